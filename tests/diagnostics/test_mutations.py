#!/usr/bin/env python3
"""The mistakes that deck_mistakes.py makes are the ones it claims to make, at the lines it claims."""
import sys
import unittest

try:
    import yaml
except ImportError:
    print("skipped: install python3-yaml")
    sys.exit(77)

from deck_mistakes import mistakes, typos

DECK = """# a comment
title: Sample   # with a note
dimension: 2
resolution: 0.01 m
variables: {depth: 0.2, spare: 1}
bodies:
  - name: column
    shape: {type: box, min: [0, 0, 0],
            max: [depth, 0, 1]}
    filling: lattice   # the default
output:
  frames:
    every: 1 s

# the end
"""

SHAPE = {"oneOf": [{"properties": {"type": {"const": "ball"}, "radius": {}}, "required": ["radius"]},
                   {"properties": {"type": {"const": "box"}, "min": {"type": "array"}, "max": {}},
                    "required": ["type", "min"]}]}
SCHEMA = {"properties": {
    "title": {"type": "string"}, "dimension": {"type": "integer", "minimum": 2, "maximum": 3},
    "resolution": {"anyOf": [{"type": "number", "exclusiveMinimum": 0}, {"type": "string"}]},
    "variables": {"type": "object"},
    "bodies": {"items": {"$ref": "#/definitions/body"}},
    "output": {"properties": {"frames": {"properties": {"every": {}}}}}},
    "required": ["resolution"],
    "definitions": {"body": {"properties": {"name": {}, "shape": SHAPE,
                                            "filling": {"enum": ["lattice", "relaxed"]}},
                             "required": ["name", "shape"]}}}


class Mutations(unittest.TestCase):
    def setUp(self):
        self.made = list(mistakes(DECK, SCHEMA))

    def of(self, kind, path):
        return [m for m in self.made if (m.kind, m.path) == (kind, path)]

    def test_typos_are_one_letter_away(self):
        for name in ("x", "to", "min", "shape", "resolution"):
            for typo in typos(name):
                self.assertNotEqual(typo, name)
                self.assertLessEqual(abs(len(typo) - len(name)), 1)

    def test_every_key_is_misspelt_at_its_line(self):
        for path, place in {"title": 2, "bodies": 6, "bodies[0].name": 7, "bodies[0].shape": 8,
                            "bodies[0].shape.max": 9, "output.frames.every": 13}.items():
            made, = self.of("misspelt", path)
            self.assertEqual(made.lines, (place,), path)
            self.assertEqual(made.suggestion, path.split(".")[-1])
            before, after = DECK.splitlines(), made.text.splitlines()
            self.assertEqual([i + 1 for i in range(len(before)) if before[i] != after[i]], [place])

    def test_a_variable_goes_wrong_where_it_is_used(self):
        self.assertEqual([m.lines for m in self.of("misspelt", "variables.depth")], [(9,)])
        self.assertEqual(self.of("misspelt", "variables.spare"), [])

    def test_types(self):
        for made in (m for m in self.made if m.kind == "type"):
            deck = yaml.safe_load(made.text)
            for part in made.path.replace("]", "").replace("[", ".").split("."):
                deck = deck[int(part)] if part.isdigit() else deck[part]
            self.assertIn(deck, (17, {"wrong": "type"}))

    def test_numbers(self):
        self.assertEqual([yaml.safe_load(m.text)["resolution"] for m in self.of("unit", "resolution")],
                         ["0.01 kg"])
        self.assertEqual([yaml.safe_load(m.text)["dimension"] for m in self.of("range", "dimension")],
                         [float("inf"), 1, 4])
        made, = self.of("unit", "bodies[0].shape.min")
        self.assertIn("min: [0 kg, 0, 0]", made.text)

    def test_choices(self):
        made, = self.of("choice", "bodies[0].filling")
        self.assertEqual((made.suggestion, made.lines), ("lattice", (10,)))
        made, = self.of("choice", "bodies[0].shape.type")
        self.assertEqual(made.suggestion, "box")

    def test_missing(self):
        self.assertEqual({m.path for m in self.made if m.kind == "missing"},
                         {"resolution", "bodies[0].name", "bodies[0].shape", "bodies[0].shape.type",
                          "bodies[0].shape.min"})
        for path, last in (("bodies[0].name", "name"), ("bodies[0].shape", "shape")):
            self.assertNotIn(last, yaml.safe_load(self.of("missing", path)[0].text)["bodies"][0])
        shape = yaml.safe_load(self.of("missing", "bodies[0].shape.min")[0].text)["bodies"][0]["shape"]
        self.assertEqual(set(shape), {"type", "max"})

    def test_duplicates(self):
        for made in (m for m in self.made if m.kind == "duplicate"):
            name = made.path.split(".")[-1]
            self.assertIn(name + ":", made.text.splitlines()[made.lines[0] - 1])
            self.assertEqual(made.text.count(name + ":"), DECK.count(name + ":") + 1)
            yaml.safe_load(made.text)   # PyYAML lets duplicates pass, so this checks the layout


if __name__ == "__main__":
    unittest.main(verbosity=0)

#!/usr/bin/env python3
"""Turned and mirrored decks, and the margins that share/validation/stability computes.

    test_stability.py SPHGEO
"""
import json
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "share/validation")]
import claims  # noqa: E402
import turn_deck  # noqa: E402
from program import ProgramTest, main  # noqa: E402

DECK = """\
dimension: 2
resolution: 0.05 m
gravity: [1, 0, -9.81]
end_time: 0.2 s
materials:
  - {name: water, type: water, sound_speed: 30}
  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1 MPa, friction_angle: 30 deg}
bodies:
  - {name: pool, material: water, shape: {type: box, min: [0, 0, 0], max: [0.5, 1, 0.5]}, pressure: hydrostatic, velocity: [z, 0, -x/2]}
  - {name: bed, material: sand, stress: geostatic, shape: {type: box, min: [0.7, 0, 0], max: [1, 1, 0.2]}}
boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [1, 1, 1], open: [top]}]
probes:
  - {name: energy, type: energy, every: 0.02}
  - {name: place, type: moments, every: 0.02}
  - {name: heap, type: deposit, every: 0.02}
expect: [{name: away, probe: place.center_x, reduce: last, measure: below, tolerance: 1}]
"""


class Stability(ProgramTest):
    def ran(self, name, change=None):
        """Columns of the run of the deck, or of the changed one, by probe."""
        deck = "deck.yaml"
        if change:
            deck = f"{name}.yaml"
            turn_deck.save(turn_deck.rewrite(turn_deck.load(self.here / "base/resolved.yaml"), change, 30), self.here / deck)
        else:
            self.write(deck, DECK)
        done = self.call("run", deck, "-q", "--threads", "1", "-o", name)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return {p.stem: claims.read_probe(p) for p in (self.here / name / "probes").glob("*.csv")}

    def test_a_changed_scene_is_the_same_scene(self):
        base = self.ran("base")
        for word in ("mirrored", "turned"):
            change = turn_deck.change_of(word)
            other = self.ran(word, change)
            self.assertEqual("heap" in other, word == "mirrored")
            with self.subTest(word):
                for column in ("center_x", "center_z"):
                    was, now = base["place"][column], claims.old_column(other["place"], column, change, "moments")
                    self.assertAlmostEqual(was[0], now[0], delta=0.01)
                    self.assertAlmostEqual(was[-1], now[-1], delta=0.03)
                for column in ("kinetic", "potential"):
                    was, now = base["energy"][column][0], other["energy"][column][0]
                    self.assertAlmostEqual(was, now, delta=0.06 * abs(was))

    def test_what_cannot_be_turned_is_said(self):
        self.ran("base")
        deck = turn_deck.load(self.here / "base/resolved.yaml")
        deck["bodies"][0]["shape"] = {"type": "boulder", "center": [0, 0, 0], "radius": 1, "roughness": 0.1, "seed": 1}
        deck["bodies"][0]["pressure"] = "zero"
        with self.assertRaisesRegex(turn_deck.NotApplicable, "boulder"):
            turn_deck.rewrite(deck, turn_deck.change_of("mirrored"))

    def test_reductions_are_those_of_the_program(self):
        self.write("deck.yaml", DECK.replace("expect: [", "expect: [" + "".join(
            f"{{name: {how}, probe: place.center_z, reduce: {how}, from: 0.05, shift: 0.1, scale: 2, measure: below, tolerance: 9}}, "
            for how in ("last", "first", "min", "max", "max_abs", "mean", "range", "growth", "slope"))))
        done = self.call("run", "deck.yaml", "-q", "--threads", "1", "-o", "run")
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        told = {e["name"]: e["value"] for e in json.loads((self.here / "run/summary.json").read_text())["expect"]}
        resolved = turn_deck.load(self.here / "run/resolved.yaml")
        probes = {p["name"]: p["type"] for p in resolved["probes"]}
        for claim in resolved["expect"]:
            value, _ = claims.measure(claim, self.here / "run", probes, None)
            self.assertAlmostEqual(value, told[claim["name"]], delta=1e-9 + 1e-9 * abs(value), msg=claim["name"])

    def test_margins(self):
        within = {"measure": "within", "reference": 2.0, "tolerance": 0.1, "tolerance_kind": "relative"}
        self.assertAlmostEqual(claims.margin(within, 2.1, 0), 0.5)
        below, above = ({"measure": m, "tolerance": 1.0} for m in ("below", "above"))
        for claim, value, start, share in ((below, 0.5, 0, 0.5), (below, 2, 0, 2), (below, -1, 0, 0), (below, 0.5, 3, 0.8),
                                           (below, 2, 3, 2), (below, 4, 3, math.inf), (above, 1.5, 2, 0.5), (above, 4, 0, 0.25),
                                           (below, math.nan, 0, math.inf)):
            self.assertAlmostEqual(claims.margin(claim, value, start), share, msg=(claim, value, start))
            if math.isfinite(value):
                self.assertEqual(share <= 1, value <= 1 if claim is below else value >= 1)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Every shipped deck validates against schemas/deck.schema.json with an independent validator
(python3-jsonschema, draft 7), the schema is a valid draft 7 schema, and broken decks are refused.

    validate_decks.py [--schema FILE] [DECK...]
"""
import argparse
import copy
import json
import re
import sys
from pathlib import Path

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}; install python3-jsonschema and python3-yaml")
    sys.exit(77)

ROOT = Path(__file__).resolve().parents[2]


class Yaml12Loader(yaml.SafeLoader):
    """Numbers as YAML 1.2 and the deck reader read them: PyYAML takes 1e-3 for a text, on for a flag."""


Yaml12Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers
            if tag not in ("tag:yaml.org,2002:float", "tag:yaml.org,2002:bool",
                           "tag:yaml.org,2002:int", "tag:yaml.org,2002:timestamp")]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def resolver(tag, pattern, first):
    Yaml12Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(pattern), list(first))


resolver("bool", r"^(true|True|TRUE|false|False|FALSE)$", "tTfF")
resolver("int", r"^[-+]?(0|[1-9][0-9]*)$", "-+0123456789")
resolver("float", r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$", "-+.0123456789")


def load(path):
    return yaml.load(path.read_text(encoding="utf-8"), Loader=Yaml12Loader)


def broken_versions(deck):
    """The deck with one mistake each that no valid schema may let through."""
    unknown = copy.deepcopy(deck)
    unknown["resolutoin"] = 0.01
    yield "an unknown section", unknown
    for key in ("resolution", "dimension", "bodies"):
        if key in deck:
            wrong = copy.deepcopy(deck)
            wrong[key] = {"not": "this"}
            yield f"a wrong type of '{key}'", wrong
    if deck.get("bodies"):
        wrong = copy.deepcopy(deck)
        wrong["bodies"][0]["shaep"] = 1
        yield "an unknown key of a body", wrong
        wrong = copy.deepcopy(deck)
        wrong["bodies"][0].get("shape", wrong["bodies"][0])["type"] = "no such type"
        yield "an unknown type of shape", wrong


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--schema", type=Path, default=ROOT / "schemas" / "deck.schema.json")
    arguments.add_argument("decks", nargs="*", type=Path)
    given = arguments.parse_args()
    decks = given.decks or sorted((ROOT / "decks").rglob("*.yaml"))

    schema = json.loads(given.schema.read_text(encoding="utf-8"))
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    failures = 0 if decks else 1
    broken = 0
    for path in decks:
        deck = load(path)
        for error in sorted(validator.iter_errors(deck), key=lambda e: list(map(str, e.path))):
            failures += 1
            print(f"{path}: {'.'.join(map(str, error.path)) or 'deck'}: {error.message[:300]}")
        for mistake, wrong in broken_versions(deck):
            broken += 1
            if validator.is_valid(wrong):
                failures += 1
                print(f"{path}: the schema lets {mistake} through")
    print(f"schema: {len(decks)} decks, {broken} broken versions, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

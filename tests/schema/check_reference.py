#!/usr/bin/env python3
"""Every key and type of the JSON Schema of decks stands in the reference page.

    check_reference.py
"""
import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def walk(schema, keys, types):
    """Collects the names of properties, and the constants that `type` may have."""
    if isinstance(schema, list):
        for item in schema:
            walk(item, keys, types)
    if not isinstance(schema, dict):
        return
    for name, inner in schema.get("properties", {}).items():
        keys.add(name)
        if name == "type" and isinstance(inner, dict):
            types |= {inner["const"]} if "const" in inner else set(inner.get("enum", []))
    for inner in schema.values():
        walk(inner, keys, types)


def main():
    keys, types = set(), set()
    walk(json.loads((ROOT / "schemas" / "deck.schema.json").read_text()), keys, types)
    page = (ROOT / "share" / "doc" / "reference.md").read_text()
    in_tables = set(re.findall(r"(?m)^\| `([^`]+)` \|", page))
    headings = set(re.findall(r"(?m)^### (\S+)$", page))
    # `type` selects the heading.
    missing = sorted(f"key '{k}'" for k in keys - in_tables - {"type"}) + sorted(f"type '{t}'" for t in types - headings)
    for what in missing:
        print(f"share/doc/reference.md: there is no {what}")
    if len(keys) < 50 or len(types) < 10:
        missing.append("")
        print(f"the schema names only {len(keys)} keys and {len(types)} types: is it read as it should be?")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())

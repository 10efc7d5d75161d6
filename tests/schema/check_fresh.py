#!/usr/bin/env python3
"""schemas/deck.schema.json is what `sphgeo schema` prints, byte for byte.

    check_fresh.py SPHGEO
"""
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main():
    stored = ROOT / "schemas" / "deck.schema.json"
    printed = subprocess.run([sys.argv[1], "schema"], capture_output=True, check=True).stdout
    if printed and stored.is_file() and stored.read_bytes() == printed:
        return 0
    print(f"{stored.relative_to(ROOT)} is stale; renew it: sphgeo schema > {stored.relative_to(ROOT)}")
    return 1


if __name__ == "__main__":
    sys.exit(main())

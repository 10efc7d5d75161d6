#!/usr/bin/env python3
"""schemas/deck.schema.json is what `sphgeo schema` prints, and share/doc/reference.md what `sphgeo reference`
prints, byte for byte.

    check_fresh.py SPHGEO
"""
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PRINTED = {"schema": "schemas/deck.schema.json", "reference": "share/doc/reference.md"}


def main():
    stale = 0
    for command, name in PRINTED.items():
        stored = ROOT / name
        printed = subprocess.run([sys.argv[1], command], capture_output=True, check=True).stdout
        if not printed or not stored.is_file() or stored.read_bytes() != printed:
            print(f"{name} is stale; renew it: sphgeo {command} > {name}")
            stale += 1
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())

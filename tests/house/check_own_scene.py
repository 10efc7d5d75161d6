#!/usr/bin/env python3
"""The deck of share/doc/own_scene.md is sound after each of its blocks, and runs and keeps its claims at the end.

    check_own_scene.py SPHGEO
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PAGE = Path(__file__).resolve().parents[2] / "share/doc/own_scene.md"


def main():
    sphgeo = str(Path(sys.argv[1]).resolve())
    blocks = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(), re.DOTALL)
    if len(blocks) != 4:
        print(f"{PAGE.name}: {len(blocks)} blocks of YAML, not 4")
        return 1
    with tempfile.TemporaryDirectory(prefix="sphgeo-own-") as folder:
        deck, text = Path(folder) / "my_scene.yaml", ""
        for number, block in enumerate(blocks, 1):
            text += block
            deck.write_text(text)
            words = ["check", deck, "--no-calibrate"] if number < len(blocks) else ["run", deck, "-o", Path(folder) / "run", "--verify"]
            done = subprocess.run([sphgeo, *map(str, words)], capture_output=True, text=True)
            if done.returncode != 0:
                print(f"{PAGE.name}, block {number}: exit {done.returncode}\n{done.stdout}{done.stderr}")
                return 1
        if not (Path(folder) / "run/report.html").is_file():
            print("there is no report.html")
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

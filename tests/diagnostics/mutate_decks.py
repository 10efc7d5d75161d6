#!/usr/bin/env python3
"""Makes every mistake of deck_mistakes.py in every key of every shipped deck, one at a time, and looks
whether `sphgeo check` says so: exit 2 and the right line always, the right suggestion in at least 90 %.

    mutate_decks.py --sphgeo BINARY [--all] [--verbose] [DECK...]
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from decks import affordable  # noqa: E402

try:
    from deck_mistakes import mistakes
except ImportError as absent:
    print(f"skipped: {absent}; install python3-yaml")
    sys.exit(77)

ROOT = Path(__file__).resolve().parents[2]
ERROR = re.compile(r"^(.*?):(\d+):(\d+): error", re.MULTILINE)
OFFER = re.compile(r"did you mean '([^']+)'")


def sampled(items, most):
    """At most so many items, evenly spread, the same ones each time."""
    if len(items) <= most:
        return items
    return [items[i * len(items) // most] for i in range(most)]


def check(sphgeo, path):
    """(exit code, stderr without colours) of `sphgeo check`."""
    done = subprocess.run([sphgeo, "check", str(path)], stdin=subprocess.DEVNULL, timeout=1200,
                          capture_output=True, text=True, env={**os.environ, "NO_COLOR": "1"})
    return done.returncode, done.stderr


def judge(sphgeo, name, deck, mistake, number):
    """What is wrong with the answer to one mistake: a set of 'exit', 'line', 'suggestion'; and the answer."""
    path = deck.with_name(f"{deck.stem}.{number}.yaml")
    path.write_text(mistake.text, encoding="utf-8")
    try:
        code, said = check(sphgeo, path)
    except subprocess.TimeoutExpired:
        code, said = "none within a minute", ""
    path.unlink()
    wrong = set()
    if code != 2:
        wrong.add("exit")
    first = ERROR.search(said)
    if not first or Path(first.group(1)).name != path.name or int(first.group(2)) not in mistake.lines:
        wrong.add("line")
    if mistake.suggestion and mistake.suggestion not in OFFER.findall(said):
        wrong.add("suggestion")
    return wrong, f"{name}: {mistake.kind} {mistake.path}: exit {code}, wanted line " \
                  f"{'/'.join(map(str, mistake.lines))} {mistake.suggestion}\n{said[:600]}"


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--sphgeo", required=True)
    arguments.add_argument("--all", action="store_true", help="no sampling")
    arguments.add_argument("--most", type=int, default=400, help="mistakes per deck without --all")
    arguments.add_argument("--verbose", action="store_true", help="print every wrong answer")
    arguments.add_argument("--jobs", type=int, default=os.cpu_count(), help="checks at the same time")
    arguments.add_argument("decks", nargs="*", type=Path)
    given = arguments.parse_args()
    sphgeo = str(Path(given.sphgeo).resolve())
    decks = given.decks or [ROOT / deck for deck in affordable()]
    schema = json.loads(subprocess.run([sphgeo, "schema"], capture_output=True, check=True).stdout)

    tally, bad, clean = Counter(), [], 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(given.jobs) as pool:
        # The mutated decks stand where the decks stand, so that the files they name are found.
        shutil.copytree(ROOT / "decks", Path(folder) / "decks")
        for shared in ("share", "schemas", "tests"):
            (Path(folder) / shared).symlink_to(ROOT / shared)
        for original in (d.resolve() for d in decks):
            name = str(original.relative_to(ROOT))
            deck = Path(folder) / name
            code, said = check(sphgeo, deck)
            clean += code == 0
            if code != 0:
                bad.append(f"{name}: the deck itself is refused: exit {code}\n{said[:600]}")
                continue
            made = sampled(list(mistakes(original.read_text(encoding="utf-8"), schema)),
                           sys.maxsize if given.all else given.most)
            numbered = enumerate(made)
            for mistake, (wrong, answer) in zip(made, pool.map(
                    lambda m: judge(sphgeo, name, deck, m[1], m[0]), numbered)):
                tally.update({"made": 1, mistake.kind: 1, "offers": bool(mistake.suggestion)})
                tally.update("wrong " + w for w in wrong)
                if wrong:
                    bad.append(f"[{', '.join(sorted(wrong))}] {answer}")

    for answer in bad if given.verbose else bad[:12]:
        print(answer)
    right = {w: tally["made"] - tally["wrong " + w] for w in ("exit", "line")}
    offered = tally["offers"] - tally["wrong suggestion"]
    kinds = ", ".join(f"{tally[k]} {k}" for k in
                      ("misspelt", "type", "unit", "range", "choice", "missing", "duplicate"))
    print(f"mistakes: {tally['made']} in {clean}/{len(decks)} decks ({kinds}): exit 2 {right['exit']}, "
          f"right line {right['line']}, right suggestion {offered}/{tally['offers']}")
    good = (decks and clean == len(decks) and tally["made"] and right["exit"] == right["line"] == tally["made"]
            and offered >= 0.9 * tally["offers"])
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())

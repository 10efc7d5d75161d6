#!/usr/bin/env python3
"""Every shipped deck gives the same bits in one piece and in four, with one and with two threads.

    test_resume_decks.py SPHGEO SAME_STATE [--whole] [--seed N] [--set KEY=VALUE]... [DECK...]

Each deck below decks/ (or the ones named) runs to its end with one thread, with two threads, and once more ended
at three random places (by --max-acoustic-steps, so mostly within an advection step) and resumed, with the number of threads changed each time. Frames, tables,
summary and the arrays of the last checkpoint must be the same.

So that it takes seconds, the end is where the deck is after SHORT steps, and frames and rows are close enough for
some of them to fall into each piece. --whole: everything as the deck has it, which takes minutes for each; --set makes a
long one coarser or shorter.
"""
import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from decks import affordable  # noqa: E402
from run_folder import differing, results  # noqa: E402

DONE, STOPPED = 0, 6
SHORT = 40    # advection steps
PIECES = 4
# Decks that need settings of their own to be short, and what is worth a second look: deck, settings.
SETTINGS = {
    "decks/basics/dam_break_impact.yaml": ["resolution=H/30"],
    "decks/basics/standing_wave.yaml": ["resolution=depth/20"],
    "decks/basics/oscillating_drop.yaml": ["resolution=R/20"],
}
ALSO = [
    ("decks/basics/still_water.yaml", ["dimension=3", "resolution=depth/8"]),
    ("decks/basics/column_collapse.yaml", ["dimension=3", "resolution=width/8", "numerics.pair_precision=double"]),
    ("decks/basics/dam_break.yaml", ["dimension=3", "resolution=L/8", "numerics.pair_precision=double"]),
]


class Wrong(Exception):
    pass


class Case:
    def __init__(self, args, deck, settings, folder):
        self.args, self.deck, self.settings, self.folder = args, deck, settings, Path(folder)

    def run(self, name, *words, expected=DONE):
        out = self.folder / name
        changes = [word for change in self.settings for word in ("--set", change)]
        done = subprocess.run([self.args.sphgeo, "run", str(ROOT / self.deck), "-o", str(out), "-q", *changes, *map(str, words)],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode != expected:
            raise Wrong(f"{name} {' '.join(map(str, words))}: exit {done.returncode}, not {expected}\n{done.stderr[-2000:]}")
        return json.loads((out / "summary.json").read_text())

    def shorten(self):
        """Ends the deck where it is after SHORT steps, with five frames and nine rows on the way."""
        end = self.run("probe", "--max-steps", SHORT, expected=STOPPED)["time_s"]
        self.settings = [*self.settings, f"end_time={end!r}", f"output.frames.every={end / 4!r}", f"output.run_every={end / 8!r}"]

    def compare(self, name, what):
        wrong = differing(results(self.folder / "whole"), results(self.folder / name))
        if wrong:
            raise Wrong(f"{what}: not the same: {', '.join(wrong)}")
        done = subprocess.run([self.args.same_state, *(str(self.folder / f / "checkpoint.h5") for f in ("whole", name))],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise Wrong(f"{what}: the last checkpoints differ: {done.stdout}{done.stderr}")

    def __call__(self, rng):
        if not self.args.whole:
            self.shorten()
        whole = self.run("whole", "--threads", 1)
        total = whole["steps"]["advection"]
        frames = len(list((self.folder / "whole" / "frames").glob("*.vtu")))
        # A scene of material points only has no particles and no frames.
        if total < PIECES or whole["steps"]["acoustic"] < PIECES or (frames < 2 and any(whole["particles"].values())):
            raise Wrong(f"{total} steps and {frames} frames are too few to compare anything")
        self.run("threads", "--threads", 2)
        self.compare("threads", "1 and 2 threads")
        # Within advection steps and between two of them.
        places = sorted(rng.sample(range(1, whole["steps"]["acoustic"]), PIECES - 1))
        at = 0
        for k, place in enumerate(places):
            steps = self.run("pieces", "--threads", 2 - k % 2, "--max-acoustic-steps", place - at, *(["--resume"] if k else []),
                             expected=STOPPED)["steps"]["acoustic"]
            if steps != place:
                raise Wrong(f"asked to stop after {place} acoustic steps, it stopped after {steps}")
            at = place
        self.run("pieces", "--threads", 1, "--resume")
        self.compare("pieces", f"stopped after {places} of {whole['steps']['acoustic']} acoustic steps")
        return f"{total} steps, {whole['steps']['acoustic']} acoustic, {sum(whole['particles'].values())} particles, {frames} frame files, stopped after {places}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("sphgeo")
    parser.add_argument("same_state")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--whole", action="store_true")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="for every deck that is named")
    args = parser.parse_intermixed_args()
    if args.set and not args.decks:
        parser.error("--set needs the decks that it is for")
    found = affordable()
    decks = [Path(d).resolve().relative_to(ROOT).as_posix() for d in args.decks] or found
    unknown = [d for d in [*SETTINGS, *(deck for deck, _ in ALSO)] if d not in found]
    for deck in unknown:
        print(f"{deck}: has settings here, but there is no such deck")
    cases = [(d, args.set if args.whole or args.set else SETTINGS.get(d, [])) for d in decks]
    if not args.whole and not args.set:
        cases += [(d, settings) for d, settings in ALSO if d in decks]
    failed = len(unknown)
    for deck, settings in cases:
        rng = random.Random(f"{args.seed} {deck} {settings}")
        start = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            try:
                said = "the same bits: " + Case(args, deck, settings, folder)(rng)
            except Wrong as e:
                said, failed = f"WRONG {e}", failed + 1
        print(f"{' '.join([deck, *settings])}: {said}; {time.monotonic() - start:.1f} s", flush=True)
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Every shipped deck is checked, explained, begun with two threads, ended within an advection step, and gone on with;
water in soil is relaxed. Made for builds with sanitizers: a report of one, or an exit that is not the one expected, fails.

    test_starts.py SPHGEO [DECK...] [--steps N]

N advection steps each time.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from decks import affordable  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
DONE, USAGE, STOPPED = 0, 2, 6
REPORTS = ("Sanitizer", "runtime error:")
# Scenes in three dimensions: deck, settings.
ALSO = [
    ("decks/basics/dam_break.yaml", ["dimension=3", "resolution=L/8"]),
    ("decks/basics/still_water.yaml", ["dimension=3", "resolution=depth/8", "numerics.pair_precision=double"]),
    ("decks/basics/column_collapse.yaml", ["dimension=3", "resolution=width/6"]),
    ("decks/paper/submerged_crater.yaml", ["resolution=0.00625", "relaxation.steps=10"]),
    ("decks/paper/u_tube.yaml", ["dimension=3", "resolution=0.2", "relaxation.steps=10"]),
    ("decks/paper/relaxation_uniform.yaml", ["dimension=3", "resolution=L/15", "relaxation.steps=10"]),
]
# Finer than a start under a sanitizer needs.
COARSER = {
    "decks/basics/repose_angle.yaml": "radius/6",
    "decks/basics/dam_break_impact.yaml": "H/30",
    "decks/basics/standing_wave.yaml": "depth/20",
    "decks/basics/oscillating_drop.yaml": "R/20",
}


class Wrong(Exception):
    pass


def call(sphgeo, *words, expected):
    """Runs the program; returns what it says."""
    env = {**os.environ, "NO_COLOR": "1"}
    # Exit codes of their own, none of which is one of the program's.
    for name in ("ASAN_OPTIONS", "TSAN_OPTIONS", "UBSAN_OPTIONS"):
        env[name] = ":".join(filter(None, [os.environ.get(name), "exitcode=66:halt_on_error=1:print_stacktrace=1"]))
    done = subprocess.run([sphgeo, *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, text=True, env=env)
    said = done.stdout + done.stderr
    if done.returncode not in expected or any(word in said for word in REPORTS):
        raise Wrong(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stderr[-6000:]}")
    return said


def start(sphgeo, deck, settings, steps, folder):
    path = ROOT / deck
    changes = [word for s in settings for word in ("--set", s)]
    out = Path(folder) / "run"
    call(sphgeo, "check", path, *changes, "--no-calibrate", expected=[DONE])
    call(sphgeo, "check", path, *changes, "--explain", "--json", "--no-calibrate", expected=[DONE])
    run = ("run", path, *changes, "-o", out, "-q", "--threads", 2)
    # Too short a scene may end before it is stopped.
    call(sphgeo, *run, "--max-steps", steps, expected=[STOPPED, DONE])
    call(sphgeo, *run, "--resume", "--max-acoustic-steps", 3, expected=[STOPPED, DONE])
    call(sphgeo, *run, "--resume", "--max-steps", steps, expected=[STOPPED, DONE])
    resolved = (out / "resolved.yaml").read_text()
    if "type: water" in resolved and "type: soil" in resolved:
        # A usage error: no water of the deck starts in pores.
        call(sphgeo, "relax", path, *changes, "--set", "relaxation.steps=10", "-o", Path(folder) / "relaxed", "-q", "--threads", 2,
             expected=[DONE, USAGE])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("sphgeo")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--steps", type=int, default=6)
    args = parser.parse_intermixed_args()
    found = affordable()
    decks = [Path(d).resolve().relative_to(ROOT).as_posix() for d in args.decks] or found
    cases = [(d, [f"resolution={COARSER[d]}"] if d in COARSER else []) for d in decks]
    cases += [(d, settings) for d, settings in ALSO if not args.decks or d in decks]
    failed = 0
    for deck, settings in cases:
        begun = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            try:
                start(args.sphgeo, deck, settings, args.steps, folder)
                said = "no report"
            except Wrong as e:
                said, failed = f"WRONG {e}", failed + 1
        print(f"{' '.join([deck, *settings])}: {said}; {time.monotonic() - begun:.1f} s", flush=True)
    print(f"{len(cases)} scenes, {failed} wrong")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Runs a deck with 1 and 3 threads: each run ends well, what the deck expects is met, the run folder
is complete and its resolved deck is a valid deck, the results are the same bits, and they are what they were
when the baseline of the case was written (baselines/NAME.json, within tolerances.yaml; with --lively tolerances_lively.yaml).

    run_case.py SPHGEO DECK RUN_FOLDER [--unverified] [--no-frames] [--lively] [--at-rest] [sphgeo run options...]

--no-frames: the scene has no particles. --unverified: the run is too short for what the deck expects; everything else is checked.
--at-rest: velocities are not compared, as what is left of them is rounding.
With SPHGEO_UPDATE_BASELINES=1 in the environment the baseline is written anew instead of compared with.
"""
import json
import os
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from run_folder import differing, results  # noqa: E402

THREADS = (1, 3)  # an odd number shares out no work evenly
HERE = Path(__file__).resolve().parent


def call(*words):
    """Runs a command; on failure prints what it said and ends the test."""
    done = subprocess.run([str(w) for w in words], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        print(" ".join(map(str, words)), f"\nexit {done.returncode}")
        print(done.stdout[-4000:], done.stderr[-4000:], sep="\n")
        sys.exit(1)


def check_folder(sphgeo, folder, found):
    """Sentences about what is missing from a run folder."""
    call(sphgeo, "check", folder / "resolved.yaml")
    if found.get("summary.json", {}).get("status") != "done":
        yield f"summary.json: status is {found.get('summary.json', {}).get('status')}, not done"
    if not found.get("run.csv"):
        yield "run.csv has no rows"
    collections = sorted(folder.rglob("*.pvd"))
    # Scenes of material points only have no particles, and so no frames.
    if not collections and any(found.get("summary.json", {}).get("particles", {"?": 1}).values()):
        yield "there is no .pvd"
    for pvd in collections:
        frames = [pvd.parent / e.get("file") for e in xml.parse(pvd).iter("DataSet")]
        if not frames or not all(f.is_file() for f in frames):
            yield f"{pvd.name} names frames that are not there, or none"


def compare(sphgeo, run, name, tolerances, at_rest):
    """A sentence for every difference from the case's baseline."""
    baseline = HERE / "baselines" / f"{name}.json"
    if os.environ.get("SPHGEO_UPDATE_BASELINES"):
        call(sphgeo, "compare", run, baseline, "--update")
        return
    if not baseline.is_file():
        yield f"there is no {baseline.name}: run this test with SPHGEO_UPDATE_BASELINES=1 and look at what it writes"
        return
    done = subprocess.run([sphgeo, "compare", run, baseline, "--tolerances", HERE / tolerances, "--json"],
                          capture_output=True, text=True)
    if done.returncode not in (0, 4):
        yield f"sphgeo compare: exit {done.returncode}: {done.stderr.strip()}"
        return
    for d in json.loads(done.stdout)["differences"]:
        if at_rest and d["kind"] == "field" and "velocity" in d["name"]:
            continue
        if not d["pass"]:
            yield f"{d['kind']} {d['name']}: differs by {d['difference']}, tolerance {d['tolerance']} ({d['note']})"


def main():
    sphgeo, deck, folder, options = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]
    verify = [] if "--unverified" in options else ["--verify"]
    tolerances = "tolerances_lively.yaml" if "--lively" in options else "tolerances.yaml"
    for_sphgeo = [o for o in options if o not in ("--unverified", "--no-frames", "--lively", "--at-rest")]
    shutil.rmtree(folder, ignore_errors=True)
    wrong, first = [], None
    for threads in THREADS:
        here = folder / f"threads{threads}"
        here.parent.mkdir(parents=True, exist_ok=True)
        call(sphgeo, "run", deck, "-o", here, "--threads", threads, *verify, *for_sphgeo)
        found = results(here)
        if first is None:
            first = found
            wrong += check_folder(sphgeo, here, found)
            wrong += compare(sphgeo, here, folder.name, tolerances, "--at-rest" in options)
        wrong += [f"{name} differs between {THREADS[0]} and {threads} threads" for name in differing(first, found)]
    for sentence in wrong:
        print(f"{folder}: {sentence}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

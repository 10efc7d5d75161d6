#!/usr/bin/env python3
"""A run that was ended in any way goes on with the same bits.

    test_resume.py SPHGEO DECK [--kills N] [--seed N] [sphgeo run options...]

Ends: --max-steps at three places, SIGTERM, SIGINT, three of them, the stop file, `kill -9` at random times (N of them, also
while a checkpoint is being written); then damaged checkpoints, a changed deck, a later end, two runs in one folder.
"""
import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import HANGS  # noqa: E402
from run_folder import differing, results  # noqa: E402

DONE, USAGE, IO, STOPPED = 0, 2, 5, 6


class Test:
    def __init__(self, sphgeo, deck, options, folder):
        self.sphgeo, self.deck, self.options, self.folder, self.wrong = sphgeo, deck, options, Path(folder), []

    def words(self, out, *more):
        return [self.sphgeo, "run", self.deck, "-o", str(out), "-q", *self.options, *map(str, more)]

    def run(self, out, *more, expected=DONE):
        done = subprocess.run(self.words(out, *more), stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if done.returncode != expected:
            self.fail(f"{out.name} {' '.join(map(str, more))}: exit {done.returncode}, not {expected}\n{done.stderr[-2000:]}")
        return done.stderr

    def fail(self, sentence):
        self.wrong.append(sentence)
        print(sentence)

    def same(self, out, what):
        """The results must be those of the run that nobody ended; no file may be left over."""
        here = results(out)
        for name in differing(self.reference, here):
            self.fail(f"{what}: {name} differs from the run in one piece" if name in here and name in self.reference
                      else f"{what}: {name} is in one of the two folders only")

    def fresh(self, name):
        out = self.folder / name
        shutil.rmtree(out, ignore_errors=True)
        return out


def steps_of(out):
    return json.loads((out / "summary.json").read_text())["steps"]["advection"]


def end_by_steps(t, rng):
    total = steps_of(t.folder / "whole")
    out = t.fresh("steps")
    places = sorted(rng.sample(range(1, total), 3))
    at = 0
    for k, place in enumerate(places):
        t.run(out, "--max-steps", place - at, "--threads", 1 + k % 2, *(["--resume"] if k else []), expected=STOPPED)
        at = place
        status = json.loads((out / "summary.json").read_text())
        if status["status"] != "stopped" or status["steps"]["advection"] != place:
            t.fail(f"--max-steps: {status['status']} after {status['steps']['advection']} steps, not stopped after {place}")
    t.run(out, "--resume")
    t.same(out, f"stopped after {places} steps")
    # A finished run may be asked to go on: there is nothing left to do, and nothing changes.
    t.run(out, "--resume")
    t.same(out, "resumed after its end")


def wait_for_rows(t, out, process, rows=3):
    """Until the run has written some rows of run.csv, or has ended."""
    table = out / "run.csv"
    while process.poll() is None and (not table.exists() or sum(not l.startswith("#") for l in open(table)) <= rows):
        time.sleep(0.01)


def end_politely(t):
    for name, ask in (("SIGTERM", lambda p, out: p.send_signal(signal.SIGTERM)), ("SIGINT", lambda p, out: p.send_signal(signal.SIGINT)),
                      ("stop file", lambda p, out: (out / "stop").touch())):
        out = t.fresh("polite")
        process = subprocess.Popen(t.words(out), stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        wait_for_rows(t, out, process, 0)
        ask(process, out)
        _, said = process.communicate(timeout=HANGS)
        if process.returncode == DONE:
            continue  # it was faster
        if process.returncode != STOPPED or "--resume" not in said:
            t.fail(f"{name}: exit {process.returncode}, said: {said}")
        if (out / "stop").exists():
            t.fail(f"{name}: the stop file is still there, and would end the next run")
        t.run(out, "--resume")
        t.same(out, name)


def end_at_once(t):
    """The third signal ends a run as it is; what it was writing does not stay half-written."""
    for _ in range(5):
        out = t.fresh("at_once")
        process = subprocess.Popen(t.words(out, "--set", "output.checkpoint_every=0"), stdin=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        wait_for_rows(t, out, process, 0)
        while process.poll() is None:
            process.send_signal(signal.SIGINT)
        left = sorted(str(p) for p in out.rglob("*.part"))
        if left:
            t.fail(f"three signals: exit {process.returncode}, left {left}")


def kill(t, rng, kills):
    """kill -9 at random times of one run, resumed each time, until it ends; again until all kills are done."""
    start = time.monotonic()
    t.run(t.fresh("timing"), "--set", "output.checkpoint_every=0")
    duration = time.monotonic() - start
    done, checks, out = 0, 0, t.fresh("killed")
    while done < kills:
        process = subprocess.Popen(t.words(out, "--resume", "--set", "output.checkpoint_every=0"), stdin=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        try:
            _, said = process.communicate(timeout=rng.uniform(0.02, 0.6) * duration)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            done += 1
            continue
        if process.returncode != DONE:
            t.fail(f"after {done} kills: exit {process.returncode}, said: {said}")
            return
        t.run(out, "--resume")  # writes the resolved deck with its own interval of checkpoints
        t.same(out, f"killed {done} times")
        checks += 1
        out = t.fresh("killed")
    t.run(out, "--resume")
    t.same(out, f"killed {done} times")
    print(f"{done} kills, {checks + 1} runs brought to their end")


def damaged(t, rng):
    out = t.fresh("damaged")
    t.run(out, "--max-steps", 4, expected=STOPPED)
    t.run(out, "--resume", "--max-steps", 4, expected=STOPPED)
    whole = (out / "checkpoint.h5").read_bytes()
    for what, bytes_ in (("cut", whole[:rng.randrange(len(whole))]), ("flipped", flipped(whole, rng)), ("empty", b"")):
        here = t.fresh("mended")
        shutil.copytree(out, here)
        (here / "checkpoint.h5").write_bytes(bytes_)
        said = t.run(here, "--resume")
        if "warning" not in said or "checkpoint.h5" not in said:
            t.fail(f"a {what} checkpoint is used without a warning: {said}")
        t.same(here, f"a {what} checkpoint")
        (here / "checkpoint.h5").write_bytes(bytes_)
        (here / "checkpoint.prev.h5").write_bytes(bytes_)
        said = t.run(here, "--resume", expected=IO)
        if "no intact checkpoint" not in said:
            t.fail(f"two {what} checkpoints: {said}")


def flipped(data, rng):
    bad = bytearray(data)
    bad[rng.randrange(len(bad))] ^= 1 << rng.randrange(8)
    return bytes(bad)


def changes(t):
    out = t.fresh("changed")
    t.run(out, "--max-steps", 3, expected=STOPPED)
    before = {p: p.read_bytes() for p in out.rglob("*") if p.is_file()}
    said = t.run(out, "--resume", "--set", "numerics.limiter=7", expected=USAGE)
    if "numerics.limiter: 3 there, 7 here" not in said:
        t.fail(f"a changed key is not named: {said}")
    said = t.run(out, expected=USAGE)
    if "--resume" not in said:
        t.fail(f"a folder with a checkpoint is refused without a word about --resume: {said}")
    if before != {p: p.read_bytes() for p in out.rglob("*") if p.is_file()}:
        t.fail("a refused run has changed files")
    # A later end: the same as if it had been the end from the start.
    longer = ["--set", "end_time=0.06", "--set", "output.run_every=1e-3", "--set", "output.frames.every=0.02"]
    short = ["--set", "end_time=0.03"] + longer[2:]
    one = t.fresh("longer")
    t.run(one, *longer)
    two = t.fresh("extended")
    t.run(two, *short)
    t.run(two, "--resume", *longer)
    theirs, ours = results(one), results(two)
    for name in ("summary.json", "run.csv"):
        if theirs[name] != ours[name]:
            t.fail(f"a run that got a later end differs from a long one in {name}")


def locked(t):
    out = t.fresh("locked")
    process = subprocess.Popen(t.words(out), stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    wait_for_rows(t, out, process, 0)
    process.send_signal(signal.SIGSTOP)
    if process.poll() is None:
        said = t.run(out, "--resume", expected=USAGE)
        if "another run" not in said:
            t.fail(f"two runs in one folder: {said}")
    process.send_signal(signal.SIGCONT)
    process.wait()
    t.same(out, "the run whose folder was asked for")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("sphgeo")
    parser.add_argument("deck")
    parser.add_argument("--kills", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    args, options = parser.parse_known_args()
    rng = random.Random(args.seed)
    with tempfile.TemporaryDirectory() as folder:
        t = Test(args.sphgeo, args.deck, options, folder)
        whole = t.fresh("whole")
        t.run(whole)
        t.reference = results(whole)
        end_by_steps(t, rng)
        end_politely(t)
        end_at_once(t)
        damaged(t, rng)
        changes(t)
        locked(t)
        kill(t, rng, args.kills)
    return 1 if t.wrong else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Whether two builds give the same bits for the regression decks (tests/decks/cases.txt).

    compare_builds.py ONE TWO                      runs the cases with both programs and compares what they wrote
    compare_builds.py ONE --record FILE            keeps what ONE writes, as checksums
    compare_builds.py TWO --against FILE           compares with what was kept

Options: --short N   ends each case where it is after N advection steps: a first look within a few minutes
         --jobs N    cases at the same time (2), each with one thread
         --threads N threads of each run (1)
         CASE...     only the cases whose names contain one of these words

Compared are frames, tables without their comments, steps, claims and ledger, but for clocks: what tests/support/run_folder.py takes to be
the same run. Exit 0: all the same; 1: the cases that differ are named, with the files.
"""
import argparse
import hashlib
import json
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from run_folder import results  # noqa: E402

FOR_THE_TEST = ("--unverified", "--no-frames", "--lively", "--at-rest")


def cases(words):
    """Name, deck and options of each case."""
    for line in (ROOT / "tests" / "decks" / "cases.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        name, _, deck, *options = shlex.split(line)
        if not words or any(word in name for word in words):
            yield name, deck, [o for o in options if o not in FOR_THE_TEST]


def run(program, deck, out, *options):
    """Runs a deck; the summary, or an exception with what the program said."""
    done = subprocess.run([program, "run", str(ROOT / deck), "-o", str(out), "-q", *map(str, options)],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode not in (0, 4, 6):
        raise RuntimeError(f"{deck}: exit {done.returncode}: {done.stderr.strip()[-600:]}")
    return json.loads((out / "summary.json").read_text())


def checksums(program, deck, options, args, end):
    """Checksum of each result by name, and the end of the run; `end` [s] shortens it, None: see --short."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        if args.short and end is None:
            end = run(program, deck, folder / "first", "--threads", args.threads, "--max-steps", args.short, *options)["time_s"]
        shorten = []
        if end is not None:
            # More often than a short end needs would be refused.
            shorten = [f"end_time={end!r}", f"output.frames.every={end / 4!r}", f"output.run_every={end / 8!r}"]
        run(program, deck, folder / "run", "--threads", args.threads, *options, *(w for s in shorten for w in ("--set", s)))
        found = results(folder / "run")
    encoded = {name: value if isinstance(value, bytes) else json.dumps(value, sort_keys=True).encode()
               for name, value in found.items()}
    for name in encoded:
        # Reference tables are named by their whole path.
        encoded[name] = encoded[name].replace(str(ROOT).encode(), b"PROJECT") if name == "resolved.yaml" else encoded[name]
        if name.endswith(".csv"):  # comments may read better than they did
            encoded[name] = b"\n".join(line for line in encoded[name].split(b"\n") if not line.startswith(b"#"))
    return {"end": end, "files": {name: hashlib.sha256(value).hexdigest() for name, value in encoded.items()}}


def measure(program, chosen, args, kept):
    """checksums() of all cases by name; a run that fails is kept as what it said."""
    def one(case):
        name, deck, options = case
        try:
            found = checksums(program, deck, options, args, kept.get(name, {}).get("end"))
        except (RuntimeError, OSError, KeyError) as e:
            found = {"failed": str(e)}
        print(f"{name}: {found.get('failed') or str(len(found['files'])) + ' files'}", file=sys.stderr, flush=True)
        return name, found

    with ThreadPoolExecutor(args.jobs) as pool:
        return dict(pool.map(one, chosen))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="PROGRAM|CASE")
    parser.add_argument("--record", type=Path)
    parser.add_argument("--against", type=Path)
    parser.add_argument("--short", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--threads", type=int, default=1)
    args = parser.parse_intermixed_args()
    many = 1 if args.record or args.against else 2
    programs = [str(Path(p).resolve()) for p in args.programs[:many]]
    chosen = list(cases(args.programs[many:]))
    if len(programs) < many or not chosen:
        parser.error("two programs, or one with --record or --against, and at least one case")
    if args.against:
        kept = json.loads(args.against.read_text())
        chosen = [c for c in chosen if c[0] in kept]
    else:
        kept = measure(programs[0], chosen, args, {})
    if args.record:
        args.record.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
        failed = [name for name, found in kept.items() if "failed" in found]
        print(f"{len(kept)} cases kept in {args.record}" + (f"; failed: {', '.join(failed)}" if failed else ""))
        return 1 if failed else 0
    found = measure(programs[-1], chosen, args, kept)
    different = 0
    for name, now in found.items():
        before = kept[name]
        if "failed" in now or "failed" in before:
            wrong = [f"before: {before.get('failed', 'ran')}, now: {now.get('failed', 'ran')}"]
        else:
            names = sorted(set(before["files"]) | set(now["files"]))
            wrong = [file for file in names if before["files"].get(file) != now["files"].get(file)]
        if wrong:
            different += 1
            print(f"{name}: differs: {', '.join(wrong[:6])}{' ...' if len(wrong) > 6 else ''}")
    print(f"{len(found) - different} of {len(found)} cases give the same bits")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())

"""What two run folders must share when they hold the same run."""
import csv
import json

# What a run says of itself that may differ from one run to the next: clocks and the machine.
OWN = ("wall", "seconds", "per_s", "memory", "eta", "threads", "rate", "bytes")


def results(folder):
    """Everything in the run folder that depends on the deck alone, by name. Not the checkpoint, which holds
    clocks beside the state: tools/same_state.cpp compares two of those."""
    found = {}
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        name = path.relative_to(folder).as_posix()
        if name.startswith("checkpoint") or name == "report.html":  # it shows wall times
            continue
        if name == "summary.json":
            summary = json.loads(path.read_text())
            found[name] = {k: summary[k] for k in ("status", "deck_hash", "particles", "steps", "time_s",
                                                   "expect", "ledger")}
        elif name == "run.csv":
            with open(path, newline="") as file:
                rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
            found[name] = [{k: v for k, v in row.items() if not any(w in k for w in OWN)} for row in rows]
        else:
            found[name] = path.read_bytes()
    return found


def differing(one, other):
    """The names whose contents are not the same in two such results."""
    return [name for name in sorted(set(one) | set(other)) if one.get(name) != other.get(name)]

"""Sweeps of hardness: one number of a deck varied over the range a user may write (stability.yaml, `sweeps`)."""
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import turn_deck

ROOT = Path(__file__).resolve().parents[2]


def run(options, plan, runner, judge, quiet):
    """{sweep: [result of each value]}."""
    names = [n for n in plan["sweeps"] if not options.decks or n in options.decks]
    todo = [(name, value) for name in names for value in plan["sweeps"][name]["values"]]

    def one(item):
        name, value = item
        sweep = plan["sweeps"][name]
        value = float(value) if isinstance(value, str) else value
        path = ROOT / f"decks/hard/{sweep['deck']}.yaml"
        done = runner.run(path, f"sweeps/{name}/{value:g}", sweep.get("options", []) + [f"{sweep['key']}={value!r}"] + quiet)
        text = done["folder"] / "resolved.yaml"
        resolved = turn_deck.load(text) if text.is_file() else {"probes": [], "expect": []}
        result = {"value": f"{value:g}", **judge(resolved, done, None, sweep.get("skip", []))}
        worst = max(result["claims"].items(), key=lambda c: c[1], default=("", 0))
        print(f"{name} {value:g}: {'; '.join(result['wrong']) or f'{worst[0]} {100 * worst[1]:.2g} %'}", file=sys.stderr, flush=True)
        return name, result

    results = {name: [] for name in names}
    with ThreadPoolExecutor(options.jobs) as pool:
        for name, result in pool.map(one, todo):
            results[name].append(result)
    return results

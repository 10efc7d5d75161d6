"""The page stability.md: tables of decks and of sweeps."""
import datetime
import math
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TITLES = {"base": "as it is", "jitter": "worst of 10 seeds", "half_step": "half the step", "fine": "half the spacing",
          "turned": "turned", "mirrored": "mirrored"}
PREFACE = """# Stability

Every deck of `decks/hard` in variants, by `share/validation/stability`; sweeps of hardness by `share/validation/stability --sweeps`. Both continue
from where they were stopped. This page is written by them.
"""


def processor():
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown processor"


def measured(command, sphgeo):
    said = subprocess.run([str(sphgeo), "--version"], capture_output=True, text=True, check=False).stdout
    commit = next((line.split()[1] for line in said.splitlines() if line.startswith("commit ")), "unknown")
    return f"Measured on {datetime.date.today()}, {processor()}, one thread a run, program of commit {commit}: `{command}`."


def percent(margin):
    if not math.isfinite(margin):
        return "missed"
    p = 100 * margin
    return "0 %" if p == 0 else f"{p:.2g} %" if p < 99.5 else f"{p:.0f} %"


def cell(variants):
    """One group of variants of one deck: the worst margin and its claim."""
    variants = [v for v in variants if "not_applicable" not in v]
    if not variants:
        return "-"
    broken = [v for v in variants if v["wrong"]]
    margins = [(m, name) for v in variants for name, m in v["claims"].items()]
    worst = max(margins, default=None)
    text = f"{percent(worst[0])} `{worst[1]}`" if worst else "nothing claimed"
    if not broken:
        return text
    count = f", {len(broken)} of {len(variants)}" if len(variants) > 1 else ""
    kinds = {w.split(":")[0] if ":" in w.split("`")[0] else "lost particles" for v in broken for w in v["wrong"] if not w.startswith("`")}
    if kinds:
        text = ", ".join(sorted(kinds)) + (f"; {text}" if worst else "")
    return f"**{text}{count}**"


def decks(results, plan, options):
    """The section of the decks, and how many variants broke."""
    groups = options.variants
    rows, broken, left, without = [], [], {}, []
    judged = runs = 0
    for name, variants in sorted(results.items()):
        cells, mach = [], 0.0
        for group in groups:
            of_group = [v for v in variants.values() if v["group"] == group]
            cells.append(cell(of_group))
        for variant, v in variants.items():
            if "not_applicable" in v:
                without.append(f"- `{name}`, {variant}: {v['not_applicable']}.")
                continue
            runs += 1
            judged += len(v["claims"])
            mach = max(mach, v["mach"] or 0.0)
            broken += [f"- `{name}`, {variant}: {w}." for w in v["wrong"]]
            for claim, why in v["unjudged"].items():
                left.setdefault((name, claim, why), []).append(v["group"])
        rows.append(f"| `{name}` | " + " | ".join(cells) + f" | {mach:.2g} |")
    bad = sum(1 for vs in results.values() for v in vs.values() if v.get("wrong"))
    command = "share/validation/stability" + (" --full" if options.full else "")
    text = [measured(command, options.sphgeo), ""]
    text += [f"{len(results)} decks, {runs} runs, {judged} claims judged: {runs - bad} runs hold, {bad} do not.", ""]
    text += ["The number is the share of what is allowed that the worst claim takes up: 3 % leaves a wide margin, more than 100 % is missed.",
             "A claim of how close a value stays to a reference counts its error against the tolerance; one of a bound counts how far the value",
             "went from where it started towards the bound; one that starts beyond the bound, how far it has to go against how far it went.",
             "Also required: the run ends by itself, no particle is lost, no particle is faster than sound. Jitter moves every particle by up to a",
             "tenth of a spacing in each direction. Turned: by 17 degrees in the x-z plane, gravity too, so that no wall and no surface lies along the lattice.", ""]
    text += ["| deck | " + " | ".join(TITLES[g] for g in groups) + " | largest Mach number |", "|---" * (len(groups) + 2) + "|"] + rows + [""]
    if broken:
        text += ["Missed claims:", ""] + broken + [""]
    if without:
        text += ["Variants that a deck does not have:", ""] + without + [""]
    if left:
        text += ["Claims that do not apply to a variant:", ""]
        text += [f"- `{n}`, `{c}`, {', '.join(sorted(set(g)))}: {why}." for (n, c, why), g in sorted(left.items())] + [""]
    if not options.full:
        text += ["Shorter or coarser than shipped: " + "; ".join(f"`{n}` with {', '.join(f'`{o}`' for o in os)}" for n, os in plan["short"].items() if n in results)
                 + ". Half the spacing: `resolution` is set, except " +
                 "; ".join(f"`{n}` with {', '.join(f'`{o}`' for o in e['options'])} ({e['because']})" for n, e in plan["fine"].items() if n in results) + ".", ""]
    return "\n".join(text), bad


def sweeps(results, plan, options):
    text = [measured("share/validation/stability --sweeps", options.sphgeo), "",
            "One number of a deck is varied. Margins as above; the worst claim of each run.", ""]
    for name, points in results.items():
        sweep = plan["sweeps"][name]
        text += [f"### {sweep['title']}", "", f"`{sweep['deck']}`" + (f" with {', '.join(f'`{o}`' for o in sweep['options'])}" if sweep.get("options") else "") +
                 f", `{sweep['key']}`" +
                 (f". Not judged: {', '.join(f'`{c}`' for c in sweep['skip'])}, as {sweep['because']}" if sweep.get("skip") else "") + ".", ""]
        text += ["| " + sweep["quantity"] + " | " + " | ".join(str(p["value"]) for p in points) + " |", "|---" * (len(points) + 1) + "|",
                 "| worst claim | " + " | ".join(cell([p]) for p in points) + " |", ""]
        wrong = [f"- {p['value']}: {w}" for p in points for w in p["wrong"]]
        text += wrong + [""] if wrong else []
    return "\n".join(text)


def write(page, section, text):
    """Replaces one section of the page and keeps the other."""
    parts = {"Decks": "", "Sweeps": ""}
    if page.is_file():
        current = None
        for line in page.read_text(encoding="utf-8").splitlines():
            if line.startswith("## ") and line[3:] in parts:
                current = line[3:]
            elif current:
                parts[current] += line + "\n"
    # Places in decks are told from the project's folder or that of the runs.
    parts[section] = re.sub(r"/[^\s(`]*/(?=\w+/(?:turned|mirrored)\.yaml)", "", text.replace(f"{ROOT}/", ""))
    body = "\n".join(f"## {name}\n\n{parts[name].strip()}\n" for name in parts if parts[name].strip())
    page.write_text(PREFACE + "\n" + body, encoding="utf-8")

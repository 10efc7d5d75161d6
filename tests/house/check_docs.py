#!/usr/bin/env python3
"""Every command and option that README.md and the manual pages name is one that the program has, and
every command and option that the program has is in a manual page. Every probe and every reduction has a row in
share/doc/probes.md that names a test, and the tests that it names exist.

    check_docs.py SPHGEO
"""
import json
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
OPTION = re.compile(r"(?<![\w-])--?[a-zA-Z][\w-]*")
# "share/setup CMD" hands the words on to sphgeo; "test" and ctest's options are its own.
CALL = re.compile(r"(?<![\w/-])(?:sphgeo|(?:build/\w+/)sphgeo|share/setup) +([a-z]\w*)((?: +[^\s`|;&>]+)*)")
COMMON = {"-h", "--help"}


def plain(roff):
    """Text of a manual page without its macros and escapes."""
    lines = [re.sub(r"^\.(?:[A-Z]{1,2}) ?", "", l) for l in roff.splitlines() if not l.startswith('.\\"')]
    return "\n".join(lines).replace("\\-", "-").replace("\\&", "").replace('"', " ")


def code_of(markdown):
    """What stands in code blocks and between backticks, a line each."""
    blocks = re.findall(r"```\w*\n(.*?)```", markdown, re.DOTALL)
    rest = re.sub(r"```.*?```", "", markdown, flags=re.DOTALL)
    return "\n".join(blocks + re.findall(r"`([^`\n]+)`", rest))


def help_of(sphgeo, *words):
    return subprocess.run([sphgeo, *words, "--help"], capture_output=True, text=True, check=True).stdout


def options_in(text):
    return set(OPTION.findall(text))


def offered(sphgeo):
    """{command: its options}; "" stands for the program itself."""
    top = help_of(sphgeo)
    commands = re.findall(r"^  (\w+) ", top.split("Subcommands:")[1], re.MULTILINE)
    head = {"": options_in("\n".join(re.findall(r"^  (-\S+)", top, re.MULTILINE)))}
    for command in commands:
        flags = re.findall(r"^  (-\S+)", help_of(sphgeo, command), re.MULTILINE)
        head[command] = options_in(" ".join(f.replace(",", " ") for f in flags))
    return head


def check_calls(name, text, known):
    """Calls written out in a text: `sphgeo run DECK -o DIR`."""
    for line in text.splitlines():
        for command, words in CALL.findall(line):
            if command == "test" and "share/setup test" in line:
                continue
            if command not in known:
                yield f"{name}: there is no command '{command}': {line.strip()}"
                continue
            for option in options_in(words) - known[command] - COMMON:
                yield f"{name}: 'sphgeo {command}' has no option '{option}': {line.strip()}"


def check_pages(known):
    """Each option of a page is one of its command, and each option of a command is in its page."""
    overview = plain((ROOT / "man" / "sphgeo.1").read_text())
    described = set(re.findall(r"(?m)^(\w+)(?: .*)?$", overview.split("COMMANDS")[1].split("OPTIONS")[0]))
    for command, options in known.items():
        page = ROOT / "man" / (f"sphgeo-{command}.1" if command else "sphgeo.1")
        if command and command not in described:
            yield f"man/sphgeo.1: the command '{command}' is not described"
        if not page.is_file():
            yield f"{page.relative_to(ROOT)}: there is no such page"
            continue
        text = plain(page.read_text())
        for option in sorted(options - COMMON):
            if option not in options_in(text):
                yield f"{page.relative_to(ROOT)}: the option '{option}' is not described"
    for page in sorted((ROOT / "man").glob("sphgeo-*.1")):
        command = page.stem.split("-", 1)[1]
        if command not in known:
            yield f"man/{page.name}: there is no command '{command}'"
            continue
        used = plain(page.read_text()).split("OPTIONS")[-1].split("EXAMPLES")[0]
        for option in sorted(options_in(used) - known[command] - COMMON):
            yield f"man/{page.name}: there is no option '{option}'"


def check_paths(name, text):
    """Decks that an example names exist."""
    for path in re.findall(r"\bdecks/[\w/]+\.yaml", text):
        if not (ROOT / path).is_file():
            yield f"{name}: there is no {path}"


def check_readme_table(text, known):
    """The README's rows name options of a command beside it."""
    for row in re.findall(r"(?m)^\| *`sphgeo (\w+).*$", text):
        if row not in known:
            yield f"README.md: there is no command '{row}'"
    for command, row in re.findall(r"(?m)^\| *`sphgeo (\w+)([^\n]*)$", text):
        for option in options_in(" ".join(re.findall(r"`([^`]*)`", row))) - known.get(command, set()):
            yield f"README.md: 'sphgeo {command}' has no option '{option}'"


def rows_of(markdown):
    """{name: its row} of the tables whose first cells are names between backticks."""
    return {name: row for row in re.findall(r"(?m)^\|.*$", markdown) for name in re.findall(r"`(\w+)`", row.split("|")[1])}


def reductions(sphgeo):
    schema = json.loads(subprocess.run([sphgeo, "schema"], capture_output=True, text=True, check=True).stdout)
    return schema["properties"]["expect"]["items"]["properties"]["reduce"]["enum"]


def check_probes(sphgeo):
    """The table of probes is whole, and its proofs are tests."""
    page = "share/doc/probes.md"
    rows = rows_of((ROOT / page).read_text())
    listed = subprocess.run([sphgeo, "list"], capture_output=True, text=True, check=True).stdout
    probes = re.findall(r"(?m)^  (\w+) ", listed.split("\nprobes:\n")[1].split("\n\n")[0])
    for name in probes + reductions(sphgeo):
        if name not in rows:
            yield f"{page}: there is no row for '{name}'"
            continue
        proofs = re.findall(r"`(tests/[\w/]+\.cpp)`(?:: ([^;|]+))?", rows[name])
        if not proofs:
            yield f"{page}: the row of '{name}' names no test"
        for file, case in proofs:
            text = (ROOT / file).read_text() if (ROOT / file).is_file() else ""
            # A title that is too long for a line is two pieces in the source.
            titles = re.sub(r'"\s*"', "", text)
            if not text or (case and f'"{case.strip()}' not in titles):
                yield f"{page}: the row of '{name}' names a test that does not exist: {file} {case}"
    for name in rows:
        if name not in probes and name not in reductions(sphgeo):
            yield f"{page}: there is no probe or reduction '{name}'"


def findings(sphgeo):
    known = offered(sphgeo)
    readme = (ROOT / "README.md").read_text()
    yield from check_calls("README.md", code_of(readme), known)
    yield from check_readme_table(readme, known)
    yield from check_paths("README.md", readme)
    results = (ROOT / "share" / "validation" / "README.md").read_text()
    yield from check_calls("share/validation/README.md", code_of(results), known)
    yield from check_paths("share/validation/README.md", results)
    for page in sorted((ROOT / "man").glob("*.1")):
        text = plain(page.read_text())
        if "EXAMPLES" in text:
            yield from check_calls(f"man/{page.name}", text.split("EXAMPLES")[1].split("EXIT")[0], known)
        yield from check_paths(f"man/{page.name}", text)
    yield from check_pages(known)
    yield from check_probes(sphgeo)


def main():
    found = sorted(set(findings(sys.argv[1])))
    for finding in found:
        print(finding)
    print(f"docs: {len(found)} wrong")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

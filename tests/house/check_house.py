#!/usr/bin/env python3
"""Checks the rules of the house that a compiler does not: which room may include which, file lengths,
and names. Prints each breach as file:line: sentence; exit 1 when there is one.

    check_house.py PROJECT_ROOT
"""
import re
import sys
from pathlib import Path

# Lowest first; the rooms of one tuple are neighbours.
ROOMS = [("core",), ("deck",), ("particles",), ("sph",), ("geometry", "materials"),
         ("boundaries", "effects", "probes"), ("scene",), ("plan",), ("solve", "output"),
         ("run",), ("relax", "study", "report", "compare"), ("cli",)]
LEVEL = {room: level for level, rooms in enumerate(ROOMS) for room in rooms}
# Rooms that run a scene and have no business with the deck.
MODEL_FREE = ("particles", "sph", "effects", "plan")
MAX_LINES = 400
MAX_COLUMNS = 100
# Rooms where things are added, one file each, named after the type it registers.
PLUGIN_ROOMS = ("geometry", "materials", "boundaries", "effects", "probes")

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"')
# A type is registered under a name; an effect's name is the first word of its info().
REGISTERS = re.compile(r"^\s*(?:static |inline )*const(?:expr)? Register\w*\s*<", re.MULTILINE)
REGISTERED = re.compile(r'\bRegister\w*\s*<[^;"]*>\s*\w*\s*[({]\s*"([^"]+)"'
                        r'|\bEffectInfo\s+info\(\)\s*\{\s*return\s*(?:EffectInfo\s*)?\{\s*"([^"]+)"')
# Writing to a standard stream, or ending the program.
PRINTS = re.compile(r"\bstd::(?:cout|cerr|clog|exit|quick_exit|abort|terminate)\b"
                    r"|(?<![\w.>:])(?:std::)?(?:printf|puts|exit|_exit)\s*\(")
UNFINISHED = re.compile(r"\b(" + "|".join(["TO" + "DO", "FIX" + "ME", "X" * 3, "HA" + "CK"]) + r")\b")


def lines_of(path):
    return path.read_text(encoding="utf-8").splitlines()


def code_files(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in (".h", ".cpp"))


def check_includes(root):
    """Rooms include downwards, neighbours only without a cycle; paths are rooted at src/."""
    src = root / "src"
    sideways = {}  # (from, to) -> the place where it was first seen
    for path in code_files(src):
        parts = path.relative_to(src).parts
        if len(parts) == 1:
            if path.name != "main.cpp":
                yield f"{path}:1: a file in no room"
            continue
        room = parts[0]
        if room not in LEVEL:
            yield f"{path}:1: '{room}' is no room of the house"
            continue
        for number, line in enumerate(lines_of(path), 1):
            found = INCLUDE.match(line)
            if not found:
                continue
            target = found.group(1)
            if not (src / target).is_file():
                yield f'{path}:{number}: "{target}" is no file below src/'
                continue
            other = target.split("/")[0]
            if other == room or other not in LEVEL:
                continue
            if LEVEL[other] > LEVEL[room]:
                yield f"{path}:{number}: {room} must not include the higher room {other}"
            elif LEVEL[other] == LEVEL[room]:
                sideways.setdefault((room, other), f"{path}:{number}")
    for (room, other), place in sorted(sideways.items()):
        if reaches(sideways, other, room):
            yield f"{place}: {room} and {other} include each other"


def reaches(edges, start, goal):
    """True when a chain of edges leads from start to goal."""
    seen, todo = set(), [start]
    while todo:
        room = todo.pop()
        if room == goal:
            return True
        if room not in seen:
            seen.add(room)
            todo += [b for a, b in edges if a == room]
    return False


def check_model(root):
    """What runs does not see the deck's model, by no chain of includes: it reads the parameters."""
    src = root / "src"
    includes = {}
    for path in code_files(src):
        found = (INCLUDE.match(line) for line in lines_of(path))
        includes[path.relative_to(src).as_posix()] = [f.group(1) for f in found if f]
    for name in sorted(includes):
        if name.split("/")[0] in MODEL_FREE and "deck/model.h" in chain_from(includes, name):
            yield f"{src / name}:1: includes the model; what it needs belongs in sph/parameters.h"


def chain_from(includes, name):
    """All files that one includes, directly or not."""
    seen, todo = set(), [name]
    while todo:
        for other in includes.get(todo.pop(), []):
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return seen


def check_texts(root):
    """Length, macros, `using namespace`, include guards and words that mark an unfinished part."""
    for folder in (root / "src", root / "tests"):
        for path in code_files(folder):
            lines = lines_of(path)
            header = path.suffix == ".h"
            if len(lines) > MAX_LINES:
                yield f"{path}:{len(lines)}: longer than {MAX_LINES} lines"
            if header and "#pragma once" not in lines:
                yield f"{path}:1: a header without #pragma once"
            for number, line in enumerate(lines, 1):
                if len(line) > MAX_COLUMNS:
                    yield f"{path}:{number}: wider than {MAX_COLUMNS} columns"
                if header and re.match(r"\s*using\s+namespace\b", line):
                    yield f"{path}:{number}: using namespace in a header"
                if folder.name == "src" and re.match(r"\s*#\s*define\b", line):
                    yield f"{path}:{number}: a macro"
                if UNFINISHED.search(line):
                    yield f"{path}:{number}: a word that marks an unfinished part"


def check_prints(root):
    """Only cli/ prints and ends the program: the other rooms return, throw, or tell an observer."""
    src = root / "src"
    for path in code_files(src):
        room = path.relative_to(src).parts[0]
        if room in ("cli", "main.cpp"):
            continue
        for number, line in enumerate(lines_of(path), 1):
            if PRINTS.search(line.split("//")[0]):
                yield f"{path}:{number}: only cli/ prints and ends the program"


def check_names(root):
    """A file that registers a type carries its name: one name everywhere."""
    for room in PLUGIN_ROOMS:
        for path in code_files(root / "src" / room):
            text = path.read_text(encoding="utf-8")
            names = {a or b for a, b in REGISTERED.findall(text)}
            if REGISTERS.search(text) and path.stem not in names:
                yield f"{path}:1: registers {', '.join(sorted(names)) or 'something'} but is not named so"


def check_types(root):
    """No two headers define a type of one name: all stand in the namespace sphgeo, and linkers take either for both."""
    first = {}
    for path in code_files(root / "src"):
        if path.suffix != ".h":
            continue
        for number, line in enumerate(lines_of(path), 1):
            found = re.match(r"(?:struct|class|enum(?: class)?)\s+(\w+)\b[^;]*(?:\{|$)", line)
            if not found:
                continue
            place = first.setdefault(found.group(1), path)
            if place != path:
                yield f"{path}:{number}: '{found.group(1)}' is a type of {place.relative_to(root)}, too"


def check_tests(root):
    """tests/<room>/test_*.cpp holds TEST_SUITE("<room>"), so that the room's ctest entry runs it."""
    for path in sorted((root / "tests").glob("*/test_*.cpp")):
        suites = re.findall(r'TEST_SUITE(?:_BEGIN)?\s*\(\s*"([^"]*)"', path.read_text(encoding="utf-8"))
        if suites != [path.parent.name]:
            yield f'{path}:1: wants one TEST_SUITE("{path.parent.name}"), has {suites}'


def findings(root):
    for check in (check_includes, check_model, check_texts, check_prints, check_names, check_types,
                  check_tests):
        yield from check(root)


def main():
    root = Path(sys.argv[1])
    if not code_files(root / "src"):
        print(f"{root}: no sources below src/")
        return 1
    found = list(findings(root))
    for finding in found:
        print(finding)
    print(f"house: {len(code_files(root / 'src'))} files, {len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

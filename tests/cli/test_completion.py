#!/usr/bin/env python3
"""The completions of share/completion offer every command and option of `--help`, and nothing else.

    test_completion.py SPHGEO
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SPHGEO = None
ROOT = Path(__file__).resolve().parents[2]
BASH = ROOT / "share" / "completion" / "sphgeo.bash"
ZSH = ROOT / "share" / "completion" / "_sphgeo"


def help_of(*words):
    return subprocess.run([SPHGEO, *words, "--help"], capture_output=True, text=True, check=True).stdout


def commands():
    return re.findall(r"^  (\w+) ", help_of().split("Subcommands:")[1], re.MULTILINE)


def options(*words):
    found = set()
    for flags in re.findall(r"^  (-\S+)", help_of(*words), re.MULTILINE):
        found |= set(flags.split(","))
    return found


def complete(*words, folder=None):
    """What bash offers after these words; the last one is being typed."""
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _sphgeo; printf "%s\\n" "${COMPREPLY[@]}"'
    done = subprocess.run(["bash", "-c", script, "bash", str(BASH), SPHGEO, *words], capture_output=True, text=True,
                          cwd=folder, check=True, env={**os.environ, "LC_ALL": "C"})
    return {line.rstrip("/ ") for line in done.stdout.splitlines() if line}


class Completion(unittest.TestCase):
    def test_bash_commands(self):
        self.assertEqual({w for w in complete("") if not w.startswith("-")}, set(commands()))
        self.assertEqual({w for w in complete("-")}, options())
        self.assertEqual(complete("ru"), {"run"})

    def test_bash_options(self):
        for command in commands():
            self.assertEqual(complete(command, "-"), options(command), command)

    def test_bash_arguments(self):
        self.assertIn("numerics", complete("show", "num"))
        self.assertIn("box", complete("show", ""))
        self.assertEqual(complete("bench", "--precision", "s"), {"single"})
        scenes = set(re.findall(r'\{"(\w[\w.]*)", (?:\[\]|dam_break)', (ROOT / "src" / "cli" / "bench.cpp").read_text()))
        self.assertEqual(complete("bench", "--scene", ""), scenes)
        with tempfile.TemporaryDirectory() as folder:
            for name in ("deck.yaml", "notes.txt"):
                (Path(folder) / name).write_text("")
            (Path(folder) / "decks").mkdir()
            self.assertEqual(complete("run", "", folder=folder), {"deck.yaml", "decks"})
            self.assertEqual(complete("run", "-o", "", folder=folder), {"decks"})

    def test_zsh(self):
        text = ZSH.read_text()
        listed = set(re.findall(r"(?m)^    '([a-z]+):", text))
        self.assertEqual(listed, set(commands()))
        branches = {}
        for names, body in re.findall(r"(?ms)^    ([a-z |]+)\)\n(.*?);;", text):
            for name in names.split("|"):
                branches[name.strip()] = body
        for command in commands():
            body = branches.get(command, "").replace("$deck", text.split("deck=(")[1].split(")\n")[0])
            offered = set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", re.sub(r":_files -\S+|\[[^]]*\]|'\([^)]*\)'?", " ", body)))
            self.assertEqual(offered, options(command), command)


if __name__ == "__main__":
    SPHGEO = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=0)

"""Calls of the program under test. A script's first argument names it; `main` takes that and runs the tests."""
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# A drop of 16 particles that falls for a step or two.
DECK = """\
dimension: 2
resolution: 0.1 m
end_time: 1 ms
materials: [{name: water, type: water, sound_speed: 10}]
bodies: [{name: drop, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 1, 0.4]}}]
"""


# A program that takes longer hangs, s: none takes a hundredth of that on a machine of its own.
HANGS = 1200


class ProgramTest(unittest.TestCase):
    """Each test calls the program in a folder of its own."""
    sphgeo = None

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="sphgeo test ")
        self.addCleanup(temporary.cleanup)
        self.here = Path(temporary.name)

    def write(self, name, text):
        path = self.here / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return name

    def call(self, *words, **options):
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "timeout": HANGS, "cwd": self.here, **options}
        env = {**os.environ, "NO_COLOR": "1", **options.pop("env", {})}
        return subprocess.run([self.sphgeo, *words], env=env, **options)

    def accepted(self, *words, **options):
        done = self.call(*words, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done


def main():
    ProgramTest.sphgeo = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=0)

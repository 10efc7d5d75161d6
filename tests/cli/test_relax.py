#!/usr/bin/env python3
"""`sphgeo relax`: what it writes, that a run takes it, and that another deck does not.

    test_relax.py SPHGEO
"""
import csv
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import DECK, ProgramTest, main  # noqa: E402

BED = """\
dimension: 2
resolution: 0.05
end_time: 1 ms
materials:
  - {name: water, type: water, sound_speed: 10}
  - {name: sand, type: soil, density: 2650, volume_fraction: 0.6, youngs_modulus: 1e7, friction_angle: 30 deg, skeleton: fixed}
bodies:
  - {name: sea, material: water, shape: {type: box, min: [0, 0, 0], max: [1, 1, 1]}}
  - {name: bed, material: sand, shape: {type: box, min: [0, 0, 0], max: [1, 1, 0.5]}}
relaxation: {steps: 30}
expect:
  - {name: spread, probe: relaxation.density_spread, measure: below, tolerance: 0.03}
  - {name: mass, probe: relaxation.mass_error, reference: 0, tolerance: 1, tolerance_kind: absolute}
"""


class Relax(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("bed.yaml", BED)

    def call(self, *words):
        return super().call(*words, text=True)

    def summary(self, folder):
        return json.loads((self.here / folder / "summary.json").read_text())

    def test_results(self):
        done = self.accepted("relax", "bed.yaml", "-o", "out", "--verify")
        self.assertIn("water in soil: 280 particles", done.stderr)
        self.assertIn("pass", done.stdout)
        found = self.summary("out")
        self.assertEqual(found["particles"], {"water": 280})  # half clear, half with 0.4 of the room
        self.assertEqual([e["pass"] for e in found["expect"]], [True, True])
        self.assertEqual(found["relaxation"]["steps"], 30)
        rows = [line for line in (self.here / "out/probes/relaxation.csv").read_text().splitlines() if not line.startswith("#")]
        table = list(csv.DictReader(rows))
        self.assertEqual([int(float(r["step"])) for r in table], list(range(31)))
        self.assertLess(float(table[-1]["density_spread"]), 0.03)
        self.assertEqual(len(list((self.here / "out/frames").glob("water_*.vtu"))), 2)
        self.assertEqual(self.call("relax", "bed.yaml", "-o", "out").returncode, 2)
        self.accepted("relax", "bed.yaml", "-o", "out", "--overwrite", "-q")
        missed = self.call("relax", "bed.yaml", "-o", "missed", "--verify", "--set", "expect[0].tolerance=1e-9")
        self.assertEqual(missed.returncode, 4)

    def test_use(self):
        self.accepted("relax", "bed.yaml", "-o", "out", "-q")
        self.accepted("run", "bed.yaml", "-o", "own", "--verify")
        done = self.accepted("run", "bed.yaml", "-o", "given", "--verify", "--set", "relaxation.file=out/relaxed.h5")
        self.assertIn("from ", done.stderr)
        first = [(self.here / run / "frames/water_000000.vtu").read_bytes() for run in ("own", "given")]
        self.assertEqual(first[0], first[1])
        self.assertEqual(self.summary("own")["deck_hash"], self.summary("given")["deck_hash"])
        self.assertEqual(self.summary("own")["expect"], [])

    def test_refused(self):
        self.accepted("relax", "bed.yaml", "-o", "out", "-q")
        for change, says in (("resolution=0.1", "resolution: 0.05 there, 0.1 here"),
                             ("materials[1].volume_fraction=0.5", "soil[0].volume_fraction: 0.6 there, 0.5 here"),
                             ("relaxation.seed=2", "relaxation.seed: 1 there, 2 here")):
            done = self.call("run", "bed.yaml", "-o", "run", "--set", "relaxation.file=out/relaxed.h5", "--set", change)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("E132", done.stderr)
            self.assertIn(says, done.stderr)
        data = bytearray((self.here / "out/relaxed.h5").read_bytes())
        data[len(data) // 2] ^= 1
        self.write("flipped.h5", bytes(data))
        done = self.call("check", "bed.yaml", "--set", "relaxation.file=flipped.h5")
        self.assertEqual(done.returncode, 2)
        self.assertIn("the stored water is damaged: its checksum does not fit", done.stderr)
        self.write("dry.yaml", DECK)
        done = self.call("relax", "dry.yaml", "-o", "none")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is nothing to relax", done.stderr)
        self.assertFalse((self.here / "none").exists())
        done = self.call("check", "bed.yaml", "--set", "bodies[1].volume_fraction=0.99")
        self.assertEqual(done.returncode, 2)
        self.assertIn("E131", done.stderr)

    def test_check_counts(self):
        self.assertIn("body 'sea': 280", self.accepted("check", "bed.yaml", "--no-calibrate").stdout)


if __name__ == "__main__":
    main()

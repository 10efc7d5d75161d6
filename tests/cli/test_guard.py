#!/usr/bin/env python3
"""Runs that become unstable, each by another cause: exit 3, one sentence that says what and where, a last frame that shows it,
and a checkpoint from before, from which the run comes to the same end.

    test_guard.py SPHGEO
"""
import json
import re
import shutil
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import ProgramTest, main  # noqa: E402

POOL = """\
dimension: 2
resolution: 0.05 m
gravity: 9.81
end_time: 1 s
output: {checkpoint_every: 0}
materials:
  - {name: water, type: water, sound_speed: 20}
  - {name: sand, type: soil, density: 2600, volume_fraction: 0.6, youngs_modulus: 1 MPa, friction_angle: 30 deg}
bodies: [{name: body, material: MATERIAL, shape: {type: box, min: [0, 0, 0], max: [0.5, 1, 0.5]}}]
boundaries:
  - {name: tank, type: tank, min: [0, 0, 0], max: [1, 1, 1], open: [OPEN]}
"""


class Guard(ProgramTest):
    def unstable(self, cause, *settings, material="water", open_face="top", more=""):
        """Runs the pool until the guard stops it; the summary's part about the guard."""
        shutil.rmtree(self.here / "run", ignore_errors=True)
        self.write("deck.yaml", POOL.replace("MATERIAL", material).replace("OPEN", open_face) + more)
        words = [w for s in settings for w in ("--set", s)]
        done = self.call("run", "deck.yaml", "-q", "--threads", "1", "-o", "run", *words)
        said = done.stderr.decode()
        self.assertEqual(done.returncode, 3, said)
        summary = json.loads((self.here / "run/summary.json").read_text())
        guard = summary["guard"]
        self.assertEqual(summary["status"], "unstable")
        self.assertTrue(guard["tripped"])
        self.assertEqual(guard["cause"], cause, said)
        self.assertIn(guard["reason"], said)
        self.assertGreaterEqual(summary["steps"]["advection"], 1)
        self.check_last_frame(guard)
        self.check_checkpoint(guard, words)
        return guard

    def check_last_frame(self, guard):
        """The last frame of every set is of the moment when the run was stopped, and the program can read it."""
        pvds = sorted((self.here / "run/frames").glob("*.pvd"))
        self.assertTrue(pvds)
        for pvd in pvds:
            last = list(xml.parse(pvd).iter("DataSet"))[-1]
            self.assertAlmostEqual(float(last.get("timestep")), guard["time_s"], delta=1e-6 + 1e-3 * guard["time_s"])
            frame = pvd.parent / last.get("file")
            head = frame.read_bytes()[:4000]
            self.assertIn(b"VTKFile", head)
            self.assertTrue(frame.read_bytes().rstrip().endswith(b"</VTKFile>"), frame)
            self.assertTrue(re.search(rb'NumberOfPoints="\d+"', head))
        # Frames are read when runs are compared. A run is the same as itself, but what is no number is the same as nothing.
        self.assertEqual(self.call("compare", "run", "run").returncode, 4 if guard["cause"] == "not_finite" else 0)

    def check_checkpoint(self, guard, words):
        """What is kept is of before: from there the same thing happens once more, at the same time."""
        if not (self.here / "run/checkpoint.h5").exists():
            return
        again = self.call("run", "deck.yaml", "-q", "--threads", "1", "-o", "run", "--resume", *words)
        self.assertEqual(again.returncode, 3, again.stderr.decode())
        second = json.loads((self.here / "run/summary.json").read_text())["guard"]
        for key in ("cause", "set", "particle", "position", "time_s"):
            self.assertEqual(second.get(key), guard.get(key), key)

    def test_a_value_that_is_no_number(self):
        for material in ("water", "sand"):
            with self.subTest(material):
                guard = self.unstable("not_finite", "body_force=[sqrt(0.05-t),0,0]", material=material)
                self.assertAlmostEqual(guard["time_s"], 0.05, delta=0.01)
                self.assertIn("body_force is not finite there", guard["reason"])

    def test_faster_than_sound(self):
        guard = self.unstable("speed", "body_force=[4000*t,0,0]", "materials[0].sound_speed=8", "numerics.density_bound=0.9")
        self.assertEqual(guard["set"], "water")
        self.assertIn("times its speed of sound", guard["reason"])

    def test_a_density_out_of_bounds(self):
        guard = self.unstable("density", "numerics.density_bound=0.02", "body_force=[0,0,-30*t*20]")
        self.assertIn("density", guard["reason"])

    def test_lost_particles(self):
        for material in ("water", "sand"):
            with self.subTest(material):
                guard = self.unstable("lost", "numerics.domain_min=[-1,-1,-0.1]", material=material, open_face="bottom")
                self.assertIn("look for a hole in the boundaries", guard["reason"])

    def test_a_thin_wall_swept_through(self):
        sweep = ("  - {name: blade, type: wall, shape: {type: box, min: [0.55, 0, 0.1], max: [0.6, 1, 1]}, "
                 "motion: {displacement: [-3*t, 0, 0]}}\n")
        for material in ("water", "sand"):
            with self.subTest(material):
                guard = self.unstable("penetration", "numerics.density_bound=0.9", "numerics.domain_min=[-5,-1,-1]", material=material, more=sweep)
                self.assertIn("sit inside a wall", guard["reason"])


if __name__ == "__main__":
    main()

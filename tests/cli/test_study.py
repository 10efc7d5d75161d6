#!/usr/bin/env python3
"""`sphgeo study` and `sphgeo compare` from the outside.

    test_study.py SPHGEO
"""
import json
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import HANGS, ProgramTest, main  # noqa: E402

# A block of water that falls for a while: its speed has a closed form.
FALL = """\
title: Fall
dimension: 2
resolution: 0.1 m
end_time: 0.1 s
variables: {g: 10}
gravity: g
materials: [{name: water, type: water, sound_speed: 20}]
bodies: [{name: drop, material: water, shape: {type: box, min: [0, 0, 0], max: [0.8, 1, 0.8]}}]
probes:
  - {name: amount, type: amount}
  - {name: energy, type: energy}
expect:
  - {name: fall_energy, probe: energy.kinetic, reduce: at, at: 0.1, reference: 320, tolerance: 0.1, source: m g^2 t^2 / 2}
  - {name: kept, probe: amount.count, reduce: range, tolerance: 0, measure: below, source: nothing is lost}
"""


class Study(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("fall.yaml", FALL)

    def study(self, *words, expected=0):
        done = self.call("study", "fall.yaml", "-o", "out", *words)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done

    def json(self):
        return json.loads((self.here / "out" / "study.json").read_text())

    def test_ladder(self):
        done = self.study("--vary", "resolution=0.1,0.2,0.4")
        study = self.json()
        self.assertEqual([r["status"] for r in study["runs"]], ["done"] * 3)
        energy = next(r for r in study["results"] if r["name"] == "fall_energy")
        self.assertEqual([l["resolution"] for l in energy["levels"]], [0.4, 0.2, 0.1])  # coarsest first
        for level in energy["levels"]:
            summary = json.loads((self.here / "out" / level["folder"] / "summary.json").read_text())
            measured = next(e for e in summary["expect"] if e["name"] == "fall_energy")
            self.assertEqual(level["value"], measured["value"])
            self.assertEqual(level["error"], measured["error"])
            self.assertEqual(level["wall_s"], summary["wall_s"])
        for key in ("order", "gci", "label", "richardson", "sentence", "reference"):
            self.assertIn(key, energy)
        self.assertIn(energy["label"], ("monotone", "oscillatory", "not in the asymptotic range", "unchanged"))
        self.assertIn(energy["sentence"].encode(), done.stdout)

    def test_runs_are_used_again_when_nothing_has_changed(self):
        self.study("--vary", "resolution=0.2,0.4")
        stamps = {p: p.stat().st_mtime_ns for p in (self.here / "out" / "runs").glob("*/summary.json")}
        again = self.study("--vary", "resolution=0.1,0.2,0.4")
        self.assertEqual(again.stderr.count(b"used again"), 2, again.stderr)
        for path, stamp in stamps.items():
            self.assertEqual(path.stat().st_mtime_ns, stamp)
        self.write("fall.yaml", FALL.replace("at: 0.1,", "at: 0.05,").replace("320", "80"))
        changed = self.study("--vary", "resolution=0.2,0.4")
        self.assertNotIn(b"used again", changed.stderr)
        self.assertEqual(len(list((self.here / "out" / "runs").glob("*/summary.json"))), 5)

    def test_several_keys(self):
        self.study("--vary", "resolution=0.2,0.4", "--vary", "g=5,10")
        self.assertEqual(len(self.json()["runs"]), 4)
        self.assertEqual([r["key"] for r in self.json()["results"]], ["resolution", "g"] * 2)
        self.study("--vary", "resolution=0.2,0.4", "--vary", "g=5,10", "--combine", "--jobs", "2")
        curves = [r for r in self.json()["results"] if r["name"] == "kept"]
        self.assertEqual([r["settings"] for r in curves], [{"g": 5}, {"g": 10}])

    def test_mistakes_come_before_the_first_run(self):
        for vary, sentence in (("resolutoin=0.1", b"resolutoin"), ("resolution=0.4,-1", b"-1"), ("resolution", b"KEY=VALUE"), ("resolution=0.4,0.4", b"twice")):
            done = self.study("--vary", vary, expected=2)
            self.assertIn(sentence, done.stderr)
        self.assertFalse((self.here / "out" / "study.json").exists())
        self.write("fall.yaml", FALL.split("expect:")[0])
        self.assertIn(b"expect", self.study("--vary", "g=1,2", expected=2).stderr)

    def test_a_stopped_study_goes_on(self):
        words = [self.sphgeo, "study", "fall.yaml", "-o", "out", "--vary", "resolution=0.4,0.02"]
        process = subprocess.Popen(words, cwd=self.here, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        while process.poll() is None and not list((self.here / "out" / "runs").glob("*0.02*/run.csv")):
            time.sleep(0.02)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=HANGS)
        if process.returncode == 0:
            self.skipTest("the study was at its end before this test could stop it")
        self.assertEqual(process.returncode, 6, said)
        self.assertEqual([r["status"] for r in self.json()["runs"]], ["done", "stopped"])
        self.study("--vary", "resolution=0.4,0.02")
        self.assertEqual([r["status"] for r in self.json()["runs"]], ["done", "done"])

    def test_an_unstable_run_is_told_and_the_others_count(self):
        done = self.study("--vary", "numerics.cfl_acoustic=0.4,0.2", "--set", "g=4000", expected=3)
        self.assertIn(b"unstable", done.stdout)

    def test_what_cannot_be_measured_is_said(self):
        """A result that some runs do not have, and one that none has, are in the tables, with the reason."""
        self.write("some.yaml", FALL + """\
  - {name: early, probe: PROBE, reduce: at, at: 0.05, measure: below, tolerance: 1e9}
  - {name: never, probe: PROBE, reduce: at, at: 1e3, measure: below, tolerance: 1e9}
""".replace("PROBE", "energy.total"))
        done = self.call("study", "some.yaml", "-o", "s", "-q", "--vary", "end_time=0.02,0.1")
        text = done.stdout.decode()
        self.assertIn("left out: 0.02:", text, done.stderr)
        never = text[text.index("\nnever"):]
        self.assertIn("no run has a value of it", never)
        self.assertEqual(never.count("left out:"), 2)
        # Twice the last one, and the short run lacks the other two that ask for later times.
        page = (self.here / "s/study.html").read_text()
        self.assertEqual(page.count("left out: "), 4)


class Compare(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("fall.yaml", FALL)
        for name, more in (("a", []), ("b", []), ("c", ["--set", "g=10.2"])):
            self.accepted("run", "fall.yaml", "-o", name, "-q", "--set", "resolution=0.2", *more)

    def compare(self, *words, expected=0):
        done = self.call("compare", *words)
        self.assertEqual(done.returncode, expected, done.stderr)
        return done.stdout.decode()

    def test_equal_runs(self):
        result = json.loads(self.compare("a", "b", "--json"))
        self.assertTrue(result["pass"])
        self.assertEqual({d["difference"] for d in result["differences"]}, {0})
        kinds = {d["kind"] for d in result["differences"]}
        self.assertGreaterEqual(kinds, {"status", "steps", "probe", "particles", "positions", "field", "ledger", "result"})

    def test_other_gravity_is_found_and_the_worst_comes_first(self):
        said = self.compare("c", "a", expected=4)
        self.assertIn("probe energy.kinetic", said)
        self.assertIn("FAIL", said.splitlines()[1])
        ratios = [d["difference"] / d["tolerance"] for d in json.loads(self.compare("c", "a", "--json", expected=4))["differences"]
                  if d["difference"] is not None and d["tolerance"]]
        self.assertEqual(ratios, sorted(ratios, reverse=True))

    def test_baseline_and_tolerances(self):
        self.compare("a", "base.json", "--update")
        self.compare("b", "base.json")
        self.compare("c", "base.json", expected=4)
        self.write("wide.yaml", "probes: 1\nfields: 2\nledger: 1\nresults: 1\nsteps: 1\npositions: 1\nrules: [{name: probe energy.total, tolerance: 100}]\n")
        self.compare("c", "base.json", "--tolerances", "wide.yaml")
        self.write("wide.yaml", "probs: 1\n")
        self.compare("c", "base.json", "--tolerances", "wide.yaml", expected=2)

    def test_what_is_no_run(self):
        self.compare("nowhere", "a", expected=5)
        self.compare("a", "nowhere.json", expected=5)
        self.compare("a", "fall.yaml", expected=2)
        self.compare("a", "b", "--update", expected=2)


if __name__ == "__main__":
    main()

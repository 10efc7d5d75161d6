#!/usr/bin/env python3
"""What a run will cost: `check` says it, `run` writes it beside what it did cost, and a scene that the machine
has no memory for is refused before anything is placed.

    test_forecast.py SPHGEO
"""
import json
import resource
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import HANGS  # noqa: E402

SPHGEO = None
ROOT = Path(__file__).resolve().parents[2]
QUICK = str(ROOT / "decks/basics/gate_and_sill.yaml")


def call(*words, memory=None, processor_seconds=None):
    def limit():
        for kind, most in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_CPU, processor_seconds)):
            if most:
                resource.setrlimit(kind, (most, most))
    return subprocess.run([SPHGEO, *words], capture_output=True, text=True, timeout=HANGS, preexec_fn=limit)


def check(*words):
    done = call("check", QUICK, "--json", *words)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)["forecast"]


class Forecast(unittest.TestCase):
    def test_check(self):
        priced, counted = check(), check("--no-calibrate")
        self.assertGreater(priced["wall_s"], 0)
        self.assertIsNone(counted["wall_s"])
        for key in ("particles", "advection_steps", "acoustic_steps", "threads"):
            self.assertEqual(priced[key], counted[key])
        self.assertEqual(check("--no-calibrate", "--threads", "2")["threads"], 2)
        ladder = priced["ladder"]
        self.assertEqual([round(r["resolution"], 4) for r in ladder], [0.02, 0.0141, 0.0071, 0.005])
        for key in ("memory_bytes", "disk_bytes", "acoustic_steps", "wall_s"):
            values = [r[key] for r in ladder]
            values.insert(2, priced[key])
            self.assertEqual(values, sorted(values), key)
        text = call("check", QUICK, "--no-calibrate").stdout
        self.assertIn("time unknown", text)
        self.assertIn("<- this deck", text)

    def test_inlets(self):
        """What inlets bring in is counted, in the memory too, and comes out in the run."""
        rain = str(ROOT / "decks/hard/rain_on_roof.yaml")
        words = ("--set", "end_time=0.5", "--set", "boundaries[1].share=0.5")
        with_rain = json.loads(call("check", rain, "--json", "--no-calibrate", *words).stdout)["forecast"]
        self.assertEqual(with_rain["particles"]["water"], 0)
        # Width 0.8 m, 2 m/s, half a second, half the places, of 1e-4 m2.
        self.assertAlmostEqual(with_rain["entering"], 0.8 * 2 * 0.5 * 0.5 / 1e-4, delta=100)
        self.assertEqual([r["entering"] > s["entering"] for r, s in zip(with_rain["ladder"][1:], with_rain["ladder"])], [True] * 3)
        dry = json.loads(call("check", rain, "--json", "--no-calibrate", *words, "--set", "boundaries[1].share=0.001").stdout)["forecast"]
        self.assertGreater(with_rain["memory_bytes"], dry["memory_bytes"] + 400 * with_rain["entering"])
        self.assertIn("inlets insert about", call("check", rain, "--no-calibrate").stdout)

    def test_ladder(self):
        """The rungs are what the deck itself says at those spacings."""
        for rung in check("--no-calibrate")["ladder"]:
            there = check("--no-calibrate", "--set", f"resolution={rung['resolution']!r}")
            particles = [sum(f["particles"].values()) for f in (rung, there)]
            self.assertLess(abs(particles[0] / particles[1] - 1), 0.03, rung["resolution"])
            for key, most in (("acoustic_steps", 0.03), ("memory_bytes", 0.15), ("disk_bytes", 0.2)):
                self.assertLess(abs(rung[key] / there[key] - 1), most, f"{key} at {rung['resolution']}")

    def test_run(self):
        """All but the time, which depends on what else the machine does."""
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "run"
            done = call("run", QUICK, "-q", "-o", str(out), "--set", "end_time=0.3", "--threads", "1")
            self.assertEqual(done.returncode, 0, done.stderr)
            forecast = json.loads((out / "summary.json").read_text())["forecast"]
            actual = forecast["actual"]
            self.assertEqual(forecast["particles"], actual["particles"])
            for key, most in (("memory_bytes", 0.15), ("advection_steps", 0.15), ("acoustic_steps", 0.15), ("disk_bytes", 0.25)):
                self.assertLess(abs(forecast[key] / actual[key] - 1), most, key)
            self.assertGreater(forecast["wall_s"], 0)
            self.assertGreater(actual["wall_s"], 0)
            there = check("--no-calibrate", "--set", "end_time=0.3", "--threads", "1")
            for key in ("particles", "advection_steps", "acoustic_steps"):
                self.assertEqual(forecast[key], there[key])

    def test_too_large(self):
        for command in (["check", QUICK], ["run", QUICK, "-o", "/nonexistent/run"]):
            for change in (["resolution=2e-6"], ["resolution=2e-6", "dimension=3"]):
                done = call(*command, *(w for c in change for w in ("--set", c)), processor_seconds=10)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertEqual(done.stdout, "")
                # Sizes beyond all reason are refused with the boundary that asks for them, before memory is counted.
                texts = ("E030", "resolution", "particles") if "E030" in done.stderr else (
                    "E145", "resolution", "particles", "are available", "would fit")
                for text in texts:
                    self.assertIn(text, done.stderr)

    def test_the_resolution_that_fits(self):
        """Under a limit of the address space, the offered resolution is taken, and takes most of what there is."""
        limit = 1_000_000_000
        words = ("check", QUICK, "--no-calibrate", "--threads", "1", "--set", "dimension=3", "--set")
        done = call(*words, "resolution=0.002", memory=limit)
        self.assertEqual(done.returncode, 2, done.stderr)
        offered = done.stderr.split("a resolution of ")[1].split(" m ")[0]
        done = call(*words, f"resolution={offered}", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        needed = json.loads(done.stdout)["forecast"]["memory_bytes"]
        self.assertLess(needed, limit)
        self.assertGreater(needed, 0.6 * limit)


if __name__ == "__main__":
    SPHGEO = str(Path(sys.argv.pop(1)).resolve())
    unittest.main(verbosity=0)

#!/usr/bin/env python3
"""A disk that fails: whatever call fails, whatever it says, the run ends with exit 5 and one sentence that
names the file, and leaves no half-written file.

    test_faults.py SPHGEO FAULT_SHIM
"""
import errno
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SPHGEO = SHIM = None
DECK = """\
dimension: 2
resolution: 0.1 m
end_time: 4 ms
materials: [{name: water, type: water, sound_speed: 10}]
bodies: [{name: drop, material: water, shape: {type: box, min: [0, 0, 0], max: [0.4, 1, 0.4]}}]
boundaries: [{name: tank, type: tank, min: [0, 0, 0], max: [0.8, 1, 0.8], open: [top]}]
probes: [{name: energy, type: energy, every: 2 ms}]
output: {frames: {every: 4 ms}, run_every: 2 ms, checkpoint_every: 0}
expect: [{name: kept, probe: energy, reduce: last, reference: 0, tolerance: 1e9, tolerance_kind: absolute}]
"""
# What each kind of call may fail with.
ERRORS = {"open": (errno.EACCES, errno.ENOSPC), "write": (errno.ENOSPC, errno.EIO), "sync": (errno.EIO,),
          "close": (errno.ENOSPC,), "rename": (errno.EACCES,), "mkdir": (errno.EACCES,)}


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="sphgeo faults ö ")
        cls.here = Path(cls.temporary.name)
        (cls.here / "deck.yaml").write_text(DECK)
        cls.log = cls.here / "log"
        cls.good = cls.here / "good"
        done = cls.run_deck(cls.good, log=True)
        assert done.returncode == 0, done.stderr
        lines = cls.log.read_text().splitlines()
        cls.calls = {kind: sum(l.startswith(kind + " ") for l in lines) for kind in ERRORS}
        cls.frames = {p.name: p.read_bytes() for p in (cls.good / "frames").iterdir()}

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def run_deck(cls, folder, *words, fault=None, log=False):
        env = {**os.environ, "LD_PRELOAD": SHIM, "NO_COLOR": "1", "SPHGEO_FAULT_FOLDER": str(folder)}
        if fault:
            env["SPHGEO_FAULT"] = fault
        if log:
            env["SPHGEO_FAULT_LOG"] = str(cls.log)
        return subprocess.run([SPHGEO, "run", "deck.yaml", "-q", "--threads", "1", "-o", str(folder), *words],
                              cwd=cls.here, env=env, capture_output=True, text=True, timeout=1200)

    def check_whole(self, folder):
        """Every file in the folder is whole, and none is temporary."""
        for path in sorted(folder.rglob("*")):
            if path.is_dir():
                continue
            name = str(path.relative_to(folder))
            self.assertFalse(name.endswith(".part"), name)
            data = path.read_bytes()
            if path.suffix == ".vtu":
                self.assertEqual(data, self.frames[path.name], name)
            elif path.suffix == ".pvd":
                self.assertTrue(data.endswith(b"</VTKFile>\n"), name)
            elif path.suffix == ".json":
                json.loads(data)
            elif path.suffix == ".h5":
                mark = b"\nsphgeo checkpoint 5 "
                self.assertTrue(data[-72:].startswith(mark), name)
                self.assertEqual(int(data[-72 + len(mark):][:16], 16), len(data) - 72, name)
            elif path.suffix == ".html":
                self.assertTrue(data.endswith(b"</html>\n"), name)
            elif path.suffix == ".csv":
                text = data.decode()
                self.assertTrue(text == "" or text.endswith("\n"), name)
                table = [l for l in text.splitlines() if not l.startswith("#")]
                self.assertLessEqual(len({l.count(",") for l in table}), 1, name)
            else:
                self.assertEqual(data, (self.good / name).read_bytes(), name)

    def check_refused(self, done, folder, error):
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(os.strerror(error), done.stderr)
        self.check_whole(folder)
        # The page comes after the results: without it they are there none the less.
        only_the_page = done.stderr.startswith(f"warning: there is no report.html: {folder}")
        self.assertTrue(only_the_page or done.stderr.startswith(f"error: {folder}"), done.stderr)
        self.assertEqual((folder / "summary.json").exists(), only_the_page)

    def fails_at(self, kind, n, error, more=""):
        with tempfile.TemporaryDirectory(dir=self.here) as name:
            folder = Path(name) / "run"
            self.log.unlink(missing_ok=True)
            done = self.run_deck(folder, fault=f"{kind}:{n}{more}:{error}", log=True)
            if done.returncode == 0 and sum(l.startswith(kind + " ") for l in self.log.read_text().splitlines()) < n:
                self.assertGreater(n, self.calls[kind] / 2)
                return None  # how many checkpoints there are depends on the clock: this run had fewer calls
            self.check_refused(done, folder, error)
            # What is there suffices to go on.
            done_later = self.run_deck(folder, "--resume")
            self.assertEqual(done_later.returncode, 0, done_later.stderr)
            self.check_whole(folder)
            self.assertEqual({p.name: p.read_bytes() for p in (folder / "frames").iterdir()}, self.frames)
            return done.stderr

    def test_a_sound_run_calls_all_of_them(self):
        for kind in ERRORS:
            self.assertGreater(self.calls[kind], 1, kind)
        self.check_whole(self.good)

    def test_every_write_may_meet_a_full_disk(self):
        for n in range(1, self.calls["write"] + 1):
            with self.subTest(n=n):
                said = self.fails_at("write", n, errno.ENOSPC, "+")
                if said is not None:
                    self.assertRegex(said, r"\d+ bytes")

    def test_every_write_may_fail_once(self):
        # A later flush of a table may succeed, so only the error and the files count.
        for n in range(1, self.calls["write"] + 1):
            with self.subTest(n=n):
                self.fails_at("write", n, errno.EIO)

    def test_every_other_call_may_fail(self):
        for kind, errors in ERRORS.items():
            if kind in ("write", "close"):
                continue
            for error in errors:
                for n in range(1, self.calls[kind] + 1):
                    with self.subTest(kind=kind, n=n, error=error):
                        self.fails_at(kind, n, error)

    def test_a_close_that_fails(self):
        """Network drives tell of a full disk here. Tables have been flushed before: theirs may pass."""
        codes = set()
        for n in range(1, self.calls["close"] + 1):
            with self.subTest(n=n), tempfile.TemporaryDirectory(dir=self.here) as name:
                folder = Path(name) / "run"
                done = self.run_deck(folder, fault=f"close:{n}:{errno.ENOSPC}")
                codes.add(done.returncode)
                if done.returncode != 0:
                    self.check_refused(done, folder, errno.ENOSPC)
                self.check_whole(folder)
        self.assertIn(5, codes)

    def test_short_writes_are_continued(self):
        folder = self.here / "short"
        done = self.run_deck(folder, fault="short:1:0")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.check_whole(folder)
        self.assertEqual({p.name: p.read_bytes() for p in (folder / "frames").iterdir()}, self.frames)

    def test_old_results_that_cannot_be_deleted_stay(self):
        folder = self.here / "old"
        self.assertEqual(self.run_deck(folder).returncode, 0)
        before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
        done = self.run_deck(folder, "--overwrite", fault=f"unlink:1+:{errno.EACCES}")
        self.assertEqual(done.returncode, 5, done.stderr)
        self.assertRegex(done.stderr, f"^error: {folder}/.*cannot delete.*Permission denied\n$")
        self.assertEqual({p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}, before)

    def test_results_are_replaced_file_by_file(self):
        """With the old results gone, a run that fails leaves whole new files and no old summary."""
        folder = self.here / "replaced"
        self.assertEqual(self.run_deck(folder).returncode, 0)
        done = self.run_deck(folder, "--overwrite", fault=f"write:6+:{errno.ENOSPC}")
        self.check_refused(done, folder, errno.ENOSPC)
        self.assertEqual(self.run_deck(folder, "--overwrite").returncode, 0)

    def test_real_permissions(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        locked = self.here / "locked"
        locked.mkdir(mode=0o500)
        done = self.run_deck(locked / "run")
        self.check_refused(done, locked, errno.EACCES)


if __name__ == "__main__":
    SPHGEO, SHIM = (str(Path(sys.argv.pop(1)).resolve()) for _ in range(2))
    if not sys.platform.startswith("linux"):
        sys.exit(77)
    unittest.main(verbosity=0)

#!/usr/bin/env python3
"""The command line: exit codes, sentences that say what to do, and what goes to which stream.

    test_cli.py SPHGEO
"""
import json
import math
import os
import struct
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import DECK, ProgramTest, main  # noqa: E402

MISSED = """\
probes: [{name: energy, type: energy}]
expect:
  - {name: wrong, probe: energy.kinetic, reduce: last, reference: 100, tolerance: 1 %}
"""


class CommandLine(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("deck.yaml", DECK)

    def call(self, *words, stdin=""):
        return super().call(*words, input=stdin, text=True)

    def refused(self, code, says, *words, stdin=""):
        """The call ends with this code, says each of these on stderr, and prints no data."""
        done = self.call(*words, stdin=stdin)
        self.assertEqual(done.returncode, code, done.stderr)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, done.stderr)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def test_commands(self):
        self.refused(2, ["a command is missing", "sphgeo --help"])
        self.refused(2, "no command 'rnu'; did you mean 'run'?", "rnu", "deck.yaml", "-o", "out")
        self.refused(2, "no command 'deck.yaml'", "deck.yaml")
        self.refused(2, "no option '--verison'; did you mean '--version'?", "--verison")
        for words in (["--help"], ["run", "--help"], ["--version"]):
            self.assertIn("sphgeo", self.accepted(*words).stdout)
        about = self.accepted("--version").stdout
        for line in (r"^sphgeo \d+\.\d+\.\d+$", r"^commit +\S+$", r"^compiler +(GCC|Clang) \d", r"^vectors +\d+ bits", r"^threads +up to \d+",
                     r"^libraries .*yaml-cpp \d.*muparser \d.*HDF5 \d.*zlib \d.*fmt \d.*Eigen \d"):
            self.assertRegex(about, f"(?m){line}")

    def test_options(self):
        self.refused(2, "'sphgeo check' has no option '--explian'; did you mean '--explain'?",
                     "check", "--explian", "deck.yaml")
        # The misspelt option matters more than what is missing because of it.
        self.refused(2, "has no option '--ouput'; did you mean '--output'?", "run", "deck.yaml",
                     "--ouput", "out")
        self.refused(2, "has no option '--thread'; did you mean '--threads'?", "run", "deck.yaml",
                     "-o", "out", "--thread=2")
        self.refused(2, "'sphgeo run' needs -o DIR", "run", "deck.yaml")
        self.refused(2, "'sphgeo run' needs DECK", "run", "-o", "out")
        self.refused(2, "'sphgeo check' needs DECK", "check")
        self.refused(2, "no use for 'more.yaml'", "check", "deck.yaml", "more.yaml")
        self.refused(2, "--set", "check", "deck.yaml", "--set")
        for wrong in ("0", "-1", "two", "2.5", "1e400"):
            self.refused(2, f"'{wrong}' is not a whole number above 0", "run", "deck.yaml", "-o", "out",
                         f"--threads={wrong}")
        for many in ("1025", "1e8", "100000000", "99999999999999999999"):
            self.refused(2, f"'{many}': at most 1024 threads", "run", "deck.yaml", "-o", "out",
                         f"--threads={many}")
        self.refused(2, "no bench scene 'dam_brek'; did you mean 'dam_break'?", "bench", "--scene",
                     "dam_brek")
        self.assertFalse((self.here / "out").exists())

    def test_export(self):
        deck = self.write("solid.yaml", """\
dimension: 3
resolution: 0.1
end_time: 1
materials: [{name: rock, type: rigid, density: 2600}]
bodies: [{name: ball, material: rock, shape: {type: sphere, center: [0, 0, 1], radius: 0.5}}]
boundaries: [{name: ground, type: wall, shape: {type: box, min: [-1, -1, -0.5], max: [1, 1, 0]}}]
""")
        self.accepted("export", deck, "ball", "-o", "ball.stl")
        data = (self.here / "ball.stl").read_bytes()
        faces = [struct.unpack_from("<12fH", data, 84 + 50 * k)[3:12] for k in range(struct.unpack_from("<I", data, 80)[0])]
        self.assertEqual(len(data), 84 + 50 * len(faces))
        volume = sum(x0 * (y1 * z2 - z1 * y2) + y0 * (z1 * x2 - x1 * z2) + z0 * (x1 * y2 - y1 * x2)
                     for x0, y0, z0, x1, y1, z1, x2, y2, z2 in faces) / 6
        self.assertAlmostEqual(volume, 4 / 3 * math.pi * 0.125, delta=0.01)
        # A deck takes it back.
        taken = self.write("taken.yaml", (self.here / "solid.yaml").read_text().replace("{type: sphere, center: [0, 0, 1], radius: 0.5}", "{type: stl, file: ball.stl}"))
        self.assertIn("the deck is correct", self.accepted("check", taken, "--no-calibrate").stdout)
        self.accepted("export", deck, "ground", "-o", "ground.stl", "--spacing", "0.2")
        self.refused(2, "ground.stl exists; --overwrite replaces it", "export", deck, "ground", "-o", "ground.stl")
        self.accepted("export", deck, "ground", "-o", "ground.stl", "--overwrite")
        self.refused(2, ["no body and no wall of the deck is named 'bal'", "did you mean 'ball'?"], "export", deck, "bal", "-o", "x.stl")
        self.refused(2, "STL needs a scene in 3D", "export", deck, "ball", "-o", "x.stl", "--set", "dimension=2")
        self.refused(2, "is not a length above zero", "export", deck, "ball", "-o", "x.stl", "--spacing=-1")
        self.assertFalse((self.here / "x.stl").exists())

    def test_decks_that_cannot_be_read(self):
        self.refused(2, ["none.yaml", "No such file"], "check", "none.yaml")
        self.refused(2, "it is a folder", "check", ".")
        self.refused(2, "the deck is empty", "check", "-")
        (self.here / "binary.yaml").write_bytes(bytes(range(256)) * 64)
        self.refused(2, "binary.yaml", "check", "binary.yaml")
        if os.geteuid() != 0:
            (self.here / "locked.yaml").write_text(DECK)
            (self.here / "locked.yaml").chmod(0)
            self.refused(2, "Permission denied", "check", "locked.yaml")
        for command in (["check", "none.yaml"], ["run", "none.yaml", "-o", "out"]):
            self.assertEqual(len(self.refused(2, "none.yaml", *command).splitlines()), 1)

    def test_mistakes_of_a_deck(self):
        (self.here / "bad.yaml").write_text(DECK.replace("resolution", "resolutoin"))
        for command in (["check", "bad.yaml"], ["run", "bad.yaml", "-o", "out"]):
            self.refused(2, ["bad.yaml:2:1: error", "did you mean 'resolution'?"], *command)
        self.refused(2, "did you mean 'resolution'?", "check", "deck.yaml", "--set", "resolutoin=1")
        self.assertFalse((self.here / "out").exists())

    def test_a_scene_that_fails_at_once_is_not_correct(self):
        self.write("fast.yaml", DECK.replace("material: water,", "material: water, velocity: [50, 0, 0],"))
        self.refused(2, "the scene fails in its first steps", "check", "fast.yaml")

    def test_nothing_drives_the_terminal(self):
        bad = "no\x1b[31m\x9b2J\u202e\udcff.yaml"   # ESC, C1, right-to-left override, a byte that is no UTF-8
        shown = "no?[31m?2J??.yaml"
        for words in (["check", bad], [bad], [f"--{bad}"], ["show", bad], ["check", "deck.yaml", bad], ["check", f"--{bad}", "deck.yaml"],
                      ["check", "deck.yaml", "--set", f"title={bad}"], ["check", "deck.yaml", "--set", f"{bad}=1"],
                      ["run", "deck.yaml", "-o", "out", f"--threads={bad}"], ["bench", "--scene", bad]):
            said = self.refused(2, "no?[31m" if "--set" in words else shown, *words)
            self.assertNotRegex(said, r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u202e]")
        self.refused(5, f"deck.yaml/{shown}", "run", "deck.yaml", "-q", "-o", f"deck.yaml/{bad}")
        # A title may hold what is UTF-8 and no control character, and is still not shown as it is.
        titled = ["check", "deck.yaml", "--no-calibrate", "--set", "title=a\x9b2J\u202eb"]
        self.assertEqual(self.accepted(*titled).stdout.split(":")[0], "a?2J?b")
        self.refused(2, ["--set #1: error[E002]", "the byte 27"], "check", "deck.yaml", "--set", 'title="\\e[2J"')

    def test_standard_input(self):
        self.accepted("check", "-", stdin=DECK)
        self.refused(2, "<stdin>:1:", "check", "-", stdin="dimension: 4\n" + DECK.split("\n", 1)[1])

    def test_run_folders(self):
        run = ["run", "deck.yaml", "-q", "-o"]
        (self.here / "notes").mkdir()
        (self.here / "notes" / "mine.txt").write_text("kept")
        self.accepted(*run, "notes")   # a folder with other files is no obstacle
        stamp = (self.here / "notes" / "resolved.yaml").read_text()
        self.refused(2, ["holds results", "--overwrite", "--resume"], *run, "notes")
        self.accepted(*run, "notes", "--overwrite", "--set", "end_time=2 ms")
        self.assertNotEqual((self.here / "notes" / "resolved.yaml").read_text(), stamp)
        self.assertEqual((self.here / "notes" / "mine.txt").read_text(), "kept")
        self.accepted(*run, "deep/er/run")
        self.refused(5, "deck.yaml", *run, "deck.yaml")
        self.refused(5, "deck.yaml/below", *run, "deck.yaml/below")

    def test_streams(self):
        done = self.accepted("run", "deck.yaml", "-o", "out", "--threads", "2")
        self.assertEqual(done.stdout, "")
        self.assertNotIn("\033", done.stderr)
        summary = json.loads((self.here / "out" / "summary.json").read_text())
        self.assertEqual((summary["status"], summary["threads"]), ("done", 2))
        quiet = self.accepted("run", "deck.yaml", "-o", "quiet", "--quiet")
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))

    def test_verify(self):
        (self.here / "missed.yaml").write_text(DECK + MISSED)
        done = self.accepted("run", "missed.yaml", "-q", "-o", "a")
        self.assertIn("wrong", done.stdout)
        done = self.call("run", "missed.yaml", "-q", "-o", "b", "--verify")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(json.loads((self.here / "b" / "summary.json").read_text())["exit_code"], 4)

    def test_plan_as_data(self):
        plan = json.loads(self.accepted("check", "deck.yaml", "--explain", "--json").stdout)
        self.assertIn("water_momentum", [e["name"] for e in plan["plan"]])
        self.assertIn("water_momentum", self.accepted("check", "deck.yaml", "--explain").stdout)

    def test_list_and_show(self):
        listed = self.accepted("list").stdout
        for name in ("box", "water", "tank", "pressure", "water_momentum"):
            self.assertRegex(listed, rf"(?m)^  {name} ")
            if name != "water_momentum":
                self.assertIn(f"{name} (", self.accepted("show", name).stdout)
        shown = self.accepted("show", "tank").stdout
        for key in ("name", "min", "max", "open", "slip"):
            self.assertRegex(shown, rf"(?m)^  {key}$")
        for name, kind, says in (("numerics", "section", "cfl_acoustic"), ("expect", "section", "tolerance"),
                                 ("body", "section", "filling"), ("deck", "section", "resolution"),
                                 ("water_momentum", "effect", "Eqs. 60-63"), ("density", "field", "kg/m3")):
            shown = self.accepted("show", name).stdout
            self.assertIn(f"{name} ({kind}): ", shown)
            self.assertIn(says, shown)
            self.assertRegex(listed, rf"(?m)^  {name} ")
        # A key has its unit, range, default and equation.
        for text in ("(Eq. 63)", "at least 0", "default 3", "one of single or double"):
            self.assertIn(text, self.accepted("show", "numerics").stdout)
        self.assertIn("required", self.accepted("show", "tank").stdout)
        # A probe has its columns, with their units.
        for text in ("columns, in 3D:", "  flow [m3/s]", "  mass_flow [kg/s]"):
            self.assertIn(text, self.accepted("show", "flux").stdout)
        self.refused(2, "no type 'bxo'; did you mean 'box'?", "show", "bxo")
        self.refused(2, ["no type 'interfac'; did you mean", "'interface_state'"], "show", "interfac")
        self.refused(2, "'sphgeo list'", "show", "no_such_thing_at_all")

    def test_a_full_disk_is_said(self):
        if not Path("/dev/full").exists():
            self.skipTest("no /dev/full")
        for command in ("schema", "list", "reference"):
            with open("/dev/full", "w") as full:
                done = subprocess.run([self.sphgeo, command], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 5, command)
            self.assertIn("standard output", done.stderr)


if __name__ == "__main__":
    main()

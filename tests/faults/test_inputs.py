#!/usr/bin/env python3
"""Files and streams that are not as they should be: missing, endless, in circles, in other encodings, under
strange names, or far too large. A deck fault ends with exit 2 and the place, and within bounded time and
memory.

    test_inputs.py SPHGEO
"""
import os
import resource
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from program import DECK, HANGS, ROOT, ProgramTest, main  # noqa: E402

HEAD = DECK.rsplit("bodies", 1)[0]
MEMORY = 800 << 20
SECONDS = 20   # of processor time: a bound for hangs that other work on the machine does not reach


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


class Inputs(ProgramTest):
    def call(self, *words, **options):
        return super().call(*words, preexec_fn=limit, timeout=HANGS, **options)

    def refused(self, says, deck, *words):
        """Exit 2 within bounds; stderr holds each of the texts, on few and short lines."""
        done = self.call("check", deck, *words)
        said = done.stderr.decode()
        self.assertEqual(done.returncode, 2, said[:2000])
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, said[:20000])
        self.assertLess(len(said), 30000)
        return said

    # --- files that a deck names

    def test_includes(self):
        self.write("missing.yaml", "include: [nowhere.yaml]\n" + DECK)
        self.refused(["missing.yaml:1:11: error", "nowhere.yaml", "No such file"], "missing.yaml")
        self.write("a.yaml", "include: [b.yaml]\n" + DECK)
        self.write("b.yaml", "include: [a.yaml]\n")
        self.refused(["b.yaml:1:11: error", "'a.yaml' includes itself"], "a.yaml")
        self.write("zero.yaml", "include: [/dev/zero]\n" + DECK)
        self.refused(["zero.yaml:1:11: error", "not a regular file"], "zero.yaml")
        os.mkfifo(self.here / "pipe")
        self.write("pipe.yaml", "include: [pipe]\n" + DECK)
        self.refused(["pipe.yaml:1:11: error", "not a regular file"], "pipe.yaml")
        for k in range(30):
            self.write(f"deep{k}.yaml", f"include: [deep{k + 1}.yaml]\n" + (DECK if k == 0 else ""))
        self.refused(["deep20.yaml:1:11: error", "more than 20 levels"], "deep0.yaml")
        self.refused("larger than", "/dev/zero")

    def test_shapes_from_files(self):
        shape = "bodies: [{name: b, material: water, shape: {type: stl, file: %s}}]\n"
        self.write("missing.yaml", HEAD + shape % "nowhere.stl")
        self.refused(["missing.yaml:5:62: error", "nowhere.stl", "not found"], "missing.yaml")
        self.write("cut.stl", (ROOT / "share/assets/ball.stl").read_bytes()[:-30])
        self.write("cut.yaml", HEAD + shape % "cut.stl")
        self.refused(["cut.yaml:5:", "truncated"], "cut.yaml")
        self.write("device.yaml", HEAD + shape % "/dev/zero")
        self.refused("not found", "device.yaml")

    def test_reference_tables_are_read_before_the_run(self):
        self.write("table.csv", "t,x\n0,1\n1,one\n")
        self.write("deck.yaml", DECK + "probes: [{name: f, type: front}]\nexpect: [{name: e, probe: f, reduce: curve, "
                   "reference_csv: table.csv, tolerance: 1}]\n")
        self.refused(["deck.yaml:7:", "table.csv:3", "'one' is not a finite number"], "deck.yaml")

    def test_names_with_blanks_and_other_letters(self):
        folder = "größe 水 $HOME 'x'"
        shutil.copy(ROOT / "share/assets/ball.stl", self.here / "ball.stl")
        (self.here / folder).mkdir()
        shutil.move(self.here / "ball.stl", self.here / folder / "Kugel ü.stl")
        self.write(f"{folder}/teil ä.yaml", HEAD)
        self.write(f"{folder}/deck ß.yaml", 'include: ["teil ä.yaml"]\nbodies: [{name: ball, material: water, '
                   'shape: {type: stl, file: "Kugel ü.stl"}}]\ntitle: "Größe 水"\n')
        out = f"{folder}/läufe 1"
        self.accepted("run", f"{folder}/deck ß.yaml", "-q", "-o", out)
        self.accepted("check", f"{out}/resolved.yaml")
        self.accepted("run", f"{out}/resolved.yaml", "-q", "-o", "again")
        frames = [sorted((self.here / o / "frames").iterdir()) for o in (out, "again")]
        self.assertEqual([p.read_bytes() for p in frames[0]], [p.read_bytes() for p in frames[1]])

    # --- encodings

    def test_encodings(self):
        self.write("bom.yaml", "\ufeff" + DECK.replace("\n", "\r\n"))
        self.accepted("check", "bom.yaml")
        self.write("latin1.yaml", DECK.encode() + b"title: Gr\xf6\xdfe\n")
        self.refused(["latin1.yaml:6:10: error", "not UTF-8", "0xF6"], "latin1.yaml")
        for name in ("utf-16-le", "utf-16-be"):
            self.write("utf16.yaml", ("\ufeff" + DECK).encode(name))
            self.refused(["utf16.yaml:1:1: error", "UTF-16"], "utf16.yaml")
        self.write("nul.yaml", DECK + "title: a\0b\n")
        self.refused(["nul.yaml:6:9: error", "contains the byte 0"], "nul.yaml")
        self.write("escape.yaml", DECK + "title: \x1b[31mred\n")
        self.refused(["escape.yaml:6:8: error", "contains the byte 27"], "escape.yaml")
        self.write("tab.yaml", DECK + "numerics:\n\tlimiter: 3\n")
        self.refused(["tab.yaml:7:", "blanks, not with tabs"], "tab.yaml")
        for wrong in (b"\xc0\x80", b"\xed\xa0\x80", b"\xf5\x80\x80\x80", b"\xe2\x82"):
            self.write("wrong.yaml", DECK.encode() + b"title: '" + wrong + b"'\n")
            self.refused(["wrong.yaml:6:9: error", "not UTF-8"], "wrong.yaml")
        # The mark stands under its letter, whatever stands before it.
        self.write("wide.yaml", DECK + "title: {größe: 1}\n")
        said = self.refused("wide.yaml:6:8", "wide.yaml").splitlines()
        self.assertEqual(said[1].index("{"), said[2].index("^"))

    # --- sizes

    def test_aliases(self):
        bomb = "x-a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
        for c in "bcdefghi":
            bomb += f"x-{c}: &{c} [{', '.join(['*' + chr(ord(c) - 1)] * 10)}]\n"
        self.write("bomb.yaml", DECK + bomb)
        self.refused(["bomb.yaml:10:", "more than 200000 values"], "bomb.yaml")
        self.write("texts.yaml", DECK + "x-a: &a " + 15000 * "t" + "\nx-b: [" + 10000 * "*a, " + "]\n")
        self.refused(["texts.yaml:7:", "bytes of text"], "texts.yaml")
        self.write("nested.yaml", DECK + "x-a: " + "".join(f"&a{k} [" for k in range(50)) + 90000 * "1," + 50 * "]" + "\n")
        self.refused(["nested.yaml:6:", "more than 200000 values"], "nested.yaml")
        deep = DECK + "x-0: &a0 1\n" + "".join(f"x-{k}: &a{k} [[[[[[[[[[[[*a{k - 1}]]]]]]]]]]]]\n" for k in range(1, 900))
        self.write("deep.yaml", deep)
        self.refused(["deep.yaml:11:", "more than 60 levels"], "deep.yaml")

    def test_large_decks(self):
        half = 5 << 20
        for name, text, says in (
                ("size", DECK + "# " + 11 * (1 << 20) * "c", "larger than"),
                ("line", DECK + "x: " + half * "[", "a line of 5242883 bytes"),
                ("lists", DECK + "x:\n" + 250000 * "[\n", "60 levels"),
                ("maps", DECK + "x:\n" + 250000 * "{\n", "60 levels"),
                ("brackets", DECK + "x:\n" + half // 2 * "[\n", "more than 600000 brackets"),
                ("pairs", DECK + "x: [" + half // 5 * "[[]],\n", "more than 600000 brackets"),
                ("dashes", DECK + "x:\n" + 100000 * "- ", "60 levels"),
                ("questions", DECK + 100000 * "? ", "E"),
                ("stars", DECK + "x: [" + half // 4 * "*a,\n", "E006"),
                ("words", DECK + "x: [" + half // 4 * "'a'\n", "E002"),
                ("colons", DECK + "x: [" + half // 5 * "'a':\n", "E002"),
                ("anchors", DECK + "x: " + 80000 * "&a ", "E002"),
                ("quote", DECK + 'x: "' + half // 2 * "q\n", "E"),
                ("value", DECK + "title: " + half // 2 * "v\n ", "characters; at most"),
                ("key", DECK + 900 * "k" + ": 1", "a key of 900 characters"),
                ("keys", DECK + "".join(f"x-{k}: 1\n" for k in range(6000)), "more than 5000 keys"),
                ("values", DECK + "x-a: [" + 300000 * "1,\n" + "]", "more than 200000 values"),
                ("items", HEAD + "bodies: [" + 11000 * "{}," + "]", "takes at most 10000"),
                ("names", DECK.replace("drop", 300 * "n"), "a name of 300 characters"),
                ("errors", DECK + "".join(f"wrong{k}: 1\n" for k in range(4000)), "more errors"),
                ("variables", DECK + "variables: {" + ", ".join(f"v{k}: v{k}x+1" for k in range(4900)) + "}", "more errors"),
                ("lines", DECK + half * "\n" + "x", "E"),
                ("formula", DECK.replace("0.1 m", 3000 * "1+" + "1"), "too long"),
                ("parentheses", DECK.replace("0.1 m", 150 * "(" + "1" + 150 * ")"), "too many parentheses")):
            with self.subTest(name):
                self.write(name + ".yaml", text)
                self.refused(["error[E", says], name + ".yaml")
        many = "variables: {" + ", ".join(f"v{k}: {'v%d + 1' % (k - 1) if k else 1}" for k in range(4900)) + "}\n"
        self.write("many.yaml", DECK + many)
        self.accepted("check", "many.yaml")

    def test_scenes_beyond_any_machine(self):
        for says, change in (("particles", "resolution=1e-6"), ("km across", "resolution=1e-9"), ("km across", "resolution=1e-200"),
                             ("km across", "bodies.drop.shape.max=[1e12, 1, 1e-3]")):
            self.write("deck.yaml", DECK)
            self.refused(["error[E", "resolution", says], "deck.yaml", "--set", change)
        self.write("tank.yaml", DECK + "boundaries: [{name: t, type: tank, min: [0, 0, 0], max: [1e15, 1, 1e15]}]\n")
        self.refused(["tank.yaml:6:", "walls of the tank"], "tank.yaml")

    # --- streams

    def test_output_that_nobody_takes(self):
        self.write("deck.yaml", DECK + "probes: [{name: e, type: energy}]\nexpect: [{name: k, probe: e, reduce: last, "
                   "reference: 0, tolerance: 1e9, tolerance_kind: absolute}]\n")
        commands = (["check", "deck.yaml", "--explain"], ["check", "deck.yaml", "--json"], ["list"], ["schema"],
                    ["show", "tank"], ["run", "deck.yaml", "-q", "--overwrite", "-o", "out"])
        for words in commands:
            with self.subTest(words=words, stream="full"), open("/dev/full", "w") as full:
                done = self.call(*words, stdout=full)
                self.assertEqual(done.returncode, 5, done.stderr)
                self.assertIn(b"error: cannot write to standard output: No space left", done.stderr)
            with self.subTest(words=words, stream="pipe"):
                read, write = os.pipe()
                os.close(read)
                done = self.call(*words, stdout=write)
                os.close(write)
                self.assertEqual(done.returncode, 5, done.stderr)
                self.assertIn(b"Broken pipe", done.stderr)
            with self.subTest(words=words, stream="closed"):
                done = subprocess.run(["/bin/sh", "-c", 'exec "$@" >&-', "sh", self.sphgeo, *words], cwd=self.here,
                                      stderr=subprocess.PIPE, timeout=HANGS)
                self.assertEqual(done.returncode, 5, done.stderr)
                self.assertIn(b"Bad file descriptor", done.stderr)
        # The results are there all the same, and nothing that was meant for the stream is in them.
        self.assertTrue((self.here / "out/summary.json").is_file())
        table = (self.here / "out/run.csv").read_text()
        self.assertEqual(len({l.count(",") for l in table.splitlines() if not l.startswith("#")}), 1)

    def test_errors_that_nobody_reads(self):
        """A terminal that goes away ends no run."""
        self.write("deck.yaml", DECK)
        read, write = os.pipe()
        os.close(read)
        done = self.call("run", "deck.yaml", "-o", "out", stderr=write)
        os.close(write)
        self.assertEqual(done.returncode, 0)
        done = subprocess.run(["/bin/sh", "-c", 'exec "$@" 0<&- >&- 2>&-', "sh", self.sphgeo, "run", "deck.yaml", "-o", "none"],
                              cwd=self.here, timeout=HANGS)
        self.assertEqual(done.returncode, 0)
        self.assertTrue((self.here / "none/run.csv").read_text().startswith("# sphgeo"))


if __name__ == "__main__":
    main()

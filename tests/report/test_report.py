#!/usr/bin/env python3
"""The page of a run and the preview of a scene. The page's visible numbers are those of summary.json, its pictures show something, and it asks for
nothing else. With Chromium installed also: a browser has nothing to say against it, light and dark; without it
this part is skipped (exit 77).

    test_report.py SPHGEO
"""
import base64
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from html.parser import HTMLParser
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
UNITS = {"kB": 1e3, "MB": 1e6, "GB": 1e9, "s": 1, "min": 60, "h": 3600, "d": 86400, "": 1, "%": 0.01}


class Page(HTMLParser):
    """Texts with a data-path, pictures, embedded summaries, and every address in the page."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.traced, self.pictures, self.summaries, self.addresses, self.open = [], [], {}, [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.addresses += [v for k, v in attributes if k in ("src", "href", "action", "data") and not v.startswith("data:image/png;base64,")]
        if tag == "img":
            self.pictures.append(base64.b64decode(given["src"].split(",", 1)[1]))
        if tag in ("img", "meta"):
            return
        self.open.append((tag, given, []))

    def handle_endtag(self, tag):
        while self.open:
            name, given, texts = self.open.pop()
            if "data-path" in given:
                self.traced.append((int(given.get("data-run", 1)), given["data-path"], "".join(texts)))
            if name == "script":
                self.summaries[given["id"]] = json.loads("".join(texts))
            if name == tag:
                return

    def handle_data(self, data):
        for _, _, texts in self.open[-1:]:
            texts.append(data)


def number_of(text):
    """The number that a reader sees: '3 456', '1.2×10⁻⁵', '25.3 MB', '2 min 05 s'."""
    text = text.replace("\u202f", "").replace("\u00a0", " ").replace("−", "-")
    raised = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
    text = re.sub(r"(×?)10([⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+)", lambda m: ("" if m[1] else "1") + "e" + m[2].translate(raised), text)
    parts = re.findall(r"(-?[\d.]+(?:e-?\d+)?) ?([A-Za-z%]*)", text)
    return sum(float(value) * UNITS[unit] for value, unit in parts)


def at(summary, pointer):
    for part in pointer.split("/")[1:]:
        part = part.replace("~1", "/").replace("~0", "~")
        summary = summary[int(part)] if isinstance(summary, list) else summary[part]
    return summary


def png_pixels(data):
    """Width, height and rows of bytes of a PNG of 8 bits a channel, and bytes a pixel."""
    width, height, bits, kind = struct.unpack(">IIBB", data[16:26])
    at_byte, packed = 8, b""
    while at_byte < len(data):
        length = struct.unpack(">I", data[at_byte:at_byte + 4])[0]
        if data[at_byte + 4:at_byte + 8] == b"IDAT":
            packed += data[at_byte + 8:at_byte + 8 + length]
        at_byte += 12 + length
    size = {0: 1, 2: 3, 3: 1, 6: 4}[kind]
    raw, stride = zlib.decompress(packed), (width * bits * size + 7) // 8
    rows, before = [], bytearray(stride)
    for r in range(height):
        how, row = raw[r * (stride + 1)], bytearray(raw[r * (stride + 1) + 1:(r + 1) * (stride + 1)])
        for i in range(stride if how else 0):
            a, b = row[i - size] if i >= size else 0, before[i]
            c = before[i - size] if i >= size else 0
            near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, near)[how]) & 255
        rows.append(row)
        before = row
    return width, height, rows, size


def check_numbers(page, folders):
    """Sentences about numbers that differ from summary.json."""
    files = [json.loads((f / "summary.json").read_text()) for f in folders]
    for k, file in enumerate(files):
        if page.summaries.get("summary" if k == 0 else f"summary-{k + 1}") != file:
            yield f"the summary of run {k + 1} in the page is not its summary.json"
    if len(page.traced) < 40 * len(folders):
        yield f"only {len(page.traced)} numbers say where they come from"
    for run, path, text in page.traced:
        value = at(files[run - 1], path)
        seen = number_of(text)
        # A byte count in MB, a wall time in seconds and a share in per mille are rounded; all else has three digits or more.
        loose = (0.06e6 if "bytes" in path else 0.6 if path.endswith("wall_s") and value >= 100 else
                 6e-4 if path.endswith("busy") else 0)
        if abs(seen - value) > max(6e-3 * abs(value), loose):
            yield f"{path}: the page shows '{text}', summary.json has {value}"


def check_page(text, folders, pictures):
    page = Page(text)
    yield from check_numbers(page, folders)
    if page.addresses or re.search(r"url\(|@import|https?://(?!www\.w3\.org/2000/svg)", text):
        yield f"the page asks for something else: {page.addresses[:3]}"
    if len(text) > 3_000_000:
        yield f"the page has {len(text)} bytes"
    if len(page.pictures) < pictures:
        yield f"{len(page.pictures)} pictures, expected {pictures} or more"
    for picture in page.pictures:
        width, height, rows, _ = png_pixels(picture)
        if width < 100 or len({byte for row in rows for byte in row}) < 3:
            yield f"a picture of {width} x {height} pixels shows nothing"


def browse(chromium, page, *options):
    return subprocess.run([chromium, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--enable-logging=stderr",
                           "--window-size=500,900", *options, page.as_uri()], capture_output=True, text=True, timeout=1200)


def check_browser(chromium, page, folders, here):
    """What a browser makes of it: its own reading of the page, no complaint, two colour schemes."""
    done = browse(chromium, page, "--dump-dom")
    complaints = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    if done.returncode != 0 or complaints:
        yield f"Chromium: exit {done.returncode}, {complaints[:3]}"
    yield from (f"in Chromium: {s}" for s in check_numbers(Page(done.stdout), folders))
    corners = []
    for scheme in (1, 0):  # light, dark
        shot = here / f"shot{scheme}.png"
        browse(chromium, page, f"--screenshot={shot}", f"--blink-settings=preferredColorScheme={scheme}")
        _, _, rows, size = png_pixels(shot.read_bytes())
        corners.append(sum(rows[2][2 * size:2 * size + 3]) / 3)
        if len({bytes(row[i:i + 3]) for row in rows[::3] for i in range(0, len(row), 3 * size)}) < 20:
            yield "the page looks empty"
    if not corners[0] > 230 or not corners[1] < 60:
        yield f"the page is not light ({corners[0]:.0f}) and dark ({corners[1]:.0f})"


def main():
    sphgeo = str(Path(sys.argv[1]).resolve())
    wrong = []

    def call(*words):
        done = subprocess.run([sphgeo, *map(str, words)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{words}: exit {done.returncode}\n{done.stderr}")

    with tempfile.TemporaryDirectory() as name:
        here = Path(name)
        one, two, both = here / "one", here / "two", here / "both.html"
        call("run", ROOT / "decks/basics/gate_and_sill.yaml", "-o", one, "-q", "--set", "end_time=0.3")
        call("run", ROOT / "decks/basics/gate_and_sill.yaml", "-o", two, "-q", "--set", "end_time=0.2", "--no-report")
        if (two / "report.html").exists():
            wrong.append("--no-report wrote a report")
        wrong += check_page((one / "report.html").read_text(), [one], 6)
        call("report", one, two, "-o", both)
        wrong += check_page(both.read_text(), [one, two], 8)
        if subprocess.run([sphgeo, "report", one, two], capture_output=True).returncode != 2:
            wrong.append("two runs without -o are no usage error")
        if subprocess.run([sphgeo, "report", here], capture_output=True).returncode != 5:
            wrong.append("a folder without a run is no error of files")
        scene = here / "scene.png"
        call("check", ROOT / "decks/basics/gate_and_sill.yaml", "--no-calibrate", "--preview", scene)
        width, height, rows, _ = png_pixels(scene.read_bytes())
        if width < 400 or height < 100 or len({byte for row in rows for byte in row}) < 4:  # paper, water, walls, probes
            wrong.append(f"the preview of {width} x {height} pixels shows nothing")
        chromium = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
        if chromium:
            wrong += check_browser(chromium, one / "report.html", [one], here)
    for sentence in wrong:
        print(sentence)
    if not wrong and not chromium:
        print("no Chromium: the page was not opened")
        return 77
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

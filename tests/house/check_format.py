#!/usr/bin/env python3
"""All C and C++ files are as clang-format writes them with the project's .clang-format.

    check_format.py PROJECT_ROOT

Prints the files that are not; exit 1 when there is one. Exit 77 (skipped) without clang-format 14, the version of
Debian 12: other versions lay out some constructs differently.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

VERSION = "14"


def main():
    root = Path(sys.argv[1])
    tool = shutil.which(f"clang-format-{VERSION}") or shutil.which("clang-format")
    said = subprocess.run([tool, "--version"], capture_output=True, text=True).stdout if tool else ""
    found = re.search(r"version (\d+)", said)
    if not found or found.group(1) != VERSION:
        print(f"format: there is no clang-format {VERSION}")
        return 77
    files = sorted(p for folder in ("src", "tests") for p in (root / folder).rglob("*") if p.suffix in (".h", ".cpp", ".c"))
    if not files:
        print(f"{root}: no sources")
        return 1
    done = subprocess.run([tool, "--dry-run", "--Werror", *files], cwd=root, capture_output=True, text=True)
    wrong = sorted({line.split(":")[0] for line in done.stderr.splitlines() if "clang-format-violations" in line})
    for path in wrong:
        print(f"{path}: not as clang-format writes it; clang-format -i {path}")
    print(f"format: {len(files)} files, {len(wrong)} breaches")
    return 1 if wrong or done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())

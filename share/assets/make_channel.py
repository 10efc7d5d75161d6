#!/usr/bin/env python3
"""Makes the terrain of decks/paper/debris_flow.yaml: a steep channel of V-shape with a rounded bottom that winds down a slope and
flattens, with capped shoulders and fractal noise, and the top of the deposit in its head.

    share/assets/make_channel.py [--spacing 2] [-o FOLDER]

Writes channel_ground.csv and channel_deposit.csv, heights in m on a grid from (0, -35) to (200, 35): rows along x, row after row
along y. All is procedural: no survey is behind it.
"""
import argparse
import math
from pathlib import Path

LENGTH, HALF = 200.0, 35.0


def lattice(i, j, octave):
    """A number in -1..1 for a lattice point: a hash, so that every machine makes the same terrain."""
    h = (i * 374761393 + j * 668265263 + octave * 2147483647) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 0x7FFFFFFF - 1.0


def smooth(t):
    return t * t * t * (t * (6 * t - 15) + 10)


def value_noise(x, y, octave):
    i, j = math.floor(x), math.floor(y)
    u, v = smooth(x - i), smooth(y - j)
    low = lattice(i, j, octave) * (1 - u) + lattice(i + 1, j, octave) * u
    high = lattice(i, j + 1, octave) * (1 - u) + lattice(i + 1, j + 1, octave) * u
    return low * (1 - v) + high * v


def noise(x, y):
    total, weight, size = 0.0, 0.5, 24.0
    for octave in range(4):
        total += weight * value_noise(x / size, y / size, octave)
        weight, size = weight / 2, size / 2
    return total


def thalweg(x):
    return 6 * math.sin(2 * math.pi * x / 110)


def ground(x, y):
    s = abs(y - thalweg(x))
    bed = 8 + 92 * (1 - x / LENGTH) ** 1.8
    shoulder = min(0.5 * s * s / (s + 4), 22)
    rough = 0.15 + (0.6 - 0.15) * min(1.0, s / 12)
    return bed + shoulder + rough * noise(x, y)


def deposit(x, y):
    """The top of the deposit; below the ground where there is none."""
    s = abs(y - thalweg(x))
    ends = min(1.0, (x - 15) / 4, (50 - x) / 4)
    thick = 4 * (1 - (s / 14) ** 2) * ends if 15 < x < 50 else -1.0
    return ground(x, y) + max(thick, -1.0)


def write(path, height, what, spacing):
    nx, ny = round(LENGTH / spacing) + 1, round(2 * HALF / spacing) + 1
    with open(path, "w") as out:
        out.write(f"# {what}, m; rows along x from 0 to {LENGTH:g} m, row after row along y from {-HALF:g} to {HALF:g} m, {spacing:g} m apart\n")
        out.write("# made by share/assets/make_channel.py\n")
        for j in range(ny):
            out.write(",".join(f"{height(i * spacing, -HALF + j * spacing):.3f}" for i in range(nx)) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--spacing", type=float, default=2.0)
    parser.add_argument("-o", "--output", default=str(Path(__file__).resolve().parent))
    args = parser.parse_args()
    write(Path(args.output) / "channel_ground.csv", ground, "heights of a channel", args.spacing)
    write(Path(args.output) / "channel_deposit.csv", deposit, "top of a deposit in a channel", args.spacing)


if __name__ == "__main__":
    main()

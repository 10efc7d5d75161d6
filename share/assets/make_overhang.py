#!/usr/bin/env python3
"""Writes overhang.stl: a piece of terrain 1.2 by 0.5 m with a lip that stands out over a hollow.

Usage: make_overhang.py [folder]     (default: the folder of this script)

No grid of heights can hold it. The same file comes out bit for bit on every machine; it is kept in the repository so
that decks run without Python.
"""

import math
import os
import struct
import sys

# Profile (x, z) from the head to the foot: a plateau, the lip, the hollow below it, an apron.
PROFILE = [(0.0, 0.46), (0.15, 0.445), (0.30, 0.43), (0.42, 0.415), (0.52, 0.40), (0.60, 0.375), (0.625, 0.34), (0.60, 0.305),
           (0.53, 0.28), (0.47, 0.25), (0.45, 0.21), (0.48, 0.165), (0.56, 0.135), (0.68, 0.12), (0.84, 0.105), (1.02, 0.085), (1.2, 0.06)]
WIDTH, ROWS, FLOOR = 0.5, 13, -0.1


def place(i, j):
    """Corner i along the profile, j across: the lip bulges in the middle, and the ground is a little rough."""
    x, z = PROFILE[i]
    y = WIDTH * j / (ROWS - 1)
    bulge = 0.05 * math.sin(math.pi * j / (ROWS - 1)) * math.exp(-((i - 6) / 2.5) ** 2)
    rough = 0.006 * math.sin(2.3 * i + 1.7 * j) if 0 < i < len(PROFILE) - 1 and 0 < j < ROWS - 1 else 0.0
    return (round(x + bulge, 6), round(y, 6), round(z + rough, 6))


def terrain():
    n = len(PROFILE)
    top = [[place(i, j) for j in range(ROWS)] for i in range(n)]
    faces = []

    def quad(a, b, c, d):
        faces.append((a, b, c))
        faces.append((a, c, d))

    for i in range(n - 1):
        for j in range(ROWS - 1):
            quad(top[i][j], top[i + 1][j], top[i + 1][j + 1], top[i][j + 1])
    # Sides and floor: the outline of each side is closed by the corners of the floor.
    low = {(i, j): (top[i][j][0], top[i][j][1], FLOOR) for i in (0, n - 1) for j in range(ROWS)}
    for j in range(ROWS - 1):
        quad(low[0, j], top[0][j], top[0][j + 1], low[0, j + 1])
        quad(low[n - 1, j + 1], top[n - 1][j + 1], top[n - 1][j], low[n - 1, j])
        quad(low[0, j + 1], low[n - 1, j + 1], low[n - 1, j], low[0, j])
    for j, turned in ((0, False), (ROWS - 1, True)):
        outline = [low[0, j]] + [low[n - 1, j]] + [top[i][j] for i in reversed(range(n))]
        for a, b, c in ears(outline):
            faces.append((a, c, b) if turned else (a, b, c))
    return faces


def ears(points):
    """Triangles of a simple polygon in the plane y = const, anticlockwise in (x, z) as the points are."""
    def cross(a, b, c):
        return (b[0] - a[0]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[0] - a[0])

    left = list(points)
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            if cross(a, b, c) <= 1e-12:
                continue
            if any(min(cross(a, b, p), cross(b, c, p), cross(c, a, p)) >= 0 for p in left if p not in (a, b, c)):
                continue
            yield a, b, c
            del left[k]
            break
        else:
            raise ValueError("the outline crosses itself")
    yield tuple(left)


def write(path, faces):
    with open(path, "wb") as out:
        out.write(b"terrain with an overhang, made by make_overhang.py".ljust(80))
        out.write(struct.pack("<I", len(faces)))
        for a, b, c in faces:
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            length = math.sqrt(sum(q * q for q in n))
            out.write(struct.pack("<12fH", *[q / length for q in n], *a, *b, *c, 0))


if __name__ == "__main__":
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    write(os.path.join(folder, "overhang.stl"), terrain())

#!/usr/bin/env python3
"""Writes the small STL surfaces of this folder: a ball (binary) and a wedge (text).

Usage: make_stl.py [folder]     (default: the folder of this script)

The same files come out bit for bit on every machine; they are kept in the repository so that decks
run without Python.
"""

import math
import os
import struct
import sys


def normal(a, b, c):
    u = [b[k] - a[k] for k in range(3)]
    v = [c[k] - a[k] for k in range(3)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in n))
    return [x / length for x in n]


def ball(radius, divisions):
    """An octahedron, each face divided, all corners moved to the sphere; faces turned outwards."""
    faces = []
    axes = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    for sx in (1, -1):
        for sy in (1, -1):
            for sz in (1, -1):
                a, b, c = ([s * x for x in axis] for s, axis in zip((sx, sy, sz), axes))
                if sx * sy * sz < 0:
                    b, c = c, b

                def corner(i, j):
                    k = divisions - i - j
                    p = [(i * a[m] + j * b[m] + k * c[m]) / divisions for m in range(3)]
                    length = math.sqrt(sum(x * x for x in p))
                    return tuple(radius * x / length + 0.0 for x in p)

                for i in range(divisions):
                    for j in range(divisions - i):
                        faces.append((corner(i, j), corner(i + 1, j), corner(i, j + 1)))
                        if i + j < divisions - 1:
                            faces.append((corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)))
    return faces


def wedge(length, width, height):
    """A right-angled ramp that rises along x, its upright face at x = length."""
    p = [(x, y, z) for x, z in ((0.0, 0.0), (length, 0.0), (length, height)) for y in (0.0, width)]
    quads = [(0, 1, 3, 2), (2, 3, 5, 4), (4, 5, 1, 0)]
    faces = [(p[0], p[2], p[4]), (p[1], p[5], p[3])]
    for a, b, c, d in quads:
        faces += [(p[a], p[b], p[c]), (p[a], p[c], p[d])]
    return faces


def write_binary(path, faces):
    with open(path, "wb") as out:
        out.write(b"binary STL, metres".ljust(80))
        out.write(struct.pack("<I", len(faces)))
        for face in faces:
            out.write(struct.pack("<3f", *normal(*face)))
            for point in face:
                out.write(struct.pack("<3f", *point))
            out.write(struct.pack("<H", 0))


def write_text(path, faces, name):
    with open(path, "w", encoding="ascii", newline="\n") as out:
        out.write(f"solid {name}\n")
        for face in faces:
            out.write("  facet normal {:g} {:g} {:g}\n    outer loop\n".format(*normal(*face)))
            for point in face:
                out.write("      vertex {:g} {:g} {:g}\n".format(*point))
            out.write("    endloop\n  endfacet\n")
        out.write(f"endsolid {name}\n")


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    write_binary(os.path.join(folder, "ball.stl"), ball(0.1, 10))
    write_text(os.path.join(folder, "wedge.stl"), wedge(0.4, 0.2, 0.2), "wedge")


if __name__ == "__main__":
    main()

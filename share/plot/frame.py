#!/usr/bin/python3
"""Paints frames of a run as a picture: particles coloured by a field, boundaries as lines.

    share/plot/frame.py RUN --field pressure --time 0.2 0.5 1 -o dam.png
    share/plot/frame.py RUN --set water --field velocity --view 30 20 -o dam3.png
    share/plot/frame.py RELAXED --field number_density --time 0 100 --moment "step {:.0f}" -o pores.png

Takes the frames nearest to the given times (the last one without --time), one panel each. Vectors are
coloured by their length. A 3D run is seen from --view AZIMUTH ELEVATION, in degrees.
Needs python3-vtk9 and python3-matplotlib.
"""
import argparse
import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("run", type=Path, help="the run folder")
    parser.add_argument("--set", nargs="+", help="sets to paint; all without it")
    parser.add_argument("--field", default="velocity")
    parser.add_argument("--time", nargs="+", type=float, help="seconds")
    parser.add_argument("--range", nargs=2, type=float, metavar=("LOW", "HIGH"), help="of the colours")
    parser.add_argument("--window", nargs=4, type=float, metavar=("X0", "X1", "Z0", "Z1"),
                        help="part of the picture plane, m")
    parser.add_argument("--view", nargs=2, type=float, default=(-60, 20), metavar=("AZIMUTH", "ELEVATION"))
    parser.add_argument("--moment", default="t = {:.4g} s", metavar="TEXT",
                        help="above each panel, {} for the time; of 'sphgeo relax': --moment 'step {:.0f}'")
    parser.add_argument("--title", help="above the picture; the deck's own without it")
    parser.add_argument("--size", type=float, help="diameter of a particle, m; the resolution without it")
    parser.add_argument("--columns", type=int, default=3, help="panels in a row")
    parser.add_argument("--dpi", type=int, default=150)
    parser.add_argument("-o", "--output", type=Path, required=True)
    return parser.parse_args()


def collections(run, wanted):
    """{set: [(time, file)]} of the run's .pvd files, the wanted ones."""
    found = {}
    for pvd in sorted(run.rglob("*.pvd")):
        if wanted and pvd.stem not in wanted:
            continue
        found[pvd.stem] = [(float(e.get("timestep")), pvd.parent / e.get("file"))
                           for e in xml.parse(pvd).iter("DataSet")]
    missing = set(wanted or []) - set(found)
    if missing or not any(found.values()):
        sys.exit(f"{run}: no frames" + (f" of {', '.join(sorted(missing))}" if missing else ""))
    return {name: frames for name, frames in found.items() if frames}


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points_of(grid):
    if grid.GetNumberOfPoints() == 0:
        return np.zeros((0, 3))
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(float)


def field_of(grid, name):
    """The field as one number per point, and its unit; (None, "") when the set does not have it."""
    array = grid.GetPointData().GetArray(name)
    if array is None:
        return None, ""
    values = vtk_to_numpy(array)
    unit = ""
    information = array.GetInformation()
    if information.Has(array.UNITS_LABEL()):
        unit = information.Get(array.UNITS_LABEL())
    return (np.linalg.norm(values, axis=1) if values.ndim > 1 else values.astype(float)), unit


def cells_of(grid):
    """Corner numbers of the cells: shape (cells, 1) for particles, 2 for lines, 3 for triangles."""
    count = grid.GetNumberOfCells()
    if count == 0:
        return np.zeros((0, 1), int)
    return vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(count, -1)


class Camera:
    """Parallel projection; a 2D run is seen as it is."""

    def __init__(self, flat, azimuth, elevation):
        a, e = np.radians(azimuth), np.radians(elevation)
        right = np.array([-np.sin(a), np.cos(a), 0])
        back = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        if flat:
            right, back = np.array([1.0, 0, 0]), np.array([0, -1.0, 0])
        self.axes = np.array([right, np.cross(back, right), back])

    def see(self, points):
        """Picture coordinates and nearness of the points."""
        seen = points @ self.axes.T
        return seen[:, :2], seen[:, 2]


def deck_value(run, key):
    """A top-level value of resolved.yaml as text, or None."""
    deck = run / "resolved.yaml"
    text = deck.read_text(encoding="utf-8") if deck.is_file() else ""
    found = re.search(rf"^{key}:\s*(.+)$", text, re.MULTILINE)
    return found.group(1).strip().strip("'\"") if found else None


def paint(axes, grids, given, size, camera, limits):
    """Draws one moment; farther particles first. Returns what the colour bar needs."""
    places, nearness, colors, grey = [], [], [], []
    for grid in grids:
        points, cells = points_of(grid), cells_of(grid)
        seen, near = camera.see(points)
        if cells.shape[1] > 1:
            corners = seen[cells]
            if cells.shape[1] == 3:
                corners = np.concatenate([corners, corners[:, :1]], axis=1)
            lines = cells.shape[1] == 2
            axes.add_collection(LineCollection(corners, colors="#404040", linewidths=0.8 if lines else 0.2,
                                               alpha=1 if lines else 0.3))
            axes.update_datalim(seen)
            continue
        values, _ = field_of(grid, given.field)
        places.append(seen)
        nearness.append(near)
        grey.append(np.full(len(seen), values is None))
        colors.append(np.zeros(len(seen)) if values is None else values)
    axes.set_aspect("equal")
    axes.tick_params(labelsize=7)
    mapper = plt.cm.ScalarMappable(plt.Normalize(*limits), "viridis")
    if places:
        seen, order = np.concatenate(places), np.argsort(np.concatenate(nearness), kind="stable")
        tints = mapper.to_rgba(np.concatenate(colors))
        tints[np.concatenate(grey)] = (0.6, 0.6, 0.6, 1)
        wide = np.full(len(order), size)
        axes.add_collection(EllipseCollection(wide, wide, np.zeros(len(order)), units="xy", linewidths=0,
                                              offsets=seen[order], facecolors=tints[order],
                                              transOffset=axes.transData))
        axes.update_datalim(np.concatenate([seen.min(axis=0)[None] - size, seen.max(axis=0)[None] + size])
                            if len(seen) else np.zeros((0, 2)))
    axes.autoscale_view()
    if given.window:
        axes.set_xlim(given.window[:2])
        axes.set_ylim(given.window[2:])
    return mapper


def main():
    given = arguments()
    frames = collections(given.run, given.set)
    known = sorted({t for listed in frames.values() if len(listed) > 1 for t, _ in listed}) or \
        sorted({t for listed in frames.values() for t, _ in listed})
    times = [min(known, key=lambda t: abs(t - wanted)) for wanted in given.time or [known[-1]]]
    moments = [[read(min(listed, key=lambda f: abs(f[0] - time))[1]) for listed in frames.values()]
               for time in times]

    values = [field_of(g, given.field) for grids in moments for g in grids]
    unit = next((u for v, u in values if v is not None), "")
    values = [v[np.isfinite(v)] for v, _ in values if v is not None and np.isfinite(v).any()]
    if not values:
        sys.exit(f"{given.run}: no field '{given.field}' in these frames")
    limits = given.range or (min(v.min() for v in values), max(v.max() for v in values))

    flat = deck_value(given.run, "dimension") == "2" or \
        all(np.ptp(points_of(g)[:, 1]) == 0 for g in moments[0] if g.GetNumberOfPoints())
    camera = Camera(flat, *given.view)
    size = given.size or float((deck_value(given.run, "resolution") or "0.01").split()[0])

    columns = min(given.columns, len(times))
    rows = -(-len(times) // columns)
    figure, panels = plt.subplots(rows, columns, squeeze=False, figsize=(4.6 * columns + 1, 3.2 * rows),
                                  layout="constrained")
    for panel in panels.flat[len(times):]:
        panel.set_axis_off()
    for panel, time, grids in zip(panels.flat, times, moments):
        mapper = paint(panel, grids, given, size, camera, limits)
        panel.set_title(given.moment.format(time), fontsize=9)
        if flat:
            panel.set_xlabel("x (m)", fontsize=8)
            panel.set_ylabel("z (m)", fontsize=8)
        else:
            panel.set_axis_off()
    figure.colorbar(mapper, ax=panels, shrink=0.8,
                    label=given.field + (f" ({unit})" if unit not in ("", "1") else ""))
    figure.suptitle(given.title or deck_value(given.run, "title") or "", fontsize=11)
    given.output.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(given.output, dpi=given.dpi)


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Reads .vtu and .pvd files with VTK's own reader and checks that they are whole.

usage: read_vtu.py FILE_OR_FOLDER...      every frame: cells, fields, Threshold
       read_vtu.py --samples TEST_BINARY  lets the unit tests write frames of known content and checks it

Exit code 0 when all is well, 1 when a file is not, 77 (skipped) when VTK is not installed.
"""
import math
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

try:
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    from vtkmodules.vtkFiltersCore import vtkThreshold
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    from vtkmodules.vtkCommonDataModel import vtkDataObject
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

problems = []
complaints = vtkStringOutputWindow()
vtkOutputWindow.SetInstance(complaints)


def check(condition, where, what):
    if not condition:
        problems.append(f"{where}: {what}")


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    check(reader.CanReadFile(str(path)), path, "VTK says it cannot read it")
    reader.SetFileName(str(path))
    before = complaints.GetOutput() or ""
    reader.Update()
    said = (complaints.GetOutput() or "")[len(before):]
    check(not said.strip(), path, f"VTK complains: {said.strip()[:300]}")
    return reader.GetOutput()


def threshold_count(grid, array):
    """Cells that a Threshold over the whole range keeps: all of them when points have cells."""
    low, high = grid.GetPointData().GetArray(array).GetRange(0)
    keep = vtkThreshold()
    keep.SetInputData(grid)
    keep.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, array)
    keep.SetThresholdFunction(vtkThreshold.THRESHOLD_BETWEEN)
    keep.SetLowerThreshold(low)
    keep.SetUpperThreshold(high)
    keep.Update()
    return keep.GetOutput().GetNumberOfCells()


def check_frame(path):
    """Everything a frame promises, whatever it holds. Returns the grid."""
    grid = read(path)
    points, cells = grid.GetNumberOfPoints(), grid.GetNumberOfCells()
    for data, count in ((grid.GetPointData(), points), (grid.GetCellData(), cells)):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetArray(i)
            check(array.GetNumberOfTuples() == count, path,
                  f"{array.GetName()}: {array.GetNumberOfTuples()} values for {count}")
    check(cells > 0 or points == 0, path, f"{points} points without cells: Threshold shows none")
    vertices = cells > 0 and all(grid.GetCellType(i) == 1 for i in range(0, cells, max(1, cells // 100)))
    if vertices:
        check(cells == points, path, f"{cells} vertex cells for {points} points")
        names = [grid.GetPointData().GetArrayName(i) for i in range(grid.GetPointData().GetNumberOfArrays())]
        for name in names:
            if grid.GetPointData().GetArray(name).GetNumberOfComponents() != 1:
                continue
            values = vtk_to_numpy(grid.GetPointData().GetArray(name))
            finite = int((values == values).sum())
            if finite:
                check(threshold_count(grid, name) == finite, path, f"Threshold of {name} loses cells")
    return grid


def check_collection(path):
    """A .pvd: valid XML, rising times, and every file is there with the TimeValue it is first named at."""
    last, named = -math.inf, {}
    for entry in ElementTree.parse(path).getroot().iter("DataSet"):
        time, frame = float(entry.get("timestep")), path.parent / entry.get("file")
        check(time >= last, path, f"time {time} after {last}")
        last = time
        if not frame.exists():
            check(False, path, f"names {frame.name}, which is not there")
            continue
        if frame in named:   # what rests is written once and named again
            continue
        named[frame] = time
        stamp = read(frame).GetFieldData().GetArray("TimeValue")
        check(stamp is not None and stamp.GetValue(0) == time, frame, f"TimeValue is not {time}")


def check_samples(binary):
    """The clouds of tests/output/test_vtu.cpp, whose content is known."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([binary, "--test-suite=output", "--test-case=frames for VTK's own reader"],
                       check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "SPHGEO_VTU_SAMPLES": folder})
        for n in (0, 5, 40001):
            for kind, tolerance in (("packed", 1e-6), ("raw", 0)):
                path = Path(folder) / f"cloud_{n}_{kind}.vtu"
                grid = check_frame(path)
                check(grid.GetNumberOfPoints() == n, path, f"{grid.GetNumberOfPoints()} points for {n}")
                stamp = grid.GetFieldData().GetArray("TimeValue")
                check(stamp is not None and stamp.GetValue(0) == 0.125, path, "wrong TimeValue")
                data = grid.GetPointData()
                wanted = {"velocity": 3, "pressure": 1, "id": 1, "part <&>": 1}
                found = {data.GetArrayName(i): data.GetArray(i).GetNumberOfComponents()
                         for i in range(data.GetNumberOfArrays())}
                check(found == wanted, path, f"fields {found}")
                if found != wanted:
                    continue
                unit = data.GetArray("pressure").GetInformation().Get(data.GetArray("pressure").UNITS_LABEL())
                check(unit == "Pa", path, f"unit of the pressure: {unit}")
                for i in range(0, n, max(1, n // 500)):
                    ok = (data.GetArray("id").GetValue(i) == 2**40 + 7 * i
                          and data.GetArray("part <&>").GetValue(i) == -(i % 3)
                          and abs(data.GetArray("velocity").GetTuple3(i)[2] - (i + 0.5)) <= tolerance * i
                          and abs(grid.GetPoint(i)[0] - 0.1 * i) <= tolerance * 0.1 * i + 1e-12)
                    check(ok, path, f"wrong values of particle {i}")
        triangles = check_frame(Path(folder) / "mesh_triangles.vtu")
        check(triangles.GetNumberOfCells() == 2 and triangles.GetCellType(1) == 5, "triangles", "not two")
        check(triangles.GetCellData().GetArray("area") is not None, "triangles", "no cell data")
        lines = check_frame(Path(folder) / "mesh_lines.vtu")
        check(lines.GetNumberOfCells() == 3 and lines.GetCellType(0) == 3, "lines", "not three")
    return 8


def main(arguments):
    if len(arguments) == 2 and arguments[0] == "--samples":
        count = check_samples(arguments[1])
    else:
        files = []
        for name in map(Path, arguments):
            files += sorted([*name.rglob("*.vtu"), *name.rglob("*.pvd")]) if name.is_dir() else [name]
        for path in files:
            if path.suffix == ".pvd":
                check_collection(path)
            else:
                check_frame(path)
        count = len(files)
        check(count > 0, "read_vtu", "no file to read")
    for problem in problems[:50]:
        print(problem)
    print(f"{count} files, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

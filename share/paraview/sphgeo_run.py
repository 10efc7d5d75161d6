"""A ParaView macro: shows a run of sphgeo with all its sets, in fitting representations.

As a macro: Macros > Import new macro..., then open any .pvd of the run (or set SPHGEO_RUN to the run folder before
ParaView starts) and click it. From a terminal:

    pvpython share/paraview/sphgeo_run.py RUN [PICTURE.png]    paints the last moment
    SPHGEO_RUN=RUN paraview --script=share/paraview/sphgeo_run.py

Particles become balls of the size of their spacing, coloured by what matters for their set; boundaries stay
transparent. A 2D scene is seen from the front, with z up.
"""
import os
import re
import sys
from pathlib import Path

# What each kind of set is coloured by: the first of these that its frames hold.
FIELDS = {"water": ("velocity", "pressure"), "soil": ("plastic_strain", "velocity"), "solids": ("von_mises", "velocity")}
PLAIN = {"water": (0.36, 0.62, 0.86), "soil": (0.80, 0.64, 0.36), "solids": (0.58, 0.60, 0.65)}


def kind_of(name):
    """'solids' of 'solids_2': sets of solids may be several."""
    return "solids" if name.startswith("solids") else name


def collections(run):
    """{set: path of its .pvd file} of a run folder, particles first, boundaries last. Also takes the folder frames/ or
    a file in it. Raises FileNotFoundError when there are none."""
    run = Path(run)
    for folder in (run / "frames", run, run.parent):
        found = {p.stem: p for p in sorted(folder.glob("*.pvd"))}
        if found:
            return dict(sorted(found.items(), key=lambda f: f[0] == "boundaries"))
    raise FileNotFoundError(f"{run}: no .pvd files there or in frames/")


def run_folder(pvd):
    """The run folder of a .pvd file, or its own folder."""
    folder = Path(pvd).parent
    return folder.parent if folder.name == "frames" else folder


def deck_value(run, key):
    """A top-level number of resolved.yaml, or None."""
    deck = Path(run) / "resolved.yaml"
    text = deck.read_text(encoding="utf-8") if deck.is_file() else ""
    found = re.search(rf"^{key}:\s*([-+.\deE]+)\s*(?:#.*)?$", text, re.MULTILINE)
    return float(found.group(1)) if found else None


def field_of(name, arrays):
    """What to colour a set by, of the arrays that it has; None: its plain colour."""
    wanted = FIELDS.get(kind_of(name), ("velocity",))
    return next((f for f in wanted if f in arrays), None)


def where_from(arguments, environment, active_file):
    """The run folder: from the command line, the environment, an open file, or the current folder."""
    if arguments:
        return Path(arguments[0])
    if environment.get("SPHGEO_RUN"):
        return Path(environment["SPHGEO_RUN"])
    return run_folder(active_file) if active_file else Path.cwd()


def show_particles(pv, name, reader, view, spacing):
    display = pv.Show(reader, view)
    display.SetRepresentationType("Point Gaussian")
    display.ShaderPreset = "Sphere"
    display.GaussianRadius = spacing / 2
    arrays = [a.Name for a in (reader.PointData.GetArray(i) for i in range(reader.PointData.GetNumberOfArrays()))]
    field = field_of(name, arrays)
    if field is None:
        pv.ColorBy(display, None)
        display.DiffuseColor = PLAIN.get(kind_of(name), (0.7, 0.7, 0.7))
        return
    pv.ColorBy(display, ("POINTS", field, "Magnitude") if field == "velocity" else ("POINTS", field))
    # Over all times, so that equal colours mean the same in every frame.
    display.RescaleTransferFunctionToDataRangeOverTime()
    display.SetScalarBarVisibility(view, True)


def show_boundaries(pv, reader, view, flat):
    display = pv.Show(reader, view)
    display.SetRepresentationType("Surface")
    pv.ColorBy(display, None)
    display.DiffuseColor = display.AmbientColor = (0.5, 0.52, 0.55)
    if flat:
        display.LineWidth = 2
    else:
        display.Opacity = 0.15


def show(pv, run):
    """Opens all sets of a run in the active view; `pv` is paraview.simple. Returns the readers by set."""
    files = collections(run)
    run = run_folder(next(iter(files.values())))
    flat = deck_value(run, "dimension") == 2
    view = pv.GetActiveViewOrCreate("RenderView")
    readers = {}
    for name, path in files.items():
        reader = readers[name] = pv.PVDReader(registrationName=f"{run.name}: {name}", FileName=str(path))
        reader.UpdatePipeline()
        if name == "boundaries":
            show_boundaries(pv, reader, view, flat)
        else:
            show_particles(pv, name, reader, view, deck_value(run, "resolution") or 0.01)
    scene = pv.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    view.CameraPosition, view.CameraFocalPoint = ((0, -1, 0) if flat else (0.5, -1, 0.45)), (0, 0, 0)
    view.CameraViewUp = (0, 0, 1)
    view.CameraParallelProjection = 1 if flat else 0
    pv.ResetCamera(view)
    pv.Render(view)
    return readers


def main(arguments):
    import paraview.simple as pv
    source = pv.GetActiveSource()
    show(pv, where_from(arguments, os.environ, getattr(source, "FileName", None)))
    if len(arguments) > 1:
        pv.SaveScreenshot(arguments[1], pv.GetActiveView(), ImageResolution=(1600, 1000))


# ParaView may run a macro under any name, and then the arguments are its own; a test imports this file under its own.
if __name__ != "sphgeo_run":
    main([a for a in getattr(sys, "argv", [])[1:] if __name__ == "__main__" and not a.startswith("-")])

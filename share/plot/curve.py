#!/usr/bin/python3
"""Draws a probe of one or more runs beside a measured curve.

    share/plot/curve.py RUN [RUN ...] --probe sensor1 --reference share/reference/lobovsky2014_p1.csv \\
        --x-scale 0.17487 --y-scale 2934 --xlabel 't sqrt(g/H)' --ylabel 'p / (rho g H)' -o impact.png

Times of the runs are divided by --x-scale and values by --y-scale; the reference is drawn as it is. A run is
named after its folder, or by RUN=NAME. Needs python3-matplotlib.
"""
import argparse
import csv
from pathlib import Path

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN", help="run folder, or folder=name")
    parser.add_argument("--probe", required=True, help="name of the probe")
    parser.add_argument("--column", help="its column; the first without it")
    parser.add_argument("--reference", type=Path, help="CSV with a header row; the first two columns are drawn")
    parser.add_argument("--reference-name", default="measured")
    parser.add_argument("--x-scale", type=float, default=1.0)
    parser.add_argument("--y-scale", type=float, default=1.0)
    parser.add_argument("--xlim", nargs=2, type=float)
    parser.add_argument("--ylim", nargs=2, type=float)
    parser.add_argument("--xlabel", default="t [s]")
    parser.add_argument("--ylabel")
    parser.add_argument("--dpi", type=int, default=110)
    parser.add_argument("-o", "--output", type=Path, required=True)
    return parser.parse_args()


def read(path):
    """The columns of a table by name; cells without a number are None."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(line for line in file if not line.startswith("#"))
        names = [n.split("[")[0].strip() for n in next(rows)]
        table = {n: [] for n in names}
        for row in rows:
            for name, cell in zip(names, row):
                table[name].append(float(cell) if cell.strip() else None)
    return names, table


def main():
    args = arguments()
    figure, axes = plt.subplots(figsize=(7.2, 3.6), constrained_layout=True)
    for run in args.runs:
        folder, _, name = run.partition("=")
        names, table = read(Path(folder) / "probes" / f"{args.probe}.csv")
        column = args.column or names[1]
        points = [(t, y) for t, y in zip(table[names[0]], table[column]) if y is not None]
        axes.plot([t / args.x_scale for t, _ in points], [y / args.y_scale for _, y in points], lw=0.8,
                  label=name or Path(folder).name)
    if args.reference:
        names, table = read(args.reference)
        axes.plot(table[names[0]], table[names[1]], "k.", ms=4, label=args.reference_name)
    axes.set(xlabel=args.xlabel, ylabel=args.ylabel or args.probe, xlim=args.xlim, ylim=args.ylim)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(args.output, dpi=args.dpi, metadata={"Software": None})


if __name__ == "__main__":
    main()

"""Claims of decks: their values from probe tables, also of scenes that were turned or mirrored, and how much of what is allowed
they take up."""
import csv
import math


class NoMeaning(Exception):
    """A claim that cannot be judged, as a sentence."""


def read_probe(path):
    """The columns of a probe's table by name, without units."""
    with open(path, encoding="utf-8") as text:
        rows = list(csv.reader(line for line in text if not line.startswith("#")))
    names = [name.split(" [")[0] for name in rows[0]]
    return {name: [float(r[k]) if r[k] else math.nan for r in rows[1:]] for k, name in enumerate(names)}


def partner(name, columns):
    """The stem and axis of a column that is a component of a vector: center_z -> center_, z."""
    stem, axis = name[:-1], name[-1]
    if axis in "xz" and stem + "x" in columns and stem + "z" in columns and not stem.startswith("semi_axis"):
        return stem, axis
    return None, None


def old_column(columns, name, change, kind):
    """A column as it would be in the coordinates of the scene before it was changed."""
    values = columns[name]
    if kind in ("energy", "amount", "penetration", "mean", "front", "pressure", "deposit", "water_level", "flux"):
        return values
    stem, axis = partner(name, columns)
    if change.word == "mirrored":
        if "torque" in name:  # turns the other way, except about x
            odd = not name.endswith("_x")
        else:
            odd = axis == "x" if stem else name[-2:] in ("xy", "xz")
        return [-v for v in values] if odd else values
    if stem:
        x, z = columns[stem + "x"], columns[stem + "z"]
        return [change.c * a + change.s * b if axis == "x" else change.c * b - change.s * a for a, b in zip(x, z)]
    if name.endswith(("torque", "_y", "uy", "vy", "area", "volume", "plastic_strain", "volume_fraction")) and not name.startswith("semi_axis"):
        return values
    raise NoMeaning(f"the column {name} of a {kind} probe belongs to the axes")


def window(times, values, low, high):
    """Samples between two times, and interpolated at them."""
    all_of = [(t, v) for t, v in zip(times, values) if not math.isnan(v)]

    def at(time):
        for (t0, y0), (t1, y1) in zip(all_of, all_of[1:]):
            if t0 <= time <= t1:
                return [(time, y0 + (y1 - y0) * (time - t0) / (t1 - t0))]
        return []

    inside = [p for p in all_of if low <= p[0] <= high]
    first = at(low) if not inside or inside[0][0] > low else []
    last = at(high) if not inside or inside[-1][0] < high else []
    return first + inside + last


def reduce(times, values, claim):
    """One number from a column, as the program reduces it."""
    pairs = window(times, values, claim["from"] if claim["from"] != "auto" else -math.inf, claim["to"] if claim["to"] != "auto" else math.inf)
    if not pairs:
        raise NoMeaning("no sample lies within its times")
    t, y = [p[0] for p in pairs], [p[1] for p in pairs]
    how = claim["reduce"]
    simple = {"last": lambda: y[-1], "first": lambda: y[0], "min": lambda: min(y), "max": lambda: max(y),
              "max_abs": lambda: max(map(abs, y)), "range": lambda: max(y) - min(y)}
    if how in simple:
        return simple[how]()
    if how == "mean":
        if len(y) < 2:
            return y[0]
        return sum((t[i + 1] - t[i]) * (y[i] + y[i + 1]) / 2 for i in range(len(y) - 1)) / (t[-1] - t[0])
    if how == "growth":
        lowest, most = y[0], 0.0
        for v in y:
            lowest = min(lowest, v)
            most = max(most, v - lowest)
        return most
    if how == "slope":
        middle_t, middle_y = sum(t) / len(t), sum(y) / len(y)
        return sum((a - middle_t) * (b - middle_y) for a, b in zip(t, y)) / sum((a - middle_t) ** 2 for a in t)
    raise NoMeaning(f"'{how}' is not known here")


def measure(claim, run, probes, change):
    """Value of a claim and what its column starts with, both shifted and scaled. `probes`: kinds by name."""
    probe, _, column = claim["probe"].rpartition(".")
    if not probe:
        probe, column = column, None
    table = run / "probes" / f"{probe}.csv"
    if not table.is_file():
        raise NoMeaning(f"a {probes.get(probe, 'missing')} probe has no meaning there")
    columns = read_probe(table)
    times = columns.pop("time")
    name = column or next(iter(columns))
    values = old_column(columns, name, change, probes[probe]) if change else columns[name]
    scaled = lambda v: (v + claim["shift"]) / claim["scale"]  # noqa: E731
    whole = claim["reduce"] in ("last", "min", "max", "mean", "first", "at")
    start = next((v for v in values if not math.isnan(v)), math.nan)
    return scaled(reduce(times, values, claim)), scaled(start) if whole else 0.0


def margin(claim, value, start):
    """What share of the allowed a value takes up; more than 1 is missed.

    A value that is to stay within a tolerance of its reference: error over tolerance. One that is to stay on its side of a bound:
    how far it went there from its start, over how far it might. One that starts beyond the bound and has to cross it: how far it
    has to go over how far it went.
    """
    if not math.isfinite(value):
        return math.inf
    bound = claim["tolerance"]
    if claim["measure"] == "within":
        error = abs(value - claim["reference"])
        if claim["tolerance_kind"] == "relative":
            error /= abs(claim["reference"])
        return error / bound if bound > 0 else (0.0 if error == 0 else math.inf)
    sign = 1 if claim["measure"] == "below" else -1
    room, used = sign * (bound - start), sign * (value - start)
    if room >= 0:
        if used <= 0:
            return 0.0
        return used / room if room > 0 else math.inf
    return room / used if used < 0 else math.inf

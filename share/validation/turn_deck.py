#!/usr/bin/env python3
"""The same scene turned in the x-z plane, or mirrored in x: rewrites a deck whose numbers are resolved.

    share/validation/turn_deck.py RUN/resolved.yaml --turn 17 [--sound-speed C0] -o turned.yaml
    share/validation/turn_deck.py RUN/resolved.yaml --mirror -o mirrored.yaml

Turned shapes are filled with `filling: relaxed`, as no lattice fits them. Hydrostatic and geostatic starts become formulas in the
coordinates of the old deck, tanks walls. Water whose speed of sound follows from heights needs --sound-speed, that of the old deck
(`sphgeo check --json`). What cannot be carried over ends with exit 1 and a sentence. Probes that have no meaning in the new
scene, and `expect`, are left out; claims.py takes the columns of the others back to the old coordinates.
"""
import argparse
import copy
import math
import re
import sys

import yaml

AXES = "xyz"
EXACT = "{:.17g}".format


class Loader(yaml.SafeLoader):
    """Reads 1e-6 as a number, as sphgeo does."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9]+[eE][-+]?[0-9]+$"), list("-+0123456789"))


def load(path):
    with open(path, encoding="utf-8") as text:
        return yaml.load(text, Loader)


class NotApplicable(Exception):
    """A construct that cannot be carried over, as a sentence."""


class Turn:
    """By an angle (rad) in the x-z plane about the origin, x towards z."""
    word = "turned"

    def __init__(self, angle):
        self.angle, self.c, self.s = angle, math.cos(angle), math.sin(angle)
        c, s = EXACT(self.c), EXACT(self.s)
        self.old = {"x": f"({c}*x+{s}*z)", "y": "y", "z": f"({c}*z-{s}*x)"}

    def vector(self, v):
        x, y, z = v
        if all(isinstance(n, (int, float)) for n in v):
            return [self.c * x - self.s * z, y, self.s * x + self.c * z]
        c, s = EXACT(self.c), EXACT(self.s)
        return [f"{c}*({x})-{s}*({z})", y, f"{s}*({x})+{c}*({z})"]

    def tensor(self, t):
        """xx, yy, zz, xy, yz, xz as formulas or numbers."""
        xx, yy, zz, xy, yz, xz = (f"({n})" for n in t)
        c, s, cc, ss, cs = (EXACT(n) for n in (self.c, self.s, self.c**2, self.s**2, self.c * self.s))
        return [f"{cc}*{xx}+{ss}*{zz}-2*{cs}*{xz}", yy, f"{ss}*{xx}+{cc}*{zz}+2*{cs}*{xz}",
                f"{c}*{xy}-{s}*{yz}", f"{s}*{xy}+{c}*{yz}", f"{cs}*{xx}-{cs}*{zz}+({cc}-{ss})*{xz}"]

    def shape(self, shape):
        return {"type": "transform", "rotate": self.angle, "of": copy.deepcopy(shape)}

    def axial(self, axis):
        """An axis of rotation."""
        return self.vector(axis)


class Mirror:
    """x becomes -x."""
    word = "mirrored"
    old = {"x": "(-x)", "y": "y", "z": "z"}

    def vector(self, v):
        return [-v[0] if isinstance(v[0], (int, float)) else f"-({v[0]})", v[1], v[2]]

    def tensor(self, t):
        xx, yy, zz, xy, yz, xz = t
        return [xx, yy, zz, f"-({xy})", yz, f"-({xz})"]

    def axial(self, axis):
        return [axis[0], -axis[1], -axis[2]]

    def shape(self, shape):
        shape = copy.deepcopy(shape)
        kind = shape["type"]
        if isinstance(shape.get("of"), dict):
            shape["of"] = self.shape(shape["of"])
        elif isinstance(shape.get("of"), list):
            shape["of"] = [self.shape(s) for s in shape["of"]]
        if kind == "box":
            shape["min"][0], shape["max"][0] = -shape["max"][0], -shape["min"][0]
        elif kind == "transform":
            shape["about"], shape["translate"] = self.vector(shape["about"]), self.vector(shape["translate"])
            shape["axis"] = self.axial(shape["axis"])
        elif kind in ("polygon", "prism"):
            shape["points"] = [self.vector(p) for p in reversed(shape["points"])]
        elif kind in ("sphere", "ellipsoid", "cylinder", "capsule", "cone", "half_space"):
            for key in ("center", "from", "to", "point", "normal"):
                if key in shape:
                    shape[key] = self.vector(shape[key])
        elif kind not in ("union", "difference", "intersection", "complement", "shell"):
            raise NotApplicable({"boulder": "the random shape of a boulder has no mirror image in a deck"}.get(
                kind, f"a shape of type {kind} has no mirror image in a deck"))
        return shape


def formula(change, text):
    """A formula of x, y, z in terms of the new coordinates."""
    if not isinstance(text, str):
        return text
    return re.sub(r"(?<![\w.])[xyz](?![\w(])", lambda m: change.old[m.group()], text)


def given(value):
    return value not in (None, "auto")


def top_of(shape):
    """Highest z of a shape of boxes, spheres and what is made of them."""
    kind = shape["type"]
    if kind == "box":
        return shape["max"][2]
    if kind == "sphere":
        return shape["center"][2] + shape["radius"]
    if kind == "polygon":
        return max(p[2] for p in shape["points"])
    if kind == "difference":
        return top_of(shape["of"][0])
    if kind == "union":
        return max(map(top_of, shape["of"]))
    raise NotApplicable(f"the level of a hydrostatic or geostatic start follows from the top of a {kind}")


class Rewrite:
    def __init__(self, deck, change, sound_speed=None):
        self.deck, self.change, self.sound_speed = copy.deepcopy(deck), change, sound_speed
        self.gravity = deck["gravity"]
        self.materials = {m["name"]: m for m in deck["materials"]}

    def run(self):
        deck, change = self.deck, self.change
        deck["title"] += f", {change.word}"
        deck["gravity"] = change.vector(deck["gravity"])
        if given(deck.get("body_force")):
            deck["body_force"] = change.vector([formula(change, f) for f in deck["body_force"]])
        for material in deck["materials"]:
            if material["type"] == "water" and self.sound_speed:
                material["sound_speed"], material["max_speed"] = self.sound_speed, "auto"
        for body in deck["bodies"]:
            self.body(body)
        deck["boundaries"] = [self.boundary(b) for b in deck.get("boundaries") or []]
        self.domain(deck["numerics"])
        if given(deck.get("relaxation", {}).get("file")):
            raise NotApplicable("its pore water is read from a file")
        deck["probes"] = [p for p in map(self.probe, deck.get("probes") or []) if p]
        deck["expect"] = []
        return deck

    def body(self, body):
        change = self.change
        if given(body.get("copies")):
            raise NotApplicable(f"the copies of body '{body['name']}' are placed at random")
        down = -self.gravity[2]
        density = self.materials[body["material"]]["density"]
        z = change.old["z"]
        if body.get("pressure") == "hydrostatic":
            level = body["level"] if given(body.get("level")) else top_of(body["shape"])
            body["pressure"], body["level"] = f"max(0,{EXACT(density * down)}*({EXACT(level)}-{z}))", "auto"
        elif body.get("pressure") == "hydraulic_head":
            body["pressure"] = f"max(0,{EXACT(density * down)}*({formula(change, body['head'])}-{z}))"
            body["head"] = "auto"
        else:
            body["pressure"] = formula(change, body.get("pressure", "zero"))
        if body.get("stress") == "geostatic":
            self.geostatic(body, density, down, z)
        elif given(body.get("stress_tensor")):
            body["stress_tensor"] = change.tensor([formula(change, f) for f in body["stress_tensor"]])
        for key in ("volume_fraction", "porosity", "saturation"):
            body[key] = formula(change, body.get(key, "auto"))
        body["velocity"] = change.vector([formula(change, f) for f in body["velocity"]])
        body["shape"] = change.shape(body["shape"])
        if change.word == "turned":
            body["filling"] = "relaxed"
        for clamped in body.get("clamped") or []:
            clamped["shape"] = change.shape(clamped["shape"])
            self.motion(clamped)

    def geostatic(self, body, density, down, z):
        soil = self.materials[body["material"]]
        fraction = next((f for f in (body.get("volume_fraction"), soil.get("volume_fraction")) if given(f)), None)
        if fraction is None or isinstance(fraction, str) or given(body.get("porosity")):
            raise NotApplicable(f"the geostatic stress of body '{body['name']}' follows from a porosity that varies")
        level = body["level"] if given(body.get("level")) else top_of(body["shape"])
        if given(body.get("lateral_stress_ratio")):
            ratio = body["lateral_stress_ratio"]
        elif given(soil.get("friction_angle")):
            ratio = 1 - math.sin(soil["friction_angle"])
        else:
            raise NotApplicable(f"the lateral stress of body '{body['name']}' is not stated")
        upright = f"(-max(0,{EXACT(density * fraction * down)}*({EXACT(level)}-{z})))"
        side = f"({EXACT(ratio)}*{upright})"
        body["stress_tensor"] = self.change.tensor([side, side, upright, "0", "0", "0"])
        body["stress"], body["level"], body["lateral_stress_ratio"] = "zero", "auto", "auto"

    def motion(self, part):
        motion = part.get("motion")
        if not given(motion):
            return
        if given(motion.get("table")):
            raise NotApplicable("a motion is read from a table")
        motion["displacement"] = self.change.vector(motion["displacement"])
        motion["center"] = self.change.vector(motion["center"])
        motion["axis"] = self.change.axial(motion["axis"])
        if given(motion.get("waves")):
            motion["waves"]["direction"] = self.change.vector(motion["waves"]["direction"])

    def boundary(self, wall):
        if wall["type"] == "tank":
            shape = self.walls_of(wall)
            wall = {"type": "wall", "name": wall["name"], "shape": shape, "slip": wall["slip"], "motion": wall.get("motion", "auto")}
        elif wall["type"] in ("inlet", "reservoir", "outlet"):
            return self.crossed(wall)
        elif wall["type"] != "wall":
            raise NotApplicable(f"a boundary of type {wall['type']}")
        wall["shape"] = self.change.shape(wall["shape"])
        self.motion(wall)
        return wall

    def crossed(self, boundary):
        """A boundary that particles cross."""
        kind = boundary["type"]
        if self.change.word == "turned" and kind != "outlet":
            raise NotApplicable(f"an {kind} lies along the axes" if kind == "inlet" else "a reservoir holds a level in z")
        if kind == "inlet":
            boundary["min"], boundary["max"] = self.change.vector(boundary["min"]), self.change.vector(boundary["max"])
            boundary["min"][0], boundary["max"][0] = sorted((boundary["min"][0], boundary["max"][0]))
            boundary["velocity"] = self.change.vector([formula(self.change, f) for f in boundary["velocity"]])
        else:
            boundary["shape"] = self.change.shape(boundary["shape"])
        return boundary

    def walls_of(self, tank):
        """The tank as a difference of boxes; an open face stays open."""
        factors = [f for f in (self.deck["numerics"].get(k) for k in ("h_factor_water", "h_factor_soil")) if given(f)]
        by = math.ceil(2 * max([1.8] + factors)) * self.deck["resolution"]
        outer, inner = ([list(tank["min"]), list(tank["max"])] for _ in range(2))
        faces = {"left": (0, 0), "right": (1, 0), "front": (0, 1), "back": (1, 1), "bottom": (0, 2), "top": (1, 2)}
        for name, (high, axis) in faces.items():
            if axis == 1 and self.deck["dimension"] == 2:
                continue
            moved = inner if name in tank["open"] else outer
            moved[high][axis] += by if high else -by
        return {"type": "difference", "of": [{"type": "box", "min": b[0], "max": b[1]} for b in (outer, inner)]}

    def domain(self, numerics):
        low, high = numerics.get("domain_min"), numerics.get("domain_max")
        if not given(low) and not given(high):
            return
        if given(low) and given(high):
            corners = [self.change.vector([(low, high)[a >> k & 1][k] for k in range(3)]) for a in range(8)]
            numerics["domain_min"] = [min(c[k] for c in corners) for k in range(3)]
            numerics["domain_max"] = [max(c[k] for c in corners) for k in range(3)]
        elif self.change.word == "mirrored" and given(high):
            # One side is open, and only the other was given: x changes its end, so all is left to the program.
            numerics["domain_max"] = "auto"
        else:
            numerics["domain_min"] = numerics["domain_max"] = "auto"

    def probe(self, probe):
        """The probe in the new scene; nothing when it has no meaning there."""
        change, kind = self.change, probe["type"]
        turned = change.word == "turned"
        if any(given(probe.get(k)) for k in ("region_min", "region_max")):
            return None
        if kind in ("energy", "amount", "penetration", "moments", "body_force", "force", "exchange"):
            return probe
        if kind in ("pressure", "velocity", "stress", "material_point"):
            probe["at"] = change.vector(probe["at"])
            return probe
        if kind == "mean":
            for key in ("region", "over"):
                if given(probe.get(key)):
                    probe[key] = change.shape(probe[key])
            return probe
        if kind == "front":
            probe["direction"] = change.vector(probe["direction"])
            return probe
        if turned:
            return None
        if kind == "deposit":
            probe["origin"], probe["direction"] = change.vector(probe["origin"]), change.vector(probe["direction"])
            return probe
        if kind == "flux":
            probe["point"], probe["normal"] = change.vector(probe["point"]), change.vector(probe["normal"])
            return probe
        if kind == "water_level":
            for key in ("at", "minus"):
                if given(probe.get(key)):
                    probe[key] = change.vector(probe[key])
            return probe
        return None


def change_of(word, angle=17):
    return Mirror() if word == "mirrored" else Turn(math.radians(angle))


def rewrite(deck, change, sound_speed=None):
    """The deck (as loaded from resolved.yaml) after the change. Raises NotApplicable."""
    return Rewrite(deck, change, sound_speed).run()


def save(deck, path):
    with open(path, "w", encoding="utf-8") as out:
        yaml.safe_dump(deck, out, sort_keys=False, width=1000)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("deck", help="resolved.yaml of a run")
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--turn", type=float, metavar="DEGREES")
    how.add_argument("--mirror", action="store_true")
    parser.add_argument("--sound-speed", type=float, metavar="C0", help="of the water, m/s")
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    deck = load(options.deck)
    try:
        save(rewrite(deck, Mirror() if options.mirror else Turn(math.radians(options.turn)), options.sound_speed), options.output)
    except NotApplicable as e:
        print(f"{options.deck}: not applicable: {e}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

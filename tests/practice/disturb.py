#!/usr/bin/env python3
"""Copies a rig's scenario and a recording set with a fault of the kind that laboratories have; the physics in it stays as it is.

    disturb.py SCENARIO SET OUT FAULT        OUT/scenario.toml, its robots beside it, and the recording in OUT/set

sigma=F      the stated noise is F times the true one
no-noise     no noise is stated
ar1=R        noise of the stated size with the correlation R from sample to sample is added, and the stated noise grows by the square root of two
outliers=P   a share P of all samples is off by twenty times the noise
clip=S       the first body rate, joint rate or force is cut at S times its largest size
rename       the rig has another name
links        links, joints, vehicles, shapes, actuators and sensors have other names, in robots, scenario and recording (`NAMES` in OUT/names.json)
turned       the world is turned: positions, attitudes and velocities in its axes, gravity, and bases that stand in it
wrong=SEED   masses off by 3 % and centres of mass by 5 mm in the robots' files, and [tolerance] says so (wrong_nominals.py)

CSV and Parquet (pyarrow from PyPI). Numbers come from a generator seeded by the set's name.
"""

import csv
import json
import math
import pathlib
import random
import re
import shutil
import sys
import tomllib

from wrong_nominals import wrong

SIZE = 20.0  # of an outlier, in units of noise
IN_TABLES = ("outliers", "ar1", "clip", "turned")
FAULTS = IN_TABLES + ("sigma", "no-noise", "rename", "links", "wrong")


class Table:
    """One run: channel → values, none where it was not sampled."""

    def __init__(self, path):
        self.path, self.is_csv = path, path.suffix == ".csv"
        if self.is_csv:
            with open(path, newline="") as file:
                header, *rows = list(csv.reader(file))
            self.digits = [max((len(row[i].partition(".")[2]) for row in rows), default=6) for i in range(len(header))]
            self.columns = {name: [float(row[i]) if row[i] else None for row in rows] for i, name in enumerate(header)}
            self.time = [row[0] for row in rows]
        else:
            import pyarrow.parquet

            self.columns = pyarrow.parquet.read_table(path).to_pydict()

    def write(self, path, names=lambda channel: channel):
        if self.is_csv:
            text = [["" if v is None else f"{v:.{d}f}" for v in column] for column, d in zip(self.columns.values(), self.digits)]
            text[0] = self.time
            with open(path, "w", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow([names(channel) for channel in self.columns])
                writer.writerows(zip(*text))
        else:
            import pyarrow
            import pyarrow.parquet

            columns = {names(channel): pyarrow.array(values) for channel, values in self.columns.items()}
            pyarrow.parquet.write_table(pyarrow.table(columns), path)


def sigma_of(noise, channel):
    found = [s for prefix, s in noise.items() if channel == prefix or channel.startswith(prefix + ".")]
    if not found or channel.startswith("drive."):
        return None
    # About an axis a turn is twice as large as in the quaternion.
    return found[0] / 2 if ".orientation." in channel else found[0]


def each(values, change):
    return [None if v is None else change(v) for v in values]


def spoil(table, noise, kind, amount, dice):
    """Outliers, coloured noise, or one channel that is clipped."""
    for channel, values in table.columns.items():
        sigma = sigma_of(noise, channel)
        if sigma is None:
            continue
        if kind == "outliers":
            table.columns[channel] = each(values, lambda v: v + (dice.choice([-1, 1]) * SIZE * sigma if dice.random() < amount else 0.0))
        elif kind == "ar1":
            state = dice.gauss(0, 1)

            def coloured(v):
                nonlocal state
                out = v + sigma * state
                state = amount * state + (1 - amount**2) ** 0.5 * dice.gauss(0, 1)
                return out

            table.columns[channel] = each(values, coloured)
        elif kind == "clip" and not (".orientation" in channel or ".position" in channel):
            limit = amount * max((abs(v) for v in values if v is not None), default=0.0)
            table.columns[channel] = each(values, lambda v: max(-limit, min(limit, v)))
            return


def turn_of(scenario):
    """The turn of the world, a unit quaternion: about the vertical where bodies move in a plane."""
    axis, angle = ((0.0, 0.0, 1.0), 0.7) if re.search(r"free\s*=\s*\[", scenario) else ((0.267261, 0.534522, 0.801784), 0.9)
    return (math.cos(angle / 2), *(math.sin(angle / 2) * a for a in axis))


def product(a, b):
    (aw, ax, ay, az), (bw, bx, by, bz) = a, b
    return (aw * bw - ax * bx - ay * by - az * bz, aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx, aw * bz + ax * by - ay * bx + az * bw)


def turned(q, v):
    w, x, y, z = q
    return product(product(q, (0.0, *v)), (w, -x, -y, -z))[1:]


def turn(table, q):
    """Vectors in the world's axes, a measured drive's and a mechanism's among them (the stage does not turn), and attitudes."""
    groups = {}
    for channel in table.columns:
        prefix, _, component = channel.rpartition(".")
        groups.setdefault(prefix, []).append(component)
    for prefix, components in groups.items():
        family, _, quantity, *_ = (*prefix.split("."), "", "")
        is_vector = (family in ("body", "drive") and quantity in ("position", "linear_velocity")) or prefix == "sensor.spring.force"
        if family == "body" and quantity == "orientation":
            components, change = ["w", "x", "y", "z"], lambda row: product(q, row)
        elif is_vector:
            components, change = [c for c in "xyz" if c in components], lambda row: turned(q, (*row, 0.0)[:3])
        else:
            continue
        keys = [f"{prefix}.{c}" for c in components]
        rows = [row if None in row else change(row) for row in zip(*(table.columns[k] for k in keys))]
        for i, key in enumerate(keys):
            table.columns[key] = [row[i] for row in rows]


def turn_scenario(text, q):
    """Gravity, and bases that stand in the world; where free bodies begin is estimated."""
    vector = lambda m: "gravity_m_per_s2 = [" + ", ".join(repr(x) for x in turned(q, json.loads(m[1]))) + "]"
    text = re.sub(r"gravity_m_per_s2\s*=\s*(\[[^\]]*\])", vector, text)
    if re.search(r"free\s*=\s*\[", text):  # what moves in a plane is turned about its normal
        return text
    return re.sub(r'^base = "fixed"', f'base = "fixed"\npose = {{ quaternion_wxyz = {list(q)} }}', text, flags=re.M)


def names_of(scenario, robots):
    """Old name → new name of all that has one."""
    found = [m for urdf in robots.values() for m in re.findall(r'<(?:link|joint)\s+name="([^"]+)"', urdf)]
    described = tomllib.loads(scenario)
    for kind in ("vehicle", "shape", "actuator", "sensor", "mechanism", "drive"):
        found += [entry["name"] for entry in described.get(kind, [])]
    return {name: f"part{i:02d}" for i, name in enumerate(sorted(set(found)))}


def renamed(names, text):
    """A channel, a place or a path with the new names of its parts."""
    return "".join(names.get(part, part) for part in re.split(r"([./:])", text))


def in_text(names, text):
    """TOML whose strings but those of files, and whose keys of joints, have the new names."""
    text = re.sub(r'"([^"\n]*)"', lambda m: m[0] if m[1].endswith((".urdf", ".csv", ".parquet")) else f'"{renamed(names, m[1])}"', text)
    return re.sub(r"^(\w+)( = \{ position_)", lambda m: names.get(m[1], m[1]) + m[2], text, flags=re.M)


def main():
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    scenario, source, out = (pathlib.Path(a) for a in sys.argv[1:4])
    kind, _, amount = sys.argv[4].partition("=")
    if kind not in FAULTS:
        sys.exit(f"unknown fault {sys.argv[4]}\n{__doc__}")
    disturb(scenario, source, out, kind, amount)


def disturb_manifest(text, kind, amount, names):
    if kind in ("sigma", "ar1"):
        by = float(amount) if kind == "sigma" else 2**0.5
        head, section, tail = re.split(r"(\[noise\]\n.*?)(?=\n\[)", text, maxsplit=1, flags=re.S)
        return head + re.sub(r'"([^"]+)"\s*=\s*(\S+)', lambda m: f'"{m[1]}" = {float(m[2]) * by}', section) + tail
    if kind == "no-noise":
        return re.sub(r"\[noise\]\n.*?\n(?=\[)", "", text, count=1, flags=re.S)
    if kind == "rename":
        return re.sub(r'rig(\s*)= "[^"]*"', r'rig\1= "another"', text, count=1)
    return in_text(names, text)


def disturb_scenario(scenario, out, kind, amount):
    """OUT/scenario.toml and its robots; the new names."""
    text = scenario.read_text()
    robots = {urdf: (scenario.parent / urdf).resolve().read_text() for urdf in sorted(set(re.findall(r'^urdf\s*=\s*"([^"]+)"', text, re.M)))}
    names = names_of(text, robots) if kind == "links" else {}
    dice = random.Random(int(amount)) if kind == "wrong" else None
    for urdf, robot in robots.items():
        if kind == "wrong":
            robot = wrong(robot, dice, 0.03, 0.005)
        robot = re.sub(r'\b(name|link|joint)="([^"]+)"', lambda m: f'{m[1]}="{names.get(m[2], m[2])}"', robot)
        file = pathlib.Path(urdf)
        (out / f"{file.parent.name}-{file.name}").write_text(robot)
        text = text.replace(f'"{urdf}"', f'"{file.parent.name}-{file.name}"')
    text = in_text(names, text) if names else text
    text = turn_scenario(text, turn_of(text)) if kind == "turned" else text
    if kind == "wrong":
        text += "\n[tolerance]\nmass = 0.03\ncom_m = 0.005\n"
    (out / "scenario.toml").write_text(text)
    return names


def disturb(scenario, source, out, kind, amount):
    (out / "set").mkdir(parents=True, exist_ok=True)
    names = disturb_scenario(scenario, out, kind, amount)
    (out / "names.json").write_text(json.dumps(names))
    text = (source / "recording.toml").read_text()
    noise = tomllib.loads(text).get("noise", {})
    (out / "set" / "recording.toml").write_text(disturb_manifest(text, kind, amount, names))
    for path in sorted(source.iterdir()):
        if path.suffix not in (".csv", ".parquet"):
            continue
        if not names and kind not in IN_TABLES:
            shutil.copy(path, out / "set" / path.name)
            continue
        table = Table(path)
        if kind == "turned":
            turn(table, turn_of(scenario.read_text()))
        elif kind in IN_TABLES:
            spoil(table, noise, kind, float(amount), random.Random(f"{source.name} {path.name}"))
        table.write(out / "set" / path.name, lambda channel: renamed(names, channel))


if __name__ == "__main__":
    main()

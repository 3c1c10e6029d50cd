#!/usr/bin/env python3
"""Copies a recording set with a fault of the kind that laboratories have; the physics in it stays as it is.

    disturb.py SET OUT FAULT        FAULT: sigma=0.7 | no-noise | ar1=0.8 | outliers=0.001 | clip=0.9 | rename

sigma=F      the stated noise is F times the true one
no-noise     no noise is stated
ar1=R        noise of the stated size with the correlation R from sample to sample is added, and the stated noise grows by the square root of two
outliers=P   a share P of all samples is off by twenty times the noise
clip=S       the first body rate, joint rate or force is cut at S times its largest size
rename       the rig has another name

CSV sets only. Numbers come from a generator seeded by the set's name.
"""

import csv
import pathlib
import random
import re
import shutil
import sys

SIZE = 20.0  # of an outlier, in units of noise


def noise_of(text):
    """[noise] of recording.toml: channel or prefix, standard deviation."""
    section = re.search(r"\[noise\]\n(.*?)(?:\n\[|\Z)", text, re.S)
    return {k: float(v) for k, v in re.findall(r'"([^"]+)"\s*=\s*(\S+)', section.group(1))} if section else {}


def sigma_of(noise, channel):
    found = [s for prefix, s in noise.items() if channel == prefix or channel.startswith(prefix + ".")]
    if not found or channel.startswith("drive."):
        return None
    # About an axis a turn is twice as large as in the quaternion.
    return found[0] / 2 if ".orientation." in channel else found[0]


def disturb_run(path, out, noise, kind, amount, dice):
    with open(path, newline="") as file:
        header, *rows = list(csv.reader(file))
    for column, channel in enumerate(header):
        sigma = sigma_of(noise, channel)
        if sigma is None:
            continue
        sampled = [row for row in rows if row[column] != ""]
        digits = max((len(row[column].partition(".")[2]) for row in sampled), default=6)
        values = [float(row[column]) for row in sampled]
        if kind == "outliers":
            values = [v + (dice.choice([-1, 1]) * SIZE * sigma if dice.random() < amount else 0.0) for v in values]
        elif kind == "ar1":
            state = dice.gauss(0, 1)
            for i in range(len(values)):
                values[i] += sigma * state
                state = amount * state + (1 - amount**2) ** 0.5 * dice.gauss(0, 1)
        elif kind == "clip" and (".orientation" in channel or ".position" in channel):
            continue
        elif kind == "clip":
            limit = amount * max(map(abs, values), default=0.0)
            values = [max(-limit, min(limit, v)) for v in values]
        for row, value in zip(sampled, values):
            row[column] = f"{value:.{digits}f}"
        if kind == "clip":
            break
    with open(out, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([header, *rows])


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    source, out, fault = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    kind, _, amount = fault.partition("=")
    text = (source / "recording.toml").read_text()
    noise = noise_of(text)
    out.mkdir(parents=True, exist_ok=True)
    if kind == "sigma":
        scale = lambda m: f'"{m[1]}" = {float(m[2]) * float(amount)}'
        head, section, tail = re.split(r"(\[noise\]\n.*?)(?=\n\[)", text, maxsplit=1, flags=re.S)
        text = head + re.sub(r'"([^"]+)"\s*=\s*(\S+)', scale, section) + tail
    elif kind == "no-noise":
        text = re.sub(r"\[noise\]\n.*?\n(?=\[)", "", text, count=1, flags=re.S)
    elif kind == "rename":
        text = re.sub(r'rig(\s*)= "[^"]*"', r'rig\1= "another"', text, count=1)
    elif kind == "ar1":
        head, section, tail = re.split(r"(\[noise\]\n.*?)(?=\n\[)", text, maxsplit=1, flags=re.S)
        scale = lambda m: f'"{m[1]}" = {float(m[2]) * 2**0.5}'
        text = head + re.sub(r'"([^"]+)"\s*=\s*(\S+)', scale, section) + tail
    elif kind not in ("outliers", "clip"):
        sys.exit(f"unknown fault {fault}\n{__doc__}")
    (out / "recording.toml").write_text(text)
    for path in sorted(source.iterdir()):
        if path.suffix == ".csv" and kind in ("outliers", "ar1", "clip"):
            disturb_run(path, out / path.name, noise, kind, float(amount), random.Random(f"{source.name} {path.name}"))
        elif path.name != "recording.toml":
            shutil.copy(path, out / path.name)


main()

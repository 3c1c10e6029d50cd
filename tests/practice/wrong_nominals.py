#!/usr/bin/env python3
"""Copies a rig's scenario with link masses and centres of mass that are a little wrong, and says so in its [tolerance].

    wrong_nominals.py SCENARIO OUT SEED [MASS COM [untold]]        OUT/<name>.toml beside its robots; MASS 0.03 (share), COM 0.005 (m): one standard
                                                                deviation; untold: without [tolerance]

The recording is the truth; what a diagnosis has to find in it stays what it was.
"""

import math
import pathlib
import random
import re
import sys


def wrong(urdf, dice, mass, com, most=math.inf):
    """A robot's file with masses and centres of mass off by standard deviations `mass` and `com`, by no more than `most` of them."""
    off = lambda deviation: deviation * max(-most, min(most, dice.gauss(0.0, 1.0)))

    def inertial(block):
        text = block.group(0)
        factor = 1.0 + off(mass)
        text = re.sub(r'(<mass\s+value=")([^"]+)"', lambda m: f'{m.group(1)}{float(m.group(2)) * factor:.9g}"', text)
        moved = lambda m: m.group(1) + " ".join(f"{float(x) + off(com):.9g}" for x in m.group(2).split()) + '"'
        return re.sub(r'(<origin\s[^>]*xyz=")([^"]+)"', moved, text, count=1)

    return re.sub(r"<inertial>.*?</inertial>", inertial, urdf, flags=re.S)


def main():
    scenario, out, seed = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), int(sys.argv[3])
    mass, com = map(float, sys.argv[4:6]) if len(sys.argv) > 4 else (0.03, 0.005)
    is_told = "untold" not in sys.argv[6:]
    dice = random.Random(seed)
    out.mkdir(parents=True, exist_ok=True)
    text = scenario.read_text()
    for urdf in sorted(set(re.findall(r'^urdf\s*=\s*"([^"]+)"', text, re.M))):
        source = (scenario.parent / urdf).resolve()
        (out / source.name).write_text(wrong(source.read_text(), dice, mass, com))
        text = text.replace(f'"{urdf}"', f'"{source.name}"')
    if is_told:
        text += f"\n[tolerance]\nmass = {mass}\ncom_m = {com}\n"
    (out / scenario.name).write_text(text)


if __name__ == "__main__":
    main()

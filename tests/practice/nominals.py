#!/usr/bin/env python3
"""Effects planted where the scenario's masses and centres of mass are wrong, and said to be so in [tolerance]; then diagnosed.

    nominals.py SOFTDOCK RECORDINGS OUT [effects=1,2,3,0] [draws=40] [first=1] [rigs=tumbler,arm-bench,…]

A draw is a rig, as many of its cases of planted.py as `effects` says, each of 0.7 to 1.4 times its size, in recordings like the practice sets', with masses that are then written 3 %
and centres of mass 5 mm wrong (one standard deviation) into the robots' files. What counts is name and place. A set whose effects no longer stand at three times the noise in windows once those
numbers are free (`error.within_tolerance`) is told as weak and counted apart. Prints a row for each set as soon as it is known; what is there already is not made again.
"""

import json
import pathlib
import random
import sys
import time

import planted
from disturb import disturb

WEAK = 3.0
RIGS = ["tumbler", "arm-bench", "dock-impact", "air-table", "stick-slip"]


def drawn(count, draw, rigs):
    """Rig, cases, sizes: of different names, and none that the wrong numbers themselves may be."""
    dice = random.Random(f"{count} {draw}")
    rig = rigs[draw % len(rigs)]
    name_of = lambda case: planted.planted_in(case, 1.0)[0]["name"]
    usable = [c for c, effects in planted.CASES.items() if c.startswith(f"{rig}/") and len(effects) == 1 and name_of(c) not in ("body-mass", "body-com")]
    cases = []
    while len(cases) < count:
        case = dice.choice(usable)
        if name_of(case) not in map(name_of, cases):
            cases.append(case)
    return rig, cases, [round(dice.uniform(0.7, 1.4), 2) for _ in cases], dice.randrange(1, 10_000)


def planted_set(softdock, recordings, folder, rig, effects, seed):
    """The scenario with wrong numbers and the set, made if they are not there."""
    if not (folder / "wrong" / "scenario.toml").exists():
        if not planted.plant(softdock, recordings, rig, effects, seed, folder):
            return None
        disturb(planted.SCENARIOS / f"{rig}.toml", folder / "set", folder / "wrong", "wrong", str(seed))
    return folder / "wrong"


def diagnosed(softdock, recordings, folder, rig, effects, seed):
    """The diagnosis, none where there is none, and the seconds it took."""
    wrong = planted_set(softdock, recordings, folder, rig, effects, seed)
    began = time.time()
    told = folder / "out" / "diagnosis.json"
    if wrong and not told.exists():
        planted.run([softdock, "diagnose", wrong / "scenario.toml", wrong / "set", "--out", folder / "out", "--quiet"], folder / "diagnose.log")
    return (json.loads(told.read_text()) if told.exists() else None), time.time() - began


def errors(told):
    """Windowed errors of the nominal model, of the same with its numbers free, of the corrected one; what is not told is infinite, or the nominal model's."""
    if told is None:
        return float("inf"), float("inf"), float("inf")
    number = lambda x: float("inf") if x is None else x
    before, after = (number(told["error"]["windowed"][key]) for key in ("before", "after"))
    return before, number(told["error"].get("within_tolerance") or before), after


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    softdock, recordings, out = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    options = dict(a.split("=", 1) for a in sys.argv[4:])
    counts, first = [int(x) for x in options.get("effects", "1,2,3,0").split(",")], int(options.get("first", 1))
    rigs = options["rigs"].split(",") if "rigs" in options else RIGS
    print("| planted | verdict | told | before, within tolerances, after | right | s |\n| --- | --- | --- | --- | --- | --- |", flush=True)
    tally = {}
    for draw in range(first, first + int(options.get("draws", 40))):
        for count in counts:
            rig, cases, sizes, seed = drawn(count, draw, rigs)
            effects = [e for case, size in zip(cases, sizes) for e in planted.planted_in(case, size)]
            told, seconds = diagnosed(softdock, recordings, out / f"{count}-{draw}-{rig}", rig, effects, seed)
            found = told["effects"] if told else []
            right = told is not None and len(found) == len(effects) and all(any(planted.is_same(e, p) for e in found) for p in effects)
            before, left, after = errors(told)
            kind = "weak" if effects and left < WEAK else "right"
            tally.setdefault((count, kind), []).append(right)
            what = f"{rig}: " + (", ".join(f"{c.split('/')[1]} × {s:g}" for c, s in zip(cases, sizes)) or "nothing") + f" ({draw})"
            words = "; ".join(f"{e['name']} at {e['place']}" for e in found) or "nothing"
            is_right = ("yes" if right else "no") + (", weak" if kind == "weak" else "")
            print(f"| {what} | {told['verdict'] if told else 'none'} | {words} | {before:.3g}, {left:.3g}, {after:.4g} | {is_right} | {seconds:.0f} |", flush=True)
    print("\n| effects planted | sets | name and place right |\n| --- | --- | --- |")
    for (count, kind), rights in sorted(tally.items()):
        print(f"| {count or 'none'}{', weak' if kind == 'weak' else ''} | {len(rights)} | {sum(rights)} ({100 * sum(rights) / len(rights):.0f} %) |")


if __name__ == "__main__":
    main()

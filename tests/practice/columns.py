#!/usr/bin/env python3
"""Diagnoses copies of the practice sets with faults of laboratories in them, and judges them by the sets' own keys.

    columns.py SOFTDOCK RECORDINGS KEYS OUT [SET-PREFIX…] [faults=sigma=0.7,no-noise,…] [draw=SEED]

Every set with every fault of `COLUMNS` (or of `faults`; disturb.py tells what they are); with `draw` one fault of each set, drawn by the seed. A
diagnosis that is there already is not made again. Prints a row for each as soon as it is known, then how many of each column are right: verdict, first
name and place as in the key, nothing beside them.
"""

import json
import pathlib
import random
import subprocess
import sys
import time

from disturb import disturb

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "rigs"
COLUMNS = ["sigma=0.7", "sigma=0.95", "sigma=1.05", "sigma=1.5", "no-noise", "ar1=0.8", "outliers=0.001", "clip=0.9", "rename", "links", "turned", "wrong=1"]


def named_as_before(diagnosis, names):
    """The diagnosis with the names that the key knows."""
    for new in sorted({v: k for k, v in names.items()}, reverse=True):
        diagnosis = diagnosis.replace(new, {v: k for k, v in names.items()}[new])
    return diagnosis


def diagnosed(softdock, recordings, out, name, fault):
    """Folder of the diagnosis, and the seconds that it took."""
    scenario, folder = SCENARIOS / f"{name.rsplit('-', 1)[0]}.toml", out / fault / name
    told = out / fault / "told" / name
    if (told / "diagnosis.json").exists():
        return told, 0
    kind, _, amount = fault.partition("=")
    disturb(scenario, recordings / name, folder, kind, amount)
    told.mkdir(parents=True, exist_ok=True)
    began = time.time()
    with open(folder / "log", "w") as log:
        command = [softdock, "diagnose", folder / "scenario.toml", folder / "set", "--out", folder / "out", "--quiet"]
        subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False)
    if (folder / "out" / "diagnosis.json").exists():
        names = json.loads((folder / "names.json").read_text())
        (told / "diagnosis.json").write_text(named_as_before((folder / "out" / "diagnosis.json").read_text(), names))
    return told, time.time() - began


def judged(told, key):
    """Whether it is right, and what was told."""
    if not (told / "diagnosis.json").exists():
        return False, "no diagnosis"
    diagnosis = json.loads((told / "diagnosis.json").read_text())
    plain = lambda e: (e["name"], e["place"].replace("link:", "body:"))
    found, planted = [plain(e) for e in diagnosis["effects"]], [plain(e) for e in key["effects"]]
    accepted = [plain(e) for e in key.get("accept", []) if isinstance(e, dict) and "name" in e]
    is_unknown = "unknown" in key.get("tags", [])
    verdict = "unknown" if is_unknown else "explained" if planted else "no-mismatch"
    words = f"{diagnosis['verdict']}: " + ("; ".join(f"{n} at {p}" for n, p in found) or "nothing")
    first = not planted or (found != [] and found[0] in planted + accepted)
    extra = [e for e in found if e not in planted + accepted]
    return diagnosis["verdict"] == verdict and (is_unknown or (first and not extra and len(found) >= min(len(planted), 1))), words


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    softdock, recordings, keys, out = (pathlib.Path(a).resolve() for a in sys.argv[1:5])
    options = dict(a.split("=", 1) for a in sys.argv[5:] if "=" in a)
    prefixes = [a for a in sys.argv[5:] if "=" not in a] or [""]
    sets = sorted(p.parent.name for p in recordings.glob("*/recording.toml") if p.parent.name.startswith(tuple(prefixes)))
    faults = options["faults"].split(",") if "faults" in options else COLUMNS
    pairs = [(name, fault) for fault in faults for name in sets]
    if "draw" in options:
        dice = random.Random(int(options["draw"]))
        pairs = [(name, dice.choice(faults)) for name in sets]
    print("| set | fault | told | right | s |\n| --- | --- | --- | --- | --- |", flush=True)
    count = {}
    for name, fault in pairs:
        told, seconds = diagnosed(softdock, recordings, out, name, fault)
        right, words = judged(told, json.loads((keys / f"{name}.json").read_text()))
        count.setdefault(fault, []).append(right)
        print(f"| {name} | {fault} | {words} | {'yes' if right else 'no'} | {seconds:.0f} |", flush=True)
    print("\n| fault | right |\n| --- | --- |")
    for fault, rights in count.items():
        print(f"| {fault} | {sum(rights)} of {len(rights)} |")


main()

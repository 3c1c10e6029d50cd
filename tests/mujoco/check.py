#!/usr/bin/env python3
"""Holds diagnoses against what record.py concealed: check.py OUT, with OUT/<robot>/<case>/out/diagnosis.json. Status 1 where one is wrong."""

import json
import pathlib
import sys

KEYS = {"joint-coulomb-friction": "c", "joint-viscous-friction": "b", "payload": "mass", "joint-cable-stiffness": "k",
        "actuator-delay": "delay", "actuator-gain": "gain", "actuator-lag": "time_constant", "joint-armature": "i_rotor", "body-mass": "mass", "sensor-scale": "scale",
        "sensor-bias": "bias", "sensor-delay": "delay"}
# MuJoCo's dry friction is a regularised constraint, ours a bristle: a share of the mismatch, not all of it.
SHARE = 0.95


def main():
    out = pathlib.Path(sys.argv[1])
    right = 0
    keys = json.loads((out / "keys.json").read_text())
    print("| recording | verdict | found | explained | right |\n| --- | --- | --- | --- | --- |")
    for case, concealed in keys.items():
        file = out / case / "out" / "diagnosis.json"
        if not file.exists():
            print(f"| {case} | no diagnosis | | | no |")
            continue
        told = json.loads(file.read_text())
        found = [(e["name"], e["place"], e["params"]) for e in told["effects"]]
        share = (told.get("explained_share") or {}).get("share")
        words = "; ".join(f"{n} at {p}, {KEYS[n]} = {v[KEYS[n]]:.5g}" if n in KEYS and KEYS[n] in v else f"{n} at {p}" for n, p, v in found)
        is_place = lambda a, b: a == b or (a.startswith("body:") and b.startswith(("body:", "link:")) and a[5:] == b[5:])
        has = lambda c: any(n == c[0] and (is_place(c[1], p) or c[0] == "actuator-delay") for n, p, _ in found)
        good = len(found) == len(concealed) and all(map(has, concealed))
        good &= told["verdict"] == "no-mismatch" if not concealed else share is not None and share >= SHARE
        right += good
        print(f"| {case} | {told['verdict']} | {words} | {'' if share is None else f'{100 * min(share, 1):.2f} %'} | {'yes' if good else 'no'} |")
    print(f"\n{right} of {len(keys)} right")
    return 0 if right == len(keys) else 1


sys.exit(main())

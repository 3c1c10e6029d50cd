#!/usr/bin/env python3
"""Draws what is concealed in recordings by MuJoCo, diagnoses them with nominal numbers that are a little wrong, and judges the answers.

    drawn.py SOFTDOCK OUT [robots=arm,floater] [effects=0,1,2,3] [draws=10] [first=1] [mass=0.03] [com=0.005] [untold] [sigma=1.0]

For each robot and number of effects `draws` sets: effects, places and sizes at random (0.7 to 1.6 times what LIBRARY says), link masses of the scenario
off by `mass` and centres of mass by `com` (standard deviations; its [tolerance] says so, but for `untold`), σ stated times `sigma`. Done sets are
kept, so that it goes on where it was stopped: one OUT for one choice of numbers. Needs mujoco 4.0 and numpy from PyPI. Prints a table; the last lines are the shares that were right.
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import time

import numpy as np

import record

sys.path.insert(0, str(record.HERE.parent / "practice"))
from wrong_nominals import wrong

# What may be concealed, and how large: at joints by their strength (that of the second joint of the arm is one), or in its own unit.
LIBRARY = {
    "joint-coulomb-friction": ("joint", 0.5), "joint-viscous-friction": ("joint", 0.5), "joint-quadratic-friction": ("joint", 0.3),
    "joint-viscous-asymmetry": ("joint", (0.6, 0.35)), "joint-offset": ("joint", 0.3), "joint-cable-stiffness": ("joint", 2.5),
    "joint-torque-ripple": ("joint", (0.25, 17.0, 1.1)), "periodic-disturbance": ("joint", (0.25, 6.3, 0.4)), "joint-armature": ("joint", 0.03),
    "actuator-gain": ("ratio", 0.05), "actuator-lag": ("absolute", 0.01), "actuator-delay": ("absolute", 0.006), "payload": ("tool", 0.35),
    "sensor-scale": ("ratio", 0.03), "sensor-bias": ("absolute", 0.006), "sensor-delay": ("absolute", 0.004),
}
# Standard deviations that a number that is within its tolerance is off by at most.
MOST = 2.5
STRENGTH = {"arm": [0.5, 1.0, 0.7, 0.25], "floater": [0.6, 0.4, 0.12]}


def drawn(dice, robot, count):
    """Effects of a set: kinds and joints all different."""
    kinds = dice.sample(sorted(LIBRARY), count)
    joints = dice.sample(range(len(record.ROBOTS[robot]["joints"])), min(count, 3))
    return [effect(dice, robot, kind, joint) for kind, joint in zip(kinds, joints)]


def effect(dice, robot, kind, joint):
    where, size = LIBRARY[kind]
    grow = math.exp(dice.uniform(math.log(0.7), math.log(1.6)))
    if where == "tool":
        return [kind, None, size * grow]
    if where == "ratio":
        return [kind, joint, 1.0 + dice.choice([-1.0, 1.0]) * size * grow]
    if where == "absolute":
        step = record.STEP
        return [kind, joint, round(size * grow / step) * step]
    grow *= STRENGTH[robot][joint]
    if kind in ("joint-torque-ripple", "periodic-disturbance"):
        return [kind, joint, (size[0] * grow, *size[1:])]
    return [kind, joint, tuple(s * grow for s in size) if isinstance(size, tuple) else size * grow]


def acting(effects):
    """As record.py's laws have them: MuJoCo's own dry friction is a constraint that creeps, a Dahl law is what a bearing does."""
    return [("dahl" if kind == "joint-coulomb-friction" else kind, where, size) for kind, where, size in effects]


def write_set(folder, robot_name, effects, seed, options):
    robot, dice = record.ROBOTS[robot_name], random.Random(seed)
    folder.mkdir(parents=True)
    model = record.model_of(robot_name, robot, acting(effects))
    (folder / "recording.toml").write_text(record.manifest(robot_name, options["sigma"]))
    for run in range(record.RUNS):
        recorded = record.record(model, robot, acting(effects), np.random.default_rng([seed, run]))
        record.write_run(folder / f"run-{run + 1}.csv", robot, recorded, np.random.default_rng([seed, run, 7]))
    urdf = (record.HERE / f"{robot_name}.urdf").read_text()
    (folder.parent / f"{robot_name}.urdf").write_text(wrong(urdf, dice, options["mass"], options["com"], MOST))
    scenario = record.scenario(robot_name, robot)
    if not options["untold"] and options["mass"] > 0:
        scenario += f"\n[tolerance]\nmass = {options['mass']}\ncom_m = {options['com']}\n"
    (folder.parent / "scenario.toml").write_text(scenario)


def is_same(robot, concealed, found):
    kind, where, _ = concealed
    place = record.place_of(record.ROBOTS[robot], kind, where)
    plain = lambda p: p.replace("link:", "body:").replace("actuator:", "joint:")
    return found["name"] == kind and plain(found["place"]).split("/")[-1] == plain(place).split("/")[-1]


def judged(softdock, out, robot, count, seed, options):
    effects = drawn(random.Random(f"{robot} {count} {seed}"), robot, count)
    case = out / robot / str(count) / str(seed)
    if not (case / "set").exists():
        write_set(case / "set", robot, effects, seed, options)
    began = time.time()
    if not (case / "out" / "diagnosis.json").exists():
        with open(case / "log", "w") as log:
            subprocess.run([softdock, "diagnose", case / "scenario.toml", case / "set", "--out", case / "out", "--quiet"], stdout=log, stderr=log, check=False)
    seconds = time.time() - began
    words = ", ".join(f"{k} {record.place_of(record.ROBOTS[robot], k, w)} {np.round(s, 4)}" for k, w, s in effects)
    if not (case / "out" / "diagnosis.json").exists():
        return f"| {robot} {count}/{seed} | {words} | no diagnosis | | no | {seconds:.0f} |", False, False
    told = json.loads((case / "out" / "diagnosis.json").read_text())
    found = told["effects"]
    has = [any(is_same(robot, c, f) for f in found) for c in effects]
    extra = [f for f in found if not any(is_same(robot, c, f) for c in effects)]
    right = all(has) and not extra
    answer = "" if right else "; ".join(f"{f['name']} at {f['place']}" for f in found)
    return f"| {robot} {count}/{seed} | {words} | {told['verdict']} | {answer} | {'yes' if right else 'no'} | {seconds:.0f} |", right, bool(extra)


def main():
    softdock, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    said = dict(a.split("=") if "=" in a else (a, "1") for a in sys.argv[3:])
    options = {"mass": float(said.get("mass", 0.03)), "com": float(said.get("com", 0.005)), "sigma": float(said.get("sigma", 1.0)), "untold": "untold" in said}
    robots, counts = said.get("robots", "arm,floater").split(","), [int(c) for c in said.get("effects", "0,1,2,3").split(",")]
    first, draws = int(said.get("first", 1)), int(said.get("draws", 10))
    print("| set | concealed | verdict | told, where that is not what was concealed | right | s |\n| --- | --- | --- | --- | --- | --- |", flush=True)
    tally = {count: [] for count in counts}
    for seed in range(first, first + draws):
        for count in counts:
            for robot in robots:
                line, right, extra = judged(softdock, out, robot, count, seed, options)
                tally[count].append((right, extra))
                print(line, flush=True)
    print()
    for count, answers in tally.items():
        print(f"{count} effects: {sum(r for r, _ in answers)} of {len(answers)} right, {sum(e for _, e in answers)} with an effect that is not there")


if __name__ == "__main__":
    main()

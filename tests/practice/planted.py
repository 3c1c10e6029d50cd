#!/usr/bin/env python3
"""Effects that the practice sets do not have: planted by softdock in recordings like theirs, then diagnosed.

    planted.py SOFTDOCK RECORDINGS OUT [CASE-PREFIX…] [seeds=11,12,13] [sizes=0.7,1.4]        CASE-PREFIX: tumbler, arm-bench/joint-, nothing/tumbler …

`nothing/RIG` plants nothing: a null. A case is planted once for each seed, its sizes (what it names beside frequencies, orders, phases, positions
and times) times one of `sizes`, in turn. What is planted is simulated by softdock itself, with four times finer steps, so that this shows what
the search can tell apart and how sure its numbers are, not whether its laws are those of hardware. Prints a table: what was planted, what was
told, whether it is the same, and by how many of its standard errors the worst number is off; then how many of all numbers of the right ones lie
within their 95 % intervals (1.96 standard errors).
"""

import itertools
import json
import pathlib
import subprocess
import sys
import time
import tomllib

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "rigs"
LIKE = {"tumbler": "tumbler-05", "arm-bench": "arm-bench-03", "dock-impact": "dock-impact-05", "air-table": "air-table-02", "stick-slip": "stick-slip-03"}
TARGET, CHASER, GYRO, STAR = "body:target", "body:chaser", "sensor:body.target.angular_velocity", "sensor:body.target.orientation"
DROGUE, PLATE = "contact:probe/drogue", "contact:slider/plate"

CASES = {
    "tumbler/gravity": [f'name = "gravity-gradient", place = "{TARGET}", mean_motion = 0.001114'],
    "tumbler/flexible": [f'name = "flexible-appendage", place = "{TARGET}", frequency = 0.06, damping = 0.01, coupling = [3.0, 1.0, -4.0]'],
    "tumbler/dissipation": [f'name = "internal-dissipation", place = "{TARGET}", i_damper = 4.0, c = 0.4'],
    "tumbler/pump": [f'name = "periodic-disturbance", place = "{TARGET}", amplitude = [0.03, 0.0, 0.02], frequency = 0.43, phase = 0.7'],
    "tumbler/world-torque": [f'name = "constant-torque", place = "{TARGET}", vector = [0.0006, -0.0003, 0.0004], frame = "world"'],
    "tumbler/bias": [f'name = "sensor-bias", place = "{GYRO}", bias = [0.0006, -0.0004, 0.0002]'],
    "tumbler/scale": [f'name = "sensor-scale", place = "{GYRO}", scale = 1.006'],
    "tumbler/late": [f'name = "sensor-delay", place = "{STAR}", delay = 0.09'],
    "tumbler/turned": [f'name = "sensor-misalignment", place = "{GYRO}", angle = [0.006, -0.004, 0.009]'],
    "tumbler/slosh-small": [f'name = "slosh", place = "{TARGET}", mass = 6.0, frequency = 0.2, damping = 0.03, position = [0.1, -0.3, 0.5]'],
    "tumbler/damping+late": [f'name = "angular-damping", place = "{TARGET}", c = 0.01', f'name = "sensor-delay", place = "{STAR}", delay = 0.12'],
    "tumbler/flexible+torque": [f'name = "flexible-appendage", place = "{TARGET}", frequency = 0.07, damping = 0.02, coupling = [3.0, 0.0, 3.5]',
                                f'name = "constant-torque", place = "{TARGET}", vector = [0.0004, 0.0002, -0.0005]'],
    "tumbler/inertia+bias": [f'name = "body-inertia", place = "{TARGET}", inertia = [95.0, 163.0, 214.0, 0.8, 0.0, -1.2]',
                             f'name = "sensor-bias", place = "{GYRO}", bias = [0.0004, 0.0005, -0.0003]'],
    "arm-bench/joint-asymmetry": ['name = "joint-friction-asymmetry", place = "joint:joint_2", c_plus = 0.9, c_minus = 0.5'],
    "arm-bench/joint-backlash": ['name = "joint-backlash", place = "joint:joint_4", gap = 0.0015, k = 6000.0, d = 8.0'],
    "arm-bench/joint-ripple": ['name = "joint-torque-ripple", place = "joint:joint_3", amplitude = 0.4, order = 17, phase = 1.1'],
    "arm-bench/joint-cable": ['name = "joint-cable-stiffness", place = "joint:joint_5", k = 1.4, q_rest = 0.2'],
    "arm-bench/joint-armature": ['name = "joint-armature", place = "joint:joint_6", i_rotor = 0.012'],
    "arm-bench/joint-gain": ['name = "actuator-gain", place = "joint:joint_1", gain = 0.97'],
    "arm-bench/joint-lag": ['name = "actuator-lag", place = "joint:joint_3", time_constant = 0.008'],
    "arm-bench/joint-pump": ['name = "periodic-disturbance", place = "joint:joint_2", amplitude = 0.5, frequency = 6.3, phase = 0.4'],
    "arm-bench/joint-coulomb-7": ['name = "joint-coulomb-friction", place = "joint:joint_7", c = 0.25'],
    "arm-bench/soft-gear+dry": ['name = "joint-elasticity", place = "joint:joint_4", k = 900.0, d = 2.0', 'name = "joint-coulomb-friction", place = "joint:joint_6", c = 0.3'],
    "arm-bench/joint-elastic-6": ['name = "joint-elasticity", place = "joint:joint_6", k = 900.0, d = 0.8'],
    "arm-bench/body-mass": ['name = "body-mass", place = "body:link_5", mass = 2.05'],
    "arm-bench/bias": ['name = "sensor-bias", place = "sensor:joint.joint_3.position", bias = 0.004'],
    "arm-bench/tacho": ['name = "sensor-scale", place = "sensor:joint.joint_2.velocity", scale = 1.03'],
    "arm-bench/dry+payload": ['name = "joint-coulomb-friction", place = "joint:joint_4", c = 0.6', 'name = "payload", place = "link:link_7", mass = 0.25, com = [0.0, 0.02, 0.1]'],
    "arm-bench/viscous+ripple": ['name = "joint-viscous-friction", place = "joint:joint_2", b = 1.2', 'name = "joint-torque-ripple", place = "joint:joint_5", amplitude = 0.2, order = 30, phase = 0.0'],
    "arm-bench/viscous+few-waves": ['name = "joint-viscous-friction", place = "joint:joint_7", b = 0.12', 'name = "joint-torque-ripple", place = "joint:joint_2", amplitude = 0.6, order = 12, phase = 0.7'],
    "arm-bench/dry+viscous+cable": ['name = "joint-coulomb-friction", place = "joint:joint_3", c = 0.5', 'name = "joint-viscous-friction", place = "joint:joint_3", b = 0.5',
                                    'name = "joint-cable-stiffness", place = "joint:joint_6", k = 0.8, q_rest = -0.3'],
    "dock-impact/offset": [f'name = "contact-geometry-offset", place = "{DROGUE}", offset = [0.0, 0.003, -0.002]'],
    "dock-impact/stribeck": [f'name = "friction-stribeck", place = "{DROGUE}", mu_s = 0.17, mu_d = 0.11, v_s = 0.02'],
    "dock-impact/bristle": [f'name = "friction-bristle-stiffness", place = "{DROGUE}", k_b = 240000.0, c_b = 400.0'],
    "dock-impact/inertia": [f'name = "body-inertia", place = "{CHASER}", inertia = [92.0, 126.0, 128.0, 0.0, 2.0, 0.0]'],
    "dock-impact/mass": [f'name = "body-mass", place = "{CHASER}", mass = 462.0'],
    "dock-impact/force-late": ['name = "sensor-delay", place = "sensor:sensor.probe.force", delay = 0.002'],
    "dock-impact/force-scale": ['name = "sensor-scale", place = "sensor:sensor.probe.force", scale = 1.04'],
    "dock-impact/friction+mass": [f'name = "friction-coefficient", place = "{DROGUE}", mu = 0.16', f'name = "body-mass", place = "{CHASER}", mass = 440.0'],
    "air-table/quadratic": [f'name = "quadratic-drag", place = "{CHASER}", c = 0.6'],
    "air-table/turned-nozzle": ['name = "actuator-misalignment", place = "actuator:thruster_2", angle_y = 0.0, angle_z = 0.06'],
    "air-table/late": ['name = "actuator-delay", place = "actuator:*", delay = 0.02'],
    "air-table/hose": [f'name = "tether-stiffness", place = "{CHASER}", k = 0.05, d = 0.02, anchor = [-0.5, 0.4, 0.25]'],
    "air-table/mass": [f'name = "body-mass", place = "{CHASER}", mass = 12.5'],
    "air-table/tilt+drag": ['name = "tilt", place = "world", vector = [0.0005, 0.0003, 0.0]', f'name = "linear-drag", place = "{CHASER}", c = 0.04'],
    "stick-slip/dwell": [f'name = "friction-dwell-time", place = "{PLATE}", mu_s_inf = 0.29, time_constant = 0.6'],
    "stick-slip/tilt": ['name = "tilt", place = "world", vector = [0.03, -0.02, 0.0]'],
    "stick-slip/mass": ['name = "body-mass", place = "body:slider", mass = 1.26'],
    "stick-slip/force-bias": ['name = "sensor-bias", place = "sensor:sensor.spring.force", bias = [0.06, -0.03, 0.0]'],
    "stick-slip/stribeck+tilt": [f'name = "friction-stribeck", place = "{PLATE}", mu_s = 0.28, mu_d = 0.24, v_s = 0.004', 'name = "tilt", place = "world", vector = [0.02, 0.01, 0.0]'],
}

CASES |= {f"nothing/{rig}": [] for rig in LIKE}


def run(command, log):
    with open(log, "w") as file:
        return subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, check=False).returncode


def numbers(value):
    return value if isinstance(value, list) else [value]


def offs(planted, effect):
    """How many of its standard errors each number of an effect is off."""
    found = []
    for key, true in planted.items():
        value, error = effect["params"].get(key), effect["std_err"].get(key)
        if isinstance(true, str) or value is None or error is None:
            continue
        pairs = zip(numbers(true), numbers(value), numbers(error))
        found += [abs(v - t) / e for t, v, e in pairs if isinstance(e, (int, float)) and e > 0]
    return found


def is_same(effect, planted):
    plain = lambda place: place.replace("link:", "body:")
    return effect["name"] == planted["name"] and plain(effect["place"]) == plain(planted["place"])


def planted_in(case, size):
    """The effects of a case, the numbers that say how large they are times `size`."""
    planted = [tomllib.loads(f"x = {{ {entry} }}")["x"] for entry in CASES[case]]
    return [{key: grown(effect, key, value, size) for key, value in effect.items()} for effect in planted]


def grown(effect, key, value, size):
    grow = lambda x: x * size if isinstance(x, float) else x
    if effect["name"] not in GROWING or key not in GROWING[effect["name"]]:
        return value
    return [grow(x) for x in value] if isinstance(value, list) else grow(value)


GROWING = {
    "flexible-appendage": ["coupling"], "internal-dissipation": ["c"], "periodic-disturbance": ["amplitude"], "constant-torque": ["vector"],
    "sensor-bias": ["bias"], "sensor-delay": ["delay"], "sensor-misalignment": ["angle"], "slosh": ["mass"], "angular-damping": ["c"],
    "joint-friction-asymmetry": ["c_plus", "c_minus"], "joint-torque-ripple": ["amplitude"], "joint-cable-stiffness": ["k"],
    "joint-armature": ["i_rotor"], "actuator-lag": ["time_constant"], "joint-coulomb-friction": ["c"], "joint-viscous-friction": ["b"],
    "payload": ["mass"], "contact-geometry-offset": ["offset"], "quadratic-drag": ["c"], "linear-drag": ["c"], "actuator-delay": ["delay"],
    "tether-stiffness": ["k", "d"], "tilt": ["vector"],
}


def toml(value):
    return json.dumps(value) if isinstance(value, str) else str(value)


def plant(softdock, recordings, rig, planted, seed, folder):
    """Makes FOLDER/set, where it is not there; whether it is there then."""
    folder.mkdir(parents=True, exist_ok=True)
    entries = [", ".join(f"{key} = {toml(value)}" for key, value in effect.items()) for effect in planted]
    effects = [argument for entry in entries for argument in ("--effect", entry)]
    like = ["--like", recordings / LIKE[rig], "--seed", str(seed)]
    command = [softdock, "plant", SCENARIOS / f"{rig}.toml", *like, *effects, "--out", folder / "set"]
    return (folder / "set").exists() or run(command, folder / "plant.log") == 0


def diagnosed(softdock, recordings, out, case, seed, size):
    rig = case.split("/")[1] if case.startswith("nothing/") else case.split("/")[0]
    scenario, folder = SCENARIOS / f"{rig}.toml", out / case / f"{seed}-{size:g}"
    planted = planted_in(case, size)
    what = f"{case}, seed {seed}" + (f", times {size:g}" if size != 1.0 else "")
    if not plant(softdock, recordings, rig, planted, seed, folder):
        return f"| {what} | not planted: see {folder / 'plant.log'} | | | | |", False, []
    began = time.time()
    if not (folder / "out" / "diagnosis.json").exists():
        run([softdock, "diagnose", scenario, folder / "set", "--out", folder / "out", "--quiet"], folder / "diagnose.log")
    seconds = time.time() - began
    told_file = folder / "out" / "diagnosis.json"
    if not told_file.exists():
        return f"| {what} | no diagnosis: see {folder / 'diagnose.log'} | | | | |", False, []
    told = json.loads(told_file.read_text())
    found = told["effects"]
    matched = [(p, next((e for e in found if is_same(e, p)), None)) for p in planted]
    right = len(found) == len(planted) and all(e for _, e in matched) and (found != [] or told["verdict"] == "no-mismatch")
    off = [x for p, e in matched if e for x in offs({k: v for k, v in p.items() if k not in ("name", "place")}, e)] if right else []
    words = "; ".join(f"{e['name']} at {e['place']}" for e in found)
    worst = f"{max(off):.1f} of {len(off)}" if off else ""
    return f"| {what} | {told['verdict']} | {'' if right else words} | {'yes' if right else 'no'} | {worst} | {seconds:.0f} |", right, off


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    softdock, recordings, out = (pathlib.Path(a).resolve() for a in sys.argv[1:4])
    listed = lambda key, kind, usual: next(([kind(x) for x in a.split("=")[1].split(",")] for a in sys.argv[4:] if a.startswith(f"{key}=")), usual)
    seeds, sizes = listed("seeds", int, [11]), listed("sizes", float, [1.0])
    prefixes = [a for a in sys.argv[4:] if "=" not in a] or [case.split("/")[0] for case in CASES if not case.startswith("nothing/")]
    cases = [case for case in CASES if any(case.startswith(p) for p in prefixes)]
    print("| planted | verdict | told, where that is not what was planted | right | standard errors off, worst number | s |\n| --- | --- | --- | --- | --- | --- |", flush=True)
    count, all_off = 0, []
    for (i, seed), (k, case) in itertools.product(enumerate(seeds), enumerate(cases)):
        line, right, off = diagnosed(softdock, recordings, out, case, seed, sizes[(i + k) % len(sizes)])
        count += right
        all_off += [off] if off else []
        print(line, flush=True)
    print(f"\n{count} of {len(cases) * len(seeds)} right")
    numbers_off = [x for off in all_off for x in off]
    if numbers_off:
        within = sum(x <= 1.96 for x in numbers_off)
        print(f"{within} of {len(numbers_off)} numbers ({100 * within / len(numbers_off):.1f} %) within their 95 % intervals")


if __name__ == "__main__":
    main()

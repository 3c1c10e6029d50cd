#!/usr/bin/env python3
"""Effects planted in scenarios of the catalogue, measured by their own sensors over five runs each, then diagnosed by the scenario as it is.

    planted.py SOFTDOCK OUT [CASE-PREFIX…]        CASE-PREFIX: probe-drogue, probe-drogue/latch …

The scenario that is diagnosed is unchanged but for sensors, which it has none of; the runs are shorter, made by Runge-Kutta at 0.1 ms (what the scenario's
own integrator loses would be taken for physics), and differ in how the vehicles meet. Three are fitted, two left out. Prints a table: what was planted, the verdict, what was told, whether name and place are right, and the time.
"""

import json
import pathlib
import subprocess
import sys
import time

HOME = pathlib.Path(__file__).resolve().parents[2]
RUNS, HELD_OUT = 5, 2

# Per scenario: the sensors, what every run sets, and how runs differ.
SCENARIOS = {
    "probe-drogue": {
        "sensors": """
[[sensor]]
name = "strut_scale"
kind = "joint-encoder"
joint = "servicer/strut"
rate_hz = 200.0
noise_m = 2e-5

[[sensor]]
name = "gimbal_encoders"
kind = "joint-encoder"
joint = "servicer/gimbal_*"
rate_hz = 200.0
noise_deg = 0.005

[[sensor]]
name = "servicer_mocap"
kind = "pose"
link = "servicer/bus"
rate_hz = 50.0
position_noise_m = 1e-4
attitude_noise_deg = 0.01

[[sensor]]
name = "client_mocap"
kind = "pose"
link = "client/bus"
rate_hz = 50.0
position_noise_m = 1e-4
attitude_noise_deg = 0.01
""",
        "set": ["duration_s=16.0", "integrator.kind=rk4", "integrator.step_s=1e-4"],
        "runs": [
            ["closing_m_per_s=0.075", "lateral_m=[0.05, 0.02]", "tilt_deg=[1.5, -1.0]", "roll_deg=2.0"],
            ["closing_m_per_s=0.09", "lateral_m=[-0.03, 0.05]", "tilt_deg=[-1.0, 2.0]", "roll_deg=-1.0"],
            ["closing_m_per_s=0.06", "lateral_m=[0.02, -0.06]", "tilt_deg=[0.5, 1.0]", "roll_deg=3.0"],
            ["closing_m_per_s=0.08", "lateral_m=[-0.05, -0.03]", "tilt_deg=[2.0, 0.5]", "roll_deg=0.0"],
            ["closing_m_per_s=0.07", "lateral_m=[0.06, -0.01]", "tilt_deg=[-2.0, -1.0]", "roll_deg=1.0"],
        ],
        "run": "vehicle.servicer.approach.",
    },
}

CASES = {
    "probe-drogue/nothing": [],
    "probe-drogue/strut": ['name = "joint-viscous-friction", place = "joint:servicer/strut", b = 80.0'],
    "probe-drogue/latch": ['name = "mechanism-stiffness", place = "mechanism:seat", factor = 0.6'],
    "probe-drogue/friction": ['name = "friction-coefficient", place = "contact:servicer/head/client/drogue", mu = 0.2'],
}


def run(command, log):
    with open(log, "a") as file:
        return subprocess.run([str(c) for c in command], stdout=file, stderr=subprocess.STDOUT, check=False).returncode


def scenario_of(name, home):
    """The scenario with its sensors, beside the recordings."""
    text = (HOME / "scenarios" / f"{name}.toml").read_text().replace("../robots", str(HOME / "robots"))
    path = home / f"{name}.toml"
    path.write_text(text + SCENARIOS[name]["sensors"])
    return path


def record(softdock, scenario, rig, effects, home):
    """Runs of a case; whether all were written."""
    folder = home / "set"
    for number, starts in enumerate(rig["runs"], 1):
        role = "holdout" if number > RUNS - HELD_OUT else "fit"
        command = [softdock, "run", scenario, "--no-rrd", "--quiet", "--out", home / "run", "--seed", number, "--record", folder,
                   "--role", role]
        for change in rig["set"] + [rig["run"] + start for start in starts]:
            command += ["--set", change]
        if effects:
            command += ["--set", f"effect=[{', '.join('{ ' + e + ' }' for e in effects)}]"]
        # A run that does not end as the scenario expects is a recording all the same.
        run(command, home / "record.log")
    return len(list(folder.glob("run-*"))) == RUNS


def main():
    arguments = sys.argv[1:]
    if len(arguments) < 2:
        sys.exit(__doc__)
    softdock, out, prefixes = pathlib.Path(arguments[0]).resolve(), pathlib.Path(arguments[1]).resolve(), tuple(arguments[2:])
    print("| planted | verdict | told | right | s |\n| --- | --- | --- | --- | --- |", flush=True)
    right = asked = 0
    for case, effects in CASES.items():
        if prefixes and not case.startswith(prefixes):
            continue
        name = case.split("/")[0]
        home = out / case.replace("/", "-")
        home.mkdir(parents=True, exist_ok=True)
        scenario, rig = scenario_of(name, home), SCENARIOS[name]
        asked += 1
        if not record(softdock, scenario, rig, effects, home):
            print(f"| {case} | not recorded, see {home}/record.log | | no | |", flush=True)
            continue
        begun = time.time()
        run([softdock, "diagnose", scenario, home / "set", "--verbose", "--out", home / "out"], home / "diagnose.log")
        took = time.time() - begun
        answer = home / "out" / "diagnosis.json"
        found = json.loads(answer.read_text()) if answer.exists() else {"verdict": "none", "effects": []}
        plain = lambda place: place.replace("link:", "body:").replace("servicer/", "").replace("client/", "")
        told = [(e["name"], plain(e["place"])) for e in found["effects"]]
        parts = [dict(p.split(" = ", 1) for p in e.split(", ")[:2]) for e in effects]
        planted = [(p["name"].strip('"'), plain(p["place"].strip('"'))) for p in parts]
        is_right = sorted(told) == sorted(planted)
        right += is_right
        words = "; ".join(f"{e['name']} at {plain(e['place'])} {json.dumps(e['params'])}" for e in found["effects"]) or "nothing"
        print(f"| {case} | {found['verdict']} | {words} | {'yes' if is_right else 'no'} | {took:.0f} |", flush=True)
    print(f"\n{right} of {asked} by name and place")


if __name__ == "__main__":
    main()

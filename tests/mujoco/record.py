#!/usr/bin/env python3
"""Recordings of two robots by MuJoCo, each with something concealed, beside scenarios that know nothing of it.

    record.py OUT [CASE…]        needs mujoco 4.0 and numpy from PyPI; without CASE all of CASES, MORE only where asked for

OUT/<robot>/scenario.toml, OUT/<robot>/<case>/{recording.toml,run-1.csv …}, OUT/keys.json: what is in which case, for check.py alone.
RK4 at 0.1 ms; torques of a PD loop along sums of sines, held at 500 Hz and recorded; joints at 250 Hz, bases at 50 Hz; white noise and rounding.
"""

import json
import pathlib
import sys

import mujoco
import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
RUNS, SECONDS, STEP, TICK = 5, 6.0, 1e-4, 2e-3
NOISE = {"position": 5e-5, "velocity": 2e-3, "base": 2e-4, "turn": 2e-4, "gyro": 5e-4}

ROBOTS = {
    "arm": dict(base="fixed", gravity=-9.81, joints=["pan", "lift", "elbow", "wrist"], gain=[20, 90, 50, 12], tool="hand"),
    "floater": dict(base="free", gravity=0.0, joints=["root", "bend", "roll"], gain=[25, 15, 4], tool="tool"),
}
CASES = {
    "nothing": [],
    "dry": [("joint-coulomb-friction", 1, 0.5)],
    "viscous": [("joint-viscous-friction", 2, 0.4)],
    "payload": [("payload", None, 0.35)],
    "spring": [("joint-cable-stiffness", 1, 2.5)],
    "late": [("actuator-delay", 0, 0.006)],
    "dry-payload": [("joint-coulomb-friction", 1, 0.5), ("payload", None, 0.35)],
}
# Beyond what the table of simulators holds: the same of other laws, of sensors, and three at once.
MORE = {
    "viscous-sides": [("joint-viscous-asymmetry", 1, (0.6, 0.35))],
    "quadratic": [("joint-quadratic-friction", 2, 0.25)],
    "offset": [("joint-offset", 1, 0.3)],
    "ripple": [("joint-torque-ripple", 2, (0.12, 17.0, 1.1))],
    "pump": [("periodic-disturbance", 1, (0.15, 6.3, 0.4))],
    "gain": [("actuator-gain", 1, 0.96)],
    "lag": [("actuator-lag", 0, 0.01)],
    "rotor": [("joint-armature", 2, 0.02)],
    "heavy": [("body-mass", None, 1.08)],
    "tacho": [("sensor-scale", 1, 1.03)],
    "encoder": [("sensor-bias", 1, 0.004)],
    "encoder-late": [("sensor-delay", 2, 0.004)],
    "dahl": [("joint-coulomb-friction", 1, 0.4)],
    "viscous-rotor": [("joint-viscous-friction", 1, 0.5), ("joint-armature", 2, 0.02)],
    "viscous-payload-late": [("joint-viscous-friction", 2, 0.4), ("payload", None, 0.25), ("actuator-delay", 0, 0.006)],
    "spring-gain-tacho": [("joint-cable-stiffness", 2, 2.0), ("actuator-gain", 1, 0.97), ("sensor-scale", 0, 1.04)],
}
# Of a dry friction that is given as a law of its own, not by MuJoCo's constraint: deflection of its bristle, rad.
PRE_SLIDING = 3e-4


class Laws:
    """Efforts and readings that MuJoCo has no name for, evaluated at the begin of every step."""

    def __init__(self, effects, count):
        self.effects, self.bristle, self.lagged, self.last = effects, np.zeros(count), None, None

    def effort(self, t, q, v, command):
        """What acts on the joints."""
        out = command.copy()
        for effect, j, size in self.effects:
            if effect == "actuator-gain":
                out[j] *= size
            elif effect == "actuator-lag":
                self.lagged = command[j] if self.lagged is None else self.lagged + (1 - np.exp(-STEP / size)) * (command[j] - self.lagged)
                out[j] = self.lagged
        for effect, j, size in self.effects:
            if effect == "joint-viscous-asymmetry":
                out[j] -= size[0 if v[j] >= 0 else 1] * v[j]
            elif effect == "joint-quadratic-friction":
                out[j] -= size * abs(v[j]) * v[j]
            elif effect == "joint-offset":
                out[j] += size
            elif effect == "joint-torque-ripple":
                out[j] += size[0] * np.sin(size[1] * q[j] + size[2])
            elif effect == "periodic-disturbance":
                out[j] += size[0] * np.sin(2 * np.pi * size[1] * t + size[2])
            elif effect == "dahl":
                moved = 0.0 if self.last is None else q[j] - self.last
                end = np.copysign(PRE_SLIDING, moved)
                self.bristle[j] = end + (self.bristle[j] - end) * np.exp(-abs(moved) / PRE_SLIDING)
                self.last = q[j]
                out[j] -= size / PRE_SLIDING * self.bristle[j]
        return out

    def read(self, kind, values):
        """What the sensors make of it."""
        values = values.copy()
        for effect, j, size in self.effects:
            if effect == "sensor-scale" and kind == "velocity":
                values[j] *= size
            elif effect == "sensor-bias" and kind == "position":
                values[j] += size
        return values

    def lateness(self):
        """Steps by which a joint's encoder is late."""
        return {j: round(size / STEP) for effect, j, size in self.effects if effect == "sensor-delay"}


def model_of(name, robot, effects):
    spec = mujoco.MjSpec.from_file(str(HERE / f"{name}.urdf"))
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.gravity = [0, 0, robot["gravity"]]
    spec.compiler.fusestatic = False
    if robot["base"] == "free":
        spec.worldbody.first_body().add_freejoint()
    for joint in spec.joints:
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
    for effect, where, size in effects:
        if effect == "payload":
            tool = spec.body(robot["tool"])
            tool.add_body(name="load", pos=[0.02, 0.0, 0.09], mass=size, inertia=[1e-9] * 3, ipos=[0, 0, 0], explicitinertial=True)
            continue
        if effect == "body-mass":
            spec.body(robot["tool"]).mass *= size
            continue
        joint = spec.joint(robot["joints"][where])
        if effect == "joint-armature":
            joint.armature = size
        elif effect == "joint-coulomb-friction":
            joint.frictionloss = size
        elif effect == "joint-viscous-friction":
            joint.damping = [size, 0, 0] if np.ndim(joint.damping) else size
        elif effect == "joint-cable-stiffness":
            joint.stiffness = [size, 0, 0] if np.ndim(joint.stiffness) else size
    return spec.compile()


def reference(dice, count):
    """Sums of three sines a joint: position and rate by time."""
    amplitude = dice.uniform(0.15, 0.45, (count, 3))
    rate = 2 * np.pi * dice.uniform(0.15, 0.9, (count, 3))
    phase = dice.uniform(0, 2 * np.pi, (count, 3))
    middle = dice.uniform(-0.6, 0.6, count)
    at = lambda t: middle + (amplitude * np.sin(rate * t + phase)).sum(1)
    slope = lambda t: (amplitude * rate * np.cos(rate * t + phase)).sum(1)
    return at, slope


def record(model, robot, effects, dice):
    delays = [(where, size) for effect, where, size in effects if effect == "actuator-delay"]
    delay = delays[0] if delays else (None, 0.0)
    laws = Laws(effects, len(robot["joints"]))
    late_by, past_q = laws.lateness(), []
    data = mujoco.MjData(model)
    count = len(robot["joints"])
    is_free = robot["base"] == "free"
    q0, v0 = (7, 6) if is_free else (0, 0)
    at, slope = reference(dice, count)
    data.qpos[q0:] = at(0.0) + dice.normal(0, 0.05, count)
    if is_free:
        data.qvel[:6] = np.r_[dice.normal(0, 0.01, 3), dice.normal(0, 0.03, 3)]
    mujoco.mj_forward(model, data)
    gain = np.array(robot["gain"], float)
    commands, joints, bases = [], [], []
    per_tick, late = round(TICK / STEP), round(delay[1] / STEP)
    held = []
    for k in range(round(SECONDS / STEP) + 1):
        t = k * STEP
        if k % per_tick == 0:
            q, v = data.qpos[q0:], data.qvel[v0:]
            command = gain * (at(t) - q) + 0.15 * gain * (slope(t) - v) + data.qfrc_bias[v0:]
            command = np.round(command, 4)
            commands.append((t, command))
            held.append((k, command))
        if k % round(4e-3 / STEP) == 0:
            seen = data.qpos[q0:].copy()
            for j, steps in late_by.items():
                seen[j] = past_q[max(k - steps, 0)][j] if k else seen[j]
            joints.append((t, laws.read("position", seen), laws.read("velocity", data.qvel[v0:])))
        if is_free and k % round(20e-3 / STEP) == 0:
            bases.append((t, data.qpos[:3].copy(), data.qpos[3:7].copy(), data.qvel[3:6].copy()))
        now = held[-1][1].copy()
        if delay[0] is not None:
            past = [c for (since, c) in held[-12:] if since <= k - late]
            now[delay[0]] = past[-1][delay[0]] if past else 0.0
        if late_by:
            past_q.append(data.qpos[q0:].copy())
        data.qfrc_applied[v0:] = laws.effort(t, data.qpos[q0:].copy(), data.qvel[v0:].copy(), now)
        mujoco.mj_step(model, data)
    return commands, joints, bases


def write_run(path, robot, recorded, dice):
    commands, joints, bases = recorded
    rows = {}
    names = robot["joints"]
    header = [f"joint.{j}.effort_command" for j in names] + [f"joint.{j}.position" for j in names] + [f"joint.{j}.velocity" for j in names]
    base = [f"body.hull.position.{a}" for a in "xyz"] + [f"body.hull.orientation.{a}" for a in "wxyz"] + [f"body.hull.angular_velocity.{a}" for a in "xyz"]
    header += base if bases else []
    put = lambda t, channel, value, digits: rows.setdefault(round(t, 6), {}).__setitem__(channel, f"{value:.{digits}f}")
    for t, command in commands:
        for j, c in zip(names, command):
            put(t, f"joint.{j}.effort_command", c, 4)
    for t, q, v in joints:
        for j, x, w in zip(names, q + dice.normal(0, NOISE["position"], len(q)), v + dice.normal(0, NOISE["velocity"], len(v))):
            put(t, f"joint.{j}.position", x, 6)
            put(t, f"joint.{j}.velocity", w, 5)
    for t, p, q, w in bases:
        turn = dice.normal(0, NOISE["turn"], 3)
        noisy = np.zeros(4)
        mujoco.mju_mulQuat(noisy, q, np.r_[1.0, 0.5 * turn])
        noisy /= np.linalg.norm(noisy)
        for a, x in zip("xyz", p + dice.normal(0, NOISE["base"], 3)):
            put(t, f"body.hull.position.{a}", x, 6)
        for a, x in zip("wxyz", noisy):
            put(t, f"body.hull.orientation.{a}", x, 7)
        for a, x in zip("xyz", w + dice.normal(0, NOISE["gyro"], 3)):
            put(t, f"body.hull.angular_velocity.{a}", x, 6)
    lines = ["t," + ",".join(header)]
    lines += [f"{t:.4f}," + ",".join(row.get(c, "") for c in header) for t, row in sorted(rows.items())]
    path.write_text("\n".join(lines) + "\n")


def manifest(robot, stated=1.0):
    """What a set says of itself, the noise of its sensors times `stated`."""
    text = f'format = 1\nrig = "{robot}"\ntitle = "{robot} by MuJoCo"\n\n[noise]\n'
    for j in ROBOTS[robot]["joints"]:
        text += f'"joint.{j}.position" = {NOISE["position"] * stated:.6g}\n"joint.{j}.velocity" = {NOISE["velocity"] * stated:.6g}\n'
    if ROBOTS[robot]["base"] == "free":
        for channel, key in (("position", "base"), ("orientation", "turn"), ("angular_velocity", "gyro")):
            text += f'"body.hull.{channel}" = {NOISE[key] * stated:.6g}\n'
    for i in range(RUNS):
        text += f'\n[[run]]\nfile = "run-{i + 1}.csv"\nrole = "{"fit" if i < 3 else "holdout"}"\nnote = "sines {i + 1}"\n'
    return text


def scenario(name, robot):
    text = f'name = "{name}"\nseed = 1\nduration_s = 1.0\n\n[integrator]\nkind = "rk4"\nstep_s = 5e-4\n\n'
    kind = "lab" if robot["gravity"] else "deep-space"
    text += f'[environment]\nkind = "{kind}"\n' + (f"gravity_m_per_s2 = [0.0, 0.0, {robot['gravity']}]\n" if robot["gravity"] else "")
    text += f'\n[[vehicle]]\nname = "{name}"\nurdf = "{name}.urdf"\nbase = "{robot["base"]}"\n'
    for j in robot["joints"]:
        text += f'\n[[actuator]]\nname = "{j}"\nkind = "joint-torque"\njoint = "{name}/{j}"\n'
    return text


ALL = {**CASES, **MORE}


def place_of(robot, effect, where):
    if effect in ("payload", "body-mass"):
        return f"body:{robot['tool']}"
    joint = robot["joints"][where]
    if effect.startswith("sensor-"):
        return f"sensor:joint.{joint}.{'velocity' if effect == 'sensor-scale' else 'position'}"
    return f"joint:{joint}"


def main():
    out, wanted = pathlib.Path(sys.argv[1]), sys.argv[2:] or list(CASES)
    keys = {}
    for number, (name, robot) in enumerate(ROBOTS.items()):
        folder = out / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "scenario.toml").write_text(scenario(name, robot))
        (folder / f"{name}.urdf").write_text((HERE / f"{name}.urdf").read_text())
        for case in wanted:
            effects = ALL[case]
            acting = [("dahl" if case == "dahl" else effect, where, size) for effect, where, size in effects]
            model = model_of(name, robot, acting)
            (folder / case).mkdir(exist_ok=True)
            (folder / case / "recording.toml").write_text(manifest(name))
            for run in range(RUNS):
                dice = np.random.default_rng([number, run])
                recorded = record(model, robot, acting, dice)
                write_run(folder / case / f"run-{run + 1}.csv", robot, recorded, np.random.default_rng([number, run, list(ALL).index(case)]))
            place = lambda effect, where: place_of(robot, effect, where)
            keys[f"{name}/{case}"] = [[effect, place(effect, where), size] for effect, where, size in effects]
            print(f"{name}/{case}", flush=True)
    (out / "keys.json").write_text(json.dumps(keys, indent=1) + "\n")


if __name__ == "__main__":
    main()

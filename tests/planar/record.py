#!/usr/bin/env python3
"""Recordings of a vehicle on air bearings by a simulator of its own, each with something concealed, diagnosed and judged.

    record.py SOFTDOCK OUT [CASE…]        needs numpy

OUT/scenario.toml, OUT/vehicle.urdf, OUT/<case>/{recording.toml,run-1.csv …}. Three runs of 25 s, the last is left out of the fit. Six thrusters that are
open or shut for a fifth of a second to a second and a half, pose at 50 Hz, gyro at 125 Hz, white noise and rounding; RK4 at 2 ms, which is converged: at
1 ms no reading moves by a hundredth of its noise.

The equations are Lagrange's in q = (x, y, θ, u₁, u₂, η, φ): place and turn of the vehicle, deflection of a mass on a spring in the vehicle's axes, coordinate of
an appendage's mode, turn of an inner ring. Each part adds its mass to M(q) and its velocity product to the right-hand side.
"""

import json
import pathlib
import subprocess
import sys

import numpy as np

MASS, COM, INERTIA = 14.0, np.array([0.01, -0.005]), 0.35
LARGEST, TICK, STEP, SECONDS, RUNS = 0.6, 0.05, 2e-3, 25.0, 3
NOISE = {"position": 2e-4, "orientation": 5e-4, "angular_velocity": 1e-3}
# Place and direction of each thruster, axes of the vehicle.
THRUSTERS = {
    "left_ahead": ([-0.2, 0.15], [1, 0]),
    "right_ahead": ([-0.2, -0.15], [1, 0]),
    "left_back": ([0.2, 0.15], [-1, 0]),
    "right_back": ([0.2, -0.15], [-1, 0]),
    "to_left": ([0.1, -0.2], [0, 1]),
    "to_right": ([-0.1, 0.2], [0, -1]),
}
CASES = {
    "nothing": {},
    "slosh": {"mass": 2.0, "frequency": 0.6, "damping": 0.03, "position": [0.08, 0.12]},
    "flexible-appendage": {"frequency": 0.9, "damping": 0.01, "coupling": 0.22},
    "internal-dissipation": {"i_damper": 0.06, "c": 0.03},
    "linear-drag": {"c": 0.15},
    "actuator-gain": {"gain": 0.9},
}
# The number by which a case is judged, and by how much of it, at most, it may be off.
JUDGED = {"slosh": "mass", "flexible-appendage": "frequency", "internal-dissipation": "c", "linear-drag": "c", "actuator-gain": "gain"}
NEAR = 0.03


def across(r):
    """A vector turned by a right angle."""
    return np.array([-r[1], r[0]])


class Vehicle:
    """The vehicle with one effect."""

    def __init__(self, case):
        self.case, self.law = case, CASES[case]
        own = self.law if case == "slosh" else {"mass": 0.0, "position": [0.0, 0.0]}
        # What sloshes is a part of the nominal mass, centre and inertia, at rest.
        self.slosh, self.rest = own["mass"], COM + np.array(own["position"])
        self.mass = MASS - self.slosh
        self.com = (MASS * COM - self.slosh * self.rest) / self.mass
        parallel = self.mass * np.sum((self.com - COM) ** 2) + self.slosh * np.sum((self.rest - COM) ** 2)
        self.inertia = INERTIA - parallel

    def accelerations(self, q, v, commands):
        """q̈ under shares of the thrusters' force."""
        c, s, rate = np.cos(q[2]), np.sin(q[2]), v[2]
        turn = np.array([[c, -s], [s, c]])
        matrix, force = np.zeros((7, 7)), np.zeros(7)

        def add_point(mass, place, moving, slip):
            jacobian = np.zeros((2, 7))
            jacobian[:, :2], jacobian[:, 2] = np.eye(2), turn @ across(place)
            if moving:
                jacobian[:, 3:5] = turn
            product = turn @ (-(rate**2) * place + 2 * rate * across(slip))
            matrix[:] += mass * jacobian.T @ jacobian
            force[:] -= mass * jacobian.T @ product

        add_point(self.mass, self.com, False, np.zeros(2))
        matrix[2, 2] += self.inertia
        for name, share in zip(THRUSTERS, commands):
            place, along = map(np.array, THRUSTERS[name])
            push = share * LARGEST * (self.law["gain"] if self.case == "actuator-gain" and name == "left_ahead" else 1.0)
            force[:2] += push * turn @ along
            force[2] += push * (place[0] * along[1] - place[1] * along[0])
        if self.case == "slosh":
            omega = 2 * np.pi * self.law["frequency"]
            add_point(self.slosh, self.rest + q[3:5], True, v[3:5])
            force[3:5] -= self.slosh * (omega**2 * q[3:5] + 2 * self.law["damping"] * omega * v[3:5])
        if self.case == "flexible-appendage":
            omega, coupling = 2 * np.pi * self.law["frequency"], self.law["coupling"]
            matrix[5, 5], matrix[2, 5], matrix[5, 2] = 1.0, coupling, coupling
            force[5] -= omega**2 * q[5] + 2 * self.law["damping"] * omega * v[5]
        if self.case == "internal-dissipation":
            ring, drag = self.law["i_damper"], self.law["c"] * (v[6] - rate)
            matrix[2, 2], matrix[6, 6] = matrix[2, 2] - ring, ring
            force[2], force[6] = force[2] + drag, -drag
        if self.case == "linear-drag":
            # On the velocity of the centre of mass.
            velocity = v[:2] + rate * turn @ across(COM)
            pull = -self.law["c"] * velocity
            force[:2] += pull
            force[2] += (turn @ across(COM)) @ pull
        still = [k for k in range(3, 7) if matrix[k, k] == 0.0]
        matrix[still, still], force[still] = 1.0, 0.0
        return np.linalg.solve(matrix, force)

    def run(self, seed):
        """States every STEP and commands every TICK."""
        dice = np.random.default_rng([seed, 1])
        ticks = round(SECONDS / TICK) + 1
        commands = np.zeros((ticks, len(THRUSTERS)))
        for k in range(len(THRUSTERS)):
            at = 0
            while at < ticks:
                length = dice.integers(4, 30)
                commands[at : at + length, k] = float(dice.random() < 0.35)
                at += length
        q, v = np.zeros(7), np.zeros(7)
        q[:2], q[2] = dice.normal(0, 0.3, 2), dice.uniform(-1, 1)
        v[:2], v[2] = dice.normal(0, 0.02, 2), dice.normal(0, 0.05)
        v[6] = v[2]
        x, states = np.concatenate([q, v]), []
        for i in range(round(SECONDS / STEP) + 1):
            states.append(x)
            now = commands[min(int((i + 0.5) * STEP / TICK), ticks - 1)]
            rate = lambda x: np.concatenate([x[7:], self.accelerations(x[:7], x[7:], now)])  # noqa: B023, E731
            a = rate(x)
            b = rate(x + STEP / 2 * a)
            c = rate(x + STEP / 2 * b)
            d = rate(x + STEP * c)
            x = x + STEP / 6 * (a + 2 * b + 2 * c + d)
        return np.array(states), commands


def write_run(file, states, commands, seed):
    """One run as a file: every channel at its own instants."""
    dice = np.random.default_rng([seed, 2])
    rows = {}

    def put(at, cells):
        rows.setdefault(round(at, 6), {}).update(cells)

    for k, shares in enumerate(commands):
        put(k * TICK, {f"actuator.{n}.command": f"{u:g}" for n, u in zip(THRUSTERS, shares)})
    for i in range(0, len(states), round(1 / 50 / STEP)):
        place = states[i, :2] + NOISE["position"] * dice.standard_normal(2)
        off = NOISE["orientation"] * dice.standard_normal(3)
        half = states[i, 2] / 2
        w, z = np.cos(half), np.sin(half)
        # A small turn about the vehicle's own axes after the true one.
        turned = np.array([w - z * off[2] / 2, w * off[0] / 2 - z * off[1] / 2, w * off[1] / 2 + z * off[0] / 2, z + w * off[2] / 2])
        turned /= np.linalg.norm(turned)
        cells = {f"body.hull.position.{a}": f"{x:.6f}" for a, x in zip("xy", place)}
        put(i * STEP, cells | {f"body.hull.orientation.{a}": f"{x:.7f}" for a, x in zip("wxyz", turned)})
    for i in range(0, len(states), round(1 / 125 / STEP)):
        rates = np.array([0, 0, states[i, 9]]) + NOISE["angular_velocity"] * dice.standard_normal(3)
        put(i * STEP, {f"body.hull.angular_velocity.{a}": f"{x:.6f}" for a, x in zip("xyz", rates)})
    names = sorted({name for cells in rows.values() for name in cells})
    lines = [",".join(["t", *names])]
    lines += [",".join([f"{t:g}", *(rows[t].get(name, "") for name in names)]) for t in sorted(rows)]
    file.write_text("\n".join(lines) + "\n")


def write_scenario(out):
    """The nominal model, which knows of no case."""
    (out / "vehicle.urdf").write_text(
        f"""<?xml version="1.0"?>
<robot name="vehicle">
  <link name="hull"><inertial><origin xyz="{COM[0]} {COM[1]} 0"/><mass value="{MASS}"/>
    <inertia ixx="0.3" iyy="0.3" izz="{INERTIA}" ixy="0" ixz="0" iyz="0"/></inertial></link>
</robot>
"""
    )
    text = """name = "vehicle"
seed = 1
duration_s = 1.0
[integrator]
kind = "rk4"
step_s = 2e-3
[environment]
kind = "air-bearing"
[[vehicle]]
name = "vehicle"
urdf = "vehicle.urdf"
base = { free = ["x", "y", "yaw"] }
"""
    for name, (place, along) in THRUSTERS.items():
        text += f"""[[actuator]]
name = "{name}"
kind = "thruster"
link = "vehicle/hull"
position_m = [{place[0]}, {place[1]}, 0.0]
direction = [{float(along[0])}, {float(along[1])}, 0.0]
max_force_n = {LARGEST}
"""
    (out / "scenario.toml").write_text(text)


def record(out, case):
    """All runs of a case."""
    folder = out / case
    folder.mkdir(parents=True, exist_ok=True)
    text = f'format = 1\nrig = "vehicle"\ntitle = "{case}"\n[noise]\n'
    text += "".join(f'"body.hull.{name}" = {sigma}\n' for name, sigma in NOISE.items())
    for k in range(1, RUNS + 1):
        seed = 100 * list(CASES).index(case) + k
        states, commands = Vehicle(case).run(seed)
        write_run(folder / f"run-{k}.csv", states, commands, seed)
        text += f'[[run]]\nfile = "run-{k}.csv"\nrole = "{"fit" if k < RUNS else "holdout"}"\n'
    (folder / "recording.toml").write_text(text)


def is_right(case, told):
    """Whether a diagnosis tells what was concealed, and nothing else."""
    if case == "nothing":
        return told["verdict"] == "no-mismatch"
    names = [effect["name"] for effect in told["effects"]]
    if told["verdict"] != "explained" or names != [case]:
        return False
    key = JUDGED[case]
    return abs(told["effects"][0]["params"][key] / CASES[case][key] - 1) < NEAR


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    softdock, out, cases = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:] or list(CASES)
    out.mkdir(parents=True, exist_ok=True)
    write_scenario(out)
    right = 0
    print("| concealed | verdict | told | right |\n| --- | --- | --- | --- |")
    for case in cases:
        record(out, case)
        result = out / case / "out"
        subprocess.run([softdock, "diagnose", out / "scenario.toml", out / case, "--out", result, "--quiet"], check=False, stdout=subprocess.DEVNULL)
        told = json.loads((result / "diagnosis.json").read_text())
        right += is_right(case, told)
        words = "; ".join(f'{e["name"]} at {e["place"]} {e["params"]}' for e in told["effects"])
        concealed = f"{case} {CASES[case]}" if CASES[case] else case
        print(f'| {concealed} | {told["verdict"]} | {words} | {"yes" if is_right(case, told) else "no"} |', flush=True)
    sys.exit(0 if right == len(cases) else f"{right} of {len(cases)} right")


if __name__ == "__main__":
    main()

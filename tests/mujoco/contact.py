#!/usr/bin/env python3
"""Recordings by MuJoCo of a ball that flies against a plate, beside a scenario whose law of contact is another one.

    contact.py OUT [CASE…]        needs mujoco 4.0 and numpy from PyPI; OUT/plate.toml, OUT/<case>/{recording.toml,run-1.csv …}
    softdock diagnose OUT/plate.toml OUT/friction

No gravity, both bodies free, no control; one touch of 16 ms a run. MuJoCo's contact is a linear spring and damper on the relative acceleration
(direct `solref`), its friction a cone on a damper, which creeps where softdock's bristle holds: what is concealed stands beside a law that is wrong anyway.
RK4 at 0.1 ms; poses at 250 Hz, body rates of the chaser; white noise.
"""

import pathlib
import sys

import mujoco
import numpy as np

RUNS, SECONDS, STEP, EVERY = 5, 5.0, 1e-4, 40
RADIUS, ARM = 0.03, 0.5
BODIES = {"chaser": (20.0, (0.0, 0.0, 0.0), (0.8, 1.2, 1.2)), "target": (80.0, (0.3, 0.0, 0.0), (6.0, 8.0, 8.0))}
# Stiffness and damping of the relative motion by its effective mass, 1/s² and 1/s: rebounds with 0.55 of the speed.
SPRING, DAMPER = 4e4, 60.0
NOISE = {"position": 2e-5, "orientation": 5e-5, "angular_velocity": 2e-4}
CASES = {"nothing": {}, "friction": {"friction": 0.25}, "mass": {"heavier": 1.1}}


def model(friction=0.12, heavier=1.0):
    contact = f'mass="0" friction="{friction} 0 0" condim="3" solref="{-SPRING} {-DAMPER}" solimp="0.99 0.99 0.001"'
    shapes = {"chaser": f'type="sphere" size="{RADIUS}" pos="{ARM} 0 0"', "target": 'type="box" size="0.01 0.4 0.4" pos="0.01 0 0"'}
    bodies = ""
    for name, (mass, com, inertia) in BODIES.items():
        mass *= heavier if name == "target" else 1.0
        inertial = f'<inertial pos="{words(com)}" mass="{mass}" diaginertia="{words(inertia)}"/>'
        bodies += f'<body name="{name}"><freejoint/>{inertial}<geom {shapes[name]} {contact}/></body>'
    option = f'<option gravity="0 0 0" timestep="{STEP}" integrator="RK4" cone="elliptic" impratio="20"/>'
    return mujoco.MjModel.from_xml_string(f"<mujoco>{option}<worldbody>{bodies}</worldbody></mujoco>")


def words(values):
    return " ".join(str(v) for v in values)


def record(built, seed):
    """Rows of t, poses and the chaser's rates."""
    dice, noise = np.random.default_rng(seed), np.random.default_rng([seed, 7])
    data = mujoco.MjData(built)
    data.qpos[0:3] = [-0.01 - 0.02 * dice.random(), *(0.05 * dice.normal(size=2))]
    data.qpos[7] = 0.6
    data.qvel[0:3] = [0.08 + 0.05 * dice.random(), *(0.04 * dice.normal(size=2))]
    data.qvel[3:6] = 0.05 * dice.normal(size=3)
    data.qvel[9:12] = 0.01 * dice.normal(size=3)
    rows = []
    for step in range(round(SECONDS / STEP) + 1):
        if step % EVERY == 0:
            row = [step * STEP]
            for q in (data.qpos[0:7], data.qpos[7:14]):
                row += [*(q[0:3] + NOISE["position"] * noise.normal(size=3)), *turned(q[3:7], NOISE["orientation"] * noise.normal(size=3))]
            rows.append([*row, *(data.qvel[3:6] + NOISE["angular_velocity"] * noise.normal(size=3))])
        mujoco.mj_step(built, data)
    return rows


def turned(orientation, by):
    out = np.zeros(4)
    mujoco.mju_mulQuat(out, orientation, np.array([1.0, *(0.5 * by)]))
    return out / np.linalg.norm(out)


def write(folder, options):
    folder.mkdir(parents=True, exist_ok=True)
    pose = [f"body.{b}.{part}" for b in BODIES for part in [*(f"position.{a}" for a in "xyz"), *(f"orientation.{a}" for a in "wxyz")]]
    header = ",".join(["t", *pose, *(f"body.chaser.angular_velocity.{a}" for a in "xyz")])
    manifest = 'format = 1\nrig = "plate"\ntitle = "A ball against a plate"\n\n[noise]\n'
    manifest += "".join(f'"body.{b}.{q}" = {NOISE[q]}\n' for b in BODIES for q in ("position", "orientation"))
    manifest += f'"body.chaser.angular_velocity" = {NOISE["angular_velocity"]}\n'
    for run in range(RUNS):
        rows = record(model(**options), 100 + run)
        lines = [",".join(f"{x:.7f}" for x in row) for row in rows]
        (folder / f"run-{run + 1}.csv").write_text("\n".join([header, *lines]) + "\n")
        manifest += f'\n[[run]]\nfile = "run-{run + 1}.csv"\nrole = "{"fit" if run < 3 else "holdout"}"\n'
    (folder / "recording.toml").write_text(manifest)


def urdf(name, mass, com, inertia):
    moments = "".join(f' {k}="{v}"' for k, v in zip(("ixx", "iyy", "izz"), inertia))
    inertial = f'<origin xyz="{words(com)}"/><mass value="{mass}"/><inertia{moments} ixy="0" ixz="0" iyz="0"/>'
    return f'<robot name="{name}"><link name="{name}"><inertial>{inertial}</inertial></link></robot>\n'


def scenario():
    mass = 1.0 / sum(1.0 / m for m, _, _ in BODIES.values())
    return f"""name = "plate"
seed = 1
duration_s = {SECONDS}

[integrator]
kind = "rk4"
step_s = 2.5e-4

[[vehicle]]
name = "chaser"
urdf = "chaser.urdf"
pose = {{ position_m = [-0.02, 0.0, 0.0] }}
twist = {{ linear_m_per_s = [0.1, 0.0, 0.0] }}

[[vehicle]]
name = "target"
urdf = "target.urdf"
pose = {{ position_m = [0.6, 0.0, 0.0] }}

[[shape]]
name = "ball"
on = "chaser/chaser"
kind = "sphere"
radius_m = {RADIUS}
pose = {{ position_m = [{ARM}, 0.0, 0.0] }}

[[shape]]
name = "plate"
on = "target/target"
kind = "box"
size_m = [0.02, 0.8, 0.8]
pose = {{ position_m = [0.01, 0.0, 0.0] }}

# As stiff as MuJoCo's, and as lively at 0.1 m/s.
[[contact]]
between = ["chaser/ball", "target/plate"]
points = "deepest"
normal = {{ law = "hunt-crossley", stiffness_n_per_m_exp = {round(mass * SPRING)}, exponent = 1.0, dissipation_s_per_m = 6.0 }}
friction = {{ law = "bristle", mu = 0.12, stiffness_n_per_m = 4.0e5, damping_n_s_per_m = 400.0 }}

[output]
log_rate_hz = 250.0
"""


def main():
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(CASES):
        sys.exit(f"usage: contact.py OUT [{'|'.join(CASES)} …]")
    out = pathlib.Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    for name, (mass, com, inertia) in BODIES.items():
        (out / f"{name}.urdf").write_text(urdf(name, mass, com, inertia))
    (out / "plate.toml").write_text(scenario())
    for case in sys.argv[2:] or CASES:
        write(out / case, CASES[case])


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Recordings of two rigs in contact by MuJoCo, each with something concealed, beside scenarios that know nothing of it.

    berth.py OUT [CASE…]                needs mujoco 4.0 and numpy from PyPI; without CASE all of CASES
    berth.py OUT compare SOFTDOCK       the same five starts of `berth` by both simulators, unpushed, through their first touch; needs pyarrow too

OUT/<rig>/scenario.toml, OUT/<rig>/<case>/{recording.toml,run-1.csv …}, OUT/keys.json, as record.py writes them.

`berth`: a free flyer bumps its ball tip against the slanted plate of a free target, pushed there again and again by its thrusters. `puck`: a puck on three
feet is pushed about on a table with weight. MuJoCo's contact is an acceleration constraint (Todorov 2014): with a direct `solref = (−k, −b)` the force of one
point is m_eff (k r + b v − d a₀) with the effective mass of that point and the impedance d, and its friction creeps; softdock's laws have neither, so that a
scenario's stiffness is right for one attitude and what is left is MuJoCo's own.
"""

import json
import pathlib
import subprocess
import sys

import mujoco
import numpy as np

RUNS, STEP, TICK = 5, 1e-4, 10e-3
NOISE = {"position": 1e-4, "orientation": 2e-4, "angular_velocity": 4e-4, "force": 0.05}
IMPEDANCE = 0.95

BERTH = """
<mujoco>
  <option timestep="{step}" integrator="RK4" gravity="0 0 0" cone="elliptic" impratio="10"/>
  <worldbody>
    <body name="chaser">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="0.35 0.42 0.47"/>
      <geom name="tip" type="sphere" size="0.04" pos="0.3 0 0" contype="1" conaffinity="2" mass="0"/>
      <site name="com"/>
    </body>
    <body name="target">
      <freejoint/>
      <inertial pos="0 0 0" mass="25" diaginertia="0.9 1.1 1.2"/>
      <geom name="plate" type="box" size="0.02 0.3 0.3" pos="-0.3 0 0" euler="0 0 {tilt}" contype="2" conaffinity="1" mass="0"/>
    </body>
  </worldbody>
</mujoco>
"""
PUCK = """
<mujoco>
  <option timestep="{step}" integrator="RK4" gravity="{gx} {gy} -9.81" cone="elliptic" impratio="10"/>
  <worldbody>
    <geom name="table" type="plane" size="5 5 0.1" contype="2" conaffinity="1"/>
    <body name="puck">
      <freejoint/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="0.02 0.02 0.03"/>
      <geom name="foot_1" type="sphere" size="0.015" pos="0.1 0 -0.035" contype="1" conaffinity="2" mass="0"/>
      <geom name="foot_2" type="sphere" size="0.015" pos="-0.05 0.0866 -0.035" contype="1" conaffinity="2" mass="0"/>
      <geom name="foot_3" type="sphere" size="0.015" pos="-0.05 -0.0866 -0.035" contype="1" conaffinity="2" mass="0"/>
    </body>
  </worldbody>
</mujoco>
"""

RIGS = {
    "berth": dict(xml=BERTH, seconds=10.0, bodies=["chaser", "target"], mass=14.0, mu=0.25, k=6000.0, b=150.0, pushes=(1.2, 0.15)),
    "puck": dict(xml=PUCK, seconds=8.0, bodies=["puck"], mass=2.5, mu=0.30, k=40000.0, b=300.0, pushes=(11.0, 8.0)),
}
# Direction, and which of a rig's largest pushes it is; commands are shares of that.
THRUSTERS = {"push_x": ((1, 0), 0), "back_x": ((-1, 0), 0), "push_y": ((0, 1), 1), "back_y": ((0, -1), 1)}
CASES = {
    "berth": {
        "nothing": [],
        "stiffness": [("contact-stiffness", "contact:tip/plate", 0.5)],
        "friction": [("friction-coefficient", "contact:tip/plate", 0.12)],
        "mass": [("body-mass", "body:chaser", 15.4)],
        "force": [("constant-force", "body:target", (0.02, -0.012, 0.0))],
        "drag": [("linear-drag", "body:chaser", 0.25)],
        "gain": [("actuator-gain", "actuator:push_x", 0.9)],
        "offset": [("contact-geometry-offset", "contact:tip/plate", 0.004)],
        "friction-drag": [("friction-coefficient", "contact:tip/plate", 0.12), ("linear-drag", "body:chaser", 0.25)],
    },
    "puck": {
        "nothing": [],
        "friction": [("friction-coefficient", "contact:foot/table", 0.24)],
        "mass": [("body-mass", "body:puck", 2.75)],
        "tilt": [("tilt", "world", (0.06, -0.04, 0.0))],
        "gain": [("actuator-gain", "actuator:push_x", 0.9)],
        "viscous": [("friction-viscous", "contact:foot/table", 0.8)],
    },
}


def value(effects, name, usual):
    found = [size for effect, _, size in effects if effect == name]
    return found[0] if found else usual


def model_of(name, rig, effects):
    tilt = value(effects, "tilt", (0.0, 0.0, 0.0))
    text = rig["xml"].format(step=STEP, mass=value(effects, "body-mass", rig["mass"]), tilt=8.0, gx=tilt[0], gy=tilt[1])
    spec = mujoco.MjSpec.from_string(text)
    k = rig["k"] * value(effects, "contact-stiffness", 1.0)
    for geom in spec.geoms:
        geom.friction = [value(effects, "friction-coefficient", rig["mu"]), 0.0, 0.0]
        geom.condim = 3
        geom.solref = [-k, -rig["b"]]
        geom.solimp = [IMPEDANCE, IMPEDANCE, 0.001, 0.5, 2]
        if geom.name == "plate":
            geom.pos = geom.pos + np.array([-value(effects, "contact-geometry-offset", 0.0), 0.0, 0.0])
    return spec.compile()


def schedule(name, rig, dice):
    """Forces of the two thrusters through the middle, body axes: when, and how much."""
    most = rig["pushes"][0]
    out, t = [], 0.0
    while t < rig["seconds"]:
        if name == "berth":
            # Towards the plate most of the time, now and then aside.
            x = dice.uniform(0.3, 1.0) * most if dice.random() < 0.75 else 0.0
            y = dice.uniform(-1, 1) * rig["pushes"][1]
        else:
            x, y = dice.uniform(-1, 1) * most, dice.uniform(-1, 1) * rig["pushes"][1]
        out.append((t, round(x, 3), round(y, 3)))
        t += round(dice.uniform(0.4, 1.1) / TICK) * TICK
    return out


def begin(name, data, dice):
    data.qpos[3:7] = [1, 0, 0, 0]
    if name == "berth":
        data.qpos[:3] = [-0.68 - dice.uniform(0, 0.03), dice.normal(0, 0.01), dice.normal(0, 0.01)]
        data.qvel[:6] = np.r_[0.08 + dice.normal(0, 0.01), dice.normal(0, 0.01, 2), dice.normal(0, 0.03, 3)]
        data.qpos[7:14] = [0, 0, 0, 1, 0, 0, 0]
        data.qvel[6:12] = np.r_[dice.normal(0, 0.003, 3), dice.normal(0, 0.02, 3)]
    else:
        data.qpos[:3] = [dice.normal(0, 0.1), dice.normal(0, 0.1), 0.05]
        angle = dice.uniform(-0.5, 0.5)
        data.qpos[3:7] = [np.cos(angle / 2), 0, 0, np.sin(angle / 2)]


def record(name, rig, effects, dice):
    model = model_of(name, rig, effects)
    data = mujoco.MjData(model)
    begin(name, data, dice)
    pushes = schedule(name, rig, dice)
    gain, drag = value(effects, "actuator-gain", 1.0), value(effects, "linear-drag", 0.0)
    force, viscous = value(effects, "constant-force", None), value(effects, "friction-viscous", 0.0)
    bodies = [model.body(b).id for b in rig["bodies"]]
    settle = round(0.5 / STEP) if name == "puck" else 0
    commands, poses, rates = [], [], []
    for k in range(-settle, round(rig["seconds"] / STEP) + 1):
        t = k * STEP
        now = [p for p in pushes if p[0] <= t + 1e-9][-1] if k >= 0 else (0, 0.0, 0.0)
        turn = data.xmat[bodies[0]].reshape(3, 3)
        data.xfrc_applied[:] = 0.0
        mujoco.mj_forward(model, data)
        v = data.qvel[:3]
        data.xfrc_applied[bodies[0], :3] = turn @ [gain * now[1] if now[1] > 0 else now[1], now[2], 0.0] - drag * v
        if viscous:
            # At each foot, as its slip is; the feet share the weight.
            for foot in ("foot_1", "foot_2", "foot_3"):
                arm = data.geom(foot).xpos - [0, 0, 0.015] - data.xipos[bodies[0]]
                slip = v + np.cross(turn @ data.qvel[3:6], arm)
                at = np.r_[-viscous * slip[:2], 0.0]
                data.xfrc_applied[bodies[0], :3] += at
                data.xfrc_applied[bodies[0], 3:] += np.cross(arm, at)
        if force is not None:
            data.xfrc_applied[bodies[1], :3] = force
        if k >= 0:
            if k % round(TICK / STEP) == 0:
                commands.append((t, now[1], now[2]))
                poses.append((t, [(data.qpos[7 * i : 7 * i + 3].copy(), data.qpos[7 * i + 3 : 7 * i + 7].copy()) for i in range(len(bodies))]))
            if k % round(4e-3 / STEP) == 0:
                rates.append((t, [data.qvel[6 * i + 3 : 6 * i + 6].copy() for i in range(len(bodies))]))
        mujoco.mj_step(model, data)
    return commands, poses, rates


def write_run(path, rig, recorded, dice):
    commands, poses, rates = recorded
    rows, header = {}, [f"actuator.{thruster}.command" for thruster in THRUSTERS]
    for body in rig["bodies"]:
        header += [f"body.{body}.position.{a}" for a in "xyz"] + [f"body.{body}.orientation.{a}" for a in "wxyz"]
        header += [f"body.{body}.angular_velocity.{a}" for a in "xyz"]
    put = lambda t, channel, number, digits: rows.setdefault(round(t, 6), {}).__setitem__(channel, f"{number:.{digits}f}")
    last = None
    for t, x, y in commands:
        if (x, y) != last:
            for thruster, ((ax, ay), along) in THRUSTERS.items():
                put(t, f"actuator.{thruster}.command", max(ax * x + ay * y, 0.0) / rig["pushes"][along], 6)
            last = (x, y)
    for t, all_of in poses:
        for body, (p, q) in zip(rig["bodies"], all_of):
            noisy = np.zeros(4)
            mujoco.mju_mulQuat(noisy, q, np.r_[1.0, 0.5 * dice.normal(0, NOISE["orientation"], 3)])
            noisy /= np.linalg.norm(noisy)
            for a, x in zip("xyz", p + dice.normal(0, NOISE["position"], 3)):
                put(t, f"body.{body}.position.{a}", x, 6)
            for a, x in zip("wxyz", noisy):
                put(t, f"body.{body}.orientation.{a}", x, 7)
    for t, all_of in rates:
        for body, w in zip(rig["bodies"], all_of):
            for a, x in zip("xyz", w + dice.normal(0, NOISE["angular_velocity"], 3)):
                put(t, f"body.{body}.angular_velocity.{a}", x, 6)
    lines = ["t," + ",".join(header)]
    lines += [f"{t:.4f}," + ",".join(row.get(c, "") for c in header) for t, row in sorted(rows.items())]
    path.write_text("\n".join(lines) + "\n")


def manifest(name, rig):
    text = f'format = 1\nrig = "{name}"\ntitle = "{name} by MuJoCo"\n\n[noise]\n'
    for body in rig["bodies"]:
        for channel in ("position", "orientation", "angular_velocity"):
            text += f'"body.{body}.{channel}" = {NOISE[channel]:.6g}\n'
    for i in range(RUNS):
        text += f'\n[[run]]\nfile = "run-{i + 1}.csv"\nrole = "{"fit" if i < 3 else "holdout"}"\n'
    return text


def link(name, mass, inertia):
    ixx, iyy, izz = inertia
    return (f'  <link name="{name}"><inertial><mass value="{mass}"/><inertia ixx="{ixx}" iyy="{iyy}" izz="{izz}" ixy="0" ixz="0" iyz="0"/>'
            "</inertial></link>\n")


def write_scenario(folder, name, rig):
    inertias = {"chaser": (14.0, (0.35, 0.42, 0.47)), "target": (25.0, (0.9, 1.1, 1.2)), "puck": (2.5, (0.02, 0.02, 0.03))}
    for body in rig["bodies"]:
        (folder / f"{body}.urdf").write_text(f'<robot name="{body}">\n{link(body, *inertias[body])}</robot>\n')
    text = f'name = "{name}"\nseed = 1\nduration_s = 1.0\n\n[integrator]\nkind = "rk4"\nstep_s = 5e-4\n\n[environment]\n'
    text += 'kind = "deep-space"\n' if name == "berth" else 'kind = "lab"\ngravity_m_per_s2 = [0.0, 0.0, -9.81]\n'
    for body, x in zip(rig["bodies"], (-0.7, 0.0) if name == "berth" else (0.0,)):
        z = 0.0 if name == "berth" else 0.05
        text += f'\n[[vehicle]]\nname = "{body}"\nurdf = "{body}.urdf"\npose = {{ position_m = [{x}, 0.0, {z}] }}\n'
    # Of one point with nothing else to bear: m_eff k, with the effective mass of a push through the middles, or of a foot that bears a third.
    if name == "berth":
        effective = 1.0 / (1.0 / 14.0 + 1.0 / 25.0)
        shapes = [("tip", "chaser/chaser", 'kind = "sphere"\nradius_m = 0.04\npose = { position_m = [0.3, 0.0, 0.0] }'),
                  ("plate", "target/target", 'kind = "box"\nsize_m = [0.04, 0.6, 0.6]\npose = { position_m = [-0.3, 0.0, 0.0], rpy_deg = [0.0, 0.0, 8.0] }')]
        between = '["chaser/tip", "target/plate"]'
    else:
        effective = 2.5 / 3.0
        feet = [(0.1, 0.0), (-0.05, 0.0866), (-0.05, -0.0866)]
        shapes = [(f"foot_{i + 1}", "puck/puck", f'kind = "sphere"\nradius_m = 0.015\npose = {{ position_m = [{x}, {y}, -0.035] }}') for i, (x, y) in enumerate(feet)]
        shapes.append(("table", "world", 'kind = "half-space"'))
        between = '["puck/puck", "world/table"]'
    for shape, on, rest in shapes:
        text += f'\n[[shape]]\nname = "{shape}"\non = "{on}"\n{rest}\n'
    stiffness, damping = effective * rig["k"], effective * rig["b"]
    text += f"\n[[contact]]\nbetween = {between}\n"
    text += f'normal = {{ law = "linear", stiffness_n_per_m = {stiffness:.5g}, damping_n_s_per_m = {damping:.4g} }}\n'
    text += f'friction = {{ law = "bristle", mu = {rig["mu"]}, stiffness_n_per_m = {5 * stiffness:.5g}, damping_n_s_per_m = {damping:.4g} }}\n'
    for thruster, ((x, y), along) in THRUSTERS.items():
        body = rig["bodies"][0]
        text += f'\n[[actuator]]\nname = "{thruster}"\nkind = "thruster"\nlink = "{body}/{body}"\nposition_m = [0.0, 0.0, 0.0]\n'
        text += f'direction = [{x:.1f}, {y:.1f}, 0.0]\nmax_force_n = {rig["pushes"][along]}\n'
    (folder / "scenario.toml").write_text(text)


def compare(folder, softdock):
    """What a second from each start is by both simulators: largest differences of places and body rates, and the peak of the normal force."""
    import pyarrow.parquet

    name, rig = "berth", RIGS["berth"]
    write_scenario(folder, name, rig)
    print("| start | touches at, s | place after 1 s, µm | rates after it, mrad/s | largest on the way | changed by the touch | peak force, N |\n| --- | --- | --- | --- | --- | --- | --- |")
    for run in range(RUNS):
        model = model_of(name, rig, [])
        data = mujoco.MjData(model)
        begin(name, data, np.random.default_rng([0, run]))
        scenario = (folder / "scenario.toml").read_text().replace("step_s = 5e-4", f"step_s = {STEP}")
        for i, x in enumerate(("-0.7", "0.0")):
            q, v = data.qpos[7 * i : 7 * i + 3], data.qvel[6 * i : 6 * i + 6]
            here = f"pose = {{ position_m = {[*map(float, q)]} }}\n"
            twist = f"twist = {{ linear_m_per_s = {[*map(float, v[:3])]}, angular_deg_per_s = {[*map(float, np.degrees(v[3:]))]} }}\n"
            scenario = scenario.replace(f"pose = {{ position_m = [{x}, 0.0, 0.0] }}\n", here + twist, 1)
        (folder / "start.toml").write_text(scenario + "\n[output]\nlog_rate_hz = 10000.0\n")
        subprocess.run([softdock, "run", folder / "start.toml", "--out", folder / "start"], check=True, stdout=subprocess.DEVNULL)
        read = pyarrow.parquet.read_table(folder / "start" / "signals.parquet").to_pydict()
        columns = lambda quantity: np.array([[read[f"body.{b}.{quantity}.{a}"] for a in "xyz"] for b in rig["bodies"]])
        places, rates = columns("position"), columns("angular_velocity")
        worst, first, peak = [0.0, 0.0], data.qvel[3:6].copy(), 0.0
        force, touched = np.zeros(6), None
        for step in range(round(1.0 / STEP) + 1):
            off = [(places[i, :, step] - data.qpos[7 * i : 7 * i + 3], rates[i, :, step] - data.qvel[6 * i + 3 : 6 * i + 6]) for i in range(2)]
            last = [max(np.abs(pair[k]).max() for pair in off) for k in range(2)]
            worst = [max(a, b) for a, b in zip(worst, last)]
            mujoco.mj_step(model, data)
            for contact in range(data.ncon):
                mujoco.mj_contactForce(model, data, contact, force)
                touched = touched if touched is not None or force[0] <= 0.0 else step * STEP
                peak = max(peak, force[0])
        changed = np.abs(data.qvel[3:6] - first).max()
        own = max(read["contact.chaser.target.normal_force"])
        print(f"| {run + 1} | {touched:.4f} | {1e6 * last[0]:.0f} | {1e3 * last[1]:.2f} | {1e3 * worst[1]:.1f} | {1e3 * changed:.1f} | {own:.1f}, {peak:.1f} by MuJoCo |")


def main():
    out, wanted = pathlib.Path(sys.argv[1]), sys.argv[2:]
    if wanted[:1] == ["compare"]:
        (out / "berth").mkdir(parents=True, exist_ok=True)
        return compare(out / "berth", pathlib.Path(wanted[1]).resolve())
    keys = {}
    for number, (name, rig) in enumerate(RIGS.items()):
        folder = out / name
        folder.mkdir(parents=True, exist_ok=True)
        write_scenario(folder, name, rig)
        for case, effects in CASES[name].items():
            if wanted and case not in wanted and f"{name}/{case}" not in wanted:
                continue
            (folder / case).mkdir(exist_ok=True)
            (folder / case / "recording.toml").write_text(manifest(name, rig))
            for run in range(RUNS):
                recorded = record(name, rig, effects, np.random.default_rng([number, run]))
                write_run(folder / case / f"run-{run + 1}.csv", rig, recorded, np.random.default_rng([number, run, list(CASES[name]).index(case)]))
            keys[f"{name}/{case}"] = effects
            print(f"{name}/{case}", flush=True)
    (out / "keys.json").write_text(json.dumps(keys, indent=1) + "\n")


if __name__ == "__main__":
    main()

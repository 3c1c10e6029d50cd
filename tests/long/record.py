#!/usr/bin/env python3
"""Long and many recordings of the seven-joint arm by MuJoCo, with viscous friction at one joint that the scenario does not have.

    record.py OUT hour|many        needs mujoco 4.0, numpy and pyarrow from PyPI

hour: one file of 3600 s at 1 kHz, 14 channels measured and 7 commanded, two thirds of it to fit. many: 50 runs of 12 s at 250 Hz, 40 to fit.
OUT/<case>/{recording.toml,run-*.parquet}; the scenario is scenarios/rigs/arm-bench.toml.
"""

import pathlib
import sys

import mujoco
import numpy as np
import pyarrow
import pyarrow.parquet

ROOT = pathlib.Path(__file__).resolve().parents[2]
JOINTS = [f"joint_{k}" for k in range(1, 8)]
ROTORS = [0.45, 0.45, 0.3, 0.3, 0.12, 0.1, 0.06]
GAIN = np.array([400.0, 400.0, 250.0, 250.0, 60.0, 50.0, 30.0])
MIDDLE = np.array([0.0, 0.35, 0.0, 1.1, 0.0, 0.5, 0.0])
STEP, VISCOUS, AT = 1e-3, 0.8, "joint_4"
NOISE = {"position": 2e-5, "velocity": 1e-3}


def model():
    spec = mujoco.MjSpec.from_file(str(ROOT / "robots/arm-bench/arm-bench.urdf"))
    spec.option.timestep = STEP
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    spec.option.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT
    spec.compiler.fusestatic = False
    for name, rotor in zip(JOINTS, ROTORS):
        joint = spec.joint(name)
        joint.limited = mujoco.mjtLimited.mjLIMITED_FALSE
        joint.actfrclimited = mujoco.mjtLimited.mjLIMITED_FALSE
        joint.armature = rotor
        if name == AT:
            joint.damping = [VISCOUS, 0, 0] if np.ndim(joint.damping) else VISCOUS
    return spec.compile()


def record(model, seconds, every, dice):
    """Time, commands, positions and rates, a row every so many steps; torques are held for as many, two at least."""
    amplitude, rate = dice.uniform(0.1, 0.3, (7, 3)), 2 * np.pi * dice.uniform(0.1, 0.6, (7, 3))
    phase = dice.uniform(0, 2 * np.pi, (7, 3))
    data = mujoco.MjData(model)
    data.qpos[:] = MIDDLE + (amplitude * np.sin(phase)).sum(1) + dice.normal(0, 0.02, 7)
    mujoco.mj_forward(model, data)
    rows = []
    for k in range(round(seconds / STEP) + 1):
        t = k * STEP
        if k % max(2, every) == 0:
            angle = rate * t + phase
            at, slope = MIDDLE + (amplitude * np.sin(angle)).sum(1), (amplitude * rate * np.cos(angle)).sum(1)
            command = np.round(GAIN * (at - data.qpos) + 0.15 * GAIN * (slope - data.qvel) + data.qfrc_bias, 3)
        if k % every == 0:
            rows.append(np.r_[t, command, data.qpos, data.qvel])
        data.qfrc_applied[:] = command
        mujoco.mj_step(model, data)
    rows = np.array(rows)
    rows[:, 8:15] = np.round(rows[:, 8:15] + dice.normal(0, NOISE["position"], (len(rows), 7)), 6)
    rows[:, 15:] = np.round(rows[:, 15:] + dice.normal(0, NOISE["velocity"], (len(rows), 7)), 4)
    return rows


def write(path, rows):
    names = ["t"] + [f"joint.{j}.{what}" for what in ("effort_command", "position", "velocity") for j in JOINTS]
    pyarrow.parquet.write_table(pyarrow.table({name: rows[:, i] for i, name in enumerate(names)}), path)


def manifest(runs):
    text = 'format = 1\nrig = "arm-bench"\ntitle = "Seven-joint arm by MuJoCo"\n\n[noise]\n'
    text += "".join(f'"joint.{j}.{what}" = {size}\n' for what, size in NOISE.items() for j in JOINTS)
    return text + "".join("\n[[run]]\n" + "".join(f"{key} = {value}\n" for key, value in run.items()) for run in runs)


def main():
    out, case = pathlib.Path(sys.argv[1]) / sys.argv[2], sys.argv[2]
    out.mkdir(parents=True, exist_ok=True)
    arm = model()
    if case == "hour":
        write(out / "run-1.parquet", record(arm, 3600.0, 1, np.random.default_rng(1)))
        runs = [dict(file='"run-1.parquet"', role='"fit"', to_s=2400.0), dict(file='"run-1.parquet"', role='"holdout"', from_s=2400.0)]
    else:
        for k in range(50):
            write(out / f"run-{k + 1}.parquet", record(arm, 12.0, 4, np.random.default_rng([2, k])))
        runs = [dict(file=f'"run-{k + 1}.parquet"', role='"fit"' if k < 40 else '"holdout"') for k in range(50)]
    (out / "recording.toml").write_text(manifest(runs))


main()

#!/usr/bin/env python3
"""Reference values of every URDF of example-robot-data and pybullet_data that Pinocchio loads, made on the spot.

    every_robot.py SITE OUT        SITE: the site-packages folder of both; OUT: where every.json and every.f64 go

The format is that of generate.py, and so is everything that is compared; crates/multibody/tests/pinocchio/every.rs reads
it. Here are few states of many robots, mimic joints are freed on both sides, and two kinds of robot get what a simulation
would have to give them, on both sides too:

  ballast    a root without mass floats with this one, as the iiwa's does in generate.py; and so that it has a centre of mass,
             a robot without any
  armature   where the mass matrix is singular (massless fingers), ABA has no answer, and where it nearly is (a point mass
             on three axes that nearly meet, massless links near gimbal lock), rounding is the answer: each joint freedom
             gets this inertia

The folder random_urdfs of pybullet_data (a thousand files of one object each) is left out.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True

import check
import generate
import pinocchio as pin
from reference import GRAVITY, Robot, State

STATES = 5
COLLECTIONS = {"example-robot-data": generate.ROBOTS, "pybullet_data": "pybullet_data"}
BALLAST = {"mass": 8.0, "tensor": [0.1, 0.12, 0.08]}
ARMATURE = 0.01
# Least eigenvalue of a mass matrix scaled to a unit diagonal that lets ABA agree to 1e-9 with room for a hundred operations;
# that of the other robots is above 1e-4.
SINGULAR = 1e-5


def files(site):
    """(collection, path) of every URDF."""
    for collection, folder in COLLECTIONS.items():
        for path in sorted((site / folder).rglob("*.urdf")):
            if "random_urdfs" not in path.parts:
                yield collection, path


def is_loaded(path):
    """Whether Pinocchio takes the file."""
    try:
        return pin.buildModelFromUrdf(str(path)) is not None
    except (RuntimeError, ValueError):
        return False


def is_singular(name, path):
    """Whether the mass matrix is, or nearly is, singular in one of the states, with one of the bases."""
    for base in ("fixed", "free"):
        robot = build(name, path, base, 0.0)
        for k in range(STATES):
            robot.enter(State(robot, k))
            m = robot.mass_matrix()[robot.held :, robot.held :]
            sizes = np.sqrt(np.diag(m))
            if m.size and (sizes.min() == 0.0 or np.linalg.eigvalsh(m / np.outer(sizes, sizes))[0] < SINGULAR):
                return True
    return False


def build(name, path, base, armature):
    """A robot, with what it needs to move."""
    robot = Robot(name, path, base, are_mimics_freed=True)
    mass = sum(i.mass for i in robot.model.inertias)
    if mass == 0.0 or (base == "free" and robot.model.inertias[1].mass == 0.0):
        robot.ballast = BALLAST
        robot.model.inertias[1] += pin.Inertia(BALLAST["mass"], np.zeros(3), np.diag(BALLAST["tensor"]))
    robot.add_armature(armature)
    return robot


def calc_bodies_energy(robot):
    """Kinetic energy without the armatures', which Pinocchio books in a way of its own."""
    robot.model.armature[:] = 0.0
    kinetic, _ = robot.energies()
    robot.add_armature(robot.armature)
    return kinetic


def rows_of(robot):
    """Columns' names and the rows of all states."""
    generate.calc_scales(robot)
    state = State(robot, 0)
    robot.enter(state)
    if robot.armature == 0.0:
        check.check_energy(robot)
    check.check_momentum(robot)
    check.check_forward_is_inverse_of_inverse(robot, state)
    if robot.nv > 6:
        check.check_fixed_model(robot, state)
    rows = []
    for k in range(STATES):
        links, columns = generate.row(robot, State(robot, k))
        columns["kinetic"] = calc_bodies_energy(robot)
        columns["total"] = sum(i.mass for i in robot.model.inertias)
        rows += links + list(columns.values())
    return list(columns), rows


def main(site, out):
    """Writes the set, and which files Pinocchio refuses."""
    site, out = Path(site), Path(out)
    generate.STATES = STATES
    models, numbers, refused = [], [], []
    for collection, path in files(site):
        name = f"{collection}/{path.relative_to(site / COLLECTIONS[collection])}"
        if not is_loaded(path):
            refused.append(name)
            continue
        armature = ARMATURE if is_singular(name, path) else 0.0
        for base in ("fixed", "free"):
            robot = build(name, path, base, armature)
            columns, rows = rows_of(robot)
            entry = generate.describe(robot, "third-party", str(path.relative_to(site)), columns)
            models.append(entry | {"armature": armature})
            numbers += rows
    np.array(numbers, "<f8").tofile(out / "every.f64")
    index = {"states": STATES, "gravity": list(GRAVITY), "models": models, "refused": refused, "version": pin.__version__}
    (out / "every.json").write_text(json.dumps(index))


if __name__ == "__main__":
    main(*sys.argv[1:])

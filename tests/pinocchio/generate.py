#!/usr/bin/env python3
"""Fixtures that hold softdock's multibody algorithms to those of Pinocchio.

    python -m venv venv && venv/bin/pip install pin==4.1.0 example-robot-data==6.0.0 pybullet==3.2.7
    venv/bin/python tests/pinocchio/generate.py                    # all of it, about half a minute
    venv/bin/python tests/pinocchio/generate.py servicer           # after a change of robots/servicer/servicer.urdf
    venv/bin/python tests/pinocchio/generate.py --dump trees tree-03 free 17    # every quantity of one state, to read

The Rust side is crates/multibody/tests/pinocchio.rs. Its third-party robots come from the site-packages folder of
that same environment, which SOFTDOCK_THIRD_PARTY_ROBOTS names; without it they are skipped, loudly.

What is stored. Inputs are not: both sides draw them by name (stream.py). Outputs are exact f64 projections on random
weights of magnitude ½ to 1, new ones for every state and quantity, so that an error in any entry of any matrix moves
a stored number. So that a small entry weighs as much as a large one, entries of mixed size are divided by their
typical size, a power of two per freedom in the index. Files, per set of models (panda, ur5, iiwa, servicer, trees):

  SET.json   the index: gravity, names of the global columns, and per model and base: its URDF, links in the order of
             the columns, and per joint the exponents e of the typical sizes 2^e of √M_ii, effort and acceleration
  SET.f64    little-endian f64, one block per model in the order of the index: 100 rows (states) of
             [placement of each link, velocity of each link, global columns]

Global columns (w: weights; sums over freedoms i scaled as said; x, y: vectors of weights over the freedoms):

  placement      Σ w (p, R column by column)          link origin and axes in W
  velocity       Σ w (ω, v)                           at the link's origin, W axes
  jacobian       Σ w (J x)                            of one link, drawn per state
  jacobian_rate  Σ w (J̇ x)                            x over all freedoms, base included even if it is fixed
  bias           Σ w (J̇ v)
  rnea.base      Σ w F_i / 2^e,  rnea.joints          base wrench (moment, force) and efforts of the drawn acceleration
  aba.base       Σ w a_i / 2^e,  aba.joints           (α, classical acceleration) and joint accelerations
  mass.bb bj jj  Σ y_i M_ij x_j / 2^(e_i + e_j)       blocks of the mass matrix: base–base, base–joints, joints–joints
  com            Σ w c                                centre of mass in W
  linear angular Σ w p,  Σ w L                        momenta, the angular one about the centre of mass
  kinetic potential                                   energies, J

A fixed base has no rnea.base, aba.base, mass.bb and mass.bj. Generalised coordinates, frames and the conversion from
Pinocchio's are in reference.py; random_trees.py writes the random robots; check.py holds the conversion to finite
differences and identities before anything is written.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.dont_write_bytecode = True

import check
import random_trees
from reference import BASE, GRAVITY, Robot, State

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
STATES = 100
TREES = 50
ROBOTS = "cmeel.prefix/share/example-robot-data/robots"
# A root of no mass cannot float: the free iiwa gets this one, on both sides.
IIWA_BALLAST = {"mass": 8.0, "tensor": [0.1, 0.12, 0.08]}


def sources(which):
    """(name, where the path starts, path, ballast of the free base) of a set's models."""
    third_party = {
        "panda": f"{ROBOTS}/panda_description/urdf/panda.urdf",
        "ur5": f"{ROBOTS}/ur_description/urdf/ur5_robot.urdf",
        "iiwa": "pybullet_data/kuka_iiwa/model.urdf",
    }
    if which in third_party:
        return [(which, "third-party", third_party[which], IIWA_BALLAST if which == "iiwa" else None)]
    if which == "servicer":
        return [("servicer", "repository", "robots/servicer/servicer.urdf", None)]
    return [(f"tree-{k:02}", "repository", f"tests/pinocchio/trees/{k:02}.urdf", None) for k in range(TREES)]


def locate(where, path):
    """Absolute path of a model's file."""
    if where == "repository":
        return REPOSITORY / path
    return next(p / path for p in map(Path, sys.path) if (p / path).exists())


def exponents(sizes):
    """Exponents of the powers of two nearest to the typical sizes."""
    return [int(round(np.log2(s))) if s > 0 else 0 for s in sizes]


def calc_scales(robot):
    """Per freedom the exponents of √M_ii, effort and acceleration, over the states; sets robot.scales."""
    mass, effort, acceleration = [], [], []
    for state in (State(robot, k) for k in range(STATES)):
        robot.enter(state)
        mass.append(np.sqrt(np.diag(robot.mass_matrix())))
        effort.append(np.abs(robot.rnea(state.signed(robot, "a"))))
    robot.scales = {"mass": exponents(np.mean(mass, 0)), "effort": exponents(np.mean(effort, 0))}
    for state in (State(robot, k) for k in range(STATES)):
        robot.enter(state)
        acceleration.append(np.abs(robot.aba(calc_tau(robot, state), state)))
    robot.scales["acceleration"] = exponents(np.mean(acceleration, 0))


def calc_tau(robot, state):
    """Efforts of the size that the motion takes."""
    return np.exp2(robot.scales["effort"]) * state.signed(robot, "tau")


def split(robot, what, terms):
    """Base and joint sums of terms over the freedoms."""
    out = {} if robot.held else {f"{what}.base": terms[:6].sum()}
    return out | {f"{what}.joints": terms[6:].sum()}


def project_mass(robot, state):
    """Three blocks of Σ y M x."""
    unit = np.exp2(-np.array(robot.scales["mass"], float))
    x, y = state.weights(robot, "mass.x"), state.weights(robot, "mass.y")
    terms = np.outer(y * unit, x * unit) * robot.mass_matrix()
    blocks = {} if robot.held else {"mass.bb": terms[:6, :6].sum(), "mass.bj": terms[:6, 6:].sum()}
    return blocks | {"mass.jj": terms[6:, 6:].sum()}


def project_link(state, what, link, values):
    """Σ w · values, the weights drawn for this quantity and link."""
    return np.dot(state.stream(what, link).weights(len(values)), values)


def quantities(robot, state):
    """Everything Pinocchio says of a state, unprojected; also what --dump shows."""
    robot.enter(state)
    com, linear, angular = robot.centroidal()
    link = state.stream("link", "jacobian").pick(robot.links)
    kinetic, potential = robot.energies()
    return {
        "placement": {n: np.concatenate([robot.placement(n)[0], robot.placement(n)[1].T.ravel()]) for n in robot.links},
        "velocity": {n: robot.velocity(n) for n in robot.links},
        "link": link,
        "jacobian": robot.jacobian(link),
        "jacobian_rate": robot.jacobian_rate(link),
        "rnea": robot.rnea(state.signed(robot, "a")),
        "aba": robot.aba(calc_tau(robot, state), state),
        "com": com,
        "linear": linear,
        "angular": angular,
        "kinetic": kinetic,
        "potential": potential,
    }


def project_jacobians(robot, state, has):
    """J x, J̇ x and J̇ v of the drawn link."""
    x, rate = state.weights(robot, "jacobian.x"), has["jacobian_rate"]
    values = {"jacobian": has["jacobian"] @ x, "jacobian_rate": rate @ x, "bias": rate @ robot.v}
    return {what: project_link(state, what, "", value) for what, value in values.items()}


def project_freedoms(robot, state, has):
    """RNEA and ABA, scaled."""
    out = {}
    for what, scale in (("rnea", "effort"), ("aba", "acceleration")):
        terms = state.weights(robot, what) * has[what] * np.exp2(-np.array(robot.scales[scale], float))
        out |= split(robot, what, terms)
    return out


def row(robot, state):
    """One row of a file: links' columns, and the global ones by name."""
    has = quantities(robot, state)
    links = [project_link(state, what, n, has[what][n]) for what in ("placement", "velocity") for n in robot.links]
    columns = project_jacobians(robot, state, has) | project_freedoms(robot, state, has) | project_mass(robot, state)
    columns |= {what: project_link(state, what, "", has[what]) for what in ("com", "linear", "angular")}
    columns |= {what: has[what] for what in ("kinetic", "potential")}
    return links, columns


def describe(robot, where, path, columns):
    """Index entry of a model."""
    joints = {BASE: slice(robot.held, 6)} | robot.columns
    scales = {n: {what: e[s] for what, e in robot.scales.items()} for n, s in joints.items() if s.stop > s.start}
    entry = {"name": robot.name, "base": robot.base, "from": where, "urdf": path, "links": robot.links}
    return entry | {"ballast": robot.ballast, "columns": columns, "scales": scales}


def build(which):
    """The robots of a set, both bases, scales not yet set."""
    for name, where, path, ballast in sources(which):
        for base in ("fixed", "free"):
            robot = Robot(name, locate(where, path), base, ballast if base == "free" else None)
            yield robot, where, path


def write_set(which):
    """Checks and writes SET.json and SET.f64."""
    models, numbers = [], []
    for robot, where, path in build(which):
        calc_scales(robot)
        for k in range(3):
            check.check(robot, State(robot, k))
        columns = {}
        for k in range(STATES):
            links, columns = row(robot, State(robot, k))
            numbers += links + list(columns.values())
        models.append(describe(robot, where, path, list(columns)))
        print(f"{robot.name} {robot.base}: {len(robot.links)} links, {robot.nv - robot.held} freedoms", flush=True)
    assert np.isfinite(numbers).all()
    np.array(numbers, "<f8").tofile(HERE / f"{which}.f64")
    entries = ",\n".join(json.dumps(m, separators=(",", ":")) for m in models)
    head = f'"states":{STATES},"gravity":{json.dumps(list(GRAVITY))}'
    (HERE / f"{which}.json").write_text(f'{{{head},"models":[\n{entries}\n]}}\n')


def dump(which, name, base, number):
    """Prints every quantity of one state."""
    robot = next(r for r, _, _ in build(which) if (r.name, r.base) == (name, base))
    calc_scales(robot)
    state = State(robot, int(number))
    np.set_printoptions(precision=17, linewidth=200)
    for what, value in quantities(robot, state).items():
        for link, entry in value.items() if isinstance(value, dict) else [("", value)]:
            print(what, link, entry, sep="\n")
    print("mass", robot.mass_matrix(), "joints", robot.columns, sep="\n")


def main(arguments):
    """Writes the sets that are named, or all."""
    if arguments[:1] == ["--dump"]:
        return dump(*arguments[1:])
    for which in arguments or ["panda", "ur5", "iiwa", "servicer", "trees"]:
        if which == "trees":
            (HERE / "trees").mkdir(exist_ok=True)
            for k in range(TREES):
                (HERE / "trees" / f"{k:02}.urdf").write_text(random_trees.urdf(k))
        write_set(which)


if __name__ == "__main__":
    main(sys.argv[1:])

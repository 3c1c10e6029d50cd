"""Holds the conversion of reference.py to identities and finite differences, before a fixture is written."""

import numpy as np
import pinocchio as pin

# Central differences over 1e-6 s of quantities near one.
DIFFERENCE = 1e-6
STEP_S = 1e-6
# Identities of exact quantities.
ROUND_OFF = 1e-9


def close(what, robot, a, b, tolerance):
    """Fails with a sentence if two arrays differ."""
    a, b = np.asarray(a), np.asarray(b)
    error = np.abs(a - b).max() / max(1.0, np.abs(b).max())
    if not error < tolerance:
        raise SystemExit(f"{robot.name} {robot.base}: {what} differs by {error:.2e}, relative; the conversion is wrong")


def check(robot, state):
    """All checks on one state."""
    robot.enter(state)
    check_energy(robot)
    check_velocities(robot)
    check_forward_is_inverse_of_inverse(robot, state)
    check_momentum(robot)
    check_rates(robot, state)
    check_potential(robot)
    check_fixed_model(robot, state)
    check_mimic(robot, state)


def check_energy(robot):
    """Kinetic energy is ½ vᵀ M v."""
    close("½ vᵀMv", robot, 0.5 * robot.v @ robot.mass_matrix() @ robot.v, robot.energies()[0], ROUND_OFF)


def check_velocities(robot):
    """Link velocities are J v."""
    for link in robot.links:
        close(f"J v of {link}", robot, robot.jacobian(link) @ robot.v, robot.velocity(link), ROUND_OFF)


def check_forward_is_inverse_of_inverse(robot, state):
    """ABA(RNEA(a)) = a, base acceleration included."""
    a = state.signed(robot, "a")
    close("ABA after RNEA", robot, robot.aba(robot.rnea(a), state), a, ROUND_OFF)


def check_momentum(robot):
    """Base rows of M v are the momentum about the base origin."""
    com, linear, angular = robot.centroidal()
    about_base = angular + np.cross(com - robot.q[:3], linear)
    close("momentum", robot, (robot.mass_matrix() @ robot.v)[:6], np.concatenate([about_base, linear]), ROUND_OFF)


def moved(robot, time_s):
    """Link frames' velocities and Jacobians after moving at constant v (base: ω, v in W) for a while."""
    q, v = robot.q, robot.v
    step = robot.v_pin * time_s
    placed = pin.integrate(robot.model, q, step)
    # The base turns about W axes and its origin moves straight.
    placed[:3] = q[:3] + v[3:6] * time_s
    turned = pin.exp3(v[:3] * time_s) @ robot.rot
    placed[3:7] = pin.Quaternion(turned).coeffs()
    t = robot.t.copy()
    t[:3, 3:6] = t[3:6, :3] = turned.T
    data = robot.model.createData()
    pin.computeJointJacobians(robot.model, data, placed)
    pin.updateFramePlacements(robot.model, data)
    frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    return {n: np.roll(pin.getFrameJacobian(robot.model, data, robot.frame(n), frame), 3, axis=0) @ t for n in robot.links}


def check_rates(robot, state):
    """J̇ is the difference quotient of J, and the acceleration of RNEA's base is classical."""
    ahead, behind = moved(robot, STEP_S), moved(robot, -STEP_S)
    for n in robot.links:
        close(f"J̇ of {n}", robot, robot.jacobian_rate(n), (ahead[n] - behind[n]) / (2 * STEP_S), DIFFERENCE)
    a = state.signed(robot, "a")
    pin.forwardKinematics(robot.model, robot.data, robot.q, robot.v_pin, robot.t @ a + robot.t_rate @ robot.v)
    frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    for n in robot.links:
        motion = pin.getFrameClassicalAcceleration(robot.model, robot.data, robot.frame(n), frame)
        ours = robot.jacobian(n) @ a + robot.jacobian_rate(n) @ robot.v
        close(f"acceleration of {n}", robot, ours, np.concatenate([motion.angular, motion.linear]), ROUND_OFF)


def check_potential(robot):
    """Potential energy is −m g·c."""
    mass = sum(i.mass for i in robot.model.inertias)
    close("potential", robot, -mass * robot.model.gravity.linear @ robot.centroidal()[0], robot.energies()[1], ROUND_OFF)


def check_fixed_model(robot, state):
    """Pinocchio's fixed-base model gives the joint rows of the held free one."""
    if robot.base == "free":
        return
    robot.fixed.gravity.linear = robot.rot.T @ robot.model.gravity.linear
    a, g, q = state.signed(robot, "a"), robot.gather[6:, 6:], robot.pin_q(robot.fixed, state)
    tau = pin.rnea(robot.fixed, robot.fixed.createData(), q, g @ robot.v[6:], g @ a[6:])
    close("RNEA of the fixed model", robot, g.T @ tau, robot.rnea(a)[6:], ROUND_OFF)
    m = np.triu(pin.crba(robot.fixed, robot.fixed.createData(), q))
    m = g.T @ (m + np.triu(m, 1).T) @ g
    close("CRBA of the fixed model", robot, m, robot.mass_matrix()[6:, 6:], ROUND_OFF)


def check_mimic(robot, state):
    """Where Pinocchio itself folds mimic joints, it finds the same efforts as Tᵀ τ_pin."""
    if not robot.mimics or robot.mimic_model is None:
        return
    model = robot.mimic_model
    q = robot.pin_q(model, state)
    order = [(model.joints[model.getJointId(n)].idx_v, s) for n, s in robot.columns.items()]
    a = state.signed(robot, "a")
    full = [robot.v_pin[:6], (robot.t @ a + robot.t_rate @ robot.v)[:6]]
    v, v_dot = np.zeros(model.nv), np.zeros(model.nv)
    v[:6], v_dot[:6] = full
    for at, s in order:
        v[at : at + s.stop - s.start], v_dot[at : at + s.stop - s.start] = robot.v[s], a[s]
    tau, ours = pin.rnea(model, model.createData(), q, v, v_dot), robot.rnea(a)
    for at, s in order:
        close("RNEA with mimic", robot, ours[s], tau[at : at + s.stop - s.start], ROUND_OFF)

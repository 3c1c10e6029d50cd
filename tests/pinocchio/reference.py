"""One robot in Pinocchio, seen in softdock's coordinates.

Generalised velocity here: base twist [ω; v] in W axes about the base origin, then the joints that lead (v of a floating
joint: linear, angular, in the child's axes; planar: vx, vy in the child's axes, rate), mimic joints left out.
Pinocchio is always given the *full* tree, every mimic joint as a joint of its own, and its free-flyer root, whose
velocity is (v, ω) in the base's axes. With R = rot_wb and the constant 0, 1 and multiplier matrix G of the joints:

  v_pin = T(q) v,   T = diag( [ 0  Rᵀ ; Rᵀ  0 ], G )
  a_pin = T a + Ṫ v,   base rows of Ṫ x = ( −ω_b × Rᵀ x_v ;  −ω_b × Rᵀ x_ω )      a: (α, classical acceleration, v̇)
  τ = Tᵀ τ_pin,   M = Tᵀ M_pin T,   J = J_pin T,   J̇ = J̇_pin T + J_pin Ṫ

A fixed base is the free one held: pose given, base velocity and acceleration zero, base rows dropped. Only its ABA is
run on Pinocchio's fixed-base model, in the base's axes with gravity turned to Rᵀ g.
ABA of a robot with mimic joints (Pinocchio refuses) solves M a = τ − RNEA(q, v, 0); every ABA result, Pinocchio's
too, gets one step of iterative refinement with RNEA as the residual.
"""

import math
import xml.etree.ElementTree as ElementTree

import numpy as np
import pinocchio as pin

from stream import Stream

GRAVITY = np.array([0.4, -1.1, -9.6])
BASE = "base"
LWA = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED


def mimics_of(path):
    """Follower → (leader, multiplier, offset) of a URDF file."""
    out = {}
    for joint in ElementTree.parse(path).getroot().findall("joint"):
        tag = joint.find("mimic")
        if tag is not None:
            out[joint.get("name")] = (tag.get("joint"), float(tag.get("multiplier", 1)), float(tag.get("offset", 0)))
    return out


def build_mimic(path):
    """Pinocchio's own model with folded mimic joints; None where it cannot (leader after follower, or mixed kinds)."""
    try:
        model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer(), mimic=True)
    except (RuntimeError, ValueError):
        return None
    model.gravity.linear = GRAVITY
    return model


def unit_quaternion(x):
    """Four numbers to a unit quaternion."""
    return np.array(x) / np.linalg.norm(x)


class State:
    """Random state `number` of a robot: q and velocities by joint name, the base under `BASE`."""

    def __init__(self, robot, number):
        self.key = f"{robot.name}/{robot.base}/{number}"
        self.pose = self.floating("q", BASE)
        self.q = {name: self.coordinates(kind, name) for name, kind in robot.kinds.items()}

    def stream(self, what, name):
        """The stream of one quantity of one joint or link."""
        return Stream(f"{self.key}/{what}/{name}")

    def floating(self, what, name):
        """Position and unit quaternion (x, y, z, w)."""
        x = self.stream(what, name).signed(7)
        return np.concatenate([x[:3], unit_quaternion(x[3:])])

    def coordinates(self, kind, name):
        """Coordinates of a joint, angles over the whole turn."""
        if kind == "floating":
            return self.floating("q", name)
        scale = {"turning": [math.pi], "sliding": [0.5], "planar": [1.0, 1.0, math.pi]}[kind]
        return np.array(scale) * self.stream("q", name).signed(len(scale))

    def vector(self, robot, what, draw, hold_base):
        """A vector over the generalised velocity, drawn joint by joint; base rows zero where the base is held."""
        base = np.zeros(6) if hold_base and robot.base == "fixed" else draw(self.stream(what, BASE), 6)
        return np.concatenate([base] + [draw(self.stream(what, n), w) for n, w in robot.widths.items()])

    def signed(self, robot, what):
        """Uniform in [−1, 1), a held base at rest."""
        return self.vector(robot, what, lambda s, n: s.signed(n), True)

    def weights(self, robot, what):
        """Weights for a projection, base rows included whatever the base."""
        return self.vector(robot, what, lambda s, n: s.weights(n), False)


class Robot:
    """A URDF file with a free or fixed base, in Pinocchio; with its mimic joints freed, every joint leads."""

    def __init__(self, name, path, base, ballast=None, are_mimics_freed=False):
        self.name, self.base, self.ballast, self.armature = name, base, ballast, 0.0
        self.mimics = {} if are_mimics_freed else mimics_of(path)
        self.model = pin.buildModelFromUrdf(str(path), pin.JointModelFreeFlyer())
        self.fixed = pin.buildModelFromUrdf(str(path))
        self.mimic_model = build_mimic(path) if self.mimics else None
        if ballast:
            inertia = pin.Inertia(ballast["mass"], np.zeros(3), np.diag(ballast["tensor"]))
            self.model.inertias[1] = inertia
        self.model.gravity.linear = GRAVITY
        self.data, self.fixed_data = self.model.createData(), self.fixed.createData()
        self.links = sorted(f.name for f in self.model.frames if f.type == pin.FrameType.BODY)
        self.kinds = {n: self.kind(n) for n in list(self.model.names)[2:] if n not in self.mimics}
        self.widths = {n: {"floating": 6, "planar": 3}.get(k, 1) for n, k in self.kinds.items()}
        self.columns, at = {}, 6
        for n, w in self.widths.items():
            self.columns[n] = slice(at, at + w)
            at += w
        self.nv = at
        self.held = 6 if base == "fixed" else 0
        self.gather = self.calc_gather()

    def add_armature(self, armature):
        """Gives every joint freedom an inertia of its own."""
        self.armature = armature
        self.model.armature[6:] = armature
        self.fixed.armature[:] = armature

    def kind(self, name):
        """What moves: turning, sliding, planar or floating."""
        short = self.model.joints[self.model.getJointId(name)].shortname()
        if "FreeFlyer" in short:
            return "floating"
        if "Planar" in short:
            return "planar"
        return "sliding" if short.startswith("JointModelP") else "turning"

    def calc_gather(self):
        """G with an identity base block: full joint rates from the leading ones."""
        g = np.zeros((self.model.nv, self.nv))
        for name in list(self.model.names)[2:]:
            joint = self.model.joints[self.model.getJointId(name)]
            leader, multiplier, _ = self.mimics.get(name, (name, 1.0, 0.0))
            g[joint.idx_v : joint.idx_v + joint.nv, self.columns[leader]] = multiplier * np.eye(joint.nv)
        return g

    def pin_q(self, model, state):
        """Pinocchio's configuration, base pose included where the model has one."""
        q = pin.neutral(model)
        for name in list(model.names)[1:]:
            joint = model.joints[model.getJointId(name)]
            if joint.nq == 0:
                continue
            q[joint.idx_q : joint.idx_q + joint.nq] = self.joint_q(name, joint, state)
        return q

    def joint_q(self, name, joint, state):
        """Pinocchio's coordinates of one joint."""
        if name == "root_joint":
            return state.pose
        leader, multiplier, offset = self.mimics.get(name, (name, 1.0, 0.0))
        q = state.q[leader]
        if joint.nv > 1:
            return q if joint.nq == 7 else [q[0], q[1], math.cos(q[2]), math.sin(q[2])]
        angle = multiplier * q[0] + offset
        return [angle] if joint.nq == 1 else [math.cos(angle), math.sin(angle)]

    def enter(self, state):
        """Places the robot: configuration, T and Ṫ of the state."""
        self.q = self.pin_q(self.model, state)
        self.rot = pin.Quaternion(*state.pose[[6, 3, 4, 5]]).toRotationMatrix()
        self.v = state.signed(self, "v")
        self.t = self.gather.copy()
        self.t[:3, 3:6] = self.t[3:6, :3] = self.rot.T
        spin = pin.skew(self.rot.T @ self.v[:3])
        self.t_rate = np.zeros_like(self.t)
        self.t_rate[:3, 3:6] = self.t_rate[3:6, :3] = -spin @ self.rot.T
        self.v_pin = self.t @ self.v
        pin.computeJointJacobiansTimeVariation(self.model, self.data, self.q, self.v_pin)
        pin.forwardKinematics(self.model, self.data, self.q, self.v_pin)
        pin.updateFramePlacements(self.model, self.data)

    def frame(self, link):
        """Index of a link's frame."""
        return self.model.getFrameId(link, pin.FrameType.BODY)

    def placement(self, link):
        """Position (m) and rotation in W."""
        pose = self.data.oMf[self.frame(link)]
        return pose.translation.copy(), pose.rotation.copy()

    def velocity(self, link):
        """[ω; v] of the link's origin, W axes."""
        motion = pin.getFrameVelocity(self.model, self.data, self.frame(link), LWA)
        return np.concatenate([motion.angular, motion.linear])

    def jacobian(self, link):
        """J of the link's origin, W axes, angular rows first."""
        return np.roll(pin.getFrameJacobian(self.model, self.data, self.frame(link), LWA), 3, axis=0) @ self.t

    def jacobian_rate(self, link):
        """J̇ of the link's origin, W axes, angular rows first."""
        rate = pin.getFrameJacobianTimeVariation(self.model, self.data, self.frame(link), LWA)
        jacobian = pin.getFrameJacobian(self.model, self.data, self.frame(link), LWA)
        return np.roll(rate @ self.t + jacobian @ self.t_rate, 3, axis=0)

    def rnea(self, a):
        """Generalised force of the acceleration (α, classical, v̇)."""
        return self.t.T @ pin.rnea(self.model, self.data, self.q, self.v_pin, self.t @ a + self.t_rate @ self.v)

    def mass_matrix(self):
        """M over [ω; v; joints]."""
        m = np.triu(pin.crba(self.model, self.data, self.q))
        return self.t.T @ (m + np.triu(m, 1).T) @ self.t

    def aba(self, tau, state):
        """Acceleration (α, classical, v̇) of the generalised force, base rows zero where it is held."""
        free = slice(self.held, None)
        m = self.mass_matrix()[free, free]
        if self.mimics:
            a = np.zeros(self.nv)
            a[free] = np.linalg.solve(m, (tau - self.rnea(a))[free])
        else:
            a = self.pinocchio_aba(tau, state)
        a[free] += np.linalg.solve(m, (tau - self.rnea(a))[free])
        return a

    def pinocchio_aba(self, tau, state):
        """Pinocchio's own ABA, where it has one."""
        if self.base == "free":
            a_pin = pin.aba(self.model, self.data, self.q, self.v_pin, np.linalg.solve(self.t.T, tau))
            return np.linalg.solve(self.t, a_pin - self.t_rate @ self.v)
        self.fixed.gravity.linear = self.rot.T @ GRAVITY
        g, q = self.gather[6:, 6:], self.pin_q(self.fixed, state)
        a = pin.aba(self.fixed, self.fixed_data, q, g @ self.v[6:], g @ tau[6:])
        return np.concatenate([np.zeros(6), g.T @ a])

    def centroidal(self):
        """Centre of mass in W, linear momentum, angular momentum about the centre of mass."""
        h = pin.computeCentroidalMomentum(self.model, self.data, self.q, self.v_pin)
        return self.data.com[0].copy(), h.linear.copy(), h.angular.copy()

    def energies(self):
        """Kinetic energy, and potential energy with its zero at the world's origin, J."""
        kinetic = pin.computeKineticEnergy(self.model, self.data, self.q, self.v_pin)
        return kinetic, pin.computePotentialEnergy(self.model, self.data, self.q)

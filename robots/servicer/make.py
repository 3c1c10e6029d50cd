"""Generates the servicer: `python3 robots/servicer/make.py` writes servicer.urdf and meshes/, `--check` only verifies.

A free-flying bus with two solar wings, thruster pods at its corners, a docking camera, and a 7-joint arm with a two-finger
gripper on its top deck. Root frame: centre of the bus box, +x forward (towards the client), +z to the deck, +y to port.
At zero the arm stands upright and every link frame is parallel to the root's, but for the tool, which is turned by 90° about
its approach axis so that in the natural pose the bar of a client that faces us lies along the grasp frame's x.
"""

import sys
from math import pi, radians
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import arm
import inertia
import kinematics
import parts
import urdf
from shapes import cylinder, dish, drum, foil, joined, nozzle, rounded_box

BUS = (1.4, 1.4, 1.2)
MOUNT = (0.48, 0.0, 0.70)          # of the shoulder: on a pedestal near the front edge of the deck
WING = dict(panels=2, span=1.25, chord=1.25, yoke=0.45, mass=20.0)
WING_TILT = -0.35                  # rad about y: cells towards the deck and a little aft
NATURAL_DEG = {"shoulder_yaw": 0, "shoulder_pitch": 70, "upper_roll": 0, "elbow_pitch": 88, "forearm_roll": 0,
               "wrist_pitch": -68, "wrist_roll": 0}
TRACKERS = (0.28, 0.48)            # y of the two star trackers on the deck
CORNERS = [((0.66 * x, 0.66 * y, 0.56 * z), (x, y, z)) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def bus():
    """Box, tanks, equipment; the wings and the arm are links of their own."""
    return urdf.Link("bus", bus_solids(), bus_visuals(), [
        ("bus", urdf.box_tag(BUS), (0, 0, 0), (0, 0, 0)),
        ("arm_pedestal", urdf.cylinder_tag(0.17, 0.10), (MOUNT[0], 0, 0.65), (0, 0, 0)),
    ])


def bus_solids():
    return [
        inertia.box_shell(165.0, BUS, (0, 0, 0)),
        inertia.sphere(110.0, 0.27, (-0.15, 0.33, -0.15)),
        inertia.sphere(110.0, 0.27, (-0.15, -0.33, -0.15)),
        inertia.box(95.0, (0.6, 0.9, 0.25), (-0.20, 0.0, 0.36)),        # avionics and battery
        inertia.box(62.0, (0.3, 0.7, 0.5), (0.45, 0.04, 0.05)),         # arm electronics, docking sensors
        inertia.tube(24.0, 0.17, (MOUNT[0], 0, 0.40), MOUNT),           # pedestal
        inertia.tube(20.0, 0.20, (-0.95, 0, 0), (-0.55, 0, 0)),         # main engine
        inertia.tube(12.0, 0.36, (-0.42, -0.30, 0.95), (-0.42, -0.30, 1.05)),  # dish
        inertia.box(12.0, (1.32, 1.32, 1.12), (0, 0, 0)),               # pods and harness
    ]


def bus_visuals():
    blocks, nozzles = parts.thruster_pods([(tuple(1.07 * c for c in p), s) for p, s in CORNERS], (0, 1, 2))
    barrels, glass = optics()
    return [
        ("bus_foil", foil(BUS, 0.017, 16, seed=7), "foil_gold"),
        ("bus_frame", joined(parts.edge_frame(BUS, 0.035), bus_fittings()), "aluminium"),
        ("bus_adapter", joined(parts.adapter_ring(0.45, 0.07, (-0.70, 0, 0), (-1, 0, 0)), drum(0.13, (-0.69, 0, 0), (-0.76, 0, 0))), "steel"),
        ("bus_pods", blocks, "aluminium"),
        ("bus_white", bus_white(), "white"),
        ("bus_graphite", joined(front_plate(), barrels), "graphite"),
        ("bus_nozzles", nozzles, "nozzle"),
        ("bus_engine", nozzle(0.07, 0.24, 0.34, (-0.74, 0, 0), (-1, 0, 0), 32), "nozzle"),
        ("bus_lens", glass, "lens"),
        ("bus_lamps", lamps(), "lamp"),
    ]


def bus_fittings():
    """Pedestal, wing drives, mast of the dish."""
    out = cylinder(0.20, (MOUNT[0], 0, 0.60), (MOUNT[0], 0, 0.62), 36)
    out += cylinder(0.185, (MOUNT[0], 0, 0.62), (MOUNT[0], 0, 0.695), 36, top=0.145)
    for side in (-1, 1):
        out += drum(0.12, (0, side * 0.70, 0), (0, side * 0.745, 0), 0.015)
    out += cylinder(0.028, (-0.42, -0.30, 0.58), (-0.42, -0.30, 0.88), 16)
    out += drum(0.06, (-0.42, -0.36, 0.88), (-0.42, -0.24, 0.88), 0.015)
    for turn in ((0.10, 0.0), (-0.05, 0.0866), (-0.05, -0.0866)):
        out += cylinder(0.007, (-0.42 + 2.6 * turn[0], -0.30 + 2.6 * turn[1], 1.02), (-0.42, -0.30, 1.24), 8)
    return out


def bus_white():
    """Radiators on both sides, dish with its feed, star trackers, patch antennas."""
    out = joined()
    for side in (-1, 1):
        for z in (-0.34, 0.34):
            out += rounded_box((1.10, 0.03, 0.34), 0.008, (0, side * 0.718, z), steps=1)
        out += rounded_box((0.34, 0.03, 0.30), 0.008, (-0.38, side * 0.718, 0), steps=1)
        out += rounded_box((0.34, 0.03, 0.30), 0.008, (0.38, side * 0.718, 0), steps=1)
    out += dish(0.36, 0.11, 0.012, (-0.42, -0.30, 0.94), (0, 0, 1))
    out += cylinder(0.045, (-0.42, -0.30, 1.20), (-0.42, -0.30, 1.26), 16, top=0.03)
    for y in TRACKERS:
        out += rounded_box((0.14, 0.13, 0.10), 0.02, (-0.45, y, 0.65))
        out += trackers(y)[0]
    out += rounded_box((0.16, 0.16, 0.03), 0.01, (-0.05, 0.45, 0.615))
    return out


def trackers(y):
    """A star tracker's baffle and its glass."""
    return parts.camera((-0.46, y, 0.68), (-0.13, 0, 0.18), 0.058, 0.20)


def front_plate():
    """The dark plate of the docking sensors on the +x face."""
    return rounded_box((0.03, 0.80, 0.50), 0.012, (0.712, 0, 0.18))


def optics():
    """Two docking cameras, a lidar between them, the glass of the star trackers. Returns barrels, glass."""
    barrels, glass = joined(), joined()
    for xyz, radius in (((0.725, 0.24, 0.28), 0.055), ((0.725, -0.24, 0.28), 0.055), ((0.725, 0.0, 0.10), 0.085)):
        barrel, lens = parts.camera(xyz, (1, 0, 0), radius, 2.0 * radius)
        barrels += barrel
        glass += lens
    for y in TRACKERS:
        glass += trackers(y)[1]
    return barrels, glass


def lamps():
    """Floodlights beside the cameras."""
    out = joined()
    for y in (-0.34, 0.34):
        for z in (0.05, 0.14):
            out += drum(0.032, (0.72, y, z), (0.742, y, z), 0.008, 20)
    return out


def robot():
    """Links and joints, parents first."""
    arm_links, arm_joints = arm.build("bus", MOUNT)
    wings = [parts.solar_wing(f"wing_{side}", **WING) for side in ("left", "right")]
    half = 0.5 * BUS[1] + 0.03
    joints = [
        urdf.Joint("wing_left_root", "bus", "wing_left", (0, half, 0), (0, WING_TILT, 0)),
        urdf.Joint("wing_right_root", "bus", "wing_right", (0, -half, 0), (0, -WING_TILT, pi)),
    ]
    return [bus(), *wings, *arm_links], joints + arm_joints


def natural():
    return {name: radians(angle) for name, angle in NATURAL_DEG.items()}


def comment(joints):
    _, tip, _ = kinematics.pose(joints, "grasp_frame", natural())
    angles = ", ".join(f"{name} {angle}" for name, angle in NATURAL_DEG.items())
    return (f"Servicer of softdock: own work, MIT OR Apache-2.0. Generated by make.py: change that, not this.\n"
            f"Root frame: centre of the bus, +x towards the client, +z to the deck.\n"
            f"Natural pose, deg: {angles}:\n"
            f"grasp_frame at {tip[0]:.4f} {tip[1]:.4f} {tip[2]:.4f} m, its x y z along bus y z x.")


def check(out, links, joints):
    """Prints what a reader wants to know; fails if the files are stale or the pose is not what NOTICE says."""
    print("\n".join(kinematics.mass_table(links)))
    rot, tip, _ = kinematics.pose(joints, "grasp_frame", natural())
    print("natural pose: grasp_frame at", " ".join(f"{x:.4f}" for x in tip))
    want = ((0, 0, 1), (1, 0, 0), (0, 1, 0))
    assert kinematics.degrees_between(rot, want) < 1e-5, f"grasp_frame is turned away: {rot}"
    values = kinematics.singular_values(joints, "grasp_frame", natural())
    print("singular values of the Jacobian there:", " ".join(f"{x:.4f}" for x in values))
    stale = urdf.stale(out)
    assert not stale, f"regenerate: {[path.name for path in stale]}"


if __name__ == "__main__":
    links, joints = robot()
    out = urdf.files(HERE, "servicer", links, joints, parts.colours_of(links), comment(joints))
    if "--check" not in sys.argv:
        urdf.write(out)
    check(out, links, joints)

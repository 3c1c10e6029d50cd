"""Generates the client: `python3 robots/client-satellite/make.py` writes client-satellite.urdf and meshes/, `--check` verifies.

A communications satellite that cannot help itself: foil-wrapped bus, two solar arrays, launch-adapter ring and engine below,
dishes, and a grapple bar on the −x face, which faces the servicer. Root frame: centre of the bus box, +z away from the ring.
Tank and payload lie off the axes, so that the principal axes are a little off the body's and the three moments differ.
"""

import sys
from math import pi
from pathlib import Path

sys.dont_write_bytecode = True
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import inertia
import kinematics
import parts
import urdf
from shapes import box, cylinder, dish, drum, foil, joined, nozzle, ring, rounded_box

BUS = (1.1, 1.1, 1.5)
RING = (0.4685, 0.08)              # radius and height of the 937 mm launch adapter
WING = dict(panels=2, span=0.75, chord=1.25, yoke=0.30, mass=12.0, strings=(5, 8))
WING_TILT = -1.05                  # rad about y: the cells look to −x and up
BAR = (0.03, 0.30, 0.03)           # the bar lies along y
BAR_OFF_FACE = 0.22                # its centre line from the −x face
POST = 0.014                       # radius of the two standoffs
POST_Y = 0.132                     # where they stand; 0.236 m of bar are free between them
GRASP_AXES = (pi / 2, 0, pi / 2)   # x along y, y along z, z along x: into the satellite


def bus():
    low = (0, 0, -0.5 * BUS[2] - 0.5 * RING[1])
    return urdf.Link("bus", bus_solids(), bus_visuals(), [
        ("bus", urdf.box_tag(BUS), (0, 0, 0), (0, 0, 0)),
        ("adapter_ring", urdf.cylinder_tag(RING[0] + 0.012, RING[1]), low, (0, 0, 0)),
    ])


def bus_solids():
    return [
        inertia.box_shell(118.0, BUS, (0, 0, 0)),
        inertia.sphere(128.0, 0.34, (0.02, 0.015, -0.22)),            # half-empty tank
        inertia.box(64.0, (0.55, 0.70, 0.35), (0.10, -0.06, 0.48)),   # payload
        inertia.box(38.0, (0.30, 0.25, 0.40), (-0.22, 0.26, 0.02)),   # battery
        inertia.box(22.0, (0.25, 0.30, 0.30), (0.26, -0.24, -0.10)),  # electronics
        inertia.tube(9.0, RING[0], (0, 0, -0.83), (0, 0, -0.75), 0.012),
        inertia.tube(6.0, 0.08, (0, 0, -0.95), (0, 0, -0.70)),
        inertia.tube(7.0, 0.40, (0.62, 0.0, 0.30), (0.72, 0.0, 0.30)),
    ]


def bus_visuals():
    corners = [((0.53 * x, 0.53 * y, 0.73 * z), (x, y, z)) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    blocks, nozzles = parts.thruster_pods([(tuple(1.06 * c for c in p), s) for p, s in corners], (2,))
    return [
        ("bus_foil", foil(BUS, 0.015, 16, seed=23), "foil_silver"),
        ("bus_frame", parts.edge_frame(BUS, 0.03), "aluminium"),
        ("bus_ring", parts.adapter_ring(RING[0], RING[1], (0, 0, -0.75), (0, 0, -1)), "steel"),
        ("bus_fittings", joined(fittings(), blocks), "aluminium"),
        ("bus_white", white_parts(), "white"),
        ("bus_amber", amber_parts(), "foil_gold"),
        ("bus_nozzles", nozzles, "nozzle"),
        ("bus_engine", nozzle(0.05, 0.17, 0.26, (0, 0, -0.75), (0, 0, -1), 28), "nozzle"),
        ("bus_graphite", graphite_parts(), "graphite"),
    ]


def fittings():
    """Array drives, feeds and arms of the dishes."""
    out = joined()
    for side in (-1, 1):
        out += drum(0.10, (0, side * 0.55, 0), (0, side * 0.59, 0), 0.012)
    out += cylinder(0.035, (0.54, 0, 0.30), (0.66, 0, 0.30), 16)
    for y, z in ((0.0, 0.30), (0.26, -0.15), (-0.26, -0.15)):
        out += cylinder(0.008, (0.75, y, 0.30 + z), (1.02, 0, 0.30), 8)
    out += cylinder(0.02, (0.15, -0.15, 0.74), (0.15, -0.15, 1.0), 12)
    return out


def white_parts():
    """Radiators above and below the array drives, the main dish with its feed, the horn on the top deck."""
    out = joined()
    for side in (-1, 1):
        for z in (-0.42, 0.42):
            out += rounded_box((0.86, 0.03, 0.52), 0.008, (0, side * 0.568, z), steps=1)
    out += dish(0.43, 0.13, 0.012, (0.64, 0, 0.30), (1, 0, 0))
    out += cylinder(0.05, (0.98, 0, 0.30), (1.05, 0, 0.30), 18, top=0.03)
    out += dish(0.17, 0.05, 0.008, (0.15, -0.15, 0.99), (0, 0, 1))
    return out


def amber_parts():
    """Foil of the engine deck and a collar on the top deck, in the other colour."""
    return joined(drum(0.33, (0, 0, -0.745), (0, 0, -0.765), 0.008, 40), rounded_box((0.40, 0.36, 0.16), 0.04, (-0.20, 0.24, 0.82)))


def graphite_parts():
    """Sun sensors, a star tracker, the dark field of the docking mark."""
    out = rounded_box((0.036, 0.46, 0.34), 0.006, (-0.554, 0, 0), steps=1)
    for y in (0.14, 0.33):
        out += parts.camera((-0.20, y, 0.88), (-0.08, 0, 0.14), 0.055, 0.17)[0]
    out += rounded_box((0.07, 0.07, 0.03), 0.01, (-0.40, -0.40, 0.76), steps=1)
    return out


def grapple_bar():
    """Frame at the centre of the bar, axes of the bus. Two standoffs carry it; behind it is nothing for 0.18 m."""
    reach = BAR_OFF_FACE - 0.5 * BAR[0]
    posts, feet, solids = joined(), joined(), [inertia.box(2.1, BAR, (0, 0, 0))]
    collisions = [("grapple_bar", urdf.box_tag(BAR), (0, 0, 0), (0, 0, 0))]
    for word, side in (("left", 1), ("right", -1)):
        start, end = (0.5 * BAR[0], side * POST_Y, 0), (BAR_OFF_FACE, side * POST_Y, 0)
        posts += cylinder(POST, start, end, 20)
        posts += cylinder(0.022, start, (0.5 * BAR[0] + 0.02, side * POST_Y, 0), 20, top=POST)
        feet += drum(0.036, (BAR_OFF_FACE - 0.04, side * POST_Y, 0), (BAR_OFF_FACE, side * POST_Y, 0), 0.008, 24)
        solids.append(inertia.tube(0.95, POST, start, end))
        middle = (0.5 * (start[0] + end[0]), side * POST_Y, 0)
        collisions.append((f"standoff_{word}", urdf.cylinder_tag(POST, reach), middle, (0, pi / 2, 0)))
    return urdf.Link("grapple_bar", solids, [
        ("bar", box(BAR), "orange"), ("bar_posts", posts, "steel"), ("bar_feet", feet, "housing"), ("bar_mark", mark(), "white"),
    ], collisions)


def mark():
    """What the gripper's camera looks for on the dark plate: a ring, a cross, corner squares."""
    x = BAR_OFF_FACE - 0.026
    out = ring(0.052, 0.064, (x, 0, 0), (x + 0.004, 0, 0), 40)
    out += box((0.004, 0.084, 0.008), (x + 0.002, 0, 0))
    out += box((0.004, 0.008, 0.084), (x + 0.002, 0, 0))
    for y in (-0.19, 0.19):
        for z in (-0.13, 0.13):
            out += box((0.004, 0.04, 0.04), (x + 0.002, y, z))
    return out


def robot():
    """Links and joints, parents first."""
    wings = [parts.solar_wing(f"array_{side}", **WING) for side in ("left", "right")]
    half = 0.5 * BUS[1] + 0.03
    face = (-0.5 * BUS[0] - BAR_OFF_FACE, 0, 0)
    joints = [
        urdf.Joint("array_left_root", "bus", "array_left", (0, half, 0), (0, WING_TILT, 0)),
        urdf.Joint("array_right_root", "bus", "array_right", (0, -half, 0), (0, -WING_TILT, pi)),
        urdf.Joint("grapple_bar_mount", "bus", "grapple_bar", face),
        urdf.Joint("grapple_frame_mount", "grapple_bar", "grapple_frame", (0, 0, 0), GRASP_AXES),
    ]
    return [bus(), *wings, grapple_bar(), urdf.Link("grapple_frame")], joints


COMMENT = """Client satellite of softdock: own work, MIT OR Apache-2.0. Generated by make.py: change that, not this.
Root frame: centre of the bus; the grapple bar is on the -x face, the launch-adapter ring on the -z face.
grapple_frame: x along the bar (bus +y), y along bus +z, z into the satellite (bus +x)."""


def whole(links, joints):
    """The satellite as one rigid body in the root frame."""
    solids = []
    for link in links:
        rot, pos, _ = kinematics.pose(joints, link.name, {})
        for s in link.solids:
            tensor = kinematics.product(kinematics.product(rot, s.tensor), tuple(zip(*rot)))
            centre = tuple(a + b for a, b in zip(kinematics.times(rot, s.centre), pos))
            solids.append(inertia.Solid(s.mass, centre, tensor))
    return urdf.Link("as one body", solids)


def check(out, links, joints):
    """Prints what a reader wants to know; fails if the files are stale or the frames are not what NOTICE says."""
    print("\n".join(kinematics.mass_table(links)))
    one = whole(links, joints)
    print(kinematics.mass_table([one])[0])
    for row in inertia.combined(one.solids).tensor:
        print("   ", " ".join(f"{x:10.4f}" for x in row))
    rot, place, _ = kinematics.pose(joints, "grapple_frame", {})
    print("grapple_frame at", " ".join(f"{x:.4f}" for x in place))
    assert kinematics.degrees_between(rot, ((0, 0, 1), (1, 0, 0), (0, 1, 0))) < 1e-5, f"grapple_frame is turned away: {rot}"
    stale = urdf.stale(out)
    assert not stale, f"regenerate: {[path.name for path in stale]}"


if __name__ == "__main__":
    links, joints = robot()
    out = urdf.files(HERE, "client-satellite", links, joints, parts.colours_of(links), COMMENT)
    if "--check" not in sys.argv:
        urdf.write(out)
    check(out, links, joints)

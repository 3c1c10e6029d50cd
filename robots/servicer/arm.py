"""The arm and the gripper of the servicer: dimensions, masses, shapes.

Seven revolute joints: yaw, pitch, roll at the shoulder, pitch at the elbow, roll, pitch, roll at the wrist. The upper arm runs
beside the forearm (0.17 m to port), so that the elbow folds fully; the wrist is back in the plane of the shoulder.
At zero all frames are parallel to the mount's and the arm stands along +z. Metres, kilograms, newtons, radians.
"""

from math import pi, radians

import inertia
from shapes import box, cylinder, drum, joined, ring, rounded_box
from urdf import Joint, Link, box_tag, cylinder_tag

OFFSET = 0.17            # between the planes of shoulder and upper arm, along y
SHOULDER_HEIGHT = 0.24   # yaw origin to pitch axis
HINGE = 0.14             # pitch axis to roll origin
UPPER = 0.91             # roll origin to elbow axis
FOREARM = 0.66           # elbow axis to forearm roll origin
YOKE = 0.31              # forearm roll origin to wrist pitch axis
WRIST = 0.14             # wrist pitch axis to wrist roll origin
FLANGE = 0.08            # wrist roll origin to the sensor
SENSOR = 0.03            # height of the force-torque sensor
PALM = (0.12, 0.24, 0.10)
PADS = 0.19              # palm origin to the centre of the pads
PAD = (0.04, 0.012, 0.06)
OPENING = 0.12           # between the pads' inner faces, open
STROKE = 0.055           # of each finger
ALONG_X, ALONG_Y = (0, pi / 2, 0), (-pi / 2, 0, 0)

# name, child, parent's offset, axis, limit in degrees, effort in N·m, speed in rad/s
CHAIN = [
    ("shoulder_yaw", "shoulder", None, (0, 0, 1), 170, 400, 0.6),
    ("shoulder_pitch", "upper_hinge", (0, OFFSET, SHOULDER_HEIGHT), (0, 1, 0), 120, 400, 0.6),
    ("upper_roll", "upper_arm", (0, 0, HINGE), (0, 0, 1), 170, 250, 0.8),
    ("elbow_pitch", "forearm", (0, -OFFSET, UPPER), (0, 1, 0), 165, 250, 0.8),
    ("forearm_roll", "wrist_yoke", (0, 0, FOREARM), (0, 0, 1), 170, 120, 1.2),
    ("wrist_pitch", "wrist", (0, 0, YOKE), (0, 1, 0), 115, 120, 1.2),
    ("wrist_roll", "flange", (0, 0, WRIST), (0, 0, 1), 170, 80, 1.5),
]


def build(parent, mount):
    """Links and joints from the mount to the grasp frame, parents first."""
    joints, carrier = [], parent
    for name, child, xyz, axis, limit, effort, speed in CHAIN:
        reach = radians(limit)
        joints.append(Joint(name, carrier, child, xyz or mount, (0, 0, 0), "revolute", axis, (-reach, reach, effort, speed)))
        carrier = child
    joints += [
        Joint("force_torque_mount", "flange", "force_torque", (0, 0, FLANGE), (0, 0, pi / 2)),
        Joint("palm_mount", "force_torque", "palm", (0, 0, SENSOR)),
        finger_joint("finger_left", 1, ""),
        finger_joint("finger_right", -1, "finger_left"),
        Joint("grasp_frame_mount", "palm", "grasp_frame", (0, 0, PADS)),
    ]
    links = [shoulder(), upper_hinge(), upper_arm(), forearm(), wrist_yoke(), wrist(), flange(), Link("force_torque"), palm()]
    return links + [finger("left", 1), finger("right", -1), Link("grasp_frame")], joints


def finger_joint(name, side, mimic):
    """Positive closes; at zero the inner faces are OPENING apart."""
    y = side * 0.5 * (OPENING + PAD[1])
    return Joint(name, "palm", name, (0, y, PADS), (0, 0, 0), "prismatic", (0, -side, 0), (0, STROKE, 400, 0.1), mimic)


def shoulder():
    pitch = ((0, -0.12, SHOULDER_HEIGHT), (0, 0.075, SHOULDER_HEIGHT))
    white = joined(rounded_box((0.17, 0.15, 0.18), 0.045, (0, -0.02, 0.17)), cylinder(0.09, (0, 0, 0.10), (0, 0, 0.17), 28))
    dark = joined(drum(0.14, (0, 0, 0), (0, 0, 0.12), 0.025), drum(0.115, *pitch, 0.025))
    trim = joined(bands(0.142, (0, 0, 0.035), (0, 0, 0.06)), end_cap(0.07, (0, -0.12, SHOULDER_HEIGHT), (0, -1, 0)))
    return Link("shoulder", [inertia.tube(7.5, 0.14, (0, 0, 0), (0, 0, 0.12)), inertia.tube(6.5, 0.115, *pitch)],
                [("shoulder_dark", dark, "housing"), ("shoulder_white", white, "white"), ("shoulder_trim", trim, "aluminium")],
                [("shoulder_yaw_housing", cylinder_tag(0.14, 0.14), (0, 0, 0.07), (0, 0, 0)),
                 ("shoulder_pitch_housing", cylinder_tag(0.115, 0.19), (0, -0.0225, SHOULDER_HEIGHT), ALONG_Y)])


def upper_hinge():
    ends = ((0, -0.085, 0), (0, 0.095, 0))
    white = joined(drum(0.095, (0, 0, 0.06), (0, 0, HINGE), 0.02))
    dark = drum(0.115, *ends, 0.025)
    trim = joined(end_cap(0.07, ends[1], (0, 1, 0)), bands(0.117, (0, -0.06, 0), (0, -0.045, 0)))
    return Link("upper_hinge", [inertia.tube(6.5, 0.115, *ends), inertia.tube(2.5, 0.09, (0, 0, 0.06), (0, 0, HINGE))],
                [("upper_hinge_dark", dark, "housing"), ("upper_hinge_white", white, "white"), ("upper_hinge_trim", trim, "aluminium")],
                [("upper_hinge", cylinder_tag(0.115, 0.18), (0, 0.005, 0), ALONG_Y)])


def upper_arm():
    elbow = ((0, -0.075, UPPER), (0, 0.095, UPPER))
    dark = joined(drum(0.098, (0, 0, 0.004), (0, 0, 0.11), 0.02), drum(0.10, *elbow, 0.022))
    white = joined(cylinder(0.085, (0, 0, 0.11), (0, 0, 0.16), 32, top=0.068), cylinder(0.068, (0, 0, 0.16), (0, 0, 0.74), 32),
                   cylinder(0.068, (0, 0, 0.74), (0, 0, 0.84), 32, top=0.082))
    trim = joined(bands(0.0705, (0, 0, 0.20), (0, 0, 0.225)), bands(0.0705, (0, 0, 0.68), (0, 0, 0.705)),
                  conduit(0.077, 0.13, 0.78), end_cap(0.06, elbow[1], (0, 1, 0)))
    marks = joined(bands(0.0695, (0, 0, 0.44), (0, 0, 0.48)))
    return Link("upper_arm", [inertia.tube(4.5, 0.098, (0, 0, 0), (0, 0, 0.11)),
                              inertia.tube(5.5, 0.068, (0, 0, 0.11), (0, 0, 0.84), 0.01),
                              inertia.tube(6.0, 0.10, *elbow)],
                [("upper_arm_white", white, "white"), ("upper_arm_dark", dark, "housing"), ("upper_arm_trim", trim, "aluminium"),
                 ("upper_arm_marks", marks, "orange")],
                [("upper_boom", cylinder_tag(0.09, 0.80), (0, 0, 0.41), (0, 0, 0)),
                 ("elbow_housing", cylinder_tag(0.10, 0.17), (0, 0.01, UPPER), ALONG_Y)])


def forearm():
    elbow = ((0, -0.095, 0), (0, 0.085, 0))
    dark = joined(drum(0.10, *elbow, 0.022), drum(0.08, (0, 0, 0.56), (0, 0, FOREARM - 0.004), 0.018))
    white = joined(cylinder(0.078, (0, 0, 0.06), (0, 0, 0.15), 32, top=0.058), cylinder(0.058, (0, 0, 0.15), (0, 0, 0.50), 32),
                   cylinder(0.058, (0, 0, 0.50), (0, 0, 0.57), 32, top=0.072))
    trim = joined(bands(0.0605, (0, 0, 0.18), (0, 0, 0.20)), bands(0.0605, (0, 0, 0.46), (0, 0, 0.48)),
                  conduit(0.066, 0.12, 0.53), end_cap(0.06, elbow[0], (0, -1, 0)))
    marks = joined(bands(0.0595, (0, 0, 0.31), (0, 0, 0.345)))
    return Link("forearm", [inertia.tube(5.5, 0.10, *elbow), inertia.tube(3.0, 0.058, (0, 0, 0.08), (0, 0, 0.56), 0.008),
                            inertia.tube(3.5, 0.08, (0, 0, 0.56), (0, 0, FOREARM))],
                [("forearm_white", white, "white"), ("forearm_dark", dark, "housing"), ("forearm_trim", trim, "aluminium"),
                 ("forearm_marks", marks, "orange")],
                [("elbow_hinge", cylinder_tag(0.10, 0.18), (0, -0.005, 0), ALONG_Y),
                 ("forearm_boom", cylinder_tag(0.078, 0.56), (0, 0, 0.37), (0, 0, 0))])


def wrist_yoke():
    dark, white, solids, collisions = joined(), joined(), [], []
    white += drum(0.08, (0, 0, 0), (0, 0, 0.055), 0.018)
    white += rounded_box((0.11, 0.21, 0.045), 0.02, (0, 0, 0.07))
    for side, word in ((-1, "right"), (1, "left")):
        white += rounded_box((0.085, 0.028, 0.26), 0.012, (0, side * 0.09, 0.19))
        dark += drum(0.062, (0, side * 0.072, YOKE), (0, side * 0.118, YOKE), 0.012)
        solids.append(inertia.box(1.2, (0.085, 0.028, 0.26), (0, side * 0.09, 0.19)))
        collisions.append((f"wrist_tine_{word}", box_tag((0.10, 0.035, 0.32)), (0, side * 0.093, 0.21), (0, 0, 0)))
    solids.append(inertia.tube(2.8, 0.08, (0, 0, 0), (0, 0, 0.09)))
    collisions.append(("wrist_yoke", cylinder_tag(0.085, 0.09), (0, 0, 0.045), (0, 0, 0)))
    return Link("wrist_yoke", solids, [("wrist_yoke_white", white, "white"), ("wrist_yoke_dark", dark, "housing")], collisions)


def wrist():
    ends = ((0, -0.07, 0), (0, 0.07, 0))
    dark = joined(drum(0.062, *ends, 0.014))
    white = joined(cylinder(0.05, (0, 0, 0.04), (0, 0, 0.10), 28), drum(0.062, (0, 0, 0.09), (0, 0, WRIST - 0.003), 0.012))
    return Link("wrist", [inertia.tube(2.6, 0.062, *ends), inertia.tube(1.4, 0.055, (0, 0, 0.05), (0, 0, WRIST))],
                [("wrist_dark", dark, "housing"), ("wrist_white", white, "white")],
                [("wrist", cylinder_tag(0.062, 0.14), (0, 0, 0.07), (0, 0, 0))])


def flange():
    """Last housing, and the ring of the force-torque sensor, whose frame is a link of its own."""
    dark = joined(drum(0.072, (0, 0, 0), (0, 0, FLANGE - 0.01), 0.015))
    trim = joined(ring(0.03, 0.066, (0, 0, FLANGE - 0.012), (0, 0, FLANGE + 0.004), 36),
                  ring(0.03, 0.060, (0, 0, FLANGE + 0.004), (0, 0, FLANGE + SENSOR), 36))
    return Link("flange", [inertia.tube(2.6, 0.072, (0, 0, 0), (0, 0, FLANGE)),
                           inertia.tube(0.6, 0.06, (0, 0, FLANGE), (0, 0, FLANGE + SENSOR))],
                [("flange_dark", dark, "housing"), ("flange_sensor", trim, "aluminium")],
                [("flange", cylinder_tag(0.072, FLANGE + SENSOR), (0, 0, 0.5 * (FLANGE + SENSOR)), (0, 0, 0))])


def palm():
    """Gripper body with rails for the fingers and a camera that sees the bar."""
    x, y, z = PALM
    white = joined(rounded_box((x, y, 0.075), 0.018, (0, 0, 0.042)), cylinder(0.07, (0, 0, 0), (0, 0, 0.02), 32))
    dark = joined(rounded_box((0.05, y - 0.02, 0.03), 0.006, (0, 0, 0.082), steps=1), rounded_box((0.05, 0.07, 0.07), 0.014, (-0.08, 0, 0.055)))
    rails = joined(*[cylinder(0.007, (s * 0.038, -0.112, 0.088), (s * 0.038, 0.112, 0.088), 12) for s in (-1, 1)],
                   *[box((0.095, 0.01, 0.022), (0, s * 0.112, 0.088)) for s in (-1, 1)])
    lens = drum(0.02, (-0.08, 0, 0.085), (-0.08, 0, 0.098), 0.004, 20)
    return Link("palm", [inertia.box(4.6, (x, y, 0.09), (0, 0, 0.045)), inertia.box(0.4, (0.05, 0.07, 0.07), (-0.08, 0, 0.055))],
                [("palm_white", white, "white"), ("palm_dark", dark, "housing"), ("palm_rails", rails, "steel"), ("palm_lens", lens, "lens")],
                [("palm", box_tag(PALM), (0, 0, 0.5 * z), (0, 0, 0))])


def finger(word, side):
    """Frame at the centre of the pad; `side` is the sign of its y. The pad is what touches."""
    back = side * (0.5 * PAD[1] + 0.009)
    low = 0.082 - PADS
    body = joined(rounded_box((0.034, 0.018, 0.030 - low - 0.02), 0.005, (0, back, 0.5 * (0.030 + low + 0.02)), steps=1),
                  rounded_box((0.098, 0.045, 0.030), 0.008, (0, back + side * 0.012, low + 0.015), steps=1),
                  rounded_box((0.014, 0.030, 0.06), 0.004, (0, back + side * 0.014, -0.055), steps=1))
    pad = box(PAD)
    return Link(f"finger_{word}", [inertia.box(0.06, PAD, (0, 0, 0)), inertia.box(0.20, (0.034, 0.018, 0.12), (0, back, -0.03)),
                                   inertia.box(0.14, (0.098, 0.045, 0.03), (0, back + side * 0.012, low + 0.015))],
                [(f"finger_{word}_body", body, "orange"), (f"finger_{word}_pad", pad, "rubber")],
                [(f"pad_{word}", box_tag(PAD), (0, 0, 0), (0, 0, 0))])


def bands(radius, start, end):
    """A ring of trim around a boom."""
    return cylinder(radius, start, end, 32)


def end_cap(radius, xyz, axis):
    """The cover on the end of a joint."""
    near = tuple(c - 0.004 * a for c, a in zip(xyz, axis))
    return drum(radius, near, tuple(c + 0.014 * a for c, a in zip(xyz, axis)), 0.006, 28)


def conduit(distance, low, high):
    """The harness along a boom: a thin pipe with clamps, on its −x side."""
    out = cylinder(0.009, (-distance, 0, low), (-distance, 0, high), 10)
    for k in range(4):
        z = low + (high - low) * (k + 0.5) / 4
        out += box((0.03, 0.03, 0.012), (-distance + 0.004, 0, z))
    return out

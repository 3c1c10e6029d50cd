"""Where a frame is, how well the arm moves it, and whether the inertias are physical: the generators' own check.

Rows of a rotation are tuples. The geometric Jacobian has the angular part first, in the axes of the root link, at the origin of
the frame asked for. Standard library only, and on purpose not the simulator's code: it is a second opinion.
"""

from math import acos, cos, pi, sin, sqrt

import inertia
from shapes import add, cross, sub

UNIT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def product(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def times(a, v):
    return tuple(sum(a[i][k] * v[k] for k in range(3)) for i in range(3))


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = axis
    c, s, d = cos(angle), sin(angle), 1.0 - cos(angle)
    return ((c + d * x * x, d * x * y - s * z, d * x * z + s * y),
            (d * x * y + s * z, c + d * y * y, d * y * z - s * x),
            (d * x * z - s * y, d * y * z + s * x, c + d * z * z))


def from_rpy(rpy):
    return product(turn(UNIT[2], rpy[2]), product(turn(UNIT[1], rpy[1]), turn(UNIT[0], rpy[0])))


def path_to(joints, link):
    """The joints from the root to a link."""
    carried = {joint.child: joint for joint in joints}
    out = []
    while link in carried:
        out.insert(0, carried[link])
        link = carried[link].parent
    return out


def pose(joints, link, angles):
    """Rotation and position of a link in the root's frame, and axis and place of each moving joint on the way."""
    rot, pos, movers = UNIT, (0.0, 0.0, 0.0), []
    for joint in path_to(joints, link):
        pos = add(pos, times(rot, joint.xyz))
        rot = product(rot, from_rpy(joint.rpy))
        if joint.kind == "fixed":
            continue
        value = angles.get(joint.mimic or joint.name, 0.0)
        movers.append((joint, times(rot, joint.axis), pos))
        if joint.kind == "prismatic":
            pos = add(pos, times(rot, tuple(value * a for a in joint.axis)))
        else:
            rot = product(rot, turn(joint.axis, value))
    return rot, pos, movers


def singular_values(joints, link, angles):
    """Of the geometric Jacobian (rad and m mixed), largest first."""
    _, tip, movers = pose(joints, link, angles)
    columns = [(*axis, *cross(axis, sub(tip, place))) for _, axis, place in movers]
    gram = [[sum(c[i] * c[j] for c in columns) for j in range(6)] for i in range(6)]
    return sorted((sqrt(max(x, 0.0)) for x in eigenvalues(gram)), reverse=True)


def eigenvalues(matrix, sweeps=30):
    """Of a symmetric matrix, by Jacobi's rotations."""
    a, n = [list(row) for row in matrix], len(matrix)
    for _ in range(sweeps):
        for p in range(n):
            for q in range(p + 1, n):
                if abs(a[p][q]) > 1e-15:
                    rotate(a, p, q)
    return [a[i][i] for i in range(n)]


def rotate(a, p, q):
    """One rotation in the plane p, q that makes a[p][q] zero."""
    theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q])
    t = (1.0 if theta >= 0.0 else -1.0) / (abs(theta) + sqrt(theta * theta + 1.0))
    c = 1.0 / sqrt(t * t + 1.0)
    s = t * c
    for k in range(len(a)):
        a[k][p], a[k][q] = c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]
    for k in range(len(a)):
        a[p][k], a[q][k] = c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]


def mass_table(links):
    """Lines: link, mass, centre of mass, principal moments; an assertion if one of them cannot be of this world."""
    lines, total = [], 0.0
    for link in links:
        if not link.solids:
            continue
        body = inertia.combined(link.solids)
        low, middle, high = sorted(eigenvalues(body.tensor))
        assert body.mass > 0.0 and low > 0.0 and low + middle >= high, f"link {link.name}: inertia is not physical"
        total += body.mass
        centre = " ".join(f"{x:8.4f}" for x in body.centre)
        lines.append(f"{link.name:14s} {body.mass:8.3f} kg   com {centre}   principal {low:.4g} {middle:.4g} {high:.4g}")
    return lines + [f"{'total':14s} {total:8.3f} kg"]


def degrees_between(a, b):
    """Angle between two rotations, deg."""
    trace = sum(a[k][i] * b[k][i] for i in range(3) for k in range(3))
    return acos(max(-1.0, min(1.0, 0.5 * (trace - 1.0)))) * 180.0 / pi

"""Triangle meshes of simple shapes, for the generators of this folder.

Every vertex has one position and one normal; where a surface has an edge, its vertices are there twice, once for each side. So
a reader that takes the normals of the file and one that averages the normals of the triangles see the same picture.
Triangles are counter-clockwise from outside. Lengths in metres. Standard library only; the same input gives the same bytes.
"""

from math import cos, hypot, pi, sin, sqrt


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, k):
    return (a[0] * k, a[1] * k, a[2] * k)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = sqrt(dot(a, a))
    return scale(a, 1.0 / length) if length > 0.0 else (0.0, 0.0, 1.0)


def turned_to(axis):
    """Rotation (columns x, y, z) whose z is `axis`; the identity for +z."""
    z = unit(axis)
    x = (1.0, 0.0, 0.0) if abs(z[0]) < 0.9 else (0.0, 1.0, 0.0)
    y = unit(cross(z, x))
    return (cross(y, z), y, z)


def short(x, digits):
    """A number in as few characters as it needs, never a negative zero."""
    text = f"{x:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Mesh:
    """Vertices, normals, triangles."""

    def __init__(self):
        self.points, self.normals, self.triangles = [], [], []

    def __iadd__(self, other):
        base = len(self.points)
        self.points += other.points
        self.normals += other.normals
        self.triangles += [(a + base, b + base, c + base) for a, b, c in other.triangles]
        return self

    def at(self, xyz, axis=(0, 0, 1)):
        """A copy with its z axis turned to `axis` and its origin moved to `xyz`."""
        x, y, z = turned_to(axis)
        turn = lambda v: add(add(scale(x, v[0]), scale(y, v[1])), scale(z, v[2]))
        out = Mesh()
        out.points = [add(turn(p), xyz) for p in self.points]
        out.normals = [turn(n) for n in self.normals]
        out.triangles = list(self.triangles)
        return out

    def triangle(self, a, b, c):
        """Adds a triangle unless it has no area (the poles of a revolved shape)."""
        p, q, r = self.points[a], self.points[b], self.points[c]
        n = cross(sub(q, p), sub(r, p))
        if dot(n, n) > 1e-18:
            self.triangles.append((a, b, c))

    def quads(self, rows, columns, base):
        """Joins a grid of vertices, row after row, with the outside on the side of row × column."""
        for i in range(rows - 1):
            for j in range(columns - 1):
                a = base + i * columns + j
                b, c, d = a + columns, a + columns + 1, a + 1
                self.triangle(a, b, c)
                self.triangle(a, c, d)

    def obj(self):
        """The mesh as Wavefront OBJ text: positions to 0.1 mm."""
        used = sorted({i for t in self.triangles for i in t})
        new = {old: k + 1 for k, old in enumerate(used)}
        lines = ["v " + " ".join(short(x, 4) for x in self.points[i]) for i in used]
        lines += ["vn " + " ".join(short(x, 3) for x in unit(self.normals[i])) for i in used]
        lines += ["f " + " ".join(f"{new[i]}//{new[i]}" for i in t) for t in self.triangles]
        return "\n".join(lines) + "\n"


def joined(*meshes):
    out = Mesh()
    for mesh in meshes:
        out += mesh
    return out


def box(size, xyz=(0, 0, 0)):
    """A box with sharp edges, centred at `xyz`."""
    out = Mesh()
    half = scale(size, 0.5)
    for k in range(3):
        for sign in (1, -1):
            i, j = ((k + 1) % 3, (k + 2) % 3) if sign > 0 else ((k + 2) % 3, (k + 1) % 3)
            base = len(out.points)
            for u, v in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
                p = [0.0, 0.0, 0.0]
                p[k], p[i], p[j] = sign * half[k], u * half[i], v * half[j]
                out.points.append(add(tuple(p), xyz))
                out.normals.append(tuple(float(sign) if m == k else 0.0 for m in range(3)))
            out.quads(2, 2, base)
    return out


def rounded_box(size, radius, xyz=(0, 0, 0), steps=2):
    """A box whose edges and corners are rounded: all points within `radius` of a smaller box."""
    out = Mesh()
    inner = [max(0.5 * s - radius, 0.0) for s in size]
    arc = [radius * (1.0 - cos(0.5 * pi * n / steps)) for n in range(steps + 1)]
    for k in range(3):
        for sign in (1, -1):
            i, j = ((k + 1) % 3, (k + 2) % 3) if sign > 0 else ((k + 2) % 3, (k + 1) % 3)
            lines = [[-0.5 * size[m] + a for a in arc] + [0.5 * size[m] - a for a in reversed(arc)] for m in (i, j)]
            base = len(out.points)
            for u in lines[0]:
                for v in lines[1]:
                    p = [0.0, 0.0, 0.0]
                    p[k], p[i], p[j] = sign * 0.5 * size[k], u, v
                    core = tuple(max(-h, min(h, x)) for x, h in zip(p, inner))
                    n = unit(sub(tuple(p), core))
                    out.points.append(add(add(core, scale(n, radius)), xyz))
                    out.normals.append(n)
            out.quads(len(lines[0]), len(lines[1]), base)
    return out


def revolved(strips, segments=24):
    """Turns strips of (radius, z) about z. A strip is smooth along its length; between strips is an edge.

    The outside is to the right of the direction of travel seen with z up and the radius to the right: go up on the outside.
    """
    out = Mesh()
    for strip in strips:
        base = len(out.points)
        tilt = strip_normals(strip)
        for (r, z), (nr, nz) in zip(strip, tilt):
            for s in range(segments):
                c, d = cos(2.0 * pi * s / segments), sin(2.0 * pi * s / segments)
                out.points.append((r * c, r * d, z))
                out.normals.append((nr * c, nr * d, nz))
        for i in range(len(strip) - 1):
            for s in range(segments):
                a, d = base + i * segments + s, base + i * segments + (s + 1) % segments
                out.triangle(a, d, d + segments)
                out.triangle(a, d + segments, a + segments)
    return out


def strip_normals(strip):
    """Normals (radial, axial) at the points of a strip: the mean of the two segments that meet there."""
    pieces = []
    for (r0, z0), (r1, z1) in zip(strip, strip[1:]):
        length = hypot(r1 - r0, z1 - z0) or 1.0
        pieces.append(((z1 - z0) / length, -(r1 - r0) / length))
    out = []
    for i in range(len(strip)):
        near = pieces[max(i - 1, 0):i + 1]
        r, z = sum(n[0] for n in near), sum(n[1] for n in near)
        length = hypot(r, z) or 1.0
        out.append((r / length, z / length))
    return out


def cylinder(radius, start, end, segments=24, top=None):
    """A cylinder between two points, flat ends; a cone if `top` gives another radius at the end."""
    height = sqrt(dot(sub(end, start), sub(end, start)))
    top = radius if top is None else top
    strips = [[(0.0, 0.0), (radius, 0.0)], [(radius, 0.0), (top, height)], [(top, height), (0.0, height)]]
    return revolved(strips, segments).at(start, sub(end, start))


def drum(radius, start, end, edge=0.02, segments=28):
    """A cylinder with rounded rims: the housing of a joint."""
    height = sqrt(dot(sub(end, start), sub(end, start)))
    turns = [0.5 * pi * n / 4 for n in range(5)]
    low = [(radius - edge + edge * sin(t), edge - edge * cos(t)) for t in turns]
    high = [(radius - edge + edge * cos(t), height - edge + edge * sin(t)) for t in turns]
    strips = [[(0.0, 0.0), low[0]], low, [low[-1], high[0]], high, [high[-1], (0.0, height)]]
    return revolved(strips, segments).at(start, sub(end, start))


def ring(inner, outer, start, end, segments=48):
    """A flat ring or a short pipe."""
    height = sqrt(dot(sub(end, start), sub(end, start)))
    corners = [(inner, 0.0), (outer, 0.0), (outer, height), (inner, height), (inner, 0.0)]
    strips = [[a, b] for a, b in zip(corners, corners[1:])]
    return revolved(strips, segments).at(start, sub(end, start))


def nozzle(throat, exit, length, xyz, axis, segments=20):
    """A bell nozzle, seen from outside and inside; the throat at `xyz`, the gas leaves along `axis`."""
    stations = (0.0, 0.1, 0.3, 0.6, 1.0) if segments > 16 else (0.0, 0.3, 1.0)
    bell = [(throat + (exit - throat) * sqrt(s), length * s) for s in stations]
    wall = 0.04 * exit
    inside = [(r - wall, z) for r, z in reversed(bell)]
    strips = [[(0.0, 0.0), bell[0]], bell, [bell[-1], inside[0]], inside, [inside[-1], (0.0, 0.001)]]
    return revolved(strips, segments).at(xyz, axis)


def dish(radius, depth, thickness, xyz, axis, segments=32):
    """A parabolic reflector, both sides; its vertex at `xyz`, open towards `axis`."""
    front = [(radius * s, depth * s * s) for s in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)]
    back = [(r, z - thickness) for r, z in front]
    strips = [back, [back[-1], front[-1]], list(reversed(front))]
    return revolved(strips, segments).at(xyz, axis)


class Dice:
    """A small linear congruential generator, so that the foil has the same creases everywhere."""

    def __init__(self, seed):
        self.state = seed

    def roll(self):
        """Evenly in −1…1."""
        self.state = (1664525 * self.state + 1013904223) % 2**32
        return self.state / 2.0**31 - 1.0


def foil(size, relief, cells, seed, skip=()):
    """A box wrapped in multi-layer insulation: each face a sheet with shallow dents, flat at its rim.

    `skip` names faces (axis, sign) that something else covers.
    """
    out, dice = Mesh(), Dice(seed)
    for k in range(3):
        for sign in (1, -1):
            if (k, sign) not in skip:
                out += foil_sheet(size, k, sign, relief, cells, dice)
    return out


def foil_sheet(size, k, sign, relief, cells, dice):
    """One face of the wrapping: normal along axis `k`, on the side of `sign`."""
    out = Mesh()
    i, j = ((k + 1) % 3, (k + 2) % 3) if sign > 0 else ((k + 2) % 3, (k + 1) % 3)
    at = lambda n, axis: size[axis] * (n / cells - 0.5)
    for u in range(cells + 1):
        for v in range(cells + 1):
            p = [0.0, 0.0, 0.0]
            rim = u in (0, cells) or v in (0, cells)
            wander = 0.0 if rim else 0.25 * size[i] / cells
            p[k] = sign * (0.5 * size[k] + (0.0 if rim else relief * dice.roll()))
            p[i], p[j] = at(u, i) + wander * dice.roll(), at(v, j) + wander * dice.roll()
            if rim:
                p[i], p[j] = at(u, i), at(v, j)
            out.points.append(tuple(p))
    out.quads(cells + 1, cells + 1, 0)
    out.normals = averaged_normals(out)
    return out


def averaged_normals(mesh):
    """Normals from the triangles that share a vertex, weighted by area."""
    sums = [(0.0, 0.0, 0.0)] * len(mesh.points)
    for t in mesh.triangles:
        p, q, r = (mesh.points[i] for i in t)
        n = cross(sub(q, p), sub(r, p))
        for i in t:
            sums[i] = add(sums[i], n)
    return [unit(n) for n in sums]

"""Mass, centre of mass and inertia tensor of links made of simple solids, all in the axes of the link.

  I_C = Σ ( I_i + m_i (|r_i|² 1 − r_i r_iᵀ) ),   r_i = c_i − C

Lengths in m, masses in kg, tensors in kg·m² about the centre of mass. Standard library only.
"""

from collections import namedtuple

from shapes import dot, sub, turned_to

Solid = namedtuple("Solid", "mass centre tensor")


def diagonal(x, y, z):
    return ((x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z))


def box(mass, size, centre):
    """A full box along the axes."""
    x, y, z = (s * s for s in size)
    return Solid(mass, centre, diagonal(mass * (y + z) / 12, mass * (x + z) / 12, mass * (x + y) / 12))


def box_shell(mass, size, centre):
    """Six panels of the same mass per area: the walls of a bus."""
    areas = [size[1] * size[2], size[0] * size[2], size[0] * size[1]]
    per_area = mass / (2 * sum(areas))
    panels = []
    for k in range(3):
        flat = tuple(0.0 if i == k else s for i, s in enumerate(size))
        for sign in (-0.5, 0.5):
            middle = tuple(c + (sign * size[k] if i == k else 0.0) for i, c in enumerate(centre))
            panels.append(box(per_area * areas[k], flat, middle))
    return combined(panels)


def sphere(mass, radius, centre):
    """A full ball: a tank with its propellant frozen."""
    return Solid(mass, centre, diagonal(*[0.4 * mass * radius * radius] * 3))


def tube(mass, radius, start, end, wall=None):
    """A pipe of outer `radius` between two points; full if `wall` is not given."""
    inner = 0.0 if wall is None else radius - wall
    square = radius * radius + inner * inner
    along = sub(end, start)
    across = mass * (square / 4 + dot(along, along) / 12)
    columns = turned_to(along)
    local = (across, across, mass * square / 2)
    tensor = tuple(
        tuple(sum(local[k] * columns[k][i] * columns[k][j] for k in range(3)) for j in range(3)) for i in range(3)
    )
    return Solid(mass, tuple(0.5 * (a + b) for a, b in zip(start, end)), tensor)


def combined(solids):
    """Several solids as one."""
    mass = sum(s.mass for s in solids)
    centre = tuple(sum(s.mass * s.centre[i] for s in solids) / mass for i in range(3))
    tensor = [[0.0] * 3 for _ in range(3)]
    for solid in solids:
        r = sub(solid.centre, centre)
        for i in range(3):
            for j in range(3):
                steiner = solid.mass * ((dot(r, r) if i == j else 0.0) - r[i] * r[j])
                tensor[i][j] += solid.tensor[i][j] + steiner
    return Solid(mass, centre, tuple(tuple(row) for row in tensor))

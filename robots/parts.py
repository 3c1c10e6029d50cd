"""Pieces that more than one spacecraft has: foil-wrapped buses, solar wings, thruster pods, optics. Metres, frames as said."""

from itertools import product

import inertia
from shapes import Mesh, box, cylinder, drum, joined, nozzle, revolved, ring, rounded_box
from urdf import Link, box_tag

COLOURS = {
    "foil_gold": (0.86, 0.62, 0.16, 1), "foil_silver": (0.74, 0.76, 0.79, 1),
    "aluminium": (0.66, 0.68, 0.71, 1), "white": (0.92, 0.92, 0.90, 1), "graphite": (0.15, 0.16, 0.18, 1),
    "housing": (0.30, 0.32, 0.36, 1), "cell_blue": (0.04, 0.10, 0.36, 1), "substrate": (0.50, 0.52, 0.56, 1),
    "nozzle": (0.34, 0.30, 0.28, 1), "lens": (0.05, 0.09, 0.16, 1), "lamp": (1.0, 0.97, 0.85, 1),
    "orange": (0.90, 0.42, 0.08, 1), "rubber": (0.09, 0.09, 0.10, 1), "steel": (0.80, 0.80, 0.82, 1),
}


def edge_frame(size, width):
    """Square struts along the twelve edges of a box."""
    out = joined()
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        for u, v in product((-1, 1), repeat=2):
            strut, middle = [width] * 3, [0.0] * 3
            strut[k] = size[k] + 0.5 * width
            middle[i], middle[j] = 0.5 * u * size[i], 0.5 * v * size[j]
            out += rounded_box(tuple(strut), 0.2 * width, tuple(middle), steps=1)
    return out


def thruster_pods(corners, outward):
    """At each corner (point, signs) a block and a nozzle along each axis in `outward`. Returns blocks, nozzles."""
    blocks, nozzles = joined(), joined()
    for point, signs in corners:
        blocks += rounded_box((0.09, 0.09, 0.09), 0.018, point, steps=1)
        for k in outward:
            axis = tuple(float(signs[k]) if i == k else 0.0 for i in range(3))
            start = tuple(p + 0.045 * a for p, a in zip(point, axis))
            nozzles += nozzle(0.012, 0.036, 0.075, start, axis, segments=12)
    return blocks, nozzles


def camera(xyz, axis, radius=0.05, length=0.11):
    """A lens barrel with a hood; `xyz` on the wall. Returns barrel, glass."""
    barrel = [[(0.0, 0.0), (radius, 0.0)], [(radius, 0.0), (radius, 0.6 * length), (1.15 * radius, length)],
              [(1.15 * radius, length), (0.9 * radius, length)], [(0.9 * radius, length), (0.75 * radius, 0.7 * length)]]
    glass = [[(0.78 * radius, 0.72 * length), (0.5 * radius, 0.80 * length), (0.0, 0.84 * length)]]
    return revolved(barrel, 24).at(xyz, axis), revolved(glass, 24).at(xyz, axis)


def solar_wing(name, panels, span, chord, yoke, mass, strings=(6, 8)):
    """A wing along +y from its root, cells towards +z: `panels` of span × chord behind a triangular yoke. Returns a Link."""
    thick, gap = 0.022, 0.025
    frame, cells, back, solids = joined(), joined(), joined(), []
    frame += drum(0.055, (0, 0, 0), (0, 0.10, 0), 0.012)
    for side in (-1, 1):
        frame += cylinder(0.016, (0, 0.08, 0), (side * 0.36 * chord, yoke, 0), 12)
    frame += cylinder(0.016, (-0.36 * chord, yoke - 0.01, 0), (0.36 * chord, yoke - 0.01, 0), 12)
    for n in range(panels):
        middle = (0.0, yoke + 0.5 * span + n * (span + gap), 0.0)
        frame += box((chord, span, thick), middle)
        frame += panel_rims(chord, span, thick, middle)
        frame += hinges(chord, middle[1] - 0.5 * span - 0.5 * gap)
        cells += cell_field(chord, span, strings, (0, middle[1], 0.5 * thick + 0.003))
        back += panel_back(chord, span, (0, middle[1], -0.5 * thick))
        solids.append(inertia.box(0.88 * mass / panels, (chord, span, thick), middle))
    solids.append(inertia.tube(0.12 * mass, 0.03, (0, 0, 0), (0, yoke, 0)))
    length = panels * span + (panels - 1) * gap
    tag = box_tag((chord, length, 0.03))
    link = Link(name, solids, [("wing_frame", frame, "substrate"), ("wing_cells", cells, "cell_blue"),
                                ("wing_back", back, "graphite")])
    link.collisions.append((f"{name}_panels", tag, (0, yoke + 0.5 * length, 0), (0, 0, 0)))
    return link


def panel_back(chord, span, middle):
    """The back of a panel: carbon-fibre fields between ribs."""
    out = joined()
    for i in range(3):
        for j in range(3):
            x, y = (i - 1) * (chord - 0.05) / 3, (j - 1) * (span - 0.05) / 3
            out += box(((chord - 0.11) / 3, (span - 0.11) / 3, 0.006), (middle[0] + x, middle[1] + y, middle[2] - 0.001))
    return out


def panel_rims(chord, span, thick, middle):
    """A raised edge around a panel."""
    x, y, z = middle
    rim, high = 0.018, thick + 0.012
    out = joined()
    for side in (-1, 1):
        out += box((rim, span, high), (x + side * 0.5 * (chord - rim), y, z))
        out += box((chord - 2 * rim, rim, high), (x, y + side * 0.5 * (span - rim), z))
    return out


def hinges(chord, y):
    out = joined()
    for x in (-0.36 * chord, 0.36 * chord):
        out += cylinder(0.02, (x - 0.05, y, 0), (x + 0.05, y, 0), 12)
    return out


def cell_field(chord, span, strings, middle, border=0.03, gap=0.012):
    """Rows of cells as thin tiles."""
    out = joined()
    nx, ny = strings[1], strings[0]
    dx, dy = (chord - 2 * border) / nx, (span - 2 * border) / ny
    for i in range(nx):
        for j in range(ny):
            x, y = -0.5 * chord + border + (i + 0.5) * dx, middle[1] - 0.5 * span + border + (j + 0.5) * dy
            out += tile(dx - gap, dy - gap, (middle[0] + x, y, middle[2]))
    return out


def tile(width, depth, middle):
    """A rectangle with cut corners, facing +z."""
    out, c = Mesh(), 0.12 * min(width, depth)
    w, d = 0.5 * width, 0.5 * depth
    corners = [(w - c, -d), (w, c - d), (w, d - c), (w - c, d), (c - w, d), (-w, d - c), (-w, c - d), (c - w, -d)]
    out.points = [(middle[0] + x, middle[1] + y, middle[2]) for x, y in corners]
    out.normals = [(0.0, 0.0, 1.0)] * 8
    for k in range(1, 7):
        out.triangle(0, k, k + 1)
    return out


def adapter_ring(radius, height, xyz, axis):
    """A launch-adapter ring: a web between two flanges, standing on the face at `xyz`."""
    web = ring(radius - 0.012, radius, (0, 0, 0), (0, 0, height), 56)
    low = ring(radius - 0.03, radius + 0.03, (0, 0, 0), (0, 0, 0.024), 56)
    top = ring(radius - 0.035, radius + 0.012, (0, 0, height - 0.018), (0, 0, height), 56)
    return joined(web, low, top).at(xyz, axis)


def colours_of(links):
    """The colours that these links use."""
    used = {colour for link in links for _, _, colour in link.visuals}
    return {name: rgba for name, rgba in COLOURS.items() if name in used}

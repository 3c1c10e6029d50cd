"""Links and joints as plain tables, and their URDF text.

A link has solids (for the mass), visuals (mesh, colour) and collisions (name, geometry, place). Frames, signs and units are
URDF's: SI, roll-pitch-yaw about fixed axes. Standard library only; the same input gives the same bytes.
"""

from dataclasses import dataclass, field
from pathlib import Path

import inertia


@dataclass
class Link:
    name: str
    solids: list = field(default_factory=list)
    visuals: list = field(default_factory=list)     # (mesh name, Mesh, colour)
    collisions: list = field(default_factory=list)  # (name, geometry tag, xyz, rpy)


@dataclass
class Joint:
    name: str
    parent: str
    child: str
    xyz: tuple = (0, 0, 0)
    rpy: tuple = (0, 0, 0)
    kind: str = "fixed"
    axis: tuple = (0, 0, 1)
    limits: tuple = ()   # lower, upper, effort, speed
    mimic: str = ""


def box_tag(size):
    return f'<box size="{numbers(size)}"/>'


def cylinder_tag(radius, length):
    return f'<cylinder radius="{numbers([radius])}" length="{numbers([length])}"/>'


def numbers(values, digits=6):
    return " ".join(f"{x:.{digits}g}" if abs(x) > 1e-12 else "0" for x in values)


def origin(xyz, rpy=(0, 0, 0)):
    turn = ' rpy="' + " ".join(repr(float(a)) if a else "0" for a in rpy) + '"' if any(rpy) else ""
    return f'<origin xyz="{numbers(xyz)}"{turn}/>'


def inertial_lines(solids):
    if not solids:
        return []
    m, c, t = inertia.combined(solids)
    names = (("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2))
    entries = " ".join(f'{name}="{numbers([t[i][j]], 9)}"' for name, i, j in names)
    return ["    <inertial>", f"      {origin(c)}", f'      <mass value="{numbers([m], 9)}"/>',
            f"      <inertia {entries}/>", "    </inertial>"]


def link_lines(link):
    lines = inertial_lines(link.solids)
    for mesh, _, colour in link.visuals:
        lines += [f'    <visual name="{mesh}">', f'      <geometry><mesh filename="meshes/{mesh}.obj"/></geometry>',
                  f'      <material name="{colour}"/>', "    </visual>"]
    for name, tag, xyz, rpy in link.collisions:
        lines += [f'    <collision name="{name}">', f"      {origin(xyz, rpy)}",
                  f"      <geometry>{tag}</geometry>", "    </collision>"]
    if not lines:
        return [f'  <link name="{link.name}"/>']
    return [f'  <link name="{link.name}">', *lines, "  </link>"]


def joint_lines(joint):
    lines = [f'  <joint name="{joint.name}" type="{joint.kind}">', f"    {origin(joint.xyz, joint.rpy)}",
             f'    <parent link="{joint.parent}"/>', f'    <child link="{joint.child}"/>']
    if joint.kind != "fixed":
        words = zip(("lower", "upper", "effort", "velocity"), joint.limits)
        lines.append(f'    <axis xyz="{numbers(joint.axis)}"/>')
        lines.append("    <limit " + " ".join(f'{w}="{numbers([x])}"' for w, x in words) + "/>")
        lines.append('    <dynamics damping="0" friction="0"/>')
    if joint.mimic:
        lines.append(f'    <mimic joint="{joint.mimic}" multiplier="1" offset="0"/>')
    return lines + ["  </joint>"]


def text(name, links, joints, colours, comment):
    """The whole file."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', "<!--", *[f"  {c}".rstrip() for c in comment.splitlines()], "-->",
             f'<robot name="{name}">']
    for colour, rgba in colours.items():
        lines.append(f'  <material name="{colour}"><color rgba="{numbers(rgba)}"/></material>')
    carried = {joint.child: joint for joint in joints}
    for link in links:
        lines += [""] + (joint_lines(carried[link.name]) if link.name in carried else []) + link_lines(link)
    return "\n".join(lines + ["</robot>"]) + "\n"


def files(folder, name, links, joints, colours, comment):
    """Everything that the generator writes: path to text."""
    folder = Path(folder)
    out = {folder / f"{name}.urdf": text(name, links, joints, colours, comment)}
    for link in links:
        for mesh, shape, _ in link.visuals:
            out[folder / "meshes" / f"{mesh}.obj"] = shape.obj()
    return out


def write(out):
    for path, content in out.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(content, encoding="utf-8", newline="\n")


def stale(out):
    """Files on disk that differ from what the generator would write."""
    return [path for path, content in out.items() if not path.exists() or path.read_text(encoding="utf-8") != content]

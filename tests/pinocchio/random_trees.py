"""Random robots: URDF files of 5 to 13 links with every kind of joint, from the stream of their number.

What they hold on purpose: branches; links and joints in shuffled file order; inertial frames with turned axes and
products of inertia; massless links behind fixed joints and, in some, as the root; axes that are not of unit length;
mimic joints whose leader stands before or after them, above, below or beside them, with negative ratios and offsets.
Numbers have four digits, so that a file is small and every parser reads the same 64 bits.
"""

import math

import numpy as np

from stream import Stream

KINDS = ["revolute"] * 5 + ["continuous"] * 3 + ["prismatic"] * 4 + ["fixed"] * 3 + ["floating"] * 2 + ["planar"] * 2
ONE_FREEDOM = ("revolute", "continuous", "prismatic")


def text(values):
    """Four digits each, blanks between."""
    return " ".join(f"{v:.4f}".rstrip("0").rstrip(".") for v in values)


def rotation(rpy):
    """Rotation matrix of URDF's roll, pitch, yaw."""
    (sr, sp, sy), (cr, cp, cy) = np.sin(rpy), np.cos(rpy)
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return z @ y @ x


def inertial(stream):
    """A solid box of random size in a turned frame, its tensor written in axes turned once more."""
    mass = 0.5 + 4.0 * stream.unit()
    a, b, c = (0.1 + 0.4 * stream.unit() for _ in range(3))
    moments = mass / 12.0 * np.array([b * b + c * c, a * a + c * c, a * a + b * b])
    turn = rotation([math.pi * s for s in stream.signed(3)])
    i = turn @ np.diag(moments) @ turn.T
    com, rpy = [0.2 * s for s in stream.signed(3)], [math.pi * s for s in stream.signed(3)]
    six = " ".join(f'i{p}="{i["xyz".index(p[0]), "xyz".index(p[1])]:.6f}"' for p in ("xx", "xy", "xz", "yy", "yz", "zz"))
    return (
        f'<inertial><origin xyz="{text(com)}" rpy="{text(rpy)}"/>'
        f'<mass value="{mass:.4f}"/><inertia {six}/></inertial>'
    )


def axis(kind, stream):
    """A unit vector to four digits, or a vector of another length; z for planar joints, the only axis Pinocchio has."""
    if kind in ("fixed", "floating"):
        return ""
    if kind == "planar":
        return '<axis xyz="0 0 1"/>'
    style, v = stream.unit(), np.array(stream.signed(3))
    if style < 0.2:
        v = np.roll([1, 0, 0], stream.below(3)) * stream.pick([1, -1])
    elif style < 0.8:
        v = v / np.linalg.norm(v)
    return f'<axis xyz="{text(v)}"/>'


def mimic(index, kinds, leaders, stream):
    """A mimic tag for some of the joints of one freedom; leaders lead for good, followers never lead."""
    others = [j for j in leaders if j != index]
    if kinds[index] not in ONE_FREEDOM or len(leaders) < 2 or stream.unit() < 0.7:
        return ""
    leader = stream.pick(others)
    parts = [f'joint="{joint_name(leader)}"']
    if stream.unit() < 0.8:
        parts.append(f'multiplier="{text([stream.pick([-1, 1]) * (0.3 + 1.2 * stream.unit())])}"')
    if stream.unit() < 0.6:
        parts.append(f'offset="{text([0.5 * s for s in stream.signed(1)])}"')
    return f"<mimic {' '.join(parts)}/>"


def joint_name(index):
    """Name of joint `index`, which carries link `index` + 1; not in alphabetical order of the tree."""
    return f"joint_{chr(97 + (index * 7 + 3) % 26)}"


def link_name(index):
    """Name of link `index`."""
    return "root" if index == 0 else f"link_{chr(97 + (index * 11 + 5) % 26)}"


def topology(stream):
    """Parents and kinds of the joints; a massless root has one fixed child first."""
    n = 4 + stream.below(9)
    massless_root = stream.unit() < 0.3
    kinds = [stream.pick(KINDS) for _ in range(n)]
    parents = [max(0, i - stream.below(1 + min(i, 3))) if stream.unit() < 0.75 else stream.below(i + 1) for i in range(n)]
    if massless_root:
        kinds[0] = "fixed"
    return kinds, parents, massless_root


def followers(kinds, stream):
    """Mimic tags by joint, chosen so that no leader follows."""
    one = [i for i, k in enumerate(kinds) if k in ONE_FREEDOM]
    leading = one[: max(1, len(one) // 2)] if stream.unit() < 0.5 else one[len(one) // 2 :]
    return {i: mimic(i, kinds, leading, stream) for i in one if i not in leading}


def joint(index, kinds, parents, tag, stream):
    """One joint element."""
    xyz, rpy = [0.4 * s for s in stream.signed(3)], [math.pi * s for s in stream.signed(3)]
    limit = '<limit lower="-3" upper="3" effort="100" velocity="10"/>' if kinds[index] in ("revolute", "prismatic") else ""
    return (
        f'<joint name="{joint_name(index)}" type="{kinds[index]}">'
        f'<parent link="{link_name(parents[index])}"/><child link="{link_name(index + 1)}"/>'
        f'<origin xyz="{text(xyz)}" rpy="{text(rpy)}"/>{axis(kinds[index], stream)}{limit}{tag}</joint>'
    )


def shuffle(items, stream):
    """In random order."""
    items = list(items)
    for i in range(len(items) - 1, 0, -1):
        k = stream.below(i + 1)
        items[i], items[k] = items[k], items[i]
    return items


def urdf(number):
    """The text of random robot `number`."""
    stream = Stream(f"tree/{number}")
    kinds, parents, massless_root = topology(stream)
    tags = followers(kinds, stream)
    massless = {i + 1 for i, k in enumerate(kinds) if k == "fixed" and stream.unit() < 0.5}
    massless = massless - {1} | {0} if massless_root else massless
    joints = [joint(i, kinds, parents, tags.get(i, ""), stream) for i in range(len(kinds))]
    links = []
    for i in range(len(kinds) + 1):
        body = "" if i in massless else inertial(stream)
        links.append(f'<link name="{link_name(i)}">{body}</link>')
    lines = shuffle(links + joints, stream)
    return f'<robot name="tree-{number:02}">\n' + "\n".join(lines) + "\n</robot>\n"

//! The part of URDF that softdock uses, as a table: which tag may stand where, with which attributes.
//!
//! Source: the URDF XML specification, <http://wiki.ros.org/urdf/XML>, with `<capsule>` and the attributes of
//! versions 1.1 and 1.2 as in urdfdom. What is not in the table is a vendor's own and is passed over, unless it looks
//! like a misspelling of something in the table.

use super::docking::{INNER_CONE, INNER_CYLINDER, PETAL, RING};

/// A tag.
pub(crate) struct Tag {
    pub(crate) name: &'static str,
    pub(crate) attributes: &'static [Attribute],
    pub(crate) children: &'static [Child],
    /// Known to other programs, of no meaning here; listed where they could be taken for a misspelling.
    pub(crate) passed_over: &'static [&'static str],
    /// Exactly one of the children is there.
    pub(crate) is_choice: bool,
}

/// A tag inside another.
pub(crate) struct Child {
    pub(crate) tag: &'static Tag,
    pub(crate) count: Count,
}

/// How often a tag may stand in its parent.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Count {
    One,
    Optional,
    Many,
}

/// An attribute of a tag.
pub(crate) struct Attribute {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) is_required: bool,
}

/// What an attribute's text must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Anything.
    Text,
    /// Anything but nothing.
    Name,
    Number,
    /// Finite, or infinite for "no limit".
    NumberOrInfinity,
    Positive,
    NonNegative,
    NonNegativeOrInfinity,
    Vec3,
    /// Three positive numbers.
    Size,
    /// Three numbers that are not zero.
    Scale,
    /// Four numbers from 0 to 1.
    Rgba,
    /// Four numbers that are not all zero.
    Quaternion,
    /// An angle between 0 and π/2.
    AcuteAngle,
    /// An angle between 0 and π.
    HalfTurn,
    /// true or false.
    Flag,
}

pub(crate) const fn must(name: &'static str, kind: Kind) -> Attribute {
    Attribute { name, kind, is_required: true }
}

pub(crate) const fn may(name: &'static str, kind: Kind) -> Attribute {
    Attribute { name, kind, is_required: false }
}

const fn one(tag: &'static Tag) -> Child {
    Child { tag, count: Count::One }
}

const fn optional(tag: &'static Tag) -> Child {
    Child { tag, count: Count::Optional }
}

const fn many(tag: &'static Tag) -> Child {
    Child { tag, count: Count::Many }
}

pub(crate) const fn leaf(name: &'static str, attributes: &'static [Attribute]) -> Tag {
    Tag { name, attributes, children: &[], passed_over: &[], is_choice: false }
}

const fn node(name: &'static str, attributes: &'static [Attribute], children: &'static [Child]) -> Tag {
    Tag { name, attributes, children, passed_over: &[], is_choice: false }
}

static ORIGIN: Tag =
    leaf("origin", &[may("xyz", Kind::Vec3), may("rpy", Kind::Vec3), may("quat_xyzw", Kind::Quaternion)]);

static MASS: Tag = leaf("mass", &[must("value", Kind::Number)]);
static INERTIA: Tag = leaf(
    "inertia",
    &[
        must("ixx", Kind::Number),
        may("ixy", Kind::Number),
        may("ixz", Kind::Number),
        must("iyy", Kind::Number),
        may("iyz", Kind::Number),
        must("izz", Kind::Number),
    ],
);
static INERTIAL: Tag = node("inertial", &[], &[optional(&ORIGIN), one(&MASS), one(&INERTIA)]);

static BOX: Tag = leaf("box", &[must("size", Kind::Size)]);
static SPHERE: Tag = leaf("sphere", &[must("radius", Kind::Positive)]);
static CYLINDER: Tag = leaf("cylinder", &[must("radius", Kind::Positive), must("length", Kind::Positive)]);
static CAPSULE: Tag = leaf("capsule", &[must("radius", Kind::Positive), must("length", Kind::Positive)]);
/// The mesh tag, also for those who read its scale alone.
pub(crate) static MESH: Tag = leaf("mesh", &[must("filename", Kind::Name), may("scale", Kind::Scale)]);
static GEOMETRY: Tag = Tag {
    name: "geometry",
    attributes: &[],
    children: &[optional(&BOX), optional(&SPHERE), optional(&CYLINDER), optional(&CAPSULE), optional(&MESH)],
    passed_over: &[],
    is_choice: true,
};

static COLOR: Tag = leaf("color", &[must("rgba", Kind::Rgba)]);
static MATERIAL: Tag = Tag {
    name: "material",
    attributes: &[may("name", Kind::Text)],
    children: &[optional(&COLOR)],
    passed_over: &["texture"],
    is_choice: false,
};
static VISUAL: Tag = node(
    "visual",
    &[may("name", Kind::Text)],
    &[optional(&ORIGIN), one(&GEOMETRY), Child { tag: &MATERIAL, count: Count::Optional }],
);
/// softdock's own: what a collision is made of, where URDF has no word for it.
pub(crate) static SOFTDOCK_SHAPE: Tag = Tag {
    name: "softdock_shape",
    attributes: &[],
    children: &[optional(&INNER_CONE), optional(&INNER_CYLINDER), optional(&RING), optional(&PETAL)],
    passed_over: &[],
    is_choice: true,
};
static COLLISION: Tag = Tag {
    name: "collision",
    attributes: &[may("name", Kind::Text)],
    children: &[optional(&ORIGIN), one(&GEOMETRY), optional(&SOFTDOCK_SHAPE)],
    passed_over: &["material", "verbose", "surface", "contact_coefficients", "max_contacts"],
    is_choice: false,
};
static LINK: Tag = Tag {
    name: "link",
    attributes: &[must("name", Kind::Name)],
    children: &[optional(&INERTIAL), many(&VISUAL), many(&COLLISION)],
    passed_over: &["contact", "sensor", "self_collision_checking", "gazebo", "material", "plugin"],
    is_choice: false,
};

static PARENT: Tag = leaf("parent", &[must("link", Kind::Name)]);
static CHILD: Tag = leaf("child", &[must("link", Kind::Name)]);
static AXIS: Tag = leaf("axis", &[must("xyz", Kind::Vec3)]);
static LIMIT: Tag = leaf(
    "limit",
    &[
        may("lower", Kind::NumberOrInfinity),
        may("upper", Kind::NumberOrInfinity),
        may("effort", Kind::NonNegativeOrInfinity),
        may("velocity", Kind::NonNegativeOrInfinity),
    ],
);
static DYNAMICS: Tag = leaf("dynamics", &[may("damping", Kind::NonNegative), may("friction", Kind::NonNegative)]);
static MIMIC: Tag =
    leaf("mimic", &[must("joint", Kind::Name), may("multiplier", Kind::Number), may("offset", Kind::Number)]);
static JOINT: Tag = Tag {
    name: "joint",
    attributes: &[must("name", Kind::Name), must("type", Kind::Name)],
    children: &[
        optional(&ORIGIN),
        one(&PARENT),
        one(&CHILD),
        optional(&AXIS),
        optional(&LIMIT),
        optional(&DYNAMICS),
        optional(&MIMIC),
    ],
    passed_over: &["safety_controller", "calibration", "hardwareInterface", "sensor", "gazebo", "plugin"],
    is_choice: false,
};

/// The outermost tag.
pub(crate) static ROBOT: Tag = Tag {
    name: "robot",
    attributes: &[must("name", Kind::Name), may("version", Kind::Text)],
    children: &[many(&LINK), many(&JOINT), many(&MATERIAL)],
    passed_over: &["transmission", "gazebo", "sensor", "ros2_control", "plugin", "model", "group", "actuator"],
    is_choice: false,
};

/// Tags with only one home, which would be lost in silence if they stood elsewhere: (tag, home).
pub(crate) static HOMES: &[(&str, &str)] = &[
    ("inertial", "link"),
    ("visual", "link"),
    ("collision", "link"),
    ("mass", "inertial"),
    ("inertia", "inertial"),
    ("geometry", "visual"),
    ("box", "geometry"),
    ("sphere", "geometry"),
    ("cylinder", "geometry"),
    ("capsule", "geometry"),
    ("mesh", "geometry"),
    ("softdock_shape", "collision"),
    ("inner_cone", "softdock_shape"),
    ("inner_cylinder", "softdock_shape"),
    ("parent", "joint"),
    ("child", "joint"),
    ("axis", "joint"),
    ("limit", "joint"),
    ("dynamics", "joint"),
    ("mimic", "joint"),
];

/// A value to show in "add attribute=…".
pub(crate) fn example_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Text | Kind::Name => "…",
        Kind::Vec3 => "0 0 0",
        Kind::Size | Kind::Scale => "1 1 1",
        Kind::Rgba => "0.5 0.5 0.5 1",
        Kind::Quaternion => "0 0 0 1",
        Kind::AcuteAngle | Kind::HalfTurn => "0.785",
        Kind::Flag => "true",
        Kind::Positive | Kind::Number | Kind::NonNegative | Kind::NumberOrInfinity | Kind::NonNegativeOrInfinity => {
            "1.0"
        }
    }
}

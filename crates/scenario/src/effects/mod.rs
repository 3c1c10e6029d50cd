//! The vocabulary of effects: which there are, where each may act, and what its parameters are.
//!
//! Names, places, parameters and conventions are those of the recordings' table of effects; values are SI, without suffix.
//! At its neutral parameters an effect changes nothing: [`Neutral`] says what they are.

mod table;

use crate::spelling::hint_for_name;
use std::fmt;

macro_rules! names {
    ($($variant:ident = $text:literal, $doc:literal;)*) => {
        /// The effects, by name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum EffectName {
            $(#[doc = $doc] $variant,)*
        }

        impl EffectName {
            /// All of them, in the order of the table.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name as it is written.
            pub fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }

            /// What it adds to the model, in a few words.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$variant => $doc,)*
                }
            }
        }
    };
}

names! {
    JointViscousFriction = "joint-viscous-friction", "Friction of a joint that grows with its rate.";
    JointCoulombFriction = "joint-coulomb-friction", "Dry friction of a joint.";
    JointStribeckFriction = "joint-stribeck-friction", "Dry friction of a joint, higher at rest than in motion.";
    JointFrictionAsymmetry = "joint-friction-asymmetry", "Dry friction of a joint that differs by direction.";
    JointViscousAsymmetry = "joint-viscous-asymmetry", "Viscous friction of a joint that differs by direction.";
    JointQuadraticFriction = "joint-quadratic-friction", "Friction of a joint that grows with the square of its rate.";
    JointOffset = "joint-offset", "A constant effort at a joint.";
    JointBacklash = "joint-backlash", "Play between motor side and link side.";
    JointElasticity = "joint-elasticity", "A spring between motor side and link side.";
    JointTorqueRipple = "joint-torque-ripple", "A torque periodic in the joint's position.";
    JointCableStiffness = "joint-cable-stiffness", "A spring to a rest position of the joint.";
    JointArmature = "joint-armature", "More reflected rotor inertia.";
    ActuatorGain = "actuator-gain", "Delivered effort over commanded effort.";
    ActuatorDelay = "actuator-delay", "Commands act later.";
    ActuatorLag = "actuator-lag", "A first-order lag between command and output.";
    ActuatorSaturation = "actuator-saturation", "A bound of the output.";
    ActuatorMisalignment = "actuator-misalignment", "A thrust axis that is tilted.";
    Payload = "payload", "A point mass fixed to a link.";
    BodyMass = "body-mass", "Another mass of a body.";
    BodyCom = "body-com", "Another centre of mass of a body.";
    BodyInertia = "body-inertia", "Another inertia of a body.";
    ConstantForce = "constant-force", "A constant force on a body.";
    ConstantTorque = "constant-torque", "A constant torque on a body.";
    Tilt = "tilt", "A constant acceleration of everything.";
    LinearDrag = "linear-drag", "Drag proportional to speed.";
    QuadraticDrag = "quadratic-drag", "Drag proportional to the square of speed.";
    AngularDamping = "angular-damping", "A torque against angular velocity.";
    InternalDissipation = "internal-dissipation", "An inner sphere that turns in a viscous fluid.";
    GravityGradient = "gravity-gradient", "The tidal torque in orbit.";
    TetherStiffness = "tether-stiffness", "A spring and damper to an anchor.";
    Slosh = "slosh", "A mass on a spring in a tank.";
    FlexibleAppendage = "flexible-appendage", "A lightly damped mode of bending.";
    PeriodicDisturbance = "periodic-disturbance", "A force or torque at a fixed frequency.";
    ContactStiffness = "contact-stiffness", "Another stiffness of a contact.";
    ContactDamping = "contact-damping", "Another damping of a contact.";
    FrictionCoefficient = "friction-coefficient", "Another sliding level of friction.";
    FrictionStribeck = "friction-stribeck", "Friction that is higher at rest than in motion.";
    FrictionBristleStiffness = "friction-bristle-stiffness", "Another stiffness before sliding.";
    FrictionViscous = "friction-viscous", "Friction that grows with sliding speed.";
    FrictionAnisotropy = "friction-anisotropy", "Friction that depends on direction.";
    FrictionDwellTime = "friction-dwell-time", "Breakaway that grows with time at rest.";
    Adhesion = "adhesion", "A force that resists parting.";
    ContactGeometryOffset = "contact-geometry-offset", "A misaligned contact part.";
    MountCompliance = "mount-compliance", "An elastic mount behind a contact part.";
    SensorBias = "sensor-bias", "A constant added to a reading.";
    SensorScale = "sensor-scale", "A factor on a reading.";
    SensorDelay = "sensor-delay", "Readings that are old.";
    SensorMisalignment = "sensor-misalignment", "A sensor that is turned.";
    Unknown = "unknown", "Significant, and none of the others; a diagnosis, not a model.";
}

impl EffectName {
    /// The effect of that name.
    pub fn parse(text: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|name| name.text() == text)
    }

    /// Continues the sentence that a name is unknown: the nearest one, or all.
    pub fn hint(text: &str) -> String {
        hint_for_name(text, Self::ALL.iter().map(|name| name.text()))
    }

    /// Where it may act and what its parameters are.
    pub fn entry(self) -> Entry {
        table::entry(self)
    }
}

impl fmt::Display for EffectName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.text())
    }
}

/// The kinds of places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceKind {
    /// `joint:[vehicle/]name`.
    Joint,
    /// `link:[vehicle/]name`.
    Link,
    /// `body:[vehicle/]name`, any link of a URDF.
    Body,
    /// `contact:a/b`.
    Contact,
    /// `actuator:name`, globs allowed.
    Actuator,
    /// `sensor:` and a prefix of channels.
    Sensor,
    /// `world`.
    World,
}

impl PlaceKind {
    /// What stands before the colon.
    pub fn text(self) -> &'static str {
        match self {
            Self::Joint => "joint",
            Self::Link => "link",
            Self::Body => "body",
            Self::Contact => "contact",
            Self::Actuator => "actuator",
            Self::Sensor => "sensor",
            Self::World => "world",
        }
    }
}

/// An effect of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Its name.
    pub name: EffectName,
    /// Where it may act.
    pub places: &'static [PlaceKind],
    /// Its parameters.
    pub parameters: &'static [Parameter],
}

impl Entry {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }
}

/// A parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its key.
    pub name: &'static str,
    /// What stands there.
    pub shape: Shape,
    /// Where the effect changes nothing.
    pub neutral: Neutral,
    /// Whether it must be given; else the neutral value stands for it (the first of a choice, zero for a phase).
    pub is_required: bool,
    /// Every number is between these, ends included.
    pub range: [f64; 2],
}

/// What stands as a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// One number.
    Number,
    /// Three numbers.
    Vector,
    /// Six numbers: xx, yy, zz, xy, xz, yz.
    Tensor,
    /// One number or three.
    NumberOrVector,
    /// One of these words.
    Choice(&'static [&'static str]),
}

/// Where an effect changes nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neutral {
    /// At this value of every entry.
    Value(f64),
    /// At the value of the nominal model.
    Nominal,
    /// A parameter of shape: another one decides whether the effect is there.
    Shape,
}

/// All effects in the order of the table.
pub fn catalogue() -> impl Iterator<Item = Entry> {
    EffectName::ALL.iter().map(|name| name.entry())
}

//! What the definition of an effect holds, and the kinds of places at which effects act.

use super::assembly::Build;
use super::identify::Identify;
use super::parameter::Parameter;
use std::fmt;

/// An effect: one definition that the scenario's checks, the schema, the build, the diagnosis, the report and the guide share.
///
/// Its law stands in `sim`. A name is told in its definition alone; what else speaks of an effect does so by the definition.
pub struct EffectDef {
    /// Name, as it is written in a file.
    pub name: &'static str,
    /// What it adds to the model, in a sentence.
    pub meaning: &'static str,
    /// The same in words that go on with "in", "at" or "of" a place.
    pub words: &'static str,
    /// Where it may act.
    pub places: &'static [PlaceKind],
    /// Its parameters.
    pub parameters: &'static [Parameter],
    /// The law with its signs and conventions.
    pub equation: &'static str,
    /// Where the law is from; for one that needs no source, where it stands.
    pub source: &'static str,
    /// How an entry of a scenario becomes a part of a world.
    pub(crate) build: Build,
    /// How a diagnosis looks for it.
    pub identify: Identify,
    /// Which of its parameters, or combinations of them, data can show.
    pub shown: Shown,
    /// Whose numbers it corrects.
    pub corrects: Corrects,
}

/// Which of an effect's parameters, or combinations of them, data can show: by these a found effect is compared with a true one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Each for itself.
    Each,
    /// Each up to its sign: a vector along which something swings.
    UpToSign {
        /// The vector.
        vector: &'static str,
    },
    /// Of a mass at a place the product of the mass and the square of the distance.
    SecondMoment {
        /// The mass.
        mass: &'static str,
        /// Its place.
        place: &'static str,
    },
    /// Two levels and the direction of the first: the same ellipse with both exchanged and a quarter of a turn between.
    Ellipse {
        /// The level along the direction.
        along: &'static str,
        /// The level across it.
        across: &'static str,
        /// The direction.
        angle: &'static str,
    },
    /// A level that falls with speed: the numbers, or the whole curve.
    FallingLevel {
        /// The level in fast sliding.
        sliding: &'static str,
        /// The level at rest.
        rest: &'static str,
        /// The speed over which it falls.
        speed: &'static str,
    },
    /// Amplitude and phase: the same wave with the other sign half a turn later.
    Wave {
        /// The amplitude.
        amplitude: &'static str,
        /// The phase.
        phase: &'static str,
    },
}

/// Whose numbers an effect corrects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corrects {
    /// Nobody's: it is physics that the nominal model does not have.
    Nothing,
    /// Masses, inertias or what an actuator delivers: what a data sheet says of a vehicle.
    DataSheet,
    /// Numbers of the nominal law of a contact.
    ContactLaw,
}

impl EffectDef {
    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.parameters.iter().find(|p| p.name == name)
    }
}

/// Definitions are as many as names.
impl PartialEq for EffectDef {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for EffectDef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("EffectDef").field(&self.name).finish()
    }
}

impl fmt::Display for EffectDef {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
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
    /// `mechanism:name`, globs allowed.
    Mechanism,
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
            Self::Mechanism => "mechanism",
            Self::Sensor => "sensor",
            Self::World => "world",
        }
    }
}

//! Compliant weld: a bushing from t = 0, with an optional strength.
//!
//! At rest F_b coincides with F_a; [`crate::World::rest_mechanism`] takes the present pose for rest instead. A weld given
//! by its frequency and damping ratio: [`Bushing::from_frequency`].

use super::{Bushing, MechanismMemory, MechanismStatus, Moment, Strength, find_negative};

/// A compliant weld.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weld {
    /// How it holds.
    pub hold: Bushing,
    /// How much it holds; it breaks beyond.
    pub strength: Strength,
}

impl Weld {
    pub(crate) fn advance(&self, now: &Moment<'_>, memory: MechanismMemory) -> MechanismMemory {
        if memory.status == MechanismStatus::Engaged && self.strength.is_exceeded(now.load) {
            return MechanismMemory { status: MechanismStatus::Broken, since: now.time, ..memory };
        }
        memory
    }

    pub(crate) fn find_fault(&self) -> Option<String> {
        let strength = [("break force", self.strength.force), ("break moment", self.strength.moment)];
        self.hold.find_fault().or(find_negative(&strength))
    }
}

//! Effects on sensors: they change no world, but what is read of it ([`crate::measure::SensorModel`]).

use super::{Entry, Parts};
use crate::build::faults::Faults;

/// Families of channels that a sensor can have.
const FAMILIES: [&str; 4] = ["joint", "body", "sensor", "drive"];

/// Holds the place against the families of channels.
pub(super) fn apply(entry: &Entry<'_>, _: &mut Parts, faults: &mut Faults<'_>) {
    let family = entry.place.split('.').next().unwrap_or_default();
    if !FAMILIES.contains(&family) {
        faults.unknown(&entry.key("place"), "family of channels", family, FAMILIES);
    }
}

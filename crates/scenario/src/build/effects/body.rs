//! Effects on bodies and on the world.

use super::{Entry, Parts};
use crate::build::faults::Faults;
use multibody::RobotDescription;

/// Changes mass properties that the effect takes over.
pub(super) fn edit_robots(_: &Entry<'_>, _: (&[&str], &mut [RobotDescription]), _: &mut Faults<'_>) {}

/// Changes the parts of the world, and adds what acts in it.
pub(super) fn apply(entry: &Entry<'_>, _: &mut Parts, faults: &mut Faults<'_>) {
    entry.not_yet(faults);
}

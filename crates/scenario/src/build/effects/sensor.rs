//! Effects on sensors.

use super::{Entry, Parts};
use crate::build::faults::Faults;

/// Changes what a sensor reads.
pub(super) fn apply(entry: &Entry<'_>, _: &mut Parts, faults: &mut Faults<'_>) {
    entry.not_yet(faults);
}

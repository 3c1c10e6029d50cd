//! Effects on mass properties: they change the robot's description before its tree is built.

use super::places::links;
use super::{Entry, Robots};
use crate::build::faults::Faults;
use crate::effects::EditMass;

/// Changes the links that the place names.
pub(super) fn edit(entry: &Entry<'_>, edit: EditMass, robots: &mut Robots<'_>, faults: &mut Faults<'_>) {
    for (v, l) in links(entry, robots, faults) {
        edit(entry, &mut robots.descriptions[v].links[l].inertial, faults);
    }
}

//! Effects on joints: at every joint that a place names.

use super::places::joints;
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::GearSpec;
use multibody::Joint;
use sim::{Effect, EffectKind, JointEffect, JointLaw};

/// Changes the joints themselves.
pub(super) fn edit(
    entry: &Entry<'_>,
    change: fn(&Entry<'_>, &mut Joint, &mut Faults<'_>),
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for site in joints(entry, &parts.vehicles, faults) {
        change(entry, &mut parts.vehicles[site.vehicle].tree.joints[site.joint], faults);
    }
}

/// Puts gears between rotors and joints.
pub(super) fn add_gears(
    entry: &Entry<'_>,
    of: fn(&Entry<'_>, &mut Joint, &mut Faults<'_>) -> Option<GearSpec>,
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for site in joints(entry, &parts.vehicles, faults) {
        let gear = of(entry, &mut parts.vehicles[site.vehicle].tree.joints[site.joint], faults);
        let kind = gear.map(|gear| EffectKind::Series(gear.at(site.coordinate)));
        parts.effects.extend(kind.map(|kind| Effect { name: entry.title(), kind }));
    }
}

/// Adds what acts on the joints.
pub(super) fn add_efforts(
    entry: &Entry<'_>,
    of: impl Fn(&mut Faults<'_>) -> Option<JointLaw>,
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for site in joints(entry, &parts.vehicles, faults) {
        let kind = of(faults).map(|law| EffectKind::Joint(JointEffect { coordinate: site.coordinate, law }));
        parts.effects.extend(kind.map(|kind| Effect { name: entry.title(), kind }));
    }
}

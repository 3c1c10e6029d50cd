//! Effects on contacts: other numbers in the laws of the pairs that a place names, and parts that stand elsewhere.
//!
//! Directions of a contact plane are those of the second-named part: along a docking shape's axis, else along x of its link,
//! laid into the plane and turned about its outward normal.

use super::places::{ContactSite, contacts};
use super::{Entry, Parts};
use crate::build::faults::Faults;
use contact::Shape;
use sim::{Grain, PairLaw, ShapeSpec};
use spatial::Vec3;

/// Changes the laws of the pairs that the place names.
pub(super) fn edit_laws(
    entry: &Entry<'_>,
    edit: fn(&Entry<'_>, &mut PairLaw, Grain) -> Result<(), String>,
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    for site in contacts(entry, parts, faults) {
        let grain = grain_of(parts, &site);
        let law = &mut parts.pairs[site.pair].1;
        if let Err(reason) = edit(entry, law, grain).and_then(|()| check(law)) {
            entry.fault(faults, &reason);
        }
    }
}

/// Moves the second-named parts.
pub(super) fn displace_parts(
    entry: &Entry<'_>,
    displace: fn(&Entry<'_>, &mut ShapeSpec, bool),
    parts: &mut Parts,
    faults: &mut Faults<'_>,
) {
    let sites = contacts(entry, parts, faults);
    let mut moved: Vec<usize> = sites.iter().map(|s| part_of(s, parts, 1)).collect();
    moved.sort_unstable();
    moved.dedup();
    let is_alone = moved.len() == 1;
    moved.into_iter().for_each(|shape| displace(entry, &mut parts.shapes[shape], is_alone));
}

/// The first-named (0) or second-named (1) part of a contact, as an index into the shapes.
pub(super) fn part_of(site: &ContactSite, parts: &Parts, which: usize) -> usize {
    parts.pairs[site.pair].0[which ^ usize::from(site.is_swapped)]
}

fn check(law: &PairLaw) -> Result<(), String> {
    law.normal.check().map_err(|e| format!("makes the contact impossible: {e}"))?;
    law.friction.as_ref().map_or(Ok(()), |f| f.check().map_err(|e| format!("makes the contact impossible: {e}")))
}

fn grain_of(parts: &Parts, site: &ContactSite) -> Grain {
    let shape = &parts.shapes[part_of(site, parts, 1)];
    let in_link = match shape.shape {
        Shape::Docking(_) => shape.pose_ls.rotation * Vec3::z(),
        _ => Vec3::x(),
    };
    let link = shape.vehicle.map(|v| &parts.vehicles[v].tree.links[shape.link]);
    let axis = link.map_or(in_link, |l| l.frame_bl.rot * in_link);
    Grain { on_b: !site.is_swapped, axis, angle: 0.0 }
}

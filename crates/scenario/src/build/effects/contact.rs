//! Effects on contacts: other numbers in the laws of the pairs that a place names, and parts that stand elsewhere.
//!
//! Directions of a contact plane are those of the second-named part: along a docking shape's axis, else along x of its link,
//! laid into the plane and turned about its outward normal.

use super::places::{ContactSite, contacts};
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::EffectName;
use contact::{Docking, NormalLaw, Shape};
use friction::{Bristle, Friction};
use multibody::RobotDescription;
use sim::{Grain, PairLaw};
use spatial::{Pose, Vec3, nalgebra};

/// Speed over which rest is lost where friction grows with time at rest, m/s, and how fast that goes, s.
const DWELL: (f64, f64) = (1e-3, 2e-3);

/// Contacts take over no mass of a robot before its tree is built: a mount's tip is taken out of the tree.
pub(super) fn edit_robots(_: &Entry<'_>, _: (&[&str], &mut [RobotDescription]), _: &mut Faults<'_>) {}

/// Changes laws and poses of the pairs that the place names.
pub(super) fn apply(entry: &Entry<'_>, parts: &mut Parts, faults: &mut Faults<'_>) {
    if entry.name == EffectName::MountCompliance {
        return;
    }
    let sites = contacts(entry, parts, faults);
    if entry.name == EffectName::ContactGeometryOffset {
        let mut moved: Vec<usize> = sites.iter().map(|s| part_of(s, parts, 1)).collect();
        moved.sort_unstable();
        moved.dedup();
        let is_alone = moved.len() == 1;
        return moved.into_iter().for_each(|shape| move_part(entry, parts, shape, is_alone));
    }
    for site in sites {
        let grain = grain_of(entry, parts, &site);
        let law = &mut parts.pairs[site.pair].1;
        if let Err(reason) = edit(entry, law, grain) {
            entry.fault(faults, &reason);
        }
    }
}

/// The first-named (0) or second-named (1) part of a contact, as an index into the shapes.
pub(super) fn part_of(site: &ContactSite, parts: &Parts, which: usize) -> usize {
    parts.pairs[site.pair].0[which ^ usize::from(site.is_swapped)]
}

fn edit(entry: &Entry<'_>, law: &mut PairLaw, grain: Grain) -> Result<(), String> {
    let number = |name: &str| entry.number(name);
    match entry.name {
        EffectName::ContactStiffness => set_stiffness(&mut law.normal.law, number("k"), entry.given("n"))?,
        EffectName::ContactDamping => match &mut law.normal.law {
            NormalLaw::HuntCrossley { dissipation, .. } => *dissipation = number("c"),
            NormalLaw::SpringDamper { damping, .. } => *damping = number("c"),
            NormalLaw::Constant { .. } => return Err(DEAD_WEIGHT.to_owned()),
        },
        EffectName::Adhesion => law.normal.adhesion += number("force"),
        EffectName::FrictionCoefficient => set_level(law, number("mu"))?,
        EffectName::FrictionAnisotropy => {
            set_ellipse(bristle(law)?, number("mu_1"), number("mu_2"))?;
            law.grain = Some(grain);
        }
        _ => edit_bristle(entry, bristle(law)?)?,
    }
    law.normal.check().map_err(|e| format!("makes the contact impossible: {e}"))?;
    law.friction.as_ref().map_or(Ok(()), |f| f.check().map_err(|e| format!("makes the contact impossible: {e}")))
}

fn edit_bristle(entry: &Entry<'_>, law: &mut Bristle) -> Result<(), String> {
    let number = |name: &str| entry.number(name);
    match entry.name {
        EffectName::FrictionStribeck => {
            if law.dwell_time > 0.0 {
                return Err(TWO_LEVELS.to_owned());
            }
            (law.mu_static, law.mu_kinetic, law.stribeck_speed) = (number("mu_s"), number("mu_d"), number("v_s"));
        }
        EffectName::FrictionDwellTime => {
            if law.mu_static != law.mu_kinetic {
                return Err(TWO_LEVELS.to_owned());
            }
            (law.mu_static, law.dwell_time) = (number("mu_s_inf"), number("time_constant"));
            (law.stribeck_speed, law.fall_time) = DWELL;
        }
        EffectName::FrictionBristleStiffness => {
            law.stiffness = number("k_b");
            law.damping = entry.given("c_b").unwrap_or(law.damping);
        }
        EffectName::FrictionViscous => law.viscous += number("b"),
        _ => {}
    }
    Ok(())
}

const TWO_LEVELS: &str =
    "meets a contact whose level changes already: it can fall with speed or grow at rest, not both";

fn set_stiffness(law: &mut NormalLaw, k: f64, n: Option<f64>) -> Result<(), String> {
    match law {
        NormalLaw::HuntCrossley { stiffness, exponent, .. } => {
            *stiffness = k;
            *exponent = n.unwrap_or(*exponent);
        }
        NormalLaw::SpringDamper { stiffness, .. } => {
            if n.is_some_and(|n| n != 1.0) {
                return Err("gives an exponent to a linear law; give the contact a hunt-crossley law".to_owned());
            }
            *stiffness = k;
        }
        NormalLaw::Constant { .. } => return Err(DEAD_WEIGHT.to_owned()),
    }
    Ok(())
}

const DEAD_WEIGHT: &str = "meets a contact that is pressed by a constant force and has no such number; leave it out";

fn bristle(law: &mut PairLaw) -> Result<&mut Bristle, String> {
    match &mut law.friction {
        Some(Friction::Bristle(law)) => Ok(law),
        _ => Err("needs bristle friction; give the contact friction = { law = \"bristle\", … }".to_owned()),
    }
}

/// The sliding level; the level at rest with it where they are one.
fn set_level(law: &mut PairLaw, mu: f64) -> Result<(), String> {
    let (at_rest, sliding) = match &mut law.friction {
        Some(Friction::Bristle(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        Some(Friction::Coulomb(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        Some(Friction::LuGre(law)) => (&mut law.mu_static, &mut law.mu_kinetic),
        None => return Err("meets a contact without friction; give it friction = { law = \"bristle\", … }".to_owned()),
    };
    if *at_rest == *sliding {
        *at_rest = mu;
    }
    *sliding = mu;
    Ok(())
}

fn set_ellipse(law: &mut Bristle, along: f64, across: f64) -> Result<(), String> {
    if along <= 0.0 {
        return Err("needs mu_1 above zero: turn the angle by 90 deg and exchange the levels".to_owned());
    }
    law.mu_static = if law.mu_static == law.mu_kinetic { along } else { law.mu_static * (along / law.mu_kinetic) };
    (law.mu_kinetic, law.across) = (along, across / along);
    Ok(())
}

fn grain_of(entry: &Entry<'_>, parts: &Parts, site: &ContactSite) -> Grain {
    let shape = &parts.shapes[part_of(site, parts, 1)];
    let in_link = match shape.shape {
        Shape::Docking(_) => shape.pose_ls.rotation * Vec3::z(),
        _ => Vec3::x(),
    };
    let link = shape.vehicle.map(|v| &parts.vehicles[v].tree.links[shape.link]);
    let axis = link.map_or(in_link, |l| l.frame_bl.rot * in_link);
    Grain { on_b: !site.is_swapped, axis, angle: entry.number("angle") }
}

/// Moves a part in its link's axes, by the turn `angle` (a rotation vector) about its origin and by `offset`. What consists
/// of several shapes turns about the link's origin, so that they keep together.
fn move_part(entry: &Entry<'_>, parts: &mut Parts, shape: usize, is_alone: bool) {
    let (offset, angle) = (entry.vector("offset"), entry.vector("angle"));
    if offset == Vec3::zeros() && angle == Vec3::zeros() {
        return;
    }
    let part = &mut parts.shapes[shape];
    let origin =
        if is_alone { part.pose_ls * nalgebra::Point3::from(origin_of(&part.shape)) } else { Default::default() };
    let turn = nalgebra::UnitQuaternion::from_scaled_axis(angle);
    let about = |p: Vec3| Pose::from_parts(p.into(), nalgebra::UnitQuaternion::identity());
    let turned = Pose::from_parts((origin.coords + offset).into(), turn);
    part.pose_ls = turned * about(-origin.coords) * part.pose_ls;
}

/// Where a part's origin is, in the shape's frame: of a cone its apex.
fn origin_of(shape: &Shape) -> Vec3 {
    match *shape {
        Shape::Docking(Docking::InnerCone { half_angle, depth, throat_radius, .. }) => {
            Vec3::new(0.0, 0.0, -depth - throat_radius / half_angle.tan())
        }
        _ => Vec3::zeros(),
    }
}

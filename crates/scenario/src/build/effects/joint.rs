//! Effects on joints: friction, gears, cables, ripple, disturbances, reflected inertia.

use super::places::{JointSite, joints};
use super::{Entry, Parts};
use crate::build::faults::Faults;
use crate::effects::EffectName;
use sim::{DryLevel, Effect, EffectKind, JointEffect, JointLaw, Series};

/// Adds reflected inertia to the joints' own.
pub(super) fn add_armature(entry: &Entry<'_>, parts: &mut Parts, faults: &mut Faults<'_>) {
    for site in joints(entry, &parts.vehicles, faults) {
        let joint = &mut parts.vehicles[site.vehicle].tree.joints[site.joint];
        let sum = joint.armature + entry.number("i_rotor");
        if sum < 0.0 {
            let has = joint.armature;
            let reason = format!("takes more than the joint has ({has} kg·m² or kg are reflected there)");
            faults.add(&entry.key("i_rotor"), reason);
        }
        joint.armature = sum;
    }
}

/// Adds what acts on the joints.
pub(super) fn apply(entry: &Entry<'_>, parts: &mut Parts, faults: &mut Faults<'_>) {
    for site in joints(entry, &parts.vehicles, faults) {
        let kind = match entry.name {
            EffectName::JointBacklash | EffectName::JointElasticity => gear(entry, site, parts, faults),
            _ => law(entry, faults).map(|law| EffectKind::Joint(JointEffect { coordinate: site.coordinate, law })),
        };
        parts.effects.extend(kind.map(|kind| Effect { name: entry.title(), kind }));
    }
}

fn law(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<JointLaw> {
    let number = |name: &str| entry.number(name);
    Some(match entry.name {
        EffectName::JointViscousFriction => JointLaw::Viscous { damping: number("b") },
        EffectName::JointCoulombFriction => JointLaw::Dry(DryLevel::Constant(number("c"))),
        EffectName::JointStribeckFriction => {
            JointLaw::Dry(DryLevel::Falling { c: number("c"), s: number("s"), v_s: number("v_s") })
        }
        EffectName::JointFrictionAsymmetry => {
            JointLaw::Dry(DryLevel::Directed { c_plus: number("c_plus"), c_minus: number("c_minus") })
        }
        EffectName::JointViscousAsymmetry => {
            JointLaw::ViscousBySide { plus: number("b_plus"), minus: number("b_minus") }
        }
        EffectName::JointQuadraticFriction => JointLaw::Quadratic { drag: number("b_2") },
        EffectName::JointOffset => JointLaw::Offset { effort: number("effort") },
        EffectName::JointTorqueRipple => {
            JointLaw::Ripple { amplitude: number("amplitude"), order: number("order"), phase: number("phase") }
        }
        EffectName::JointCableStiffness => JointLaw::Cable { stiffness: number("k"), rest: number("q_rest") },
        EffectName::PeriodicDisturbance => return periodic(entry, faults),
        _ => return None,
    })
}

fn periodic(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<JointLaw> {
    let Some(amplitude) = entry.given("amplitude") else {
        faults.add(&entry.key("amplitude"), "must be one number at a joint");
        return None;
    };
    if entry.is_given("kind") {
        faults.add(
            &entry.key("kind"),
            "is that of the joint: a torque where it turns, a force where it slides; leave it out",
        );
    }
    Some(JointLaw::Periodic { amplitude, frequency: entry.number("frequency"), phase: entry.number("phase") })
}

/// A gear that yields; it takes the joint's reflected inertia behind its spring. A rigid one is none.
fn gear(entry: &Entry<'_>, site: JointSite, parts: &mut Parts, faults: &mut Faults<'_>) -> Option<EffectKind> {
    let (stiffness, damping, gap) = (entry.number("k"), entry.number("d"), entry.number("gap"));
    if stiffness.is_infinite() {
        if gap > 0.0 {
            faults.add(&entry.key("k"), "must be finite where there is play: teeth that meet are springs");
        }
        return None;
    }
    let joint = &mut parts.vehicles[site.vehicle].tree.joints[site.joint];
    if joint.armature <= 0.0 {
        let reason = "has no rotor to put behind the spring; give the joint's [[actuator]] its \
                      reflected_inertia_kg_m2 (reflected_mass_kg where it slides)";
        entry.fault(faults, reason);
        return None;
    }
    let rotor = std::mem::replace(&mut joint.armature, 0.0);
    Some(EffectKind::Series(Series { coordinate: site.coordinate, rotor, stiffness, damping, gap }))
}

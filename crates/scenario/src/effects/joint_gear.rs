//! A gear that yields or has play, between a drive's rotor and its joint.
//!
//!   B ω̇ = u − τ,   τ = k e + d ẋ where |x| > gap/2, else 0,   e = x ∓ gap/2,   x = θ − q
//!
//! Encoder and tachometer sit on the motor side θ. At an infinite stiffness without play there is no gear.

use super::*;
use parameter::{AT_LEAST_ZERO, POSITIVE, zero};
use unit::{DAMPING, PLACE, STIFFNESS};

const SOURCE: &str = "Elastic joints after Spong 1987; play as a dead zone in series, after Nordin and Gutman 2002; \
                      law in `crates/sim/src/parts/effect/series.rs`.";

/// With a spring.
pub static JOINT_ELASTICITY: EffectDef = EffectDef {
    name: "joint-elasticity",
    meaning: "A spring between motor side and link side.",
    words: "elasticity between motor and link",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("k", POSITIVE, STIFFNESS, "stiffness of the gear").neutral_at(f64::INFINITY),
        zero("d", AT_LEAST_ZERO, DAMPING, "damping of the gear").optional(),
    ],
    equation: "τ = k (θ − q) + d (θ̇ − q̇) on the link side, B θ̈ = u − τ on the motor side; θ: motor side in joint units, B: the joint's \
               reflected inertia, u: the drive's effort.",
    source: SOURCE,
    build: Build::Gear(|entry, joint, faults| gear(entry, joint, 0.0, faults)),
    identify: Identify {
        candidates: Candidates::Joint(elastic),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Proportional,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// With play as well.
pub static JOINT_BACKLASH: EffectDef = EffectDef {
    name: "joint-backlash",
    meaning: "Play between motor side and link side.",
    words: "backlash",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("gap", AT_LEAST_ZERO, PLACE, "full width of the play"),
        zero("k", POSITIVE, STIFFNESS, "stiffness of the engaged gear; finite where there is play")
            .neutral_at(f64::INFINITY),
        zero("d", AT_LEAST_ZERO, DAMPING, "damping of the engaged gear").optional(),
    ],
    equation: "As joint-elasticity where |θ − q| > gap/2, with the spring's deflection counted from the edge of the play; no effort within.",
    source: SOURCE,
    build: Build::Gear(|entry, joint, faults| gear(entry, joint, entry.number("gap"), faults)),
    identify: Identify {
        candidates: Candidates::Joint(play),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(|_, x| vec![Alternative::here(&JOINT_ELASTICITY, vec![(-x[1]).exp(), x[2]])]),
        start: Start::LogProportional,
        minima: Minima::Several,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::Nothing,
};

/// A gear that yields; it takes the joint's reflected inertia behind its spring. A rigid one is none.
fn gear(entry: &Entry<'_>, joint: &mut multibody::Joint, gap: f64, faults: &mut Faults<'_>) -> Option<GearSpec> {
    let (stiffness, damping) = (entry.number("k"), entry.number("d"));
    if stiffness.is_infinite() {
        if gap > 0.0 {
            faults.add(&entry.key("k"), "must be finite where there is play: teeth that meet are springs");
        }
        return None;
    }
    if joint.armature <= 0.0 {
        let reason = "has no rotor to put behind the spring; give the joint's [[actuator]] its \
                      reflected_inertia_kg_m2 (reflected_mass_kg where it slides)";
        entry.fault(faults, reason);
        return None;
    }
    let rotor = std::mem::replace(&mut joint.armature, 0.0);
    Some(GearSpec { rotor, stiffness, damping, gap })
}

/// Rates, rad/s, at which a rotor swings on the springs that are screened: the stiffest that a replay still resolves, and a softer one; softer still without
/// play, which a joint that carries a load sags on.
const RATES: [f64; 3] = [300.0, 120.0, 48.0];
/// Of these, the first so many with play as well.
const WITH_PLAY: usize = 2;

/// A spring on which a rotor swings at a rate, with a tenth of its aperiodic damping.
struct Spring {
    k: f64,
    d: f64,
}

fn springs(joint: &JointFact) -> Vec<Spring> {
    if joint.armature <= 0.0 {
        return Vec::new();
    }
    let spring = |rate: f64| {
        let k: f64 = joint.armature * rate * rate;
        Spring { k, d: 0.1 * (k * joint.armature).sqrt() }
    };
    RATES.map(spring).into()
}

fn elastic(joint: &JointFact, _: &Survey<'_>) -> Vec<Candidate> {
    let of = |Spring { k, d }: Spring| {
        let coordinates = vec![Coordinate::level("k", 0.0), Coordinate::level("d", d)];
        Candidate::new(joint.place(), coordinates)
            .encoded(Encoding::Compliance)
            .screened_at(&format!("k = {k:.0}"), &[vec![1.0 / k, d], vec![1.0 / k, 3.0 * d]])
            .expensive()
    };
    springs(joint).into_iter().map(of).collect()
}

fn play(joint: &JointFact, _: &Survey<'_>) -> Vec<Candidate> {
    let of = |Spring { k, d }: Spring| {
        let coordinates = vec![
            Coordinate::log("gap", 5e-4, [1e-6, 0.1]),
            Coordinate::log("k", k, [10.0, 1e7]),
            Coordinate::level("d", d),
        ];
        let at = |gap: f64| vec![gap.ln(), k.ln(), d];
        Candidate::new(joint.place(), coordinates)
            .screened_at(&format!("k = {k:.0}"), &[at(3e-4), at(1.5e-3)])
            .expensive()
    };
    springs(joint).into_iter().take(WITH_PLAY).map(of).collect()
}

//! A torque that is periodic in a joint's position: cogging, a gear's teeth.

use super::joint::SMALL;
use super::*;
use parameter::{ANY, shape, zero};
use sim::JointLaw;
use unit::{EFFORT, NONE, RAD};

/// amplitude sin(order q + phase).
pub static JOINT_TORQUE_RIPPLE: EffectDef = EffectDef {
    name: "joint-torque-ripple",
    meaning: "A torque periodic in the joint's position.",
    words: "a torque ripple that follows the joint's angle",
    places: &[PlaceKind::Joint],
    parameters: &[
        zero("amplitude", ANY, EFFORT, "amplitude"),
        shape("order", ANY, NONE, "periods in a turn; where the joint slides 2π over the wavelength, 1/m"),
        shape("phase", ANY, RAD, "phase at q = 0").optional(),
    ],
    equation: "amplitude · sin(order q + phase).",
    source: "Fourier component of cogging; law in `crates/sim/src/parts/effect/joint.rs`.",
    build: Build::Effort(|entry| {
        let number = |name: &str| entry.number(name);
        JointLaw::Ripple { amplitude: number("amplitude"), order: number("order"), phase: number("phase") }
    }),
    identify: Identify {
        candidates: Candidates::Joint(candidates),
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: Some(spring),
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Wave { amplitude: "amplitude", phase: "phase" },
    corrects: Corrects::Nothing,
};

/// Where the joint stays within a part of one wave that is a spring: A sin(n q + φ) ≈ A sin φ + A n cos φ q.
fn spring(_: &str, x: &[f64]) -> Vec<Alternative> {
    let [along, across, order] = [x[0], x[1], x[2]];
    let stiffness = -order * along;
    let is_spring = order <= LONG && stiffness > 0.0;
    is_spring.then(|| Alternative::here(&JOINT_CABLE_STIFFNESS, vec![stiffness, across])).into_iter().collect()
}

/// Largest order of a wave that may stand for a spring.
const LONG: f64 = 2.0;

/// Orders at which a ripple is screened, whatever the data show.
const ORDERS: [f64; 9] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0];

/// Waves that a joint has to go through: what the data show, and where a fit may go, and what is screened whatever they show. One of some phase is much
/// like gravity, an offset and a spring together.
const WAVES: [f64; 2] = [0.75, 1.5];

/// Of waves that a joint has gone through, and where what is missing swings over its place.
fn candidates(joint: &JointFact, _: &Survey<'_>) -> Vec<Candidate> {
    let waves = |count: f64| if joint.travel > 0.0 { count * std::f64::consts::TAU / joint.travel } else { 0.0 };
    let [lowest, least] = WAVES.map(|count| waves(count).clamp(0.5, LARGEST));
    let coordinates = vec![
        Coordinate::free("amplitude", 0.0),
        Coordinate::free("phase", 0.0),
        Coordinate::free("order", least.max(1.0)).within([lowest, LARGEST]),
    ];
    let ripple = Candidate::new(joint.place(), coordinates).encoded(Encoding::Phasor);
    let mut orders: Vec<f64> = ORDERS.into_iter().filter(|o| *o >= least).collect();
    if orders.is_empty() {
        orders.push(least);
    }
    orders.extend(joint.orders.iter().filter(|o| **o >= lowest && **o <= LARGEST));
    vec![ripple.screened_on(2, &orders, &Along::each(0..2, SMALL)).expensive()]
}

/// Largest order.
const LARGEST: f64 = 1e4;

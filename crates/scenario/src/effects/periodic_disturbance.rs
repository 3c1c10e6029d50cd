//! A force or torque at a fixed frequency: a pump, the imbalance of a wheel.

use super::joint::SMALL;
use super::*;
use parameter::{ANY, AT_LEAST_ZERO, choice, shape, zero};
use sim::{JointLaw, Load};
use std::f64::consts::{FRAC_PI_2, TAU};
use unit::{EFFORT, HZ, RAD};

/// What swings at a body.
const KINDS: [&str; 2] = ["torque", "force"];

/// amplitude sin(2π f t + phase).
pub static PERIODIC_DISTURBANCE: EffectDef = EffectDef {
    name: "periodic-disturbance",
    meaning: "A force or torque at a fixed frequency.",
    words: "a periodic disturbance",
    places: &[PlaceKind::Body, PlaceKind::Joint],
    parameters: &[
        zero("amplitude", ANY, EFFORT, "amplitude: a number at a joint, a vector in the body's axes at a body")
            .number_or_vector(),
        shape("frequency", AT_LEAST_ZERO, HZ, "f"),
        shape("phase", ANY, RAD, "phase at the run's start").optional(),
        choice("kind", &KINDS, "what it is at a body"),
    ],
    equation: "amplitude · sin(2π f t + phase), t from the run's start: an effort at a joint; at a body a couple, or a force at the centre of mass, fixed in the body.",
    source: "Fourier component of an imbalance; laws in `crates/sim/src/parts/effect/joint.rs` and `crates/sim/src/parts/effect/body/load.rs`.",
    build: Build::EffortOrLoad { effort, load },
    identify: Identify {
        candidates: Candidates::JointAndBody { joint: at_joint, body: at_body },
        tier: Tier::Exotic,
        tolerance: None,
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Wave { amplitude: "amplitude", phase: "phase" },
    corrects: Corrects::Nothing,
};

fn effort(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<JointLaw> {
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

fn load(entry: &Entry<'_>, faults: &mut Faults<'_>) -> Option<Load> {
    if entry.numbers("amplitude").is_none_or(|a| a.len() != 3) {
        faults.add(&entry.key("amplitude"), "must be three numbers at a body: a vector in its axes");
        return None;
    }
    Some(Load::Periodic {
        amplitude: entry.vector("amplitude"),
        is_force: entry.word("kind") == KINDS[1],
        rate: TAU * entry.number("frequency"),
        phase: entry.number("phase"),
    })
}

/// Highest frequency, Hz, whatever the samples tell.
const FASTEST: f64 = 200.0;

/// Highest frequency that is looked for, Hz: a faster wave is a slower one to the samples.
fn highest(survey: &Survey<'_>) -> f64 {
    survey.highest.clamp(1.0, FASTEST)
}

/// Frequencies at which a wave is screened, Hz: those at which something swings, and a grid.
fn frequencies(survey: &Survey<'_>, grid: &[f64]) -> Vec<f64> {
    [survey.lines, grid].concat().into_iter().filter(|f| *f <= highest(survey)).collect()
}

fn at_joint(joint: &JointFact, survey: &Survey<'_>) -> Vec<Candidate> {
    let coordinates = vec![
        Coordinate::free("amplitude", 0.0),
        Coordinate::free("phase", 0.0),
        Coordinate::log("frequency", 1.0, [1.0 / survey.duration.max(1.0), highest(survey)]),
    ];
    let wave = Candidate::new(joint.place(), coordinates).encoded(Encoding::Phasor);
    let grid = frequencies(survey, &log_grid(0.5, 32.0, 1.0));
    vec![wave.screened_on(2, &grid, &Along::each(0..2, SMALL)).expensive()]
}

/// A vector that swings with one phase: a torque where the body turns, a force where it moves along.
fn at_body(body: &BodyFact, survey: &Survey<'_>) -> Vec<Candidate> {
    if !body.is_base {
        return Vec::new();
    }
    let [torque, force] = KINDS;
    let wave = |kind: &str, mask: &[bool], step: f64| {
        mask.iter()
            .any(|m| *m)
            .then(|| swinging(body, survey, &Along::each((0..3).filter(|k| mask[*k]), step)).with_word("kind", kind))
    };
    [wave(torque, body.turns(), 1e-5), wave(force, body.slides(), 1e-4)].into_iter().flatten().collect()
}

fn swinging(body: &BodyFact, survey: &Survey<'_>, axes: &[Along]) -> Candidate {
    let mut coordinates = Coordinate::vector(["amplitude[0]", "amplitude[1]", "amplitude[2]"], [0.0; 3]);
    coordinates.push(Coordinate::free("phase", 0.0));
    coordinates.push(Coordinate::log("frequency", 1.0, [0.5 / survey.duration.max(1.0), highest(survey)]));
    let mut wave = Candidate::new(body.place(), coordinates).expensive();
    for f in frequencies(survey, &log_grid(2.0 / survey.duration.max(1.0), 16.0, 1.0)) {
        let at = |quarter: f64| {
            let mut base = wave.neutral();
            (base[3], base[4]) = (quarter, f.ln());
            axes.iter().map(move |along| along.from(&base)).collect::<Vec<_>>()
        };
        let columns = [at(0.0), at(FRAC_PI_2)].concat();
        wave.screens.push(ScreenPoint { label: format!("f = {f:.3} Hz"), columns });
    }
    wave
}

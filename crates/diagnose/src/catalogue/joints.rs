//! Effects at a joint.

use super::{hypothesis, log_grid};
use crate::facts::{Facts, JointFact};
use crate::hypothesis::{Coordinate, Encoding, Hypothesis};

/// Effort beside which a first step is small, N·m.
const SMALL: f64 = 1e-3;

pub(super) fn add(joint: &JointFact, facts: &Facts, all: &mut Vec<Hypothesis>) {
    let place = format!("joint:{}", joint.name);
    let place = place.as_str();
    all.push(hypothesis("joint-viscous-friction", place, vec![Coordinate::level("b", 0.0)]).screened(&[(0, SMALL)]));
    all.push(hypothesis("joint-coulomb-friction", place, vec![Coordinate::level("c", 0.0)]).screened(&[(0, SMALL)]));
    let stribeck =
        vec![Coordinate::level("c", 0.0), Coordinate::level("s", 0.0), Coordinate::log("v_s", 0.05, [1e-3, 3.0])];
    let columns = [(vec![(0, 1.0)], SMALL), (vec![(1, 1.0)], SMALL)];
    all.push(
        hypothesis("joint-stribeck-friction", place, stribeck)
            .encoded(Encoding::Excess { of: 1, over: 0 })
            .screened_on(2, &[0.02, 0.08, 0.3], &columns),
    );
    let sides = vec![Coordinate::level("c_plus", 0.0), Coordinate::level("c_minus", 0.0)];
    all.push(hypothesis("joint-friction-asymmetry", place, sides).screened(&[(0, SMALL), (1, SMALL)]));
    let sides = vec![Coordinate::level("b_plus", 0.0), Coordinate::level("b_minus", 0.0)];
    all.push(hypothesis("joint-viscous-asymmetry", place, sides).screened(&[(0, SMALL), (1, SMALL)]));
    all.push(
        hypothesis("joint-quadratic-friction", place, vec![Coordinate::level("b_2", 0.0)]).screened(&[(0, SMALL)]),
    );
    all.push(hypothesis("joint-offset", place, vec![Coordinate::free("effort", 0.0)]).screened(&[(0, SMALL)]));
    add_springs(joint, place, all);
    add_periodic(place, facts, all);
    all.push(
        hypothesis("joint-armature", place, vec![Coordinate::free("i_rotor", 0.0)])
            .screened(&[(0, 1e-5)])
            .nominal_number(),
    );
}

fn add_springs(joint: &JointFact, place: &str, all: &mut Vec<Hypothesis>) {
    let cable = vec![Coordinate::level("k", 0.0), Coordinate::free("q_rest", 0.0)];
    all.push(
        hypothesis("joint-cable-stiffness", place, cable).encoded(Encoding::Rested).screened(&[(0, SMALL), (1, SMALL)]),
    );
    if joint.armature <= 0.0 {
        return;
    }
    // The stiffest spring on which the rotor swings at a rate that the replay still resolves, and softer ones.
    for rate in [300.0, 120.0] {
        let k: f64 = joint.armature * rate * rate;
        let d = 0.1 * (k * joint.armature).sqrt();
        let series = vec![Coordinate::level("k", 0.0), Coordinate::level("d", d)];
        all.push(
            hypothesis("joint-elasticity", place, series)
                .encoded(Encoding::Compliance)
                .screened_at(&format!("k = {k:.0}"), &[vec![1.0 / k, d], vec![1.0 / k, 3.0 * d]])
                .dear(),
        );
        let gap = vec![
            Coordinate::log("gap", 5e-4, [1e-6, 0.1]),
            Coordinate::log("k", k, [10.0, 1e7]),
            Coordinate::level("d", d),
        ];
        let at = |gap: f64| vec![gap.ln(), k.ln(), d];
        all.push(
            hypothesis("joint-backlash", place, gap)
                .screened_at(&format!("k = {k:.0}"), &[at(3e-4), at(1.5e-3)])
                .dear(),
        );
    }
}

fn add_periodic(place: &str, facts: &Facts, all: &mut Vec<Hypothesis>) {
    let ripple = vec![
        Coordinate::free("amplitude", 0.0),
        Coordinate::free("phase", 0.0),
        Coordinate { bounds: [0.5, 1000.0], ..Coordinate::free("order", 1.0) },
    ];
    let columns = [(vec![(0, 1.0)], SMALL), (vec![(1, 1.0)], SMALL)];
    let orders = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0];
    all.push(
        hypothesis("joint-torque-ripple", place, ripple)
            .encoded(Encoding::Phasor)
            .screened_on(2, &orders, &columns)
            .dear(),
    );
    let wave = vec![
        Coordinate::free("amplitude", 0.0),
        Coordinate::free("phase", 0.0),
        Coordinate::log("frequency", 1.0, [1.0 / facts.duration.max(1.0), 200.0]),
    ];
    let grid = log_grid(0.5, 32.0, 1.0);
    all.push(
        hypothesis("periodic-disturbance", place, wave)
            .encoded(Encoding::Phasor)
            .screened_on(2, &grid, &columns)
            .dear(),
    );
}

//! Effects at a contact.

use super::{hypothesis, log_grid};
use crate::facts::{ContactFact, Facts};
use crate::hypothesis::{Coordinate, Encoding, Hypothesis};

pub(super) fn add(contact: &ContactFact, _facts: &Facts, all: &mut Vec<Hypothesis>) {
    let place = format!("contact:{}", contact.name);
    if let Some(normal) = contact.normal.filter(|_| contact.has_normal_motion) {
        add_normal(&place, normal, contact.mass, all);
    }
    if let Some(bristle) = contact.bristle {
        add_friction(&place, bristle, all);
    }
}

fn add_normal(place: &str, [k, n, c]: [f64; 3], mass: f64, all: &mut Vec<Hypothesis>) {
    let law = vec![
        Coordinate::log("k", k, [1e-3 * k, 1e3 * k]),
        Coordinate { bounds: [1.0, 3.0], ..Coordinate::free("n", n) },
    ];
    all.push(hypothesis("contact-stiffness", place, law).screened(&[(0, 1e-4), (1, 1e-5)]).nominal_number());
    let damping = vec![Coordinate::level("c", c)];
    all.push(hypothesis("contact-damping", place, damping).screened(&[(0, 1e-3 * c.max(0.1))]).nominal_number());
    all.push(hypothesis("adhesion", place, vec![Coordinate::level("force", 0.0)]).screened(&[(0, 1e-3)]));
    let part = vec![
        Coordinate::free("offset[0]", 0.0),
        Coordinate::free("offset[1]", 0.0),
        Coordinate::free("offset[2]", 0.0),
        Coordinate::free("angle[0]", 0.0),
        Coordinate::free("angle[1]", 0.0),
        Coordinate::free("angle[2]", 0.0),
    ];
    let columns: Vec<(usize, f64)> = (0..6).map(|i| (i, 1e-7)).collect();
    all.push(hypothesis("contact-geometry-offset", place, part).screened(&columns));
    add_mount(place, mass, all);
}

/// Mass of a tip of which nothing is known, kg: what a scenario takes where none is given.
const TIP_MASS: f64 = 0.8;

/// Stiffnesses on which the lighter body would swing at 1 to 16 Hz.
fn add_mount(place: &str, mass: f64, all: &mut Vec<Hypothesis>) {
    let rate = |f: f64| (std::f64::consts::TAU * f).powi(2) * mass;
    let m = TIP_MASS.min(0.02 * mass);
    let coordinates = |k: f64| {
        vec![
            Coordinate::log("k", k, [1e-2 * k, 1e3 * k]),
            Coordinate::level("d", 0.05 * (k * mass).sqrt()),
            Coordinate::log("m", m, [1e-4 * mass, 0.3 * mass]),
        ]
    };
    for f in [1.5, 3.0, 6.0, 12.0] {
        let k = rate(f);
        let point = |ratio: f64| vec![k.ln(), ratio * (k * mass).sqrt(), m.ln()];
        let label = format!("k = {k:.2e}");
        all.push(hypothesis("mount-compliance", place, coordinates(k)).screened_at(&label, &[point(0.02), point(0.1)]));
    }
}

/// Dwell times (s) and breakaway levels (in sliding ones) at which a contact that gains strength at rest is screened.
const DWELLS: [f64; 4] = [0.05, 0.2, 0.8, 3.2];
const STRONGER: [f64; 2] = [1.1, 1.3];

fn add_friction(place: &str, [mu, k_b, c_b]: [f64; 3], all: &mut Vec<Hypothesis>) {
    let level = vec![Coordinate { bounds: [1e-3, 5.0], ..Coordinate::level("mu", mu) }];
    all.push(hypothesis("friction-coefficient", place, level).screened(&[(0, 1e-5)]).nominal_number());
    let stribeck = vec![
        Coordinate { bounds: [0.0, 5.0], ..Coordinate::level("mu_s", 0.0) },
        Coordinate { bounds: [1e-3, 5.0], ..Coordinate::level("mu_d", mu) },
        Coordinate::log("v_s", 5e-3, [1e-5, 1.0]),
    ];
    let columns = [(vec![(0, 1.0)], 1e-5), (vec![(1, 1.0)], 1e-5)];
    all.push(
        hypothesis("friction-stribeck", place, stribeck).encoded(Encoding::Excess { of: 0, over: 1 }).screened_on(
            2,
            &log_grid(5e-4, 0.064, 1.0),
            &columns,
        ),
    );
    let bristle = vec![Coordinate::log("k_b", k_b, [1e-2 * k_b, 1e2 * k_b]), Coordinate::level("c_b", c_b)];
    all.push(hypothesis("friction-bristle-stiffness", place, bristle).screened(&[(0, 1e-3), (1, 1e-2 * c_b.max(1.0))]));
    all.push(hypothesis("friction-viscous", place, vec![Coordinate::level("b", 0.0)]).screened(&[(0, 1e-2)]));
    let ellipse = vec![
        Coordinate { bounds: [1e-3, 5.0], ..Coordinate::level("mu_1", mu) },
        Coordinate::free("mu_2", 0.0),
        Coordinate::free("angle", 0.0),
    ];
    all.push(hypothesis("friction-anisotropy", place, ellipse).encoded(Encoding::Ellipse).screened(&[
        (0, 1e-5),
        (1, 1e-5),
        (2, 1e-5),
    ]));
    let dwell = vec![
        Coordinate { bounds: [1e-3, 5.0], ..Coordinate::level("mu_s_inf", mu) },
        Coordinate::log("time_constant", 0.3, [1e-3, 100.0]),
    ];
    // What slides in the nominal model has no rest that could make it stronger: it has to hold for that, so that only secants tell.
    let points = DWELLS.iter().flat_map(|time| STRONGER.iter().map(move |by| (*time, *by)));
    let dwell = hypothesis("friction-dwell-time", place, dwell);
    all.push(points.fold(dwell, |dwell, (time, by)| {
        dwell.screened_at(&format!("time_constant = {time:.2}, {by:.1} mu"), &[vec![by * mu, time.ln()]])
    }));
}

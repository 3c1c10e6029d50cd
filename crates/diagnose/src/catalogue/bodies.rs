//! Effects on bodies, and on all of them.

use super::{along, hypothesis, log_grid};
use crate::facts::{BodyFact, Facts};
use crate::hypothesis::{Coordinate, Encoding, Hypothesis, ScreenPoint};
use scenario::spec::ParamValue;
use spatial::Vec3;

const COM: [&str; 3] = ["com[0]", "com[1]", "com[2]"];
const VECTOR: [&str; 3] = ["vector[0]", "vector[1]", "vector[2]"];
const POSITION: [&str; 3] = ["position[0]", "position[1]", "position[2]"];
const COUPLING: [&str; 3] = ["coupling[0]", "coupling[1]", "coupling[2]"];
const AMPLITUDE: [&str; 3] = ["amplitude[0]", "amplitude[1]", "amplitude[2]"];
const INERTIA: [&str; 6] = ["inertia[0]", "inertia[1]", "inertia[2]", "inertia[3]", "inertia[4]", "inertia[5]"];

pub(super) fn add(body: &BodyFact, facts: &Facts, all: &mut Vec<Hypothesis>) {
    let place = format!("body:{}", body.name);
    let place = place.as_str();
    add_inertial(body, place, all);
    if !body.is_base {
        return;
    }
    let (turns, slides) = (body.mask[..3].iter().any(|m| *m), body.mask[3..].iter().any(|m| *m));
    // On what slides under its own weight a force is a tilt, and drag is viscous friction.
    let rests = facts.contacts.iter().any(|c| c.normal.is_none() && (c.mass - body.mass).abs() < 1e-9 * body.mass);
    if slides {
        let drag = |name| hypothesis(name, place, vec![Coordinate::level("c", 0.0)]).screened(&[(0, 1e-4)]);
        if !rests {
            add_constant("constant-force", place, &body.mask[3..], body.mass * 1e-5, all);
            all.push(drag("linear-drag"));
        }
        all.push(drag("quadratic-drag"));
        add_tether(place, &body.mask[3..], all);
    }
    if turns {
        add_constant("constant-torque", place, &body.mask[..3], 1e-6, all);
        all.push(hypothesis("angular-damping", place, vec![Coordinate::level("c", 0.0)]).screened(&[(0, 1e-5)]));
    }
    if turns && body.mask[..3].iter().all(|m| *m) {
        add_internal(body, place, facts, all);
    }
    add_waves(body, place, facts, all);
}

fn add_inertial(body: &BodyFact, place: &str, all: &mut Vec<Hypothesis>) {
    let m = body.mass;
    let of_arm = !body.is_base;
    let is_planar = body.is_base && !body.mask[0] && !body.mask[1];
    let weighs = of_arm || (body.mask[3..].iter().any(|m| *m) && !body.is_torque_free);
    if weighs {
        let mass = vec![Coordinate { bounds: [0.05 * m, 20.0 * m], ..Coordinate::free("mass", m) }];
        all.push(hypothesis("body-mass", place, mass).screened(&[(0, 1e-4 * m)]).nominal_number());
        let com = (0..3).map(|k| Coordinate::free(COM[k], body.com[k])).collect();
        // In the plane only what lies in it shows.
        let shown: Vec<(usize, f64)> = (0..3).filter(|k| !is_planar || *k < 2).map(|k| (k, 1e-5)).collect();
        let mut h = hypothesis("body-com", place, com).screened(&shown).nominal_number();
        h.held = (shown.len()..3).collect();
        all.push(h);
    }
    let i = &body.inertia;
    let entries = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
    let size = (i.trace() / 3.0).max(1e-9);
    let inertia: Vec<Coordinate> = (0..6).map(|k| Coordinate::free(INERTIA[k], entries[k])).collect();
    // A body that nothing pushes shows only ratios: Ixx stays. One that cannot turn shows nothing, one in the plane Izz.
    let is_shown = |k: &usize| match is_planar {
        true => body.mask[2] && *k == 2,
        false => *k > 0 || !body.is_torque_free,
    };
    let columns: Vec<(usize, f64)> = (0..6).filter(is_shown).map(|k| (k, 1e-4 * size)).collect();
    if !columns.is_empty() {
        let mut h = hypothesis("body-inertia", place, inertia).screened(&columns).nominal_number();
        h.held = (0..6).filter(|k| !is_shown(k)).collect();
        all.push(h);
    }
    if of_arm {
        let payload = vec![
            Coordinate::level("mass", 0.0),
            Coordinate::free(COM[0], 0.0),
            Coordinate::free(COM[1], 0.0),
            Coordinate::free(COM[2], 0.0),
        ];
        let link = place.replacen("body:", "link:", 1);
        let at = |c: [f64; 3]| vec![1e-2, 1e-2 * c[0], 1e-2 * c[1], 1e-2 * c[2]];
        let points = [at([0.0; 3]), at([0.1, 0.0, 0.0]), at([0.0, 0.1, 0.0]), at([0.0, 0.0, 0.1])];
        all.push(hypothesis("payload", &link, payload).encoded(Encoding::Moment).screened_at("", &points));
    }
}

fn add_constant(name: &'static str, place: &str, mask: &[bool], step: f64, all: &mut Vec<Hypothesis>) {
    let columns: Vec<(usize, f64)> = (0..3).filter(|k| mask[*k]).map(|k| (k, step)).collect();
    for frame in ["body", "world"] {
        let vector = (0..3).map(|k| Coordinate::free(VECTOR[k], 0.0)).collect();
        let mut h = hypothesis(name, place, vector).screened(&columns);
        h.constants.push(("frame", ParamValue::Text(frame.to_owned())));
        all.push(h);
    }
}

fn add_tether(place: &str, mask: &[bool], all: &mut Vec<Hypothesis>) {
    let tether = vec![
        Coordinate::level("k", 0.0),
        Coordinate::free("anchor[0]", 0.0),
        Coordinate::free("anchor[1]", 0.0),
        Coordinate::free("anchor[2]", 0.0),
        Coordinate::level("d", 0.0),
    ];
    let mut steps = vec![(0, 1e-3)];
    steps.extend((0..3).filter(|k| mask[*k]).map(|k| (1 + k, 1e-4)));
    steps.push((4, 1e-3));
    let mut h = hypothesis("tether-stiffness", place, tether).encoded(Encoding::Anchored).screened(&steps);
    h.held = (0..3).filter(|k| !mask[*k]).map(|k| 1 + k).collect();
    all.push(h);
}

/// Six axes whose dyads span all symmetric tensors.
fn axes() -> [Vec3; 6] {
    let mixed = |i: usize, j: usize| (Vec3::ith(i, 1.0) + Vec3::ith(j, 1.0)).normalize();
    [Vec3::x(), Vec3::y(), Vec3::z(), mixed(0, 1), mixed(0, 2), mixed(1, 2)]
}

/// Moving parts inside a body, and the tide.
fn add_internal(body: &BodyFact, place: &str, facts: &Facts, all: &mut Vec<Hypothesis>) {
    let size = body.inertia.trace() / 3.0;
    let damper = vec![Coordinate::level("i_damper", 0.0), Coordinate::log("c", 0.01, [1e-5, 10.0])];
    let rates = log_grid(1e-3, 1.0, 1.0);
    let mut damping = hypothesis("internal-dissipation", place, damper).encoded(Encoding::RateOfInertia).screened_on(
        1,
        &rates,
        &[(vec![(0, 1.0)], 1e-3 * size)],
    );
    damping.is_dear = !body.is_torque_free;
    all.push(damping);
    let tide = vec![Coordinate::level("mean_motion", 0.0)];
    all.push(hypothesis("gravity-gradient", place, tide).encoded(Encoding::Squared).screened(&[(0, 1e-7)]));
    let grid = log_grid((6.0 / facts.duration).max(0.02), 2.0, 2.0);
    all.push(slosh(body, place, &grid));
    all.push(appendage(body, place, &grid));
}

fn slosh(body: &BodyFact, place: &str, grid: &[f64]) -> Hypothesis {
    let mass = 0.01 * body.mass;
    let mut coordinates = vec![
        Coordinate { bounds: [0.0, 0.5 * body.mass], ..Coordinate::level("mass", mass) },
        Coordinate::log("frequency", 0.1, [5e-3, 20.0]),
        Coordinate::log("damping", 0.02, [1e-4, 1.0]),
    ];
    coordinates.extend((0..3).map(|k| Coordinate { bounds: [-10.0, 10.0], ..Coordinate::free(POSITION[k], 0.0) }));
    let mut h = hypothesis("slosh", place, coordinates);
    // A tumble shows m p pᵀ: the mass alone stays as it is.
    h.held = vec![0];
    h.is_dear = true;
    for f in grid {
        let point = |axis: &Vec3| {
            let mut x = h.neutral();
            (x[0], x[1]) = (mass, f.ln());
            (0..3).for_each(|k| x[3 + k] = 0.3 * axis[k]);
            x
        };
        h = h.clone().screened_at(&format!("f = {f:.3} Hz"), &axes().iter().map(point).collect::<Vec<_>>());
    }
    h
}

fn appendage(body: &BodyFact, place: &str, grid: &[f64]) -> Hypothesis {
    let mut coordinates =
        vec![Coordinate::log("frequency", 0.1, [5e-3, 20.0]), Coordinate::log("damping", 0.01, [1e-4, 1.0])];
    coordinates.extend((0..3).map(|k| Coordinate::free(COUPLING[k], 0.0)));
    let mut h = hypothesis("flexible-appendage", place, coordinates);
    h.is_dear = true;
    let size = (0.01 * body.inertia.trace() / 3.0).sqrt();
    for f in grid {
        let point = |axis: &Vec3| {
            let mut x = h.neutral();
            x[0] = f.ln();
            (0..3).for_each(|k| x[2 + k] = size * axis[k]);
            x
        };
        h = h.clone().screened_at(&format!("f = {f:.3} Hz"), &axes().iter().map(point).collect::<Vec<_>>());
    }
    h
}

/// Pumps and wheels: a vector that swings with one phase.
fn add_waves(body: &BodyFact, place: &str, facts: &Facts, all: &mut Vec<Hypothesis>) {
    let grid = log_grid(2.0 / facts.duration.max(1.0), 16.0, 1.0);
    for (kind, mask, step) in [("torque", &body.mask[..3], 1e-5), ("force", &body.mask[3..], 1e-4)] {
        if !mask.iter().any(|m| *m) {
            continue;
        }
        let mut coordinates: Vec<Coordinate> = (0..3).map(|k| Coordinate::free(AMPLITUDE[k], 0.0)).collect();
        coordinates.push(Coordinate::free("phase", 0.0));
        coordinates.push(Coordinate::log("frequency", 1.0, [0.5 / facts.duration.max(1.0), 200.0]));
        let mut h = hypothesis("periodic-disturbance", place, coordinates);
        h.constants.push(("kind", ParamValue::Text(kind.to_owned())));
        for f in &grid {
            let mut columns = Vec::new();
            for quarter in [0.0, std::f64::consts::FRAC_PI_2] {
                let mut base = h.neutral();
                (base[3], base[4]) = (quarter, f.ln());
                columns.extend((0..3).filter(|k| mask[*k]).map(|k| along(&base, &[(k, 1.0)], step)));
            }
            h.screens.push(ScreenPoint { label: format!("f = {f:.3} Hz"), columns });
        }
        all.push(h.dear());
    }
}

pub(super) fn add_world(facts: &Facts, all: &mut Vec<Hypothesis>) {
    let mut mask = [false; 3];
    for body in facts.bodies.iter().filter(|b| b.is_base) {
        (0..3).for_each(|k| mask[k] |= body.mask[3 + k]);
    }
    let columns: Vec<(usize, f64)> =
        (0..3).filter(|k| mask[*k] || !facts.joints.is_empty()).map(|k| (k, 1e-6)).collect();
    if !columns.is_empty() {
        let vector = (0..3).map(|k| Coordinate::free(VECTOR[k], 0.0)).collect();
        all.push(hypothesis("tilt", "world", vector).screened(&columns));
    }
}

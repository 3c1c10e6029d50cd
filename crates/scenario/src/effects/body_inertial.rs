//! Other mass properties of a body than its data sheet says: mass, centre of mass, inertia.
//!
//! They are new values, in the place of the nominal ones: the mass leaves centre and tensor as they are, the centre leaves mass and tensor
//! about it, the tensor counts about the centre of mass in the link's axes.

use super::*;
use multibody::Inertial;
use parameter::{ANY, POSITIVE, nominal};
use spatial::{Inertia, Mat3};
use unit::{KG, KG_M2, M};

const SOURCE: &str = "Newton and Euler; a change of the robot's description before its tree is built.";

/// A new mass.
pub static BODY_MASS: EffectDef = EffectDef {
    name: "body-mass",
    meaning: "Another mass of a body.",
    words: "a wrong mass",
    places: &[PlaceKind::Body, PlaceKind::Link],
    parameters: &[nominal("mass", POSITIVE, KG, "the true mass, of the link as the URDF has it")],
    equation: "mass in the place of the nominal one; centre of mass and inertia about it stay.",
    source: SOURCE,
    build: Build::SetMass(|entry, own, faults| correct(entry, own, faults, |own, _| own.mass = entry.number("mass"))),
    identify: Identify {
        candidates: Candidates::Body(mass),
        tier: Tier::Nominal,
        tolerance: Some(|tolerance, c| c.iter().map(|c| tolerance.mass * c.neutral.abs()).collect()),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

/// A new centre of mass.
pub static BODY_COM: EffectDef = EffectDef {
    name: "body-com",
    meaning: "Another centre of mass of a body.",
    words: "a wrong centre of mass",
    places: &[PlaceKind::Body, PlaceKind::Link],
    parameters: &[nominal("com", ANY, M, "the true centre of mass, link frame").vector()],
    equation: "com in the place of the nominal centre of mass; mass and inertia about it stay.",
    source: SOURCE,
    build: Build::SetMass(|entry, own, faults| correct(entry, own, faults, |own, _| own.com = entry.vector("com"))),
    identify: Identify {
        candidates: Candidates::Body(com),
        tier: Tier::Nominal,
        tolerance: Some(|tolerance, _| vec![tolerance.com_m; 3]),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

/// A new tensor.
pub static BODY_INERTIA: EffectDef = EffectDef {
    name: "body-inertia",
    meaning: "Another inertia of a body.",
    words: "a wrong inertia",
    places: &[PlaceKind::Body, PlaceKind::Link],
    parameters: &[nominal("inertia", ANY, KG_M2, "the true tensor: xx, yy, zz, xy, xz, yz with the signs of URDF")
        .tensor()
        .with_inertia(1.0)],
    equation: "inertia in the place of the nominal tensor about the centre of mass, axes of the link. Of a free body without known torques only ratios \
               show: a diagnosis leaves Ixx at its nominal value.",
    source: SOURCE,
    build: Build::SetMass(|entry, own, faults| correct(entry, own, faults, set_tensor(entry))),
    identify: Identify {
        candidates: Candidates::Body(inertia),
        tier: Tier::Nominal,
        tolerance: Some(share_of_trace),
        penalty: None,
        nested: None,
        start: Start::Mean,
        minima: Minima::One,
        concerns: Concerns::Motion,
    },
    shown: Shown::Each,
    corrects: Corrects::DataSheet,
};

/// Changes what a link with mass has.
fn correct(
    entry: &Entry<'_>,
    inertial: &mut Option<Inertial>,
    faults: &mut Faults<'_>,
    change: impl FnOnce(&mut Inertial, &mut Faults<'_>),
) {
    match inertial {
        Some(own) => change(own, faults),
        None => entry.fault(faults, "corrects a link with mass; name one"),
    }
}

fn set_tensor(entry: &Entry<'_>) -> impl FnOnce(&mut Inertial, &mut Faults<'_>) {
    move |own, faults| {
        let Some([xx, yy, zz, xy, xz, yz]) = entry.numbers("inertia") else { return };
        own.tensor_com = Mat3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz);
        if let Err(error) = Inertia::check(own.mass, &own.tensor_com) {
            faults.add(&entry.key("inertia"), format!("is no rigid body's: {error}"));
        }
    }
}

/// Whether a body's mass shows: it is pushed, or carried by joints.
fn weighs(body: &BodyFact) -> bool {
    !body.is_base || (body.slides().iter().any(|m| *m) && !body.is_torque_free)
}

/// Whether a base moves in a plane only.
fn is_planar(body: &BodyFact) -> bool {
    body.is_base && !body.mask[0] && !body.mask[1]
}

fn mass(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    if !weighs(body) {
        return Vec::new();
    }
    let m = body.mass;
    let coordinates = vec![Coordinate::free("mass", m).within([0.05 * m, 20.0 * m])];
    vec![Candidate::new(body.place(), coordinates).screened(&[Along::new(0, 1e-4 * m)])]
}

fn com(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    // The origin of what turns freely circles its centre of mass, which is seen where its place is.
    let circles = body.is_placed && body.turns().contains(&true);
    if !weighs(body) && !circles {
        return Vec::new();
    }
    // In the plane only what lies in it shows.
    let shown = if is_planar(body) { 2 } else { 3 };
    let coordinates = Coordinate::vector(["com[0]", "com[1]", "com[2]"], body.com.into());
    let coordinates = coordinates.into_iter().map(|c| c.about(body.reach())).collect();
    let centre = Candidate::new(body.place(), coordinates).screened(&Along::each(0..shown, 1e-5));
    vec![centre.holding((shown..3).collect())]
}

const INERTIA: [&str; 6] = ["inertia[0]", "inertia[1]", "inertia[2]", "inertia[3]", "inertia[4]", "inertia[5]"];

fn inertia(body: &BodyFact, _: &Survey<'_>) -> Vec<Candidate> {
    let i = &body.inertia;
    let entries = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
    // A body that nothing pushes shows only ratios: Ixx stays, and in the plane nothing. One that cannot turn shows nothing, one in the plane Izz.
    let is_shown = |k: &usize| match is_planar(body) {
        true => body.mask[2] && *k == 2 && !body.is_torque_free,
        false => *k > 0 || !body.is_torque_free,
    };
    let columns = Along::each((0..6).filter(is_shown), 1e-4 * body.mean_moment().max(1e-9));
    if columns.is_empty() {
        return Vec::new();
    }
    let coordinates = INERTIA
        .into_iter()
        .zip(entries)
        .map(|(key, at)| Coordinate::free(key, at).about(3.0 * body.mean_moment()))
        .collect();
    let tensor = Candidate::new(body.place(), coordinates).screened(&columns);
    vec![tensor.holding((0..6).filter(|k| !is_shown(k)).collect())]
}

/// A share of the mean of the principal moments, for each entry.
fn share_of_trace(tolerance: &Tolerance, coordinates: &[Coordinate]) -> Vec<f64> {
    let trace = coordinates.iter().take(3).map(|c| c.neutral).sum::<f64>() / 3.0;
    vec![tolerance.inertia * trace; 6]
}

//! The parts as laws: action and reaction, the way to their relative coordinates and back, rest.

use super::*;
use spatial::{Frame, Mat3, Twist, rotation_about};
use std::f64::consts::TAU;

// Round-off of a few products of numbers near one.
const ROUND_OFF: f64 = 1e-13;

fn motion() -> BodyMotion {
    let rot = rotation_about(&Vec3::new(0.6, 0.0, 0.8), 0.9);
    let twist = Twist::new(Vec3::new(0.3, 0.1, -0.4), Vec3::new(1.0, 0.2, 0.7));
    BodyMotion { frame_wl: Frame { rot, pos: Vec3::new(1.0, -2.0, 0.5) }, twist, time: 2.5 }
}

fn place() -> BodyPlace {
    BodyPlace { vehicle: 0, link: 0, com: Vec3::zeros(), tensor_com: Mat3::identity() }
}

fn parts() -> [BodyLaw; 3] {
    let coupling = Vec3::new(0.5, -0.2, 0.3);
    [
        BodyLaw::Slosh(Slosh { mass: 1.4, rate: TAU * 0.11, damping: 0.02, rest: Vec3::new(0.25, 0.15, 0.45) }),
        BodyLaw::Appendage(Appendage { rate: TAU * 0.2, damping: 0.01, coupling }),
        BodyLaw::Sphere(Sphere { inertia: 0.8, c: 0.05 }),
    ]
}

/// Some deflection of every coordinate.
fn deflected(law: &BodyLaw) -> Vec<f64> {
    (0..law.memory_names().len()).map(|k| 0.1 - 0.03 * k as f64).collect()
}

fn memory_of(law: &BodyLaw, relative: &[f64]) -> Vec<f64> {
    let mut memory = vec![0.0; law.memory_names().len()];
    law.calc_memory(&motion(), relative, &mut memory);
    memory
}

#[test]
fn relative_coordinates_lead_back_to_themselves() {
    for law in parts() {
        let mut back = vec![0.0; law.memory_names().len()];
        law.calc_relative(&motion(), &memory_of(&law, &deflected(&law)), &mut back);
        let gap = back.iter().zip(deflected(&law)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(gap < ROUND_OFF, "{law:?}: {gap}");
    }
}

#[test]
fn what_the_body_gets_the_part_loses() {
    // The part's momentum a moment later, by its rate, about a point fixed in W: the link's origin of now.
    let h = 1e-6;
    for law in parts() {
        let memory = memory_of(&law, &deflected(&law));
        let mut rate = vec![0.0; memory.len()];
        let action = law.eval(&place(), &motion(), &memory, &Vec3::zeros(), &mut rate);
        let at = |k: f64| {
            let m: Vec<f64> = memory.iter().zip(&rate).map(|(x, r)| x + k * h * r).collect();
            let now = motion();
            let turned = rotation_about(&now.twist.ang.normalize(), k * h * now.twist.ang.norm()) * now.frame_wl.rot;
            let frame_wl = Frame { rot: turned, pos: now.frame_wl.pos };
            law.calc_momentum(&frame_wl, &m)
        };
        let gain = (at(1.0) - at(-1.0)) * (0.5 / h);
        // Central difference: h² and round-off / h.
        let miss = (gain.force + action.internal.force).norm() + (gain.moment + action.internal.moment).norm();
        assert!(miss < 1e-8, "{law:?}: {miss}");
    }
}

#[test]
fn a_part_at_rest_with_a_still_body_stays_there() {
    let still = BodyMotion { twist: Twist::default(), ..motion() };
    for law in parts() {
        let (mut memory, mut rate) = (vec![0.0; law.memory_names().len()], vec![1.0; law.memory_names().len()]);
        law.calc_memory(&still, &vec![0.0; law.memory_names().len()], &mut memory);
        let action = law.eval(&place(), &still, &memory, &Vec3::zeros(), &mut rate);
        assert!(rate.iter().all(|r| r.abs() < ROUND_OFF) && action.internal.force.norm() < ROUND_OFF, "{law:?}");
        assert!(action.internal.moment.norm() < ROUND_OFF && law.calc_energy(&still.frame_wl, &memory) < ROUND_OFF);
    }
}

#[test]
fn parts_of_nothing_act_on_nothing() {
    let nothing = [
        BodyLaw::Slosh(Slosh { mass: 0.0, rate: 0.7, damping: 0.02, rest: Vec3::x() }),
        BodyLaw::Appendage(Appendage { rate: 0.7, damping: 0.01, coupling: Vec3::zeros() }),
        BodyLaw::Sphere(Sphere { inertia: 0.0, c: 0.05 }),
    ];
    for law in nothing {
        let memory = memory_of(&law, &deflected(&law));
        let mut rate = vec![0.0; memory.len()];
        let action = law.eval(&place(), &motion(), &memory, &Vec3::x(), &mut rate);
        assert!(action == BodyAction::default() && law.calc_momentum(&motion().frame_wl, &memory) == Wrench::default());
        assert!(rate.iter().all(|r| r.is_finite()));
    }
}

//! Prescribed motions: closed forms, the books with a driven base as an external agent, and recordings behind their noise.

use crate::support::mechanisms::{at, mechanism};
use crate::support::{ALL, Setup, arm7, block, run, spec};
use multibody::Tree;
use sim::{
    Base, Bushing, Drive, DriveAxis, DrivePath, Energy, Integrator, MechanismKind, Model, ModelSpec, MomentumAudit,
    State, World,
};
use spatial::{Pose, Rot, Vec3};
use std::f64::consts::TAU;
use std::sync::Arc;

fn driven(spec: ModelSpec, vehicle: usize, frame: Pose, paths: Vec<(DriveAxis, DrivePath)>) -> World {
    let paths = paths.into_iter().map(|(axis, path)| (axis, Arc::new(path))).collect();
    let drive = Drive { name: "stage".to_owned(), vehicle, frame, start: Pose::identity(), paths };
    let model = Model::build(spec).unwrap().with_drives(vec![drive]).unwrap();
    let model = Arc::new(model);
    let state = State::new(&model);
    World::new(model, state)
}

/// A block of 2 kg on a spring and damper from a stage of 5 kg that moves along x as A sin(2π f t).
fn shaken(setup: &Setup) -> World {
    let half = Vec3::repeat(0.1);
    let hold =
        Bushing { stiffness: Vec3::new(200.0, 0.0, 0.0), damping: Vec3::new(4.0, 0.0, 0.0), ..Bushing::default() };
    let spring = mechanism("spring", at(0, 0.0, 0.0, 0.0), at(1, 0.0, 0.0, 0.0), MechanismKind::Bushing(hold));
    let guided = Base::Only([false, false, false, true, false, false]);
    let vehicles: Vec<(Tree, Base)> = vec![(block(5.0, half), Base::Fixed), (block(2.0, half), guided)];
    let spec = ModelSpec { mechanisms: vec![spring], ..spec(vehicles, setup) };
    driven(spec, 0, Pose::identity(), vec![(DriveAxis::X, DrivePath::sine(0.02, 1.2, 0.0))])
}

#[test]
fn a_shaken_oscillator_follows_its_steady_swing() {
    for integrator in ALL {
        let step = if integrator == Integrator::RungeKutta4 { 1e-3 } else { 1e-4 };
        let mut world = shaken(&Setup::new(integrator).step(step));
        run(&mut world, (12.0 / step).round() as usize); // e^(−c/2m t) = e^−12
        let (omega, t) = (TAU * 1.2, world.state().time);
        // x = Re X e^{iωt}, X = −i A (k + iωc)/(k − mω² + iωc)
        let (k, c, m, a) = (200.0, omega * 4.0, 2.0, 0.02);
        let d = k - m * omega * omega;
        let (re, im) = ((k * d + c * c) / (d * d + c * c), (c * d - k * c) / (d * d + c * c));
        let expected = a * (re * (omega * t).sin() + im * (omega * t).cos());
        let x = world.state().bases[1].translation.vector.x;
        // First order at 0.1 ms: ω h A ≈ 1e-5; the transient has fallen to 1e-7.
        let tolerance = if integrator == Integrator::RungeKutta4 { 1e-6 } else { 4e-5 };
        assert!((x - expected).abs() < tolerance, "{integrator:?}: {x} against {expected}");
        let stage = world.state().bases[0].translation.vector.x;
        assert!((stage - a * (omega * t).sin()).abs() < 1e-15, "{integrator:?}");
    }
}

#[test]
fn what_a_drive_puts_in_is_in_the_books() {
    for integrator in ALL {
        let mut world = shaken(&Setup::new(integrator).step(2e-4));
        let start = Energy::of(&world);
        let mut audit = MomentumAudit::new(&world);
        for _ in 0..5000 {
            run(&mut world, 1);
            audit.update(&world);
        }
        let (end, account) = (Energy::of(&world), world.state().account);
        let gain = end.kinetic + end.mechanism - start.kinetic - start.mechanism;
        let drive_work = world.works().drives[0];
        let put_in = drive_work - account.mechanism_loss;
        // Euler's schemes lose or gain some ω² h = 2 % of the swing's energy in 1 s; the others their order.
        let share = match integrator {
            Integrator::RungeKutta4 => 1e-9,
            Integrator::ImplicitMidpoint => 1e-4,
            Integrator::ImplicitEuler | Integrator::SemiImplicitEuler => 3e-2,
        };
        let tolerance = share * drive_work.abs();
        assert!((gain - put_in).abs() < tolerance, "{integrator:?}: {gain} J against {put_in} J");
        assert!(drive_work > 1e-3, "the drive does work: {drive_work} J");
    }
}

#[test]
fn an_arm_on_a_driven_base_keeps_the_momentum_books() {
    for (integrator, tolerance) in [(Integrator::RungeKutta4, 1e-8), (Integrator::ImplicitMidpoint, 1e-12)] {
        let frame = Pose::from_parts(Vec3::new(0.3, -0.2, 0.1).into(), Rot::from_euler_angles(0.2, 0.1, -0.4));
        let paths = vec![
            (DriveAxis::Y, DrivePath::sine(0.05, 1.5, 0.3)),
            (DriveAxis::AboutZ, DrivePath::through(&[[0.0, 0.0], [0.5, 0.4], [1.2, -0.2]])),
        ];
        let spec = spec(vec![(arm7(), Base::Fixed)], &Setup::new(integrator).step(1e-3));
        let mut world = driven(spec, 0, frame, paths);
        let (mut audit, start) = (MomentumAudit::new(&world), Energy::of(&world).kinetic);
        for _ in 0..1000 {
            run(&mut world, 1);
            audit.update(&world);
        }
        assert!(audit.absolute[0] < tolerance && audit.absolute[1] < tolerance, "{integrator:?}: {:?}", audit.absolute);
        let (gain, work) = (Energy::of(&world).kinetic - start, world.works().drives[0]);
        let loose = if integrator == Integrator::RungeKutta4 { 1e-6 } else { 1e-3 };
        assert!((gain - work).abs() < loose * gain.abs().max(1.0), "{integrator:?}: {gain} J, {work} J");
        assert!(world.state().v.iter().any(|v| v.abs() > 0.05), "the joints feel the base");
    }
}

#[test]
fn paths_are_their_derivatives() {
    let points: Vec<[f64; 2]> = (0..9).map(|i| [0.25 * f64::from(i), (0.9 * f64::from(i)).sin()]).collect();
    let times: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
    let samples: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
    let paths = [
        DrivePath::sine(0.3, 0.7, 0.2),
        DrivePath::ramp(0.4),
        DrivePath::through(&points),
        DrivePath::smoothed(&times, &samples, None),
    ];
    let h = 1e-5;
    for path in &paths {
        for t in [0.0317, 0.4999, 0.77, 1.2345] {
            let (before, now, after) = (path.eval(t - h), path.eval(t), path.eval(t + h));
            let velocity = (after.position - before.position) / (2.0 * h);
            let acceleration = (after.velocity - before.velocity) / (2.0 * h);
            // Central differences: h² times a third derivative of up to 100, and rounding 1e-16/h.
            assert!((velocity - now.velocity).abs() < 1e-7, "{path:?} at {t}");
            assert!((acceleration - now.acceleration).abs() < 1e-5, "{path:?} at {t}");
        }
    }
    assert_eq!(paths[2].eval(0.5).position, points[2][1], "through its points");
    assert!(paths[2].eval(9.0).velocity.abs() < 1e-14, "at rest at its end, to rounding");
}

/// Splitmix64 and Box–Muller: white noise that any machine repeats.
fn normal(seed: &mut u64) -> f64 {
    let mut uniform = || {
        *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = *seed;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (a, b) = (uniform().max(1e-300), uniform());
    (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
}

#[test]
fn smoothing_leaves_little_of_the_noise_of_a_stage() {
    let (noise, mut seed) = (1e-6, 7);
    let times: Vec<f64> = (0..6000).map(|i| 1e-3 * f64::from(i)).filter(|t| !(2.0..2.02).contains(t)).collect();
    // A speed that rises over 0.1 s and turns round: 10 mm/s.
    let truth = |t: f64| 1e-2 * (0.1 * ((t - 1.0) / 0.05).tanh().mul_add(0.5, 0.5) + 0.3 * (0.8 * t).sin());
    let rate = |t: f64| {
        let bell = 1.0 / ((t - 1.0) / 0.05).cosh();
        1e-2 * (0.1 * 0.5 / 0.05 * bell * bell + 0.24 * (0.8 * t).cos())
    };
    let samples: Vec<f64> = times.iter().map(|t| truth(*t) + noise * normal(&mut seed)).collect();
    for known in [None, Some(noise)] {
        let path = DrivePath::smoothed(&times, &samples, known);
        let rms =
            |f: &dyn Fn(f64) -> f64| (times.iter().map(|t| f(*t).powi(2)).sum::<f64>() / times.len() as f64).sqrt();
        let position = rms(&|t| path.eval(t).position - truth(t));
        let velocity = rms(&|t| path.eval(t).velocity - rate(t));
        let residual = rms(&|t| path.eval(t).position - truth(t)) / noise;
        // Raw differences would give 1.4 mm/s.
        assert!(position < 0.35 * noise && velocity < 3e-5, "{position} m, {velocity} m/s, {residual}");
    }
}

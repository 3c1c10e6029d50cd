//! The torque-free triaxial body against Jacobi's elliptic functions: attitude to a microradian after 1,000 s.

use crate::support::elliptic::TorqueFree;
use crate::support::{Setup, free_world, link, robot, run};
use multibody::Inertial;
use sim::{Integrator, World};
use spatial::{Mat3, Pose, Rot, Twist, Vec3};

/// Ascending, of a satellite with one long side; kg·m².
const MOMENTS: [f64; 3] = [30.0, 55.0, 70.0];

/// One start: angle of L from axis 3, spin in rad/s, phase of the elliptic functions.
type Start = (f64, f64, f64);

/// Starts with at most 3 rad/s, the nearest 0.1 rad on either side of the separatrix.
fn starts() -> [Start; 6] {
    let edge = TorqueFree::separatrix(&MOMENTS.into());
    [
        (edge - 0.1, 3.0, 0.3),
        (edge + 0.1, 3.0, 1.1),
        (0.05, 2.9, 0.0),
        (edge - 0.3, 1.0, 2.0),
        (1.5, 2.9, 0.7),
        (edge + 0.2, 0.3, -0.4),
    ]
}

/// A body whose principal axes are turned in its link, whose centre of mass is off the origin, and which drifts.
fn body(case: &TorqueFree, setup: &Setup) -> (World, Rot) {
    let rot_lp = Rot::from_scaled_axis(Vec3::new(0.4, -0.7, 0.9));
    let turn = rot_lp.to_rotation_matrix();
    let tensor_com = turn.matrix() * Mat3::from_diagonal(&MOMENTS.into()) * turn.matrix().transpose();
    let com = Vec3::new(0.2, -0.1, 0.3);
    let mut description = link("body", 120.0, com, Vec3::zeros());
    description.inertial = Some(Inertial { mass: 120.0, com, tensor_com });
    let mut world = free_world(robot(vec![description], Vec::new()), setup);
    let rot_wl = Rot::from_scaled_axis(Vec3::new(-0.3, 0.5, 1.2));
    world.state_mut().bases[0] = Pose::from_parts(Vec3::new(1.0, 2.0, -0.5).into(), rot_wl);
    let omega = rot_wl * (rot_lp * case.omega(0.0));
    let drift = Vec3::new(0.01, -0.02, 0.005);
    world.set_base_twists(&[Twist::new(omega, drift - omega.cross(&(rot_wl * com)))]);
    (world, rot_lp)
}

/// Angle between the simulated and the exact attitude, rad.
fn attitude_error(world: &World, rot_lp: &Rot, start: &Mat3, case: &TorqueFree) -> f64 {
    let t = world.state().time;
    let exact = start * case.attitude(0.0, 0.0).transpose() * case.attitude(t, case.turn(0.0, t));
    let rot_wp = (world.state().bases[0].rotation * rot_lp).to_rotation_matrix();
    // From the antisymmetric part: precise for small angles.
    let d = rot_wp.matrix() * exact.transpose();
    0.5 * Vec3::new(d[(2, 1)] - d[(1, 2)], d[(0, 2)] - d[(2, 0)], d[(1, 0)] - d[(0, 1)]).norm()
        + (3.0 - d.trace()).max(0.0)
}

/// Attitude error after `seconds`.
fn simulate(start: Start, setup: &Setup, seconds: f64) -> f64 {
    let case = TorqueFree::new(MOMENTS.into(), start.0, start.1, start.2);
    let (mut world, rot_lp) = body(&case, setup);
    let rot_wp = (world.state().bases[0].rotation * rot_lp).to_rotation_matrix();
    run(&mut world, (seconds / setup.step).round() as usize);
    attitude_error(&world, &rot_lp, rot_wp.matrix(), &case)
}

/// Attitude error of the first start, for the table of orders, rad.
pub(crate) fn error_of_first_start(setup: &Setup, seconds: f64) -> f64 {
    simulate(starts()[0], setup, seconds)
}

#[test]
fn elliptic_motion_satisfies_eulers_equations_and_turns_with_its_own_rate() {
    for (angle, spin, phase) in starts() {
        let case = TorqueFree::new(MOMENTS.into(), angle, spin, phase);
        let (t, d) = (7.3, 1e-4);
        let moments = Vec3::from(MOMENTS);
        let slope = (case.omega(t + d) - case.omega(t - d)) / (2.0 * d);
        let w = case.omega(t);
        let euler = moments.component_mul(&slope) + w.cross(&moments.component_mul(&w));
        assert!(euler.norm() < 1e-5, "central difference: d² of a motion at 3 rad/s; {euler}");
        let (before, after) =
            (case.attitude(t - d, case.turn(0.0, t - d)), case.attitude(t + d, case.turn(0.0, t + d)));
        let rate = case.attitude(t, case.turn(0.0, t)).transpose() * (after - before) / (2.0 * d);
        let turned = Vec3::new(rate[(2, 1)], rate[(0, 2)], rate[(1, 0)]);
        assert!((turned - w).norm() < 1e-6, "{turned} {w}");
    }
}

#[test]
fn attitude_after_1000_s_is_within_a_microradian() {
    for start in starts() {
        let error = simulate(start, &Setup::new(Integrator::RungeKutta4), 1000.0);
        println!("L at {:.3} rad, {:.1} rad/s: attitude error {error:.1e} rad", start.0, start.1);
        assert!(error <= 1e-6);
    }
}

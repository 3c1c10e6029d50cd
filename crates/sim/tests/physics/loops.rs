//! Loops through contact: links of one tree that touch each other, and two arms on one base that hold one target.

use crate::support::{ALL, Setup, block, bristle, joint, linear, link, robot, run, shape, spec, twist, world};
use contact::Shape;
use multibody::{JointKind, Tree};
use sim::{
    Actuator, ActuatorKind, Base, Command, Energy, Integrator, ModelSpec, MomentumAudit, PairLaw, ShapeSpec, World,
};
use spatial::{Pose, Rot, Vec3};

/// Relative drift that rounding leaves after some thousand steps.
const DRIFT: f64 = 1e-12;
/// Of every contact here, N/m.
const STIFFNESS: f64 = 1e5;

fn motor(coordinate: usize) -> Actuator {
    let kind = ActuatorKind::JointEffort { coordinate, limit: 100.0 };
    Actuator { name: format!("motor{coordinate}"), kind }
}

/// A ball that sits in a link of vehicle 0.
fn ball(name: &str, link: usize, at: Vec3, radius: f64) -> ShapeSpec {
    let pose_ls = Pose::translation(at.x, at.y, at.z);
    ShapeSpec { link, pose_ls, ..shape(name, Some(0), Shape::Ball { radius }) }
}

/// A free chain of three bars in a plane, folded so that the tip of the third, a ball, comes down on the first, a capsule.
fn folded_arm(damping: f64, swapped: bool, setup: &Setup) -> World {
    let bar = |name| link(name, 2.0, Vec3::new(0.25, 0.0, 0.0), Vec3::new(0.002, 0.04, 0.04));
    let hinge = |name, parent| joint(name, parent, Vec3::new(0.5, 0.0, 0.0), Vec3::z(), JointKind::Revolute);
    let tree = robot(vec![bar("first"), bar("second"), bar("third")], vec![hinge("a", 0), hinge("b", 1)]);
    let lying = Rot::from_scaled_axis(Vec3::y() * std::f64::consts::FRAC_PI_2);
    let pose_ls = Pose::from_parts(Vec3::new(0.25, 0.0, 0.0).into(), lying);
    let bar_shape = shape("bar", Some(0), Shape::Capsule { radius: 0.05, half_length: 0.25 });
    let shapes = vec![ShapeSpec { pose_ls, ..bar_shape }, ball("tip", 2, Vec3::new(0.5, 0.0, 0.0), 0.03)];
    let pair = if swapped { [1, 0] } else { [0, 1] };
    let friction = (damping > 0.0).then(|| bristle(0.4, 1e4, 5.0));
    let pairs = vec![(pair, PairLaw::new(linear(STIFFNESS, damping), friction))];
    let mut world = world(ModelSpec { shapes, pairs, ..spec(vec![(tree, Base::Free)], setup) });
    // Folded back twice: the tip stands 0.2 m above the first bar, and both joints close.
    world.state_mut().q.copy_from_slice(&[1.7, 1.9]);
    world.state_mut().v.copy_from_slice(&[0.3, 2.0]);
    world.set_base_twists(&[twist([0.1, 0.0, 0.2], [0.05, -0.1, 0.2])]);
    world
}

#[test]
fn two_links_of_one_arm_that_hit_each_other_keep_the_arms_momentum() {
    for integrator in ALL {
        let mut world = folded_arm(100.0, false, &Setup::new(integrator).step(2e-4));
        let mut audit = MomentumAudit::new(&world);
        let (start, mut hardest) = (Energy::of(&world), 0.0_f64);
        for _ in 0..5_000 {
            run(&mut world, 1);
            hardest = world.touches().map(|t| t.force_w.norm()).fold(hardest, f64::max);
            audit.update(&world);
        }
        let end = Energy::of(&world);
        println!("{integrator:?}: {hardest:.1} N, drift {:.1e} {:.1e}", audit.linear_drift, audit.angular_drift);
        assert!(hardest > 20.0, "{integrator:?}: they hit each other, with {hardest} N");
        assert!(audit.linear_drift < DRIFT && audit.angular_drift < DRIFT, "{integrator:?}: {audit:?}");
        assert!(end.kinetic + end.elastic < start.kinetic, "{integrator:?}: dampers and friction take, nothing gives");
    }
}

#[test]
fn an_elastic_blow_within_one_arm_keeps_its_energy() {
    let total = |world: &World| Energy::of(world).kinetic + Energy::of(world).elastic;
    let mut world = folded_arm(0.0, false, &Setup::new(Integrator::RungeKutta4).step(2e-5));
    let start = total(&world);
    let mut touched = false;
    let mut worst = 0.0_f64;
    for _ in 0..50_000 {
        run(&mut world, 1);
        touched |= world.touches().any(|t| t.normal_force > 0.0);
        worst = worst.max((total(&world) / start - 1.0).abs());
    }
    println!("energy off by {worst:.1e}");
    // Fourth order, but for the two corners of the law where the balls meet and part: h² of a blow of 10 ms.
    assert!(touched && worst < 1e-5, "touched: {touched}, {worst}");
}

#[test]
fn naming_the_two_links_the_other_way_round_is_the_same_blow() {
    for integrator in ALL {
        let setup = Setup::new(integrator).step(2e-4);
        let [here, there] = [false, true].map(|swapped| {
            let mut world = folded_arm(100.0, swapped, &setup);
            run(&mut world, 5_000);
            world.state().q.clone()
        });
        let off = (here[0] - there[0]).abs().max((here[1] - there[1]).abs());
        // Two orders of addition, told apart by a blow that multiplies them some thousand times.
        assert!(off < 1e-9, "{integrator:?}: {off:.1e} rad");
    }
}

/// Two fingers on one base that slide along x towards each other.
fn fingers(base: Base, setup: &Setup) -> World {
    let finger = |name| link(name, 0.5, Vec3::zeros(), Vec3::repeat(1e-3));
    let slide =
        |name, side: f64| joint(name, 0, Vec3::new(0.05 * side, 0.0, 0.0), Vec3::x() * -side, JointKind::Prismatic);
    let body = link("base", 5.0, Vec3::new(0.0, 0.0, -0.1), Vec3::repeat(0.1));
    let tree = robot(vec![body, finger("left"), finger("right")], vec![slide("left", -1.0), slide("right", 1.0)]);
    let shapes = vec![ball("left", 1, Vec3::zeros(), 0.04), ball("right", 2, Vec3::zeros(), 0.04)];
    let pairs = vec![([0, 1], PairLaw::new(linear(STIFFNESS, 200.0), Some(bristle(0.5, 1e4, 10.0))))];
    let actuators = vec![motor(0), motor(1)];
    world(ModelSpec { shapes, pairs, actuators, ..spec(vec![(tree, base)], setup) })
}

#[test]
fn fingers_of_one_hand_press_on_each_other_with_what_their_motors_give() {
    for integrator in ALL {
        for base in [Base::Free, Base::Fixed] {
            let mut world = fingers(base, &Setup::new(integrator));
            for command in world.commands_mut() {
                command.effort = 12.0;
            }
            run(&mut world, 3_000);
            let forces: Vec<f64> = world.touches().map(|t| t.force_w.x).collect();
            // On B, the right finger, along +x; both at rest, so each motor's 12 N meet.
            assert_eq!(forces.len(), 1);
            assert!((forces[0] - 12.0).abs() < 1e-6, "{integrator:?} {base:?}: {} N", forces[0]);
            let v = &world.state().v;
            assert!(v[0].abs() < 1e-9 && v[1].abs() < 1e-9 && (world.state().q[0] - world.state().q[1]).abs() < 1e-12);
            if base == Base::Free {
                let p = world.state().momentum[0];
                assert!(p.force.norm() < 1e-13 && p.moment.norm() < 1e-13, "{integrator:?}: it pushed itself: {p:?}");
            }
        }
    }
}

/// A base with two arms of two bars each, mirrored in x, whose tips (balls) stand at either side of a box.
///
/// Shoulders at x = ∓0.4, bars of 0.4 m; q = ±(shoulder, elbow) brings the tips to (∓0.1, 0.4 √2 …).
struct TwoArms {
    tree: Tree,
    /// Joint positions, left then right, and the Jacobian's transpose for a force along x at the left tip.
    q: [f64; 4],
    lever: [f64; 2],
    tip: Vec3,
}

const BAR: f64 = 0.4;

fn two_arms() -> TwoArms {
    let bar = |name| link(name, 1.0, Vec3::new(0.0, 0.5 * BAR, 0.0), Vec3::new(0.014, 0.001, 0.014));
    let at = |side: f64| Vec3::new(0.4 * side, 0.0, 0.0);
    let hinge = |name, parent, place: Vec3| joint(name, parent, place, Vec3::z(), JointKind::Revolute);
    let elbow = Vec3::new(0.0, BAR, 0.0);
    let base = link("base", 40.0, Vec3::new(0.0, -0.2, 0.0), Vec3::new(2.0, 3.0, 4.0));
    let links = vec![base, bar("left_upper"), bar("left_fore"), bar("right_upper"), bar("right_fore")];
    let joints = vec![
        hinge("left_shoulder", 0, at(-1.0)),
        hinge("left_elbow", 1, elbow),
        hinge("right_shoulder", 0, at(1.0)),
        hinge("right_elbow", 3, elbow),
    ];
    // Bars along y at zero; turned by a and a + b about z. Left: outwards by 0.3, then inwards by 1.3.
    let (a, b) = (0.3_f64, -1.3_f64);
    let tip = Vec3::new(-0.4 - BAR * (a.sin() + (a + b).sin()), BAR * (a.cos() + (a + b).cos()), 0.0);
    // ∂x/∂a, ∂x/∂b of the left tip.
    let lever = [-BAR * (a.cos() + (a + b).cos()), -BAR * (a + b).cos()];
    TwoArms { tree: robot(links, joints), q: [a, b, -a, -b], lever, tip }
}

#[test]
fn two_arms_on_one_base_hold_a_target_between_them() {
    const SQUEEZE: f64 = 20.0;
    const DRIVE: f64 = 400.0;
    for integrator in [Integrator::ImplicitEuler, Integrator::ImplicitMidpoint] {
        let arms = two_arms();
        let radius = 0.02;
        let half = Vec3::new(-arms.tip.x - radius, 0.05, 0.04);
        let mut spec = spec(vec![(arms.tree, Base::Free), (block(3.0, half), Base::Free)], &Setup::new(integrator));
        let tip = |name, link| ball(name, link, Vec3::new(0.0, BAR, 0.0), radius);
        spec.shapes =
            vec![tip("left", 2), tip("right", 4), shape("box", Some(1), Shape::Cuboid { half_extents: half })];
        let law = PairLaw::new(linear(STIFFNESS, 300.0), Some(bristle(0.6, 2e4, 60.0)));
        spec.pairs = vec![([0, 2], law), ([1, 2], law)];
        let drive = |coordinate| ActuatorKind::JointDrive { coordinate, stiffness: DRIVE, damping: 40.0, limit: 200.0 };
        spec.actuators = (0..4).map(|c| Actuator { name: format!("drive{c}"), kind: drive(c) }).collect();
        let mut world = world(spec);
        world.state_mut().bases[1] = Pose::translation(0.0, arms.tip.y, 0.0);
        world.state_mut().q.copy_from_slice(&arms.q);
        for (k, command) in world.commands_mut().iter_mut().enumerate() {
            let side = if k < 2 { 1.0 } else { -1.0 };
            *command = Command { position: arms.q[k], effort: side * arms.lever[k % 2] * SQUEEZE, velocity: 0.0 };
        }
        // The whole drifts and turns slowly, and the target a little against it.
        let (at, spin) = (Vec3::new(0.0, arms.tip.y, 0.0), Vec3::new(0.01, 0.0, 0.02));
        let carried = spin.cross(&at);
        let target = twist([0.01, 0.0, 0.05], [carried.x, carried.y, carried.z + 0.01]);
        world.set_base_twists(&[twist([0.01, 0.0, 0.02], [0.0; 3]), target]);
        let mut audit = MomentumAudit::new(&world);
        for _ in 0..40 {
            run(&mut world, 100);
            audit.update(&world);
        }
        // Drives yield along x as springs of 1/Σ(lever²/k) against a contact that yields far less.
        let yielding = 1.0 / (arms.lever.iter().map(|l| l * l / DRIVE).sum::<f64>());
        let expected = SQUEEZE * STIFFNESS / (STIFFNESS + yielding);
        let forces: Vec<Vec3> = world.touches().map(|t| t.force_w).collect();
        println!("{integrator:?}: {:?} N against {expected:.3}", forces.iter().map(|f| f.norm()).collect::<Vec<_>>());
        assert_eq!(forces.len(), 2, "held from both sides");
        for force in &forces {
            // What turns with 0.02 rad/s presses by its centripetal force, millinewtons.
            assert!((force.norm() / expected - 1.0).abs() < 5e-3, "{integrator:?}: {} N, {expected} N", force.norm());
        }
        let net = (forces[0] + forces[1]).norm();
        assert!(net < 0.02 * expected, "{integrator:?}: {net} N are left on a target that hardly accelerates");
        assert!(world.touches().all(|t| t.sticks), "{integrator:?}: by friction");
        assert!(audit.linear_drift < DRIFT && audit.angular_drift < DRIFT, "{integrator:?}: {audit:?}");
        let relative = world.kinematics(1).vel[0].ang - world.kinematics(0).vel[0].ang;
        assert!(
            relative.norm() < 5e-3,
            "{integrator:?}: the target turns against its captor by {} rad/s",
            relative.norm()
        );
    }
}

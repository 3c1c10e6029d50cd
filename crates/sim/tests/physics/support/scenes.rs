//! Scenes with contact that several topics look at.

use super::{Setup, arm7, block, bristle, hunt_crossley, joint, linear, link, robot, shape, spec, twist, world};
use contact::{Normal, NormalLaw, Shape};
use multibody::{JointKind, Tree};
use sim::{Actuator, ActuatorKind, Base, Command, ModelSpec, PairLaw, ShapeSpec, World};
use spatial::{Pose, Rot, Twist, Vec3};

/// Half the edges of the usual block, m.
pub(crate) const BLOCK: [f64; 3] = [0.1, 0.1, 0.05];

/// A block of 1 kg on the half-space z < 0, in a field that a slope of `angle` would give.
pub(crate) fn block_on_slope(angle: f64, law: PairLaw, setup: &Setup) -> World {
    let gravity = 9.81 * Vec3::new(angle.sin(), 0.0, -angle.cos());
    let half = Vec3::from(BLOCK);
    let mut spec = spec(vec![(block(1.0, half), Base::Free)], &setup.gravity(gravity));
    spec.shapes =
        vec![shape("floor", None, Shape::HalfSpace), shape("block", Some(0), Shape::Cuboid { half_extents: half })];
    spec.pairs = vec![([0, 1], law)];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, half.z - 1e-9);
    world
}

/// A plate of 8 kg and a box of 2 kg that flies into it with a spin: several impacts, corners sliding and sticking.
pub(crate) fn box_hits_plate_spec(setup: &Setup) -> ModelSpec {
    let (plate, half) = (block(8.0, Vec3::new(0.4, 0.4, 0.05)), Vec3::new(0.1, 0.07, 0.05));
    let mut spec = spec(vec![(plate, Base::Free), (block(2.0, half), Base::Free)], setup);
    spec.shapes =
        vec![shape("face", Some(0), Shape::HalfSpace), shape("box", Some(1), Shape::Cuboid { half_extents: half })];
    spec.pairs = vec![([0, 1], PairLaw::new(linear(1e4, 40.0), Some(bristle(0.4, 1e4, 20.0))))];
    spec
}

/// The box just above the plate, tilted; both spin.
pub(crate) fn start_box_hits_plate(world: &mut World) {
    let tilt = Rot::from_scaled_axis(Vec3::new(0.04, -0.03, 0.4));
    world.state_mut().bases[1] = Pose::from_parts(Vec3::new(0.05, 0.02, 0.06).into(), tilt);
    world.set_base_twists(&[twist([0.1, -0.2, 0.05], [0.0, 0.01, 0.02]), twist([0.2, -0.3, -1.0], [0.2, 0.1, -0.4])]);
}

/// A free base with two fingers (half-spaces that slide on x) and a box of 2 kg between them: eight sticking points.
///
/// Actuators: one drive per finger; [`start_gripper`] closes them with about 20 N.
pub(crate) fn gripper_spec(setup: &Setup) -> ModelSpec {
    let half = Vec3::new(0.05, 0.04, 0.06);
    let mut spec = spec(vec![(gripper_tree(), Base::Free), (block(2.0, half), Base::Free)], setup);
    let box_shape = shape("box", Some(1), Shape::Cuboid { half_extents: half });
    spec.shapes = vec![finger(1, 1.0), finger(2, -1.0), box_shape];
    let law = PairLaw::new(linear(5e4, 50.0), Some(bristle(0.5, 5e4, 30.0)));
    spec.pairs = vec![([0, 2], law), ([1, 2], law)];
    spec.actuators = (0..2).map(finger_drive).collect();
    spec
}

/// The same gripper with pads of finite size in place of half-spaces.
pub(crate) fn pad_gripper_spec(setup: &Setup) -> ModelSpec {
    let mut spec = gripper_spec(setup);
    for (shape, side) in spec.shapes.iter_mut().zip([-1.0, 1.0]).take(2) {
        shape.pose_ls = Pose::translation(0.01 * side, 0.005, 0.0);
        shape.shape = Shape::Cuboid { half_extents: Vec3::new(0.01, 0.03, 0.025) };
    }
    spec
}

/// The pad gripper's world at its start.
pub(crate) fn pad_gripper(setup: &Setup) -> World {
    let mut world = world(pad_gripper_spec(setup));
    start_gripper(&mut world);
    world
}

/// Bodies of every shape that fly into a big free box, each tilted and turning.
pub(crate) fn shower(setup: &Setup) -> World {
    shower_of(setup, usize::MAX)
}

/// The same, where only the first `touching` of ball, box, cylinder, capsule, hull and mesh touch the big box.
pub(crate) fn shower_of(setup: &Setup, touching: usize) -> World {
    let corner =
        |k: u32| Vec3::new(f64::from(k & 1) - 0.5, f64::from(k >> 1 & 1) - 0.5, f64::from(k >> 2) - 0.5) * 0.12;
    let hull: Vec<Vec3> = (0..7).map(corner).collect();
    let faces = vec![[0, 2, 1], [0, 1, 4], [0, 4, 2], [1, 2, 4]];
    let shapes = [
        Shape::Ball { radius: 0.06 },
        Shape::Cuboid { half_extents: Vec3::new(0.06, 0.05, 0.04) },
        Shape::Cylinder { radius: 0.05, half_length: 0.06 },
        Shape::Capsule { radius: 0.04, half_length: 0.05 },
        Shape::ConvexHull { vertices: hull.clone() },
        Shape::TriMesh { vertices: hull[..5].to_vec(), triangles: faces },
    ];
    let half = Vec3::new(0.6, 0.4, 0.1);
    let mut vehicles = vec![(block(30.0, half), Base::Free)];
    vehicles.extend(shapes.iter().map(|_| (block(0.8, Vec3::repeat(0.05)), Base::Free)));
    let mut spec = spec(vehicles, setup);
    spec.shapes = vec![shape("box", Some(0), Shape::Cuboid { half_extents: half })];
    let law = PairLaw::new(hunt_crossley(4e4, 1.5, 0.4), Some(bristle(0.4, 5e3, 8.0)));
    for (i, geometry) in shapes.into_iter().enumerate() {
        spec.shapes.push(shape(&format!("shape{i}"), Some(i + 1), geometry));
        spec.pairs.push(([0, i + 1], law));
    }
    spec.pairs.truncate(touching);
    let mut world = world(spec);
    let mut twists = vec![twist([0.02, -0.01, 0.03], [0.0; 3])];
    for i in 1..7 {
        let place = Vec3::new(0.3 * f64::from((i - 1) % 3) - 0.3, 0.3 * f64::from((i - 1) / 3) - 0.15, 0.2);
        let turned = Rot::from_scaled_axis(Vec3::new(0.2 * f64::from(i), 0.3, -0.1));
        world.state_mut().bases[i as usize] = Pose::from_parts(place.into(), turned);
        twists.push(twist([0.5, -0.4, 0.3 * f64::from(i)], [0.05, 0.02 * f64::from(i), -0.3]));
    }
    world.set_base_twists(&twists);
    world
}

fn gripper_tree() -> Tree {
    let finger = |name| link(name, 0.5, Vec3::zeros(), Vec3::new(2e-3, 1.5e-3, 1e-3));
    let base = link("base", 20.0, Vec3::new(0.0, 0.02, -0.1), Vec3::new(0.8, 0.7, 0.6));
    let slide = |name, x: f64| joint(name, 0, Vec3::new(x, 0.0, 0.3), Vec3::x() * -x.signum(), JointKind::Prismatic);
    robot(vec![base, finger("left"), finger("right")], vec![slide("slide_left", -0.08), slide("slide_right", 0.08)])
}

fn finger(link: usize, facing: f64) -> ShapeSpec {
    let turn = Rot::from_scaled_axis(Vec3::y() * facing * std::f64::consts::FRAC_PI_2);
    ShapeSpec {
        link,
        pose_ls: Pose::from_parts(Vec3::zeros().into(), turn),
        ..shape(&format!("finger{link}"), Some(0), Shape::HalfSpace)
    }
}

fn finger_drive(coordinate: usize) -> Actuator {
    let kind = ActuatorKind::JointDrive { coordinate, stiffness: 2e3, damping: 100.0, limit: 50.0 };
    Actuator { name: format!("finger{coordinate}"), kind }
}

/// Base twists of gripper and box at the start: tumbling together, the box a little faster.
pub(crate) fn gripper_twists() -> [Twist; 2] {
    [twist([0.05, 0.1, -0.03], [0.0; 3]), twist([0.06, 0.1, -0.02], [0.03, 0.01, 0.005])]
}

/// Fingers a millimetre off the box and closing, everything else at rest.
pub(crate) fn place_gripper(world: &mut World) {
    let state = world.state_mut();
    state.bases[1] = Pose::translation(0.0, 0.0, 0.3);
    state.q[..2].fill(0.029);
    state.commands.fill(Command { position: 0.04, ..Command::default() });
}

/// Fingers closing on a box that tumbles with the gripper.
pub(crate) fn start_gripper(world: &mut World) {
    place_gripper(world);
    world.set_base_twists(&gripper_twists());
}

/// The gripper's world at its start.
pub(crate) fn gripper(setup: &Setup) -> World {
    let mut world = world(gripper_spec(setup));
    start_gripper(&mut world);
    world
}

/// The plate's world at its start.
pub(crate) fn box_hits_plate(setup: &Setup) -> World {
    let mut world = world(box_hits_plate_spec(setup));
    start_box_hits_plate(&mut world);
    world
}

/// The free-floating arm with a drive on every joint.
pub(crate) fn driven_arm(setup: &Setup) -> World {
    let mut spec = spec(vec![(arm7(), Base::Free)], setup);
    spec.actuators = (0..7)
        .map(|coordinate| {
            let kind = ActuatorKind::JointDrive { coordinate, stiffness: 40.0, damping: 8.0, limit: 30.0 };
            Actuator { name: format!("drive{coordinate}"), kind }
        })
        .collect();
    let mut world = world(spec);
    world.set_base_twists(&[twist([0.01, -0.02, 0.015], [0.002, 0.001, -0.003])]);
    world
}

/// A ball of 1 kg, its lowest point `gap` above the half-space z < 0 (its origin there), moving at `speed` along z.
pub(crate) fn flying_ball(normal: Normal, gap: f64, speed: f64, setup: &Setup) -> World {
    let ball = robot(vec![link("ball", 1.0, Vec3::zeros(), Vec3::repeat(4e-3))], Vec::new());
    let mut spec = spec(vec![(ball, Base::Free)], setup);
    let floor = shape("floor", None, Shape::HalfSpace);
    let pose_ls = Pose::translation(0.0, 0.0, -0.1);
    spec.shapes = vec![ShapeSpec { pose_ls, ..floor }, shape("ball", Some(0), Shape::Ball { radius: 0.1 })];
    spec.pairs = vec![([0, 1], PairLaw::new(normal, None))];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, gap);
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, speed])]);
    world
}

/// The usual block without gravity, flat, its lower face `gap` above the half-space, moving at `speed` along z.
pub(crate) fn flying_block(normal: Normal, gap: f64, speed: f64, setup: &Setup) -> World {
    let half = Vec3::from(BLOCK);
    let mut spec = spec(vec![(block(1.0, half), Base::Free)], setup);
    let cuboid = Shape::Cuboid { half_extents: half };
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("block", Some(0), cuboid)];
    spec.pairs = vec![([0, 1], PairLaw::new(normal, None))];
    let mut world = world(spec);
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, half.z + gap);
    world.set_base_twists(&[twist([0.0; 3], [0.0, 0.0, speed])]);
    world
}

const DOWN: [f64; 3] = [0.0, 0.0, -9.81];

/// The ball in gravity, `depth` deep, at rest: it swings about its equilibrium.
pub(crate) fn pressed_ball(normal: Normal, depth: f64, setup: &Setup) -> World {
    flying_ball(normal, -depth, 0.0, &setup.gravity(DOWN.into()))
}

/// The ball in gravity, dropped from `gap`.
pub(crate) fn bouncing_ball(normal: Normal, gap: f64, setup: &Setup) -> World {
    flying_ball(normal, gap, 0.0, &setup.gravity(DOWN.into()))
}

/// A block of 1 kg that cannot turn, at rest in z on one point, moving at `speed` along x.
pub(crate) fn sliding_block(law: PairLaw, speed: f64, setup: &Setup) -> World {
    let base = Base::Only([false, false, false, true, false, true]);
    let tree = robot(vec![link("block", 1.0, Vec3::zeros(), Vec3::repeat(4e-3))], Vec::new());
    let mut spec = spec(vec![(tree, base)], &setup.gravity(DOWN.into()));
    spec.shapes = vec![shape("floor", None, Shape::HalfSpace), shape("foot", Some(0), Shape::Ball { radius: 0.1 })];
    spec.pairs = vec![([0, 1], law)];
    let mut world = world(spec);
    let NormalLaw::SpringDamper { stiffness, .. } = law.normal.law else { panic!("a linear law") };
    world.state_mut().bases[0] = Pose::translation(0.0, 0.0, 0.1 - 9.81 / stiffness);
    world.set_base_twists(&[twist([0.0; 3], [speed, 0.0, 0.0])]);
    world
}

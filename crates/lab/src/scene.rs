//! Bodies and laws that several experiments share.
//!
//! | builder | is |
//! | --- | --- |
//! | [`box_robot`], [`ball_robot`], [`cylinder_robot`] | one link with its mass and its look |
//! | [`gantry_robot`] | a block on massless carriages that slide along x, y and z of a fixed frame: it cannot turn |
//! | [`stiff_contact`], [`contact_law`] | normal spring-damper with bristle friction |
//! | [`block_on_slope`], [`gantry_block`] | a bench with such a body resting on the floor |

use crate::LabError;
use crate::bench::{Bench, Rig};
use contact::{Normal, NormalLaw, Shape};
use friction::{Bristle, Friction};
use multibody::{Geometry, Inertial, JointDescription, JointKind, LinkDescription, RobotDescription, Visual};
use record::Trail;
use sim::{Base, PairLaw};
use spatial::{Mat3, Pose, Vec3};

/// Standard gravity of the experiments, m/s².
pub const GRAVITY: f64 = 9.81;
/// Half the edges of the usual block of 1 kg, m.
pub const BLOCK: [f64; 3] = [0.1, 0.1, 0.05];

/// A robot of one link.
pub fn one_link(name: &str, mass: f64, moments: Vec3, geometry: Geometry) -> RobotDescription {
    RobotDescription {
        name: name.to_owned(),
        file: format!("{name} (built in)").into(),
        links: vec![link(name, mass, moments, Some(geometry))],
        joints: Vec::new(),
    }
}

/// A box of uniform density; half edges in m.
pub fn box_robot(mass: f64, half: [f64; 3]) -> RobotDescription {
    one_link("block", mass, box_moments(mass, half), Geometry::Box { size: 2.0 * Vec3::from(half) })
}

/// A ball of uniform density.
pub fn ball_robot(mass: f64, radius: f64) -> RobotDescription {
    one_link("ball", mass, Vec3::repeat(0.4 * mass * radius * radius), Geometry::Sphere { radius })
}

/// A cylinder of uniform density along z; full length.
pub fn cylinder_robot(mass: f64, radius: f64, length: f64) -> RobotDescription {
    let across = mass * (3.0 * radius * radius + length * length) / 12.0;
    let moments = Vec3::new(across, across, 0.5 * mass * radius * radius);
    one_link("cylinder", mass, moments, Geometry::Cylinder { radius, length })
}

/// Principal moments of a box, kg·m².
pub fn box_moments(mass: f64, half: [f64; 3]) -> Vec3 {
    let [x, y, z] = half.map(|l| l * l);
    mass / 3.0 * Vec3::new(y + z, x + z, x + y)
}

/// A link with its centre of mass at its origin and at most one visible shape; massless where `mass` is zero.
pub fn link(name: &str, mass: f64, moments: Vec3, geometry: Option<Geometry>) -> LinkDescription {
    let tensor_com = Mat3::from_diagonal(&moments);
    let visual = |geometry| Visual {
        name: format!("{name}_visual"),
        pose_ls: Pose::identity(),
        geometry,
        rgba: Some([0.16, 0.45, 0.70, 1.0]),
    };
    LinkDescription {
        name: name.to_owned(),
        inertial: (mass > 0.0).then(|| Inertial { mass, com: Vec3::zeros(), tensor_com }),
        visuals: geometry.map(visual).into_iter().collect(),
        collisions: Vec::new(),
    }
}

/// A joint at the parent's origin without limits or friction.
pub fn joint(name: &str, parent: usize, axis: Vec3, kind: JointKind) -> JointDescription {
    JointDescription {
        name: name.to_owned(),
        kind,
        parent,
        pose_pj: Pose::identity(),
        axis,
        position_limits: None,
        effort_limit: f64::INFINITY,
        velocity_limit: f64::INFINITY,
        damping: 0.0,
        friction: 0.0,
        mimic: None,
    }
}

/// Coordinates and link of [`gantry_robot`]: along x, along y, the lift z; the block is link 3.
pub const GANTRY: [usize; 3] = [0, 1, 2];
/// Link of the block on the gantry.
pub const GANTRY_BLOCK: usize = 3;

/// A block on three massless carriages: it slides along x, y and z of a fixed frame and cannot turn, so that all its
/// corners press alike whatever pulls it.
pub fn gantry_robot(mass: f64, half: [f64; 3]) -> RobotDescription {
    let bare = |name| link(name, 0.0, Vec3::zeros(), None);
    let block = link("block", mass, box_moments(mass, half), Some(Geometry::Box { size: 2.0 * Vec3::from(half) }));
    let slide = |name, parent, axis| joint(name, parent, axis, JointKind::Prismatic);
    RobotDescription {
        name: "gantry".to_owned(),
        file: "gantry (built in)".into(),
        links: vec![bare("frame"), bare("carriage_x"), bare("carriage_y"), block],
        joints: vec![slide("along_x", 0, Vec3::x()), slide("along_y", 1, Vec3::y()), slide("lift", 2, Vec3::z())],
    }
}

/// Spring-damper contact (N/m and N·s/m per point) with friction.
pub fn contact_law(stiffness: f64, damping: f64, friction: impl Into<Friction>) -> PairLaw {
    PairLaw::new(Normal::new(NormalLaw::SpringDamper { stiffness, damping }), Some(friction.into()))
}

/// 1e6 N/m per point in the normal and in the bristle, one level: rigid for a block of 1 kg, and far beyond what an
/// explicit method holds at 1 ms.
pub fn stiff_contact(mu: f64) -> PairLaw {
    let bristle = Bristle { mu_static: mu, mu_kinetic: mu, stiffness: 1e6, damping: 100.0, ..Bristle::default() };
    contact_law(1e6, 1e3, bristle)
}

/// A free block of 1 kg on the floor, in the field that a slope of `angle` (rad, falling towards +x) would give.
pub fn block_on_slope(experiment: &'static str, angle: f64, law: PairLaw, step: f64) -> Result<Rig, LabError> {
    let gravity = [GRAVITY * angle.sin(), 0.0, -GRAVITY * angle.cos()];
    let mut bench = Bench::new(experiment, step).gravity(gravity);
    bench.add_floor();
    let block = bench.add_vehicle("block", &box_robot(1.0, BLOCK), Base::Free);
    bench.add_shape(Some(block), 0, Shape::Cuboid { half_extents: BLOCK.into() });
    bench.pair("floor", "block", law);
    let mut rig = bench.build()?;
    rig.place(block, [0.0, 0.0, BLOCK[2] - 1e-9], [0.0; 3]);
    Ok(rig)
}

/// A bench with a block on the gantry that rests with four corners on the floor; springs or efforts are to be added on the
/// coordinates [`GANTRY`].
pub fn gantry_block(experiment: &'static str, mass: f64, law: PairLaw, step: f64) -> Bench {
    let mut bench = Bench::new(experiment, step).gravity([0.0, 0.0, -GRAVITY]);
    bench.add_floor();
    let gantry = bench.add_vehicle("block", &gantry_robot(mass, BLOCK), Base::Fixed);
    let point_l = Vec3::new(0.0, 0.0, -BLOCK[2]);
    bench.scene.trails.push(Trail { name: "block".to_owned(), link: GANTRY_BLOCK, point_l });
    bench.add_shape(Some(gantry), GANTRY_BLOCK, Shape::Cuboid { half_extents: BLOCK.into() });
    bench.pair("floor", "block", law);
    bench
}

/// Lowers the block of a [`gantry_block`] to where four springs of `stiffness` (N/m) carry its weight.
pub fn settle_gantry(rig: &mut Rig, mass: f64, stiffness: f64) {
    rig.world.state_mut().q[GANTRY[2]] = BLOCK[2] - mass * GRAVITY / (4.0 * stiffness);
    rig.world.refresh();
}

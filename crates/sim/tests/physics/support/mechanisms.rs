//! Small worlds with mechanisms.

use super::{Setup, block, spec, twist, world};
use sim::{Anchor, Base, Bushing, Energy, Mechanism, MechanismKind, ModelSpec, Strength, Strut, Weld, World};
use spatial::{Pose, Rot, Vec3};

/// Half the edges of the usual free body of 2 kg, m.
pub(crate) const HALF: [f64; 3] = [0.1, 0.15, 0.2];

/// A frame of vehicle `v`'s base.
pub(crate) fn on(vehicle: usize, pose_la: Pose) -> Anchor {
    Anchor { vehicle: Some(vehicle), link: 0, pose_la }
}

/// A point of vehicle `v`'s base.
pub(crate) fn at(vehicle: usize, x: f64, y: f64, z: f64) -> Anchor {
    on(vehicle, Pose::translation(x, y, z))
}

/// A frame of the world.
pub(crate) fn ground(pose_la: Pose) -> Anchor {
    Anchor { vehicle: None, link: 0, pose_la }
}

pub(crate) fn mechanism(name: &str, side_a: Anchor, side_b: Anchor, kind: MechanismKind) -> Mechanism {
    Mechanism { name: name.to_owned(), side_a, side_b, kind }
}

/// Two free blocks of the given masses, with mechanisms.
pub(crate) fn two_blocks_spec(masses: [f64; 2], mechanisms: Vec<Mechanism>, setup: &Setup) -> ModelSpec {
    let vehicles = masses.iter().map(|m| (block(*m, Vec3::from(HALF)), Base::Free)).collect();
    ModelSpec { mechanisms, ..spec(vehicles, setup) }
}

pub(crate) fn two_blocks(masses: [f64; 2], mechanisms: Vec<Mechanism>, setup: &Setup) -> World {
    world(two_blocks_spec(masses, mechanisms, setup))
}

/// One free block of 2 kg and what ties it to the world.
pub(crate) fn tied_block(kind: MechanismKind, setup: &Setup) -> World {
    let tie = mechanism("tie", ground(Pose::identity()), at(0, 0.0, 0.0, 0.0), kind);
    let spec = ModelSpec { mechanisms: vec![tie], ..spec(vec![(block(2.0, Vec3::from(HALF)), Base::Free)], setup) };
    world(spec)
}

/// Six struts between the base (vehicle 0, 40 kg) and a ring (vehicle 1, 4 kg) 0.3 m above: a soft-capture ring. A striker
/// of 15 kg (vehicle 2) hangs on a soft weld that stands for the first touch, off the ring's centre.
pub(crate) fn ring_spec(strut: Strut, setup: &Setup) -> ModelSpec {
    let mut mechanisms = Vec::new();
    for k in 0..6_u8 {
        let angle = |turns: f64| std::f64::consts::TAU * turns;
        let pair = f64::from(k / 2) / 3.0;
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let (low, high) = (angle(pair + 0.02 * side), angle(pair + 0.13 * side));
        let foot = at(0, 0.5 * low.cos(), 0.5 * low.sin(), 0.1);
        let head = at(1, 0.4 * high.cos(), 0.4 * high.sin(), 0.0);
        mechanisms.push(mechanism(&format!("strut{k}"), foot, head, MechanismKind::Strut(strut)));
    }
    let touch = Weld { hold: Bushing::isotropic([4e3, 40.0], [60.0, 2.0]), strength: Strength::default() };
    let [_, ring, striker] = ring_places();
    let on_striker = striker.inverse() * ring * Pose::translation(0.3, 0.1, 0.0);
    mechanisms.push(mechanism("touch", at(1, 0.3, 0.1, 0.0), on(2, on_striker), MechanismKind::Weld(touch)));
    let vehicles = vec![
        (block(40.0, Vec3::new(0.6, 0.6, 0.1)), Base::Free),
        (block(4.0, Vec3::new(0.4, 0.4, 0.02)), Base::Free),
        (block(15.0, Vec3::new(0.3, 0.3, 0.3)), Base::Free),
    ];
    ModelSpec { mechanisms, ..spec(vehicles, setup) }
}

fn ring_places() -> [Pose; 3] {
    let tilt = Rot::from_scaled_axis(Vec3::new(0.1, -0.05, 0.2));
    let striker = Pose::from_parts(Vec3::new(0.25, 0.1, 0.75).into(), tilt);
    [Pose::identity(), Pose::translation(0.0, 0.0, 0.4), striker]
}

/// Base, ring and striker at the start: the striker comes down, turning.
pub(crate) fn start_ring(world: &mut World) {
    world.state_mut().bases.copy_from_slice(&ring_places());
    let still = twist([0.0; 3], [0.0; 3]);
    world.set_base_twists(&[still, still, twist([0.05, 0.02, -0.1], [0.02, -0.05, -0.3])]);
}

/// The ring's world at its start.
pub(crate) fn struck_ring(strut: Strut, setup: &Setup) -> World {
    let mut world = world(ring_spec(strut, setup));
    start_ring(&mut world);
    world
}

/// Length of each strut where the world stands.
pub(crate) fn strut_length(world: &World) -> f64 {
    world.mechanisms().next().unwrap().deformation[0]
}

/// Kinetic and stored energy and all that mechanisms have dissipated, less what a motor gave: constant where the
/// integrator damps nothing.
pub(crate) fn calc_total(world: &World) -> f64 {
    let (energy, account) = (Energy::of(world), world.state().account);
    energy.kinetic + energy.mechanism + account.mechanism_loss - account.pull_in_work
}

//! Force sensors: what touches a part, what a mechanism does, and what passes through a joint.

use multibody::SlidingPoint;
use sim::{EffectKind, JointEffect, JointLaw, Model, Vehicle, World};
use spatial::{Pose, Vec3, Wrench};

/// A force sensor of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceGauge {
    /// Sum of the contact forces on one shape, or on every shape of a link.
    Contact {
        /// Global body.
        body: usize,
        /// The collider, where only one counts.
        collider: Option<usize>,
        /// Vehicle that carries the sensor.
        vehicle: usize,
        /// Link that carries it.
        link: usize,
        /// The sensor in that link.
        pose_ls: Pose,
        /// The elastic mount of the part, behind which the sensor sits.
        mount: Option<Mount>,
    },
    /// What a link's parent does to it through the joint between them, link axes, moment about the link's origin.
    Joint {
        /// Vehicle.
        vehicle: usize,
        /// The link beyond the joint.
        link: usize,
    },
    /// What a mechanism does to its side b (or a), W axes, moment about the point of action.
    Mechanism {
        /// Index of the mechanism.
        index: usize,
        /// 1 on side b, −1 on side a.
        sign: f64,
    },
}

/// A part on an elastic mount: what reaches a sensor behind it is k u + d u̇, and the moment about the tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mount {
    /// First of the tip's three sliding coordinates, an index into the world's `v`.
    pub coordinate: usize,
    /// Spring, N/m.
    pub stiffness: f64,
    /// Damper, N·s/m.
    pub damping: f64,
    /// Vehicle of the tip.
    pub vehicle: usize,
    /// The tip's link.
    pub link: usize,
}

impl Mount {
    /// Every mount of a model.
    pub fn all(model: &Model) -> Vec<Self> {
        let points = |(v, vehicle): (usize, &Vehicle)| -> Vec<Self> {
            vehicle.tree.sliding_points.iter().map(|point| Self::at(model, v, *point)).collect()
        };
        model.vehicles.iter().enumerate().flat_map(points).collect()
    }

    /// Mass of the tip, kg.
    pub fn mass(&self, model: &Model) -> f64 {
        let tree = &model.vehicles[self.vehicle].tree;
        tree.bodies[tree.links[self.link].body].inertia.mass
    }

    /// At which the tip swings on its spring, rad/s.
    pub fn rate(&self, model: &Model) -> f64 {
        (self.stiffness / self.mass(model)).sqrt()
    }

    /// The mount that carries a global body; none where it is not on one.
    pub(super) fn of(model: &Model, body: usize) -> Option<Self> {
        let &(vehicle, local) = model.owners.get(body)?;
        Some(Self::at(model, vehicle, model.vehicles[vehicle].tree.sliding_point(local)?))
    }

    /// The mount of a sliding point: its springs and dampers are the effects on its first coordinate.
    fn at(model: &Model, vehicle: usize, point: SlidingPoint) -> Self {
        let own = &model.vehicles[vehicle];
        let coordinate = own.v0 + own.tree.joints[point.joint].v_index;
        let mut mount = Self { coordinate, stiffness: 0.0, damping: 0.0, vehicle, link: point.link };
        for effect in model.effects() {
            match effect.kind {
                EffectKind::Joint(JointEffect { coordinate: c, law }) if c == coordinate => match law {
                    JointLaw::Cable { stiffness, .. } => mount.stiffness += stiffness,
                    JointLaw::Viscous { damping } => mount.damping += damping,
                    _ => {}
                },
                _ => {}
            }
        }
        mount
    }

    /// What the mount does to the body that carries it, W axes, moment about `origin`; `touch` is what touches the tip, about its origin.
    fn calc_wrench(&self, world: &World, touch: &Wrench, origin: &Vec3) -> Wrench {
        let (frame, state) = (world.link_frame(self.vehicle, self.link), world.state());
        let along = |k: usize| {
            let i = self.coordinate + k;
            self.stiffness * state.q[world.model().coordinates[i].q_index] + self.damping * state.v[i]
        };
        let force = frame.rot * Vec3::new(along(0), along(1), along(2));
        Wrench::new(touch.moment + (frame.pos - origin).cross(&force), force)
    }
}

impl ForceGauge {
    /// Force and moment, in the axes and about the origin of the sensor.
    pub(super) fn calc_wrench(&self, world: &World) -> Wrench {
        match self {
            Self::Mechanism { index, sign } => {
                world.mechanisms().nth(*index).map_or(Wrench::default(), |m| m.wrench_w * *sign)
            }
            Self::Joint { vehicle, link } => {
                let Some(wrench) = world.calc_joint_wrench(*vehicle, *link) else {
                    return Wrench::new(Vec3::repeat(f64::NAN), Vec3::repeat(f64::NAN));
                };
                let rot = world.link_frame(*vehicle, *link).rot;
                Wrench::new(rot.tr_mul(&wrench.moment), rot.tr_mul(&wrench.force))
            }
            Self::Contact { body, collider, vehicle, link, pose_ls, mount } => {
                let frame = world.link_frame(*vehicle, *link);
                let origin = frame.point(&pose_ls.translation.vector);
                let about = |point: &Vec3| sum_contact(world, (*body, *collider), point);
                let sum = mount.map_or_else(
                    || about(&origin),
                    |m| m.calc_wrench(world, &about(&world.link_frame(m.vehicle, m.link).pos), &origin),
                );
                let into = |v: &Vec3| pose_ls.rotation.inverse() * frame.rot.tr_mul(v);
                Wrench::new(into(&sum.moment), into(&sum.force))
            }
        }
    }
}

/// Forces of the touching points on a part, moments about `origin`, W axes.
fn sum_contact(world: &World, (body, collider): (usize, Option<usize>), origin: &Vec3) -> Wrench {
    let model = world.model();
    let mut sum = Wrench::default();
    for touch in world.touches() {
        let [a, b] = model.scene.pairs()[touch.pair];
        let sign = f64::from(i8::from(counts(model, b, body, collider)) - i8::from(counts(model, a, body, collider)));
        if sign != 0.0 {
            sum += Wrench::from_force_at(sign * touch.force_w, &(touch.point_w - origin));
        }
    }
    sum
}

fn counts(model: &Model, touching: usize, body: usize, collider: Option<usize>) -> bool {
    collider.map_or_else(|| model.scene.colliders()[touching].body == body, |only| only == touching)
}

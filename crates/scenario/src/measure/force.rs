//! Force sensors: what touches a part, and what a mechanism does.

use sim::{Model, World};
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
    },
    /// What a mechanism does to its side b (or a), W axes, moment about the point of action.
    Mechanism {
        /// Index of the mechanism.
        index: usize,
        /// 1 on side b, −1 on side a.
        sign: f64,
    },
}

impl ForceGauge {
    /// Force and moment, in the axes and about the origin of the sensor.
    pub(super) fn calc_wrench(&self, world: &World) -> Wrench {
        match self {
            Self::Mechanism { index, sign } => {
                world.mechanisms().nth(*index).map_or(Wrench::default(), |m| m.wrench_w * *sign)
            }
            Self::Contact { body, collider, vehicle, link, pose_ls } => {
                let frame = world.link_frame(*vehicle, *link);
                let origin = frame.point(&pose_ls.translation.vector);
                let sum = sum_contact(world, (*body, *collider), &origin);
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

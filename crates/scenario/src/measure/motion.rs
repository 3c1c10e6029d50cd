//! Sensors that ride on a link: what an inertial measurement unit feels, and where a camera sees another link.
//!
//!   gyro = Rᵀ ω,     accelerometer = Rᵀ (a + α × r + ω × (ω × r) − g(p)),     R: the sensor's axes in W, r: from the link's origin to the sensor
//!
//! with the link's acceleration a, α from [`World::calc_link_acceleration`] and the field g of [`sim::Model::calc_field`].

use sim::World;
use spatial::{Frame, Pose, Rot, Vec3};

/// A frame fixed to a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// Vehicle.
    pub vehicle: usize,
    /// Link.
    pub link: usize,
    /// The frame in that link.
    pub pose_ls: Pose,
}

impl Seat {
    fn frame(&self, world: &World) -> Frame {
        &world.link_frame(self.vehicle, self.link) * &Frame::from(&self.pose_ls)
    }

    /// Its pose in W.
    pub fn calc_pose(&self, world: &World) -> Pose {
        self.frame(world).to_pose()
    }

    /// Angular velocity in its axes, rad/s.
    pub fn calc_rate(&self, world: &World) -> Vec3 {
        self.frame(world).rot.tr_mul(&world.link_twist(self.vehicle, self.link).ang)
    }

    /// Specific force in its axes, m/s²; not a number where the world would diverge at once.
    pub fn calc_specific_force(&self, world: &World) -> Vec3 {
        let Some(rate) = world.calc_link_acceleration(self.vehicle, self.link) else { return Vec3::repeat(f64::NAN) };
        let (frame, spin) = (self.frame(world), world.link_twist(self.vehicle, self.link).ang);
        let arm = frame.pos - world.link_frame(self.vehicle, self.link).pos;
        let acceleration = rate.at(&arm) + spin.cross(&spin.cross(&arm));
        frame.rot.tr_mul(&(acceleration - world.model().calc_field(world.state().time, &frame.pos)))
    }
}

/// A link seen from a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Vehicle and link that are seen.
    pub of: (usize, usize),
    /// The camera.
    pub from: Seat,
}

impl Sight {
    /// Origin of what is seen in the camera's axes, m.
    pub fn calc_position(&self, world: &World) -> Vec3 {
        let camera = self.from.frame(world);
        camera.rot.tr_mul(&(world.link_frame(self.of.0, self.of.1).pos - camera.pos))
    }

    /// Axes of what is seen in those of the camera.
    pub fn calc_orientation(&self, world: &World) -> Rot {
        let (camera, seen) = (self.from.frame(world), world.link_frame(self.of.0, self.of.1));
        camera.to_pose().rotation.inverse() * seen.to_pose().rotation
    }
}

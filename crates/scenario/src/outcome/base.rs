//! What a host feels: how far the base of the vehicle that catches, or is docked to, is turned and pushed.

use super::Metric;
use sim::World;
use spatial::{Pose, Rot, Vec3, log_rotation};

/// Follows one vehicle's base against the uniform motion that it had at the start.
#[derive(Clone, Debug)]
pub(super) struct BaseWatch {
    vehicle: usize,
    start: Pose,
    rate_w: Vec3,
    velocity_w: Vec3,
    turn: f64,
    rate_change: f64,
    speed_change: f64,
}

impl BaseWatch {
    pub(super) fn new(world: &World, vehicle: usize) -> Self {
        let twist = world.kinematics(vehicle).vel[0];
        let start = world.state().bases[vehicle];
        Self {
            vehicle,
            start,
            rate_w: twist.ang,
            velocity_w: twist.lin,
            turn: 0.0,
            rate_change: 0.0,
            speed_change: 0.0,
        }
    }

    pub(super) fn observe(&mut self, world: &World) {
        let twist = world.kinematics(self.vehicle).vel[0];
        let expected = Rot::from_scaled_axis(self.rate_w * world.state().time) * self.start.rotation;
        let turn = log_rotation(&(world.state().bases[self.vehicle].rotation * expected.inverse())).norm();
        self.turn = self.turn.max(turn);
        self.rate_change = self.rate_change.max((twist.ang - self.rate_w).norm());
        self.speed_change = self.speed_change.max((twist.lin - self.velocity_w).norm());
    }

    pub(super) fn add_metrics(&self, metrics: &mut Vec<Metric>) {
        let mut add = |name: &'static str, value: f64, meaning| {
            metrics.push(Metric { name: name.into(), value: value.into(), meaning });
        };
        add(
            "base_turn_deg",
            self.turn.to_degrees(),
            "largest turn of the host's base (servicer, or the port's vehicle) off its first motion",
        );
        add("base_rate_change_deg_per_s", self.rate_change.to_degrees(), "largest change of its angular rate");
        add("base_speed_change_m_per_s", self.speed_change, "largest change of its base's velocity");
    }
}

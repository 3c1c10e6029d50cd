//! What a channel of a recording would read in the simulated world.
//!
//! A [`Gauge`] reads one quantity as a whole (`body.slider.position`, `sensor.probe.force`, `joint.elbow.velocity`), a
//! [`Meter`] one channel (`body.slider.position.x`) with the faults of its sensor. Names are those of recordings: joints, links
//! and sensors by their own name, where several vehicles have it as `vehicle/name`; a vehicle's name stands for its base link.
//!
//! | channel | reads |
//! | --- | --- |
//! | `joint.….position`, `.velocity` | encoder and tachometer: the motor side where the joint's gear yields, rad, rad/s or m, m/s |
//! | `joint.….link_position`, `.link_velocity` | the link side, which is where the joint stands; without such a gear the same |
//! | `joint.….effort` | effort that acted in the last step, N·m or N |
//! | `body.….position`, `.linear_velocity` | the link frame's origin, W axes |
//! | `body.….orientation`, `.angular_velocity` | link axes in W; rate in link axes, as a gyro |
//! | `sensor.….force`, `.torque` | see [`crate::spec::SensorKind`]: contact-force, mechanism-force |
//! | `sensor.….angular_velocity`, `.specific_force` | of kind imu: gyro and accelerometer, its axes |
//! | `sensor.….position`, `.orientation` | of kind pose, seen from a link: the other link in the camera's axes |
//! | `drive.….position`, `.angle` | where the drive is, in the axes of its frame |
//! | `actuator.….command` | what the controller asked for |
//!
//! A contact force is that of the instant only after [`World::refresh_touches`]; without it, that of the last step.

mod force;
mod motion;
mod resolve;
mod sensor;

pub use force::{ForceGauge, Mount};
pub use motion::{Seat, Sight};
pub(crate) use resolve::{joints, links};
pub use sensor::SensorModel;
pub(crate) use sensor::{SensorEntry, find_fault};

use crate::spec::Scenario;
use sim::{ActuatorKind, DriveAxis, Model, World};
use spatial::{Rot, Vec3};

/// A channel that means nothing in a scenario.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("channel \"{channel}\": {fault}")]
pub struct MeasureError {
    /// The channel.
    pub channel: String,
    /// What is wrong with it, and the way out.
    pub fault: String,
}

/// What a gauge reads at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// A number.
    Scalar(f64),
    /// A vector.
    Vector(Vec3),
    /// An orientation: rotates body vectors into W.
    Rotation(Rot),
}

/// A quantity of the world that sensors read as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    quantity: Quantity,
}

/// What is read; joints by their index into `v`, links by vehicle and link, drives and actuators by their index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// Motor side of a joint, rad or m.
    JointPosition(usize),
    /// Motor side of a joint, rad/s or m/s.
    JointVelocity(usize),
    /// Link side of a joint, rad or m.
    JointLinkPosition(usize),
    /// Link side of a joint, rad/s or m/s.
    JointLinkVelocity(usize),
    /// Effort of the last step, N·m or N.
    JointEffort(usize),
    /// Origin of a link in W, m.
    Position(usize, usize),
    /// Link axes in W.
    Orientation(usize, usize),
    /// Of a link's origin, W axes, m/s.
    LinearVelocity(usize, usize),
    /// Of a link, link axes, rad/s.
    AngularVelocity(usize, usize),
    /// Of a force sensor, N.
    Force(ForceGauge),
    /// Of a force sensor, N·m.
    Torque(ForceGauge),
    /// Of a gyro, its axes, rad/s.
    SensorRate(Seat),
    /// Of an accelerometer, its axes, m/s².
    SpecificForce(Seat),
    /// Of a camera, its axes, m.
    SeenPosition(Sight),
    /// Of a camera: axes of what it sees in its own.
    SeenOrientation(Sight),
    /// Displacement of a drive, axes of its frame, m.
    DrivePosition(usize),
    /// Turn of a drive, rad.
    DriveAngle(usize),
    /// What a controller asked an actuator for.
    Command(usize),
}

impl Quantity {
    /// The joint whose place or speed it is, as an index into `v`.
    pub fn motion_of(self) -> Option<usize> {
        use Quantity::{JointLinkPosition, JointLinkVelocity, JointPosition, JointVelocity};
        match self {
            JointPosition(v) | JointVelocity(v) | JointLinkPosition(v) | JointLinkVelocity(v) => Some(v),
            _ => None,
        }
    }

    /// Whether it is of a joint, by one number.
    pub fn is_joint(self) -> bool {
        use Quantity::{JointEffort, JointLinkPosition, JointLinkVelocity, JointPosition, JointVelocity};
        matches!(
            self,
            JointPosition(_) | JointVelocity(_) | JointLinkPosition(_) | JointLinkVelocity(_) | JointEffort(_)
        )
    }

    /// Whether it is an orientation.
    pub fn is_orientation(self) -> bool {
        matches!(self, Self::Orientation(..) | Self::SeenOrientation(_))
    }
}

impl Gauge {
    /// The quantity of that name, `body.slider.position`.
    pub fn resolve(scenario: &Scenario, model: &Model, name: &str) -> Result<Self, MeasureError> {
        let refuse = |fault: String| MeasureError { channel: name.to_owned(), fault };
        resolve::quantity(scenario, model, name).map(|quantity| Self { quantity }).map_err(refuse)
    }

    /// What it reads.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Its present value, without faults of a sensor.
    #[inline]
    pub fn read(&self, world: &World) -> Reading {
        let drive = |k: usize| (&world.model().drives[k], world.state().time);
        match self.quantity {
            Quantity::JointPosition(v) => Reading::Scalar(world.motor_side(v).0),
            Quantity::JointVelocity(v) => Reading::Scalar(world.motor_side(v).1),
            Quantity::JointLinkPosition(v) => Reading::Scalar(world.state().q[world.model().coordinates[v].q_index]),
            Quantity::JointLinkVelocity(v) => Reading::Scalar(world.state().v[v]),
            Quantity::JointEffort(v) => Reading::Scalar(world.effort(v)),
            Quantity::Position(v, l) => Reading::Vector(world.link_frame(v, l).pos),
            Quantity::Orientation(v, l) => Reading::Rotation(world.link_frame(v, l).to_pose().rotation),
            Quantity::LinearVelocity(v, l) => Reading::Vector(world.link_twist(v, l).lin),
            Quantity::AngularVelocity(v, l) => {
                Reading::Vector(world.link_frame(v, l).rot.tr_mul(&world.link_twist(v, l).ang))
            }
            Quantity::Force(gauge) => Reading::Vector(gauge.calc_wrench(world).force),
            Quantity::Torque(gauge) => Reading::Vector(gauge.calc_wrench(world).moment),
            Quantity::SensorRate(seat) => Reading::Vector(seat.calc_rate(world)),
            Quantity::SpecificForce(seat) => Reading::Vector(seat.calc_specific_force(world)),
            Quantity::SeenPosition(sight) => Reading::Vector(sight.calc_position(world)),
            Quantity::SeenOrientation(sight) => Reading::Rotation(sight.calc_orientation(world)),
            Quantity::DrivePosition(k) => {
                let (drive, now) = drive(k);
                Reading::Vector(drive.calc_displacement(now))
            }
            Quantity::DriveAngle(k) => {
                let (drive, now) = drive(k);
                Reading::Scalar(drive.eval(DriveAxis::AboutZ, now).position)
            }
            Quantity::Command(a) => Reading::Scalar(read_command(world, a)),
        }
    }

    /// Whether its value is that of the instant only after [`World::refresh_touches`].
    pub fn reads_contact(&self) -> bool {
        let of_contact = |gauge: &ForceGauge| matches!(gauge, ForceGauge::Contact { .. });
        matches!(&self.quantity, Quantity::Force(g) | Quantity::Torque(g) if of_contact(g))
    }

    /// Whether it reads zero as long as nothing touches: a force sensor right behind its part, not behind an elastic mount.
    pub fn rests_untouched(&self) -> bool {
        self.reads_contact() && !self.is_behind_mount()
    }

    /// Whether it is a force sensor behind an elastic mount: untouched it reads zero only once that has come to rest.
    pub fn is_behind_mount(&self) -> bool {
        let is_behind = |gauge: &ForceGauge| matches!(gauge, ForceGauge::Contact { mount: Some(_), .. });
        matches!(&self.quantity, Quantity::Force(g) | Quantity::Torque(g) if is_behind(g))
    }
}

fn read_command(world: &World, actuator: usize) -> f64 {
    let command = &world.state().commands[actuator];
    match world.model().actuators[actuator].kind {
        ActuatorKind::JointDrive { stiffness, .. } if stiffness > 0.0 => command.position,
        ActuatorKind::JointDrive { .. } => command.velocity,
        _ => command.effort,
    }
}

/// One channel, as its sensor reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meter {
    gauge: Gauge,
    sensor: SensorModel,
    component: usize,
}

impl Meter {
    /// The channel of that name, `body.slider.position.x`, with the faults that the scenario's effects give its sensor.
    pub fn resolve(scenario: &Scenario, model: &Model, channel: &str) -> Result<Self, MeasureError> {
        let (name, component) = resolve::split(channel);
        let gauge = Gauge::resolve(scenario, model, name)?;
        let sensor = SensorModel::late(scenario, model, name);
        match resolve::component(gauge.is_scalar(), gauge.quantity.is_orientation(), component) {
            Some(component) => Ok(Self { gauge, sensor, component }),
            None => Err(MeasureError {
                channel: channel.to_owned(),
                fault: "needs a component: .x, .y or .z; .w too of an orientation; none of a number".to_owned(),
            }),
        }
    }

    /// What the sensor makes of the world as it is now. Who wants its delay reads the world [`Self::delay`] earlier.
    #[inline]
    pub fn read(&self, world: &World) -> f64 {
        match self.sensor.apply(&self.gauge.read(world)) {
            Reading::Scalar(x) => x,
            Reading::Vector(v) => v[self.component],
            Reading::Rotation(q) => [q.i, q.j, q.k, q.w][self.component],
        }
    }

    /// Age of what it reads, s.
    pub fn delay(&self) -> f64 {
        self.sensor.delay
    }

    /// The quantity behind it.
    pub fn gauge(&self) -> Gauge {
        self.gauge
    }
}

impl Gauge {
    /// Whether it reads a number.
    pub fn is_scalar(&self) -> bool {
        self.quantity.is_joint() || matches!(self.quantity, Quantity::DriveAngle(_) | Quantity::Command(_))
    }
}

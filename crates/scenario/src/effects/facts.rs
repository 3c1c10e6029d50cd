//! What the nominal model and the recordings offer to a definition that asks where its effect could act: places and nominal numbers.

use crate::measure::Quantity;
use spatial::{Mat3, Vec3};

/// A joint with one coordinate.
#[derive(Clone, Debug, Default)]
pub struct JointFact {
    /// Its name.
    pub name: String,
    /// Index into `v`.
    pub coordinate: usize,
    /// Reflected rotor inertia, kg·m² or kg.
    pub armature: f64,
    /// Largest command, N·m or N; zero where none was recorded.
    pub largest_command: f64,
    /// How far its readings go, rad or m; zero where nothing reads its place.
    pub travel: f64,
    /// Orders at which what the model leaves swings over its place, 1/rad or 1/m; none before that was looked at.
    pub orders: Vec<f64>,
}

/// An actuator: the drive of a joint, a thruster, or all thrusters together.
#[derive(Clone, Debug)]
pub struct ActuatorFact {
    /// Its place.
    pub place: String,
    /// Largest command, N·m or N; zero where commands are only on and off.
    pub largest_command: f64,
    /// Whether it pushes along an axis of its own.
    pub is_thruster: bool,
}

/// A body: a base that moves, or the link of an arm.
#[derive(Clone, Debug)]
pub struct BodyFact {
    /// Its link.
    pub name: String,
    /// Index of its vehicle.
    pub vehicle: usize,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass, link frame, m.
    pub com: Vec3,
    /// About the centre of mass, kg·m².
    pub inertia: Mat3,
    /// The base's free components; all false for the link of an arm on a fixed base.
    pub mask: [bool; 6],
    /// Whether it is a vehicle's base.
    pub is_base: bool,
    /// Whether joints move it.
    pub is_on_joints: bool,
    /// Whether nothing but its own inertia moves it: no thruster, no contact, no mechanism.
    pub is_torque_free: bool,
    /// Whether a sensor reads where its vehicle is, or how fast that moves on.
    pub is_placed: bool,
}

/// A contact pair.
#[derive(Clone, Debug)]
pub struct ContactFact {
    /// `probe/drogue`.
    pub name: String,
    /// Normal law: stiffness, exponent, dissipation (of a linear law its damping, N s/m).
    pub normal: Option<[f64; 3]>,
    /// Whether that is a spring and a damper, whose exponent is one whatever happens.
    pub is_linear: bool,
    /// Bristle law: level, stiffness, damping.
    pub bristle: Option<[f64; 3]>,
    /// Mass of the lighter free body, kg.
    pub mass: f64,
    /// Whether both sides can move against each other in space.
    pub has_normal_motion: bool,
    /// Displacements of its second part that change nothing: shifts along, and turns about the axes of its link.
    pub unmoved_by: [bool; 6],
}

/// A strut, bushing, latch or weld.
#[derive(Clone, Debug, Default)]
pub struct MechanismFact {
    /// Its name.
    pub name: String,
    /// Whether it has springs that a factor changes.
    pub has_springs: bool,
    /// Whether it has dampers likewise.
    pub has_dampers: bool,
}

/// A sensor.
#[derive(Clone, Debug)]
pub struct SensorFact {
    /// Channel without component.
    pub channel: String,
    /// What it measures.
    pub quantity: Quantity,
    /// Components.
    pub axes: Vec<usize>,
    /// Noise, its unit.
    pub sigma: f64,
}

/// What is around a place.
#[derive(Clone, Copy, Debug)]
pub struct Survey<'a> {
    /// Joints with one coordinate.
    pub joints: &'a [JointFact],
    /// Bodies.
    pub bodies: &'a [BodyFact],
    /// Contact pairs.
    pub contacts: &'a [ContactFact],
    /// Acceleration of gravity, m/s², W axes.
    pub gravity: [f64; 3],
    /// Longest run, s.
    pub duration: f64,
    /// Highest frequency that samples tell from lower ones, Hz: half the rate of the fastest sensor (Nyquist 1928).
    pub highest: f64,
    /// Frequencies at which what the model leaves swings, Hz.
    pub lines: &'a [f64],
}

impl JointFact {
    /// Its place.
    pub fn place(&self) -> String {
        format!("joint:{}", self.name)
    }
}

impl BodyFact {
    /// Its place.
    pub fn place(&self) -> String {
        format!("body:{}", self.name)
    }

    /// How far it reaches from its link's origin, m: to its centre of mass, and from there twice the radius of gyration, as far as a rod does.
    pub fn reach(&self) -> f64 {
        let gyration = if self.mass > 0.0 { (1.5 * self.mean_moment() / self.mass).max(0.0).sqrt() } else { 0.0 };
        self.com.norm() + 2.0 * gyration
    }

    /// Axes about which it can turn as a base.
    pub fn turns(&self) -> &[bool] {
        &self.mask[..3]
    }

    /// Axes along which it can move as a base.
    pub fn slides(&self) -> &[bool] {
        &self.mask[3..]
    }

    /// Axes along which something may push it: the link of an arm goes wherever its joints let it.
    pub fn shifts(&self) -> [bool; 3] {
        std::array::from_fn(|k| if self.is_base { self.mask[3 + k] } else { self.is_on_joints })
    }

    /// Axes about which something may turn it.
    pub fn twists(&self) -> [bool; 3] {
        std::array::from_fn(|k| if self.is_base { self.mask[k] } else { self.is_on_joints })
    }

    /// Whether it is a base that can turn.
    pub fn can_turn(&self) -> bool {
        self.is_base && self.turns().iter().any(|m| *m)
    }

    /// Whether it is a base that something pushes along as well: what moves in it shows by its weight, not by its moment alone.
    pub fn is_pushed(&self) -> bool {
        self.is_base && !self.is_torque_free && self.slides().iter().any(|m| *m)
    }

    /// Whether it is a base that can turn about every axis.
    pub fn tumbles(&self) -> bool {
        self.is_base && self.turns().iter().all(|m| *m)
    }

    /// Mean of the principal moments, kg·m².
    pub fn mean_moment(&self) -> f64 {
        self.inertia.trace() / 3.0
    }
}

impl ContactFact {
    /// Its place.
    pub fn place(&self) -> String {
        format!("contact:{}", self.name)
    }

    /// The numbers of its normal law, where its parts can part.
    pub fn moving_normal(&self) -> Option<[f64; 3]> {
        self.normal.filter(|_| self.has_normal_motion)
    }
}

impl MechanismFact {
    /// Its place.
    pub fn place(&self) -> String {
        format!("mechanism:{}", self.name)
    }
}

impl SensorFact {
    /// Its place.
    pub fn place(&self) -> String {
        format!("sensor:{}", self.channel)
    }

    /// Whether it reads an orientation.
    pub fn is_orientation(&self) -> bool {
        self.quantity.is_orientation()
    }
}

impl Survey<'_> {
    /// Whether a body slides under its own weight: a force on it is then a tilt, and drag is viscous friction.
    pub fn rests(&self, body: &BodyFact) -> bool {
        self.contacts.iter().any(|c| c.normal.is_none() && (c.mass - body.mass).abs() < 1e-9 * body.mass)
    }
}

//! Names of channels by the recording format: `<family>.<subject>.<quantity>[.<component>]`.

use super::units::Dimension;

/// What a channel measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// Encoder of a joint, rad or m: on the motor's side of a gear that yields.
    JointPosition,
    /// Rate of a joint, rad/s or m/s, on the same side.
    JointVelocity,
    /// Encoder on the link's side of a gear, rad or m.
    JointLinkPosition,
    /// Rate there, rad/s or m/s.
    JointLinkVelocity,
    /// What the controller asked of a drive, N·m or N; of a position or rate loop its feed-forward.
    JointEffortCommand,
    /// Reference of a position loop, rad or m.
    JointPositionCommand,
    /// Reference of a rate loop, rad/s or m/s.
    JointVelocityCommand,
    /// Torque sensor of a joint, N·m or N.
    JointEffort,
    /// Origin of a body in the world, m.
    BodyPosition,
    /// Quaternion that rotates body vectors into the world.
    BodyOrientation,
    /// Velocity of the origin in the world frame, m/s.
    BodyLinearVelocity,
    /// Gyro: angular velocity in the body frame, rad/s.
    BodyAngularVelocity,
    /// Force in the sensor's frame on the sensed side, N.
    SensorForce,
    /// Torque likewise, N·m.
    SensorTorque,
    /// Gyro in its own axes, rad/s.
    SensorAngularVelocity,
    /// Accelerometer in its own axes, m/s².
    SensorSpecificForce,
    /// Origin of what a camera sees in the camera's axes, m.
    SensorPosition,
    /// Quaternion that rotates vectors of what a camera sees into the camera's axes.
    SensorOrientation,
    /// Valve, wheel torque, gripper force.
    ActuatorCommand,
    /// Prescribed motion of a driven part, m.
    DrivePosition,
    /// Prescribed turn of a driven part about z of its motion, rad.
    DriveAngle,
}

/// Family, name of the quantity in files, number of components (1: a scalar), what it is.
const TABLE: [(&str, &str, &[&str], Quantity); 21] = [
    ("joint", "position", &[], Quantity::JointPosition),
    ("joint", "velocity", &[], Quantity::JointVelocity),
    ("joint", "link_position", &[], Quantity::JointLinkPosition),
    ("joint", "link_velocity", &[], Quantity::JointLinkVelocity),
    ("joint", "effort_command", &[], Quantity::JointEffortCommand),
    ("joint", "position_command", &[], Quantity::JointPositionCommand),
    ("joint", "velocity_command", &[], Quantity::JointVelocityCommand),
    ("joint", "effort", &[], Quantity::JointEffort),
    ("body", "position", &XYZ, Quantity::BodyPosition),
    ("body", "orientation", &WXYZ, Quantity::BodyOrientation),
    ("body", "linear_velocity", &XYZ, Quantity::BodyLinearVelocity),
    ("body", "angular_velocity", &XYZ, Quantity::BodyAngularVelocity),
    ("sensor", "force", &XYZ, Quantity::SensorForce),
    ("sensor", "torque", &XYZ, Quantity::SensorTorque),
    ("sensor", "angular_velocity", &XYZ, Quantity::SensorAngularVelocity),
    ("sensor", "specific_force", &XYZ, Quantity::SensorSpecificForce),
    ("sensor", "position", &XYZ, Quantity::SensorPosition),
    ("sensor", "orientation", &WXYZ, Quantity::SensorOrientation),
    ("actuator", "command", &[], Quantity::ActuatorCommand),
    ("drive", "position", &XYZ, Quantity::DrivePosition),
    ("drive", "angle", &[], Quantity::DriveAngle),
];
const XYZ: [&str; 3] = ["x", "y", "z"];
const WXYZ: [&str; 4] = ["w", "x", "y", "z"];

impl Quantity {
    /// Whether it may be an angle that a sensor tells up to whole turns.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::JointPosition | Self::JointLinkPosition | Self::JointPositionCommand | Self::DriveAngle)
    }

    /// What its unit may measure: a joint turns or slides.
    pub fn dimensions(self) -> &'static [Dimension] {
        match self {
            Self::JointPosition | Self::JointLinkPosition | Self::JointPositionCommand => {
                &[Dimension::Angle, Dimension::Length]
            }
            Self::JointVelocity | Self::JointLinkVelocity | Self::JointVelocityCommand => {
                &[Dimension::Rate, Dimension::Speed]
            }
            Self::JointEffortCommand | Self::JointEffort => &[Dimension::Torque, Dimension::Force],
            Self::BodyPosition | Self::DrivePosition | Self::SensorPosition => &[Dimension::Length],
            Self::DriveAngle => &[Dimension::Angle],
            Self::BodyOrientation | Self::SensorOrientation => &[Dimension::Number],
            Self::SensorSpecificForce => &[Dimension::Acceleration],
            Self::BodyLinearVelocity => &[Dimension::Speed],
            Self::BodyAngularVelocity | Self::SensorAngularVelocity => &[Dimension::Rate],
            Self::SensorForce => &[Dimension::Force],
            Self::SensorTorque => &[Dimension::Torque],
            Self::ActuatorCommand => &[Dimension::Force, Dimension::Torque, Dimension::Number],
        }
    }

    /// SI unit as printed, both where a joint may turn or slide.
    pub fn unit(self) -> &'static str {
        match self {
            Self::JointPosition | Self::JointLinkPosition | Self::JointPositionCommand => "rad|m",
            Self::JointVelocity | Self::JointLinkVelocity | Self::JointVelocityCommand => "rad/s|m/s",
            Self::JointEffortCommand | Self::JointEffort => "N·m|N",
            Self::ActuatorCommand => "",
            _ => self.dimensions()[0].si(),
        }
    }

    /// Whether it is a force: a blow makes it stand out for as little as one sample, where places and rates go on smoothly.
    pub fn is_force(self) -> bool {
        matches!(self, Self::JointEffort | Self::SensorForce | Self::SensorTorque)
    }

    /// Whether it is a quaternion.
    pub fn is_orientation(self) -> bool {
        matches!(self, Self::BodyOrientation | Self::SensorOrientation)
    }

    /// Whether it was asked for and not measured: it has no noise.
    pub fn is_command(self) -> bool {
        matches!(
            self,
            Self::JointEffortCommand | Self::JointPositionCommand | Self::JointVelocityCommand | Self::ActuatorCommand
        )
    }
}

/// A channel's name, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelName<'a> {
    /// Joint, body, sensor, actuator or drive.
    pub subject: &'a str,
    /// What is measured.
    pub quantity: Quantity,
    /// `x`, `y`, `z`, of a quaternion `w` too; empty for a scalar.
    pub component: &'a str,
    /// The name without its component.
    pub prefix: &'a str,
}

impl<'a> ChannelName<'a> {
    /// Takes a name apart; none if the format does not know it.
    pub fn parse(name: &'a str) -> Option<Self> {
        TABLE.iter().find_map(|(family, quantity, components, what)| {
            let inside = name.strip_prefix(family)?.strip_prefix('.')?;
            let (head, component) = match components.is_empty() {
                true => (inside, ""),
                false => inside.rsplit_once('.').filter(|(_, last)| components.contains(last))?,
            };
            let subject = head.strip_suffix(quantity)?.strip_suffix('.').filter(|subject| !subject.is_empty())?;
            let cut = if component.is_empty() { 0 } else { component.len() + 1 };
            Some(Self { subject, quantity: *what, component, prefix: &name[..name.len() - cut] })
        })
    }

    /// Family of the channel: `joint`, `body`, …
    pub fn family(&self) -> &'a str {
        self.prefix.split('.').next().unwrap_or_default()
    }
}

/// All forms of channel names, for messages.
pub(super) fn forms() -> Vec<String> {
    let form = |(family, quantity, components, _): &(&str, &str, &[&str], Quantity)| match components.is_empty() {
        true => format!("{family}.<{family}>.{quantity}"),
        false => format!("{family}.<{family}>.{quantity}.{{{}}}", components.join(",")),
    };
    TABLE.iter().map(form).collect()
}

/// What an unknown name was probably meant to be: each of its parts replaced by the nearest valid one.
pub(super) fn meant(name: &str) -> Option<String> {
    let parts: Vec<&str> = name.split('.').collect();
    let (first, rest) = parts.split_first()?;
    let family = super::spelling::nearest(first, TABLE.iter().map(|row| row.0))?;
    let (component, middle) = match rest.split_last()? {
        (last, before) if WXYZ.contains(&last.to_lowercase().as_str()) => (last.to_lowercase(), before),
        _ => (String::new(), rest),
    };
    let (quantity, subject) = middle.split_last()?;
    let known = TABLE.iter().filter(|row| row.0 == family && row.2.is_empty() == component.is_empty());
    let quantity = super::spelling::nearest(quantity, known.map(|row| row.1))?;
    let tail = if component.is_empty() { String::new() } else { format!(".{component}") };
    let guess = format!("{family}.{}.{quantity}{tail}", subject.join("."));
    ChannelName::parse(&guess).is_some().then_some(guess)
}

//! Names of channels → quantities of a model.

use super::Quantity;
use super::force::{ForceGauge, Mount};
use super::motion::{Seat, Sight};
use crate::spec::{MechanismEnd, Scenario, SensorKind};
use crate::spelling::hint_for_name;
use multibody::{Joint, JointKind};
use sim::Model;

/// Quantity and component of a channel.
pub(super) fn split(channel: &str) -> (&str, Option<&str>) {
    match channel.rsplit_once('.') {
        Some((name, component)) if ["x", "y", "z", "w"].contains(&component) => (name, Some(component)),
        _ => (channel, None),
    }
}

/// Index of a component; a number has none.
pub(super) fn component(is_scalar: bool, is_rotation: bool, name: Option<&str>) -> Option<usize> {
    match (is_scalar, name) {
        (true, None) => Some(0),
        (false, Some("w")) if !is_rotation => None,
        (false, Some(name)) => ["x", "y", "z", "w"].iter().position(|k| *k == name),
        _ => None,
    }
}

pub(super) fn quantity(scenario: &Scenario, model: &Model, name: &str) -> Result<Quantity, String> {
    let parts = name.split_once('.').and_then(|(family, rest)| Some((family, rest.rsplit_once('.')?)));
    let Some((family, (name, what))) = parts else {
        return Err("is not of the form family.name.quantity, as body.slider.position".to_owned());
    };
    match (family, what) {
        ("joint", "position") => Ok(Quantity::JointPosition(joint(model, name)?)),
        ("joint", "velocity") => Ok(Quantity::JointVelocity(joint(model, name)?)),
        ("joint", "link_position") => Ok(Quantity::JointLinkPosition(joint(model, name)?)),
        ("joint", "link_velocity") => Ok(Quantity::JointLinkVelocity(joint(model, name)?)),
        ("joint", "effort") => Ok(Quantity::JointEffort(joint(model, name)?)),
        ("body", "position") => link(model, name).map(|(v, l)| Quantity::Position(v, l)),
        ("body", "orientation") => link(model, name).map(|(v, l)| Quantity::Orientation(v, l)),
        ("body", "linear_velocity") => link(model, name).map(|(v, l)| Quantity::LinearVelocity(v, l)),
        ("body", "angular_velocity") => link(model, name).map(|(v, l)| Quantity::AngularVelocity(v, l)),
        ("sensor", "force") => Ok(Quantity::Force(force(scenario, model, name)?)),
        ("sensor", "torque") => Ok(Quantity::Torque(force(scenario, model, name)?)),
        ("sensor", "angular_velocity") => Ok(Quantity::SensorRate(seat(scenario, model, name)?)),
        ("sensor", "specific_force") => Ok(Quantity::SpecificForce(seat(scenario, model, name)?)),
        ("sensor", "position") => Ok(Quantity::SeenPosition(sight(scenario, model, name)?)),
        ("sensor", "orientation") => Ok(Quantity::SeenOrientation(sight(scenario, model, name)?)),
        ("drive", "position") => Ok(Quantity::DrivePosition(drive(model, name)?)),
        ("drive", "angle") => Ok(Quantity::DriveAngle(drive(model, name)?)),
        ("actuator", "command") => Ok(Quantity::Command(actuator(model, name)?)),
        _ => {
            Err(format!("nothing is measured as \"{family}.….{what}\"; see the table of channels in the documentation"))
        }
    }
}

/// The one of `(vehicle, name)` that a text means: `vehicle/name`, or the name where only one has it.
fn only<'a, T: Copy>(what: &str, text: &str, all: impl Iterator<Item = (&'a str, &'a str, T)>) -> Result<T, String> {
    let all: Vec<(&str, &str, T)> = all.collect();
    let full = |c: &(&str, &str, T)| format!("{}/{}", c.0, c.1);
    let is_full = |c: &(&str, &str, T)| text.split_once('/') == Some((c.0, c.1));
    let found: Vec<_> = all.iter().filter(|c| c.1 == text || is_full(c)).collect();
    match found[..] {
        [one] => Ok(one.2),
        [] => Err(format!("no {what} \"{text}\"{}", hint_for_name(text, all.iter().map(|c| c.1)))),
        _ => Err(format!("{what} \"{text}\" is in several vehicles; write {}", full(found[0]))),
    }
}

/// Joints with a coordinate of their own: vehicle, name, index into the world's `v`.
pub(crate) fn joints(model: &Model) -> impl Iterator<Item = (&str, &str, usize)> {
    let single = |j: &&Joint| !j.is_mimic && matches!(j.kind, JointKind::Revolute | JointKind::Prismatic);
    model.vehicles.iter().flat_map(move |v| {
        v.tree.joints.iter().filter(single).map(|j| (v.name.as_str(), j.name.as_str(), v.v0 + j.v_index))
    })
}

/// Links: vehicle, name, and both as indices.
pub(crate) fn links(model: &Model) -> impl Iterator<Item = (&str, &str, (usize, usize))> {
    model.vehicles.iter().enumerate().flat_map(|(v, vehicle)| {
        vehicle.tree.links.iter().enumerate().map(move |(l, link)| (vehicle.name.as_str(), link.name.as_str(), (v, l)))
    })
}

/// Joints that bear a link, fixed ones too: vehicle, name, and the link as vehicle and link.
fn borne(model: &Model) -> impl Iterator<Item = (&str, &str, (usize, usize))> {
    model.vehicles.iter().enumerate().flat_map(|(v, vehicle)| {
        let links = vehicle.tree.links.iter().enumerate().filter(|(_, link)| link.parent.is_some());
        links.map(move |(l, link)| (vehicle.name.as_str(), link.joint.as_str(), (v, l)))
    })
}

fn joint(model: &Model, name: &str) -> Result<usize, String> {
    only("joint", name, joints(model))
}

fn link(model: &Model, name: &str) -> Result<(usize, usize), String> {
    only("link", name, links(model)).or_else(|error| model.vehicle(name).map(|v| (v, 0)).ok_or(error))
}

/// What is measured of the subjects of a family, scalars last.
const MEASURED: [(&str, &[&str]); 4] = [
    ("joint", &["position", "velocity", "link_position", "link_velocity", "effort"]),
    ("body", &["position", "orientation", "linear_velocity", "angular_velocity"]),
    ("sensor", &["force", "torque", "angular_velocity", "specific_force", "position", "orientation"]),
    ("drive", &["position", "angle"]),
];

/// Every quantity that can be read, each by all names that mean it.
pub(super) fn all_names(scenario: &Scenario, model: &Model) -> Vec<Vec<String>> {
    let named = |name: &String| vec![name.clone()];
    let subjects = |family: &str| -> Vec<Vec<String>> {
        match family {
            "joint" => joints(model).map(|(v, j, at)| joint_names(model, (v, j), at)).collect(),
            "body" => links(model).map(|(v, l, at)| link_names(model, (v, l), at)).collect(),
            "sensor" => scenario.sensors.iter().map(|s| named(&s.name)).collect(),
            _ => model.drives.iter().map(|d| named(&d.name)).collect(),
        }
    };
    let of_family = |(family, quantities): &(&str, &[&str])| -> Vec<Vec<String>> {
        let whole = |names: &Vec<String>, what: &str| names.iter().map(|n| format!("{family}.{n}.{what}")).collect();
        subjects(family).iter().flat_map(|names| quantities.iter().map(|what| whole(names, what))).collect()
    };
    MEASURED.iter().flat_map(of_family).collect()
}

/// All names that mean what `name` means: with the vehicle, and without it where that is enough.
pub(super) fn synonyms(model: &Model, name: &str) -> Vec<String> {
    let parts = name.split_once('.').and_then(|(family, rest)| Some((family, rest.rsplit_once('.')?)));
    let Some((family, (subject, what))) = parts else { return vec![name.to_owned()] };
    let subjects = match family {
        "joint" => joint(model, subject).ok().and_then(|at| {
            let own = joints(model).find(|(.., a)| *a == at)?;
            Some(joint_names(model, (own.0, own.1), at))
        }),
        "body" => link(model, subject).ok().and_then(|at| {
            let own = links(model).find(|(.., a)| *a == at)?;
            Some(link_names(model, (own.0, own.1), at))
        }),
        _ => None,
    };
    subjects.map_or_else(
        || vec![name.to_owned()],
        |all| all.iter().map(|subject| format!("{family}.{subject}.{what}")).collect(),
    )
}

fn joint_names(model: &Model, (vehicle, name): (&str, &str), at: usize) -> Vec<String> {
    let mut names = vec![format!("{vehicle}/{name}"), name.to_owned()];
    names.retain(|n| joint(model, n) == Ok(at));
    names
}

fn link_names(model: &Model, (vehicle, name): (&str, &str), at: (usize, usize)) -> Vec<String> {
    let mut names = vec![format!("{vehicle}/{name}"), name.to_owned(), vehicle.to_owned()];
    names.retain(|n| link(model, n) == Ok(at));
    names.dedup();
    names
}

fn drive(model: &Model, name: &str) -> Result<usize, String> {
    let hint = || hint_for_name(name, model.drives.iter().map(|d| d.name.as_str()));
    model.drives.iter().position(|d| d.name == name).ok_or_else(|| format!("no drive \"{name}\"{}", hint()))
}

fn actuator(model: &Model, name: &str) -> Result<usize, String> {
    let is = |a: &sim::Actuator| a.name == name || a.name.rsplit_once('/').is_some_and(|(_, last)| last == name);
    let hint = || hint_for_name(name, model.actuators.iter().map(|a| a.name.as_str()));
    model.actuators.iter().position(is).ok_or_else(|| format!("no actuator \"{name}\"{}", hint()))
}

fn sensor<'s>(scenario: &'s Scenario, name: &str) -> Result<&'s SensorKind, String> {
    let hint = || hint_for_name(name, scenario.sensors.iter().map(|s| s.name.as_str()));
    let found = scenario.sensors.iter().find(|s| s.name == name);
    found.map(|s| &s.kind).ok_or_else(|| format!("no sensor \"{name}\"{}", hint()))
}

fn seat(scenario: &Scenario, model: &Model, name: &str) -> Result<Seat, String> {
    match sensor(scenario, name)? {
        SensorKind::Imu { link: on, pose, .. } => {
            let (vehicle, link) = link(model, on)?;
            Ok(Seat { vehicle, link, pose_ls: pose.pose() })
        }
        _ => Err(format!("sensor \"{name}\" is no imu")),
    }
}

fn sight(scenario: &Scenario, model: &Model, name: &str) -> Result<Sight, String> {
    match sensor(scenario, name)? {
        SensorKind::Pose { relative_to, .. } if relative_to == "world" => {
            Err(format!("sensor \"{name}\" sees from the world: what it reads is the body's own, body.….position"))
        }
        SensorKind::Pose { link: seen, relative_to, pose, .. } => {
            let (of, (vehicle, link)) = (link(model, seen)?, link(model, relative_to)?);
            Ok(Sight { of, from: Seat { vehicle, link, pose_ls: pose.pose() } })
        }
        _ => Err(format!("sensor \"{name}\" sees no pose")),
    }
}

fn force(scenario: &Scenario, model: &Model, name: &str) -> Result<ForceGauge, String> {
    match sensor(scenario, name)? {
        SensorKind::ContactForce { part, link: on, pose, .. } => {
            let (vehicle, link) = link(model, on)?;
            let (body, collider) = touched(model, part)?;
            let mount = Mount::of(model, body);
            Ok(ForceGauge::Contact { body, collider, vehicle, link, pose_ls: pose.pose(), mount })
        }
        SensorKind::MechanismForce { mechanism, on, .. } => {
            let hint = || hint_for_name(mechanism, model.mechanisms.iter().map(|m| m.name.as_str()));
            let index = model.mechanisms.iter().position(|m| m.name == *mechanism);
            let index = index.ok_or_else(|| format!("no mechanism \"{mechanism}\"{}", hint()))?;
            Ok(ForceGauge::Mechanism { index, sign: if *on == MechanismEnd::B { 1.0 } else { -1.0 } })
        }
        SensorKind::ForceTorque { joint, .. } => {
            let (vehicle, link) = only("joint", joint, borne(model))?;
            Ok(ForceGauge::Joint { vehicle, link })
        }
        _ => Err(format!("sensor \"{name}\" reads no force")),
    }
}

/// Global body and collider of a shape, or the body of a link, by `vehicle/name`.
fn touched(model: &Model, part: &str) -> Result<(usize, Option<usize>), String> {
    if let Some(collider) = model.collider_names.iter().position(|n| n == part) {
        return Ok((model.scene.colliders()[collider].body, Some(collider)));
    }
    let (v, l) = link(model, part)?;
    Ok((model.vehicles[v].body0 + model.vehicles[v].tree.links[l].body, None))
}

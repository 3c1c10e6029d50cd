//! Actuators by name → coordinates and bodies; reaction wheels become rotors of the tree.

use super::faults::Faults;
use super::shapes::place_of;
use crate::glob::{glob_matches, is_glob};
use crate::spec::{self, Scenario};
use multibody::{Joint, JointKind};
use sim::{Actuator, ActuatorKind, VehicleSpec};
use spatial::Vec3;

/// The world's actuators, and how the file's names lead to them.
#[derive(Clone, Debug, Default)]
pub(crate) struct ActuatorTable {
    pub(crate) actuators: Vec<Actuator>,
    /// Rotor speeds at t = 0, by coordinate.
    pub(crate) rotor_speeds: Vec<(usize, f64)>,
}

impl ActuatorTable {
    /// Actuators of that name, or drives of that group (`arm` means `arm/shoulder`, `arm/elbow`, …).
    pub(crate) fn find(&self, name: &str) -> impl Iterator<Item = usize> + '_ {
        let prefix = format!("{name}/");
        let name = name.to_owned();
        let matches = move |a: &Actuator| a.name == name || a.name.starts_with(&prefix);
        self.actuators.iter().enumerate().filter(move |(_, a)| matches(a)).map(|(i, _)| i)
    }
}

/// Resolves all actuators; wheels are added to the trees first, since they shift the coordinates behind them.
pub(super) fn resolve(scenario: &Scenario, vehicles: &mut [VehicleSpec], faults: &mut Faults<'_>) -> ActuatorTable {
    let mut rotors = vec![None; scenario.actuators.len()];
    for (i, actuator) in scenario.actuators.iter().enumerate() {
        if let spec::ActuatorKind::ReactionWheel { link, inertia_kg_m2, speed_limit_rad_per_s, speed_rad_per_s, .. } =
            &actuator.kind
            && let Some((Some(v), l)) = place_of(vehicles, link, &format!("actuator[{i}].link"), faults)
        {
            let (tree, axis) = (&mut vehicles[v].tree, actuator.kind.axis().unwrap_or_else(Vec3::x));
            let (body, axis) = (tree.links[l].body, tree.links[l].frame_bl.rot * axis);
            let rotor = tree.add_rotor(body, &axis, *inertia_kg_m2, &actuator.name);
            tree.joints[rotor].velocity_limit = *speed_limit_rad_per_s;
            rotors[i] = Some((v, rotor));
            check_start_speed(i, *speed_rad_per_s, *speed_limit_rad_per_s, faults);
        }
    }
    let is_latch = |m: &spec::Mechanism| matches!(m.kind, spec::MechanismKind::Latch(_));
    let mechanisms = scenario.mechanisms.iter().enumerate();
    let latches: Vec<_> = mechanisms.filter(|(_, m)| is_latch(m)).map(|(k, m)| (k, m.name.as_str())).collect();
    let mut table = ActuatorTable::default();
    let mut all = Vec::new();
    for (i, actuator) in scenario.actuators.iter().enumerate() {
        let site = Site { i, vehicles, rotor: rotors[i], latches: &latches };
        add(&mut table, actuator, &site, faults);
        all.push(brought(actuator, &site, faults));
    }
    for Brought { armatures, speed_limits } in all {
        armatures.iter().for_each(|(v, j, inertia)| vehicles[*v].tree.joints[*j].armature += inertia);
        speed_limits.iter().for_each(|(v, j, limit)| vehicles[*v].tree.joints[*j].velocity_limit = *limit);
    }
    table
}

fn check_start_speed(i: usize, speed: f64, limit: f64, faults: &mut Faults<'_>) {
    if speed.abs() > limit {
        let reason =
            format!("starts at {speed} rad/s, beyond its limit of {limit}; lower it or raise speed_limit_rad_per_s");
        faults.add(&format!("actuator[{i}].speed_rad_per_s"), reason);
    }
}

/// What an actuator brings to its joints: vehicle, joint, and the value.
struct Brought {
    armatures: Vec<(usize, usize, f64)>,
    speed_limits: Vec<(usize, usize, f64)>,
}

/// Rotors that an actuator's drives reflect to their joints, and the speeds at which they stop pushing.
fn brought(actuator: &spec::Actuator, site: &Site<'_>, faults: &mut Faults<'_>) -> Brought {
    let kind = &actuator.kind;
    let inertia = "give reflected_mass_kg for a joint that slides, reflected_inertia_kg_m2 for one that turns";
    let speed = "give speed_limit_m_per_s for a joint that slides, speed_limit_rad_per_s for one that turns";
    let armatures = at_joints(kind, (kind.reflected_inertia(), inertia), site, faults);
    let speed_limits = at_joints(kind, (kind.joint_speed_limit(), speed), site, faults);
    Brought { armatures, speed_limits }
}

/// A value and whether it is one of sliding joints, at all joints of an actuator.
fn at_joints(
    kind: &spec::ActuatorKind,
    (value, advice): (Option<(f64, bool)>, &str),
    site: &Site<'_>,
    faults: &mut Faults<'_>,
) -> Vec<(usize, usize, f64)> {
    let Some((value, is_linear)) = value else { return Vec::new() };
    let mut found = Vec::new();
    for pattern in kind.joint_patterns() {
        // A pattern that names no joint has been told already.
        for (v, joint) in joints_of(site, pattern, "", &mut Faults::silent(faults)) {
            if is_linear != (joint.kind == JointKind::Prismatic) {
                faults.add(&format!("actuator[{}]", site.i), advice);
            }
            let index = site.vehicles[v].tree.joints.iter().position(|j| j.name == joint.name);
            found.extend(index.map(|j| (v, j, value)));
        }
    }
    found
}

/// Where an actuator is being built.
struct Site<'a> {
    i: usize,
    vehicles: &'a [VehicleSpec],
    rotor: Option<(usize, usize)>,
    /// Index and name of the mechanisms that are latches.
    latches: &'a [(usize, &'a str)],
}

impl Site<'_> {
    /// Index into the world's `v` of a joint's coordinate.
    fn coordinate(&self, vehicle: usize, joint: &Joint) -> usize {
        self.vehicles[..vehicle].iter().map(|v| v.tree.nv).sum::<usize>() + joint.v_index
    }

    fn body(&self, vehicle: usize, link: usize) -> usize {
        let before: usize = self.vehicles[..vehicle].iter().map(|v| v.tree.bodies.len()).sum();
        before + self.vehicles[vehicle].tree.links[link].body
    }
}

fn add(table: &mut ActuatorTable, actuator: &spec::Actuator, site: &Site<'_>, faults: &mut Faults<'_>) {
    let key = |k: &str| format!("actuator[{}].{k}", site.i);
    let mut push = |name: String, kind| table.actuators.push(Actuator { name, kind });
    match &actuator.kind {
        spec::ActuatorKind::JointTorque { joint, limit_n_m, limit_n, .. } => {
            for (v, joint) in joints_of(site, joint, &key("joint"), faults) {
                check_limit(joint, [*limit_n_m, *limit_n], &key(""), faults);
                let limit = limit_n_m.or(*limit_n).unwrap_or(joint.effort_limit);
                let coordinate = site.coordinate(v, joint);
                push(actuator.name.clone(), ActuatorKind::JointEffort { coordinate, limit });
            }
        }
        spec::ActuatorKind::JointDrive(drive) => {
            let single = drive.joints.is_empty();
            for pattern in drive.joint_patterns() {
                for (v, joint) in joints_of(site, pattern, &key(if single { "joint" } else { "joints" }), faults) {
                    if drive.is_linear() != (joint.kind == JointKind::Prismatic) {
                        faults.add(&key(""), unit_mismatch(joint));
                    } else if drive.damping_n_m_s_per_rad.is_some() && drive.is_linear()
                        || drive.damping_n_s_per_m.is_some() && !drive.is_linear()
                    {
                        faults.add(&key("damping"), unit_mismatch(joint));
                    }
                    check_limit(joint, [drive.limit_n_m, drive.limit_n], &key(""), faults);
                    let name = if single { actuator.name.clone() } else { format!("{}/{}", actuator.name, joint.name) };
                    let coordinate = site.coordinate(v, joint);
                    let limit = drive.limit().unwrap_or(joint.effort_limit);
                    let (stiffness, damping) = (drive.stiffness(), drive.damping());
                    push(name, ActuatorKind::JointDrive { coordinate, stiffness, damping, limit });
                }
            }
        }
        spec::ActuatorKind::Thruster { link, position_m, max_force_n, .. } => {
            if let Some((Some(v), l)) = place_of(site.vehicles, link, &key("link"), faults) {
                let frame = &site.vehicles[v].tree.links[l].frame_bl;
                let direction = frame.rot * actuator.kind.axis().unwrap_or_else(Vec3::x);
                let position = frame.point(&Vec3::from(*position_m));
                let body = site.body(v, l);
                push(
                    actuator.name.clone(),
                    ActuatorKind::Thruster { body, position, direction, max_force: *max_force_n },
                );
            }
        }
        spec::ActuatorKind::ReactionWheel { torque_limit_n_m, speed_rad_per_s, .. } => {
            let Some((v, j)) = site.rotor else { return };
            let coordinate = site.coordinate(v, &site.vehicles[v].tree.joints[j]);
            push(actuator.name.clone(), ActuatorKind::JointEffort { coordinate, limit: *torque_limit_n_m });
            table.rotor_speeds.push((coordinate, *speed_rad_per_s));
        }
        spec::ActuatorKind::LatchRelease { latch } => match site.latches.iter().find(|(_, name)| name == latch) {
            Some((mechanism, _)) => {
                push(actuator.name.clone(), ActuatorKind::LatchRelease { mechanism: *mechanism });
            }
            None => faults.unknown(&key("latch"), "latch", latch, site.latches.iter().map(|(_, name)| *name)),
        },
    }
}

/// The limit of a joint's actuator, of the keys for a turning and a sliding joint or else the URDF's, is one that can act.
fn check_limit(joint: &Joint, [turning, sliding]: [Option<f64>; 2], key: &str, faults: &mut Faults<'_>) {
    let (name, slides) = (&joint.name, joint.kind == JointKind::Prismatic);
    let (own, other) = if slides { (sliding, turning) } else { (turning, sliding) };
    let keys = if slides { ["limit_n", "limit_n_m"] } else { ["limit_n_m", "limit_n"] };
    if other.is_some() {
        let motion = if slides { "slides" } else { "turns" };
        faults.add(&format!("{key}{}", keys[1]), format!("joint \"{name}\" {motion}; give {} instead", keys[0]));
    } else if own.is_none() && joint.effort_limit <= 0.0 {
        let reason = format!(
            "joint \"{name}\" has the effort limit 0 in its URDF, so that its actuator could give nothing; give {} here",
            keys[0]
        );
        faults.add(key.trim_end_matches('.'), reason);
    }
}

fn unit_mismatch(joint: &Joint) -> String {
    let (kind, keys) = if joint.kind == JointKind::Prismatic {
        ("prismatic", "stiffness_n_per_m and damping_n_s_per_m")
    } else {
        ("revolute", "stiffness_n_m_per_rad and damping_n_m_s_per_rad")
    };
    format!("joint \"{}\" is {kind}; give {keys}", joint.name)
}

/// Joints with a single coordinate of their own that `vehicle/joint` or a glob names.
fn joints_of<'a>(site: &Site<'a>, pattern: &str, key: &str, faults: &mut Faults<'_>) -> Vec<(usize, &'a Joint)> {
    let driven = |j: &Joint| !j.is_mimic && matches!(j.kind, JointKind::Revolute | JointKind::Prismatic);
    let mut found = Vec::new();
    let mut valid = Vec::new();
    for (v, vehicle) in site.vehicles.iter().enumerate() {
        for joint in vehicle.tree.joints.iter().filter(|j| driven(j)) {
            let name = format!("{}/{}", vehicle.name, joint.name);
            let hit = if is_glob(pattern) { glob_matches(pattern, &name) } else { name == pattern };
            if hit {
                found.push((v, joint));
            }
            valid.push(name);
        }
    }
    if found.is_empty() {
        faults.unknown(key, "joint that can be driven", pattern, valid.iter().map(String::as_str));
    }
    found
}

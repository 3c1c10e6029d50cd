//! URDF files → trees and bases.

use super::effects::{self, Entry};
use super::faults::Faults;
use super::stock::Stock;
use crate::spec::{BaseAxis, Environment, Scenario, Vehicle};
use multibody::{JointDescription, JointKind, RobotDescription, Tree, UrdfWarnings};
use sim::VehicleSpec;
use spatial::Vec3;
use std::path::PathBuf;

/// What the vehicles' files hold, one per vehicle.
pub(super) struct RobotFiles {
    pub(super) robots: Vec<RobotDescription>,
    /// What is doubtful in them.
    pub(super) warnings: Vec<UrdfWarnings>,
    /// Mass properties of the links without what effects add to them or take out.
    pub(super) own_inertials: Vec<effects::OwnInertials>,
}

/// The vehicles of a scenario, in its order.
pub(super) struct Loaded {
    pub(super) files: RobotFiles,
    pub(super) nominal_coms: effects::NominalComs,
    pub(super) specs: Vec<VehicleSpec>,
}

/// Loads every vehicle's robot; `None` if one cannot be had, since nothing else can be checked then. What is wrong with a
/// file is told where it is first asked for.
pub(super) fn load(scenario: &Scenario, plan: &[Entry<'_>], stock: &Stock, faults: &mut Faults<'_>) -> Option<Loaded> {
    let dir = scenario.source.file_dir();
    let (mut loaded, mut warnings) = (Vec::with_capacity(scenario.vehicles.len()), Vec::new());
    let mut refused = Vec::new();
    for (i, vehicle) in scenario.vehicles.iter().enumerate() {
        let folders: Vec<PathBuf> = vehicle.package_paths.iter().map(|p| dir.join(p)).collect();
        let asked = (dir.join(&vehicle.urdf), folders);
        match stock.robot(&asked.0, &asked.1) {
            Ok(mut found) => {
                lift_stops(&mut found.robot, i, vehicle, faults);
                loaded.push((found.robot, base(scenario, i, vehicle, faults)));
                warnings.push(found.warnings);
            }
            Err(_) if refused.contains(&asked) => {}
            Err(errors) => {
                faults.add(&format!("vehicle[{i}].urdf"), format!("the URDF cannot be used:\n{errors}"));
                refused.push(asked);
            }
        }
    }
    if loaded.len() < scenario.vehicles.len() {
        return None;
    }
    let (mut robots, bases): (Vec<_>, Vec<_>) = loaded.into_iter().unzip();
    let names: Vec<&str> = scenario.vehicles.iter().map(|v| v.name.as_str()).collect();
    let nominal_coms = effects::nominal_coms(&robots);
    let mut edited = effects::Robots { names: &names, descriptions: &mut robots, nominal_coms: &nominal_coms };
    let own_inertials = effects::edit_robots(plan, &mut edited, faults);
    let spec = |(vehicle, (robot, base)): (&Vehicle, (&RobotDescription, sim::Base))| VehicleSpec {
        name: vehicle.name.clone(),
        tree: Tree::from_description(robot),
        base,
    };
    let specs = scenario.vehicles.iter().zip(robots.iter().zip(bases)).map(spec).collect();
    Some(Loaded { files: RobotFiles { robots, warnings, own_inertials }, nominal_coms, specs })
}

/// Takes the range from the joints that are named to have none.
fn lift_stops(robot: &mut RobotDescription, i: usize, vehicle: &Vehicle, faults: &mut Faults<'_>) {
    let is_single = |j: &JointDescription| matches!(j.kind, JointKind::Revolute | JointKind::Prismatic);
    for (k, wanted) in vehicle.unstopped_joints.iter().enumerate() {
        if let Some(joint) = robot.joints.iter_mut().find(|j| is_single(j) && j.name == *wanted) {
            joint.position_limits = None;
            continue;
        }
        let names = robot.joints.iter().filter(|j| is_single(j)).map(|j| j.name.as_str());
        faults.unknown(&format!("vehicle[{i}].unstopped_joints[{k}]"), "joint with a range", wanted, names);
    }
}

fn base(scenario: &Scenario, i: usize, vehicle: &Vehicle, faults: &mut Faults<'_>) -> sim::Base {
    if vehicle.base.is_fixed() {
        return sim::Base::Fixed;
    }
    if vehicle.base.is_free() {
        // On an air bearing a free vehicle floats in the plane.
        return if scenario.environment == Environment::AirBearing {
            sim::Base::Only([false, false, true, true, true, false])
        } else {
            sim::Base::Free
        };
    }
    let mask = mask_in_world(vehicle);
    if mask.is_none() {
        let reason = "the free directions are those of the base's initial pose, and its axes must lie along W's; \
                      turn the pose by multiples of 90 deg, or free whole planes that the turn keeps";
        faults.add(&format!("vehicle[{i}].base"), reason);
    }
    sim::Base::Only(mask.unwrap_or([true; 6]))
}

/// The free components of the twist in W axes; `None` where the initial attitude mixes free and held ones.
fn mask_in_world(vehicle: &Vehicle) -> Option<[bool; 6]> {
    let mut own = [false; 6];
    for axis in vehicle.base.free_axes() {
        own[match axis {
            BaseAxis::Roll => 0,
            BaseAxis::Pitch => 1,
            BaseAxis::Yaw => 2,
            BaseAxis::X => 3,
            BaseAxis::Y => 4,
            BaseAxis::Z => 5,
        }] = true;
    }
    let rot = vehicle.pose.pose().rotation;
    let mut mask = [false; 6];
    for half in [0, 3] {
        for k in 0..3 {
            // W's axis k, seen from the base: it is free if all the own axes it is made of are, held if none is.
            let seen = rot.inverse() * Vec3::ith(k, 1.0);
            let parts: Vec<bool> = (0..3).filter(|j| seen[*j].abs() > 1e-9).map(|j| own[half + j]).collect();
            if parts.iter().any(|p| *p != parts[0]) {
                return None;
            }
            mask[half + k] = parts.first().copied().unwrap_or(false);
        }
    }
    Some(mask)
}

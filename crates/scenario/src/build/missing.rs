//! What a URDF lacks is no fault until the scenario needs it: shapes that could not be had where they may touch, and
//! inertia where something moves freely.

use super::faults::Faults;
use super::shapes::Named;
use multibody::{
    Freedom, Geometry, RobotDescription, UrdfDoubt, UrdfWarnings, find_singular_freedoms, find_singular_freedoms_at,
};
use sim::{ShapeSpec, VehicleSpec, World};
use std::sync::Arc;

/// A collision shape that could not be had.
pub(super) struct Lost {
    /// Its names; the shape itself is a stand-in.
    pub(super) named: Named,
    reason: Arc<str>,
}

/// The collision shapes that could not be had.
pub(super) fn lost_shapes(robots: &[RobotDescription], vehicles: &[VehicleSpec]) -> Vec<Lost> {
    let mut lost = Vec::new();
    for (v, robot) in robots.iter().enumerate() {
        for (link, description) in robot.links.iter().enumerate() {
            for collision in &description.collisions {
                let Geometry::Missing(reason) = &collision.geometry else { continue };
                let names = [&collision.name, &description.name].map(|n| format!("{}/{n}", vehicles[v].name));
                let spec = ShapeSpec {
                    name: collision.name.clone(),
                    vehicle: Some(v),
                    link,
                    pose_ls: collision.pose_ls,
                    shape: super::shape_of_geometry(&collision.geometry),
                };
                lost.push(Lost { named: Named { spec, names: names.into() }, reason: Arc::clone(reason) });
            }
        }
    }
    lost
}

/// Refuses what is not there and may touch; `may_touch` says whether two shapes may.
pub(super) fn check_touching(
    lost: &[Lost],
    shapes: &[Named],
    may_touch: impl Fn(&Named, &Named) -> bool,
    faults: &mut Faults<'_>,
) {
    for (i, Lost { named, reason }) in lost.iter().enumerate() {
        let others = shapes.iter().chain(lost.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, l)| &l.named));
        let Some(other) = others.into_iter().find(|other| may_touch(named, other)) else { continue };
        let (key, name) = (format!("vehicle[{}].urdf", named.spec.vehicle.unwrap_or_default()), &named.names[0]);
        let reason = format!(
            "the collision shape \"{name}\" may touch \"{}\" and is missing: {reason}; bring it, or keep it from touching: \
             [[contact]] between = [\"{}\", \"*\"], enabled = false",
            other.names[0], named.names[1]
        );
        faults.add(&key, reason);
    }
}

/// Refuses what moves freely and has no inertia against it: no force decides how it moves.
pub(super) fn check_freedoms(world: &World, warnings: &[UrdfWarnings], faults: &mut Faults<'_>) {
    for (i, (vehicle, warnings)) in world.model().vehicles.iter().zip(warnings).enumerate() {
        let (tree, base) = (&vehicle.tree, vehicle.base.mask());
        let always = find_singular_freedoms(tree, base);
        for freedom in find_singular_freedoms_at(tree, base, &world.state().q[vehicle.q_range()]) {
            let reason = match freedom {
                Freedom::Base => BASE.to_owned(),
                Freedom::Joint(j) if always.contains(&freedom) => of_joint(&tree.joints[j].name, warnings),
                Freedom::Joint(j) => at_start(&tree.joints[j].name),
            };
            faults.add(&format!("vehicle[{i}].urdf"), reason);
        }
    }
}

const BASE: &str = "the base moves freely, but nothing of the vehicle resists it with inertia (its root has no mass and joints \
                    take the others out of the way, or it is a point mass); give the root link an <inertial>, or set \
                    base = \"fixed\"";

/// In the words of the file's own warning, which has the line.
fn of_joint(joint: &str, warnings: &UrdfWarnings) -> String {
    let subject = format!("joint \"{joint}\"");
    let is_it = |doubt: &UrdfDoubt| matches!(doubt, UrdfDoubt::MovesNoMass { .. } | UrdfDoubt::MovesNoInertia { .. });
    let told = warnings.iter().find(|w| w.subject == subject && is_it(&w.what));
    told.map_or_else(|| format!("{subject}: what it moves resists it with no inertia; {ARMATURE}"), ToString::to_string)
}

fn at_start(joint: &str) -> String {
    format!(
        "joint \"{joint}\": as the joints stand at the start, what it moves resists it with no inertia (a point mass lies on its \
         axis, or axes coincide); start elsewhere ([vehicle.joints]), or {ARMATURE}"
    )
}

const ARMATURE: &str = "give the links beyond it an inertia, or the joint an armature ([[effect]] name = \"joint-armature\", or \
                        the reflected_inertia_kg_m2 (reflected_mass_kg where it slides) of its [[actuator]])";

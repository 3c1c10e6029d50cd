//! Collision shapes and the laws of their pairs.
//!
//! Shapes of different vehicles (and of the world) may touch unless a `[[contact]]` says `enabled = false`; shapes of one
//! vehicle only where a `[[contact]]` names them. Links that a joint holds together overlap at that joint by their nature: a
//! glob leaves them out (as MuJoCo and Drake do), and a `[[contact]]` that names both lets them touch. Every shape answers to
//! its own name and to its link's.

use super::beds;
use super::faults::Faults;
use super::laws::{pair_law, pivot_law};
use super::missing;
use crate::spec::{ContactRule, FrictionLaw, Grain, PointRule, Scenario};
use contact::{Bed, Shape};
use multibody::{Geometry, RobotDescription, Tree};
use record::docking_of_geometry;
use sim::{Base, PairLaw, ShapeSpec, VehicleSpec};
use spatial::Vec3;

/// A shape with the names it answers to.
pub(super) struct Named {
    pub(super) spec: ShapeSpec,
    pub(super) names: Vec<String>,
}

impl Named {
    fn names(&self) -> Vec<&str> {
        self.names.iter().map(String::as_str).collect()
    }
}

/// All shapes, and the pairs that may touch.
pub(super) fn resolve(
    scenario: &Scenario,
    robots: &[RobotDescription],
    vehicles: &[VehicleSpec],
    faults: &mut Faults<'_>,
) -> (Vec<ShapeSpec>, Vec<([usize; 2], PairLaw)>) {
    let mut shapes = Vec::new();
    for (v, robot) in robots.iter().enumerate() {
        shapes.extend(of_robot(v, &vehicles[v].name, robot));
    }
    add_scenario_shapes(scenario, (robots, vehicles), &mut shapes, faults);
    let lost = missing::lost_shapes(robots, vehicles);
    check_rules(scenario, &shapes.iter().chain(lost.iter().map(|l| &l.named)).collect::<Vec<_>>(), faults);
    missing::check_touching(&lost, &shapes, |a, b| law_of_pair(scenario, vehicles, a, b).is_some(), faults);
    check_grains(scenario, faults);
    let mut pairs = Vec::new();
    for b in 1..shapes.len() {
        for a in 0..b {
            if let Some(law) = law_of_pair(scenario, vehicles, &shapes[a], &shapes[b]) {
                pairs.push(([a, b], law));
            }
        }
    }
    // The sides' order is part of the sign of a force; the pairs' order part of the order of sums.
    pairs.sort_by_key(|(pair, _)| *pair);
    (shapes.into_iter().map(|n| n.spec).collect(), pairs)
}

fn of_robot<'a>(v: usize, vehicle: &'a str, robot: &'a RobotDescription) -> impl Iterator<Item = Named> + 'a {
    robot.links.iter().enumerate().flat_map(move |(link, description)| {
        let had = description.collisions.iter().filter(|c| !matches!(c.geometry, Geometry::Missing(_)));
        had.map(move |collision| Named {
            spec: ShapeSpec {
                name: collision.name.clone(),
                vehicle: Some(v),
                link,
                pose_ls: collision.pose_ls,
                shape: shape_of_geometry(&collision.geometry),
            },
            names: vec![format!("{vehicle}/{}", collision.name), format!("{vehicle}/{}", description.name)],
        })
    })
}

/// The collision shape of a URDF geometry; a missing one touches nothing.
pub fn shape_of_geometry(geometry: &Geometry) -> Shape {
    match geometry {
        Geometry::Box { size } => Shape::Cuboid { half_extents: 0.5 * size },
        Geometry::Sphere { radius } => Shape::Ball { radius: *radius },
        Geometry::Cylinder { radius, length } => Shape::Cylinder { radius: *radius, half_length: 0.5 * length },
        Geometry::Capsule { radius, length } => Shape::Capsule { radius: *radius, half_length: 0.5 * length },
        Geometry::Docking(geometry) => Shape::Docking(docking_of_geometry(geometry)),
        Geometry::Missing(_) => Shape::Bed(Bed::new(Vec::new())),
        Geometry::Mesh(mesh) => Shape::TriMesh {
            vertices: mesh.vertices.iter().map(|v| Vec3::from(*v)).collect(),
            triangles: mesh.triangles.clone(),
        },
    }
}

fn add_scenario_shapes(
    scenario: &Scenario,
    (robots, vehicles): (&[RobotDescription], &[VehicleSpec]),
    shapes: &mut Vec<Named>,
    faults: &mut Faults<'_>,
) {
    for (i, shape) in scenario.shapes.iter().enumerate() {
        let Some((vehicle, link)) = place_of(vehicles, &shape.on, &format!("shape[{i}].on"), faults) else { continue };
        let description = vehicle.map(|v| &robots[v].links[link]);
        let Some((pose, form)) = beds::shape_of_kind(&shape.kind, description, &format!("shape[{i}].of"), faults)
        else {
            continue;
        };
        let pose_ls = shape.pose.pose() * pose;
        let spec = ShapeSpec { name: shape.name.clone(), vehicle, link, pose_ls, shape: form };
        let mut names = vec![shape.place()];
        names.extend(vehicle.map(|_| shape.on.clone()));
        shapes.push(Named { spec, names });
    }
}

/// Vehicle and link of `vehicle/link`; no vehicle for "world".
pub(super) fn place_of(
    vehicles: &[VehicleSpec],
    on: &str,
    key: &str,
    faults: &mut Faults<'_>,
) -> Option<(Option<usize>, usize)> {
    if on == "world" {
        return Some((None, 0));
    }
    let (name, link) = on.split_once('/').unwrap_or((on, ""));
    let Some(v) = vehicles.iter().position(|v| v.name == name) else {
        faults.unknown(key, "vehicle", name, vehicles.iter().map(|v| v.name.as_str()));
        return None;
    };
    let links = &vehicles[v].tree.links;
    let found = links.iter().position(|l| l.name == link);
    if found.is_none() {
        faults.unknown(key, "link", link, links.iter().map(|l| l.name.as_str()));
    }
    found.map(|l| (Some(v), l))
}

/// A rule that names nothing is a slip of the pen.
fn check_rules(scenario: &Scenario, shapes: &[&Named], faults: &mut Faults<'_>) {
    let mut check = |key: String, pattern: &str| {
        let all = || shapes.iter().flat_map(|s| s.names.iter().map(String::as_str));
        if !all().any(|name| crate::glob_matches(pattern, name)) {
            let valid: Vec<&str> = all().collect();
            faults.unknown(&key, "shape or link", pattern, valid);
        }
    };
    for (i, rule) in scenario.keep_out.iter().enumerate() {
        rule.between.iter().enumerate().for_each(|(k, p)| check(format!("keep_out[{i}].between[{k}]"), p));
    }
    for (i, rule) in scenario.contacts.iter().enumerate() {
        rule.between.iter().enumerate().for_each(|(k, p)| check(format!("contact[{i}].between[{k}]"), p));
    }
    for (i, rule) in scenario.contacts.iter().enumerate() {
        if let Some(grain) = &rule.grain
            && !rule
                .between
                .iter()
                .any(|side| crate::glob_matches(&grain.on, side) || crate::glob_matches(side, &grain.on))
        {
            let sides = rule.between.iter().map(String::as_str);
            faults.unknown(&format!("contact[{i}].grain.on"), "side of this contact", &grain.on, sides);
        }
    }
}

/// A grain and levels that differ across it do nothing without each other.
fn check_grains(scenario: &Scenario, faults: &mut Faults<'_>) {
    let differs = |law: &FrictionLaw| matches!(law, FrictionLaw::Bristle(law) if law.across_ratio != 1.0);
    let by_default = differs(&scenario.contact_default.friction);
    let needs = "does nothing without a grain; give the [[contact]] grain = { on = …, axis = … }";
    for (i, rule) in scenario.contacts.iter().enumerate() {
        let differs = rule.friction.as_ref().map_or(by_default, differs);
        if rule.grain.is_some() && !differs {
            let reason =
                "does nothing where the levels are the same in all directions; give the friction an across_ratio";
            faults.add(&format!("contact[{i}].grain"), reason);
        }
        if rule.grain.is_none() && rule.friction.is_some() && differs {
            faults.add(&format!("contact[{i}].friction"), format!("across_ratio {needs}"));
        }
    }
    let is_used = |r: &ContactRule| r.grain.is_some() && r.friction.is_none();
    if by_default && !scenario.contacts.iter().any(is_used) {
        faults.add("contact_default.friction", format!("across_ratio {needs}"));
    }
}

fn law_of_pair(scenario: &Scenario, vehicles: &[VehicleSpec], a: &Named, b: &Named) -> Option<PairLaw> {
    if body_of(vehicles, &a.spec) == body_of(vehicles, &b.spec) {
        return None;
    }
    let (names_a, names_b) = (a.names(), b.names());
    if a.spec.vehicle == b.spec.vehicle {
        let are_joined = a.spec.vehicle.is_some_and(|v| {
            let tree = &vehicles[v].tree;
            are_neighbours(tree, tree.links[a.spec.link].body, tree.links[b.spec.link].body)
        });
        let is_meant = |r: &ContactRule| !are_joined || !r.between.iter().any(|side| crate::is_glob(side));
        let names = |r: &ContactRule| names_a.iter().any(|a| names_b.iter().any(|b| r.matches(a, b)));
        scenario.contacts.iter().find(|r| is_meant(r) && names(r))?;
    }
    let law = scenario.contact_law(&names_a, &names_b);
    let rule = scenario.contact_rule(&names_a, &names_b);
    let grain = rule.and_then(|r| r.grain.as_ref());
    let pivot = rule.and_then(|r| r.pivot.as_ref()).map(pivot_law);
    let on_side = |on: &str, names: &[&str]| names.iter().any(|n| crate::glob_matches(on, n));
    law.enabled.then(|| {
        let grain = grain.map(|g| (g, on_side(&g.on, &names_b)));
        PairLaw {
            grain: grain.map(|(g, on_b)| grain_on(vehicles, if on_b { b } else { a }, g, on_b)),
            pivot,
            only_deepest: rule.is_some_and(|r| r.points == PointRule::Deepest),
            ..pair_law(&law)
        }
    })
}

/// Whether one joint holds two bodies of a tree together.
pub(super) fn are_neighbours(tree: &Tree, a: usize, b: usize) -> bool {
    a != b && (tree.bodies[a].parent == b || tree.bodies[b].parent == a)
}

/// A grain in the axes of the body that carries the shape.
fn grain_on(vehicles: &[VehicleSpec], shape: &Named, grain: &Grain, on_b: bool) -> sim::Grain {
    let axis = Vec3::from(grain.axis);
    let link = shape.spec.vehicle.map(|v| &vehicles[v].tree.links[shape.spec.link]);
    sim::Grain { on_b, axis: link.map_or(axis, |l| l.frame_bl.rot * axis), angle: 0.0 }
}

/// What a shape is fixed to; all that stands still in W is one body.
fn body_of(vehicles: &[VehicleSpec], shape: &ShapeSpec) -> Option<(usize, usize)> {
    let v = shape.vehicle?;
    let body = vehicles[v].tree.links[shape.link].body;
    (vehicles[v].base != Base::Fixed || body != 0).then_some((v, body))
}

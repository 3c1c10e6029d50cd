//! What is to be seen: the visual shapes of every link, and where to look.

use multibody::{Geometry, LinkDescription, RobotDescription, Visual};
use spatial::Vec3;

/// Everything visible, without poses: those come with each sample, in the order of [`Scene::links`].
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The vehicles.
    pub vehicles: Vec<SceneVehicle>,
    /// Shapes that stand still in W (a floor, a rig's frame).
    pub fixtures: Vec<Visual>,
    /// Points whose path is drawn as a line.
    pub trails: Vec<Trail>,
    /// Index (in [`Scene::links`]) of the link that the close-up view moves with, such as the target's.
    pub close_up: Option<usize>,
}

/// A vehicle's links.
#[derive(Clone, Debug)]
pub struct SceneVehicle {
    /// Name in the scenario.
    pub name: String,
    /// Links, in the order of their poses.
    pub links: Vec<SceneLink>,
}

/// A link's shapes.
#[derive(Clone, Debug)]
pub struct SceneLink {
    /// Name in its robot.
    pub name: String,
    /// Its visual shapes, in the link's frame.
    pub visuals: Vec<Visual>,
}

/// The path of a point.
#[derive(Clone, Debug)]
pub struct Trail {
    /// Its name.
    pub name: String,
    /// Index of the link that carries the point, in [`Scene::links`].
    pub link: usize,
    /// The point in that link's frame, m.
    pub point_l: Vec3,
}

impl SceneVehicle {
    /// A vehicle of this name with the visual shapes of a robot.
    pub fn from_robot(name: impl Into<String>, robot: &RobotDescription) -> Self {
        let links = robot.links.iter();
        let links = links.map(|link| SceneLink { name: link.name.clone(), visuals: visuals_of(link) });
        Self { name: name.into(), links: links.collect() }
    }
}

/// What a link shows; where it shows nothing, the docking shapes that touch, which no other reader draws.
fn visuals_of(link: &LinkDescription) -> Vec<Visual> {
    if !link.visuals.is_empty() {
        return link.visuals.clone();
    }
    let docking = link.collisions.iter().filter(|c| matches!(c.geometry, Geometry::Docking(_)));
    docking
        .map(|c| Visual { name: c.name.clone(), pose_ls: c.pose_ls, geometry: c.geometry.clone(), rgba: None })
        .collect()
}

impl Scene {
    /// All links, vehicles in order: (vehicle's name, link).
    pub fn links(&self) -> impl Iterator<Item = (&str, &SceneLink)> {
        self.vehicles.iter().flat_map(|vehicle| vehicle.links.iter().map(|link| (vehicle.name.as_str(), link)))
    }

    /// Number of links, and of poses in each sample.
    pub fn link_count(&self) -> usize {
        self.vehicles.iter().map(|vehicle| vehicle.links.len()).sum()
    }

    /// Index of a link in [`Scene::links`].
    pub fn link_index(&self, vehicle: &str, link: &str) -> Option<usize> {
        self.links().position(|(v, l)| v == vehicle && l.name == link)
    }
}

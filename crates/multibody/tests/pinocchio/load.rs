//! The robots, read by this crate's own loader.

use crate::fixture::{Model, third_party};
use multibody::{Inertial, RobotDescription, SearchPaths, Tree, UrdfErrors, load_urdf};
use spatial::{Inertia, Mat3, Vec3};

/// The tree of a model; its root gets the ballast, if the index has one.
pub fn load(model: &Model) -> Result<Tree, UrdfErrors> {
    let packages = third_party().map(|site| site.join("cmeel.prefix/share"));
    let mut robot = load_urdf(&model.urdf, &SearchPaths::new(packages))?.robot;
    if let Some((mass, moments)) = model.ballast {
        let tensor_com = Mat3::from_diagonal(&moments);
        robot.links[0].inertial = Some(Inertial { mass, com: Vec3::zeros(), tensor_com });
    }
    Ok(Tree::from_description(&robot))
}

/// The tree of a description with every mimic joint a joint of its own; ballast on top, and armatures, as in the index.
pub fn freed(model: &Model, mut robot: RobotDescription) -> Tree {
    robot.joints.iter_mut().for_each(|joint| joint.mimic = None);
    let mut tree = Tree::from_description(&robot);
    if let Some((mass, moments)) = model.ballast {
        tree.bodies[0].inertia += Inertia::from_com(mass, &Vec3::zeros(), &Mat3::from_diagonal(&moments));
    }
    tree.joints.iter_mut().for_each(|joint| joint.armature = model.armature);
    tree
}

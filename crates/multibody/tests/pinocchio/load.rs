//! The robots, read by this crate's own loader.

use crate::fixture::{Model, third_party};
use multibody::{Inertial, SearchPaths, Tree, load_urdf};
use spatial::{Mat3, Vec3};

/// The tree of a model; its root gets the ballast, if the index has one.
pub fn load(model: &Model) -> Tree {
    let packages = third_party().map(|site| site.join("cmeel.prefix/share"));
    let mut robot = load_urdf(&model.urdf, &SearchPaths::new(packages)).unwrap_or_else(|errors| panic!("{errors}"));
    if let Some((mass, moments)) = model.ballast {
        let tensor_com = Mat3::from_diagonal(&moments);
        robot.links[0].inertial = Some(Inertial { mass, com: Vec3::zeros(), tensor_com });
    }
    Tree::from_description(&robot)
}

//! Robots of others load whole: Panda, UR5 and iiwa with their meshes.
//!
//! Their files are not part of this repository. `SOFTDOCK_THIRD_PARTY_ROBOTS` names a Python site-packages directory
//! with the packages `example-robot-data` (0.13, `cmeel.prefix/share/…`) and `pybullet` (`pybullet_data/…`);
//! without it these tests say that they were skipped.

use multibody::{Geometry, JointKind, RobotDescription, SearchPaths, load_urdf};
use std::io::Write;
use std::path::{Path, PathBuf};

const ROBOTS: &str = "cmeel.prefix/share/example-robot-data/robots";

/// Past the capture of test output: a test that did not run must not look like one that passed.
fn tell(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn third_party(test: &str) -> Option<PathBuf> {
    let found = std::env::var_os("SOFTDOCK_THIRD_PARTY_ROBOTS").map(PathBuf::from);
    if found.is_none() {
        tell(&format!("SKIPPED {test}: set SOFTDOCK_THIRD_PARTY_ROBOTS to a site-packages directory to run it"));
    }
    found
}

fn load(path: &Path, search: &SearchPaths) -> RobotDescription {
    load_urdf(path, search).unwrap_or_else(|errors| panic!("{} must load:\n{errors}", path.display())).robot
}

/// Sum of the masses, kg, and number of triangles, of a robot.
fn totals(robot: &RobotDescription) -> (f64, usize) {
    let mass = robot.links.iter().filter_map(|l| l.inertial).map(|i| i.mass).sum();
    let visuals = robot.links.iter().flat_map(|l| &l.visuals).map(|v| &v.geometry);
    let collisions = robot.links.iter().flat_map(|l| &l.collisions).map(|c| &c.geometry);
    let triangles = visuals.chain(collisions).map(|g| if let Geometry::Mesh(m) = g { m.triangles.len() } else { 0 });
    (mass, triangles.sum())
}

/// Extent of a link's visual meshes along its own axes, m.
fn extent(robot: &RobotDescription, link: &str) -> [f64; 3] {
    let link = robot.links.iter().find(|l| l.name == link).expect("the link exists");
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for visual in &link.visuals {
        let Geometry::Mesh(mesh) = &visual.geometry else { continue };
        for vertex in &mesh.vertices {
            for i in 0..3 {
                bounds[0][i] = bounds[0][i].min(vertex[i]);
                bounds[1][i] = bounds[1][i].max(vertex[i]);
            }
        }
    }
    std::array::from_fn(|i| bounds[1][i] - bounds[0][i])
}

#[test]
fn panda_loads_with_meshes_and_its_second_finger_follows_the_first() {
    let Some(packages) = third_party("panda") else { return };
    let search = SearchPaths::new([packages.join("cmeel.prefix/share")]);
    let panda = load(&packages.join(ROBOTS).join("panda_description/urdf/panda.urdf"), &search);
    assert_eq!((panda.links.len(), panda.joints.len()), (13, 12));
    assert!(panda.root_has_mass());
    let named = |name: &str| panda.joints.iter().position(|j| j.name == name).expect("the joint exists");
    let follower = panda.joints[named("panda_finger_joint2")].mimic.expect("it mimics");
    assert_eq!((follower.joint, follower.multiplier, follower.offset), (named("panda_finger_joint1"), 1.0, 0.0));
    let (mass, triangles) = totals(&panda);
    assert!((mass - 18.0).abs() < 2.0, "a Panda weighs about 18 kg, not {mass}");
    assert!(triangles > 50_000, "{triangles} triangles");
    let finger = extent(&panda, "panda_leftfinger");
    assert!((finger[2] - 0.054).abs() < 0.005, "a finger is 54 mm long, not {finger:?}");
    let is_coloured = |g: &Geometry| matches!(g, Geometry::Mesh(m) if m.vertex_rgba.len() == m.vertices.len());
    assert!(panda.links.iter().flat_map(|l| &l.visuals).all(|v| is_coloured(&v.geometry)), "DAE files carry colours");
}

#[test]
fn package_is_found_by_walking_up_from_the_file() {
    let Some(packages) = third_party("walking up") else { return };
    let path = packages.join(ROBOTS).join("ur_description/urdf/ur5_robot.urdf");
    load(&path, &SearchPaths::default());
}

#[test]
fn ur5_loads_with_meshes_from_a_massless_world() {
    let Some(packages) = third_party("UR5") else { return };
    let search = SearchPaths::new([packages.join("cmeel.prefix/share")]);
    let ur5 = load(&packages.join(ROBOTS).join("ur_description/urdf/ur5_robot.urdf"), &search);
    assert_eq!(ur5.links[0].name, "world");
    assert!(ur5.joints.iter().enumerate().all(|(i, j)| j.parent <= i), "parents stand before children");
    assert_eq!(ur5.joints.iter().filter(|j| j.kind == JointKind::Revolute).count(), 6);
    let (_, triangles) = totals(&ur5);
    assert!(triangles > 50_000, "{triangles} triangles");
    let forearm = extent(&ur5, "forearm_link");
    assert!((0.4..0.6).contains(&forearm[2]), "the forearm is about half a metre long, not {forearm:?}");
}

#[test]
fn iiwa_loads_with_obj_meshes_on_a_base_without_mass() {
    let Some(packages) = third_party("iiwa") else { return };
    let iiwa = load(&packages.join("pybullet_data/kuka_iiwa/model.urdf"), &SearchPaths::default());
    assert_eq!(iiwa.joints.len(), 7);
    assert!(!iiwa.root_has_mass(), "its file gives the base a mass of 0");
    assert_eq!(iiwa.links[0].visuals[0].rgba, Some([0.2, 0.2, 0.2, 1.0]), "the named colour Grey");
    let base = extent(&iiwa, "lbr_iiwa_link_0");
    assert!((0.15..0.35).contains(&base[0]), "the base is about a quarter of a metre wide, not {base:?}");
}

/// Every URDF of the directories in `SOFTDOCK_MORE_ROBOTS` (separated as in PATH) loads.
#[test]
fn more_robots_load() {
    let Some(directories) = std::env::var_os("SOFTDOCK_MORE_ROBOTS") else {
        tell("SKIPPED more robots: set SOFTDOCK_MORE_ROBOTS to directories with .urdf files to run it");
        return;
    };
    for directory in std::env::split_paths(&directories) {
        let entries = std::fs::read_dir(&directory).expect("the directory can be read");
        let mut paths: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).collect();
        paths.retain(|p| p.extension().is_some_and(|e| e == "urdf"));
        paths.sort();
        paths.iter().for_each(|path| drop(load(path, &SearchPaths::default())));
        tell(&format!("{}: {} robots load", directory.display(), paths.len()));
    }
}

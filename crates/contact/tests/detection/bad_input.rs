//! Everything that a scene refuses, and the words that help to mend it.

use crate::support::*;

fn refusal(colliders: Vec<Collider>, pairs: Vec<[usize; 2]>) -> String {
    Scene::new(colliders, pairs).expect_err("the scene should be refused").to_string()
}

fn mesh(triangles: Vec<[u32; 3]>) -> Shape {
    Shape::TriMesh { vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y()], triangles }
}

#[test]
fn bad_shapes_are_refused_by_name() {
    let flat: Vec<Vec3> = corners_of_cube(0.1).iter().map(|v| Vec3::new(v.x, v.y, 0.0)).collect();
    let mut broken = corners_of_cube(0.1);
    broken[3].y = f64::NAN;
    let rows = [
        (cuboid(0.1, f64::NAN, 0.1), "half extent is NaN"),
        (cuboid(0.1, -0.1, 0.1), "half extent is -0.1"),
        (ball(0.0), "radius is 0"),
        (ball(f64::INFINITY), "radius is inf"),
        (cylinder(0.1, 0.0), "half length is 0"),
        (capsule(-1.0, 0.1), "radius is -1"),
        (Shape::ConvexHull { vertices: flat }, "span no volume"),
        (Shape::ConvexHull { vertices: vec![Vec3::zeros(); 8] }, "span no volume"),
        (Shape::ConvexHull { vertices: vec![Vec3::zeros(), Vec3::x()] }, "span no volume"),
        (Shape::ConvexHull { vertices: vec![] }, "span no volume"),
        (Shape::ConvexHull { vertices: broken }, "vertex 3"),
        (mesh(vec![[0, 1, 2], [0, 1, 3]]), "triangle 1 names vertex 3"),
        (mesh(vec![]), "no triangle"),
        (mesh(vec![[0, 0, 1], [2, 2, 2]]), "no triangle"),
        (Shape::Compound(vec![]), "at least one part"),
        (Shape::Compound(vec![(Pose::identity(), ball(-0.5))]), "radius is -0.5"),
        (Shape::Compound(vec![(Pose::translation(f64::NAN, 0.0, 0.0), ball(0.5))]), "its pose"),
    ];
    for (shape, words) in rows {
        let text = refusal(vec![collider("servicer/palm", 0, shape)], vec![]);
        assert!(text.contains("servicer/palm") && text.contains(words), "{words}: {text}");
    }
}

#[test]
fn bad_pairs_are_refused_by_number() {
    let both = || vec![collider("palm", 0, ball(0.1)), collider("bar", 1, ball(0.1))];
    let text = refusal(both(), vec![[0, 1], [0, 2]]);
    assert!(text.contains("pair 1") && text.contains("collider 2") && text.contains("2 colliders"), "{text}");
    let text = refusal(both(), vec![[1, 1]]);
    assert!(text.contains("pair 0") && text.contains("bar"), "{text}");
    let text = refusal(both(), vec![[0, 1], [1, 0]]);
    assert!(text.contains("pair 1") && text.contains("palm") && text.contains("bar"), "{text}");
}

#[test]
fn a_pose_that_is_no_number_is_refused() {
    let mut palm = collider("palm", 0, ball(0.1));
    palm.pose_bs = Pose::translation(0.0, f64::NAN, 0.0);
    assert!(refusal(vec![palm], vec![]).contains("palm"));
}

//! parry3d's queries, through the dispatcher, agree with the detector.

use crate::support::*;
use contact::{DockingDispatcher, DockingShape};
use parry3d_f64::glamx::{DMat3, DQuat};
use parry3d_f64::math::{Pose as ParryPose, Vector};
use parry3d_f64::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, PointQuery, QueryDispatcher, Ray, RayCast,
};
use parry3d_f64::shape::{Ball, Capsule, Cuboid, HalfSpace, Shape as ParryShape, TypedShape};

fn parry_pose(frame: &Frame) -> ParryPose {
    let column = |k: usize| Vector::new(frame.rot[(0, k)], frame.rot[(1, k)], frame.rot[(2, k)]);
    let rotation = DQuat::from_mat3(&DMat3::from_cols(column(0), column(1), column(2)));
    ParryPose::from_parts(Vector::new(frame.pos.x, frame.pos.y, frame.pos.z), rotation)
}

fn parry_shape(shape: &Shape) -> Option<Box<dyn ParryShape>> {
    Some(match shape {
        Shape::Ball { radius } => Box::new(Ball::new(*radius)),
        Shape::Capsule { radius, half_length } => Box::new(Capsule::new_z(*half_length, *radius)),
        Shape::Cuboid { half_extents: h } => Box::new(Cuboid::new(Vector::new(h.x, h.y, h.z))),
        Shape::HalfSpace => Box::new(HalfSpace::new(Vector::Z)),
        Shape::Docking(docking) => Box::new(DockingShape::new(*docking).unwrap()),
        _ => return None,
    })
}

#[test]
fn queries_through_the_chain_agree_with_the_detector() {
    // parry's pose is a quaternion made of our matrix.
    const CONVERTED: f64 = 1e-12;
    let chain = DockingDispatcher.chain(DefaultQueryDispatcher);
    let (mut dice, mut told) = (Dice(21), 0);
    for a in dockings().map(Shape::Docking) {
        for b in shapes() {
            let Some(shape_b) = parry_shape(&b) else { continue };
            let is_twin = a == b;
            let shape_a = parry_shape(&a).unwrap();
            let mut two = Two::new(a.clone(), b);
            for _ in 0..40 {
                let frame = dice.frame(0.12);
                let pose = parry_pose(&frame);
                let ours = two.find(&at(0.0, 0.0, 0.0), &frame, 0.01).to_vec();
                // Cores that cross have no normal to speak of.
                let Some(nearest) = ours.iter().min_by(|p, q| p.gap.total_cmp(&q.gap)).filter(|p| p.gap > -5e-4) else {
                    continue;
                };
                let margin = 0.01 + 1e-4;
                let contact = chain.contact(&pose, &*shape_a, &*shape_b, margin).unwrap().unwrap();
                assert!((contact.dist - nearest.gap).abs() < CONVERTED, "{contact:?} {nearest:?}");
                let distance = chain.distance(&pose, &*shape_a, &*shape_b).unwrap().distance;
                assert!((distance - nearest.gap.max(0.0)).abs() < CONVERTED);
                assert_eq!(
                    chain.intersection_test(&pose, &*shape_a, &*shape_b).unwrap().intersecting,
                    nearest.gap < 0.0
                );
                // The other way round.
                let swapped = chain.contact(&pose.inverse(), &*shape_b, &*shape_a, margin).unwrap().unwrap();
                assert!((swapped.dist - nearest.gap).abs() < CONVERTED);
                let mut manifolds: Vec<ContactManifold<(), ()>> = Vec::new();
                chain.contact_manifolds(&pose, &*shape_a, &*shape_b, margin, &mut manifolds, &mut None).unwrap();
                assert!(manifolds.len() >= ours.len(), "the detector keeps the most of 16");
                // Twins are told apart by the colliders' names, which parry does not know.
                for p in ours.iter().filter(|_| !is_twin) {
                    let same = |m: &&ContactManifold<(), ()>| {
                        let n = Vec3::new(m.local_n1.x, m.local_n1.y, m.local_n1.z);
                        (m.points[0].dist - p.gap).abs() < CONVERTED && (n - p.normal_w).norm() < 1e-9
                    };
                    assert!(manifolds.iter().any(|m| same(&m)), "{p:?} is not among parry's");
                }
                told += 1;
            }
        }
    }
    assert!(told > 60, "{told}");
}

#[test]
fn other_pairs_pass_to_the_next_dispatcher() {
    let chain = DockingDispatcher.chain(DefaultQueryDispatcher);
    let pose = ParryPose::translation(0.0, 0.0, 0.5);
    assert!((chain.distance(&pose, &Ball::new(0.1), &Ball::new(0.2)).unwrap().distance - 0.2).abs() < 1e-15);
    let cone = DockingShape::new(cone()).unwrap();
    assert!(matches!(cone.as_typed_shape(), TypedShape::Custom(_)));
    assert!(DockingDispatcher.distance(&pose, &Ball::new(0.1), &Ball::new(0.2)).is_err());
}

#[test]
fn points_project_and_rays_stop_on_the_surface() {
    let ring = DockingShape::new(ring()).unwrap();
    let projected = ring.project_local_point(Vector::new(0.3, 0.0, 0.0), true);
    assert!(!projected.is_inside && (projected.point - Vector::new(0.215, 0.0, 0.0)).length() < 1e-15);
    assert!(ring.contains_local_point(Vector::new(0.0, 0.21, 0.0)));
    let down = Ray::new(Vector::new(0.2, 0.0, 1.0), Vector::new(0.0, 0.0, -2.0));
    let hit = ring.cast_local_ray_and_get_normal(&down, 10.0, true).unwrap();
    assert!((hit.time_of_impact - 0.5 * 0.985).abs() < 1e-9 && (hit.normal - Vector::Z).length() < 1e-9);
    assert!(ring.cast_local_ray(&Ray::new(Vector::Z, -Vector::Z), 10.0, true).is_none(), "through the middle");
    let volume = 2.0 * std::f64::consts::PI.powi(2) * 0.2 * 0.015 * 0.015;
    let mass = ring.mass_properties(1.0).mass();
    assert!((mass / volume - 1.0).abs() < 0.06, "{mass} for {volume}: 12 × 64 facets");
    let aabb = ring.compute_local_aabb();
    assert!((aabb.maxs - Vector::new(0.215, 0.215, 0.015)).length() < 1e-15);
}

/// Every vertex of the tessellation is on the surface, and the faces look outward.
#[test]
fn tessellations_lie_on_the_surface() {
    for docking in dockings() {
        let (mesh, shape) = (docking.tessellate(), DockingShape::new(docking).unwrap());
        for v in &mesh.vertices {
            let p = Vector::new(v.x, v.y, v.z);
            let inside_the_floor = shape.project_local_point(p, false);
            assert!((inside_the_floor.point - p).length() < 1e-12 || inside_the_floor.is_inside, "{docking:?} {v:?}");
        }
        assert!(shape.mass_properties(1.0).mass() > 0.0, "{docking:?}");
        let at = |i: u32| mesh.vertices[i as usize];
        let volume: f64 = mesh.triangles.iter().map(|t| at(t[0]).dot(&at(t[1]).cross(&at(t[2]))) / 6.0).sum();
        assert!(volume > 0.0, "{docking:?} is inside out: {volume}");
    }
}

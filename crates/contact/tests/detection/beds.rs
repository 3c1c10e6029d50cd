//! Beds: areas, moments of area, and the foundation that their samples make together.

#![allow(clippy::print_stdout)]

use crate::support::*;
use contact::{Bed, ContactError};
use std::f64::consts::{PI, TAU};

/// Sums over a few thousand samples.
const SUM: f64 = 1e-12;
/// Depth of the samples, m.
const DEPTH: f64 = 1e-4;

fn cut_square(cuts: usize, size: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    // Uneven cuts, so that no two triangles are alike.
    let at = |i: usize| size * ((i as f64 / cuts as f64).powf(1.4) - 0.5);
    let vertices =
        (0..=cuts).flat_map(|j| (0..=cuts).map(move |i| (i, j))).map(|(i, j)| Vec3::new(at(i), at(j), 0.0)).collect();
    let corner = |i: usize, j: usize| (j * (cuts + 1) + i) as u32;
    let cells = (0..cuts).flat_map(|j| (0..cuts).map(move |i| (i, j)));
    let halves = |(i, j): (usize, usize)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (vertices, cells.flat_map(halves).collect())
}

/// A bed that looks down at z, over a half-space.
fn over_floor(bed: Bed) -> Two {
    Two::new(Shape::HalfSpace, Shape::Bed(bed))
}

fn face_down(rotation: Vec3, z: f64) -> Frame {
    Frame { rot: rotation_matrix(&rotation) * rotation_matrix(&(PI * Vec3::x())), pos: Vec3::new(0.0, 0.0, z) }
}

/// Σ w δ and the moments about the face's centre, for a foundation of unit stiffness.
fn press(two: &mut Two, frame: &Frame) -> (f64, Vec3) {
    let points = two.find_touching(&at(0.0, 0.0, 0.0), frame);
    assert_consistent(&points);
    let force = points.iter().map(|p| -p.weight * p.gap).sum();
    let moment = points.iter().map(|p| (p.point_b_w - frame.pos).cross(&(-p.weight * p.gap * p.normal_w))).sum();
    (force, moment)
}

#[test]
fn areas_and_second_moments_are_those_of_the_face() {
    let (r, q) = (0.05, 0.03);
    let (vertices, triangles) = cut_square(5, 0.08);
    let square = 0.08_f64.powi(2);
    let polar = |outer: f64, inner: f64| 0.5 * PI * (outer.powi(4) - inner.powi(4));
    for n in [6, 8, 31, 128, 2000] {
        for (bed, area, second) in [
            (Bed::disc(r, n), PI * r * r, polar(r, 0.0)),
            (Bed::annulus(q, r, n), PI * (r * r - q * q), polar(r, q)),
            (Bed::rectangle(0.08, 0.08, n), square, square * square / 6.0),
            (Bed::of_mesh(&vertices, &triangles, 0.08 / (n as f64).sqrt()), square, square * square / 6.0),
        ] {
            let sum = |f: &dyn Fn(&Vec3) -> f64| bed.samples.iter().map(|s| s.area * f(&s.point)).sum::<f64>();
            let scale = area * r;
            assert!((bed.calc_area() / area - 1.0).abs() < SUM && bed.reference_area == bed.calc_area());
            assert!((sum(&Vec3::norm_squared) / second - 1.0).abs() < SUM, "{n}: polar moment");
            assert!(sum(&|p| p.x).abs() < SUM * scale && sum(&|p| p.y).abs() < SUM * scale, "{n}: centre");
            assert!((sum(&|p| p.x * p.x) / second - 0.5).abs() < SUM && sum(&|p| p.x * p.y).abs() < SUM * scale * r);
        }
        assert_eq!((Bed::disc(r, n).samples.len(), Bed::annulus(q, r, n).samples.len()), (n, n));
    }
    for (bed, area) in [
        (Bed::cylinder_patch(r, 0.1, 1.2, 100), r * 1.2 * 0.1),
        (Bed::sphere_cap(r, 0.7, 100), TAU * r * r * (1.0 - 0.7_f64.cos())),
        (Bed::of_surface(&cylinder(r, 0.1), 0.01).unwrap(), TAU * r * (0.2 + r)),
        (Bed::of_surface(&cuboid(0.1, 0.2, 0.3), 0.03).unwrap(), 0.88),
        (Bed::of_surface(&capsule(r, 0.1), 0.01).unwrap(), TAU * r * (0.2 + 2.0 * r)),
    ] {
        assert!((bed.calc_area() / area - 1.0).abs() < SUM);
        // A closed surface, or a part of it: each sample on it, with the normal outward.
        assert!(bed.samples.iter().all(|s| s.normal.dot(&s.point) > 0.0 && (s.normal.norm() - 1.0).abs() < SUM));
    }
}

#[test]
fn stiffness_does_not_depend_on_the_number_of_samples_or_on_the_mesh() {
    let r = 0.05;
    let [(coarse_v, coarse_t), (fine_v, fine_t)] = [cut_square(1, 0.08), cut_square(9, 0.08)];
    let discs = [8, 128, 2000].map(|n| (Bed::disc(r, n), 0.25 * r * r));
    let squares = [8, 128, 2000].map(|n| (Bed::rectangle(0.08, 0.08, n), 0.08_f64.powi(2) / 12.0));
    let meshes =
        [(coarse_v, coarse_t), (fine_v, fine_t)].map(|(v, t)| (Bed::of_mesh(&v, &t, 1.0), 0.08_f64.powi(2) / 12.0));
    for (bed, gyration) in discs.into_iter().chain(squares).chain(meshes) {
        let mut two = over_floor(bed);
        let (force, moment) = press(&mut two, &face_down(Vec3::zeros(), -DEPTH));
        // Gaps are exact to round-off of the lengths, 1e-17 m.
        assert!((force / DEPTH - 1.0).abs() < SUM && moment.norm() < 1e-16, "{force} {moment}");
        // Tilted, all of it still in contact: f = δ, M = −θ ρ² with the radius of gyration ρ of the face.
        let tilt: f64 = 1e-3;
        let (force, moment) = press(&mut two, &face_down(Vec3::new(tilt, 0.0, 0.0), -DEPTH));
        assert!((force / DEPTH - 1.0).abs() < SUM, "{force}");
        // The force stays upright: arms shorten by cos θ, depths are ρ sin θ.
        assert!((moment.x / (-gyration * tilt.sin() * tilt.cos()) - 1.0).abs() < SUM, "{moment}");
    }
}

#[test]
fn centre_of_pressure_of_a_half_lifted_face_is_that_of_the_foundation() {
    // A rectangle 2a wide, tilted about y until it touches over the length c: pressure a triangle over c, its centre at
    // c/3 from the deep edge. f = θ c²/(4a), per unit stiffness of the whole.
    let (a, c, tilt): (f64, f64, f64) = (0.04, 0.05, 1e-3);
    let mut last = f64::INFINITY;
    for n in [32, 128, 512, 2048, 8192] {
        let mut two = over_floor(Bed::rectangle(2.0 * a, 0.02, n));
        let frame = face_down(Vec3::new(0.0, tilt, 0.0), tilt.sin() * (a - c));
        let (force, moment) = press(&mut two, &frame);
        let centre = -moment.y / force;
        let error = (force * 4.0 * a / (tilt.sin() * c * c) - 1.0).abs();
        let off = (centre - (a - c / 3.0) * tilt.cos()).abs() / a;
        println!("{n:5} samples: force off by {error:.1e}, centre of pressure by {off:.1e} of the half width");
        // The edge of contact cuts a cell: the integrand has a kink there, the error falls with the cell's square.
        assert!(error < 4.0 / n as f64 && off < 4.0 / n as f64);
        last = error;
    }
    assert!(last < 1e-4);
}

#[test]
fn spin_torque_of_a_uniformly_pressed_disc_is_two_thirds_mu_n_r() {
    let r = 0.05;
    println!("samples   rings' spin torque / (2/3 μNR)   sunflower's");
    for n in [8, 32, 128, 512, 2000] {
        let bed = Bed::disc(r, n);
        let torque: f64 = bed.samples.iter().map(|s| s.area * s.point.norm()).sum::<f64>() / bed.calc_area();
        let sunflower = (0..n).map(|i| r * ((i as f64 + 0.5) / n as f64).sqrt()).sum::<f64>() / n as f64;
        let [error, other] = [torque, sunflower].map(|t| t / (2.0 / 3.0 * r) - 1.0);
        println!("{n:7}   {error:+.1e}   {other:+.1e}");
        assert!(error.abs() < SUM);
    }
}

#[test]
fn samples_meet_every_kind_of_solid_where_its_surface_is() {
    let (vertices, triangles) = closed_box(0.1);
    let solids = [
        (cuboid(0.1, 0.1, 0.1), 0.1),
        (hull(0.1), 0.1),
        (Shape::TriMesh { vertices, triangles }, 0.1),
        (floor(), 0.0),
        (Shape::HalfSpace, 0.0),
        (Shape::Compound(vec![(Pose::identity(), cuboid(0.1, 0.1, 0.1)), (Pose::identity(), ball(0.05))]), 0.1),
        (cylinder(0.2, 0.1), 0.1),
    ];
    for (solid, top) in solids {
        let bed = Bed::disc(0.03, 64);
        for flipped in [false, true] {
            let (a, b) = (solid.clone(), Shape::Bed(bed.clone()));
            let frames =
                [at(0.0, 0.0, 0.0), Frame { pos: Vec3::new(0.01, 0.02, top - DEPTH), ..face_down(Vec3::zeros(), 0.0) }];
            let (mut two, [frame_a, frame_b]) =
                if flipped { (Two::new(b, a), [frames[1], frames[0]]) } else { (Two::new(a, b), frames) };
            let points = two.find_touching(&frame_a, &frame_b);
            assert_eq!(features(&points), (0..64).collect::<Vec<u64>>(), "{solid:?}");
            assert_consistent(&points);
            let up = if flipped { -Vec3::z() } else { Vec3::z() };
            for p in &points {
                assert!((p.gap + DEPTH).abs() < ROUND_OFF && (p.normal_w - up).norm() < ROUND_OFF, "{solid:?} {p:?}");
                assert!((p.weight - 1.0 / 64.0).abs() < 1e-2 / 64.0);
            }
        }
    }
    // On a ball the depth is along its radius.
    let mut two = Two::new(ball(0.1), Shape::Bed(Bed::disc(0.03, 64)));
    for p in two.find(&at(0.0, 0.0, 0.0), &face_down(Vec3::zeros(), 0.1 - DEPTH), 1e-3) {
        assert!((p.gap - (p.point_b_w.norm() - 0.1)).abs() < ROUND_OFF);
    }
}

fn closed_box(half: f64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (corners_of_cube(half), quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

#[test]
fn sheet_met_from_behind_pushes_a_sample_back_to_the_side_it_came_from() {
    // An open mesh has no inside: the sample's normal says that it came from above, however deep it is.
    let mut two = Two::new(floor(), Shape::Bed(Bed::rectangle(0.02, 0.02, 4)));
    for depth in [1e-6, 1e-4, 1e-3] {
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &face_down(Vec3::zeros(), -depth));
        assert_eq!(points.len(), 4);
        assert!(points.iter().all(|p| (p.gap + depth).abs() < ROUND_OFF && p.normal_w == Vec3::z()));
    }
}

#[test]
fn samples_that_look_away_and_other_beds_are_not_met() {
    let mut back = over_floor(Bed::disc(0.05, 20));
    assert!(back.find(&at(0.0, 0.0, 0.0), &at(0.0, 0.0, -DEPTH), 1e-3).is_empty());
    // Under a table and looking down, it is the floor's business, not the table's.
    let (vertices, triangles) = closed_box(0.1);
    for table in [cuboid(0.1, 0.1, 0.1), hull(0.1), Shape::TriMesh { vertices, triangles }] {
        let mut two = Two::new(table, Shape::Bed(Bed::disc(0.15, 200)));
        for z in [-0.101, -0.1 - DEPTH, -0.1 + DEPTH, 0.0, 0.09] {
            let touching = two.find_touching(&at(0.0, 0.0, 0.0), &face_down(Vec3::zeros(), z));
            assert!(touching.is_empty() || z > -0.1, "at {z}: {touching:?}");
            assert!(touching.iter().all(|p| p.normal_w.z > 0.9), "at {z}");
        }
    }
    let mut beds = Two::new(Shape::Bed(Bed::disc(0.05, 20)), Shape::Bed(Bed::disc(0.05, 20)));
    assert!(beds.find(&at(0.0, 0.0, 0.0), &face_down(Vec3::zeros(), -DEPTH), 1e-3).is_empty());
}

#[test]
fn seams_of_a_compound_change_no_samples_name() {
    let halves = [-0.1, 0.1].map(|x| (Pose::translation(x, 0.0, -0.1), cuboid(0.1, 0.1, 0.1)));
    let mut two = Two::new(Shape::Compound(halves.to_vec()), Shape::Bed(Bed::rectangle(0.02, 0.02, 64)));
    for i in 0..100 {
        let frame =
            Frame { pos: Vec3::new(-0.05 + 1.003e-3 * f64::from(i), 0.0, -DEPTH), ..face_down(Vec3::zeros(), 0.0) };
        let points = two.find_touching(&at(0.0, 0.0, 0.0), &frame);
        assert_eq!(features(&points), (0..64).collect::<Vec<u64>>(), "step {i}");
    }
}

#[test]
fn beds_without_sense_are_refused_by_name() {
    let mut bad = Bed::disc(0.05, 10);
    bad.samples[3].area = -1.0;
    for (bed, said) in [
        (Bed::new(Vec::new()), "no sample"),
        (bad, "sample 3"),
        (Bed::disc(0.05, 10).with_reference_area(0.0), "reference area of 0 m²"),
        (Bed::disc(f64::NAN, 10), "NaN m²"),
    ] {
        let error = Scene::new(vec![collider("pad", 0, Shape::Bed(bed))], Vec::new()).unwrap_err();
        assert!(matches!(error, ContactError::Bed { .. }) && error.to_string().contains(said), "{error}");
        assert!(error.to_string().starts_with("collider \"pad\""));
    }
}

#[test]
fn detecting_hundreds_of_samples_again_allocates_nothing() {
    let (vertices, triangles) = closed_box(0.1);
    let solids = [cuboid(0.1, 0.1, 0.1), hull(0.1), Shape::TriMesh { vertices, triangles }, cylinder(0.1, 0.1)];
    for solid in solids {
        let mut two = Two::new(solid, Shape::Bed(Bed::disc(0.05, 500)));
        let mut found = 0;
        let mut run = || {
            for i in 0..20 {
                let frame = face_down(Vec3::new(1e-4 * f64::from(i), 0.0, 0.0), 0.1 - DEPTH);
                found = two.find(&at(0.0, 0.0, 0.0), &frame, 1e-3).len();
            }
        };
        run();
        assert_eq!(allocation_counter::measure(run).count_total, 0);
        assert_eq!(found, 500);
    }
}

//! Convex pieces of concave meshes: their outer surface is the mesh's, their gaps stay open.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use contact::{Collider, ContactError, DecomposeOptions, Detector, Scene, Shape, calc_deviation, decompose};
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
use spatial::{Frame, Pose, Vec3};
use std::f64::consts::TAU;

type Mesh = (Vec<Vec3>, Vec<[u32; 3]>);

/// What the measure resolves, m: it looks 1e-6 of the size off a surface for what covers it.
const EXACT: f64 = 3e-7;

/// Prism over a polygon without holes, counter-clockwise, whose triangulation is given.
fn prism(outline: &[(f64, f64)], faces: &[[u32; 3]], height: f64) -> Mesh {
    let n = outline.len() as u32;
    let at = |z: f64| outline.iter().map(move |&(x, y)| Vec3::new(x, y, z));
    let vertices = at(0.0).chain(at(height)).collect();
    let mut triangles: Vec<[u32; 3]> = faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
    triangles.extend(faces.iter().map(|f| f.map(|i| i + n)));
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, j, j + n], [i, j + n, i + n]]);
    }
    (vertices, triangles)
}

/// A U, 0.1 m wide and high, legs of 0.03 m: between them 0.04 m.
fn u_shape() -> Mesh {
    let outline =
        [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.07, 0.1), (0.07, 0.03), (0.03, 0.03), (0.03, 0.1), (0.0, 0.1)];
    let faces = [[0, 1, 4], [0, 4, 5], [1, 2, 4], [2, 3, 4], [0, 5, 7], [5, 6, 7]];
    prism(&outline, &faces, 0.05)
}

/// A plate between two polygons of `n` corners each.
fn plate_with_hole(n: u32, outer: impl Fn(f64) -> (f64, f64), inner: f64, height: f64) -> Mesh {
    let mut vertices = Vec::new();
    for z in [0.0, height] {
        for i in 0..n {
            let phi = TAU * f64::from(i) / f64::from(n);
            let (x, y) = outer(phi);
            vertices.push(Vec3::new(x, y, z));
            vertices.push(Vec3::new(inner * phi.cos(), inner * phi.sin(), z));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        let [o, p, q, r] = [2 * i, 2 * j, 2 * i + 1, 2 * j + 1];
        let up = |k: u32| k + 2 * n;
        let mut quad = |a: u32, b: u32, c: u32, d: u32| triangles.extend([[a, b, c], [a, c, d]]);
        quad(up(o), up(p), up(r), up(q));
        quad(o, q, r, p);
        quad(o, p, up(p), up(o));
        quad(q, up(q), up(r), r);
    }
    (vertices, triangles)
}

fn annulus(n: u32) -> Mesh {
    plate_with_hole(n, |phi| (0.1 * phi.cos(), 0.1 * phi.sin()), 0.06, 0.02)
}

/// A square plate with a round hole.
fn box_with_hole(n: u32) -> Mesh {
    let on_square = |phi: f64| {
        let (s, c) = phi.sin_cos();
        let k = 0.1 / s.abs().max(c.abs());
        (k * c, k * s)
    };
    plate_with_hole(n, on_square, 0.05, 0.04)
}

fn volume(points: &[Vec3]) -> f64 {
    let points: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let (v, t) = parry3d_f64::transformation::convex_hull(&points);
    let six = |t: &[u32; 3]| {
        let [p, q, r] = t.map(|i| v[i as usize] - v[0]);
        p.cross(q).dot(r)
    };
    t.iter().map(six).sum::<f64>() / 6.0
}

fn mesh_volume((v, t): &Mesh) -> f64 {
    let six = |t: &[u32; 3]| {
        let [p, q, r] = t.map(|i| v[i as usize]);
        p.cross(&q).dot(&r)
    };
    t.iter().map(six).sum::<f64>() / 6.0
}

/// Deviation of parry's pieces of the same mesh, of its hulls "exact" to the triangles.
fn by_voxels((vertices, triangles): &Mesh) -> (usize, f64) {
    let points: Vec<Vector> = vertices.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let parameters = VHACDParameters { resolution: 64, concavity: 1e-3, ..VHACDParameters::default() };
    let parts = VHACD::decompose(&parameters, &points, triangles, true);
    let pieces: Vec<Vec<Vec3>> = parts
        .compute_exact_convex_hulls(&points, triangles)
        .into_iter()
        .map(|(v, _)| v.iter().map(|p| Vec3::new(p.x, p.y, p.z)).collect())
        .collect();
    (pieces.len(), calc_deviation(vertices, triangles, &pieces, 0.004).unwrap())
}

#[test]
fn pieces_are_height_true_and_fill_the_mesh_exactly() {
    println!("mesh            pieces   deviation, m   VHACD's pieces and deviation, m");
    for (name, mesh, most) in [
        ("U", u_shape(), 3),
        ("annulus of 32", annulus(32), 32),
        ("box with hole", box_with_hole(24), 24),
        ("L-ish U, moved", moved(u_shape()), 3),
    ] {
        let found = decompose(&mesh.0, &mesh.1, &DecomposeOptions::default()).unwrap();
        let (voxel_pieces, voxels) = by_voxels(&mesh);
        println!("{name:14} {:7}   {:12.1e}   {voxel_pieces} {voxels:.1e}", found.pieces.len(), found.deviation);
        assert!(found.pieces.len() <= most, "{name}: {} pieces", found.pieces.len());
        assert!(found.deviation < EXACT, "{name}: {}", found.deviation);
        let filled: f64 = found.pieces.iter().map(|p| volume(p)).sum();
        assert!((filled / mesh_volume(&mesh) - 1.0).abs() < 1e-9, "{name}: {filled}");
        assert!(found.deviation < voxels);
    }
}

/// In a place and attitude of no round numbers.
fn moved((vertices, triangles): Mesh) -> Mesh {
    let pose = Pose::new(Vec3::new(0.31, -0.17, 0.23), Vec3::new(0.4, -0.7, 1.1));
    (vertices.iter().map(|v| pose.rotation * v + pose.translation.vector).collect(), triangles)
}

#[test]
fn convex_mesh_is_one_piece() {
    let outline = [(0.0, 0.0), (0.1, 0.0), (0.12, 0.05), (0.1, 0.1), (0.0, 0.1)];
    let mesh = moved(prism(&outline, &[[0, 1, 2], [0, 2, 3], [0, 3, 4]], 0.05));
    let found = decompose(&mesh.0, &mesh.1, &DecomposeOptions::default()).unwrap();
    assert_eq!(found.pieces.len(), 1);
    assert_eq!(found.pieces[0].len(), 10);
    assert!(found.pieces[0].iter().all(|p| mesh.0.contains(p)), "corners are the mesh's own, bit for bit");
}

#[test]
fn rod_passes_through_the_gap_of_a_u_and_stops_at_its_floor() {
    let (vertices, triangles) = u_shape();
    let shape = decompose(&vertices, &triangles, &DecomposeOptions::default()).unwrap().into_shape();
    let rod = Shape::Capsule { radius: 0.0195, half_length: 0.1 };
    let collider = |name: &str, body, shape| Collider { name: name.to_owned(), body, pose_bs: Pose::identity(), shape };
    let scene = Scene::new(vec![collider("u", 0, shape), collider("rod", 1, rod)], vec![[0, 1]]).unwrap();
    let (mut detector, mut points) = (Detector::new(&scene), Vec::new());
    let mut gap_at = |y: f64| {
        let frames = [Frame::identity(), Frame { pos: Vec3::new(0.05, y, 0.025), ..Frame::identity() }];
        detector.detect(&scene, &frames, &[1e-3, 0.0], &mut points);
        points.iter().map(|p| p.gap).fold(f64::INFINITY, f64::min)
    };
    // Half a millimetre on each side, all the way down from above the mouth.
    for i in 0..140 {
        let gap = gap_at(0.125 - 5e-4 * f64::from(i));
        assert!(gap > 4.9e-4, "step {i}: {gap}");
    }
    // On the floor: y = 0.03 + 0.0195 less what it sinks in.
    assert!((gap_at(0.0495 - 1e-5) + 1e-5).abs() < 1e-9);
}

/// A plate with a square pocket in its top.
fn plate_with_pocket(depth: f64) -> Mesh {
    let ring = |half: f64, z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(half * x, half * y, z))
    };
    let vertices = [ring(0.05, 0.0), ring(0.05, 0.02), ring(0.03, 0.02), ring(0.03, 0.02 - depth)].concat();
    let mut triangles = vec![[0, 2, 1], [0, 3, 2], [12, 13, 14], [12, 14, 15]];
    for below in [0, 4, 8] {
        for i in 0..4 {
            let [a, b] = [below + i, below + (i + 1) % 4];
            triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
        }
    }
    (vertices, triangles)
}

#[test]
fn tolerance_fills_shallow_pockets_and_no_deeper_ones() {
    println!("pocket, m   tolerance, m   pieces   deviation, m");
    for (depth, tolerance, one) in [(5e-4, 0.0, false), (5e-4, 4e-4, false), (5e-4, 6e-4, true), (5e-3, 6e-4, false)] {
        let (vertices, triangles) = plate_with_pocket(depth);
        let options = DecomposeOptions { tolerance, spacing: 1e-3, ..DecomposeOptions::default() };
        let found = decompose(&vertices, &triangles, &options).unwrap();
        println!("{depth:9.0e} {tolerance:14.0e} {:8}   {:.1e}", found.pieces.len(), found.deviation);
        assert_eq!(found.pieces.len() == 1, one);
        let expected = if one { depth } else { 0.0 };
        assert!((found.deviation - expected).abs() < EXACT);
    }
}

#[test]
fn too_few_pieces_show_in_the_deviation() {
    let (vertices, triangles) = annulus(32);
    let options = DecomposeOptions { max_pieces: 4, ..DecomposeOptions::default() };
    let found = decompose(&vertices, &triangles, &options).unwrap();
    println!("4 pieces at most: {} with a deviation of {:.1e} m", found.pieces.len(), found.deviation);
    assert!(found.pieces.len() <= 4 && found.deviation > 1e-3);
}

#[test]
fn decomposing_twice_gives_the_same_bits_and_turned_inside_out_the_same_pieces() {
    let (vertices, mut triangles) = moved(box_with_hole(16));
    let options = DecomposeOptions::default();
    let first = decompose(&vertices, &triangles, &options).unwrap();
    assert_eq!(first, decompose(&vertices, &triangles, &options).unwrap());
    triangles.iter_mut().for_each(|t| t.swap(0, 2));
    let inside_out = decompose(&vertices, &triangles, &options).unwrap();
    assert_eq!(inside_out.pieces.len(), first.pieces.len());
}

#[test]
fn open_and_broken_meshes_are_refused_with_a_way_out() {
    let (vertices, mut triangles) = u_shape();
    triangles.pop();
    let options = DecomposeOptions::default();
    let error = decompose(&vertices, &triangles, &options).unwrap_err();
    assert!(matches!(error, ContactError::OpenMesh { .. }) && error.to_string().contains("close it"), "{error}");
    assert!(decompose(&vertices, &[[0, 1, 99]], &options).is_err());
    assert!(decompose(&[], &[], &options).is_err());
    assert!(decompose(&[Vec3::repeat(f64::NAN); 3], &[[0, 1, 2], [0, 2, 1]], &options).is_err());
    assert!(decompose(&[Vec3::x(), Vec3::y(), Vec3::z()], &[[0, 1, 2], [0, 2, 1]], &options).is_err());
}

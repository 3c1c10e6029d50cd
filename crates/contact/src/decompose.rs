//! Height-true convex decomposition of closed meshes: the pieces' outer surface *is* the mesh's.
//!
//! Decompositions on voxels put the outer surface where the voxels are, and cut beside the walls instead of along them:
//! hulls bulge into gaps by part of a voxel. Here every cut lies in the plane of a triangle of the mesh (a binary space
//! partition, W. C. Thibault and B. F. Naylor, "Set operations on polyhedra using binary space partitioning trees",
//! Computer Graphics 21 (4), 1987):
//!
//!   start with a box about the mesh and cut off what lies wholly outside; while a triangle runs through the inside of a cell, cut the worst cell along one
//!
//! A cell that no triangle runs through is wholly solid or wholly empty, which the mesh's winding number at points inside
//! of it says. Cells that are convex together are joined. The result is exact but for round-off. A concave wall takes one
//! piece per facet: a drogue of 64 facets becomes 64 pieces, so smooth cavities are better given as analytic shapes. A
//! `tolerance` lets pockets and grooves shallower than it be filled; it never fills deeper ones, and never drops a thin
//! wall. [`Decomposition::deviation`] is measured afterwards, on both surfaces, and resolves 1e-6 of the mesh's size.
//!
//! Deterministic: cells are cut in the order of their defects, ties in the order of their making.

use crate::decompose_cell::Cell;
use crate::decompose_measure::Surface;
use crate::{ContactError, Shape};
use parry3d_f64::transformation::try_convex_hull;
use spatial::{Pose, Vec3};

/// How a mesh is decomposed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecomposeOptions {
    /// Depth of pockets that may be filled, m; 0: none.
    pub tolerance: f64,
    /// Most cells while cutting. What is left uncut then shows in the deviation.
    pub max_pieces: usize,
    /// Distance between the points at which the deviation is measured, m; 0: a fiftieth of the mesh's size.
    pub spacing: f64,
}

impl Default for DecomposeOptions {
    fn default() -> Self {
        Self { tolerance: 0.0, max_pieces: 256, spacing: 0.0 }
    }
}

/// Convex pieces of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Decomposition {
    /// Corners of each piece, m.
    pub pieces: Vec<Vec<Vec3>>,
    /// Largest distance found between the surfaces of the mesh and of the pieces' union, either way, m.
    pub deviation: f64,
}

impl Decomposition {
    /// The pieces as one collision shape.
    pub fn into_shape(self) -> Shape {
        let hull = |vertices| (Pose::identity(), Shape::ConvexHull { vertices });
        Shape::Compound(self.pieces.into_iter().map(hull).collect())
    }
}

/// Round-off, relative to the mesh's size.
const ROUND_OFF: f64 = 1e-10;
/// Points per length at which the deviation is measured by default.
const FINE: f64 = 50.0;

/// Decomposes a closed mesh into convex pieces; corners in any order, if but all triangles look out or all look in.
pub fn decompose(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    options: &DecomposeOptions,
) -> Result<Decomposition, ContactError> {
    let surface = Surface::new(vertices, triangles)?;
    let eps = ROUND_OFF * surface.size;
    let mut cells = cut(&surface, options, eps);
    join(&mut cells, eps);
    let pieces: Vec<Vec<Vec3>> = cells.iter().map(|cell| surface.snap(cell.corners(eps), 10.0 * eps)).collect();
    let spacing = if options.spacing > 0.0 { options.spacing } else { surface.size / FINE };
    let deviation = surface.calc_deviation(&pieces, spacing);
    Ok(Decomposition { pieces, deviation })
}

/// Largest distance (m) found between the surface of a closed mesh and that of the union of convex pieces, either way, at
/// points `spacing` (m) apart.
pub fn calc_deviation(
    vertices: &[Vec3],
    triangles: &[[u32; 3]],
    pieces: &[Vec<Vec3>],
    spacing: f64,
) -> Result<f64, ContactError> {
    Ok(Surface::new(vertices, triangles)?.calc_deviation(pieces, spacing))
}

/// Solid cells that no triangle runs through, or as many as allowed.
fn cut(surface: &Surface, options: &DecomposeOptions, eps: f64) -> Vec<Cell> {
    let mut open = vec![Cell::around(surface).trimmed(surface, eps)];
    let mut done = Vec::new();
    open[0].update_defect(options.tolerance, eps);
    while let Some(worst) = worst_of(&open) {
        if open[worst].defect == 0.0 || open.len() + done.len() >= options.max_pieces {
            break;
        }
        let cell = open.remove(worst);
        let plane = cell.choose_cut(eps);
        for mut half in cell.split(&plane, eps) {
            half.update_defect(options.tolerance, eps);
            if half.defect > 0.0 {
                open.push(half);
            } else if surface.holds(&half) {
                done.push(half);
            }
        }
    }
    // What is left uncut, at the bound of pieces or without a defect from the start, is solid where most of it is.
    done.extend(open.into_iter().filter(|cell| surface.holds(cell)));
    done
}

fn worst_of(cells: &[Cell]) -> Option<usize> {
    (0..cells.len()).max_by(|&i, &j| cells[i].defect.total_cmp(&cells[j].defect).then(j.cmp(&i)))
}

/// Joins cells that are convex together.
fn join(cells: &mut Vec<Cell>, eps: f64) {
    let mut i = 0;
    while i < cells.len() {
        let found = (i + 1..cells.len()).find_map(|j| cells[i].joined(&cells[j], eps).map(|both| (j, both)));
        // A cell that has grown may fit to one that was tried before.
        i = match found {
            Some((j, both)) => {
                cells[i] = both;
                cells.remove(j);
                0
            }
            None => i + 1,
        };
    }
}

/// A convex hull as triangles.
pub(crate) struct Hull {
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Hull {
    /// The hull of points that span a volume.
    pub(crate) fn of(points: &[Vec3]) -> Option<Self> {
        let points: Vec<_> = points.iter().map(crate::scene::to_parry).collect();
        let (vertices, triangles) = try_convex_hull(&points).ok()?;
        let vertices: Vec<Vec3> = vertices.into_iter().map(crate::scene::from_parry).collect();
        Some(Self { vertices, triangles })
    }
}

//! A patch: the vertex, edge or face with which a convex shape meets a direction.

use spatial::{Frame, Vec3};

/// One corner of a patch and the edge that leaves it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    /// Position, m.
    pub(crate) p: Vec3,
    /// Number of the vertex.
    pub(crate) vertex: u32,
    /// Number of the edge to the next corner.
    pub(crate) edge: u32,
}

/// The disc that a many-cornered patch stands for: the end of a cylinder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Disc {
    /// Its centre, m.
    pub(crate) centre: Vec3,
    /// Body-fixed axes in its plane.
    pub(crate) axes: [Vec3; 2],
    /// Radius, m.
    pub(crate) radius: f64,
    /// Number of the rim where an edge enters it; where one leaves it, one more.
    pub(crate) rim: u32,
}

/// One corner: a vertex; two: an edge; more: a face, counter-clockwise about its outward normal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patch {
    /// The corners.
    pub(crate) corners: Vec<Corner>,
    /// Outward unit normal of a face.
    pub(crate) normal: Vec3,
    /// The disc that the corners lie on, if it is one.
    pub(crate) disc: Option<Disc>,
    /// Number of the face or of the whole shape, for points that are vertices of the other body.
    pub(crate) whole: u32,
}

impl Patch {
    /// Empties the patch for a face with this normal (ignored below three corners).
    #[inline]
    pub(crate) fn begin(&mut self, normal: Vec3, whole: u32) {
        self.corners.clear();
        self.normal = normal;
        self.whole = whole;
        self.disc = None;
    }

    /// Appends a corner.
    #[inline]
    pub(crate) fn push(&mut self, p: Vec3, vertex: u32, edge: u32) {
        self.corners.push(Corner { p, vertex, edge });
    }

    /// Moves the patch to the parent frame.
    #[inline]
    pub(crate) fn transform(&mut self, frame: &Frame) {
        for c in &mut self.corners {
            c.p = frame.point(&c.p);
        }
        self.normal = frame.rot * self.normal;
        if let Some(disc) = &mut self.disc {
            disc.centre = frame.point(&disc.centre);
            disc.axes = disc.axes.map(|axis| frame.rot * axis);
        }
    }
}

/// Two unit vectors that make a right-handed basis with the unit vector `n`; a function of `n` alone.
#[inline]
pub(crate) fn tangents(n: &Vec3) -> (Vec3, Vec3) {
    let (x, y, z) = (n.x.abs(), n.y.abs(), n.z.abs());
    let helper = if x <= y && x <= z {
        Vec3::new(1.0, 0.0, 0.0)
    } else if y <= z {
        Vec3::new(0.0, 1.0, 0.0)
    } else {
        Vec3::new(0.0, 0.0, 1.0)
    };
    let t1 = n.cross(&helper).normalize();
    (t1, n.cross(&t1))
}

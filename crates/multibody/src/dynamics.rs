//! Inverse and forward dynamics, mass matrix, momentum and energy.
//!
//! Generalised velocity (V_B, v): base twist (angular first, W axes, about the anchor), then the joint coordinates.
//! Accelerations of the base are *spatial*: the rate of the twist about the anchor taken as fixed in W; the classical
//! acceleration of the base origin is `lin` + ω × v.
//!
//!   M (A_B, v̇) + c = (F_B, τ)           F_B: wrench on the base about the anchor; zero when it floats free
//!
//! Algorithms: recursive Newton–Euler, composite rigid body and articulated body (Featherstone 2008, ch. 5, 6, 7, 9),
//! all in one frame, so that composites are sums.

use crate::{Kinematics, Tree};
use spatial::{Inertia, SpatialMatrix, Twist, Vec3, Wrench};

/// Scratch of the recursions; sized once from the tree.
#[derive(Clone, Debug)]
pub struct Dynamics {
    /// Spatial accelerations of the bodies.
    pub acc: Vec<Twist>,
    /// Wrenches that the parents' joints transmit, about the anchor; the first is the base's total.
    pub wrench: Vec<Wrench>,
    pub(crate) composite: Vec<SpatialMatrix>,
    locked: Vec<Inertia>,
    pub(crate) force: Vec<Wrench>,
    pub(crate) articulated: crate::aba::ArticulatedScratch,
    paths: Vec<Moves>,
    /// Body by body where its path begins, and the end.
    path_starts: Vec<usize>,
}

/// A screw that moves a body: its place in [`Kinematics::screws`], and the coordinate that it belongs to.
#[derive(Clone, Copy, Debug)]
pub struct Moves {
    /// Index into the screws.
    pub column: u32,
    /// Index into v.
    pub coordinate: u32,
}

impl Dynamics {
    /// Room for one vehicle.
    pub fn new(tree: &Tree) -> Self {
        let n = tree.bodies.len();
        let (mut paths, mut path_starts) = (Vec::new(), vec![0]);
        for body in 0..n {
            add_path(tree, body, &mut paths);
            path_starts.push(paths.len());
        }
        Self {
            acc: vec![Twist::default(); n],
            wrench: vec![Wrench::default(); n],
            composite: vec![SpatialMatrix::default(); n],
            locked: vec![Inertia::default(); n],
            force: vec![Wrench::default(); 6],
            articulated: crate::aba::ArticulatedScratch::new(tree),
            paths,
            path_starts,
        }
    }

    /// The screws that move a body, from the tip inwards.
    #[inline]
    pub fn path(&self, body: usize) -> &[Moves] {
        &self.paths[self.path_starts[body]..self.path_starts[body + 1]]
    }

    /// Inverse dynamics: joint efforts `tau` and the base wrench (about the anchor, W axes) that produce the given
    /// accelerations against the external wrenches `external` (per body, about the anchor, W axes).
    pub fn calc_inverse(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        motion: &Accelerations<'_>,
        external: &[Wrench],
        tau: &mut [f64],
    ) -> Wrench {
        self.calc_body_wrenches(tree, kin, motion, external);
        let base = self.collect(tree, kin, tau);
        for joint in tree.joints.iter().filter(|j| j.armature != 0.0 && !j.is_mimic && !motion.v_dot.is_empty()) {
            let range = joint.v_index..joint.v_index + joint.width;
            for (tau, v_dot) in tau[range.clone()].iter_mut().zip(&motion.v_dot[range]) {
                *tau += joint.armature * v_dot;
            }
        }
        base
    }

    /// First half of the inverse dynamics: per body, the wrench that its motion takes beyond the external ones.
    pub fn calc_body_wrenches(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        motion: &Accelerations<'_>,
        external: &[Wrench],
    ) {
        self.acc[0] = motion.base;
        for (j, joint) in tree.joints.iter().enumerate() {
            let parent = tree.bodies[j + 1].parent;
            let mut rate = Twist::default();
            for k in 0..joint.width {
                rate += kin.screws[joint.column + k] * motion.v[joint.v_index + k];
            }
            let mut acc = self.acc[parent];
            if !motion.v_dot.is_empty() {
                for k in 0..joint.width {
                    acc += kin.screws[joint.column + k] * motion.v_dot[joint.v_index + k];
                }
            }
            self.acc[j + 1] = acc + kin.vel[parent].cross_motion(&rate);
        }
        for (body, wrench) in self.wrench.iter_mut().enumerate() {
            let momentum = kin.inertia[body].momentum(&kin.vel[body]);
            *wrench =
                kin.inertia[body].momentum(&self.acc[body]) + kin.vel[body].cross_force(&momentum) - external[body];
        }
    }

    /// Second half: sums `wrench` from the tips to the base; joint efforts into `tau`, the base's wrench returned.
    pub fn collect(&mut self, tree: &Tree, kin: &Kinematics, tau: &mut [f64]) -> Wrench {
        tau.fill(0.0);
        for (j, joint) in tree.joints.iter().enumerate().rev() {
            let wrench = self.wrench[j + 1];
            for k in 0..joint.width {
                tau[joint.v_index + k] += kin.screws[joint.column + k].dot(&wrench);
            }
            self.wrench[tree.bodies[j + 1].parent] += wrench;
        }
        self.wrench[0]
    }

    /// Mass matrix over (V_B, v), plus `extra` (per body that has any, about the anchor; empty for none): row-major, the full square
    /// of side `stride` ≥ 6 + nv written from `m[0]`.
    pub fn calc_mass_matrix(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        extra: &[Option<SpatialMatrix>],
        m: &mut [f64],
        stride: usize,
    ) {
        let n = 6 + tree.nv;
        for row in m.chunks_mut(stride).take(n) {
            row[..n].fill(0.0);
        }
        self.add_mass_matrix(tree, kin, extra, m, stride);
        for k in 1..n {
            for l in 0..k {
                m[k * stride + l] = m[l * stride + k];
            }
        }
    }

    /// The same, added to the upper triangle alone, diagonal included; the rest of the square is left as it is.
    pub fn add_mass_matrix(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        extra: &[Option<SpatialMatrix>],
        m: &mut [f64],
        stride: usize,
    ) {
        if extra.is_empty() {
            self.add_rigid(tree, kin, m, (stride, 6));
            add_base_block(&SpatialMatrix::from(&self.locked[0]), m, stride);
        } else {
            self.add_stiffened(tree, kin, extra, m, stride);
            add_base_block(&self.composite[0], m, stride);
        }
        add_armatures(tree, m, (stride, 6));
    }

    /// Mass matrix over the joint coordinates alone, of a vehicle whose base is held: row-major, added to the upper triangle of the square
    /// of side `stride` ≥ nv that begins at `m[0]`.
    pub fn add_joint_mass_matrix(&mut self, tree: &Tree, kin: &Kinematics, m: &mut [f64], stride: usize) {
        self.add_rigid(tree, kin, m, (stride, 0));
        add_armatures(tree, m, (stride, 0));
    }

    /// Composites are inertias: ten numbers each. Joint coordinates begin at row `first`, behind the base's six or none.
    fn add_rigid(&mut self, tree: &Tree, kin: &Kinematics, m: &mut [f64], at: (usize, usize)) {
        self.locked.copy_from_slice(&kin.inertia);
        for (j, joint) in tree.joints.iter().enumerate().rev() {
            let locked = self.locked[j + 1];
            for k in 0..joint.width {
                self.force[k] = locked.momentum(&kin.screws[joint.column + k]);
            }
            self.add_joint_rows(tree, kin, j, m, at);
            self.locked[tree.bodies[j + 1].parent] += locked;
        }
    }

    /// What stiffness adds to them is any symmetric matrix.
    fn add_stiffened(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        extra: &[Option<SpatialMatrix>],
        m: &mut [f64],
        stride: usize,
    ) {
        for ((composite, inertia), extra) in self.composite.iter_mut().zip(&kin.inertia).zip(extra) {
            *composite = SpatialMatrix::from(inertia);
            if let Some(extra) = extra {
                *composite += *extra;
            }
        }
        for (j, joint) in tree.joints.iter().enumerate().rev() {
            let composite = self.composite[j + 1];
            for k in 0..joint.width {
                self.force[k] = composite.mul(&kin.screws[joint.column + k]);
            }
            self.add_joint_rows(tree, kin, j, m, (stride, 6));
            self.composite[tree.bodies[j + 1].parent] += composite;
        }
    }

    /// What a joint shares with itself and with all that moves it, when its unit gains take the wrenches `force` of all that hangs on it: its
    /// entries of the upper triangle.
    fn add_joint_rows(&self, tree: &Tree, kin: &Kinematics, j: usize, m: &mut [f64], (stride, first): (usize, usize)) {
        let joint = &tree.joints[j];
        for k in 0..joint.width {
            let (row, force) = (first + joint.v_index + k, self.force[k]);
            for l in k..joint.width {
                m[row * stride + row - k + l] += kin.screws[joint.column + l].dot(&force);
            }
            for above in self.path(tree.bodies[j + 1].parent) {
                let value = kin.screws[above.column as usize].dot(&force);
                let column = first + above.coordinate as usize;
                let entry = &mut m[row.min(column) * stride + row.max(column)];
                *entry += value;
                // A mimic joint below its leader meets its own coordinate: both halves land on the diagonal.
                *entry += if row == column { value } else { 0.0 };
            }
            if first == 6 {
                let base =
                    [force.moment.x, force.moment.y, force.moment.z, force.force.x, force.force.y, force.force.z];
                for (above, value) in m.chunks_exact_mut(stride).zip(base) {
                    above[row] += value;
                }
            }
        }
    }
}

fn add_path(tree: &Tree, mut body: usize, path: &mut Vec<Moves>) {
    while body != 0 {
        let joint = &tree.joints[body - 1];
        let moves = |k: usize| Moves { column: (joint.column + k) as u32, coordinate: (joint.v_index + k) as u32 };
        path.extend((0..joint.width).map(moves));
        body = tree.bodies[body].parent;
    }
}

fn add_armatures(tree: &Tree, m: &mut [f64], (stride, first): (usize, usize)) {
    for joint in tree.joints.iter().filter(|j| j.armature != 0.0 && !j.is_mimic) {
        for k in first + joint.v_index..first + joint.v_index + joint.width {
            m[k * stride + k] += joint.armature;
        }
    }
}

fn add_base_block(total: &SpatialMatrix, m: &mut [f64], stride: usize) {
    for i in 0..3 {
        for j in i..3 {
            m[i * stride + j] += total.ma[(i, j)];
            m[(3 + i) * stride + 3 + j] += total.fl[(i, j)];
        }
        for j in 0..3 {
            m[i * stride + 3 + j] += total.ml[(i, j)];
        }
    }
}

/// Velocities and accelerations for the inverse dynamics.
#[derive(Clone, Copy, Debug)]
pub struct Accelerations<'a> {
    /// Spatial acceleration of the base about the anchor.
    pub base: Twist,
    /// Joint rates.
    pub v: &'a [f64],
    /// Joint accelerations; empty where all are zero.
    pub v_dot: &'a [f64],
}

/// Momentum about the anchor, W axes: angular in the moment slot, linear in the force slot.
pub fn calc_momentum(kin: &Kinematics) -> Wrench {
    kin.inertia.iter().zip(&kin.vel).fold(Wrench::default(), |sum, (i, v)| sum + i.momentum(v))
}

/// Inertia of the whole vehicle with its joints locked, about the anchor, W axes.
pub fn calc_locked_inertia(kin: &Kinematics) -> Inertia {
    kin.inertia.iter().fold(Inertia::default(), |sum, i| sum + *i)
}

/// Centroidal momentum: centre of mass in W (m), angular momentum about it and linear momentum, W axes.
pub fn calc_centroidal_momentum(kin: &Kinematics) -> (Vec3, Wrench) {
    let com = calc_locked_inertia(kin).com();
    (kin.anchor + com, calc_momentum(kin).about(&com))
}

/// Kinetic energy of the bodies, J; that of the armatures is [`calc_armature_energy`].
pub fn calc_kinetic_energy(kin: &Kinematics) -> f64 {
    kin.inertia.iter().zip(&kin.vel).map(|(i, v)| i.kinetic_energy(v)).sum()
}

/// Kinetic energy of the joints' armatures at the rates `v`, J.
pub fn calc_armature_energy(tree: &Tree, v: &[f64]) -> f64 {
    let of = |j: &crate::Joint| 0.5 * j.armature * v[j.v_index..j.v_index + j.width].iter().map(|v| v * v).sum::<f64>();
    tree.joints.iter().filter(|j| j.armature != 0.0 && !j.is_mimic).map(of).sum()
}

/// Potential energy in a uniform gravity field (W axes, m/s²), zero at the world's origin, J.
pub fn calc_potential_energy(kin: &Kinematics, gravity: &Vec3) -> f64 {
    -kin.inertia.iter().map(|i| gravity.dot(&(i.mc + i.mass * kin.anchor))).sum::<f64>()
}

/// Adds the weight of every body to `external`, about the anchor.
pub fn add_gravity(kin: &Kinematics, gravity: &Vec3, external: &mut [Wrench]) {
    for (inertia, wrench) in kin.inertia.iter().zip(external) {
        *wrench += Wrench::new(inertia.mc.cross(gravity), inertia.mass * gravity);
    }
}

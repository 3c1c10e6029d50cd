//! Forward dynamics by the articulated-body algorithm (Featherstone 2008, section 7.3), in one frame.
//!
//!   U = Iᴬ S,  D = Sᵀ U,  u = τ − Sᵀ pᴬ
//!   to the parent:  Iᴬ − U D⁻¹ Uᵀ,   pᴬ + Iᵃ c + U D⁻¹ u
//!
//! A joint's armature adds to its D. A mimic joint couples two places of the tree and breaks the recursion: use the mass
//! matrix there.

use crate::{Dynamics, Kinematics, Tree};
use spatial::{Mat3, SpatialMatrix, Twist, Wrench, nalgebra};

type Mat6 = nalgebra::Matrix6<f64>;

/// Scratch of the articulated-body recursion.
#[derive(Clone, Debug)]
pub(crate) struct ArticulatedScratch {
    bias: Vec<Wrench>,
    u: Vec<Wrench>,
    residual: Vec<f64>,
    d_inverse: Vec<Mat6>,
    coriolis: Vec<Twist>,
}

impl ArticulatedScratch {
    pub(crate) fn new(tree: &Tree) -> Self {
        let (n, columns) = (tree.bodies.len(), tree.n_columns());
        Self {
            bias: vec![Wrench::default(); n],
            u: vec![Wrench::default(); columns],
            residual: vec![0.0; columns],
            d_inverse: vec![Mat6::zeros(); tree.joints.len()],
            coriolis: vec![Twist::default(); n],
        }
    }
}

/// What drives the forward dynamics.
#[derive(Clone, Copy, Debug)]
pub struct Drive<'a> {
    /// Joint rates.
    pub v: &'a [f64],
    /// Joint efforts, N·m or N.
    pub tau: &'a [f64],
    /// External wrenches per body, about the anchor, W axes.
    pub external: &'a [Wrench],
    /// Whether the base moves.
    pub base_free: bool,
}

impl Dynamics {
    /// Joint accelerations into `v_dot`; returns the base's spatial acceleration about the anchor (zero if held).
    ///
    /// `None` if the tree has mimic joints, or if an articulated inertia is singular (within rounding, garbage).
    pub fn calc_forward(
        &mut self,
        tree: &Tree,
        kin: &Kinematics,
        drive: &Drive<'_>,
        v_dot: &mut [f64],
    ) -> Option<Twist> {
        if tree.has_mimic() {
            return None;
        }
        for body in 0..tree.bodies.len() {
            let momentum = kin.inertia[body].momentum(&kin.vel[body]);
            self.composite[body] = SpatialMatrix::from(&kin.inertia[body]);
            self.articulated.bias[body] = kin.vel[body].cross_force(&momentum) - drive.external[body];
        }
        for j in (0..tree.joints.len()).rev() {
            self.fold_joint(tree, kin, drive, j)?;
        }
        let base = if drive.base_free { self.solve_base()? } else { Twist::default() };
        self.acc[0] = base;
        for j in 0..tree.joints.len() {
            self.unfold_joint(tree, kin, j, v_dot);
        }
        Some(base)
    }

    fn fold_joint(&mut self, tree: &Tree, kin: &Kinematics, drive: &Drive<'_>, j: usize) -> Option<()> {
        let (joint, parent, body) = (&tree.joints[j], tree.bodies[j + 1].parent, j + 1);
        let scratch = &mut self.articulated;
        let mut rate = Twist::default();
        let mut d = Mat6::identity();
        for k in 0..joint.width {
            let screw = kin.screws[joint.column + k];
            rate += screw * drive.v[joint.v_index + k];
            let u = self.composite[body].mul(&screw);
            scratch.u[joint.column + k] = u;
            scratch.residual[joint.column + k] = drive.tau[joint.v_index + k] - screw.dot(&scratch.bias[body]);
            for l in 0..joint.width {
                d[(l, k)] = kin.screws[joint.column + l].dot(&u);
            }
        }
        for k in 0..joint.width {
            d[(k, k)] += joint.armature;
        }
        let d_inverse = match joint.width {
            1 if d[(0, 0)] <= 0.0 => return None,
            1 => Mat6::from_diagonal_element(1.0 / d[(0, 0)]),
            _ => d.try_inverse()?,
        };
        scratch.d_inverse[j] = d_inverse;
        scratch.coriolis[body] = kin.vel[parent].cross_motion(&rate);
        let mut reduced = self.composite[body];
        let mut carried = Wrench::default();
        for k in 0..joint.width {
            for l in 0..joint.width {
                let (uk, ul) = (scratch.u[joint.column + k], scratch.u[joint.column + l]);
                subtract_outer(&mut reduced, &uk, &ul, d_inverse[(k, l)]);
                carried += uk * (d_inverse[(k, l)] * scratch.residual[joint.column + l]);
            }
        }
        let bias = scratch.bias[body] + reduced.mul(&scratch.coriolis[body]) + carried;
        scratch.bias[parent] += bias;
        self.composite[parent] += reduced;
        Some(())
    }

    fn solve_base(&self) -> Option<Twist> {
        let (m, bias) = (&self.composite[0], &self.articulated.bias[0]);
        let mut a = Mat6::zeros();
        a.fixed_view_mut::<3, 3>(0, 0).copy_from(&m.ma);
        a.fixed_view_mut::<3, 3>(0, 3).copy_from(&m.ml);
        a.fixed_view_mut::<3, 3>(3, 0).copy_from(&m.fa);
        a.fixed_view_mut::<3, 3>(3, 3).copy_from(&m.fl);
        let (mo, f) = (bias.moment, bias.force);
        let x = a.cholesky()?.solve(&nalgebra::Vector6::new(-mo.x, -mo.y, -mo.z, -f.x, -f.y, -f.z));
        Some(Twist::new(x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<3>(3).into_owned()))
    }

    fn unfold_joint(&mut self, tree: &Tree, kin: &Kinematics, j: usize, v_dot: &mut [f64]) {
        let (joint, scratch) = (&tree.joints[j], &self.articulated);
        let mut acc = self.acc[tree.bodies[j + 1].parent] + scratch.coriolis[j + 1];
        let arriving = acc;
        for k in 0..joint.width {
            let mut value = 0.0;
            for l in 0..joint.width {
                let drive = scratch.residual[joint.column + l] - arriving.dot(&scratch.u[joint.column + l]);
                value += scratch.d_inverse[j][(k, l)] * drive;
            }
            v_dot[joint.v_index + k] = value;
            acc += kin.screws[joint.column + k] * value;
        }
        self.acc[j + 1] = acc;
    }
}

fn subtract_outer(m: &mut SpatialMatrix, a: &Wrench, b: &Wrench, k: f64) {
    let outer = |x: &spatial::Vec3, y: &spatial::Vec3| -> Mat3 { (k * x) * y.transpose() };
    m.ma -= outer(&a.moment, &b.moment);
    m.ml -= outer(&a.moment, &b.force);
    m.fa -= outer(&a.force, &b.moment);
    m.fl -= outer(&a.force, &b.force);
}

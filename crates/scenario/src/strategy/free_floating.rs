//! Resolved-rate control of a free-floating arm by the generalised Jacobian (Umetani and Yoshida 1989).
//!
//!   H_b V_B + H_q q̇ = h                         momentum, about the base origin
//!   V_E = J_b V_B + J_q q̇ = J* q̇ + V_0,   J* = J_q − J_b H_b⁻¹ H_q,   V_0 = J_b H_b⁻¹ h
//!   q̇ = J*ᵀ (J* J*ᵀ + λ² 1)⁻¹ (V_E − V_0) + null-space motion towards a comfortable pose
//!
//! On a held base V_B is zero and J* is the plain Jacobian.

use multibody::{Dynamics, Kinematics};
use sim::{Base, Vehicle, World};
use spatial::{Twist, Vec3, nalgebra};

type Mat6 = nalgebra::Matrix6<f64>;
type Vec6 = nalgebra::Vector6<f64>;

/// An arm whose joints move a tool.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    pub(super) vehicle: usize,
    pub(super) link: usize,
    /// Coordinates of the arm, indices into the vehicle's `v`.
    pub(super) coordinates: Vec<usize>,
}

/// What the rates shall do.
#[derive(Clone, Copy, Debug)]
pub(super) struct RateRequest<'a> {
    /// Twist of the tool about its origin, W axes.
    pub(super) twist: Twist,
    /// Damping λ of the inverse.
    pub(super) damping: f64,
    /// Rates that the null space takes up where it can, by arm coordinate.
    pub(super) wish: &'a [f64],
}

fn stacked(t: &Twist) -> Vec6 {
    Vec6::new(t.ang.x, t.ang.y, t.ang.z, t.lin.x, t.lin.y, t.lin.z)
}

impl Arm {
    /// Joint rates that give the tool its twist.
    pub(super) fn calc_rates(&self, world: &World, request: &RateRequest<'_>) -> Vec<f64> {
        let vehicle = &world.model().vehicles[self.vehicle];
        let kin = world.kinematics(self.vehicle);
        let (columns, drift) = self.calc_jacobian(world, vehicle, kin);
        let mut jjt = Mat6::identity() * (request.damping * request.damping);
        for c in &columns {
            jjt += c * c.transpose();
        }
        let Some(factor) = jjt.cholesky() else { return vec![0.0; columns.len()] };
        let wished: Vec6 = columns.iter().zip(request.wish).map(|(c, w)| c * *w).sum();
        let x = factor.solve(&(stacked(&request.twist) - drift - wished));
        columns.iter().zip(request.wish).map(|(c, w)| c.dot(&x) + w).collect()
    }

    /// Columns of J*, and V_0.
    fn calc_jacobian(&self, world: &World, vehicle: &Vehicle, kin: &Kinematics) -> (Vec<Vec6>, Vec6) {
        let tree = &vehicle.tree;
        let n = 6 + tree.nv;
        let mut columns = vec![Twist::default(); n];
        let tool = world.link_frame(self.vehicle, self.link).pos;
        kin.calc_jacobian(tree, tree.links[self.link].body, &tool, &mut columns);
        let own = |k: &usize| stacked(&columns[6 + k]);
        if vehicle.base != Base::Free {
            return (self.coordinates.iter().map(own).collect(), Vec6::zeros());
        }
        let mut mass = vec![0.0; n * n];
        Dynamics::new(tree).calc_mass_matrix(tree, kin, &[], &mut mass, n);
        let locked = Mat6::from_fn(|i, j| mass[i * n + j]);
        let Some(locked) = locked.cholesky() else {
            return (self.coordinates.iter().map(own).collect(), Vec6::zeros());
        };
        let j_base = Mat6::from_fn(|i, j| stacked(&columns[j])[i]);
        let coupling = |k: &usize| Vec6::from_fn(|i, _| mass[i * n + 6 + k]);
        let reduced = |k: &usize| own(k) - j_base * locked.solve(&coupling(k));
        let momentum = multibody::calc_momentum(kin);
        let h = stacked(&Twist::new(momentum.moment, momentum.force));
        // Joints beyond the arm (a gripper that closes) move too: their part of the momentum is not the base's.
        let others: Vec6 = (0..tree.nv)
            .filter(|k| !self.coordinates.contains(k))
            .map(|k| coupling(&k) * world.state().v[vehicle.v0 + k])
            .sum();
        (self.coordinates.iter().map(reduced).collect(), j_base * locked.solve(&(h - others)))
    }
}

/// Rotation vector and translation that bring `frame` to `goal`, each cut to a length.
pub(super) fn calc_bounded_error(frame: &spatial::Frame, goal: &spatial::Pose, longest: [f64; 2]) -> Twist {
    let (turn, shift) = crate::build::halves(&crate::build::calc_error(frame, goal));
    let cut = |v: Vec3, most: f64| if v.norm() > most { v * (most / v.norm()) } else { v };
    Twist::new(cut(turn, longest[0]), cut(shift, longest[1]))
}

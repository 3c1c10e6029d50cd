//! Freedoms that nothing resists: where the mass matrix is singular whatever the configuration.
//!
//! With the coordinates ordered from the base to the tips, eliminating them from the last to the first leaves on the
//! diagonal what the articulated-body algorithm divides by,
//!   D_i = M_ii − Σ_k M_ik M_kk⁻¹ M_ki,   k outboard of i:
//! the inertia that the rest of the tree, free to give way, puts up against coordinate i. Where it vanishes no force
//! decides the acceleration: a joint that carries nothing with mass, one that turns a point mass about itself, or the
//! innermost of three whose axes meet in front of a point mass.
//!
//! A mass matrix that is singular in one configuration alone says nothing of the robot, so several are looked at, and only
//! what vanishes in all of them is the robot's ([`find_singular_freedoms`]). A simulation that begins in such a
//! configuration still cannot take its first step ([`find_singular_freedoms_at`]).

use crate::{Dynamics, Kinematics, Tree};
use spatial::{Inertia, Pose, Twist};

/// D below this part of the inertias it is made of is rounding: a hundred operations of 1e-16 each, and as much again.
const ROUNDING: f64 = 1e-13;
/// Configurations that are looked at.
const LOOKS: usize = 3;
/// Larger mass matrices are not looked at (their elimination costs the cube): no robot has half as many freedoms.
const MOST_FREEDOMS: usize = 500;

/// What can move by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// The base.
    Base,
    /// A joint of the tree, by its index.
    Joint(usize),
}

/// What has no inertia against it in a tree whose base is free in the marked components of its twist (angular x, y, z,
/// then linear, in its axes): from the base to the tips. Armatures count.
pub fn find_singular_freedoms(tree: &Tree, base: [bool; 6]) -> Vec<Freedom> {
    let mut is_singular = vec![tree.nv <= MOST_FREEDOMS; 6 + tree.nv];
    for pivots in looks(tree, base) {
        is_singular.iter_mut().zip(pivots).for_each(|(singular, pivot)| *singular &= !pivot.is_positive());
    }
    freedoms_of(tree, base, &is_singular)
}

/// As [`find_singular_freedoms`], in the configuration `q` alone.
pub fn find_singular_freedoms_at(tree: &Tree, base: [bool; 6], q: &[f64]) -> Vec<Freedom> {
    if tree.nv > MOST_FREEDOMS {
        return Vec::new();
    }
    let is_singular: Vec<bool> = calc_pivots(tree, base, q).iter().map(|pivot| !pivot.is_positive()).collect();
    freedoms_of(tree, base, &is_singular)
}

fn freedoms_of(tree: &Tree, base: [bool; 6], is_singular: &[bool]) -> Vec<Freedom> {
    let base = (0..6).any(|i| base[i] && is_singular[i]).then_some(Freedom::Base);
    let joints = tree.joints.iter().enumerate().filter(|(_, j)| !j.is_mimic);
    let joints = joints.filter(|(_, j)| is_singular[6 + j.v_index..6 + j.v_index + j.width].contains(&true));
    base.into_iter().chain(joints.map(|(j, _)| Freedom::Joint(j))).collect()
}

/// Whether a tree that floats free has a motion of negative kinetic energy in some of the configurations: some body's
/// inertia is impossible, and no other makes up for it.
pub(crate) fn has_negative_energy(tree: &Tree) -> bool {
    looks(tree, [true; 6]).flatten().any(|pivot| pivot.is_negative())
}

fn looks(tree: &Tree, base: [bool; 6]) -> impl Iterator<Item = Vec<Pivot>> + '_ {
    let count = if tree.nv > MOST_FREEDOMS { 0 } else { LOOKS };
    (0..count).map(move |look| calc_pivots(tree, base, &probe(tree, look)))
}

/// A D, and the sum of the magnitudes that M_ii is made of.
struct Pivot {
    value: f64,
    size: f64,
}

impl Pivot {
    fn is_positive(&self) -> bool {
        self.value > ROUNDING * self.size
    }

    fn is_negative(&self) -> bool {
        self.value < -ROUNDING * self.size
    }
}

/// A configuration where nothing stands at a right angle or in a line: steps of the golden ratio, within ±1 rad or m.
fn probe(tree: &Tree, look: usize) -> Vec<f64> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let xi: Vec<f64> = (0..tree.nv).map(|i| 2.0 * (GOLDEN * (1 + i + look * 7) as f64).fract() - 1.0).collect();
    let mut q = tree.q_zero.clone();
    tree.retract(&mut q, &xi);
    q
}

/// D of every row of the mass matrix; zero in rows of a held base.
fn calc_pivots(tree: &Tree, base: [bool; 6], q: &[f64]) -> Vec<Pivot> {
    let n = 6 + tree.nv;
    let mut kin = Kinematics::new(tree);
    kin.update_positions(tree, &Pose::identity(), q);
    let mut m = vec![0.0; n * n];
    Dynamics::new(tree).calc_mass_matrix(tree, &kin, &[], &mut m, n);
    let mut pivots: Vec<Pivot> = calc_sizes(tree, &kin).into_iter().map(|size| Pivot { value: 0.0, size }).collect();
    let is_free = |i: &usize| *i >= 6 || base[*i];
    for i in (0..n).rev().filter(is_free) {
        let pivot = &mut pivots[i];
        pivot.value = m[i * n + i];
        if !pivot.is_positive() && !pivot.is_negative() {
            continue;
        }
        // Rows and columns before i, in the lower triangle.
        let (above, row) = m.split_at_mut(i * n);
        for r in (0..i).filter(|r| row[*r] != 0.0) {
            let share = row[r] / pivot.value;
            above[r * n..=r * n + r].iter_mut().zip(&row[..=r]).for_each(|(m, k)| *m -= share * k);
        }
    }
    pivots
}

/// Per row the sizes.
fn calc_sizes(tree: &Tree, kin: &Kinematics) -> Vec<f64> {
    let mut composite: Vec<Inertia> = kin.inertia.clone();
    let mut sizes = vec![0.0; 6 + tree.nv];
    for (j, joint) in tree.joints.iter().enumerate().rev() {
        let own = composite[j + 1];
        for k in 0..joint.width {
            sizes[6 + joint.v_index + k] += size_of(&own, &kin.screws[joint.column + k]);
        }
        composite[tree.bodies[j + 1].parent] += own;
    }
    let total = &composite[0];
    sizes[..3].fill(total.rot.norm());
    sizes[3..6].fill(total.mass);
    sizes
}

fn size_of(inertia: &Inertia, screw: &Twist) -> f64 {
    let (turn, slide) = (screw.ang.norm(), screw.lin.norm());
    inertia.rot.norm() * turn * turn + 2.0 * inertia.mc.norm() * turn * slide + inertia.mass * slide * slide
}

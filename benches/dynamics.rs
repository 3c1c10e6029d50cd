//! What do the kernels cost?
//!
//! ```text
//! cargo bench --no-default-features --bench dynamics
//! ```
//!
//! The tree algorithms on robots/bench/peer-arm7.urdf (7 revolute joints), its base bolted down (7 degrees of freedom) or
//! free (13). One iteration is one call at a state in motion. Everything but `kinematics` starts from known kinematics,
//! and `momentum_and_base_twist` is what a step adds for its momentum state. Only ABA and the factorisation know whether
//! the base is free: the other kernels always carry it along, so their two rows are the same work.
//!
//! Other libraries, same arm, ns on two virtual cores of a Xeon (family 6, model 207):
//!
//! | | fixed 7 | free 13 |
//! | --- | --- | --- |
//! | Pinocchio 4.1.0 (-O3), ABA in world axes, kinematics included | 1551 | 1996 |
//! | Pinocchio, RNEA, kinematics included | 788 | 902 |
//! | Pinocchio, CRBA, kinematics included | 398 | 490 |
//! | Pinocchio, CRBA, Cholesky and inverse | 839 | 1967 |
//! | Pinocchio, all joint Jacobians, kinematics included | 267 | 307 |
//! | MuJoCo 4.0.0, whole mj_forward without contact | 1135 | 1536 |
//! | MuJoCo, kinematics, CRBA and factorisation | 604 | 866 |
//! | MuJoCo, RNEA, velocities known | 178 | 207 |
//! | MuJoCo, Jacobian of one body, kinematics known | 21 | 33 |
//! | Drake 1.51.1, EvalTimeDerivatives | 9199 | 10332 |

use divan::{Bencher, black_box};
use softdock::multibody::{
    Accelerations, Drive, Dynamics, Kinematics, SearchPaths, Tree, calc_locked_inertia, calc_momentum, load_urdf,
};
use softdock::spatial::nalgebra::{Cholesky, SMatrix};
use softdock::spatial::{Pose, Rot, Twist, Vec3, Wrench};
use std::path::Path;

/// Whether the base is free.
const BASES: [Base; 2] = [Base::Fixed7, Base::Free13];

/// Freedoms of the arm with its base.
const N: usize = 13;

#[derive(Clone, Copy, Debug)]
enum Base {
    Fixed7,
    Free13,
}

fn main() {
    divan::main();
}

#[divan::bench(args = BASES)]
fn kinematics(bencher: Bencher<'_, '_>, base: Base) {
    let mut arm = Arm::new(base);
    bencher.bench_local(move || {
        arm.update();
        black_box(&arm.kin);
    });
}

#[divan::bench(args = BASES)]
fn momentum_and_base_twist(bencher: Bencher<'_, '_>, base: Base) {
    let arm = Arm::new(base);
    bencher.bench_local(|| {
        let kin = black_box(&arm.kin);
        calc_locked_inertia(kin).twist_of(&calc_momentum(kin))
    });
}

#[divan::bench(args = BASES)]
fn rnea(bencher: Bencher<'_, '_>, base: Base) {
    let mut arm = Arm::new(base);
    let base_acceleration = arm.twist;
    bencher.bench_local(move || {
        let Arm { tree, kin, dynamics, v, v_dot, tau, external, .. } = &mut arm;
        let motion = Accelerations { base: base_acceleration, v, v_dot };
        black_box(dynamics.calc_inverse(tree, black_box(kin), &motion, external, tau));
    });
}

#[divan::bench(args = BASES)]
fn aba(bencher: Bencher<'_, '_>, base: Base) {
    let mut arm = Arm::new(base);
    bencher.bench_local(move || {
        let Arm { tree, kin, dynamics, v, v_dot, tau, external, .. } = &mut arm;
        let drive = Drive { v, tau, external, base_free: matches!(base, Base::Free13) };
        black_box(dynamics.calc_forward(tree, black_box(kin), &drive, v_dot));
    });
}

#[divan::bench(args = BASES)]
fn crba(bencher: Bencher<'_, '_>, base: Base) {
    let (mut arm, mut m) = (Arm::new(base), [0.0; N * N]);
    bencher.bench_local(move || {
        arm.dynamics.calc_mass_matrix(&arm.tree, black_box(&arm.kin), &[], &mut m, N);
        black_box(&m);
    });
}

#[divan::bench(args = BASES)]
fn crba_and_cholesky(bencher: Bencher<'_, '_>, base: Base) {
    let (mut arm, mut m) = (Arm::new(base), [0.0; N * N]);
    bencher.bench_local(move || {
        arm.dynamics.calc_mass_matrix(&arm.tree, black_box(&arm.kin), &[], &mut m, N);
        match base {
            Base::Fixed7 => black_box(factor::<7>(&m)),
            Base::Free13 => black_box(factor::<13>(&m)),
        }
    });
}

#[divan::bench(args = BASES)]
fn jacobian_of_the_tip(bencher: Bencher<'_, '_>, base: Base) {
    let (arm, mut columns) = (Arm::new(base), [Twist::default(); N]);
    let tip = arm.tree.bodies.len() - 1;
    let point_w = arm.kin.frame(tip).point(&Vec3::new(0.0, 0.0, 0.1));
    bencher.bench_local(move || {
        arm.kin.calc_jacobian(&arm.tree, tip, black_box(&point_w), &mut columns);
        black_box(&columns);
    });
}

/// Pivot of the last freedom of the Cholesky factor of the last K freedoms' block.
fn factor<const K: usize>(m: &[f64; N * N]) -> f64 {
    let block = SMatrix::<f64, K, K>::from_fn(|i, j| m[(N - K + i) * N + N - K + j]);
    Cholesky::new(block).expect("a mass matrix is positive definite").l_dirty()[(K - 1, K - 1)]
}

/// The arm in motion.
struct Arm {
    tree: Tree,
    kin: Kinematics,
    dynamics: Dynamics,
    pose: Pose,
    twist: Twist,
    q: Vec<f64>,
    v: Vec<f64>,
    v_dot: Vec<f64>,
    tau: Vec<f64>,
    external: Vec<Wrench>,
}

impl Arm {
    fn new(base: Base) -> Self {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/bench/peer-arm7.urdf");
        let robot = load_urdf(&file, &SearchPaths::default()).unwrap_or_else(|e| panic!("{e}")).robot;
        let tree = Tree::from_description(&robot);
        assert_eq!(6 + tree.nv, N, "the arm has seven joints");
        let (pose, twist) = match base {
            Base::Fixed7 => (Pose::identity(), Twist::default()),
            Base::Free13 => (
                Pose::from_parts(Vec3::new(1.0, -2.0, 0.5).into(), Rot::from_euler_angles(0.3, -0.2, 0.7)),
                Twist::new(Vec3::new(0.03, -0.02, 0.05), Vec3::new(0.1, 0.2, -0.1)),
            ),
        };
        let series = |scale: f64| (0..tree.nv).map(|k| scale * (1.0 + k as f64).sin()).collect::<Vec<f64>>();
        let mut arm = Self {
            kin: Kinematics::new(&tree),
            dynamics: Dynamics::new(&tree),
            pose,
            twist,
            q: series(0.8),
            v: series(0.5),
            v_dot: series(0.3),
            tau: series(2.0),
            external: vec![Wrench::default(); tree.bodies.len()],
            tree,
        };
        arm.update();
        arm
    }

    fn update(&mut self) {
        self.kin.update_positions(&self.tree, black_box(&self.pose), black_box(&self.q));
        self.kin.update_velocities(&self.tree, black_box(&self.twist), black_box(&self.v));
    }
}

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

mod fixtures;

use divan::{Bencher, black_box};
use fixtures::arm::{Arm, BASES, Base, N};
use softdock::multibody::{calc_locked_inertia, calc_momentum};
use softdock::spatial::{Twist, Vec3};

fn main() {
    divan::main();
}

#[divan::bench(args = BASES)]
fn kinematics(bencher: Bencher<'_, '_>, base: Base) {
    bench(bencher, base, Arm::update);
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
    bench(bencher, base, Arm::rnea);
}

#[divan::bench(args = BASES)]
fn aba(bencher: Bencher<'_, '_>, base: Base) {
    bench(bencher, base, Arm::aba);
}

#[divan::bench(args = BASES)]
fn crba(bencher: Bencher<'_, '_>, base: Base) {
    bench(bencher, base, Arm::crba);
}

#[divan::bench(args = BASES)]
fn crba_and_cholesky(bencher: Bencher<'_, '_>, base: Base) {
    bench(bencher, base, Arm::crba_and_cholesky);
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

fn bench(bencher: Bencher<'_, '_>, base: Base, kernel: fn(&mut Arm)) {
    let mut arm = Arm::new(base);
    bencher.bench_local(move || kernel(&mut arm));
}

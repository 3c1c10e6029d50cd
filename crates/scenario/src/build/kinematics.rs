//! Inverse kinematics of a start pose: damped least squares with a falling damping (Levenberg 1944, Marquardt 1963).

use multibody::{JointKind, Kinematics, Tree};
use spatial::{Frame, Pose, Twist, Vec3, log_rotation, nalgebra};

type Mat6 = nalgebra::Matrix6<f64>;
type Vec6 = nalgebra::Vector6<f64>;

/// Position error, m, and angle error, rad, of a solution.
const TOLERANCE: f64 = 1e-10;
/// Most iterations; a reachable pose takes about ten.
const ITERATIONS: usize = 300;

/// Moves `q` until `link` is at `goal` (W), with the base held at `pose_wb`. Only joints named in `movable` move, all if
/// it is empty; position limits hold.
pub(crate) fn solve_pose(
    tree: &Tree,
    pose_wb: &Pose,
    link: usize,
    goal: &Pose,
    movable: &[String],
    q: &mut [f64],
) -> Result<(), String> {
    let mut kin = Kinematics::new(tree);
    let mut columns = vec![Twist::default(); 6 + tree.nv];
    let moves = movable_coordinates(tree, movable);
    let mut damping = 1e-2;
    let mut best = f64::INFINITY;
    for _ in 0..ITERATIONS {
        kin.update_positions(tree, pose_wb, q);
        let frame = kin.link_frame(tree, link);
        let error = calc_error(&frame, goal);
        let size = error.norm();
        if size < TOLERANCE {
            return Ok(());
        }
        damping = if size < best { (damping * 0.3_f64).max(1e-12) } else { (damping * 5.0).min(1e3) };
        best = size;
        kin.calc_jacobian(tree, tree.links[link].body, &frame.pos, &mut columns);
        step(tree, &columns, &moves, &error, damping, q);
    }
    Err(format!(
        "\"{}\" cannot reach the pose: {best:.3} (m, rad) are left; move the base or the pose, or give other start joints",
        tree.links[link].name
    ))
}

/// Coordinates that may move: index into q and v, and limits.
fn movable_coordinates(tree: &Tree, names: &[String]) -> Vec<(usize, usize, Option<[f64; 2]>)> {
    let own =
        tree.joints.iter().filter(|j| !j.is_mimic && matches!(j.kind, JointKind::Revolute | JointKind::Prismatic));
    own.filter(|j| names.is_empty() || names.contains(&j.name))
        .map(|j| (j.q_index, j.v_index, j.position_limits))
        .collect()
}

/// Rotation vector and translation from the frame to the goal, W axes.
pub(crate) fn calc_error(frame: &Frame, goal: &Pose) -> Vec6 {
    let turn = log_rotation(&(goal.rotation * frame.to_pose().rotation.inverse()));
    let shift = goal.translation.vector - frame.pos;
    Vec6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z)
}

fn step(
    tree: &Tree,
    columns: &[Twist],
    moves: &[(usize, usize, Option<[f64; 2]>)],
    error: &Vec6,
    damping: f64,
    q: &mut [f64],
) {
    let column = |v: usize| {
        let t: &Twist = &columns[6 + v];
        Vec6::new(t.ang.x, t.ang.y, t.ang.z, t.lin.x, t.lin.y, t.lin.z)
    };
    let mut jjt = Mat6::identity() * damping;
    for (_, v, _) in moves {
        let c = column(*v);
        jjt += c * c.transpose();
    }
    let Some(factor) = jjt.cholesky() else { return };
    let x = factor.solve(error);
    debug_assert!(tree.nv + 6 == columns.len());
    for (qi, v, limits) in moves {
        // At most half a radian an iteration: the linearisation is not good for more.
        q[*qi] += column(*v).dot(&x).clamp(-0.5, 0.5);
        if let Some([lower, upper]) = limits {
            q[*qi] = q[*qi].clamp(*lower, *upper);
        }
    }
}

/// A 6-vector's angular and linear halves.
pub(crate) fn halves(v: &Vec6) -> (Vec3, Vec3) {
    (v.fixed_rows::<3>(0).into_owned(), v.fixed_rows::<3>(3).into_owned())
}

//! The linear system of one pass, island by island.
//!
//!   A dv = h (τ − c + Jᵀ f),   A = M + Jᵀ G J + diag(slopes · h)
//!
//! JᵀGJ within a vehicle is the mass matrix of links whose inertia is increased by S = Σ XᵀGX; between two bodies only
//! −J_aᵀ S_ab J_b is extra, once per pair of bodies. Vehicles that touch form an island; each island is factored by
//! itself (UᵀU, upper triangle, row-major: inner loops run along rows and keep one order of addition).

use crate::contacts::Touch;
use crate::mechanism::{self, Coupling};
use crate::model::Model;
use crate::pivots;
use crate::workspace::Workspace;
use multibody::{Kinematics, Tree};
use spatial::{Mat3, SpatialMatrix, Twist, Vec3, Wrench};

/// Row of a body's freedom that its base's guide holds.
const HELD: usize = usize::MAX;

/// The islands of this step and the storage of their systems.
#[derive(Clone, Debug)]
pub(crate) struct Islands {
    /// Island's representative, by vehicle.
    group: Vec<usize>,
    /// Per vehicle: row in its island's system of base freedoms and coordinates (`HELD` where there is none).
    rows: Vec<Vec<usize>>,
    /// Per representative: size and start in `matrix`.
    size: Vec<usize>,
    start: Vec<usize>,
    matrix: Vec<f64>,
    rhs: Vec<Vec<f64>>,
    scratch: Vec<f64>,
    /// Whether vehicles without joints are left out.
    leaves_rigid: bool,
}

impl Islands {
    pub fn new(model: &Model) -> Self {
        let n: usize = model.vehicles.iter().map(|v| 6 + v.tree.nv).sum();
        let largest = model.vehicles.iter().map(|v| 6 + v.tree.nv).max().unwrap_or(0);
        Self {
            group: vec![0; model.vehicles.len()],
            rows: model.vehicles.iter().map(|v| vec![HELD; 6 + v.tree.nv]).collect(),
            size: vec![0; model.vehicles.len()],
            start: vec![0; model.vehicles.len()],
            matrix: vec![0.0; n * (n + LANES)],
            rhs: model.vehicles.iter().map(|_| Vec::with_capacity(n)).collect(),
            scratch: vec![0.0; largest * largest],
            leaves_rigid: false,
        }
    }

    /// Groups the vehicles that act on each other within the step and numbers their freedoms.
    pub fn regroup(&mut self, model: &Model, touches: &[Touch], couplings: &[Coupling]) {
        for (i, group) in self.group.iter_mut().enumerate() {
            *group = i;
        }
        // A force that does not answer to the gains ties nothing together: so it is in flight and in every stage of Runge–Kutta.
        let ties = |t: &&Touch| t.out.g != Mat3::zeros() || model.laws[t.pair as usize].pivot.is_some();
        let touching = touches.iter().filter(ties).map(|t| [t.body_a, t.body_b]);
        for [body_a, body_b] in touching.chain(couplings.iter().map(|c| c.bodies)) {
            if let (Some(&(a, _)), Some(&(b, _))) = (model.owners.get(body_a), model.owners.get(body_b)) {
                let (low, high) = (self.group[a].min(self.group[b]), self.group[a].max(self.group[b]));
                self.group.iter_mut().filter(|g| **g == high).for_each(|g| *g = low);
            }
        }
        self.size.fill(0);
        for (i, vehicle) in model.vehicles.iter().enumerate() {
            let (size, mask) = (&mut self.size[self.group[i]], vehicle.base.mask());
            let is_left = self.leaves_rigid && vehicle.tree.nv == 0;
            for (k, row) in self.rows[i].iter_mut().enumerate() {
                *row = if !is_left && (k >= 6 || mask[k]) { *size } else { HELD };
                *size += usize::from(*row != HELD);
            }
        }
        let mut start = 0;
        for (i, size) in self.size.iter().enumerate() {
            self.start[i] = start;
            start += size * padded(*size);
            self.rhs[i].clear();
            self.rhs[i].resize(*size, 0.0);
        }
        self.matrix[..start].fill(0.0);
    }
}

/// Assembles and factors every island's matrix; returns `false` if one is not positive definite.
pub(crate) fn factor(model: &Model, ws: &mut Workspace, h: f64) -> bool {
    // Forces that do not answer to gains, as under Runge–Kutta, stiffen nothing.
    let answers = |touch: &Touch| touch.out.g != Mat3::zeros();
    let is_stiffened = !ws.couplings.is_empty() || !ws.pivots.is_empty() || ws.touches.iter().any(answers);
    if is_stiffened {
        ws.extra.fill(SpatialMatrix::default());
    }
    for touch in ws.touches.iter().filter(|t| answers(t)) {
        for body in [touch.body_a, touch.body_b] {
            if let Some(&(vehicle, _)) = model.owners.get(body) {
                let r = touch.point - ws.kin[vehicle].anchor;
                ws.extra[body] += SpatialMatrix::from_point(&touch.out.g, &r, &r);
            }
        }
    }
    mechanism::add_stiffness(model, ws, h);
    pivots::add_stiffness(model, ws, h);
    ws.islands.regroup(model, &ws.touches, &ws.couplings);
    for i in 0..model.vehicles.len() {
        add_vehicle(model, ws, i, (h, is_stiffened));
    }
    add_cross_terms(model, ws);
    for k in 0..ws.couplings.len() {
        if let Some(([a, b], coupling)) = mechanism::calc_cross(model, ws, k, h) {
            add_cross(model, ws, [a, b], &coupling);
        }
    }
    for k in 0..ws.pivots.len() {
        if let Some((bodies, coupling)) = pivots::calc_cross(model, ws, k, h) {
            add_cross(model, ws, bodies, &coupling);
        }
    }
    let Islands { size, start, matrix, .. } = &mut ws.islands;
    size.iter().zip(start.iter()).all(|(n, at)| cholesky(&mut matrix[*at..*at + n * padded(*n)], *n))
}

fn add_vehicle(model: &Model, ws: &mut Workspace, i: usize, (h, is_stiffened): (f64, bool)) {
    let vehicle = &model.vehicles[i];
    if vehicle.tree.nv == 0 && (vehicle.base.is_held() || ws.islands.leaves_rigid) {
        return;
    }
    let slopes = &ws.coordinate_lines[vehicle.v0..vehicle.v0 + vehicle.tree.nv];
    if vehicle.base.is_held() && !is_stiffened {
        let islands = &mut ws.islands;
        let group = islands.group[i];
        let (stride, first) = (padded(islands.size[group]), islands.rows[i][6]);
        let own = &mut islands.matrix[islands.start[group] + first * (stride + 1)..];
        ws.dynamics[i].add_joint_mass_matrix(&vehicle.tree, &ws.kin[i], own, stride);
        for (k, (_, slope)) in slopes.iter().enumerate() {
            own[k * (stride + 1)] += h * slope;
        }
        return;
    }
    let n = 6 + vehicle.tree.nv;
    let bodies = vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len();
    let extra = if is_stiffened { &ws.extra[bodies] } else { &[] };
    let islands = &mut ws.islands;
    ws.dynamics[i].calc_mass_matrix(&vehicle.tree, &ws.kin[i], extra, &mut islands.scratch[..n * n], n);
    let group = islands.group[i];
    let (at, stride, rows) = (islands.start[group], padded(islands.size[group]), &islands.rows[i]);
    for (k, &row) in rows.iter().enumerate().filter(|(_, r)| **r != HELD) {
        let target = &mut islands.matrix[at + row * stride..at + (row + 1) * stride];
        for (l, &column) in rows.iter().enumerate().filter(|(_, c)| **c != HELD) {
            target[column] = islands.scratch[k * n + l];
        }
        if k >= 6 {
            target[row] += h * slopes[k - 6].1;
        }
    }
}

fn add_cross_terms(model: &Model, ws: &mut Workspace) {
    let mut i = 0;
    while i < ws.touches.len() {
        let (a, b) = (ws.touches[i].body_a, ws.touches[i].body_b);
        let both = model.owners.get(a).zip(model.owners.get(b));
        let mut coupling = SpatialMatrix::default();
        while i < ws.touches.len() && (ws.touches[i].body_a, ws.touches[i].body_b) == (a, b) {
            if let Some((&(va, _), &(vb, _))) = both {
                let touch = &ws.touches[i];
                let (ra, rb) = (touch.point - ws.kin[va].anchor, touch.point - ws.kin[vb].anchor);
                coupling += SpatialMatrix::from_point(&touch.out.g, &ra, &rb);
            }
            i += 1;
        }
        if both.is_some() && coupling != SpatialMatrix::default() {
            add_cross(model, ws, [a, b], &coupling);
        }
    }
}

/// Subtracts JₐᵀC J_b and its transpose.
fn add_cross(model: &Model, ws: &mut Workspace, [a, b]: [usize; 2], coupling: &SpatialMatrix) {
    let ((va, la), (vb, lb)) = (model.owners[a], model.owners[b]);
    let islands = &mut ws.islands;
    let group = islands.group[va];
    let (at, stride) = (islands.start[group], padded(islands.size[group]));
    let (rows_a, rows_b, matrix) = (&islands.rows[va], &islands.rows[vb], &mut islands.matrix[at..]);
    let mut subtract = |column: usize, wrench: &Wrench| {
        let mut entry = |row: usize, value: f64| {
            if row != HELD && column != HELD {
                matrix[row * stride + column] -= value;
                matrix[column * stride + row] -= value;
            }
        };
        for k in 0..3 {
            entry(rows_a[k], wrench.moment[k]);
            entry(rows_a[3 + k], wrench.force[k]);
        }
        for_path(&model.vehicles[va].tree, &ws.kin[va], la, |k, screw| entry(rows_a[k], screw.dot(wrench)));
    };
    for (l, column) in rows_b.iter().take(6).enumerate() {
        subtract(*column, &column_of(coupling, l));
    }
    for_path(&model.vehicles[vb].tree, &ws.kin[vb], lb, |l, screw| subtract(rows_b[l], &coupling.mul(screw)));
}

/// What a unit of the base's freedom `k` gives.
fn column_of(matrix: &SpatialMatrix, k: usize) -> Wrench {
    let column = |m: &spatial::Mat3| m.column(k % 3).into_owned();
    if k < 3 {
        Wrench::new(column(&matrix.ma), column(&matrix.fa))
    } else {
        Wrench::new(column(&matrix.ml), column(&matrix.fl))
    }
}

/// Visits the joint freedoms that move a body, with their screws, from the tip inwards.
fn for_path(tree: &Tree, kin: &Kinematics, body: usize, mut visit: impl FnMut(usize, &Twist)) {
    let mut at = body;
    while at != 0 {
        let joint = &tree.joints[at - 1];
        for k in 0..joint.width {
            visit(6 + joint.v_index + k, &kin.screws[joint.column + k]);
        }
        at = tree.bodies[at].parent;
    }
}

/// Joint accelerations of the present state under forces that do not answer to gains, into `v_gain`: bases go by their momentum, and what has
/// no joints is left out. `false` if a mass matrix is not positive definite.
pub(crate) fn solve_joints(model: &Model, ws: &mut Workspace) -> bool {
    ws.islands.leaves_rigid = true;
    let is_definite = factor(model, ws, 1.0);
    if is_definite {
        solve(model, ws, 1.0);
    }
    ws.islands.leaves_rigid = false;
    is_definite
}

/// Solves for the gains of all twists and rates, from the factored matrices and the lines' forces at zero gain.
pub(crate) fn solve(model: &Model, ws: &mut Workspace, h: f64) {
    ws.contact.fill(Wrench::default());
    for touch in &ws.touches {
        let line = if model.drives.is_empty() { touch.out.line } else { line_beside_drives(model, ws, touch, h) };
        for (body, sign) in [(touch.body_a, -1.0), (touch.body_b, 1.0)] {
            if let Some(&(vehicle, _)) = model.owners.get(body) {
                let r = touch.point - ws.kin[vehicle].anchor;
                ws.contact[body] += Wrench::from_force_at(sign * line, &r);
            }
        }
    }
    mechanism::add_wrenches(model, ws);
    pivots::add_moments(model, ws);
    for i in 0..model.vehicles.len() {
        write_rhs(model, ws, i, h);
    }
    let Islands { size, start, matrix, rhs, .. } = &mut ws.islands;
    for i in 0..size.len() {
        back_substitute(&matrix[start[i]..start[i] + size[i] * padded(size[i])], &mut rhs[i]);
    }
    for i in 0..model.vehicles.len() {
        read_gains(model, ws, i);
    }
}

/// The line at zero gain of all that forces move: what a driven base gains is known.
fn line_beside_drives(model: &Model, ws: &Workspace, touch: &Touch, h: f64) -> Vec3 {
    let at = |body: usize| {
        let Some(&(vehicle, _)) = model.owners.get(body) else { return Vec3::zeros() };
        ws.drive_gain[vehicle].at(&(touch.point - ws.kin[vehicle].anchor))
    };
    touch.out.line - touch.out.g * (at(touch.body_b) - at(touch.body_a)) / h
}

fn write_rhs(model: &Model, ws: &mut Workspace, i: usize, h: f64) {
    let vehicle = &model.vehicles[i];
    if ws.islands.leaves_rigid && vehicle.tree.nv == 0 {
        return;
    }
    for body in 0..vehicle.tree.bodies.len() {
        ws.dynamics[i].wrench[body] = ws.bias[vehicle.body0 + body] - ws.contact[vehicle.body0 + body];
    }
    let tau = &mut ws.tau[vehicle.v_range()];
    let base = ws.dynamics[i].collect(&vehicle.tree, &ws.kin[i], tau);
    let islands = &mut ws.islands;
    let rhs = &mut islands.rhs[islands.group[i]];
    for (k, &row) in islands.rows[i].iter().enumerate().filter(|(_, r)| **r != HELD) {
        rhs[row] = match k {
            0..3 => -h * base.moment[k],
            3..6 => -h * base.force[k - 3],
            _ => h * (ws.coordinate_lines[vehicle.v0 + k - 6].0 - tau[k - 6]),
        };
    }
}

fn read_gains(model: &Model, ws: &mut Workspace, i: usize) {
    let vehicle = &model.vehicles[i];
    let islands = &ws.islands;
    let rhs = &islands.rhs[islands.group[i]];
    let gain = |k: usize| if islands.rows[i][k] == HELD { 0.0 } else { rhs[islands.rows[i][k]] };
    let mut base = Twist::new(Vec3::new(gain(0), gain(1), gain(2)), Vec3::new(gain(3), gain(4), gain(5)));
    if vehicle.base.is_held() {
        base = ws.drive_gain[i];
    }
    for k in 0..vehicle.tree.nv {
        ws.v_gain[vehicle.v0 + k] = gain(6 + k);
    }
    ws.base_gain[i] = base;
    ws.dvel[vehicle.body0] = base;
    for (j, joint) in vehicle.tree.joints.iter().enumerate() {
        let mut twist = ws.dvel[vehicle.body0 + vehicle.tree.bodies[j + 1].parent];
        for k in 0..joint.width {
            twist += ws.kin[i].screws[joint.column + k] * ws.v_gain[vehicle.v0 + joint.v_index + k];
        }
        ws.dvel[vehicle.body0 + j + 1] = twist;
    }
}

/// Columns that are summed in registers at a time; rows are padded to a multiple.
const LANES: usize = 8;

/// Length of a padded row.
fn padded(n: usize) -> usize {
    n.next_multiple_of(LANES)
}

/// A = UᵀU in place, upper triangle, `n` rows of `padded(n)`; a row's columns are summed in registers over all rows above.
fn cholesky(a: &mut [f64], n: usize) -> bool {
    let stride = padded(n);
    for k in 0..n {
        let (above, rest) = a.split_at_mut(k * stride);
        let row = &mut rest[..stride];
        for (b, x) in row.as_chunks_mut::<LANES>().0.iter_mut().enumerate().skip(k / LANES) {
            let mut sum = *x;
            for u in above.chunks_exact(stride) {
                let factor = u[k];
                for (s, y) in sum.iter_mut().zip(&u[b * LANES..(b + 1) * LANES]) {
                    *s -= factor * y;
                }
            }
            *x = sum;
        }
        let pivot = row[k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        let inverse = 1.0 / pivot.sqrt();
        row[k / LANES * LANES..].iter_mut().for_each(|x| *x *= inverse);
    }
    true
}

/// x with UᵀU x = b, in place.
fn back_substitute(u: &[f64], b: &mut [f64]) {
    let (n, stride) = (b.len(), padded(b.len()));
    for k in 0..n {
        b[k] /= u[k * stride + k];
        let value = b[k];
        for i in k + 1..n {
            b[i] -= u[k * stride + i] * value;
        }
    }
    for k in (0..n).rev() {
        let mut value = b[k];
        for i in k + 1..n {
            value -= u[k * stride + i] * b[i];
        }
        b[k] = value / u[k * stride + k];
    }
}

//! The linear system of one pass, island by island.
//!
//!   A dv = h (τ − c + Jᵀ f),   A = M + Jᵀ G J + diag(slopes · h)
//!
//! JᵀGJ within a vehicle is the mass matrix of links whose inertia is increased by S = Σ XᵀGX; between two bodies only
//! −J_aᵀ S_ab J_b is extra, once per pair of bodies. Vehicles that touch form an island; each island is factored by
//! itself (Cholesky's method without roots, upper triangle, row-major: inner loops run along rows and keep one order of
//! addition). Below the diagonal the matrix is neither written nor read.

use crate::forces::{mechanisms, pivots};
use crate::model::Model;
use crate::workspace::{Coupling, HELD, Islands, LANES, Touch, Workspace, padded};
use spatial::{Mat3, SpatialMatrix, Twist, Vec3, Wrench};
use std::cmp::Ordering;

impl Islands {
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
    let is_stiffened = !ws.couplings.is_empty() || !ws.pivots.is_empty() || ws.touches.iter().any(answers);
    if is_stiffened {
        ws.extra.fill(None);
    }
    add_touches(model, ws);
    mechanisms::add_stiffness(model, ws, h);
    pivots::add_stiffness(model, ws, h);
    ws.islands.regroup(model, &ws.touches, &ws.couplings);
    for i in 0..model.vehicles.len() {
        add_vehicle(model, ws, i, (h, is_stiffened));
    }
    for k in 0..ws.islands.cross.len() {
        let (bodies, coupling) = ws.islands.cross[k];
        add_cross(model, ws, bodies, &coupling);
    }
    for k in 0..ws.couplings.len() {
        if let Some(([a, b], coupling)) = mechanisms::calc_cross(model, ws, k, h) {
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

/// Whether a touch stiffens anything: forces that do not answer to gains, as under Runge–Kutta, do not.
fn answers(touch: &Touch) -> bool {
    touch.out.g != Mat3::zeros()
}

/// What touches add to the bodies' own inertia, and between the two bodies of each pair: summed about B's anchor, then moved
/// to A's. A pair's touches stand beside each other.
fn add_touches(model: &Model, ws: &mut Workspace) {
    let Workspace { touches, kin, extra, islands, .. } = ws;
    let bodies_of = |t: &Touch| [t.body_a, t.body_b];
    islands.cross.clear();
    for run in touches.chunk_by(|t, u| bodies_of(t) == bodies_of(u)) {
        let [a, b] = bodies_of(&run[0]);
        let anchor = |body: usize| model.owners.get(body).map(|&(vehicle, _)| kin[vehicle].anchor);
        let (anchor_a, anchor_b) = (anchor(a), anchor(b));
        let Some(origin) = anchor_b.or(anchor_a) else { continue };
        let mut sum = SpatialMatrix::default();
        let mut is_stiff = false;
        for touch in run.iter().filter(|t| answers(t)) {
            sum += SpatialMatrix::from_point(&touch.out.g, &(touch.point - origin));
            is_stiff = true;
        }
        if !is_stiff {
            continue;
        }
        *extra[if anchor_b.is_some() { b } else { a }].get_or_insert_default() += sum;
        if let (Some(anchor_a), Some(anchor_b)) = (anchor_a, anchor_b) {
            let [between, own] = sum.about_first(&(anchor_b - anchor_a));
            *extra[a].get_or_insert_default() += own;
            islands.cross.push(([a, b], between));
        }
    }
}

fn add_vehicle(model: &Model, ws: &mut Workspace, i: usize, (h, is_stiffened): (f64, bool)) {
    let vehicle = &model.vehicles[i];
    if vehicle.tree.nv == 0 && (vehicle.base.is_held() || ws.islands.leaves_rigid) {
        return;
    }
    let slopes = &ws.coordinate_lines[vehicle.v0..vehicle.v0 + vehicle.tree.nv];
    let islands = &mut ws.islands;
    let group = islands.group[i];
    let (at, stride, rows) = (islands.start[group], padded(islands.size[group]), &islands.rows[i]);
    let bodies = vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len();
    let extra = if is_stiffened { &ws.extra[bodies] } else { &[] };
    let mask = vehicle.base.mask();
    if mask == [true; 6] {
        let own = &mut islands.matrix[at + rows[0] * (stride + 1)..];
        ws.dynamics[i].add_mass_matrix(&vehicle.tree, &ws.kin[i], extra, own, stride);
    } else if vehicle.base.is_held() && !is_stiffened {
        let own = &mut islands.matrix[at + rows[6] * (stride + 1)..];
        ws.dynamics[i].add_joint_mass_matrix(&vehicle.tree, &ws.kin[i], own, stride);
    } else {
        let n = 6 + vehicle.tree.nv;
        let all = &mut islands.scratch[..n * n];
        all.fill(0.0);
        ws.dynamics[i].add_mass_matrix(&vehicle.tree, &ws.kin[i], extra, all, n);
        for (k, &row) in rows.iter().enumerate().filter(|(_, r)| **r != HELD) {
            for (l, &column) in rows.iter().enumerate().skip(k).filter(|(_, c)| **c != HELD) {
                islands.matrix[at + row * stride + column] = all[k * n + l];
            }
        }
    }
    for (&row, (_, slope)) in rows[6..].iter().zip(slopes) {
        islands.matrix[at + row * (stride + 1)] += h * slope;
    }
}

/// Subtracts JₐᵀC J_b and its transpose, of which the upper triangle.
fn add_cross(model: &Model, ws: &mut Workspace, [a, b]: [usize; 2], coupling: &SpatialMatrix) {
    match model.owners[a].0.cmp(&model.owners[b].0) {
        // A vehicle's rows stand before those of the vehicles behind it.
        Ordering::Less => add_between(model, ws, [a, b], coupling),
        Ordering::Greater => add_between(model, ws, [b, a], &coupling.transpose()),
        Ordering::Equal => add_within(model, ws, [a, b], coupling),
    }
}

/// The bodies are of two vehicles, A's the first.
fn add_between(model: &Model, ws: &mut Workspace, [a, b]: [usize; 2], coupling: &SpatialMatrix) {
    let ((va, la), (vb, lb)) = (model.owners[a], model.owners[b]);
    let islands = &mut ws.islands;
    let group = islands.group[va];
    let (at, stride) = (islands.start[group], padded(islands.size[group]));
    let (rows_a, rows_b, matrix) = (&islands.rows[va], &islands.rows[vb], &mut islands.matrix[at..]);
    let (path_b, screws_b) = (ws.dynamics[vb].path(lb), &ws.kin[vb].screws);
    let mut subtract = |row: usize, seen: &Wrench| {
        let own = &mut matrix[row * stride..][..stride];
        subtract_base(own, rows_b, seen);
        for moves in path_b {
            own[rows_b[6 + moves.coordinate as usize]] -= screws_b[moves.column as usize].dot(seen);
        }
    };
    for (k, row) in rows_a.iter().enumerate().take(6).filter(|(_, r)| **r != HELD) {
        subtract(*row, &row_of(coupling, k));
    }
    for moves in ws.dynamics[va].path(la) {
        let screw = &ws.kin[va].screws[moves.column as usize];
        subtract(rows_a[6 + moves.coordinate as usize], &coupling.tr_mul(screw));
    }
}

/// The six numbers of a wrench, in the order of a base's freedoms.
#[inline]
fn numbers(wrench: &Wrench) -> [f64; 6] {
    let (m, f) = (&wrench.moment, &wrench.force);
    [m.x, m.y, m.z, f.x, f.y, f.z]
}

/// Subtracts the six numbers of a wrench from a row, in the columns of a base's freedoms.
#[inline]
fn subtract_base(row: &mut [f64], columns: &[usize], seen: &Wrench) {
    let (numbers, first) = (numbers(seen), columns[0]);
    // Of a base that is free the columns follow on each other.
    if first != HELD && columns[5] == first + 5 {
        row[first..first + 6].iter_mut().zip(numbers).for_each(|(x, number)| *x -= number);
        return;
    }
    for (column, number) in columns.iter().zip(numbers).filter(|(c, _)| **c != HELD) {
        row[*column] -= number;
    }
}

/// Both bodies are of one vehicle: both halves may land on one entry.
fn add_within(model: &Model, ws: &mut Workspace, [a, b]: [usize; 2], coupling: &SpatialMatrix) {
    let ((vehicle, la), (_, lb)) = (model.owners[a], model.owners[b]);
    let islands = &mut ws.islands;
    let group = islands.group[vehicle];
    let (at, stride) = (islands.start[group], padded(islands.size[group]));
    let (rows, matrix) = (&islands.rows[vehicle], &mut islands.matrix[at..]);
    let (dynamics, screws) = (&ws.dynamics[vehicle], &ws.kin[vehicle].screws);
    let mut subtract = |row: usize, seen: &Wrench| {
        let mut entry = |column: usize, value: f64| {
            let entry = &mut matrix[row.min(column) * stride + row.max(column)];
            *entry -= value;
            *entry -= if row == column { value } else { 0.0 };
        };
        for (column, value) in rows.iter().zip(numbers(seen)).filter(|(c, _)| **c != HELD) {
            entry(*column, value);
        }
        for moves in dynamics.path(lb) {
            entry(rows[6 + moves.coordinate as usize], screws[moves.column as usize].dot(seen));
        }
    };
    for (k, row) in rows.iter().enumerate().take(6).filter(|(_, r)| **r != HELD) {
        subtract(*row, &row_of(coupling, k));
    }
    for moves in dynamics.path(la) {
        subtract(rows[6 + moves.coordinate as usize], &coupling.tr_mul(&screws[moves.column as usize]));
    }
}

/// What acts on the base's freedom `k` for a unit of each of the other's.
fn row_of(matrix: &SpatialMatrix, k: usize) -> Wrench {
    let row = |m: &Mat3| m.row(k % 3).transpose();
    if k < 3 { Wrench::new(row(&matrix.ma), row(&matrix.ml)) } else { Wrench::new(row(&matrix.fa), row(&matrix.fl)) }
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
    mechanisms::add_wrenches(model, ws);
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
    let (rhs, rows) = (&mut islands.rhs[islands.group[i]], &islands.rows[i]);
    for (&row, number) in rows.iter().zip(numbers(&base)).filter(|(row, _)| **row != HELD) {
        rhs[row] = -h * number;
    }
    let range = vehicle.v_range();
    for ((&row, line), tau) in rows[6..].iter().zip(&ws.coordinate_lines[range.clone()]).zip(&ws.tau[range]) {
        rhs[row] = h * (line.0 - tau);
    }
    if let Some(push) = &ws.push {
        let own = push.joints.iter().skip(vehicle.v0).take(vehicle.tree.nv);
        rows[6..].iter().zip(own).for_each(|(&row, effort)| rhs[row] += h * effort);
    }
}

fn read_gains(model: &Model, ws: &mut Workspace, i: usize) {
    let vehicle = &model.vehicles[i];
    let (rhs, rows) = (&ws.islands.rhs[ws.islands.group[i]], &ws.islands.rows[i]);
    let gain = |k: usize| if rows[k] == HELD { 0.0 } else { rhs[rows[k]] };
    let mut base = Twist::new(Vec3::new(gain(0), gain(1), gain(2)), Vec3::new(gain(3), gain(4), gain(5)));
    if vehicle.base.is_held() {
        base = ws.drive_gain[i];
    }
    for (v, &row) in ws.v_gain[vehicle.v_range()].iter_mut().zip(&rows[6..]) {
        *v = rhs[row];
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

const WIDER: usize = 2 * LANES;

const WIDEST: usize = 3 * LANES;

/// A = WᵀP⁻¹W in place: W upper triangular, P its diagonal of pivots, of which the inverse is left there; `n` rows of
/// `padded(n)`. (Of UᵀU, U = P^−½ W: here no root stands between a row and the next.)
fn cholesky(a: &mut [f64], n: usize) -> bool {
    let stride = padded(n);
    for k in 0..n {
        let (above, rest) = a.split_at_mut(k * stride);
        let row = &mut rest[..stride];
        let mut at = k / LANES * LANES;
        while at < stride {
            at += match stride - at {
                LANES => subtract_rows::<LANES>(above, row, k, at),
                WIDER => subtract_rows::<WIDER>(above, row, k, at),
                _ => subtract_rows::<WIDEST>(above, row, k, at),
            };
        }
        let pivot = row[k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        row[k] = 1.0 / pivot;
    }
    true
}

/// Takes the rows above off W columns of row `k` from `at`, in registers over all rows; returns W.
#[inline]
fn subtract_rows<const W: usize>(above: &[f64], row: &mut [f64], k: usize, at: usize) -> usize {
    let stride = row.len();
    let Some(own) = row[at..].first_chunk_mut::<W>() else { return W };
    let mut sum = *own;
    for (i, u) in above.chunks_exact(stride).enumerate() {
        let (factor, Some(y)) = (u[i] * u[k], u[at..].first_chunk::<W>()) else { break };
        for (s, y) in sum.iter_mut().zip(y) {
            *s -= factor * y;
        }
    }
    *own = sum;
    W
}

/// x with WᵀP⁻¹W x = b, in place, from what [`cholesky`] left.
fn back_substitute(u: &[f64], b: &mut [f64]) {
    let (n, stride) = (b.len(), padded(b.len()));
    for k in 0..n {
        let row = &u[k * stride..][..n];
        let (known, rest) = b.split_at_mut(k + 1);
        let x = known[k] * row[k];
        rest.iter_mut().zip(&row[k + 1..]).for_each(|(b, u)| *b -= u * x);
    }
    for k in (0..n).rev() {
        let row = &u[k * stride..][..n];
        let (open, known) = b.split_at_mut(k + 1);
        // What was found last is taken last: a processor sums the rest meanwhile.
        let value = known.iter().zip(&row[k + 1..]).rev().fold(open[k], |value, (b, u)| value - u * b);
        open[k] = value * row[k];
    }
}

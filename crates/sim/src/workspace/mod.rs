//! Scratch of a step: sized once from the model, so that a step allocates nothing.

mod coupling;
mod inner;
mod islands;
mod scratch;
mod touch;

pub(crate) use coupling::Coupling;
pub(crate) use inner::{Action, Parts, calc_carried, calc_carried_linear, calc_motion, of_bodies, particles};
pub(crate) use islands::{HELD, Islands, LANES, padded};
pub use scratch::Rest;
pub(crate) use scratch::{DriveStart, Pull, Pulls, Thrust};
pub(crate) use touch::{Answer, Outcome, PivotTouch, Place, Touch};

use crate::model::Model;
use crate::parts::{Base, CoordinateForce, CoordinatePoint, Push, Vehicle};
use crate::state::{ContactMemory, State};
use contact::{ContactPoint, Detector};
use multibody::{Dynamics, Kinematics, calc_locked_inertia, calc_momentum};
use spatial::{Frame, Inertia, SpatialMatrix, Twist, Vec3, Wrench};

/// Scratch of one world; holds nothing that a result depends on.
#[derive(Debug)]
pub(crate) struct Workspace {
    /// Length of the present step, s, and the time at its end, s.
    pub step: f64,
    pub end: f64,
    /// Share of a step's gains in the velocity that displaces: 1 for the Euler schemes, ½ at mid-step, 0 in a stage.
    pub gain_share: f64,
    /// Whether [`crate::EnergyBalance`] are kept.
    pub keeps_books: bool,
    /// Time since the step's start of an explicit stage, s.
    pub since: Option<f64>,
    pub kin: Vec<Kinematics>,
    pub dynamics: Vec<Dynamics>,
    /// Frames of all bodies in W; the world's is the last.
    pub frames: Vec<Frame>,
    pub frames_start: Vec<Frame>,
    pub detector: Detector,
    pub points: Vec<ContactPoint>,
    pub reach: Vec<f64>,
    pub touches: Vec<Touch>,
    /// Points (pair, feature) that pressed before the present step, where touches are sought.
    pub pressing: Vec<(u32, u64)>,
    /// What the touches' laws answered last, in their order.
    pub answers: Vec<Answer>,
    pub couplings: Vec<Coupling>,
    pub pivots: Vec<PivotTouch>,
    /// Per body, about its vehicle's anchor: forces from outside, then what motion takes beyond them.
    pub external: Vec<Wrench>,
    /// Of these, gravity and tides; and the thrusters' shares.
    pub weights: Vec<Wrench>,
    pub thrusts: Vec<Thrust>,
    pub bias: Vec<Wrench>,
    pub contact: Vec<Wrench>,
    /// What contacts and mechanisms add to the inertia of a body.
    pub extra: Vec<Option<SpatialMatrix>>,
    /// Change of the bodies' twists in the step; the world's is the last and zero.
    pub dvel: Vec<Twist>,
    pub base_start: Vec<Twist>,
    /// Linear momentum and centre of mass of the vehicles at the step's start.
    pub momentum_start: Vec<Vec3>,
    pub centre_start: Vec<Vec3>,
    pub base_gain: Vec<Twist>,
    /// Per vehicle: spatial acceleration of a driven base in this stage or step, and its gain in the step; else zero.
    pub base_acceleration: Vec<Twist>,
    pub drive_gain: Vec<Twist>,
    pub drive_start: Vec<DriveStart>,
    pub q_start: Vec<f64>,
    pub effects_start: Vec<f64>,
    pub queries_start: u64,
    pub v_gain: Vec<f64>,
    /// Joints that are held in this step, with their rates before, and the largest share of what they bear that would move one.
    pub held: Vec<(Rest, f64)>,
    pub unrest: f64,
    pub v_mid: Vec<f64>,
    pub tau: Vec<f64>,
    pub displacement: Vec<f64>,
    pub coordinate_points: Vec<CoordinatePoint>,
    pub coordinate_forces: Vec<CoordinateForce>,
    /// Linearisation of the coordinate laws: effort at zero gain, and slope.
    pub coordinate_lines: Vec<(f64, f64)>,
    pub islands: Islands,
    /// Forces beside all laws.
    pub push: Option<Push>,
    /// What forces of one's own do.
    pub pulls: Pulls,
    pub memories: Vec<ContactMemory>,
    pub parts: Parts,
    pub backup: State,
    /// The state before a part of a step that may have to be made again.
    pub before: State,
}

impl Workspace {
    pub fn new(model: &Model) -> Self {
        let (bodies, nv) = (model.owners.len() + 1, model.nv());
        let point = CoordinatePoint::still(0.0, 0.0, 1.0);
        Self {
            step: model.step,
            end: 0.0,
            gain_share: 0.0,
            keeps_books: true,
            since: None,
            kin: model.vehicles.iter().map(|v| Kinematics::new(&v.tree)).collect(),
            dynamics: model.vehicles.iter().map(|v| Dynamics::new(&v.tree)).collect(),
            frames: vec![Frame::identity(); bodies],
            frames_start: vec![Frame::identity(); bodies],
            detector: Detector::new(&model.scene),
            points: Vec::new(),
            reach: vec![0.0; bodies],
            touches: Vec::new(),
            pressing: Vec::new(),
            answers: Vec::new(),
            couplings: Vec::with_capacity(model.mechanisms.len()),
            pivots: Vec::new(),
            external: vec![Wrench::default(); bodies],
            weights: vec![Wrench::default(); model.owners.len()],
            thrusts: Vec::with_capacity(model.actuators.len()),
            bias: vec![Wrench::default(); bodies],
            contact: vec![Wrench::default(); bodies],
            extra: vec![None; bodies],
            dvel: vec![Twist::default(); bodies],
            base_start: vec![Twist::default(); model.vehicles.len()],
            momentum_start: vec![Vec3::zeros(); model.vehicles.len()],
            centre_start: vec![Vec3::zeros(); model.vehicles.len()],
            q_start: vec![0.0; model.nq()],
            effects_start: vec![0.0; model.effects.n_memory()],
            queries_start: 0,
            base_gain: vec![Twist::default(); model.vehicles.len()],
            base_acceleration: vec![Twist::default(); model.vehicles.len()],
            drive_gain: vec![Twist::default(); model.vehicles.len()],
            drive_start: Vec::with_capacity(model.drives.len()),
            v_gain: vec![0.0; nv],
            held: Vec::new(),
            unrest: 0.0,
            v_mid: vec![0.0; nv],
            tau: vec![0.0; nv],
            displacement: vec![0.0; nv],
            coordinate_points: vec![point; nv],
            coordinate_forces: vec![CoordinateForce::default(); nv],
            coordinate_lines: vec![(0.0, 0.0); nv],
            islands: Islands::new(model),
            push: None,
            pulls: Pulls::default(),
            memories: Vec::new(),
            parts: Parts::new(model),
            backup: State::new(model),
            before: State::new(model),
        }
    }

    /// Frames, screws and inertias at the state's poses.
    pub fn update_positions(&mut self, model: &Model, state: &State) {
        for i in 0..model.vehicles.len() {
            self.update_screws(model, state, i);
            self.update_frames(model, i);
        }
    }

    /// Screws and inertias of a vehicle at its pose.
    pub fn update_screws(&mut self, model: &Model, state: &State, i: usize) {
        let vehicle = &model.vehicles[i];
        self.kin[i].update_positions(&vehicle.tree, &state.bases[i], &state.q[vehicle.q_range()]);
    }

    /// Frames of a vehicle's bodies in W, from its kinematics.
    pub fn update_frames(&mut self, model: &Model, i: usize) {
        let vehicle = &model.vehicles[i];
        let frames = &mut self.frames[vehicle.body0..vehicle.body0 + vehicle.tree.bodies.len()];
        for (body, frame) in frames.iter_mut().enumerate() {
            *frame = self.kin[i].frame(body);
        }
    }

    /// Twists of all bodies from the state's momentum and joint rates.
    pub fn update_velocities(&mut self, model: &Model, state: &State) {
        for (i, vehicle) in model.vehicles.iter().enumerate() {
            let kin = &mut self.kin[i];
            kin.update_velocities(&vehicle.tree, &Twist::default(), &state.v[vehicle.v_range()]);
            let base = match vehicle.base {
                Base::Driven(k) => model.drives[k].calc_motion(state.time).twist,
                _ => {
                    let carried =
                        if self.parts.has_parts { calc_carried(model, state, i, kin) } else { Wrench::default() };
                    calc_base_twist(vehicle, kin, &state.momentum[i], &carried)
                }
            };
            for twist in &mut kin.vel {
                *twist += base;
            }
        }
    }

    /// What a body's twist about its vehicle's anchor gains with its driven base in this step.
    #[inline]
    pub fn drive_gain_of(&self, model: &Model, body: usize) -> Twist {
        model.owners.get(body).map_or(Twist::default(), |&(vehicle, _)| self.drive_gain[vehicle])
    }

    /// Twist of a global body about the point at `point` (W), W axes; zero for the world.
    #[inline]
    pub fn twist_at(&self, model: &Model, body: usize, point: &Vec3) -> Twist {
        let Some(&(vehicle, local)) = model.owners.get(body) else { return Twist::default() };
        let kin = &self.kin[vehicle];
        kin.vel[local].about(&(point - kin.anchor))
    }
}

/// Base twist (about the anchor) of a vehicle whose kinematics hold the twists with the base held; `carried` is what the
/// parts inside its bodies have of the momentum, about the anchor.
fn calc_base_twist(vehicle: &Vehicle, kin: &Kinematics, momentum: &Wrench, carried: &Wrench) -> Twist {
    if vehicle.base == Base::Fixed {
        return Twist::default();
    }
    if let (Base::Only([false, false, false, x, y, z]), 1) = (vehicle.base, kin.inertia.len()) {
        // A body that does not turn is a point.
        let rate = momentum.force / kin.inertia[0].mass;
        let free = |on: bool, rate: f64| if on { rate } else { 0.0 };
        return Twist::new(Vec3::zeros(), Vec3::new(free(x, rate.x), free(y, rate.y), free(z, rate.z)));
    }
    let locked = calc_locked_inertia(kin);
    let about_anchor = Wrench::new(momentum.moment - kin.anchor.cross(&momentum.force), momentum.force);
    let relative = if vehicle.tree.nv == 0 { Wrench::default() } else { calc_momentum(kin) };
    let h = about_anchor - relative - *carried;
    match vehicle.base {
        Base::Only(PLANAR) => solve_planar(&locked, &h),
        Base::Free => locked.twist_of(&h).unwrap_or(Twist::new(Vec3::repeat(f64::NAN), Vec3::repeat(f64::NAN))),
        _ => solve_masked(&SpatialMatrix::from(&locked), &h, &vehicle.base.mask()),
    }
}

/// The free slots of a base on a level floor: spin about z, and both speeds along it.
const PLANAR: [bool; 6] = [false, false, true, true, true, false];

/// The planar twist whose momentum is `h`: f = m v + ω ẑ × c and h_z = I ω + c × v, c the first moment, solved for ω first.
fn solve_planar(locked: &Inertia, h: &Wrench) -> Twist {
    let (c, f, mass) = (&locked.mc, &h.force, locked.mass);
    let about_com = locked.rot[(2, 2)] - (c.x * c.x + c.y * c.y) / mass;
    let spin = (h.moment.z - (c.x * f.y - c.y * f.x) / mass) / about_com;
    Twist::new(Vec3::new(0.0, 0.0, spin), Vec3::new((f.x + spin * c.y) / mass, (f.y - spin * c.x) / mass, 0.0))
}

/// The twist in the free slots whose momentum there is `h`: UᵀU of the free rows alone, which are few.
fn solve_masked(locked: &SpatialMatrix, h: &Wrench, mask: &[bool; 6]) -> Twist {
    let entry = |i: usize, j: usize| match (i < 3, j < 3) {
        (true, true) => locked.ma[(i, j)],
        (true, false) => locked.ml[(i, j - 3)],
        (false, true) => locked.fa[(i - 3, j)],
        (false, false) => locked.fl[(i - 3, j - 3)],
    };
    let (mut free, mut n) = ([0; 6], 0);
    for i in (0..6).filter(|i| mask[*i]) {
        (free[n], n) = (i, n + 1);
    }
    let (mut u, mut x) = ([[0.0; 6]; 6], [0.0; 6]);
    for i in 0..n {
        let own = if free[i] < 3 { h.moment[free[i]] } else { h.force[free[i] - 3] };
        let above = |u: &[[f64; 6]; 6], j: usize| (0..i).map(|k| u[k][i] * u[k][j]).sum::<f64>();
        // A matrix that is not positive definite gives NaN, which the step reports.
        u[i][i] = (entry(free[i], free[i]) - above(&u, i)).sqrt();
        for j in i + 1..n {
            u[i][j] = (entry(free[i], free[j]) - above(&u, j)) / u[i][i];
        }
        x[i] = (own - (0..i).map(|k| u[k][i] * x[k]).sum::<f64>()) / u[i][i];
    }
    let mut twist = [0.0; 6];
    for i in (0..n).rev() {
        x[i] = (x[i] - (i + 1..n).map(|j| u[i][j] * x[j]).sum::<f64>()) / u[i][i];
        twist[free[i]] = x[i];
    }
    let [wx, wy, wz, vx, vy, vz] = twist;
    Twist::new(Vec3::new(wx, wy, wz), Vec3::new(vx, vy, vz))
}

/// Momentum (about W's origin, in the slots that the base's guide leaves free) of a vehicle that moves as `kin` says.
pub(crate) fn calc_world_momentum(vehicle: &Vehicle, kin: &Kinematics) -> Wrench {
    world_wrench(vehicle, &kin.anchor, &calc_momentum(kin))
}

/// A wrench (or momentum) about the anchor, as it enters the vehicle's momentum about W's origin.
pub(crate) fn world_wrench(vehicle: &Vehicle, anchor: &Vec3, about_anchor: &Wrench) -> Wrench {
    if let Base::Driven(_) = vehicle.base {
        return about_anchor.about(&-anchor);
    }
    let mask = vehicle.base.mask();
    let free = |v: &Vec3, at: usize| Vec3::from_fn(|i, _| if mask[at + i] { v[i] } else { 0.0 });
    let force = free(&about_anchor.force, 3);
    Wrench::new(free(&(about_anchor.moment + anchor.cross(&force)), 0), force)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spatial::Mat3;

    #[test]
    fn a_planar_base_moves_as_the_masked_solution_says() {
        let tensor = Mat3::new(3.0, 0.1, -0.2, 0.1, 4.0, 0.3, -0.2, 0.3, 5.0);
        let locked = Inertia::from_com(12.0, &Vec3::new(0.3, -0.4, 0.2), &tensor);
        let h = Wrench::new(Vec3::new(0.7, -1.1, 2.3), Vec3::new(0.4, 1.9, -0.8));
        let (short, long) = (solve_planar(&locked, &h), solve_masked(&SpatialMatrix::from(&locked), &h, &PLANAR));
        assert!((short.ang - long.ang).norm() + (short.lin - long.lin).norm() < 1e-14, "{short:?} {long:?}");
    }
}

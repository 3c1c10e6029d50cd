//! The laws of single coordinates in a step: passive efforts, drives, gears, effects; and the works that they do.

use super::Acting;
use crate::model::{Model, Scheme};
use crate::parts::{
    Branch, Coordinate, CoordinateForce, CoordinatePoint, EffectKind, Series, Shaft, apply_speed_limit, nominal_effort,
};
use crate::state::State;
use crate::workspace::Workspace;
use friction::Trial;
use spatial::Vec3;

/// How a coordinate passes through a step, or through a stage per second.
pub(crate) struct Passage {
    /// Where effects with memory are evaluated, and when, s.
    pub point: CoordinatePoint,
    pub time: f64,
    /// Position at mid-way and rate; the displacement is the rate times `elapsed`.
    pub q: f64,
    pub rate: f64,
    pub elapsed: f64,
    /// Deflection of a gear at mid-way, and its rate.
    pub gear: [f64; 2],
    /// What the motor's speed limit left of its effort, where it is at that limit.
    pub limited: Option<f64>,
}

impl Coordinate {
    /// Adds the works of actuators and effects in a passage, J; what damping and stops take in it, J.
    pub(crate) fn add_works(&self, passage: &Passage, acting: &Acting<'_>, works: &mut [f64]) -> f64 {
        let Passage { q, rate, elapsed, gear, .. } = *passage;
        let (motor, moved) = ((q + gear[0], rate + gear[1]), elapsed * (rate + gear[1]));
        let asked = |index: usize| deliver(index, &passage.point, motor, acting).0;
        // A speed limit leaves less than is asked, of every actuator the same share.
        let share = passage.limited.map_or(1.0, |left| {
            let whole: f64 = self.actuators.iter().map(|&index| asked(index)).sum();
            if whole == 0.0 { 0.0 } else { left / whole }
        });
        for &index in &self.actuators {
            works[index] += share * asked(index) * moved;
        }
        for &index in &self.effects {
            if let EffectKind::Joint(effect) = &acting.model.effects.list[index].kind
                && !effect.stores()
            {
                let at = (&passage.point, rate);
                let (effort, _) = effect.eval(at, (q, rate), acting.memory(index), passage.time);
                works[acting.model.work_of_effect(index)] += effort * elapsed * rate;
            }
        }
        if let Some((index, series)) = self.series.and_then(|index| acting.model.series(index)) {
            works[acting.model.work_of_effect(index)] -= elapsed * series.calc_loss(gear);
        }
        elapsed * self.calc_loss(q, rate)
    }

    /// The law of this coordinate at the rate `v_new`.
    pub(crate) fn eval(&self, at: &CoordinatePoint, v_new: f64, acting: &Acting<'_>) -> CoordinateForce {
        let (q, v) = (at.q_base + at.beta * v_new, (1.0 - at.theta) * at.v_start + at.theta * v_new);
        let mut out =
            CoordinateForce { effort: -self.damping * v, slope: self.damping * at.theta, ..Default::default() };
        if let Some([lower, upper]) = self.limits {
            let (below, above) = (lower - q, q - upper);
            let (depth, sign) = if below > 0.0 { (below, 1.0) } else { (above, -1.0) };
            let push = self.stop_stiffness * depth - sign * self.stop_damping * v;
            if depth > 0.0 && push > 0.0 {
                out.effort += sign * push;
                out.slope += self.stop_stiffness * at.beta + self.stop_damping * at.theta;
            }
        }
        if let Some(law) = &self.dry {
            let s = Vec3::new(at.dry_start, 0.0, 0.0);
            let slip = Vec3::new(v, 0.0, 0.0);
            let s_trial = s + Vec3::new(at.moved_base + at.beta * v_new, 0.0, 0.0);
            let brush =
                law.eval(&Trial { s, s_trial, slip, elapsed: at.elapsed, normal_force: 1.0, ..Trial::default() });
            out.effort += brush.force.x;
            out.slope += if brush.sticks { brush.by_deflection.across * at.beta } else { 0.0 };
        }
        match self.series.and_then(|index| acting.model.series(index)) {
            None => self.add_drives((at, v_new), (q, v), acting, &mut out),
            Some((index, series)) => self.add_motor((at, v_new), (index, series), acting, &mut out),
        }
        for &index in &self.effects {
            if let EffectKind::Joint(effect) = &acting.model.effects.list[index].kind {
                let (effort, slope) = effect.eval((at, v_new), (q, v), acting.memory(index), acting.state.time);
                out.effort += effort;
                out.slope += slope;
            }
        }
        out
    }

    fn add_drives(
        &self,
        (at, v_new): (&CoordinatePoint, f64),
        motor: (f64, f64),
        acting: &Acting<'_>,
        out: &mut CoordinateForce,
    ) {
        let (mut effort, mut slope) = self.drive(at, motor, acting);
        if self.speed_limit.is_finite() {
            let limited = apply_speed_limit(self.speed_limit, (effort, slope), at.end.unwrap_or(v_new), at.branch);
            (effort, slope) = (limited.effort, limited.slope);
            (out.branch, out.fall) = (Some(limited.branch), limited.fall);
            out.is_limited = limited.branch != Branch::Full;
            if at.end.is_none() {
                slope += limited.fall;
            }
        }
        out.effort += effort;
        out.slope += slope;
        (out.driven, out.through) = (effort, effort);
    }

    fn add_motor(
        &self,
        (at, v_new): (&CoordinatePoint, f64),
        (index, series): (usize, &Series),
        acting: &Acting<'_>,
        out: &mut CoordinateForce,
    ) {
        let drive = |at: &CoordinatePoint, q: f64, v: f64| self.drive(at, (q, v), acting);
        let motor = series.eval(at, v_new, &self.shaft(index, acting), drive);
        out.effort += motor.effort;
        out.slope += motor.slope;
        (out.driven, out.through) = (motor.driven, motor.effort);
        out.is_limited = motor.is_limited;
    }

    /// The motor behind the gear that effect `index` is.
    pub(crate) fn shaft<'a>(&self, index: usize, acting: &Acting<'a>) -> Shaft<'a> {
        Shaft { memory: acting.memory(index), step: acting.step, speed_limit: self.speed_limit }
    }

    /// What all its actuators deliver with the motor at q and v, and −∂/∂v'.
    pub(crate) fn drive(&self, at: &CoordinatePoint, motor: (f64, f64), acting: &Acting<'_>) -> (f64, f64) {
        let each = self.actuators.iter().map(|&index| deliver(index, at, motor, acting));
        each.fold((0.0, 0.0), |sum, (effort, slope)| (sum.0 + effort, sum.1 + slope))
    }
}

fn deliver(index: usize, at: &CoordinatePoint, motor: (f64, f64), acting: &Acting<'_>) -> (f64, f64) {
    let lines = &acting.model.effects.lines;
    let nominal = nominal_effort(&acting.model.actuators[index].kind, lines.command(index, acting.state), at, motor);
    lines.deliver(index, nominal, acting)
}

/// Force of thruster `index` along its direction, N; zero for other actuators.
pub(crate) fn calc_thrust(index: usize, acting: &Acting<'_>) -> f64 {
    deliver(index, &CoordinatePoint::still(0.0, 0.0, acting.step), (0.0, 0.0), acting).0
}

impl Model {
    /// Position and rate of the motor that drives a coordinate, where encoder and tachometer sit.
    pub(crate) fn calc_motor_side(&self, state: &State, coordinate: usize) -> (f64, f64) {
        let (q, v) = (state.q[self.coordinates[coordinate].q_index], state.v[coordinate]);
        match self.coordinates[coordinate].series {
            Some(index) => {
                let memory = &state.effects[self.effects.memory(index)];
                (q + memory[0], v + memory[1])
            }
            None => (q, v),
        }
    }
}

impl Series {
    /// Deflection and its rate after a step that gives the joint the rate `v_new`.
    pub(super) fn advance(
        &self,
        at: &CoordinatePoint,
        v_new: f64,
        acting: &Acting<'_>,
        index: usize,
        scheme: Scheme,
    ) -> [f64; 2] {
        let (memory, coordinate) = (acting.memory(index), &acting.model.coordinates[self.coordinate]);
        let drive = |at: &CoordinatePoint, q: f64, v: f64| coordinate.drive(at, (q, v), acting);
        let motor = self.eval(at, v_new, &coordinate.shaft(index, acting), drive);
        let rate = motor.rate_end - v_new;
        let mean = if scheme == Scheme::ImplicitMidpoint { 0.5 * (memory[1] + rate) } else { rate };
        [memory[0] + acting.step * mean, rate]
    }
}

impl Passage {
    pub(crate) fn over_step(model: &Model, state: &State, ws: &Workspace, i: usize) -> Self {
        let (h, coordinate) = (ws.step, &model.coordinates[i]);
        let start = ws.q_start[coordinate.q_index];
        let moved = state.q[coordinate.q_index] - start;
        let (q, rate) = (start + 0.5 * moved, moved / h);
        let last = &ws.coordinate_points[i];
        let half = CoordinatePoint { elapsed: 0.5 * h, ..*last };
        let point =
            CoordinatePoint { q_base: q, moved_base: 0.5 * moved, v_start: rate, beta: 0.0, theta: 0.0, ..half };
        let gear = coordinate.series.map_or([0.0; 2], |index| {
            let at = model.effects.memory(index).start;
            let [from, to] = [ws.effects_start[at], state.effects[at]];
            [0.5 * (from + to), (to - from) / h]
        });
        let limited = find_limited(ws, i);
        Self { point, time: ws.end - 0.5 * h, q, rate, elapsed: h, gear, limited }
    }

    pub(crate) fn of_stage(model: &Model, state: &State, ws: &Workspace, i: usize) -> Self {
        let coordinate = &model.coordinates[i];
        let gear = coordinate.series.map_or([0.0; 2], |index| {
            let at = model.effects.memory(index).start;
            [state.effects[at], state.effects[at + 1]]
        });
        let (q, rate) = (state.q[coordinate.q_index], state.v[i]);
        let limited = find_limited(ws, i);
        Self { point: ws.coordinate_points[i], time: state.time, q, rate, elapsed: 1.0, gear, limited }
    }
}

/// The effort that a motor at its speed limit gave.
fn find_limited(ws: &Workspace, i: usize) -> Option<f64> {
    let force = &ws.coordinate_forces[i];
    force.is_limited.then_some(force.driven)
}

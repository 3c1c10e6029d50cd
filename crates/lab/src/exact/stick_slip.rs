//! Stick–slip of a block that a spring pulls at constant speed, event-exact (after Rabinowicz 1951, with a bristle).
//!
//!   m ẍ = k (V t − x) − f
//!
//! | mode | f | ends when |
//! | --- | --- | --- |
//! | stuck | K s + C ẋ, ṡ = ẋ | s reaches ± B_s/K: sliding; the force reaches ± B_s: capped |
//! | capped | ± B_s, ṡ = ẋ | s reaches ± B_s/K: sliding; K s + C ẋ falls below B_s: stuck |
//! | sliding | ± B_k, s = ± B_k/K | ẋ turns: stuck |
//!
//! B_s and B_k are the static and the kinetic bound (level times normal force, N), K and C the bristle's stiffness and
//! damping. Every mode is a linear oscillator under a growing load, so the motion between two events is closed; events
//! are found by bisection to round-off. Nothing of the simulator or of its law is used.

use super::first_root;
use super::oscillator::Oscillator;

/// Parameters, SI.
#[derive(Clone, Copy, Debug)]
pub struct StickSlip {
    /// m, kg.
    pub mass: f64,
    /// k of the pulling spring, N/m.
    pub pull_stiffness: f64,
    /// V, m/s.
    pub pull_speed: f64,
    /// B_s, N.
    pub bound_static: f64,
    /// B_k, N.
    pub bound_kinetic: f64,
    /// K, N/m.
    pub bristle_stiffness: f64,
    /// C, N·s/m.
    pub bristle_damping: f64,
}

/// How the block moves at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// On its bristle.
    Stuck,
    /// On its bristle, whose damper asks for more than the bound gives; the sign of the force's bound.
    Capped(f64),
    /// Dragging its bristle; the sign of the motion.
    Sliding(f64),
}

/// One mode's share of the motion.
#[derive(Clone, Copy, Debug)]
pub struct Phase {
    /// Mode.
    pub mode: Mode,
    /// Start, s.
    pub start: f64,
    /// End, s.
    pub end: f64,
    /// Place of the block at the start, m.
    pub place: f64,
    /// Deflection at the start, m.
    pub deflection: f64,
    motion: Oscillator,
}

impl Phase {
    /// Place (m) and speed (m/s) of the block at an instant of the phase.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let (y, v) = self.motion.at(t - self.start);
        (self.place + y, v)
    }
}

/// The steady cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// From breakaway to breakaway, s.
    pub period: f64,
    /// Half of greatest less least spring force, N.
    pub amplitude: f64,
    /// From stop to breakaway, s.
    pub stick: f64,
    /// Spring force at breakaway, N.
    pub breakaway: f64,
}

impl StickSlip {
    /// Force of the pulling spring with the block at `x`, N.
    pub fn spring_force(&self, t: f64, x: f64) -> f64 {
        self.pull_stiffness * (self.pull_speed * t - x)
    }

    /// The phases from rest at t = 0, spring and bristle unloaded, until `until`.
    pub fn phases(&self, until: f64) -> Vec<Phase> {
        let mut phases = Vec::new();
        let (mut t, mut x, mut v, mut s, mut mode) = (0.0, 0.0, 0.0, 0.0, Mode::Stuck);
        while t < until {
            let phase = self.phase(mode, (t, until), (x, v, s));
            let (y, speed) = phase.motion.at(phase.end - phase.start);
            (x, v) = (phase.place + y, speed);
            (s, mode) = self.after(&phase, y, v);
            if matches!(mode, Mode::Stuck) && matches!(phase.mode, Mode::Sliding(_)) {
                v = 0.0;
            }
            t = phase.end;
            phases.push(phase);
        }
        phases
    }

    fn phase(&self, mode: Mode, (start, until): (f64, f64), (place, speed, deflection): (f64, f64, f64)) -> Phase {
        let spring = self.spring_force(start, place);
        let (damping, stiffness, friction) = match mode {
            Mode::Stuck => {
                let (k, c) = (self.bristle_stiffness, self.bristle_damping);
                (c, self.pull_stiffness + k, k * deflection)
            }
            Mode::Capped(sign) => (0.0, self.pull_stiffness, sign * self.bound_static),
            Mode::Sliding(sign) => (0.0, self.pull_stiffness, sign * self.bound_kinetic),
        };
        let motion = Oscillator {
            mass: self.mass,
            damping,
            stiffness,
            load: spring - friction,
            load_rate: self.pull_stiffness * self.pull_speed,
            speed,
        };
        let mut phase = Phase { mode, start, end: until, place, deflection, motion };
        // A cap lasts about C/K; a hundredth of it is a safe step for the search there.
        let dt = match mode {
            Mode::Capped(_) => motion.resolution().min(0.01 * self.bristle_damping / self.bristle_stiffness),
            _ => motion.resolution(),
        };
        phase.end = first_root(|t| self.margin(&phase, t), start, until, dt).unwrap_or(until);
        phase
    }

    /// What is left until the phase's next event; not positive beyond it.
    fn margin(&self, phase: &Phase, t: f64) -> f64 {
        // From the displacement itself: place + y − place would cost the bristle's last digits.
        let (y, v) = phase.motion.at(t - phase.start);
        let s = phase.deflection + y;
        let force = self.bristle_stiffness * s + self.bristle_damping * v;
        match phase.mode {
            Mode::Stuck => self.bound_static - force.abs().max(self.bristle_stiffness * s.abs()),
            Mode::Capped(sign) => {
                (self.bound_static - self.bristle_stiffness * s * sign).min(force * sign - self.bound_static)
            }
            Mode::Sliding(sign) => v * sign,
        }
    }

    /// Deflection and mode after a phase.
    fn after(&self, phase: &Phase, y: f64, v: f64) -> (f64, Mode) {
        let s = phase.deflection + y;
        let (k, c) = (self.bristle_stiffness, self.bristle_damping);
        let slid = |sign: f64| sign * self.bound_kinetic / k;
        // An end is found a last bit beyond the event.
        let at_reach = k * s.abs() >= self.bound_static * (1.0 - 1e-12);
        match phase.mode {
            Mode::Sliding(sign) => (slid(sign), Mode::Stuck),
            _ if at_reach => (slid(s.signum()), Mode::Sliding(s.signum())),
            Mode::Stuck => (s, Mode::Capped((k * s + c * v).signum())),
            Mode::Capped(_) => (s, Mode::Stuck),
        }
    }

    /// The last whole cycle before `until`; `None` where there are not two breakaways.
    pub fn cycle(&self, until: f64) -> Option<Cycle> {
        let phases = self.phases(until);
        let slides = |p: &&Phase| matches!(p.mode, Mode::Sliding(_));
        let breaks: Vec<&Phase> = phases.iter().filter(slides).collect();
        let [.., first, second] = breaks.as_slice() else { return None };
        let (greatest, least) = self.spring_extremes(first);
        Some(Cycle {
            period: second.start - first.start,
            amplitude: 0.5 * (greatest - least),
            stick: second.start - first.end,
            breakaway: self.spring_force(second.start, second.place),
        })
    }

    /// Greatest and least spring force of a slide: where the block overtakes the pull, and where the pull overtakes it.
    fn spring_extremes(&self, slide: &Phase) -> (f64, f64) {
        let faster = |t: f64| slide.at(t).1 - self.pull_speed;
        let dt = slide.motion.resolution();
        let overtakes = first_root(|t| -faster(t), slide.start, slide.end, dt).unwrap_or(slide.end);
        let overtaken = first_root(faster, overtakes + dt, slide.end, dt).unwrap_or(slide.end);
        let force = |t: f64| self.spring_force(t, slide.at(t).0);
        (force(overtakes), force(overtaken))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const CASE: StickSlip = StickSlip {
        mass: 1.0,
        pull_stiffness: 100.0,
        pull_speed: 0.01,
        bound_static: 5.0,
        bound_kinetic: 3.0,
        bristle_stiffness: 1e7,
        bristle_damping: 300.0,
    };

    /// Rigid Coulomb friction with a drop: x = V t + A sin(ω t + φ) while sliding. From v = 0 at breakaway the elongation's
    /// amplitude is A = √((ΔB/k)² + (V/ω)²), the slide lasts 2(π − atan(ΔB ω/(k V)))/ω, the stick 2 ΔB/(k V).
    #[test]
    fn with_a_rigid_bristle_it_is_rabinowicz_s_cycle() {
        for speed in [0.003, 0.01, 0.1] {
            let case = StickSlip { pull_speed: speed, ..CASE };
            let drop = case.bound_static - case.bound_kinetic;
            let omega = (case.pull_stiffness / case.mass).sqrt();
            let (x, v) = (drop / case.pull_stiffness, speed / omega);
            let stick = 2.0 * x / speed;
            let slide = 2.0 * (std::f64::consts::PI - (x / v).atan()) / omega;
            let cycle = case.cycle(8.0 + 6.0 * (stick + slide)).unwrap();
            // The bristle moves the events by 5 N/1e7 N/m over the speed, twice, and by its damper's C/K = 30 µs.
            let tolerance = (1e-6 / speed + 6e-5) / stick;
            assert!((cycle.stick / stick - 1.0).abs() < tolerance, "{} {stick}", cycle.stick);
            assert!((cycle.period / (stick + slide) - 1.0).abs() < tolerance);
            assert!((cycle.amplitude / (case.pull_stiffness * x.hypot(v)) - 1.0).abs() < tolerance);
        }
    }

    /// Between events energy is conserved but for what friction takes: integrate the equation of motion by small steps.
    #[test]
    fn with_a_soft_bristle_it_agrees_with_tiny_steps() {
        let case = StickSlip { bristle_stiffness: 2e3, bristle_damping: 20.0, ..CASE };
        let until = 12.0;
        let (h, mut t, mut x, mut v, mut s, mut slides) = (2e-6, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64, false);
        while t < until - 0.5 * h {
            let bound = if slides { case.bound_kinetic } else { case.bound_static };
            let friction = if slides {
                s.signum() * bound
            } else {
                (case.bristle_stiffness * s + case.bristle_damping * v).clamp(-bound, bound)
            };
            v += h * (case.spring_force(t, x) - friction) / case.mass;
            x += h * v;
            t += h;
            if slides {
                slides = v * s > 0.0;
            } else {
                s += h * v;
                slides = s.abs() > bound / case.bristle_stiffness;
            }
            if slides {
                s = s.signum() * case.bound_kinetic / case.bristle_stiffness;
            }
        }
        let exact = case.phases(until).last().unwrap().at(until).0;
        // First order in 2 µs over a dozen events.
        assert!((x - exact).abs() < 2e-5 * exact, "{x} {exact}");
    }
}

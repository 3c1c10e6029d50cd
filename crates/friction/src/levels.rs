//! Friction levels: static, kinetic, what lies between them, and the time that it takes.
//!
//!   μ = μ_k + (μ_s − μ_k) w,     w: rest, 0 sliding … 1 rested
//!
//! | `stribeck_speed` v_s | `dwell_time` T | rest |
//! | --- | --- | --- |
//! | > 0 | 0 | w = exp(−(u/v_s)²): the level falls smoothly with the slip speed u (Stribeck) |
//! | > 0 | > 0 | ẇ = (exp(−(u/v_s)²) − w)/T where that rises; it falls with `fall_time` in place of T, or at once where that is 0 |
//! | 0 | 0 | w = 1 while the point sticks, 0 while it slides: the level drops where the bristle breaks away |
//! | 0 | > 0 | ẇ = (1 − w)/T while it sticks, 0 while it slides |
//!
//! The dwell time makes the breakaway force grow with the time at rest, and fall with the rate of loading (after Gonthier,
//! McPhee, Lange and Piedbœuf 2004, whose contact model lags the Stribeck exponential by a slow time constant where it
//! rises and a short one where it falls). A new contact starts rested where T = 0, else with w = 0.

/// How the level moves between static and kinetic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Levels {
    /// Level of a rested contact, 1.
    pub rested: f64,
    /// Level in fast sliding, 1.
    pub kinetic: f64,
    /// Speed over which the level falls, m/s; zero: it drops at breakaway.
    pub stribeck_speed: f64,
    /// Time constant with which rest returns, s; zero: at once.
    pub dwell_time: f64,
    /// Time constant with which it is lost in sliding, s; zero: at once.
    pub fall_time: f64,
}

impl Levels {
    /// Rest of a contact that has just begun.
    #[inline]
    pub fn initial_rest(&self) -> f64 {
        if self.dwell_time == 0.0 { 1.0 } else { 0.0 }
    }

    /// Level at a rest, 1.
    #[inline]
    pub fn at(&self, rest: f64) -> f64 {
        self.kinetic + (self.rested - self.kinetic) * rest
    }

    /// Whether the level never changes.
    #[inline]
    pub fn is_constant(&self) -> bool {
        self.rested == self.kinetic
    }

    /// exp(−(u/v_s)²); only where there is a Stribeck speed.
    #[inline]
    fn stribeck(&self, speed: f64) -> f64 {
        let x = speed / self.stribeck_speed;
        (-x * x).exp()
    }

    /// Rest after `elapsed` s in which it tends to `target`.
    #[inline]
    fn follow(&self, rest: f64, target: f64, elapsed: f64) -> f64 {
        let time = self.time_towards(target, rest);
        if time == 0.0 { target } else { rest - (target - rest) * (-elapsed / time).exp_m1() }
    }

    /// Time constant with which rest goes to `target`, s.
    #[inline]
    fn time_towards(&self, target: f64, rest: f64) -> f64 {
        if target > rest || self.dwell_time == 0.0 { self.dwell_time } else { self.fall_time }
    }

    /// Rest at a slip speed (m/s) after `elapsed` s; with a drop, the rest to which the trial is held.
    #[inline]
    pub fn calc_rest(&self, rest: f64, speed: f64, elapsed: f64) -> f64 {
        if self.is_constant() || self.stribeck_speed == 0.0 {
            return rest;
        }
        self.follow(rest, self.stribeck(speed), elapsed)
    }

    /// Rest once it is known whether the point sticks.
    #[inline]
    pub fn settle(&self, rest: f64, sticks: bool, elapsed: f64) -> f64 {
        match (self.stribeck_speed == 0.0, sticks) {
            (false, _) => rest,
            (true, true) => self.follow(rest, 1.0, elapsed),
            (true, false) => 0.0,
        }
    }

    /// Rest of a contact that has stuck for `elapsed` s since it began.
    pub fn calc_rested(&self, elapsed: f64) -> f64 {
        match self.stribeck_speed == 0.0 {
            true => self.settle(self.initial_rest(), true, elapsed),
            false => self.calc_rest(self.initial_rest(), 0.0, elapsed),
        }
    }

    /// Time for which a contact has stuck that has this rest, s.
    pub fn calc_time_at_rest(&self, rest: f64) -> f64 {
        -self.dwell_time * (-rest.clamp(0.0, 1.0 - f64::EPSILON)).ln_1p()
    }

    /// dμ/du at a slip speed, s/m; zero where the level does not follow the speed at once.
    #[inline]
    pub fn calc_slope(&self, speed: f64) -> f64 {
        if self.is_constant() || self.stribeck_speed == 0.0 || self.dwell_time > 0.0 {
            return 0.0;
        }
        let v = self.stribeck_speed;
        -2.0 * speed / (v * v) * (self.rested - self.kinetic) * self.stribeck(speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_at_rest_is_told_by_the_rest() {
        let dwelling = Levels { rested: 0.3, kinetic: 0.25, stribeck_speed: 1e-3, dwell_time: 0.8, fall_time: 2e-3 };
        // 1 − exp(−0.4/0.8)
        assert!((dwelling.calc_rested(0.4) - 0.393_469_340_287_366_6).abs() < 1e-15);
        assert!((dwelling.calc_time_at_rest(dwelling.calc_rested(0.4)) - 0.4).abs() < 1e-15);
        assert_eq!(dwelling.calc_rested(0.0), 0.0);
        // Where the level comes back at once any contact is rested, and nothing tells since when.
        let plain = Levels { dwell_time: 0.0, ..dwelling };
        assert_eq!((plain.calc_rested(0.0), plain.calc_time_at_rest(1.0)), (1.0, 0.0));
        // With a drop in place of a fall, it grows while it sticks.
        let dropping = Levels { stribeck_speed: 0.0, ..dwelling };
        assert_eq!(dropping.calc_rested(0.4), dwelling.calc_rested(0.4));
    }
}

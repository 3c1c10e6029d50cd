//! Normal laws: the force between two surfaces along the contact normal.
//!
//! With δ = −gap (penetration, m) and δ̇ = −gap rate (m/s), positive while the surfaces approach:
//!
//!   Hunt–Crossley    fₙ = k δⁿ (1 + d δ̇),    both brackets clamped at zero       (Hunt and Crossley 1975)
//!   spring-damper    fₙ = max(0, k δ + c δ̇)  for δ > 0, else 0
//!   constant         fₙ = f₀, whatever the gap: a weight that a guide holds against a surface
//!   adhesion         f  = fₙ − p  for δ > 0, p: pull-off force, N; zero is neutral and changes no bit
//!
//! fₙ is never attractive; adhesion is a part of its own, so that friction may use fₙ alone. Sign: a positive force
//! pushes B along +n, away from A. The Hunt–Crossley damper grows with the spring, so the force starts and ends at zero;
//! to first order in d v the coefficient of restitution is e = 1 − (2/3) d v at the impact speed v, for every n.
//!
//! K. H. Hunt and F. R. E. Crossley, "Coefficient of restitution interpreted as damping in vibroimpact",
//! J. Applied Mechanics 42 (1975) 440–445.

use crate::ContactError;

/// How a surface resists penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalLaw {
    /// fₙ = k δⁿ (1 + d δ̇): a power-law spring whose damping grows with the penetration.
    HuntCrossley {
        /// k, N/mⁿ.
        stiffness: f64,
        /// n, at least 1: 1 for a flat pad, 1.5 for spheres (Hertz).
        exponent: f64,
        /// d, s/m.
        dissipation: f64,
    },
    /// fₙ = k δ + c δ̇, clamped at zero.
    SpringDamper {
        /// k, N/m.
        stiffness: f64,
        /// c, N·s/m.
        damping: f64,
    },
    /// fₙ = f₀ at every gap: what presses is known and nothing gives way.
    Constant {
        /// f₀, N.
        force: f64,
    },
}

/// A normal law with adhesion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Normal {
    /// The repulsive part.
    pub law: NormalLaw,
    /// Pull-off force while the surfaces overlap, N; zero for none.
    pub adhesion: f64,
}

/// A normal force and its slopes, for linearly implicit steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NormalForce {
    /// Repulsion less adhesion, N; positive pushes the bodies apart.
    pub force: f64,
    /// ∂f/∂gap, N/m; zero or negative wherever the damping does not outweigh the spring.
    pub d_gap: f64,
    /// ∂f/∂(gap rate), N·s/m; zero or negative.
    pub d_rate: f64,
}

impl NormalLaw {
    /// Repulsive force at `gap` (m, negative = penetration) and `gap_rate` (m/s); never negative.
    #[inline]
    pub fn eval(&self, gap: f64, gap_rate: f64) -> NormalForce {
        if let Self::Constant { force } = *self {
            return NormalForce { force, ..NormalForce::default() };
        }
        let (depth, rate) = (-gap, -gap_rate);
        // Written so that NaN gives no force here: the step reports divergence from the state, with time and body.
        if depth.is_nan() || depth <= 0.0 {
            return NormalForce::default();
        }
        match *self {
            Self::HuntCrossley { stiffness, exponent, dissipation } => {
                let bracket = 1.0 + dissipation * rate;
                if bracket <= 0.0 {
                    return NormalForce::default();
                }
                let slope = stiffness * power(depth, exponent - 1.0);
                let spring = slope * depth;
                NormalForce {
                    force: spring * bracket,
                    d_gap: -exponent * slope * bracket,
                    d_rate: -spring * dissipation,
                }
            }
            Self::SpringDamper { stiffness, damping } => {
                let force = stiffness * depth + damping * rate;
                if force <= 0.0 {
                    return NormalForce::default();
                }
                NormalForce { force, d_gap: -stiffness, d_rate: -damping }
            }
            Self::Constant { force } => NormalForce { force, ..NormalForce::default() },
        }
    }

    /// Energy stored in the spring at `gap`, J: what it gives back when parted infinitely slowly.
    pub fn calc_stored_energy(&self, gap: f64) -> f64 {
        let depth = (-gap).max(0.0);
        match *self {
            Self::HuntCrossley { stiffness, exponent, .. } => stiffness * depth.powf(exponent + 1.0) / (exponent + 1.0),
            Self::SpringDamper { stiffness, .. } => 0.5 * stiffness * depth * depth,
            Self::Constant { .. } => 0.0,
        }
    }

    /// Power that the law takes for good, W, at `gap` (m) and `gap_rate` (m/s): its damper's; where the surfaces part faster than
    /// the spring follows, what the spring would have given. Never negative. Stated by itself, not from [`Self::eval`], so that an
    /// account of energy holds one against the other.
    #[inline]
    pub fn calc_loss(&self, gap: f64, gap_rate: f64) -> f64 {
        let (depth, rate) = (-gap, -gap_rate);
        if depth.is_nan() || depth <= 0.0 {
            return 0.0;
        }
        match *self {
            Self::HuntCrossley { stiffness, exponent, dissipation } => {
                let spring = stiffness * power(depth, exponent - 1.0) * depth;
                if dissipation * rate > -1.0 { spring * dissipation * rate * rate } else { -spring * rate }
            }
            Self::SpringDamper { stiffness, damping } => {
                let spring = stiffness * depth;
                if damping * rate > -spring { damping * rate * rate } else { -spring * rate }
            }
            Self::Constant { .. } => 0.0,
        }
    }

    fn check(&self) -> Result<(), ContactError> {
        match *self {
            Self::HuntCrossley { stiffness, exponent, dissipation } => {
                check_range("stiffness", stiffness, stiffness > 0.0, "finite and greater than 0 N/mⁿ")?;
                check_range("exponent", exponent, (1.0..=10.0).contains(&exponent), "between 1 and 10")?;
                check_range("dissipation", dissipation, dissipation >= 0.0, "finite and at least 0 s/m")
            }
            Self::SpringDamper { stiffness, damping } => {
                check_range("stiffness", stiffness, stiffness > 0.0, "finite and greater than 0 N/m")?;
                check_range("damping", damping, damping >= 0.0, "finite and at least 0 N·s/m")
            }
            Self::Constant { force } => check_range("force", force, force >= 0.0, "finite and at least 0 N"),
        }
    }
}

impl Normal {
    /// The law without adhesion.
    pub fn new(law: NormalLaw) -> Self {
        Self { law, adhesion: 0.0 }
    }

    /// Force at `gap` (m, negative = penetration) and `gap_rate` (m/s): repulsion, less adhesion while they overlap.
    #[inline]
    pub fn eval(&self, gap: f64, gap_rate: f64) -> NormalForce {
        let mut out = self.law.eval(gap, gap_rate);
        if gap < 0.0 {
            out.force -= self.adhesion;
        }
        out
    }

    /// The repulsive part alone, N: what friction is bounded by.
    #[inline]
    pub fn calc_compression(&self, gap: f64, gap_rate: f64) -> f64 {
        self.law.eval(gap, gap_rate).force
    }

    /// What adhesion takes off the repulsion at a gap, N.
    #[inline]
    pub fn adhesion_at(&self, gap: f64) -> f64 {
        if gap < 0.0 { self.adhesion } else { 0.0 }
    }

    /// Energy stored in the spring at `gap`, J, less the work that adhesion has to be paid to part: k δⁿ⁺¹/(n+1) − p δ.
    pub fn calc_stored_energy(&self, gap: f64) -> f64 {
        self.law.calc_stored_energy(gap) - self.adhesion * (-gap).max(0.0)
    }

    /// Checks the ranges of all parameters.
    pub fn check(&self) -> Result<(), ContactError> {
        self.law.check()?;
        check_range("adhesion", self.adhesion, self.adhesion >= 0.0, "finite and at least 0 N")
    }
}

fn check_range(parameter: &'static str, value: f64, fits: bool, range: &'static str) -> Result<(), ContactError> {
    if fits && value.is_finite() { Ok(()) } else { Err(ContactError::LawParameter { parameter, value, range }) }
}

/// depthᵉ with the exponents of practice, 0 (flat) and ½ (Hertz), exactly rounded and fast.
#[inline]
fn power(depth: f64, exponent: f64) -> f64 {
    if exponent == 0.0 {
        1.0
    } else if exponent == 0.5 {
        depth.sqrt()
    } else {
        depth.powf(exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn hertz() -> NormalLaw {
        NormalLaw::HuntCrossley { stiffness: 2e5, exponent: 1.5, dissipation: 0.6 }
    }

    fn laws() -> impl Strategy<Value = NormalLaw> {
        let hunt = (1.0..1e8f64, 1.0..3.0f64, 0.0..10.0f64).prop_map(|(stiffness, exponent, dissipation)| {
            NormalLaw::HuntCrossley { stiffness, exponent, dissipation }
        });
        let linear =
            (1.0..1e8f64, 0.0..1e5f64).prop_map(|(stiffness, damping)| NormalLaw::SpringDamper { stiffness, damping });
        prop_oneof![hunt, linear]
    }

    proptest! {
        #[test]
        fn a_law_never_pulls(law in laws(), gap in -0.01..0.01f64, rate in -10.0..10.0f64) {
            let f = law.eval(gap, rate);
            prop_assert!(f.force >= 0.0 && f.d_gap <= 0.0 && f.d_rate <= 0.0);
            prop_assert!(gap < 0.0 || f == NormalForce::default());
        }

        #[test]
        fn slopes_are_those_of_the_force(law in laws(), gap in -0.01..-1e-4f64, rate in -0.05..0.05f64) {
            let (f, h) = (law.eval(gap, rate), 1e-8);
            let sides = [law.eval(gap - h, rate), law.eval(gap + h, rate), law.eval(gap, rate - h), law.eval(gap, rate + h)];
            prop_assume!(f.force > 0.0 && sides.iter().all(|s| s.force > 0.0));
            // Central differences: round-off of the force over h, and h² (relative 1e-8 of the depth squared).
            let tol = |slope: f64| 1e-6 * slope.abs() + 1e-14 * f.force / h + 1e-9;
            let d_gap = (sides[1].force - sides[0].force) / (2.0 * h);
            let d_rate = (sides[3].force - sides[2].force) / (2.0 * h);
            prop_assert!((d_gap - f.d_gap).abs() <= tol(f.d_gap), "{} {}", d_gap, f.d_gap);
            prop_assert!((d_rate - f.d_rate).abs() <= tol(f.d_rate), "{} {}", d_rate, f.d_rate);
        }

        #[test]
        fn what_is_not_stored_is_lost(law in laws(), gap in -0.01..-1e-4f64, rate in -10.0..10.0f64) {
            // Power of the force on what moves, and what the spring takes at that rate.
            let (power, spring) = (-law.eval(gap, rate).force * rate, law.eval(gap, 0.0).force * -rate);
            let loss = law.calc_loss(gap, rate);
            prop_assert!(loss >= 0.0 && (power - spring - loss).abs() <= 1e-12 * (power.abs() + spring.abs() + loss));
        }

        #[test]
        fn stored_energy_is_the_work_of_the_spring(law in laws(), depth in 1e-4..0.01f64) {
            // Midpoint rule with 2,000 intervals: error below 1e-5 of the whole for exponents from 1.
            let (n, sum) = (2000, (0..2000).map(|i| law.eval(-depth * (f64::from(i) + 0.5) / 2000.0, 0.0).force).sum::<f64>());
            let work = sum * depth / f64::from(n);
            prop_assert!((work - law.calc_stored_energy(-depth)).abs() < 1e-5 * work);
        }
    }

    #[test]
    fn hunt_crossley_in_numbers() {
        let f = hertz().eval(-1e-4, -0.5);
        // 2e5 · (1e-4)^1.5 · (1 + 0.6 · 0.5) = 0.26 N
        assert!((f.force - 0.26).abs() < 1e-14);
        assert_eq!(hertz().eval(-1e-4, 2.0), NormalForce::default(), "parting faster than 1/d: no pull");
    }

    #[test]
    fn zero_adhesion_changes_no_bit_and_adhesion_pulls_by_its_force() {
        let plain = Normal::new(hertz());
        let sticky = Normal { adhesion: 0.3, ..plain };
        for gap in [-1e-3, -1e-7, 0.0, 1e-7] {
            assert_eq!(plain.eval(gap, -0.1), hertz().eval(gap, -0.1));
        }
        assert!((sticky.eval(-1e-5, 0.0).force - (hertz().eval(-1e-5, 0.0).force - 0.3)).abs() < 1e-15);
        assert_eq!(sticky.eval(1e-9, 0.0).force, 0.0);
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let bad = Normal::new(NormalLaw::HuntCrossley { stiffness: 1e5, exponent: 0.5, dissipation: 0.0 });
        let message = bad.check().expect_err("an exponent below one is refused").to_string();
        assert_eq!(message, "normal law: exponent is 0.5; it must be between 1 and 10");
        assert!(Normal { adhesion: f64::NAN, ..Normal::new(hertz()) }.check().is_err());
        assert!(Normal::new(hertz()).check().is_ok());
    }
}

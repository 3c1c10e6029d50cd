//! One type for all laws, so that a user can see what each gets wrong.

use crate::bristle::Bristle;
use crate::coulomb::RegularisedCoulomb;
use crate::lugre::LuGre;
use crate::trial::{Brush, BrushRate, FrictionError, Trial};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The friction law of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Friction {
    /// The extended bristle law.
    Bristle(Bristle),
    /// A smooth function of the slip velocity.
    Coulomb(RegularisedCoulomb),
    /// LuGre, Dahl or elasto-plastic.
    LuGre(LuGre),
}

impl From<Bristle> for Friction {
    fn from(law: Bristle) -> Self {
        Self::Bristle(law)
    }
}

impl From<RegularisedCoulomb> for Friction {
    fn from(law: RegularisedCoulomb) -> Self {
        Self::Coulomb(law)
    }
}

impl From<LuGre> for Friction {
    fn from(law: LuGre) -> Self {
        Self::LuGre(law)
    }
}

impl Friction {
    /// Checks every parameter's range.
    pub fn check(&self) -> Result<(), FrictionError> {
        match self {
            Self::Bristle(law) => law.check(),
            Self::Coulomb(law) => law.check(),
            Self::LuGre(law) => law.check(),
        }
    }

    /// Force, new deflection and rest, and derivatives.
    #[inline]
    pub fn eval(&self, trial: &Trial) -> Brush {
        match self {
            Self::Bristle(law) => law.eval(trial),
            Self::Coulomb(law) => law.eval(trial),
            Self::LuGre(law) => law.eval(trial),
        }
    }

    /// The law in continuous time; `trial.s_trial` and `trial.elapsed` do not matter.
    pub fn eval_rate(&self, trial: &Trial) -> BrushRate {
        match self {
            Self::Bristle(law) => law.eval_rate(trial),
            Self::Coulomb(law) => law.eval_rate(trial),
            Self::LuGre(law) => law.eval_rate(trial),
        }
    }

    /// Rest of a contact that has just begun.
    #[inline]
    pub fn initial_rest(&self) -> f64 {
        if let Self::Bristle(law) = self { law.initial_rest() } else { 1.0 }
    }

    /// Stiffness and damping of the bristle, N/m and N·s/m; zero for a law without one.
    #[inline]
    pub fn spring(&self) -> (f64, f64) {
        match self {
            Self::Bristle(law) => (law.stiffness, law.damping),
            Self::Coulomb(_) => (0.0, 0.0),
            Self::LuGre(law) => (law.stiffness, law.damping),
        }
    }

    /// Viscous term, N·s/m.
    #[inline]
    pub fn viscous(&self) -> f64 {
        match self {
            Self::Bristle(law) => law.viscous,
            Self::Coulomb(law) => law.viscous,
            Self::LuGre(law) => law.viscous,
        }
    }

    /// The highest level that it can reach, 1.
    pub fn highest_level(&self) -> f64 {
        match self {
            Self::Bristle(law) => law.mu_static.max(law.mu_kinetic) * law.across.max(1.0),
            Self::Coulomb(law) => law.mu_static.max(law.mu_kinetic),
            Self::LuGre(law) => law.mu_static.max(law.mu_kinetic),
        }
    }

    /// The law of a point that carries the share `w` of it: stiffness, damping and viscous term; levels stay, since the
    /// normal force that they multiply has its share already.
    pub fn weighted(&self, w: f64) -> Self {
        match *self {
            Self::Bristle(f) => {
                Bristle { stiffness: w * f.stiffness, damping: w * f.damping, viscous: w * f.viscous, ..f }.into()
            }
            Self::Coulomb(f) => RegularisedCoulomb { viscous: w * f.viscous, ..f }.into(),
            Self::LuGre(f) => {
                LuGre { stiffness: w * f.stiffness, damping: w * f.damping, viscous: w * f.viscous, ..f }.into()
            }
        }
    }

    /// Energy stored in a deflection, J.
    pub fn calc_stored_energy(&self, s: &Vector3<f64>) -> f64 {
        0.5 * self.spring().0 * s.norm_squared()
    }
}

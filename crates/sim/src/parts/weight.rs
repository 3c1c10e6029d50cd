//! The share of a pair's law that acts at one point.
//!
//! A sample of a bed carries w = A/A_ref of its pair's law: stiffness, damping and adhesion along the normal, stiffness,
//! damping and viscous term of the bristle. Exponents, dissipation and friction levels are as they are: μ multiplies a
//! normal force that has its share already, and the reach μ fₙ/k of a bristle does not depend on w. At w = 1, the weight
//! of every other point, no bit changes.

use super::pair::PairLaw;
use contact::{Normal, NormalLaw};
use friction::Pivot;
use std::borrow::Cow;

impl PairLaw {
    /// The law at a point of the weight `w`.
    #[inline]
    pub(crate) fn weighted(&self, w: f64) -> Cow<'_, Self> {
        if w == 1.0 { Cow::Borrowed(self) } else { Cow::Owned(self.scaled(w)) }
    }

    fn scaled(&self, w: f64) -> Self {
        let law = match self.normal.law {
            NormalLaw::HuntCrossley { stiffness, exponent, dissipation } => {
                NormalLaw::HuntCrossley { stiffness: w * stiffness, exponent, dissipation }
            }
            NormalLaw::SpringDamper { stiffness, damping } => {
                NormalLaw::SpringDamper { stiffness: w * stiffness, damping: w * damping }
            }
            NormalLaw::Constant { force } => NormalLaw::Constant { force: w * force },
        };
        Self {
            normal: Normal { law, adhesion: w * self.normal.adhesion },
            friction: self.friction.map(|f| f.weighted(w)),
            pivot: self.pivot.map(|p| Pivot { stiffness: w * p.stiffness, damping: w * p.damping, ..p }),
            grain: self.grain,
            only_deepest: self.only_deepest,
        }
    }
}

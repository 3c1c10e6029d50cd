//! A problem at the clock at which the derivatives of what was found are what they are.

use super::coarse::{self, Coarse};
use super::fit::{Fitted, Problem};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::fit::{first_sizes, vary};
use crate::held::holds;

impl Problem<'_> {
    /// The same at a clock at which derivatives of a set, those by its numbers too, are what they are: what was found may be faster than what a nominal model
    /// has. That of a model with dry friction stays as it is.
    pub fn heard_by(self, set: &EffectSet) -> Result<Self, DiagnoseError> {
        if self.coarse.first().is_none_or(|c| c.is_exact) || !set.has_findings() {
            return Ok(self);
        }
        let is_finding = |((m, _), _): &((usize, usize), f64)| !set.members[*m].0.is_tolerated();
        let (slots, sizes): (Vec<_>, Vec<f64>) =
            set.slots().into_iter().zip(first_sizes(set)).filter(is_finding).unzip();
        let built = self.plant.build(&set.effects())?;
        // Corners differ from clock to clock, and both ends of a quotient have the same; what holds is replayed as it is judged anyway.
        if holds(&built) || built.model.coordinates.iter().any(|c| c.dry.is_some()) {
            return Ok(self);
        }
        let variations = vary(self.plant, set, &slots, &sizes)?;
        let coarse = coarse::of_model(&self.stage, (&built, &self.forces), (&self.runs, self.knots), &variations);
        let longest = |clock: &[Coarse]| clock.first().map_or(0.0, |c| c.longest);
        Ok(if longest(&coarse) > longest(&self.coarse) { self } else { Self { coarse, ..self } })
    }

    /// A fit at this clock where another one was fitted at a different one.
    pub fn reheard(&self, other: &Self, fit: &Fitted) -> Result<Option<Fitted>, DiagnoseError> {
        let clock = |of: &Self| of.coarse.first().map(|c| (c.is_exact, c.longest));
        if clock(self) == clock(other) {
            return Ok(None);
        }
        let step = self.coarse.first().map_or(0.0, |c| c.longest);
        self.stage.work.watch.step(&format!("derivatives of what was found are taken in steps of {step:.3e} s"));
        self.onto(fit).map(Some)
    }
}

//! Runs followed by another model than that which their states are of.

use super::fit::{Fitted, Made, Problem, Reach, SETTLING};
use super::marginal::score;
use super::track::{Link, Told, Track};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::held::holds;
use nalgebra::DVector;
use rayon::prelude::*;
use std::sync::Arc;

/// Rise of −2 log likelihood by residual with which derivatives have led astray, and up to which a model is where the runs are already.
const ASTRAY: f64 = 0.1;
const THERE: f64 = 1e-3;

/// Share of what a force was begun with below which it was held for none.
const NONE: f64 = 1e-2;
/// Times that a model that holds is followed anew, and fall of −2 log likelihood by residual that is worth another time.
const FOLLOWED: usize = 4;
const FALLEN: f64 = 3e-3;
impl Problem<'_> {
    /// The runs of another fit followed by a model: with the derivatives that are known, and with its own where those lead astray.
    pub(super) fn followed(&self, from: &Fitted, with: Fitted) -> Result<Fitted, DiagnoseError> {
        let mut now = with.clone();
        if with.links.is_empty() {
            self.follow(&mut now)?;
            return Ok(now);
        }
        // One law in the place of its equal: the runs are where it has them.
        let is_replaced = with.set.members.len() == from.set.members.len();
        if is_replaced && with.set.titles() != from.set.titles() {
            let made = self.linearise(&mut now, &[], true);
            if made.is_ok_and(|made| self.score_of(&made, &now) < from.score + THERE * from.count as f64) {
                return Ok(now);
            }
        }
        let is_near = self.follow(&mut now).and_then(|()| {
            let made = self.linearise(&mut now, &[], true)?;
            Ok(self.score_of(&made, &now) < from.score + ASTRAY * from.count as f64)
        });
        if is_near.unwrap_or(false) {
            return Ok(now);
        }
        now = Fitted { links: Vec::new(), ..with };
        self.follow(&mut now)?;
        Ok(now)
    }

    /// Whether the first of two sets that may take another one's place is as likely as the other at the states of that; it is where derivatives are not known.
    pub(crate) fn is_likelier_to_begin(&self, from: &Fitted, sets: [&EffectSet; 2]) -> bool {
        let score = |set: &EffectSet| {
            let mut now = self.with(from, self.possible(from, set.clone()).ok()?).ok()?;
            let made = (!now.links.is_empty()).then(|| self.linearise(&mut now, &[], true))?;
            made.ok().map(|made| self.score_of(&made, &now)).filter(|score| score.is_finite())
        };
        match sets.map(score) {
            [Some(own), Some(other)] => own <= other,
            [own, other] => own.is_some() || other.is_none(),
        }
    }

    /// −2 log likelihood of a fit as it stands.
    fn score_of(&self, made: &Made, of: &Fitted) -> f64 {
        score(&made.chains(&[]), &of.spread) + of.set.prior_cost() - of.datum
    }

    /// Lets the runs be followed by another model than that which their states are of: what pushed them, pushes it no more or more.
    pub(super) fn follow(&self, now: &mut Fitted) -> Result<(), DiagnoseError> {
        let mut tracks = now.tracks.clone();
        let frame = self.frame(now);
        let channels = self.channels_of(&now.tracks);
        let usual = now.spread.usual_force();
        let follow = |(k, track): (usize, &mut Track)| {
            let known = now.links.get(k).map(|links| links.as_slice());
            let of_interval =
                |own: &Vec<u16>| DVector::from_iterator(own.len(), own.iter().map(|c| now.spread.noise[*c as usize]));
            let factors: Vec<DVector<f64>> = channels[k].iter().map(of_interval).collect();
            let told = Told { start: &now.first, force: &usual, factors: &factors };
            frame.follow(track, told, known).map(Arc::new)
        };
        let links: Option<Vec<Arc<Vec<Link>>>> = tracks.par_iter_mut().enumerate().map(follow).collect();
        now.links = links.ok_or_else(|| self.lost())?;
        now.tracks = tracks;
        Ok(())
    }

    /// A fit whose runs are followed anew, and its numbers from there, as long as that betters it; as it is where all intervals are followed.
    pub(super) fn fitted_again(&self, mut now: Fitted, reach: Reach) -> Result<Fitted, DiagnoseError> {
        for _ in 0..FOLLOWED {
            let again = self.followed_again(now.clone())?;
            let fall = now.score - again.score;
            if fall.is_nan() || fall < FALLEN * now.count as f64 {
                break;
            }
            let next = self.fit_once(&again, again.set.clone(), Reach { reuse: true, ..reach })?;
            now = if next.score < again.score { next } else { again };
        }
        Ok(now)
    }

    /// A fit with forces that seemed idle while its states were astray tried again at what they were begun with, where that is better.
    pub(super) fn with_forces_again(&self, settled: Fitted, begun: &DVector<f64>) -> Fitted {
        let Some(again) = revived(&settled, begun) else { return settled };
        let again = self.settle(again, SETTLING, true).ok();
        again.filter(|again| again.score < settled.score).unwrap_or(settled)
    }

    /// A fit whose runs nothing unknown pushes, its numbers as they are.
    pub fn without_forces(&self, mut of: Fitted) -> Result<Fitted, DiagnoseError> {
        of.spread.force.fill(0.0);
        self.settle(of, SETTLING, true)
    }

    /// A fit that came out worse than what it goes on from and has more numbers than, where forces fell idle while its states were astray: again, with
    /// those as large as they were known to be.
    pub(super) fn with_forces_of(&self, from: &Fitted, fitted: Fitted, reach: Reach) -> Result<Fitted, DiagnoseError> {
        if fitted.score <= from.score {
            return Ok(fitted);
        }
        let Some(begun) = revived(&fitted, &from.spread.force) else { return Ok(fitted) };
        let again = self.fit_once(&begun, begun.set.clone(), Reach { reuse: true, ..reach });
        Ok(again.ok().filter(|again| again.score < fitted.score).unwrap_or(fitted))
    }

    /// Runs of a model that holds followed anew, as long as that betters them: states that were led astray through a touch are found again by what comes before
    /// them, not by steps along derivatives that were taken astray.
    pub(super) fn followed_again(&self, mut now: Fitted) -> Result<Fitted, DiagnoseError> {
        for _ in 0..FOLLOWED {
            if !holds(&now.built) || !now.spread.is_led_astray() {
                break;
            }
            let mut next = Fitted { links: Vec::new(), ..now.clone() };
            next.spread.local.clear();
            self.follow(&mut next)?;
            let next = self.settle(next, SETTLING, true)?;
            let fall = now.score - next.score;
            if fall.is_nan() || fall <= 0.0 {
                break;
            }
            now = next;
            if fall < FALLEN * now.count as f64 {
                break;
            }
        }
        Ok(now)
    }
}

/// A fit with the forces that fell idle as large as they were known to be; none where none did.
fn revived(fitted: &Fitted, known: &DVector<f64>) -> Option<Fitted> {
    let force = fitted.spread.force.zip_map(known, |now, known| if now < NONE * known { known } else { now });
    let mut revived = (force != fitted.spread.force).then(|| fitted.clone())?;
    revived.spread.force = force;
    Some(revived)
}

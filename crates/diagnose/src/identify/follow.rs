//! Runs followed by another model than that which their states are of.

use super::fit::{Fitted, Made, Problem};
use super::marginal::score;
use super::track::{Link, Told, Track};
use crate::error::DiagnoseError;
use nalgebra::DVector;
use rayon::prelude::*;
use std::sync::Arc;

/// Rise of −2 log likelihood by residual with which derivatives have led astray, and up to which a model is where the runs are already.
const ASTRAY: f64 = 0.1;
const THERE: f64 = 1e-3;

impl Problem<'_> {
    /// The runs of another fit followed by a model: with the derivatives that are known, and with its own where those lead astray.
    pub(super) fn followed(&self, from: &Fitted, with: Fitted) -> Result<Fitted, DiagnoseError> {
        let mut now = with.clone();
        if with.links.is_empty() {
            self.follow(&mut now)?;
            return Ok(now);
        }
        // One law in the place of its equal: the runs are where it has them.
        let is_replaced = with.set.members.len() == from.set.members.len() && with.set.titles() != from.set.titles();
        if is_replaced {
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
}

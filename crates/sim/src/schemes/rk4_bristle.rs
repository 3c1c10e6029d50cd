//! Bristles through a Runge–Kutta step: where the normal force goes to zero they turn faster than any step can follow.
//!
//! At every stage the deflection is brought there from the step's start by [`friction::Bristle::flow`], along the slip and
//! the normal force found so far; at the end along the quadratics through start, middle (the mean of both stages) and end.
//! While a bristle sticks through a stage that is s + c h u of the stage before, the method's own value, and at the end its
//! own sum, h/6 (u₁ + 2 u₂ + 2 u₃ + u₄): order four stays.

use crate::forces::contacts::Turned;
use crate::model::Model;
use crate::state::ContactMemory;
use crate::workspace::Touch;
use friction::{Bristle, Friction, SlipPath};
use spatial::Vec3;

/// What the stages found at one point: slip in the plane and axes of the step's start (m/s), compression (N), and what has
/// become of deflection and rest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Track {
    slip: [Vec3; 4],
    normal_force: [f64; 4],
    end: Option<(Vec3, f64)>,
}

/// A stage, as seen from a point.
pub(crate) struct Stage<'a> {
    /// Its number.
    pub node: usize,
    /// h, s.
    pub step: f64,
    /// Memory at the step's start.
    pub slot: &'a ContactMemory,
    /// From the frames of the start to the present ones, and back.
    pub there: &'a Turned<'a>,
    pub back: &'a Turned<'a>,
}

fn bristle(model: &Model, pair: u32, weight: f64) -> Option<Bristle> {
    match model.laws[pair as usize].weighted(weight).friction {
        Some(Friction::Bristle(law)) => Some(law),
        _ => None,
    }
}

/// Whether a pair's deflections are brought along here; else they have rates.
pub(crate) fn is_tracked(model: &Model, pair: u32) -> bool {
    matches!(model.laws[pair as usize].friction, Some(Friction::Bristle(_)))
}

/// Brings a touch's bristle, which it recalled as it was at the step's start, to the present stage.
pub(crate) fn bring(model: &Model, touch: &mut Touch, at: &Stage<'_>, track: &mut Track) {
    let Some(law) = bristle(model, touch.pair, touch.weight) else { return };
    let (n, k) = (touch.normal, at.node);
    let slip = touch.u - n * n.dot(&touch.u);
    let normal_force =
        model.laws[touch.pair as usize].weighted(touch.weight).normal.calc_compression(touch.gap, n.dot(&touch.u));
    let bodies = (touch.body_a, touch.body_b);
    track.slip[k] = at.back.deflection(bodies, &slip, &n, &at.slot.normal_w);
    track.normal_force[k] = normal_force;
    if k == 0 {
        return;
    }
    let here = |v: &Vec3| at.there.deflection(bodies, v, &at.slot.normal_w, &n);
    let from = (here(&track.slip[0]), track.normal_force[0]);
    let elapsed = if k == 3 { at.step } else { 0.5 * at.step };
    let way = Way { law: &law, s: touch.s, rest: touch.rest, grain: touch.grain };
    let own =
        SlipPath { slip: [here(&track.slip[k - 1]); 3], ..SlipPath::between(from, (slip, normal_force), elapsed) };
    let whole = SlipPath {
        slip: [from.0, here(&(0.5 * (track.slip[1] + track.slip[2]))), slip],
        normal_force: [from.1, 0.5 * (track.normal_force[1] + track.normal_force[2]), normal_force],
        elapsed: at.step,
    };
    if k == 3 {
        let (s, rest) = way.end(&whole, &whole);
        track.end = Some((at.back.deflection(bodies, &s, &n, &at.slot.normal_w), rest));
        (touch.s, touch.rest) = way.end(&own, &whole);
    } else {
        (touch.s, touch.rest) = way.end(&own, &SlipPath::between(from, (slip, normal_force), elapsed));
    }
}

/// Where a bristle starts from.
struct Way<'a> {
    law: &'a Bristle,
    s: Vec3,
    rest: f64,
    grain: Vec3,
}

impl Way<'_> {
    /// Deflection and rest at the end: along `own` where it sticks, else along `path`.
    fn end(&self, own: &SlipPath, path: &SlipPath) -> (Vec3, f64) {
        match self.law.stick(&self.s, &self.grain, own) {
            Some(s) => (s, self.rest),
            None => self.law.flow(&self.s, self.rest, &self.grain, path),
        }
    }
}

/// Puts the bristles where the last stage found them; what does not touch there any more has none.
pub(crate) fn place_at_the_end(model: &Model, tracks: &[Track], bristles: &mut [ContactMemory]) {
    for (memory, track) in bristles.iter_mut().zip(tracks) {
        if let Some(law) = bristle(model, memory.pair, 1.0) {
            (memory.s_w, memory.rest) = track.end.unwrap_or_else(|| (Vec3::zeros(), law.levels().initial_rest()));
        }
    }
}

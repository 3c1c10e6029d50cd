//! A set of effects fitted to whole runs: Gauss–Newton on numbers and states together, forces and noise as large as the data make them.
//!
//! One iteration: every interval about its state, the numbers' columns, numbers and spread by [`super::marginal`], states by the smoother. States follow the
//! samples whatever the model does, so that no run is ever lost, and the columns are those of the motion that was measured; what remains nonlinear is the
//! numbers themselves. A step is taken if it lowers the marginal likelihood's −2 log as made linear there, and shortened where it does not.

use super::coarse::{self, Coarse};
use super::damped::{Look, SHORTER, Way};
use super::forces::{Force, first_spread, forces};
use super::marginal::{Chain, Estimate, Linear, Spread, estimate, price_of_factor};
use super::shown::shown;
use super::step::next_sizes;
use super::track::{Base, Bases, Column, Frame, Interval, Link, Side, Source, Track, coordinates};
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::facts::Facts;
use crate::fit::{first_sizes, vary};
use crate::held::holds;
use crate::linear::{Stage, Variation};
use crate::plant::{Built, Plant};
use crate::start::Freedom;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::sync::Arc;

/// What is fitted to what.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    /// Runs, steps and counts.
    pub stage: Stage<'a>,
    /// The runs at coarser clocks.
    pub coarse: Arc<Vec<Coarse>>,
    /// The scenario.
    pub plant: &'a Plant,
    /// Runs that are fitted.
    pub runs: Vec<usize>,
    /// Intervals of each run.
    pub knots: usize,
    /// Unknown forces.
    pub forces: Vec<Force>,
    /// Names of the channels, in the order of their numbers.
    pub channels: Vec<String>,
}

/// A set of effects with all that goes with it.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The set.
    pub set: EffectSet,
    /// Its model.
    pub built: Built,
    /// Coordinates of a state.
    pub freedoms: Vec<Freedom>,
    /// Runs with their states.
    pub tracks: Vec<Track>,
    /// Derivatives by states and forces, as last taken.
    pub links: Vec<Arc<Vec<Link>>>,
    /// Columns of the numbers that only move within their tolerances: they change little, and are taken anew where these have moved.
    pub steady: Steady,
    /// Prior standard deviations of a first state.
    pub first: DVector<f64>,
    /// Spread of forces and noise.
    pub spread: Spread,
    /// −2 log of the marginal likelihood and of the numbers' priors, less the datum.
    pub score: f64,
    /// What the same fit on halved intervals has more of it than on those that a search began with: scores are told as of these.
    pub datum: f64,
    /// Part of it that residuals make.
    pub cost: f64,
    /// Residuals.
    pub count: usize,
    /// Covariance of the fitted numbers.
    pub covariance: DMatrix<f64>,
    /// Whether the last step promised next to nothing.
    pub converged: bool,
}

/// What the intervals of all runs read and where they end, run by run.
type Exact = Vec<Vec<Base>>;

/// Columns of a run, number by number and interval by interval.
pub type Columns = Vec<Vec<Column>>;

/// Columns of the numbers that only move within their tolerances, and where these stood, units of their tolerances.
#[derive(Clone, Debug, Default)]
pub struct Steady {
    runs: Vec<Arc<Columns>>,
    at: Vec<f64>,
}

/// How far a fit goes.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Most iterations.
    pub iterations: usize,
    /// Whether derivatives by states and forces may be those of an earlier fit.
    pub reuse: bool,
}

/// Intervals of a run, and samples of its sparsest reading that each has.
const KNOTS: std::ops::RangeInclusive<usize> = 24..=48;
const SAMPLES: usize = 12;
/// How many times as many intervals as the shortest run another one has at most.
const LONGER: usize = 32;
/// How many times as many a run has where a replay leaves the range of numbers, one after the other.
const FINER: [usize; 2] = [2, 4];
/// Promised fall of −2 log likelihood below which a fit has converged.
pub(super) const CONVERGED: f64 = 0.3;
/// Share of what a look has brought below which a step that does not bring what it promises is not shortened.
const LITTLE: f64 = 0.01;
/// Shares of the way to a model that cannot be built that are tried instead: powers of the half.
const HALVINGS: i32 = 4;
const NEARER: f64 = 0.5;
/// Steps of the spread: from afar, and near.
const STEPS: [usize; 2] = [12, 6];
/// Iterations of states and spread of a model without numbers.
pub(super) const SETTLING: usize = 3;
/// Iterations until the states of a model that holds have settled.
const CONVERGING: usize = 12;
/// Iterations until states follow each other, and what they may miss each other by, units of noise: a free run makes much of it.
const JOININGS: usize = 3;
const JOINED: f64 = 1e-2;
/// Standard deviations of its tolerance by which a number moves until its column is taken anew: a mass and an arm whose product shows are told apart by
/// what their columns differ in, of second order.
const MOVED: f64 = 0.1;
/// A first state is known no better than so many times what its first interval shows of it.
const UNKNOWN: f64 = 1e4;
/// Largest prior standard deviation of a first state's coordinate, its own unit.
const LARGEST: f64 = 1.0;

impl Fitted {
    /// Intervals of all runs.
    pub fn intervals(&self) -> usize {
        self.tracks.iter().map(|t| t.intervals.len()).sum()
    }
}

impl<'a> Problem<'a> {
    /// Some runs of a scenario.
    pub fn new(stage: Stage<'a>, plant: &'a Plant, facts: &Facts, runs: Vec<usize>) -> Self {
        let forces = forces(facts);
        let mut channels: Vec<String> =
            stage.tapes.iter().flat_map(|t| t.readings.iter().map(|r| r.channel.clone())).collect();
        channels.sort();
        channels.dedup();
        let sampled = stage.tapes.iter().flat_map(|t| t.readings.iter().map(|r| r.times.len()));
        let knots = (sampled.min().unwrap_or(0) / SAMPLES).clamp(*KNOTS.start(), *KNOTS.end());
        let built = plant.build(&[]);
        let coarse = built.map_or_else(
            |_| coarse::as_judged(&stage),
            |built| coarse::of_model(&stage, (&built, &forces), (&runs, knots), &[]),
        );
        Self { stage, coarse, plant, runs, knots, forces, channels }
    }

    /// What a fit's runs are made linear about and by.
    pub fn frame<'f>(&'f self, of: &'f Fitted) -> Frame<'f> {
        self.frame_of(&of.built, &of.freedoms)
    }

    fn frame_of<'f>(&'f self, built: &'f Built, freedoms: &'f [Freedom]) -> Frame<'f> {
        Frame { stage: &self.stage, coarse: &self.coarse, built, freedoms, forces: &self.forces }
    }

    /// Coordinates of a model's states that show in some run.
    fn coordinates(&self, built: &Built, track: &Track) -> Vec<Freedom> {
        let interval = &track.intervals[track.intervals.len() / 2];
        let start = interval.start.fitted_to(built);
        let all = coordinates(built, &start);
        let readings = || self.stage.tapes.iter().flat_map(|t| &t.readings);
        shown(&self.frame_of(built, &all), readings, (track.run, &Interval { start, ..interval.clone() }))
    }

    /// Variances that are estimated.
    pub fn variances(&self) -> usize {
        self.forces.len() + self.channels.len()
    }

    /// Channel of every residual of every interval, run by run.
    pub fn channels_of(&self, tracks: &[Track]) -> Vec<Vec<Vec<u16>>> {
        let of_run = |track: &Track| {
            let tape = &self.stage.tapes[track.run];
            let number =
                |r: usize| self.channels.iter().position(|c| *c == tape.readings[r].channel).unwrap_or(0) as u16;
            let numbers: Vec<u16> = (0..tape.readings.len()).map(number).collect();
            let of_interval = |members: &Vec<u32>| {
                let reading = |m: &u32| tape.events[*m as usize].reading as usize;
                let of_event = |r: usize| std::iter::repeat_n(numbers[r], tape.readings[r].width());
                members.iter().map(reading).flat_map(of_event).collect::<Vec<u16>>()
            };
            track.intervals.iter().map(|i| of_interval(&i.members)).collect()
        };
        tracks.iter().map(of_run).collect()
    }

    /// The nominal model along all runs.
    pub fn begin(&self) -> Result<Fitted, DiagnoseError> {
        self.begin_with(&EffectSet::default())
    }

    /// A set along all runs, its numbers as they are.
    pub fn begin_with(&self, set: &EffectSet) -> Result<Fitted, DiagnoseError> {
        self.shorter(|knots| {
            let begun = self.refined(self.begun_in(knots, set)?, true)?;
            // What is fitted later goes on from here: what it gains must be its own.
            if holds(&begun.built) { self.settle(begun, CONVERGING, true) } else { Ok(begun) }
        })
    }

    /// What can be done with so many intervals of each run; with shorter ones where a replay leaves the range of numbers before its samples correct it.
    fn shorter<T>(&self, made: impl Fn(usize) -> Result<T, DiagnoseError>) -> Result<T, DiagnoseError> {
        if self.runs.is_empty() {
            return Err(self.lost());
        }
        let again = FINER.into_iter().map(|times| times * self.knots);
        again.fold(made(self.knots), |known, knots| known.or_else(|_| made(knots)))
    }

    /// The same with so many intervals of each run.
    fn begun_in(&self, knots: usize, set: &EffectSet) -> Result<Fitted, DiagnoseError> {
        let set = set.clone();
        let built = self.plant.build(&set.effects())?;
        let length = |run: usize| self.stage.tapes[run].span.1 - self.stage.tapes[run].span.0;
        let shortest = self.runs.iter().map(|r| length(*r)).fold(f64::INFINITY, f64::min);
        // Of runs of unlike length the longer ones have more intervals, not longer ones: how far a model is followed from a state is a time.
        let count = |run: usize| knots * ((length(run) / shortest) as usize).clamp(1, LONGER);
        let cut = |run: &usize| Track::cut((&self.stage, &self.coarse), (&built, self.forces.len()), *run, count(*run));
        let tracks: Vec<Track> = self.runs.par_iter().map(cut).collect::<Result<_, _>>()?;
        let freedoms = self.coordinates(&built, &tracks[0]);
        let frame = self.frame_of(&built, &freedoms);
        let typical = frame.link(tracks[0].run, &tracks[0].intervals[knots / 2]).ok_or_else(|| self.lost())?;
        let step = |w: &[super::track::Interval]| DVector::from_vec(w[1].start.difference(&w[0].start, &freedoms));
        let steps: Vec<DVector<f64>> = tracks.iter().flat_map(|t| t.intervals.windows(2).map(step)).collect();
        let force = first_spread(&freedoms, &self.forces, &steps, &typical.b);
        let spread = Spread { force, ..Spread::steady(self.forces.len(), self.channels.len().max(1)) };
        let shown = |k: usize| (UNKNOWN / typical.s.column(k).norm()).min(LARGEST);
        let first = |k: usize| freedoms[k].largest(&built).unwrap_or_else(|| shown(k));
        let first = DVector::from_iterator(freedoms.len(), (0..freedoms.len()).map(first));
        let mut none = Fitted {
            set,
            built,
            freedoms,
            tracks,
            links: Vec::new(),
            steady: Steady::default(),
            first,
            spread,
            score: f64::INFINITY,
            datum: 0.0,
            cost: f64::INFINITY,
            count: 0,
            covariance: DMatrix::zeros(0, 0),
            converged: false,
        };
        self.follow(&mut none)?;
        let begun = none.spread.force.clone();
        let settled = self.settle(none, SETTLING, false)?;
        if !holds(&settled.built) {
            return Ok(settled);
        }
        let settled = self.with_forces_again(settled, &begun);
        self.followed_again(settled)
    }

    /// The same fit on other samples of the same runs.
    pub fn onto(&self, of: &Fitted) -> Result<Fitted, DiagnoseError> {
        let mut tracks = of.tracks.clone();
        tracks.iter_mut().flat_map(|t| &mut t.intervals).for_each(|i| i.few = Arc::default());
        let tracks = tracks.iter().map(|t| t.onto((&self.stage, &self.coarse), &of.built)).collect::<Result<_, _>>()?;
        Ok(Fitted { tracks, links: Vec::new(), steady: Steady::default(), ..of.clone() })
    }

    /// Two sets along other runs than those that they were fitted to, their numbers as they are.
    pub fn along(&self, [one, other]: [&Fitted; 2]) -> Result<[Fitted; 2], DiagnoseError> {
        self.shorter(|knots| {
            let begun = self.begun_in(knots, &EffectSet::default())?;
            let along = |of: &Fitted| {
                let mut now = self.with(&begun, of.set.frozen())?;
                now.spread = Spread { local: Vec::new(), ..of.spread.clone() };
                self.follow(&mut now)?;
                self.settle(now, SETTLING, true)
            };
            Ok([along(one)?, along(other)?])
        })
    }

    /// A fit on the intervals of another one, its numbers as they are; that is what its score is compared by from there on.
    pub fn onto_intervals(&self, of: &Fitted, intervals: &Fitted) -> Result<Fitted, DiagnoseError> {
        let mut now = self.with(intervals, of.set.clone())?;
        now.spread = Spread { local: Vec::new(), ..of.spread.clone() };
        (now.links, now.datum) = (Vec::new(), of.datum);
        self.follow(&mut now)?;
        let now = self.settle(now, SETTLING, false)?;
        Ok(Fitted { datum: of.datum + now.score - of.score, score: of.score, ..now })
    }

    pub(crate) fn lost(&self) -> DiagnoseError {
        let file = self.runs.first().map_or_else(String::new, |r| self.stage.tapes[*r].file.clone());
        DiagnoseError::Replay {
            file,
            what: "an interval of it cannot be replayed from what its samples say".to_owned(),
        }
    }

    /// States and spread of a model as it stands.
    pub(super) fn settle(&self, mut now: Fitted, times: usize, reuse: bool) -> Result<Fitted, DiagnoseError> {
        for time in 0..times {
            // Through touches derivatives are another's at every look; states that have settled once are near.
            let made = if time > 0 && holds(&now.built) {
                let exact = self.read(&mut now)?;
                self.with_columns(&mut now, &exact, &[])?
            } else {
                self.linearise(&mut now, &[], reuse || time > 0)?
            };
            let steps = if time == 0 { STEPS[0] } else { STEPS[1] };
            let chains = made.chains(&[]);
            let found = estimate(&chains, None, &now.spread.without_local_noise(), steps);
            let before = now.score;
            (now.spread, now.score, now.cost, now.count) = (found.spread.clone(), found.score, found.cost, made.count);
            now.score += now.set.prior_cost() - now.datum;
            now.tracks = self.moved(&now, &chains, &found);
            if (before - now.score).abs() < CONVERGED {
                break;
            }
        }
        Ok(now)
    }

    /// A fit whose states follow each other: what the end of an interval exceeds the next one's state by is lost in the noise of that. Numbers converge
    /// before states do where a joint leaves its rest. As it was where a replay from there leaves the range of numbers.
    pub fn joined(&self, mut now: Fitted) -> Fitted {
        let mut known = now.tracks.clone();
        for time in 1..=JOININGS {
            // Derivatives that are known lead there, or to where they are taken anew.
            let Ok(made) = self.linearise(&mut now, &[], time < JOININGS) else {
                return Fitted { tracks: known, ..now };
            };
            if made.runs.iter().all(is_joined) {
                break;
            }
            let chains = made.chains(&[]);
            let found = estimate(&chains, None, &now.spread, STEPS[1]);
            let moved = self.moved(&now, &chains, &found);
            known = std::mem::replace(&mut now.tracks, moved);
        }
        now
    }

    /// A set fitted, from where another one stands; where something holds the runs are followed anew as long as that betters it.
    pub fn fit(&self, from: &Fitted, set: EffectSet, reach: Reach) -> Result<Fitted, DiagnoseError> {
        let once = self.with_forces_of(from, self.fit_once(from, set, reach)?, reach)?;
        self.fitted_again(once, reach)
    }

    /// The same once, from the states of another fit.
    pub(super) fn fit_once(&self, from: &Fitted, set: EffectSet, reach: Reach) -> Result<Fitted, DiagnoseError> {
        let mut now = self.with(from, self.possible(from, set)?)?;
        // To the end a fit begins by following the runs anew: what memory an effect has in them may have been found beside other numbers.
        if !reach.reuse || now.set.titles() != from.set.titles() {
            now = self.followed(from, now)?;
        }
        if !reach.reuse {
            now.steady = Steady::default();
        }
        let slots = now.set.slots();
        if slots.is_empty() {
            return self.settle(now, SETTLING, reach.reuse);
        }
        let mut sizes = first_sizes(&now.set);
        let mut way = Way::default();
        let mut promised = f64::INFINITY;
        for iteration in 0..reach.iterations {
            let steps = if iteration == 0 { STEPS[0] } else { STEPS[1] };
            let most = way.most();
            let here = self.here(&mut now, (&slots, &sizes), (reach.reuse || iteration > 0, steps), most);
            if let Some((last, ..)) = way.last.as_ref().filter(|_| here.is_err()) {
                // A look that has brought nearly all that it can is not worth a shorter step.
                let is_over = reach.reuse && promised < LITTLE * (from.score - last.score);
                let last = Fitted { converged: false, ..last.clone() };
                if way.shorter >= SHORTER || is_over {
                    return Ok(last);
                }
                let Some(next) = way.shorter(self) else { return Ok(last) };
                now = next;
                continue;
            }
            let (made, here, score) = here?;
            let chains = made.chains(&(0..slots.len()).collect::<Vec<_>>());
            let look =
                Look { slots: &slots, chains, ridge: ridge_of(&now.set, slots.len()), spread: here.spread.clone() };
            let found = estimate(&look.chains, Some(&look.ridge), &here.spread, STEPS[1]);
            (now.score, now.cost, now.count) = (score, here.cost, made.count);
            now.spread = here.spread.clone();
            now.covariance = found.covariance.clone();
            sizes = next_sizes(&now.set, &slots, &found.covariance);
            promised = score + now.datum - found.score;
            now.converged = promised < CONVERGED;
            if now.converged || iteration + 1 == reach.iterations {
                break;
            }
            let look = Look { spread: found.spread.clone(), ..look };
            // At the edge of what a body can be there is no way on.
            let step = way.next(&look, &found);
            let Ok(next) = self.stepped(&now, &look, step) else {
                return Ok(way.likelier(Fitted { converged: false, ..now }));
            };
            way.last = Some((std::mem::replace(&mut now, next), look, found));
        }
        Ok(way.likelier(now))
    }

    /// A set made linear where it stands, with the spread that is likeliest there, and its score; an error where that is more than a bound, before any
    /// column is taken.
    fn here(
        &self,
        now: &mut Fitted,
        (slots, sizes): (&[(usize, usize)], &[f64]),
        (reuse, steps): (bool, usize),
        most: f64,
    ) -> Result<(Made, Estimate, f64), DiagnoseError> {
        let exact = self.exact(now, reuse)?;
        let made = self.with_columns(now, &exact, &[])?;
        // Which intervals are not followed is another question each time.
        let here = estimate(&made.chains(&[]), None, &now.spread.without_local_noise(), steps);
        let score = here.score + now.set.prior_cost() - now.datum;
        if most.is_finite() && (score.is_nan() || score > most) {
            return Err(self.lost());
        }
        let variations = vary(self.plant, &now.set, slots, sizes)?;
        Ok((self.with_columns(now, &exact, &variations)?, here, score))
    }

    /// A set, or the largest share of the way to it from another one, or from what changes nothing, that is a model: a linear step knows nothing of what a
    /// body can be.
    pub(super) fn possible(&self, from: &Fitted, set: EffectSet) -> Result<EffectSet, DiagnoseError> {
        let Err(error) = self.plant.build(&set.effects()) else { return Ok(set) };
        let shares = (1..=HALVINGS).map(|k| NEARER.powi(k));
        let mut nearer = shares.map(|share| set.a_share_of_the_way(&from.set, share));
        nearer.find(|near| self.plant.build(&near.effects()).is_ok()).ok_or(error)
    }

    /// A share of the way from one fit to another one of the same set.
    pub(super) fn between(&self, a: &Fitted, b: &Fitted, share: f64) -> Result<Fitted, DiagnoseError> {
        let slots = a.set.slots();
        let by: Vec<f64> =
            slots.iter().map(|(m, k)| share * (b.set.members[*m].1[*k] - a.set.members[*m].1[*k])).collect();
        let set = a.set.moved(&slots, &by);
        let half = self.with(b, set)?;
        let frame = self.frame(&half);
        let tracks = a.tracks.iter().zip(&b.tracks).map(|(a, b)| frame.between(a, b, share)).collect();
        Ok(Fitted { tracks, spread: a.spread.clone(), ..half })
    }

    /// Another set at the states of a fit.
    pub(super) fn with(&self, from: &Fitted, set: EffectSet) -> Result<Fitted, DiagnoseError> {
        let built = self.plant.build(&set.effects())?;
        let freedoms = self.coordinates(&built, &from.tracks[0]);
        let is_same = freedoms == from.freedoms;
        let first = |f: &Freedom| {
            let known = || from.freedoms.iter().position(|g| g == f).map(|k| from.first[k]);
            f.largest(&built).or_else(known).unwrap_or(LARGEST)
        };
        let first = DVector::from_iterator(freedoms.len(), freedoms.iter().map(first));
        let mut now = Fitted { set, built, freedoms, first, ..from.clone() };
        if !is_same {
            (now.links, now.steady) = (Vec::new(), Steady::default());
        }
        now.tracks = {
            let frame = self.frame(&now);
            from.tracks.par_iter().map(|t| frame.carried(t, &from.built)).collect()
        };
        // A sensor that is later than was thought tells of an earlier interval.
        let told: Vec<Track> = now
            .tracks
            .iter()
            .map(|t| t.onto((&self.stage, &self.coarse), &now.built))
            .collect::<Result<_, DiagnoseError>>()?;
        let is_told_alike = |(a, b): (&Track, &Track)| {
            a.intervals.iter().zip(&b.intervals).all(|(a, b)| a.members.len() == b.members.len())
        };
        if !told.iter().zip(&now.tracks).all(is_told_alike) {
            (now.tracks, now.links, now.steady) = (told, Vec::new(), Steady::default());
        }
        Ok(now)
    }

    /// Everything linear about the states of a fit, with a column for each variation.
    pub fn linearise(&self, now: &mut Fitted, variations: &[Variation], reuse: bool) -> Result<Made, DiagnoseError> {
        let exact = self.exact(now, reuse)?;
        self.with_columns(now, &exact, variations)
    }

    /// What a fit reads where it stands, its derivatives by states and forces taken anew where these are not to be reused.
    fn exact(&self, now: &mut Fitted, reuse: bool) -> Result<Exact, DiagnoseError> {
        let exact = self.read(now)?;
        let frame = self.frame(now);
        let is_known = reuse && now.links.len() == now.tracks.len();
        if is_known && now.built.model.is_smooth() {
            return Ok(exact);
        }
        let links = |(k, track): (usize, &Track)| match now.links.get(k) {
            Some(known) if is_known => frame.links_where_changed(track, known),
            _ => frame.links(track).map(Arc::new),
        };
        let links: Option<Vec<Arc<Vec<Link>>>> = now.tracks.par_iter().enumerate().map(links).collect();
        now.links = links.ok_or_else(|| self.lost())?;
        Ok(exact)
    }

    /// What a fit reads where it stands, with what holds handed on.
    fn read(&self, now: &mut Fitted) -> Result<Exact, DiagnoseError> {
        let mut tracks = std::mem::take(&mut now.tracks);
        let exact: Option<Exact> = tracks.par_iter_mut().map(|t| self.frame(now).hand_on(t)).collect();
        now.tracks = tracks;
        exact.ok_or_else(|| self.lost())
    }

    /// The same with a column for each variation.
    fn with_columns(&self, now: &mut Fitted, exact: &Exact, variations: &[Variation]) -> Result<Made, DiagnoseError> {
        let frame = self.frame(now);
        let all = now.tracks.par_iter().zip(exact);
        let bases: Option<Vec<Bases<'_>>> = all.map(|(t, exact)| frame.bases(t, exact, variations)).collect();
        let bases = bases.ok_or_else(|| self.lost())?;
        let links = now.links.clone();
        let steady = self.steady(now, &bases, variations);
        let channels = self.channels_of(&now.tracks);
        let count = channels.iter().flatten().map(Vec::len).sum();
        let price = price_of_factor(count, channels.iter().map(Vec::len).sum::<usize>() * self.channels.len());
        let linear = |(k, channels): (usize, Vec<Vec<u16>>)| {
            let known = steady.runs.get(k).into_iter().flat_map(|s| s.iter());
            let mut known = known.map(|column| Source::Known(column));
            let sources: Vec<Source<'_>> = variations
                .iter()
                .filter_map(|v| if v.is_tolerated { known.next() } else { Some(Source::Taken(v)) })
                .collect();
            let sides = frame.sides(&now.tracks[k], &links[k], &bases[k], &sources);
            Linear { run: k, price, links: Arc::clone(&links[k]), sides, channels, start: now.first.clone() }
        };
        let runs: Vec<Linear> = channels.into_par_iter().enumerate().map(linear).collect();
        now.steady = steady;
        Ok(Made { runs, count })
    }

    /// Columns of the numbers that have a tolerance: known ones, as long as the numbers stand next to where they were taken. What is only usually off, where
    /// the scenario declares nothing, is off by little, and there are many of them.
    fn steady(&self, now: &Fitted, bases: &[Bases<'_>], variations: &[Variation]) -> Steady {
        let taken: Vec<&Variation> = variations.iter().filter(|v| v.is_tolerated).collect();
        let at = now.set.within_tolerances();
        let is_whole = |(own, track): (&Arc<Columns>, &Track)| {
            own.len() == taken.len() && own.iter().all(|c| c.len() == track.intervals.len())
        };
        let known = &now.steady;
        let is_known = known.runs.len() == now.tracks.len() && known.runs.iter().zip(&now.tracks).all(is_whole);
        let is_near = at.len() == known.at.len() && at.iter().zip(&known.at).all(|(a, b)| (a - b).abs() < MOVED);
        if taken.is_empty() || is_known && (is_near || self.plant.scenario.tolerance.is_exact()) {
            return known.clone();
        }
        let frame = self.frame(now);
        let columns = |(t, b): (&Track, &Bases<'_>)| {
            Arc::new(taken.par_iter().map(|v| frame.columns(t, b, v)).collect::<Columns>())
        };
        Steady { runs: now.tracks.par_iter().zip(bases).map(columns).collect(), at }
    }

    /// The runs of a fit with their states where the smoother has them.
    pub(super) fn moved(&self, now: &Fitted, chains: &[Chain], found: &Estimate) -> Vec<Track> {
        let frame = self.frame(now);
        let of = |(track, chain): (&Track, &Chain)| frame.moved(track, &chain.smoothed(&found.spread, &found.theta));
        now.tracks.par_iter().zip(chains).map(of).collect()
    }
}

/// Whether what the ends of intervals exceed the next ones' states by is lost in the noise.
fn is_joined(run: &Linear) -> bool {
    let step = |(side, next): (&Side, &Link)| (&next.s * side.d.column(side.d.ncols() - 1)).amax() < JOINED;
    run.sides.iter().zip(&run.links[1..]).all(step)
}

/// All runs made linear.
pub struct Made {
    /// Run by run.
    pub runs: Vec<Linear>,
    /// Residuals.
    pub count: usize,
}

impl Made {
    /// Products of the columns of some numbers, run by run.
    pub fn chains(&self, columns: &[usize]) -> Vec<Chain> {
        self.runs.iter().map(|r| r.chain(columns)).collect()
    }
}

/// Products of the priors of a set's numbers about where these stand.
pub fn ridge_of(set: &EffectSet, numbers: usize) -> DMatrix<f64> {
    let mut ridge = DMatrix::zeros(numbers + 1, numbers + 1);
    set.add_prior(&mut ridge);
    ridge
}

//! A search along whole runs, and what the rest of a diagnosis asks of it.

use crate::attempt::Attempt;
use crate::catalogue;
use crate::diagnosis::Rival;
use crate::effect_set::EffectSet;
use crate::error::DiagnoseError;
use crate::excerpts;
use crate::facts::Facts;
use crate::fit::Fit;
use crate::hypothesis::Hypothesis;
use crate::identify::fit::{Fitted, Problem, Reach};
use crate::linear::{Segment, Stage, Steps};
use crate::lost;
use crate::nothing;
use crate::pace::{self, Discretisation};
use crate::plant::Plant;
use crate::replay::Span;
use crate::select::pool::price;
use crate::select::search::{
    Found, NEXT_TO_NOTHING, Remainder, criterion, hypotheses_of, names, remainder, search, to_the_end,
};
use crate::ties::near_the_best;
use record::Role;
use scenario::spec::Tolerance;
use std::cmp::Ordering;
use std::sync::Arc;

/// What a search along whole runs has found.
pub(crate) struct Course {
    /// The nominal model and the best set along the runs that are fitted.
    pub found: Found,
    /// What each of them leaves beyond noise.
    pub left: [Remainder; 2],
}

/// What nominal numbers may be off by where a scenario does not say it: weighed and drawn, not identified.
pub(crate) const USUAL: Tolerance = Tolerance { mass: 0.01, com_m: 2e-3, inertia: 0.01, ..Tolerance::EXACT };

/// Iterations of a last fit, to all samples.
const LAST: Reach = Reach { iterations: 4, reuse: false };
/// Iterations with the nominal numbers free within their tolerances.
const WITHIN: Reach = Reach { iterations: 6, reuse: true };

/// Searches along the runs that may be fitted, from the likeliest there of some sets that were found otherwise, or from none.
pub(crate) fn seek(
    stage: &Stage<'_>,
    plant: &Plant,
    (own, known): (&Facts, &[EffectSet]),
) -> Result<Course, DiagnoseError> {
    let problem = Problem { runs: spokesmen(stage, plant)?, ..problem(stage, plant, own, Role::Fit) };
    let mut nominal = problem.begin()?;
    let left = remainder(&problem, &nominal)?;
    stage.work.watch.step(&format!("the nominal model leaves {:.1}, noise at most {:.1}", left.rise, left.bound));
    let within = catalogue::within(&Facts::new(&nominal.built, stage.tapes), &plant.scenario.tolerance);
    if !within.members.is_empty() && !left.is_noise() {
        nominal = to_the_end(&problem, problem.fit(&nominal, within, WITHIN)?);
        stage.work.watch.step(&format!("numbers within their tolerances: −2 log L {:.1}", nominal.score));
    }
    let hypotheses = |now: &Fitted| hypotheses_of(&problem, now, own);
    let usual = || catalogue::within(&Facts::new(&nominal.built, stage.tapes), &USUAL);
    let numbers = plant.scenario.tolerance.is_exact().then(usual);
    let begun = known.iter().map(|set| beginning(&problem, &nominal, set)).reduce(likelier).transpose()?;
    // What they took is not taken from what may be found.
    if begun.is_some() {
        stage.work.begin_to_count();
    }
    let (mut found, searched) = search(&problem, (nominal, begun), &hypotheses, numbers)?;
    let heard = problem.clone().heard_by(&found.best.set)?;
    if let Some(best) = heard.reheard(&searched, &found.best)? {
        found.best = to_the_end(&heard, best);
    }
    let after = remainder(&heard, &found.best)?;
    stage.work.watch.step(&format!("what was found leaves {:.1}, noise at most {:.1}", after.rise, after.bound));
    Ok(Course { found, left: [left, after] })
}

/// What was found otherwise along the runs: from states of its own, fitted to its end.
fn beginning(problem: &Problem<'_>, nominal: &Fitted, known: &EffectSet) -> Result<Fitted, DiagnoseError> {
    let own = problem.begin_with(known)?;
    let begun = to_the_end(problem, problem.fit(&own, known.clone(), WITHIN)?);
    let [before, after] = [nominal.score, begun.score];
    problem.stage.work.watch.step(&format!("with {}: −2 log L {before:.1} → {after:.1}", names(known)));
    Ok(begun)
}

/// The likelier of two beginnings; one alone where the other leads nowhere.
fn likelier(one: Result<Fitted, DiagnoseError>, other: Result<Fitted, DiagnoseError>) -> Result<Fitted, DiagnoseError> {
    match (one, other) {
        (Ok(one), Ok(other)) => Ok(if other.score.total_cmp(&one.score).is_lt() { other } else { one }),
        (Ok(alone), Err(_)) | (Err(_), Ok(alone)) => Ok(alone),
        (error, Err(_)) => error,
    }
}

/// The runs that are searched along: of many an even selection, by how many steps of a body they take.
fn spokesmen(stage: &Stage<'_>, plant: &Plant) -> Result<Vec<usize>, DiagnoseError> {
    let all: Vec<usize> = (0..stage.tapes.len()).filter(|r| stage.tapes[*r].role == Role::Fit).collect();
    let built = plant.build(&[])?;
    let bodies = built.model.owners.len() as f64;
    // Stops of joints are passed now and then; touches may last.
    let step = if pace::touches(&built) { stage.pace.step } else { stage.pace.free };
    let steps = |run: &usize| (stage.tapes[*run].span.1 - stage.tapes[*run].span.0) / step;
    let share = SEARCHED / (bodies * all.iter().map(steps).sum::<f64>());
    let count = ((share * all.len() as f64) as usize).max(FEWEST);
    let chosen: Vec<usize> = excerpts::evenly(all.len(), count).into_iter().map(|i| all[i]).collect();
    if chosen.len() < all.len() {
        stage.work.watch.step(&format!("{} of {} runs are searched along", chosen.len(), all.len()));
    }
    Ok(chosen)
}

/// Steps of a body that are searched along, and runs at least: all three of an arm of seven joints are, over 12 s each.
const SEARCHED: f64 = 1.5e5;
const FEWEST: usize = 2;

/// What was found along some runs fitted to all of them.
pub(crate) fn told_by_all_runs(
    stage: &Stage<'_>,
    plant: &Plant,
    own: &Facts,
    course: Course,
) -> Result<Course, DiagnoseError> {
    let problem = problem(stage, plant, own, Role::Fit);
    if course.found.best.tracks.len() == problem.runs.len() {
        return Ok(course);
    }
    let problem = problem.heard_by(&course.found.best.set)?;
    let [nominal, along] = problem.along([&course.found.nominal, &course.found.best])?;
    let set = course.found.best.set.clone();
    let best = if set.members.is_empty() { along } else { problem.fit(&along, set, ALL_RUNS)? };
    let left = [remainder(&problem, &nominal)?, remainder(&problem, &best)?];
    Ok(Course { found: Found { nominal, best, ..course.found }, left })
}

/// Iterations of a fit to all runs: numbers are near.
const ALL_RUNS: Reach = Reach { iterations: 3, reuse: true };

/// Iterations of a fit without a finding: the others are near.
const WITHOUT: Reach = Reach { iterations: 4, reuse: false };

/// What was found along whole runs without what is not worth its price there any more.
pub(crate) fn without_nothings(
    stage: &Stage<'_>,
    plant: &Plant,
    own: &Facts,
    course: Course,
) -> Result<Course, DiagnoseError> {
    let many = catalogue::hypotheses(own).len();
    let weak = |of: &Fitted| nothing::weak(&of.set, &of.covariance, 1.0, |h| price(h, of.count, many));
    let known = &course.found.best;
    if weak(known).is_empty() {
        return Ok(course);
    }
    let problem = &problem(stage, plant, own, Role::Fit).heard_by(&known.set)?;
    let less = |of: &Fitted, member: usize| {
        let Ok(less) = problem.fit(of, of.set.without(member), WITHOUT) else { return Ok(None) };
        let costs = criterion(&less, many) - criterion(of, many);
        Ok(nothing::is_better_by(costs, &of.set.members[member].0, stage.work.watch).then_some(less))
    };
    let best = nothing::without(known.clone(), weak, less)?;
    if best.set.members.len() == known.set.members.len() {
        return Ok(course);
    }
    let after = remainder(problem, &best)?;
    let is_empty = best.set.members.is_empty();
    // What states have come to beside what is none is the nominal model's as well.
    let nominal = if is_empty { best.clone() } else { course.found.nominal.clone() };
    let left = if is_empty { [after; 2] } else { [course.left[0], after] };
    let criteria = if is_empty { [criterion(&best, many); 2] } else { course.found.criteria };
    Ok(Course { found: Found { nominal, best, criteria, ..course.found }, left })
}

/// The runs of a role along which something is sought.
pub(crate) fn problem<'a>(stage: &Stage<'a>, plant: &'a Plant, own: &Facts, role: Role) -> Problem<'a> {
    let runs = (0..stage.tapes.len()).filter(|r| stage.tapes[*r].role == role).collect();
    Problem::new(*stage, plant, own, runs)
}

/// The same at steps that suit what was found: it may be faster than what the nominal model has, and what steps lose is taken for its numbers.
pub(crate) fn at_suiting_steps(
    stage: &Stage<'_>,
    plant: &Plant,
    own: &Facts,
    (course, window): (Course, f64),
    chosen: Discretisation,
) -> Result<(Course, Discretisation), DiagnoseError> {
    let best = &course.found.best;
    let windows = windows_of(&problem(stage, plant, own, Role::Fit), best, window);
    let judged = as_fit(stage, best, windows);
    // What rough steps lose is in it: a run that is followed may owe them all that is left.
    if best.set.members.is_empty() || judged.rms() >= lost::NEAR {
        return Ok((course, chosen));
    }
    let found = pace::suited(stage, &judged);
    if found.pace == stage.pace {
        return Ok((course, found));
    }
    let finer = Stage { pace: found.pace, ..*stage };
    let problem =
        Problem { runs: best.tracks.iter().map(|t| t.run).collect(), ..problem(&finer, plant, own, Role::Fit) };
    let problem = problem.heard_by(&best.set)?;
    let best = problem.fit(&problem.onto(best)?, best.set.clone(), LAST)?;
    let left = [course.left[0], remainder(&problem, &best)?];
    Ok((Course { found: Found { best, ..course.found }, left }, found))
}

/// The last fit, to all samples.
pub(crate) fn fit_to_all(
    (thin, all): (&Stage<'_>, &Stage<'_>),
    plant: &Plant,
    own: &Facts,
    course: Course,
) -> Result<Course, DiagnoseError> {
    let scalars = |stage: &Stage<'_>| stage.tapes.iter().map(|t| t.offsets[t.offsets.len() - 1]).sum::<usize>();
    let best = &course.found.best;
    if best.set.members.is_empty() || scalars(all) <= scalars(thin) || scalars(all) > MOST {
        return Ok(course);
    }
    // Where forces are left they are what limits the numbers, not how many samples there are.
    let problem = problem(all, plant, own, Role::Fit);
    if problem.power(best) > NEXT_TO_NOTHING * problem.power(&course.found.nominal) {
        return Ok(course);
    }
    let problem = problem.heard_by(&best.set)?;
    let best = problem.fit(&problem.onto(best)?, best.set.clone(), LAST)?;
    let left = [course.left[0], remainder(&problem, &best)?];
    Ok(Course { found: Found { best, ..course.found }, left })
}

/// Scalars beyond which an even selection of them has to do.
const MOST: usize = 2_000_000;

/// Windows of all runs with the states that each of two sets has there; those of runs that were left out follow its numbers as they are.
pub(crate) fn windows(
    stage: &Stage<'_>,
    plant: &Plant,
    (own, window): (&Facts, f64),
    fitted: [&Fitted; 2],
) -> Result<[Fit; 2], DiagnoseError> {
    let left_out = problem(stage, plant, own, Role::Holdout).heard_by(&fitted[1].set)?;
    let joined = |fit: Fitted| if fit.set.members.is_empty() { fit } else { left_out.joined(fit) };
    let mut all = fitted.map(|fit| vec![joined(fit.clone())]);
    if !left_out.runs.is_empty() {
        all.iter_mut().zip(left_out.along(fitted)?).for_each(|(own, fit)| own.push(joined(fit)));
    }
    let [one, other] = all.map(|own| own.iter().flat_map(|f| windows_of(&left_out, f, window)).collect());
    Ok([as_fit(stage, fitted[0], one), as_fit(stage, fitted[1], other)])
}

/// Windows of the runs of a fit, whether these are a problem's own or others.
pub(crate) fn windows_of(problem: &Problem<'_>, fitted: &Fitted, window: f64) -> Vec<Segment> {
    let frame = problem.frame(fitted);
    let of_run = |track: &crate::identify::track::Track| {
        let spans = crate::linear::windows(&problem.stage.tapes[track.run], Some(window));
        let segment = |span: Span| {
            let start = frame.state_at(track, span.from)?;
            let guess = Arc::new(start.clone());
            let steps = Steps::default();
            Some(Segment { run: track.run, span, start, guess, weight: 1.0, columns: None, steps })
        };
        spans.into_iter().filter_map(segment).collect::<Vec<_>>()
    };
    fitted.tracks.iter().flat_map(of_run).collect()
}

/// A fit of segments as the report asks for it.
pub(crate) fn as_fit(stage: &Stage<'_>, fitted: &Fitted, segments: Vec<Segment>) -> Fit {
    let (count, noise) = stage.noise(&segments);
    Fit {
        cost: stage.cost(&fitted.built, &segments),
        count,
        noise,
        freedom: fitted.set.slots().len() + segments.len() * fitted.freedoms.len(),
        set: fitted.set.clone(),
        built: fitted.built.clone(),
        segments,
        covariance: fitted.covariance.clone(),
        converged: fitted.converged,
        iterations: 0,
        doubt: stage.doubt,
    }
}

/// What stands for a finding in other sets that are near the best one by the criterion: title of the finding, and its rival. A set that has all of the
/// best one's findings and more stands for none of them. Where a richer law of the same kind has a finding's place that is in the set as well.
pub(crate) fn rivals(course: &Course) -> Vec<(String, Rival)> {
    let Found { best, criteria: [nominal, own], tried, equals, .. } = &course.found;
    let best = &best.set;
    let left = course.left[1];
    let near = near_the_best(nominal - own, if left.is_noise() { 0.0 } else { left.rise });
    let has_all = |set: &EffectSet| best.findings().all(|(h, _)| set.has_finding(h));
    let all = tried.iter().map(|t| (&t.set, t.criteria[1])).chain(equals.iter().map(|(set, c)| (set, *c)));
    let mut found: Vec<(String, Rival)> = Vec::new();
    for (other, criterion) in all.filter(|(set, criterion)| !has_all(set) && (criterion - own).abs() < near) {
        let is_richer = |(r, x): &(Hypothesis, Vec<f64>), h: &Hypothesis| {
            r.place == h.place && r.plainer(x).iter().any(|plain| plain.name == h.name)
        };
        let has = |h: &Hypothesis| other.has_finding(h) || other.findings().any(|m| is_richer(m, h));
        for (h, _) in best.findings().filter(|(h, _)| !has(h)) {
            for (r, _) in other.findings().filter(|(r, _)| !best.has_finding(r)) {
                let score_gap = criterion - own;
                let rival = Rival { name: r.name.to_owned(), place: r.place.clone(), score_gap };
                match found
                    .iter_mut()
                    .find(|(of, k)| *of == h.title() && (&k.name, &k.place) == (&rival.name, &rival.place))
                {
                    Some((_, known)) => known.score_gap = known.score_gap.min(score_gap),
                    None => found.push((h.title(), rival)),
                }
            }
        }
    }
    found.sort_by(|a, b| a.1.score_gap.total_cmp(&b.1.score_gap));
    found
}

/// What was tried, for the report.
pub(crate) fn attempts(course: &Course) -> Vec<Attempt> {
    let all = course.found.left.max(1.0);
    let mut attempts: Vec<Attempt> = Vec::new();
    for (h, score) in &course.found.shown {
        if !attempts.iter().any(|a| a.name == h.name && a.place == h.place) {
            attempts.push(Attempt {
                round: 0,
                name: h.name.to_owned(),
                place: h.place.clone(),
                score: score.score,
                share: (score.score / all).clamp(0.0, 1.0),
                fall: None,
                parameters: score.rank,
                gain: None,
                together: None,
                kept: false,
                found: score.start.clone(),
                set: EffectSet::default(),
                shown: score.shown.clone(),
            });
        }
    }
    let best = &course.found.best.set;
    for tried in &course.found.tried {
        let [fall, gain] = [tried.scores, tried.criteria].map(|s| s[0] - s[1]);
        for (h, x) in tried.set.findings().filter(|(h, _)| tried.added.contains(&h.title())) {
            let is_kept = best.findings().any(|(b, _)| b.title() == h.title());
            let is_whole = tried.added.iter().all(|t| best.findings().any(|(b, _)| b.title() == *t));
            let at = attempts.iter().position(|a| a.round == tried.round && a.title() == h.title());
            let known = at.map(|i| attempts.remove(i));
            let is_of_use = |k: &Attempt| k.kept || !(is_kept && is_whole);
            let is_better = |k: &Attempt| is_of_use(k) && k.gain.is_some_and(|g| g >= gain || k.kept && g > 0.0);
            if known.as_ref().is_some_and(is_better) {
                attempts.extend(known);
                continue;
            }
            let shown = known.map_or_else(|| crate::screen::Shown { errors: Vec::new(), condition: 1.0 }, |k| k.shown);
            attempts.push(Attempt {
                round: tried.round,
                name: h.name.to_owned(),
                place: h.place.clone(),
                score: tried.promised,
                share: tried.taken.clamp(0.0, 1.0),
                fall: Some(fall),
                parameters: h.coordinates.len() - h.held.len(),
                gain: Some(gain),
                together: (tried.added.len() > 1 && is_kept && is_whole).then_some(gain),
                kept: is_kept && is_whole,
                found: x.clone(),
                set: EffectSet::default(),
                shown,
            });
        }
    }
    keep_what_is_left_of_sets(&mut attempts, course);
    keep_what_was_taken(&mut attempts);
    attempts
}

/// What an earlier round had tried of a kept effect was not taken then.
fn keep_what_was_taken(attempts: &mut Vec<Attempt>) {
    let taken: Vec<(String, usize)> = attempts.iter().filter(|a| a.kept).map(|a| (a.title(), a.round)).collect();
    attempts.retain(|a| !taken.iter().any(|(title, round)| *title == a.title() && *round > a.round));
}

/// What was fitted beside others that were of no use is kept, and what these brought was its own.
fn keep_what_is_left_of_sets(attempts: &mut [Attempt], course: &Course) {
    let best = course.found.best.set.titles();
    for title in &best {
        if attempts.iter().any(|a| a.kept && a.title() == *title) {
            continue;
        }
        let own = attempts.iter_mut().filter(|a| a.title() == *title && a.gain.is_some());
        let Some(own) = own.max_by(|a, b| a.gain.partial_cmp(&b.gain).unwrap_or(Ordering::Equal)) else { continue };
        own.kept = true;
        let (round, gain) = (own.round, own.gain);
        let sets = course.found.tried.iter().filter(|t| t.round == round && t.added.contains(title));
        let beside: Vec<&String> = sets.flat_map(|t| &t.added).filter(|t| !best.contains(t)).collect();
        let idle = attempts.iter_mut().filter(|a| a.round == round && a.gain == gain && beside.contains(&&a.title()));
        idle.for_each(|a| (a.gain, a.fall) = (None, None));
    }
}

//! From findings to the diagnosis and its evidence.

use crate::accuracy::errors;
use crate::along::USUAL;
use crate::attempt::Attempt;
use crate::condition::{self, Features, find_features};
use crate::diagnosis::{Diagnosis, FORMAT, Found, Located as LocatedPlace, Remainder, Rival, Role, StdErr, Verdict};
use crate::effect_set::EffectSet;
use crate::evidence::{
    self, Evidence, Heat, HeatRow, Hypothesis, Identifiable, Level, Parameter, Remark, Status, bin_edges, mean_squares,
};
use crate::hypothesis::Hypothesis as Member;
use crate::linear::{Segment, Stage};
use crate::run::Findings;
use crate::share;
use crate::ties::near;
use crate::vocabulary::unit;
use nalgebra::DMatrix;
use record::inspect::Inspection;
use scenario::Scenario;
use scenario::spec::Tolerance;
use std::collections::BTreeMap;
use std::path::Path;

/// Both of them.
pub(crate) fn tell(
    findings: &Findings,
    stage: &Stage<'_>,
    inspection: &Inspection,
    scenario: &Scenario,
    folder: &Path,
) -> (Diagnosis, Evidence) {
    let found =
        if findings.verdict == Verdict::Unknown { Vec::new() } else { effects(findings, |h| !h.is_tolerated()) };
    let features = find_features(stage, &findings.nominal);
    let recording = folder.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let diagnosis = Diagnosis {
        format: FORMAT,
        scenario: scenario.name.clone(),
        recording,
        verdict: findings.verdict,
        located: located(findings, stage, &features),
        effects: found,
        within_tolerance: effects(findings, Member::is_tolerated),
        error: errors(findings, stage),
        explained_share: (findings.verdict.is_found() && findings.found.set.has_findings())
            .then(|| findings.explained.clone()),
        remainder: remainder(findings, stage, &features),
        remarks: record::inspect::said_once(&inspection.remarks)
            .into_iter()
            .filter(|(r, _)| r.severity > record::Severity::Note)
            .map(|(r, more)| r.sentence() + &more)
            .chain(findings.said.iter().cloned())
            .chain(said_of_tolerances(findings, &scenario.tolerance))
            .chain(lost_runs(findings, stage))
            .chain(only_where_left_out(findings, stage))
            .collect(),
    };
    let evidence = Evidence {
        title: findings.title.clone(),
        quality: record::inspect::said_once(&inspection.remarks).into_iter().map(quality).collect(),
        discretisation: Some(discretisation(findings)),
        heat: heat(findings, stage),
        curves: crate::curves::curves(findings, stage),
        forces: crate::curves::forces(findings, stage),
        scatters: crate::curves::scatters(findings, &features),
        identifiability: identifiability(findings),
        detection: crate::detect::detection(stage, &findings.judgement.windowed[0]),
        whiteness: crate::detect::whiteness(findings, stage),
        ranking: ranking(findings),
        parameters: parameters(findings),
        correlation: correlation(&findings.uncertainty.covariance),
        timings: findings.timings.clone(),
    };
    (diagnosis, evidence)
}

/// What the effects leave, where something is detected in it.
fn remainder(findings: &Findings, stage: &Stage<'_>, features: &Features) -> Option<Remainder> {
    let left = findings.left.as_ref().filter(|_| findings.verdict == Verdict::PartlyExplained)?;
    let corrected = &findings.judgement.windowed[1];
    crate::detect::detection(stage, corrected).filter(|d| d.value > d.bound)?;
    let (from_s, to_s) = condition::when(stage, &corrected.fit);
    let place = |p: usize| {
        let name = left.places[p].name.clone();
        let depends = condition::dependence(features, &findings.nominal, left, &name);
        let condition =
            depends.map_or_else(|| condition_of(&name).to_owned(), |on| format!("{}; {on}", condition_of(&name)));
        LocatedPlace { place: name, share: left.share(p), from_s, to_s, condition }
    };
    let mut ranked = left.ranked();
    ranked.retain(|p| left.share(*p).is_finite() && left.share(*p) > 0.0);
    let error = findings.judgement.rms(true, |_| true)[1];
    Some(Remainder { error, located: ranked.into_iter().take(PLACES).map(place).collect() })
}

/// Places of a remainder that are told.
const PLACES: usize = 3;

/// That runs left out of the fit are off where those that were fitted are not.
fn only_where_left_out(findings: &Findings, stage: &Stage<'_>) -> Option<String> {
    let off = |role: record::Role| findings.judgement.rms_of(stage.tapes, true, role).map(|[_, after]| after);
    let is_found = findings.verdict.is_found() || findings.found.set.has_findings();
    let (fit, left_out) = (off(record::Role::Fit)?, off(record::Role::Holdout)?);
    let is_new = !is_found && fit <= share::LEFT && left_out > share::LEFT;
    is_new.then(|| {
        format!(
            "What differs shows in runs left out of the fit alone, by {left_out:.3} times the noise in windows: the others are predicted as well as noise \
             allows, so that nothing was sought. Give one of those runs role = \"fit\" to have it sought there."
        )
    })
}

/// Runs that the corrected model follows up to an instant only.
fn lost_runs(findings: &Findings, stage: &Stage<'_>) -> Vec<String> {
    let of = |segment: &Segment| {
        let tape = &stage.tapes[segment.run];
        let (file, until) = (&tape.file, segment.span.to);
        let is_cut = findings.follows && until < tape.span.1 && findings.found.set.has_findings();
        is_cut.then(|| {
            format!(
                "{file} is followed up to {until:.4} s only, as the other runs are to their ends: something else \
                 happens there, and what comes later was not used for the fit."
            )
        })
    };
    findings.found.segments.iter().filter_map(of).collect()
}

fn discretisation(findings: &Findings) -> evidence::Discretisation {
    let found = findings.discretisation;
    evidence::Discretisation { step_s: found.pace.step, window_s: findings.window, error: found.worst, bound: 0.1 }
}

fn quality((remark, more): (&record::Remark, String)) -> Remark {
    let level = match remark.severity {
        record::Severity::Note => Level::Note,
        record::Severity::Warning => Level::Warning,
        record::Severity::Fault => Level::Serious,
    };
    let subject = remark.channel.clone().or_else(|| remark.run.clone()).unwrap_or_default();
    Remark { level, subject, text: remark.what.clone() + &more }
}

/// Covariance of one member's coordinates; those that were held have none.
fn covariance_of(findings: &Findings, member: usize) -> DMatrix<f64> {
    let (fit, covariance) = (&findings.found, &findings.uncertainty.covariance);
    let slots = fit.set.slots();
    let n = fit.set.members[member].0.coordinates.len();
    let at = |k: usize| slots.iter().position(|s| *s == (member, k));
    DMatrix::from_fn(n, n, |i, j| match (at(i), at(j)) {
        (Some(i), Some(j)) => covariance.get((i, j)).copied().unwrap_or(0.0),
        _ => 0.0,
    })
}

/// How many they are, and which has moved most.
fn said_of_tolerances(findings: &Findings, tolerance: &Tolerance) -> Option<String> {
    let members: Vec<_> = findings.found.set.members.iter().filter(|(h, _)| h.is_tolerated()).collect();
    let moved = |(h, x): &&(Member, Vec<f64>)| {
        let of = |k: usize| (x[k] - h.coordinates[k].neutral).abs() / h.tolerance[k];
        (0..x.len()).filter(|k| h.tolerance[*k] > 0.0).map(of).fold(0.0, f64::max)
    };
    let most = members.iter().copied().max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
    let given = match tolerance.is_exact() {
        true => format!(
            "what is usual, for the scenario gives no [tolerance] (masses and inertias {} %, centres {} mm)",
            100.0 * USUAL.mass,
            1000.0 * USUAL.com_m
        ),
        false => "the tolerances of the scenario".to_owned(),
    };
    Some(format!(
        "{} nominal numbers or vectors were free within {given}; {} has moved most, by {:.1} standard deviations.",
        members.len(),
        most.0.title(),
        moved(&most)
    ))
}

/// Some members of the set, as they are told.
fn effects(findings: &Findings, wanted: impl Fn(&Member) -> bool) -> Vec<Found> {
    let fit = &findings.found;
    let of = |(m, (h, x)): (usize, &(Member, Vec<f64>))| {
        let effect = h.effect(x);
        let held = |key: &str| fit.set.held.iter().any(|(n, k)| *n == m && h.coordinates[*k].key == key);
        let mut std_err: BTreeMap<String, StdErr> = BTreeMap::new();
        for (key, error) in h.errors(x, &covariance_of(findings, m)) {
            let value = if held(key) || error <= 0.0 { f64::INFINITY } else { error };
            match key.split_once('[') {
                None => {
                    std_err.insert(key.to_owned(), StdErr::one(value));
                }
                Some((name, _)) => {
                    let slot = std_err.entry(name.to_owned()).or_insert_with(|| StdErr::each(&[]));
                    if let StdErr::Each(values) = slot {
                        values.push(value.is_finite().then_some(value));
                    }
                }
            }
        }
        let slides = slides(&fit.built, &effect.place);
        let of_this = findings.rivals.iter().filter(|(title, _)| *title == h.title());
        let rivals = of_this.map(|(_, rival)| rival.clone()).collect();
        Found { name: effect.name, place: effect.place, params: effect.params, std_err, slides, rivals }
    };
    fit.set.members.iter().enumerate().filter(|(_, (h, _))| wanted(h)).map(of).collect()
}

/// Whether a place is a joint that slides.
fn slides(built: &crate::plant::Built, place: &str) -> bool {
    let Some(name) = place.strip_prefix("joint:") else { return false };
    let name = name.rsplit('/').next().unwrap_or(name);
    let mut joints = built.model.vehicles.iter().flat_map(|v| &v.tree.joints);
    joints.any(|j| j.name == name && j.kind == multibody::JointKind::Prismatic)
}

/// Hypotheses whose refit came near the chosen one's in the round in which it was chosen, by the title of that; near that of the whole set where
/// several were chosen together. `left`: what the set leaves beyond noise.
pub(crate) fn rivals_by_round(attempts: &[Attempt], set: &EffectSet, left: f64) -> Vec<(String, Rival)> {
    let of = |chosen: &Member| -> Vec<(String, Rival)> {
        let is_chosen = |a: &Attempt| a.kept && a.name == chosen.name && a.place == chosen.place;
        let Some(own) = attempts.iter().find(|a| is_chosen(a)) else { return Vec::new() };
        let Some(gain) = own.together.or(own.gain) else { return Vec::new() };
        let is_found = |a: &Attempt| set.findings().any(|(h, _)| h.title() == a.title());
        let near = near(attempts, (own.round, gain), left).filter(|(a, _)| !is_found(a));
        near.map(|(a, score_gap)| (chosen.title(), Rival { name: a.name.clone(), place: a.place.clone(), score_gap }))
            .collect()
    };
    set.findings().flat_map(|(h, _)| of(h)).collect()
}

fn located(findings: &Findings, stage: &Stage<'_>, features: &Features) -> Vec<LocatedPlace> {
    let (from_s, to_s) = condition::when(stage, &findings.nominal);
    let place = |name: String, share: f64, condition: &str| {
        let is_unknown = findings.verdict == Verdict::Unknown;
        let depends = is_unknown.then(|| condition::dependence(features, &findings.nominal, &findings.located, &name));
        let depends = depends.flatten();
        let condition = depends.map_or_else(|| condition.to_owned(), |on| format!("{condition}; {on}"));
        LocatedPlace { place: name, share, from_s, to_s, condition }
    };
    let by_force = || {
        let all = &findings.located;
        let order = all.ranked();
        let most = order.first().map_or(0.0, |p| all.share(*p));
        // A free force on a body fits what a contact or a joint does to it as well: of places that do alike, the one with fewer freedoms comes first.
        let (mut alike, others): (Vec<usize>, Vec<usize>) = order.iter().partition(|p| all.share(**p) > most - TIE);
        alike.sort_by_key(|p| all.rank(*p));
        let places = alike.into_iter().chain(others).take(TOLD);
        let places: Vec<(String, f64)> = places.map(|p| (all.places[p].name.clone(), all.share(p))).collect();
        places
    };
    match findings.verdict {
        Verdict::NoMismatch => Vec::new(),
        Verdict::Unknown => by_force().into_iter().map(|(n, s)| place(n.clone(), s, condition_of(&n))).collect(),
        _ => {
            // Two effects at one place are one place; a law that took another's place at the end stands for that.
            let members: Vec<_> = findings.found.set.findings().collect();
            let is_member = |place: &str| members.iter().any(|(h, _)| h.place == place);
            let kept = || findings.attempts.iter().filter(|a| a.kept);
            let most =
                |places: &dyn Fn(&str) -> bool| kept().filter(|a| places(&a.place)).map(|a| a.share).reduce(f64::max);
            let mut shares: Vec<(String, f64)> = Vec::new();
            // A nominal model that is far from what the runs did is no measure of what was taken from it: what was explained by the one place sits there.
            let alone = (findings.explained.share > 0.0).then_some(findings.explained.share);
            let alone = alone.filter(|_| members.iter().all(|(h, _)| h.place == members[0].0.place));
            for (h, _) in &members {
                let own = most(&|place| place == h.place).or_else(|| most(&|place| !is_member(place)));
                let own = own.filter(|share| *share > NONE).or(alone);
                if !shares.iter().any(|s| s.0 == h.place) {
                    shares.push((h.place.clone(), own.unwrap_or(1.0)));
                }
            }
            shares.into_iter().map(|(p, share)| place(p.clone(), share.clamp(0.0, 1.0), condition_of(&p))).collect()
        }
    }
}

/// Share of the mismatch that is as good as none.
const NONE: f64 = 0.005;
/// Difference of shares that does not tell places apart.
const TIE: f64 = 0.03;
/// Places of what has no name that are told.
const TOLD: usize = 4;

fn condition_of(place: &str) -> &'static str {
    if place.starts_with("contact:") { "in contact" } else { "always" }
}

pub(crate) fn role(role: record::Role) -> Role {
    match role {
        record::Role::Fit => Role::Fit,
        record::Role::Holdout => Role::Holdout,
    }
}

/// What the first screen's information matrices say, the most promising first.
fn identifiability(findings: &Findings) -> Vec<Identifiable> {
    let first = findings.attempts.iter().filter(|a| a.round == 0);
    let of = |a: &Attempt| {
        let remark = match a.shown.condition {
            _ if a.shown.errors.iter().all(|e| e.1.is_infinite()) => "these recordings cannot show it",
            condition if condition > RIDGE => "only combinations of its parameters show",
            _ => "",
        };
        let one = |(parameter, std_err): &(String, f64)| Identifiable {
            effect: a.name.clone(),
            place: a.place.clone(),
            unit: unit(
                &a.name,
                parameter.split('[').next().unwrap_or(parameter),
                slides(&findings.nominal.built, &a.place),
            )
            .to_owned(),
            parameter: parameter.clone(),
            std_err: *std_err,
            condition: a.shown.condition,
            remark: remark.to_owned(),
        };
        a.shown.errors.iter().map(one).collect::<Vec<_>>()
    };
    first.flat_map(of).collect()
}

/// Fall of the cost by the whole set over the runs that were fitted, in windows where these judge.
fn fall_of(findings: &Findings) -> f64 {
    let [before, after] = findings.judgement.costs(!findings.follows, |run| findings.found.has_run(run));
    before - after
}

fn nan_unless_finite(x: f64) -> f64 {
    if x.is_finite() { x } else { f64::NAN }
}

/// Condition of a scaled information matrix beyond which single parameters say little.
const RIDGE: f64 = 1e4;

fn ranking(findings: &Findings) -> Vec<Hypothesis> {
    let near: Vec<&Rival> = findings.rivals.iter().map(|(_, rival)| rival).collect();
    let is_rival = |a: &Attempt| near.iter().any(|r| r.name == a.name && r.place == a.place);
    let held_back = nan_unless_finite(fall_of(findings) - findings.uncertainty.optimism);
    let nan = |x: Option<f64>| x.map_or(f64::NAN, nan_unless_finite);
    let of = |a: &Attempt| Hypothesis {
        name: a.name.clone(),
        place: a.place.clone(),
        screen_score: a.score,
        freedoms: a.parameters,
        share: a.share,
        refit_fall: nan(a.fall),
        bic_gain: nan(a.gain),
        held_back_gain: if a.kept { held_back } else { f64::NAN },
        status: match (a.kept, a.fall) {
            (true, _) => Status::Chosen,
            (false, Some(_)) if is_rival(a) => Status::Rival,
            (false, Some(_)) => Status::Rejected,
            (false, None) => Status::Screened,
        },
        why: format!("round {}", a.round + 1),
    };
    let worth = |a: &&Attempt| a.fall.is_some() || a.share > 0.01;
    let mut all: Vec<Hypothesis> = findings.attempts.iter().filter(worth).map(of).collect();
    all.sort_by_key(|h| h.status);
    all
}

fn parameters(findings: &Findings) -> Vec<Parameter> {
    let fit = &findings.found;
    let mut all = Vec::new();
    for (m, (h, x)) in fit.set.members.iter().enumerate().filter(|(_, (h, _))| !h.is_tolerated()) {
        let nominal = h.decode(&h.neutral());
        let slots = fit.set.slots().into_iter().zip(&findings.uncertainty.from_profile);
        let is_profiled = slots.filter(|(slot, _)| slot.0 == m).any(|(_, is_profiled)| *is_profiled);
        let errors = h.errors(x, &covariance_of(findings, m));
        for (((key, value), (_, error)), (_, before)) in h.decode(x).into_iter().zip(errors).zip(nominal) {
            let std_err = if error > 0.0 { error } else { f64::INFINITY };
            all.push(Parameter {
                effect: h.name.to_owned(),
                place: h.place.clone(),
                name: key.to_owned(),
                unit: unit(h.name, key.split('[').next().unwrap_or(key), slides(&fit.built, &h.place)).to_owned(),
                value,
                nominal: before,
                std_err,
                interval: (value - 1.96 * std_err, value + 1.96 * std_err),
                from_profile: is_profiled,
            });
        }
    }
    all
}

fn correlation(covariance: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let n = covariance.nrows();
    let of = |i: usize, j: usize| covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt().max(1e-300);
    (0..n).map(|i| (0..n).map(|j| of(i, j)).collect()).collect()
}

/// Bins of a heat strip.
const BINS: usize = 60;

fn heat(findings: &Findings, stage: &Stage<'_>) -> Vec<Heat> {
    let (windowed, tapes) = (&findings.judgement.windowed, stage.tapes);
    let strip = |run: usize| {
        let tape = &tapes[run];
        let edges = bin_edges(tape.span.0, tape.span.1, BINS);
        let samples = windowed.each_ref().map(|p| p.scalars(tape));
        let row = |(k, reading): (usize, &crate::reading::Reading)| {
            let of = |m: usize| {
                mean_squares(samples[m].iter().filter(|s| s.reading == k).map(|s| (s.time, s.residual)), &edges)
            };
            HeatRow { channel: reading.channel.clone(), nominal: of(0), corrected: of(1) }
        };
        Heat {
            run: tape.file.clone(),
            role: role(tape.role),
            window_s: Some(findings.window),
            rows: tape.readings.iter().enumerate().map(row).collect(),
            edges_s: edges,
        }
    };
    (0..tapes.len()).map(strip).collect()
}

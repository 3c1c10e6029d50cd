//! Curves of the evidence: channels that matter, and the missing force over time.

use crate::condition::{Features, find_dependence};
use crate::evidence::{Curve, MissingForce, Scatter, ScatterPoint};
use crate::judge::Scalar;
use crate::linear::Stage;
use crate::locate::Located;
use crate::reading::Value;
use crate::run::Findings;
use crate::tape::Tape;
use crate::tell::role;
use record::{ChannelName, Role};
use scenario::measure::Quantity;
use sim::Model;

/// Most channels drawn.
const CHANNELS: usize = 6;

/// The channels of one run that differ most, measured and predicted in windows.
pub(crate) fn curves(findings: &Findings, stage: &Stage<'_>) -> Vec<Curve> {
    let Some(run) = stage.tapes.iter().position(|t| t.role == Role::Holdout).or((!stage.tapes.is_empty()).then_some(0))
    else {
        return Vec::new();
    };
    let tape = &stage.tapes[run];
    let [nominal, corrected] = findings.judgement.windowed.each_ref().map(|p| {
        let drawn = p.scalars(tape).into_iter().filter_map(|s| measured(tape, &s).map(|m| (s, m)));
        drawn.collect::<Vec<(Scalar, f64)>>()
    });
    let mut channels: Vec<((usize, usize), f64)> = Vec::new();
    for (scalar, _) in &nominal {
        let own = (scalar.reading, scalar.component);
        match channels.iter_mut().find(|c| c.0 == own) {
            Some(channel) => channel.1 += scalar.residual.powi(2),
            None => channels.push((own, scalar.residual.powi(2))),
        }
    }
    channels.sort_by(|a, b| b.1.total_cmp(&a.1));
    let curve = |(r, k): (usize, usize)| {
        let reading = &tape.readings[r];
        let of = |all: &[(Scalar, f64)], f: &dyn Fn(&(Scalar, f64)) -> f64| -> Vec<f64> {
            all.iter().filter(|(s, _)| (s.reading, s.component) == (r, k)).map(f).collect()
        };
        let predicted = |(s, measured): &(Scalar, f64)| measured + s.residual * reading.sigma;
        let channel = reading.component(k);
        Curve {
            run: tape.file.clone(),
            role: role(tape.role),
            unit: unit_of_channel(&findings.nominal.built.model, reading.quantity, &channel).to_owned(),
            channel,
            sigma: reading.sigma,
            window_s: Some(findings.window),
            t: of(&nominal, &|s| s.0.time),
            measured: of(&nominal, &|s| s.1),
            nominal: of(&nominal, &predicted),
            corrected: if findings.found.set.members.is_empty() { Vec::new() } else { of(&corrected, &predicted) },
        }
    };
    channels.into_iter().take(CHANNELS).map(|(c, _)| curve(c)).collect()
}

/// Unit of a channel; of a joint's that of its kind, for the name of a channel does not tell whether it turns or slides.
pub(crate) fn unit_of_channel(model: &Model, quantity: Quantity, channel: &str) -> &'static str {
    let unit = ChannelName::parse(channel).map_or("", |name| name.quantity.unit());
    let Some((turning, sliding)) = unit.split_once('|') else { return unit };
    let (Quantity::JointPosition(v)
    | Quantity::JointVelocity(v)
    | Quantity::JointLinkPosition(v)
    | Quantity::JointLinkVelocity(v)) = quantity
    else {
        return unit;
    };
    if model.slides(v) { sliding } else { turning }
}

/// What was measured; orientations have no curve.
fn measured(tape: &Tape, scalar: &Scalar) -> Option<f64> {
    let reading = &tape.readings[scalar.reading];
    match reading.values[scalar.sample] {
        Value::Vector(v) => Some(v[reading.axes[scalar.component]]),
        Value::Rotation(_) => None,
    }
}

/// Most places drawn.
const PLACES: usize = 2;
/// Share of the mismatch below which a place is not drawn.
const SMALL: f64 = 0.01;
/// Share of a force's variance that a quantity must explain for a drawing against it.
const EXPLAINS: f64 = 0.3;

/// Missing forces that are drawn: place and which of its numbers, where anything that was measured shows it.
pub(crate) fn drawn(located: &Located) -> Vec<(usize, usize)> {
    let places = located.ranked().into_iter().filter(|p| located.share(*p) > SMALL).take(PLACES);
    let steady = |p: usize| {
        let columns = located.places[p].columns.iter().enumerate();
        let is_wave = |label: &str| label.ends_with("sine");
        columns.filter(move |(_, c)| !is_wave(&c.0)).map(move |(c, _)| (p, c))
    };
    places.flat_map(steady).filter(|(p, c)| located.windows.iter().any(|w| w[*p].error[*c] > 0.0)).collect()
}

/// What a place's number acts on, by its label; empty where the place has only one.
fn freedom_of(label: &str) -> &str {
    label.trim_end_matches("constant").trim()
}

/// Unit of a place's number, by its label.
fn unit_of(place: &str, label: &str) -> &'static str {
    match label {
        "level" => "",
        "bristle" | "stiffness" => "N/m",
        "viscous" => "N s/m",
        "damping" => "s/m",
        _ if label.starts_with("force") => "N",
        _ if place.starts_with("joint:") || label.starts_with("torque") => "N m",
        _ => "",
    }
}

/// The missing force of the places where most of it acts: its mean over each window of the first run that was fitted; with the law that was
/// found, as the same estimate sees it.
pub(crate) fn forces(findings: &Findings, stage: &Stage<'_>) -> Vec<MissingForce> {
    let (located, segments) = (&findings.located, &findings.nominal.segments);
    let Some(run) = segments.first().map(|s| s.run) else { return Vec::new() };
    let windows: Vec<usize> = (0..segments.len()).filter(|i| segments[*i].run == run).collect();
    let force = |(p, c): (usize, usize)| {
        let place = &located.places[p];
        let label = place.columns[c].0.as_str();
        let of = |f: &dyn Fn(usize) -> f64| -> Vec<f64> { windows.iter().map(|i| f(*i)).collect() };
        let law = findings.left.as_ref().map(|left| (law_name(findings), of(&|i| law(located, left, i, (p, c)))));
        MissingForce {
            place: place.name.clone(),
            freedom: freedom_of(label).to_owned(),
            unit: unit_of(&place.name, label).to_owned(),
            run: stage.tapes[run].file.clone(),
            t: of(&|i| 0.5 * (segments[i].span.from + segments[i].span.to)),
            estimate: of(&|i| located.windows[i][p].estimate[c]),
            std_err: of(&|i| located.windows[i][p].error[c]),
            law,
        }
    };
    drawn(located).into_iter().map(force).collect()
}

/// The law's own part of a missing force: what is missing from the nominal model less what is missing from the corrected one.
fn law(located: &Located, left: &Located, window: usize, (place, column): (usize, usize)) -> f64 {
    let after = left.windows.get(window).and_then(|w| w.get(place)).and_then(|w| w.estimate.get(column));
    after.map_or(f64::NAN, |after| located.windows[window][place].estimate[column] - after)
}

fn law_name(findings: &Findings) -> String {
    findings.found.set.findings().map(|(h, _)| h.name).collect::<Vec<_>>().join(" and ")
}

/// The missing forces against the quantities that explain most of them.
pub(crate) fn scatters(findings: &Findings, features: &Features) -> Vec<Scatter> {
    let located = &findings.located;
    let against = |(p, c): (usize, usize)| {
        let found = find_dependence(features, &findings.nominal, located, (p, c))?;
        if found.share < EXPLAINS {
            return None;
        }
        let (place, label) = (&located.places[p], located.places[p].columns[c].0.as_str());
        let windows: Vec<usize> =
            (0..located.windows.len()).filter(|i| located.windows[*i][p].error[c] > 0.0).collect();
        let point = |i: &usize| {
            let window = &located.windows[*i][p];
            ScatterPoint { x: found.values[*i], y: window.estimate[c], std_err: window.error[c] }
        };
        let law = findings.left.as_ref().map(|left| {
            let mut along: Vec<(f64, f64)> =
                windows.iter().map(|i| (found.values[*i], law(located, left, *i, (p, c)))).collect();
            along.sort_by(|a, b| a.0.total_cmp(&b.0));
            (law_name(findings), along)
        });
        let what = freedom_of(label);
        let unit = unit_of(&place.name, label);
        Some(Scatter {
            place: place.name.clone(),
            across: found.name.clone(),
            up: format!("missing {}{}", if what.is_empty() { "torque" } else { what }, in_unit(unit)),
            points: windows.iter().map(point).collect(),
            law,
            r_squared: found.share,
        })
    };
    drawn(located).into_iter().filter_map(against).collect()
}

fn in_unit(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(", {unit}") }
}

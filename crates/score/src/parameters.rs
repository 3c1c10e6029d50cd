//! Whether parameters are right: within 10 % or two standard errors, in the combinations that data can show.
//!
//! | parameter | compared as |
//! | --- | --- |
//! | inertia of a free body without known torques (its Ixx was held at the nominal value), torques, dampings, slosh on it | the key's values times (Ixx found / Ixx of the key); a modal coupling times its root |
//! | slosh `mass`, `position` | m ‖p‖² |
//! | `friction-anisotropy` | angle modulo π; mu_1 and mu_2 exchanged with the angle turned by π/2 |
//! | levels that fall with speed | each, or the whole curve within 10 % of (breakaway − sliding) from v_s/10 to 10 v_s |
//! | a modal coupling | up to its sign |
//! | amplitude and phase | phase modulo 2π; amplitude of the other sign with the phase turned by π |
//! | an angle that has no natural zero (phase, axis of anisotropy) | within 0.1 rad or two standard errors |
//! | a vector | entry by entry; an entry that is zero in the key within 10 % of the vector's norm or two standard errors |

use crate::{Key, KeyEffect};
use diagnose::diagnosis::{Found, ParamValue, StdErr};
use record::page::number::short;
use scenario::effects::{self, BODY_INERTIA, Parameter, Shown};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Allowed deviation, as a fraction.
const FRACTION: f64 = 0.1;
/// Allowed deviation in standard errors.
const DEVIATIONS: f64 = 2.0;
/// Allowed deviation of an angle without a natural zero, rad.
const ANGLE: f64 = 0.1;

/// One parameter beside the key.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Name of the effect in the key.
    pub effect: String,
    /// The parameter, or the combination of them that is judged.
    pub parameter: String,
    /// What the key says, brought to the same scale.
    pub key: Vec<f64>,
    /// What was found.
    pub found: Vec<f64>,
    /// Standard errors; `null` where none is given.
    pub std_err: Vec<Option<f64>>,
    /// Whether it is right.
    pub right: bool,
}

impl Judged {
    /// `angular-damping: c 0.014 ± 0.0003 instead of 0.012`.
    pub fn sentence(&self) -> String {
        let list = |values: &[f64]| values.iter().map(|v| short(*v)).collect::<Vec<_>>().join(", ");
        let errors: Vec<f64> = self.std_err.iter().flatten().copied().collect();
        let errors = if errors.is_empty() { String::new() } else { format!(" ± {}", list(&errors)) };
        let (found, key) = (list(&self.found), list(&self.key));
        let found = if found.is_empty() { "not given".to_owned() } else { found };
        format!("{}: {} {found}{errors} instead of {key}", self.effect, self.parameter)
    }
}

/// The scale of a free body without known torques: Ixx found over Ixx of the key, where Ixx was held and not fitted; else 1.
pub(super) fn gauge(key: &Key, all: &[Found]) -> f64 {
    let inertia = key.effects.iter().find(|e| e.name == BODY_INERTIA.name);
    let found = all.iter().find(|e| e.name == BODY_INERTIA.name);
    let (Some(inertia), Some(found)) = (inertia, found) else { return 1.0 };
    let ixx = |params: &ParamValue| params.numbers().and_then(|n| n.first().copied()).filter(|x| *x > 0.0);
    let is_held = errors(found, "inertia").first().copied().flatten().is_none_or(|e| e == 0.0);
    let pair = (found.params.get("inertia").and_then(ixx), inertia.params.get("inertia").and_then(ixx));
    match pair {
        (Some(found), Some(key)) if is_held => found / key,
        _ => 1.0,
    }
}

/// The definition of an effect's parameter.
fn definition(effect: &str, parameter: &str) -> Option<&'static Parameter> {
    effects::find(effect)?.parameter(parameter)
}

/// Which of an effect's parameters data can show: each, of one that has no definition.
fn shown(effect: &str) -> Shown {
    effects::find(effect).map_or(Shown::Each, |def| def.shown)
}

/// Judges the parameters of one effect.
pub(super) fn judge(key: &KeyEffect, found: &Found, gauge: f64) -> Vec<Judged> {
    let mut judged = if key.name == found.name { same(key, found, gauge) } else { stand_in(key, found) };
    judged.extend(frames(key, found));
    judged
}

/// The parameters of the key's effect itself.
fn same(key: &KeyEffect, found: &Found, gauge: f64) -> Vec<Judged> {
    let each = || key.params.iter().filter_map(|(name, value)| generic(key, found, (name, value), gauge)).collect();
    match shown(&key.name) {
        Shown::Each | Shown::UpToSign { .. } => each(),
        Shown::SecondMoment { mass, place } => second_moment(key, found, gauge, [mass, place]),
        Shown::Ellipse { along, across, angle } => ellipse(key, found, [along, across, angle]),
        Shown::FallingLevel { sliding, rest, speed } => levels(key, found, [sliding, rest, speed]),
        Shown::Wave { amplitude, phase } => wave(key, found, [amplitude, phase]),
    }
}

/// A parameter compared as it stands; `None` where it needs no comparison.
fn generic(key: &KeyEffect, found: &Found, (name, value): (&str, &ParamValue), gauge: f64) -> Option<Judged> {
    let definition = definition(&key.name, name);
    let scale = gauge.powf(definition.map_or(0.0, |parameter| parameter.inertia_power));
    let truth: Vec<f64> = value.numbers()?.iter().map(|v| v * scale).collect();
    let given = match found.params.get(name) {
        Some(value) => value.numbers().unwrap_or_default().to_vec(),
        None if definition.is_some_and(|parameter| parameter.is_kept) => return None,
        None => vec![0.0; truth.len()],
    };
    let flipped: Vec<f64> = given.iter().map(|v| -v).collect();
    let errors = errors(found, name);
    let may_flip = matches!(shown(&key.name), Shown::UpToSign { vector } if vector == name);
    let right = agree(&truth, &given, &errors) || (may_flip && agree(&truth, &flipped, &errors));
    Some(Judged { right, ..judged(key, name, truth, given, errors) })
}

/// Entry by entry.
fn agree(truth: &[f64], given: &[f64], errors: &[Option<f64>]) -> bool {
    let norm = truth.iter().map(|v| v * v).sum::<f64>().sqrt();
    let entry = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
    !given.is_empty()
        && (0..truth.len().max(given.len())).all(|i| {
            let (truth, given) = (entry(truth, i), entry(given, i));
            let size = if truth == 0.0 { norm } else { truth.abs() };
            let error = errors.get(i).copied().flatten().unwrap_or(0.0);
            near(given - truth, size, error)
        })
}

/// Whether a deviation is small beside the quantity's size or its standard error.
fn near(deviation: f64, size: f64, std_err: f64) -> bool {
    deviation.abs() <= (FRACTION * size).max(DEVIATIONS * std_err)
}

fn judged(key: &KeyEffect, parameter: &str, truth: Vec<f64>, found: Vec<f64>, std_err: Vec<Option<f64>>) -> Judged {
    Judged { effect: key.name.clone(), parameter: parameter.to_owned(), key: truth, found, std_err, right: false }
}

fn errors(found: &Found, name: &str) -> Vec<Option<f64>> {
    found.std_err.get(name).map(StdErr::entries).unwrap_or_default().to_vec()
}

fn number_of(params: &BTreeMap<String, ParamValue>, name: &str) -> f64 {
    params.get(name).and_then(ParamValue::number).unwrap_or(f64::NAN)
}

/// An effect that counts for the key's: its one number against the key's one number; more cannot be compared.
fn stand_in(key: &KeyEffect, found: &Found) -> Vec<Judged> {
    let only = |params: &BTreeMap<String, ParamValue>| match params.iter().next() {
        Some((name, ParamValue::Number(value))) if params.len() == 1 => Some((name.clone(), *value)),
        _ => None,
    };
    let (Some((name, truth)), Some((other, given))) = (only(&key.params), only(&found.params)) else {
        let uncompared = judged(key, &format!("(stands for it: {})", found.name), vec![], vec![], vec![]);
        return vec![Judged { right: true, ..uncompared }];
    };
    let errors = errors(found, &other);
    let right = agree(&[truth], &[given], &errors);
    vec![Judged {
        right,
        ..judged(key, &format!("{name} (as {other} of {})", found.name), vec![truth], vec![given], errors)
    }]
}

/// Frames and other words must be the key's; where none is given the default is meant.
fn frames(key: &KeyEffect, found: &Found) -> Vec<Judged> {
    let differs = |(name, value): (&String, &ParamValue)| match (value, found.params.get(name)) {
        (ParamValue::Text(truth), Some(ParamValue::Text(given))) if truth != given => {
            Some(judged(key, &format!("{name} \"{given}\" instead of \"{truth}\""), vec![], vec![], vec![]))
        }
        _ => None,
    };
    key.params.iter().filter_map(differs).collect()
}

/// m ‖p‖², and the rest as it stands.
fn second_moment(key: &KeyEffect, found: &Found, gauge: f64, [mass, place]: [&str; 2]) -> Vec<Judged> {
    let product = |params: &BTreeMap<String, ParamValue>| {
        let position = params.get(place).and_then(ParamValue::numbers).unwrap_or_default();
        number_of(params, mass) * position.iter().map(|p| p * p).sum::<f64>()
    };
    let (truth, given) = (gauge * product(&key.params), product(&found.params));
    let right = near(given - truth, truth.abs(), 0.0);
    let rest = key.params.iter().filter(|(name, _)| name.as_str() != mass && name.as_str() != place);
    let combined = format!("{mass} ‖{place}‖²");
    let mut all = vec![Judged { right, ..judged(key, &combined, vec![truth], vec![given], vec![]) }];
    all.extend(rest.filter_map(|(name, value)| generic(key, found, (name, value), gauge)));
    all
}

/// The distance of two angles modulo a period.
fn turn(from: f64, to: f64, period: f64) -> f64 {
    (to - from + 0.5 * period).rem_euclid(period) - 0.5 * period
}

fn angle_is_near(deviation: f64, std_err: Option<f64>) -> bool {
    deviation.abs() <= ANGLE.max(DEVIATIONS * std_err.unwrap_or(0.0))
}

fn first_error(found: &Found, name: &str) -> Option<f64> {
    errors(found, name).first().copied().flatten()
}

/// Whichever way of naming the axes is nearer.
fn ellipse(key: &KeyEffect, found: &Found, names: [&str; 3]) -> Vec<Judged> {
    let [mu_1, mu_2, angle] = names.map(|name| number_of(&found.params, name));
    let [e_1, e_2, e_angle] = names.map(|name| first_error(found, name));
    let truth = names.map(|name| number_of(&key.params, name));
    let off = |angle: f64| turn(truth[2], angle, PI);
    let is_exchanged = off(angle + FRAC_PI_2).abs() < off(angle).abs();
    let (levels, level_errors, off) = match is_exchanged {
        true => ([mu_2, mu_1], [e_2, e_1], off(angle + FRAC_PI_2)),
        false => ([mu_1, mu_2], [e_1, e_2], off(angle)),
    };
    let mut all: Vec<Judged> = (0..2)
        .map(|i| {
            let right = near(levels[i] - truth[i], truth[i].abs(), level_errors[i].unwrap_or(0.0));
            Judged { right, ..judged(key, names[i], vec![truth[i]], vec![levels[i]], vec![level_errors[i]]) }
        })
        .collect();
    let right = angle_is_near(off, e_angle);
    all.push(Judged { right, ..judged(key, names[2], vec![truth[2]], vec![truth[2] + off], vec![e_angle]) });
    all
}

/// A level that falls with speed from `rest` to `sliding`: each number, or the curve.
fn levels(key: &KeyEffect, found: &Found, [sliding, rest, speed]: [&str; 3]) -> Vec<Judged> {
    let pairs = key.params.iter().filter_map(|(name, value)| generic(key, found, (name, value), 1.0));
    let mut all: Vec<Judged> = pairs.collect();
    if all.iter().all(|j| j.right) {
        return all;
    }
    let level = |params: &BTreeMap<String, ParamValue>, v: f64| {
        let [c, s, v_s] = [sliding, rest, speed].map(|name| number_of(params, name));
        c + (s - c) * (-(v / v_s).powi(2)).exp()
    };
    let v_s = number_of(&key.params, speed);
    let rise = number_of(&key.params, rest) - number_of(&key.params, sliding);
    let speeds = (0..=40).map(|k| v_s * 10_f64.powf(-1.0 + f64::from(k) / 20.0));
    let square = speeds.map(|v| (level(&found.params, v) - level(&key.params, v)).powi(2)).sum::<f64>() / 41.0;
    if square.sqrt() <= FRACTION * rise.abs() {
        all.iter_mut().for_each(|j| j.right = true);
    }
    all
}

/// Amplitude and phase together, the rest as it stands.
fn wave(key: &KeyEffect, found: &Found, [amplitude, phase]: [&str; 2]) -> Vec<Judged> {
    let rest = key.params.iter().filter(|(name, _)| name.as_str() != amplitude && name.as_str() != phase);
    let mut all: Vec<Judged> = rest.filter_map(|(name, value)| generic(key, found, (name, value), 1.0)).collect();
    let list = |params: &BTreeMap<String, ParamValue>| {
        params.get(amplitude).and_then(ParamValue::numbers).unwrap_or_default().to_vec()
    };
    let (truth, given) = (list(&key.params), list(&found.params));
    let is_opposite = truth.iter().zip(&given).map(|(a, b)| a * b).sum::<f64>() < 0.0;
    let (sign, shift) = if is_opposite { (-1.0, PI) } else { (1.0, 0.0) };
    let given: Vec<f64> = given.iter().map(|a| sign * a).collect();
    let amplitude_errors = errors(found, amplitude);
    let right = agree(&truth, &given, &amplitude_errors);
    all.push(Judged { right, ..judged(key, amplitude, truth, given, amplitude_errors) });
    if let Some(truth) = key.params.get(phase).and_then(ParamValue::number) {
        let off = turn(truth, number_of(&found.params, phase) + shift, TAU);
        let error = first_error(found, phase);
        let right = angle_is_near(off, error);
        all.push(Judged { right, ..judged(key, phase, vec![truth], vec![truth + off], vec![error]) });
    }
    all
}

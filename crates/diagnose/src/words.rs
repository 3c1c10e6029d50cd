//! The verdict in one paragraph of plain words, from the data.

use crate::diagnosis::{
    ChannelError, Diagnosis, Explained, Found, Judged, Located, ParamValue, Rival, StdErr, Verdict,
};
use crate::evidence::Evidence;
use crate::number::{digits, noise, percent, with_error};
use crate::vocabulary::{plain_name, unit};

/// A gap of the information criterion below which the data do not decide between two explanations.
pub const UNDECIDED: f64 = 10.0;
/// Part of the recording's length that an onset may be late, or an end early, and still be called the whole of it.
const WHOLE: f64 = 0.03;

/// What came out, in one or two words.
pub fn headline(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::NoMismatch => "No mismatch",
        Verdict::Explained => "Explained",
        Verdict::PartlyExplained => "Partly explained",
        Verdict::Unknown => "Unknown physics",
    }
}

/// The verdict in one paragraph: whether there is a mismatch, where and when, what it is, how sure, and what it improves.
pub fn paragraph(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let mut said = vec![opening(diagnosis)];
    if diagnosis.verdict != Verdict::NoMismatch {
        said.extend(whereabouts(diagnosis, evidence));
    }
    said.extend(explanation(diagnosis));
    said.extend(improvement(diagnosis));
    said.extend(doubts(diagnosis));
    said.join(" ")
}

fn opening(diagnosis: &Diagnosis) -> String {
    let (scenario, recording) = (&diagnosis.scenario, &diagnosis.recording);
    let judged = diagnosis.judged();
    let (before, whose) = (noise(judged.error.before), whose_words(&judged));
    if diagnosis.verdict == Verdict::NoMismatch {
        let numbers = if diagnosis.is_corrected() { ", its numbers corrected within their tolerances," } else { "" };
        let error = match diagnosis.is_corrected() {
            true => format!(
                "{} times the noise (1 is perfect; {before} with the nominal numbers)",
                noise(judged.error.after)
            ),
            false => format!("{before} times the noise (1 is perfect)"),
        };
        return format!(
            "The scenario “{scenario}”{numbers} predicts the recording “{recording}” as well as the noise of its sensors allows: \
             its error {whose} is {error}, and no effect of the library improves it significantly."
        );
    }
    let times = format!("wrong by {before} times the noise (1 is perfect)");
    let wrong = match diagnosis.most_wrong() {
        Some((c, e)) if judged.error.before > BEYOND => {
            format!("wrong by {} in {}, far beyond the noise", in_unit(c, e.before), c.channel)
        }
        Some((c, e)) => format!("{times}, in {} by {}", c.channel, in_unit(c, e.before)),
        None => times,
    };
    format!(
        "The recording “{recording}” differs from the scenario “{scenario}” by more than the noise of its sensors: \
         {whose} the scenario is {wrong}."
    )
}

/// Error in units of noise beyond which a sentence tells it in the channel's own unit alone: it says more of the sensor than of the model.
const BEYOND: f64 = 1e5;

/// "0.24 m": an error to two digits.
fn in_unit(channel: &ChannelError, error: f64) -> String {
    format!("{} {}", digits(error, 2), channel.unit).trim_end().to_owned()
}

/// On which runs, and over which horizon.
fn whose_words(judged: &Judged) -> String {
    let whose = match judged.left_out {
        true => "on runs that were not used for the search",
        false => "on the runs that were used (there are no others)",
    };
    match judged.window_s {
        None => whose.to_owned(),
        Some(window) => {
            format!("{whose}, over {} s at a time (whole runs are not predictable)", crate::number::short(window))
        }
    }
}

fn whereabouts(diagnosis: &Diagnosis, evidence: &Evidence) -> Option<String> {
    let first = diagnosis.located.first()?;
    let mut said = format!("{} of the mismatch sits at {}", percent(first.share), place_words(&first.place));
    said += &format!(" ({}", when_words(first, evidence));
    match first.condition.trim() {
        "" | "always" => said += ")",
        condition => said += &format!("; {condition})"),
    }
    if let Some(second) = diagnosis.located.get(1).filter(|l| l.share >= 0.1) {
        said += &format!(", {} at {}", percent(second.share), place_words(&second.place));
    }
    Some(said + ".")
}

/// A place for a reader: `joint joint_3`, `contact of probe and drogue`.
pub fn place_words(place: &str) -> String {
    let (kind, name) = place.split_once(':').unwrap_or((place, ""));
    match kind {
        "contact" => format!("the contact of {}", name.replacen('/', " and ", 1)),
        "world" => "the whole rig".to_owned(),
        "sensor" => format!("the sensor {name}"),
        _ if name.starts_with(kind) => name.to_owned(),
        _ => format!("{kind} {name}"),
    }
}

/// When a mismatch is there: "throughout", "from 12.4 s on", "from 3 s to 5 s".
pub fn when_words(located: &Located, evidence: &Evidence) -> String {
    let edges = || evidence.heat.iter().flat_map(|h| h.edges_s.iter().copied());
    let (start, end) = (edges().fold(f64::INFINITY, f64::min), edges().fold(f64::NEG_INFINITY, f64::max));
    let room = WHOLE * (end - start).max(0.0);
    let is_late = located.from_s.is_finite() && (!start.is_finite() || located.from_s > start + room);
    let is_early = located.to_s.is_finite() && (!end.is_finite() || located.to_s < end - room);
    let [from, to] = [located.from_s, located.to_s].map(|t| crate::number::digits(t, 3));
    match (is_late, is_early) {
        (false, false) => "throughout".to_owned(),
        (true, false) => format!("from {from} s on"),
        (false, true) => format!("until {to} s"),
        (true, true) => format!("from {from} s to {to} s"),
    }
}

fn explanation(diagnosis: &Diagnosis) -> Option<String> {
    let effects: Vec<String> = diagnosis.effects.iter().map(effect_words).collect();
    let list = join(&effects);
    let within = within_words(diagnosis);
    match (diagnosis.verdict, effects.is_empty()) {
        (Verdict::NoMismatch, _) => None,
        (Verdict::Explained, false) => {
            let it = if within.is_empty() { "It" } else { "that" };
            Some(format!("{within}{it} is explained by {list}."))
        }
        (Verdict::PartlyExplained, false) => {
            let part = diagnosis.explained_share.as_ref().map_or_else(|| "A part".to_owned(), share_words);
            let of = if within.is_empty() { "it" } else { "that" };
            Some(format!("{within}{part} of {of} is explained by {list}. {}", remainder_words(diagnosis)))
        }
        _ => Some(
            "No effect of the library helps on runs that were left out of the fit, alone or with others; below stands where the \
             mismatch sits, when, and on what it depends as far as the residuals show that."
                .to_owned(),
        ),
    }
}

/// "Its numbers, corrected within their tolerances, leave 12.3 times the noise in windows; "; nothing where none is free.
fn within_words(diagnosis: &Diagnosis) -> String {
    let left = diagnosis.error.within_tolerance.filter(|left| left.is_finite());
    left.map_or_else(String::new, |left| {
        let times = noise(left);
        format!(
            "Its numbers, corrected within their tolerances, leave {times} times the noise over {} s at a time; ",
            crate::number::short(diagnosis.error.window_s)
        )
    })
}

/// "99.6": a share in per cent, with as many digits as tell it from all.
pub fn share_percent(share: f64) -> String {
    let share = share.min(1.0);
    let decimals = (-(1.0 - share).max(1e-6).log10()).ceil().max(2.0) as usize - 2;
    format!("{:.*}", if share < 1.0 { decimals } else { 0 }, 100.0 * share)
}

/// "99.6 % (95 % interval 99.4 to 99.7 %)".
pub fn share_words(explained: &Explained) -> String {
    let [share, low, high] = [explained.share, explained.interval[0], explained.interval[1]].map(share_percent);
    format!("{share} % (95 % interval {low} to {high} %)")
}

/// What is left, where, when, and on what it depends.
fn remainder_words(diagnosis: &Diagnosis) -> String {
    let Some(remainder) = &diagnosis.remainder else {
        return "What remains shows over whole runs only, in no window.".to_owned();
    };
    let error = match remainder.error {
        error if error > BEYOND => String::new(),
        error => format!(", {} times the noise in windows,", noise(error)),
    };
    let Some(first) = remainder.located.first() else {
        return format!("What remains{error} has no place.");
    };
    let on = if first.condition == "always" { String::new() } else { format!(" ({})", first.condition) };
    let place = place_words(&first.place);
    format!("What remains{error} sits most at {place}{on}; no effect of the library takes most of it away.")
}

/// "viscous friction at joint_3 (b = 0.9012 ± 0.0011 N m s/rad)".
pub fn effect_words(found: &Found) -> String {
    format!("{} at {} ({})", plain_name(&found.name), place_words(&found.place), parameter_words(found))
}

/// "b = 0.9012 ± 0.0011 N m s/rad, …".
pub fn parameter_words(found: &Found) -> String {
    let one = |(name, value): (&String, &ParamValue)| {
        let unit = unit(&found.name, name, found.slides);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        format!("{name} = {}{unit}", value_words(value, found.std_err.get(name)))
    };
    found.params.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// A parameter's value with its errors.
pub fn value_words(value: &ParamValue, std_err: Option<&StdErr>) -> String {
    let errors = std_err.map(StdErr::entries).unwrap_or_default();
    let entry = |i: usize, x: f64| with_error(x, errors.get(i).copied().flatten().unwrap_or(f64::NAN));
    match value {
        ParamValue::Number(x) => entry(0, *x),
        ParamValue::Numbers(list) => {
            format!("[{}]", list.iter().enumerate().map(|(i, x)| entry(i, *x)).collect::<Vec<_>>().join(", "))
        }
        ParamValue::Text(text) => text.clone(),
        ParamValue::Flag(flag) => flag.to_string(),
    }
}

fn improvement(diagnosis: &Diagnosis) -> Option<String> {
    if diagnosis.effects.is_empty() {
        return None;
    }
    let judged = diagnosis.judged();
    let what = if diagnosis.effects.len() == 1 { "it" } else { "them" };
    let error = &diagnosis.error;
    let windows = match judged.window_s {
        Some(_) => String::new(),
        None => format!(
            " (restarted every {} s: from {} to {})",
            crate::number::short(error.window_s),
            noise(error.windowed.before),
            noise(error.windowed.after)
        ),
    };
    let times =
        format!("from {} to {} times the noise{windows}", noise(judged.error.before), noise(judged.error.after));
    let own = diagnosis
        .most_wrong()
        .map(|(c, e)| format!("in {} from {} to {}", c.channel, in_unit(c, e.before), in_unit(c, e.after)));
    let falls = match own {
        Some(own) if judged.error.before > BEYOND => own,
        Some(own) => format!("{times}, {own}"),
        None => times,
    };
    Some(format!("With {what} in the model, the error there falls {falls}."))
}

/// What the data do not decide.
fn doubts(diagnosis: &Diagnosis) -> Option<String> {
    let near = |found: &Found| {
        let one = |rival: &Rival| match crate::place::same_place(&rival.place, &found.place) {
            true => plain_name(&rival.name).to_owned(),
            false => format!("{} at {}", plain_name(&rival.name), place_words(&rival.place)),
        };
        let rivals: Vec<String> = found.rivals.iter().filter(|r| r.score_gap < UNDECIDED).map(one).collect();
        let what = plain_name(&found.name);
        (!rivals.is_empty()).then(|| format!("The data do not decide between {what} and {}.", rivals.join(" or ")))
    };
    let said: Vec<String> = diagnosis.effects.iter().filter_map(near).collect();
    if !said.is_empty() {
        return Some(said.join(" "));
    }
    let rivals = || diagnosis.effects.iter().flat_map(|e| &e.rivals);
    let nearest = rivals().min_by(|a, b| a.score_gap.total_cmp(&b.score_gap))?;
    // Those that are told though the data decide are near beside what is left, which is none of theirs.
    Some(format!(
        "The nearest other explanation, {} at {}, is worse by {} in the information criterion: less than a twentieth of what either leaves beyond \
         noise, so that what neither of them has may decide between them.",
        plain_name(&nearest.name),
        place_words(&nearest.place),
        crate::number::digits(nearest.score_gap, 3)
    ))
}

fn join(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [rest @ .., last] => format!("{} and by {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_has_the_digits_that_tell_it_from_all() {
        assert_eq!(
            [0.5, 0.96, 0.9964, 0.99991, 1.0, 1.002].map(share_percent),
            ["50", "96", "99.6", "99.991", "100", "100"]
        );
    }

    #[test]
    fn places_and_times_are_words() {
        assert_eq!(place_words("joint:joint_3"), "joint_3");
        assert_eq!(place_words("joint:elbow"), "joint elbow");
        assert_eq!(place_words("contact:probe/drogue"), "the contact of probe and drogue");
        let heat = crate::evidence::Heat {
            run: String::new(),
            role: crate::diagnosis::Role::Fit,
            window_s: None,
            edges_s: vec![0.0, 10.0, 20.0],
            rows: Vec::new(),
        };
        let evidence = Evidence { heat: vec![heat], ..Evidence::default() };
        let located =
            |from_s, to_s| Located { place: "world".into(), share: 1.0, from_s, to_s, condition: String::new() };
        assert_eq!(when_words(&located(0.1, 20.0), &evidence), "throughout");
        assert_eq!(when_words(&located(12.4, 20.0), &evidence), "from 12.4 s on");
        assert_eq!(when_words(&located(0.0, 5.0), &evidence), "until 5 s");
        assert_eq!(when_words(&located(3.0, 5.0), &evidence), "from 3 s to 5 s");
    }
}

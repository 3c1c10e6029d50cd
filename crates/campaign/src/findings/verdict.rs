//! The campaign in a few plain sentences.

use super::{Driver, Fifth, Findings, Success};
use record::page::number::{digits, grouped, percent, rate};
use record::page::unit::unit;

/// The paragraph.
pub(super) fn paragraph(findings: &Findings) -> String {
    if findings.runs == 0 {
        return "The table has no run.".to_owned();
    }
    let mut sentences = vec![opening(findings)];
    sentences.extend(failures(findings));
    sentences.extend(driver(findings));
    sentences.join(" ")
}

/// A rate with its interval: `92.6 % (95 % interval 90.0 … 94.6 %)`.
pub(crate) fn rate_words(of: &crate::stats::Rate) -> String {
    let low = rate(of.interval.low);
    let low = low.trim_end_matches(" %");
    format!("{} (95 % interval {low} … {})", rate(of.value), rate(of.interval.high))
}

/// `soft_captured` → `Soft captured`.
pub(crate) fn flag_words(flag: &str) -> String {
    let words = flag.replace('_', " ");
    let mut signs = words.chars();
    signs.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + signs.as_str())
}

fn opening(findings: &Findings) -> String {
    if let Some(Success { flag, rate, .. }) = &findings.success {
        let (count, of) = (grouped(rate.count as u64), grouped(rate.of as u64));
        let runs = if rate.of == 1 { "run" } else { "runs" };
        return format!("{} in {count} of {of} {runs}: {}.", flag_words(flag), rate_words(rate));
    }
    let outcomes: Vec<String> =
        findings.outcomes.iter().map(|tally| format!("{} {}", tally.outcome, tally.rate.count)).collect();
    let runs = if findings.runs == 1 { "1 run".to_owned() } else { format!("{} runs", grouped(findings.runs as u64)) };
    if outcomes.is_empty() { format!("{runs}.") } else { format!("{runs}: {}.", outcomes.join(", ")) }
}

fn failures(findings: &Findings) -> Option<String> {
    let success = findings.success.as_ref()?;
    let failed = success.rate.of - success.rate.count;
    let mut failing: Vec<_> = findings.outcomes.iter().filter(|tally| tally.is_failure).collect();
    failing.sort_by_key(|tally| std::cmp::Reverse(tally.rate.count - tally.successes));
    let named: Vec<String> =
        failing.iter().map(|tally| format!("{} ({})", tally.outcome, tally.rate.count - tally.successes)).collect();
    if failed == 0 || named.is_empty() {
        return None;
    }
    let others = match (failed, success.rate.count) {
        (1, 0) => "It".to_owned(),
        (1, _) => "The other".to_owned(),
        (_, 0) => "They".to_owned(),
        _ => format!("The other {failed}"),
    };
    let reasons = failing.iter().flat_map(|tally| &tally.reasons);
    let why = reasons.reduce(|a, b| if b.runs > a.runs { b } else { a }).map_or_else(String::new, |reason| {
        let text = reason.pattern.trim_end_matches('.');
        if failed == 1 {
            format!(": “{text}”")
        } else {
            format!(", most often ({} of {failed}) because “{text}”", reason.runs)
        }
    });
    Some(format!("{others} ended {}{why}.", list(&named)))
}

/// `a, b or c`.
fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

fn driver(findings: &Findings) -> Option<String> {
    let first = findings.sensitivity.ranking.first()?;
    let ranked_by = findings.sensitivity.ranked_by.as_deref()?;
    let is_success = findings.success.as_ref().is_some_and(|success| success.flag == ranked_by);
    let output = if is_success { "success".to_owned() } else { ranked_by.to_owned() };
    if !first.is_clear {
        return Some(format!(
            "No input alone drives {output} beyond what chance would show in {} runs.",
            findings.runs
        ));
    }
    let share = first.first_order.filter(|s| *s > first.noise.unwrap_or(f64::INFINITY)).map_or_else(
        || "it correlates with it, though it explains little of it alone".to_owned(),
        |share| format!("alone it explains {} of the variance of {output}", percent(share.min(1.0))),
    );
    let matters = if is_success { "matters most".to_owned() } else { format!("matters most to {output}") };
    let range = if is_success { fifth_words(first) } else { String::new() };
    Some(format!("The input that {matters} is {}: {share}{range}.", first.input))
}

/// Success in the best and in the worst fifth of the input's values.
fn fifth_words(driver: &Driver) -> String {
    let best = driver.by_fifth.iter().reduce(|a, b| if b.rate.value > a.rate.value { b } else { a });
    let worst = driver.by_fifth.iter().reduce(|a, b| if b.rate.value < a.rate.value { b } else { a });
    let (Some(best), Some(worst)) = (best, worst) else { return String::new() };
    let unit = unit(&driver.input).map_or_else(String::new, |unit| format!(" {unit}"));
    let words = |fifth: &Fifth| {
        let (low, high) = (digits(fifth.low, 3), digits(fifth.high, 3));
        let at = if low == high { low } else { format!("{low} … {high}") };
        format!("{} at {at}{unit}", percent(fifth.rate.value))
    };
    format!(", and success goes from {} to {}", words(best), words(worst))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::tests::table;
    use crate::findings::{Findings, Options};

    fn verdict(count: usize, threshold: usize) -> String {
        Findings::of(&table(count, |i| i < threshold), &Options::default()).verdict
    }

    #[test]
    fn the_verdict_reads_as_a_sentence() {
        assert_eq!(
            verdict(1, 0),
            "Captured in 0 of 1 run: 0 % (95 % interval 0 … 79.3 %). It ended lost (1): “slipped … mm in pad_1”."
        );
        let all = verdict(40, 40);
        assert!(all.starts_with(
            "Captured in 40 of 40 runs: 100 % (95 % interval 91.2 … 100 %). The input that matters most to "
        ));
        let part = verdict(200, 150);
        assert!(
            part.contains("The other 50 ended lost (50), most often (50 of 50) because “slipped … mm in pad_1”."),
            "{part}"
        );
        assert!(part.contains("success goes from 100 % at 0 … 39 ° to 0 % at 160 … 199 °"), "{part}");
    }

    #[test]
    fn flags_become_words() {
        assert_eq!((flag_words("soft_captured").as_str(), flag_words("")), ("Soft captured", String::new()));
        assert_eq!(list(&["a".into(), "b".into(), "c".into()]), "a, b or c");
    }
}

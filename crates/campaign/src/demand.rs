//! What a campaign as a whole must show: rates of flags, quantiles of numbers.

use crate::stats::{quantile, sorted};
use crate::table::{Cells, Table};
use scenario::spec::CampaignExpect;

/// One demand and whether it was met.
#[derive(Clone, Debug, PartialEq)]
pub struct Demand {
    /// Whether it was met.
    pub met: bool,
    /// The demand and what came, in a sentence.
    pub text: String,
}

/// Checks every demand; a metric that no run has is not met.
pub fn check_demands(expects: &[CampaignExpect], table: &Table) -> Vec<Demand> {
    expects.iter().map(|expect| check(expect, table)).collect()
}

fn check(expect: &CampaignExpect, table: &Table) -> Demand {
    let level = expect.quantile.unwrap_or(0.5);
    let (what, value) = match table.column(&expect.metric).map(|c| &c.cells) {
        Some(Cells::Flags(flags)) if !flags.is_empty() => {
            let yes = flags.iter().filter(|f| **f == Some(true)).count();
            (format!("rate of {}", expect.metric), Some(yes as f64 / flags.len() as f64))
        }
        Some(cells) => {
            let values: Vec<f64> = cells.numbers().unwrap_or_default().into_iter().flatten().collect();
            let value = if values.is_empty() { None } else { quantile(&sorted(values), level) };
            (format!("{level} quantile of {}", expect.metric), value)
        }
        None => (expect.metric.clone(), None),
    };
    let Some(value) = value else {
        return Demand { met: false, text: format!("no run has a number or a flag \"{}\"", expect.metric) };
    };
    let (met, bound) = match (expect.at_most, expect.at_least) {
        (Some(most), _) => (value <= most, format!("at most {most}")),
        (None, Some(least)) => (value >= least, format!("at least {least}")),
        (None, None) => (false, "something, but the entry says nothing".to_owned()),
    };
    let verb = if met { "is" } else { "should be" };
    Demand { met, text: format!("{what} {verb} {bound}: {value:.4}") }
}

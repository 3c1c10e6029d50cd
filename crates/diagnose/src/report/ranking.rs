//! The ranking of hypotheses and their evidence.

use super::{share_bar, table};
use crate::diagnosis::Diagnosis;
use crate::evidence::{Evidence, Hypothesis, Status};
use crate::number::digits;
use crate::vocabulary::plain_name;
use record::plot::escape;

/// Hypotheses that are shown without a click.
const MOST: usize = 12;

/// The section.
pub(super) fn section(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let rivals = rivals(diagnosis);
    if evidence.ranking.is_empty() && rivals.is_empty() {
        return String::new();
    }
    let mut text = rivals;
    if evidence.ranking.is_empty() {
        return text;
    }
    text += "<p>Every effect of the library at every place where it could act. <i>Screen</i>: fall of the summed squared residual \
             that a linear estimate predicts, nuisance (initial states, active parameters) projected out. <i>Refit</i>: fall after a fit in \
             full simulation. <i>Criterion</i>: that fall less what the effect's parameters would win from noise (BIC). <i>Held back</i>: fall by the \
             whole chosen set where each run is predicted with numbers that the others give. Both last must be positive. A column's head sorts by it.</p>\n";
    let header =
        ["#", "effect", "place", "#screen", "share", "#parameters", "#refit", "#criterion", "#held back", "result"];
    let rows: Vec<Vec<String>> = evidence.ranking.iter().enumerate().map(|(i, h)| row(i, h)).collect();
    let (first, more) = rows.split_at(rows.len().min(MOST));
    text += &table("sortable", &header, first);
    if !more.is_empty() {
        let others = table("sortable", &header, more);
        text += &format!("<details><summary>{} more, all weaker</summary>{others}</details>\n", more.len());
    }
    text
}

fn rivals(diagnosis: &Diagnosis) -> String {
    let mut rows = Vec::new();
    for found in &diagnosis.effects {
        for rival in &found.rivals {
            rows.push(vec![
                format!("{} at {}", escape(&found.name), escape(&found.place)),
                format!("{} at {}", escape(&rival.name), escape(&rival.place)),
                digits(rival.score_gap, 3),
            ]);
        }
    }
    if rows.is_empty() {
        return String::new();
    }
    "<p>Nearest other explanations after a refit. A gap below about 10 in the information criterion means that the data do \
     not decide.</p>\n"
        .to_owned()
        + &table("", &["found", "instead of it", "#worse by"], &rows)
}

fn row(i: usize, h: &Hypothesis) -> Vec<String> {
    let class = match h.status {
        Status::Chosen => "good",
        Status::Rival => "fair",
        Status::Rejected | Status::Screened => "plain",
    };
    let why = if h.why.is_empty() { String::new() } else { format!("<small>{}</small>", escape(&h.why)) };
    let number = |x: f64| digits(x, 3);
    vec![
        (i + 1).to_string(),
        format!("<b>{}</b><small>{}</small>", escape(&h.name), escape(plain_name(&h.name))),
        escape(&h.place),
        number(h.screen_score),
        share_bar(h.share),
        h.freedoms.to_string(),
        number(h.refit_fall),
        number(h.bic_gain),
        number(h.held_back_gain),
        format!("<span class=\"pill {class}\">{}</span>{why}", h.status.word()),
    ]
}

//! A diagnosis on the terminal.

use crate::diagnosis::{Diagnosis, RunError};
use crate::evidence::{Evidence, Status};
use crate::number::{digits, noise, percent};
use crate::words::{headline, paragraph, value_words, when_words};

/// Most hypotheses shown.
const HYPOTHESES: usize = 8;
/// Width of a line of text.
const WIDTH: usize = 100;

/// The diagnosis in plain text: verdict, places, effects, nearest other explanations, errors.
pub fn summary_text(diagnosis: &Diagnosis, evidence: &Evidence) -> String {
    let mut text = format!("{}\n\n", headline(diagnosis.verdict).to_uppercase());
    text += &wrapped(&paragraph(diagnosis, evidence), "  ");
    for remark in &diagnosis.remarks {
        text += &wrapped(&format!("! {remark}"), "  ");
    }
    let located = diagnosis
        .located
        .iter()
        .map(|l| vec![l.place.clone(), percent(l.share), when_words(l, evidence), l.condition.clone()]);
    add_table(&mut text, &["where", "share", "when", "condition"], located.collect());
    add_table(&mut text, &["effect", "place", "parameter", "value"], effects(diagnosis));
    add_table(&mut text, &["other explanation", "place", "worse by"], rivals(diagnosis));
    add_table(
        &mut text,
        &["hypothesis", "place", "score", "share", "refit", "criterion", "held back", ""],
        ranking(evidence),
    );
    let header = ["run", "role", "before", "after", "windows before", "after"];
    add_table(&mut text, &header, errors(diagnosis));
    text += "\n  Errors are RMS in units of the sensors' noise: 1.0 is perfect.\n";
    text
}

fn effects(diagnosis: &Diagnosis) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for found in &diagnosis.effects {
        for (i, (name, value)) in found.params.iter().enumerate() {
            let (effect, place) = if i == 0 { (found.name.clone(), found.place.clone()) } else { Default::default() };
            let unit = crate::vocabulary::unit(&found.name, name, found.slides);
            let value = format!("{} {unit}", value_words(value, found.std_err.get(name)));
            rows.push(vec![effect, place, name.clone(), value]);
        }
    }
    rows
}

fn rivals(diagnosis: &Diagnosis) -> Vec<Vec<String>> {
    let rivals = diagnosis.effects.iter().flat_map(|e| &e.rivals);
    rivals.map(|r| vec![r.name.clone(), r.place.clone(), digits(r.score_gap, 3)]).collect()
}

fn ranking(evidence: &Evidence) -> Vec<Vec<String>> {
    let tried = evidence.ranking.iter().filter(|h| h.status != Status::Screened);
    tried
        .take(HYPOTHESES)
        .map(|h| {
            let number = |x: f64| digits(x, 3);
            let [score, refit, criterion, held] =
                [h.screen_score, h.refit_fall, h.bic_gain, h.held_back_gain].map(number);
            let (name, place, status) = (h.name.clone(), h.place.clone(), h.status.word().to_owned());
            vec![name, place, score, percent(h.share), refit, criterion, held, status]
        })
        .collect()
}

fn errors(diagnosis: &Diagnosis) -> Vec<Vec<String>> {
    let error = &diagnosis.error;
    let row = |r: &RunError| {
        let figures = [r.before, r.after, r.windowed_before, r.windowed_after].map(noise);
        [vec![r.file.clone(), r.role.word().to_owned()], figures.to_vec()].concat()
    };
    let mut rows: Vec<Vec<String>> = error.runs.iter().map(row).collect();
    let pooled = |role: &str, e: crate::diagnosis::BeforeAfter| {
        vec!["all".to_owned(), role.to_owned(), noise(e.before), noise(e.after)]
    };
    rows.push(pooled("fit", error.fit));
    rows.extend(error.holdout.map(|e| pooled("holdout", e)));
    if let Some(last) = rows.last_mut() {
        last.extend([noise(error.windowed.before), noise(error.windowed.after)]);
    }
    rows
}

fn add_table(text: &mut String, header: &[&str], rows: Vec<Vec<String>>) {
    if rows.is_empty() {
        return;
    }
    let mut all = vec![header.iter().map(|h| (*h).to_owned()).collect()];
    all.extend(rows);
    text.push('\n');
    text.push_str(&aligned(&all));
}

/// Rows of cells in aligned columns, two spaces apart.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let width = |k: usize| rows.iter().filter_map(|r| r.get(k)).map(|c| c.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::from(" ");
        for (cell, width) in row.iter().zip(&widths) {
            line.push_str(&format!(" {cell:<width$} "));
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// Text in lines of at most [`WIDTH`] characters.
fn wrapped(text: &str, indent: &str) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split_whitespace() {
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > WIDTH - indent.len() {
            lines += &format!("{indent}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines + &format!("{indent}{line}\n")
}

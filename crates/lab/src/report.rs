//! What a reader gets: tables of figures in Markdown and JSON, and one HTML page with tables and charts.

use crate::chart::escape;
use crate::{Allowed, Experiment, Figure, Outcome, chart_svg};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// An experiment with what it found.
pub type Answer = (Experiment, Outcome);

/// A number for a reader: at most six digits, powers of ten where they help.
pub fn shown(x: f64) -> String {
    if x.is_nan() {
        return "–".to_owned();
    }
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&x.abs()) {
        let text = format!("{x:.3e}");
        let (mantissa, power) = text.split_once('e').unwrap_or((&text, "0"));
        return format!("{}e{power}", mantissa.trim_end_matches('0').trim_end_matches('.'));
    }
    let digits = (5 - x.abs().log10().floor() as i32).clamp(0, 8) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What a figure should be, and how far it may be off, in words.
pub fn condition(figure: &Figure) -> (String, String) {
    let expected = shown(figure.expected);
    match figure.allowed {
        Allowed::Relative(x) => (expected, format!("± {} %", shown(100.0 * x))),
        Allowed::Absolute(x) => (expected, format!("± {}", shown(x))),
        Allowed::AtMost(x) => (format!("≤ {}", shown(x)), String::new()),
        Allowed::AtLeast(x) => (format!("≥ {}", shown(x)), String::new()),
        Allowed::Shown => (expected, "shown".to_owned()),
    }
}

/// `yes`, `NO`, or nothing for a figure that is only shown.
pub fn verdict(figure: &Figure) -> &'static str {
    match figure.allowed {
        Allowed::Shown => "",
        _ if figure.holds() => "yes",
        _ => "NO",
    }
}

fn unit(figure: &Figure) -> &'static str {
    if figure.unit == "1" { "" } else { figure.unit }
}

/// Rows (figure, measured with unit, should be, allowed, holds).
pub fn rows(outcome: &Outcome) -> Vec<[String; 5]> {
    let row = |f: &Figure| {
        let (expected, allowed) = condition(f);
        let measured = format!("{} {}", shown(f.measured), unit(f)).trim_end().to_owned();
        [f.name.clone(), measured, expected, allowed, verdict(f).to_owned()]
    };
    outcome.figures.iter().map(row).collect()
}

/// One table of all experiments.
pub fn markdown(answers: &[Answer]) -> String {
    let mut text = String::from(
        "| experiment | figure | measured | should be | allowed | holds |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    for (experiment, outcome) in answers {
        for (i, row) in rows(outcome).iter().enumerate() {
            let name = if i == 0 { experiment.name } else { "" };
            let cells = row.iter().map(|c| c.replace('|', "\\|")).collect::<Vec<_>>().join(" | ");
            let _ = writeln!(text, "| {name} | {cells} |");
        }
    }
    text
}

/// Figures with their verdicts, for programs.
pub fn figures_json(answers: &[Answer]) -> Value {
    let figure = |f: &Figure| {
        json!({ "name": f.name, "measured": f.measured, "expected": f.expected, "unit": f.unit,
                "allowed": f.allowed, "holds": f.holds() })
    };
    let of = |(experiment, outcome): &Answer| {
        json!({ "experiment": experiment.name, "question": experiment.question, "holds": outcome.holds(),
                "figures": outcome.figures.iter().map(figure).collect::<Vec<_>>(), "notes": outcome.notes })
    };
    Value::Array(answers.iter().map(of).collect())
}

/// What the output folder's summary says.
pub fn summary(answers: &[Answer]) -> Map<String, Value> {
    let holds = answers.iter().all(|(_, o)| o.holds());
    let mut summary = Map::new();
    summary.insert("outcome".to_owned(), if holds { "all figures hold" } else { "some figures do not hold" }.into());
    summary.insert("experiments".to_owned(), answers.iter().map(|(e, _)| Value::from(e.name)).collect());
    summary
}

/// The charts of one experiment, one below the other, as one SVG.
pub fn charts_svg(outcome: &Outcome) -> String {
    let charts: Vec<String> = outcome.charts.iter().map(chart_svg).collect();
    let height = 400 * charts.len().max(1);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 820 {height}\" width=\"820\" height=\"{height}\">\n"
    );
    for (i, chart) in charts.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate(0,{})\">\n{chart}</g>", 400 * i);
    }
    svg.push_str("</svg>\n");
    svg
}

const STYLE: &str = "body{font-family:sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:1em 0}td,th{border-bottom:1px solid #ddd;padding:.25em .7em;text-align:left}\
td:nth-child(n+2){font-variant-numeric:tabular-nums}.no{color:#b00;font-weight:bold}.q{color:#555}svg{max-width:100%;height:auto}";

/// One self-contained page.
pub fn html(answers: &[Answer]) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>softdock lab</title><style>{STYLE}</style>\
         </head><body>\n<h1>softdock lab</h1>\n<p>{}</p>\n<ul>\n",
        count(answers)
    );
    for (experiment, outcome) in answers {
        let mark = if outcome.holds() { "" } else { " <span class=\"no\">does not hold</span>" };
        let _ = writeln!(
            page,
            "<li><a href=\"#{0}\">{0}</a>: {1}{mark}</li>",
            experiment.name,
            escape(experiment.question)
        );
    }
    page.push_str("</ul>\n");
    for answer in answers {
        add_section(&mut page, answer);
    }
    page.push_str("</body></html>\n");
    page
}

/// "41 figures of 9 experiments; 40 hold."
pub fn count(answers: &[Answer]) -> String {
    let judged = || answers.iter().flat_map(|(_, o)| &o.figures).filter(|f| !matches!(f.allowed, Allowed::Shown));
    let holding = judged().filter(|f| f.holds()).count();
    format!("{} of {} figures hold, {} experiments.", holding, judged().count(), answers.len())
}

fn add_section(page: &mut String, (experiment, outcome): &Answer) {
    let _ = writeln!(
        page,
        "<h2 id=\"{0}\">{0}</h2>\n<p class=\"q\">{1}</p>\n<table><tr><th>figure</th><th>measured</th><th>should be</th>\
         <th>allowed</th><th>holds</th></tr>",
        experiment.name,
        escape(experiment.question)
    );
    for [name, measured, expected, allowed, holds] in rows(outcome) {
        let class = if holds == "NO" { " class=\"no\"" } else { "" };
        let cells = [name, measured, expected, allowed].map(|c| format!("<td>{}</td>", escape(&c))).concat();
        let _ = writeln!(page, "<tr>{cells}<td{class}>{holds}</td></tr>");
    }
    page.push_str("</table>\n");
    for note in &outcome.notes {
        match note.starts_with('|') {
            true => add_table(page, note),
            false => drop(writeln!(page, "<p>{}</p>", escape(note))),
        }
    }
    for chart in &outcome.charts {
        page.push_str(&chart_svg(chart));
    }
}

/// A Markdown table: its second line is the rule.
fn add_table(page: &mut String, table: &str) {
    page.push_str("<table>");
    for (i, line) in table.lines().enumerate().filter(|(i, _)| *i != 1) {
        let cell = if i == 0 { "th" } else { "td" };
        let cells = line.trim().trim_matches('|').split('|');
        let row: String = cells.map(|c| format!("<{cell}>{}</{cell}>", escape(c.trim()))).collect();
        let _ = writeln!(page, "<tr>{row}</tr>");
    }
    page.push_str("</table>\n");
}

/// The notes of all experiments in Markdown, each under its experiment's name.
pub fn notes_markdown(answers: &[Answer]) -> String {
    let mut text = String::new();
    for (experiment, outcome) in answers.iter().filter(|(_, o)| !o.notes.is_empty()) {
        let _ = writeln!(text, "\n## {}\n\n{}", experiment.name, outcome.notes.join("\n\n"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LabError, Options};

    fn answers() -> Vec<Answer> {
        fn run(_: &Options) -> Result<Outcome, LabError> {
            Ok(Outcome::default())
        }
        let experiment = Experiment { name: "a", question: "b < c?", run };
        let figures = vec![
            Figure::relative("good", 1.0001, 1.0, "N", 1e-3),
            Figure::at_most("bad", 2e-9, 1e-12, "m/s"),
            Figure::shown("beside", 3.0, f64::NAN, "1"),
        ];
        let notes = vec!["| x | y |\n| --- | --- |\n| 1 | < 2 |\n".to_owned()];
        vec![(experiment, Outcome { figures, notes, ..Outcome::default() })]
    }

    #[test]
    fn the_table_says_what_holds_and_what_does_not() {
        let text = markdown(&answers());
        assert!(text.contains("| a | good | 1.0001 N | 1 | ± 0.1 % | yes |"), "{text}");
        assert!(text.contains("|  | bad | 2e-9 m/s | ≤ 1e-12 |  | NO |"), "{text}");
        assert!(text.contains("|  | beside | 3 | – | shown |  |"), "{text}");
        assert_eq!(count(&answers()), "1 of 2 figures hold, 1 experiments.");
    }

    #[test]
    fn a_page_escapes_what_it_quotes_and_json_has_null_for_nan() {
        let page = html(&answers());
        assert!(page.contains("b &lt; c?") && page.contains("<tr><td>1</td><td>&lt; 2</td></tr>"), "{page}");
        assert!(!page.contains("---"));
        let json = figures_json(&answers());
        assert!(json[0]["figures"][2]["expected"].is_null() && json[0]["holds"] == false);
    }
}

//! Signals as CSV: one header row, first column `t` in seconds, an empty cell where a channel was not sampled.
//!
//! Numbers are written in the shortest form that reads back to the same bits. Units are not in the file: the
//! channel's name tells them, or the Parquet file beside it.

use crate::folder::write_file;
use crate::{ChannelSpec, RecordError, Signals};
use std::fmt::Write as _;
use std::path::Path;

/// Writes signals to a CSV file and waits until it is on disk.
pub fn write_csv(path: &Path, signals: &Signals) -> Result<(), RecordError> {
    write_file(path, encode_csv(signals).as_bytes())
}

/// The text of a CSV file.
pub fn encode_csv(signals: &Signals) -> String {
    let mut text = String::from("t");
    for channel in &signals.channels {
        text.push(',');
        text.push_str(&quoted(&channel.spec.name));
    }
    text.push('\n');
    for (row, t) in signals.times.iter().enumerate() {
        add_number(&mut text, *t);
        for channel in &signals.channels {
            text.push(',');
            add_number(&mut text, channel.values[row]);
        }
        text.push('\n');
    }
    text
}

/// Reads signals from a CSV file.
pub fn read_csv(path: &Path) -> Result<Signals, RecordError> {
    let bytes = std::fs::read(path).map_err(RecordError::read(path))?;
    let text = String::from_utf8(bytes).map_err(|_| RecordError::table(path, "is not UTF-8 text"))?;
    parse_csv(path, &text)
}

/// Parses the text of a CSV file; `path` is for messages.
pub fn parse_csv(path: &Path, text: &str) -> Result<Signals, RecordError> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let header = lines.next().map(|(_, line)| cells(line)).unwrap_or_default();
    if header.first().map(String::as_str) != Some("t") {
        let found = header.first().cloned().unwrap_or_default();
        return Err(line_error(path, 1, format!("first column is \"{found}\", must be \"t\" (time in s)")));
    }
    let specs = header[1..].iter().map(|name| ChannelSpec { name: name.clone(), ..ChannelSpec::default() });
    let mut signals = Signals::new(specs.collect());
    for (i, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        add_row(&mut signals, &header, line).map_err(|problem| line_error(path, i + 1, problem))?;
    }
    signals.check(path)?;
    Ok(signals)
}

fn add_row(signals: &mut Signals, header: &[String], line: &str) -> Result<(), String> {
    let row = cells(line);
    if row.len() != header.len() {
        return Err(format!("{} cells, the header has {}", row.len(), header.len()));
    }
    let t = parse_number(&row[0], "t")?.ok_or("has no time t")?;
    if let Some(before) = signals.times.last().filter(|before| t <= **before) {
        return Err(format!("time {t} s does not come after {before} s; t must increase strictly"));
    }
    signals.times.push(t);
    for (channel, cell) in signals.channels.iter_mut().zip(&row[1..]) {
        channel.values.push(parse_number(cell, &channel.spec.name)?.unwrap_or(f64::NAN));
    }
    Ok(())
}

fn parse_number(cell: &str, column: &str) -> Result<Option<f64>, String> {
    if cell.is_empty() {
        return Ok(None);
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        _ => Err(format!(
            "\"{cell}\" in column \"{column}\" is not a finite number; leave the cell empty where nothing was measured"
        )),
    }
}

fn line_error(path: &Path, line: usize, problem: String) -> RecordError {
    RecordError::Line { path: path.to_owned(), line, problem }
}

/// The debug form of `f64` is the shortest that reads back exactly, with an exponent where that is shorter.
fn add_number(text: &mut String, value: f64) {
    if !value.is_nan() {
        let _infallible = write!(text, "{value:?}");
    }
}

fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.into() }
}

/// Cells of a line; quotes protect commas, a doubled quote is a quote.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut inside = false;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        let last = cells.len() - 1;
        match c {
            '"' if inside && chars.peek() == Some(&'"') => cells[last].extend(chars.next()),
            '"' => inside = !inside,
            ',' if !inside => cells.push(String::new()),
            other => cells[last].push(other),
        }
    }
    cells.iter().map(|cell| cell.trim().to_string()).collect()
}

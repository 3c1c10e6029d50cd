//! The committed figures: one row per case, compared with what was counted.
//!
//! A case that grew by more than [`MARGIN`] fails the check; so does one that has no row, and a row that has no case. To move
//! a row takes a reason, which stands in its last column, and which README's Changes must tell as well (tests/instructions.rs).
//! Rows within the margin stay as they are, so that small growths add up until they count.

use std::fmt::Write as _;

/// Relative change beyond which a figure has moved. One binary repeats its counts to some 1e-4, other processors choose
/// other library functions, and another release of the compiler changes 1 to 2 %.
pub const MARGIN: f64 = 0.03;

/// Head of the committed file, up to its rows.
const HEAD: &str = "\
# Instructions

What one call of each takes: instructions in softdock's own code, counted by valgrind (callgrind) in the profile of the
tests; what the C library does is left out, since it depends on the processor. Checked by
`cargo bench --profile dev --no-default-features --bench instructions`, which fails where a figure has grown by more than
3 %, and written by the same with `-- --bless --reason \"…\"`: the reason stands beside what it moved, and in README's Changes.

| what | instructions | moved because |
| --- | ---: | --- |
";

/// One case.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    pub case: String,
    pub instructions: u64,
    /// Why the figure moved last; empty for one that never did.
    pub reason: String,
}

/// What became of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Within the margin of the committed figure.
    Same,
    /// Beyond the margin.
    Grown,
    /// Below the margin: good, and worth a blessing, so that it cannot slip back.
    Fallen,
    /// Counted, but not committed.
    New,
    /// Committed, but not counted.
    Gone,
}

impl Verdict {
    /// Whether the check passes with it.
    pub fn is_good(self) -> bool {
        matches!(self, Self::Same | Self::Fallen)
    }
}

/// The rows of a table's text.
pub fn parse(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim().strip_prefix('|')?.strip_suffix('|')?.split('|').map(str::trim).collect();
        let [case, figure, reason] = cells[..] else { return None };
        let instructions = figure.replace(',', "").parse().ok()?;
        Some(Row { case: case.to_owned(), instructions, reason: reason.to_owned() })
    };
    text.lines().filter_map(row).collect()
}

/// The table's text.
pub fn print(rows: &[Row]) -> String {
    let mut text = HEAD.to_owned();
    for Row { case, instructions, reason } in rows {
        let _ = writeln!(text, "| {case} | {} | {reason} |", grouped(*instructions));
    }
    text
}

/// Every case and row with its verdict and its relative change, in the order of what was counted.
pub fn compare(committed: &[Row], counted: &[(String, u64)]) -> Vec<(String, Verdict, f64)> {
    let of_case = |(case, now): &(String, u64)| match committed.iter().find(|r| r.case == *case) {
        None => (case.clone(), Verdict::New, 0.0),
        Some(row) => {
            let change = (*now as f64 - row.instructions as f64) / row.instructions as f64;
            (case.clone(), judge(change), change)
        }
    };
    let is_gone = |row: &&Row| counted.iter().all(|(case, _)| *case != row.case);
    let gone = committed.iter().filter(is_gone).map(|r| (r.case.clone(), Verdict::Gone, 0.0));
    counted.iter().map(of_case).chain(gone).collect()
}

fn judge(change: f64) -> Verdict {
    match change {
        c if c > MARGIN => Verdict::Grown,
        c if c < -MARGIN => Verdict::Fallen,
        _ => Verdict::Same,
    }
}

/// The rows with what has moved taken over for a reason; the others stay as they are.
pub fn bless(committed: &[Row], counted: &[(String, u64)], reason: &str) -> Vec<Row> {
    let verdicts = compare(committed, counted);
    let row = |((case, now), (_, verdict, _)): (&(String, u64), &(String, Verdict, f64))| {
        let old = committed.iter().find(|r| r.case == *case).filter(|_| *verdict == Verdict::Same);
        let reason = if *verdict == Verdict::New { "" } else { reason };
        let moved = || Row { case: case.clone(), instructions: *now, reason: reason.to_owned() };
        old.cloned().unwrap_or_else(moved)
    };
    counted.iter().zip(&verdicts).map(row).collect()
}

/// 1234567 as 1,234,567.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let comma = |(i, c): (usize, char)| {
        let is_first_of_three = i > 0 && (digits.len() - i).is_multiple_of(3);
        is_first_of_three.then_some(',').into_iter().chain([c])
    };
    digits.chars().enumerate().flat_map(comma).collect()
}

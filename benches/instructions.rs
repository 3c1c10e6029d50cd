//! How many instructions does a step take, and has it grown?
//!
//! ```text
//! cargo bench --profile dev --no-default-features --bench instructions                            # count and compare
//! cargo bench --profile dev --no-default-features --bench instructions -- --bless --reason "…"    # take over what moved
//! ```
//!
//! Wants valgrind. Clocks of shared machines vary by tens of per cent, instructions of one binary by less than 1e-3: they can
//! guard what a step costs. The committed figures are tests/tables/instructions.md; status 1 where one has grown by more than
//! 3 %. Cases: `instructions/cases.rs`; how it is counted: `instructions/callgrind.rs`; what is compared: `instructions/table.rs`.
#![allow(clippy::print_stdout)]

#[path = "instructions/callgrind.rs"]
mod callgrind;
#[path = "instructions/cases.rs"]
mod cases;
mod fixtures;
#[path = "instructions/table.rs"]
mod table;

use fixtures::missions::place;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;
use table::{Row, Verdict};

/// The committed figures.
const TABLE: &str = "tests/tables/instructions.md";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let has = |flag: &str| arguments.iter().any(|a| a == flag);
    if has(callgrind::CHILD) {
        return child();
    }
    let reason = arguments.iter().position(|a| a == "--reason").and_then(|at| arguments.get(at + 1));
    let ended = match (has("--bless"), reason) {
        (true, None) => Err("--bless wants --reason \"why the figures moved\"".to_owned()),
        (true, Some(reason)) => check(Some(reason)),
        (false, _) => check(None),
    };
    match ended {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(fault) => {
            println!("{fault}");
            ExitCode::from(2)
        }
    }
}

/// Runs the cases in one thread, the one that callgrind collects.
fn child() -> ExitCode {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
    if let Err(fault) = pool {
        println!("{fault}");
        return ExitCode::from(2);
    }
    cases::run();
    ExitCode::SUCCESS
}

/// Counts, compares, and takes over what moved if there is a reason; whether all is well.
fn check(reason: Option<&str>) -> Result<bool, String> {
    let counted = count()?;
    let file = place(TABLE);
    let committed = table::parse(&fs::read_to_string(&file).unwrap_or_default());
    let verdicts = table::compare(&committed, &counted);
    show(&committed, &counted, &verdicts);
    if let Some(reason) = reason {
        let text = table::print(&table::bless(&committed, &counted, reason));
        fs::write(&file, text).map_err(|e| format!("{}: {e}", file.display()))?;
        println!("blessed {TABLE}; README's Changes must tell the reason in the same words");
        return Ok(true);
    }
    let is_good = verdicts.iter().all(|(_, verdict, _)| verdict.is_good());
    if !is_good {
        println!("{TABLE} no longer holds: win it back, or bless what moved with a reason (-- --bless --reason \"…\")");
    }
    Ok(is_good)
}

/// Instructions of one call of every case.
fn count() -> Result<Vec<(String, u64)>, String> {
    let folder: PathBuf = std::env::temp_dir().join(format!("softdock-instructions-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let blocks = callgrind::count(&folder);
    // What is left of a folder of profiles harms nobody.
    let _ = fs::remove_dir_all(&folder);
    let of_call = |(line, sum): (String, u64)| {
        let (calls, name) = line.split_once('\t').ok_or(format!("the measured binary printed {line:?}"))?;
        let calls: u64 = calls.parse().map_err(|_| format!("the measured binary printed {line:?}"))?;
        if sum == 0 {
            return Err(format!("{name}: nothing was counted; was the binary stripped of its symbols?"));
        }
        Ok((name.to_owned(), sum / calls))
    };
    blocks?.into_iter().map(of_call).collect()
}

fn show(committed: &[Row], counted: &[(String, u64)], verdicts: &[(String, Verdict, f64)]) {
    println!("{:<48} {:>15} {:>15} {:>9}", "instructions", "committed", "counted", "change");
    for (case, verdict, change) in verdicts {
        let then = committed.iter().find(|r| r.case == *case).map(|r| r.instructions);
        let now = counted.iter().find(|(c, _)| c == case).map(|c| c.1);
        let number = |n: Option<u64>| n.map_or("–".to_owned(), table::grouped);
        let verdict = if *verdict == Verdict::Same { String::new() } else { format!("{verdict:?}").to_lowercase() };
        println!("{case:<48} {:>15} {:>15} {:>+8.1} % {verdict}", number(then), number(now), 100.0 * change);
    }
}

//! Counts what a child of this very binary executes between the first and the last line of each measured block.
//!
//! Callgrind collects inside one function only (`--toggle-collect`) and writes a profile whenever it is left (`--dump-after`), so
//! that starting up and preparing cost nothing. Of a profile only lines of this binary count: memory functions and
//! trigonometry of the C library have versions by processor.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

/// Argument of the child.
pub const CHILD: &str = "--count";

/// Name of the function that is measured, as callgrind demangles it.
const MEASURED: &str = "instructions::callgrind::measured_block";

/// Runs work inside the collected function.
#[inline(never)]
pub fn measured_block(work: &mut dyn FnMut()) {
    work();
}

/// Instructions of every block that the child measures, with the lines that the child printed: a block each.
pub fn count(folder: &Path) -> Result<Vec<(String, u64)>, String> {
    let own = std::env::current_exe().map_err(|e| format!("this binary's own path: {e}"))?;
    let out = folder.join("profile");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--collect-atstart=no", "--quiet"])
        .args([format!("--toggle-collect={MEASURED}"), format!("--dump-after={MEASURED}")])
        .arg(format!("--callgrind-out-file={}", out.display()))
        .args([own.as_os_str(), OsStr::new(CHILD)])
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("valgrind could not be started ({e}); install it, e.g. apt-get install valgrind"))?;
    if !output.status.success() {
        return Err(format!("the measured binary ended with {}", output.status));
    }
    let name = own.file_name().and_then(OsStr::to_str).unwrap_or_default();
    let lines = String::from_utf8_lossy(&output.stdout);
    let block = |(k, line): (usize, &str)| {
        let profile = folder.join(format!("profile.{}", k + 1));
        let text = std::fs::read_to_string(&profile).map_err(|e| format!("{}: {e}", profile.display()))?;
        Ok((line.to_owned(), sum_of_object(&text, name)))
    };
    lines.lines().enumerate().map(block).collect()
}

/// Sum of the costs in a callgrind profile that belong to the object file of that name.
///
/// A line `ob=(7) /path` opens an object and names it, `ob=(7)` opens it again; a line that begins with a position gives a
/// cost, but for the one after `calls=`, which repeats what the callee cost.
pub fn sum_of_object(profile: &str, name: &str) -> u64 {
    let (mut own_id, mut is_own, mut is_call, mut sum) = (None, false, false, 0);
    for line in profile.lines() {
        let known = line.strip_prefix("ob=").or_else(|| line.strip_prefix("cob="));
        if let Some((id, path)) = known.and_then(|o| o.split_once(' '))
            && path.rsplit('/').next() == Some(name)
        {
            own_id = Some(id.to_owned());
        }
        if let Some(object) = line.strip_prefix("ob=") {
            is_own = own_id.is_some() && object.split(' ').next() == own_id.as_deref();
        } else if line.starts_with("calls=") {
            is_call = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit() || "+-*".contains(c)) {
            let cost: u64 = line.split(' ').nth(1).and_then(|c| c.parse().ok()).unwrap_or(0);
            sum += if is_own && !is_call { cost } else { 0 };
            is_call = false;
        }
    }
    sum
}

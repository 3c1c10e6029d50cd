//! How many runs a second, what a second thread gives, what the campaign costs beside its simulations, and how much memory it takes.
//!
//! Not statistics of microseconds but whole commands: `cargo bench --bench campaign [RUNS]`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Scenarios that are timed.
const SCENARIOS: [&str; 2] = ["probe-drogue", "tumbling-capture"];

/// What a command took.
#[derive(Clone, Copy, Debug, Default)]
struct Taken {
    wall_s: f64,
    cpu_s: f64,
    peak_mib: f64,
}

fn main() {
    let runs = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(100_u64);
    println!(
        "{:<18} {:>6} {:>8} {:>9} {:>8} {:>8} {:>8}",
        "scenario", "runs", "threads", "runs/s", "CPU, s", "wall, s", "MiB"
    );
    for scenario in SCENARIOS {
        let one = campaign(scenario, runs, 1);
        let two = campaign(scenario, runs, 2);
        let ten = campaign(scenario, runs / 10, 2);
        for (taken, runs, threads) in [(one, runs, 1), (two, runs, 2), (ten, runs / 10, 2)] {
            println!(
                "{scenario:<18} {runs:>6} {threads:>8} {:>9.2} {:>8.1} {:>8.1} {:>8.1}",
                runs as f64 / taken.wall_s,
                taken.cpu_s,
                taken.wall_s,
                taken.peak_mib
            );
        }
        println!(
            "{scenario:<18} speed-up of two threads {:.2}; their CPU time over that of one {:.3}; memory of {runs} runs over that of {} {:.3}",
            one.wall_s / two.wall_s,
            two.cpu_s / one.cpu_s,
            runs / 10,
            two.peak_mib / ten.peak_mib
        );
    }
    // Runs that simulate next to nothing: what is left is the campaign's own.
    let [few, many] = [200, 2200].map(|runs| campaign("probe-drogue --set duration_s=0.001", runs, 1));
    println!("a run without simulation, building included: {:.3} ms", 1e3 * (many.wall_s - few.wall_s) / 2000.0);
}

/// Runs a campaign in a folder of its own and watches it.
fn campaign(scenario: &str, runs: u64, threads: u64) -> Taken {
    let home = tempfile::tempdir().unwrap();
    let mut words = scenario.split(' ');
    let file = format!("scenarios/{}.toml", words.next().unwrap());
    let started = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_softdock"))
        .args([
            "campaign",
            &file,
            "--quiet",
            "--no-rrd",
            "--runs",
            &runs.to_string(),
            "--threads",
            &threads.to_string(),
        ])
        .args(words)
        .arg("--out")
        .arg(home.path().join("out"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut taken = Taken::default();
    let of_process = |name: &str| fs::read_to_string(format!("/proc/{}/{name}", child.id())).unwrap_or_default();
    let (status, stat) = (|| of_process("status"), || of_process("stat"));
    loop {
        taken.peak_mib = taken.peak_mib.max(peak_mib(&status()));
        taken.cpu_s = taken.cpu_s.max(cpu_s(&stat()));
        if is_over(&stat()) {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    taken.wall_s = started.elapsed().as_secs_f64();
    child.wait().unwrap();
    taken
}

/// Whether a process is gone or waits to be collected.
fn is_over(stat: &str) -> bool {
    stat.rsplit(')').next().is_none_or(|rest| rest.trim_start().starts_with('Z') || rest.is_empty())
}

fn peak_mib(status: &str) -> f64 {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok()).map_or(0.0, |kib| kib / 1024.0)
}

/// User and system time of a process: fields 14 and 15 of its stat, in hundredths of a second.
fn cpu_s(stat: &str) -> f64 {
    let rest = stat.rsplit(')').next().unwrap_or_default();
    let field = |k: usize| rest.split_whitespace().nth(k - 3).and_then(|x| x.parse::<f64>().ok()).unwrap_or(0.0);
    (field(14) + field(15)) / 100.0
}

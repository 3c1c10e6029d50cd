//! `softdock campaign FILE`: thousands of dispersed runs of a scenario, in parallel, resumable.

use crate::{STOPPED, Status, campaign_report};
use indicatif::{ProgressBar, ProgressStyle};
use softdock::campaign::{self, Folder, Plan, Row, Shard, Summary, Watch};
use softdock::scenario;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Arguments of `softdock campaign`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// The scenario, with its [campaign]
    file: PathBuf,
    /// Other dispersions of the scenario, by the name of the campaign's variant
    #[arg(long)]
    variant: Option<String>,
    /// How many runs, instead of the scenario's
    #[arg(long)]
    runs: Option<u32>,
    /// Folder for table.parquet, the report and the recordings [default: out/campaign/NAME]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Override a key of the scenario in every run (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Seed of the campaign, instead of the scenario's
    #[arg(long)]
    seed: Option<u64>,
    /// Threads [default: as many as the machine, or the scheduler, gives]
    #[arg(long)]
    threads: Option<usize>,
    /// Make only shard i of n, counted from 0; a SLURM array or a Kubernetes indexed job says so by itself
    #[arg(long, value_name = "I/N")]
    shard: Option<Shard>,
    /// Go on with a campaign that was interrupted (or begin it)
    #[arg(long)]
    resume: bool,
    /// List the runs with what they would draw, and make none
    #[arg(long)]
    dry_run: bool,
    /// Print a job script for a scheduler instead of running
    #[arg(long, value_name = "SCHEDULER", requires = "shards")]
    emit: Option<crate::emit::Scheduler>,
    /// How many shards the job script has
    #[arg(long, value_name = "N")]
    shards: Option<u64>,
    /// Container image of the Kubernetes manifest
    #[arg(long, default_value = "softdock:latest")]
    image: String,
    /// Volume claim of the Kubernetes manifest
    #[arg(long, default_value = "campaign")]
    claim: String,
    /// The two inputs of the capture-envelope map, by the names of their columns [default: those that matter most]
    #[arg(long, num_args = 2, value_names = ["ACROSS", "UP"])]
    map: Option<Vec<String>>,
    /// No recordings of notable runs
    #[arg(long)]
    no_rrd: bool,
    /// No progress and no summary
    #[arg(long, short)]
    quiet: bool,
}

/// Runs, or lists, or writes the job script.
pub(crate) fn main(arguments: &Arguments) -> anyhow::Result<Status> {
    let mut overrides = arguments.set.clone();
    overrides.extend(arguments.seed.map(|seed| format!("seed={seed}")));
    let plan = Plan::new(scenario::load(&arguments.file, &overrides)?, arguments.variant.as_deref(), arguments.runs)?;
    let out = arguments.out.clone().unwrap_or_else(|| PathBuf::from("out/campaign").join(name_of(&plan)));
    if let (Some(scheduler), Some(shards)) = (arguments.emit, arguments.shards) {
        print!("{}", crate::emit::script(scheduler, &job(arguments, &plan, &out, shards))?);
        return Ok(Status::AsExpected);
    }
    let shard = match arguments.shard {
        Some(shard) => Some(shard),
        None => Shard::from_scheduler(|name| std::env::var(name).ok())?,
    };
    if arguments.dry_run {
        list(&plan, shard.unwrap_or(Shard::WHOLE));
        return Ok(Status::AsExpected);
    }
    let target = shard.map_or_else(|| out.clone(), |shard| out.join(format!("shard-{shard}")));
    stop_when_asked();
    let mut folder = Folder::open(&target, &plan, shard.unwrap_or(Shard::WHOLE), arguments.resume)?;
    let progress = Progress::new(arguments.quiet);
    let threads = threads(arguments.threads);
    let summary = campaign::execute(&plan, &mut folder, (shard.unwrap_or(Shard::WHOLE), threads), &progress)?;
    progress.bar.finish_and_clear();
    if summary.is_cut_short {
        let own = shard.unwrap_or(Shard::WHOLE);
        let (done, all) = (summary.done, (0..plan.runs()).filter(|run| own.has(*run)).count());
        eprintln!("stopped after {done} of {all} runs, which {} keeps; go on with --resume", target.display());
        return Ok(Status::Stopped);
    }
    conclude(arguments, (&plan, &target, shard), &summary, threads)
}

/// Whether somebody has pressed Ctrl-C, or a scheduler wants its machine back.
static IS_CANCELLED: AtomicBool = AtomicBool::new(false);

/// The first signal lets the runs that are on come to their ends, the second ends the command at once; finished runs are kept either way.
fn stop_when_asked() {
    let stop = || {
        if IS_CANCELLED.swap(true, Ordering::Relaxed) {
            std::process::exit(STOPPED.into());
        }
        eprintln!("\nstopping after the runs that are on; once more to stop at once");
    };
    // Where no handler can be set a signal ends the command at once, as it always may.
    ctrlc::set_handler(stop).ok();
}

/// Name of the default folder.
fn name_of(plan: &Plan) -> String {
    let variant = plan.variant.as_ref().map(|v| format!("-{v}")).unwrap_or_default();
    format!("{}{variant}", plan.header.scenario)
}

fn job<'a>(arguments: &'a Arguments, plan: &'a Plan, out: &'a Path, shards: u64) -> crate::emit::Job<'a> {
    crate::emit::Job {
        plan,
        file: &arguments.file,
        out,
        set: &arguments.set,
        seed: arguments.seed,
        variant: arguments.variant.as_deref(),
        shards,
        threads: arguments.threads,
        image: &arguments.image,
        claim: &arguments.claim,
    }
}

/// What a person sees, and the status: 4 where runs have no result, 1 where it is not as expected.
fn conclude(
    arguments: &Arguments,
    (plan, target, shard): (&Plan, &Path, Option<Shard>),
    summary: &Summary,
    threads: usize,
) -> anyhow::Result<Status> {
    if !arguments.quiet {
        println!("{}", speed(plan, summary, threads));
    }
    // A shard knows a part only: its table is for the merge, and it fails only where runs have no result.
    let demands = if shard.is_none() { finish(arguments, plan, target)? } else { Vec::new() };
    if !arguments.quiet {
        println!("The results are in {}", target.display());
    }
    let is_met = match (shard, demands.is_empty()) {
        (Some(_), _) => true,
        (None, true) => summary.unexpected == 0,
        (None, false) => demands.iter().all(|d| d.met),
    };
    Ok(match (summary.failed, is_met) {
        (0, true) => Status::AsExpected,
        (0, false) => Status::NotAsExpected,
        _ => Status::Diverged,
    })
}

/// Report, recordings and demands of a whole campaign.
fn finish(arguments: &Arguments, plan: &Plan, target: &Path) -> anyhow::Result<Vec<campaign::Demand>> {
    let table = campaign::read_table(target)?;
    let map = arguments.map.as_ref().and_then(|m| Some((m.first()?.clone(), m.get(1)?.clone())));
    let findings = campaign_report::find(&table, map);
    if cfg!(feature = "rerun") && !arguments.no_rrd {
        campaign_report::record_notable(plan, target, &findings, arguments.quiet)?;
    }
    campaign_report::write(target, &table, &findings)?;
    let demands = campaign::check_demands(&plan.campaign.expects, &table);
    if !arguments.quiet {
        println!("\n{}\n", findings.verdict);
        for outcome in &findings.outcomes {
            println!("  {:<12} {:>6}", outcome.outcome, outcome.rate.count);
        }
        println!();
        demands
            .iter()
            .for_each(|d| println!("  {} {}", if d.met { "as expected:" } else { "NOT AS EXPECTED:" }, d.text));
    }
    Ok(demands)
}

/// Rate, share of the threads that simulates, and what each run costs beside its simulation.
fn speed(plan: &Plan, summary: &Summary, threads: usize) -> String {
    let wall = summary.wall_s.max(f64::MIN_POSITIVE);
    format!(
        "{} runs of {}: {} made now in {:.1} s on {threads} threads: {:.1} runs/s, speed-up {:.2}; {:.1} ms of building a run",
        summary.done,
        plan.header.scenario,
        summary.made,
        summary.wall_s,
        summary.made as f64 / wall,
        summary.runs_s / wall,
        1e3 * summary.building_s / summary.made.max(1) as f64,
    )
}

/// As many threads as were asked for, as the scheduler gives, or as the machine has.
pub(crate) fn threads(asked: Option<usize>) -> usize {
    let scheduled = || std::env::var("SLURM_CPUS_PER_TASK").ok().and_then(|text| text.parse().ok());
    let machine = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.or_else(scheduled).unwrap_or_else(machine).max(1)
}

/// The runs that would be made.
fn list(plan: &Plan, shard: Shard) {
    let names: Vec<&str> = plan.header.inputs.iter().map(|i| i.name.as_str()).collect();
    println!("run\t{}", names.join("\t"));
    for run in (0..plan.runs()).filter(|run| shard.has(*run)) {
        let values: Vec<String> = plan.design.draw(run).iter().map(|x| format!("{x:.6}")).collect();
        println!("{run}\t{}", values.join("\t"));
    }
    println!("\n{} runs; {}", plan.runs(), plan.header.sampling);
    for input in &plan.header.inputs {
        println!("  {} = {}: {}; read back from the {}", input.name, input.path, input.distribution, input.read_from);
    }
}

/// Rate, remaining time and tally, as the runs end.
pub(crate) struct Progress {
    pub(crate) bar: ProgressBar,
    tally: Mutex<BTreeMap<String, usize>>,
}

impl Progress {
    pub(crate) fn new(quiet: bool) -> Self {
        let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(1) };
        let template = "{pos:>6}/{len} {wide_bar} {per_sec} left {eta}  {msg}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self { bar, tally: Mutex::new(BTreeMap::new()) }
    }
}

impl Watch for Progress {
    fn is_cancelled(&self) -> bool {
        IS_CANCELLED.load(Ordering::Relaxed)
    }

    fn begin(&self, done: usize, missing: usize) {
        self.bar.set_length((done + missing) as u64);
        self.bar.set_position(done as u64);
        self.bar.reset_eta();
    }

    fn finished(&self, row: &Row) {
        if let Ok(mut tally) = self.tally.lock() {
            *tally.entry(row.outcome.clone()).or_default() += 1;
            let words: Vec<String> = tally.iter().map(|(outcome, n)| format!("{outcome} {n}")).collect();
            self.bar.set_message(words.join(", "));
        }
        self.bar.inc(1);
    }
}

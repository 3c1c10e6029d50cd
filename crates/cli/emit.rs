//! Job scripts for schedulers: a SLURM array, a Kubernetes indexed job.

use softdock::campaign::Plan;
use std::path::Path;

/// The schedulers that a script can be written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Scheduler {
    /// An sbatch script with a job array.
    Slurm,
    /// A Job manifest with indexed completions.
    K8s,
}

/// What the script is to run.
pub(crate) struct Job<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) file: &'a Path,
    pub(crate) out: &'a Path,
    pub(crate) set: &'a [String],
    pub(crate) seed: Option<u64>,
    pub(crate) variant: Option<&'a str>,
    pub(crate) shards: u64,
    pub(crate) threads: Option<usize>,
    /// Image with `softdock` in it, and the claim of the results' volume, for Kubernetes.
    pub(crate) image: &'a str,
    pub(crate) claim: &'a str,
}

/// Memory of a job, MB: ten times what a campaign takes.
const MEMORY_MB: u64 = 1024;
/// Threads of a shard, where none are asked for.
const THREADS: usize = 4;

const SBATCH: &str = include_str!("emit/slurm.sbatch.template");
const MANIFEST: &str = include_str!("emit/job.yaml.template");

/// The script, ready to be submitted.
pub(crate) fn script(scheduler: Scheduler, job: &Job<'_>) -> anyhow::Result<String> {
    let (template, quote): (&str, fn(&str) -> String) = match scheduler {
        Scheduler::Slurm => (SBATCH, shell_quoted),
        Scheduler::K8s => (MANIFEST, yaml_quoted),
    };
    let (file, out) = match scheduler {
        // A batch job starts in the folder of its submission; a container's folders are not those of this machine.
        Scheduler::Slurm => (std::path::absolute(job.file)?, std::path::absolute(job.out)?),
        Scheduler::K8s => (job.file.to_owned(), job.out.to_owned()),
    };
    let program = match scheduler {
        Scheduler::Slurm => std::env::current_exe()?.display().to_string(),
        Scheduler::K8s => "softdock".to_owned(),
    };
    let last = job.shards.saturating_sub(1);
    let values = [
        ("{name}", label(&job.plan.header.scenario)),
        ("{runs}", job.plan.runs().to_string()),
        ("{shards}", job.shards.to_string()),
        ("{last}", last.to_string()),
        ("{threads}", job.threads.unwrap_or(THREADS).to_string()),
        ("{memory_mb}", MEMORY_MB.to_string()),
        ("{softdock}", quote(&program)),
        ("{file}", quote(&file.display().to_string())),
        ("{out}", quote(&out.display().to_string())),
        ("{image}", quote(job.image)),
        ("{claim}", quote(job.claim)),
        ("{options}", options(job, scheduler, quote)),
    ];
    Ok(filled(template, &values))
}

/// The template with its places filled, in one pass: a value that looks like a place stays as it is.
fn filled(template: &str, values: &[(&str, String)]) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some(at) = rest.find('{') {
        text += &rest[..at];
        rest = &rest[at..];
        let found = values.iter().find(|(place, _)| rest.starts_with(place));
        let (value, length) = found.map_or(("{", 1), |(place, value)| (value.as_str(), place.len()));
        text += value;
        rest = &rest[length..];
    }
    text + rest
}

/// What else the campaign was given: it belongs to every shard.
fn options(job: &Job<'_>, scheduler: Scheduler, quote: fn(&str) -> String) -> String {
    let mut words: Vec<String> = Vec::new();
    for set in job.set {
        words.extend(["--set".to_owned(), set.clone()]);
    }
    if let Some(seed) = job.seed {
        words.extend(["--seed".to_owned(), seed.to_string()]);
    }
    if let Some(variant) = job.variant {
        words.extend(["--variant".to_owned(), variant.to_owned()]);
    }
    let quoted = words.iter().map(|word| quote(word));
    match scheduler {
        Scheduler::Slurm => quoted.map(|word| format!(" {word}")).collect(),
        Scheduler::K8s => quoted.map(|word| format!("\n            - {word}")).collect(),
    }
}

/// A name that schedulers take: letters, digits and hyphens.
fn label(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let label: String = name.chars().map(plain).take(50).collect();
    format!("softdock-{}", label.trim_matches('-'))
}

fn shell_quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}

/// A JSON string is a YAML string; a container's arguments expand `$(…)`, and `$$` is a plain dollar.
fn yaml_quoted(text: &str) -> String {
    serde_json::Value::from(text.replace('$', "$$")).to_string()
}

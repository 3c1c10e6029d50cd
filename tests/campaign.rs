//! Campaigns as a user meets them: the same table however it came about, nothing lost, and what is wrong is said.
#![allow(clippy::unwrap_used)]

use softdock::campaign::table::Cells;
use softdock::campaign::{read_identity, read_table};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A scenario whose runs take a few hundredths of a second.
const QUICK: [&str; 5] = ["campaign", "scenarios/probe-drogue.toml", "--set", "duration_s=2.5", "--no-rrd"];

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_softdock"));
    command.args(arguments).current_dir(env!("CARGO_MANIFEST_DIR"));
    // A test that runs under a scheduler is no part of its array.
    for name in ["SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX", "SLURM_CPUS_PER_TASK"] {
        command.env_remove(name);
    }
    command
}

fn softdock(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn quick(out: &Path, more: &[&str]) -> Output {
    softdock(&[&QUICK[..], &["--quiet", "--out", text(out)], more].concat())
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn error_of(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn table(folder: &Path) -> Vec<u8> {
    fs::read(folder.join("table.parquet")).unwrap_or_else(|e| panic!("{}: {e}", folder.display()))
}

/// A folder in the test's own temporary one.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
}

#[test]
fn one_thread_two_threads_and_five_shards_give_the_same_bytes() {
    let home = Home::new();
    let runs = ["--runs", "60"];
    quick(&home.at("one"), &[&runs[..], &["--threads", "1"]].concat());
    quick(&home.at("two"), &[&runs[..], &["--threads", "2"]].concat());
    let mut shards = Vec::new();
    for i in [3, 0, 4, 2, 1] {
        let shard = format!("{i}/5");
        quick(&home.at("parts"), &[&runs[..], &["--shard", &shard]].concat());
        shards.push(text(&home.at(&format!("parts/shard-{i}-of-5"))).to_owned());
    }
    let merge = |shards: &[String], out: &str| {
        let shards: Vec<&str> = shards.iter().map(String::as_str).collect();
        softdock(&[&["merge"], &shards[..], &["--runs", "60", "--out", text(&home.at(out))]].concat())
    };
    assert_eq!(merge(&shards, "merged").status.code(), Some(0));
    assert_eq!(table(&home.at("one")), table(&home.at("two")), "threads");
    assert_eq!(table(&home.at("one")), table(&home.at("merged")), "shards");

    let partly = merge(&shards[..4], "partly");
    assert_eq!(partly.status.code(), Some(1));
    let said = String::from_utf8_lossy(&partly.stdout).into_owned();
    assert!(said.contains("12 runs are missing: 1, 6, 11"), "{said}");
}

#[test]
fn a_campaign_that_is_killed_ten_times_loses_nothing() {
    let home = Home::new();
    let (whole, killed) = (home.at("whole"), home.at("killed"));
    let arguments = [&QUICK[..], &["--runs", "150", "--threads", "2", "--resume", "--quiet"]].concat();
    assert!(command(&[&arguments[..], &["--out", text(&whole)]].concat()).status().unwrap().code().is_some());
    let lines = || fs::read(killed.join("runs.jsonl")).map_or(0, |b| b.iter().filter(|b| **b == b'\n').count());
    for _ in 0..10 {
        let before = lines();
        let mut child =
            command(&[&arguments[..], &["--out", text(&killed)]].concat()).stdout(Stdio::null()).spawn().unwrap();
        let patience = Instant::now();
        while lines() < before + 4 && patience.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(3));
        }
        child.kill().unwrap(); // SIGKILL
        child.wait().unwrap();
        assert!(lines() >= before + 4, "runs were lost, or none was made");
        assert!(!killed.join("table.parquet").exists(), "a table of half a campaign looks whole");
    }
    assert!(lines() < 150, "it was over before it could be killed ten times");
    command(&[&arguments[..], &["--out", text(&killed)]].concat()).status().unwrap();
    assert_eq!(table(&whole), table(&killed));
}

#[test]
fn runs_whose_controller_sees_through_sensors_are_the_same_on_any_threads_and_after_a_kill() {
    let home = Home::new();
    let camera = ["campaign", "scenarios/tumbling-capture-camera.toml", "--set", "duration_s=8.0", "--runs", "12"];
    let with =
        |out: &str, more: &[&str]| command(&[&camera[..], &["--out", text(&home.at(out)), "--quiet"], more].concat());
    for (out, threads) in [("one", "1"), ("two", "2")] {
        with(out, &["--threads", threads]).status().unwrap();
    }
    let lines =
        || fs::read(home.at("killed").join("runs.jsonl")).map_or(0, |b| b.iter().filter(|b| **b == b'\n').count());
    let mut child = with("killed", &["--threads", "1", "--resume"]).stdout(Stdio::null()).spawn().unwrap();
    let patience = Instant::now();
    while lines() < 4 && patience.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(3));
    }
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    assert!((4..12).contains(&lines()), "{} runs", lines());
    with("killed", &["--resume"]).status().unwrap();
    assert_eq!(table(&home.at("one")), table(&home.at("two")), "threads");
    assert_eq!(table(&home.at("one")), table(&home.at("killed")), "a kill");
}

#[test]
fn ctrl_c_stops_after_the_runs_that_are_on_and_says_how_to_go_on() {
    let home = Home::new();
    let (whole, stopped) = (home.at("whole"), home.at("stopped"));
    let arguments = [&QUICK[..], &["--runs", "150", "--threads", "2", "--resume", "--quiet"]].concat();
    let mut child = command(&[&arguments[..], &["--out", text(&stopped)]].concat())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let patience = Instant::now();
    let has_begun = || fs::read(stopped.join("runs.jsonl")).is_ok_and(|bytes| bytes.contains(&b'\n'));
    while !has_begun() && patience.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(3));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().unwrap(), &mut said).unwrap();
    assert!(said.contains("of 150 runs, which") && said.contains("go on with --resume"), "{said}");
    assert!(!stopped.join("table.parquet").exists(), "a table of half a campaign looks whole");
    for folder in [&whole, &stopped] {
        assert!(command(&[&arguments[..], &["--out", text(folder)]].concat()).status().unwrap().code().is_some());
    }
    assert_eq!(table(&whole), table(&stopped));
}

#[test]
fn longer_campaigns_draw_the_same_first_runs_and_what_is_drawn_is_applied() {
    let home = Home::new();
    quick(&home.at("short"), &["--runs", "10"]);
    quick(&home.at("long"), &["--runs", "25"]);
    let (short, long) = (read_table(&home.at("short")).unwrap(), read_table(&home.at("long")).unwrap());
    assert_eq!(short.header, long.header);
    assert_eq!(short.header.inputs.len(), 11);
    for input in &short.header.inputs {
        let column = |table: &softdock::campaign::table::Table, prefix: &str| -> Vec<f64> {
            table.numbers(&format!("{prefix}.{}", input.name)).unwrap().into_iter().map(Option::unwrap).collect()
        };
        assert_eq!(column(&short, "input")[..], column(&long, "input")[..10], "{}", input.name);
        assert_eq!(input.read_from, "built model", "{}", input.name);
        for (drawn, applied) in column(&long, "input").into_iter().zip(column(&long, "applied")) {
            // Degrees to radians and back, and a few rotations, at values of order one.
            assert!((drawn - applied).abs() < 1e-12, "{}: drawn {drawn}, applied {applied}", input.name);
        }
    }
}

#[test]
fn any_run_is_made_again_to_the_bit() {
    let home = Home::new();
    let out = home.at("campaign");
    softdock(&[
        "campaign",
        "scenarios/tumbling-capture.toml",
        "--set",
        "duration_s=14.0",
        "--runs",
        "3",
        "--no-rrd",
        "-q",
        "--out",
        text(&out),
    ]);
    let again = softdock(&["replay", text(&out.join("table.parquet")), "2", "--out", text(&home.at("again"))]);
    let said = String::from_utf8_lossy(&again.stdout).into_owned();
    assert_eq!(again.status.code(), Some(0), "{said}{}", error_of(&again));
    assert!(said.contains("identical to the table, bit for bit"), "{said}");
    assert!(home.at("again").join("signals.parquet").exists());

    let absent = softdock(&["replay", text(&out), "3", "--out", text(&home.at("none"))]);
    assert_eq!(absent.status.code(), Some(3));
    assert!(error_of(&absent).contains("has no run 3; it has 3 runs from 0 to 2"), "{}", error_of(&absent));

    let other = softdock(&[
        "replay",
        text(&out),
        "2",
        "--scenario",
        "scenarios/tumbling-capture.toml",
        "--out",
        text(&home.at("other")),
    ]);
    assert!(error_of(&other).contains("was made of another scenario"), "{}", error_of(&other));
}

#[test]
fn a_run_without_a_result_makes_the_status_4_and_stands_in_the_table() {
    let home = Home::new();
    let file = scenario_with(&home, "[[campaign.disperse]]\npath = \"integrator.step_s\"\ngrid = [1e-3, 2.0]\n");
    let out = home.at("out");
    let output = softdock(&["campaign", text(&file), "--runs", "4", "--out", text(&out), "--no-rrd", "-q"]);
    assert_eq!(output.status.code(), Some(4), "{}", error_of(&output));
    let table = read_table(&out).unwrap();
    let outcomes: Vec<&str> = (0..4).map(|row| table.text("outcome", row)).collect();
    assert_eq!(outcomes, ["completed", "unbuildable", "completed", "unbuildable"]);
    assert!(table.text("reason", 1).contains("step_s"), "{}", table.text("reason", 1));
}

/// A small scenario of one's own with a campaign.
fn scenario_with(home: &Home, campaign: &str) -> PathBuf {
    let urdf = Path::new(env!("CARGO_MANIFEST_DIR")).join("robots/tumbler/tumbler.urdf");
    let file = home.at("own.toml");
    let text = format!(
        "name = \"own\"\nseed = 4\nduration_s = 0.05\n[[vehicle]]\nname = \"body\"\nurdf = \"{}\"\n\
         [campaign]\nruns = 4\n{campaign}",
        urdf.display()
    );
    fs::write(&file, text).unwrap();
    file
}

#[test]
fn nonsense_is_refused_with_its_place_and_a_way_out() {
    let home = Home::new();
    let entry = |body: &str| format!("[[campaign.disperse]]\n{body}\n");
    let twice = entry("path = \"duration_s\"\nnormal = { sigma = 0.1 }").repeat(2);
    let cases: [(String, &str); 9] = [
        (
            entry("path = \"vehicle.nobody.twist.linear_m_per_s[0]\"\nnormal = { sigma = 0.1 }"),
            "none is named \"nobody\"",
        ),
        (entry("path = \"vehicle.body.twist.linear_m_per_s[7]\"\nnormal = { sigma = 0.1 }"), "own.toml:"),
        (entry("path = \"vehicle.body.twist.linear_m_per_s[0]\"\nnormal = { sigma = -0.1 }"), "sigma"),
        (
            entry("path = \"vehicle.body.twist.linear_m_per_s[0]\"\nuniform = { low = 2.0, high = 1.0 }"),
            "must not exceed",
        ),
        (entry("path = \"vehicle.body.urdf\"\nnormal = { sigma = 0.1 }"), "only numbers can be dispersed"),
        (twice, "is dispersed by two entries"),
        (
            entry("paths = [\"duration_s\", \"integrator.step_s\"]\nnormal = { sigma = 0.1 }"),
            "`ball` and `directions` take `paths`",
        ),
        (
            entry("path = \"duration_s\"\nname = \"d\"\nuniform = { low = 1.0, high = 2.0 }")
                + "[[campaign.correlate]]\nbetween = [\"d\", \"e\"]\nrho = 0.5\n",
            "\"e\": no dispersion has this name or path",
        ),
        (
            entry("path = \"vehicle.body.pose.position_m[0]\"\nchoice = [0.0]\nnormal = { sigma = 1.0 }"),
            "exclude each other",
        ),
    ];
    for (campaign, message) in cases {
        let file = scenario_with(&home, &campaign);
        let output = softdock(&["campaign", text(&file), "--out", text(&home.at("out")), "-q"]);
        let error = error_of(&output);
        assert_eq!(output.status.code(), Some(3), "{campaign}{error}");
        assert!(error.contains(message), "{campaign}\n{error}");
        assert!(!home.at("out").exists(), "{campaign}: something was written");
    }
}

#[test]
fn dispersing_what_nothing_hears_is_refused() {
    let home = Home::new();
    // A later rule for the same pair decides: nothing reads the first one's friction.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scenario = fs::read_to_string(root.join("scenarios/probe-drogue.toml")).unwrap();
    let later =
        "[[contact]]\nbetween = [\"servicer/head\", \"client/drogue\"]\nfriction = { law = \"none\" }\n[docking]\n";
    let body = scenario.split("[campaign]").next().unwrap();
    let body = body.replace("../robots", text(&root.join("robots"))).replace("[docking]\n", later);
    let campaign = "[campaign]\nruns = 3\n[[campaign.disperse]]\npath = \"contact[0].friction.mu\"\nuniform = { low = 0.1, high = 0.2 }\n";
    let file = home.at("unheard.toml");
    fs::write(&file, body.to_owned() + campaign).unwrap();
    let output = softdock(&["campaign", text(&file), "--out", text(&home.at("out")), "-q"]);
    let error = error_of(&output);
    assert_eq!(output.status.code(), Some(3), "{error}");
    assert!(error.contains("nothing in the built model changes with `contact[0].friction.mu`"), "{error}");
}

#[test]
fn folders_of_others_are_left_alone() {
    let home = Home::new();
    let out = home.at("out");
    quick(&out, &["--runs", "3"]);
    let before = table(&out);

    let again = quick(&out, &["--runs", "3"]);
    assert!(
        error_of(&again).contains("holds a campaign with 3 of 3 runs; continue it with --resume"),
        "{}",
        error_of(&again)
    );
    let changed = quick(&out, &["--runs", "3", "--resume", "--set", "contact[0].friction.mu=0.2"]);
    assert!(error_of(&changed).contains("holds another campaign"), "{}", error_of(&changed));
    let other = softdock(&[
        "campaign",
        "scenarios/tumbling-capture.toml",
        "--runs",
        "1",
        "--resume",
        "--out",
        text(&out),
        "-q",
    ]);
    assert!(error_of(&other).contains("of \"probe-drogue\", not \"tumbling-capture\""), "{}", error_of(&other));
    assert_eq!(table(&out), before);
    assert_eq!(read_identity(&out).unwrap().unwrap().runs, 3);

    let foreign = home.at("foreign");
    fs::create_dir(&foreign).unwrap();
    fs::write(foreign.join("thesis.tex"), "mine").unwrap();
    let refused = quick(&foreign, &["--runs", "1", "--resume"]);
    assert!(error_of(&refused).contains("holds \"thesis.tex\" and no campaign"), "{}", error_of(&refused));
    assert_eq!(fs::read_dir(&foreign).unwrap().count(), 1);
}

#[test]
#[cfg(target_os = "linux")]
fn a_disk_that_fills_up_in_mid_campaign_loses_no_finished_run() {
    let home = Home::new();
    let disk = home.at("disk");
    fs::create_dir(&disk).unwrap();
    let mount =
        |options: &str| Command::new("mount").args(["-t", "tmpfs", "-o", options, "tmpfs", text(&disk)]).output();
    if !mount("size=64k").is_ok_and(|o| o.status.success()) {
        eprintln!("SKIPPED: no right to mount a small disk here");
        return;
    }
    let out = disk.join("out");
    let full = quick(&out, &["--runs", "60", "--threads", "1"]);
    let kept = fs::read_to_string(out.join("runs.jsonl")).unwrap().lines().count();
    let grown = mount("remount,size=16m").is_ok_and(|o| o.status.success());
    let resumed = quick(&out, &["--runs", "60", "--resume"]);
    let tables =
        (fs::read(out.join("table.parquet")), quick(&home.at("whole"), &["--runs", "60"]), table(&home.at("whole")));
    Command::new("umount").arg(&disk).output().unwrap();
    assert_eq!(full.status.code(), Some(3));
    let error = error_of(&full);
    assert!(error.contains("runs.jsonl") && error.contains("free some space and go on with --resume"), "{error}");
    assert!((5..60).contains(&kept), "{kept} runs were kept");
    assert!(grown && resumed.status.code() != Some(3), "{}", error_of(&resumed));
    assert_eq!(tables.0.unwrap(), tables.2);
}

#[test]
fn dry_run_lists_the_runs_and_writes_nothing() {
    let home = Home::new();
    let output = softdock(&[
        "campaign",
        "scenarios/probe-drogue.toml",
        "--variant",
        "corners",
        "--dry-run",
        "--out",
        text(&home.at("out")),
    ]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(said.lines().take_while(|l| !l.is_empty()).count(), 1 + 2048);
    assert!(said.contains("2048 combinations") && !home.at("out").exists(), "{said}");
    // A corner is one: the vector sums have their whole length in it, and no corner is listed twice.
    let mut rows: Vec<Vec<f64>> = said
        .lines()
        .skip(1)
        .take(2048)
        .map(|line| line.split('\t').skip(1).map(|x| x.parse().unwrap()).collect())
        .collect();
    assert!(rows.iter().all(|r| (r[5].hypot(r[6]) - 0.2).abs() < 1e-5 && (r[7].hypot(r[8]) - 4.0).abs() < 1e-5));
    rows.sort_by(|a, b| a.partial_cmp(b).unwrap());
    rows.dedup();
    assert_eq!(rows.len(), 2048);
}

#[test]
fn job_scripts_name_the_scenario_and_every_shard() {
    let emit = |scheduler: &str| {
        let output = softdock(&[
            "campaign",
            "scenarios/probe-drogue.toml",
            "--runs",
            "50",
            "--emit",
            scheduler,
            "--shards",
            "5",
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let (slurm, k8s) = (emit("slurm"), emit("k8s"));
    assert!(
        slurm.contains("#SBATCH --array=0-4") && slurm.contains("--runs 50") && slurm.contains("/5\" --resume"),
        "{slurm}"
    );
    assert!(k8s.contains("completionMode: Indexed") && k8s.contains("completions: 5"), "{k8s}");
    assert!(!slurm.contains("{softdock}") && !k8s.contains("{image}"));
}

#[test]
fn comparison_pairs_the_runs_and_says_which_is_better() {
    let home = Home::new();
    let out = home.at("compare");
    let output = softdock(&[
        "compare",
        "scenarios/probe-drogue.toml",
        "scenarios/probe-drogue.toml",
        "--set-a",
        "duration_s=4.0",
        "--set-b",
        "duration_s=4.0",
        "--set-b",
        "contact[0].friction.mu=1.0",
        "--names",
        "lubricated",
        "dry",
        "--runs",
        "40",
        "--quiet",
        "--out",
        text(&out),
    ]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{}", error_of(&output));
    assert!(said.contains("lubricated"), "{said}");
    let comparison: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("comparison.json")).unwrap()).unwrap();
    assert_eq!(comparison["pairs"], 40);
    let rate = |side: &str| comparison["success"][side]["value"].as_f64().unwrap();
    assert!(rate("rate_a") > rate("rate_b") + 0.3, "{said}");

    let other = softdock(&[
        "compare",
        text(&out.join("a")),
        "scenarios/tumbling-capture.toml",
        "--set-b",
        "duration_s=0.1",
        "--runs",
        "40",
        "--quiet",
        "--out",
        text(&home.at("x")),
    ]);
    assert!(other.status.code().is_some());
}

#[test]
fn report_stands_beside_the_table_in_three_forms() {
    let home = Home::new();
    let out = home.at("out");
    quick(&out, &["--runs", "20"]);
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(
        page.contains("<svg") && !page.contains("http://") && !page.contains("https://"),
        "the page needs a network"
    );
    let json: serde_json::Value = serde_json::from_slice(&fs::read(out.join("report.json")).unwrap()).unwrap();
    assert_eq!(json["runs"], 20);
    assert!(fs::read_to_string(out.join("report.md")).unwrap().contains("probe-drogue"));
    let table = read_table(&out).unwrap();
    assert!(matches!(table.column("captured").unwrap().cells, Cells::Flags(_)));
}

//! Excerpts of recordings that are too long to be replayed as a whole: an hour at 1 kHz says in a twelfth of it what a model misses.

use record::{RecordedRun, RecordingSet, Remark, Role, Series, Severity};

/// Instants of a role that are looked at, and of an excerpt.
const ROWS: usize = 300_000;
const EXCERPT: usize = 12_000;

/// A set with excerpts, evenly spread, in the place of the runs of a role that has far more instants than are looked at; none where none has.
pub(crate) fn of(set: &RecordingSet) -> Option<RecordingSet> {
    let rows = |role: Role| set.runs.iter().filter(|r| r.role == role).map(rows).sum::<usize>();
    let is_long = |role: Role| rows(role) > ROWS;
    if ![Role::Fit, Role::Holdout].into_iter().any(is_long) {
        return None;
    }
    let mut some = RecordingSet {
        folder: set.folder.clone(),
        rig: set.rig.clone(),
        title: set.title.clone(),
        window_s: set.window_s,
        noise: set.noise.clone(),
        runs: Vec::new(),
        remarks: set.remarks.clone(),
    };
    for role in [Role::Fit, Role::Holdout] {
        let own = set.runs.iter().filter(|r| r.role == role);
        if !is_long(role) {
            some.runs.extend(own.cloned());
            continue;
        }
        let parts: Vec<(&RecordedRun, [usize; 2])> =
            own.flat_map(|run| parts(run).map(move |part| (run, part))).collect();
        let chosen = evenly(parts.len(), ROWS / EXCERPT);
        let (many, count) = (rows(role), chosen.len());
        let what =
            format!("its {} runs have {many} instants: {count} excerpts, evenly spread, speak for all", role.key());
        some.remarks.push(Remark::new(Severity::Warning, what));
        some.runs.extend(chosen.into_iter().map(|i| excerpt(parts[i].0, parts[i].1)));
    }
    Some(some)
}

/// Indices of `count` of `all` things, evenly spread.
pub(crate) fn evenly(all: usize, count: usize) -> Vec<usize> {
    let count = count.min(all);
    (0..count).map(|i| (2 * i + 1) * all / (2 * count)).collect()
}

/// Instants of a run's densest channel.
fn rows(run: &RecordedRun) -> usize {
    densest(run).map_or(0, Series::len)
}

fn densest(run: &RecordedRun) -> Option<&Series> {
    run.series.iter().max_by_key(|s| s.len())
}

/// The parts of a run, of one length, by the instants of its densest channel.
fn parts(run: &RecordedRun) -> impl Iterator<Item = [usize; 2]> {
    let (rows, count) = (rows(run), rows(run).div_ceil(EXCERPT).max(1));
    (0..count).map(move |i| [i * rows / count, (i + 1) * rows / count])
}

/// A part of a run; its time goes on.
fn excerpt(run: &RecordedRun, [first, end]: [usize; 2]) -> RecordedRun {
    let Some(clock) = densest(run) else { return run.clone() };
    let (from, to) = (clock.times[first], clock.times[end - 1]);
    let within = |s: &Series| {
        let range = s.times.partition_point(|t| *t < from)..s.times.partition_point(|t| *t <= to);
        Series::with_quantum(&s.channel, &s.times[range.clone()], s.values[range].to_vec(), s.quantum())
    };
    RecordedRun {
        file: format!("{} {from:.2}–{to:.2} s", run.file),
        role: run.role,
        note: run.note.clone(),
        series: run.series.iter().map(within).filter(|s| !s.is_empty()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(file: &str, role: Role, rows: usize) -> RecordedRun {
        let times: Vec<f64> = (0..rows).map(|i| i as f64 * 1e-3).collect();
        let slow: Vec<f64> = times.iter().step_by(10).copied().collect();
        let series = vec![
            Series::with_quantum("joint.a.position", times.clone(), times.clone(), 0.0),
            Series::with_quantum("joint.a.velocity", slow.clone(), slow, 0.0),
        ];
        RecordedRun { file: file.to_owned(), role, note: String::new(), series }
    }

    #[test]
    fn what_is_short_stays_as_it_is() {
        let set = RecordingSet { runs: vec![run("a", Role::Fit, 20_000)], ..RecordingSet::default() };
        assert!(of(&set).is_none());
    }

    #[test]
    fn excerpts_are_spread_evenly_and_keep_their_time() {
        let runs = vec![run("a", Role::Fit, 1_200_000), run("b", Role::Holdout, 5_000)];
        let set = of(&RecordingSet { runs, ..RecordingSet::default() }).expect("it is long");
        let fit: Vec<&RecordedRun> = set.runs.iter().filter(|r| r.role == Role::Fit).collect();
        assert_eq!((fit.len(), set.runs.len(), set.remarks.len()), (25, 26, 1));
        let begins: Vec<f64> = fit.iter().map(|r| r.series[0].times[0]).collect();
        assert!(begins.windows(2).all(|b| (b[1] - b[0] - 48.0).abs() < 1e-9), "{begins:?}");
        for run in fit {
            let [fast, slow] = [&run.series[0], &run.series[1]];
            assert_eq!((fast.len(), slow.len()), (12_000, 1_200));
            assert_eq!(fast.times[..], fast.values[..]);
        }
    }
}

//! `runs.jsonl`: a line for every finished run, appended the moment it is over.
//!
//! A process that is killed loses nothing but the runs it was in: what was written is with the system. At the next opening a
//! last line without its end is cut off. Lines are in the order in which runs ended; the table is in the order of runs.

use crate::error::CampaignError;
use crate::row::Row;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two waits for the disk: a power cut loses at most the runs of the last second.
const SYNC_EVERY: Duration = Duration::from_secs(1);

/// The journal of a campaign, open for more.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    length: u64,
    /// Place of every run's line, sorted by run.
    index: Vec<(u64, u64)>,
    synced: Instant,
}

impl Journal {
    /// Opens or creates the journal, cuts off a torn last line and finds the runs that are in it.
    pub(crate) fn open(path: &Path) -> Result<Self, CampaignError> {
        let options = OpenOptions::new().read(true).append(true).create(true).truncate(false).open(path);
        let file = options.map_err(CampaignError::write(path))?;
        let (index, length) = scan(path, &file)?;
        file.set_len(length).map_err(CampaignError::write(path))?;
        Ok(Self { path: path.to_owned(), file, length, index, synced: Instant::now() })
    }

    /// Runs that are in it, ascending.
    pub(crate) fn runs(&self) -> impl Iterator<Item = u64> + '_ {
        self.index.iter().map(|(run, _)| *run)
    }

    /// Number of runs that are in it.
    pub(crate) fn len(&self) -> usize {
        self.index.len()
    }

    /// Writes a run. After an error the journal is as before, and the run counts as not made.
    pub(crate) fn push(&mut self, row: &Row) -> Result<(), CampaignError> {
        let mut line = serde_json::to_vec(row).map_err(|e| CampaignError::table(&self.path, e))?;
        line.push(b'\n');
        if let Err(error) = self.file.write_all(&line) {
            let _torn_line_is_cut_at_the_next_opening_if_not_now = self.file.set_len(self.length);
            return Err(CampaignError::write(&self.path)(error));
        }
        let place = self.index.partition_point(|(run, _)| *run < row.run);
        self.index.insert(place, (row.run, self.length));
        self.length += line.len() as u64;
        if self.synced.elapsed() > SYNC_EVERY {
            self.sync()?;
        }
        Ok(())
    }

    /// Waits until all is on disk.
    pub(crate) fn sync(&mut self) -> Result<(), CampaignError> {
        self.synced = Instant::now();
        self.file.sync_data().map_err(CampaignError::write(&self.path))
    }

    /// The rows in the order of runs, one at a time.
    pub(crate) fn rows(&self) -> Result<Rows<'_>, CampaignError> {
        let file = File::open(&self.path).map_err(CampaignError::read(&self.path))?;
        Ok(Rows { journal: self, reader: BufReader::new(file), next: 0 })
    }
}

/// Rows of a journal in the order of runs.
pub(crate) struct Rows<'a> {
    journal: &'a Journal,
    reader: BufReader<File>,
    next: usize,
}

impl Iterator for Rows<'_> {
    type Item = Result<Row, CampaignError>;

    fn next(&mut self) -> Option<Self::Item> {
        let (_, place) = *self.journal.index.get(self.next)?;
        self.next += 1;
        let path = &self.journal.path;
        let mut line = String::new();
        let read = self.reader.seek(SeekFrom::Start(place)).and_then(|_| self.reader.read_line(&mut line));
        Some(match read {
            Ok(_) => serde_json::from_str(&line).map_err(|e| CampaignError::table(path, e)),
            Err(error) => Err(CampaignError::read(path)(error)),
        })
    }
}

/// The whole lines of a journal: run and place of each, sorted by run, and where the last of them ends. Where a run stands twice
/// the first counts.
fn scan(path: &Path, file: &File) -> Result<(Vec<(u64, u64)>, u64), CampaignError> {
    let mut reader = BufReader::new(file);
    let (mut index, mut place, mut number) = (Vec::new(), 0_u64, 0);
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = reader.by_ref().read_until(b'\n', &mut line).map_err(CampaignError::read(path))?;
        number += 1;
        if read == 0 || line.last() != Some(&b'\n') {
            break;
        }
        let row: Row = serde_json::from_slice(&line).map_err(|e| CampaignError::Journal {
            path: path.to_owned(),
            line: number,
            problem: format!("is no run of a campaign: {e}"),
        })?;
        index.push((row.run, place));
        place += read as u64;
    }
    index.sort_unstable();
    index.dedup_by_key(|(run, _)| *run);
    Ok((index, place))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::fs;

    fn row(run: u64) -> Row {
        Row { run, inputs: vec![0.1 + run as f64, f64::MIN_POSITIVE], reason: "line\nbreak".into(), ..Row::default() }
    }

    #[test]
    fn rows_come_back_bit_for_bit_and_in_order() {
        let home = tempfile::tempdir().unwrap();
        let mut journal = Journal::open(&home.path().join("runs.jsonl")).unwrap();
        for run in [5, 0, 3] {
            journal.push(&row(run)).unwrap();
        }
        let rows: Vec<Row> = journal.rows().unwrap().map(Result::unwrap).collect();
        assert_eq!(rows, [row(0), row(3), row(5)]);
    }

    #[test]
    fn a_line_torn_by_a_kill_is_cut_off_wherever_it_was_torn() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("runs.jsonl");
        let mut journal = Journal::open(&path).unwrap();
        journal.push(&row(0)).unwrap();
        journal.push(&row(1)).unwrap();
        let whole = fs::read(&path).unwrap();
        let first = whole.iter().position(|b| *b == b'\n').unwrap() + 1;
        for cut in first..whole.len() {
            fs::write(&path, &whole[..cut]).unwrap();
            let mut again = Journal::open(&path).unwrap();
            assert_eq!(again.runs().collect::<Vec<_>>(), [0], "cut at {cut}");
            again.push(&row(1)).unwrap();
            assert_eq!(fs::read(&path).unwrap(), whole, "cut at {cut}");
        }
    }

    #[test]
    fn a_line_that_is_no_run_is_named() {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("runs.jsonl");
        fs::write(&path, "{\"run\": 1}\n").unwrap();
        let message = Journal::open(&path).unwrap_err().to_string();
        assert!(message.contains("runs.jsonl:1: is no run of a campaign"), "{message}");
    }
}

//! A table of numbers as the recordings hold them: CSV, one header row, every cell a finite number.

use super::RealError;
use std::path::{Path, PathBuf};

/// Columns with names, all of one length.
#[derive(Clone, Debug)]
pub struct Table {
    path: PathBuf,
    columns: Vec<(String, Vec<f64>)>,
}

impl Table {
    /// Reads a table.
    pub fn load(path: &Path) -> Result<Self, RealError> {
        let text = std::fs::read_to_string(path).map_err(|source| RealError::Read { path: path.to_owned(), source })?;
        Self::parse(path, &text)
    }

    /// Parses a table; `path` is for messages.
    pub fn parse(path: &Path, text: &str) -> Result<Self, RealError> {
        let content = |problem: String| RealError::Content { path: path.to_owned(), problem };
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let (_, header) = lines.next().ok_or_else(|| content("is empty".to_owned()))?;
        let mut columns: Vec<_> = header.split(',').map(|name| (name.trim().to_owned(), Vec::new())).collect();
        for (i, line) in lines {
            let cells: Vec<&str> = line.split(',').collect();
            if cells.len() != columns.len() {
                return Err(content(format!(
                    "line {}: {} cells, the header has {}",
                    i + 1,
                    cells.len(),
                    columns.len()
                )));
            }
            for (cell, (name, values)) in cells.iter().zip(&mut columns) {
                let value = cell.trim().parse::<f64>().ok().filter(|x| x.is_finite());
                let wrong = || content(format!("line {}: \"{cell}\" in column {name} is not a finite number", i + 1));
                values.push(value.ok_or_else(wrong)?);
            }
        }
        Ok(Self { path: path.to_owned(), columns })
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Result<&[f64], RealError> {
        let found = self.columns.iter().find(|(n, _)| n == name);
        found.map(|(_, values)| values.as_slice()).ok_or_else(|| RealError::Content {
            path: self.path.clone(),
            problem: format!("has no column \"{name}\"; it has {}", self.names()),
        })
    }

    fn names(&self) -> String {
        self.columns.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_cell_is_named_by_line_and_column() {
        let error = Table::parse(Path::new("a.csv"), "t,x\n0,1\n1,oops\n").expect_err("not a number");
        assert_eq!(error.to_string(), "recording a.csv: line 3: \"oops\" in column x is not a finite number");
    }

    #[test]
    fn columns_are_found_by_name() {
        let table = Table::parse(Path::new("a.csv"), "t,x\n0,1\n1,2.5\n").expect("a table");
        assert_eq!(table.column("x").expect("x"), [1.0, 2.5]);
        assert!(table.column("y").is_err());
    }
}

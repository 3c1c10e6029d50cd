//! A run file as columns: CSV, Parquet or MCAP, read leniently where the format leaves room, exactly where it does not.
//!
//! A cell that is not a number is an error only where its column is used, so that foreign files may hold text. `nan`,
//! `inf`, `null`, `NA` count as missing, and it is said. A last row without a line end is left out: a number that was
//! cut short cannot be told from a whole one.

use super::{Remark, Severity};
use crate::RecordError;
use arrow::array::{Array, ArrayRef, AsArray};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Float64Type, Schema, TimeUnit};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use std::fs::File;
use std::path::{Path, PathBuf};

/// A column.
#[derive(Clone, Debug, Default)]
pub(super) struct Column {
    /// Name in the header.
    pub(super) name: String,
    /// One value per row; NaN: missing.
    pub(super) values: Vec<f64>,
    /// Row and text of the first cell that is not a number.
    pub(super) text_at: Option<(usize, String)>,
    /// Cells that say `nan`, `inf`, `null`.
    pub(super) not_finite: usize,
}

/// A file of columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    /// The file.
    pub(super) path: PathBuf,
    /// Its columns.
    pub(super) columns: Vec<Column>,
    /// Line of each row (CSV) or its number from 1 (Parquet).
    pub(super) places: Vec<usize>,
    /// Text of the group column.
    pub(super) labels: Vec<String>,
    /// Columns that are times: one of them is chosen, and nobody misses the others.
    pub(super) clocks: &'static [&'static str],
    /// What was left out.
    pub(super) remarks: Vec<Remark>,
}

impl Table {
    /// Reads a file by its extension; `group`: the column whose text is wanted.
    pub(super) fn load(path: &Path, group: Option<&str>) -> Result<Self, RecordError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let table = match extension.as_str() {
            "parquet" | "pq" => load_parquet(path, group)?,
            "csv" | "txt" | "tsv" => load_csv(path, group)?,
            "mcap" => super::mcap_file::load(path)?,
            _ => {
                let problem = format!(
                    "is neither .csv nor .parquet nor .mcap (its ending is \"{extension}\"); convert or rename it"
                );
                return Err(RecordError::table(path, problem));
            }
        };
        if table.places.is_empty() {
            return Err(RecordError::table(
                path,
                "holds no row of data; was the recording stopped at once, or the file cut?",
            ));
        }
        Ok(table)
    }

    /// A column by its name.
    pub(super) fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// A column that is to be used: one with text in it is refused.
    pub(super) fn numbers(&self, column: &Column) -> Result<(), RecordError> {
        let Some((row, text)) = &column.text_at else { return Ok(()) };
        let decimal_comma = text.contains(',') && text.replace(',', ".").parse::<f64>().is_ok();
        let way_out = match decimal_comma {
            true => "write decimals with a point",
            false => "leave the cell empty where nothing was measured",
        };
        let problem = format!("\"{}\" in column \"{}\" is not a number; {way_out}", shortened(text), column.name);
        Err(self.at(*row, problem))
    }

    /// An error at a row.
    pub(super) fn at(&self, row: usize, problem: String) -> RecordError {
        let line = self.places.get(row).copied().unwrap_or_default();
        RecordError::Line { path: self.path.clone(), line, problem }
    }
}

fn shortened(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().count() <= LONGEST { text.to_owned() } else { text.chars().take(LONGEST).chain(['…']).collect() }
}

fn load_csv(path: &Path, group: Option<&str>) -> Result<Table, RecordError> {
    let bytes = std::fs::read(path).map_err(RecordError::read(path))?;
    let text = String::from_utf8(bytes)
        .map_err(|_| RecordError::table(path, "is not UTF-8 text; export it as plain CSV in UTF-8"))?;
    parse(path, &text, group)
}

/// Parses the text of a CSV file; fields are split at the commas of the header, else at its semicolons or tabs.
pub(super) fn parse(path: &Path, text: &str, group: Option<&str>) -> Result<Table, RecordError> {
    let text = text.trim_start_matches('\u{feff}');
    let header = text.lines().next().unwrap_or_default();
    let comma = [',', ';', '\t'].into_iter().find(|c| header.contains(*c)).unwrap_or(',');
    let names: Vec<String> = cells(header, comma).map(|name| name.into_owned()).collect();
    check_header(path, &names)?;
    let columns = names.into_iter().map(|name| Column { name, ..Column::default() }).collect();
    let mut table = Table { path: path.to_owned(), columns, ..Table::default() };
    let group = group.and_then(|name| table.columns.iter().position(|column| column.name == name));
    let last = text.lines().count();
    for (i, line) in text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty()) {
        if i + 1 == last && !text.ends_with('\n') {
            table.remarks.push(Remark::new(
                Severity::Warning,
                format!("line {last}, the last, has no line end and may be cut short: it is left out"),
            ));
            continue;
        }
        add_row(&mut table, line, comma, (i + 1, last), group)?;
    }
    Ok(table)
}

fn check_header(path: &Path, names: &[String]) -> Result<(), RecordError> {
    let wrong = |problem: String| Err(RecordError::Line { path: path.to_owned(), line: 1, problem });
    if names.iter().all(String::is_empty) {
        return wrong("the file has no header; its first line names the columns, t first".to_owned());
    }
    for (i, name) in names.iter().enumerate() {
        if !name.is_empty() && names[..i].contains(name) {
            return wrong(format!("two columns are named \"{name}\"; rename one"));
        }
    }
    Ok(())
}

fn add_row(
    table: &mut Table,
    line: &str,
    comma: char,
    (number, last): (usize, usize),
    group: Option<usize>,
) -> Result<(), RecordError> {
    let row = table.places.len();
    let mut count = 0;
    for cell in cells(line, comma) {
        if let Some(column) = table.columns.get_mut(count) {
            column.push(row, &cell);
        }
        if group == Some(count) {
            table.labels.push(cell.into_owned());
        }
        count += 1;
    }
    if count == table.columns.len() {
        table.places.push(number);
        return Ok(());
    }
    let way_out = match (count < table.columns.len(), number == last) {
        (true, true) => "the file ends in the middle of a row: copy it again, or delete its last line",
        (true, false) => "mend or delete the line; a missing value is an empty cell between two commas",
        (false, _) => "mend or delete the line; decimals are written with a point",
    };
    let problem = format!("{count} cells, the header has {}; {way_out}", table.columns.len());
    Err(RecordError::Line { path: table.path.clone(), line: number, problem })
}

impl Column {
    fn push(&mut self, row: usize, cell: &str) {
        let value = match cell {
            "" => f64::NAN,
            _ => match cell.parse::<f64>() {
                Ok(value) if value.is_finite() => value,
                Ok(_) => self.missing(),
                Err(_) if ["null", "NULL", "NA", "N/A", "None", "-"].contains(&cell) => self.missing(),
                Err(_) => {
                    self.text_at.get_or_insert_with(|| (row, cell.to_owned()));
                    f64::NAN
                }
            },
        };
        self.values.push(value);
    }

    fn missing(&mut self) -> f64 {
        self.not_finite += 1;
        f64::NAN
    }
}

/// Cells of a line, trimmed; quotes protect the separator, a doubled quote is a quote.
fn cells(line: &str, comma: char) -> Box<dyn Iterator<Item = std::borrow::Cow<'_, str>> + '_> {
    if line.contains('"') {
        return Box::new(quoted_cells(line, comma).into_iter().map(|cell| cell.trim().to_owned().into()));
    }
    Box::new(line.split(comma).map(|cell| cell.trim().into()))
}

fn quoted_cells(line: &str, comma: char) -> Vec<String> {
    let mut cells = Vec::new();
    let mut cell = String::new();
    let mut inside = false;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if inside && chars.peek() == Some(&'"') => cell.extend(chars.next()),
            '"' => inside = !inside,
            c if c == comma && !inside => cells.push(std::mem::take(&mut cell)),
            other => cell.push(other),
        }
    }
    cells.push(cell);
    cells
}

fn load_parquet(path: &Path, group: Option<&str>) -> Result<Table, RecordError> {
    let file = File::open(path).map_err(RecordError::read(path))?;
    let wrong = |error: &dyn std::fmt::Display| {
        let text = error.to_string();
        let problem = match text.contains("Disabled feature") {
            true => format!(
                "is compressed in a way that is not read here ({text}); write it with snappy, zstd, gzip or lz4"
            ),
            false => format!("not a whole Parquet file ({text}); copy it again, or ask for it anew"),
        };
        RecordError::table(path, problem)
    };
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| wrong(&e))?;
    let schema = builder.schema().clone();
    let reader = builder.build().map_err(|e| wrong(&e))?;
    let mut table = Table { path: path.to_owned(), columns: named(&schema), ..Table::default() };
    check_header(path, &table.columns.iter().map(|c| c.name.clone()).collect::<Vec<_>>())?;
    for batch in reader {
        let batch = batch.map_err(|e| wrong(&e))?;
        for (column, array) in table.columns.iter_mut().zip(batch.columns()) {
            append(column, array).map_err(|e| wrong(&e))?;
            if group == Some(column.name.as_str()) {
                append_labels(&mut table.labels, array).map_err(|e| wrong(&e))?;
            }
        }
        let rows = table.places.len();
        table.places.extend(rows + 1..=rows + batch.num_rows());
    }
    Ok(table)
}

fn named(schema: &Schema) -> Vec<Column> {
    schema.fields().iter().map(|field| Column { name: field.name().clone(), ..Column::default() }).collect()
}

/// Nulls become missing; integers, booleans and single precision become doubles, stamps of time seconds.
fn append(column: &mut Column, array: &ArrayRef) -> Result<(), arrow::error::ArrowError> {
    let factor = match array.data_type() {
        DataType::Timestamp(unit, _) => match unit {
            TimeUnit::Second => 1.0,
            TimeUnit::Millisecond => 1e-3,
            TimeUnit::Microsecond => 1e-6,
            TimeUnit::Nanosecond => 1e-9,
        },
        kind if kind.is_numeric() || *kind == DataType::Boolean => 1.0,
        kind => {
            let row = column.values.len();
            column.text_at.get_or_insert_with(|| (row, format!("a {kind}")));
            column.values.extend(std::iter::repeat_n(f64::NAN, array.len()));
            return Ok(());
        }
    };
    let whole = if factor == 1.0 { array.clone() } else { cast(array, &DataType::Int64)? };
    let array = cast(&whole, &DataType::Float64)?;
    let numbers = array.as_primitive::<Float64Type>();
    for i in 0..numbers.len() {
        let value = if numbers.is_null(i) { f64::NAN } else { factor * numbers.value(i) };
        let odd = !numbers.is_null(i) && !value.is_finite();
        let value = if odd { column.missing() } else { value };
        column.values.push(value);
    }
    Ok(())
}

fn append_labels(labels: &mut Vec<String>, array: &ArrayRef) -> Result<(), arrow::error::ArrowError> {
    let array = cast(array, &DataType::Utf8)?;
    let texts = array.as_string::<i32>();
    labels.extend((0..texts.len()).map(|i| if texts.is_null(i) { String::new() } else { texts.value(i).to_owned() }));
    Ok(())
}

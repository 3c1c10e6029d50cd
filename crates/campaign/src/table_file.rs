//! The table as Parquet: a row a run, in the order of runs.
//!
//! Equal runs give equal bytes, however they came about: no clock, no host, no number of threads; columns in a fixed order (run,
//! seed, inputs, applied values, outcome, reason, expectations, then metrics and work by name), row groups of a fixed size,
//! and a column only where some run has a value. It is written from the journal in two passes, so that memory does not grow with
//! the number of runs.

use crate::error::CampaignError;
use crate::row::Row;
use crate::table::{Cells, Column, Header, Table};
use arrow::array::{Array, ArrayRef, AsArray, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow::datatypes::{DataType, Field, Float64Type, Int64Type, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Value of the key `softdock.format` in the file's metadata.
pub const TABLE_FORMAT: &str = "softdock-campaign-1";
/// Name of the file.
pub const TABLE_FILE: &str = "table.parquet";
/// Rows of a row group, and of what is in memory at a time: a row as text and maps takes ten times what it does encoded.
const GROUP: usize = 1024;
const BATCH: usize = 128;

/// Columns that every table has before its metrics.
const FIRST: [(&str, Kind); 2] = [("run", Kind::Integer), ("seed", Kind::Integer)];
const RESULT: [(&str, Kind); 4] =
    [("outcome", Kind::Text), ("reason", Kind::Text), ("as_expected", Kind::Flag), ("not_as_expected", Kind::Text)];

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Integer,
    Number,
    Flag,
    Text,
}

impl Kind {
    fn of(value: &Value) -> Option<Self> {
        match value {
            Value::Bool(_) => Some(Self::Flag),
            Value::Number(_) => Some(Self::Number),
            Value::String(_) => Some(Self::Text),
            _ => None,
        }
    }

    fn data_type(self) -> DataType {
        match self {
            Self::Integer => DataType::Int64,
            Self::Number => DataType::Float64,
            Self::Flag => DataType::Boolean,
            Self::Text => DataType::Utf8,
        }
    }
}

/// The columns of a table that is to be written.
#[derive(Debug)]
struct Layout {
    columns: Vec<(String, Kind)>,
}

/// Writes rows, in the order of runs, given twice: once to find the columns, once to write them.
pub(crate) fn write_table<I>(
    path: &Path,
    header: &Header,
    rows: impl Fn() -> Result<I, CampaignError>,
) -> Result<(), CampaignError>
where
    I: Iterator<Item = Result<Row, CampaignError>>,
{
    let layout = Layout::of(header, rows()?)?;
    let partial = path.with_extension("parquet.partial");
    let file = File::create(&partial).map_err(CampaignError::write(&partial))?;
    let schema = layout.schema(header);
    let failed = |error: parquet::errors::ParquetError| disk_error(&partial, error);
    let mut writer = ArrowWriter::try_new(file, Arc::clone(&schema), Some(properties(header))).map_err(failed)?;
    let mut batch: Vec<Row> = Vec::with_capacity(BATCH);
    let mut rows = rows()?;
    loop {
        batch.clear();
        for row in rows.by_ref().take(BATCH) {
            batch.push(row?);
        }
        if batch.is_empty() {
            break;
        }
        let built = layout.batch(header, &schema, &batch).map_err(|e| CampaignError::table(&partial, e))?;
        writer.write(&built).map_err(failed)?;
    }
    let file = writer.into_inner().map_err(failed)?;
    file.sync_all().map_err(CampaignError::write(&partial))?;
    std::fs::rename(&partial, path).map_err(CampaignError::write(path))
}

/// An error of the Parquet writer is one of the disk, if it says so.
fn disk_error(path: &Path, error: parquet::errors::ParquetError) -> CampaignError {
    match error {
        parquet::errors::ParquetError::External(source) => match source.downcast::<std::io::Error>() {
            Ok(source) => CampaignError::write(path)(*source),
            Err(other) => CampaignError::table(path, other),
        },
        other => CampaignError::table(path, other),
    }
}

impl Layout {
    fn of(header: &Header, rows: impl Iterator<Item = Result<Row, CampaignError>>) -> Result<Self, CampaignError> {
        let (mut metrics, mut work) = (BTreeMap::new(), BTreeMap::new());
        for row in rows {
            let row = row?;
            for (name, value) in &row.metrics {
                if let Some(kind) = Kind::of(value) {
                    metrics.entry(name.clone()).or_insert(kind);
                }
            }
            for name in row.work.keys() {
                work.entry(format!("work.{name}")).or_insert(Kind::Integer);
            }
        }
        let own = |list: &[(&str, Kind)]| -> Vec<(String, Kind)> {
            list.iter().map(|(n, k)| ((*n).to_owned(), *k)).collect()
        };
        let mut columns = own(&FIRST);
        for prefix in ["input", "applied"] {
            columns.extend(header.inputs.iter().map(|input| (format!("{prefix}.{}", input.name), Kind::Number)));
        }
        columns.extend(own(&RESULT));
        columns.extend(metrics);
        columns.extend(work);
        Ok(Self { columns })
    }

    fn schema(&self, header: &Header) -> Arc<Schema> {
        let fields: Vec<Field> = self.columns.iter().map(|(n, k)| Field::new(n, k.data_type(), true)).collect();
        let metadata = header_pairs(header).into_iter().map(|pair| (pair.key, pair.value.unwrap_or_default()));
        Arc::new(Schema::new_with_metadata(fields, metadata.collect()))
    }

    fn batch(
        &self,
        header: &Header,
        schema: &Arc<Schema>,
        rows: &[Row],
    ) -> Result<RecordBatch, arrow::error::ArrowError> {
        let inputs = header.inputs.len();
        let array = |(place, (name, kind)): (usize, &(String, Kind))| -> ArrayRef {
            let value = |row: &Row| cell(row, (place, inputs), name);
            match kind {
                Kind::Integer => Arc::new(rows.iter().map(|r| value(r).as_i64()).collect::<Int64Array>()),
                Kind::Number => Arc::new(rows.iter().map(|r| value(r).as_f64()).collect::<Float64Array>()),
                Kind::Flag => Arc::new(rows.iter().map(|r| value(r).as_bool()).collect::<BooleanArray>()),
                Kind::Text => {
                    Arc::new(rows.iter().map(|r| value(r).as_str().map(str::to_owned)).collect::<StringArray>())
                }
            }
        };
        RecordBatch::try_new(Arc::clone(schema), self.columns.iter().enumerate().map(array).collect())
    }
}

/// The cell of a row at a column.
fn cell(row: &Row, (place, inputs): (usize, usize), name: &str) -> Value {
    let number = |value: Option<f64>| value.map_or(Value::Null, Value::from);
    if (FIRST.len()..FIRST.len() + 2 * inputs).contains(&place) {
        let k = place - FIRST.len();
        return number(if k < inputs {
            row.inputs.get(k).copied()
        } else {
            row.applied.get(k - inputs).copied().flatten()
        });
    }
    match name {
        "run" => Value::from(row.run),
        "seed" => Value::from(row.seed),
        "outcome" => Value::from(row.outcome.as_str()),
        "reason" => Value::from(row.reason.as_str()),
        "as_expected" => Value::from(row.unmet.is_empty()),
        "not_as_expected" if row.unmet.is_empty() => Value::Null,
        "not_as_expected" => Value::from(row.unmet.join("; ")),
        _ => {
            let work = name.strip_prefix("work.").and_then(|counter| row.work.get(counter));
            work.or_else(|| row.metrics.get(name)).cloned().unwrap_or(Value::Null)
        }
    }
}

fn properties(header: &Header) -> WriterProperties {
    WriterProperties::builder()
        .set_created_by(format!("softdock {}", header.version))
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_max_row_group_row_count(Some(GROUP))
        .set_key_value_metadata(Some(header_pairs(header)))
        .build()
}

fn header_pairs(header: &Header) -> Vec<KeyValue> {
    let text = serde_json::to_string(header).unwrap_or_default();
    vec![
        KeyValue::new("softdock.format".to_owned(), TABLE_FORMAT.to_owned()),
        KeyValue::new("softdock.campaign".to_owned(), text),
    ]
}

/// Reads a table; `path` may be the file or the folder of a campaign.
pub fn read_table(path: &Path) -> Result<Table, CampaignError> {
    let path = &if path.is_dir() { path.join(TABLE_FILE) } else { path.to_owned() };
    let file = File::open(path).map_err(CampaignError::read(path))?;
    let wrong = |e: &dyn std::fmt::Display| CampaignError::table(path, format!("not a readable Parquet file: {e}"));
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| wrong(&e))?;
    let pairs = builder.metadata().file_metadata().key_value_metadata().cloned().unwrap_or_default();
    let value = |key: &str| pairs.iter().find(|p| p.key == key).and_then(|p| p.value.clone());
    if value("softdock.format").as_deref() != Some(TABLE_FORMAT) {
        let problem = "is no table of a campaign; give the table.parquet that `softdock campaign` writes";
        return Err(CampaignError::table(path, problem));
    }
    let header: Header =
        serde_json::from_str(&value("softdock.campaign").unwrap_or_default()).map_err(|e| wrong(&e))?;
    let fields = builder.schema().clone();
    let mut columns: Vec<Column> = fields
        .fields()
        .iter()
        .map(|field| Column { name: field.name().clone(), cells: empty(field.data_type()) })
        .collect();
    for batch in builder.build().map_err(|e| wrong(&e))? {
        let batch = batch.map_err(|e| wrong(&e))?;
        for (column, array) in columns.iter_mut().zip(batch.columns()) {
            append(&mut column.cells, array);
        }
    }
    Ok(Table { header, columns })
}

fn empty(kind: &DataType) -> Cells {
    match kind {
        DataType::Int64 => Cells::Integers(Vec::new()),
        DataType::Boolean => Cells::Flags(Vec::new()),
        DataType::Utf8 => Cells::Texts(Vec::new()),
        _ => Cells::Numbers(Vec::new()),
    }
}

fn append(cells: &mut Cells, array: &ArrayRef) {
    let has = |i: usize| !array.is_null(i);
    let all = 0..array.len();
    match cells {
        Cells::Integers(list) => {
            let values = array.as_primitive::<Int64Type>();
            list.extend(all.map(|i| has(i).then(|| values.value(i))));
        }
        Cells::Numbers(list) => {
            let values = array.as_primitive::<Float64Type>();
            list.extend(all.map(|i| has(i).then(|| values.value(i))));
        }
        Cells::Flags(list) => {
            let values = array.as_boolean();
            list.extend(all.map(|i| has(i).then(|| values.value(i))));
        }
        Cells::Texts(list) => {
            let values = array.as_string::<i32>();
            list.extend(all.map(|i| has(i).then(|| values.value(i).to_owned())));
        }
    }
}

/// The rows of a table again, as the journal has them.
pub(crate) fn rows_of(table: &Table) -> Vec<Row> {
    (0..table.len()).map(|i| row_of(table, i)).collect()
}

fn row_of(table: &Table, i: usize) -> Row {
    let mut row = Row::default();
    for column in &table.columns {
        let value = match &column.cells {
            Cells::Integers(list) => list[i].map(Value::from),
            Cells::Numbers(list) => list[i].map(Value::from),
            Cells::Flags(list) => list[i].map(Value::from),
            Cells::Texts(list) => list[i].clone().map(Value::from),
        };
        put(&mut row, &column.name, value);
    }
    row
}

fn put(row: &mut Row, name: &str, value: Option<Value>) {
    let text = |value: &Option<Value>| value.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned();
    let whole = |value: &Option<Value>| value.as_ref().and_then(Value::as_u64).unwrap_or_default();
    let number = |value: &Option<Value>| value.as_ref().and_then(Value::as_f64);
    match name {
        "run" => row.run = whole(&value),
        "seed" => row.seed = whole(&value),
        "outcome" => row.outcome = text(&value),
        "reason" => row.reason = text(&value),
        "as_expected" => {}
        "not_as_expected" => row.unmet.extend(value.as_ref().map(|_| text(&value))),
        _ if name.starts_with("input.") => row.inputs.push(number(&value).unwrap_or(f64::NAN)),
        _ if name.starts_with("applied.") => row.applied.push(number(&value)),
        _ => {
            let (map, key) = match name.strip_prefix("work.") {
                Some(counter) => (&mut row.work, counter),
                None => (&mut row.metrics, name),
            };
            map.extend(value.map(|v| (key.to_owned(), v)));
        }
    }
}

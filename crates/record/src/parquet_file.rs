//! Signals as a Parquet file: column `t` (s), then one `Float64` column per channel, null where not sampled.
//!
//! Unit, description and plot stand in each field's metadata, the run's in the file's (`softdock.*`). Equal logs give
//! equal bytes: no clock, no host, one row group per 64 Ki rows.

use crate::folder::write_file;
use crate::{Channel, ChannelSpec, Meta, RecordError, Signals};
use arrow::array::{Array, ArrayRef, AsArray, Float64Array, RecordBatch};
use arrow::compute::cast;
use arrow::datatypes::{DataType, Field, Float64Type, Schema};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::Compression;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

/// Value of the key `softdock.format` in the file's metadata.
pub const SIGNALS_FORMAT: &str = "softdock-signals-1";

/// Writes the signals of a run to a Parquet file and waits until it is on disk.
pub fn write_parquet(path: &Path, meta: &Meta, signals: &Signals) -> Result<(), RecordError> {
    write_file(path, &encode_parquet(meta, signals)?)
}

/// The bytes of a Parquet file.
pub fn encode_parquet(meta: &Meta, signals: &Signals) -> Result<Vec<u8>, RecordError> {
    let encode = || -> Result<Vec<u8>, parquet::errors::ParquetError> {
        let batch = build_batch(meta, signals)?;
        let mut bytes = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties(meta)))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(bytes)
    };
    encode().map_err(|error| RecordError::Encode { what: "signals.parquet", reason: error.to_string() })
}

/// Reads signals from a Parquet file, from softdock or from elsewhere: any numeric columns with one named `t`.
pub fn read_parquet(path: &Path) -> Result<(Meta, Signals), RecordError> {
    let file = File::open(path).map_err(RecordError::read(path))?;
    let wrong =
        |error: &dyn std::fmt::Display| RecordError::table(path, format!("not a readable Parquet file: {error}"));
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|e| wrong(&e))?;
    let header = builder.metadata().file_metadata().key_value_metadata().cloned().unwrap_or_default();
    let schema = builder.schema().clone();
    let reader = builder.build().map_err(|e| wrong(&e))?;
    let mut columns = vec![Vec::new(); schema.fields().len()];
    for batch in reader {
        let batch = batch.map_err(|e| wrong(&e))?;
        for (column, array) in columns.iter_mut().zip(batch.columns()) {
            append_numbers(column, array).map_err(|e| wrong(&e))?;
        }
    }
    let signals = assemble(path, &schema, columns)?;
    Ok((meta_from(&header), signals))
}

/// The run's header stands in the Arrow schema too, where pyarrow and polars look for it.
fn build_batch(meta: &Meta, signals: &Signals) -> Result<RecordBatch, arrow::error::ArrowError> {
    let mut fields = vec![time_field()];
    let mut columns: Vec<ArrayRef> = vec![Arc::new(Float64Array::from(signals.times.clone()))];
    for channel in &signals.channels {
        fields.push(channel_field(&channel.spec));
        let sampled = channel.values.iter().map(|value| (!value.is_nan()).then_some(*value));
        columns.push(Arc::new(Float64Array::from_iter(sampled)));
    }
    let header = header_of(meta).into_iter().map(|pair| (pair.key, pair.value.unwrap_or_default()));
    RecordBatch::try_new(Arc::new(Schema::new_with_metadata(fields, header.collect())), columns)
}

fn time_field() -> Field {
    let metadata = [("unit", "s"), ("description", "simulated time")].map(|(k, v)| (k.to_string(), v.to_string()));
    Field::new("t", DataType::Float64, false).with_metadata(HashMap::from(metadata))
}

fn channel_field(spec: &ChannelSpec) -> Field {
    let metadata = [("unit", &*spec.unit), ("description", &*spec.description), ("plot", spec.plot.key())];
    let metadata = metadata.map(|(key, value)| (key.to_string(), value.to_string()));
    Field::new(&spec.name, DataType::Float64, true).with_metadata(HashMap::from(metadata))
}

fn properties(meta: &Meta) -> WriterProperties {
    WriterProperties::builder()
        .set_created_by(format!("softdock {}", meta.version))
        // Samples of a signal are seldom twice the same: a dictionary of them is work for nothing.
        .set_dictionary_enabled(false)
        .set_compression(Compression::SNAPPY)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_max_row_group_row_count(Some(64 * 1024))
        .set_key_value_metadata(Some(header_of(meta)))
        .build()
}

fn header_of(meta: &Meta) -> Vec<KeyValue> {
    let pair = |key: &str, value: &str| KeyValue::new(format!("softdock.{key}"), value.to_string());
    let mut header = vec![
        pair("format", SIGNALS_FORMAT),
        pair("scenario", &meta.scenario),
        pair("seed", &meta.seed.to_string()),
        pair("version", &meta.version),
        pair("inputs", &meta.inputs),
    ];
    header.extend(meta.notes.iter().map(|(key, value)| pair(&format!("note.{key}"), value)));
    header
}

fn meta_from(header: &[KeyValue]) -> Meta {
    let text = |key: &str| {
        let key = format!("softdock.{key}");
        header.iter().find(|pair| pair.key == key).and_then(|pair| pair.value.clone()).unwrap_or_default()
    };
    let note = |pair: &KeyValue| {
        let key = pair.key.strip_prefix("softdock.note.")?;
        Some((key.to_string(), pair.value.clone().unwrap_or_default()))
    };
    Meta {
        scenario: text("scenario"),
        seed: text("seed").parse().unwrap_or_default(),
        version: text("version"),
        inputs: text("inputs"),
        notes: header.iter().filter_map(note).collect(),
    }
}

/// Nulls become NaN; integers and single precision become doubles.
fn append_numbers(column: &mut Vec<f64>, array: &ArrayRef) -> Result<(), arrow::error::ArrowError> {
    let array = cast(array, &DataType::Float64)?;
    let numbers = array.as_primitive::<Float64Type>();
    column.extend((0..numbers.len()).map(|i| if numbers.is_null(i) { f64::NAN } else { numbers.value(i) }));
    Ok(())
}

fn assemble(path: &Path, schema: &Schema, mut columns: Vec<Vec<f64>>) -> Result<Signals, RecordError> {
    let Some(time) = schema.fields().iter().position(|field| field.name() == "t") else {
        let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
        let problem = format!("has no column \"t\" (time in s); its columns are {}", names.join(", "));
        return Err(RecordError::table(path, problem));
    };
    let mut channels: Vec<Channel> = schema
        .fields()
        .iter()
        .zip(&mut columns)
        .map(|(field, values)| Channel { spec: spec_of(field), values: std::mem::take(values) })
        .collect();
    let times = channels.remove(time).values;
    if let Some(row) = times.iter().position(|t| !t.is_finite()) {
        return Err(RecordError::table(path, format!("row {} has no finite time t", row + 1)));
    }
    let signals = Signals { times, channels };
    signals.check(path)?;
    Ok(signals)
}

fn spec_of(field: &Field) -> ChannelSpec {
    let text = |key: &str| field.metadata().get(key).cloned().unwrap_or_default();
    ChannelSpec {
        name: field.name().clone(),
        unit: text("unit"),
        description: text("description"),
        plot: text("plot").parse().unwrap_or_default(),
    }
}

//! A run file in MCAP, as ROS 2 and Foxglove write it: messages as rows of a table.
//!
//! | messages | columns |
//! | --- | --- |
//! | `sensor_msgs/JointState` | `TOPIC.JOINT.position`, `.velocity`, `.effort` |
//! | `geometry_msgs/PoseStamped` | `TOPIC.position.{x,y,z}`, `TOPIC.orientation.{x,y,z,w}` |
//! | `geometry_msgs/TransformStamped`, `tf2_msgs/TFMessage` | `TOPIC.CHILD.position…`, `TOPIC.CHILD.orientation…` |
//! | `nav_msgs/Odometry` | `TOPIC.position…`, `.orientation…`, `.linear_velocity…`, `.angular_velocity…` (both in the child's axes) |
//! | `sensor_msgs/Imu` | `TOPIC.orientation…`, `.angular_velocity…`, `.linear_acceleration…` |
//! | `geometry_msgs/WrenchStamped` | `TOPIC.force.{x,y,z}`, `TOPIC.torque.{x,y,z}` |
//! | JSON | `TOPIC.KEY.KEY…` of every number; a key that is a channel's name stands for itself |
//!
//! `TOPIC` is without its first slash. Two columns are times: `t`, the stamp of a message's header (of JSON its `t`), or when it was logged where it has none;
//! and `log_time`. `[time] column` of `recording.toml` chooses between them. Encodings: CDR (XTypes 1.3, section 7.4.3, plain, both byte orders) and JSON.
//! Messages of other types are said and not read.

use super::channel_name::ChannelName;
use super::table::{Column, Table};
use super::{Remark, Severity};
use crate::RecordError;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Nanoseconds from which on a clock counts from an epoch and not from the run's start.
const EPOCH: i64 = 1_000_000_000_000_000;

/// Columns of time.
const CLOCKS: [&str; 2] = ["t", "log_time"];

/// An instant: of JSON in seconds, as it stands there; of ROS and of the log in nanoseconds, of which seconds since an epoch would lose some.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stamp {
    Seconds(f64),
    Nanoseconds(i64),
}

impl Stamp {
    /// Since an instant in nanoseconds, s.
    fn since(self, base: i64) -> f64 {
        match self {
            Self::Seconds(seconds) => seconds,
            Self::Nanoseconds(count) => (count - base) as f64 / 1e9,
        }
    }
}

/// A row: its stamp, when it was logged, and its numbers by column.
type Row = (Stamp, Stamp, Vec<(String, f64)>);

/// What a message says: when, where its header has a stamp, and its numbers by what follows the topic.
#[derive(Debug, Default, PartialEq)]
struct Said {
    stamp: Option<Stamp>,
    numbers: Vec<(String, f64)>,
}

/// Reads all messages of a file.
pub(super) fn load(path: &Path) -> Result<Table, RecordError> {
    let bytes = std::fs::read(path).map_err(RecordError::read(path))?;
    let broken = |error: mcap::McapError| {
        RecordError::table(path, format!("is no whole MCAP file: {error}; `mcap recover` saves what a cut one holds"))
    };
    let mut rows: Vec<Row> = Vec::new();
    let mut strange: BTreeSet<String> = BTreeSet::new();
    for message in mcap::MessageStream::new(&bytes).map_err(broken)? {
        let message = message.map_err(broken)?;
        let schema = message.channel.schema.as_ref().map_or("", |schema| schema.name.as_str());
        let topic = message.channel.topic.trim_start_matches('/');
        let said = match message.channel.message_encoding.as_str() {
            "cdr" => read_cdr(schema, &message.data),
            "json" => read_json(&message.data),
            other => Err(format!("is encoded as {other}")),
        };
        let logged = Stamp::Nanoseconds(i64::try_from(message.log_time).unwrap_or(i64::MAX));
        match said {
            Ok(said) => {
                let named = said.numbers.into_iter().map(|(what, x)| (column_of(topic, &what), x)).collect();
                rows.push((said.stamp.unwrap_or(logged), logged, named));
            }
            Err(why) => {
                strange.insert(format!("messages of \"{topic}\" ({schema}) are not read: it {why}"));
            }
        }
    }
    let mut remarks: Vec<Remark> = strange.into_iter().map(|what| Remark::new(Severity::Warning, what)).collect();
    let base = base_of(&rows);
    if base > 0 {
        let what = format!("its time counts from its first stamp, {} s after the clock's epoch", base as f64 / 1e9);
        remarks.push(Remark::new(Severity::Note, what));
    }
    let since = |(stamp, logged, numbers): Row| (stamp.since(base), logged.since(base), numbers);
    Ok(Table { remarks, ..tabulate(path, rows.into_iter().map(since).collect()) })
}

/// The same by what stands in the table: stamp and log time, s.
type Timed = (f64, f64, Vec<(String, f64)>);

/// The earliest instant of a file whose clock counts from an epoch; zero of another.
fn base_of(rows: &[Row]) -> i64 {
    let counts = rows.iter().flat_map(|row| [row.0, row.1]).filter_map(|stamp| match stamp {
        Stamp::Nanoseconds(count) => Some(count),
        Stamp::Seconds(_) => None,
    });
    counts.min().filter(|first| *first > EPOCH).unwrap_or(0)
}

/// `JOINT.position` of a topic; what is a channel's name already stays.
fn column_of(topic: &str, what: &str) -> String {
    if what.is_empty() {
        topic.to_owned()
    } else if ChannelName::parse(what).is_some() {
        what.to_owned()
    } else {
        format!("{topic}.{what}")
    }
}

/// Rows in the order of time; what was said at the same instants shares one.
fn tabulate(path: &Path, mut rows: Vec<Timed>) -> Table {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut names: Vec<&String> = rows.iter().flat_map(|row| row.2.iter().map(|(name, _)| name)).collect();
    names.sort();
    names.dedup();
    let at: BTreeMap<&str, usize> = names.iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
    let mut values: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    let mut times: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
    for (stamp, logged, numbers) in &rows {
        let last = times[0].len().wrapping_sub(1);
        let is_free = |(name, _): &(String, f64)| values[at[name.as_str()]][last].is_nan();
        let joins = times[0].last() == Some(stamp) && numbers.iter().all(is_free);
        if !joins {
            times[0].push(*stamp);
            times[1].push(*logged);
            values.iter_mut().for_each(|column| column.push(f64::NAN));
        }
        let row = times[0].len() - 1;
        numbers.iter().for_each(|(name, x)| values[at[name.as_str()]][row] = *x);
    }
    let places = (1..=times[0].len()).collect();
    let column = |(name, values): (String, Vec<f64>)| Column { name, values, ..Column::default() };
    let timed = CLOCKS.map(str::to_owned).into_iter().zip(times);
    let measured = names.into_iter().cloned().zip(values);
    let columns = timed.chain(measured).map(column).collect();
    Table { path: path.to_owned(), columns, places, clocks: &CLOCKS, ..Table::default() }
}

/// Every number of a JSON object.
fn read_json(data: &[u8]) -> Result<Said, String> {
    let value: serde_json::Value = serde_json::from_slice(data).map_err(|error| format!("is no JSON: {error}"))?;
    let mut said = Said::default();
    flatten("", &value, &mut said.numbers);
    if let Some(at) = said.numbers.iter().position(|(key, _)| key == "t") {
        said.stamp = Some(Stamp::Seconds(said.numbers.remove(at).1));
    }
    Ok(said)
}

fn flatten(before: &str, value: &serde_json::Value, out: &mut Vec<(String, f64)>) {
    let below = |key: &str| if before.is_empty() { key.to_owned() } else { format!("{before}.{key}") };
    match value {
        serde_json::Value::Number(number) => out.extend(number.as_f64().map(|x| (before.to_owned(), x))),
        serde_json::Value::Bool(is) => out.push((before.to_owned(), f64::from(u8::from(*is)))),
        serde_json::Value::Object(map) => map.iter().for_each(|(key, value)| flatten(&below(key), value, out)),
        serde_json::Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, value)| flatten(&below(&i.to_string()), value, out));
        }
        serde_json::Value::Null | serde_json::Value::String(_) => {}
    }
}

/// A ROS 2 message.
fn read_cdr(schema: &str, data: &[u8]) -> Result<Said, String> {
    let mut cdr = Cdr::new(data)?;
    let mut said = Said::default();
    match schema.replace("/msg/", "/").as_str() {
        "sensor_msgs/JointState" => {
            said.stamp = cdr.header()?;
            let names: Vec<String> = (0..cdr.length()?).map(|_| cdr.text()).collect::<Result<_, _>>()?;
            for what in ["position", "velocity", "effort"] {
                let values = cdr.doubles()?;
                let named = names.iter().zip(values).filter(|(_, x)| x.is_finite());
                said.numbers.extend(named.map(|(joint, x)| (format!("{joint}.{what}"), x)));
            }
        }
        "geometry_msgs/PoseStamped" => {
            said.stamp = cdr.header()?;
            cdr.pose("", &mut said.numbers)?;
        }
        "geometry_msgs/TransformStamped" => said.stamp = cdr.transform(&mut said.numbers)?,
        "tf2_msgs/TFMessage" => {
            for _ in 0..cdr.length()? {
                said.stamp = cdr.transform(&mut said.numbers)?.or(said.stamp);
            }
        }
        "nav_msgs/Odometry" => {
            said.stamp = cdr.header()?;
            cdr.text()?;
            cdr.pose("", &mut said.numbers)?;
            cdr.skip(36)?;
            cdr.vector("linear_velocity", &mut said.numbers)?;
            cdr.vector("angular_velocity", &mut said.numbers)?;
        }
        "sensor_msgs/Imu" => {
            said.stamp = cdr.header()?;
            cdr.rotation("orientation", &mut said.numbers)?;
            // The first variance says −1 where there is no attitude (REP 145).
            let has_none = cdr.double()? == -1.0;
            if has_none {
                said.numbers.clear();
            }
            cdr.skip(8)?;
            cdr.vector("angular_velocity", &mut said.numbers)?;
            cdr.skip(9)?;
            cdr.vector("linear_acceleration", &mut said.numbers)?;
        }
        "geometry_msgs/WrenchStamped" => {
            said.stamp = cdr.header()?;
            cdr.vector("force", &mut said.numbers)?;
            cdr.vector("torque", &mut said.numbers)?;
        }
        _ => return Err("is of no type that is known here".to_owned()),
    }
    Ok(said)
}

/// Reads a CDR stream in order.
struct Cdr<'a> {
    /// What follows the encapsulation: alignment counts from here.
    data: &'a [u8],
    at: usize,
    is_little: bool,
}

impl<'a> Cdr<'a> {
    fn new(data: &'a [u8]) -> Result<Self, String> {
        match data {
            [0, kind @ (0 | 1), _, _, rest @ ..] => Ok(Self { data: rest, at: 0, is_little: *kind == 1 }),
            _ => Err("has no plain CDR header".to_owned()),
        }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let from = self.at.next_multiple_of(N);
        let bytes = self.data.get(from..from + N).and_then(|bytes| <[u8; N]>::try_from(bytes).ok());
        self.at = from + N;
        bytes.ok_or_else(|| "ends before its type does".to_owned())
    }

    fn word(&mut self) -> Result<u32, String> {
        let bytes = self.take()?;
        Ok(if self.is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn double(&mut self) -> Result<f64, String> {
        let bytes = self.take()?;
        Ok(if self.is_little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    /// Elements of a sequence: never more than there are bytes left.
    fn length(&mut self) -> Result<usize, String> {
        let length = self.word()? as usize;
        if length > self.data.len().saturating_sub(self.at) {
            return Err("ends before its type does".to_owned());
        }
        Ok(length)
    }

    fn text(&mut self) -> Result<String, String> {
        let length = self.length()?;
        let bytes = &self.data[self.at..self.at + length];
        self.at += length;
        String::from_utf8(bytes.strip_suffix(&[0]).unwrap_or(bytes).to_vec())
            .map_err(|_| "has text that is none".to_owned())
    }

    fn doubles(&mut self) -> Result<Vec<f64>, String> {
        (0..self.length()?).map(|_| self.double()).collect()
    }

    fn skip(&mut self, doubles: usize) -> Result<(), String> {
        (0..doubles).try_for_each(|_| self.double().map(drop))
    }

    /// The stamp of a header; none where it is zero.
    fn header(&mut self) -> Result<Option<Stamp>, String> {
        let (seconds, nanoseconds) = (self.word()? as i32, self.word()?);
        self.text()?;
        let count = i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds);
        Ok((count != 0).then_some(Stamp::Nanoseconds(count)))
    }

    fn put(&mut self, what: &str, components: &[&str], out: &mut Vec<(String, f64)>) -> Result<(), String> {
        for component in components {
            out.push((format!("{what}.{component}"), self.double()?));
        }
        Ok(())
    }

    fn vector(&mut self, what: &str, out: &mut Vec<(String, f64)>) -> Result<(), String> {
        self.put(what, &["x", "y", "z"], out)
    }

    fn rotation(&mut self, what: &str, out: &mut Vec<(String, f64)>) -> Result<(), String> {
        self.put(what, &["x", "y", "z", "w"], out)
    }

    fn pose(&mut self, before: &str, out: &mut Vec<(String, f64)>) -> Result<(), String> {
        self.vector(&format!("{before}position"), out)?;
        self.rotation(&format!("{before}orientation"), out)
    }

    fn transform(&mut self, out: &mut Vec<(String, f64)>) -> Result<Option<Stamp>, String> {
        let stamp = self.header()?;
        let child = self.text()?;
        self.pose(&format!("{child}."), out)?;
        Ok(stamp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(out: &mut Vec<u8>, frame: &str) {
        out.extend([0, 1, 0, 0]);
        out.extend(12i32.to_le_bytes());
        out.extend(500_000_000u32.to_le_bytes());
        text(out, frame);
    }

    fn text(out: &mut Vec<u8>, text: &str) {
        align(out, 4);
        out.extend((text.len() as u32 + 1).to_le_bytes());
        out.extend(text.bytes().chain([0]));
    }

    fn align(out: &mut Vec<u8>, to: usize) {
        while !(out.len() - 4).is_multiple_of(to) {
            out.push(0);
        }
    }

    fn double(out: &mut Vec<u8>, x: f64) {
        align(out, 8);
        out.extend(x.to_le_bytes());
    }

    #[test]
    fn a_joint_state_is_read_with_its_padding_and_a_cut_one_is_refused() {
        let mut message = Vec::new();
        header(&mut message, "map");
        message.extend(2u32.to_le_bytes());
        for name in ["a", "elbow"] {
            text(&mut message, name);
        }
        for values in [&[0.25, -1.5][..], &[3.0, 4.0], &[]] {
            align(&mut message, 4);
            message.extend((values.len() as u32).to_le_bytes());
            values.iter().for_each(|x| double(&mut message, *x));
        }
        let said = read_cdr("sensor_msgs/msg/JointState", &message).expect("it is whole");
        assert_eq!(said.stamp, Some(Stamp::Nanoseconds(12_500_000_000)));
        let expected = [("a.position", 0.25), ("elbow.position", -1.5), ("a.velocity", 3.0), ("elbow.velocity", 4.0)];
        assert_eq!(said.numbers, expected.map(|(k, x)| (k.to_owned(), x)));
        for cut in 0..message.len() {
            assert!(read_cdr("sensor_msgs/JointState", &message[..cut]).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn json_is_flat_and_channels_keep_their_names() {
        let said = read_json(br#"{"t": 1.5, "joint.elbow.position": 0.5, "pose": {"x": [1, 2]}, "word": "no"}"#);
        let said = said.expect("it is JSON");
        assert_eq!(said.stamp, Some(Stamp::Seconds(1.5)));
        let names: Vec<String> = said.numbers.iter().map(|(key, _)| column_of("arm", key)).collect();
        assert_eq!(names, ["joint.elbow.position", "arm.pose.x.0", "arm.pose.x.1"]);
        assert!(read_json(b"{").is_err());
    }

    #[test]
    fn messages_of_one_instant_share_a_row_and_two_of_one_topic_do_not() {
        let row = |t: f64, name: &str, x: f64| (t, t + 9.0, vec![(name.to_owned(), x)]);
        let table = tabulate(
            Path::new("a.mcap"),
            vec![row(2.0, "a", 1.0), row(1.0, "b", 2.0), row(1.0, "a", 3.0), row(1.0, "a", 4.0)],
        );
        let of = |name: &str| table.column(name).map(|c| c.values.clone()).expect("it is there");
        assert_eq!(of("t"), [1.0, 1.0, 2.0]);
        assert_eq!(of("log_time"), [10.0, 10.0, 11.0]);
        assert_eq!(of("a"), [3.0, 4.0, 1.0]);
        assert_eq!(of("b")[0], 2.0);
    }
}

//! What changes with time, sent column by column: poses, contacts, signals, events.

use super::look::{Look, single};
use super::paths::{channel_path, link_path};
use super::shapes::translation_and_quaternion;
use crate::{Channel, ContactSample, Event, EventKind, Log, Scene};
use rerun::{RecordingStream, RecordingStreamError, TextLogLevel, TimeColumn};

/// Colour of what sticks.
const STICK: [u8; 3] = [38, 198, 178];
/// Colour of what slides.
const SLIDE: [u8; 3] = [255, 140, 26];
/// Colour of normal forces.
const NORMAL: [u8; 3] = [140, 170, 255];
/// Colours of lines, told apart on dark and on light ground.
const LINES: [[u8; 3]; 10] = [
    [79, 152, 255],
    [255, 152, 48],
    [58, 201, 122],
    [235, 87, 87],
    [177, 122, 255],
    [64, 205, 216],
    [240, 200, 60],
    [240, 120, 190],
    [150, 160, 175],
    [160, 200, 80],
];

type Sent = Result<(), RecordingStreamError>;

/// All rows of a log.
pub(super) fn send_rows(rec: &RecordingStream, log: &Log, scene: &Scene, look: &Look) -> Sent {
    send_poses(rec, log, scene, look)?;
    send_contacts(rec, log, look)?;
    for channel in &log.signals.channels {
        send_channel(rec, log, channel)?;
    }
    send_events(rec, &log.events)
}

/// Names, colours and widths of the lines.
pub(super) fn send_styles(rec: &RecordingStream, log: &Log) -> Sent {
    for axes in log.signals.axes() {
        for (k, (&i, label)) in axes.channels.iter().zip(&axes.labels).enumerate() {
            let line = rerun::SeriesLines::new()
                .with_names([label.as_str()])
                .with_colors([rerun::Color::from(LINES[k % LINES.len()])])
                .with_widths([1.5]);
            rec.log_static(channel_path(&log.signals.channels[i].spec), &line)?;
        }
    }
    Ok(())
}

/// The summary for people, and what the colours mean.
pub(super) fn send_summary(rec: &RecordingStream, markdown: &str, look: &Look) -> Sent {
    let text = format!("{}\n\n{}\n", markdown.trim_end(), look.legend());
    let document = rerun::TextDocument::new(text).with_media_type(rerun::MediaType::MARKDOWN);
    rec.log_static("summary", &document)
}

fn send_poses(rec: &RecordingStream, log: &Log, scene: &Scene, look: &Look) -> Sent {
    let times = times(log, 0..log.len());
    for link in 0..log.link_count() {
        let logged = (0..log.len()).map(|i| translation_and_quaternion(&look.near(&log.poses_w(i)[link])));
        let (translations, quaternions): (Vec<_>, Vec<_>) = logged.unzip();
        let columns = rerun::Transform3D::update_fields()
            .with_many_translation(translations)
            .with_many_quaternion(quaternions)
            .columns_of_unit_batches()?;
        rec.send_columns(link_path(scene, link), times.clone(), columns)?;
    }
    Ok(())
}

/// Rows where something touches, and one with nothing after each of them so that nothing stays on the screen.
fn send_contacts(rec: &RecordingStream, log: &Log, look: &Look) -> Sent {
    let touching = |i: usize| !log.contacts[i].is_empty();
    let rows: Vec<usize> = (0..log.len()).filter(|&i| touching(i) || i == 0 || touching(i - 1)).collect();
    let lengths: Vec<usize> = rows.iter().map(|&i| log.contacts[i].len()).collect();
    let contacts: Vec<&ContactSample> = rows.iter().flat_map(|&i| &log.contacts[i]).collect();
    let origins: Vec<[f32; 3]> = contacts.iter().map(|c| look.near_point(&c.point_w)).collect();
    let state: Vec<rerun::Color> = contacts.iter().map(|c| colour(if c.sticking { STICK } else { SLIDE })).collect();
    let times = times(log, rows.iter().copied());

    let points = rerun::Points3D::update_fields().with_positions(origins.clone()).with_colors(state.clone());
    let radius = rerun::Points3D::update_fields().with_radii([rerun::Radius::new_ui_points(4.0)]);
    rec.log_static("world/contacts/points", &radius)?;
    rec.send_columns("world/contacts/points", times.clone(), points.columns(lengths.clone())?)?;

    let arrows = |vectors: Vec<[f32; 3]>, colours: Vec<rerun::Color>| {
        let arrows = rerun::Arrows3D::update_fields().with_vectors(vectors).with_origins(origins.clone());
        arrows.with_colors(colours).columns(lengths.clone())
    };
    let thickness = rerun::Arrows3D::update_fields().with_radii([rerun::Radius::new_ui_points(1.6)]);
    let normal = contacts.iter().map(|c| single(c.normal_force_w * look.arrow_m_per_n)).collect();
    let friction = contacts.iter().map(|c| single(c.friction_force_w * look.arrow_m_per_n)).collect();
    for (path, vectors, colours) in [
        ("world/contacts/normal", normal, vec![colour(NORMAL); contacts.len()]),
        ("world/contacts/friction", friction, state),
    ] {
        rec.log_static(path, &thickness)?;
        rec.send_columns(path, times.clone(), arrows(vectors, colours)?)?;
    }
    Ok(())
}

fn send_channel(rec: &RecordingStream, log: &Log, channel: &Channel) -> Sent {
    let rows: Vec<usize> = (0..log.len()).filter(|&i| channel.values[i].is_finite()).collect();
    let values = rows.iter().map(|&i| channel.values[i]);
    let columns = rerun::Scalars::update_fields().with_scalars(values).columns_of_unit_batches()?;
    rec.send_columns(channel_path(&channel.spec), times(log, rows.iter().copied()), columns)
}

/// The text log, and the phases as a lane of their own.
pub(super) fn send_events(rec: &RecordingStream, events: &[Event]) -> Sent {
    if events.is_empty() {
        return Ok(());
    }
    let times = event_times(events.iter());
    let columns = rerun::TextLog::update_fields()
        .with_many_text(events.iter().map(|event| event.text.as_str()))
        .with_many_level(events.iter().map(|event| level(event.kind)))
        .columns_of_unit_batches()?;
    rec.send_columns("events", times, columns)?;
    let phases: Vec<&Event> = events.iter().filter(|event| starts_phase(event.kind)).collect();
    if phases.is_empty() {
        return Ok(());
    }
    let times = event_times(phases.iter().copied());
    let columns = rerun::StateChange::new().with_state(phases.iter().map(|event| event.text.as_str()));
    rec.send_columns("phase", times, columns.columns_of_unit_batches()?)
}

/// Events that the phase lane shows: what the strategy does, and what becomes of the target.
fn starts_phase(kind: EventKind) -> bool {
    matches!(kind, EventKind::Phase | EventKind::Capture | EventKind::Loss)
}

fn level(kind: EventKind) -> TextLogLevel {
    match kind {
        EventKind::Phase | EventKind::Note => TextLogLevel::DEBUG.into(),
        EventKind::Contact | EventKind::Capture => TextLogLevel::INFO.into(),
        EventKind::Limit => TextLogLevel::WARN.into(),
        EventKind::Loss => TextLogLevel::ERROR.into(),
    }
}

fn colour(rgb: [u8; 3]) -> rerun::Color {
    rgb.into()
}

fn times(log: &Log, rows: impl Iterator<Item = usize> + Clone) -> [TimeColumn; 2] {
    let seconds = rows.clone().map(|i| log.signals.times[i]);
    [sim_time(seconds), TimeColumn::new_sequence("step", rows.map(|i| log.steps[i] as i64))]
}

fn event_times<'a>(events: impl Iterator<Item = &'a Event> + Clone) -> [TimeColumn; 2] {
    let seconds = events.clone().map(|event| event.t);
    [sim_time(seconds), TimeColumn::new_sequence("step", events.map(|event| event.step as i64))]
}

/// Whole nanoseconds: Rerun's clock.
fn sim_time(seconds: impl Iterator<Item = f64>) -> TimeColumn {
    TimeColumn::new_duration_nanos("sim_time", seconds.map(|t| (t * 1e9).round() as i64))
}

//! The views that a run opens on.
//!
//! ```text
//! ┌──────────────────────────┬──────────────┐
//! │ overview, 3-D            │ relative     │
//! │                          ├──────────────┤
//! ├────────────┬─────────────┤ contact      │
//! │ close-up   │ summary     ├──────────────┤
//! │            │ events      │ …, the rest  │
//! ├────────────┴─────────────┤ in tabs      │
//! │ phases                   │              │
//! └──────────────────────────┴──────────────┘
//! ```

use super::blueprint::{self, Node, View};
use super::look::{Look, single};
use super::paths::{axes_path, link_path};
use crate::{Axes, ChannelSpec, EventKind, Log, Plot, Scene};
use rerun::blueprint::components::{
    BackgroundKind, Corner2D, Eye3DKind, LinkAxis, LoopMode, PanelState, PlayState, TimelineName,
};
use rerun::external::re_sdk_types::blueprint::archetypes as bp;
use rerun::{RecordingStream, RecordingStreamError};
use spatial::Vec3;

/// Plots that stand beside the 3-D view; what is beyond goes into tabs.
const FRONT_PLOTS: usize = 4;
/// Legends with more lines than this hide the plot.
const LEGEND_LINES: usize = 8;
/// Ground of the 3-D views, RGB.
const NIGHT: [u8; 3] = [13, 16, 24];
/// From where the scene is looked at, W axes.
const EYE_DIRECTION: [f64; 3] = [0.55, -1.0, 0.5];

/// Sends the blueprint of a finished run: it plays from the start, in a loop.
pub(super) fn send_blueprint(
    rec: &RecordingStream,
    log: &Log,
    scene: &Scene,
    look: &Look,
) -> Result<(), RecordingStreamError> {
    let panel = time_panel().with_play_state(PlayState::Playing).with_loop_mode(LoopMode::All);
    blueprint::send(rec, &layout(log, scene, look), &panel)
}

/// Sends the blueprint of a run that is going on: it follows the newest instant.
pub(super) fn send_live_blueprint(
    rec: &RecordingStream,
    log: &Log,
    scene: &Scene,
    look: &Look,
) -> Result<(), RecordingStreamError> {
    let panel = time_panel().with_play_state(PlayState::Following);
    blueprint::send(rec, &layout(log, scene, look), &panel)
}

fn time_panel() -> bp::TimePanelBlueprint {
    bp::TimePanelBlueprint::new().with_state(PanelState::Collapsed).with_timeline(TimelineName("sim_time".into()))
}

fn layout(log: &Log, scene: &Scene, look: &Look) -> Node {
    let left = left_side(log, scene, look);
    match right_side(log) {
        Some(right) => Node::row(vec![(3.0, left), (2.0, right)]),
        None => left,
    }
}

fn left_side(log: &Log, scene: &Scene, look: &Look) -> Node {
    let text = Node::tabs(vec![
        View::new("TextDocument", "Summary", "/summary").into(),
        View::new("TextLog", "Events", "/events").with("TextLogColumns", &event_columns()).into(),
    ]);
    let below = match scene.close_up {
        Some(link) => Node::row(vec![(1.0, close_up(scene, link, look)), (1.0, text)]),
        None => text,
    };
    let mut rows = vec![(3.0, overview(look)), (2.0, below)];
    if log.events.iter().any(|event| event.kind == EventKind::Phase) {
        rows.push((0.6, View::new("StateTimeline", "Phase", "/phase").into()));
    }
    Node::column(rows)
}

fn overview(look: &Look) -> Node {
    let eye = look.centre + Vec3::from(EYE_DIRECTION).normalize() * look.radius * 1.9;
    let view = View::new("3D", "Overview", "/world");
    with_space_properties(view, eye, look.centre).into()
}

/// The camera moves with the link; it looks at the first contact from the side where the other vehicle comes from,
/// and at the whole link where no contact is known.
fn close_up(scene: &Scene, link: usize, look: &Look) -> Node {
    let target = look.touch_l.unwrap_or_default();
    let sideways = look.approach_l.cross(&Vec3::z()).try_normalize(0.05).unwrap_or(Vec3::y());
    let near = if look.touch_l.is_some() { 0.25 } else { 0.6 };
    let distance = (near * look.radius).clamp(0.4, 8.0 * near);
    let eye = target + (0.6 * look.approach_l + 0.7 * sideways + 0.4 * Vec3::z()).normalize() * distance;
    let view =
        View::new("3D", "Close-up", link_path(scene, link)).with_contents(&["+ /world/**", "- /world/trails/**"]);
    with_space_properties(view, eye, target).into()
}

/// Space has no floor: no grid, dark ground.
fn with_space_properties(view: View, eye: Vec3, target: Vec3) -> View {
    let eye = bp::EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position(single(eye))
        .with_look_target(single(target))
        .with_eye_up([0.0, 0.0, 1.0]);
    view.with("EyeControls3D", &eye)
        .with("LineGrid3D", &bp::LineGrid3D::new().with_visible(false))
        .with("Background", &bp::Background::new(BackgroundKind::SolidColor).with_color(NIGHT))
}

/// Time, severity and text, without the columns that say the same in every row.
fn event_columns() -> bp::TextLogColumns {
    use rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
    let shown = |kind| TextLogColumn { visible: true.into(), kind };
    let time = |timeline: &str, visible: bool| TimelineColumn { visible: visible.into(), timeline: timeline.into() };
    bp::TextLogColumns::new()
        .with_timeline_columns([time("sim_time", true), time("step", false)])
        .with_text_log_columns([shown(TextLogColumnKind::LogLevel), shown(TextLogColumnKind::Body)])
}

/// The most telling plots below each other, the others in tabs; nothing where there are no signals.
fn right_side(log: &Log) -> Option<Node> {
    let specs: Vec<&ChannelSpec> = log.signals.channels.iter().map(|channel| &channel.spec).collect();
    let (front, others) = front_and_others(log.signals.axes());
    let mut column: Vec<(f32, Node)> = front.iter().map(|axes| (1.0, plot(axes, &specs))).collect();
    if !others.is_empty() {
        column.push((1.0, Node::tabs(others.iter().map(|axes| plot(axes, &specs)).collect())));
    }
    (!column.is_empty()).then(|| Node::column(column))
}

/// One set of axes of each telling plot first; places that are left go to their second ones.
fn front_and_others(all: Vec<Axes>) -> (Vec<Axes>, Vec<Axes>) {
    let telling = |axes: &Axes| axes.plot <= Plot::Energy;
    let mut seen = Vec::new();
    let (first, second): (Vec<Axes>, Vec<Axes>) = all.into_iter().partition(|axes| {
        let new = telling(axes) && !seen.contains(&axes.plot);
        seen.push(axes.plot);
        new
    });
    let (mut front, mut others) = (first, Vec::new());
    for axes in second {
        if front.len() < FRONT_PLOTS && telling(&axes) { front.push(axes) } else { others.push(axes) }
    }
    front.sort_by_key(|axes| axes.plot);
    (front, others)
}

fn plot(axes: &Axes, specs: &[&ChannelSpec]) -> Node {
    let legend =
        bp::PlotLegend::new().with_corner(Corner2D::RightTop).with_visible(axes.channels.len() <= LEGEND_LINES);
    let origin = axes.channels.first().map(|&i| axes_path(specs[i])).unwrap_or_else(rerun::EntityPath::root);
    View::new("TimeSeries", axes.title(specs), origin)
        .with("PlotLegend", &legend)
        .with("TimeAxis", &bp::TimeAxis::new().with_link(LinkAxis::LinkToGlobal))
        .into()
}

//! A blueprint as a tree of containers and views, with the view properties that Rerun's own builder keeps private
//! (camera, grid, legend, time axis) and with identifiers that are the same in every file.

use rerun::blueprint::components::{
    ColumnShare, ContainerKind, IncludedContent, QueryExpression, RootContainer, RowShare,
};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as bp;
use rerun::{AsComponents, RecordingStream, RecordingStreamBuilder, RecordingStreamError, SerializedComponentBatch};

/// A container or a view.
#[derive(Debug)]
pub(super) enum Node {
    /// Children side by side, one over the other, or behind each other.
    Container { kind: ContainerKind, children: Vec<(f32, Self)> },
    /// A view.
    View(View),
}

/// A view of one of Rerun's classes.
#[derive(Debug)]
pub(super) struct View {
    class: &'static str,
    name: String,
    origin: String,
    contents: Vec<String>,
    properties: Vec<(&'static str, Vec<SerializedComponentBatch>)>,
}

impl View {
    /// A view of all that is below `origin`.
    pub(super) fn new(class: &'static str, name: impl Into<String>, origin: impl ToString) -> Self {
        let contents = vec!["$origin/**".into()];
        Self { class, name: name.into(), origin: origin.to_string(), contents, properties: Vec::new() }
    }

    /// Shows these entities instead.
    pub(super) fn with_contents(mut self, contents: &[&str]) -> Self {
        self.contents = contents.iter().map(ToString::to_string).collect();
        self
    }

    /// Sets a property; `name` is the archetype's.
    pub(super) fn with(mut self, name: &'static str, property: &dyn AsComponents) -> Self {
        self.properties.push((name, property.as_serialized_batches()));
        self
    }
}

impl From<View> for Node {
    fn from(view: View) -> Self {
        Self::View(view)
    }
}

impl Node {
    /// Children side by side, with their shares of the width.
    pub(super) fn row(children: Vec<(f32, Self)>) -> Self {
        Self::Container { kind: ContainerKind::Horizontal, children }
    }

    /// Children one over the other, with their shares of the height.
    pub(super) fn column(children: Vec<(f32, Self)>) -> Self {
        Self::Container { kind: ContainerKind::Vertical, children }
    }

    /// Children behind each other.
    pub(super) fn tabs(children: Vec<Self>) -> Self {
        let children = children.into_iter().map(|child| (1.0, child)).collect();
        Self::Container { kind: ContainerKind::Tabs, children }
    }
}

/// Sends a blueprint along with a recording, as its active and default one.
pub(super) fn send(
    rec: &RecordingStream,
    root: &Node,
    time_panel: &bp::TimePanelBlueprint,
) -> Result<(), RecordingStreamError> {
    let Some(info) = rec.store_info() else { return Ok(()) };
    let (sheet, storage) = RecordingStreamBuilder::new(info.application_id().clone())
        .recording_id(format!("{}-blueprint", info.recording_id()))
        .enabled(true)
        .send_properties(false)
        .blueprint()
        .memory()?;
    sheet.set_log_time_enabled(false);
    sheet.set_time_sequence("blueprint", 0);
    let mut writer = Writer { sheet: &sheet, count: 0 };
    let id = writer.add(root)?.1;
    let viewport = bp::ViewportBlueprint::new()
        .with_root_container(RootContainer(rerun::datatypes::Uuid { bytes: id }))
        .with_auto_layout(false)
        .with_auto_views(false);
    sheet.log("viewport", &viewport)?;
    send_panels(&sheet, time_panel)?;
    let messages = storage.take();
    if let Some(blueprint_id) = messages.first().map(|message| message.store_id().clone()) {
        let activation = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
        rec.send_blueprint(messages, activation);
    }
    Ok(())
}

/// All but the time panel are folded away.
fn send_panels(sheet: &RecordingStream, time_panel: &bp::TimePanelBlueprint) -> Result<(), RecordingStreamError> {
    use rerun::blueprint::components::PanelState;
    for panel in ["blueprint_panel", "selection_panel"] {
        sheet.log(panel, &bp::PanelBlueprint::new().with_state(PanelState::Collapsed))?;
    }
    sheet.log("time_panel", time_panel)
}

type Id = [u8; 16];

struct Writer<'a> {
    sheet: &'a RecordingStream,
    count: u8,
}

impl Writer<'_> {
    /// Writes a node and all below; returns its path and identifier.
    fn add(&mut self, node: &Node) -> Result<(String, Id), RecordingStreamError> {
        match node {
            Node::Container { kind, children } => self.add_container(*kind, children),
            Node::View(view) => self.add_view(view),
        }
    }

    fn add_container(
        &mut self,
        kind: ContainerKind,
        children: &[(f32, Node)],
    ) -> Result<(String, Id), RecordingStreamError> {
        let mut contents = Vec::new();
        for (_, child) in children {
            contents.push(IncludedContent(self.add(child)?.0.into()));
        }
        let (path, id) = self.next("container");
        let mut container = bp::ContainerBlueprint::new(kind);
        if let Some(first) = contents.first().filter(|_| kind == ContainerKind::Tabs) {
            container = container.with_active_tab(first.0.as_str());
        }
        let shares = children.iter().map(|(share, _)| rerun::datatypes::Float32(*share));
        container = match kind {
            ContainerKind::Horizontal => container.with_col_shares(shares.map(ColumnShare)),
            _ => container.with_row_shares(shares.map(RowShare)),
        };
        self.sheet.log(path.clone(), &container.with_contents(contents))?;
        Ok((path, id))
    }

    fn add_view(&mut self, view: &View) -> Result<(String, Id), RecordingStreamError> {
        let (path, id) = self.next("view");
        let contents = view.contents.iter().map(|query| QueryExpression(query.as_str().into()));
        self.sheet.log(format!("{path}/ViewContents"), &bp::ViewContents::new(contents))?;
        let blueprint = bp::ViewBlueprint::new(view.class)
            .with_display_name(view.name.as_str())
            .with_space_origin(view.origin.as_str());
        self.sheet.log(path.clone(), &blueprint)?;
        for (name, batches) in &view.properties {
            self.sheet.log_serialized_batches(format!("{path}/{name}"), false, batches.iter().cloned())?;
        }
        Ok((path, id))
    }

    /// The next identifier: a fixed one with a number, in the form of a random UUID (version 4).
    fn next(&mut self, kind: &str) -> (String, Id) {
        self.count += 1;
        let mut id = *b"softdock\x40views\x00\x00";
        id[6] = 0x40;
        id[8] = 0x80;
        id[15] = self.count;
        let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
        let groups = [&id[0..4], &id[4..6], &id[6..8], &id[8..10], &id[10..16]];
        (format!("{kind}/{}", groups.map(hex).join("-")), id)
    }
}

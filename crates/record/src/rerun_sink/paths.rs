//! Entity paths. Names from files are parts of their own and escaped, whatever characters they have.

use crate::{ChannelSpec, Scene};
use rerun::{EntityPath, EntityPathPart};

/// A path from parts that may hold any characters.
pub(super) fn path(parts: &[&str]) -> EntityPath {
    EntityPath::new(parts.iter().map(|part| EntityPathPart::from(*part)).collect())
}

/// Where a link's pose and shapes are.
pub(super) fn link_path(scene: &Scene, link: usize) -> EntityPath {
    match scene.links().nth(link) {
        Some((vehicle, link)) => path(&["world", vehicle, &link.name]),
        None => path(&["world"]),
    }
}

/// Where the channels of a set of axes are.
pub(super) fn axes_path(spec: &ChannelSpec) -> EntityPath {
    let unit = if spec.unit.is_empty() { "1" } else { spec.unit.as_str() };
    path(&["signals", spec.plot.key(), unit])
}

/// Where a channel is.
pub(super) fn channel_path(spec: &ChannelSpec) -> EntityPath {
    axes_path(spec).join(&path(&[&spec.name]))
}

//! Colours: from a primitive's material symbol through the instance's binding to the effect's diffuse colour.

use super::{Ids, LocalName, child, floats, target};
use roxmltree::Node;

/// Looks colours up.
pub(super) struct Colours<'m, 'a, 'i> {
    ids: &'m Ids<'a, 'i>,
}

impl<'m, 'a, 'i> Colours<'m, 'a, 'i> {
    /// Of a document.
    pub(super) fn new(ids: &'m Ids<'a, 'i>) -> Self {
        Self { ids }
    }

    /// Diffuse RGBA of the material that `symbol` stands for in an instance; `None` for textures and unknown ones.
    pub(super) fn find(&self, symbol: &str, instance: Option<Node<'a, 'i>>) -> Option<[f32; 4]> {
        let bound = instance.into_iter().flat_map(|i| i.descendants());
        let bound = bound.filter(|n| n.has_tag_name_local("instance_material"));
        let bound = bound.filter(|n| n.attribute("symbol") == Some(symbol)).find_map(|n| n.attribute("target"));
        let material = target(self.ids, bound.unwrap_or(symbol))?;
        let effect = target(self.ids, child(material, "instance_effect")?.attribute("url")?)?;
        let diffuse = effect.descendants().find(|n| n.has_tag_name_local("diffuse"))?;
        let rgba = floats(child(diffuse, "color")?).ok()?;
        let in_range = rgba.iter().map(|x| x.clamp(0.0, 1.0) as f32).collect::<Vec<_>>();
        match in_range[..] {
            [r, g, b] => Some([r, g, b, 1.0]),
            [r, g, b, a] => Some([r, g, b, a]),
            _ => None,
        }
    }
}

//! COLLADA (DAE): triangles of the visual scene, in metres, z up, with diffuse colours.
//!
//! Source: Khronos, COLLADA 1.4.1 specification (2008), chapter 5. Read are `<unit>`, `<up_axis>`, the nodes of the
//! scene with their transforms and instances, `<triangles>`, `<polylist>`, `<polygons>`, `<tristrips>`, `<trifans>`,
//! and the diffuse colour of bound materials. Polygons become fans, so they should be convex. Textures, lines, skins
//! and animations are passed over.
//!
//! Up axis: the file's axes are turned so that its up is z and its right is x (5-18 of the specification: right, up,
//! inward = x, y, z for Y_UP; −y, x, z for X_UP; x, z, −y for Z_UP).

mod geometry;
mod materials;
mod scene;

use super::markup::{parse_bounded, place_of};
use super::{Fault, RawMesh};
use geometry::Library;
use materials::Colours;
use roxmltree::{Document, Node};
use spatial::nalgebra::Matrix4;
use std::collections::HashMap;
use std::path::Path;

/// Elements of a document by the id that others name them by.
type Ids<'a, 'i> = HashMap<&'a str, Node<'a, 'i>>;

/// Reads a COLLADA file.
pub(super) fn read_collada(bytes: &[u8], _file: &Path) -> Result<RawMesh, Fault> {
    let text = std::str::from_utf8(bytes).map_err(|_| Fault::new("it is not UTF-8 text"))?;
    let document =
        parse_bounded(text).map_err(|e| Fault::in_line(place_of(text, e.offset).line, format!("XML: {}", e.said)))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err(Fault::new(format!("its outermost tag is <{}>, not <COLLADA>", root.tag_name().name())));
    }
    let ids = ids_of(&document);
    let mut library = Library::new(&ids, Colours::new(&ids));
    let to_metres = calc_world(root)?;
    let placed = scene::place_geometries(root, &ids, to_metres)?;
    for instance in &placed {
        library.add_instance(instance)?;
    }
    Ok(library.finish())
}

fn ids_of<'a, 'i>(document: &'a Document<'i>) -> Ids<'a, 'i> {
    let mut ids = Ids::new();
    for node in document.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("id") {
            ids.entry(id).or_insert(node);
        }
    }
    ids
}

/// The element that `url="#id"` names.
fn target<'a, 'i>(ids: &Ids<'a, 'i>, url: &str) -> Option<Node<'a, 'i>> {
    ids.get(url.strip_prefix('#').unwrap_or(url)).copied()
}

/// The first child with this tag.
fn child<'a, 'i>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|c| c.has_tag_name_local(tag))
}

/// Tags are compared without their namespace: files of 1.4 and 1.5 differ in it.
trait LocalName {
    fn has_tag_name_local(&self, tag: &str) -> bool;
}

impl LocalName for Node<'_, '_> {
    fn has_tag_name_local(&self, tag: &str) -> bool {
        self.is_element() && self.tag_name().name() == tag
    }
}

/// Line of a node, for a fault.
fn line_of(node: Node<'_, '_>) -> usize {
    node.document().text_pos_at(node.range().start).row as usize
}

/// The numbers of an element's text.
fn floats(node: Node<'_, '_>) -> Result<Vec<f64>, Fault> {
    let words = node.text().unwrap_or_default().split_ascii_whitespace();
    let parsed = words.map(|w| w.parse::<f64>().map_err(|_| w)).collect::<Result<Vec<_>, _>>();
    parsed.map_err(|w| Fault::in_line(line_of(node), format!("\"{w}\" is not a number")))
}

/// From the file's units and axes to metres, z up.
fn calc_world(root: Node<'_, '_>) -> Result<Matrix4<f64>, Fault> {
    let asset = child(root, "asset");
    let unit = asset.and_then(|a| child(a, "unit"));
    let metres = unit.and_then(|u| u.attribute("meter")).map_or(Ok(1.0), |text| {
        let parsed = text.trim().parse::<f64>().ok().filter(|m| m.is_finite() && *m > 0.0);
        parsed.ok_or_else(|| Fault::new(format!("its unit is \"{text}\" metres")))
    })?;
    let up = asset.and_then(|a| child(a, "up_axis")).and_then(|u| u.text()).unwrap_or("Y_UP").trim();
    let turn = match up {
        "X_UP" => [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]],
        "Y_UP" => [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        "Z_UP" => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        other => return Err(Fault::new(format!("its up_axis is \"{other}\""))),
    };
    Ok(Matrix4::from_fn(|r, c| match (r, c) {
        (0..3, 0..3) => metres * turn[r][c],
        (3, 3) => 1.0,
        _ => 0.0,
    }))
}

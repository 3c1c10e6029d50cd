//! Geometries: positions from sources, corners from primitives.

use super::materials::Colours;
use super::scene::Instance;
use super::{Fault, Ids, LocalName, RawMesh, child, floats, line_of, target};
use roxmltree::Node;
use spatial::nalgebra::{Matrix4, Point3};
use std::collections::HashMap;
use std::rc::Rc;

/// More triangles than any mesh of a robot; instances can multiply them.
const MOST_TRIANGLES: usize = 20_000_000;
/// What a triangle without a colour gets where others have one.
const UNCOLOURED: [f32; 4] = [0.8, 0.8, 0.8, 1.0];

/// Corners of a primitive's polygons: indices of positions.
struct Polygons {
    triangles: Vec<[usize; 3]>,
    positions: Rc<Vec<[f64; 3]>>,
}

/// Collects placed geometries into one mesh.
pub(super) struct Library<'m, 'a, 'i> {
    ids: &'m Ids<'a, 'i>,
    colours: Colours<'m, 'a, 'i>,
    sources: HashMap<String, Rc<Vec<[f64; 3]>>>,
    mesh: RawMesh,
    is_coloured: bool,
}

impl<'m, 'a, 'i> Library<'m, 'a, 'i> {
    /// Empty.
    pub(super) fn new(ids: &'m Ids<'a, 'i>, colours: Colours<'m, 'a, 'i>) -> Self {
        Self { ids, colours, sources: HashMap::new(), mesh: RawMesh::default(), is_coloured: false }
    }

    /// The mesh; without colours if no part has one.
    pub(super) fn finish(mut self) -> RawMesh {
        if !self.is_coloured {
            self.mesh.vertex_rgba.clear();
        }
        self.mesh
    }

    /// Adds the triangles of one instance.
    pub(super) fn add_instance(&mut self, instance: &Instance<'a, 'i>) -> Result<(), Fault> {
        let Some(mesh) = child(instance.geometry, "mesh") else { return Ok(()) };
        for primitive in mesh.children().filter(Node::is_element) {
            let Some(polygons) = self.polygons_of(primitive)? else { continue };
            let symbol = primitive.attribute("material");
            let colour = symbol.and_then(|s| self.colours.find(s, instance.instance));
            self.is_coloured |= colour.is_some();
            if self.mesh.triangles.len() + polygons.triangles.len() > MOST_TRIANGLES {
                return Err(Fault::in_line(line_of(primitive), format!("it has more than {MOST_TRIANGLES} triangles")));
            }
            self.append(&polygons, &instance.pose, colour.unwrap_or(UNCOLOURED));
        }
        Ok(())
    }

    fn append(&mut self, polygons: &Polygons, pose: &Matrix4<f64>, rgba: [f32; 4]) {
        let is_mirrored = pose.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        let mut index_of = vec![u32::MAX; polygons.positions.len()];
        for corners in &polygons.triangles {
            let mut triangle = [0; 3];
            for (i, &corner) in corners.iter().enumerate() {
                if index_of[corner] == u32::MAX {
                    index_of[corner] = self.mesh.vertices.len() as u32;
                    let placed = pose.transform_point(&Point3::from(polygons.positions[corner]));
                    self.mesh.vertices.push(placed.coords.into());
                    self.mesh.vertex_rgba.push(rgba);
                }
                triangle[i] = index_of[corner];
            }
            if is_mirrored {
                triangle.swap(1, 2);
            }
            self.mesh.triangles.push(triangle);
        }
    }

    /// The polygons of a primitive; `None` for elements that are none, or that have no faces.
    fn polygons_of(&mut self, primitive: Node<'a, 'i>) -> Result<Option<Polygons>, Fault> {
        let tag = primitive.tag_name().name();
        if !matches!(tag, "triangles" | "polylist" | "polygons" | "tristrips" | "trifans") {
            return Ok(None);
        }
        let fault = |reason| Fault::in_line(line_of(primitive), reason);
        let inputs: Vec<_> = primitive.children().filter(|c| c.has_tag_name_local("input")).collect();
        let offset = |n: &Node<'_, '_>| n.attribute("offset").and_then(|o| o.parse::<usize>().ok()).unwrap_or(0);
        let stride = inputs.iter().map(offset).max().unwrap_or(0).saturating_add(1);
        let vertex = inputs.iter().find(|n| n.attribute("semantic") == Some("VERTEX"));
        let Some(vertex) = vertex else {
            return Err(fault(format!("<{tag}> has no VERTEX input")));
        };
        let positions = self.positions_of(*vertex)?;
        let mut triangles = Vec::new();
        for polygon in split_polygons(primitive, stride)? {
            let corners: Vec<usize> = polygon.chunks_exact(stride).map(|c| c[offset(vertex)]).collect();
            if let Some(bad) = corners.iter().find(|i| **i >= positions.len()) {
                return Err(fault(format!("<{tag}> names vertex {bad}, but there are {}", positions.len())));
            }
            add_triangles(tag, &corners, &mut triangles);
        }
        Ok(Some(Polygons { triangles, positions }))
    }

    /// Positions behind a VERTEX input: `<vertices>` → POSITION → `<source>` → `<float_array>`.
    fn positions_of(&mut self, input: Node<'a, 'i>) -> Result<Rc<Vec<[f64; 3]>>, Fault> {
        let name = input.attribute("source").unwrap_or_default();
        if let Some(known) = self.sources.get(name) {
            return Ok(known.clone());
        }
        let missing = || Fault::in_line(line_of(input), format!("vertices \"{name}\" have no positions"));
        let vertices = target(self.ids, name).ok_or_else(missing)?;
        let is_position = |n: &Node<'_, '_>| n.attribute("semantic") == Some("POSITION");
        let position = vertices.children().find(is_position).and_then(|n| n.attribute("source"));
        let source = position.and_then(|url| target(self.ids, url)).ok_or_else(missing)?;
        let positions = Rc::new(read_source(source, self.ids).ok_or_else(missing)??);
        self.sources.insert(name.to_owned(), positions.clone());
        Ok(positions)
    }
}

fn read_source(source: Node<'_, '_>, ids: &Ids<'_, '_>) -> Option<Result<Vec<[f64; 3]>, Fault>> {
    let accessor = child(source, "technique_common").and_then(|t| child(t, "accessor"));
    let array = child(source, "float_array");
    let array = array.or_else(|| target(ids, accessor?.attribute("source")?))?;
    let number = |name, otherwise| {
        accessor.and_then(|a| a.attribute(name)).and_then(|s| s.parse::<usize>().ok()).unwrap_or(otherwise)
    };
    let (stride, offset) = (number("stride", 3).max(3), number("offset", 0));
    let positions = floats(array).map(|numbers| {
        let numbers = numbers.get(offset..).unwrap_or_default();
        // The last group may lack what the stride would skip.
        numbers.chunks(stride).filter(|c| c.len() >= 3).map(|c| [c[0], c[1], c[2]]).collect()
    });
    Some(positions)
}

/// Index lists, one for each polygon, strip or fan; a list of triangles is cut in threes.
fn split_polygons(primitive: Node<'_, '_>, stride: usize) -> Result<Vec<Vec<usize>>, Fault> {
    let mut lists = Vec::new();
    for list in primitive.children().filter(Node::is_element) {
        match list.tag_name().name() {
            "p" => lists.push(indices(list)?),
            // A polygon with holes: its outer contour alone.
            "ph" => lists.extend(child(list, "p").map(indices).transpose()?),
            _ => {}
        }
    }
    let cut = |counts: &mut dyn Iterator<Item = usize>| {
        let all: Vec<usize> = lists.concat();
        let mut start = 0_usize;
        let mut cut = Vec::new();
        for count in counts {
            let end = count.checked_mul(stride).and_then(|n| start.checked_add(n)).filter(|end| *end <= all.len())?;
            cut.push(all[start..end].to_vec());
            start = end;
        }
        Some(cut)
    };
    let short = || Fault::in_line(line_of(primitive), "its <vcount> asks for more corners than <p> has");
    match primitive.tag_name().name() {
        "triangles" => {
            let total: usize = lists.iter().map(Vec::len).sum();
            let count = total.checked_div(stride.saturating_mul(3)).unwrap_or(0);
            cut(&mut std::iter::repeat_n(3, count)).ok_or_else(short)
        }
        "polylist" => {
            let counts = child(primitive, "vcount").map(indices).transpose()?.unwrap_or_default();
            cut(&mut counts.into_iter()).ok_or_else(short)
        }
        _ => Ok(lists),
    }
}

fn indices(node: Node<'_, '_>) -> Result<Vec<usize>, Fault> {
    let words = node.text().unwrap_or_default().split_ascii_whitespace();
    let parsed = words.map(|w| w.parse::<usize>().map_err(|_| w)).collect::<Result<Vec<_>, _>>();
    parsed.map_err(|w| Fault::in_line(line_of(node), format!("\"{w}\" is not an index")))
}

fn add_triangles(tag: &str, corners: &[usize], triangles: &mut Vec<[usize; 3]>) {
    if tag == "tristrips" {
        // Every second triangle of a strip is turned round.
        let turned = |(i, w): (usize, &[usize])| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] };
        triangles.extend(corners.windows(3).enumerate().map(turned));
    } else if let [first, rest @ ..] = corners {
        triangles.extend(rest.windows(2).map(|w| [*first, w[0], w[1]]));
    }
}

//! Wavefront OBJ, with diffuse colours from its material library.
//!
//! Only positions, faces and materials matter here. Their lines are checked first, so that errors have a line, and
//! handed alone to `tobj`; faces with more than three corners become fans, so they should be convex. A face with fewer has no
//! area and is passed over.

use super::{Fault, RawMesh};
use std::path::Path;

/// Reads an OBJ file; materials that cannot be read leave the mesh without colours.
pub(super) fn read_obj(bytes: &[u8], file: &Path) -> Result<RawMesh, Fault> {
    let text = String::from_utf8_lossy(bytes);
    let kept = check_lines(&text)?;
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let (models, materials) =
        tobj::load_obj_buf(&mut kept.as_bytes(), &options, |library| load_materials(library, file))
            .map_err(|e| Fault::new(e.to_string()))?;
    let materials = materials.unwrap_or_default();
    let mut mesh = RawMesh::default();
    for model in &models {
        append(&mut mesh, &model.mesh, &materials)?;
    }
    if mesh.vertex_rgba.iter().all(|c| *c == UNCOLOURED) {
        mesh.vertex_rgba.clear();
    }
    Ok(mesh)
}

/// What a vertex without material gets where others have one.
const UNCOLOURED: [f32; 4] = [0.8, 0.8, 0.8, 1.0];
/// Larger material libraries are not read.
const LARGEST_LIBRARY_BYTES: u64 = 16 << 20;

fn load_materials(library: &Path, file: &Path) -> tobj::MTLLoadResult {
    let path = file.parent().unwrap_or(Path::new("")).join(library);
    let is_readable = std::fs::metadata(&path).is_ok_and(|m| m.is_file() && m.len() <= LARGEST_LIBRARY_BYTES);
    if !is_readable {
        return Err(tobj::LoadError::OpenFileFailed);
    }
    tobj::load_mtl(path)
}

fn append(mesh: &mut RawMesh, part: &tobj::Mesh, materials: &[tobj::Material]) -> Result<(), Fault> {
    let first = u32::try_from(mesh.vertices.len()).map_err(|_| Fault::new("it has more than 2³² vertices"))?;
    let corners = part.indices.as_chunks::<3>().0;
    let count = part.positions.len() / 3;
    if part.indices.iter().any(|i| *i as usize >= count) {
        return Err(Fault::new("a face names a vertex that does not exist"));
    }
    let positions = part.positions.as_chunks::<3>().0;
    mesh.vertices.extend(positions.iter().map(|p| p.map(f64::from)));
    mesh.triangles.extend(corners.iter().map(|t| t.map(|i| i + first)));
    let material = part.material_id.and_then(|id| materials.get(id));
    let diffuse = material.and_then(|m| m.diffuse.map(|[r, g, b]| [r, g, b, m.dissolve.unwrap_or(1.0)]));
    if part.vertex_color.len() == part.positions.len() {
        mesh.vertex_rgba.extend(part.vertex_color.as_chunks::<3>().0.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]));
    } else {
        mesh.vertex_rgba.extend(std::iter::repeat_n(diffuse.unwrap_or(UNCOLOURED), count));
    }
    Ok(())
}

/// The lines that matter, with faces reduced to positions counted from 1.
fn check_lines(text: &str) -> Result<String, Fault> {
    let mut kept = String::with_capacity(text.len());
    let mut vertices = 0_i64;
    for (i, line) in text.lines().enumerate() {
        let (word, rest) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        match word {
            "v" => {
                vertices += 1;
                let numbers = check_vertex(rest).map_err(|reason| Fault::in_line(i + 1, reason))?;
                kept.extend(["v ", &numbers, "\n"]);
            }
            "f" => {
                let corners = check_face(rest, vertices).map_err(|reason| Fault::in_line(i + 1, reason))?;
                if let Some(corners) = corners {
                    kept.extend(["f ", &corners, "\n"]);
                }
            }
            "o" | "g" | "usemtl" | "mtllib" if !rest.trim().is_empty() => kept.extend([word, " ", rest, "\n"]),
            _ => {}
        }
    }
    Ok(kept)
}

/// Position, and the colour that some exporters append; not the weight.
fn check_vertex(rest: &str) -> Result<String, String> {
    let words: Vec<&str> = rest.split_whitespace().collect();
    if let Some(word) = words.iter().find(|w| !w.parse::<f32>().is_ok_and(f32::is_finite)) {
        return Err(format!("\"{word}\" is not a finite number"));
    }
    match words.len() {
        3 | 6 => Ok(words.join(" ")),
        4 | 7 => Ok(words[..3].join(" ")),
        found => Err(format!("a vertex has {found} numbers instead of 3")),
    }
}

fn check_face(rest: &str, vertices: i64) -> Result<Option<String>, String> {
    let mut corners = String::new();
    let mut count = 0;
    for corner in rest.split_whitespace() {
        let written = corner.split('/').next().unwrap_or(corner);
        let index = written.parse::<i64>().map_err(|_| format!("\"{corner}\" is not a vertex index"))?;
        let from_one = if index < 0 { vertices.saturating_add(index).saturating_add(1) } else { index };
        if from_one < 1 || from_one > vertices {
            return Err(format!("a face names vertex {index}, but {vertices} vertices precede it"));
        }
        corners.push_str(&format!("{from_one} "));
        count += 1;
    }
    Ok((count >= 3).then_some(corners))
}

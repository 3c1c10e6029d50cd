//! STL, binary and text.
//!
//! A binary file is 80 bytes of header, the number of triangles as u32, and 50 bytes for each; exporters write headers
//! that begin with `solid` too, so the length decides. `stl_io` reads both and joins equal vertices.

use super::{Fault, RawMesh};
use std::io::Cursor;
use std::path::Path;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: u64 = 50;

/// Reads an STL file.
pub(super) fn read_stl(bytes: &[u8], _file: &Path) -> Result<RawMesh, Fault> {
    let promised = promised_length(bytes);
    if promised != Some(bytes.len() as u64) && is_text(bytes) {
        return read(canonical_text(bytes));
    }
    match promised {
        None => Err(Fault::new(format!("{} bytes are too few for an STL file", bytes.len()))),
        Some(length) if length > bytes.len() as u64 => {
            let triangles = (length - HEADER_BYTES as u64) / TRIANGLE_BYTES;
            let found = bytes.len();
            Err(Fault::new(format!("its header promises {triangles} triangles in {length} bytes, but it has {found}")))
        }
        Some(_) => read(binary_without_solid(bytes)),
    }
}

/// Length in bytes of a binary file that begins like this.
fn promised_length(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(80..HEADER_BYTES)?.try_into().map(u32::from_le_bytes).ok()?;
    Some(HEADER_BYTES as u64 + TRIANGLE_BYTES * u64::from(count))
}

fn is_text(bytes: &[u8]) -> bool {
    let start = bytes[..bytes.len().min(6)].to_ascii_lowercase();
    start.starts_with(b"solid") && bytes.iter().take(512).all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace())
}

/// The form that `stl_io` knows: small letters, and a blank after `solid`.
fn canonical_text(bytes: &[u8]) -> Vec<u8> {
    let lower = bytes.to_ascii_lowercase();
    [b"solid ", &lower[5..]].concat()
}

/// `stl_io` takes every file that begins with `solid ` for text.
fn binary_without_solid(bytes: &[u8]) -> Vec<u8> {
    let mut copy = bytes.to_vec();
    copy[..5].fill(b' ');
    copy
}

fn read(bytes: Vec<u8>) -> Result<RawMesh, Fault> {
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|e| Fault::new(e.to_string()))?;
    let index = |i: usize| u32::try_from(i).map_err(|_| Fault::new("it has more than 2³² vertices"));
    let triangles = mesh.faces.iter().map(|f| {
        let [a, b, c] = f.vertices;
        Ok([index(a)?, index(b)?, index(c)?])
    });
    Ok(RawMesh {
        triangles: triangles.collect::<Result<_, Fault>>()?,
        vertices: mesh.vertices.iter().map(|v| v.0.map(f64::from)).collect(),
        vertex_rgba: Vec::new(),
    })
}

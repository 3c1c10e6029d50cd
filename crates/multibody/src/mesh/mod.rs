//! Triangle meshes from files: STL, OBJ and COLLADA (DAE), in metres, checked.
//!
//! A mesh that leaves this module has at least one triangle with area, finite vertices, and indices inside its vertices.
//! Triangles without area are dropped: they are seen by nobody and have no normal. A scale with an odd number of
//! negative factors mirrors, so the triangles are turned round to stay counter-clockwise from outside.

mod collada;
pub(crate) mod markup;
mod obj;
mod search;
mod stl;

pub use markup::TextPlace;
pub use search::SearchPaths;

use crate::Mesh;
use std::path::{Path, PathBuf};

/// Files above this are refused; the finest meshes of robots have a tenth of it.
const LARGEST_FILE_BYTES: u64 = 256 << 20;
/// Beyond this a coordinate is a slip, and areas would no longer be finite.
const LARGEST_COORDINATE_M: f64 = 1e15;

/// Why a mesh cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs, reason = "the sentence beside each variant says what its fields are")]
pub enum MeshError {
    #[error("mesh {name} is not found; tried {}; correct the path", listed(.tried))]
    NotFound { name: String, tried: Vec<PathBuf> },
    #[error(
        "package \"{package}\" is not found in {}every folder from {} upwards; name the folder that holds it (`--package-path`, package_paths of a vehicle, ROS_PACKAGE_PATH or AMENT_PREFIX_PATH)",
        searched(.named), .above.display()
    )]
    NoPackage { package: String, named: Vec<PathBuf>, above: PathBuf },
    #[error("mesh {name} has the unknown form {scheme}://; use a path, file:// or package://")]
    UnknownScheme { name: String, scheme: String },
    #[error("mesh {} cannot be read: {reason}", .file.display())]
    Unreadable { file: PathBuf, reason: String },
    #[error("mesh {} has {bytes} bytes, more than the {limit} that are read; decimate it", .file.display())]
    TooLarge { file: PathBuf, bytes: u64, limit: u64 },
    #[error("mesh {} has the unknown extension \"{extension}\"; convert it to stl, obj or dae", .file.display())]
    UnknownExtension { file: PathBuf, extension: String },
    #[error("mesh {} is broken{}: {reason}; export it again", .file.display(), at_line(.line))]
    Broken { file: PathBuf, line: Option<usize>, reason: String },
    #[error("mesh {} has no triangles; export it again with faces", .file.display())]
    Empty { file: PathBuf },
    #[error("mesh {}: vertex {vertex} is not a finite number of metres (or beyond 1e15); export it again", .file.display())]
    NotFinite { file: PathBuf, vertex: usize },
    #[error("mesh {}: all its {triangles} triangles are without area; check scale and export", .file.display())]
    NoArea { file: PathBuf, triangles: usize },
}

fn listed(tried: &[PathBuf]) -> String {
    tried.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(", ")
}

fn searched(named: &[PathBuf]) -> String {
    named.iter().map(|p| format!("{}, ", p.display())).collect()
}

impl MeshError {
    /// Whether there is no file at all, as where a URDF was copied without its meshes.
    pub fn is_missing(&self) -> bool {
        matches!(self, Self::NotFound { .. } | Self::NoPackage { .. })
    }
}

fn at_line(line: &Option<usize>) -> String {
    line.map_or_else(String::new, |l| format!(" in line {l}"))
}

/// Triangles as a file gives them: not yet scaled or checked.
#[derive(Debug, Default)]
struct RawMesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    vertex_rgba: Vec<[f32; 4]>,
}

/// What a reader found wrong, before the file's name is known to it.
#[derive(Debug)]
struct Fault {
    line: Option<usize>,
    reason: String,
}

impl Fault {
    fn new(reason: impl Into<String>) -> Self {
        Self { line: None, reason: reason.into() }
    }

    fn in_line(line: usize, reason: impl Into<String>) -> Self {
        Self { line: Some(line), reason: reason.into() }
    }
}

/// Reads, scales and checks a mesh file.
///
/// The scale multiplies the file's coordinates (COLLADA's own unit is applied before).
pub fn load_mesh(file: &Path, scale: [f64; 3]) -> Result<Mesh, MeshError> {
    let reader = reader_for(file)?;
    let bytes = read_bounded(file)?;
    let raw =
        reader(&bytes, file).map_err(|f| MeshError::Broken { file: file.into(), line: f.line, reason: f.reason })?;
    checked(file, raw, scale)
}

type Reader = fn(&[u8], &Path) -> Result<RawMesh, Fault>;

fn reader_for(file: &Path) -> Result<Reader, MeshError> {
    let extension = file.extension().map(|e| e.to_string_lossy().into_owned()).unwrap_or_default();
    match extension.to_lowercase().as_str() {
        "stl" => Ok(stl::read_stl),
        "obj" => Ok(obj::read_obj),
        "dae" => Ok(collada::read_collada),
        _ => Err(MeshError::UnknownExtension { file: file.into(), extension }),
    }
}

fn read_bounded(file: &Path) -> Result<Vec<u8>, MeshError> {
    let unreadable = |reason: String| MeshError::Unreadable { file: file.into(), reason };
    let meta = std::fs::metadata(file).map_err(|e| unreadable(e.to_string()))?;
    if !meta.is_file() {
        return Err(unreadable("it is not a regular file".into()));
    }
    if meta.len() > LARGEST_FILE_BYTES {
        return Err(MeshError::TooLarge { file: file.into(), bytes: meta.len(), limit: LARGEST_FILE_BYTES });
    }
    std::fs::read(file).map_err(|e| unreadable(e.to_string()))
}

fn checked(file: &Path, raw: RawMesh, scale: [f64; 3]) -> Result<Mesh, MeshError> {
    let file: PathBuf = file.into();
    let RawMesh { mut vertices, mut triangles, vertex_rgba } = raw;
    if triangles.is_empty() {
        return Err(MeshError::Empty { file });
    }
    for vertex in &mut vertices {
        (0..3).for_each(|i| vertex[i] *= scale[i]);
    }
    let is_off = |v: &[f64; 3]| v.iter().any(|x| !x.is_finite() || x.abs() > LARGEST_COORDINATE_M);
    if let Some(vertex) = vertices.iter().position(is_off) {
        return Err(MeshError::NotFinite { file, vertex });
    }
    if scale.iter().product::<f64>() < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    let given = triangles.len();
    triangles.retain(|t| has_area(&vertices, *t));
    if triangles.is_empty() {
        return Err(MeshError::NoArea { file, triangles: given });
    }
    Ok(Mesh { file, vertices, triangles, vertex_rgba })
}

fn has_area(vertices: &[[f64; 3]], [a, b, c]: [u32; 3]) -> bool {
    let at = |i: u32| spatial::Vec3::from(vertices[i as usize]);
    let normal = (at(b) - at(a)).cross(&(at(c) - at(a)));
    normal.norm_squared() > 0.0
}

//! Any bytes as a mesh file: an answer in words or a sound mesh. The first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use multibody::load_mesh;

fuzz_target!(|bytes: &[u8]| {
    let Some((first, content)) = bytes.split_first() else { return };
    let extension = ["stl", "obj", "dae"][usize::from(first % 3)];
    let file = std::env::temp_dir().join(format!("softdock-fuzz-{}.{extension}", std::process::id()));
    std::fs::write(&file, content).expect("the temporary directory can be written");
    match load_mesh(&file, [1.0, -1.0, 1.0]) {
        Ok(mesh) => {
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < mesh.vertices.len()));
            assert!(mesh.vertices.iter().flatten().all(|x| x.is_finite()));
            assert!(mesh.vertex_rgba.is_empty() || mesh.vertex_rgba.len() == mesh.vertices.len());
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});

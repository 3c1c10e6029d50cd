//! Where a mesh named in a URDF lies.
//!
//! | written | is |
//! | --- | --- |
//! | `meshes/hand.stl` | relative to the URDF's directory |
//! | `/data/hand.stl`, `file:///data/hand.stl` | that file |
//! | `package://pkg/rest` | `root/pkg/rest` for the roots of [`SearchPaths`], then of `ROS_PACKAGE_PATH`, then the URDF's directory and all above it; a root that *is* the package (its last part is `pkg`) gives `root/rest` |

use super::MeshError;
use std::path::{Path, PathBuf};

/// Where `package://` paths are looked up, in this order, before the environment and the URDF's own surroundings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SearchPaths {
    /// Directories that hold packages, or are packages.
    pub package_roots: Vec<PathBuf>,
}

impl SearchPaths {
    /// Looks in these directories first.
    pub fn new(package_roots: impl IntoIterator<Item = impl Into<PathBuf>>) -> Self {
        Self { package_roots: package_roots.into_iter().map(Into::into).collect() }
    }

    /// The existing file that a URDF in `base_dir` means by `name`, or every place where it was looked for.
    pub fn find(&self, name: &str, base_dir: &Path) -> Result<PathBuf, MeshError> {
        let tried = match name.split_once("://") {
            None => vec![base_dir.join(name)],
            Some(("file", path)) => vec![base_dir.join(path)],
            Some(("package" | "model", path)) => self.package_places(path, base_dir),
            Some((scheme, _)) => {
                return Err(MeshError::UnknownScheme { name: shortened(name), scheme: shortened(scheme) });
            }
        };
        let found = tried.iter().find(|p| p.is_file()).cloned();
        found.ok_or_else(|| MeshError::NotFound { name: shortened(name), tried })
    }

    fn package_places(&self, path: &str, base_dir: &Path) -> Vec<PathBuf> {
        let (package, rest) = path.split_once('/').unwrap_or((path, ""));
        let ros = std::env::var_os("ROS_PACKAGE_PATH").unwrap_or_default();
        let base_dir = std::path::absolute(base_dir).unwrap_or_else(|_| base_dir.into());
        let roots = self.package_roots.iter().cloned();
        let roots = roots.chain(std::env::split_paths(&ros).filter(|p| !p.as_os_str().is_empty()));
        let mut places = Vec::new();
        for root in roots.chain(base_dir.ancestors().map(Path::to_path_buf)) {
            let is_package = root.file_name().is_some_and(|n| n == package);
            let inside = is_package.then(|| root.join(rest));
            for place in inside.into_iter().chain([root.join(package).join(rest)]) {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
        }
        places
    }
}

fn shortened(name: &str) -> String {
    if name.chars().nth(200).is_none() { name.into() } else { name.chars().take(200).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_package_is_looked_for_in_roots_then_upwards_and_every_place_is_told() {
        let search = SearchPaths::new(["/nowhere/share"]);
        let error = search.find("package://arm/meshes/a.stl", Path::new("/nowhere/arm/urdf")).expect_err("not there");
        let said = error.to_string();
        let roots = said.find("/nowhere/share/arm/meshes/a.stl").expect("the root is tried");
        let above = said.find("/nowhere/arm/meshes/a.stl").expect("the package around the URDF is tried");
        assert!(roots < above, "{said}");
    }
}

//! Where a mesh named in a URDF lies.
//!
//! | written | is |
//! | --- | --- |
//! | `meshes/hand.stl` | relative to the URDF's directory |
//! | `/data/hand.stl`, `file:///data/hand.stl` | that file |
//! | `package://pkg/rest` | `rest` inside the package `pkg` |
//!
//! A package is a directory of its name, or one whose `package.xml` has its `<name>`. It is looked for, in this order,
//! among the roots of [`SearchPaths`], those of `ROS_PACKAGE_PATH`, the `share` directories of `AMENT_PREFIX_PATH`, and the
//! URDF's directory with all above it; a root may be the package itself or hold it. Backslashes count as slashes where
//! nothing has them in its name.

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
        let found = self.find_as_written(name, base_dir);
        if found.is_err() && name.contains('\\') {
            return self.find_as_written(&name.replace('\\', "/"), base_dir).or(found);
        }
        found
    }

    fn find_as_written(&self, name: &str, base_dir: &Path) -> Result<PathBuf, MeshError> {
        let tried = match name.split_once("://") {
            None => vec![base_dir.join(name)],
            Some(("file", path)) => vec![base_dir.join(path)],
            // Some write a third slash.
            Some(("package" | "model", path)) => self.package_places(path.trim_start_matches('/'), base_dir)?,
            Some((scheme, _)) => {
                return Err(MeshError::UnknownScheme { name: shortened(name), scheme: shortened(scheme) });
            }
        };
        let found = tried.iter().find(|p| p.is_file()).cloned();
        found.ok_or_else(|| MeshError::NotFound { name: shortened(name), tried })
    }

    /// The file in every package of that name.
    fn package_places(&self, path: &str, base_dir: &Path) -> Result<Vec<PathBuf>, MeshError> {
        let (package, rest) = path.split_once('/').unwrap_or((path, ""));
        let base_dir = std::path::absolute(base_dir).unwrap_or_else(|_| base_dir.into());
        let mut named = self.package_roots.clone();
        named.extend(from_environment("ROS_PACKAGE_PATH"));
        named.extend(from_environment("AMENT_PREFIX_PATH").map(|prefix| prefix.join("share")));
        let mut places: Vec<PathBuf> = Vec::new();
        for root in named.iter().cloned().chain(base_dir.ancestors().map(Path::to_path_buf)) {
            let itself = is_package(&root, package).then(|| root.clone());
            let inside = Some(root.join(package)).filter(|dir| dir.is_dir());
            for place in itself.into_iter().chain(inside).map(|dir| dir.join(rest)) {
                if !places.contains(&place) {
                    places.push(place);
                }
            }
        }
        if places.is_empty() {
            return Err(MeshError::NoPackage { package: shortened(package), named, above: base_dir });
        }
        Ok(places)
    }
}

fn from_environment(variable: &str) -> impl Iterator<Item = PathBuf> {
    let value = std::env::var_os(variable).unwrap_or_default();
    std::env::split_paths(&value).filter(|p| !p.as_os_str().is_empty()).collect::<Vec<_>>().into_iter()
}

/// Larger files are no package's description.
const LARGEST_MANIFEST_BYTES: u64 = 1 << 20;

fn is_package(dir: &Path, name: &str) -> bool {
    let manifest = dir.join("package.xml");
    let is_short = || std::fs::metadata(&manifest).is_ok_and(|m| m.is_file() && m.len() <= LARGEST_MANIFEST_BYTES);
    let text = || if is_short() { std::fs::read_to_string(&manifest).unwrap_or_default() } else { String::new() };
    dir.is_dir() && (dir.file_name().is_some_and(|n| n == name) || name_in(&text()) == Some(name))
}

/// What stands between the first `<name>` and its end.
fn name_in(manifest: &str) -> Option<&str> {
    let (_, rest) = manifest.split_once("<name>")?;
    rest.split_once("</name>").map(|(name, _)| name.trim())
}

fn shortened(name: &str) -> String {
    if name.chars().nth(200).is_none() { name.into() } else { name.chars().take(200).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directory(name: &str) -> PathBuf {
        let dir = std::env::temp_dir().join(format!("softdock-search-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&dir).expect("a temporary directory can be made");
        dir
    }

    fn write(path: &Path, text: &str) {
        std::fs::create_dir_all(path.parent().expect("it has a parent")).expect("a directory can be made");
        std::fs::write(path, text).expect("a file can be written");
    }

    #[test]
    fn a_package_that_is_nowhere_is_told_with_the_places() {
        let search = SearchPaths::new(["/nowhere/share"]);
        let error = search.find("package://arm/meshes/a.stl", Path::new("/nowhere/urdf")).expect_err("not there");
        let said = error.to_string();
        assert!(
            said.contains("\"arm\"") && said.contains("/nowhere/share") && said.contains("/nowhere/urdf"),
            "{said}"
        );
    }

    #[test]
    fn a_package_is_found_in_roots_then_upwards_by_its_folder_or_its_manifest() {
        let dir = directory("order");
        write(&dir.join("root/arm/meshes/a.stl"), "");
        write(&dir.join("clone/package.xml"), "<package><name> arm </name></package>");
        write(&dir.join("clone/meshes/a.stl"), "");
        write(&dir.join("clone/urdf/arm.urdf"), "");
        let find = |search: SearchPaths| search.find("package://arm/meshes/a.stl", &dir.join("clone/urdf"));
        assert_eq!(find(SearchPaths::default()), Ok(dir.join("clone/meshes/a.stl")), "the folder has another name");
        assert_eq!(find(SearchPaths::new([dir.join("root")])), Ok(dir.join("root/arm/meshes/a.stl")));
        assert_eq!(find(SearchPaths::new([dir.join("root/arm")])), Ok(dir.join("root/arm/meshes/a.stl")));
        let empty = SearchPaths::default().find("package:///arm/meshes\\a.stl", &dir.join("clone/urdf"));
        assert_eq!(empty, Ok(dir.join("clone/meshes/a.stl")), "three slashes and a backslash");
        std::fs::remove_dir_all(dir).expect("it can be removed");
    }
}

//! Malformed robots: each is refused with a message that names file, place and subject; none panics or hangs.

mod meshes;
mod physics;
mod table;
mod xml;

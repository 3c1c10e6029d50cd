//! Malformed robots: each is refused with a message that names file, place and subject; none panics or hangs. And odd ones:
//! each loads, with one warning that does the same and says what was assumed.

mod doubts;
mod meshes;
mod mutations;
mod physics;
mod table;
mod xml;

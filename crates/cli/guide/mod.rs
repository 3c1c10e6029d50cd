//! The guide: how to write a scenario, bring a robot, diagnose a recording, and find one's way in the code.
//!
//! | page | for |
//! | --- | --- |
//! | [`scenario_file`] | the scenario file, section by section, as one complete example |
//! | [`robots`] | URDF: what is read, what is assumed, meshes, docking shapes |
//! | [`contact`](mod@contact) | contact and friction laws with their equations and sources |
//! | [`effects`] | physics beyond the nominal model: which there are, where they act, their parameters |
//! | [`energy`] | what is stored, lost and worked, and what the integration itself lost |
//! | [`diagnosis`] | from a rig's recording to a report and a corrected scenario |
//! | [`architecture`] | crates and layers, one step, determinism, where to add what |
//! | [`changes`] | what moved in earlier versions, and by how much |
//!
//! Every example is compiled and run by `cargo test`. Commands are written `softdock …`; from a clone that is `cargo run -- …`.

#[doc = include_str!("architecture.md")]
pub mod architecture {}

#[doc = include_str!("changes.md")]
pub mod changes {}

#[doc = include_str!("contact.md")]
pub mod contact {}

#[doc = include_str!("diagnosis.md")]
pub mod diagnosis {}

#[doc = include_str!("effects.md")]
pub mod effects {}

#[doc = include_str!("energy.md")]
pub mod energy {}

#[doc = include_str!("robots.md")]
pub mod robots {}

#[doc = include_str!("scenario_file.md")]
pub mod scenario_file {}

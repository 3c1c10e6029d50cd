//! Dispersed runs of a scenario: drawn, made in parallel, kept, compared, reported, held against a baseline.
//!
//! **scenario → [`Plan`] → rows → table → report.** Run i draws the same sample whatever the order, the threads, the shards and the
//! number of runs; its row goes to a journal the moment it is over; the table is a function of the rows alone.

mod applied;
mod chance;
pub mod compare;
mod demand;
mod design;
mod error;
mod execute;
pub mod findings;
mod folder;
mod journal;
mod merge;
mod plan;
pub mod regress;
mod replay;
pub mod report;
mod row;
mod run;
mod shard;
pub mod stats;
pub mod table;
mod table_file;

pub use demand::{Demand, check_demands};
pub use design::Design;
pub use error::CampaignError;
pub use execute::{Summary, Watch, execute};
pub use folder::{Folder, Identity, read_identity};
pub use merge::{Merged, merge};
pub use plan::Plan;
pub use replay::{Replayed, replay};
pub use row::Row;
pub use run::{Finished, Keep, make};
pub use shard::Shard;
pub use table_file::{TABLE_FILE, TABLE_FORMAT, read_table};

//! softdock: spacecraft docking and grasp scenarios with bristle friction.
//!
//! The layers, each usable by itself: [`spatial`] < [`friction`] < [`contact`] < [`multibody`] < [`sim`] < [`record`] <
//! [`lab`] < [`scenario`] < [`campaign`] < [`diagnose`] < [`score`]. How to use them stands in the [`guide`].
//!
//! ```no_run
//! use softdock::scenario;
//! let file = std::path::Path::new("scenarios/tumbling-capture.toml");
//! let scenario = scenario::load(file, &["contact[0].friction.mu=0.02".into()])?;
//! let mission = scenario::build(&scenario)?;
//! let done = scenario::run(mission, None, &mut [])?; // a recorder; observers of your own
//! println!("{}: {}", done.outcome.outcome, done.outcome.reason);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod guide;

pub use {campaign, contact, diagnose, friction, lab, multibody, record, scenario, score, sim, spatial};

//! softdock: spacecraft docking and grasp scenarios with bristle friction.
//!
//! The layers, each usable by itself: [`spatial`] < [`friction`] < [`contact`] < [`multibody`] < [`sim`] < [`record`] <
//! [`lab`] < [`scenario`] < [`campaign`] < [`diagnose`] < [`score`]. How to use them stands in the [`guide`].
//!
//! ```no_run
//! use softdock::{scenario, sim};
//! let file = std::path::Path::new("scenarios/tumbling-capture.toml");
//! let scenario = scenario::load(file, &["contact[0].friction.mu=0.02".into()])?;
//! let mut mission = scenario::build(&scenario)?;
//! let mut judge = scenario::outcome::Judge::new(&mission);
//! let ended = mission.world.run(mission.steps, &*mission.controller, &mut [&mut judge as &mut dyn sim::Observer]);
//! let outcome = judge.conclude(&mission.world, &ended);
//! println!("{}: {}", outcome.outcome, outcome.reason);
//! # Ok::<(), scenario::ScenarioErrors>(())
//! ```

pub mod guide;

pub use {campaign, contact, diagnose, friction, lab, multibody, record, scenario, score, sim, spatial};

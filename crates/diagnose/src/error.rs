//! What can go wrong in a diagnosis.

use thiserror::Error;

/// Why a diagnosis cannot be made.
#[derive(Debug, Error)]
pub enum DiagnoseError {
    /// The scenario cannot be built with a set of effects.
    #[error(transparent)]
    Scenario(#[from] scenario::ScenarioErrors),
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] record::RecordError),
    /// A recorded channel has no counterpart in the scenario.
    #[error("channel \"{channel}\" of {file}: {reason}")]
    Channel {
        /// The channel.
        channel: String,
        /// The run's file.
        file: String,
        /// What is wrong and what to do.
        reason: String,
    },
    /// The recording and the scenario do not belong together.
    #[error("the recording cannot belong to this scenario: {0}")]
    Foreign(String),
    /// There is too little in the recording.
    #[error("the recording cannot be diagnosed: {0}")]
    TooLittle(String),
    /// A replay left the range of numbers.
    #[error("run {file}: {what}")]
    Replay {
        /// The run's file.
        file: String,
        /// Time, body and way out.
        what: String,
    },
}

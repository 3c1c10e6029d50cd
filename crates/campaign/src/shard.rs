//! A campaign over several machines: shard i of n makes the runs i, i + n, i + 2n, …
//!
//! A scheduler's environment says which shard a process is:
//!
//! | scheduler | shard | of |
//! | --- | --- | --- |
//! | SLURM array | (`SLURM_ARRAY_TASK_ID` − `…_MIN`)/`…_STEP` | `SLURM_ARRAY_TASK_COUNT` |
//! | Kubernetes indexed job | `JOB_COMPLETION_INDEX` | `SOFTDOCK_SHARDS`, which the emitted manifest sets |

use crate::error::CampaignError;
use std::fmt;
use std::str::FromStr;

/// One part of a campaign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Index, from 0.
    pub index: u64,
    /// How many there are.
    pub count: u64,
}

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Whether it makes a run.
    pub fn has(&self, run: u64) -> bool {
        run % self.count == self.index
    }

    /// From a scheduler's environment; `None` outside of any. `variable` reads one of its variables.
    pub fn from_scheduler(variable: impl Fn(&str) -> Option<String>) -> Result<Option<Self>, CampaignError> {
        let number = |name: &str, default: Option<u64>| -> Result<u64, CampaignError> {
            let refuse = |text: String, reason: &str| CampaignError::Shard { text, reason: reason.to_owned() };
            match (variable(name), default) {
                (Some(text), _) => text.parse().map_err(|_| refuse(format!("{name}={text}"), "must be a whole number")),
                (None, Some(default)) => Ok(default),
                (None, None) => Err(refuse(name.to_owned(), "is not set; set it, or give --shard i/n")),
            }
        };
        if variable("SLURM_ARRAY_TASK_ID").is_some() {
            let id = number("SLURM_ARRAY_TASK_ID", None)?;
            let first = number("SLURM_ARRAY_TASK_MIN", Some(0))?;
            let step = number("SLURM_ARRAY_TASK_STEP", Some(1))?.max(1);
            let count = number("SLURM_ARRAY_TASK_COUNT", None)?;
            return Self::new(id.saturating_sub(first) / step, count).map(Some);
        }
        if variable("JOB_COMPLETION_INDEX").is_some() {
            return Self::new(number("JOB_COMPLETION_INDEX", None)?, number("SOFTDOCK_SHARDS", None)?).map(Some);
        }
        Ok(None)
    }

    fn new(index: u64, count: u64) -> Result<Self, CampaignError> {
        if index < count {
            return Ok(Self { index, count });
        }
        let text = format!("{index}/{count}");
        Err(CampaignError::Shard { text, reason: "shards are counted from 0, so i must be below n".to_owned() })
    }
}

impl FromStr for Shard {
    type Err = CampaignError;

    fn from_str(text: &str) -> Result<Self, CampaignError> {
        let refuse = || CampaignError::Shard { text: text.to_owned(), reason: "must be i/n, e.g. 0/5".to_owned() };
        let (index, count) = text.split_once('/').ok_or_else(refuse)?;
        let number = |text: &str| text.trim().parse().map_err(|_| refuse());
        Self::new(number(index)?, number(count)?)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-of-{}", self.index, self.count)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn under(pairs: &[(&str, &str)]) -> Result<Option<Shard>, CampaignError> {
        Shard::from_scheduler(|name| pairs.iter().find(|(n, _)| *n == name).map(|(_, v)| (*v).to_owned()))
    }

    #[test]
    fn shards_of_any_number_make_every_run_once() {
        for count in 1..7 {
            for run in 0..40 {
                let makers = (0..count).filter(|index| Shard { index: *index, count }.has(run)).count();
                assert_eq!(makers, 1);
            }
        }
    }

    #[test]
    fn schedulers_are_recognised() {
        let shard = |index, count| Some(Shard { index, count });
        assert_eq!(under(&[]).unwrap(), None);
        let slurm = [("SLURM_ARRAY_TASK_ID", "3"), ("SLURM_ARRAY_TASK_COUNT", "5")];
        assert_eq!(under(&slurm).unwrap(), shard(3, 5));
        let stepped = [
            ("SLURM_ARRAY_TASK_ID", "14"),
            ("SLURM_ARRAY_TASK_MIN", "10"),
            ("SLURM_ARRAY_TASK_STEP", "2"),
            ("SLURM_ARRAY_TASK_COUNT", "4"),
        ];
        assert_eq!(under(&stepped).unwrap(), shard(2, 4));
        assert_eq!(under(&[("JOB_COMPLETION_INDEX", "1"), ("SOFTDOCK_SHARDS", "2")]).unwrap(), shard(1, 2));
        let message = under(&[("JOB_COMPLETION_INDEX", "1")]).unwrap_err().to_string();
        assert!(message.contains("SOFTDOCK_SHARDS") && message.contains("--shard i/n"), "{message}");
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "3", "5/5", "a/2", "1/0", "-1/2"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
        assert_eq!("2/5".parse::<Shard>().unwrap().to_string(), "2-of-5");
    }
}

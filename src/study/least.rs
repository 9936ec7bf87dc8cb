//! A `--memory-budget` under which a technique runs while it does not with a mebibyte less, and what it gives up there.

use super::driver::Driver;
use super::require_known_tiling;
use super::trials::{Fitting, MIB, Trials};
use crate::bvh::LazyBvh;
use crate::caps::Caps;
use crate::error::{Error, ErrorKind, Result};
use crate::job::Job;
use crate::plan::Requirements;
use crate::units::Bytes;
use serde_json::{Value, json};

/// A setting that means something else under the smallest budget.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GivenUp {
    pub setting: String,
    /// Without a budget.
    pub without: String,
    pub with: String,
}

/// What a technique takes at least.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Least {
    /// Whole mebibytes.
    pub budget_bytes: u64,
    /// What memory blocks take without a budget.
    pub whole_bytes: u64,
    pub given_up: Vec<GivenUp>,
}

/// By placing plans under the rules of `caps`, halving what is between too little and enough: everything has its place, what is on its
/// way between host and device included.
///
/// Errors: impossible settings or a broken scene (exit code 2); a device of these caps lacks what the settings need (3); no budget
/// would do (4).
pub fn least(job: &Job, caps: &Caps) -> Result<Least> {
    job.require_read()?;
    require_known_tiling(job)?;
    let rules = caps.rules();
    let driver = Driver { caps, requirements: Requirements::Rules(&rules) };
    let bvh = LazyBvh::default();
    let mut trials = Trials::new(job, job.load_scene()?, &bvh, driver);
    let Fitting { bytes: whole_bytes, resolved: without } = trials.under("none")?;
    // Under a budget `auto` may mean what takes more than the whole does without one.
    let none = || Error::memory(format!("no --memory-budget up to four times {} is enough", Bytes(whole_bytes)));
    let (mut enough, Fitting { resolved: mut with, .. }) = trials.enough(whole_bytes)?.ok_or_else(none)?;
    let mut too_little = 0;
    while too_little + 1 < enough {
        let tried = too_little + (enough - too_little) / 2;
        match trials.under(&format!("{tried}MiB")) {
            Ok(Fitting { resolved, .. }) => (enough, with) = (tried, resolved),
            Err(error) if error.kind() == ErrorKind::Memory => too_little = tried,
            Err(error) => return Err(error),
        }
    }
    let given_up = without.iter().filter_map(|(setting, without)| {
        let with = with.get(setting).filter(|with| *with != without)?;
        Some(GivenUp { setting: (*setting).to_owned(), without: without.clone(), with: with.clone() })
    });
    Ok(Least { budget_bytes: enough * MIB, whole_bytes, given_up: given_up.collect() })
}

impl Least {
    pub fn text(&self) -> String {
        let budget = format!("--memory-budget {}MiB", self.budget_bytes / MIB);
        let given_up: Vec<String> = self
            .given_up
            .iter()
            .map(|GivenUp { setting, without, with }| format!("--{setting} is {with} in place of {without}"))
            .collect();
        let given_up = if given_up.is_empty() { "nothing".to_owned() } else { given_up.join(", ") };
        format!(
            "{budget} is enough, and one mebibyte less is not; without a budget it takes {}; gives up: {given_up}\n",
            Bytes(self.whole_bytes)
        )
    }

    pub fn json(&self) -> Value {
        let given_up = self
            .given_up
            .iter()
            .map(|GivenUp { setting, without, with }| json!({ "setting": setting, "without": without, "with": with }));
        json!({
            "budget_bytes": self.budget_bytes,
            "whole_bytes": self.whole_bytes,
            "given_up": given_up.collect::<Vec<_>>(),
        })
    }
}

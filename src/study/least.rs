//! A `--memory-budget` under which a technique runs while it does not with a mebibyte less, and what it gives up there.

use super::budget::{self, Copies};
use super::driver::{Driver, Plans, with_inputs};
use crate::bvh::LazyBvh;
use crate::caps::Caps;
use crate::error::{ErrorKind, Result};
use crate::job::Job;
use crate::plan::Requirements;
use crate::session::Planned;
use crate::units::Bytes;
use serde_json::{Value, json};
use std::collections::BTreeMap;

const MIB: u64 = 1 << 20;

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
    let rules = caps.rules();
    let driver = Driver { caps, requirements: Requirements::Rules(&rules) };
    let bvh = LazyBvh::default();
    // Larger than any plan of a scene that a host holds.
    let most = u64::MAX / (16 * MIB);
    let mut scene = Some(job.load_scene()?);
    let mut under = |budget: &str| -> Result<(u64, BTreeMap<String, String>)> {
        let mut other = job.at(&job.values);
        other.aovs = job.aovs.clone();
        other.set("memory-budget", budget)?;
        let textured = other.with_texturing(scene.take().expect("it is put back"), caps);
        let tried = (|| {
            let plans = Plans::new(&other, &textured, &bvh, driver)?;
            let budget_bytes = other.values.bytes("memory-budget").unwrap_or(u64::MAX);
            let bytes = budget::rehearse(&plans, &other, driver, budget_bytes, Copies::All)?;
            let mut resolved: BTreeMap<String, String> = with_inputs(&other, &textured, &bvh, driver, |inputs| {
                let prepared = Planned::new(other.technique, inputs, &other.aovs)?.prepared;
                Ok(prepared.resolved().into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
            })?;
            resolved.insert("texture-limit".to_owned(), textured.texturing.limit_px.to_string());
            Ok((bytes, resolved))
        })();
        scene = Some(textured);
        tried
    };
    let (whole_bytes, without) = under("none")?;
    let mut enough = whole_bytes.div_ceil(MIB).max(1);
    let mut too_little = 0;
    // Under a budget `auto` may mean what takes more than the whole does without one.
    let mut with = loop {
        match under(&format!("{enough}MiB")) {
            Ok((_, resolved)) => break resolved,
            Err(error) if error.kind() == ErrorKind::Memory && enough < most => too_little = enough,
            Err(error) => return Err(error),
        }
        enough += enough.div_ceil(8);
    };
    while too_little + 1 < enough {
        let tried = too_little + (enough - too_little) / 2;
        match under(&format!("{tried}MiB")) {
            Ok((_, resolved)) => (enough, with) = (tried, resolved),
            Err(error) if error.kind() == ErrorKind::Memory => too_little = tried,
            Err(error) => return Err(error),
        }
    }
    let given_up = without.iter().filter_map(|(setting, without)| {
        let with = with.get(setting).filter(|with| *with != without)?;
        Some(GivenUp { setting: setting.clone(), without: without.clone(), with: with.clone() })
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

//! Progressive rendering (`--accumulate`; Segovia 2006, section 6.3): the irradiance of many runs, each with virtual lights of its own,
//! is summed up while the G-buffer and its sub-buffers stay as they are; filter and composite come once, over the mean.
//!
//! reads   irradiance in frame order; accumulate.layer  image, RGBA32F, frame extent, where BLEND surfaces are
//! writes  accumulate.sums, accumulate.layer_sums  buffers, 32 B a pixel each, kept from run to run: of even and of odd runs; the
//!         irradiance, whose place the mean takes; composite.color
//!
//! What blends is drawn in each run, over nothing: what its surfaces send and how much they cover is as much a mean as irradiance is.
//!
//! Differs from the paper: sums lie in frame order, so that every split has them and a gather comes with each run. The halves say when
//! `--until-error` is reached.

pub mod mean;
pub mod over;
pub mod sums;

use super::choices::Choices;
use crate::error::Result;
use crate::gpu::{Access, AccessSet, Buffer, Commands, Edge, Gpu, Image};
use crate::plan::{PICTURE_FORMAT, Plan, Resources};
use crate::techniques::parts::Runs;
use ash::vk;
use mean::Mean;
use over::Over;
use std::sync::Arc;
use sums::{SUM_BYTES, Sums};

const SUMS: &str = "interleaved_deferred.accumulate.sums";
const LAYER_SUMS: &str = "interleaved_deferred.accumulate.layer_sums";
/// Full name of what blends, of a run.
pub const LAYER: &str = "interleaved_deferred.accumulate.layer";

/// Row of the memory table.
const GROUP: &str = "accumulation";

pub struct Accumulate {
    sums_pass: Sums,
    mean_pass: Mean,
    sums: Buffer,
    blended: Option<Blended>,
}

/// What blends.
struct Blended {
    layer: Image,
    sums: Buffer,
    over_pass: Over,
}

/// Plans what is kept of runs, and the layer of what blends where `has_blend`; nothing for one run.
pub fn plan_resources(plan: &mut Plan, choices: &Choices, has_blend: bool) {
    if choices.run_count == 1 {
        return;
    }
    let extent = choices.mapping.extent();
    for sums in [Some(SUMS), has_blend.then_some(LAYER_SUMS)].into_iter().flatten() {
        plan.buffer(GROUP, sums, 2 * extent.pixel_count() * SUM_BYTES);
        plan.keep(sums);
    }
    if has_blend {
        let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        plan.image(GROUP, LAYER, extent, PICTURE_FORMAT, usage);
    }
}

/// Plans what makes the mean of runs, after the passes that leave `irradiance` in frame order and the layer.
pub fn plan_mean(plan: &mut Plan, choices: &Choices, has_blend: bool, irradiance: &str) {
    if choices.run_count == 1 {
        return;
    }
    let touch = |access| (irradiance.to_owned(), access);
    let layer = has_blend.then(|| (LAYER.to_owned(), Access::ComputeRead));
    plan.pass(sums::pass(), [touch(Access::ComputeRead)].into_iter().chain(layer));
    plan.pass(mean::pass(), [touch(Access::ComputeWrite)]);
}

/// Plans what lays the layers over the picture of this full name.
pub fn plan_over(plan: &mut Plan, color: &str) {
    plan.pass(over::pass(), [(color.to_owned(), Access::ComputeWrite)]);
}

impl Accumulate {
    /// Takes what `plan_resources` put in; None for one run.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, has_blend: bool) -> Result<Option<Self>> {
        if choices.run_count == 1 {
            return Ok(None);
        }
        let blended = has_blend.then(|| {
            let (layer, sums) = (resources.image(LAYER), resources.buffer(LAYER_SUMS));
            Ok(Blended { layer, sums, over_pass: Over::new(gpu, choices)? })
        });
        Ok(Some(Self {
            sums_pass: Sums::new(gpu, choices, has_blend)?,
            mean_pass: Mean::new(gpu, choices)?,
            sums: resources.buffer(SUMS),
            blended: blended.transpose()?,
        }))
    }

    /// What surfaces blend into, where there are any.
    pub fn layer(&self) -> Option<&Image> {
        self.blended.as_ref().map(|blended| &blended.layer)
    }

    /// Adds the irradiance of the run of this index, and its layer; hands the irradiance on as it leaves it.
    pub fn record_sums<'a>(
        &self,
        cmd: &mut Commands,
        run: u32,
        irradiance: Edge<'a, Buffer>,
    ) -> Result<Edge<'a, Buffer>> {
        // The run before ended with its fence.
        let layer = self
            .blended
            .as_ref()
            .map(|Blended { layer, sums, .. }| (layer.from(Access::ColorWrite), sums.from(Access::ComputeRead)));
        self.sums_pass.record(cmd, run, irradiance, self.sums.from(Access::ComputeRead), layer)?;
        Ok(irradiance.after(Access::ComputeRead))
    }

    /// Puts the mean of `of` into the irradiance; hands that on as it leaves it. `sums_from`: how the sums were touched last.
    pub fn record_mean<'a>(
        &self,
        cmd: &mut Commands,
        (of, run_count): (Runs, u32),
        sums_from: impl Into<AccessSet>,
        irradiance: Edge<'a, Buffer>,
    ) -> Result<Edge<'a, Buffer>> {
        self.mean_pass.record(cmd, of.weights(run_count), self.sums.from(sums_from), irradiance)?;
        Ok(irradiance.resource.from(Access::ComputeWrite))
    }

    /// Lays what blends over the picture of what is solid, where there is any.
    pub fn record_over(
        &self,
        cmd: &mut Commands,
        (of, run_count): (Runs, u32),
        sums_from: impl Into<AccessSet>,
        color: Edge<'_, Image>,
    ) -> Result<()> {
        let Some(Blended { sums, over_pass, .. }) = &self.blended else { return Ok(()) };
        over_pass.record(cmd, of.weights(run_count), sums.from(sums_from), color)
    }
}

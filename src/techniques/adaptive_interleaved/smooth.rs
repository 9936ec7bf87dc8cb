//! What follows the estimates: discontinuities, the box filter of each component, and the upsampling of those that are
//! estimated at fewer pixels than the frame has (Dubla 2009, sections 3 and 4.1).
//! reads   the G-buffer, the components' irradiance
//! writes  discontinuity.flags      buffer, 4 B a pixel; discontinuity.KEY.flags of a component with fewer
//!         filter.reduced.KEY       buffer, 8 B a texel, where there are fewer
//!         filter.irradiance        buffer, all components, one behind the other, 8 B a pixel

use super::choices::{Choices, ComponentChoice};
use super::resources::{FILTERED, IRRADIANCE_BYTES, NAME, of_component};
use crate::error::Result;
use crate::gpu::shader::structs::{DiscontinuityParams, UpsampleParams};
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::filter::box_filter::BoxFilter;
use crate::passes::filter::discontinuity::{self, Discontinuity};
use crate::passes::filter::upsample::Upsample;
use crate::passes::gbuffer::{self, GBuffer};
use crate::passes::texels::Texels;
use crate::plan::{Plan, Resources};
use crate::techniques::Inputs;
use std::sync::Arc;

/// The pass that flags the pixels of the frame.
const DISCONTINUITY: &str = "adaptive_interleaved.discontinuity";

/// Name of the pass that flags what a component is filtered by: the frame's, or its own.
fn flagging(choice: &ComponentChoice) -> String {
    if choice.is_reduced() { of_component("discontinuity", choice.component.name()) } else { DISCONTINUITY.to_owned() }
}

/// Components with flags of their own, after the first of those that share the frame's.
fn flagged(choices: &Choices) -> Vec<&ComponentChoice> {
    let mut flagged: Vec<&ComponentChoice> = Vec::new();
    for choice in &choices.components {
        if flagged.iter().all(|known| flagging(known) != flagging(choice)) {
            flagged.push(choice);
        }
    }
    flagged
}

/// Plans resources and passes behind the components' irradiance.
pub fn plan(plan: &mut Plan, choices: &Choices) {
    for choice in flagged(choices) {
        let texels = choice.extent().pixel_count();
        discontinuity::plan(plan, NAME, &flagging(choice), texels, choices.position);
    }
    let count = choices.components.len() as u64;
    plan.buffer("filter", FILTERED, choices.extent.pixel_count() * count * IRRADIANCE_BYTES);
    for choice in &choices.components {
        let full = |what: &str| of_component(what, choice.component.name());
        let read =
            [full("irradiance"), discontinuity::flags(&flagging(choice))].map(|name| (name, Access::ComputeRead));
        let filter = |target: &str| read.clone().into_iter().chain([(target.to_owned(), Access::ComputeWrite)]);
        if choice.is_reduced() {
            let reduced = full("filter.reduced");
            plan.buffer("filter", &reduced, choice.extent().pixel_count() * IRRADIANCE_BYTES);
            plan.pass(full("filter"), filter(&reduced));
            let touched = [(reduced, Access::ComputeRead), (FILTERED.to_owned(), Access::ComputeWrite)];
            plan.pass(full("upsample"), gbuffer::surface(NAME, choices.position).into_iter().chain(touched));
        } else {
            plan.pass(full("filter"), filter(FILTERED));
        }
    }
}

/// The passes, and what they write.
pub struct Smoothing {
    flagged: Vec<Flagged>,
    /// In the order of the components.
    filters: Vec<ComponentFilter>,
    pub filtered: Buffer,
}

/// Discontinuities of the frame, or of a component's texels.
struct Flagged {
    label: String,
    discontinuity: Discontinuity,
    flags: Buffer,
}

/// The filter of one component.
struct ComponentFilter {
    /// Index of what stops it.
    flagged: usize,
    filter: BoxFilter,
    /// Where it is estimated at fewer pixels: what the box writes, and what brings that to the frame.
    upsampled: Option<(Buffer, Upsample)>,
}

impl Smoothing {
    /// Takes what `plan` put in, and makes the pipelines.
    pub fn new(gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let (values, diagonal) = (inputs.values, inputs.scene.lasting_bounds().diagonal());
        let normal_threshold = values.number("normal-threshold") as f32;
        let position_threshold = values.length("position-threshold", diagonal);
        let (workgroup, rows) = (choices.workgroup_constants(), Texels::new(values, inputs.caps).of_filter());
        let flagged = flagged(choices).into_iter().map(|choice| {
            let row_pitch = choice.extent().width;
            let params =
                DiscontinuityParams { normal_threshold, position_threshold, row_pitch, stride: choice.params.scale };
            let label = flagging(choice);
            let flags = resources.buffer(&discontinuity::flags(&label));
            let discontinuity = Discontinuity::new(gpu, label.clone(), choices.position, &workgroup, rows, params)?;
            Ok(Flagged { label, discontinuity, flags })
        });
        let flagged = flagged.collect::<Result<Vec<_>>>()?;
        let mut filters = Vec::new();
        for (index, choice) in (0u32..).zip(&choices.components) {
            let full = |what: &str| of_component(what, choice.component.name());
            let (extent, frame_first) = (choice.extent(), index * choices.extent.pixel_count() as u32);
            let first = if choice.is_reduced() { 0 } else { frame_first };
            let upsample = |resources: &mut Resources| {
                let params = UpsampleParams {
                    width: extent.width,
                    height: extent.height,
                    scale: choice.params.scale,
                    normal_threshold,
                    position_threshold,
                    target_first: frame_first,
                };
                let upsample = Upsample::new(gpu, full("upsample"), choices.position, &workgroup, params)?;
                Result::Ok((resources.buffer(&full("filter.reduced")), upsample))
            };
            let by_label = |known: &Flagged| known.label == flagging(choice);
            filters.push(ComponentFilter {
                flagged: flagged.iter().position(by_label).expect("each component is flagged"),
                filter: BoxFilter::new(gpu, full("filter"), &workgroup, rows, extent, choices.tile_px, first)?,
                upsampled: choice.is_reduced().then(|| upsample(resources)).transpose()?,
            });
        }
        Ok(Self { flagged, filters, filtered: resources.buffer(FILTERED) })
    }

    /// The frame's flags; None where every component has its own.
    pub fn flags(&self) -> Option<&Buffer> {
        self.flagged.iter().find(|flagged| flagged.label == DISCONTINUITY).map(|flagged| &flagged.flags)
    }

    /// `irradiance`: of the components in their order, as their passes left it. Hands the G-buffer on as it leaves it,
    /// and what lights the frame.
    pub fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        mut gbuffer: Edge<'a, GBuffer>,
        irradiance: impl Iterator<Item = Edge<'a, Buffer>>,
    ) -> Result<(Edge<'a, GBuffer>, Edge<'a, Buffer>)> {
        let mut flags = Vec::new();
        for flagged in &self.flagged {
            gbuffer = flagged.discontinuity.record(cmd, frame, gbuffer, &flagged.flags)?;
            flags.push(flagged.flags.from(Access::ComputeWrite));
        }
        let mut begun = self.filtered.discard(Access::ComputeWrite);
        for (filter, irradiance) in self.filters.iter().zip(irradiance) {
            let own = flags[filter.flagged];
            flags[filter.flagged] = own.after(Access::ComputeRead);
            match &filter.upsampled {
                None => filter.filter.record(cmd, irradiance, own, &self.filtered, begun)?,
                Some((reduced, upsample)) => {
                    let fresh = reduced.discard(Access::ComputeWrite);
                    filter.filter.record(cmd, irradiance, own, reduced, fresh)?;
                    let source = reduced.from(Access::ComputeWrite);
                    gbuffer = upsample.record(cmd, frame, gbuffer, source, &self.filtered, begun)?;
                }
            }
            begun = self.filtered.from(Access::ComputeWrite).to(Access::ComputeWrite);
        }
        Ok((gbuffer, self.filtered.from(Access::ComputeWrite)))
    }
}

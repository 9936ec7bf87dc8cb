//! Discontinuities and the filter that stops at them (Segovia 2006, section 4.5), as this technique has them: a pass of
//! their own, or, with `--fuse on`, the Gaussian's rows here or in the gather and its columns in the composite.
//! reads  the G-buffer, irradiance in frame order      writes  discontinuity.flags, filter.rows or filter.irradiance

use super::choices::Choices;
use crate::error::Result;
use crate::gpu::shader::structs::DiscontinuityParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu};
use crate::passes::filter::discontinuity::{self, Discontinuity};
use crate::passes::filter::gauss::Gauss;
use crate::passes::filter::{Filter, FilterPass, FilterSetup};
use crate::passes::gbuffer::GBuffer;
use crate::plan::{Plan, Resources};
use crate::techniques::Inputs;
use crate::techniques::interleaved_deferred::resources::{DISCONTINUITY, NAME};
use std::sync::Arc;

/// Discontinuities, the filter, and what they write.
pub struct FilterStage {
    discontinuity: Discontinuity,
    pub flags: Buffer,
    place: FilterPlace,
}

/// Where irradiance is filtered.
#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
enum FilterPlace {
    /// In a pass of its own.
    OwnPass(Box<dyn FilterPass>),
    /// The composite walks the columns.
    Rows { gauss: Gauss, rows: Buffer },
    /// And the gather the rows.
    InGather,
}

/// What the composite reads.
pub struct FilteredIrradiance<'a> {
    /// In frame order.
    pub irradiance: Edge<'a, Buffer>,
    /// Where its columns are still to be walked: where walks end.
    pub flags: Option<Edge<'a, Buffer>>,
}

/// Calls `made` with what the filter is made for.
fn with_setup<T>(choices: &Choices, made: impl FnOnce(&FilterSetup<'_>) -> T) -> T {
    let Choices { shading, mapping, kernel, .. } = choices;
    made(&FilterSetup {
        label: &format!("{NAME}.filter"),
        workgroup: &shading.workgroup_constants(),
        extent: mapping.extent(),
        row_pitch: mapping.row_pitch(),
        kernel: *kernel,
        texels: shading.texels.of_filter(),
    })
}

fn plan_discontinuities(plan: &mut Plan, choices: &Choices) {
    discontinuity::plan(plan, NAME, DISCONTINUITY, choices.mapping.frame_texel_count(), choices.shading.position);
}

/// Plans the discontinuities where they come before the gather, because it filters.
pub fn plan_before_gather(plan: &mut Plan, choices: &Choices) {
    if choices.gather_filters() {
        plan_discontinuities(plan, choices);
    }
}

/// Plans resources and passes behind irradiance in frame order, `source`; returns what the composite reads.
pub fn plan(plan: &mut Plan, choices: &Choices, source: String) -> Vec<String> {
    let flags = discontinuity::flags(DISCONTINUITY);
    if choices.filter == Filter::None {
        return vec![source];
    }
    if choices.gather_filters() {
        return vec![source, flags];
    }
    plan_discontinuities(plan, choices);
    with_setup(choices, |setup| {
        if !choices.fused {
            return vec![choices.filter.plan(plan, setup, source, flags)];
        }
        let rows = setup.resource("rows");
        plan.buffer("filter", &rows, setup.irradiance_bytes());
        let read = [source, flags.clone()].map(|buffer| (buffer, Access::ComputeRead));
        plan.pass(setup.label.to_owned(), read.into_iter().chain([(rows.clone(), Access::ComputeWrite)]));
        vec![rows, flags]
    })
}

impl FilterStage {
    /// Takes what `plan` put in; None where nothing is filtered.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        resources: &mut Resources,
        choices: &Choices,
    ) -> Result<Option<Self>> {
        let place = with_setup(choices, |setup| {
            Ok(if choices.gather_filters() {
                Some(FilterPlace::InGather)
            } else if choices.fused {
                let rows = resources.buffer(&setup.resource("rows"));
                Some(FilterPlace::Rows { gauss: Gauss::new(gpu, setup)?, rows })
            } else {
                choices.filter.build(gpu, resources, setup)?.map(FilterPlace::OwnPass)
            })
        })?;
        let Some(place) = place else { return Ok(None) };
        let params = DiscontinuityParams {
            normal_threshold: inputs.values.number("normal-threshold") as f32,
            position_threshold: inputs.values.length("position-threshold", inputs.scene.lasting_bounds().diagonal()),
            row_pitch: choices.mapping.row_pitch(),
            stride: 1,
        };
        let (shading, rows) = (&choices.shading, choices.shading.texels.of_filter());
        let workgroup = shading.workgroup_constants();
        let discontinuity =
            Discontinuity::new(gpu, DISCONTINUITY.to_owned(), shading.position, &workgroup, rows, params)?;
        Ok(Some(Self { discontinuity, flags: resources.buffer(&discontinuity::flags(DISCONTINUITY)), place }))
    }

    /// The discontinuities, where a gather that filters needs them. Hands the G-buffer on as it leaves it.
    pub fn record_before_gather<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
    ) -> Result<(Edge<'a, GBuffer>, Option<Edge<'a, Buffer>>)> {
        if !matches!(self.place, FilterPlace::InGather) {
            return Ok((gbuffer, None));
        }
        let gbuffer = self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
        Ok((gbuffer, Some(self.flags.from(Access::ComputeWrite))))
    }

    /// Records the work that is left after the irradiance is in frame order. Hands the G-buffer on as it leaves it.
    pub fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'a, GBuffer>,
        source: Edge<'a, Buffer>,
    ) -> Result<(Edge<'a, GBuffer>, FilteredIrradiance<'a>)> {
        let flagged = |cmd: &mut Commands| {
            let gbuffer = self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
            Ok((gbuffer, self.flags.from(Access::ComputeWrite)))
        };
        // The gather or the rows have read them.
        let read_flags = Some(self.flags.from(Access::ComputeRead));
        match &self.place {
            FilterPlace::OwnPass(filter) => {
                let (gbuffer, flags) = flagged(cmd)?;
                let irradiance = filter.record(cmd, source, flags)?;
                Ok((gbuffer, FilteredIrradiance { irradiance, flags: None }))
            }
            FilterPlace::Rows { gauss, rows } => {
                let (gbuffer, flags) = flagged(cmd)?;
                gauss.record_rows(cmd, source, flags, rows)?;
                let irradiance = rows.from(Access::ComputeWrite);
                Ok((gbuffer, FilteredIrradiance { irradiance, flags: read_flags }))
            }
            FilterPlace::InGather => Ok((gbuffer, FilteredIrradiance { irradiance: source, flags: read_flags })),
        }
    }

    /// The finished irradiance; None where only the composite knows it.
    pub fn irradiance(&self) -> Option<&Buffer> {
        match &self.place {
            FilterPlace::OwnPass(filter) => Some(filter.irradiance()),
            FilterPlace::Rows { .. } | FilterPlace::InGather => None,
        }
    }
}

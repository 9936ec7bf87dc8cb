//! Discontinuities and the filter that stops at them (Segovia 2006, section 4.5), as this technique has them: both
//! directions in a pass of their own, or, with `--fuse on`, the rows here and the columns in the composite.
//! reads  the G-buffer, irradiance in frame order      writes  discontinuity.flags, filter.rows or filter.irradiance

use super::choices::Choices;
use super::discontinuity::{self, Discontinuity};
use super::road::Filter;
use crate::error::Result;
use crate::gpu::shader::structs::DiscontinuityParams;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::passes::filter::gauss::Gauss;
use crate::passes::filter::gauss_fast::GaussFast;
use crate::passes::gbuffer::GBuffer;
use crate::plan::{Plan, Resources};
use crate::techniques::Inputs;
use crate::techniques::interleaved_deferred::resources::NAME;
use ash::vk;
use std::sync::Arc;

/// Discontinuities, the filter, and what they write.
pub struct FilterStage {
    discontinuity: Discontinuity,
    pub flags: Buffer,
    gauss: AnyGauss,
}

#[expect(clippy::large_enum_variant, reason = "one a renderer, never moved")]
enum AnyGauss {
    Walk {
        gauss: Gauss,
        rows: Buffer,
        irradiance: Buffer,
    },
    Fast {
        gauss: GaussFast,
        between: [Image; 2],
        irradiance: Buffer,
    },
    /// The composite walks the columns.
    Rows {
        gauss: Gauss,
        rows: Buffer,
    },
    /// And the gather the rows.
    InGather,
}

/// What the composite reads.
pub struct Filtered<'a> {
    /// In frame order.
    pub irradiance: Edge<'a, Buffer>,
    /// Where its columns are still to be walked: where walks end.
    pub flags: Option<Edge<'a, Buffer>>,
}

/// Full name of a resource of this technique.
fn full(what: &str) -> String {
    format!("{NAME}.{what}")
}

/// Plans the discontinuities where they come before the gather, because it filters.
pub fn plan_before_gather(plan: &mut Plan, choices: &Choices) {
    if choices.gather_filters() {
        discontinuity::plan(plan, &choices.mapping, choices.shading.position);
    }
}

/// Plans resources and passes behind irradiance in frame order, `source`; returns what the composite reads.
pub fn plan(plan: &mut Plan, choices: &Choices, source: String) -> Vec<String> {
    if choices.filter == Filter::None {
        return vec![source];
    }
    if choices.gather_filters() {
        return vec![source, discontinuity::flags()];
    }
    discontinuity::plan(plan, &choices.mapping, choices.shading.position);
    let (read, written, sampled) = (Access::ComputeRead, Access::ComputeWrite, Access::ComputeSample);
    let [rows, target] = ["filter.rows", "filter.irradiance"].map(full);
    let bytes = choices.mapping.frame_texel_count() * 8;
    let mut touches = vec![(source, read), (discontinuity::flags(), read)];
    if choices.filter == Filter::GaussFast {
        for image in [full("filter.packed"), rows.clone()] {
            let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
            plan.image("filter", &image, choices.mapping.extent(), vk::Format::R16G16B16A16_SFLOAT, usage);
            touches.extend([(image.clone(), written), (image, sampled)]);
        }
    } else {
        plan.buffer("filter", &rows, bytes);
        touches.push((rows.clone(), written));
    }
    let filtered = if choices.fused {
        vec![rows, discontinuity::flags()]
    } else {
        if choices.filter == Filter::Gauss {
            touches.push((rows, read));
        }
        plan.buffer("filter", &target, bytes);
        touches.push((target.clone(), written));
        vec![target]
    };
    plan.pass(full("filter"), touches);
    filtered
}

impl FilterStage {
    /// Takes what `plan` put in; None where nothing is filtered.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        resources: &mut Resources,
        choices: &Choices,
    ) -> Result<Option<Self>> {
        let Choices { shading, mapping, kernel, .. } = choices;
        let (extent, pitch) = (mapping.extent(), mapping.row_pitch());
        let workgroup = shading.workgroup_constants();
        let walk = || Gauss::new(gpu, &workgroup, extent, pitch, *kernel, shading.texels.of_filter());
        let gauss = match choices.filter {
            Filter::None => return Ok(None),
            Filter::GaussFast => AnyGauss::Fast {
                gauss: GaussFast::new(gpu, &workgroup, extent, pitch, *kernel)?,
                between: ["filter.packed", "filter.rows"].map(|what| resources.image(&full(what))),
                irradiance: resources.buffer(&full("filter.irradiance")),
            },
            Filter::Gauss if choices.gather_filters() => AnyGauss::InGather,
            Filter::Gauss if choices.fused => {
                AnyGauss::Rows { gauss: walk()?, rows: resources.buffer(&full("filter.rows")) }
            }
            Filter::Gauss => AnyGauss::Walk {
                gauss: walk()?,
                rows: resources.buffer(&full("filter.rows")),
                irradiance: resources.buffer(&full("filter.irradiance")),
            },
        };
        let params = DiscontinuityParams {
            normal_threshold: inputs.values.number("normal-threshold") as f32,
            position_threshold: inputs.values.length("position-threshold", inputs.scene.lasting_bounds().diagonal()),
            row_pitch: pitch,
        };
        let discontinuity = Discontinuity::new(gpu, shading, params)?;
        Ok(Some(Self { discontinuity, flags: resources.buffer(&discontinuity::flags()), gauss }))
    }

    /// The discontinuities, where a gather that filters needs them.
    pub fn record_before_gather(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'_, GBuffer>,
    ) -> Result<Option<Edge<'_, Buffer>>> {
        if !matches!(self.gauss, AnyGauss::InGather) {
            return Ok(None);
        }
        self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
        Ok(Some(self.flags.from(Access::ComputeWrite)))
    }

    /// Records the work that is left after the irradiance is in frame order.
    pub fn record<'a>(
        &'a self,
        cmd: &mut Commands,
        frame: &Buffer,
        gbuffer: Edge<'_, GBuffer>,
        source: Edge<'a, Buffer>,
    ) -> Result<Filtered<'a>> {
        let read_flags = Some(self.flags.from(Access::ComputeRead));
        if !matches!(self.gauss, AnyGauss::InGather) {
            self.discontinuity.record(cmd, frame, gbuffer, &self.flags)?;
        }
        let flags = self.flags.from(Access::ComputeWrite);
        Ok(match &self.gauss {
            AnyGauss::Walk { gauss, rows, irradiance } => {
                gauss.record(cmd, NAME, source, flags, rows, irradiance)?;
                Filtered { irradiance: irradiance.from(Access::ComputeWrite), flags: None }
            }
            AnyGauss::Fast { gauss, between: [packed, rows], irradiance } => {
                gauss.record(cmd, NAME, source, flags, [packed, rows], irradiance)?;
                Filtered { irradiance: irradiance.from(Access::ComputeWrite), flags: None }
            }
            AnyGauss::Rows { gauss, rows } => {
                gauss.record_rows(cmd, NAME, source, flags, rows)?;
                Filtered { irradiance: rows.from(Access::ComputeWrite), flags: read_flags }
            }
            AnyGauss::InGather => Filtered { irradiance: source, flags: read_flags },
        })
    }

    /// The finished irradiance; None where only the composite knows it.
    pub fn irradiance(&self) -> Option<&Buffer> {
        match &self.gauss {
            AnyGauss::Walk { irradiance, .. } | AnyGauss::Fast { irradiance, .. } => Some(irradiance),
            AnyGauss::Rows { .. } | AnyGauss::InGather => None,
        }
    }
}

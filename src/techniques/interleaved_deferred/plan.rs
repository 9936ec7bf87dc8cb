//! Which passes the settings ask for, and what they need: resources by arithmetic.

use super::NAME;
use super::discontinuity;
use super::mapping::mapping;
use super::shade;
use super::split::{Road, one_pass};
use crate::error::{Error, Result};
use crate::gpu::Access;
use crate::gpu::shader::structs::MappingParams;
use crate::lights::cull;
use crate::passes::direct::{self, ShadingSettings};
use crate::passes::filter::{Kernel, StopBits};
use crate::passes::{blend, gbuffer};
use crate::plan::Plan;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::units::Extent;
use ash::vk;

/// The filter of `--filter`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    None,
    Gauss,
    GaussFast,
}

/// What the settings come to.
#[derive(Clone, Debug)]
pub struct Choices {
    pub shading: ShadingSettings,
    pub road: Road,
    /// 1x1 with `--split none`: one subset of all lights.
    pub mapping: MappingParams,
    pub filter: Filter,
    pub kernel: Kernel,
    /// The scene's own lights shaded per pixel in the composite.
    pub direct_full: bool,
    /// The scene's own lights joined to the subsets.
    pub direct_interleaved: bool,
    /// Virtual point lights.
    pub vpl_count: u32,
    /// The scene's own lights that this frame has.
    pub direct_count: u32,
}

impl Choices {
    /// Errors: an even kernel, fewer lights than subsets (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let Inputs { caps, values, lights, scene, view, .. } = inputs;
        let road = Road::from_setting(values.text("split"));
        let pattern = if road == Road::None { [1, 1] } else { values.pair("pattern") };
        let mapping = mapping(view.extent, pattern);
        // Only a picture whose pixels have different lights has anything to filter.
        let interleaved = !road.sums_all() && mapping.subset_count() > 1;
        let filter = match values.text("filter") {
            _ if !interleaved => Filter::None,
            "gauss" => Filter::Gauss,
            "gauss-fast" => Filter::GaussFast,
            _ => Filter::None,
        };
        let direct = values.text("direct");
        let choices = Self {
            shading: ShadingSettings::new(values, lights, scene.bounds().diagonal(), caps),
            road,
            mapping,
            filter,
            kernel: kernel(values)?,
            direct_full: direct == "full",
            direct_interleaved: direct == "interleaved",
            vpl_count: values.integer("vpls") as u32,
            direct_count: if direct == "none" { 0 } else { lights.lights.len() as u32 },
        };
        choices.check(values.text("pattern"))?;
        Ok(choices)
    }

    /// Errors: fewer lights than subsets (exit code 2).
    fn check(&self, pattern: &str) -> Result<()> {
        let (count, subset_count) = (self.vpl_count + self.joined_count(), self.subset_count());
        if count >= subset_count {
            return Ok(());
        }
        Err(Error::request(format!(
            "{NAME}: {count} lights for the {subset_count} subsets of --pattern {pattern}: each subset needs one"
        ))
        .note(format!("--vpls {subset_count} or more, or a smaller --pattern")))
    }

    /// Punctual lights that are joined to the subsets.
    pub fn joined_count(&self) -> u32 {
        if self.direct_interleaved { self.direct_count } else { 0 }
    }

    /// Light subsets: those of the pattern, or one.
    pub fn subset_count(&self) -> u32 {
        if self.road.sums_all() { 1 } else { self.mapping.subset_count() }
    }
}

fn kernel(values: &Values) -> Result<Kernel> {
    let taps = values.integer("kernel") as u32;
    if taps.is_multiple_of(2) {
        return Err(Error::request(format!("{NAME}: --kernel {taps}: it must be odd, from 5 to 17"))
            .note("Segovia 2006, table 2 measures 7, 11 and 17"));
    }
    let sigma = match values.number("sigma") {
        0.0 => taps as f32 / 3.0,
        sigma => sigma as f32,
    };
    let stop_bits = match values.text("discontinuity") {
        "any" => StopBits::ANY,
        _ => StopBits::DIRECTIONAL,
    };
    Ok(Kernel { taps, sigma, stop_bits })
}

/// Full name of a resource of this technique.
fn full(what: &str) -> String {
    format!("{NAME}.{what}")
}

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    let Choices { shading, mapping, .. } = choices;
    let (extent, has_emissive) = (inputs.view.extent, inputs.stats.has_emissive);
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, shading.position, has_emissive);
    let tree = shading.tree(inputs.bvh, inputs.scene)?;
    direct::plan(&mut plan, NAME, choices.direct_count as usize, shading, tree, extent);
    shade::plan(&mut plan, choices.vpl_count, choices.joined_count(), choices.subset_count());
    plan.picture(full("composite.color"), extent);
    plan.pass(full("gbuffer"), gbuffer::written(NAME, shading.position, has_emissive));
    let masks = shading.culls(choices.direct_count as usize).then_some(NAME);
    if masks.is_some() {
        let written = cull::masks(NAME, Access::ComputeWrite);
        plan.pass(full("cull"), gbuffer::surface(NAME, shading.position).into_iter().chain([written]));
    }
    let gathered = roads(&mut plan, choices);
    let irradiance = filter(&mut plan, choices, gathered, extent, mapping.frame_texel_count());
    let mut composed = gbuffer::shading(NAME, shading.position, has_emissive);
    composed.extend(masks.map(|technique| cull::masks(technique, Access::ComputeRead)));
    composed.extend([(irradiance, Access::ComputeRead), (full("composite.color"), Access::ComputeWrite)]);
    plan.pass(full("composite"), composed);
    if inputs.stats.has_blend {
        plan.pass(full("blend"), blend::touches(NAME, &full("composite.color")));
    }
    Ok(plan)
}

/// Split, shade, gather; returns the name of the irradiance in frame order.
fn roads(plan: &mut Plan, choices: &Choices) -> String {
    let Choices { shading, road, mapping, .. } = choices;
    let frame_bytes = mapping.frame_texel_count() * 8;
    let (shaded, gathered) = (full("shade.irradiance"), full("gather.irradiance"));
    let surface = || gbuffer::surface(NAME, shading.position);
    let (read, written) = (Access::ComputeRead, Access::ComputeWrite);
    match road {
        Road::None | Road::Branch | Road::Indirect | Road::Remap => {
            plan.buffer("irradiance", &shaded, frame_bytes);
            plan.pass(full("shade"), surface().into_iter().chain([(shaded.clone(), written)]));
            shaded
        }
        Road::Subsample => {
            let upscaled = full("upscale.irradiance");
            plan.buffer("irradiance", &shaded, mapping.sub_texel_count() * 8);
            plan.buffer("irradiance", &upscaled, frame_bytes);
            plan.pass(full("shade"), surface().into_iter().chain([(shaded.clone(), written)]));
            plan.pass(full("upscale"), [(shaded, read), (upscaled.clone(), written)]);
            upscaled
        }
        Road::OnePass => {
            one_pass::plan(plan, mapping, shading.position.bytes());
            plan.buffer("irradiance", &shaded, mapping.texel_count() * 8);
            plan.buffer("irradiance", &gathered, frame_bytes);
            plan.pass(full("split"), surface().into_iter().chain(one_pass::touches(written)));
            plan.pass(full("shade"), one_pass::touches(read).into_iter().chain([(shaded.clone(), written)]));
            plan.pass(full("gather"), [(shaded, read), (gathered.clone(), written)]);
            gathered
        }
    }
}

/// Discontinuities and the filter; returns the name of what the composite reads.
fn filter(plan: &mut Plan, choices: &Choices, source: String, extent: Extent, texel_count: u64) -> String {
    if choices.filter == Filter::None {
        return source;
    }
    let (flags, target) = (full("discontinuity.flags"), full("filter.irradiance"));
    let (read, written, sampled) = (Access::ComputeRead, Access::ComputeWrite, Access::ComputeSample);
    discontinuity::plan(plan, &choices.mapping);
    let surface = gbuffer::surface(NAME, choices.shading.position);
    plan.pass(full("discontinuity"), surface.into_iter().chain([(flags.clone(), written)]));
    let mut touches = vec![(source, read), (flags, read), (target.clone(), written)];
    plan.buffer("filter", &target, texel_count * 8);
    let (packed, horizontal) = (full("filter.packed"), full("filter.horizontal"));
    if choices.filter == Filter::GaussFast {
        for image in [&packed, &horizontal] {
            filter_image(plan, image, extent);
            touches.extend([(image.clone(), written), (image.clone(), sampled)]);
        }
    } else {
        plan.buffer("filter", &horizontal, texel_count * 8);
        touches.extend([(horizontal.clone(), written), (horizontal, read)]);
    }
    plan.pass(full("filter"), touches);
    target
}

fn filter_image(plan: &mut Plan, name: &str, extent: Extent) {
    let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
    plan.image("filter", name, extent, vk::Format::R16G16B16A16_SFLOAT, usage);
}

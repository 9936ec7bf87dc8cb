//! Which passes the settings ask for, and what they need: resources by arithmetic.

use super::NAME;
use super::discontinuity;
use super::mapping::mapping;
use super::shade::{self, SubsetLights};
use super::split::{Road, one_pass};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::MappingParams;
use crate::passes::direct::{self, ShadingSettings};
use crate::passes::filter::{Kernel, StopBits};
use crate::passes::gbuffer;
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
}

impl Choices {
    /// Errors: an even kernel (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let Inputs { values, lights, scene, view, .. } = inputs;
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
        Ok(Self {
            shading: ShadingSettings::new(values, lights, scene.bounds().diagonal()),
            road,
            mapping,
            filter,
            kernel: kernel(values)?,
            direct_full: values.text("direct") == "full",
            direct_interleaved: values.text("direct") == "interleaved",
        })
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

/// The resources of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>, lights: &SubsetLights, direct_light_count: usize) -> Result<Plan> {
    let Choices { shading, road, mapping, filter, .. } = choices;
    let extent = inputs.view.extent;
    let frame_bytes = mapping.frame_texel_count() * 8;
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, shading.position, inputs.stats.has_emissive);
    let tree = shading.tree(inputs.bvh, inputs.scene)?;
    direct::plan(&mut plan, NAME, direct_light_count, shading, tree, extent);
    shade::plan(&mut plan, lights);
    match road {
        Road::None | Road::Branch | Road::Indirect | Road::Remap => {
            plan.buffer("irradiance", format!("{NAME}.shade.irradiance"), frame_bytes)
        }
        Road::Subsample => {
            plan.buffer("irradiance", format!("{NAME}.shade.irradiance"), mapping.sub_texel_count() * 8);
            plan.buffer("irradiance", format!("{NAME}.upscale.irradiance"), frame_bytes);
        }
        Road::OnePass => {
            one_pass::plan(&mut plan, mapping, shading.position.bytes());
            plan.buffer("irradiance", format!("{NAME}.shade.irradiance"), mapping.texel_count() * 8);
            plan.buffer("irradiance", format!("{NAME}.gather.irradiance"), frame_bytes);
        }
    }
    if *filter != Filter::None {
        discontinuity::plan(&mut plan, mapping);
        plan.buffer("filter", format!("{NAME}.filter.irradiance"), frame_bytes);
    }
    match filter {
        Filter::None => {}
        Filter::Gauss => plan.buffer("filter", format!("{NAME}.filter.horizontal"), frame_bytes),
        Filter::GaussFast => {
            filter_image(&mut plan, "packed", extent);
            filter_image(&mut plan, "horizontal", extent);
        }
    }
    plan.picture(format!("{NAME}.composite.color"), extent);
    Ok(plan)
}

fn filter_image(plan: &mut Plan, what: &str, extent: Extent) {
    let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
    plan.image("filter", format!("{NAME}.filter.{what}"), extent, vk::Format::R16G16B16A16_SFLOAT, usage);
}

//! What the settings come to: the tile, and each component.

use super::components::SampleCount;
use super::resources::NAME;
use super::settings::{Component, Mode, Refine};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::AdaptiveParams;
use crate::settings::PositionStorage;
use crate::techniques::Inputs;
use crate::units::Extent;

/// Shadow rays start this part of the scene's diagonal off their surface: more than positions of 16 bits are off by.
const RAY_OFFSET: f32 = 1e-4;

pub struct Choices {
    pub extent: Extent,
    pub position: PositionStorage,
    pub workgroup: [u32; 2],
    pub tile_px: [u32; 2],
    pub refine: Refine,
    pub mode: Mode,
    /// Metres.
    pub ray_offset: f32,
    pub vpl_clamp_m: f32,
    pub is_emissive: bool,
    /// In the order in which they are listed.
    pub components: Vec<ComponentChoice>,
}

/// One component.
pub struct ComponentChoice {
    pub component: Component,
    pub count: SampleCount,
    pub params: AdaptiveParams,
}

impl Choices {
    /// Errors: settings that contradict each other, the scene or the device (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let (values, extent) = (inputs.values, inputs.view.extent);
        let (mode, [tile_x, tile_y]) = (values.choice("mode"), values.pair("tile"));
        if tile_x > extent.width || tile_y > extent.height {
            return Err(Error::request(format!(
                "{NAME}: --tile {tile_x}x{tile_y} is larger than the picture's {extent}"
            ))
            .note("a smaller --tile, or a larger --size"));
        }
        // What lights reach in one frame of an animation, they reach in all of them.
        let diagonal = inputs.scene.lasting_bounds().diagonal();
        let vpl_clamp_m = values.length("vpl-clamp", diagonal);
        let base = values.integer("base") as u32;
        let texel_count = extent.pixel_count() as u32;
        let listed = (0u32..).zip(values.listed::<Component>("components"));
        let components = listed.map(|(index, component)| {
            let (method, key) = (component.method(), component.name());
            let most = method.most_iterations(values);
            if base > most {
                return Err(Error::request(format!(
                    "{NAME}: --base {base} with --{key}-max {most}: the initial pass alone has more iterations"
                ))
                .note(format!("--base {most} or fewer, or --{key}-max {base}")));
            }
            let count = method.count(inputs, [tile_x, tile_y])?;
            let params = AdaptiveParams {
                tile_x,
                tile_y,
                tile_columns: extent.width.div_ceil(tile_x),
                tile_count: extent.width.div_ceil(tile_x) * extent.height.div_ceil(tile_y),
                base,
                most: if mode == Mode::Igi { base } else { most },
                refines_all: u32::from(mode == Mode::Max),
                irradiance_first: index * texel_count,
                source_count: count.sources,
                light_count: count.lights,
                least_squared: vpl_clamp_m * vpl_clamp_m,
            };
            Ok(ComponentChoice { component, count, params })
        });
        Ok(Self {
            extent,
            position: values.choice("position"),
            workgroup: values.pair("workgroup"),
            tile_px: [tile_x, tile_y],
            refine: values.choice("refine"),
            mode,
            ray_offset: RAY_OFFSET * diagonal.max(1e-6),
            vpl_clamp_m,
            is_emissive: inputs.emissive_lights(),
            components: components.collect::<Result<_>>()?,
        })
    }

    /// WORKGROUP_X and WORKGROUP_Y.
    pub fn workgroup_constants(&self) -> [(&'static str, u32); 2] {
        [("WORKGROUP_X", self.workgroup[0]), ("WORKGROUP_Y", self.workgroup[1])]
    }

    /// RAY_OFFSET.
    pub fn ray_constants(&self) -> [(&'static str, u32); 1] {
        [("RAY_OFFSET", self.ray_offset.to_bits())]
    }

    /// Whether tiles are refined by a dispatch of their own.
    pub fn has_refinement(&self) -> bool {
        self.mode != Mode::Igi && self.refine == Refine::Indirect
    }

    /// Whether all is one dispatch.
    pub fn is_fused(&self) -> bool {
        self.mode != Mode::Igi && self.refine == Refine::Fused
    }

    /// A pattern of one pixel leaves nothing to smooth.
    pub fn is_filtered(&self) -> bool {
        self.tile_px != [1, 1]
    }
}

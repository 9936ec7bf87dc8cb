//! What the settings come to: the tile, and each component.

use super::components::PreparedComponent;
use super::resources::NAME;
use super::settings::{self, Component, GuidanceOf, LightChoice, Mode, RayOrder, Refine, Trace};
use crate::bvh::Bvh;
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{AdaptiveParams, LightBlock, MediumBlock};
use crate::gpu::shader::{Shader, variant};
use crate::lights::object_lists::ObjectLists;
use crate::passes::blend;
use crate::passes::direct::{self, DirectSettings};
use crate::passes::workgroup::workgroup;
use crate::scene::Medium;
use crate::settings::{Brdf, DirectShadow, PositionStorage};
use crate::techniques::Inputs;
use crate::units::Extent;
use bytemuck::Zeroable;
use std::sync::Arc;

pub struct Choices {
    pub extent: Extent,
    pub position: PositionStorage,
    pub workgroup: [u32; 2],
    pub tile_px: [u32; 2],
    pub trace: Trace,
    pub refine: Refine,
    pub guidance_of: GuidanceOf,
    pub ray_order: RayOrder,
    /// How the virtual lights of `id` are chosen.
    pub light_choice: LightChoice,
    pub mode: Mode,
    /// Diffuse light, and a shadow ray for every light.
    pub direct: DirectSettings,
    /// Metres.
    pub vpl_clamp_m: f32,
    pub is_emissive: bool,
    /// Whether the scene has BLEND surfaces.
    pub has_blend: bool,
    /// What light passes through.
    pub medium: Option<Medium>,
    /// The same in its box.
    pub medium_block: Option<MediumBlock>,
    /// In the order in which they are listed.
    pub components: Vec<ComponentChoice>,
    /// The scene's own lights.
    pub lights: Vec<LightBlock>,
    /// Lists of those for what blends.
    pub blended: ObjectLists,
}

/// One component.
pub struct ComponentChoice {
    pub component: Component,
    /// What makes its samples.
    pub prepared: Box<dyn PreparedComponent>,
    pub params: AdaptiveParams,
}

impl ComponentChoice {
    /// Texels at which it is estimated.
    pub fn extent(&self) -> Extent {
        Extent { width: self.params.width, height: self.params.height }
    }

    /// Whether it is estimated at fewer pixels than the frame has.
    pub fn is_reduced(&self) -> bool {
        self.params.scale > 1
    }
}

impl Choices {
    /// Errors: settings that contradict each other, the scene or the device (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let (values, extent) = (inputs.values, inputs.view.extent);
        let (mode, [tile_x, tile_y]) = (values.choice("mode"), values.pair("tile"));
        // What lights reach in one frame of an animation, they reach in all of them.
        let diagonal = inputs.scene.lasting_bounds().diagonal();
        let vpl_clamp_m = values.length("vpl-clamp", diagonal);
        let base = values.integer("base") as u32;
        let medium_block = inputs.medium_block();
        let listed = settings::listed(values);
        let candidates = listed.clone().unwrap_or_else(|| Component::ALL.to_vec());
        let components = candidates.into_iter().map(|component| {
            let (method, key) = (component.method(), component.name());
            let most = method.most_iterations(values);
            let scale = method.scale(values);
            let own = extent.reduced(scale);
            if tile_x > own.width || tile_y > own.height {
                let of = if scale > 1 {
                    format!("{own} of {extent} pixels that {key} is estimated at")
                } else {
                    format!("picture's {extent}")
                };
                return Err(Error::request(format!("{NAME}: --tile {tile_x}x{tile_y} is larger than the {of}"))
                    .note("a smaller --tile, or a larger --size"));
            }
            let Some(prepared) = method.prepare(inputs, [tile_x, tile_y], listed.is_some())? else { return Ok(None) };
            if base > most {
                return Err(Error::request(format!(
                    "{NAME}: --base {base} with --{key}-max {most}: the initial pass alone has more iterations"
                ))
                .note(format!("--base {most} or fewer, or --{key}-max {base}")));
            }
            let count = prepared.count();
            let columns = own.width.div_ceil(tile_x);
            let mut params = AdaptiveParams {
                medium: medium_block.unwrap_or_else(MediumBlock::zeroed),
                width: own.width,
                height: own.height,
                scale,
                tile_x,
                tile_y,
                tile_columns: columns,
                tile_count: columns * own.height.div_ceil(tile_y),
                base,
                most,
                guides_each: u32::from(method.guides_each(values)),
                refines_all: u32::from(mode == Mode::Max),
                source_count: count.sources,
                light_count: if count.has_lights { inputs.lights.lights.len() as u32 } else { 0 },
                least_squared: vpl_clamp_m * vpl_clamp_m,
                march_step: 0.0,
                halo: 0.0,
                seed: values.integer("seed") as u32,
                until_error: values.number("until-error") as f32,
                ..AdaptiveParams::zeroed()
            };
            prepared.write(&mut params);
            Ok(Some(ComponentChoice { component, prepared, params }))
        });
        let components = components.filter_map(Result::transpose).collect::<Result<_>>()?;
        let lights = direct::light_blocks(inputs.lights, values);
        Ok(Self {
            blended: blend::lists(inputs.scene, &lights, values, inputs.caps)?,
            lights,
            extent,
            position: values.choice("position"),
            workgroup: workgroup(values, inputs.caps),
            tile_px: [tile_x, tile_y],
            trace: values.choice("trace"),
            refine: values.choice("refine"),
            guidance_of: values.choice("guidance-of"),
            ray_order: values.choice("ray-order"),
            light_choice: values.choice("id-choice"),
            mode,
            direct: DirectSettings::with(Brdf::Lambert, DirectShadow::Ray, inputs.lights, inputs.scene),
            vpl_clamp_m,
            is_emissive: inputs.emissive_lights(),
            has_blend: inputs.stats.has_blend,
            medium: inputs.medium(),
            medium_block,
            components,
        })
    }

    /// WORKGROUP_X and WORKGROUP_Y.
    pub fn workgroup_constants(&self) -> [(&'static str, u32); 2] {
        [("WORKGROUP_X", self.workgroup[0]), ("WORKGROUP_Y", self.workgroup[1])]
    }

    /// Whether threads that lie together have one slot of several tiles.
    pub fn is_by_slot(&self) -> bool {
        self.ray_order == RayOrder::Slot && !self.is_fused()
    }

    /// BY_SLOT.
    pub fn order_constant(&self) -> (&'static str, u32) {
        ("BY_SLOT", u32::from(self.is_by_slot()))
    }

    /// The pipeline of a pass that estimates a component: of those variants the one of its positions and its component.
    pub fn estimating_pipeline(
        &self,
        gpu: &Arc<Gpu>,
        variants: &'static [&'static Shader],
        component: Component,
        constants: &[(&'static str, u32)],
    ) -> Result<ComputePipeline> {
        let shader = variant(variants, &[self.position.name(), component.name()]);
        let mut all = [constants, &[self.direct.offset_constant()]].concat();
        if component == Component::Id {
            all.push(("BY_CONTRIBUTION", u32::from(self.light_choice == LightChoice::Contribution)));
        }
        ComputePipeline::new(gpu, shader, &all)
    }

    /// Whether tiles iterate on after the initial pass.
    pub fn is_guided(&self) -> bool {
        self.mode != Mode::Igi
    }

    /// Whether a tile's guidance is not its own alone.
    pub fn spreads(&self) -> bool {
        self.has_refinement() && self.guidance_of != GuidanceOf::Tile
    }

    /// Components whose initial passes come before the refinement of any of them, at least 1.
    pub fn recorded_together(&self) -> usize {
        let is_shared = self.spreads() && self.guidance_of == GuidanceOf::Components;
        if is_shared { self.components.len().max(1) } else { 1 }
    }

    /// Whether tiles are refined by a dispatch of their own.
    pub fn has_refinement(&self) -> bool {
        self.is_guided() && self.trace == Trace::Device && self.refine == Refine::Indirect
    }

    /// Whether all is one dispatch.
    pub fn is_fused(&self) -> bool {
        self.is_guided() && self.trace == Trace::Device && self.refine == Refine::Fused
    }

    /// The tree that rays of the device walk: the empty one where none is cast, for blended surfaces cast shadow rays too.
    pub fn device_tree<'a>(&self, inputs: &Inputs<'a>) -> Result<&'a Bvh> {
        match self.trace == Trace::Host && !self.has_blend {
            true => Ok(inputs.bvh.empty()),
            false => inputs.bvh.over(inputs.scene),
        }
    }

    /// Whether the device reads the samples of a component: blended surfaces are lit by virtual lights.
    pub fn has_device_samples(&self, component: Component) -> bool {
        self.trace == Trace::Device || component == Component::Id && self.has_blend
    }
}

//! Segovia, Iehl, Mitanchey, Peroche 2006: Non-interleaved Deferred Shading of Interleaved Sample Patterns.
//!
//! Hundreds of virtual point lights are distributed over the n x m pixels of a pattern, the G-buffer is split so that
//! pixels with the same lights lie together, each sub-buffer is shaded with its own lights, the irradiance is gathered
//! back, filtered where no discontinuity is, and multiplied with the albedo last.
//!
//! Passes, in order: vpls (on the host), gbuffer, cull, split, shade, gather, discontinuity, filter, composite, blend.
//! With `--split two-pass`, and `fragment` in two passes, split is split.blocks and split.translate, and gather is
//! gather.translate and gather.blocks. Splits that copy nothing have neither; before the shading of `stencil` and
//! `depth` comes mask. With `--fuse on` gather walks the filter's rows (behind discontinuity, which then comes before
//! split) and composite its columns: no pass filter where one compute shader pulls each pixel.
//!
//! Differs from the paper
//! - by default compute shaders copy, where the paper drew; `--split fragment` draws, with the paper's look-up textures
//! - sub-buffers are tiled in an image, as in the paper's figure 3, with `--storage image`; in buffers, the default on
//!   software drivers, they lie one after the other
//! - compute shaders shade sub-buffers, where the paper drew quads
//! - sub-buffers are padded to whole patterns or blocks, so the tiled buffer is at least as large as the frame, not equal
//! - only position and normal are split: shading sums irradiance, virtual point lights are Lambert
//! - the direct lights' pattern, made by clustering sub-buffers (section 4.6), may be of any divisors of the split's, where
//!   the paper says powers of two
//! - secondary lights are never shadowed (SNSM), as in the paper's section 6.2
//!
//! Equal to the reference: at pattern 1x1, and with `--split none`, it is plain deferred shading of the same lights;
//! every split except `none` and `subsample` gives the picture of `branch`, to the bit on software drivers.

mod aov;
mod choices;
pub mod composite;
pub mod drawn_irradiance;
pub mod filter;
mod frame;
pub mod gather;
pub mod lookup;
pub mod mapping;
pub mod mask;
mod plan;
mod resources;
pub mod settings;
pub mod shade;
pub mod split;
pub mod split_method;
mod split_passes;
pub mod sub_buffers;
pub mod subsets;
pub mod upscale;

use super::{Frame, Inputs, NamedPattern, Prepared, Technique, light_visibility};
use crate::caps::{Caps, Need};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::LightBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::object_lists::ObjectLists;
use crate::lights::{LightSet, vpl};
use crate::passes::blend;
use crate::passes::filter::Filter;
use crate::passes::{direct, gbuffer};
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::settings::{CULL_CONDITIONS, Condition, LIGHT_LISTS, SHADING, Setting, Values};
use crate::techniques::interleaved_deferred::resources::NAME;
use choices::Choices;
use frame::{FrameLights, InterleavedFrame};
use shade::SubsetLights;
use split_method::SplitMethod;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

pub struct InterleavedDeferred;

impl Technique for InterleavedDeferred {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "Segovia 2006: virtual point lights interleaved over a pattern, shaded in sub-buffers"
    }

    fn scene(&self) -> &'static str {
        "hall"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, SHADING, LIGHT_LISTS]
    }

    fn conditions(&self) -> &'static [&'static [Condition]] {
        &[settings::CONDITIONS, CULL_CONDITIONS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        aov::AOVS
    }

    fn stages_left_out(&self, inputs: &Inputs<'_>) -> Result<Vec<(&'static str, String)>> {
        Ok(aov::left_out(&Choices::new(inputs)?, inputs.values))
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("storage", "image"), ("position", "unorm16"), ("cull", "none"), ("direct-shadow", "none")]
    }

    fn needs(&self, values: &Values, caps: &Caps, has_blend: bool) -> Vec<Need> {
        let mut needs: Vec<Need> = [gbuffer::need()].into_iter().chain(blend::needs(has_blend)).collect();
        if let Ok(split) = SplitMethod::new(values, caps) {
            needs.extend(split.needs(values));
            let filter = Filter::from_setting(values.text("filter"));
            needs.extend(filter.need().filter(|_| !split.sums_all()));
        }
        needs
    }

    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)> {
        choices::bounds(caps)
    }

    /// Direct light, and what as many bounces as light walks have bring, unshadowed (SNSM) and clamped.
    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        let mut settings = vec![
            ("light-visibility", light_visibility(values, lights, 0)?),
            ("vpl-visibility", "off".to_owned()),
            ("ambient-visibility", "off".to_owned()),
        ];
        match values.integer("vpl-bounces") {
            1 => settings.push(("transport", "one-bounce".to_owned())),
            // The surface that is seen scatters too.
            more => settings.extend([("transport", "full".to_owned()), ("bounces", (more + 1).to_string())]),
        }
        match values.text("direct") {
            // Joined to the subsets, direct light is diffuse.
            "interleaved" => settings.push(("brdf", "lambert".to_owned())),
            "none" => {
                return Err(Error::request("--direct none: path tracing cannot leave out direct light")
                    .note("--direct full and interleaved have a reference"));
            }
            _ => {}
        }
        Ok(settings)
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        choices::PATTERNS
    }

    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let choices = Choices::new(inputs)?;
        let blended = blended(inputs, &direct_lights(&choices, inputs))?;
        plan::plan(&choices, inputs, &blended)
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let choices = Choices::new(inputs)?;
        let values = inputs.values;
        let emissive = match values.text("emissive") {
            "auto" => !inputs.lights.has_punctual,
            text => text == "on",
        };
        let walk = vpl::Walk {
            count: choices.vpl_count,
            bounces: values.integer("vpl-bounces") as u32,
            emissive,
            seed: values.integer("seed") as u32,
        };
        let bvh = inputs.bvh.over(inputs.scene)?;
        let started = Instant::now();
        let found = vpl::walk(inputs.scene, bvh, &inputs.lights.lights, &walk);
        let walk_ns = started.elapsed().as_nanos() as u64;
        let direct_lights = direct_lights(&choices, inputs);
        let joined: &[LightBlock] = if choices.direct_interleaved { &direct_lights } else { &[] };
        // The order depends on the pattern: dealt for the whole, then cut.
        let bounds = inputs.scene.bounds();
        let lights = SubsetLights {
            subsets: choices.subsets(),
            lights: subsets::dealt(joined, &bounds, choices.direct_subset_count()),
            vpls: found.vpls,
        };
        let clamp = values.length("vpl-clamp", bounds.diagonal());
        let mut resolved = choices.resolved();
        resolved.insert("emissive", if emissive { "on" } else { "off" }.to_owned());
        resolved.insert("vpl-clamp", format!("{clamp}"));
        Ok(Box::new(PreparedInterleaved {
            blended: blended(inputs, &direct_lights)?,
            choices,
            lights,
            direct_lights,
            walk_ns,
            walk_count: found.walk_count,
            found_count: found.found_count,
            resolved,
        }))
    }
}

/// The scene's own lights that a frame has.
fn direct_lights(choices: &Choices, inputs: &Inputs<'_>) -> Vec<LightBlock> {
    let mut lights = direct::light_blocks(inputs.lights, inputs.values);
    lights.truncate(choices.direct_count as usize);
    lights
}

/// The lists of what blends.
fn blended(inputs: &Inputs<'_>, direct_lights: &[LightBlock]) -> Result<ObjectLists> {
    blend::lists(inputs.scene, direct_lights, inputs.values, inputs.caps)
}

struct PreparedInterleaved {
    choices: Choices,
    lights: SubsetLights,
    direct_lights: Vec<LightBlock>,
    blended: ObjectLists,
    walk_ns: u64,
    walk_count: u32,
    found_count: u32,
    resolved: BTreeMap<&'static str, String>,
}

impl Prepared for PreparedInterleaved {
    fn host_passes(&self) -> Vec<(String, u64)> {
        vec![(format!("{NAME}.vpls"), self.walk_ns)]
    }

    fn counters(&self) -> BTreeMap<&'static str, f64> {
        let mean = |count: usize, subset_count: u32| count as f64 / f64::from(subset_count);
        let vpls = mean(self.lights.vpls.len(), self.choices.subset_count());
        let joined = mean(self.lights.lights.len(), self.choices.direct_subset_count());
        let mut counters = BTreeMap::from([
            ("lights", self.direct_lights.len() as f64),
            ("vpls", self.lights.vpls.len() as f64),
            ("vpls_found", f64::from(self.found_count)),
            ("light_walks", f64::from(self.walk_count)),
            ("shaded_pixels", self.choices.shaded_pixel_count() as f64),
            ("subset_lights_per_pixel", vpls + joined),
        ]);
        counters.extend(blend::counters(&self.blended));
        counters
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        self.resolved.clone()
    }

    fn light_counts(&self) -> [u32; 2] {
        [self.direct_lights.len() as u32, self.lights.vpls.len() as u32]
    }

    fn build(
        self: Box<Self>,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let Self { choices, lights, direct_lights, blended, .. } = *self;
        let lights = FrameLights { subsets: &lights, direct: &direct_lights, blended: &blended };
        Ok(Box::new(InterleavedFrame::new(gpu, inputs, scene, resources, &choices, &lights)?))
    }
}

impl Frame for InterleavedFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        // Each pass is handed the G-buffer as the one before it left it.
        let gbuffer = self.record_gbuffer(cmd, scene, frame)?;
        let gbuffer = self.record_cull(cmd, frame, gbuffer)?;
        let (gbuffer, flags) = self.record_flags_of_gather(cmd, frame, gbuffer)?;
        let (gbuffer, irradiance) = self.split_passes.record(cmd, frame, &self.shade, &self.direct, gbuffer, flags)?;
        let (gbuffer, irradiance) = self.record_filter(cmd, frame, gbuffer, irradiance)?;
        let gbuffer = self.composite.record(cmd, frame, &self.direct, gbuffer, irradiance, &self.color)?;
        self.record_blend(cmd, scene, frame, gbuffer, self.color.from(Access::ComputeWrite))
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.gbuffer_pass.counters().into()
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.color, if self.blend.is_some() { Access::ColorWrite } else { Access::ComputeWrite })
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        if self.is_lit_fully { self.direct.counters(gpu, self.color.description.extent) } else { Ok(BTreeMap::new()) }
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        aov::read(self, gpu, name)
    }
}

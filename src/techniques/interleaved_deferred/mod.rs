//! Segovia, Iehl, Mitanchey, Peroche 2006: Non-interleaved Deferred Shading of Interleaved Sample Patterns.
//!
//! Hundreds of virtual point lights are distributed over the n x m pixels of a pattern, the G-buffer is split so that
//! pixels with the same lights lie together, each sub-buffer is shaded with its own lights, the irradiance is gathered
//! back, filtered where no discontinuity is, and multiplied with the albedo last.
//!
//! Passes, in order: vpls (on the host), gbuffer, cull, split, shade, gather, discontinuity, filter, composite, blend; with
//! `--accumulate` above 1 vpls, shade, gather, blend and accumulate.sums come once a run, accumulate.mean before discontinuity and
//! accumulate.over last.
//! With `--split two-pass`, and `fragment` in two passes, split is split.blocks and split.translate, and gather is
//! gather.translate and gather.blocks. Splits that copy nothing have neither; before the shading of `stencil` and
//! `depth` comes mask. With `--fuse on` gather walks the filter's rows (behind discontinuity, which then comes before
//! shade) and composite its columns: no pass filter where one compute shader pulls each pixel.
//!
//! With `--vpl-shadow` vpl_shadow comes before shade and finds the lights that a pixel does not see. With maps vpl_maps, which draws
//! them, comes before it; where not all maps are held at once, both come once a turn, with the turn's number behind their names.
//!
//! Differs from the paper
//! - by default compute shaders copy, where the paper drew; `--split fragment` draws, with the paper's look-up textures
//! - sub-buffers are tiled in an image, as in the paper's figure 3, with `--storage image`; in buffers, the default on
//!   software drivers, they lie one after the other
//! - by default compute shaders shade sub-buffers, where the paper drew; `--shade-by viewport` and `quad` draw
//! - sub-buffers are padded to whole patterns or blocks, so the tiled buffer is at least as large as the frame, not equal
//! - only position and normal are split, where nothing needs more (`--sub-buffer-color on` moves the colour too, as in the paper)
//! - virtual point lights light surfaces as diffuse ones by default; with `--vpl-brdf ggx` what is shaded is divided by the surface's
//!   colour before the filter, where the paper says nothing of how a glossy term is filtered
//! - the direct lights' pattern, made by clustering sub-buffers (section 4.6), may be of any divisors of the split's, where
//!   the paper says powers of two
//! - the filter stops at a discontinuity in its own direction; `--discontinuity any` stops at any of the three, as the paper does
//! - what hides a light from a pixel is found before the shading, and not in its loop: the maps need not be held all at once
//!
//! Equal to the reference: at pattern 1x1, and with `--split none`, it is plain deferred shading of the same lights;
//! every split except `none` and `subsample` gives the picture of `branch`, to the bit on software drivers.

pub mod accumulate;
mod aov;
mod bench_stages;
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
mod run_settings;
mod runs;
pub mod settings;
pub mod shade;
pub mod split;
pub mod split_method;
mod split_passes;
pub mod sub_buffers;
pub mod subsets;
pub mod upscale;
pub mod vpl_shadow;

use super::bench_stage::{BenchStage, PlainForm};
use super::notes::{self, Figures};
use super::parts::{InParts, Part, Runs};
use super::{Frame, HostPart, Inputs, NamedPattern, Prepared, Run, Technique, Tuned, light_visibility};
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
use crate::plan::Plan;
use crate::resident::SceneGpu;
use crate::settings::{Brdf, LIGHT_LISTS, Setting, Values};
use crate::techniques::interleaved_deferred::resources::NAME;
use choices::{Choices, Direct, VplShadow};
use frame::{FrameLights, InterleavedFrame};
use runs::ManyRuns;
use shade::SubsetLights;
use split_method::SplitMethod;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;
use vpl_shadow::{FindHidden, VplMaps};

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
        &[settings::SETTINGS, run_settings::RUNS, settings::SHADING, LIGHT_LISTS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        aov::AOVS
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("storage", "image"),
            ("position", "unorm16"),
            ("cull", "none"),
            ("direct-shadow", "none"),
            ("vpl-shadow", "none"),
        ]
    }

    fn needs(&self, values: &Values, caps: &Caps, has_blend: bool) -> Vec<Need> {
        let of_rays = match values.choice("vpl-shadow") {
            VplShadow::None | VplShadow::Map => direct::needs(values),
            VplShadow::Ray => direct::depth_rays(values),
        };
        let mut needs: Vec<Need> =
            [gbuffer::need()].into_iter().chain(blend::needs(has_blend)).chain(of_rays).collect();
        if let Ok(split) = SplitMethod::new(values, caps) {
            needs.extend(split.needs(values));
            let filter: Filter = values.choice("filter");
            needs.extend(filter.need().filter(|_| !split.sums_all()));
        }
        needs
    }

    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)> {
        choices::bounds(caps)
    }

    /// Direct light, and what as many bounces as light walks have bring: unshadowed (SNSM), clamped and by `--vpl-brdf`, or
    /// with `--vpl-shadow` as it is, by `--brdf`.
    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        let mut settings = vec![
            ("light-visibility", light_visibility(values, lights, 0)?),
            ("vpl-visibility", if values.is("vpl-shadow", VplShadow::None) { "off" } else { "on" }.to_owned()),
            ("ambient-visibility", "off".to_owned()),
        ];
        match values.integer("vpl-bounces") {
            1 => settings.push(("transport", "one-bounce".to_owned())),
            // The surface that is seen scatters too.
            more => settings.extend([("transport", "full".to_owned()), ("bounces", (more + 1).to_string())]),
        }
        if run_settings::run_count(values) > 1 {
            // What edges lack would hide what runs come to.
            settings.push(("pixel", "middle".to_owned()));
        }
        match values.choice("direct") {
            // Joined to the subsets, direct light is scattered as that of virtual lights.
            Direct::Interleaved => settings.push(("brdf", values.choice::<Brdf>("vpl-brdf").name().to_owned())),
            Direct::None => {
                return Err(Error::request("--direct none: path tracing cannot leave out direct light")
                    .note("--direct full and interleaved have a reference"));
            }
            Direct::Full => {}
        }
        Ok(settings)
    }

    /// 2: light walks leave mirrored emissive surfaces from their front.
    fn estimator_version(&self) -> u32 {
        2
    }

    fn tuned(&self) -> Tuned {
        &[
            ("split", &["none", "branch", "indirect", "remap", "one-pass", "two-pass", "tile"]),
            ("pattern", &["2x2", "4x4", "8x8"]),
            ("filter", &["gauss", "gauss-fast"]),
            ("fuse", &["off", "on"]),
            ("storage", &["auto", "buffer", "image"]),
            ("copy", &["pull", "push"]),
            ("block", &["8", "16", "32", "64"]),
            ("texels", &["auto", "1", "4", "16"]),
            ("workgroup", &["auto", "8x8", "16x16", "64x1", "256x1"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn plain(&self) -> Option<&'static PlainForm> {
        Some(&bench_stages::PLAIN)
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        let vpls = figures.counter("vpls_found").zip(figures.counter("vpls"));
        let dark = vpls.filter(|(found, wanted)| found < wanted).map(|(found, wanted)| {
            format!(
                "  note: light walks found places for {found} virtual point lights of {wanted}; the others are dark"
            )
        });
        let composite = format!("{NAME}.composite");
        let runs = figures.counter("runs").map(|runs| {
            let plural = if runs == 1.0 { "" } else { "s" };
            notes::estimated_error(figures, &format!("{runs} run{plural}"), "--accumulate")
        });
        let direct = notes::direct_light(figures, Some(&composite));
        dark.into_iter().chain(direct).chain(runs.into_iter().flatten()).collect()
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        choices::PATTERNS
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let mut choices = Choices::new(inputs)?;
        let mut direct_lights = direct::light_blocks(inputs.lights, inputs.values);
        direct_lights.truncate(choices.direct_count as usize);
        let blended = blend::lists(inputs.scene, &direct_lights, inputs.values, inputs.caps)?;
        let emissive = inputs.emissive_lights();
        // What lights reach in one frame of an animation, they reach in all of them.
        let vpl_clamp_m = inputs.values.length("vpl-clamp", inputs.scene.lasting_bounds().diagonal());
        if choices.vpl_shadow == VplShadow::Map {
            let room_bytes = plan::room_bytes(&choices, inputs, &blended)?;
            choices.vpl_maps = Some(VplMaps::new(inputs.values, inputs.scene, &inputs.caps.limits, room_bytes)?);
        }
        Ok(Box::new(PreparedInterleaved { choices, direct_lights, blended, emissive, vpl_clamp_m }))
    }
}

struct PreparedInterleaved {
    choices: Choices,
    /// The scene's own lights that a frame has.
    direct_lights: Vec<LightBlock>,
    /// The lists of what blends.
    blended: ObjectLists,
    /// Light walks start on emissive surfaces too.
    emissive: bool,
    /// Least distance at which a virtual point light is evaluated.
    vpl_clamp_m: f32,
}

impl Prepared for PreparedInterleaved {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs, &self.blended)
    }

    fn stages_left_out(&self, inputs: &Inputs<'_>) -> Vec<(&'static str, String)> {
        aov::left_out(&self.choices, inputs.values)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let mut resolved = self.choices.resolved();
        resolved.insert("emissive", if self.emissive { "on" } else { "off" }.to_owned());
        resolved.insert("vpl-clamp", format!("{}", self.vpl_clamp_m));
        resolved
    }

    fn host_part(self: Box<Self>, inputs: &Inputs<'_>) -> Result<HostPart> {
        let Self { choices, direct_lights, blended, emissive, vpl_clamp_m } = *self;
        let walk = vpl::Walk {
            count: choices.vpl_count,
            bounces: inputs.values.integer("vpl-bounces") as u32,
            emissive,
            starts: true,
            medium: None,
            seed: inputs.values.integer("seed") as u32,
        };
        let bvh = inputs.bvh.over(inputs.scene)?;
        let started = Instant::now();
        let found = vpl::walk(inputs.scene, bvh, &inputs.lights.lights, &walk);
        let walk_ns = started.elapsed().as_nanos() as u64;
        let joined: &[LightBlock] = if choices.direct_interleaved { &direct_lights } else { &[] };
        // The order depends on the pattern: dealt for the whole, then cut.
        let subsets = SubsetLights {
            subsets: choices.subsets(),
            lights: subsets::dealt(joined, &inputs.scene.bounds(), choices.direct_subset_count()),
            vpls: found.vpls,
        };
        let mean = |count: usize, subset_count: u32| count as f64 / f64::from(subset_count);
        let vpls = mean(subsets.vpls.len(), choices.subset_count());
        let joined = mean(subsets.lights.len(), choices.direct_subset_count());
        let mut counters = BTreeMap::from([
            ("lights", direct_lights.len() as f64),
            ("vpls", subsets.vpls.len() as f64),
            ("vpls_found", f64::from(found.found_count)),
            ("light_walks", f64::from(found.walk_count)),
            ("shaded_pixels", choices.shaded_pixel_count() as f64),
            ("subset_lights_per_pixel", vpls + joined),
            ("vpls_per_pixel", vpls),
        ]);
        counters.extend(blend::counters(&blended));
        // Those of many runs come with each.
        let passes = if choices.run_count > 1 { Vec::new() } else { vec![(format!("{NAME}.vpls"), walk_ns)] };
        let runs = (choices.run_count > 1).then(|| ManyRuns {
            count: choices.run_count,
            until_error: choices.until_error,
            walk,
            course: RefCell::default(),
            found_count: Cell::default(),
        });
        Ok(HostPart {
            passes,
            counters,
            light_counts: [direct_lights.len() as u32, subsets.vpls.len() as u32],
            build: Box::new(move |gpu, inputs, scene, resources| {
                let lights = FrameLights { subsets: &subsets, direct: &direct_lights, blended: &blended, vpl_clamp_m };
                Ok(Box::new(InterleavedFrame::new(gpu, inputs, scene, resources, &choices, &lights, runs)?))
            }),
        })
    }
}

impl Frame for InterleavedFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        // Each pass is handed the G-buffer as the one before it left it.
        let gbuffer = self.record_opening(cmd, scene, frame)?;
        let (gbuffer, irradiance) = self.record_irradiance(cmd, scene, (frame, true), gbuffer)?;
        let written = Access::ComputeWrite;
        let Some(accumulate) = &self.accumulate else {
            let gbuffer = self.record_solid(cmd, frame, (gbuffer, written), irradiance)?;
            return self.record_blend(cmd, scene, frame, gbuffer, self.color.from(written));
        };
        let (gbuffer, irradiance) = self.record_run(cmd, scene, frame, (accumulate, 0), (gbuffer, irradiance))?;
        let one = (Runs::All, 1);
        let mean = accumulate.record_mean(cmd, one, written, irradiance)?;
        self.record_solid(cmd, frame, (gbuffer, written), mean)?;
        accumulate.record_over(cmd, one, written, self.color.from(written))
    }

    fn run_count(&self) -> u32 {
        self.runs.as_ref().map_or(1, |runs| runs.count)
    }

    fn in_parts(&self) -> Option<InParts> {
        self.runs.as_ref().map(|runs| InParts { until_error: runs.until_error })
    }

    fn begin_run(&self, run: &Run<'_>) -> Result<Vec<(String, u64)>> {
        let begin = |runs: &ManyRuns| runs.begin(run, &self.shade.vpls, self.hidden.as_ref());
        self.runs.as_ref().map_or(Ok(Vec::new()), begin)
    }

    fn record_part(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer, part: Part) -> Result<()> {
        let accumulate = self.accumulate.as_ref().expect("parts are of many runs, which are summed up");
        match part {
            Part::Samples { run } => {
                let is_first = run == 0;
                let gbuffer = if is_first { self.record_opening(cmd, scene, frame)? } else { self.gbuffer.drawn() };
                let irradiance = self.record_irradiance(cmd, scene, (frame, is_first), gbuffer)?;
                self.record_run(cmd, scene, frame, (accumulate, run), irradiance)?;
                Ok(())
            }
            Part::Picture { of, run_count } => {
                let irradiance = self.split_passes.irradiance().from(Access::ComputeRead);
                let (runs, read) = ((of, run_count), Access::ComputeRead);
                let mean = accumulate.record_mean(cmd, runs, read, irradiance)?;
                self.record_solid(cmd, frame, (self.gbuffer.drawn(), read), mean)?;
                accumulate.record_over(cmd, runs, read, self.color.from(Access::ComputeWrite))
            }
        }
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        let of_maps = self.hidden.iter().flat_map(FindHidden::counters);
        self.gbuffer_pass.counters().into_iter().chain(of_maps).collect()
    }

    fn picture(&self) -> (&Image, Access) {
        (
            &self.color,
            if self.blend.is_some() && self.runs.is_none() { Access::ColorWrite } else { Access::ComputeWrite },
        )
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        let mut counters = self.runs.as_ref().map(ManyRuns::counters).unwrap_or_default();
        if self.is_lit_fully {
            counters.extend(self.direct.counters(gpu, self.color.description.extent)?);
        }
        Ok(counters)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        aov::read(self, gpu, name)
    }
}

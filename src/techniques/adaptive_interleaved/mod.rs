//! Dubla, Debattista and Chalmers 2009: Adaptive Interleaved Sampling for Interactive High-Fidelity Rendering.
//!
//! Light is estimated component by component: indirect diffuse light from virtual point lights (`id`), soft shadows of
//! area lights (`ss`), light that a medium scatters once (`pm`), and, not the paper's, ambient light that no surface
//! stops (`ao`). A tile of N x M pixels shares a component's samples, each pixel with its own; after an initial
//! pass the tile decides, by what its own rays met, how many further iterations all of its pixels need, each with
//! samples that the pixel has not used. A box of the tile's size that stops at discontinuities smooths each component,
//! and albedo comes last.
//!
//! Passes, in order: samples of each component (on the host); gbuffer; of each component sample, guide, spread (where
//! `--guidance-of` is not `tile`), compact and refine (with `--refine fused` sample does all of it, with `--mode igi` there
//! is no other; with `--trace host` the host has hit and of each component sample in their place, and the device upload);
//! discontinuity; of each component filter, and upsample where it is estimated at fewer pixels than the frame has;
//! composite; blend (where the scene has BLEND surfaces). With `--guidance-of components` the guidance of all components
//! comes before the refinement of any.
//!
//! Differs from the paper
//! - a device draws what pixels see and casts the shadow rays, where the paper had eight processor cores: `--trace host`
//!   is theirs, with single rays
//! - a tile's further iterations are rounded down, and with the initial pass no more than the most (Listing 1 leaves
//!   both open)
//! - of virtual lights those count as hidden, of all that could light the point, that something hides (Listing 2); a
//!   surface that turns away from an area light hides it itself (Listing 3)
//! - of several lights each guides by itself: by the part that is hidden of those that some pixels of a tile meet and
//!   others do not. Listing 3 takes the mean over all lights, by which every tile in the shadow of one of two is in a
//!   penumbra (`--ss-guidance mean`); under one light both are the same
//! - punctual lights, which the paper does not have, belong to `ss`: their shadows are hard, or soft by `--light-radius`,
//!   and guide as others do where their range reaches
//! - threads that lie together have one slot of neighbouring tiles, not one tile (`--ray-order`)
//! - what the box filter averages is reached without crossing a discontinuity, found as in Segovia 2006, section 4.5
//! - upsampling is guided by normals and by distances from the pixel's plane, where the paper has depths (section 4.1):
//!   a floor that is seen at a slant stays one surface
//! - a march through the medium looks at the middle of its stretches, and of their parts at the middle one first: at
//!   their starts, as section 3.4 has it, the light nearest the eye counts twice and the farthest never
//! - Listing 4's line 13 is read as `missed > 0`; a place is in a halo where any light is near, and hidden from those
//!   that shine elsewhere; the first pixel of a tile is compared with none
//! - light on its way to surfaces, from them and along light walks is dimmed by the medium
//! - BLEND surfaces are drawn over the picture: punctual lights cast shadows on them, virtual ones none, area lights do
//!   not light them, and the medium dims them not
//!
//! Equal to others: `--mode adaptive` where every tile refines to the most is `--mode max`; `--refine fused` and
//! `indirect` are the same bits, as are both of `--ray-order`, and `--trace host` and `device` within the rounding of
//! floats; with `--id-max` of all the tile's pixels `--mode max` lights every texel of `id` by every virtual light, so that
//! the box has nothing to smooth.

mod aov;
mod bench_stages;
mod buffers;
mod choices;
mod compact;
mod components;
mod composite;
mod counters;
mod frame;
mod fused;
mod guide;
mod host;
mod plan;
mod refine;
mod resources;
mod sample;
mod sampler;
pub mod settings;
mod smooth;
mod spread;
mod steps;

use super::bench_stage::BenchStage;
use super::notes::Figures;
use super::{Frame, HostPart, Inputs, NamedPattern, Prepared, Run, Technique, Tuned};
use crate::caps::{Caps, Need};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::LightSet;
use crate::passes::{blend, direct, gbuffer, workgroup};
use crate::picture::Aov;
use crate::plan::Plan;
use crate::resident::SceneGpu;
use crate::sampling::pairs;
use crate::sampling::pattern::Pattern;
use crate::settings::{LIGHT_LISTS, Setting, Values, WORKGROUP};
use crate::shading::medium::Medium;
use buffers::Shared;
use choices::Choices;
use frame::AdaptiveFrame;
use resources::{NAME, of_component};
use settings::{Component, Trace};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;
use steps::ComponentSteps;

pub struct AdaptiveInterleaved;

/// The pattern of its pixels, and that of their numbers.
const PATTERNS: &[NamedPattern] = &[
    NamedPattern {
        name: "tile",
        summary: "The tile: each of its pixels has samples of its own in every iteration",
        keys: &["tile"],
        make: |values| Ok(Pattern::grid(values.pair("tile"))),
    },
    NamedPattern {
        name: "points",
        summary: "Two numbers for each pixel of a tile in each iteration, which become points of lights and directions",
        keys: &["tile", "ss-max", "sampler", "seed"],
        make: |values| {
            let (most, seed) = (values.integer("ss-max") as u32, values.integer("seed") as u32);
            Ok(pairs::of_tile(values.choice("sampler"), values.pair("tile"), most, seed))
        },
    },
];

impl Technique for AdaptiveInterleaved {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "Dubla 2009: interleaved sampling of soft shadows and indirect light, refined where tiles need it"
    }

    fn scene(&self) -> &'static str {
        "cornell"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, LIGHT_LISTS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        aov::AOVS
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("components", "ss"), ("refine", "fused")]
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        [gbuffer::need()].into_iter().chain(blend::needs(has_blend)).chain(direct::depth_rays(values)).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Diffuse light of the components that are there: straight, by as many surfaces as light walks land on, or both, and
    /// what a medium scatters once.
    fn reference_settings(&self, values: &Values, _: &LightSet) -> Result<Vec<(&'static str, String)>> {
        let listed = settings::listed(values);
        let has = |component| match &listed {
            Some(listed) => listed.contains(&component),
            None => component != Component::Ao,
        };
        let [has_id, has_ss, has_pm, has_ao] = [Component::Id, Component::Ss, Component::Pm, Component::Ao].map(has);
        let on_or_off = |is_on: bool| if is_on { "on" } else { "off" }.to_owned();
        let mut settings = vec![
            ("brdf", "lambert".to_owned()),
            ("ambient-visibility", if has_ao { "seen" } else { "off" }.to_owned()),
            ("direct-light", on_or_off(has_ss)),
        ];
        if Medium::asked(values).flatten().is_some() {
            settings.push(("airlight", if has_pm { "seen" } else { "none" }.to_owned()));
        }
        match values.integer("vpl-bounces") {
            _ if !has_id => settings.push(("transport", "direct".to_owned())),
            1 => settings.push(("transport", "one-bounce".to_owned())),
            // The surface that is seen scatters too.
            more => settings.extend([("transport", "full".to_owned()), ("bounces", (more + 1).to_string())]),
        }
        Ok(settings)
    }

    fn tuned(&self) -> Tuned {
        &[
            ("refine", &["indirect", "fused"]),
            ("ray-order", &["slot", "tile"]),
            ("geometry", &["culled", "all"]),
            ("texels", &["auto", "1", "4", "16"]),
            ("workgroup", &["auto", "8x8", "16x16", "64x1", "256x1"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        let Some(rays) = figures.counter("rays") else { return Vec::new() };
        let refined = Component::WORDS.iter().filter_map(|key| {
            let [iterations, tiles] =
                ["iterations", "tiles_refined"].map(|what| figures.counter(&format!("{what}_{key}")));
            Some(format!(
                "{key}: {:.2} iterations in the mean, {:.1} % of the tiles refined",
                iterations?,
                100.0 * tiles?
            ))
        });
        [format!("{rays:.2} shadow rays a pixel")].into_iter().chain(refined).collect()
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        PATTERNS
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        Ok(Box::new(PreparedAdaptive { choices: Choices::new(inputs)? }))
    }
}

struct PreparedAdaptive {
    choices: Choices,
}

impl Prepared for PreparedAdaptive {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs)
    }

    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        aov::left_out(&self.choices)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let emissive = if self.choices.is_emissive { "on" } else { "off" };
        let mut resolved =
            BTreeMap::from([("emissive", emissive.to_owned()), ("vpl-clamp", format!("{}", self.choices.vpl_clamp_m))]);
        resolved.insert("medium", Medium::text(self.choices.medium));
        resolved.insert(WORKGROUP.key, workgroup::text(self.choices.workgroup));
        let listed: Vec<&str> = self.choices.components.iter().map(|choice| choice.component.name()).collect();
        resolved.insert("components", listed.join(","));
        let id = self.choices.components.iter().find(|choice| choice.component == Component::Id);
        resolved.extend(id.map(|id| ("id-scale", id.params.scale.to_string())));
        resolved
    }

    fn host_part(self: Box<Self>, inputs: &Inputs<'_>) -> Result<HostPart> {
        let choices = self.choices;
        if choices.trace == Trace::Host {
            // Its building is in no frame's time.
            inputs.bvh.over(inputs.scene)?;
        }
        let (mut passes, mut samples) = (Vec::new(), Vec::new());
        for choice in &choices.components {
            let started = Instant::now();
            samples.push(choice.prepared.samples(inputs)?);
            passes.push((of_component("samples", choice.component.name()), started.elapsed().as_nanos() as u64));
        }
        let own = samples.iter().flat_map(|samples| samples.counters.iter().copied());
        let counters = own.chain(blend::counters(&choices.blended)).collect();
        let of_id = choices.components.iter().find(|choice| choice.component == Component::Id);
        let light_counts = [choices.lights.len() as u32, of_id.map_or(0, |id| id.params.source_count)];
        Ok(HostPart {
            passes,
            counters,
            light_counts,
            build: Box::new(move |gpu, inputs, scene, resources| {
                Ok(Box::new(AdaptiveFrame::new(gpu, inputs, scene, resources, &choices, &samples)?))
            }),
        })
    }
}

impl Frame for AdaptiveFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        self.gbuffer_pass.record(cmd, NAME, frame, scene, &self.gbuffer)?;
        let mut gbuffer = self.gbuffer.from(Access::ColorWrite);
        let shared = Shared { frame, direct: &self.direct };
        for together in self.components.chunks(self.recorded_together) {
            for component in together {
                gbuffer = component.record_initial(cmd, &shared, gbuffer)?;
            }
            for (index, component) in together.iter().enumerate() {
                let others = together.iter().filter(|other| !std::ptr::eq(*other, component));
                let guided = [component].into_iter().chain(others).filter_map(ComponentSteps::own_guidance);
                let written = guided.map(|own| own.from(Access::ComputeWrite));
                // The refinement of the first has read what all of them ask for.
                let own_guidance: Vec<_> =
                    written.map(|own| if index == 0 { own } else { own.after(Access::ComputeRead) }).collect();
                gbuffer = component.record_refinement(cmd, &shared, gbuffer, &own_guidance)?;
            }
        }
        let irradiance = self.components.iter().map(|steps| steps.buffers.irradiance.from(steps.last_write()));
        let (gbuffer, irradiance) = self.smoothing.record(cmd, frame, gbuffer, irradiance)?;
        let gbuffer = self.composite.record(cmd, frame, gbuffer, irradiance, &self.color)?;
        self.record_blend(cmd, scene, frame, gbuffer)
    }

    fn begin_run(&self, run: &Run<'_>) -> Result<Vec<(String, u64)>> {
        self.host.as_ref().map_or(Ok(Vec::new()), |host| host.run(run, &self.components))
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.gbuffer_pass.counters().into()
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.color, if self.blended.is_some() { Access::ColorWrite } else { Access::ComputeWrite })
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        counters::read(self, gpu)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        aov::read(self, gpu, name)
    }
}

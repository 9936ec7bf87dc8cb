//! Forward shading with a depth pre-pass and a list of lights for each object: what Kircher and Lawrance 2009, section 5,
//! call an optimized forward renderer and beat with inferred lighting. Direct light only.
//!
//! Passes: lights (on the host: the lists), shadow_maps (with `--direct-shadow map`), depth, material, blend (where the scene has BLEND surfaces), resolve (with
//! `--msaa` above 1), accumulate (with `--supersample` above 1).
//!
//! Differs from the paper, which says of its forward renderer no more than that it is one
//! - lists are by the box around an object and the light's range; the floor of a hall is one object, under all its lights
//! - the samples of MSAA are floats of linear light, of 32 bits (`--sample-format half`: 16), averaged before any tone mapping
//! - shadow maps (`--direct-shadow map`) are Clarberg and Munkberg's (2014, section 6); each run of `--supersample` draws
//!   them again, as every frame does
//! - holes of MASK surfaces are cut where they are shaded: once a pixel, with edges as jagged as without MSAA, or with
//!   `--sample-shading on` once a sample
//!
//! Equal to others: with `--msaa 1` it is `deferred` except for what that one's G-buffer rounds. `--light-lists none`,
//! `--light-buffer storage` and, with one sample, `--depth-prepass off` are the plain ways to its own bits (with more a
//! driver may choose the place in a pixel that is shaded among the samples that pass the depth test). `--supersample` is the reference of edges: the same picture
//! from N x N places in each pixel, every one of them shaded.
//!
//! Why this way: a list is found by the draw's push constants. An index of the object in the fragment shader would be one
//! more thing to interpolate for every technique that shares the vertex stage.

mod bench_stages;
mod choices;
mod plan;
mod resources;
mod settings;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::{Frame, HostPart, Inputs, Prepared, Technique, Tuned, straight_light};
use crate::caps::{Caps, Need};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image, readback};
use crate::lights::LightSet;
use crate::passes::accumulate::Accumulate;
use crate::passes::depth_prepass::DepthBegins;
use crate::passes::forward::{self, ForwardScene, ListedLights, Targets};
use crate::passes::resolve::Resolve;
use crate::passes::samples;
use crate::picture::{Aov, AovChannels};
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::settings::{FORWARD, LIGHT_LISTS, MULTISAMPLE, SHADOW_MAPS, Setting, Values};
use crate::techniques::forward::choices::Choices;
use crate::techniques::forward::resources::NAME;
use glam::Vec2;
use std::collections::BTreeMap;
use std::sync::Arc;

const DEPTH_STAGE: &str = "depth.reversed";

pub struct Forward;

impl Technique for Forward {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "forward shading with a depth pre-pass and a list of lights for each object"
    }

    fn scene(&self) -> &'static str {
        "lamps"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, FORWARD, LIGHT_LISTS, SHADOW_MAPS, MULTISAMPLE]
    }

    fn aovs(&self) -> &'static [&'static str] {
        &[DEPTH_STAGE]
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        forward::SHORTER
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        forward::needs(values, has_blend).chain(samples::needs(values)).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        straight_light(values, lights, 0)
    }

    fn tuned(&self) -> Tuned {
        &[
            ("depth-prepass", &["on", "off"]),
            ("geometry", &["culled", "all"]),
            ("light-lists", &["object", "none"]),
            ("light-buffer", &["uniform", "storage"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        Vec::from_iter(notes::direct_light(figures, None))
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let choices = Choices::new(inputs)?;
        let listed = choices.drawing.listed(inputs.values, inputs.scene, inputs.lights, inputs.caps)?;
        Ok(Box::new(PreparedForward { choices, listed }))
    }
}

struct PreparedForward {
    choices: Choices,
    listed: ListedLights,
}

impl Prepared for PreparedForward {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs, &self.listed)
    }

    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        let samples = self.choices.drawing.samples.count;
        let why = format!("with --msaa {samples} a pixel has several depths; --msaa 1 makes it");
        Vec::from_iter((samples > 1).then_some((DEPTH_STAGE, why)))
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        self.choices.drawing.resolved()
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        Ok(HostPart {
            passes: vec![self.listed.pass(NAME)],
            counters: self.listed.counters(),
            light_counts: [self.listed.lights.len() as u32, 0],
            build: Box::new(move |gpu, inputs, scene, resources| self.build(gpu, inputs, scene, resources)),
        })
    }
}

impl PreparedForward {
    /// The frame on the device.
    fn build(
        self,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let Self { choices, listed } = self;
        let Choices { drawing, runs_per_side } = &choices;
        let list = inputs.draw_list(scene, choices.coverage());
        let of = ForwardScene {
            scene: inputs.scene,
            view: inputs.view,
            bvh: inputs.bvh,
            listed: &listed,
            list,
            background: inputs.values.color("background"),
            pixels_per_texel: [1.0; 2],
        };
        Ok(Box::new(ForwardFrame {
            drawing: forward::Forward::new(gpu, resources, NAME, drawing, of, scene)?,
            accumulate: if *runs_per_side > 1 { Some(Accumulate::new(gpu, NAME, resources)?) } else { None },
            targets: Targets {
                depth: resources.image(resources::DEPTH),
                begins: DepthBegins::Far,
                drawn: resources.image(resources::DRAWN),
            },
            resolve: if drawing.samples.are_many() {
                Some(Resolve::new(gpu, drawing.samples, resources.image(resources::RESOLVED))?)
            } else {
                None
            },
            shaded_count: drawing.samples.shaded_count(),
            runs_per_side: *runs_per_side,
        }))
    }
}

struct ForwardFrame {
    drawing: forward::Forward,
    accumulate: Option<Accumulate>,
    targets: Targets,
    /// Where pixels have several samples.
    resolve: Option<Resolve>,
    /// How often a run shades a pixel.
    shaded_count: u32,
    runs_per_side: u32,
}

impl Frame for ForwardFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        self.drawing.record(cmd, NAME, frame, scene, &self.targets)?;
        if let Some(resolve) = &self.resolve {
            resolve.record(cmd, NAME, self.targets.drawn.from(Access::ColorWrite))?;
        }
        if let Some(accumulate) = &self.accumulate {
            let (run, last) = self.run_picture();
            accumulate.record(cmd, NAME, frame, run.from(last))?;
        }
        Ok(())
    }

    fn run_count(&self) -> u32 {
        self.runs_per_side * self.runs_per_side
    }

    /// The middles of `runs_per_side` x `runs_per_side` equal parts of a pixel, in row order.
    fn block_of(&self, run: u32, block: FrameBlock, view: &View) -> FrameBlock {
        let place = |index: u32| (index as f32 + 0.5) / self.runs_per_side as f32 - 0.5;
        view.moved(block, Vec2::new(place(run % self.runs_per_side), place(run / self.runs_per_side)))
    }

    fn once(&self) -> Vec<(String, u64)> {
        self.drawing.once()
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.drawing.drawn()
    }

    fn picture(&self) -> (&Image, Access) {
        match &self.accumulate {
            Some(accumulate) => (&accumulate.color, Access::ComputeWrite),
            None => self.run_picture(),
        }
    }

    /// Lights that were evaluated for the solid surfaces that are seen: pixels of several samples count with the mean, and as
    /// often as they are shaded.
    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        let (picture, last) = self.picture();
        let pixels = picture.description.extent.pixel_count() as f64;
        let texels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&readback::image(gpu, picture, last)?);
        let runs = f64::from(self.shaded_count);
        let evaluated = runs * texels.iter().map(|[.., lights]| f64::from(*lights)).sum::<f64>();
        let every = runs * pixels * f64::from(self.drawing.light_count());
        Ok(BTreeMap::from([
            ("light_evaluations", evaluated),
            ("light_evaluations_culled", every - evaluated),
            ("lights_per_pixel", evaluated / pixels),
        ]))
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        let depth = &self.targets.depth;
        let last = self.drawing.depth_access();
        let depths = bytemuck::pod_collect_to_vec(&readback::image(gpu, depth, last)?);
        Ok(Aov { name: name.to_owned(), channels: AovChannels::Y(depths) })
    }
}

impl ForwardFrame {
    /// The plain picture of a run, and how it is last touched.
    fn run_picture(&self) -> (&Image, Access) {
        match &self.resolve {
            Some(resolve) => (&resolve.color, Access::ComputeWrite),
            None => (&self.targets.drawn, Access::ColorWrite),
        }
    }
}

//! Keller and Heidrich 2001, Interleaved Sampling (Rendering Techniques 2001, Proceedings of the 12th Eurographics Workshop
//! on Rendering, pages 269-276).
//!
//! A basis pattern of irregular samples repeats over the frame (section 2.1). Copies of one sample are a regular grid, a
//! *member*, which is rasterised as a small picture of its own; a pixel is the mean of the samples that lie in it. With a
//! basis of one pixel that is the accumulation buffer, whose samples are the same in every pixel; with a basis as large as
//! the frame no two pixels have the same; `--basis` is the way from one to the other.
//!
//! A run is a member, or several (`--members sample-locations`): moment (on the host, where members differ in more than their place),
//! mask (where members are drawn over the whole frame),
//! shadow_maps (with `--direct-shadow map`), depth, material, blend (where the scene has BLEND surfaces), slices (with `--effect volume`), combine, mean.
//!
//! Differences from the paper
//! - a member's samples are scattered to their pixels by a compute pass, unless `--members stipple` asks for the polygon over
//!   the frame behind a mask (section 3.1), which is a pattern in a shader; the result is the same
//! - textures are read at the level of the frame's pixels, not of a member's, whose samples lie farther apart
//! - a pixel without a sample shows the nearest one that has some
//! - what moves does so along straight lines from where it is when the shutter opens (section 3.2 leaves it to the application)
//! - a volume shines and absorbs, as in section 3.3, but casts no shadow on surfaces and is not lit by lights
//!
//! Equal to others: with `--basis 1x1 --samples 1` it is `forward`. `forward --supersample N` is the accumulation buffer of a
//! regular pattern, `path_traced` what all of them converge to.
//!
//! Why this way: a member differs from another in what buffers hold (where its picture lies in the frame, where on the lens it is
//! seen from, at which moment, under which places of its lights), so one recorded run serves all of them, and memory is that of
//! one.

mod aov;
mod bench_stages;
mod choices;
mod combine;
mod mask;
mod mean;
mod members;
mod moment;
mod over;
mod plan;
mod resources;
mod settings;
mod slices;
mod soft;
mod table;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::{Frame, HostPart, Inputs, NamedPattern, Prepared, Run, Technique, Tuned, emissive_lights, straight_light};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::LightSet;
use crate::passes::depth_prepass::DepthBegins;
use crate::passes::forward::{self, Forward, ForwardScene, ListedLights, Targets};
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::{Coverage, DrawList, Raster, SceneGpu, Sweep};
use crate::settings::{FORWARD, GeometryChoice, LIGHT_LISTS, SHADOW_MAPS, Setting, VOLUME_PLACE, Values};
use choices::{Choices, Effect};
use combine::Combine;
use mask::Mask;
use mean::Mean;
use members::Drawing;
use moment::Moment;
use resources::NAME;
use slices::Slices;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::Arc;
use table::Table;

pub struct InterleavedSampling;

impl Technique for InterleavedSampling {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "pictures of regular grids, interleaved: from the accumulation buffer to samples that never repeat"
    }

    fn scene(&self) -> &'static str {
        "fence"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, VOLUME_PLACE, FORWARD, LIGHT_LISTS, SHADOW_MAPS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        aov::ALL
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        forward::SHORTER
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        let volume = Effect::Volume.is_chosen(values).then(|| Need {
            of: "--effect volume".to_owned(),
            ability: Ability::BlendFloats,
            instead: "the other effects work without",
        });
        let are_placed = values.is("members", Drawing::SampleLocations);
        let placed =
            [Ability::SampleLocations, Ability::SampleShading].into_iter().filter(|_| are_placed).map(|ability| {
                let instead =
                    "--members layers, stipple and tuples draw the same samples everywhere, with --places sixteenths";
                Need { of: "--members sample-locations".to_owned(), ability, instead }
            });
        forward::needs(values, has_blend).chain(volume).chain(placed).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        let mut settings = straight_light(values, lights, 0)?;
        // As members read them: with the finest, errors would end at what levels of the frame's pixels blur.
        settings.push(("texture-level", "cone".to_owned()));
        if Effect::SoftShadow.is_chosen(values) {
            let is_lit = emissive_lights(values, lights);
            settings.retain(|(key, _)| !["emissive", "light-visibility"].contains(key));
            settings.push(("emissive", if is_lit { "on" } else { "off" }.to_owned()));
            settings.push(("light-visibility", "on".to_owned()));
        }
        if !Effect::Aa.is_chosen(values) {
            settings.push(("pixel", "middle".to_owned()));
        }
        Ok(settings)
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
        let is_hard = figures.counter("soft_lights") == Some(0.0);
        let hard = is_hard.then(|| {
            "  note: every light is a point or far away: --light-radius 0.1 makes spheres of lamps".to_owned()
        });
        notes::direct_light(figures, None).into_iter().chain(hard).collect()
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        choices::PATTERNS
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let choices = Choices::new(inputs)?;
        let listed = choices.drawing.listed(inputs.values, inputs.scene, choices.light_set(inputs), inputs.caps)?;
        Ok(Box::new(PreparedInterleaved { choices, listed }))
    }
}

struct PreparedInterleaved {
    choices: Choices,
    listed: ListedLights,
}

impl Prepared for PreparedInterleaved {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs, &self.listed)
    }

    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        let are_placed = self.choices.drawing.samples.are_placed;
        let why =
            "with --members sample-locations several members are drawn at once; --members tuples draws each alone";
        Vec::from_iter(are_placed.then(|| (aov::MEMBER, why.to_owned())))
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let lens = self.choices.lens.map(|lens| ("focus", lens.focus.to_string()));
        let places = ("places", self.choices.places().name().to_owned());
        self.choices.drawing.resolved().into_iter().chain(lens).chain([places]).collect()
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        let members = &self.choices.members;
        let [least, most] = members.basis().pattern().samples_per_pixel();
        let mut counters = self.listed.counters();
        counters.extend([
            ("members", f64::from(members.count())),
            ("samples_per_member", members.grid().pixel_count() as f64),
            ("samples_per_pixel_least", f64::from(least)),
            ("samples_per_pixel_most", f64::from(most)),
        ]);
        counters.extend(self.choices.soft.as_ref().map(|soft| ("soft_lights", soft.count as f64)));
        let slices = self.choices.slices.as_ref();
        counters.extend(slices.map(|slices| ("volume_voxels", slices.voxel_count())));
        Ok(HostPart {
            passes: vec![self.listed.pass(NAME)],
            counters,
            light_counts: [self.listed.lights.len() as u32, 0],
            build: Box::new(move |gpu, inputs, scene, resources| self.build(gpu, inputs, scene, resources)),
        })
    }
}

impl PreparedInterleaved {
    /// The frame on the device.
    fn build(
        self,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let Self { choices, listed } = self;
        let raster = Raster { extent: choices.members.picture(), coverage: Coverage::Anywhere };
        // What one place of the lens, or one moment, does not see another may.
        let is_other = choices.lens.is_some() || choices.exposure.is_some();
        let geometry = if is_other { GeometryChoice::All } else { inputs.values.choice("geometry") };
        let list = DrawList::new(inputs.scene, scene, inputs.view, raster, geometry, Sweep::default());
        let of = ForwardScene {
            scene: inputs.scene,
            view: inputs.view,
            bvh: inputs.bvh,
            listed: &listed,
            list,
            background: inputs.values.color("background"),
            pixels_per_texel: choices.members.spacing_px().map(|spacing| spacing as f32),
        };
        let slices = choices.slices.as_ref();
        let is_masked = choices.members.drawing().is_over_frame();
        Ok(Box::new(InterleavedFrame {
            drawing: Forward::new(gpu, resources, NAME, &choices.drawing, of, scene)?,
            targets: Targets {
                depth: resources.image(resources::DEPTH),
                begins: if is_masked { DepthBegins::Written } else { DepthBegins::Far },
                drawn: resources.image(resources::DRAWN),
            },
            table: Table::new(gpu, resources, &choices.members)?,
            mask: is_masked.then(|| Mask::new(gpu, choices.drawing.samples)).transpose()?,
            combine: Combine::new(gpu, resources, &choices.members, inputs.view.extent)?,
            mean: Mean::new(gpu, resources, &choices.members)?,
            moment: Moment::new(gpu, inputs, scene, resources, &choices),
            slices: slices.map(|slices| Slices::new(gpu, resources, slices, &choices.members)).transpose()?,
            run: Cell::new(0),
            choices,
        }))
    }
}

struct InterleavedFrame {
    drawing: Forward,
    targets: Targets,
    table: Table,
    /// Where members are drawn over the whole frame.
    mask: Option<Mask>,
    combine: Combine,
    mean: Mean,
    /// What members see where it is not the same for all.
    moment: Option<Moment>,
    slices: Option<Slices>,
    /// The one that is drawn, which a recording of placed samples is of.
    run: Cell<u32>,
    choices: Choices,
}

impl Frame for InterleavedFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let scene = self.moment.as_ref().and_then(Moment::scene).unwrap_or(scene);
        if self.records_each_run() {
            cmd.place_samples(self.choices.members.places_px(self.run.get()));
        }
        if let Some(mask) = &self.mask {
            mask.record(cmd, frame, &self.table, &self.targets.depth)?;
        }
        self.drawing.record(cmd, NAME, frame, scene, &self.targets)?;
        if let Some(slices) = &self.slices {
            let Targets { depth, drawn, .. } = &self.targets;
            slices.record(cmd, frame, depth.from(self.drawing.depth_access()), drawn.from(Access::ColorWrite))?;
        }
        self.combine.record(cmd, frame, &self.table, self.targets.drawn.from(Access::ColorWrite))?;
        self.mean.record(cmd, frame, self.combine.sums())
    }

    fn once(&self) -> Vec<(String, u64)> {
        self.drawing.once()
    }

    fn run_count(&self) -> u32 {
        self.choices.members.run_count()
    }

    /// Where samples lie is a command's to say.
    fn records_each_run(&self) -> bool {
        self.choices.drawing.samples.are_placed
    }

    /// Pixels without a sample of the first members have none to show.
    fn has_early_pictures(&self) -> bool {
        false
    }

    fn begin_run(&self, run: &Run<'_>) -> Result<Vec<(String, u64)>> {
        self.run.set(run.index);
        let begun = self.moment.as_ref().map(|moment| moment.begin(run, &self.choices, &self.drawing));
        Ok(begun.transpose()?.into_iter().collect())
    }

    /// As the member's place on the lens sees it at its moment, its samples in the middles of its picture's texels.
    fn block_of(&self, run: u32, block: FrameBlock, view: &View) -> FrameBlock {
        let (lens, placement) = self.choices.sight(run);
        let Some(exposure) = &self.choices.exposure else { return view.seen_from(block, lens, placement) };
        let part = self.choices.part(run);
        let (view, ambient) = (exposure.view_at(part), exposure.lights_at(part).ambient);
        let block = FrameBlock { ambient: ambient.extend(0.0).to_array(), ..view.camera_of(block) };
        view.seen_from(block, lens, placement)
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.drawing.drawn()
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.mean.color, Access::ComputeWrite)
    }

    fn counters(&self, _: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        Ok(BTreeMap::new())
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        let members = &self.choices.members;
        match name {
            aov::SAMPLES => aov::samples(gpu, members, self.combine.sums().resource),
            aov::MEMBER => aov::member(gpu, members, &self.targets.drawn),
            _ => unreachable!("{NAME} has no stage {name}"),
        }
    }
}

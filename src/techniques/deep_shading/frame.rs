//! A frame of deep shading on the device: the passes in the order of figure 3, or those of a baseline.

use super::baseline::Baseline;
use super::baseline::texture_space::atlases::Atlases;
use super::buffer_addresses::BufferAddresses;
use super::choices::Choices;
use super::counters::FrameCounts;
use super::indirect;
use super::lists::ListsEdge;
use super::pass_inputs::DrawInputs;
use super::primitives::{self, Primitives};
use super::reconstruct::Reconstruct;
use super::resolve::Resolve;
use super::sample_colors::SampleColors;
use super::scales::Scales;
use super::scene::DeepScene;
use super::separate::SeparateShading;
use super::stages::{REFUSED, Stages};
use super::stereo::{self, RightEye};
use super::visibility::ray::TracedSamples;
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image};
use crate::lens::Lens;
use crate::passes::accumulate::Accumulate;
use crate::picture::Aov;
use crate::plan::Resources;
use crate::resident::{DrawList, LensDisc, SceneGpu, Sweep};
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources::{COLOR, COUNTERS, NAME, ORDER, full};
use crate::techniques::{Frame, Inputs, Run};
use std::collections::BTreeMap;
use std::sync::Arc;

/// From the scene to samples that have colours.
enum ShadingPasses {
    Separate(Box<SeparateShading>, BufferAddresses),
    Baseline(Box<Baseline>),
}

/// What the host has made of the scene.
pub struct HostTables {
    pub primitives: Primitives,
    /// With `--visibility ray`.
    pub traced: Option<TracedSamples>,
    /// With `--shading texture-space`.
    pub atlases: Option<Atlases>,
}

pub struct DeepFrame {
    choices: Choices,
    primitives: Primitives,
    list: DrawList,
    scene: DeepScene,
    scales: Option<Scales>,
    maps_once: Option<(String, u64)>,
    shader: ShadingPasses,
    resolve: Resolve,
    reconstruct: Option<Reconstruct>,
    accumulate: Option<Accumulate>,
    counters: Buffer,
    color: Image,
    right: Option<RightEye>,
    light_count: u64,
}

impl DeepFrame {
    /// Makes the pipelines and takes the planned resources out.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: Choices,
        host: HostTables,
    ) -> Result<Self> {
        let HostTables { mut primitives, traced, atlases } = host;
        let frame = inputs.view.extent;
        let closing = choices.blur.mid_exposure.as_ref().map(|middle| &middle.closing.view);
        let disc = |lens: Lens| LensDisc { aside_m: lens.middle(), radius_m: lens.reach(), focus_m: lens.focus };
        let sweep = Sweep { lens: choices.blur.lens.map(disc), closing: inputs.scene.closing.as_deref().zip(closing) };
        let list = primitives::drawn(inputs.scene, scene, inputs.view, choices.geometry, sweep);
        primitives.set_order(scene, &list);
        let reconstruct = match choices.blur.is_reconstructed {
            true => Some(Reconstruct::new(gpu, resources, &choices)?),
            false => None,
        };
        let shader = match choices.shading {
            Shading::Deep | Shading::IndirectGbuffer => {
                let separate = SeparateShading::new(gpu, scene, resources, &choices, frame, traced, &primitives)?;
                let buffers = separate.buffers().chain(reconstruct.iter().flat_map(Reconstruct::buffers));
                let buffer_addresses = BufferAddresses::new(gpu, resources, choices.is_by_address, buffers)?;
                ShadingPasses::Separate(Box::new(separate), buffer_addresses)
            }
            _ => ShadingPasses::Baseline(Box::new(Baseline::new(gpu, resources, scene, &choices, atlases.as_ref())?)),
        };
        let deep_scene = DeepScene::new(gpu, inputs, resources, &choices, scene)?;
        Ok(Self {
            maps_once: deep_scene.draw_maps_once(gpu, scene)?,
            list,
            scales: Scales::new(gpu, resources, &choices, &primitives)?,
            scene: deep_scene,
            shader,
            resolve: Resolve::new(gpu, &choices)?,
            reconstruct,
            accumulate: if choices.run_count > 1 { Some(Accumulate::new(gpu, NAME, resources)?) } else { None },
            counters: resources.buffer(&full(COUNTERS)),
            color: resources.image(&full(COLOR)),
            light_count: choices.lights(inputs).lights.len() as u64,
            right: RightEye::new(gpu, resources, &choices)?,
            choices,
            primitives,
        })
    }

    fn separate(&self) -> Option<&SeparateShading> {
        match &self.shader {
            ShadingPasses::Separate(separate, _) => Some(separate),
            ShadingPasses::Baseline(_) => None,
        }
    }

    /// Picture of one set of samples.
    fn run_picture(&self) -> &Image {
        self.reconstruct.as_ref().map_or(&self.color, |reconstruct| &reconstruct.color)
    }

    fn counted(&self, gpu: &Arc<Gpu>) -> Result<FrameCounts> {
        FrameCounts::read(gpu, &self.counters, Access::ComputeWrite)
    }
}

impl Frame for DeepFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let Self { list, primitives, counters, color, right, .. } = self;
        let eyes: Vec<&Image> = [color].into_iter().chain(right.iter().map(|right| &right.color)).collect();
        let mut bound = self.scene.bound(frame, scene);
        self.scene.record_maps(cmd, scene)?;
        if let ShadingPasses::Separate(separate, addresses) = &self.shader {
            bound.extend([addresses.bound(), separate.draw_ranges()]);
        }
        if let Some(scales) = &self.scales {
            scales.record(cmd, &bound)?;
        }
        let scales = self.scales.as_ref().map(|scales| scales.scales.from(Access::ComputeWrite));
        // Without scales nothing reads what is bound in their place.
        bound.push(("Scales", Bound::Buffer(scales.map_or(frame, |scales| scales.resource))));
        let (table, extent) = (&self.choices.table, color.description.extent);
        let inputs = DrawInputs { scene, list, primitives, table, frame: extent, scales, bound: &bound };
        match &self.shader {
            ShadingPasses::Separate(separate, _) => {
                let shaded = separate.record(cmd, &self.scene, inputs, counters)?;
                self.resolve.record(cmd, &bound, shaded, counters.from(Access::ComputeWrite), &eyes)?;
                if let Some(reconstruct) = &self.reconstruct {
                    reconstruct.record(cmd, &bound, shaded.read_by_compute(), color.from(Access::ComputeWrite))?;
                }
                let lists =
                    shaded.lists().map(|lists| ListsEdge { links: lists.links.with(Access::ComputeRead), ..lists });
                separate.record_count(cmd, &bound, lists, counters.from(Access::ComputeWrite))?;
            }
            ShadingPasses::Baseline(baseline) => {
                baseline.record(cmd, inputs, self.scene.maps_from(Access::DepthWrite), counters)?;
                let shaded = SampleColors::Baseline(baseline.from(Access::ColorWrite));
                self.resolve.record(cmd, &bound, shaded, counters.from(Access::FragmentWrite), &eyes)?;
            }
        }
        if let Some(accumulate) = &self.accumulate {
            accumulate.record(cmd, NAME, frame, self.run_picture().from(Access::ComputeWrite))?;
        }
        if let Some(right) = right {
            right.record(cmd, frame, right.color.from(Access::ComputeWrite))?;
        }
        Ok(())
    }

    fn begin_run(&self, run: &Run<'_>) -> Result<Vec<(String, u64)>> {
        if let Some(separate) = self.separate() {
            separate.begin_run(run.index);
        }
        Ok(Vec::new())
    }

    fn run_count(&self) -> u32 {
        self.choices.run_count
    }

    fn once(&self) -> Vec<(String, u64)> {
        self.maps_once.iter().cloned().collect()
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        let mut counters: BTreeMap<&'static str, f64> = self.list.counters().into();
        counters.insert("draws", self.list.calls().count() as f64);
        counters
    }

    fn picture(&self) -> (&Image, Access) {
        (self.accumulate.as_ref().map_or(self.run_picture(), |accumulate| &accumulate.color), Access::ComputeWrite)
    }

    fn explained_nan(&self) -> Option<[String; 2]> {
        let conservative = self.choices.raster.conservative.name();
        let (what, help) = match self.choices.shading {
            Shading::Deep if self.choices.is_by_fragment() => (
                format!(
                    "a sample that finds no colour is NaN: --conservative {conservative} did not draw the pixel that it needs"
                ),
                "--conservative vertex works on every device; --conservative none leaves such samples black",
            ),
            Shading::Deep | Shading::IndirectGbuffer => {
                ("a sample that finds no colour is NaN".to_owned(), "--shading ssaa shades each sample by itself")
            }
            Shading::TextureSpace(_) => (
                "a sample whose texels were never shaded is NaN".to_owned(),
                "--shading ssaa shades each sample by itself",
            ),
            Shading::Ssaa | Shading::Msaa { .. } => return None,
        };
        Some([what, help.to_owned()])
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        if !self.choices.is_counted {
            return Ok(BTreeMap::new());
        }
        let pixels = self.color.description.extent.pixel_count();
        let has_tests = self.choices.visibility == Visibility::Stochastic;
        let counted = self.counted(gpu)?;
        let mut counters = counted.report(pixels, has_tests);
        match self.choices.shading {
            Shading::Deep => {
                counters.extend(counted.of_lists());
                if self.choices.is_by_fragment() {
                    counters.extend(counted.of_fragments());
                } else {
                    counters.extend(counted.of_lights(self.light_count));
                }
            }
            Shading::IndirectGbuffer => counters.extend(counted.of_entries()),
            Shading::TextureSpace(_) => counters.extend(counted.of_textures()),
            Shading::Ssaa | Shading::Msaa { .. } => {}
        }
        Ok(counters)
    }

    fn touched_bytes(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<String, u64>> {
        match &self.shader {
            _ if !self.choices.is_counted => Ok(BTreeMap::new()),
            ShadingPasses::Baseline(baseline) => baseline.touched_bytes(gpu, &self.list),
            ShadingPasses::Separate(..) if self.choices.shading == Shading::IndirectGbuffer => {
                Ok(indirect::touched_bytes(&self.counted(gpu)?))
            }
            ShadingPasses::Separate(..) => {
                let mut touched = self.counted(gpu)?.entries(self.choices.space.extent.pixel_count()).bytes();
                if !self.choices.has_lists || self.choices.lists.is_direct {
                    // Without lists all places of colours are written, and what the host inserts is copied whole.
                    touched.retain(|name, _| *name == full(ORDER));
                }
                Ok(touched)
            }
        }
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        if name == stereo::RIGHT {
            return self.right.as_ref().expect(REFUSED).stage(gpu);
        }
        let (choices, separate) = (&self.choices, self.separate().expect(REFUSED));
        Stages { gpu, choices, separate, frame: self.color.description.extent }.read(name)
    }
}

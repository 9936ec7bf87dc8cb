//! A frame of deep shading on the device: the passes in the order of figure 3.

use super::baseline::{Baseline, Shading};
use super::brute::Brute;
use super::choices::Choices;
use super::count::Count;
use super::counters;
use super::lists::address::Address;
use super::lists::compact::Compact;
use super::lists::insert::Insert;
use super::lists::{self, Lists};
use super::plan::{COLOR, COUNTERS, SPIDS};
use super::primitives::{self, Primitives};
use super::resolve::{Resolve, Shaded};
use super::scene::DeepScene;
use super::shade::Shade;
use super::visibility::sample::Sample;
use super::visibility::{self, Samples};
use super::{NAME, full};
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, readback};
use crate::passes::accumulate::Accumulate;
use crate::plan::Resources;
use crate::report::image_file::{Aov, AovChannels};
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::{Frame, Inputs, left_out};
use std::collections::BTreeMap;
use std::sync::Arc;

pub const AOVS: &[&str] = &["count.lengths", SPIDS];

/// What builds the deep shading buffer and shades it.
struct Listed {
    lists: Lists,
    insert: Insert,
    compact: Option<Compact>,
    address: Option<Address>,
    shade: Shade,
    count: Option<Count>,
}

/// Visibility first, then what it has seen is shaded.
struct Apart {
    samples: Samples,
    sample: Sample,
    listed: Option<Listed>,
    brute: Option<Brute>,
    colors: Buffer,
}

/// From the scene to samples that have colours.
enum Shader {
    Apart(Box<Apart>),
    AsDrawn(Box<Baseline>),
}

pub struct DeepFrame {
    choices: Choices,
    primitives: Primitives,
    list: DrawList,
    scene: DeepScene,
    shader: Shader,
    resolve: Resolve,
    accumulate: Option<Accumulate>,
    counters: Buffer,
    color: Image,
}

impl Apart {
    fn new(gpu: &Arc<Gpu>, scene: &SceneGpu, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let listed = if choices.has_lists {
            let address = choices.is_compacted && choices.has_addresses;
            Some(Listed {
                lists: Lists::new(resources, choices),
                insert: Insert::new(gpu, choices)?,
                compact: if choices.is_compacted { Some(Compact::new(gpu)?) } else { None },
                address: if address { Some(Address::new(gpu)?) } else { None },
                shade: Shade::new(gpu, scene, choices)?,
                count: if choices.is_counted { Some(Count::new(gpu, resources, choices)?) } else { None },
            })
        } else {
            None
        };
        Ok(Self {
            samples: Samples::new(gpu, resources, choices)?,
            sample: Sample::new(gpu, scene, choices)?,
            brute: if choices.has_brute() { Some(Brute::new(gpu, scene, choices)?) } else { None },
            colors: lists::colors(resources),
            listed,
        })
    }

    fn count(&self) -> Option<(&Listed, &Count)> {
        self.listed.as_ref().and_then(|listed| Some((listed, listed.count.as_ref()?)))
    }
}

impl DeepFrame {
    /// Makes the pipelines and takes the planned resources out.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: Choices,
        primitives: Primitives,
    ) -> Result<Self> {
        let shader = match choices.shading {
            Shading::Deep => Shader::Apart(Box::new(Apart::new(gpu, scene, resources, &choices)?)),
            Shading::Ssaa | Shading::Msaa { .. } => {
                Shader::AsDrawn(Box::new(Baseline::new(gpu, resources, scene, &choices)?))
            }
        };
        Ok(Self {
            list: primitives::drawn(inputs.scene, scene, inputs.view, choices.geometry, choices.is_blurred()),
            scene: DeepScene::new(gpu, inputs, resources, &choices, scene)?,
            shader,
            resolve: Resolve::new(gpu, &choices)?,
            accumulate: if choices.run_count > 1 { Some(Accumulate::new(gpu, NAME, resources)?) } else { None },
            counters: resources.buffer(&full(COUNTERS)),
            color: resources.image(&full(COLOR)),
            choices,
            primitives,
        })
    }
}

impl DeepFrame {
    /// A stage of whole numbers, from that of each pixel of the frame.
    fn of_pixels(&self, name: &str, number: impl Fn([u32; 2]) -> u32) -> Aov {
        let frame = self.color.description.extent;
        let pixels = (0..frame.height).flat_map(|y| (0..frame.width).map(move |x| [x, y]));
        Aov { name: name.to_owned(), channels: AovChannels::YU32(pixels.map(number).collect()) }
    }

    /// The triangle that each pixel's first sample sees, by its id; all ones where it sees none.
    ///
    /// Errors: memory for the copy (exit code 4).
    fn first_primitives(&self, gpu: &Arc<Gpu>, samples: &Samples) -> Result<Aov> {
        let bytes = readback::image(gpu, &samples.spids, Access::ComputeSample)?;
        let spids: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&bytes);
        let frame = self.color.description.extent;
        Ok(self.of_pixels(SPIDS, |pixel| spids[self.choices.table.first_sample(frame, pixel)][0]))
    }

    /// Figure 3, from the rasterisation to the resolve, and what counts lists after it.
    fn record_apart(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        bound: &[(&'static str, Bound<'_>)],
        apart: &Apart,
    ) -> Result<()> {
        let Self { list, primitives, counters, .. } = self;
        let Apart { samples, sample, colors, .. } = apart;
        let tuples = (&self.choices.table, self.color.description.extent);
        visibility::record(cmd, sample, scene, list, primitives, bound, samples, counters, tuples)?;
        if let Some(listed) = &apart.listed {
            let lists = &listed.lists;
            listed.insert.record(cmd, bound, samples, lists, colors, counters)?;
            if let Some(compact) = &listed.compact {
                compact.record(cmd, bound, lists, colors, counters, self.choices.space.extent)?;
            }
            let mut links_left = Access::ComputeWrite;
            if let Some(address) = &listed.address {
                address.record(cmd, bound, samples, lists)?;
                links_left = Access::ComputeRead;
            }
            let maps = self.scene.maps_barrier(Access::DepthWrite);
            let left = (lists, links_left, maps);
            listed.shade.record(cmd, scene, list, primitives, bound, left, colors, counters)?;
        }
        let lists = apart.listed.as_ref().map(|listed| &listed.lists);
        if let Some(brute) = &apart.brute {
            let maps_left = if lists.is_some() { Access::FragmentSample } else { Access::DepthWrite };
            let left = (lists, self.scene.maps_barrier(maps_left));
            brute.record(cmd, scene, list, primitives, bound, samples, left, colors, counters)?;
        }
        let spids_left = match (&apart.listed, &apart.brute) {
            (Some(_), None) => Access::ComputeSample.into(),
            (Some(_), Some(_)) => Access::ComputeSample | Access::FragmentSample,
            (None, _) => Access::FragmentSample | Access::ColorWrite,
        };
        let shaded = Shaded::Apart { samples, spids_left, lists, colors };
        self.resolve.record(cmd, bound, shaded, counters, &self.color)?;
        if let Some((listed, count)) = apart.count() {
            count.record(cmd, bound, &listed.lists, counters)?;
        }
        Ok(())
    }
}

impl Frame for DeepFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let bound = self.scene.bound(frame, scene);
        self.scene.record_maps(cmd, scene)?;
        match &self.shader {
            Shader::Apart(apart) => self.record_apart(cmd, scene, &bound, apart)?,
            Shader::AsDrawn(baseline) => {
                let Self { list, primitives, counters, color, .. } = self;
                let maps = self.scene.maps_barrier(Access::DepthWrite);
                let tuples = (&self.choices.table, color.description.extent);
                baseline.record(cmd, scene, list, primitives, &bound, maps, counters, tuples)?;
                self.resolve.record(cmd, &bound, Shaded::Drawn(baseline), counters, color)?;
            }
        }
        if let Some(accumulate) = &self.accumulate {
            accumulate.record(cmd, NAME, frame, self.color.from(Access::ComputeWrite))?;
        }
        Ok(())
    }

    fn run_count(&self) -> u32 {
        self.choices.run_count
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        let mut counters: BTreeMap<&'static str, f64> = self.list.counters().into();
        counters.insert("draws", self.list.calls().count() as f64);
        counters
    }

    fn picture(&self) -> (&Image, Access) {
        (self.accumulate.as_ref().map_or(&self.color, |accumulate| &accumulate.color), Access::ComputeWrite)
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        if !self.choices.is_counted {
            return Ok(BTreeMap::new());
        }
        let pixels = self.color.description.extent.pixel_count();
        let is_baseline = self.choices.shading != Shading::Deep;
        counters::read(gpu, &self.counters, Access::ComputeWrite, pixels, self.choices.is_stochastic, is_baseline)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        let Shader::Apart(apart) = &self.shader else {
            return Err(left_out(NAME, name, "samples of a baseline (--shading) have colours and nothing else"));
        };
        if name == SPIDS {
            return self.first_primitives(gpu, &apart.samples);
        }
        let Some((_, count)) = apart.count() else {
            return Err(left_out(NAME, name, "lists are counted with --lists linked and --instrument on"));
        };
        let bytes = readback::buffer(gpu, &count.lengths, count.lengths.bytes, Access::ComputeWrite)?;
        let lengths: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(self.of_pixels(name, |at| lengths[self.choices.space.index_under(at)]))
    }
}

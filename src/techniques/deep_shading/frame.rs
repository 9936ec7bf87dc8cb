//! A frame of deep shading on the device: the passes in the order of figure 3.

use super::brute::Brute;
use super::choices::Choices;
use super::count::Count;
use super::counters::Counted;
use super::lists::address::Address;
use super::lists::compact::Compact;
use super::lists::direct::Direct;
use super::lists::insert::Insert;
use super::lists::{self, Lists};
use super::plan::{COLOR, COUNTERS, SPIDS};
use super::primitives::{self, Primitives};
use super::resolve::Resolve;
use super::scene::DeepScene;
use super::shade::Shade;
use super::visibility::ray::{Rays, Sets, Traced};
use super::visibility::sample::Sample;
use super::visibility::{self, Drawn, Samples, Visibility};
use super::{NAME, full};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image, readback};
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
    insertion: Insertion,
    shade: Shade,
    count: Option<Count>,
}

/// Who puts triangles into lists.
enum Insertion {
    Device(Box<Inserted>),
    Host(Direct),
}

/// Insertion by compute shaders.
struct Inserted {
    insert: Insert,
    compact: Option<Compact>,
    address: Option<Address>,
}

/// Who finds what samples see.
enum Seen {
    Drawn(Samples, Sample),
    Traced(Samples, Rays),
    /// With `--lists direct` the lists alone know.
    Listed,
}

impl Seen {
    fn samples(&self) -> Option<&Samples> {
        match self {
            Self::Drawn(samples, _) | Self::Traced(samples, _) => Some(samples),
            Self::Listed => None,
        }
    }
}

pub struct DeepFrame {
    choices: Choices,
    primitives: Primitives,
    list: DrawList,
    scene: DeepScene,
    visibility: Seen,
    listed: Option<Listed>,
    brute: Brute,
    resolve: Resolve,
    accumulate: Option<Accumulate>,
    colors: Buffer,
    counters: Buffer,
    color: Image,
}

impl DeepFrame {
    /// Makes the pipelines and takes the planned resources out.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: Choices,
        (primitives, traced): (Primitives, Option<Traced>),
    ) -> Result<Self> {
        let samples = |resources: &mut Resources| Samples::new(gpu, resources, &choices);
        let mut host_lists = None;
        let visibility = match traced.map(|traced| traced.sets) {
            Some(Sets::Lists(sets)) => {
                host_lists = Some(Direct::new(resources, &choices, sets));
                Seen::Listed
            }
            Some(Sets::Samples(sets)) => Seen::Traced(samples(resources)?, Rays::new(resources, &choices, sets)),
            None => Seen::Drawn(samples(resources)?, Sample::new(gpu, scene, &choices)?),
        };
        let listed = if choices.has_lists {
            let address = choices.is_compacted && choices.has_addresses;
            let insertion = match host_lists {
                Some(direct) => Insertion::Host(direct),
                None => Insertion::Device(Box::new(Inserted {
                    insert: Insert::new(gpu, &choices)?,
                    compact: if choices.is_compacted { Some(Compact::new(gpu)?) } else { None },
                    address: if address { Some(Address::new(gpu)?) } else { None },
                })),
            };
            Some(Listed {
                lists: Lists::new(resources, &choices),
                insertion,
                shade: Shade::new(gpu, scene, &choices)?,
                count: if choices.is_counted { Some(Count::new(gpu, resources, &choices)?) } else { None },
            })
        } else {
            None
        };
        Ok(Self {
            list: primitives::drawn(inputs.scene, scene, inputs.view, choices.geometry, choices.is_blurred()),
            scene: DeepScene::new(gpu, inputs, resources, &choices, scene)?,
            visibility,
            brute: Brute::new(gpu, scene, resources, &choices, inputs.view.extent)?,
            resolve: Resolve::new(gpu, &choices)?,
            accumulate: if choices.run_count > 1 { Some(Accumulate::new(gpu, NAME, resources)?) } else { None },
            colors: lists::colors(resources),
            counters: resources.buffer(&full(COUNTERS)),
            color: resources.image(&full(COLOR)),
            listed,
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

    /// Lists that the host has made.
    fn host_lists(&self) -> Option<&Direct> {
        match &self.listed.as_ref()?.insertion {
            Insertion::Host(direct) => Some(direct),
            Insertion::Device(_) => None,
        }
    }

    fn counted(&self, gpu: &Arc<Gpu>) -> Result<Counted> {
        Counted::read(gpu, &self.counters, Access::ComputeWrite)
    }

    /// The triangle that each pixel's first sample sees, by its id; all ones where it sees none.
    ///
    /// Errors: memory for the copy (exit code 4); `--lists direct` has no SPIDs (2).
    fn first_primitives(&self, gpu: &Arc<Gpu>) -> Result<Aov> {
        let Some(samples) = self.visibility.samples() else {
            return Err(left_out(NAME, SPIDS, "--lists direct has no SPIDs"));
        };
        let bytes = readback::image(gpu, &samples.spids, Access::ComputeSample)?;
        let spids: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&bytes);
        let frame = self.color.description.extent;
        Ok(self.of_pixels(SPIDS, |pixel| spids[self.choices.table.first_sample(frame, pixel)][0]))
    }
}

impl Frame for DeepFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let Self { list, primitives, visibility, colors, counters, .. } = self;
        let bound = self.scene.bound(frame, scene);
        self.scene.record_maps(cmd, scene)?;
        let frame_extent = self.color.description.extent;
        match visibility {
            Seen::Listed => {}
            Seen::Traced(samples, rays) => rays.record(cmd, samples, counters)?,
            Seen::Drawn(samples, sample) => {
                let drawn = Drawn { sample, scene, list, primitives, table: &self.choices.table, frame: frame_extent };
                visibility::record(cmd, &drawn, &bound, samples, counters, self.choices.visibility)?;
            }
        }
        if let Some(listed) = &self.listed {
            let lists = &listed.lists;
            let mut links_left = Access::ComputeWrite;
            match &listed.insertion {
                Insertion::Host(direct) => direct.record(cmd, lists, colors, counters)?,
                Insertion::Device(inserted) => {
                    let Inserted { insert, compact, address } = &**inserted;
                    let samples = visibility.samples().expect("the host has not inserted them");
                    insert.record(cmd, &bound, samples, lists, colors, counters)?;
                    if let Some(compact) = compact {
                        compact.record(cmd, &bound, lists, colors, counters, self.choices.space.extent)?;
                    }
                    if let Some(address) = address {
                        address.record(cmd, &bound, samples, lists)?;
                        links_left = Access::ComputeRead;
                    }
                }
            }
            let maps = self.scene.maps_barrier(Access::DepthWrite);
            let left = (lists, links_left, maps);
            listed.shade.record(cmd, scene, list, primitives, &bound, left, colors, counters)?;
        }
        let lists = self.listed.as_ref().map(|listed| &listed.lists);
        let maps_left = if lists.is_some() { Access::FragmentSample } else { Access::DepthWrite };
        let left = (lists, self.scene.maps_barrier(maps_left));
        self.brute.record(cmd, scene, list, primitives, &bound, visibility.samples(), left, colors, counters)?;
        let samples = visibility.samples().map(|samples| {
            let seen_by = if lists.is_some() { Access::ComputeSample } else { samples.written };
            (samples, seen_by | Access::FragmentSample)
        });
        self.resolve.record(cmd, &bound, samples, lists, colors, counters, &self.color)?;
        if let Some((listed, count)) = self.listed.as_ref().and_then(|listed| Some((listed, listed.count.as_ref()?))) {
            count.record(cmd, &bound, &listed.lists, counters)?;
        }
        if let Some(accumulate) = &self.accumulate {
            accumulate.record(cmd, NAME, frame, self.color.from(Access::ComputeWrite))?;
        }
        Ok(())
    }

    fn begin_run(&self, run: u32) {
        if let Seen::Traced(_, rays) = &self.visibility {
            rays.stage(run);
        }
        if let Some(direct) = self.host_lists() {
            direct.stage(run);
        }
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
        let is_stochastic = self.choices.visibility == Visibility::Stochastic;
        let mut counters = self.counted(gpu)?.report(pixels, is_stochastic);
        if let Some(direct) = self.host_lists() {
            counters.extend(direct.stray_counts());
        }
        Ok(counters)
    }

    fn touched_bytes(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<String, u64>> {
        // Without lists colours are cleared whole, and what the host inserts is copied whole.
        let has_entries = self.choices.is_counted && self.choices.has_lists && !self.choices.is_direct;
        Ok(if has_entries { self.counted(gpu)?.entries().bytes() } else { BTreeMap::new() })
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        if name == SPIDS {
            return self.first_primitives(gpu);
        }
        let count = self.listed.as_ref().and_then(|listed| listed.count.as_ref());
        let Some(count) = count else {
            return Err(left_out(NAME, name, "lists are counted with --lists linked and --instrument on"));
        };
        let bytes = readback::buffer(gpu, &count.lengths, count.lengths.bytes, Access::ComputeWrite)?;
        let lengths: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(self.of_pixels(name, |at| lengths[self.choices.space.index_under(at)]))
    }
}

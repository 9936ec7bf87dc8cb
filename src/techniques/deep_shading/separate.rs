//! Visibility first, then shading of what it has seen: figure 3, from samples to their colours, and the counting of
//! lists after the resolve.

use super::brute::BruteForce;
use super::choices::Choices;
use super::count::Count;
use super::indirect::Indirect;
use super::lists::address::Address;
use super::lists::compact::Compact;
use super::lists::direct::HostInsertion;
use super::lists::insert::Insert;
use super::lists::{self, Lists};
use super::primitives::Primitives;
use super::resolve::SampleColors;
use super::scene::DeepScene;
use super::shade::Shade;
use super::visibility;
use super::visibility::SampleRasterizer;
use super::visibility::ray::{Rays, TracedSamples, TracedSets};
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::visibility::samples::{DrawInputs, Samples};
use crate::units::Extent;
use std::sync::Arc;

/// What builds the deep shading buffer and shades it.
struct ListShading {
    lists: Lists,
    insertion: Insertion,
    shade: Shade,
    count: Option<Count>,
}

/// What puts triangles into lists.
enum Insertion {
    Device(Box<DeviceInsertion>),
    Host(HostInsertion),
}

/// Insertion by compute shaders.
struct DeviceInsertion {
    insert: Insert,
    compact: Option<Compact>,
    address: Option<Address>,
}

/// What finds the triangles that samples see.
enum TriangleFinder {
    Rasterizer(Samples, SampleRasterizer),
    Rays(Samples, Box<Rays>),
    /// With `--lists direct` only the lists hold it.
    HostLists,
}

/// What shades samples that are in no list.
enum Unlisted {
    BruteForce(Box<BruteForce>),
    /// All of them.
    Indirect(Box<Indirect>),
}

pub struct SeparateShading {
    finder: TriangleFinder,
    list_shading: Option<ListShading>,
    unlisted: Unlisted,
    colors: Buffer,
    visibility: Visibility,
    space: Extent,
}

impl SeparateShading {
    /// `frame`: its extent; `traced`: with `--visibility ray`; `primitives`: numbered in the order of what is drawn.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
        traced: Option<TracedSamples>,
        primitives: &Primitives,
    ) -> Result<Self> {
        let samples = |resources: &mut Resources| Samples::new(gpu, resources, choices);
        let mut host_lists = None;
        let finder = match traced.map(|traced| traced.sets) {
            Some(TracedSets::Lists(sets)) => {
                host_lists = Some(HostInsertion::new(resources, choices, sets));
                TriangleFinder::HostLists
            }
            Some(TracedSets::Samples(sets)) => {
                TriangleFinder::Rays(samples(resources)?, Box::new(Rays::new(resources, choices, sets)))
            }
            None => TriangleFinder::Rasterizer(
                samples(resources)?,
                SampleRasterizer::new(gpu, scene, resources, choices, primitives)?,
            ),
        };
        let list_shading = if choices.has_lists {
            let address = choices.is_compacted && choices.has_addresses;
            let insertion = match host_lists {
                Some(direct) => Insertion::Host(direct),
                None => Insertion::Device(Box::new(DeviceInsertion {
                    insert: Insert::new(gpu, choices)?,
                    compact: if choices.is_compacted { Some(Compact::new(gpu, choices)?) } else { None },
                    address: if address { Some(Address::new(gpu, choices)?) } else { None },
                })),
            };
            Some(ListShading {
                lists: Lists::new(resources, choices),
                insertion,
                shade: Shade::new(gpu, scene, choices)?,
                count: if choices.is_counted { Some(Count::new(gpu, resources, choices)?) } else { None },
            })
        } else {
            None
        };
        let unlisted = if choices.shading == Shading::IndirectGbuffer {
            Unlisted::Indirect(Box::new(Indirect::new(gpu, scene, resources, choices, frame)?))
        } else {
            Unlisted::BruteForce(Box::new(BruteForce::new(gpu, scene, resources, choices, frame)?))
        };
        Ok(Self {
            finder,
            list_shading,
            unlisted,
            colors: lists::colors(resources),
            visibility: choices.visibility,
            space: choices.space.extent,
        })
    }

    /// None: `--lists direct`.
    pub fn samples(&self) -> Option<&Samples> {
        match &self.finder {
            TriangleFinder::Rasterizer(samples, _) | TriangleFinder::Rays(samples, _) => Some(samples),
            TriangleFinder::HostLists => None,
        }
    }

    /// Lists that the host has made.
    pub fn host_lists(&self) -> Option<&HostInsertion> {
        match &self.list_shading.as_ref()?.insertion {
            Insertion::Host(direct) => Some(direct),
            Insertion::Device(_) => None,
        }
    }

    pub fn count(&self) -> Option<&Count> {
        self.list_shading.as_ref()?.count.as_ref()
    }

    /// The buffers of lists, of a compact geometry buffer, and of colours.
    pub fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        let list_shading = self.list_shading.iter();
        let lists = list_shading.flat_map(|list_shading| {
            list_shading.lists.all().chain(list_shading.count.iter().map(|count| &count.lengths))
        });
        let indirect = match &self.unlisted {
            Unlisted::Indirect(indirect) => Some(indirect.buffers()),
            Unlisted::BruteForce(_) => None,
        };
        lists.chain(indirect.into_iter().flatten()).chain([&self.colors])
    }

    /// Puts what the host has made of a run where the frame takes it from.
    pub fn begin_run(&self, run: u32) {
        if let TriangleFinder::Rays(_, rays) = &self.finder {
            rays.stage(run);
        }
        if let Some(direct) = self.host_lists() {
            direct.stage(run);
        }
    }

    /// To samples that have colours.
    pub fn record(
        &self,
        cmd: &mut Commands,
        deep: &DeepScene,
        drawn: DrawInputs<'_>,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<SampleColors<'_>> {
        let DrawInputs { scene, list, primitives, .. } = drawn;
        match &self.finder {
            TriangleFinder::HostLists => {}
            TriangleFinder::Rays(samples, rays) => rays.record(cmd, samples, counters)?,
            TriangleFinder::Rasterizer(samples, rasterizer) => {
                visibility::record(cmd, rasterizer, drawn, bound, samples, counters, self.visibility)?;
            }
        }
        if let Some(list_shading) = &self.list_shading {
            let links_left = self.record_insertion(cmd, list_shading, bound, counters)?;
            let maps = deep.maps_barrier(Access::DepthWrite, Access::FragmentSample);
            let left = (&list_shading.lists, links_left, maps);
            list_shading.shade.record(cmd, scene, list, primitives, bound, left, &self.colors, counters)?;
        }
        let brute = match &self.unlisted {
            Unlisted::BruteForce(brute) => brute,
            Unlisted::Indirect(indirect) => {
                let samples = self.samples().expect("there are no lists");
                let left = (samples, deep.maps_barrier(Access::DepthWrite, Access::ComputeSample));
                indirect.record(cmd, scene, list, primitives, bound, left, &self.colors, counters)?;
                let samples = (samples, samples.written | Access::FragmentSample);
                return Ok(SampleColors::Pointed {
                    samples,
                    pointers: &indirect.entries.pointers,
                    colors: &self.colors,
                });
            }
        };
        let lists = self.list_shading.as_ref().map(|list_shading| &list_shading.lists);
        let maps_left = if lists.is_some() { Access::FragmentSample } else { Access::DepthWrite };
        let left = (lists, deep.maps_barrier(maps_left, Access::FragmentSample));
        brute.record(cmd, scene, list, primitives, bound, self.samples(), left, &self.colors, counters)?;
        let samples = self.samples().map(|samples| {
            let seen_by = if lists.is_some() { Access::ComputeSample } else { samples.written };
            (samples, seen_by | Access::FragmentSample)
        });
        Ok(SampleColors::Separate { samples, lists, colors: &self.colors })
    }

    /// Returns how the links were touched last.
    fn record_insertion(
        &self,
        cmd: &mut Commands,
        list_shading: &ListShading,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<Access> {
        let (lists, colors) = (&list_shading.lists, &self.colors);
        let DeviceInsertion { insert, compact, address } = match &list_shading.insertion {
            Insertion::Device(inserted) => &**inserted,
            Insertion::Host(direct) => {
                direct.record(cmd, lists, colors, counters)?;
                return Ok(Access::ComputeWrite);
            }
        };
        let samples = self.samples().expect("the host has not inserted them");
        insert.record(cmd, bound, samples, lists, colors, counters)?;
        if let Some(compact) = compact {
            compact.record(cmd, bound, lists, colors, counters, self.space)?;
        }
        let Some(address) = address else { return Ok(Access::ComputeWrite) };
        address.record(cmd, bound, samples, lists)?;
        Ok(Access::ComputeRead)
    }

    /// After the resolve.
    pub fn record_count(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<()> {
        let Some(list_shading) = &self.list_shading else { return Ok(()) };
        let Some(count) = &list_shading.count else { return Ok(()) };
        count.record(cmd, bound, &list_shading.lists, counters)
    }
}

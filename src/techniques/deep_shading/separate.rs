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
use super::lists::{self, Lists, ListsEdge};
use super::pass_inputs::{DrawInputs, ShadingEdges};
use super::primitives::Primitives;
use super::sample_colors::SampleColors;
use super::scene::DeepScene;
use super::shade::Shade;
use super::visibility;
use super::visibility::SampleRasterizer;
use super::visibility::ray::{Rays, TracedSamples, TracedSets};
use crate::error::Result;
use crate::gpu::{Access, AccessSet, Bound, Buffer, Commands, Edge, Gpu};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::visibility::samples::{Samples, SeenSamples};
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
            let address = choices.lists.is_compacted && choices.lists.has_addresses;
            let insertion = match host_lists {
                Some(direct) => Insertion::Host(direct),
                None => Insertion::Device(Box::new(DeviceInsertion {
                    insert: Insert::new(gpu, choices)?,
                    compact: if choices.lists.is_compacted { Some(Compact::new(gpu, choices)?) } else { None },
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

    /// From what is drawn to samples that have colours.
    pub fn record(
        &self,
        cmd: &mut Commands,
        deep: &DeepScene,
        inputs: DrawInputs<'_>,
        counters: &Buffer,
    ) -> Result<SampleColors<'_>> {
        match &self.finder {
            TriangleFinder::HostLists => {}
            TriangleFinder::Rays(samples, rays) => rays.record(cmd, samples, counters)?,
            TriangleFinder::Rasterizer(samples, rasterizer) => {
                visibility::record(cmd, rasterizer, inputs, samples, counters, self.visibility)?;
            }
        }
        let brute = match &self.unlisted {
            Unlisted::BruteForce(brute) => brute,
            Unlisted::Indirect(indirect) => {
                let samples = self.samples().expect("there are no lists");
                let edges = self.untouched(deep, counters.from(Access::FragmentWrite));
                indirect.record(cmd, inputs, as_written(samples), edges)?;
                return Ok(SampleColors::Pointed {
                    samples: samples.from(samples.written | Access::FragmentSample),
                    pointers: indirect.entries.pointers.from(Access::FragmentWrite),
                    colors: self.colors.from(Access::ComputeWrite),
                });
            }
        };
        let colors = self.colors.from(Access::FragmentWrite);
        let Some(list_shading) = &self.list_shading else {
            let edges = self.untouched(deep, counters.from(Access::FragmentWrite));
            brute.record(cmd, inputs, self.samples().map(as_written), None, edges)?;
            let samples = self.samples().map(|samples| samples.from(samples.written | Access::FragmentSample));
            return Ok(SampleColors::Separate { samples, lists: None, colors });
        };
        let mut lists = self.record_insertion(cmd, list_shading, inputs.bound, counters)?;
        let edges = ShadingEdges {
            colors: self.colors.from(Access::ComputeWrite),
            counters: counters.from(Access::ComputeWrite),
            maps: deep.maps_from(Access::DepthWrite),
        };
        list_shading.shade.record(cmd, inputs, lists, edges)?;
        lists.links = lists.links.after(Access::GraphicsRead);
        // Compute shaders have read SPIDs first: what wrote them was waited for by those alone.
        let seen = self.samples().map(|samples| SeenSamples {
            spids: samples.from(Access::ComputeSample | samples.written),
            ..as_written(samples)
        });
        let edges = ShadingEdges {
            colors,
            counters: counters.from(Access::FragmentWrite),
            maps: deep.maps_from(Access::FragmentSample),
        };
        brute.record(cmd, inputs, seen, Some(lists), edges)?;
        // Compute shaders touch the links after draws have read them: what wrote them was waited for by the draws alone.
        lists.links = lists.links.with(Access::ComputeWrite);
        if seen.is_none() {
            lists.addresses = lists.addresses.with(Access::GraphicsRead);
        }
        let samples = self.samples().map(|samples| samples.from(Access::ComputeSample | Access::FragmentSample));
        Ok(SampleColors::Separate { samples, lists: Some(lists), colors })
    }

    /// Before the only pass that shades.
    fn untouched<'a>(&'a self, deep: &'a DeepScene, counters: Edge<'a, Buffer>) -> ShadingEdges<'a> {
        let colors = self.colors.from(AccessSet::UNTOUCHED);
        ShadingEdges { colors, counters, maps: deep.maps_from(Access::DepthWrite) }
    }

    /// Returns the lists as insertion leaves them.
    fn record_insertion<'a>(
        &self,
        cmd: &mut Commands,
        list_shading: &'a ListShading,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<ListsEdge<'a>> {
        let (lists, colors) = (&list_shading.lists, &self.colors);
        let written = lists.from(Access::ComputeWrite);
        let DeviceInsertion { insert, compact, address } = match &list_shading.insertion {
            Insertion::Device(inserted) => &**inserted,
            Insertion::Host(direct) => {
                direct.record(cmd, lists, colors, counters)?;
                return Ok(written);
            }
        };
        let samples = self.samples().expect("the host has not inserted them");
        let seen = samples.from(samples.written);
        insert.record(cmd, bound, seen, lists, colors, counters.from(Access::FragmentWrite))?;
        if let Some(compact) = compact {
            let [colors, counters] = [colors, counters].map(|buffer| buffer.from(Access::ComputeWrite));
            compact.record(cmd, bound, written, colors, counters, self.space)?;
        }
        let Some(address) = address else { return Ok(written) };
        address.record(cmd, bound, samples.from(Access::ComputeSample), written)?;
        Ok(ListsEdge { links: written.links.after(Access::ComputeRead), ..written })
    }

    /// Counts lists, where `--instrument on` and there are some.
    pub fn record_count(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        lists: Option<ListsEdge<'_>>,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        match (self.count(), lists) {
            (Some(count), Some(lists)) => count.record(cmd, bound, lists, counters),
            _ => Ok(()),
        }
    }
}

/// Samples as visibility leaves them.
fn as_written(samples: &Samples) -> SeenSamples<'_> {
    let depth = samples.depth.as_ref().map(|depth| depth.from(Access::DepthWrite));
    SeenSamples { spids: samples.from(samples.written), depth }
}

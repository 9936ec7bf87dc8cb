//! Visibility first, then shading of what it has seen: figure 3, from samples to their colours, and the counting of
//! lists after the resolve.

use super::choices::Choices;
use super::count::Count;
use super::entries::order::EntryOrder;
use super::entries::samples::SampleEntries;
use super::entries::shade::ShadeEntries;
use super::entries::sort::Sort;
use super::indirect::Indirect;
use super::lists::address::Address;
use super::lists::compact::Compact;
use super::lists::direct::HostInsertion;
use super::lists::insert::Insert;
use super::lists::{self, Lists, ListsEdge};
use super::pass_inputs::{DrawInputs, ShadingEdges};
use super::primitives::Primitives;
use super::ranges;
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
use crate::techniques::deep_shading::visibility::samples::Samples;
use crate::units::Extent;
use std::sync::Arc;

/// What builds the deep shading buffer.
struct ListShading {
    lists: Lists,
    insertion: Insertion,
    /// With `--shade-by fragment`: what the lists have.
    by_fragment: Option<Shade>,
    /// The rest: all of it, or strays alone.
    shade: ShadeEntries,
    count: Option<Count>,
}

/// What shades each sample by itself.
struct SampleShading {
    entries: SampleEntries,
    shade: ShadeEntries,
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

/// How samples come to what is shaded for them.
enum Source {
    Lists(Box<ListShading>),
    /// Each has it for itself.
    Samples(Box<SampleShading>),
    Cache(Box<Indirect>),
}

pub struct SeparateShading {
    finder: TriangleFinder,
    source: Source,
    sort: Sort,
    order: EntryOrder,
    /// Ranges of triangles' ids by draw.
    draw_ranges: Buffer,
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
        let source = if choices.shading == Shading::IndirectGbuffer {
            Source::Cache(Box::new(Indirect::new(gpu, scene, resources, choices, frame)?))
        } else if choices.has_lists {
            let address = choices.lists.is_compacted && choices.lists.has_addresses;
            let insertion = match host_lists {
                Some(direct) => Insertion::Host(direct),
                None => Insertion::Device(Box::new(DeviceInsertion {
                    insert: Insert::new(gpu, choices)?,
                    compact: if choices.lists.is_compacted { Some(Compact::new(gpu, choices)?) } else { None },
                    address: if address { Some(Address::new(gpu, choices)?) } else { None },
                })),
            };
            Source::Lists(Box::new(ListShading {
                lists: Lists::new(resources, choices),
                insertion,
                by_fragment: if choices.is_by_fragment() {
                    Some(Shade::new(gpu, scene, resources, choices)?)
                } else {
                    None
                },
                shade: ShadeEntries::new(gpu, scene, choices)?,
                count: if choices.is_counted { Some(Count::new(gpu, resources, choices)?) } else { None },
            }))
        } else {
            let shade = ShadeEntries::new(gpu, scene, choices)?;
            Source::Samples(Box::new(SampleShading { entries: SampleEntries::new(gpu, choices)?, shade }))
        };
        Ok(Self {
            finder,
            source,
            sort: Sort::new(gpu, choices, frame, scene.material_blocks.len())?,
            order: EntryOrder::new(resources),
            draw_ranges: ranges::by_id(gpu, resources, scene, primitives)?,
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
    fn host_lists(&self) -> Option<&HostInsertion> {
        match &self.list_shading()?.insertion {
            Insertion::Host(direct) => Some(direct),
            Insertion::Device(_) => None,
        }
    }

    fn list_shading(&self) -> Option<&ListShading> {
        match &self.source {
            Source::Lists(list_shading) => Some(list_shading),
            Source::Samples(_) | Source::Cache(_) => None,
        }
    }

    /// Ranges of draws by the ids of triangles, as shaders call them.
    pub fn draw_ranges(&self) -> (&'static str, Bound<'_>) {
        ("DrawnRanges", Bound::Buffer(&self.draw_ranges))
    }

    /// None: `--lists none`, or `--shading indirect-gbuffer`.
    pub fn lists(&self) -> Option<&Lists> {
        Some(&self.list_shading()?.lists)
    }

    pub fn count(&self) -> Option<&Count> {
        self.list_shading()?.count.as_ref()
    }

    /// The buffers of lists, of a compact geometry buffer, and of colours.
    pub fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        let list_shading = self.list_shading().into_iter();
        let lists = list_shading.flat_map(|list_shading| {
            list_shading.lists.all().chain(list_shading.count.iter().map(|count| &count.lengths))
        });
        let indirect = match &self.source {
            Source::Cache(indirect) => Some(indirect.buffers()),
            Source::Lists(_) | Source::Samples(_) => None,
        };
        lists.chain(indirect.into_iter().flatten()).chain([&self.colors, &self.order.order])
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
        let inputs = inputs.after_visibility();
        match &self.source {
            Source::Lists(list_shading) => self.record_lists(cmd, deep, inputs, list_shading, counters),
            Source::Samples(alone) => {
                alone.entries.record(cmd, inputs.bound, self.seen(), &self.colors)?;
                self.record_entries(cmd, deep, inputs, counters.from(Access::FragmentWrite), &alone.shade, None)?;
                Ok(self.separate(None))
            }
            Source::Cache(indirect) => {
                let seen = self.seen();
                let edges = ShadingEdges {
                    colors: self.colors.from(AccessSet::UNTOUCHED),
                    counters: counters.from(Access::FragmentWrite),
                    maps: deep.maps_from(Access::DepthWrite),
                };
                indirect.record(cmd, inputs, seen, (&self.sort, &self.order), edges)?;
                Ok(SampleColors::Pointed {
                    samples: seen.resource.from(Access::ComputeSample),
                    pointers: indirect.compact.pointers.from(Access::ComputeWrite),
                    colors: self.colors.from(Access::ComputeWrite),
                })
            }
        }
    }

    /// What samples see, as visibility leaves it. Not with `--lists direct`, where the host's lists alone say it.
    fn seen(&self) -> Edge<'_, Samples> {
        let samples = self.samples().expect("the host has not inserted them");
        samples.from(samples.written)
    }

    /// Samples with colours beside them, after compute shaders have read SPIDs.
    fn separate<'a>(&'a self, lists: Option<ListsEdge<'a>>) -> SampleColors<'a> {
        let samples = self.samples().map(|samples| samples.from(Access::ComputeSample));
        SampleColors::Separate { samples, lists, colors: self.colors.from(Access::ComputeWrite) }
    }

    /// Insertion, and shading of what it has listed and of strays.
    fn record_lists<'a>(
        &'a self,
        cmd: &mut Commands,
        deep: &DeepScene,
        inputs: DrawInputs<'_>,
        list_shading: &'a ListShading,
        counters: &Buffer,
    ) -> Result<SampleColors<'a>> {
        let mut lists = self.record_insertion(cmd, list_shading, inputs.bound, counters)?;
        let by_fragment = list_shading.by_fragment.as_ref().map(|shade| (shade, lists));
        let counted = counters.from(Access::ComputeWrite);
        self.record_entries(cmd, deep, inputs, counted, &list_shading.shade, by_fragment)?;
        if by_fragment.is_some() {
            // Compute shaders touch the links after draws have read them: what wrote them was waited for by the draws alone.
            lists.links = lists.links.after(Access::GraphicsRead).with(Access::ComputeWrite);
        }
        Ok(self.separate(Some(lists)))
    }

    /// Entries wait in the places of colours. `by_fragment`: what shades the triangles of lists, so that strays alone are left.
    fn record_entries(
        &self,
        cmd: &mut Commands,
        deep: &DeepScene,
        inputs: DrawInputs<'_>,
        counters: Edge<'_, Buffer>,
        shade: &ShadeEntries,
        by_fragment: Option<(&Shade, ListsEdge<'_>)>,
    ) -> Result<()> {
        let waiting = self.colors.from(Access::ComputeWrite);
        self.sort.record(cmd, inputs.bound, &self.order, waiting, counters)?;
        let (colors, counters) = (&self.colors, counters.resource);
        let mut edges = ShadingEdges {
            colors: colors.from(Access::ComputeRead),
            counters: counters.from(Access::ComputeWrite),
            maps: deep.maps_from(Access::DepthWrite),
        };
        if let Some((fragments, lists)) = by_fragment {
            fragments.record(cmd, inputs, lists, edges)?;
            let [colors, counters] = [colors, counters].map(|buffer| buffer.from(Access::FragmentWrite));
            edges = ShadingEdges { colors, counters, maps: deep.maps_from(Access::FragmentSample) };
        }
        shade.record(cmd, inputs, &self.order, edges)
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
        let seen = self.seen();
        let samples = seen.resource;
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

//! Visibility first, then shading of what it has seen: figure 3, from samples to their colours, and the counting of
//! lists after the resolve.

use super::brute::Brute;
use super::choices::Choices;
use super::count::Count;
use super::indirect::Indirect;
use super::lists::address::Address;
use super::lists::compact::Compact;
use super::lists::direct::Direct;
use super::lists::insert::Insert;
use super::lists::{self, Lists};
use super::primitives::Primitives;
use super::resolve::Shaded;
use super::scene::DeepScene;
use super::shade::Shade;
use super::visibility;
use super::visibility::Drawer;
use super::visibility::ray::{Rays, Sets, Traced};
use crate::error::Result;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::visibility::samples::{Drawn, Samples};
use crate::units::Extent;
use std::sync::Arc;

/// What builds the deep shading buffer and shades it.
struct Listed {
    lists: Lists,
    insertion: Insertion,
    shade: Shade,
    count: Option<Count>,
}

/// What puts triangles into lists.
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

/// What finds the triangles that samples see.
enum Seen {
    Drawn(Samples, Drawer),
    Traced(Samples, Box<Rays>),
    /// With `--lists direct` only the lists hold it.
    Listed,
}

/// What shades samples that are in no list.
enum Rest {
    Alone(Box<Brute>),
    /// All of them.
    Indirect(Box<Indirect>),
}

pub struct Apart {
    seen: Seen,
    listed: Option<Listed>,
    rest: Rest,
    colors: Buffer,
    visibility: Visibility,
    space: Extent,
}

impl Apart {
    /// `frame`: its extent; `traced`: with `--visibility ray`; `primitives`: numbered in the order of what is drawn.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
        traced: Option<Traced>,
        primitives: &Primitives,
    ) -> Result<Self> {
        let samples = |resources: &mut Resources| Samples::new(gpu, resources, choices);
        let mut host_lists = None;
        let seen = match traced.map(|traced| traced.sets) {
            Some(Sets::Lists(sets)) => {
                host_lists = Some(Direct::new(resources, choices, sets));
                Seen::Listed
            }
            Some(Sets::Samples(sets)) => {
                Seen::Traced(samples(resources)?, Box::new(Rays::new(resources, choices, sets)))
            }
            None => Seen::Drawn(samples(resources)?, Drawer::new(gpu, scene, resources, choices, primitives)?),
        };
        let listed = if choices.has_lists {
            let address = choices.is_compacted && choices.has_addresses;
            let insertion = match host_lists {
                Some(direct) => Insertion::Host(direct),
                None => Insertion::Device(Box::new(Inserted {
                    insert: Insert::new(gpu, choices)?,
                    compact: if choices.is_compacted { Some(Compact::new(gpu, choices)?) } else { None },
                    address: if address { Some(Address::new(gpu, choices)?) } else { None },
                })),
            };
            Some(Listed {
                lists: Lists::new(resources, choices),
                insertion,
                shade: Shade::new(gpu, scene, choices)?,
                count: if choices.is_counted { Some(Count::new(gpu, resources, choices)?) } else { None },
            })
        } else {
            None
        };
        let rest = if choices.shading == Shading::IndirectGbuffer {
            Rest::Indirect(Box::new(Indirect::new(gpu, scene, resources, choices, frame)?))
        } else {
            Rest::Alone(Box::new(Brute::new(gpu, scene, resources, choices, frame)?))
        };
        Ok(Self {
            seen,
            listed,
            rest,
            colors: lists::colors(resources),
            visibility: choices.visibility,
            space: choices.space.extent,
        })
    }

    /// None: `--lists direct`.
    pub fn samples(&self) -> Option<&Samples> {
        match &self.seen {
            Seen::Drawn(samples, _) | Seen::Traced(samples, _) => Some(samples),
            Seen::Listed => None,
        }
    }

    /// Lists that the host has made.
    pub fn host_lists(&self) -> Option<&Direct> {
        match &self.listed.as_ref()?.insertion {
            Insertion::Host(direct) => Some(direct),
            Insertion::Device(_) => None,
        }
    }

    pub fn count(&self) -> Option<&Count> {
        self.listed.as_ref()?.count.as_ref()
    }

    /// The buffers of lists, of a compact geometry buffer, and of colours.
    pub fn buffers(&self) -> impl Iterator<Item = &Buffer> {
        let listed = self.listed.iter();
        let lists = listed.flat_map(|listed| listed.lists.all().chain(listed.count.iter().map(|count| &count.lengths)));
        let indirect = match &self.rest {
            Rest::Indirect(indirect) => Some(indirect.buffers()),
            Rest::Alone(_) => None,
        };
        lists.chain(indirect.into_iter().flatten()).chain([&self.colors])
    }

    /// Puts what the host has made of a run where the frame takes it from.
    pub fn begin_run(&self, run: u32) {
        if let Seen::Traced(_, rays) = &self.seen {
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
        drawn: Drawn<'_>,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<Shaded<'_>> {
        let Drawn { scene, list, primitives, .. } = drawn;
        match &self.seen {
            Seen::Listed => {}
            Seen::Traced(samples, rays) => rays.record(cmd, samples, counters)?,
            Seen::Drawn(samples, drawer) => {
                visibility::record(cmd, drawer, drawn, bound, samples, counters, self.visibility)?;
            }
        }
        if let Some(listed) = &self.listed {
            let links_left = self.record_insertion(cmd, listed, bound, counters)?;
            let maps = deep.maps_barrier(Access::DepthWrite, Access::FragmentSample);
            let left = (&listed.lists, links_left, maps);
            listed.shade.record(cmd, scene, list, primitives, bound, left, &self.colors, counters)?;
        }
        let brute = match &self.rest {
            Rest::Alone(brute) => brute,
            Rest::Indirect(indirect) => {
                let samples = self.samples().expect("there are no lists");
                let left = (samples, deep.maps_barrier(Access::DepthWrite, Access::ComputeSample));
                indirect.record(cmd, scene, list, primitives, bound, left, &self.colors, counters)?;
                let samples = (samples, samples.written | Access::FragmentSample);
                return Ok(Shaded::Pointed { samples, pointers: &indirect.entries.pointers, colors: &self.colors });
            }
        };
        let lists = self.listed.as_ref().map(|listed| &listed.lists);
        let maps_left = if lists.is_some() { Access::FragmentSample } else { Access::DepthWrite };
        let left = (lists, deep.maps_barrier(maps_left, Access::FragmentSample));
        brute.record(cmd, scene, list, primitives, bound, self.samples(), left, &self.colors, counters)?;
        let samples = self.samples().map(|samples| {
            let seen_by = if lists.is_some() { Access::ComputeSample } else { samples.written };
            (samples, seen_by | Access::FragmentSample)
        });
        Ok(Shaded::Apart { samples, lists, colors: &self.colors })
    }

    /// Returns how the links were touched last.
    fn record_insertion(
        &self,
        cmd: &mut Commands,
        listed: &Listed,
        bound: &[(&'static str, Bound<'_>)],
        counters: &Buffer,
    ) -> Result<Access> {
        let (lists, colors) = (&listed.lists, &self.colors);
        let Inserted { insert, compact, address } = match &listed.insertion {
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
        let Some(listed) = &self.listed else { return Ok(()) };
        let Some(count) = &listed.count else { return Ok(()) };
        count.record(cmd, bound, &listed.lists, counters)
    }
}

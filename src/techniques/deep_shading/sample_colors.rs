//! Samples that have colours: where these are, and who touched what leads to them last.

use super::baseline::Baseline;
use super::choices::{Choices, ListChoices};
use super::lists::ListsEdge;
use crate::gpu::{Access, Barrier, Bound, Buffer, Edge};
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::visibility::samples::Samples;

/// Samples whose colours are there.
#[derive(Clone, Copy)]
pub enum SampleColors<'a> {
    /// Beside what samples see.
    Separate {
        /// Where they have SPIDs.
        samples: Option<Edge<'a, Samples>>,
        lists: Option<ListsEdge<'a>>,
        colors: Edge<'a, Buffer>,
    },
    /// In a compact geometry buffer that samples point to.
    Pointed {
        samples: Edge<'a, Samples>,
        pointers: Edge<'a, Buffer>,
        colors: Edge<'a, Buffer>,
    },
    Baseline(Edge<'a, Baseline>),
}

impl<'a> SampleColors<'a> {
    /// Bytes of all that says what samples' colours are.
    pub fn bytes(self) -> u64 {
        let spids = |samples: Edge<'_, Samples>| samples.resource.spids.description.bytes();
        match self {
            Self::Separate { samples, lists, colors } => {
                let addresses = lists.and_then(|edge| edge.lists.addresses.as_ref());
                samples.map_or(0, spids) + addresses.map_or(0, |buffer| buffer.bytes) + colors.resource.bytes
            }
            // Colours are counted after the frame: only those that exist.
            Self::Pointed { samples, pointers, .. } => spids(samples) + pointers.resource.bytes,
            Self::Baseline(baseline) => baseline.resource.colors.description.bytes(),
        }
    }

    /// The lists that lead to them.
    pub fn lists(self) -> Option<ListsEdge<'a>> {
        match self {
            Self::Separate { lists, .. } => lists,
            Self::Pointed { .. } | Self::Baseline(_) => None,
        }
    }

    /// The same after a compute shader has read it.
    pub fn read_by_compute(self) -> Self {
        let read = |edge: Edge<'a, Buffer>| edge.resource.from(edge.from.read_by(Access::ComputeRead));
        let sampled = |edge: Edge<'a, Samples>| edge.resource.from(edge.from.read_by(Access::ComputeSample));
        match self {
            Self::Separate { samples, lists, colors } => {
                let lists = lists.map(|edge| match edge.lists.addresses {
                    Some(_) => ListsEdge { addresses: edge.addresses.read_by(Access::ComputeRead), ..edge },
                    None => ListsEdge { links: edge.links.read_by(Access::ComputeRead), ..edge },
                });
                Self::Separate { samples: samples.map(sampled), lists, colors: read(colors) }
            }
            Self::Pointed { samples, pointers, colors } => {
                Self::Pointed { samples: sampled(samples), pointers: read(pointers), colors: read(colors) }
            }
            Self::Baseline(baseline) => Self::Baseline(baseline.resource.from(Access::ComputeSample)),
        }
    }

    /// It becomes readable by compute shaders.
    pub fn to_compute(self) -> Vec<Barrier> {
        match self {
            Self::Separate { samples, lists, colors } => {
                let mut barriers: Vec<_> =
                    lists.into_iter().flat_map(|lists| lists.colors_found_by(Access::ComputeRead)).collect();
                barriers.extend(samples.map(|samples| samples.spids_to(Access::ComputeSample)));
                barriers.push(colors.to(Access::ComputeRead));
                barriers
            }
            Self::Pointed { samples, pointers, colors } => vec![
                samples.spids_to(Access::ComputeSample),
                pointers.to(Access::ComputeRead),
                colors.to(Access::ComputeRead),
            ],
            Self::Baseline(baseline) => vec![baseline.resource.colors.from(baseline.from).to(Access::ComputeSample)],
        }
    }

    /// The same, by the names that shaders have for it.
    pub fn bound(self) -> Vec<(&'static str, Bound<'a>)> {
        let spids = |samples: Edge<'a, Samples>| {
            let samples = samples.resource;
            ("spids", samples.sampled(&samples.spids, Access::ComputeSample))
        };
        match self {
            Self::Separate { samples, lists, colors } => {
                let mut bound: Vec<_> = lists.into_iter().flat_map(|edge| edge.lists.bound()).collect();
                bound.push(("Colors", Bound::Buffer(colors.resource)));
                bound.extend(samples.map(spids));
                bound
            }
            Self::Pointed { samples, pointers, colors } => vec![
                spids(samples),
                ("Pointers", Bound::Buffer(pointers.resource)),
                ("Colors", Bound::Buffer(colors.resource)),
            ],
            Self::Baseline(baseline) => vec![("drawn", baseline.resource.sampled())],
        }
    }
}

/// How shaders find a sample's colour: a value of their axis FETCH.
pub fn fetch(choices: &Choices) -> &'static str {
    match choices {
        Choices { shading: Shading::Ssaa | Shading::TextureSpace(_), .. } => "layers",
        Choices { shading: Shading::Msaa { pass_samples: 1 }, .. } => "passes",
        Choices { shading: Shading::Msaa { .. }, .. } => "multisampled",
        Choices { shading: Shading::IndirectGbuffer, .. } => "pointer",
        Choices { has_lists: false, .. } => "own",
        Choices { lists: ListChoices { is_direct: true, .. }, .. } => "direct",
        Choices { lists: ListChoices { has_addresses: true, .. }, .. } => "address",
        Choices { lists: ListChoices { is_compacted: true, .. }, .. } => "compact",
        _ => "linked",
    }
}

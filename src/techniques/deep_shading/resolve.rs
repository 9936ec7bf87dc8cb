//! Resolve: the mean of each pixel's samples, gathered through the address buffer, by following links, or from the samples' own
//! places (Clarberg & Munkberg 2014, section 3.2); of a baseline from what it drew. Shader: resolve.comp.
//! reads  visibility.spids, shade.colors, lists.addresses or the lists; baseline.colors
//! writes  resolve.color  image, RGBA32F; stereo.right, the same of the right one of two eyes

use super::baseline::Baseline;
use super::choices::Choices;
use super::lists::Lists;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::ResolveParams;
use crate::gpu::shader::techniques::deep_shading::resolve::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Bound, Buffer, Commands, Gpu, Image, Traffic};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

/// Samples whose colours are there.
#[derive(Clone, Copy)]
pub enum SampleColors<'a> {
    /// What samples see, and its colours, apart.
    Separate {
        /// Where they have SPIDs: what read those, and what wrote them if compute shaders have not waited for it yet.
        samples: Option<(&'a Samples, AccessSet)>,
        lists: Option<&'a Lists>,
        colors: &'a Buffer,
    },
    /// In a compact geometry buffer that samples point to. What read the SPIDs, and what wrote them if compute shaders
    /// have not waited for it yet.
    Pointed {
        samples: (&'a Samples, AccessSet),
        pointers: &'a Buffer,
        colors: &'a Buffer,
    },
    Baseline(&'a Baseline),
}

impl<'a> SampleColors<'a> {
    /// Bytes of all that says what samples' colours are.
    pub fn bytes(self) -> u64 {
        match self {
            Self::Separate { samples, lists, colors, .. } => {
                let addresses = lists.and_then(|lists| lists.addresses.as_ref());
                let spids = samples.map_or(0, |(samples, _)| samples.spids.description.bytes());
                spids + addresses.map_or(0, |buffer| buffer.bytes) + colors.bytes
            }
            // Colours are counted after the frame: only those that exist.
            Self::Pointed { samples: (samples, _), pointers, .. } => samples.spids.description.bytes() + pointers.bytes,
            Self::Baseline(baseline) => baseline.colors.description.bytes(),
        }
    }

    /// The access that counted last.
    fn counted(self) -> Access {
        if matches!(self, Self::Pointed { .. }) { Access::ComputeWrite } else { Access::FragmentWrite }
    }

    fn to_compute(self, cmd: &mut Commands) {
        match self {
            Self::Separate { samples, lists, colors } => {
                match lists {
                    Some(Lists { addresses: Some(addresses), .. }) => {
                        let left = Access::ComputeWrite | Access::GraphicsRead;
                        cmd.barriers([addresses.from(left).to(Access::ComputeRead)]);
                    }
                    Some(lists) => lists.links_to_compute(cmd, Access::ComputeRead),
                    None => {}
                }
                cmd.barriers(samples.map(|(samples, left)| samples.spids.from(left).to(Access::ComputeSample)));
                cmd.barriers([colors.from(Access::FragmentWrite).to(Access::ComputeRead)]);
            }
            Self::Pointed { samples: (samples, left), pointers, colors } => {
                cmd.barriers([samples.spids.from(left).to(Access::ComputeSample)]);
                cmd.barriers([
                    pointers.from(Access::FragmentWrite).to(Access::ComputeRead),
                    colors.from(Access::ComputeWrite).to(Access::ComputeRead),
                ]);
            }
            Self::Baseline(baseline) => {
                cmd.barriers([baseline.colors.from(Access::ColorWrite).to(Access::ComputeSample)]);
            }
        }
    }

    /// For the next compute shader that reads the same: it has been waited for.
    pub fn stay_in_compute(self, cmd: &mut Commands) {
        let Self::Separate { samples, lists, colors } = self else { return };
        let read = Access::ComputeRead | Access::GraphicsRead;
        match lists {
            Some(Lists { addresses: Some(addresses), .. }) => {
                cmd.barriers([addresses.from(read).to(Access::ComputeRead)]);
            }
            Some(lists) => lists.links_to(cmd, read, Access::ComputeRead),
            None => {}
        }
        let sampled = Access::ComputeSample | Access::FragmentSample;
        cmd.barriers(samples.map(|(samples, _)| samples.spids.from(sampled).to(Access::ComputeSample)));
        cmd.barriers([colors.from(Access::ComputeRead).to(Access::ComputeRead)]);
    }

    /// The same, by the names that shaders have for it.
    pub fn bound(self) -> Vec<(&'static str, Bound<'a>)> {
        match self {
            Self::Separate { samples, lists, colors, .. } => {
                let mut bound: Vec<_> = lists.map(Lists::bound).into_iter().flatten().collect();
                let spids = samples.map(|(samples, _)| samples.sampled(&samples.spids, Access::ComputeSample));
                bound.push(("Colors", Bound::Buffer(colors)));
                bound.extend(spids.map(|spids| ("spids", spids)));
                bound
            }
            Self::Pointed { samples: (samples, _), pointers, colors } => vec![
                ("spids", samples.sampled(&samples.spids, Access::ComputeSample)),
                ("Pointers", Bound::Buffer(pointers)),
                ("Colors", Bound::Buffer(colors)),
            ],
            Self::Baseline(baseline) => vec![("drawn", baseline.sampled())],
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
        Choices { is_direct: true, .. } => "direct",
        Choices { has_addresses: true, .. } => "address",
        Choices { is_compacted: true, .. } => "compact",
        _ => "linked",
    }
}

pub struct Resolve {
    pipeline: ComputePipeline,
}

impl Resolve {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[fetch(choices)]);
        let constants = constants_of(choices, &[Some(shader)]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
    }

    /// `eyes`: the picture of each, the left one's first.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        shaded: SampleColors<'_>,
        counters: &Buffer,
        eyes: &[&Image],
    ) -> Result<()> {
        let extent = eyes[0].description.extent;
        let traffic = Traffic {
            read_bytes: shaded.bytes(),
            written_bytes: eyes.iter().map(|color| color.description.bytes()).sum(),
            invocations: Some(eyes.len() as u64 * extent.pixel_count()),
        };
        cmd.pass(&full("resolve"), traffic, |cmd| {
            shaded.to_compute(cmd);
            cmd.barriers(eyes.iter().map(|color| color.discard(Access::ComputeWrite)));
            let mut counted = shaded.counted();
            for (eye, color) in (0..).zip(eyes) {
                cmd.barriers([counters.from(counted).to(Access::ComputeWrite)]);
                counted = Access::ComputeWrite;
                let mut bound = bound.to_vec();
                bound.extend(shaded.bound());
                bound.extend([("Counters", Bound::Buffer(counters)), ("color", Bound::Storage(color))]);
                let params = ResolveParams { eye };
                let groups = self.pipeline.groups([extent.width, extent.height, 1]);
                let own = self.pipeline.interface.own(&bound);
                cmd.dispatch(&self.pipeline, bytemuck::bytes_of(&params), &own, groups)?;
            }
            Ok(())
        })
    }
}

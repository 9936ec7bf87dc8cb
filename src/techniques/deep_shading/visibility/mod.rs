//! Visibility: which triangle each sample sees, and where it is in shading space (Clarberg & Munkberg 2014, section 4.2).
//! reads   the scene, the tuples
//! writes  visibility.spids, visibility.depth and, with `--zmax on`, visibility.shading_depths: arrays of a layer a tuple,
//!         of a table's part of the frame: 8, 4 and 4 B a sample
//!
//! `repeat-frame`: layer by layer, each with all draws. `stochastic`: the same with a polygon around each triangle's blur, whose
//! samples a shader tests.

pub mod sample;
pub mod stochastic;

use super::choices::Choices;
use super::plan::{DEPTH, SHADING_DEPTHS, SPIDS};
use super::primitives::Primitives;
use super::tuples::Table;
use super::{NAME, full};
use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Gpu, Image, Layers, Traffic};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::units::Extent;
use ash::vk;
use sample::Sample;
use std::sync::Arc;

/// One entry a sample.
pub struct Samples {
    pub spids: Image,
    pub depth: Image,
    /// With `--zmax on`.
    shading_depths: Option<Image>,
    /// Texels are fetched: it only has to be there.
    nearest: Sampler,
}

impl Samples {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        Ok(Self {
            spids: resources.image(&full(SPIDS)),
            depth: resources.image(&full(DEPTH)),
            shading_depths: choices.has_zmax.then(|| resources.image(&full(SHADING_DEPTHS))),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
        })
    }

    pub fn sampled<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, access)
    }

    pub fn shading_depths(&self) -> Option<&Image> {
        self.shading_depths.as_ref()
    }

    fn bytes(&self) -> u64 {
        let images = [Some(&self.spids), Some(&self.depth), self.shading_depths.as_ref()];
        images.into_iter().flatten().map(|image| image.description.bytes()).sum()
    }
}

/// Draws every tuple into its layer: what of it is in the frame.
#[allow(clippy::too_many_arguments)]
pub fn record(
    cmd: &mut Commands,
    sample: &Sample,
    scene: &SceneGpu,
    list: &DrawList,
    primitives: &Primitives,
    bound: &[(&'static str, Bound<'_>)],
    samples: &Samples,
    counters: &Buffer,
    (table, frame): (&Table, Extent),
) -> Result<()> {
    let layers = samples.spids.description.layers();
    let traffic = Traffic {
        read_bytes: u64::from(layers) * mesh::read_bytes(scene, list.calls()),
        written_bytes: samples.bytes(),
        invocations: None,
    };
    cmd.pass(&format!("{NAME}.visibility"), traffic, |cmd| {
        let colors: Vec<&Image> = [Some(&samples.spids), samples.shading_depths()].into_iter().flatten().collect();
        cmd.barriers(colors.iter().map(|image| image.discard(Access::ColorWrite)));
        cmd.barriers([samples.depth.discard(Access::DepthWrite)]);
        cmd.barriers([counters.discard(Access::TransferWrite)]);
        cmd.clear(counters);
        cmd.barriers([counters.from(Access::TransferWrite).to(Access::FragmentWrite)]);
        let mut bound = bound.to_vec();
        bound.push(("Counters", Bound::Buffer(counters)));
        let sets = sample.sets(cmd, &bound)?;
        // No triangle; and the depth of nothing, which no list hears of.
        let cleared = Some(vk::ClearColorValue { uint32: [u32::MAX; 4] });
        for tuple in 0..layers {
            let targets: Vec<_> = colors.iter().map(|image| ColorTarget::new(image, cleared)).collect();
            let depth = (&samples.depth, Some(0.0), Access::DepthWrite);
            cmd.begin_layers(samples.spids.description.extent, Layers::One(tuple), &targets, Some(depth));
            cmd.set_scissor([0, 0], table.inside(frame, tuple));
            sample.draw(cmd, scene, list, primitives, &sets, tuple);
            cmd.end_rendering();
        }
        Ok(())
    })
}

//! Combine: the samples of a member into the pixels that they lie in (section 3.1). Shaders: combine.comp, and with `--members
//! stipple` combine.frag.
//! reads   the member's picture      writes  combine.sums  buffer, 16 B a pixel, kept from member to member
//!
//! Why two ways: the paper draws a polygon over the whole frame for each member, behind a mask of its pixels. A thread for each
//! sample touches those pixels alone, in the same order; of several members at once a thread for each pixel does, member by member. No two samples of a member lie in one pixel, unless a side of the basis
//! is shorter than a pixel, which is refused.

use super::members::{Drawing, Members};
use super::resources::{DRAWN, NAME, SUMS};
use super::table::Table;
use crate::error::Result;
use crate::gpu::pipeline::{ComputePipeline, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::techniques::interleaved_sampling::combine::{COMP_VARIANTS, FRAG};
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::fullscreen;
use crate::plan::{Plan, Resources};
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// Four floats.
const SUM_BYTES: u64 = 16;
const TEXEL_BYTES: u64 = 16;

/// Plans what it writes.
pub fn plan(plan: &mut Plan, frame: Extent) {
    plan.buffer("combine", SUMS, frame.pixel_count() * SUM_BYTES);
}

/// The pass, after those that draw a member.
pub fn plan_pass(plan: &mut Plan, drawing: Drawing) {
    plan.pass(format!("{NAME}.combine"), [(DRAWN.to_owned(), reads(drawing))]);
}

/// How the pass reads a member's picture.
pub fn reads(drawing: Drawing) -> Access {
    match drawing {
        Drawing::Layers | Drawing::Tuples => Access::ComputeRead,
        Drawing::Stipple => Access::FragmentSample,
        Drawing::SampleLocations => Access::ComputeSample,
    }
}

/// How a member's picture is used.
pub fn usage(drawing: Drawing) -> vk::ImageUsageFlags {
    match drawing {
        Drawing::Layers | Drawing::Tuples => vk::ImageUsageFlags::STORAGE,
        Drawing::Stipple | Drawing::SampleLocations => vk::ImageUsageFlags::SAMPLED,
    }
}

enum Way {
    Scattered(ComputePipeline),
    Stippled {
        polygon: GraphicsPipeline,
        sampler: Sampler,
    },
    /// Texels are fetched: the sampler only has to be there.
    Fetched {
        pipeline: ComputePipeline,
        sampler: Sampler,
    },
}

pub struct Combine {
    way: Way,
    frame: Extent,
    sums: Buffer,
}

impl Combine {
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, members: &Members, frame: Extent) -> Result<Self> {
        let scattered = |picture| -> Result<Way> {
            Ok(Way::Scattered(ComputePipeline::new(gpu, variant(COMP_VARIANTS, &[picture]), &[])?))
        };
        let way = match members.drawing() {
            Drawing::Layers => scattered("grid")?,
            Drawing::Tuples => scattered("frame")?,
            Drawing::Stipple => Way::Stippled {
                polygon: GraphicsPipeline::new(gpu, &fullscreen::description(&FRAG, &[]))?,
                sampler: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            },
            Drawing::SampleLocations => Way::Fetched {
                pipeline: ComputePipeline::new(gpu, variant(COMP_VARIANTS, &["samples"]), &[])?,
                sampler: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            },
        };
        Ok(Self { way, frame, sums: resources.buffer(SUMS) })
    }

    /// The sums as the pass leaves them.
    pub fn sums(&self) -> Edge<'_, Buffer> {
        self.sums.from(match self.way {
            Way::Scattered(_) | Way::Fetched { .. } => Access::ComputeWrite,
            Way::Stippled { .. } => Access::FragmentWrite,
        })
    }

    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, table: &Table, drawn: Edge<'_, Image>) -> Result<()> {
        let [across, down] = [table.params.grid_width, table.params.grid_height];
        let at_once = u64::from(table.params.members_at_once);
        let samples = u64::from(across) * u64::from(down) * at_once;
        let invocations = match self.way {
            Way::Scattered(_) => samples,
            Way::Stippled { .. } | Way::Fetched { .. } => self.frame.pixel_count(),
        };
        let traffic = Traffic {
            read_bytes: Some(samples * (TEXEL_BYTES + SUM_BYTES)),
            written_bytes: Some(samples * SUM_BYTES),
            invocations: Some(invocations),
        };
        let params = bytemuck::bytes_of(&table.params);
        let shared = [
            ("Frame", Bound::Buffer(frame)),
            ("Members", Bound::Buffer(&table.buffer)),
            ("Sums", Bound::Buffer(&self.sums)),
        ];
        cmd.pass(&format!("{NAME}.combine"), traffic, |cmd| match &self.way {
            Way::Scattered(pipeline) => {
                // The run before ended with a read: nothing of this one has touched the sums.
                cmd.barriers([drawn.to(Access::ComputeRead)]);
                cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::ComputeWrite)]);
                let bound = [&shared[..], &[("drawn", Bound::Storage(drawn.resource))]].concat();
                cmd.dispatch(pipeline, params, &bound, pipeline.groups([across, down, 1]))
            }
            Way::Fetched { pipeline, sampler } => {
                cmd.barriers([drawn.to(Access::ComputeSample)]);
                cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::ComputeWrite)]);
                let sampled = Bound::Sampled(drawn.resource, sampler.handle, Access::ComputeSample);
                let bound = [&shared[..], &[("drawn", sampled)]].concat();
                cmd.dispatch(pipeline, params, &bound, pipeline.groups([self.frame.width, self.frame.height, 1]))
            }
            Way::Stippled { polygon, sampler } => {
                cmd.barriers([drawn.to(Access::FragmentSample)]);
                cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::FragmentWrite)]);
                cmd.begin_rendering(self.frame, &[], None);
                let sampled = Bound::Sampled(drawn.resource, sampler.handle, Access::FragmentSample);
                let bound = [&shared[..], &[("drawn", sampled)]].concat();
                cmd.bind_graphics(polygon, params, &bound)?;
                fullscreen::draw(cmd, 0);
                cmd.end_rendering();
                Ok(())
            }
        })
    }
}

//! Primary rays of the host in place of rasterisation (Clarberg & Munkberg 2014, section 4.2, "Ray Tracing"): a tree of moving
//! triangles, walked for each sample, and what it meets brought into the layers.
//! reads  the scene on the host      writes  visibility.spids, visibility.shading_depths
//!
//! Differs from the paper: the tree is the project's own in place of Embree's; alpha is read from the finest texture level.
//! Sets of `--accumulate` are traced before the first frame, which the report's row `visibility.rays` times.

pub mod trace;
mod tree;

use super::super::choices::Choices;
use super::super::lists::direct::HostLists;
use super::super::primitives::Primitives;
use crate::error::{Error, Result};
use crate::gpu::{Access, Buffer, Commands, Image, Traffic};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Resources, Shape};
use crate::progress::Stage;
use crate::techniques::Inputs;
use crate::techniques::deep_shading::resources::{LINEAR_COUNT, NAME, full};
use crate::techniques::deep_shading::visibility::samples::{Samples, begin_counters};
use crate::units::Bytes;
use ash::vk::BufferUsageFlags;
use std::cell::RefCell;
use std::time::Instant;
use trace::{Hits, Spid, Tracer};

/// Host memory that the sets of a picture may take.
const MOST_HOST_BYTES: u64 = 4 << 30;

/// Bytes of a shading pixel: where its list begins, its first triangles, its depth.
const LIST_BYTES: u64 = 4 * (2 + LINEAR_COUNT);

const STAGED_SPIDS: &str = "visibility.rays.spids";
const STAGED_DEPTHS: &str = "visibility.rays.shading_depths";

/// Plans what the host writes for each run.
///
/// Errors: the host would hold too much (exit code 4).
pub fn plan(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let samples = choices.samples_of(inputs.view.extent);
    let listed = if choices.lists.is_direct { choices.space.extent.pixel_count() * LIST_BYTES } else { 0 };
    let bytes = samples * (size_of::<Spid>() + size_of::<u32>()) as u64 + listed;
    let most = MOST_HOST_BYTES / bytes;
    if most < u64::from(choices.run_count) {
        let (held, limit) = (Bytes(bytes * u64::from(choices.run_count)), Bytes(MOST_HOST_BYTES));
        let advice = match most {
            0 => "a smaller --size or --spp would fit".to_owned(),
            most => format!("--accumulate {most} fits; --visibility repeat-frame holds no sets"),
        };
        let sets = choices.run_count;
        let why = format!(
            "--visibility ray, --accumulate {sets}: the host would hold {held} of samples, and {limit} are its most"
        );
        return Err(Error::memory(why).within(NAME).note(advice));
    }
    if choices.lists.is_direct {
        return Ok(());
    }
    let mut staged = |name: &str, bytes: u64| {
        let flags = BufferUsageFlags::TRANSFER_SRC;
        plan.push("frame_buffer_upload", full(name), Shape::Buffer { bytes, flags, usage: Use::Upload });
    };
    staged(STAGED_SPIDS, samples * size_of::<Spid>() as u64);
    if choices.lists.has_zmax {
        staged(STAGED_DEPTHS, samples * size_of::<u32>() as u64);
    }
    Ok(())
}

/// What all sets of a picture see.
pub enum TracedSets {
    Samples(Vec<Hits>),
    /// With `--lists direct`.
    Lists(Vec<HostLists>),
}

pub struct TracedSamples {
    pub sets: TracedSets,
    pub time_ns: u64,
}

impl TracedSamples {
    /// Errors: more triangles than a tree is built over (exit code 2); Ctrl-C (130).
    pub fn new(inputs: &Inputs<'_>, choices: &Choices, primitives: &Primitives) -> Result<Self> {
        let started = Instant::now();
        let stage = Stage::counted("tracing rays", "sets of samples");
        let tracer = Tracer::new(inputs, choices, primitives)?;
        let traced = (0..choices.run_count).map(|run| {
            stage.reach(run.into(), choices.run_count.into());
            tracer.trace(run)
        });
        let sets = if choices.lists.is_direct {
            TracedSets::Lists(
                traced.map(|hits| Ok(HostLists::of(&hits?, choices, primitives.count))).collect::<Result<_>>()?,
            )
        } else {
            TracedSets::Samples(traced.collect::<Result<_>>()?)
        };
        Ok(Self { sets, time_ns: started.elapsed().as_nanos() as u64 })
    }
}

/// Results of the rays, on their way to the device.
pub struct Rays {
    sets: Vec<Hits>,
    /// Whole layers, as images hold them.
    spids: RefCell<Buffer>,
    shading_depths: Option<RefCell<Buffer>>,
}

impl Rays {
    pub fn new(resources: &mut Resources, choices: &Choices, sets: Vec<Hits>) -> Self {
        let mut staged = |name: &str| RefCell::new(resources.buffer(&full(name)));
        let spids = staged(STAGED_SPIDS);
        Self { sets, spids, shading_depths: choices.lists.has_zmax.then(|| staged(STAGED_DEPTHS)) }
    }

    /// Puts a run's set where the frame takes it from.
    pub fn stage(&self, run: u32) {
        let set = &self.sets[run as usize];
        self.spids.borrow_mut().mapped_mut().copy_from_slice(bytemuck::cast_slice(&set.spids));
        if let Some(staged) = &self.shading_depths {
            staged.borrow_mut().mapped_mut().copy_from_slice(bytemuck::cast_slice(&set.shading_depths));
        }
    }

    pub fn record(&self, cmd: &mut Commands, samples: &Samples, counters: &Buffer) -> Result<()> {
        let staged = [Some(&self.spids), self.shading_depths.as_ref()].into_iter().flatten();
        let pairs: Vec<(&RefCell<Buffer>, &Image)> = staged.zip(samples.colors()).collect();
        let bytes = pairs.iter().map(|(_, image)| image.description.bytes()).sum();
        let traffic = Traffic { read_bytes: Some(bytes), written_bytes: Some(bytes), invocations: None };
        cmd.pass(&full("visibility"), traffic, |cmd| {
            begin_counters(cmd, counters);
            cmd.barriers(pairs.iter().map(|(_, image)| image.discard(Access::TransferWrite)));
            pairs.iter().for_each(|(staged, image)| cmd.copy_to_image(&staged.borrow(), image));
            Ok(())
        })
    }
}

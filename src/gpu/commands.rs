//! Commands: a frame's command buffers, recorded by hand. The order of lines is the order of work.
//!
//! A frame is one command buffer, or one a pass (`Submits::PerPass`) so that each pass can be timed by the wall clock.
//! Debug builds track what touched each resource last and compare every barrier's left side with it.

use super::access::AccessSet;
use super::descriptors::{Bound, Descriptors};
use super::image::Image;
use super::marks::Marked;
use super::marks::noted::{Noted, Notes};
use super::marks::shape::Part;
use super::pipeline::GraphicsPipeline;
use super::places::SamplePlaces;
use super::statistics::Statistics;
use super::timing::{Clock, Timestamps};
use super::{Access, Buffer, Gpu};
use crate::error::{Error, Result};
use crate::gpu::barrier::{Barrier, Target};
use crate::gpu::interface::Interface;
use crate::units::Extent;
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

/// How a frame is submitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Submits {
    /// One submit for the frame: what a real frame does.
    One,
    /// One submit and fence for each pass, for its time.
    PerPass,
}

/// How a frame is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recording {
    pub submits: Submits,
    /// Whether the device counts what each pass does, which may cost time.
    pub has_statistics: bool,
    /// What a submit may take; a frame whose work is longer is cut where it can be (bands.rs). None: it is not. With statistics
    /// dispatches stay whole.
    pub limit: Option<Duration>,
}

impl From<Submits> for Recording {
    fn from(submits: Submits) -> Self {
        Self { submits, has_statistics: false, limit: None }
    }
}

/// What a pass moves, by arithmetic: the bytes that its invocations read and write in buffers and images. None of what arithmetic cannot
/// tell, such as nodes of a tree, texels that a triangle covers, lights that a tile has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Traffic {
    pub read_bytes: Option<u64>,
    pub written_bytes: Option<u64>,
    /// Invocations of its compute shader; None for draws.
    pub invocations: Option<u64>,
}

/// A named pass in a recorded frame.
#[derive(Clone, Debug)]
pub struct RecordedPass {
    pub name: String,
    pub traffic: Traffic,
}

/// A barrier's right side, and the pass that stated it.
#[derive(Clone, Copy, Debug)]
pub struct Touched {
    /// Index into the frame's passes.
    pub pass: usize,
    pub target: Target,
    pub access: Access,
}

/// A command buffer, which is never cut.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    pub buffer: vk::CommandBuffer,
    /// Index of the pass that it is of, or begins with.
    pub pass: usize,
}

/// A frame being recorded.
pub struct Commands {
    pub(super) gpu: Arc<Gpu>,
    pub(super) name: String,
    pub(super) submits: Submits,
    pub(super) limit: Option<Duration>,
    pool: vk::CommandPool,
    pub(super) pieces: Vec<Piece>,
    pub(super) descriptors: Descriptors,
    pub(super) passes: Vec<RecordedPass>,
    pub(super) timestamps: Option<Timestamps>,
    pub(super) statistics: Option<Statistics>,
    pub(super) truth: HashMap<Target, AccessSet>,
    touched: Vec<Touched>,
    heirs: Heirs,
    /// Touches without a shader.
    pub(super) notes: Notes,
    /// None: every sample lies where Vulkan's standard has it.
    pub(super) places: Option<SamplePlaces>,
}

/// For each resource that takes bytes over, the resources that had them before it in the frame.
pub type Heirs = HashMap<Target, Vec<Target>>;

/// Passes of one frame that can have timestamps and statistics.
const MAX_PASS_COUNT: u32 = 256;

impl Commands {
    /// Starts recording. `name` labels the command buffers. Statistics need a device that has them (`statistics::require`).
    pub fn begin(gpu: &Arc<Gpu>, name: &str, recording: impl Into<Recording>) -> Result<Self> {
        let Recording { submits, has_statistics, limit } = recording.into();
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family);
        // SAFETY: a live device and its queue family.
        let pool = unsafe { gpu.device.create_command_pool(&info, None) }
            .map_err(|result| Error::device(format!("creating the command pool of {name}: {result}")))?;
        let mut commands = Self {
            gpu: gpu.clone(),
            name: name.to_owned(),
            submits,
            limit,
            pool,
            pieces: Vec::new(),
            descriptors: Descriptors::new(gpu),
            passes: Vec::new(),
            timestamps: None,
            statistics: None,
            truth: HashMap::new(),
            touched: Vec::new(),
            heirs: Heirs::new(),
            notes: Notes::default(),
            places: None,
        };
        gpu.name(pool, name);
        if has_statistics {
            commands.statistics = Some(Statistics::new(gpu, MAX_PASS_COUNT)?);
        }
        commands.next_piece()?;
        if let Some(statistics) = &commands.statistics {
            statistics.reset(commands.buffer());
        }
        Ok(commands)
    }

    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The command buffer that is being recorded.
    pub fn buffer(&self) -> vk::CommandBuffer {
        self.pieces.last().expect("`begin` made the first").buffer
    }

    fn next_piece(&mut self) -> Result<()> {
        let device = &self.gpu.device;
        let fail = |result| Error::device(format!("recording commands: {result}"));
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
        // SAFETY: a live pool.
        let buffer = unsafe { device.allocate_command_buffers(&info) }.map_err(fail)?[0];
        // Runs of a frame may go in one submit, as many as the limit lets.
        let flags = match self.limit {
            Some(_) => vk::CommandBufferUsageFlags::SIMULTANEOUS_USE,
            None => vk::CommandBufferUsageFlags::empty(),
        };
        // SAFETY: fresh from the pool.
        unsafe { device.begin_command_buffer(buffer, &vk::CommandBufferBeginInfo::default().flags(flags)) }
            .map_err(fail)?;
        self.gpu.name(buffer, &format!("{}.{}", self.name, self.pieces.len()));
        self.pieces.push(Piece { buffer, pass: self.passes.len().saturating_sub(1) });
        Ok(())
    }

    pub(super) fn end_buffer(&self) -> Result<()> {
        // SAFETY: begun in `next_piece`.
        unsafe { self.gpu.device.end_command_buffer(self.buffer()) }
            .map_err(|result| Error::device(format!("recording commands: {result}")))
    }

    /// Records one pass under its name: debug label, timing, statistics, report row.
    pub fn pass(&mut self, name: &str, traffic: Traffic, record: impl FnOnce(&mut Self) -> Result<()>) -> Result<()> {
        let index = self.passes.len() as u32;
        assert!(index < MAX_PASS_COUNT, "{name}: more than {MAX_PASS_COUNT} passes in a frame");
        if index == 0 {
            self.make_timestamps()?;
        }
        self.passes.push(RecordedPass { name: name.to_owned(), traffic });
        self.notes.begin_pass();
        if index > 0 && (self.submits == Submits::PerPass || self.limit.is_some()) {
            self.end_buffer()?;
            self.next_piece()?;
        }
        self.gpu.label(self.buffer(), Some(name));
        if let Some(timestamps) = &self.timestamps {
            timestamps.write(self.buffer(), index, false);
        }
        if let Some(statistics) = &self.statistics {
            statistics.begin(self.buffer(), index);
        }
        record(self).map_err(|error| error.within(name))?;
        if self.gpu.marks.is_some() {
            // Marks are counted without barriers between them, and the host reads them when the pass has ended.
            self.wait_until(vk::PipelineStageFlags2::HOST, vk::AccessFlags2::HOST_READ);
        }
        if let Some(statistics) = &self.statistics {
            statistics.end(self.buffer(), index);
        }
        if let Some(timestamps) = &self.timestamps {
            timestamps.write(self.buffer(), index, true);
        }
        self.gpu.label(self.buffer(), None);
        Ok(())
    }

    /// Before the first pass, where anybody looks at them.
    fn make_timestamps(&mut self) -> Result<()> {
        if self.submits == Submits::PerPass || Clock::of(&self.gpu.caps) == Clock::Timestamps {
            self.timestamps = Timestamps::new(&self.gpu, MAX_PASS_COUNT)?;
        }
        if let Some(timestamps) = &self.timestamps {
            timestamps.reset(self.buffer());
        }
        Ok(())
    }

    /// One pipeline barrier for all of `barriers`; those that wait for nothing are left out.
    pub fn barriers(&mut self, barriers: impl IntoIterator<Item = Barrier>) {
        let mut memory = Vec::new();
        let mut buffers = Vec::new();
        let mut images = Vec::new();
        let places = self.places.as_ref().map(SamplePlaces::info);
        for barrier in barriers {
            self.check_left_side(&barrier);
            if barrier.takes_over() {
                memory.push(barrier.memory_barrier());
            }
            if barrier.is_needed() {
                match barrier.target {
                    Target::Buffer(buffer) => buffers.push(barrier.buffer_barrier(buffer)),
                    Target::Image(image, aspect) => images.push(barrier.image_barrier(image, aspect, places.as_ref())),
                }
            }
            let known = self.truth.entry(barrier.target).or_default();
            *known = known.after(barrier.to);
            if let Some(pass) = self.passes.len().checked_sub(1) {
                self.touched.push(Touched { pass, target: barrier.target, access: barrier.to });
            }
        }
        if buffers.is_empty() && images.is_empty() {
            return;
        }
        let info = vk::DependencyInfo::default()
            .memory_barriers(&memory)
            .buffer_memory_barriers(&buffers)
            .image_memory_barriers(&images);
        // SAFETY: the buffer is being recorded, outside rendering; the resources are alive.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.buffer(), &info) };
    }

    /// A touch without a shader. `marked`: of a resource; None where nobody counts.
    pub(super) fn note(&self, marked: &Option<Arc<Marked>>, writes: bool, part: Part) {
        if let (Some(marked), Some(pass)) = (marked, self.passes.len().checked_sub(1)) {
            self.notes.add(pass, Noted::Part { marked: marked.clone(), writes, part });
        }
    }

    /// All work that comes waits for all that was, and sees what it wrote.
    pub fn wait_for_all(&mut self) {
        self.wait_until(vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE);
    }

    /// The same for work at more `stages`, with their `accesses`: those of the host.
    fn wait_until(&mut self, stages: vk::PipelineStageFlags2, accesses: vk::AccessFlags2) {
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let barrier = vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(all | stages)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE | accesses);
        let barriers = [barrier];
        let info = vk::DependencyInfo::default().memory_barriers(&barriers);
        // SAFETY: the buffer is being recorded, outside rendering.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.buffer(), &info) };
    }

    /// The passes recorded so far.
    pub fn passes(&self) -> &[RecordedPass] {
        &self.passes
    }

    /// What they touched, as their barriers say.
    pub fn touched(&self) -> &[Touched] {
        &self.touched
    }

    /// A barrier whose left side lies in an earlier submit: the caller vouches for it.
    pub(super) fn assume(&mut self, barrier: Barrier) {
        self.truth.insert(barrier.target, barrier.from);
        self.barriers([barrier]);
    }

    /// Tells whose bytes each resource takes over, for the check of left sides.
    pub fn set_heirs(&mut self, heirs: Heirs) {
        self.heirs = heirs;
    }

    /// A programmer's mistake: `record` names another writer than the last one, or the plan has none.
    fn check_left_side(&self, barrier: &Barrier) {
        if cfg!(debug_assertions) && barrier.discard {
            let touched = |target: &Target| self.truth.get(target).copied().unwrap_or_default();
            assert_eq!(touched(&barrier.target), AccessSet::UNTOUCHED, "a first touch that is the second");
            for before in self.heirs.get(&barrier.target).into_iter().flatten() {
                let left = touched(before);
                assert!(
                    barrier.from.contains(left),
                    "bytes are taken over from {:?}, and it was {left:?}",
                    barrier.from
                );
            }
        } else if cfg!(debug_assertions) {
            let truth = self.truth.get(&barrier.target).copied().unwrap_or_default();
            // Scene resources enter a frame readable: their first left side is what the upload left. A writer before the
            // first touch never was.
            let right = match truth {
                AccessSet::UNTOUCHED => barrier.from.iter().all(|access| !access.writes()),
                truth => barrier.from.contains(truth),
            };
            assert!(
                right,
                "a barrier to {:?} waits for {:?}, but the resource was last touched by {truth:?}",
                barrier.to, barrier.from
            );
        }
    }

    /// Writes a set for `interface` from what is bound by name, and binds it as set 0.
    fn bind(&mut self, point: vk::PipelineBindPoint, interface: &Interface, bound: &[(&str, Bound<'_>)]) -> Result<()> {
        let set = self.descriptors.set(interface, bound)?;
        self.bind_set(point, interface, set);
        Ok(())
    }

    /// Binds a set that was made for `interface` as set 0.
    pub(super) fn bind_set(&self, point: vk::PipelineBindPoint, interface: &Interface, set: Option<vk::DescriptorSet>) {
        let Some(set) = set else { return };
        if let Some(slots) = self.descriptors.slots(set) {
            if let Some(pass) = self.passes.len().checked_sub(1) {
                slots.unknown().iter().for_each(|name| self.notes.add(pass, Noted::Unknown(name.clone())));
            }
            self.notes.bind_slots(slots.clone());
        }
        // SAFETY: the buffer is being recorded; the set was made for this layout and outlives the recorded frame.
        unsafe {
            self.gpu.device.cmd_bind_descriptor_sets(self.buffer(), point, interface.layout, 0, &[set], &[]);
        }
    }

    /// Sets the push constants of what is bound, between its draws.
    pub fn push(&self, interface: &Interface, params: &[u8]) {
        let expected = interface.push_bytes as usize;
        assert!(
            params.len() >= expected && params.len() <= expected.next_multiple_of(16),
            "{}: {} bytes of params, {expected} expected",
            interface.label,
            params.len()
        );
        if expected > 0 {
            // SAFETY: the buffer is being recorded; the range is the layout's.
            unsafe {
                let (layout, stages) = (interface.layout, interface.push_stages);
                self.gpu.device.cmd_push_constants(self.buffer(), layout, stages, 0, &params[..expected]);
            }
        }
    }

    /// Goes on with the pass in another command buffer.
    pub(super) fn next_band(&mut self) -> Result<()> {
        self.gpu.label(self.buffer(), None);
        self.end_buffer()?;
        self.next_piece()?;
        self.gpu.label(self.buffer(), self.passes.last().map(|pass| pass.name.as_str()));
        Ok(())
    }

    /// Binds a graphics pipeline, inside rendering. Draws follow on `buffer()`.
    pub fn bind_graphics(
        &mut self,
        pipeline: &GraphicsPipeline,
        params: &[u8],
        bound: &[(&str, Bound<'_>)],
    ) -> Result<()> {
        // SAFETY: the buffer is being recorded and the pipeline outlives the recorded frame.
        unsafe {
            self.gpu.device.cmd_bind_pipeline(self.buffer(), vk::PipelineBindPoint::GRAPHICS, pipeline.handle());
        }
        self.bind(vk::PipelineBindPoint::GRAPHICS, &pipeline.interface, bound)?;
        self.push(&pipeline.interface, params);
        Ok(())
    }

    /// A set that can be bound for several draws whose pipelines take turns; None where the shaders bind nothing.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn set_for(
        &mut self,
        pipeline: &GraphicsPipeline,
        bound: &[(&str, Bound<'_>)],
    ) -> Result<Option<vk::DescriptorSet>> {
        self.descriptors.set(&pipeline.interface, bound)
    }

    /// Binds a graphics pipeline with a set of `set_for`, inside rendering.
    pub fn bind_with_set(&mut self, pipeline: &GraphicsPipeline, params: &[u8], set: Option<vk::DescriptorSet>) {
        let point = vk::PipelineBindPoint::GRAPHICS;
        // SAFETY: the buffer is being recorded; the pipeline outlives the recorded frame.
        unsafe { self.gpu.device.cmd_bind_pipeline(self.buffer(), point, pipeline.handle()) };
        self.bind_set(point, &pipeline.interface, set);
        self.push(&pipeline.interface, params);
    }

    /// What a stencil test compares with, and which bits a stencil write changes, for the draws that follow.
    pub fn set_stencil(&mut self, reference: u32, write_mask: u32) {
        let faces = vk::StencilFaceFlags::FRONT_AND_BACK;
        // SAFETY: the buffer is being recorded.
        unsafe {
            self.gpu.device.cmd_set_stencil_reference(self.buffer(), faces, reference);
            self.gpu.device.cmd_set_stencil_write_mask(self.buffer(), faces, write_mask);
        }
    }

    /// Sets all of a buffer to 0; its next access follows `TransferWrite`.
    pub fn clear(&mut self, target: &Buffer) {
        // SAFETY: the buffer is being recorded outside rendering; the caller stated the barriers.
        unsafe { self.gpu.device.cmd_fill_buffer(self.buffer(), target.handle, 0, vk::WHOLE_SIZE, 0) };
        self.note(&target.marked, true, Part::All);
    }

    /// Where the attachments hold what the clip volume holds, and which texels draws may touch, until the next rendering begins.
    pub fn set_window(&mut self, [x, y]: [u32; 2], extent: Extent) {
        let viewport = vk::Viewport {
            x: x as f32,
            y: y as f32,
            width: extent.width as f32,
            height: extent.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        };
        // SAFETY: the buffer is being recorded.
        unsafe { self.gpu.device.cmd_set_viewport(self.buffer(), 0, &[viewport]) };
        self.set_scissor([x, y], extent);
    }

    /// Which texels draws may touch, until the next rendering begins: `offset` and `extent`, in the attachments.
    pub fn set_scissor(&mut self, [x, y]: [u32; 2], extent: Extent) {
        let area = vk::Rect2D {
            offset: vk::Offset2D { x: x as i32, y: y as i32 },
            extent: vk::Extent2D { width: extent.width, height: extent.height },
        };
        // SAFETY: the buffer is being recorded.
        unsafe { self.gpu.device.cmd_set_scissor(self.buffer(), 0, &[area]) };
    }

    /// Copies level 0 of an image into a buffer whose rows are `row_pitch` texels apart; what lies between rows stays.
    pub fn copy_to_rows(&mut self, source: &Image, target: &Buffer, row_pitch: u32) {
        let extent = source.description.extent;
        let region = vk::BufferImageCopy::default()
            .buffer_row_length(row_pitch)
            .image_subresource(source.whole_level(0))
            .image_extent(vk::Extent3D { width: extent.width, height: extent.height, depth: 1 });
        let layout = Access::TransferRead.layout();
        // SAFETY: the buffer is being recorded outside rendering; the caller stated the barriers and made the target as
        // long as the rows.
        unsafe {
            self.gpu.device.cmd_copy_image_to_buffer(self.buffer(), source.handle, layout, target.handle, &[region]);
        }
        self.note(&source.marked, false, Part::Layers(0..source.description.layers()));
        let texel_bytes = u64::from(super::image::texel_bytes(source.description.format));
        for row in 0..u64::from(extent.height) {
            let begin = row * u64::from(row_pitch) * texel_bytes;
            self.note(&target.marked, true, Part::Bytes(begin..begin + u64::from(extent.width) * texel_bytes));
        }
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        // SAFETY: nothing recorded here is running: `Recorded` waits for its fences.
        unsafe {
            self.gpu.device.destroy_command_pool(self.pool, None);
        }
    }
}

//! Marks of what a frame reads and writes, by its shaders themselves: a buffer that they mark granules in, and whose marks are where.
//! Shader: marks.comp.
//!
//! The buffer has four parts: slots of descriptor sets, buffers that are reached by their addresses, invocations, and a record a
//! resource.
//! What no shader does (copies, clears, attachments, indices) is noted while it is recorded (`noted`).

pub mod counted;
pub mod noted;
mod sampling;
pub mod shape;

use super::description::VertexBuffer;
use super::shader::gpu::marks::{
    COMP_BOTH, COMP_OWN, MARK_ADDRESS_WORDS, MARK_ADDRESSES, MARK_COUNTS, MARK_INVOCATIONS, MARK_MOST_ADDRESSES,
    MARK_SLOT_WORDS, MARK_SLOTS,
};
use super::shader::structs::MarkSlotBlock;
use super::shader::{Shader, Stage};
use crate::error::{Error, Result};
use crate::memory::kinds::Use;
use crate::memory::suballocate::{Suballocate, Tlsf};
use crate::memory::{Allocation, Memory, Request, Tiling};
use crate::spirv::counting::{self, Attribute, Counters, FIRST_BINDING, FIRST_STREAM};
use crate::units::Bytes;
use ash::vk;
use ash::vk::Handle;
use counted::FrameTouches;
use sampling::Sampling;
use shape::{Part, Shape, Texels};
use std::collections::{BTreeMap, HashMap};
use std::ptr::NonNull;
use std::sync::{Arc, Mutex, MutexGuard};

/// Name of the buffer in ledgers. It is none of a frame's, and in no table of what one takes.
pub const NAME: &str = "marks";
/// Binding of the marks, in set 0 and in a material's.
pub const BINDING: u32 = 63;
/// A set's slots begin at a multiple of this, the greatest that Vulkan lets a device ask for.
const SLOTS_ALIGNMENT_BYTES: u64 = 256;
const WORD_BYTES: u64 = 4;
const SLOTS_BYTES: u64 = MARK_ADDRESSES as u64 * WORD_BYTES;
/// Where records begin: behind buffers with addresses and the two words that count invocations.
const RECORDS: u64 = ((MARK_INVOCATIONS as u64 + 2) * WORD_BYTES).next_multiple_of(SLOTS_ALIGNMENT_BYTES);
const _: () = assert!(MARK_INVOCATIONS == MARK_ADDRESSES + 1 + MARK_MOST_ADDRESSES * MARK_ADDRESS_WORDS);
/// Room for marks of 5 GiB in lines.
const RECORDS_BYTES: u64 = 20 << 20;

/// The marks of a device.
pub struct Marks {
    device: ash::Device,
    /// Bytes of a piece.
    granule_bytes: u64,
    buffer: vk::Buffer,
    state: Mutex<State>,
}

struct State {
    /// None: the device is closed.
    allocation: Option<Allocation>,
    words: NonNull<u32>,
    slots: Tlsf,
    records: Tlsf,
    /// Resources that have a record, by its offset.
    live: BTreeMap<u64, (String, Shape)>,
    /// Buffers that shaders reach by addresses: address, bytes, record.
    addresses: Vec<(u64, u64, u64)>,
    samplers: HashMap<u64, Sampling>,
    touches: FrameTouches,
}

// SAFETY: the words lie in the allocation that the same struct keeps, and are read and written under its lock.
unsafe impl Send for State {}

/// A resource's record. It returns when the resource goes.
pub struct Marked {
    marks: Arc<Marks>,
    pub name: String,
    pub shape: Shape,
    record: u64,
}

/// The slots of a descriptor set. They return when nothing is recorded with the set any more.
pub struct Slots {
    marks: Arc<Marks>,
    begin: u64,
    count: u32,
    /// Resources that the set's shaders touch in a way that nobody counts.
    unknown: Vec<String>,
}

fn words_of(shape: &Shape) -> u64 {
    shape.granule_count().div_ceil(32)
}

fn record_bytes(shape: &Shape) -> u64 {
    (u64::from(MARK_COUNTS) + 2 * words_of(shape)) * WORD_BYTES
}

impl State {
    /// # Safety
    /// The device is not writing.
    unsafe fn all(&mut self) -> &mut [u32] {
        // SAFETY: mapped, of this length; the device writes it only before a fence that was waited for, as the caller says.
        unsafe {
            std::slice::from_raw_parts_mut(self.words.as_ptr(), ((RECORDS + RECORDS_BYTES) / WORD_BYTES) as usize)
        }
    }

    fn write(&mut self, offset_bytes: u64, words: &[u32]) {
        if self.allocation.is_none() {
            return;
        }
        let begin = (offset_bytes / WORD_BYTES) as usize;
        // SAFETY: slots and addresses are the host's, and are written before the frame that reads them is submitted.
        let all = unsafe { self.all() };
        all[begin..begin + words.len()].copy_from_slice(words);
    }

    fn write_addresses(&mut self) {
        let mut words = vec![self.addresses.len() as u32];
        for (address, bytes, record) in self.addresses.clone() {
            let shape = self.live[&record].1;
            let Shape::Buffer { granule_bytes, .. } = shape else { unreachable!("only buffers have addresses") };
            words.extend([address as u32, (address >> 32) as u32, bytes as u32, word_of(record)]);
            words.extend([words_of(&shape) as u32, granule_bytes.ilog2()]);
        }
        self.write(SLOTS_BYTES, &words);
    }
}

/// The binding of the marks in a set's layout.
pub fn layout_binding(stages: vk::ShaderStageFlags) -> vk::DescriptorSetLayoutBinding<'static> {
    vk::DescriptorSetLayoutBinding::default()
        .binding(BINDING)
        .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
        .descriptor_count(1)
        .stage_flags(stages)
}

/// Words from the beginning of all marks.
fn word_of(offset_bytes: u64) -> u32 {
    (offset_bytes / WORD_BYTES) as u32
}

impl Marks {
    /// Marks of pieces of `granule_bytes`, a power of two.
    ///
    /// Errors: memory (exit code 4).
    pub fn new(device: &ash::Device, memory: &Arc<Memory>, granule_bytes: u64) -> Result<Self> {
        let bytes = RECORDS + RECORDS_BYTES;
        let info = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::STORAGE_BUFFER);
        let fail = |result| Error::device(format!("creating the marks of what is touched: {result}"));
        // SAFETY: a live device; the info has no pointers.
        let buffer = unsafe { device.create_buffer(&info, None) }.map_err(fail)?;
        // SAFETY: the buffer was made from this device.
        let requirements = unsafe { device.get_buffer_memory_requirements(buffer) };
        let usage = Use::Readback;
        let request = Request { name: NAME, group: NAME, bytes, requirements, usage, tiling: Tiling::Linear };
        let bound = memory.allocate(&request).and_then(|allocation| {
            // SAFETY: fresh memory of an allowed type, in bounds, bound once.
            unsafe { device.bind_buffer_memory(buffer, allocation.handle, allocation.offset) }.map_err(fail)?;
            Ok(allocation)
        });
        let allocation = match bound {
            Ok(allocation) => allocation,
            Err(error) => {
                // SAFETY: never used.
                unsafe { device.destroy_buffer(buffer, None) };
                return Err(error);
            }
        };
        let words = allocation.mapped.expect("what is read back is mapped").cast::<u32>();
        let mut state = State {
            allocation: Some(allocation),
            words,
            slots: Tlsf::new(SLOTS_BYTES),
            records: Tlsf::new(RECORDS_BYTES),
            live: BTreeMap::new(),
            addresses: Vec::new(),
            samplers: HashMap::new(),
            touches: FrameTouches::default(),
        };
        // SAFETY: no command knows the buffer yet.
        unsafe { state.all() }.fill(0);
        Ok(Self { device: device.clone(), granule_bytes, buffer, state: Mutex::new(state) })
    }

    /// Gives the buffer back. Records and slots of what is still there are numbers from then on.
    ///
    /// # Safety
    /// The device is idle, and nothing more is recorded.
    pub unsafe fn close(&self) {
        // SAFETY: as the caller says; memory after handle.
        unsafe { self.device.destroy_buffer(self.buffer, None) };
        drop(self.state().allocation.take());
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// Bytes of a piece.
    pub fn granule_bytes(&self) -> u64 {
        self.granule_bytes
    }

    /// A record for a buffer.
    ///
    /// Errors: there is no room for so many marks (exit code 4).
    pub fn buffer(self: &Arc<Self>, name: &str, bytes: u64) -> Result<Arc<Marked>> {
        self.record(name, Shape::Buffer { bytes, granule_bytes: self.granule_bytes })
    }

    /// A record for an image.
    ///
    /// Errors: as `buffer`.
    pub fn image(self: &Arc<Self>, name: &str, texels: Texels) -> Result<Arc<Marked>> {
        self.record(name, Shape::Image(texels))
    }

    fn record(self: &Arc<Self>, name: &str, shape: Shape) -> Result<Arc<Marked>> {
        let mut state = self.state();
        let taken = state.records.take(record_bytes(&shape), SLOTS_ALIGNMENT_BYTES);
        let held: u64 = state.live.values().map(|(_, shape)| shape.bytes()).sum();
        let offset = taken.ok_or_else(|| {
            Error::memory(format!(
                "--touched: no room for the marks of {name} ({}) beside those of {}",
                Bytes(shape.bytes()),
                Bytes(held)
            ))
            .note("--touched page has 64 times the room that --touched line has")
        })?;
        let record = RECORDS + offset;
        // SAFETY: no command knows this record.
        let words = unsafe { state.all() };
        words[word_of(record) as usize..][..(record_bytes(&shape) / WORD_BYTES) as usize].fill(0);
        state.live.insert(record, (name.to_owned(), shape));
        Ok(Arc::new(Marked { marks: self.clone(), name: name.to_owned(), shape, record }))
    }

    /// Shaders will reach this buffer by its address.
    ///
    /// Errors: it shares bytes with another one, so that an address does not say which it is; it is longer than what shaders count
    /// in; or there are too many (exit code 2).
    pub fn at_address(&self, marked: &Marked, address: u64) -> Result<()> {
        let mut state = self.state();
        let bytes = marked.shape.bytes();
        let Marked { name, record, .. } = marked;
        let meets = |known: &&(u64, u64, u64)| known.0 < address + bytes && address < known.0 + known.1;
        match state.addresses.iter().find(meets) {
            Some((.., known)) if known == record => return Ok(()),
            Some((.., known)) => {
                let other = &state.live[known].0;
                let why =
                    format!("--touched: {name} and {other} share bytes, and shaders reach both by their addresses");
                return Err(Error::request(why).note("--alias off keeps them apart"));
            }
            None => {}
        }
        if bytes > u64::from(u32::MAX) || state.addresses.len() >= MARK_MOST_ADDRESSES as usize {
            return Err(Error::request(format!(
                "--touched: {name} ({}) is reached by its address: that is counted for up to {MARK_MOST_ADDRESSES} buffers of less than 4 GiB",
                Bytes(bytes)
            )));
        }
        state.addresses.push((address, bytes, *record));
        state.write_addresses();
        Ok(())
    }

    pub fn sampler(&self, handle: vk::Sampler, info: &vk::SamplerCreateInfo<'_>) {
        self.state().samplers.insert(handle.as_raw(), Sampling::of(info));
    }

    /// Room for the slots of a set, one a binding below `BINDING`, and those of vertex streams.
    ///
    /// Errors: there are more sets than slots for them (exit code 4).
    pub fn slots(self: &Arc<Self>, has_streams: bool) -> Result<Slots> {
        let count = if has_streams { FIRST_STREAM + MOST_STREAMS } else { FIRST_STREAM };
        let bytes = slots_bytes(count);
        let mut state = self.state();
        let begin = state.slots.take(bytes, SLOTS_ALIGNMENT_BYTES).ok_or_else(|| {
            Error::memory("--touched: materials and passes bind more descriptor sets than can be counted")
                .note(format!("there is room for about {}", SLOTS_BYTES / slots_bytes(FIRST_STREAM)))
        })?;
        let mut words = vec![0; (bytes / WORD_BYTES) as usize];
        words[0] = word_of(begin);
        state.write(begin, &words);
        Ok(Slots { marks: self.clone(), begin, count, unknown: Vec::new() })
    }

    /// The shader as it counts. `streams`: what its vertices are made of.
    ///
    /// Errors: something in its module cannot be followed (exit code 3).
    pub fn counting(&self, shader: &Shader, streams: &[VertexBuffer]) -> Result<Vec<u32>> {
        let attributes: Vec<Attribute> = streams
            .iter()
            .zip(0..)
            .filter(|_| shader.stage == Stage::Vertex)
            .flat_map(|(buffer, stream)| {
                let stride_bytes = buffer.stride_bytes;
                buffer.attributes.iter().map(move |(location, format, offset_bytes)| Attribute {
                    location: *location,
                    stream,
                    stride_bytes,
                    offset_bytes: *offset_bytes,
                    bytes: attribute_bytes(*format),
                })
            })
            .collect();
        let counters = Counters { own: &COMP_OWN.words(), both: &COMP_BOTH.words() };
        counting::counting(&shader.words(), &counters, &attributes)
            .map_err(|fault| Error::no_device(format!("--touched: {} cannot be counted: {fault}", shader.label())))
    }

    /// Forgets what was counted: a frame begins.
    pub fn begin_frame(&self) {
        self.state().touches = FrameTouches::default();
    }

    /// Takes the marks of a pass that has just ended, and clears them for the next one.
    pub(super) fn collect(&self, pass: &str) {
        let mut state = self.state();
        let live: Vec<(u64, String, Shape)> =
            state.live.iter().map(|(record, (name, shape))| (*record, name.clone(), *shape)).collect();
        let mut touches = std::mem::take(&mut state.touches);
        // SAFETY: as below.
        let invocations = unsafe { &mut state.all()[MARK_INVOCATIONS as usize..][..2] };
        let count = u64::from(invocations[0]) | u64::from(invocations[1]) << 32;
        invocations.fill(0);
        if count > 0 {
            touches.pass(pass).invocations += count;
        }
        for (record, name, shape) in live {
            let words = words_of(&shape) as usize;
            // SAFETY: the fence of the pass was waited for.
            let all = unsafe { state.all() };
            let own = &mut all[word_of(record) as usize..][..MARK_COUNTS as usize + 2 * words];
            if own[..MARK_COUNTS as usize].iter().all(|count| *count == 0) {
                continue;
            }
            let asked = |at: usize| u64::from(own[at]) | u64::from(own[at + 1]) << 32;
            let marks = &own[MARK_COUNTS as usize..];
            let touched = touches.pass(pass).of(&name, shape);
            touched.reads.add(&marks[..words], asked(0));
            touched.writes.add(&marks[words..], asked(2));
            own.fill(0);
        }
        state.touches = touches;
    }

    /// A pass has touched a part of a resource without a shader.
    pub(super) fn add(&self, pass: &str, marked: &Marked, writes: bool, part: &Part) {
        self.state().touches.pass(pass).of(&marked.name, marked.shape).add_part(writes, part);
    }

    /// A pass has touched a resource in a way that nobody counts.
    pub(super) fn add_unknown(&self, pass: &str, name: &str) {
        self.state().touches.pass(pass).unknown.insert(name.to_owned());
    }

    /// What was counted since the frame began.
    pub fn touches(&self) -> FrameTouches {
        self.state().touches.clone()
    }
}

/// The most streams that a draw binds.
const MOST_STREAMS: u32 = 3;

fn slots_bytes(count: u32) -> u64 {
    u64::from(MARK_SLOTS + count * MARK_SLOT_WORDS) * WORD_BYTES
}

fn attribute_bytes(format: vk::Format) -> u32 {
    match format {
        vk::Format::R32G32_SFLOAT => 8,
        vk::Format::R32G32B32_SFLOAT => 12,
        vk::Format::R32G32B32A32_SFLOAT => 16,
        other => panic!("no vertex of this program has {other:?}"),
    }
}

impl Drop for Marked {
    fn drop(&mut self) {
        let mut state = self.marks.state();
        state.live.remove(&self.record);
        state.records.give_back(self.record - RECORDS, record_bytes(&self.shape));
        let before = state.addresses.len();
        state.addresses.retain(|(.., record)| *record != self.record);
        if state.addresses.len() < before {
            state.write_addresses();
        }
    }
}

impl Drop for Slots {
    fn drop(&mut self) {
        self.marks.state().slots.give_back(self.begin, slots_bytes(self.count));
    }
}

impl Slots {
    /// What the set binds at `BINDING`: all marks from its slots on.
    fn info(&self) -> vk::DescriptorBufferInfo {
        vk::DescriptorBufferInfo::default().buffer(self.marks.buffer).offset(self.begin).range(vk::WHOLE_SIZE)
    }

    /// The set leads to an acceleration structure, which a driver reads as it likes.
    pub fn add_unknown(&mut self, name: &str) {
        self.unknown.push(name.to_owned());
    }

    pub fn unknown(&self) -> &[String] {
        &self.unknown
    }

    /// Writes them into their set.
    pub fn write_to(&self, device: &ash::Device, set: vk::DescriptorSet) {
        let info = [self.info()];
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(BINDING)
            .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
            .buffer_info(&info);
        // SAFETY: the set is fresh and of a layout with the binding; the marks outlive what is recorded with it.
        unsafe { device.update_descriptor_sets(&[write], &[]) };
    }

    /// A binding of the set leads to this resource. `sampler`: through which.
    pub fn set_binding(&self, binding: u32, marked: &Marked, sampler: Option<vk::Sampler>) {
        self.write(FIRST_BINDING + binding, marked, sampler);
    }

    /// A stream of the draws with this set.
    pub fn set_stream(&self, stream: u32, marked: &Marked) {
        // What was bound for other draws stays bound.
        if FIRST_STREAM + stream >= self.count {
            return;
        }
        self.write(FIRST_STREAM + stream, marked, None);
    }

    fn write(&self, slot: u32, marked: &Marked, sampler: Option<vk::Sampler>) {
        assert!(slot < self.count, "slot {slot} of {}", self.count);
        let mut state = self.marks.state();
        let sampling = sampler.and_then(|sampler| state.samplers.get(&sampler.as_raw()).copied());
        let Sampling { wraps, filters, levels: [least_level, most_level] } = sampling.unwrap_or_default();
        let common = MarkSlotBlock {
            record: word_of(marked.record),
            word_count: words_of(&marked.shape) as u32,
            wraps,
            filters,
            least_level,
            most_level,
            ..bytemuck::Zeroable::zeroed()
        };
        let block = match marked.shape {
            Shape::Buffer { bytes, granule_bytes } => MarkSlotBlock {
                // Shaders count in 32 bits; what they bind is shorter, and what they reach by its address is refused where it is longer.
                bytes: bytes.min(u64::from(u32::MAX)) as u32,
                granule: granule_bytes.ilog2(),
                ..common
            },
            Shape::Image(Texels {
                size: [width, height],
                layers,
                levels,
                samples,
                texel_bytes,
                block: [across, down],
            }) => {
                let granule = across | down << 8;
                MarkSlotBlock { bytes: texel_bytes, granule, width, height, layers, levels, samples, ..common }
            }
        };
        let offset = self.begin + u64::from(MARK_SLOTS + slot * MARK_SLOT_WORDS) * WORD_BYTES;
        let words: &[u32] = &bytemuck::bytes_of(&block)
            .chunks_exact(4)
            .map(|word| u32::from_ne_bytes([word[0], word[1], word[2], word[3]]))
            .collect::<Vec<_>>();
        state.write(offset, &words[..MARK_SLOT_WORDS as usize]);
    }
}

//! Direct insertion: the host puts each ray's hit into its list at once, and no SPIDs are kept (Clarberg & Munkberg
//! 2014, section 4.2, "Ray Tracing"; `--lists direct`). The lists are those that insertion on the device makes, in the
//! order that compaction gives them.
//! writes  lists.begins, lists.nodes, lists.linear, lists.zmax, lists.addresses, lists.marks, and of count.counters what the device
//!         would count of colours and strays; in places of colours entries that wait

use super::super::choices::{Choices, ListChoices};
use super::super::counters;
use super::super::visibility::ray::trace::{Hits, NONE, Spid};
use super::Lists;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::counters::{COUNTED_COLORS, COUNTED_CROWDED, COUNTED_STRAYS};
use crate::gpu::shader::techniques::deep_shading::entries::waiting::ENTRY_STRAY;
use crate::gpu::shader::techniques::deep_shading::lists::insert::LIST_MOST;
use crate::gpu::shader::techniques::deep_shading::space::NEAREST_DEPTH;
use crate::gpu::{Access, Buffer, Commands, Traffic};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Resources, Shape};
use crate::techniques::deep_shading::resources::{
    ADDRESSES, BEGINS, COLORS, COUNTERS, LINEAR, LINEAR_COUNT, MARKS, NODES, ZMAX, full,
};
use crate::units::Extent;
use ash::vk::BufferUsageFlags;
use rayon::prelude::*;
use std::cell::RefCell;

/// Among the parts of a set: it has two ends.
const COLORS_INDEX: usize = 2;

/// waiting.glsl's NO_ENTRY.
const NO_ENTRY: [u32; 2] = [NONE, 0];

/// A set's lists, as the device's buffers begin.
pub struct HostLists {
    begins: Vec<u32>,
    nodes: Vec<[u32; 2]>,
    /// In the places of nodes' colours, entries of waiting.glsl.
    entries: Vec<[u32; 2]>,
    /// The same of samples that no list has, from the buffer's end on.
    stray_entries: Vec<[u32; 2]>,
    linear: Vec<u32>,
    zmax: Vec<u32>,
    addresses: Vec<u32>,
    /// A bit for each triangle that stands in a list.
    marks: Vec<u32>,
    /// Strays that a list had no room for.
    crowded_count: usize,
}

/// A sample that is listed, and where.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    /// Index of a pixel of shading space, row by row.
    pixel: u32,
    primitive: u32,
    sample: u32,
}

impl HostLists {
    /// `primitive_count`: of the scene.
    pub fn of(hits: &Hits, choices: &Choices, primitive_count: u64) -> Self {
        Self::with(hits, choices.space.extent, primitive_count, choices.lists)
    }

    fn with(hits: &Hits, space: Extent, primitive_count: u64, choices: ListChoices) -> Self {
        let pixels = space.pixel_count() as usize;
        let ListChoices { is_compacted, has_zmax, has_marks, .. } = choices;
        let mut lists = Self {
            begins: vec![0; pixels],
            nodes: Vec::new(),
            entries: Vec::new(),
            stray_entries: Vec::new(),
            linear: vec![0; if is_compacted { pixels * LINEAR_COUNT as usize } else { 0 }],
            zmax: vec![NEAREST_DEPTH; if has_zmax { pixels } else { 0 }],
            addresses: vec![NONE; hits.spids.len()],
            marks: vec![0; if has_marks { primitive_count.div_ceil(32) as usize } else { 0 }],
            crowded_count: 0,
        };
        let mut entries = Vec::new();
        for (sample, spid) in hits.spids.iter().enumerate().filter(|(_, spid)| spid.primitive != NONE) {
            if spid.pixel == NONE {
                lists.push_stray(sample, *spid);
                continue;
            }
            let pixel = (spid.pixel >> 16) * space.width + (spid.pixel & 0xffff);
            if let Some(zmax) = lists.zmax.get_mut(pixel as usize) {
                *zmax = (*zmax).min(hits.shading_depths[sample]);
            }
            entries.push(Entry { pixel, primitive: spid.primitive, sample: sample as u32 });
        }
        entries.par_sort_unstable();
        for list in entries.chunk_by(|a, b| a.pixel == b.pixel) {
            lists.push(list, space, choices);
        }
        lists
    }

    fn push_stray(&mut self, sample: usize, spid: Spid) {
        let color = (self.addresses.len() - 1 - self.stray_entries.len()) as u32;
        self.addresses[sample] = color;
        self.stray_entries.push(match spid.pixel {
            NONE => [sample as u32, spid.primitive | ENTRY_STRAY],
            pixel => [pixel, spid.primitive],
        });
    }

    /// Samples of one shading pixel, by triangle.
    fn push(&mut self, list: &[Entry], space: Extent, choices: ListChoices) {
        let first = self.nodes.len() as u32;
        let pixel = list[0].pixel as usize;
        let packed = (list[0].pixel % space.width) | ((list[0].pixel / space.width) << 16);
        self.begins[pixel] = first + 1;
        for (length, of) in list.chunk_by(|a, b| a.primitive == b.primitive).enumerate() {
            if length >= LIST_MOST as usize {
                let spid = Spid { primitive: of[0].primitive, pixel: packed };
                of.iter().for_each(|entry| self.push_stray(entry.sample as usize, spid));
                self.crowded_count += of.len();
                continue;
            }
            if let Some(word) = self.marks.get_mut(of[0].primitive as usize / 32) {
                *word |= 1 << (of[0].primitive % 32);
            }
            let node = self.nodes.len() as u32;
            of.iter().for_each(|entry| self.addresses[entry.sample as usize] = node);
            // Pointers are one more than indices.
            self.nodes.push([of[0].primitive, node + 2]);
            self.entries.push(if choices.has_entries { [packed, of[0].primitive] } else { NO_ENTRY });
        }
        self.nodes.last_mut().expect("a list has a triangle")[1] = 0;
        if choices.is_compacted {
            let nodes = &mut self.nodes[first as usize..];
            let row = &mut self.linear[pixel * LINEAR_COUNT as usize..][..LINEAR_COUNT as usize];
            row.iter_mut().zip(&*nodes).for_each(|(id, node)| *id = node[0]);
            if let Some(end) = row.get_mut(nodes.len()) {
                *end = NONE;
            }
            // Its id lies in the row: the node carries where the list's colours begin, and the first of the linked rest.
            let has_rest = nodes.len() > LINEAR_COUNT as usize;
            nodes[0] = [first, if has_rest { first + LINEAR_COUNT as u32 + 1 } else { 0 }];
        }
    }

    /// What insertion and compaction on the device count of colours, and of samples that no list has.
    fn counters(&self) -> [u32; counters::COUNT as usize] {
        let mut words = [0; counters::COUNT as usize];
        words[COUNTED_COLORS as usize] = self.entries.len() as u32;
        words[COUNTED_STRAYS as usize] = self.stray_entries.len() as u32;
        words[COUNTED_CROWDED as usize] = self.crowded_count as u32;
        words
    }
}

/// Plans what the host writes for each run, beside one of the lists' buffers or the counters.
pub fn plan(plan: &mut Plan, name: &str, bytes: u64) {
    let shape = Shape::Buffer { bytes, flags: BufferUsageFlags::TRANSFER_SRC, usage: Use::Upload };
    plan.push("deep_shading_buffer_upload", staged_name(name), shape);
}

fn staged_name(name: &str) -> String {
    full(&format!("{name}.host"))
}

/// Lists on their way to the device.
pub struct HostInsertion {
    sets: Vec<HostLists>,
    /// Staging buffers of begins, nodes, colours and of all else that the host has made, in the order in which it is copied.
    staged: Vec<RefCell<Buffer>>,
}

impl HostInsertion {
    pub fn new(resources: &mut Resources, choices: &Choices, sets: Vec<HostLists>) -> Self {
        let names = [
            Some(BEGINS),
            Some(NODES),
            Some(COLORS),
            choices.lists.is_compacted.then_some(LINEAR),
            Some(ADDRESSES),
            choices.lists.has_zmax.then_some(ZMAX),
            choices.lists.has_marks.then_some(MARKS),
            Some(COUNTERS),
        ];
        let staged = names.into_iter().flatten().map(|name| RefCell::new(resources.buffer(&staged_name(name))));
        Self { sets, staged: staged.collect() }
    }

    /// Puts a run's lists where the frame takes them from.
    pub fn stage(&self, run: u32) {
        let set = &self.sets[run as usize];
        let HostLists { begins, nodes, entries, stray_entries, linear, zmax, addresses, marks, .. } = set;
        let [nodes, entries]: [&[u8]; 2] = [nodes, entries].map(|pairs| bytemuck::cast_slice(pairs));
        let counters = set.counters();
        let [begins, linear, addresses, zmax, marks, counters]: [&[u8]; 6] =
            [begins, linear, addresses, zmax, marks, &counters[..]].map(bytemuck::cast_slice);
        let parts = [begins, nodes, entries, linear, addresses, zmax, marks, counters].into_iter().enumerate();
        let parts = parts.filter(|(index, part)| *index <= COLORS_INDEX || !part.is_empty());
        for ((index, part), staged) in parts.zip(&self.staged) {
            let mut staged = staged.borrow_mut();
            let bytes = staged.mapped_mut();
            bytes[..part.len()].copy_from_slice(part);
            if index == COLORS_INDEX {
                // From the end on.
                let strays = bytes.chunks_exact_mut(size_of::<[u32; 2]>()).rev().zip(stray_entries);
                strays.for_each(|(bytes, entry)| bytes.copy_from_slice(bytemuck::bytes_of(entry)));
            }
        }
    }

    pub fn record(&self, cmd: &mut Commands, lists: &Lists, colors: &Buffer, counters: &Buffer) -> Result<()> {
        let others = [&lists.linear, &lists.addresses, &lists.zmax, &lists.marks];
        let copied =
            || [&lists.begins, &lists.nodes, colors].into_iter().chain(others.into_iter().flatten()).chain([counters]);
        let bytes = copied().map(|buffer| buffer.bytes).sum();
        let traffic = Traffic { read_bytes: Some(bytes), written_bytes: Some(bytes), invocations: None };
        cmd.pass(&full("lists"), traffic, |cmd| {
            cmd.barriers(copied().map(|buffer| buffer.discard(Access::TransferWrite)));
            copied().zip(&self.staged).for_each(|(buffer, staged)| cmd.copy_buffer(&staged.borrow(), buffer));
            // What follows waits for compute shaders, which make lists on the device.
            cmd.barriers(copied().map(|buffer| buffer.from(Access::TransferWrite).to(Access::ComputeWrite)));
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINKED: ListChoices = ListChoices {
        is_direct: true,
        has_entries: true,
        tolerates_duplicates: false,
        is_compacted: false,
        has_zmax: false,
        has_addresses: true,
        has_marks: false,
    };

    fn hits(spids: &[(u32, u32)]) -> Hits {
        let spids: Vec<Spid> =
            spids.iter().map(|(primitive, pixel)| Spid { primitive: *primitive, pixel: *pixel }).collect();
        Hits { shading_depths: (0..spids.len() as u32).collect(), spids }
    }

    #[test]
    fn a_triangle_is_listed_once_a_pixel_and_strays_are_marked() {
        let hits = hits(&[(7, 1), (NONE, NONE), (35, 1), (7, 1), (9, NONE), (35, 1 << 16)]);
        let lists =
            HostLists::with(&hits, Extent::new(2, 2), 40, ListChoices { has_zmax: true, has_marks: true, ..LINKED });
        assert_eq!(lists.begins, [0, 1, 3, 0]);
        assert_eq!(lists.nodes, [[7, 2], [35, 0], [35, 0]]);
        assert_eq!(lists.addresses, [0, NONE, 1, 0, 5, 2]);
        assert_eq!(lists.entries, [[1, 7], [1, 35], [1 << 16, 35]]);
        assert_eq!(lists.marks, [1 << 7, 1 << 3]);
        let counted = [COUNTED_STRAYS, COUNTED_CROWDED, COUNTED_COLORS].map(|word| lists.counters()[word as usize]);
        assert_eq!(counted, [1, 0, 3]);
        assert_eq!(
            (lists.stray_entries, lists.zmax),
            (vec![[4, 9 | ENTRY_STRAY]], vec![NEAREST_DEPTH, 0, 5, NEAREST_DEPTH])
        );
    }

    #[test]
    fn a_full_list_leaves_the_rest_to_be_shaded_alone() {
        let spids: Vec<(u32, u32)> = (0..1026).map(|primitive| (primitive, 1)).collect();
        let lists = HostLists::with(&hits(&spids), Extent::new(2, 1), 1026, LINKED);
        assert_eq!((lists.nodes.len(), lists.nodes[1023], lists.crowded_count), (1024, [1023, 0], 2));
        assert_eq!(lists.counters()[COUNTED_CROWDED as usize], 2);
        assert_eq!(lists.addresses[1023..], [1023, 1025, 1024]);
        assert_eq!(lists.stray_entries, [[1, 1024], [1, 1025]]);
    }

    #[test]
    fn a_row_holds_sixteen_and_the_rest_is_linked() {
        let spids: Vec<(u32, u32)> = (0..18).map(|primitive| (primitive, 0)).collect();
        let lists = HostLists::with(&hits(&spids), Extent::new(1, 1), 18, ListChoices { is_compacted: true, ..LINKED });
        assert_eq!((lists.begins[0], lists.nodes[0]), (1, [0, 17]));
        assert_eq!(lists.linear, (0..16).collect::<Vec<u32>>());
        assert_eq!(lists.nodes[16..], [[16, 18], [17, 0]]);
    }
}

//! Direct insertion: the host puts each ray's hit into its list at once, and no SPIDs are kept (Clarberg & Munkberg
//! 2014, section 4.2, "Ray Tracing"; `--lists direct`). The lists are those that insertion on the device makes, in the
//! order that compaction gives them.
//! writes  lists.begins, lists.nodes, lists.linear, lists.zmax, lists.addresses; begins alphas of colours at 0

use super::super::choices::Choices;
use super::super::visibility::ray::trace::{Hits, NONE, Spid};
use super::Lists;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::lists::insert::LIST_MOST;
use crate::gpu::shader::techniques::deep_shading::space::ADDRESS_STRAY;
use crate::gpu::{Access, Buffer, Commands, Traffic};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Resources, Shape};
use crate::techniques::deep_shading::resources::{ADDRESSES, BEGINS, LINEAR, LINEAR_COUNT, NODES, ZMAX, full};
use crate::units::Extent;
use ash::vk::BufferUsageFlags;
use rayon::prelude::*;
use std::cell::{Cell, RefCell};

/// Among the parts of a set.
const NODES_INDEX: usize = 1;

/// A set's lists, as the device's buffers begin.
pub struct HostLists {
    begins: Vec<u32>,
    nodes: Vec<[u32; 2]>,
    /// What samples see that no list has: SPIDs, from the buffer's end on.
    stray_nodes: Vec<[u32; 2]>,
    linear: Vec<u32>,
    zmax: Vec<u32>,
    addresses: Vec<u32>,
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
    pub fn of(hits: &Hits, choices: &Choices) -> Self {
        Self::with(hits, choices.space.extent, choices.lists.is_compacted, choices.lists.has_zmax)
    }

    fn with(hits: &Hits, space: Extent, is_compacted: bool, has_zmax: bool) -> Self {
        let pixels = space.pixel_count() as usize;
        let mut lists = Self {
            begins: vec![0; pixels],
            nodes: Vec::new(),
            stray_nodes: Vec::new(),
            linear: vec![0; if is_compacted { pixels * LINEAR_COUNT as usize } else { 0 }],
            zmax: vec![0; if has_zmax { pixels } else { 0 }],
            addresses: vec![NONE; hits.spids.len()],
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
                *zmax = (*zmax).max(hits.shading_depths[sample]);
            }
            entries.push(Entry { pixel, primitive: spid.primitive, sample: sample as u32 });
        }
        entries.par_sort_unstable();
        for list in entries.chunk_by(|a, b| a.pixel == b.pixel) {
            lists.push(list, space, is_compacted);
        }
        lists
    }

    fn push_stray(&mut self, sample: usize, spid: Spid) {
        let color = (self.addresses.len() - 1 - self.stray_nodes.len()) as u32;
        self.addresses[sample] = color | ADDRESS_STRAY;
        self.stray_nodes.push([spid.primitive, spid.pixel]);
    }

    /// Samples of one shading pixel, by triangle.
    fn push(&mut self, list: &[Entry], space: Extent, is_compacted: bool) {
        let first = self.nodes.len() as u32;
        let pixel = list[0].pixel as usize;
        self.begins[pixel] = first + 1;
        for (length, of) in list.chunk_by(|a, b| a.primitive == b.primitive).enumerate() {
            if length >= LIST_MOST as usize {
                let packed = (list[0].pixel % space.width) | ((list[0].pixel / space.width) << 16);
                let spid = Spid { primitive: of[0].primitive, pixel: packed };
                of.iter().for_each(|entry| self.push_stray(entry.sample as usize, spid));
                self.crowded_count += of.len();
                continue;
            }
            let node = self.nodes.len() as u32;
            of.iter().for_each(|entry| self.addresses[entry.sample as usize] = node);
            // Pointers are one more than indices.
            self.nodes.push([of[0].primitive, node + 2]);
        }
        self.nodes.last_mut().expect("a list has a triangle")[1] = 0;
        if is_compacted {
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
}

/// Plans what the host writes for each run, beside one of the lists' buffers.
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
    /// Staging buffers of the buffers in `Lists::all`, in that order.
    staged: Vec<RefCell<Buffer>>,
    staged_run: Cell<u32>,
}

impl HostInsertion {
    pub fn new(resources: &mut Resources, choices: &Choices, sets: Vec<HostLists>) -> Self {
        let names = [
            Some(BEGINS),
            Some(NODES),
            choices.lists.is_compacted.then_some(LINEAR),
            Some(ADDRESSES),
            choices.lists.has_zmax.then_some(ZMAX),
        ];
        let staged = names.into_iter().flatten().map(|name| RefCell::new(resources.buffer(&staged_name(name))));
        Self { sets, staged: staged.collect(), staged_run: Cell::new(0) }
    }

    /// Puts a run's lists where the frame takes them from.
    pub fn stage(&self, run: u32) {
        self.staged_run.set(run);
        let HostLists { begins, nodes, stray_nodes, linear, zmax, addresses, .. } = &self.sets[run as usize];
        let nodes: &[u8] = bytemuck::cast_slice(nodes);
        let [begins, linear, addresses, zmax]: [&[u8]; 4] =
            [begins, linear, addresses, zmax].map(|words| bytemuck::cast_slice(words));
        let parts = [begins, nodes, linear, addresses, zmax].into_iter().enumerate();
        let parts = parts.filter(|(index, part)| *index == NODES_INDEX || !part.is_empty());
        for ((index, part), staged) in parts.zip(&self.staged) {
            let mut staged = staged.borrow_mut();
            let bytes = staged.mapped_mut();
            bytes[..part.len()].copy_from_slice(part);
            if index == NODES_INDEX {
                // From the end on.
                let strays = bytes.chunks_exact_mut(size_of::<[u32; 2]>()).rev().zip(stray_nodes);
                strays.for_each(|(bytes, node)| bytes.copy_from_slice(bytemuck::bytes_of(node)));
            }
        }
    }

    /// What insertion on the device counts of samples that no list has, of the last run.
    pub fn stray_counts(&self) -> [(&'static str, f64); 2] {
        let HostLists { stray_nodes, crowded_count, .. } = &self.sets[self.staged_run.get() as usize];
        let outside = stray_nodes.len() - crowded_count;
        [("samples_outside_shading_space", outside as f64), ("samples_of_full_lists", *crowded_count as f64)]
    }

    pub fn record(&self, cmd: &mut Commands, lists: &Lists, colors: &Buffer, counters: &Buffer) -> Result<()> {
        let bytes = lists.all().map(|buffer| buffer.bytes).sum();
        let traffic = Traffic { read_bytes: bytes, written_bytes: bytes + colors.bytes, invocations: None };
        cmd.pass(&full("lists"), traffic, |cmd| {
            let all = || lists.all().chain([colors, counters]);
            cmd.barriers(all().map(|buffer| buffer.discard(Access::TransferWrite)));
            lists.all().zip(&self.staged).for_each(|(buffer, staged)| cmd.copy_buffer(&staged.borrow(), buffer));
            cmd.clear(colors);
            cmd.clear(counters);
            // What follows waits for compute shaders, which make lists on the device.
            cmd.barriers(all().map(|buffer| buffer.from(Access::TransferWrite).to(Access::ComputeWrite)));
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hits(spids: &[(u32, u32)]) -> Hits {
        let spids: Vec<Spid> =
            spids.iter().map(|(primitive, pixel)| Spid { primitive: *primitive, pixel: *pixel }).collect();
        Hits { shading_depths: (0..spids.len() as u32).collect(), spids }
    }

    #[test]
    fn a_triangle_is_listed_once_a_pixel_and_strays_are_marked() {
        let hits = hits(&[(7, 1), (NONE, NONE), (3, 1), (7, 1), (9, NONE), (3, 1 << 16)]);
        let lists = HostLists::with(&hits, Extent::new(2, 2), false, true);
        assert_eq!(lists.begins, [0, 1, 3, 0]);
        assert_eq!(lists.nodes, [[3, 2], [7, 0], [3, 0]]);
        assert_eq!(lists.addresses, [1, NONE, 0, 1, 5 | ADDRESS_STRAY, 2]);
        assert_eq!((lists.stray_nodes, lists.zmax), (vec![[9, NONE]], vec![0, 3, 5, 0]));
    }

    #[test]
    fn a_full_list_leaves_the_rest_to_be_shaded_alone() {
        let spids: Vec<(u32, u32)> = (0..1026).map(|primitive| (primitive, 1)).collect();
        let lists = HostLists::with(&hits(&spids), Extent::new(2, 1), false, false);
        assert_eq!((lists.nodes.len(), lists.nodes[1023], lists.crowded_count), (1024, [1023, 0], 2));
        assert_eq!(lists.addresses[1023..], [1023, 1025 | ADDRESS_STRAY, 1024 | ADDRESS_STRAY]);
        assert_eq!(lists.stray_nodes, [[1024, 1], [1025, 1]]);
    }

    #[test]
    fn a_row_holds_sixteen_and_the_rest_is_linked() {
        let spids: Vec<(u32, u32)> = (0..18).map(|primitive| (primitive, 0)).collect();
        let lists = HostLists::with(&hits(&spids), Extent::new(1, 1), true, false);
        assert_eq!((lists.begins[0], lists.nodes[0]), (1, [0, 17]));
        assert_eq!(lists.linear, (0..16).collect::<Vec<u32>>());
        assert_eq!(lists.nodes[16..], [[16, 18], [17, 0]]);
    }
}

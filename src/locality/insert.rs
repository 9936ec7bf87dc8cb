//! List insertion of deep shading as a kernel: what a sample reads and writes to put its triangle into the list of its shading pixel.
//! Mirrors glsl/techniques/deep_shading/lists/insert.comp, with the lists as the defaults have them: compacted later, shaded by entries,
//! with addresses, neither depths nor marks.
//!
//! What a list holds when a sample comes is data: here samples come one after the other in the order of their threads. So no
//! compare-exchange is lost, which on a device happens where threads are at one list at once.

use super::access::{Access, Kernel};
use super::frame::{Resource, Space};
use super::layout::Layout;
use super::machine::Machine;
use super::spids::{GUARD_PX, Spids};
use super::stage::{PassCounts, StageKind, Studied, check_sides};
use crate::error::{Error, Result};
use crate::gpu::shader::Side;
use crate::gpu::shader::techniques::deep_shading::counters::{COUNTED_CROWDED, COUNTED_STRAYS};
use crate::gpu::shader::techniques::deep_shading::lists::insert::{COMP_VARIANTS, LIST_MOST};
use crate::gpu::shader::techniques::deep_shading::space::{NO_PRIMITIVE, NO_SHADING_PIXEL};
use crate::techniques::deep_shading::resources::{ADDRESS_BYTES, BEGIN_BYTES, COLOR_BYTES, NODE_BYTES};
use crate::techniques::deep_shading::tuples::TupleTable;
use crate::units::Extent;

/// Samples at most: the host keeps 20 bytes of each.
const MOST_SAMPLES: u64 = 1 << 26;

/// Bytes of a counter.
const COUNTER_BYTES: usize = 4;

/// An insertion that is studied.
#[derive(Clone, Debug)]
pub struct InsertCase {
    pub extent: Extent,
    /// Samples a pixel, 1 to 64.
    pub samples: u32,
    /// Tuples that they share, a multiple of the samples up to 2048.
    pub tuples: u32,
    /// Legs of the plane's triangles, px: 1 to 1024.
    pub triangle_px: u32,
    /// Radius of its circle of confusion, px: 0 to `GUARD_PX`.
    pub blur_px: f64,
}

impl InsertCase {
    /// Errors: a number is out of range, or there are too many samples (exit code 2).
    pub fn checked(self) -> Result<Self> {
        let Self { extent, samples, tuples, triangle_px, blur_px } = self;
        check_sides(extent, [1; 2], [1; 2], [1; 2])?;
        if !(1..=64).contains(&samples) || !(1..=2048).contains(&tuples) || !tuples.is_multiple_of(samples) {
            return Err(Error::request(format!(
                "spp={samples} tuples={tuples}: there are 1 to 64 samples a pixel, and tuples are a multiple of them up to 2048"
            )));
        }
        if !(1..=1024).contains(&triangle_px) || !(0.0..=f64::from(GUARD_PX)).contains(&blur_px) {
            return Err(Error::request(format!(
                "triangle={triangle_px} blur={blur_px}: legs of triangles are 1 to 1024 px, a blur's radius is 0 to {GUARD_PX} px"
            )));
        }
        let count = self.table().sample_count(extent);
        if count > MOST_SAMPLES {
            return Err(Error::request(format!(
                "size={extent} spp={samples} tuples={tuples}: {count} samples, of which {MOST_SAMPLES} are studied at most"
            )));
        }
        Ok(self)
    }

    fn table(&self) -> TupleTable {
        TupleTable::new(self.samples, self.tuples)
    }
}

impl Studied for InsertCase {
    fn stage(&self) -> StageKind {
        StageKind::Insert
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![
            ("spp", self.samples.to_string()),
            ("tuples", self.tuples.to_string()),
            ("triangle", self.triangle_px.to_string()),
            ("blur", self.blur_px.to_string()),
        ]
    }

    fn extent(&self) -> Extent {
        self.extent
    }

    fn workgroup(&self) -> [u32; 2] {
        group_size()
    }

    fn counted(&self, machine: &Machine) -> Vec<PassCounts> {
        let spids = Spids::of_plane(self.extent, &self.table(), self.triangle_px, self.blur_px);
        let insert = Insert::new(spids, machine.layout(), machine.warp[0] * machine.warp[1]);
        vec![PassCounts::of("lists", &insert, machine)]
    }
}

/// Invocations of a workgroup, as the shader has them.
fn group_size() -> [u32; 2] {
    match COMP_VARIANTS[0].workgroup {
        [Side::Fixed(across), Side::Fixed(down), _] => [across, down],
        _ => unreachable!("insert.comp says its workgroup"),
    }
}

/// The memory of an insertion.
pub struct InsertMemory {
    /// An image with a layer a tuple.
    pub spids: Resource,
    pub begins: Resource,
    pub nodes: Resource,
    pub colors: Resource,
    pub addresses: Resource,
    pub counters: Resource,
}

/// An insertion of samples into lists.
pub struct Insert {
    spids: Spids,
    pub memory: InsertMemory,
    /// Where each sample's list began when it came.
    heads: Vec<u32>,
    /// Each sample's node: triangle, and the node after it; a stray's says where its colour is.
    nodes: Vec<[u32; 2]>,
    /// Threads of a warp, which follow each other in a row.
    lanes: u32,
    warps: Vec<Warp>,
}

/// What some thread of a warp does, so that the others wait for it.
#[derive(Clone, Copy, Default)]
struct Warp {
    /// Nodes that it reads at most.
    longest: u32,
    inserts: bool,
    has_strays: bool,
}

/// A sample's walk through its list.
struct Walk {
    /// Indices of nodes that it reads.
    read: Vec<u32>,
    /// What becomes of its triangle.
    end: End,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    /// The last node that was read holds it.
    Found,
    /// Its own node will.
    Inserted,
    /// The list is full.
    Crowded,
}

impl Insert {
    /// `lanes`: threads of a warp.
    pub fn new(spids: Spids, layout: Layout, lanes: u32) -> Self {
        let samples = spids.words.len();
        let mut space = Space::default();
        let [begin, node, color, address] =
            [BEGIN_BYTES, NODE_BYTES, COLOR_BYTES, ADDRESS_BYTES].map(|bytes| bytes as usize);
        let memory = InsertMemory {
            spids: space.layers(layout, spids.layer, spids.layer_count()),
            begins: space.entries(spids.space.pixel_count(), begin),
            nodes: space.entries(samples as u64, node),
            colors: space.entries(samples as u64, color),
            addresses: space.entries(samples as u64, address),
            counters: space.entries(u64::from(COUNTED_CROWDED.max(COUNTED_STRAYS)) + 1, COUNTER_BYTES),
        };
        let (heads, nodes) = (vec![0; samples], vec![[0; 2]; samples]);
        let mut insert = Self { spids, memory, heads, nodes, lanes, warps: Vec::new() };
        let [_, rows, layers] = insert.groups();
        insert.warps = vec![Warp::default(); (insert.warps_a_row() * rows * layers) as usize];
        insert.run();
        insert
    }

    /// Inserts one sample after the other.
    fn run(&mut self) {
        let mut begins = vec![0; self.spids.space.pixel_count() as usize];
        let mut strays = 0;
        for own in 0..self.spids.words.len() as u32 {
            let [primitive, packed] = self.spids.words[own as usize];
            if primitive == NO_PRIMITIVE {
                continue;
            }
            let mut is_stray = packed == NO_SHADING_PIXEL;
            if let Some(pixel) = self.shading_pixel(packed) {
                let head = begins[pixel as usize];
                self.heads[own as usize] = head;
                let walk = self.walk(head, primitive);
                let warp = self.warp_of(own);
                self.warps[warp].longest = self.warps[warp].longest.max(walk.read.len() as u32);
                self.warps[warp].inserts |= walk.end == End::Inserted;
                if walk.end == End::Inserted {
                    self.nodes[own as usize] = [primitive, head];
                    begins[pixel as usize] = own + 1;
                }
                is_stray = walk.end == End::Crowded;
            }
            if is_stray {
                self.nodes[own as usize] = [self.spids.words.len() as u32 - 1 - strays, 0];
                strays += 1;
                let warp = self.warp_of(own);
                self.warps[warp].has_strays = true;
            }
        }
    }

    /// Warps of a row of samples: each workgroup has its own.
    fn warps_a_row(&self) -> u32 {
        self.groups()[0] * group_size()[0].div_ceil(self.lanes)
    }

    /// Index of the warp of a sample.
    fn warp_of(&self, own: u32) -> usize {
        let (width, [threads, _]) = (self.spids.layer.width, group_size());
        let (row, x) = (own / width, own % width);
        let warp = x / threads * threads.div_ceil(self.lanes) + x % threads / self.lanes;
        (row * self.warps_a_row() + warp) as usize
    }

    /// Index of a pixel of shading space; None: there is none.
    fn shading_pixel(&self, packed: u32) -> Option<u32> {
        (packed != NO_SHADING_PIXEL).then(|| (packed >> 16) * self.spids.space.width + (packed & 0xffff))
    }

    /// From a list's beginning until a node holds `primitive` or the list ends.
    fn walk(&self, head: u32, primitive: u32) -> Walk {
        let mut read = Vec::new();
        let mut at = head;
        while at != 0 {
            read.push(at - 1);
            let [held, next] = self.nodes[at as usize - 1];
            if held == primitive {
                return Walk { read, end: End::Found };
            }
            at = next;
        }
        let end = if read.len() < LIST_MOST as usize { End::Inserted } else { End::Crowded };
        Walk { read, end }
    }
}

/// An atomic operation: a read and a write of one place, if at all.
fn atomic(resource: &Resource, index: u32, happens: bool) -> [Option<Access>; 2] {
    let at = resource.entry(u64::from(index));
    [resource.read(at), resource.write(at)].map(|access| happens.then_some(access))
}

impl Kernel for Insert {
    fn groups(&self) -> [u32; 3] {
        let ([lanes, _], Extent { width, height, .. }) = (self.group_size(), self.spids.layer);
        [width.div_ceil(lanes), height, self.spids.layer_count()]
    }

    fn group_size(&self) -> [u32; 2] {
        group_size()
    }

    fn accesses(&self, group: [u32; 3], [x, _]: [u32; 2], out: &mut Vec<Option<Access>>) {
        let ([lanes, _], Extent { width, height, .. }) = (self.group_size(), self.spids.layer);
        let at = [group[0] * lanes + x, group[1], group[2]];
        if at[0] >= width {
            return;
        }
        let memory = &self.memory;
        let own = (at[2] * height + at[1]) * width + at[0];
        out.push(Some(memory.spids.read(memory.spids.layer_texel(at))));
        let [primitive, packed] = self.spids.words[own as usize];
        if primitive == NO_PRIMITIVE {
            return;
        }
        let own_entry = |resource: &Resource| resource.entry(u64::from(own));
        let warp = self.warps[self.warp_of(own)];
        let pixel = self.shading_pixel(packed);
        let walk = pixel.map(|_| self.walk(self.heads[own as usize], primitive));
        let end = walk.as_ref().map(|walk| walk.end);
        out.push(pixel.map(|pixel| memory.begins.read(memory.begins.entry(u64::from(pixel)))));
        let read = walk.iter().flat_map(|walk| &walk.read);
        let read = read.map(|node| memory.nodes.read(memory.nodes.entry(u64::from(*node))));
        out.extend(read.map(Some).chain(std::iter::repeat(None)).take(warp.longest as usize));
        if warp.inserts {
            let inserts = end == Some(End::Inserted);
            out.push(inserts.then(|| memory.nodes.write(own_entry(&memory.nodes))));
            out.extend(atomic(&memory.begins, pixel.unwrap_or(0), inserts));
        }
        if warp.has_strays {
            let is_stray = end.is_none_or(|end| end == End::Crowded);
            out.extend(atomic(&memory.counters, COUNTED_CROWDED, end == Some(End::Crowded)));
            out.extend(atomic(&memory.counters, COUNTED_STRAYS, is_stray));
            out.push(is_stray.then(|| memory.nodes.write(own_entry(&memory.nodes))));
            let color = u64::from(self.nodes[own as usize][0]);
            out.push(is_stray.then(|| memory.colors.write(memory.colors.entry(color))));
        }
        out.push(Some(memory.addresses.write(own_entry(&memory.addresses))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::locality::access::accesses_of;

    const NOTHING: [u32; 2] = [NO_PRIMITIVE; 2];

    fn insert(layer: [u32; 2], space: [u32; 2], words: &[[u32; 2]]) -> Insert {
        let [layer, space] = [layer, space].map(|[width, height]| Extent::new(width, height));
        Insert::new(Spids { layer, space, words: words.to_vec() }, Layout::Linear, 32)
    }

    /// Spids, begins, nodes, colours, addresses, counters: bytes that are read, and written.
    fn asked(insert: &Insert) -> [[u64; 2]; 6] {
        let all = accesses_of(insert);
        let InsertMemory { spids, begins, nodes, colors, addresses, counters } = &insert.memory;
        [spids, begins, nodes, colors, addresses, counters].map(|resource| resource.asked_bytes(&all))
    }

    /// Two layers of two samples: the first pixel's list gets triangle 7, finds it, and gets 9; the second one's gets 7.
    #[test]
    fn lists_are_walked_as_on_paper() {
        let insert = insert([2, 1], [2, 1], &[[7, 0], [7, 1], [7, 0], [9, 0]]);
        let begins = [4 * 4 + 3 * 4, 3 * 4];
        assert_eq!(asked(&insert), [[4 * 8, 0], begins, [2 * 8, 3 * 8], [0, 0], [0, 4 * 4], [0, 0]]);
        let InsertMemory { spids, begins, nodes, addresses, .. } = &insert.memory;
        let of = |layer: u32, x: u32| {
            let mut out = Vec::new();
            insert.accesses([0, 0, layer], [x, 0], &mut out);
            out
        };
        let first = [
            spids.read(spids.layer_texel([1, 0, 0])),
            begins.read(begins.entry(1)),
            nodes.write(nodes.entry(1)),
            begins.read(begins.entry(1)),
            begins.write(begins.entry(1)),
            addresses.write(addresses.entry(1)),
        ];
        assert_eq!(of(0, 1), first.map(Some));
        // It finds its triangle in the first sample's node, and waits while its neighbour inserts.
        let found =
            [spids.read(spids.layer_texel([0, 0, 1])), begins.read(begins.entry(0)), nodes.read(nodes.entry(0))];
        let address = addresses.write(addresses.entry(2));
        assert_eq!(of(1, 0), [&found.map(Some)[..], &[None; 3], &[Some(address)]].concat());
        assert_eq!(of(1, 2), []);
    }

    #[test]
    fn what_sees_nothing_ends_and_strays_have_nodes_and_colours_of_their_own() {
        let insert = insert([3, 1], [1, 1], &[NOTHING, [5, NO_SHADING_PIXEL], [6, 0]]);
        let begins = [4 + 4, 4];
        assert_eq!(asked(&insert), [[3 * 8, 0], begins, [0, 2 * 8], [0, 8], [0, 2 * 4], [4, 4]]);
        // The first stray's colour is the last one.
        let all = accesses_of(&insert);
        let color = insert.memory.colors.write(insert.memory.colors.entry(2));
        assert_eq!(all.iter().filter(|access| **access == color).count(), 1);
    }

    #[test]
    fn a_full_list_is_walked_to_its_end() {
        let words: Vec<[u32; 2]> = (0..LIST_MOST + 2).map(|triangle| [triangle, 0]).collect();
        let insert = insert([LIST_MOST + 2, 1], [1, 1], &words);
        let most = u64::from(LIST_MOST);
        let [_, begins, nodes, colors, addresses, counters] = asked(&insert);
        assert_eq!(nodes, [8 * (most * (most - 1) / 2 + 2 * most), 8 * (most + 2)]);
        assert_eq!((begins, colors), ([4 * (2 * most + 2), 4 * most], [0, 2 * 8]));
        // Two are crowded out, and are strays.
        assert_eq!((addresses, counters), ([0, 4 * (most + 2)], [2 * 8, 2 * 8]));
    }

    /// A sharp plane: each sample finds its triangle but the first of a pixel, and the first on the other side of a diagonal.
    #[test]
    fn a_plane_asks_for_what_its_lists_hold() {
        let case = InsertCase { extent: Extent::new(16, 8), samples: 8, tuples: 8, triangle_px: 4, blur_px: 0.0 };
        let case = case.checked().unwrap();
        assert_eq!((case.label().as_str(), case.workgroup()), ("spp=8 tuples=8 triangle=4 blur=0", [64, 1]));
        let spids = Spids::of_plane(case.extent, &case.table(), 4, 0.0);
        // A diagonal crosses a quarter of a square's pixels.
        let distinct = spids.words.iter().collect::<std::collections::HashSet<_>>().len() as u64;
        assert_eq!(distinct, 128 + 32);
        let [spid, begins, nodes, _, addresses, counters] = asked(&Insert::new(spids, Layout::Linear, 32));
        assert_eq!((spid, begins), ([1024 * 8, 0], [4 * (1024 + distinct), 4 * distinct]));
        assert_eq!((nodes[1], addresses, counters), (8 * distinct, [0, 4 * 1024], [0, 0]));
        // The older one of a list of two costs a node more: between one and two for each sample but the first.
        assert!((8 * (1024 - 128)..8 * 2 * 1024).contains(&nodes[0]), "{nodes:?}");
        // More blur, longer lists.
        let machine = Machine::known("volta-v100").unwrap();
        let asked_of = |blur_px: f64| InsertCase { blur_px, ..case.clone() }.counted(&machine)[0].counts.asked_bytes;
        assert_eq!(asked_of(0.0), spid[0] + begins[0] + begins[1] + nodes[0] + nodes[1] + addresses[1]);
        assert!(asked_of(8.0) > asked_of(0.0));
    }

    #[test]
    fn insertions_that_cannot_be_are_refused() {
        let with = |change: fn(&mut InsertCase)| {
            let mut case =
                InsertCase { extent: Extent::new(16, 8), samples: 8, tuples: 8, triangle_px: 4, blur_px: 0.0 };
            change(&mut case);
            case.checked().err().map(|error| error.message().to_owned()).unwrap_or_default()
        };
        assert!(with(|case| case.tuples = 12).contains("spp=8 tuples=12"));
        assert!(with(|case| case.blur_px = 65.0).contains("blur=65"));
        assert!(with(|case| case.blur_px = f64::NAN).contains("blur=NaN"));
        assert!(with(|case| case.triangle_px = 0).contains("triangle=0"));
        assert!(with(|case| case.extent = Extent::new(16_384, 16_384)).contains("samples, of which 67108864"));
    }
}

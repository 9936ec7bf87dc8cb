//! Shading with the lights of the subsets as a kernel: the surfaces that a thread reads, its subset's lights, and the irradiance that it
//! writes. Mirrors glsl/techniques/interleaved_deferred/shade.

use super::access::{Access, Kernel};
use super::frame::{Resource, Space, Texels};
use super::layout::Layout;
use super::machine::Machine;
use super::stage::{PassCounts, StageKind, Studied, check_sides, pair_text, rounded_block};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{MappingParams, SubsetBlock, VplBlock};
use crate::sampling::pattern::Pattern;
use crate::techniques::interleaved_deferred::mapping::mapping;
use crate::techniques::interleaved_deferred::split_method::{Split, StorageKind};
use crate::techniques::interleaved_deferred::subsets::subsets;
use crate::units::Extent;

/// Texels that a thread may shade, as `--texels` has them.
pub const TEXELS: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// Virtual point lights at most, as `--vpls` has them.
const MOST_VPLS: u32 = 65_536;

/// A shading pass that is studied.
#[derive(Clone, Debug)]
pub struct ShadeCase {
    pub extent: Extent,
    pub split: Split,
    /// 1x1 where nothing is split.
    pub pattern: [u32; 2],
    /// A multiple of the pattern; the pattern itself where the split has no blocks.
    pub block: [u32; 2],
    /// Where sub-buffers lie.
    pub storage: StorageKind,
    pub workgroup: [u32; 2],
    /// Texels that a thread shades with one reading of its lights.
    pub texels: u32,
    /// Virtual point lights of all subsets.
    pub vpls: u32,
}

/// Where shading finds its surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Surfaces {
    /// In sub-buffers.
    SubBuffers,
    /// In the frame, a subset's at the pattern's stride.
    Strided,
    /// In the frame, each thread a pixel.
    Frame,
}

impl ShadeCase {
    /// Rounds the block up to whole patterns, and texels down to what the technique gives a thread.
    ///
    /// Errors: the split's shading is not studied; a size is 0 or too large; a subset has no light (exit code 2).
    pub fn checked(self) -> Result<Self> {
        let Self { extent, split, block, workgroup, texels, vpls, .. } = self;
        let pattern = if split == Split::None { [1, 1] } else { self.pattern };
        check_sides(extent, pattern, block, workgroup)?;
        let studied =
            [Split::None, Split::Branch, Split::Indirect, Split::Remap, Split::OnePass, Split::TwoPass, Split::Tile];
        if !studied.contains(&split) {
            return Err(Error::request(format!(
                "split={}: the addresses of its shading are not studied",
                split.name()
            ))
            .note(format!("those of {} are", studied.map(Split::name).join(", "))));
        }
        if !TEXELS.contains(&texels) {
            let known = TEXELS.map(|texels| texels.to_string()).join(", ");
            return Err(Error::request(format!("texels={texels}: a thread shades one of {known}")));
        }
        let subsets = pattern[0] * pattern[1];
        if vpls < subsets || vpls > MOST_VPLS {
            return Err(Error::request(format!(
                "vpls={vpls} with the {subsets} subsets of pattern={}: each needs a light, and there are {MOST_VPLS} at most",
                pair_text(pattern)
            )));
        }
        let block = rounded_block(has_blocks(split), pattern, block);
        let lanes = u64::from(workgroup[0]) * u64::from(workgroup[1]);
        let most = if split == Split::Branch { 1 } else { mapping(extent, pattern, block).most_list_texels(lanes) };
        Ok(Self { pattern, block, texels: texels.min(most), ..self })
    }

    pub fn mapping(&self) -> MappingParams {
        mapping(self.extent, self.pattern, self.block)
    }

    /// The stretch of the lights that each subset has.
    pub fn subsets(&self) -> Vec<SubsetBlock> {
        subsets(&Pattern::grid(self.pattern), &Pattern::grid([1, 1]), self.vpls, 0)
    }

    /// Its pass on a machine's memory.
    pub fn kernel(&self, layout: Layout) -> Shade {
        let (mapping, subsets) = (self.mapping(), self.subsets());
        Shade { case: self.clone(), memory: ShadeMemory::new(&mapping, self, layout), mapping, subsets }
    }

    fn surfaces(&self) -> Surfaces {
        match self.split {
            Split::Branch => Surfaces::Frame,
            Split::None | Split::Indirect | Split::Remap => Surfaces::Strided,
            _ => Surfaces::SubBuffers,
        }
    }
}

fn has_blocks(split: Split) -> bool {
    matches!(split, Split::TwoPass | Split::Tile)
}

impl Studied for ShadeCase {
    fn stage(&self) -> StageKind {
        StageKind::Shade
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        let pattern = (self.split != Split::None).then(|| ("pattern", pair_text(self.pattern)));
        let block = has_blocks(self.split).then(|| ("block", pair_text(self.block)));
        let is_moved = self.surfaces() == Surfaces::SubBuffers;
        let storage = is_moved.then(|| ("storage", self.storage.name().to_owned()));
        let own = [("texels", self.texels.to_string()), ("vpls", self.vpls.to_string())];
        let split = ("split", self.split.name().to_owned());
        std::iter::once(split).chain(pattern).chain(block).chain(storage).chain(own).collect()
    }

    fn extent(&self) -> Extent {
        self.extent
    }

    fn workgroup(&self) -> [u32; 2] {
        self.workgroup
    }

    fn counted(&self, machine: &Machine) -> Vec<PassCounts> {
        vec![PassCounts::of("shade", &self.kernel(machine.layout()), machine)]
    }
}

/// The memory of a shading pass.
pub struct ShadeMemory {
    /// Position and normal of the G-buffer, images.
    pub gbuffer: [Resource; 2],
    /// The same in sub-buffers.
    pub sub_buffers: Texels,
    pub subsets: Resource,
    pub vpls: Resource,
    /// In sub-buffers, part 0.
    pub irradiance: Texels,
    /// In frame order, a buffer.
    pub frame_irradiance: Resource,
}

impl ShadeMemory {
    fn new(mapping: &MappingParams, case: &ShadeCase, layout: Layout) -> Self {
        let mut space = Space::default();
        let mut image = || space.image(layout, mapping.extent());
        let gbuffer = [image(), image()];
        let sub_buffers = Texels::new(&mut space, case.storage, layout, mapping);
        let subsets = space.entries(u64::from(mapping.subset_count()), size_of::<SubsetBlock>());
        let vpls = space.entries(u64::from(case.vpls), size_of::<VplBlock>());
        let irradiance = Texels::new(&mut space, case.storage, layout, mapping);
        let frame_irradiance = space.buffer(mapping.frame_texel_count());
        Self { gbuffer, sub_buffers, subsets, vpls, irradiance, frame_irradiance }
    }
}

/// The shading of one frame in which every pixel sees a surface.
pub struct Shade {
    case: ShadeCase,
    mapping: MappingParams,
    pub memory: ShadeMemory,
    subsets: Vec<SubsetBlock>,
}

/// A point that a thread shades.
struct Point {
    /// Its surface, in the shader's order.
    reads: [Access; 2],
    /// It has a surface, which meets the lights.
    is_lit: bool,
    /// Its irradiance; None: it lies beyond the end.
    write: Option<Access>,
}

impl Shade {
    fn of_sub_buffer(&self, texel: [u32; 3]) -> Point {
        let (mapping, memory) = (&self.mapping, &self.memory);
        let exists = texel[0] < mapping.sub_width_px && texel[1] < mapping.sub_height_px;
        let held = if exists { texel } else { [0, 0, texel[2]] };
        let reads = [0, 1]
            .map(|part| memory.sub_buffers.parts[part].read(memory.sub_buffers.of_sub_buffer(part, mapping, held)));
        let at = memory.irradiance.of_sub_buffer(0, mapping, held);
        Point {
            reads,
            is_lit: exists && mapping.is_in_frame(mapping.pixel_of_texel(texel)),
            write: exists.then(|| memory.irradiance.parts[0].write(at)),
        }
    }

    fn of_frame(&self, pixel: [u32; 2]) -> Point {
        let (mapping, memory) = (&self.mapping, &self.memory);
        let exists = mapping.is_in_frame(pixel);
        let [x, y] = [pixel[0].min(mapping.width_px - 1), pixel[1].min(mapping.height_px - 1)];
        // The normal comes first.
        let reads = [1, 0].map(|part: usize| memory.gbuffer[part].read(memory.gbuffer[part].texel([x, y])));
        let at = u64::from(y) * u64::from(mapping.row_pitch()) + u64::from(x);
        let write = exists.then(|| memory.frame_irradiance.write(memory.frame_irradiance.entry(at)));
        Point { reads, is_lit: exists, write }
    }

    /// The points of a thread, and its subset; None: it returns at once.
    fn points(&self, group: [u32; 3], [x, y]: [u32; 2]) -> Option<(Vec<Point>, u32)> {
        let (mapping, [width, height]) = (&self.mapping, self.case.workgroup);
        let surfaces = self.case.surfaces();
        if surfaces == Surfaces::Frame {
            let pixel = [group[0] * width + x, group[1] * height + y];
            return mapping.is_in_frame(pixel).then(|| (vec![self.of_frame(pixel)], mapping.subset_of(pixel)));
        }
        let texels = self.case.texels;
        let point = |i: u32| {
            // listed.glsl
            let place = (group[0] * texels + i) * width * height + y * width + x;
            let texel = [place % mapping.sub_width_px, place / mapping.sub_width_px, group[2]];
            match surfaces {
                Surfaces::SubBuffers => self.of_sub_buffer(texel),
                _ => self.of_frame(mapping.pixel_of_texel(texel)),
            }
        };
        Some(((0..texels).map(point).collect(), group[2]))
    }
}

impl Kernel for Shade {
    fn groups(&self) -> [u32; 3] {
        let (mapping, [width, height]) = (&self.mapping, self.case.workgroup);
        if self.case.surfaces() == Surfaces::Frame {
            return [mapping.width_px.div_ceil(width), mapping.height_px.div_ceil(height), 1];
        }
        let a_group = u64::from(width) * u64::from(height) * u64::from(self.case.texels);
        [mapping.sub_texel_count().div_ceil(a_group) as u32, 1, mapping.subset_count()]
    }

    fn group_size(&self) -> [u32; 2] {
        self.case.workgroup
    }

    fn accesses(&self, group: [u32; 3], local: [u32; 2], out: &mut Vec<Option<Access>>) {
        let Some((points, subset)) = self.points(group, local) else { return };
        let (memory, stretch) = (&self.memory, &self.subsets[subset as usize]);
        out.extend(points.iter().flat_map(|point| point.reads).map(Some));
        out.push(Some(memory.subsets.read(memory.subsets.entry(u64::from(subset)))));
        // A thread without a surface reads no light; where subsets differ, threads wait for the one with the most.
        let own = if points.iter().any(|point| point.is_lit) { stretch.vpl_count } else { 0 };
        let most = self.case.vpls.div_ceil(self.mapping.subset_count());
        let lights = (0..most).map(|index| {
            let at = memory.vpls.entry(u64::from(stretch.vpl_first + index));
            (index < own).then(|| memory.vpls.read(at))
        });
        out.extend(lights);
        out.extend(points.iter().map(|point| point.write));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::locality::access::accesses_of;

    fn case(split: Split, size: [u32; 2], workgroup: [u32; 2]) -> ShadeCase {
        ShadeCase {
            extent: Extent::new(size[0], size[1]),
            split,
            pattern: [2, 2],
            block: [2, 2],
            storage: StorageKind::Buffer,
            workgroup,
            texels: 1,
            vpls: 6,
        }
    }

    /// 8 x 4 pixels in patterns of 2 x 2: four sub-buffers of 4 x 2 texels, a workgroup and a warp each; of six lights the first two
    /// subsets have two and the others one.
    #[test]
    fn sub_buffers_are_shaded_as_counted_on_paper() {
        let machine = Machine { layout: "linear".to_owned(), ..Machine::known("volta-v100").unwrap() };
        let case = case(Split::OnePass, [8, 4], [4, 2]).checked().unwrap();
        assert_eq!(case.label(), "split=one-pass pattern=2x2 storage=buffer texels=1 vpls=6");
        let shade = case.kernel(machine.layout());
        let (all, memory) = (accesses_of(&shade), &shade.memory);
        let [position, normal] = memory.sub_buffers.parts.map(|part| part.asked_bytes(&all));
        assert_eq!([position, normal], [[32 * 8, 0]; 2]);
        assert_eq!(memory.subsets.asked_bytes(&all), [32 * 16, 0]);
        assert_eq!(memory.vpls.asked_bytes(&all), [8 * (2 + 2 + 1 + 1) * 48, 0]);
        assert_eq!(memory.irradiance.parts[0].asked_bytes(&all), [0, 32 * 8]);
        let [PassCounts { counts, .. }] = case.counted(&machine)[..] else { panic!("it is one pass") };
        // Position, normal, subset, two lights, of which two warps leave one out, and the irradiance.
        assert_eq!((counts.warps, counts.instructions), (4, 4 * 6));
        // 64 bytes of each part, 16 of a subset. A light has 48 from a multiple of 48 on: two sectors each, and the third and the sixth
        // lie in two lines.
        assert_eq!(counts.sectors, 4 * (2 + 2 + 1 + 2) + 6 * 2);
        assert_eq!(counts.lines, 4 * 4 + 4 + 2 * 2);
        assert_eq!((counts.memory_read_bytes, counts.memory_written_bytes), (2 * 256 + 64 + 6 * 48, 256));
    }

    /// 3 x 2 pixels: sub-buffers of 2 x 1 texels, of which two have one in the padding; a workgroup of 4 threads each.
    #[test]
    fn threads_without_a_pixel_read_no_light() {
        let asked = |split: Split| {
            let case = ShadeCase { vpls: 4, ..case(split, [3, 2], [4, 1]) }.checked().unwrap();
            let shade = case.kernel(Layout::Linear);
            let all = accesses_of(&shade);
            let ShadeMemory { gbuffer, sub_buffers, subsets, vpls, irradiance, frame_irradiance } = &shade.memory;
            let surfaces = [gbuffer[0], gbuffer[1], sub_buffers.parts[0], sub_buffers.parts[1]];
            let surfaces = surfaces.map(|part| part.asked_bytes(&all)[0] / 8);
            let of = |resource: &Resource| resource.asked_bytes(&all);
            (
                surfaces,
                of(subsets)[0] / 16,
                of(vpls)[0] / 48,
                of(&irradiance.parts[0])[1] / 8,
                of(frame_irradiance)[1] / 8,
            )
        };
        assert_eq!(asked(Split::Remap), ([16, 16, 0, 0], 16, 6, 0, 6));
        assert_eq!(asked(Split::Indirect), asked(Split::Remap));
        // The padding of sub-buffers is written too.
        assert_eq!(asked(Split::OnePass), ([0, 0, 16, 16], 16, 6, 8, 0));
        // Threads beyond the frame return.
        assert_eq!(asked(Split::Branch), ([6, 6, 0, 0], 6, 6, 0, 6));
        // All four lights at each pixel; two workgroups of four places in rows of four.
        assert_eq!(asked(Split::None), ([8, 8, 0, 0], 8, 24, 0, 6));
    }

    #[test]
    fn a_thread_reads_its_lights_once_for_all_of_its_texels() {
        // Sub-buffers of 32 x 16 texels, workgroups of 32: four texels a thread leave four workgroups.
        let asked = |texels: u32| {
            let case = ShadeCase { texels, vpls: 8, ..case(Split::TwoPass, [64, 32], [8, 4]) }.checked().unwrap();
            let shade = case.kernel(Layout::Linear);
            let all = accesses_of(&shade);
            let [lights, written] =
                [shade.memory.vpls, shade.memory.irradiance.parts[0]].map(|of| of.asked_bytes(&all));
            (case.texels, lights[0], written[1])
        };
        assert_eq!(asked(1), (1, 2048 * 2 * 48, 2048 * 8));
        assert_eq!(asked(4), (4, 512 * 2 * 48, 2048 * 8));
        assert_eq!(asked(32), asked(4));
    }

    #[test]
    fn shading_that_cannot_be_is_refused() {
        let with = |change: fn(&mut ShadeCase)| {
            let mut case = case(Split::OnePass, [8, 4], [4, 2]);
            change(&mut case);
            case.checked().err().map(|error| error.message().to_owned()).unwrap_or_default()
        };
        assert!(
            with(|case| case.split = Split::Stencil).contains("split=stencil: the addresses of its shading are not")
        );
        assert!(with(|case| case.vpls = 3).contains("vpls=3 with the 4 subsets of pattern=2x2"));
        assert!(with(|case| case.texels = 3).contains("texels=3"));
        assert!(with(|case| case.workgroup = [0, 1]).contains("sides are 1 to"));
        assert_eq!(with(|case| (case.split, case.vpls) = (Split::None, 1)), "");
    }
}

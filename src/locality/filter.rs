//! Filters of the irradiance as kernels, with the discontinuities that they stop at: what each shader reads and writes. Mirrors
//! glsl/passes/filter.
//!
//! What ends a walk of the fast Gaussian is data: here nothing does. The other filters read the same wherever walks end.

use super::access::{Access, Kernel};
use super::frame::{Resource, Space};
use super::layout::Layout;
use super::machine::Machine;
use super::shade::TEXELS;
use super::stage::{PassCounts, StageKind, Studied, check_sides, pair_text};
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::passes::filter::discontinuity::MOST_COLUMNS;
use crate::passes::texels::FILTER_TEXELS;
use crate::units::Extent;

choices! {
    /// A filter.
    pub enum FilterKind {
        /// `--filter gauss` of interleaved_deferred.
        "gauss" => Gauss,
        /// `--filter gauss-fast`.
        "gauss-fast" => GaussFast,
        /// The box of adaptive_interleaved, as large as the pattern.
        "box" => Box,
    }
}

/// Bytes of a pixel's flags.
const FLAG_BYTES: usize = 4;

/// A filter that is studied.
#[derive(Clone, Debug)]
pub struct FilterCase {
    pub extent: Extent,
    pub filter: FilterKind,
    /// Taps of a Gaussian in one direction: odd, 5 to 17.
    pub taps: u32,
    /// Pixels of the box.
    pub pattern: [u32; 2],
    /// Pixels that a thread compares or filters.
    pub texels: u32,
    pub workgroup: [u32; 2],
}

impl FilterCase {
    /// Takes as few texels as the technique gives a thread that filters.
    ///
    /// Errors: a number is none of the technique's (exit code 2).
    pub fn checked(self) -> Result<Self> {
        let Self { extent, taps, pattern, texels, workgroup, .. } = self;
        check_sides(extent, pattern, pattern, workgroup)?;
        if !(5..=17).contains(&taps) || taps.is_multiple_of(2) {
            return Err(Error::request(format!("kernel={taps}: it must be odd, from 5 to 17")));
        }
        if !TEXELS.contains(&texels) {
            let known = TEXELS.map(|texels| texels.to_string()).join(", ");
            return Err(Error::request(format!("texels={texels}: a thread filters one of {known}")));
        }
        Ok(Self { texels: texels.min(FILTER_TEXELS), ..self })
    }

    /// Its passes in their order on a machine's memory.
    pub fn kernels(&self, layout: Layout) -> Vec<FilterKernel> {
        let memory = FilterMemory::new(self, layout);
        let own: &[Pass] = match self.filter {
            FilterKind::Gauss => &[Pass::Rows, Pass::Columns],
            FilterKind::GaussFast => &[Pass::Pack, Pass::FastRows, Pass::FastColumns],
            FilterKind::Box => &[Pass::Box],
        };
        let passes = std::iter::once(&Pass::Discontinuity).chain(own);
        passes.map(|pass| FilterKernel { pass: *pass, case: self.clone(), memory }).collect()
    }

    /// Texels between rows of buffers: even for the Gaussians, which read what gathers write.
    fn row_pitch(&self) -> u32 {
        if self.filter == FilterKind::Box { self.extent.width } else { self.extent.width.next_multiple_of(2) }
    }
}

impl Studied for FilterCase {
    fn stage(&self) -> StageKind {
        StageKind::Filter
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        let size = match self.filter {
            FilterKind::Box => ("pattern", pair_text(self.pattern)),
            _ => ("kernel", self.taps.to_string()),
        };
        let mut settings = vec![("filter", self.filter.name().to_owned()), size];
        settings.push(("texels", self.texels.to_string()));
        settings
    }

    fn extent(&self) -> Extent {
        self.extent
    }

    fn workgroup(&self) -> [u32; 2] {
        self.workgroup
    }

    fn counted(&self, machine: &Machine) -> Vec<PassCounts> {
        let kernels = self.kernels(machine.layout());
        kernels.iter().map(|kernel| PassCounts::of(kernel.pass.name(), kernel, machine)).collect()
    }
}

/// Which pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    Discontinuity,
    Rows,
    Columns,
    Pack,
    FastRows,
    FastColumns,
    Box,
}

impl Pass {
    /// As reports call it, without the technique; what one pass of the technique does in several dispatches is told apart.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discontinuity => "discontinuity",
            Self::Rows | Self::FastRows => "filter.rows",
            Self::Columns | Self::FastColumns => "filter.columns",
            Self::Pack => "filter.pack",
            Self::Box => "filter",
        }
    }
}

/// The memory of a filter.
#[derive(Clone, Copy)]
pub struct FilterMemory {
    /// Position and normal of the G-buffer, images.
    pub gbuffer: [Resource; 2],
    pub flags: Resource,
    /// Irradiance in frame order, a buffer.
    pub source: Resource,
    /// With its flags, an image.
    pub packed: Resource,
    /// Between the directions: an image of the fast Gaussian, else a buffer.
    pub rows: Resource,
    /// A buffer.
    pub filtered: Resource,
}

impl FilterMemory {
    fn new(case: &FilterCase, layout: Layout) -> Self {
        let mut space = Space::default();
        let gbuffer = [0, 1].map(|_| space.image(layout, case.extent));
        let texels = u64::from(case.row_pitch()) * u64::from(case.extent.height);
        let flags = space.entries(texels, FLAG_BYTES);
        let source = space.buffer(texels);
        let packed = space.image(layout, case.extent);
        let is_image = case.filter == FilterKind::GaussFast;
        let rows = if is_image { space.image(layout, case.extent) } else { space.buffer(texels) };
        let filtered = space.buffer(texels);
        Self { gbuffer, flags, source, packed, rows, filtered }
    }
}

/// A pass over one frame.
pub struct FilterKernel {
    pub pass: Pass,
    case: FilterCase,
    pub memory: FilterMemory,
}

/// What an invocation has added.
type Out<'a> = &'a mut Vec<Option<Access>>;

impl FilterKernel {
    /// Pixels that an invocation stands for, across and down.
    fn run(&self) -> [u32; 2] {
        let texels = self.case.texels;
        match self.pass {
            Pass::Discontinuity => [texels.min(MOST_COLUMNS), texels],
            Pass::Rows => [texels, 1],
            Pass::Columns | Pass::Box => [1, texels],
            Pass::Pack | Pass::FastRows | Pass::FastColumns => [1, 1],
        }
    }

    /// Place of a pixel in buffers.
    fn entry(&self, [x, y]: [u32; 2]) -> u64 {
        u64::from(y) * u64::from(self.case.row_pitch()) + u64::from(x)
    }

    fn write(&self, target: &Resource, pixel: [u32; 2]) -> Option<Access> {
        let Extent { width, height, .. } = self.case.extent;
        let is_inside = pixel[0] < width && pixel[1] < height;
        is_inside.then(|| target.write(target.entry(self.entry(pixel))))
    }

    /// Irradiance and flags of a pixel of a buffer.
    fn read_both(&self, source: &Resource, pixel: [u32; 2]) -> [Option<Access>; 2] {
        let entry = self.entry(pixel);
        [source, &self.memory.flags].map(|resource| Some(resource.read(resource.entry(entry))))
    }

    fn discontinuity(&self, first: [u32; 2], out: Out<'_>) {
        let Extent { width, height, .. } = self.case.extent;
        let [columns, rows] = self.run();
        let read = |[x, y]: [u32; 2], out: Out<'_>| {
            // The normal comes first.
            let held = [x.min(width - 1), y.min(height - 1)];
            let parts = [1, 0].map(|part: usize| &self.memory.gbuffer[part]);
            out.extend(parts.map(|part| Some(part.read(part.texel(held)))));
        };
        (0..=columns).for_each(|x| read([first[0] + x, first[1]], out));
        for y in first[1]..first[1] + rows {
            read([first[0], y + 1], out);
            for x in first[0]..first[0] + columns {
                read([x + 1, y + 1], out);
                out.push(self.write(&self.memory.flags, [x, y]));
            }
        }
    }

    /// One direction of the Gaussian; `axis`: 0 along the rows.
    fn gauss(&self, axis: usize, first: [u32; 2], out: Out<'_>) {
        let Extent { width, height, .. } = self.case.extent;
        let (source, target) = match axis {
            0 => (&self.memory.source, &self.memory.rows),
            _ => (&self.memory.rows, &self.memory.filtered),
        };
        let (radius, texels, last) = (self.case.taps / 2, self.case.texels, [width, height][axis] - 1);
        let at = |place: u32| {
            let mut pixel = first;
            pixel[axis] = place;
            pixel
        };
        for i in 0..texels + 2 * radius {
            out.extend(self.read_both(source, at((first[axis] + i).saturating_sub(radius).min(last))));
        }
        out.extend((0..texels).map(|i| self.write(target, at(first[axis] + i))));
    }

    fn pack(&self, pixel: [u32; 2], out: Out<'_>) {
        out.extend(self.read_both(&self.memory.source, pixel));
        out.push(Some(self.memory.packed.write(self.memory.packed.texel(pixel))));
    }

    /// One direction of the fast Gaussian.
    fn gauss_fast(&self, axis: usize, pixel: [u32; 2], out: Out<'_>) {
        let Extent { width, height, .. } = self.case.extent;
        let last = [width - 1, height - 1];
        let source = if axis == 0 { &self.memory.packed } else { &self.memory.rows };
        out.push(Some(source.read(source.texel(pixel))));
        let radius = self.case.taps / 2;
        for (is_after, room) in [(true, last[axis] - pixel[axis]), (false, pixel[axis])] {
            let reach = radius.min(room);
            for tap in (1..=radius).step_by(2) {
                // Others have so many look-ups.
                if tap > reach {
                    out.extend([None; 4]);
                    continue;
                }
                // Half way between two texels, or at the last one; beside it what a sampler reads with a weight of 0.
                let is_pair = tap < reach;
                let nearest = match is_after {
                    true => pixel[axis] + tap,
                    false => pixel[axis] - tap - u32::from(is_pair),
                };
                for beside in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                    let mut corner = pixel;
                    corner[axis] = nearest;
                    let corner = [0, 1].map(|axis: usize| (corner[axis] + beside[axis]).min(last[axis]));
                    out.push(Some(source.read(source.texel(corner))));
                }
            }
        }
        out.push(match axis {
            0 => Some(self.memory.rows.write(self.memory.rows.texel(pixel))),
            _ => self.write(&self.memory.filtered, pixel),
        });
    }

    fn box_filter(&self, first: [u32; 2], out: Out<'_>) {
        let Extent { width, height, .. } = self.case.extent;
        let [across, down] = self.case.pattern;
        let (left, above) = (i64::from((across - 1) / 2), i64::from((down - 1) / 2));
        // A row of the box, so many pixels below its first.
        let row = |below: u32, out: Out<'_>| {
            for column in 0..across {
                let x = i64::from(first[0] + column) - left;
                let y = i64::from(first[1] + below) - above;
                let is_inside = (0..i64::from(width)).contains(&x) && (0..i64::from(height)).contains(&y);
                let pixel = is_inside.then_some([x as u32, y as u32]);
                out.extend(pixel.map_or([None; 2], |pixel| self.read_both(&self.memory.source, pixel)));
            }
        };
        (0..down - 1).for_each(|below| row(below, out));
        for next in 0..self.case.texels.min(height - first[1]) {
            row(down - 1 + next, out);
            out.push(self.write(&self.memory.filtered, [first[0], first[1] + next]));
        }
    }
}

impl Kernel for FilterKernel {
    fn groups(&self) -> [u32; 3] {
        let (Extent { width, height, .. }, run, [across, down]) = (self.case.extent, self.run(), self.case.workgroup);
        [width.div_ceil(run[0]).div_ceil(across), height.div_ceil(run[1]).div_ceil(down), 1]
    }

    fn group_size(&self) -> [u32; 2] {
        self.case.workgroup
    }

    fn accesses(&self, group: [u32; 3], local: [u32; 2], out: &mut Vec<Option<Access>>) {
        let run = self.run();
        let first = [0, 1].map(|axis: usize| (group[axis] * self.case.workgroup[axis] + local[axis]) * run[axis]);
        if first[0] >= self.case.extent.width || first[1] >= self.case.extent.height {
            return;
        }
        match self.pass {
            Pass::Discontinuity => self.discontinuity(first, out),
            Pass::Rows => self.gauss(0, first, out),
            Pass::Columns => self.gauss(1, first, out),
            Pass::Pack => self.pack(first, out),
            Pass::FastRows => self.gauss_fast(0, first, out),
            Pass::FastColumns => self.gauss_fast(1, first, out),
            Pass::Box => self.box_filter(first, out),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::locality::access::accesses_of;

    fn case(filter: FilterKind, size: [u32; 2], texels: u32) -> FilterCase {
        let extent = Extent::new(size[0], size[1]);
        FilterCase { extent, filter, taps: 5, pattern: [2, 2], texels, workgroup: [8, 1] }.checked().unwrap()
    }

    /// What each pass asks for, to read and to write.
    fn asked(case: &FilterCase) -> Vec<[u64; 2]> {
        let sum = |kernel: &FilterKernel| {
            let mut sum = [0; 2];
            accesses_of(kernel).iter().for_each(|access| sum[usize::from(access.is_write)] += u64::from(access.bytes));
            sum
        };
        case.kernels(Layout::Linear).iter().map(sum).collect()
    }

    #[test]
    fn a_gaussian_reads_what_was_counted_on_paper() {
        let machine = Machine { layout: "linear".to_owned(), ..Machine::known("volta-v100").unwrap() };
        let case = case(FilterKind::Gauss, [8, 4], 1);
        assert_eq!(case.label(), "filter=gauss kernel=5 texels=1");
        // A pixel and its three neighbours of 16 bytes; five taps of irradiance and flags along each axis.
        assert_eq!(asked(&case), [[32 * 4 * 16, 32 * 4], [32 * 5 * 12, 32 * 8], [32 * 5 * 12, 32 * 8]]);
        let found = case.counted(&machine);
        assert_eq!(
            found.iter().map(|pass| pass.pass).collect::<Vec<_>>(),
            ["discontinuity", "filter.rows", "filter.columns"]
        );
        // A row of 8 pixels is a workgroup and a warp; it has 64 bytes of positions, normals and irradiance, and 32 of flags.
        let of = |index: usize| [found[index].counts.instructions, found[index].counts.sectors];
        assert_eq!(of(0), [4 * 9, 4 * (4 * (2 + 2) + 1)]);
        assert_eq!([of(1), of(2)], [[4 * 11, 4 * (5 * (2 + 1) + 2)]; 2]);
        // Each pass reads and writes all of it once.
        let memory = |index: usize| [found[index].counts.memory_read_bytes, found[index].counts.memory_written_bytes];
        assert_eq!([memory(0), memory(1), memory(2)], [[512, 128], [384, 256], [384, 256]]);
    }

    /// Four pixels a thread share a window of eight; where it reaches beyond the frame its edge is read.
    #[test]
    fn threads_with_several_pixels_read_neighbours_once() {
        // 2 x 4 threads of 2 x 4 pixels compare 3 x 5 of them; 2 x 3 threads filter rows of 7 pixels, 7 columns of 3.
        let case = case(FilterKind::Gauss, [7, 3], 4);
        assert_eq!(asked(&case), [[4 * 15 * 16, 21 * 4], [6 * 8 * 12, 21 * 8], [7 * 8 * 12, 21 * 8]]);
        let rows = &case.kernels(Layout::Linear)[1];
        let mut out = Vec::new();
        rows.accesses([0, 1, 0], [1, 0], &mut out);
        let read = |x: u64| rows.memory.source.read(rows.memory.source.entry(8 + x));
        let write = |x: u64| rows.memory.rows.write(rows.memory.rows.entry(8 + x));
        let irradiance = out.iter().step_by(2).take(8).map(|access| access.unwrap()).collect::<Vec<_>>();
        assert_eq!(irradiance, [2, 3, 4, 5, 6, 6, 6, 6].map(read));
        assert_eq!(out[16..], [Some(write(4)), Some(write(5)), Some(write(6)), None]);
    }

    #[test]
    fn a_fast_gaussian_looks_up_pairs() {
        let case = case(FilterKind::GaussFast, [8, 4], 1);
        // A look-up of four texels on either side of each pixel that is not the last one there: 7 of 8 in a row, 3 of 4 in a column.
        let [rows, columns] = [4 * 2 * 7, 8 * 2 * 3].map(|look_ups| look_ups * 4 * 8 + 32 * 8);
        assert_eq!(asked(&case)[1..], [[32 * 12, 256], [rows, 256], [columns, 256]]);
        let kernel = &case.kernels(Layout::Linear)[2];
        let read = |[x, y]: [u32; 2]| Some(kernel.memory.packed.read(kernel.memory.packed.texel([x, y])));
        let mut out = Vec::new();
        kernel.accesses([0, 3, 0], [1, 0], &mut out);
        // Between 2 and 3, and at 0, of the last row.
        let expected = [[1, 3], [2, 3], [3, 3], [2, 3], [3, 3], [0, 3], [1, 3], [0, 3], [1, 3]];
        assert_eq!(out[..9], expected.map(read));
        assert!(out.len() == 10 && out[9].unwrap().is_write);
    }

    #[test]
    fn a_box_reads_what_of_it_lies_in_the_frame() {
        // A pixel, the one to its right, and those below: 4 + 3 along each axis.
        assert_eq!(asked(&case(FilterKind::Box, [4, 4], 1))[1], [7 * 7 * 12, 16 * 8]);
        // Two pixels of a column read three rows, of which the lower two have one beyond the frame.
        assert_eq!(asked(&case(FilterKind::Box, [4, 4], 2))[1], [7 * 5 * 12, 16 * 8]);
        assert_eq!(case(FilterKind::Box, [4, 4], 32).texels, FILTER_TEXELS);
    }

    #[test]
    fn filters_that_cannot_be_are_refused() {
        let with = |change: fn(&mut FilterCase)| {
            let mut case = case(FilterKind::Gauss, [8, 4], 1);
            change(&mut case);
            case.checked().err().map(|error| error.message().to_owned()).unwrap_or_default()
        };
        assert!(with(|case| case.taps = 6).contains("kernel=6: it must be odd"));
        assert!(with(|case| case.taps = 19).contains("from 5 to 17"));
        assert!(with(|case| case.texels = 5).contains("texels=5"));
        assert!(with(|case| case.pattern = [65, 1]).contains("sides are 1 to"));
    }
}

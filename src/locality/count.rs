//! A kernel's memory accesses counted: by warps as they are asked for, and through the caches of a machine.

use super::access::{Access, Kernel, groups_of};
use super::cache::Cache;
use super::machine::Machine;
use serde::Serialize;

/// What was counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    pub warps: u64,
    /// Accesses of warps: as many as its invocation with the most accesses has.
    pub instructions: u64,
    /// Bytes that invocations asked for.
    pub asked_bytes: u64,
    /// Distinct lines and sectors of each instruction, summed up.
    pub lines: u64,
    pub sectors: u64,
    /// Sectors that were read from the first cache, and those that were not there.
    pub first_reads: u64,
    pub first_misses: u64,
    /// Sectors that the second cache was asked for, to read and to write; to read; and of these those that were not there.
    pub second_accesses: u64,
    pub second_reads: u64,
    pub second_misses: u64,
    pub memory_read_bytes: u64,
    pub memory_written_bytes: u64,
}

impl Counts {
    /// Bytes between the first caches and the second.
    pub fn second_bytes(&self, machine: &Machine) -> u64 {
        self.second_accesses * machine.second.sector_bytes
    }

    pub fn memory_bytes(&self) -> u64 {
        self.memory_read_bytes + self.memory_written_bytes
    }

    /// The same of several kernels, one after the other.
    pub fn plus(self, other: Self) -> Self {
        Self {
            warps: self.warps + other.warps,
            instructions: self.instructions + other.instructions,
            asked_bytes: self.asked_bytes + other.asked_bytes,
            lines: self.lines + other.lines,
            sectors: self.sectors + other.sectors,
            first_reads: self.first_reads + other.first_reads,
            first_misses: self.first_misses + other.first_misses,
            second_accesses: self.second_accesses + other.second_accesses,
            second_reads: self.second_reads + other.second_reads,
            second_misses: self.second_misses + other.second_misses,
            memory_read_bytes: self.memory_read_bytes + other.memory_read_bytes,
            memory_written_bytes: self.memory_written_bytes + other.memory_written_bytes,
        }
    }
}

/// The accesses of a warp: of its nth instruction those of all its invocations.
struct Warp {
    instructions: Vec<Vec<Access>>,
    next: usize,
}

/// A machine with cold caches.
struct Running<'a> {
    machine: &'a Machine,
    /// One a core.
    first: Vec<Cache>,
    second: Cache,
    counts: Counts,
    /// Sectors of an instruction, kept for their memory.
    sectors: Vec<u64>,
}

/// Runs a kernel on a machine whose caches are empty, and writes back what is left in them.
///
/// Workgroups go to the cores in turn. A core has some warps at once, of as many workgroups as it takes, each of which does one
/// instruction after the other in turn.
pub fn count(kernel: &dyn Kernel, machine: &Machine) -> Counts {
    let cores = machine.cores as usize;
    let mut running = Running {
        machine,
        first: (0..cores).map(|_| Cache::new(machine.first)).collect(),
        second: Cache::new(machine.second),
        counts: Counts::default(),
        sectors: Vec::new(),
    };
    let mut resident: Vec<Vec<Warp>> = (0..cores).map(|_| Vec::new()).collect();
    for (index, group) in groups_of(kernel).enumerate() {
        let core = index % cores;
        resident[core].extend(warps(kernel, group, machine));
        // All cores have had a workgroup, and one of them has all that it holds.
        if core == cores - 1 && resident.iter().any(|warps| warps.len() >= machine.resident_warps as usize) {
            running.drain(&mut resident);
        }
    }
    running.drain(&mut resident);
    let left = running.second.dirty_sectors() * machine.second.sector_bytes;
    running.counts.memory_written_bytes += left;
    running.counts
}

/// The warps of a workgroup.
fn warps(kernel: &dyn Kernel, group: [u32; 3], machine: &Machine) -> Vec<Warp> {
    let [width, height] = kernel.group_size();
    let [across, down] = machine.warp;
    // A workgroup that is not made of such rectangles is cut row by row.
    let is_tiled = width % across == 0 && height % down == 0;
    let place = |index: u32| match is_tiled {
        true => {
            let (warp, lane) = (index / (across * down), index % (across * down));
            let tiles = width / across;
            [warp % tiles * across + lane % across, warp / tiles * down + lane / across]
        }
        false => [index % width, index / width],
    };
    let lanes = across * down;
    (0..(width * height).div_ceil(lanes))
        .map(|warp| {
            let mut instructions: Vec<Vec<Access>> = Vec::new();
            let mut own = Vec::new();
            for index in warp * lanes..((warp + 1) * lanes).min(width * height) {
                own.clear();
                kernel.accesses(group, place(index), &mut own);
                instructions.resize_with(instructions.len().max(own.len()), Vec::new);
                own.iter().zip(&mut instructions).for_each(|(access, all)| all.extend(*access));
            }
            Warp { instructions, next: 0 }
        })
        .collect()
}

impl Running<'_> {
    /// Runs all warps that are there to their ends.
    fn drain(&mut self, resident: &mut [Vec<Warp>]) {
        loop {
            let mut is_done = true;
            for (core, warps) in resident.iter_mut().enumerate() {
                for warp in warps {
                    if let Some(accesses) = warp.instructions.get(warp.next) {
                        self.instruction(core, accesses);
                        warp.next += 1;
                        is_done = false;
                    }
                }
            }
            if is_done {
                break;
            }
        }
        for warps in resident {
            self.counts.warps += warps.len() as u64;
            warps.clear();
        }
    }

    fn instruction(&mut self, core: usize, accesses: &[Access]) {
        let sector_bytes = self.machine.first.sector_bytes;
        let mut sectors = std::mem::take(&mut self.sectors);
        self.counts.instructions += 1;
        for is_write in [false, true] {
            sectors.clear();
            for access in accesses.iter().filter(|access| access.is_write == is_write) {
                self.counts.asked_bytes += u64::from(access.bytes);
                let last = access.address + u64::from(access.bytes) - 1;
                sectors.extend(access.address / sector_bytes..=last / sector_bytes);
            }
            sectors.sort_unstable();
            sectors.dedup();
            self.counts.sectors += sectors.len() as u64;
            let mut line = None;
            for sector in &sectors {
                let address = sector * sector_bytes;
                let own = Some(address / self.machine.first.line_bytes);
                self.counts.lines += u64::from(line != own);
                line = own;
                if is_write { self.write(address) } else { self.read(core, address) }
            }
        }
        self.sectors = sectors;
    }

    fn read(&mut self, core: usize, address: u64) {
        self.counts.first_reads += 1;
        if self.first[core].read(address).is_hit {
            return;
        }
        self.counts.first_misses += 1;
        // A sector of the first cache may be several of the second, or a part of one.
        self.second_sectors(address, |running, address| {
            let outcome = running.second.read(address);
            running.counts.second_reads += 1;
            if !outcome.is_hit {
                running.counts.second_misses += 1;
                running.counts.memory_read_bytes += running.machine.second.sector_bytes;
            }
            outcome.written_back
        });
    }

    /// Writes go through the first cache, which does not keep them.
    fn write(&mut self, address: u64) {
        self.second_sectors(address, |running, address| running.second.write_back(address).written_back);
    }

    fn second_sectors(&mut self, address: u64, mut access: impl FnMut(&mut Self, u64) -> u32) {
        let [ours, theirs] = [self.machine.first.sector_bytes, self.machine.second.sector_bytes];
        for part in 0..(ours / theirs).max(1) {
            self.counts.second_accesses += 1;
            let written_back = access(self, address + part * theirs);
            self.counts.memory_written_bytes += u64::from(written_back) * theirs;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::locality::cache::Shape;

    /// Invocations that read 4 bytes, so far apart, and write 4 bytes one after the other, if at all.
    struct Strided {
        groups: u32,
        stride: u64,
        writes: bool,
    }

    impl Kernel for Strided {
        fn groups(&self) -> [u32; 3] {
            [self.groups, 1, 1]
        }

        fn group_size(&self) -> [u32; 2] {
            [64, 1]
        }

        fn accesses(&self, group: [u32; 3], local: [u32; 2], out: &mut Vec<Option<Access>>) {
            let index = u64::from(group[0] * 64 + local[0]);
            out.push(Some(Access::read(index * self.stride, 4)));
            if self.writes {
                out.push(Some(Access::write((1 << 30) + index * 4, 4)));
            }
        }
    }

    fn machine() -> Machine {
        let shape = |bytes| Shape { bytes, line_bytes: 128, sector_bytes: 32, ways: 4 };
        Machine { first: shape(4096), second: shape(65_536), ..Machine::known("volta-v100").unwrap() }
    }

    #[test]
    fn neighbours_share_lines_and_far_ones_do_not() {
        let of = |stride| count(&Strided { groups: 1, stride, writes: false }, &machine());
        // 32 lanes of 4 bytes are a line of four sectors; two warps.
        let near = of(4);
        assert_eq!([near.warps, near.instructions, near.lines, near.sectors, near.asked_bytes], [2, 2, 2, 8, 256]);
        assert_eq!([near.first_reads, near.first_misses, near.second_misses, near.memory_read_bytes], [8, 8, 8, 256]);
        let far = of(128);
        assert_eq!([far.lines, far.sectors, far.memory_read_bytes], [64, 64, 64 * 32]);
        assert_eq!(of(16).sectors, 64 / 2);
        // All lanes at one place.
        assert_eq!([of(0).sectors, of(0).first_misses], [2, 1]);
    }

    #[test]
    fn what_is_written_is_in_memory_at_the_end_and_once() {
        let counts = count(&Strided { groups: 40, stride: 4, writes: true }, &machine());
        assert_eq!([counts.memory_read_bytes, counts.memory_written_bytes], [40 * 256, 40 * 256]);
        // Writes pass the first cache by: each sector asks the second once, to read and to write.
        assert_eq!([counts.second_accesses, counts.second_reads], [2 * 40 * 8, 40 * 8]);
        assert_eq!(counts.plus(counts).warps, 160);
    }

    #[test]
    fn accesses_that_lie_across_sectors_count_both() {
        struct Across;
        impl Kernel for Across {
            fn groups(&self) -> [u32; 3] {
                [1, 1, 1]
            }

            fn group_size(&self) -> [u32; 2] {
                [1, 1]
            }

            fn accesses(&self, _: [u32; 3], _: [u32; 2], out: &mut Vec<Option<Access>>) {
                out.push(Some(Access::read(120, 16)));
            }
        }
        let counts = count(&Across, &machine());
        assert_eq!([counts.lines, counts.sectors], [2, 2]);
    }

    #[test]
    fn warps_are_rectangles_where_workgroups_are_made_of_them() {
        struct Square;
        impl Kernel for Square {
            fn groups(&self) -> [u32; 3] {
                [1, 1, 1]
            }

            fn group_size(&self) -> [u32; 2] {
                [16, 16]
            }

            fn accesses(&self, _: [u32; 3], [x, y]: [u32; 2], out: &mut Vec<Option<Access>>) {
                // A row a line of 128 bytes.
                out.push(Some(Access::read(u64::from(y) * 4096 + u64::from(x) * 4, 4)));
            }
        }
        let lines = |warp| count(&Square, &Machine { warp, ..machine() }).lines;
        // 8 warps: two rows of 16 each, or four rows of 8.
        assert_eq!([lines([32, 1]), lines([16, 2]), lines([8, 4])], [16, 16, 32]);
    }
}

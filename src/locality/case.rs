//! A case: a split with its gather at one frame size, pattern and block, and what its passes come to on a machine.

use super::copies::{Copy, Memory, Pass};
use super::machine::Machine;
use super::stage::{PassCounts, StageKind, Studied, check_sides, label, pair_text, rounded_block};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::MappingParams;
use crate::techniques::interleaved_deferred::mapping::mapping;
use crate::techniques::interleaved_deferred::split_method::{Form, Split, StorageKind};
use crate::units::Extent;

/// What is studied.
#[derive(Clone, Debug)]
pub struct Case {
    pub extent: Extent,
    pub split: Split,
    pub pattern: [u32; 2],
    /// A multiple of the pattern; the pattern itself where the split has no blocks.
    pub block: [u32; 2],
    pub form: Form,
    pub storage: StorageKind,
    pub workgroup: [u32; 2],
}

/// What a case came to.
pub struct Found {
    pub split: Vec<PassCounts>,
    pub gather: Vec<PassCounts>,
}

impl Case {
    /// Rounds the block up to whole patterns.
    ///
    /// Errors: the split is none that compute shaders copy for, or a size is 0 or too large (exit code 2).
    pub fn checked(self) -> Result<Self> {
        let Self { extent, split, pattern, block, workgroup, .. } = self;
        check_sides(extent, pattern, block, workgroup)?;
        if !matches!(split, Split::OnePass | Split::TwoPass | Split::Tile) {
            return Err(Error::request(format!("split={}: its addresses are not studied", split.name()))
                .note("one-pass, two-pass and tile are"));
        }
        if split == Split::Tile && self.form == Form::Push {
            return Err(Error::request("split=tile copy=push: it knows one form"));
        }
        Ok(Self { block: rounded_block(split != Split::OnePass, pattern, block), ..self })
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        let Self { split, pattern, block, form, storage, .. } = self;
        let block = (*split != Split::OnePass).then(|| ("block", pair_text(*block)));
        [("split", split.name().to_owned()), ("pattern", pair_text(*pattern))]
            .into_iter()
            .chain(block)
            .chain([("copy", form.name().to_owned()), ("storage", storage.name().to_owned())])
            .collect()
    }

    /// `split=two-pass pattern=4x4 block=16x16 copy=pull storage=image`.
    pub fn label(&self) -> String {
        label(&self.settings())
    }

    fn passes(&self) -> (&'static [Pass], &'static [Pass]) {
        match self.split {
            Split::TwoPass => {
                (&[Pass::SplitBlocks, Pass::SplitTranslate], &[Pass::GatherTranslate, Pass::GatherBlocks])
            }
            Split::Tile => (&[Pass::SplitTile], &[Pass::GatherTile]),
            _ => (&[Pass::SplitOnePass], &[Pass::GatherOnePass]),
        }
    }

    pub fn mapping(&self) -> MappingParams {
        mapping(self.extent, self.pattern, self.block)
    }

    /// Its memory on a machine.
    pub fn memory(&self, mapping: &MappingParams, machine: &Machine) -> Memory {
        Memory::new(mapping, self.storage, machine.layout())
    }

    /// Each pass with cold caches.
    pub fn counted(&self, machine: &Machine) -> Found {
        let (split, gather) = self.passes();
        Found { split: self.counted_passes(split, machine), gather: self.counted_passes(gather, machine) }
    }

    fn counted_passes(&self, passes: &[Pass], machine: &Machine) -> Vec<PassCounts> {
        let mapping = self.mapping();
        let memory = self.memory(&mapping, machine);
        let one = |pass: &Pass| {
            let kernel =
                Copy { pass: *pass, form: self.form, mapping: &mapping, memory: &memory, group_size: self.workgroup };
            PassCounts::of(pass.name(), &kernel, machine)
        };
        passes.iter().map(one).collect()
    }
}

/// One way of a case: there, or back.
pub struct CopyStage {
    pub case: Case,
    pub is_back: bool,
}

impl Studied for CopyStage {
    fn stage(&self) -> StageKind {
        if self.is_back { StageKind::Gather } else { StageKind::Split }
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        self.case.settings()
    }

    fn extent(&self) -> Extent {
        self.case.extent
    }

    fn workgroup(&self) -> [u32; 2] {
        self.case.workgroup
    }

    fn counted(&self, machine: &Machine) -> Vec<PassCounts> {
        let (split, gather) = self.case.passes();
        self.case.counted_passes(if self.is_back { gather } else { split }, machine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::locality::access::{Access, Kernel, accesses_of, groups_of};
    use crate::locality::stage::total;
    use std::collections::HashMap;

    fn case(split: Split, form: Form, storage: StorageKind) -> Case {
        let (pattern, block) = ([4, 2], [12, 4]);
        Case { extent: Extent::new(33, 17), split, pattern, block, form, storage, workgroup: [8, 4] }.checked().unwrap()
    }

    /// Every access of a pass.
    fn accesses(case: &Case, pass: Pass, mapping: &MappingParams, memory: &Memory) -> Vec<Access> {
        accesses_of(&Copy { pass, form: case.form, mapping, memory, group_size: case.workgroup })
    }

    /// Words of 8 bytes that a list of accesses reads, or writes, with how often.
    fn words(accesses: &[Access], is_write: bool) -> HashMap<u64, u32> {
        let mut words = HashMap::new();
        for access in accesses.iter().filter(|access| access.is_write == is_write) {
            for word in 0..u64::from(access.bytes) / 8 {
                *words.entry(access.address + 8 * word).or_default() += 1;
            }
        }
        words
    }

    const CASES: [(Split, Form); 5] = [
        (Split::OnePass, Form::Pull),
        (Split::OnePass, Form::Push),
        (Split::TwoPass, Form::Pull),
        (Split::TwoPass, Form::Push),
        (Split::Tile, Form::Pull),
    ];

    /// Each texel is written once, whoever writes it; the last pass of a split writes the sub-buffers, the first of a gather reads them.
    #[test]
    fn every_copy_writes_each_texel_once() {
        let machine = Machine::known("volta-v100").unwrap();
        for (split, form) in CASES {
            for storage in [StorageKind::Buffer, StorageKind::Image] {
                let case = case(split, form, storage);
                let mapping = case.mapping();
                let memory = case.memory(&mapping, &machine);
                let (splits, gathers) = case.passes();
                for pass in splits {
                    let all = accesses(&case, *pass, &mapping, &memory);
                    let written = words(&all, true);
                    assert!(written.values().all(|times| *times == 1), "{} {pass:?}", case.label());
                    assert_eq!(written.len() as u64, 2 * mapping.texel_count(), "{} {pass:?}", case.label());
                }
                for pass in gathers {
                    let written = words(&accesses(&case, *pass, &mapping, &memory), true);
                    assert!(written.values().all(|times| *times == 1), "{} {pass:?}", case.label());
                    let into_frame = [Pass::GatherOnePass, Pass::GatherBlocks, Pass::GatherTile].contains(pass);
                    // Pairs write the padding of an odd row too.
                    let pairs = form == Form::Pull && *pass != Pass::GatherTile;
                    let frame = if pairs { mapping.frame_texel_count() } else { mapping.extent().pixel_count() };
                    let expected = if into_frame { frame } else { mapping.texel_count() };
                    assert_eq!(written.len() as u64, expected, "{} {pass:?}", case.label());
                }
            }
        }
    }

    /// What a split does to numbered pixels: each sub-buffer has those of its subset, in order, whichever way they went. What goes
    /// through workgroup memory is written by other invocations than read it.
    #[test]
    fn what_is_copied_is_what_the_mapping_says() {
        let machine = Machine::known("rdna2-navi22").unwrap();
        for (split, form) in CASES.into_iter().filter(|(split, _)| *split != Split::Tile) {
            for storage in [StorageKind::Buffer, StorageKind::Image] {
                let case = case(split, form, storage);
                let mapping = case.mapping();
                let memory = case.memory(&mapping, &machine);
                // Positions alone: the parts of a surface move alike.
                let mut held: HashMap<u64, [u32; 2]> = HashMap::new();
                for y in 0..mapping.height_px {
                    for x in 0..mapping.width_px {
                        held.insert(memory.gbuffer[0].texel([x, y]), [x, y]);
                    }
                }
                for pass in case.passes().0 {
                    let kernel =
                        Copy { pass: *pass, form, mapping: &mapping, memory: &memory, group_size: case.workgroup };
                    run(&kernel, &case, &mut held);
                }
                for subset in 0..mapping.subset_count() {
                    for y in 0..mapping.sub_height_px {
                        for x in 0..mapping.sub_width_px {
                            let pixel = mapping.pixel_of_texel([x, y, subset]);
                            if mapping.is_in_frame(pixel) {
                                let at = memory.sub_buffers.of_sub_buffer(0, &mapping, [x, y, subset]);
                                assert_eq!(held.get(&at), Some(&pixel), "{} {x} {y} {subset}", case.label());
                            }
                        }
                    }
                }
            }
        }
    }

    /// Moves what is held: the nth word that an invocation writes of a part is the nth that it read of it.
    fn run(kernel: &Copy<'_>, case: &Case, held: &mut HashMap<u64, [u32; 2]>) {
        let mut moved = Vec::new();
        for group in groups_of(kernel) {
            for y in 0..case.workgroup[1] {
                for x in 0..case.workgroup[0] {
                    let mut all = Vec::new();
                    kernel.accesses(group, [x, y], &mut all);
                    // Parts take turns: position, normal. What is left out keeps its turn.
                    let of_position = |is_write: bool| {
                        let mut words = Vec::new();
                        let mut turn = 0;
                        for access in &all {
                            let is_own = access.is_none_or(|access| access.is_write == is_write);
                            // Only reads are left out.
                            if !is_own || access.is_none() && is_write {
                                continue;
                            }
                            if turn % 2 == 0 {
                                let access = access.expect("a position is always read");
                                words.extend((0..u64::from(access.bytes) / 8).map(|word| access.address + 8 * word));
                            }
                            turn += 1;
                        }
                        words
                    };
                    let (from, to) = (of_position(false), of_position(true));
                    assert_eq!(from.len(), to.len(), "{}", case.label());
                    moved.extend(to.into_iter().zip(from).filter_map(|(to, from)| Some((to, *held.get(&from)?))));
                }
            }
        }
        held.extend(moved);
    }

    #[test]
    fn counts_of_a_small_frame_are_those_counted_on_paper() {
        // 64 x 16 pixels in patterns of 4 x 4: 16 sub-buffers of 16 x 4, in buffers: two texels a thread, 8 threads a row.
        let machine = Machine { layout: "linear".to_owned(), ..Machine::known("volta-v100").unwrap() };
        let (pattern, block) = ([4, 4], [4, 4]);
        let case = Case {
            extent: Extent::new(64, 16),
            split: Split::OnePass,
            pattern,
            block,
            form: Form::Pull,
            storage: StorageKind::Buffer,
            workgroup: [8, 4],
        };
        let found = case.checked().unwrap().counted(&machine);
        let split = total(&found.split);
        // A workgroup is a warp: 8 threads of 4 sub-buffers. 16 threads down in 4 groups, 4 rows.
        assert_eq!((split.warps, split.instructions), (16, 16 * 6));
        // 16 bytes of each of 1024 pixels are read and written.
        assert_eq!(split.asked_bytes, 2 * 1024 * 16);
        // An instruction reads every eighth pixel of a row for four neighbouring sub-buffers: with the other texel of the pair
        // all of the row's 16 sectors, of which it sees half: 8 places of 4 x 8 bytes are 8 sectors.
        let reads = 16 * 4 * 8;
        // It writes 8 times 16 bytes of 4 sub-buffers: 4 sectors each.
        let writes = 16 * 2 * 4 * 4;
        assert_eq!(split.sectors, reads + writes);
        // Memory sees each byte once.
        assert_eq!((split.memory_read_bytes, split.memory_written_bytes), (1024 * 16, 1024 * 16));
    }

    #[test]
    fn cases_that_cannot_be_are_refused() {
        let with = |change: fn(&mut Case)| {
            let mut case = case(Split::OnePass, Form::Pull, StorageKind::Buffer);
            change(&mut case);
            case.checked().err().map(|error| error.message().to_owned()).unwrap_or_default()
        };
        assert!(with(|case| case.split = Split::Branch).contains("split=branch: its addresses are not studied"));
        assert!(with(|case| case.pattern = [0, 1]).contains("sides are 1 to"));
        assert!(with(|case| (case.split, case.form) = (Split::Tile, Form::Push)).contains("one form"));
        assert_eq!(with(|case| case.block = [13, 5]), "");
    }
}

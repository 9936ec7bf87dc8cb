//! What a frame touched, pass by pass, as the marks of its passes say.

use super::shape::{Part, Shape};
use std::collections::{BTreeMap, BTreeSet};

/// Reads, or writes, of one resource: granules with a mark, and bytes asked for, each access anew.
#[derive(Clone, Debug, Default)]
pub struct Accesses {
    pub marks: Vec<u32>,
    pub asked_bytes: u64,
}

/// What a pass, or a frame, did to a resource.
#[derive(Clone, Debug)]
pub struct Touches {
    pub shape: Shape,
    pub reads: Accesses,
    pub writes: Accesses,
}

/// A pass with the resources that it touched, by name.
#[derive(Clone, Debug)]
pub struct PassTouches {
    pub pass: String,
    /// Invocations of compute and fragment shaders.
    pub invocations: u64,
    pub resources: BTreeMap<String, Touches>,
    /// Resources that it touched in a way that nobody counts.
    pub unknown: BTreeSet<String>,
}

/// A frame's passes.
#[derive(Clone, Debug, Default)]
pub struct FrameTouches {
    pub passes: Vec<PassTouches>,
}

impl Accesses {
    /// Adds what was counted elsewhere.
    pub fn add(&mut self, marks: &[u32], asked_bytes: u64) {
        self.marks.resize(self.marks.len().max(marks.len()), 0);
        self.marks.iter_mut().zip(marks).for_each(|(own, more)| *own |= more);
        self.asked_bytes += asked_bytes;
    }

    fn add_part(&mut self, shape: &Shape, part: &Part) {
        let (granules, bytes) = shape.part(part);
        self.marks.resize(self.marks.len().max(granules.end.div_ceil(32) as usize), 0);
        for granule in granules {
            self.marks[(granule / 32) as usize] |= 1 << (granule % 32);
        }
        self.asked_bytes += bytes;
    }
}

impl Touches {
    pub fn none(shape: Shape) -> Self {
        Self { shape, reads: Accesses::default(), writes: Accesses::default() }
    }

    pub fn add_part(&mut self, writes: bool, part: &Part) {
        let accesses = if writes { &mut self.writes } else { &mut self.reads };
        accesses.add_part(&self.shape, part);
    }

    pub fn add(&mut self, other: &Self) {
        self.reads.add(&other.reads.marks, other.reads.asked_bytes);
        self.writes.add(&other.writes.marks, other.writes.asked_bytes);
    }

    /// Granules that are read or written.
    pub fn all_marks(&self) -> Vec<u32> {
        let mut all = self.reads.clone();
        all.add(&self.writes.marks, 0);
        all.marks
    }
}

impl FrameTouches {
    /// The pass of this name, which comes last where there was none.
    pub fn pass(&mut self, name: &str) -> &mut PassTouches {
        let place = self.passes.iter().position(|known| known.pass == name).unwrap_or_else(|| {
            self.passes.push(PassTouches {
                pass: name.to_owned(),
                invocations: 0,
                resources: BTreeMap::new(),
                unknown: BTreeSet::new(),
            });
            self.passes.len() - 1
        });
        &mut self.passes[place]
    }

    /// What all passes together did, by resource.
    pub fn resources(&self) -> BTreeMap<&str, Touches> {
        let mut all = BTreeMap::<&str, Touches>::new();
        for (name, touches) in self.passes.iter().flat_map(|pass| &pass.resources) {
            all.entry(name).or_insert_with(|| Touches::none(touches.shape)).add(touches);
        }
        all
    }
}

impl PassTouches {
    pub fn of(&mut self, name: &str, shape: Shape) -> &mut Touches {
        let touches = self.resources.entry(name.to_owned()).or_insert_with(|| Touches::none(shape));
        assert_eq!(touches.shape, shape, "{name}: a frame has two resources of one name");
        touches
    }
}

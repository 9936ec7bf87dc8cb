//! Resources: a plan made real.

use super::{Part, Plan, Planned, Shape, Sharing};
use crate::error::Result;
use crate::gpu::commands::{Heirs, Touched};
use crate::gpu::{Berth, Buffer, Gpu, Image, Target};
use crate::memory::Arena;
use crate::memory::kinds::Use;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// The plan made real: each pass takes its resources out by name.
#[derive(Default)]
pub struct Resources {
    buffers: BTreeMap<String, Buffer>,
    images: BTreeMap<String, Image>,
    /// By index into the plan.
    targets: Vec<Target>,
}

impl Resources {
    /// Makes every resource of the plan; those that share bytes in one arena a memory type, called `NAME.shared`.
    ///
    /// Errors: memory is too small (exit code 4).
    pub fn make(gpu: &Arc<Gpu>, name: &str, plan: &Plan, sharing: &Sharing) -> Result<Self> {
        let arenas = sharing
            .arenas
            .iter()
            .enumerate()
            .map(|(index, arena)| {
                let (bytes, alignment, bits) = (arena.bytes, arena.alignment_bytes, arena.memory_type_bits);
                gpu.memory.arena(&sharing.arena_name(name, index), "shared", bytes, alignment, bits, Use::Device)
            })
            .collect::<Result<Vec<_>>>()?;
        let mut resources = Self::default();
        for (index, planned) in plan.resources.iter().enumerate() {
            resources.add(gpu, planned, sharing.part(index).map(|(arena, part)| (&arenas[arena], part)))?;
        }
        Ok(resources)
    }

    fn add(&mut self, gpu: &Arc<Gpu>, planned: &Planned, part: Option<(&Arc<Arena>, &Part)>) -> Result<()> {
        let Planned { name, group, .. } = planned;
        let berth = part.map_or(Berth::Own, |(arena, part)| Berth::Part {
            arena,
            offset: part.offset,
            takes_over: part.takes_over,
        });
        let target = match planned.shape {
            Shape::Buffer { bytes, flags, usage } => {
                let buffer = Buffer::at(gpu, name, group, bytes, flags, usage, berth)?;
                let target = buffer.target();
                self.buffers.insert(name.clone(), buffer);
                target
            }
            Shape::Image(description) => {
                let image = Image::at(gpu, name, group, description, berth)?;
                let target = image.target();
                self.images.insert(name.clone(), image);
                target
            }
        };
        self.targets.push(target);
        Ok(())
    }

    /// Takes a buffer out. The plan has it: another name is a programmer's mistake.
    pub fn buffer(&mut self, name: &str) -> Buffer {
        self.buffers.remove(name).unwrap_or_else(|| panic!("the plan has no buffer {name}, or it was taken"))
    }

    /// Takes an image out. The plan has it: another name is a programmer's mistake.
    pub fn image(&mut self, name: &str) -> Image {
        self.images.remove(name).unwrap_or_else(|| panic!("the plan has no image {name}, or it was taken"))
    }

    /// The resources whose bytes each resource takes over.
    pub fn heirs(&self, sharing: &Sharing) -> Heirs {
        let parts = sharing.arenas.iter().flat_map(|arena| &arena.parts);
        parts
            .map(|part| {
                let before = part.predecessors.iter().map(|resource| self.targets[*resource]).collect();
                (self.targets[part.resource], before)
            })
            .collect()
    }

    /// Panics where the recorded passes touch transient resources otherwise than the plan says: lifetimes, and with
    /// them shared bytes, rest on it.
    pub fn assert_recorded(&self, plan: &Plan, pass_names: &[&str], touched: &[Touched]) {
        let planned: Vec<&str> = plan.passes.iter().map(|pass| pass.name.as_str()).collect();
        assert_eq!(planned, pass_names, "the plan's passes and the recorded ones");
        let indices: HashMap<Target, usize> =
            self.targets.iter().enumerate().map(|(index, target)| (*target, index)).collect();
        for (index, pass) in plan.passes.iter().enumerate() {
            let name_of = |resource: usize| plan.resources[resource].name.as_str();
            let mut says: Vec<String> = pass
                .touches
                .iter()
                .filter(|touch| plan.is_transient(touch.resource))
                .map(|touch| format!("{} {:?}", name_of(touch.resource), touch.access))
                .collect();
            let mut does: Vec<String> = touched
                .iter()
                .filter(|touch| touch.pass == index)
                .filter_map(|touch| {
                    let resource = *indices.get(&touch.target)?;
                    plan.is_transient(resource).then(|| format!("{} {:?}", name_of(resource), touch.access))
                })
                .collect();
            for list in [&mut says, &mut does] {
                list.sort();
                list.dedup();
            }
            assert_eq!(says, does, "{}: what the plan says it touches, and what was recorded", pass.name);
        }
    }
}

//! Resources: a plan made real.

use super::{Plan, Shape};
use crate::error::Result;
use crate::gpu::commands::Touched;
use crate::gpu::{Buffer, Gpu, Image, Target};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// The plan made real: each pass takes its resources out by name.
#[derive(Default)]
pub struct Resources {
    buffers: BTreeMap<String, Buffer>,
    images: BTreeMap<String, Image>,
    /// Which resource of the plan a handle is.
    indices: HashMap<Target, usize>,
}

impl Resources {
    /// Makes every resource of the plan.
    ///
    /// Errors: memory is too small or a limit is passed (exit code 4).
    pub fn make(gpu: &Arc<Gpu>, plan: &Plan) -> Result<Self> {
        plan.check(gpu.caps.limits.max_storage_buffer_range_bytes)?;
        let mut resources = Self::default();
        for (index, planned) in plan.resources.iter().enumerate() {
            let target = match planned.shape {
                Shape::Buffer { bytes, flags, usage } => {
                    let buffer = Buffer::new(gpu, &planned.name, planned.group, bytes, flags, usage)?;
                    let target = buffer.target();
                    resources.buffers.insert(planned.name.clone(), buffer);
                    target
                }
                Shape::Image(description) => {
                    let image = Image::new(gpu, &planned.name, planned.group, description)?;
                    let target = image.target();
                    resources.images.insert(planned.name.clone(), image);
                    target
                }
            };
            resources.indices.insert(target, index);
        }
        Ok(resources)
    }

    /// Takes a buffer out. The plan has it: another name is a programmer's mistake.
    pub fn buffer(&mut self, name: &str) -> Buffer {
        self.buffers.remove(name).unwrap_or_else(|| panic!("the plan has no buffer {name}, or it was taken"))
    }

    /// Takes an image out. The plan has it: another name is a programmer's mistake.
    pub fn image(&mut self, name: &str) -> Image {
        self.images.remove(name).unwrap_or_else(|| panic!("the plan has no image {name}, or it was taken"))
    }

    /// Panics where the recorded passes touch transient resources otherwise than the plan says: lifetimes, and with
    /// them shared bytes, rest on it.
    pub fn assert_recorded(&self, plan: &Plan, pass_names: &[&str], touched: &[Touched]) {
        let planned: Vec<&str> = plan.passes.iter().map(|pass| pass.name.as_str()).collect();
        assert_eq!(planned, pass_names, "the plan's passes and the recorded ones");
        for (index, pass) in plan.passes.iter().enumerate() {
            let name_of = |resource: usize| plan.resources[resource].name.as_str();
            let mut says: Vec<String> =
                pass.touches.iter().map(|touch| format!("{} {:?}", name_of(touch.resource), touch.access)).collect();
            let mut does: Vec<String> = touched
                .iter()
                .filter(|touch| touch.pass == index)
                .filter_map(|touch| {
                    let resource = *self.indices.get(&touch.target)?;
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

//! Descriptor sets, written from what a pass binds by name. They live as long as the frame that was recorded with them.

use super::buffer::Buffer;
use super::image::Image;
use super::interface::Interface;
use super::marks::Slots;
use super::shader::BindingKind;
use super::{Access, Gpu, Structure};
use crate::error::{Error, Result};
use ash::vk;
use std::collections::HashMap;
use std::sync::Arc;

/// Something a shader binds, by its name in GLSL.
#[derive(Clone, Copy)]
pub enum Bound<'a> {
    Buffer(&'a Buffer),
    /// Through a storage image descriptor; layout GENERAL.
    Storage(&'a Image),
    /// Through a sampler, layout as `access` has it.
    Sampled(&'a Image, vk::Sampler, Access),
    /// The acceleration structure that rays are traced through.
    Structure(&'a Structure),
}

/// The sets of one recorded frame.
pub struct Descriptors {
    gpu: Arc<Gpu>,
    pools: Vec<vk::DescriptorPool>,
    /// Slots of the sets, on a device that counts.
    slots: HashMap<vk::DescriptorSet, Arc<Slots>>,
}

impl Descriptors {
    pub fn new(gpu: &Arc<Gpu>) -> Self {
        Self { gpu: gpu.clone(), pools: Vec::new(), slots: HashMap::new() }
    }

    /// A set for `interface`, written from what is bound by name; None where its shaders bind nothing.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn set(&mut self, interface: &Interface, bound: &[(&str, Bound<'_>)]) -> Result<Option<vk::DescriptorSet>> {
        for (name, _) in bound {
            let known = interface.bindings.iter().any(|binding| binding.name == *name);
            assert!(known, "{}: nothing is called {name}", interface.label);
        }
        if interface.bindings.is_empty() && self.gpu.marks.is_none() {
            return Ok(None);
        }
        let set = self.allocate(interface)?;
        self.count(set, interface, bound)?;
        for binding in &interface.bindings {
            let (_, value) = bound
                .iter()
                .find(|(name, _)| *name == binding.name)
                .unwrap_or_else(|| panic!("{}: {} is not bound", interface.label, binding.name));
            let mut buffer_info = [vk::DescriptorBufferInfo::default()];
            let mut image_info = [vk::DescriptorImageInfo::default()];
            let mut structures = [vk::AccelerationStructureKHR::null()];
            let mut structure_info = vk::WriteDescriptorSetAccelerationStructureKHR::default();
            let write = vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(binding.binding)
                .descriptor_type(binding.kind.descriptor_type());
            let write = match (binding.kind, value) {
                (BindingKind::StorageBuffer | BindingKind::UniformBuffer, Bound::Buffer(buffer)) => {
                    // Shaders come to what lies behind the range by the buffer's address, or the plan has refused it.
                    let range = buffer.bytes.min(self.gpu.caps.limits.max_storage_buffer_range_bytes);
                    buffer_info[0] = buffer_info[0].buffer(buffer.handle).range(range);
                    write.buffer_info(&buffer_info)
                }
                (BindingKind::StorageImage, Bound::Storage(image)) => {
                    image_info[0] = image_info[0].image_view(image.storage_view).image_layout(vk::ImageLayout::GENERAL);
                    write.image_info(&image_info)
                }
                (BindingKind::CombinedImageSampler, Bound::Sampled(image, sampler, access)) => {
                    image_info[0] =
                        image_info[0].image_view(image.sampled_view).sampler(*sampler).image_layout(access.layout());
                    write.image_info(&image_info)
                }
                (BindingKind::AccelerationStructure, Bound::Structure(structure)) => {
                    structures[0] = structure.handle;
                    structure_info = structure_info.acceleration_structures(&structures);
                    write.descriptor_count(1).push_next(&mut structure_info)
                }
                (kind, _) => {
                    panic!("{}: {} is a {kind:?} and was bound as something else", interface.label, binding.name)
                }
            };
            // SAFETY: the set is fresh, the resources are alive and outlive the recorded frame.
            unsafe { self.gpu.device.update_descriptor_sets(&[write], &[]) };
        }
        Ok(Some(set))
    }

    /// Slots of a set, through which its shaders count.
    fn count(&mut self, set: vk::DescriptorSet, interface: &Interface, bound: &[(&str, Bound<'_>)]) -> Result<()> {
        let Some(marks) = &self.gpu.marks else { return Ok(()) };
        let mut slots = marks.slots(interface.has_vertices)?;
        for (name, value) in bound {
            let binding = interface.bindings.iter().find(|binding| binding.name == *name);
            let (marked, sampler) = match value {
                Bound::Buffer(buffer) => (&buffer.marked, None),
                Bound::Storage(image) => (&image.marked, None),
                Bound::Sampled(image, sampler, _) => (&image.marked, Some(*sampler)),
                Bound::Structure(structure) => {
                    slots.add_unknown(&structure.buffer.name);
                    structure.beneath.iter().for_each(|name| slots.add_unknown(name));
                    continue;
                }
            };
            if let (Some(binding), Some(marked)) = (binding, marked) {
                slots.set_binding(binding.binding, marked, sampler);
            }
        }
        slots.write_to(&self.gpu.device, set);
        self.slots.insert(set, Arc::new(slots));
        Ok(())
    }

    /// The slots of a set; None where nobody counts.
    pub(super) fn slots(&self, set: vk::DescriptorSet) -> Option<&Arc<Slots>> {
        self.slots.get(&set)
    }

    fn allocate(&mut self, interface: &Interface) -> Result<vk::DescriptorSet> {
        let layouts = [interface.set_layouts[0]];
        for fresh in [false, true] {
            if fresh {
                self.pools.push(new_pool(&self.gpu)?);
            }
            let Some(pool) = self.pools.last() else { continue };
            let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(*pool).set_layouts(&layouts);
            // SAFETY: a live pool and layout; a full pool answers with an error and is followed by a new one.
            match unsafe { self.gpu.device.allocate_descriptor_sets(&info) } {
                Ok(sets) => {
                    self.gpu.name(sets[0], &interface.label);
                    return Ok(sets[0]);
                }
                Err(result) if fresh => {
                    return Err(Error::device(format!("{}: allocating descriptors: {result}", interface.label)));
                }
                Err(_) => {}
            }
        }
        unreachable!("the second round returns")
    }
}

fn new_pool(gpu: &Gpu) -> Result<vk::DescriptorPool> {
    // Enough for any frame of today; a frame that needs more gets a second pool.
    let mut sizes = vec![
        (vk::DescriptorType::STORAGE_BUFFER, 256),
        (vk::DescriptorType::UNIFORM_BUFFER, 64),
        (vk::DescriptorType::STORAGE_IMAGE, 64),
        (vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 128),
    ];
    if gpu.caps.features.ray_query {
        sizes.push((vk::DescriptorType::ACCELERATION_STRUCTURE_KHR, 16));
    }
    let sizes: Vec<_> =
        sizes.into_iter().map(|(ty, descriptor_count)| vk::DescriptorPoolSize { ty, descriptor_count }).collect();
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(64).pool_sizes(&sizes);
    // SAFETY: a live device.
    unsafe { gpu.device.create_descriptor_pool(&info, None) }
        .map_err(|result| Error::device(format!("creating a descriptor pool: {result}")))
}

impl Drop for Descriptors {
    fn drop(&mut self) {
        // SAFETY: nothing recorded with the sets is running.
        unsafe { self.pools.iter().for_each(|pool| self.gpu.device.destroy_descriptor_pool(*pool, None)) };
    }
}

impl Interface {
    /// Entries of `bound` that its shaders declare.
    pub fn own<'a>(&self, bound: &[(&'static str, Bound<'a>)]) -> Vec<(&'static str, Bound<'a>)> {
        let is_own = |name: &str| self.bindings.iter().any(|binding| binding.name == name);
        bound.iter().filter(|(name, _)| is_own(name)).copied().collect()
    }
}

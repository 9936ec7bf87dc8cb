//! What a pipeline binds: descriptor set layouts and push constants, from its shaders and not from hands.

use super::shader::{Binding, BindingKind, Shader};
use super::{Gpu, marks};
use crate::error::{Error, Result};
use ash::vk;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Descriptor set layouts and push constants of one pipeline.
pub struct Interface {
    gpu: Arc<Gpu>,
    pub layout: vk::PipelineLayout,
    /// Set 0 is the pass's own. Sets above it belong to others, such as the materials'.
    pub set_layouts: Vec<vk::DescriptorSetLayout>,
    owned: Vec<vk::DescriptorSetLayout>,
    pub bindings: Vec<Binding>,
    pub push_stages: vk::ShaderStageFlags,
    pub push_bytes: u32,
    pub label: String,
    /// A stage of it is made of vertices.
    pub has_vertices: bool,
}

impl Interface {
    /// `foreign`: layouts for sets from 1 on that were made elsewhere.
    pub(super) fn new(gpu: &Arc<Gpu>, shaders: &[&Shader], foreign: &[vk::DescriptorSetLayout]) -> Result<Self> {
        let label = shaders.iter().map(|shader| shader.label()).collect::<Vec<_>>().join("+");
        shaders.iter().try_for_each(|shader| require_bindable(shader, gpu))?;
        let mut merged: BTreeMap<u32, (Binding, vk::ShaderStageFlags)> = BTreeMap::new();
        let mut push_stages = vk::ShaderStageFlags::empty();
        let mut push_bytes = 0;
        for shader in shaders {
            for binding in shader.bindings.iter().filter(|binding| binding.set == 0) {
                let slot = merged.entry(binding.binding).or_insert((*binding, vk::ShaderStageFlags::empty()));
                assert!(
                    slot.0.name == binding.name && slot.0.kind == binding.kind,
                    "{label}: binding {} is {} in one stage and {} in another",
                    binding.binding,
                    slot.0.name,
                    binding.name
                );
                slot.1 |= shader.stage.flags();
            }
            let sets = shader.bindings.iter().map(|binding| binding.set).max().unwrap_or(0) as usize;
            assert!(sets <= foreign.len(), "{label}: it reads set {sets}, and {} were given", foreign.len());
            if let Some(params) = &shader.params {
                push_stages |= shader.stage.flags();
                push_bytes = push_bytes.max(params.size_bytes.next_multiple_of(4));
            }
        }
        let all_stages = shaders.iter().fold(vk::ShaderStageFlags::empty(), |all, shader| all | shader.stage.flags());
        let marks = gpu.marks.as_ref().map(|_| marks::layout_binding(all_stages));
        let layout_bindings: Vec<_> = merged
            .values()
            .map(|(binding, stages)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding.binding)
                    .descriptor_type(binding.kind.descriptor_type())
                    .descriptor_count(binding.count)
                    .stage_flags(*stages)
            })
            .chain(marks)
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&layout_bindings);
        // SAFETY: a live device; the bindings outlive the call.
        let own = unsafe { gpu.device.create_descriptor_set_layout(&info, None) }
            .map_err(|result| Error::device(format!("creating the descriptor set layout of {label}: {result}")))?;
        let mut set_layouts = vec![own];
        set_layouts.extend_from_slice(foreign);
        let ranges = [vk::PushConstantRange { stage_flags: push_stages, offset: 0, size: push_bytes }];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts);
        if push_bytes > 0 {
            info = info.push_constant_ranges(&ranges);
        }
        let bindings = merged.values().map(|(binding, _)| *binding).collect();
        // SAFETY: as above.
        match unsafe { gpu.device.create_pipeline_layout(&info, None) } {
            Ok(layout) => {
                gpu.name(own, &label);
                gpu.name(layout, &label);
                let owned = vec![own];
                let has_vertices = all_stages.contains(vk::ShaderStageFlags::VERTEX);
                let gpu = gpu.clone();
                Ok(Self { gpu, layout, set_layouts, owned, bindings, push_stages, push_bytes, label, has_vertices })
            }
            Err(result) => {
                // SAFETY: never used.
                unsafe { gpu.device.destroy_descriptor_set_layout(own, None) };
                Err(Error::device(format!("creating the pipeline layout of {label}: {result}")))
            }
        }
    }
}

/// Errors: a stage binds more of a kind than the device lets one (exit code 3).
fn require_bindable(shader: &Shader, gpu: &Gpu) -> Result<()> {
    let limits = &gpu.caps.limits;
    for (kinds, most, limit) in [
        (&[BindingKind::StorageBuffer][..], limits.max_storage_buffers_per_stage, "StorageBuffers"),
        (&[BindingKind::StorageImage], limits.max_storage_images_per_stage, "StorageImages"),
        (
            &[BindingKind::SampledImage, BindingKind::CombinedImageSampler],
            limits.max_sampled_images_per_stage,
            "SampledImages",
        ),
    ] {
        let of_kind = shader.bindings.iter().filter(|binding| kinds.contains(&binding.kind));
        let own: u32 = of_kind.map(|binding| binding.count).sum();
        let counts = gpu.marks.is_some() && kinds.contains(&BindingKind::StorageBuffer);
        // Each set has the marks too.
        let sets = 1 + shader.bindings.iter().map(|binding| binding.set).max().unwrap_or(0);
        let count = own + if counts { sets } else { 0 };
        if count > most {
            let (label, device) = (shader.label(), &gpu.caps.identity.name);
            let why =
                format!("{label} binds {count}, and {device} lets a stage bind {most} (maxPerStageDescriptor{limit})");
            return Err(Error::no_device(why).note("--device takes another one; `quincunx devices` lists them"));
        }
    }
    Ok(())
}

impl Drop for Interface {
    fn drop(&mut self) {
        // SAFETY: pipelines made with it are destroyed by their owners, which drop this after them.
        unsafe {
            self.gpu.device.destroy_pipeline_layout(self.layout, None);
            for layout in &self.owned {
                self.gpu.device.destroy_descriptor_set_layout(*layout, None);
            }
        }
    }
}

//! Compute and graphics pipelines from the table's entries: their layouts come from the shaders and are not written by
//! hand.

pub use super::description::{Blending, Constants, DepthBias, GraphicsDescription, StencilUse, VertexBuffer};

use super::Gpu;
use super::interface::Interface;
use super::pipeline_store::{Recipe, StoredPipeline};
use super::shader::{Shader, Side};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A SPIR-V module that lives while a pipeline is made of it.
struct Module<'a> {
    gpu: &'a Gpu,
    handle: vk::ShaderModule,
}

impl<'a> Module<'a> {
    /// `streams`: what vertices are made of.
    fn new(gpu: &'a Gpu, shader: &Shader, streams: &[VertexBuffer]) -> Result<Self> {
        let words = match &gpu.marks {
            Some(marks) => marks.counting(shader, streams)?,
            None => shader.words(),
        };
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: build.rs wrote valid SPIR-V; the words outlive the call.
        let handle = unsafe { gpu.device.create_shader_module(&info, None) }
            .map_err(|result| Error::device(format!("creating shader {}: {result}", shader.label())))?;
        gpu.name(handle, &shader.label());
        Ok(Self { gpu, handle })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines keep what they need of a module.
        unsafe { self.gpu.device.destroy_shader_module(self.handle, None) };
    }
}

/// The named constants in the form that Vulkan takes.
struct Specialization {
    entries: Vec<vk::SpecializationMapEntry>,
    data: Vec<u8>,
}

impl Specialization {
    /// Constants that another stage of the same pipeline has are passed over.
    fn new(shader: &Shader, constants: Constants<'_>) -> Self {
        let mut entries = Vec::new();
        let mut data = Vec::new();
        for (name, value) in constants {
            if let Some(constant) = shader.constants.iter().find(|constant| constant.name == *name) {
                entries.push(vk::SpecializationMapEntry {
                    constant_id: constant.id,
                    offset: data.len() as u32,
                    size: 4,
                });
                data.extend_from_slice(&value.to_ne_bytes());
            }
        }
        Self { entries, data }
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(&self.data)
    }
}

/// A constant that no stage of the pipeline has is a programmer's mistake, such as a misspelt name.
fn assert_constants_exist(shaders: &[&Shader], constants: Constants<'_>) {
    for (name, _) in constants {
        let known = shaders.iter().any(|shader| shader.constants.iter().any(|constant| constant.name == *name));
        assert!(known, "{}: no constant is called {name}", shaders[0].label());
    }
}

/// A compute shader with its constants fixed.
pub struct ComputePipeline {
    stored: Arc<StoredPipeline>,
    pub interface: Interface,
    /// Invocations of a workgroup, after specialization.
    pub workgroup: [u32; 3],
}

impl ComputePipeline {
    /// A workgroup that is larger than the device's is a programmer's mistake: a caller that takes its shape from a
    /// user checks before.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, shader: &Shader, constants: Constants<'_>) -> Result<Self> {
        Self::with_sets(gpu, shader, constants, &[])
    }

    /// The same with sets from 1 on that were made elsewhere: `foreign`, their layouts.
    pub fn with_sets(
        gpu: &Arc<Gpu>,
        shader: &Shader,
        constants: Constants<'_>,
        foreign: &[vk::DescriptorSetLayout],
    ) -> Result<Self> {
        assert_constants_exist(&[shader], constants);
        let workgroup = shader.workgroup.map(|side| match side {
            Side::Fixed(value) => value,
            Side::Constant(id) => {
                let constant =
                    shader.constants.iter().find(|constant| constant.id == id).expect("reflected by build.rs");
                constants.iter().find(|(name, _)| *name == constant.name).map_or(constant.default, |(_, value)| *value)
            }
        });
        let (most, most_size) = (gpu.caps.limits.max_workgroup_invocations, gpu.caps.limits.max_workgroup_size);
        assert!(
            (0..3).all(|axis| workgroup[axis] <= most_size[axis]) && workgroup.iter().product::<u32>() <= most,
            "{}: a workgroup of {workgroup:?}: this device allows {most_size:?}, {most} in all",
            shader.label()
        );
        let interface = Interface::new(gpu, &[shader], foreign)?;
        let make = || Self::make(gpu, shader, constants, interface.layout);
        let stored = gpu.pipelines.get(&gpu.device, Recipe::compute(shader, constants), make)?;
        Ok(Self { stored, interface, workgroup })
    }

    fn make(gpu: &Gpu, shader: &Shader, constants: Constants<'_>, layout: vk::PipelineLayout) -> Result<vk::Pipeline> {
        let module = Module::new(gpu, shader, &[])?;
        let specialization = Specialization::new(shader, constants);
        let specialization_info = specialization.info();
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.handle)
            .name(c"main")
            .specialization_info(&specialization_info);
        let info = vk::ComputePipelineCreateInfo::default()
            .stage(stage)
            .layout(layout)
            // Dispatches may go in bands.
            .flags(vk::PipelineCreateFlags::DISPATCH_BASE);
        // SAFETY: every handle is alive and every pointer outlives the call.
        let made = unsafe { gpu.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None) };
        let handle =
            made.map_err(|(_, result)| Error::device(format!("creating pipeline {}: {result}", shader.label())))?[0];
        gpu.name(handle, &shader.label());
        Ok(handle)
    }

    pub fn handle(&self) -> vk::Pipeline {
        self.stored.handle
    }

    /// Workgroups that cover `size` invocations.
    pub fn groups(&self, size: [u32; 3]) -> [u32; 3] {
        [0, 1, 2].map(|axis| size[axis].div_ceil(self.workgroup[axis]))
    }
}

/// Vertex and fragment shader with their fixed state. Viewport, scissor, cull mode and front face are set by commands.
pub struct GraphicsPipeline {
    stored: Arc<StoredPipeline>,
    pub interface: Interface,
}

impl GraphicsPipeline {
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, description: &GraphicsDescription<'_>) -> Result<Self> {
        let shaders: Vec<&Shader> =
            std::iter::once(description.vertex).chain(description.geometry).chain(description.fragment).collect();
        assert_constants_exist(&shaders, description.constants);
        let interface = Interface::new(gpu, &shaders, description.foreign_sets)?;
        let make = || Self::make(gpu, description, &shaders, &interface);
        let stored = gpu.pipelines.get(&gpu.device, Recipe::graphics(description), make)?;
        Ok(Self { stored, interface })
    }

    pub fn handle(&self) -> vk::Pipeline {
        self.stored.handle
    }

    fn make(
        gpu: &Gpu,
        description: &GraphicsDescription<'_>,
        shaders: &[&Shader],
        interface: &Interface,
    ) -> Result<vk::Pipeline> {
        let modules: Vec<Module<'_>> =
            shaders.iter().map(|shader| Module::new(gpu, shader, description.vertex_buffers)).collect::<Result<_>>()?;
        let specializations: Vec<Specialization> =
            shaders.iter().map(|shader| Specialization::new(shader, description.constants)).collect();
        let infos: Vec<vk::SpecializationInfo<'_>> = specializations.iter().map(Specialization::info).collect();
        let stages: Vec<_> = (0..shaders.len())
            .map(|index| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(shaders[index].stage.flags())
                    .module(modules[index].handle)
                    .name(c"main")
                    .specialization_info(&infos[index])
            })
            .collect();
        let mut buffers = Vec::new();
        let mut attributes = Vec::new();
        for (binding, buffer) in description.vertex_buffers.iter().enumerate() {
            let binding = binding as u32;
            buffers.push(vk::VertexInputBindingDescription {
                binding,
                stride: buffer.stride_bytes,
                input_rate: vk::VertexInputRate::VERTEX,
            });
            for (location, format, offset) in buffer.attributes {
                attributes.push(vk::VertexInputAttributeDescription {
                    location: *location,
                    binding,
                    format: *format,
                    offset: *offset,
                });
            }
        }
        let vertex_input = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&buffers)
            .vertex_attribute_descriptions(&attributes);
        let assembly =
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let mut overestimate = description.conservative_margin_px.map(|margin_px| {
            let rules = gpu.caps.conservative.expect("a device without it is refused before");
            vk::PipelineRasterizationConservativeStateCreateInfoEXT::default()
                .conservative_rasterization_mode(vk::ConservativeRasterizationModeEXT::OVERESTIMATE)
                .extra_primitive_overestimation_size(rules.extra_px(margin_px))
        });
        let mut raster = vk::PipelineRasterizationStateCreateInfo::default()
            .line_width(1.0)
            .depth_clamp_enable(description.depth_clamp)
            .depth_bias_enable(description.depth_bias != DepthBias::NONE)
            .depth_bias_slope_factor(description.depth_bias.slope)
            .depth_bias_constant_factor(description.depth_bias.steps);
        if let Some(overestimate) = &mut overestimate {
            raster = raster.push_next(overestimate);
        }
        let mut placed = vk::PipelineSampleLocationsStateCreateInfoEXT::default().sample_locations_enable(true);
        let mut multisample = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::from_raw(description.samples));
        if description.are_placed {
            multisample = multisample.push_next(&mut placed);
        }
        let [front, back] = description.stencil.map(StencilUse::states).unwrap_or_default();
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .stencil_test_enable(description.stencil.is_some())
            .front(front)
            .back(back)
            .depth_test_enable(description.depth_format.is_some())
            .depth_write_enable(description.depth_write)
            .depth_compare_op(description.depth_compare);
        let attachments = vec![description.blending.state(); description.color_formats.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&attachments);
        let mut dynamic_states = vec![
            vk::DynamicState::VIEWPORT,
            vk::DynamicState::SCISSOR,
            vk::DynamicState::CULL_MODE,
            vk::DynamicState::FRONT_FACE,
        ];
        if description.stencil.is_some() {
            dynamic_states.extend([vk::DynamicState::STENCIL_REFERENCE, vk::DynamicState::STENCIL_WRITE_MASK]);
        }
        if description.are_placed {
            dynamic_states.push(vk::DynamicState::SAMPLE_LOCATIONS_EXT);
        }
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(description.color_formats)
            .depth_attachment_format(description.depth_format.unwrap_or(vk::Format::UNDEFINED));
        // A format with both is attached as both, used or not.
        if description.depth_format == Some(vk::Format::D32_SFLOAT_S8_UINT) {
            rendering = rendering.stencil_attachment_format(vk::Format::D32_SFLOAT_S8_UINT);
        }
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertex_input)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&multisample)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(interface.layout)
            .push_next(&mut rendering);
        // SAFETY: every handle is alive and every pointer outlives the call.
        let made = unsafe { gpu.device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
        let handle =
            made.map_err(|(_, result)| Error::device(format!("creating pipeline {}: {result}", interface.label)))?[0];
        gpu.name(handle, &interface.label);
        Ok(handle)
    }
}

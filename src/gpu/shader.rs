//! The table that build.rs wrote from glsl/: every entry point with what it binds, and the structs that host and
//! device share. The modules below mirror glsl/: `techniques::interleaved_deferred::gather::COMP`.

use ash::vk;

/// One entry point in one variant.
pub struct Shader {
    /// Path from glsl/ without its extension, which is also the path of its pass.
    pub name: &'static str,
    /// Extension and variant, such as `COMP_BUFFER`.
    pub variant: &'static str,
    pub stage: Stage,
    /// SPIR-V 1.6, or 1.5 where the file asks for it, little-endian words.
    pub spirv: &'static [u8],
    pub bindings: &'static [Binding],
    /// The push-constant block, where there is one.
    pub params: Option<ParamsLayout>,
    pub constants: &'static [SpecConstant],
    /// Invocations of a workgroup; ones outside compute.
    pub workgroup: [Side; 3],
}

/// Those of `constants` that one of `shaders` has: a technique hands all of its own to each of its pipelines.
pub fn constants_of(constants: &[(&'static str, u32)], shaders: &[Option<&Shader>]) -> Vec<(&'static str, u32)> {
    let has = |name: &str| {
        let mut shaders = shaders.iter().flatten();
        shaders.any(|shader| shader.constants.iter().any(|constant| constant.name == name))
    };
    constants.iter().copied().filter(|(name, _)| has(name)).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    Vertex,
    Geometry,
    Fragment,
    Compute,
}

/// One descriptor, by its name in GLSL (the block's name where the block is anonymous).
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    pub set: u32,
    pub binding: u32,
    pub name: &'static str,
    pub kind: BindingKind,
    pub count: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    StorageBuffer,
    UniformBuffer,
    StorageImage,
    SampledImage,
    CombinedImageSampler,
    Sampler,
    AccelerationStructure,
}

/// A push-constant block, as spirq read it from the SPIR-V that the driver gets.
#[derive(Clone, Copy, Debug)]
pub struct ParamsLayout {
    pub name: &'static str,
    pub size_bytes: u32,
    pub members: &'static [(&'static str, u32)],
}

/// A struct that host and device share, as naga read it.
#[derive(Clone, Copy, Debug)]
pub struct StructLayout {
    pub name: &'static str,
    pub size_bytes: u32,
    pub members: &'static [(&'static str, u32)],
}

/// A specialization constant: 4 bytes, `default` as bits.
#[derive(Clone, Copy, Debug)]
pub struct SpecConstant {
    pub name: &'static str,
    pub id: u32,
    pub default: u32,
}

/// One side of a workgroup: a number, or the id of the constant that holds it.
#[derive(Clone, Copy, Debug)]
pub enum Side {
    Fixed(u32),
    Constant(u32),
}

impl BindingKind {
    pub(super) fn descriptor_type(self) -> vk::DescriptorType {
        match self {
            Self::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
            Self::UniformBuffer => vk::DescriptorType::UNIFORM_BUFFER,
            Self::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
            Self::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
            Self::CombinedImageSampler => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
            Self::Sampler => vk::DescriptorType::SAMPLER,
            Self::AccelerationStructure => vk::DescriptorType::ACCELERATION_STRUCTURE_KHR,
        }
    }
}

impl Stage {
    pub(super) fn flags(self) -> vk::ShaderStageFlags {
        match self {
            Self::Vertex => vk::ShaderStageFlags::VERTEX,
            Self::Geometry => vk::ShaderStageFlags::GEOMETRY,
            Self::Fragment => vk::ShaderStageFlags::FRAGMENT,
            Self::Compute => vk::ShaderStageFlags::COMPUTE,
        }
    }
}

impl Shader {
    /// The SPIR-V as words.
    pub fn words(&self) -> Vec<u32> {
        self.spirv.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect()
    }

    /// Name and variant, for messages and debug names.
    pub fn label(&self) -> String {
        format!("{}.{}", self.name.replace('/', "."), self.variant.to_lowercase())
    }
}

/// The variant with these values, one for each axis in the order of the shader's `// variants:` line. Asking for one that
/// is not there is a programmer's mistake.
pub fn variant(variants: &'static [&'static Shader], values: &[&str]) -> &'static Shader {
    let suffix: String = values.iter().map(|value| format!("_{}", value.to_uppercase().replace('-', "_"))).collect();
    variants
        .iter()
        .find(|shader| shader.variant.split_once('_').is_some_and(|(_, rest)| rest == &suffix[1..]))
        .unwrap_or_else(|| panic!("{} has no variant {suffix}", variants[0].name))
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn naga_and_spirq_agree_on_every_push_constant_block() {
        for shader in ALL {
            let Some(params) = &shader.params else { continue };
            let twin = LAYOUTS
                .iter()
                .find(|twin| twin.name == params.name)
                .unwrap_or_else(|| panic!("{}: struct {} has no twin", shader.label(), params.name));
            assert_eq!(params.members, twin.members, "{}", shader.label());
            let size_bytes = twin.size_bytes;
            // spirq ends a struct with its last member, naga rounds up to its alignment.
            assert_eq!(params.size_bytes.next_multiple_of(16), size_bytes.next_multiple_of(16), "{}", shader.label());
            assert!(size_bytes <= 128, "{}: 128 bytes are what every device has", shader.label());
        }
    }

    #[test]
    fn every_shader_fits_the_smallest_workgroup_limit_by_default() {
        for shader in ALL {
            let sides = shader.workgroup.map(|side| match side {
                Side::Fixed(value) => value,
                Side::Constant(id) => shader.constants.iter().find(|c| c.id == id).expect("reflected").default,
            });
            assert!(sides.iter().product::<u32>() <= 256, "{}: {sides:?}", shader.label());
        }
    }
}

//! What pipelines are described by, beside their shaders' own words.

use super::shader::Shader;
use ash::vk;

/// Specialization constants by name, values as bits.
pub type Constants<'a> = &'a [(&'a str, u32)];

/// What a graphics pipeline draws with.
pub struct GraphicsDescription<'a> {
    pub vertex: &'a Shader,
    pub geometry: Option<&'a Shader>,
    /// None: depth only.
    pub fragment: Option<&'a Shader>,
    pub constants: Constants<'a>,
    /// One vertex buffer each: its stride and its attributes (location, format, offset).
    pub vertex_buffers: &'a [VertexBuffer],
    pub color_formats: &'a [vk::Format],
    /// Samples a pixel of every attachment.
    pub samples: u32,
    /// They lie where `Commands::place_samples` says (VK_EXT_sample_locations); else where Vulkan's standard has them.
    pub are_placed: bool,
    pub blending: Blending,
    pub depth_format: Option<vk::Format>,
    pub depth_write: bool,
    pub depth_compare: vk::CompareOp,
    /// Depth is clamped: what lies before the near plane or beyond the far one is drawn on it instead of being clipped.
    pub depth_clamp: bool,
    pub depth_bias: DepthBias,
    /// Every pixel is drawn that a triangle touches whose edges lie this much farther out, pixels
    /// (VK_EXT_conservative_rasterization). None: every pixel whose middle it covers.
    pub conservative_margin_px: Option<f32>,
    /// None: no stencil test. Reference and write mask are set by commands.
    pub stencil: Option<StencilUse>,
    /// Layouts of set 1 and above.
    pub foreign_sets: &'a [vk::DescriptorSetLayout],
}

/// What is added to depth, which is reversed: more is nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBias {
    /// In multiples of its greatest change from a pixel to the next.
    pub slope: f32,
    /// In steps of the float of the triangle's greatest depth.
    pub steps: f32,
}

impl DepthBias {
    pub const NONE: Self = Self { slope: 0.0, steps: 0.0 };
}

/// How fragments meet what is in the colour attachments, all of them alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Blending {
    Replace,
    /// Source over destination by alpha (premultiplied); the destination's own alpha stays.
    Over,
    /// The same, and the destination's alpha becomes what both let through: layers that are laid over something later.
    Layer,
    /// Sums, in the order of the draws.
    Add,
    /// Nothing is written.
    Keep,
}

impl Blending {
    pub(super) fn state(self) -> vk::PipelineColorBlendAttachmentState {
        use vk::ColorComponentFlags as Components;
        let target = match self {
            Self::Replace | Self::Over | Self::Layer | Self::Keep => vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
            Self::Add => vk::BlendFactor::ONE,
        };
        let written = match self {
            Self::Replace | Self::Layer | Self::Add => Components::RGBA,
            Self::Over => Components::R | Components::G | Components::B,
            Self::Keep => Components::empty(),
        };
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(written)
            .blend_enable(matches!(self, Self::Over | Self::Layer | Self::Add))
            .src_color_blend_factor(vk::BlendFactor::ONE)
            .dst_color_blend_factor(target)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(target)
    }
}

/// What draws do with the stencil, all eight bits of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StencilUse {
    /// Write the reference where the draw covers.
    Replace,
    /// Draw only where the stencil holds the reference.
    RequireEqual,
    /// Count closed surfaces' faces behind what was drawn, wrapping: backs up, fronts down. Where none of their inside is,
    /// as many of both are behind (the depth-fail test).
    CountBehind,
    /// Draw only where the stencil differs from the reference, and set it to 0 there.
    TakeUnequal,
    /// Draw only where the stencil holds the reference, and set it to 0 everywhere else.
    LeaveUnequal,
}

impl StencilUse {
    /// Stencil states of front faces and of back faces.
    pub(super) fn states(self) -> [vk::StencilOpState; 2] {
        let (compare_op, pass_op) = match self {
            Self::Replace => (vk::CompareOp::ALWAYS, vk::StencilOp::REPLACE),
            Self::RequireEqual | Self::LeaveUnequal => (vk::CompareOp::EQUAL, vk::StencilOp::KEEP),
            Self::CountBehind => (vk::CompareOp::ALWAYS, vk::StencilOp::KEEP),
            Self::TakeUnequal => (vk::CompareOp::NOT_EQUAL, vk::StencilOp::ZERO),
        };
        let state = vk::StencilOpState { compare_op, pass_op, compare_mask: 0xff, ..vk::StencilOpState::default() };
        let counting = |depth_fail_op| vk::StencilOpState { depth_fail_op, ..state };
        match self {
            Self::CountBehind => {
                [counting(vk::StencilOp::DECREMENT_AND_WRAP), counting(vk::StencilOp::INCREMENT_AND_WRAP)]
            }
            Self::LeaveUnequal => [vk::StencilOpState { fail_op: vk::StencilOp::ZERO, ..state }; 2],
            Self::Replace | Self::RequireEqual | Self::TakeUnequal => [state; 2],
        }
    }
}

/// Layout of one vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VertexBuffer {
    pub stride_bytes: u32,
    pub attributes: &'static [(u32, vk::Format, u32)],
}

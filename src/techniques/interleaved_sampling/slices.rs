//! Slices: a volume, drawn as planes at equal distances, farthest first, over one another (section 3.3; the slicing is
//! Cabral, Cam and Foran's, 1994, Accelerated Volume Rendering and Tomographic Reconstruction Using Texture Mapping Hardware).
//! Each member's planes lie elsewhere between two of the others. Shaders: slices.vert, slices.frag.
//! reads   the volume, the depth of surfaces       writes  slices.layer  image, `--depth`, a member's extent, and over it the
//!                                                         member's picture
//!
//! The layer begins as nothing and is laid over the surfaces once, so that `--depth` rounds what planes add up to and nothing
//! else. With `--summation hierarchical` planes add up in groups of about the root of their number, and groups to the layer.
//!
//! Differs from the paper
//! - planes stand between the nearest and the farthest place of the volume before the camera, in every picture as many
//! - opacity is of the length of the ray between two planes, which is longer at a slant, not of the distance of planes

use crate::choice::choices;
use crate::error::{Error, Result};
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::SlicesParams;
use crate::gpu::shader::techniques::interleaved_sampling::slices;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic, upload};
use crate::passes::fullscreen;
use crate::plan::{PICTURE_FORMAT, Plan, Resources};
use crate::resident::volume::{PlacedVolume, VolumeGpu};
use crate::sampling::pattern::Dimension;
use crate::scene::Scene;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::interleaved_sampling::members::Members;
use crate::techniques::interleaved_sampling::over::{NOTHING, Over};
use crate::techniques::interleaved_sampling::resources::{DEPTH, DRAWN, GROUP, LAYER, NAME, OFFSETS};
use ash::vk;
use std::sync::Arc;

choices! {
    /// Bits of a channel in which planes add up (`--depth`).
    pub enum PictureDepth {
        /// The paper's: 8 bits, which round at every plane.
        "8" => Eight,
        "half" => Half,
        "float" => Float,
    }
}

impl PictureDepth {
    fn format(self) -> vk::Format {
        match self {
            Self::Eight => vk::Format::R8G8B8A8_UNORM,
            Self::Half => vk::Format::R16G16B16A16_SFLOAT,
            Self::Float => vk::Format::R32G32B32A32_SFLOAT,
        }
    }
}

choices! {
    /// The order in which planes add up (`--summation`).
    pub enum Summation {
        /// Each over all behind it.
        "plain" => Plain,
        /// Each over those of its group, and groups over one another.
        "hierarchical" => Hierarchical,
    }
}

/// What the settings choose.
pub struct SliceChoices {
    pub planes: u32,
    depth: PictureDepth,
    summation: Summation,
    placed: PlacedVolume,
}

impl SliceChoices {
    /// Errors: the scene has no volume, or surfaces that are drawn in an order among planes; as `PlacedVolume::new` (exit
    /// code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let (scene, values): (&Scene, &Values) = (inputs.scene, inputs.values);
        let Some(volume) = &scene.volume else {
            return Err(Error::request("--effect volume with --volume none: there is nothing to slice")
                .within(NAME)
                .note("--volume head and --volume marschner-lobb are built in, --volume FILE.nrrd reads a file"));
        };
        if inputs.stats.has_blend {
            return Err(Error::request("--effect volume: BLEND surfaces would have to be drawn among the planes")
                .within(NAME)
                .note("scenes without BLEND surfaces can hold a volume, and path_traced draws it with them"));
        }
        Ok(Self {
            planes: values.integer("planes") as u32,
            depth: values.choice("depth"),
            summation: values.choice("summation"),
            placed: PlacedVolume::new(volume, values, scene)?,
        })
    }

    /// Planes that add up before they are laid over the others; all of them without groups.
    fn planes_of_group(&self) -> u32 {
        match self.summation {
            Summation::Plain => self.planes,
            Summation::Hierarchical => f64::from(self.planes).sqrt().ceil() as u32,
        }
    }

    /// How far behind the beginning of its step each member's planes lie, in steps. A single member's lie in the middle.
    fn offsets(members: &Members) -> Vec<f32> {
        let offset = |member| match members.count() {
            1 => 0.5,
            _ => members.basis().number(member, Dimension::Slice).unwrap_or_default(),
        };
        (0..members.count()).map(offset).collect()
    }

    /// Voxels of the volume, for the report.
    pub fn voxel_count(&self) -> f64 {
        self.placed.voxel_count()
    }

    /// Plans what the pass reads and writes.
    pub fn plan(&self, plan: &mut Plan, members: &Members) {
        use vk::ImageUsageFlags as Usage;
        self.placed.plan(plan, NAME);
        plan.buffer("combine", OFFSETS, 4 * u64::from(members.count()));
        let usage = Usage::COLOR_ATTACHMENT | Usage::SAMPLED;
        plan.image("color", LAYER, members.picture(), self.depth.format(), usage);
        if self.summation == Summation::Hierarchical {
            plan.image("color", GROUP, members.picture(), self.depth.format(), usage);
        }
    }

    /// Plans the pass, after the surfaces'.
    pub fn plan_pass(&self, plan: &mut Plan) {
        let group = (self.summation == Summation::Hierarchical).then_some(GROUP);
        let written = [Some(LAYER), group].into_iter().flatten();
        let touched = written.flat_map(|name| [(name, Access::ColorWrite), (name, Access::FragmentSample)]);
        let touched = touched.chain([(DEPTH, Access::DepthTest), (DRAWN, Access::ColorWrite)]);
        plan.pass(format!("{NAME}.slices"), touched.map(|(name, access)| (name.to_owned(), access)));
    }
}

/// The pass on the device.
pub struct Slices {
    volume: VolumeGpu,
    offsets: Buffer,
    layer: Image,
    group: Option<Image>,
    slices: GraphicsPipeline,
    /// A group over the layer.
    over_layer: Option<Over>,
    /// The layer over the surfaces.
    over_surfaces: Over,
    params: SlicesParams,
    planes_of_group: u32,
}

impl Slices {
    /// Fills what was planned.
    ///
    /// Errors: the driver refuses, memory for the uploads (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &SliceChoices, members: &Members) -> Result<Self> {
        let read = [Access::GraphicsRead, Access::FragmentSample];
        let offsets = resources.buffer(OFFSETS);
        let values = SliceChoices::offsets(members);
        upload::buffer(gpu, &offsets, bytemuck::cast_slice(&values), Access::GraphicsRead)?;
        let group = (choices.summation == Summation::Hierarchical).then(|| resources.image(GROUP));
        let format = [choices.depth.format()];
        let slices = GraphicsDescription {
            vertex: &slices::VERT,
            blending: Blending::Layer,
            depth_format: Some(vk::Format::D32_SFLOAT),
            depth_compare: vk::CompareOp::GREATER_OR_EQUAL,
            ..fullscreen::description(&slices::FRAG, &format)
        };
        Ok(Self {
            volume: choices.placed.upload(gpu, resources, NAME, read)?,
            offsets,
            layer: resources.image(LAYER),
            over_layer: group.is_some().then(|| Over::new(gpu, format[0], Blending::Layer)).transpose()?,
            group,
            slices: GraphicsPipeline::new(gpu, &slices)?,
            over_surfaces: Over::new(gpu, PICTURE_FORMAT, Blending::Over)?,
            params: SlicesParams {
                plane_count: choices.planes,
                layer_width: members.picture().width,
                layer_height: members.picture().height,
            },
            planes_of_group: choices.planes_of_group(),
        })
    }

    /// Draws the volume over `drawn`, behind what of it is nearer than `depth`.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        depth: Edge<'_, Image>,
        drawn: Edge<'_, Image>,
    ) -> Result<()> {
        cmd.pass(&format!("{NAME}.slices"), Traffic::default(), |cmd| {
            cmd.barriers([depth.to(Access::DepthTest), drawn.to(Access::ColorWrite)]);
            cmd.barriers([self.layer.discard(Access::ColorWrite)]);
            let planes = self.params.plane_count;
            match (&self.group, &self.over_layer) {
                (Some(group), Some(over_layer)) => {
                    for first in (0..planes).step_by(self.planes_of_group as usize) {
                        let planes = first..(first + self.planes_of_group).min(planes);
                        cmd.barriers([match first {
                            0 => group.discard(Access::ColorWrite),
                            _ => group.from(Access::FragmentSample).to(Access::ColorWrite),
                        }]);
                        self.draw_planes(cmd, frame, depth.resource, group, planes)?;
                        cmd.barriers([group.from(Access::ColorWrite).to(Access::FragmentSample)]);
                        if first > 0 {
                            cmd.barriers([self.layer.from(Access::ColorWrite).to(Access::ColorWrite)]);
                        }
                        let begins = (first == 0).then_some(NOTHING);
                        over_layer.lay(cmd, group, ColorTarget::new(&self.layer, begins))?;
                    }
                }
                _ => self.draw_planes(cmd, frame, depth.resource, &self.layer, 0..planes)?,
            }
            cmd.barriers([self.layer.from(Access::ColorWrite).to(Access::FragmentSample)]);
            self.over_surfaces.lay(cmd, &self.layer, ColorTarget::new(drawn.resource, None))
        })
    }

    /// Planes into a target that begins as nothing, by their numbers from the farthest on.
    fn draw_planes(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        depth: &Image,
        target: &Image,
        planes: std::ops::Range<u32>,
    ) -> Result<()> {
        let extent = target.description.extent;
        let target = ColorTarget::new(target, Some(NOTHING));
        cmd.begin_rendering(extent, &[target], Some((depth, None, Access::DepthTest)));
        let mut bound = vec![("Frame", Bound::Buffer(frame)), ("Offsets", Bound::Buffer(&self.offsets))];
        bound.extend(self.volume.bound());
        cmd.bind_graphics(&self.slices, bytemuck::bytes_of(&self.params), &bound)?;
        let (device, buffer) = (&cmd.gpu().device, cmd.buffer());
        // SAFETY: the buffer is being recorded inside rendering; the stages read no vertex buffer.
        unsafe {
            device.cmd_set_cull_mode(buffer, vk::CullModeFlags::NONE);
            device.cmd_set_front_face(buffer, vk::FrontFace::COUNTER_CLOCKWISE);
            // Four triangles make a polygon of six corners.
            device.cmd_draw(buffer, 12, planes.end - planes.start, 0, planes.start);
        }
        cmd.end_rendering();
        Ok(())
    }
}

//! A volume in device memory: its voxels as a three-dimensional image, its transfer function as a table, and where it stands.
//! Shaders: glsl/shading/volume.glsl.
//!
//! Three resources of a technique, `TECHNIQUE.volume.block`, `.transfer` and `.voxels`. Voxels keep the bytes that the file
//! has: 1, 2 or 4 each.

use crate::error::{Error, Result};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::VolumeBlock;
use crate::gpu::{Access, Bound, Buffer, Gpu, Image, ImageDescription, upload};
use crate::plan::{Plan, Resources, Shape};
use crate::scene::Scene;
use crate::settings::Values;
use crate::units::Extent;
use crate::volume::{Transfer, Volume, Voxels};
use ash::vk;
use bytemuck::Zeroable;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Memory row of what it holds.
const GROUP: &str = "volume";

/// Entries of the transfer table: four for each of the values that a byte has.
const ENTRIES: u32 = 1024;

fn name(technique: &str, what: &str) -> String {
    format!("{technique}.volume.{what}")
}

/// A volume as the settings have it: where it stands, and how values become light.
pub struct PlacedVolume {
    volume: Arc<Volume>,
    block: VolumeBlock,
    transfer: Vec<[f32; 4]>,
}

impl PlacedVolume {
    /// `volume`: of `scene`.
    ///
    /// Errors: no such transfer function, or a broken one; a window that is empty (exit code 2).
    pub fn new(volume: &Arc<Volume>, values: &Values, scene: &Scene) -> Result<Self> {
        let window =
            values.unless_auto("volume-window", Values::numbers::<2>).map(|window| window.map(|end| end as f32));
        if let Some([least, most]) = window
            && least >= most
        {
            let text = values.text("volume-window");
            return Err(Error::request(format!("--volume-window {text}: it ends before it begins"))
                .note(format!("{} has values from {} to {}", volume.name, volume.range[0], volume.range[1])));
        }
        let [least, most] = window.unwrap_or(volume.range);
        let transfer = Transfer::open(values.text("transfer"))?.table(ENTRIES as usize);
        let world_from_box = world_from_box(volume, values, scene);
        let last = Vec3::from(volume.size.map(|size| (size - 1) as f32));
        let longest_m = (0..3).map(|axis| world_from_box.col(axis).truncate().length()).fold(0.0, f32::max);
        let voxels_from_world = Mat4::from_scale(last) * world_from_box.as_dmat4().inverse().as_mat4();
        let block = VolumeBlock {
            world_from_box: world_from_box.to_cols_array_2d(),
            voxels_from_world: voxels_from_world.to_cols_array_2d(),
            last: last.extend(0.0).to_array(),
            lowest: least,
            // A field of one value is the table's first entry.
            scale: if most > least { (ENTRIES - 1) as f32 / (most - least) } else { 0.0 },
            extinction: values.number("volume-density") as f32 / longest_m,
            last_entry: ENTRIES - 1,
            is_float: u32::from(matches!(volume.voxels, Voxels::F32(_))),
            ..VolumeBlock::zeroed()
        };
        Ok(Self { volume: volume.clone(), block, transfer })
    }

    /// Number of its voxels.
    pub fn voxel_count(&self) -> f64 {
        self.volume.size.map(f64::from).iter().product()
    }

    /// Plans it as a resource of `technique`.
    pub fn plan(&self, plan: &mut Plan, technique: &str) {
        plan.buffer(GROUP, name(technique, "block"), size_of::<VolumeBlock>() as u64);
        plan.buffer(GROUP, name(technique, "transfer"), size_of_val(&self.transfer[..]) as u64);
        let [width, height, depth] = self.volume.size;
        let format = match self.volume.voxels {
            Voxels::U8(_) => vk::Format::R8_UINT,
            Voxels::U16(_) => vk::Format::R16_UINT,
            Voxels::F32(_) => vk::Format::R32_UINT,
        };
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let flat = ImageDescription::plain(Extent::new(width, height), format, 1, usage);
        let image = ImageDescription { depth: Some(depth), ..flat };
        plan.push(GROUP, name(technique, "voxels"), Shape::Image(image));
    }

    /// Fills what was planned; `read`: how the technique's shaders read buffers, and images.
    ///
    /// Errors: memory for the uploads (exit code 4).
    pub fn upload(
        &self,
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        [read, sampled]: [Access; 2],
    ) -> Result<VolumeGpu> {
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&name(technique, what));
            upload::buffer(gpu, &buffer, bytes, read)?;
            Result::Ok(buffer)
        };
        let block = filled("block", bytemuck::bytes_of(&self.block))?;
        let transfer = filled("transfer", bytemuck::cast_slice(&self.transfer))?;
        let voxels = resources.image(&name(technique, "voxels"));
        upload::image(gpu, &voxels, sampled, |staging| staging.copy_from_slice(self.volume.voxels.bytes()))?;
        let sampler = Sampler::clamped(gpu, vk::Filter::NEAREST)?;
        Ok(VolumeGpu { block, transfer, voxels, sampler, sampled })
    }
}

/// The box of the voxels' middles, 0 to 1 along each side, in the world.
fn world_from_box(volume: &Volume, values: &Values, scene: &Scene) -> Mat4 {
    let sides = Vec3::from([0, 1, 2].map(|axis| volume.spacing[axis] * (volume.size[axis] - 1) as f32));
    let bounds = scene.bounds();
    let fitting = || {
        let room = bounds.max - bounds.min;
        // A scene without room along an axis leaves the others to say it.
        let ratios = (0..3).map(|axis| room[axis] / sides[axis]).filter(|ratio| *ratio > 0.0);
        let ratio = ratios.reduce(f32::min);
        // One without any is a point, and a metre is as good as another length.
        ratio.map_or(1.0, |ratio| sides.max_element() * ratio)
    };
    let asked = values.unless_auto("volume-length", Values::number);
    let longest = asked.map_or_else(fitting, |length| length as f32);
    let at = values.unless_auto("volume-at", Values::numbers::<3>);
    let middle = at.map_or(bounds.center(), |at| Vec3::from(at.map(|along| along as f32)));
    let turn = (values.number("volume-turn") as f32).to_radians();
    let size = sides * (longest / sides.max_element());
    Mat4::from_translation(middle)
        * Mat4::from_rotation_y(turn)
        * Mat4::from_scale(size)
        * Mat4::from_translation(Vec3::splat(-0.5))
}

/// A volume in device memory.
pub struct VolumeGpu {
    block: Buffer,
    transfer: Buffer,
    voxels: Image,
    sampler: Sampler,
    sampled: Access,
}

impl VolumeGpu {
    /// What shaders that include shading/volume.glsl bind.
    pub fn bound(&self) -> [(&'static str, Bound<'_>); 3] {
        [
            ("Volume", Bound::Buffer(&self.block)),
            ("Transfer", Bound::Buffer(&self.transfer)),
            ("voxels", Bound::Sampled(&self.voxels, self.sampler.handle, self.sampled)),
        ]
    }
}

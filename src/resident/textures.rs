//! The scene's textures in device memory, and set 1 of each material: a white pixel where one is missing.
//!
//! Textures stand apart from the rest of the scene because they outlive it: the frames of a sequence move and bend meshes
//! and show the same pictures.

use super::SceneStats;
use crate::error::{Error, Result};
use crate::gpu::marks::{self, Slots};
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, AccessSet, Gpu, Image, upload};
use crate::plan::{Plan, Resources, Sharing};
use crate::resident::stats::distinct_images;
use crate::scene::{self, ColorSpace, Scene, ShownTexels, Texture, TextureSlot, Texturing, Wrap, mipmaps};
use ash::vk;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// Textures of a material, in the order of set 1's bindings.
const TEXTURES_PER_MATERIAL: usize = TextureSlot::ALL.len();

/// Who reads textures: all in one layout.
fn readers() -> AccessSet {
    Access::FragmentSample | Access::ComputeSample
}

/// Pictures in their colour spaces, with all levels.
pub struct Textures {
    /// Pictures in the order of `distinct_images`.
    sources: Vec<(Arc<scene::Image>, ColorSpace)>,
    texturing: Texturing,
    /// Images of `sources` in their order, and a white pixel.
    images: Vec<Image>,
}

impl Textures {
    /// Makes the textures that the scene's `stats` list, and fills them.
    ///
    /// Errors: memory is too small (exit code 4).
    pub(super) fn new(gpu: &Arc<Gpu>, scene: &Scene, stats: &SceneStats) -> Result<Self> {
        let mut plan = Plan::default();
        stats.plan_textures(&mut plan);
        let mut resources = Resources::make(gpu, "scene", &plan, &Sharing::default())?;
        let sources = sources(scene);
        let mut images = Vec::with_capacity(sources.len() + 1);
        for (index, ((image, color_space), (place, _))) in sources.iter().zip(distinct_images(scene)).enumerate() {
            let target = resources.image(&format!("scene.textures.{index}"));
            // A limit leaves the finest levels out.
            let all = mipmaps::level_count(image.width, image.height);
            let levels = all - target.description.level_count..all;
            let shown = ShownTexels::of(scene, place);
            let fill = |bytes: &mut [u8]| mipmaps::write(image, *color_space, levels, shown.as_ref(), bytes);
            upload::image(gpu, &target, readers(), fill)?;
            images.push(target);
        }
        let white = resources.image("scene.textures.white");
        upload::image(gpu, &white, readers(), |bytes| bytes.fill(255))?;
        images.push(white);
        Ok(Self { sources, texturing: scene.texturing, images })
    }

    /// Whether they are what `new` would make of `scene`: the same pictures, not only equal ones.
    pub(super) fn are_of(&self, scene: &Scene) -> bool {
        let same = |one: &(Arc<scene::Image>, ColorSpace), other: &(Arc<scene::Image>, ColorSpace)| {
            Arc::ptr_eq(&one.0, &other.0) && one.1 == other.1
        };
        let others = sources(scene);
        (self.texturing.limit_px, self.texturing.fills_gutters)
            == (scene.texturing.limit_px, scene.texturing.fills_gutters)
            && self.sources.len() == others.len()
            && self.sources.iter().zip(&others).all(|(one, other)| same(one, other))
    }
}

fn sources(scene: &Scene) -> Vec<(Arc<scene::Image>, ColorSpace)> {
    let of = |(image, color_space): (usize, ColorSpace)| (scene.images[image].clone(), color_space);
    distinct_images(scene).into_iter().map(of).collect()
}

/// Samplers, and a set for each material.
pub struct MaterialSets {
    pub samplers: Vec<Sampler>,
    pub layout: vk::DescriptorSetLayout,
    pub pool: vk::DescriptorPool,
    pub sets: Vec<vk::DescriptorSet>,
    /// One a set, on a device that counts what is touched.
    pub slots: Vec<Slots>,
}

impl MaterialSets {
    /// `textures`: the scene's.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, scene: &Scene, textures: &Textures) -> Result<Self> {
        let mut samplers = Vec::new();
        let mut sampler_of = HashMap::new();
        for texture in &scene.textures {
            if let Entry::Vacant(slot) = sampler_of.entry(texture.sampler) {
                slot.insert(samplers.len());
                let name = format!("scene.sampler.{}", samplers.len());
                samplers.push(Sampler::new(gpu, &name, &sampler_info(texture))?);
            }
        }
        if samplers.is_empty() {
            samplers.push(Sampler::clamped(gpu, vk::Filter::NEAREST)?);
        }
        let images = &textures.images;
        let image_of: HashMap<(usize, ColorSpace), usize> =
            distinct_images(scene).into_iter().enumerate().map(|(index, source)| (source, index)).collect();
        let view_of = |texture: Option<usize>| match texture {
            None => (&images[images.len() - 1], samplers[0].handle),
            Some(index) => {
                let texture = &scene.textures[index];
                let image = image_of[&(texture.image, texture.color_space)];
                (&images[image], samplers[sampler_of[&texture.sampler]].handle)
            }
        };
        let shown = scene.materials.iter().map(|material| TextureSlot::ALL.map(|slot| view_of(material.texture(slot))));
        let shown: Vec<[(&Image, vk::Sampler); TEXTURES_PER_MATERIAL]> = shown.collect();
        let layout = Access::FragmentSample.layout();
        let info = |(image, sampler): (&Image, vk::Sampler)| {
            vk::DescriptorImageInfo::default().image_view(image.view).sampler(sampler).image_layout(layout)
        };
        let infos: Vec<_> = shown.iter().map(|textures| textures.map(info)).collect();
        let slots =
            shown.iter().flat_map(|_| &gpu.marks).map(|marks| marks.slots(false)).collect::<Result<Vec<_>>>()?;
        let (layout, pool, sets) = material_sets(gpu, &infos)?;
        for ((set, textures), slots) in sets.iter().zip(&shown).zip(&slots) {
            for (binding, (image, sampler)) in textures.iter().enumerate() {
                image.marked.iter().for_each(|marked| slots.set_binding(binding as u32, marked, Some(*sampler)));
            }
            slots.write_to(&gpu.device, *set);
        }
        Ok(Self { samplers, layout, pool, sets, slots })
    }
}

fn sampler_info(texture: &Texture) -> vk::SamplerCreateInfo<'static> {
    let filter = |linear| if linear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let wrap = |wrap| match wrap {
        Wrap::Repeat => vk::SamplerAddressMode::REPEAT,
        Wrap::MirroredRepeat => vk::SamplerAddressMode::MIRRORED_REPEAT,
        Wrap::ClampToEdge => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    let sampler = &texture.sampler;
    // Without anisotropy: shaders read along a slant (glsl/shading/slanted.glsl).
    vk::SamplerCreateInfo::default()
        .mag_filter(filter(sampler.mag_linear))
        .min_filter(filter(sampler.min_linear))
        .mipmap_mode(match sampler.mip_linear {
            Some(true) => vk::SamplerMipmapMode::LINEAR,
            Some(false) | None => vk::SamplerMipmapMode::NEAREST,
        })
        .address_mode_u(wrap(sampler.wrap_u))
        .address_mode_v(wrap(sampler.wrap_v))
        .address_mode_w(vk::SamplerAddressMode::REPEAT)
        // glTF's NEAREST and LINEAR without a level: only the finest one.
        .max_lod(if sampler.mip_linear.is_some() { vk::LOD_CLAMP_NONE } else { 0.25 })
}

type Sets = (vk::DescriptorSetLayout, vk::DescriptorPool, Vec<vk::DescriptorSet>);

fn material_sets(gpu: &Gpu, infos: &[[vk::DescriptorImageInfo; TEXTURES_PER_MATERIAL]]) -> Result<Sets> {
    let kind = vk::DescriptorType::COMBINED_IMAGE_SAMPLER;
    let readers = vk::ShaderStageFlags::FRAGMENT | vk::ShaderStageFlags::COMPUTE;
    let bindings: Vec<_> = (0..TEXTURES_PER_MATERIAL as u32)
        .map(|binding| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(binding)
                .descriptor_type(kind)
                .descriptor_count(1)
                .stage_flags(readers)
        })
        .chain(gpu.marks.as_ref().map(|_| marks::layout_binding(readers)))
        .collect();
    let fail = |result| Error::device(format!("making the descriptor sets of {} materials: {result}", infos.len()));
    let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: a live device; the bindings outlive the call.
    let layout = unsafe { gpu.device.create_descriptor_set_layout(&info, None) }.map_err(fail)?;
    let count = infos.len().max(1) as u32;
    let mut sizes = vec![vk::DescriptorPoolSize { ty: kind, descriptor_count: count * TEXTURES_PER_MATERIAL as u32 }];
    let marks = vk::DescriptorPoolSize { ty: vk::DescriptorType::STORAGE_BUFFER, descriptor_count: count };
    sizes.extend(gpu.marks.as_ref().map(|_| marks));
    let info = vk::DescriptorPoolCreateInfo::default().max_sets(count).pool_sizes(&sizes);
    // SAFETY: a live device.
    let pool = match unsafe { gpu.device.create_descriptor_pool(&info, None) } {
        Ok(pool) => pool,
        Err(result) => {
            // SAFETY: never used.
            unsafe { gpu.device.destroy_descriptor_set_layout(layout, None) };
            return Err(fail(result));
        }
    };
    let layouts = vec![layout; infos.len()];
    if infos.is_empty() {
        return Ok((layout, pool, Vec::new()));
    }
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&layouts);
    // SAFETY: pool and layout are alive and the pool holds as many sets.
    let sets = match unsafe { gpu.device.allocate_descriptor_sets(&info) } {
        Ok(sets) => sets,
        Err(result) => {
            // SAFETY: never used.
            unsafe {
                gpu.device.destroy_descriptor_pool(pool, None);
                gpu.device.destroy_descriptor_set_layout(layout, None);
            }
            return Err(fail(result));
        }
    };
    let writes: Vec<_> = sets
        .iter()
        .zip(infos)
        .flat_map(|(set, images)| {
            images.chunks(1).enumerate().map(move |(binding, image)| {
                vk::WriteDescriptorSet::default()
                    .dst_set(*set)
                    .dst_binding(binding as u32)
                    .descriptor_type(kind)
                    .image_info(image)
            })
        })
        .collect();
    // SAFETY: the sets are fresh; views and samplers live as long as the sets.
    unsafe { gpu.device.update_descriptor_sets(&writes, &[]) };
    for (index, set) in sets.iter().enumerate() {
        gpu.name(*set, &format!("scene.material.{index}"));
    }
    Ok((layout, pool, sets))
}

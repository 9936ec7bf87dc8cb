//! A frame as it is recorded and what it leaves: counters, and the buffers of the paper's figure 2, read back. They have
//! the light buffer's size: a pixel of the frame
//! shows the texel that it lies in.

use super::frame::{InferredFrame, LightPass};
use super::light;
use super::light::store::{Lighting, Store};
use super::material::FilterGuides;
use super::motion;
use super::survivors::{StippleCounts, Survivors};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image, readback};
use crate::passes::cull::CullLights;
use crate::picture::{Aov, AovChannels};
use crate::resident::SceneGpu;
use crate::settings::Values;
use crate::techniques::Frame;
use crate::techniques::inferred_lighting::resources::NAME;
use crate::units::Extent;
use std::collections::BTreeMap;
use std::sync::Arc;

const MOTION: &str = "geometry.motion";

/// Names that `--aov` takes.
pub const AOVS: &[&str] = &[
    "geometry.normal",
    "geometry.dsf.id",
    "geometry.dsf.depth",
    MOTION,
    "light.l_buffer.irradiance",
    "light.l_buffer.highlight",
];

/// Those that the settings leave out.
pub fn left_out(values: &Values) -> Vec<(&'static str, String)> {
    let why = "--motion-vectors off has no earlier moment; --motion-vectors on makes it";
    Vec::from_iter((!values.is_on("motion-vectors")).then(|| (MOTION, why.to_owned())))
}

/// Reads `name` back, which the settings make.
///
/// Errors: memory for the copy (exit code 4).
pub fn read(frame: &InferredFrame, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
    let geometry = &frame.geometry;
    let last = Access::FragmentSample;
    let channels = match name {
        "geometry.normal" => {
            let bytes = readback::image(gpu, &geometry.normal, frame.normal_access())?;
            AovChannels::Rgb(spread(frame, &words(&bytes).map(|word| normal(frame, word)).collect::<Vec<_>>()))
        }
        // Object and normal group as a number, as figure 2 shows them.
        "geometry.dsf.id" => {
            let bytes = readback::image(gpu, &geometry.dsf, last)?;
            AovChannels::YU32(spread(frame, &words(&bytes).map(|word| frame.packing.id(word)).collect::<Vec<_>>()))
        }
        // Metres from the eye's plane, 0 where no surface is.
        "geometry.dsf.depth" => {
            let bytes = readback::image(gpu, &geometry.dsf, last)?;
            let depth = |word| frame.packing.depth_m(word, frame.depth_range_m).unwrap_or(0.0);
            AovChannels::Y(spread(frame, &words(&bytes).map(depth).collect::<Vec<_>>()))
        }
        // Texels of the light buffer, right and down; 0 where no surface is.
        MOTION => {
            let image = geometry.motion.as_ref().expect("a stage that the settings leave out is refused");
            let bytes = readback::image(gpu, image, Access::ColorWrite)?;
            let vectors: Vec<_> = words(&bytes).map(|word| motion::vector_px(word).extend(0.0).to_array()).collect();
            AovChannels::Rgb(spread(frame, &vectors))
        }
        "light.l_buffer.irradiance" => {
            let texels = l_buffer(frame, gpu)?;
            AovChannels::Rgb(spread(frame, &texels.iter().map(|texel| texel.irradiance).collect::<Vec<_>>()))
        }
        // One number, two and a 0, or three.
        "light.l_buffer.highlight" => {
            let texels = l_buffer(frame, gpu)?;
            if frame.described.store.has_channels() {
                AovChannels::Y(spread(frame, &texels.iter().map(|texel| texel.highlight[0]).collect::<Vec<_>>()))
            } else {
                AovChannels::Rgb(spread(frame, &texels.iter().map(|texel| texel.highlight).collect::<Vec<_>>()))
            }
        }
        _ => unreachable!("{NAME} has no stage {name}"),
    };
    Ok(Aov { name: name.to_owned(), channels })
}

/// What the frame left of the BLEND draws on the screen.
///
/// Errors: memory for the copy (exit code 4).
pub fn lit(frame: &InferredFrame, gpu: &Arc<Gpu>, survivors: &Survivors) -> Result<StippleCounts> {
    let bytes = readback::image(gpu, &frame.geometry.dsf, Access::FragmentSample)?;
    Ok(survivors.count(words(&bytes), frame.geometry.extent()))
}

fn words(bytes: &[u8]) -> impl Iterator<Item = u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}

/// In view space; 0 where no surface is.
fn normal(frame: &InferredFrame, word: u32) -> [f32; 3] {
    if frame.packing.has_normal(word) { frame.packing.view_normal(word).to_array() } else { [0.0; 3] }
}

/// Two words a texel.
fn l_buffer_words(frame: &InferredFrame, gpu: &Arc<Gpu>) -> Result<Vec<[u32; 2]>> {
    let [l_buffer] = &frame.l_buffer;
    let words: Vec<u32> = words(&readback::image(gpu, l_buffer, Access::FragmentSample)?).collect();
    Ok(words.chunks_exact(2).map(|texel| [texel[0], texel[1]]).collect())
}

fn l_buffer(frame: &InferredFrame, gpu: &Arc<Gpu>) -> Result<Vec<Lighting>> {
    Ok(l_buffer_words(frame, gpu)?.into_iter().map(|words| frame.described.store.read(words)).collect())
}

/// Texels of the L-buffer of which a channel holds the most that it can.
///
/// Errors: memory for the copy (exit code 4).
pub fn cut_texels(frame: &InferredFrame, gpu: &Arc<Gpu>) -> Result<usize> {
    let texels = l_buffer_words(frame, gpu)?;
    Ok(texels.iter().filter(|words| frame.described.store.is_cut(**words)).count())
}

/// The texel of each pixel.
fn spread<T: Copy>(frame: &InferredFrame, texels: &[T]) -> Vec<T> {
    let (low, extent): (Extent, Extent) = (frame.geometry.extent(), frame.picture().0.description.extent);
    let along = |at: u32, from: u32, to: u32| {
        ((2 * u64::from(at) + 1) * u64::from(to) / (2 * u64::from(from))).min(u64::from(to) - 1) as usize
    };
    (0..extent.height)
        .flat_map(|y| (0..extent.width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let (x, y) = (along(x, extent.width, low.width), along(y, extent.height, low.height));
            texels[y * low.width as usize + x]
        })
        .collect()
}

impl Frame for InferredFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let geometry = &self.geometry;
        let [l_buffer] = &self.l_buffer;
        self.geometry_pass.record(cmd, &self.light_frame, scene, geometry)?;
        let [mut written, mut keyed] = [Access::DepthWrite, Access::ColorWrite];
        if let Some(decals) = &self.decals {
            decals.record(cmd, &self.light_frame, scene, geometry)?;
            [written, keyed] = [Access::DepthTest, Access::FragmentSample];
        }
        if let (Some(cull), Some(masks)) = (&self.cull, &self.lights.masks) {
            let lights = CullLights { blocks: &self.lights.lights, count: self.lights.light_count };
            cull.record(cmd, geometry.from(written), &self.light_frame, lights, masks)?;
            written = Access::ComputeSample;
        }
        let from = geometry.from(written);
        match &self.light_pass {
            LightPass::Tiled(tiled) => {
                let lights = self.lights.from(Access::ComputeWrite);
                tiled.record(cmd, &self.light_frame, lights, from, l_buffer)?;
            }
            LightPass::Drawn { volumes, pack } => {
                let targets = pack.as_ref().map_or(&self.l_buffer[..], |pack| &pack.sums);
                volumes.record(cmd, &self.light_frame, &self.lights, from, targets)?;
                if let Some(pack) = pack {
                    pack.record(cmd, &self.light_frame, l_buffer)?;
                }
            }
        }
        let last = light::last_access(self.described);
        let guides = FilterGuides { dsf: geometry.dsf.from(keyed), normals: geometry.normal.from(self.lit_access()) };
        self.material.record(cmd, frame, scene, geometry, guides, l_buffer.from(last))
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        BTreeMap::from([
            ("triangles_drawn", self.geometry_pass.triangles_drawn() as f64),
            ("stipple_layers_used", self.shares.layers_used as f64),
            ("stipple_layers_shared", self.shares.layers_shared as f64),
            ("stipple_draws_sharing", self.shares.draws_sharing as f64),
            ("stipple_screen_shared", self.shares.part_of_screen()),
        ])
    }

    fn picture(&self) -> (&Image, Access) {
        self.material.picture()
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        let mut counters = self.material.counters(gpu)?;
        if let Some(survivors) = &self.survivors {
            let StippleCounts { layers, draws, unlit_draws } = lit(self, gpu, survivors)?;
            counters.insert("stipple_layers_lit", layers as f64);
            counters.insert("stipple_draws_lit", draws as f64);
            counters.insert("stipple_draws_unlit", unlit_draws as f64);
        }
        if let Store::Fixed { .. } = self.described.store {
            counters.insert("light_texels_cut", cut_texels(self, gpu)? as f64);
        }
        match &self.light_pass {
            LightPass::Tiled(_) => counters.extend(self.lights.counters(gpu, self.geometry.extent())?),
            LightPass::Drawn { volumes, .. } => {
                let all = self.geometry.extent().pixel_count() * u64::from(self.lights.light_count);
                let evaluated = volumes.evaluations()?;
                counters.insert("lights_counted_into_stencil", volumes.counted_lights() as f64);
                counters.insert("light_evaluations", evaluated as f64);
                counters.insert("light_evaluations_culled", (all - evaluated) as f64);
            }
        }
        Ok(counters)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        read(self, gpu, name)
    }
}

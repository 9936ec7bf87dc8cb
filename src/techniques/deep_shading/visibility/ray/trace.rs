//! Rays for the samples of a set: the SPID and the depth of what each sees.

use super::super::super::choices::Choices;
use super::super::super::primitives::Primitives;
use super::super::super::space::ShadingSpace;
use super::super::super::tuples::TupleTable;
use super::tree::{End, Ray, RayHit, SweptTree, corners_ws};
use crate::error::Result;
use crate::gpu::shader::structs::{DeepBlock, TupleBlock};
use crate::interrupt;
use crate::sampling::sobol;
use crate::scene::{AlphaMode, Projection, Scene};
use crate::shading::material::{MeshPoint, base_color_at};
use crate::techniques::Inputs;
use crate::techniques::deep_shading::modes::pixel_samples::PixelSamples;
use crate::units::Extent;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// space.glsl's NO_PRIMITIVE and NO_SHADING_PIXEL.
pub const NONE: u32 = u32::MAX;

/// What a sample sees, as the layers hold it: nothing has all bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Zeroable, bytemuck::Pod)]
#[repr(C)]
pub struct Spid {
    pub primitive: u32,
    /// 16 bits a side.
    pub pixel: u32,
}

/// A set's samples, layer by layer, row by row.
pub struct Hits {
    pub spids: Vec<Spid>,
    /// Depth at shading points (space.glsl's shading_depth).
    pub shading_depths: Vec<u32>,
}

/// The scene as rays see it.
pub struct Tracer<'a> {
    tree: SweptTree,
    scene: &'a Scene,
    deep: DeepBlock,
    ends: [End; 2],
    table: TupleTable,
    pixel_samples: PixelSamples,
    eyes: Vec<f32>,
    space: ShadingSpace,
    frame: Extent,
    is_moving: bool,
    depths: [f32; 2],
    seed: u32,
}

impl<'a> Tracer<'a> {
    /// Errors: as `SweptTree::new`.
    pub fn new(inputs: &Inputs<'a>, choices: &Choices, primitives: &Primitives) -> Result<Self> {
        let deep = choices.deep_block(inputs);
        let ends = End::both(&deep);
        let depths = match inputs.view.camera.projection {
            Projection::Perspective { z_near, z_far, .. } => [z_near, z_far.unwrap_or(f32::MAX)],
            Projection::Orthographic { z_near, z_far, .. } => [z_near, z_far],
        };
        Ok(Self {
            tree: SweptTree::new(inputs.scene, primitives, &ends)?,
            scene: inputs.scene,
            deep,
            ends,
            table: choices.table,
            pixel_samples: choices.pixel_samples,
            eyes: choices.eyes(),
            space: choices.space,
            frame: inputs.view.extent,
            is_moving: choices.blur.is_moving,
            depths,
            seed: inputs.values.integer("seed") as u32,
        })
    }

    /// The samples of a set.
    ///
    /// Errors: Ctrl-C (exit code 130).
    pub fn trace(&self, run: u32) -> Result<Hits> {
        let tuples = self.table.tuples(self.frame, self.seed, run, &self.eyes);
        let layer = self.table.layer(self.frame);
        let (width, height) = (layer.width as usize, layer.height as usize);
        let mut seen = vec![(Spid { primitive: NONE, pixel: NONE }, NONE); width * height * tuples.len()];
        seen.par_chunks_mut(width).enumerate().try_for_each(|(row, seen)| {
            interrupt::check()?;
            let (tuple, y) = ((row / height) as u32, (row % height) as u32);
            let inside = self.table.inside(self.frame, tuple);
            if y >= inside.height {
                return Ok(());
            }
            for (x, seen) in (0..inside.width).zip(seen) {
                let number = self.table.number(run, tuple);
                let ray = self.ray(&self.tuple_at(&tuples[tuple as usize], tuple, [x, y]), layer, [x, y]);
                let met = self.tree.first(&ray, self.depths, |met| self.is_seen(met, [x, y], number));
                if let Some(met) = met {
                    *seen = self.entry(&met);
                }
            }
            Ok::<(), crate::error::Error>(())
        })?;
        let (spids, shading_depths) = seen.into_iter().unzip();
        Ok(Hits { spids, shading_depths })
    }

    /// What the sample of `tuple` has at a layer's pixel: the tuple's, or the frame's pixel's own.
    fn tuple_at(&self, shared: &TupleBlock, tuple: u32, at: [u32; 2]) -> TupleBlock {
        match self.pixel_samples {
            PixelSamples::Shared => *shared,
            PixelSamples::Own => self.table.of_pixel(self.frame, shared, self.table.pixel_of(tuple, at)),
        }
    }

    /// Through the middle of a layer's pixel (visibility/seen.glsl's clip_of, solved for what it maps there).
    fn ray(&self, tuple: &TupleBlock, layer: Extent, [x, y]: [u32; 2]) -> Ray {
        let middle = |at: u32, side: u32| 2.0 * (at as f32 + 0.5) / side as f32 - 1.0;
        let at = Vec2::new(middle(x, layer.width), middle(y, layer.height));
        let at = (at - Vec2::from_array(tuple.shift)) / Vec2::from_array(tuple.scale);
        let lens = Vec2::from_array(self.deep.lens) * Vec2::from_array(tuple.lens);
        let aside = -lens * self.deep.inverse_focus;
        // Under perspective the picture's place is a slope, else a place.
        let (origin, direction) = match self.scene_is_perspective() {
            true => (lens, at + aside),
            false => (at + lens, aside),
        };
        Ray { origin: origin.extend(0.0), direction: direction.extend(1.0), time: tuple.time }
    }

    fn scene_is_perspective(&self) -> bool {
        // w of clip space changes with depth.
        self.deep.open_clip_from_world.iter().take(3).any(|column| column[3] != 0.0)
    }

    /// sample.frag's sides and alpha.glsl's thresholds. `number`: of the tuple among all sets'.
    fn is_seen(&self, met: &RayHit, [x, y]: [u32; 2], number: u32) -> bool {
        let draw = &self.scene.draws[met.draw as usize];
        let mesh = &self.scene.meshes[draw.mesh];
        let material = &self.scene.materials[mesh.material];
        let is_front = met.is_front != (draw.world_from_object.determinant() < 0.0);
        if !is_front && !material.double_sided {
            return false;
        }
        let alpha = || {
            let point = MeshPoint::on(mesh, met.vertices.map(|vertex| vertex as usize), met.weights.to_array());
            base_color_at(self.scene, material, &point).w
        };
        match material.alpha {
            AlphaMode::Opaque => true,
            AlphaMode::Mask { cutoff } => alpha() >= cutoff,
            AlphaMode::Blend => alpha() > alpha_threshold([x, y], number, met.draw),
        }
    }

    fn entry(&self, met: &RayHit) -> (Spid, u32) {
        let clip_at = |moment: &Scene, end: &End| {
            let [a, b, c] = corners_ws(moment, met.draw, met.vertices).map(|corner| end.clip(corner));
            let Vec3 { x, y, z } = met.weights;
            a * x + b * y + c * z
        };
        let mut clip = clip_at(self.scene, &self.ends[0]);
        if self.is_moving {
            let closing = self.scene.closing.as_deref().unwrap_or(self.scene);
            clip = 0.5 * clip + 0.5 * clip_at(closing, &self.ends[1]);
        }
        let pixel = self.space.pixel(clip).map_or(NONE, |[x, y]| x | y << 16);
        let depth = (clip.z / clip.w).clamp(0.0, 1.0);
        (Spid { primitive: met.primitive, pixel }, depth.to_bits())
    }
}

/// alpha.glsl's.
fn alpha_threshold([x, y]: [u32; 2], number: u32, draw: u32) -> f32 {
    let bits = x.wrapping_mul(0x9e37_79b1)
        ^ y.wrapping_mul(0x85eb_ca77)
        ^ number.wrapping_mul(0xc2b2_ae3d)
        ^ draw.wrapping_mul(0x27d4_eb2f);
    (sobol::mixed(bits) >> 8) as f32 / 16_777_216.0
}

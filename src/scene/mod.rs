//! The scene on the host: triangles, materials, textures, lights, cameras. No Vulkan types.
//!
//! World space is glTF's: right-handed, y up, metres. Light is glTF's: candela, lux, emissive radiance
//! (see `shading` for what they mean in a picture).

pub mod animation;
pub mod atlas;
pub mod camera;
pub mod facing;
pub mod glb;
pub mod gltf;
pub mod joined;
pub mod light;
pub mod material;
pub mod medium;
pub mod mesh;
pub mod mipmaps;
mod model;
pub mod normal_groups;
pub mod object_ids;
pub mod palette;
pub mod places;
pub mod procedural;
pub mod shell;
mod shown_texels;
pub mod texture;

use crate::error::{Error, Result};
use crate::volume::Volume;
pub use model::{Model, inspect, load, open};
use std::sync::Arc;

pub use animation::AnimationChoice;
pub use camera::{Camera, Projection};
pub use light::{Light, LightKind, LightSource};
pub use material::{AlphaMode, Material, TextureSlot};
pub use medium::Medium;
pub use mesh::{Bounds, Draw, Facing, Mesh, Node};
pub use shown_texels::ShownTexels;
pub use texture::{ColorSpace, Image, Placement, Sampler, Texture, Texturing, Wrap};

/// Everything that a technique may draw.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// The built-in name with its parameters, or the file's stem.
    pub name: String,
    /// BLAKE3, in hexadecimal, of the bytes read and the import settings (of name and parameters for built-in scenes).
    pub hash: String,
    /// Triangle lists in object space, one material each (a glTF primitive).
    pub meshes: Vec<Mesh>,
    /// Which mesh stands where. Several draws may share a mesh.
    pub draws: Vec<Draw>,
    /// What a file calls its nodes; empty for built-in scenes.
    pub nodes: Vec<Node>,
    /// Index into `nodes` of each draw; empty for built-in scenes.
    pub draw_nodes: Vec<u32>,
    /// At least one where there is a mesh; `Mesh::material` points here.
    pub materials: Vec<Material>,
    /// An image seen through a sampler in a colour space; materials point here.
    pub textures: Vec<Texture>,
    /// Decoded pictures; textures point here. Shared by the moments of a model: what is the same picture at two of them
    /// need not be looked at twice.
    pub images: Vec<Arc<Image>>,
    /// How a device holds and reads textures. What the host looks up (`shading::material`) stays as the file has it.
    pub texturing: Texturing,
    /// Punctual lights. Emissive materials are not listed here.
    pub lights: Vec<Light>,
    /// What `--medium auto` is. None: nothing, as in every file: glTF has no word for it.
    pub medium: Option<Medium>,
    /// Values on a grid that emit and absorb light (`--volume`). None: no file has one.
    pub volume: Option<Arc<Volume>>,
    /// Cameras in file order. May be empty: the view then frames the bounds (`crate::framing`).
    pub cameras: Vec<Camera>,
    /// The box around everything that is drawn while the animations play, sampled at a few moments; None where
    /// nothing moves.
    pub reach: Option<Bounds>,
    /// Which way front faces look when the animations begin; None where nothing moves.
    pub facing: Option<Facing>,
    /// The scene when the shutter closes, where it is open while things move: other places of the same meshes, lights and
    /// cameras, without pictures. None: all stands as it stands here.
    pub closing: Option<Box<Scene>>,
    /// The scene a moment before, where it was another one and motion vectors are asked for: as `closing`.
    pub earlier: Option<Box<Scene>>,
    /// What was ignored or replaced on import, one sentence each, for the user to read.
    pub warnings: Vec<String>,
}

impl Scene {
    /// This scene with a shutter that is open until it has become `closing`; where the two are one, it stands still.
    ///
    /// Errors: they differ in their triangles, lights or cameras (exit code 2).
    pub fn closing_as(mut self, mut closing: Scene) -> Result<Self> {
        if self.hash == closing.hash {
            return Ok(self);
        }
        self.require_same_shape(&closing, "while the shutter is open", "--shutter none draws one moment")?;
        let both = format!("{} {}", self.hash, closing.hash);
        self.hash = blake3::hash(both.as_bytes()).to_hex().to_string();
        closing.images = Vec::new();
        self.closing = Some(Box::new(closing));
        Ok(self)
    }

    /// This scene, which was `earlier` a moment before; where the two are one, it stands still. Its pictures are the same.
    ///
    /// Errors: they differ in their triangles, lights or cameras (exit code 2).
    pub fn moved_from(mut self, mut earlier: Scene) -> Result<Self> {
        if self.hash == earlier.hash {
            return Ok(self);
        }
        self.require_same_shape(&earlier, "since --motion-interval before", "--motion-vectors off needs one moment")?;
        earlier.images = Vec::new();
        self.earlier = Some(Box::new(earlier));
        Ok(self)
    }

    /// This scene with a volume in it.
    pub fn holding(mut self, volume: &Arc<Volume>) -> Self {
        let both = format!("{} {}", self.hash, volume.hash);
        self.hash = blake3::hash(both.as_bytes()).to_hex().to_string();
        self.volume = Some(volume.clone());
        self
    }

    /// Whether both draw the same triangles in the same materials, wherever they are.
    pub fn has_same_triangles(&self, other: &Scene) -> bool {
        let is_same = |(a, b): (&Mesh, &Mesh)| {
            (a.positions.len(), a.material, &a.indices) == (b.positions.len(), b.material, &b.indices)
        };
        let meshes_of = |scene: &Scene| scene.draws.iter().map(|draw| draw.mesh).collect::<Vec<_>>();
        self.meshes.len() == other.meshes.len()
            && meshes_of(self) == meshes_of(other)
            && self.meshes.iter().zip(&other.meshes).all(is_same)
    }

    /// Errors: `other` has other triangles, lights or cameras (exit code 2).
    fn require_same_shape(&self, other: &Scene, when: &str, instead: &str) -> Result<()> {
        let counts = |scene: &Scene| (scene.lights.len(), scene.cameras.len());
        if counts(self) != counts(other) || !self.has_same_triangles(other) {
            return Err(Error::request(format!(
                "{}: its triangles, materials, lights or cameras change {when}, not only their places",
                self.name
            ))
            .note(instead));
        }
        Ok(())
    }

    /// What its vertices, indices, draws and pictures take in memory.
    pub fn size_bytes(&self) -> u64 {
        let meshes: usize = self.meshes.iter().map(Mesh::size_bytes).sum();
        let images: usize = self.images.iter().map(|image| image.rgba8.len()).sum();
        (meshes + images + size_of_val(self.draws.as_slice())) as u64
    }

    /// How many triangles all draws together have.
    pub fn triangle_count(&self) -> u64 {
        self.draws.iter().map(|draw| self.meshes[draw.mesh].triangle_count() as u64).sum()
    }

    /// The material of each draw.
    pub fn drawn_materials(&self) -> impl Iterator<Item = &Material> {
        self.draws.iter().map(|draw| &self.materials[self.meshes[draw.mesh].material])
    }

    /// The box around everything that is drawn, while a shutter is open too, in world space; empty where nothing is drawn.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for draw in &self.draws {
            draw.extend(&self.meshes[draw.mesh], &mut bounds);
        }
        if let Some(closing) = self.closing.as_ref().map(|closing| closing.bounds()).filter(|bounds| !bounds.is_empty())
        {
            bounds.include(closing.min);
            bounds.include(closing.max);
        }
        bounds
    }

    /// The box around a draw, while a shutter is open too, in world space. On the way from opening to closing a vertex is a mix of
    /// its places under both matrices with both positions.
    pub fn swept_bounds(&self, draw: usize) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        let moments = || [Some(self), self.closing.as_deref()].into_iter().flatten();
        for (at, of) in moments().flat_map(|at| moments().map(move |of| (at, of))) {
            at.draws[draw].extend(&of.meshes[of.draws[draw].mesh], &mut bounds);
        }
        bounds
    }

    /// The box that a camera made up frames, that scattered lights fill, and whose diagonal lengths are a part of: the same
    /// at all times, `bounds` where nothing moves.
    pub fn lasting_bounds(&self) -> Bounds {
        self.reach.unwrap_or_else(|| self.bounds())
    }

    /// Which way front faces look, for a camera made up: the same at all times.
    pub fn lasting_facing(&self) -> Facing {
        self.facing.unwrap_or_else(|| Facing::of(self))
    }
}

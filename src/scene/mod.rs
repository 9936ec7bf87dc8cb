//! The scene on the host: triangles, materials, textures, lights, cameras. No Vulkan types.
//!
//! World space is glTF's: right-handed, y up, metres. Light is glTF's: candela, lux, emissive radiance
//! (see `shading` for what they mean in a picture).

pub mod camera;
pub mod glb;
pub mod gltf;
pub mod light;
pub mod material;
pub mod mesh;
pub mod mipmaps;
pub mod procedural;
pub mod texture;

use crate::error::{Error, Result};
use std::path::Path;

pub use camera::{Camera, Projection};
pub use light::{Light, LightKind};
pub use material::{AlphaMode, Material, TextureSlot};
pub use mesh::{Bounds, Draw, Mesh};
pub use texture::{ColorSpace, Image, Placement, Sampler, Texture, Wrap};

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
    /// At least one where there is a mesh; `Mesh::material` points here.
    pub materials: Vec<Material>,
    /// An image seen through a sampler in a colour space; materials point here.
    pub textures: Vec<Texture>,
    /// Decoded pictures; textures point here.
    pub images: Vec<Image>,
    /// Greatest side that a texture has in device memory: larger ones begin at a coarser level. 0: no limit. What the
    /// host looks up (`shading::material`) stays as fine as the file.
    pub texture_limit_px: u32,
    /// Punctual lights. Emissive materials are not listed here.
    pub lights: Vec<Light>,
    /// Cameras in file order. May be empty: the job then frames the bounds.
    pub cameras: Vec<Camera>,
    /// What was ignored or replaced on import, one sentence each, for the user to read.
    pub warnings: Vec<String>,
}

/// The scene that a name or a path stands for: a built-in one, with parameters after a colon, or a .gltf or .glb file.
///
/// Errors: no such scene, impossible parameters, a broken file (exit code 2).
pub fn load(spec: &str, seed: u64) -> Result<Scene> {
    if let Some(scene) = procedural::build(spec, seed) {
        return scene;
    }
    gltf::load(file(spec)?)
}

/// The same scene, and what its file holds beside it; None for built-in scenes.
///
/// Errors: those of `load`.
pub fn inspect(spec: &str, seed: u64) -> Result<(Scene, Option<gltf::Facts>)> {
    if let Some(scene) = procedural::build(spec, seed) {
        return Ok((scene?, None));
    }
    let (scene, facts) = gltf::inspect(file(spec)?)?;
    Ok((scene, Some(facts)))
}

/// The path of a scene file.
///
/// Errors: no known suffix (exit code 2).
fn file(spec: &str) -> Result<&Path> {
    let path = Path::new(spec);
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    if !["gltf", "glb"].contains(&extension.as_str()) {
        let names: Vec<&str> = procedural::ALL.iter().map(|built_in| built_in.name).collect();
        return Err(Error::request(format!("scene {spec}: neither a built-in scene nor a .gltf or .glb file"))
            .note(format!("built-in scenes: {}", names.join(", "))));
    }
    Ok(path)
}

impl Scene {
    /// How many triangles all draws together have.
    pub fn triangle_count(&self) -> u64 {
        self.draws.iter().map(|draw| self.meshes[draw.mesh].triangle_count() as u64).sum()
    }

    /// The material of each draw.
    pub fn drawn_materials(&self) -> impl Iterator<Item = &Material> {
        self.draws.iter().map(|draw| &self.materials[self.meshes[draw.mesh].material])
    }

    /// The box around everything that is drawn, in world space; empty where nothing is drawn.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for draw in &self.draws {
            for position in &self.meshes[draw.mesh].positions {
                bounds.include(draw.world_from_object.transform_point3(*position));
            }
        }
        bounds
    }
}

//! What a glTF file holds beyond what becomes a Scene, for `scene inspect`.

use std::path::Path;

use gltf::Document;

use super::buffers::Buffers;
use super::source::Source;
use super::{accessors, document, images};
use crate::error::Result;
use crate::scene::Scene;
use crate::scene::gltf::images::ImageFacts;

/// The file's own counts and names.
#[derive(Clone, Debug)]
pub struct Facts {
    /// Bytes of the file and of the files that it points at, as far as they were read.
    pub size_bytes: u64,
    pub generator: Option<String>,
    pub version: String,
    pub extensions_used: Vec<String>,
    pub extensions_required: Vec<String>,
    pub scene_count: usize,
    pub node_count: usize,
    pub mesh_count: usize,
    pub primitive_count: usize,
    pub texture_count: usize,
    pub skin_count: usize,
    pub images: Vec<ImageFacts>,
    pub animations: Vec<AnimationFacts>,
}

#[derive(Clone, Debug)]
pub struct AnimationFacts {
    pub name: String,
    pub channel_count: usize,
    /// Time of the last key, in seconds; None where the times cannot be read.
    pub duration_s: Option<f32>,
}

/// Reads a .gltf or .glb file as `load` does, and what it holds beside its scene.
///
/// Errors: those of `load`.
pub fn inspect(path: &Path) -> Result<(Scene, Facts)> {
    let scene = super::load(path)?;
    Ok((scene, facts(path).map_err(|error| error.within(path.display()))?))
}

fn facts(path: &Path) -> Result<Facts> {
    let source = Source::open(path)?;
    let document = document::parse(source.json())?.document;
    // Here the hasher only counts the bytes of external files.
    let mut hasher = blake3::Hasher::new();
    let buffers = Buffers::read(&document, &source, &mut hasher)?;
    let images = images::headers(&document, &source, &buffers, &mut hasher);
    let root = document.as_json();
    Ok(Facts {
        size_bytes: source.bytes().len() as u64 + hasher.count(),
        generator: root.asset.generator.clone(),
        version: root.asset.version.clone(),
        extensions_used: root.extensions_used.clone(),
        extensions_required: root.extensions_required.clone(),
        scene_count: root.scenes.len(),
        node_count: root.nodes.len(),
        mesh_count: root.meshes.len(),
        primitive_count: root.meshes.iter().map(|mesh| mesh.primitives.len()).sum(),
        texture_count: root.textures.len(),
        skin_count: root.skins.len(),
        images,
        animations: animations(&document, &buffers),
    })
}

fn animations(document: &Document, buffers: &Buffers<'_>) -> Vec<AnimationFacts> {
    let of = |animation: gltf::Animation<'_>| {
        let mut duration_s = Some(0.0f32);
        for sampler in animation.samplers() {
            let times = accessors::floats::<1>(buffers, &sampler.input()).ok();
            let last = times.map(|times| times.iter().map(|[time]| *time).fold(0.0, f32::max));
            duration_s = duration_s.zip(last).map(|(longest, last)| longest.max(last));
        }
        AnimationFacts {
            name: animation.name().map_or_else(|| format!("animation {}", animation.index()), str::to_owned),
            channel_count: animation.channels().count(),
            duration_s,
        }
    };
    document.animations().map(of).collect()
}

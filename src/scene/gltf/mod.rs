//! glTF 2.0 files (.gltf and .glb) to a Scene.
//!
//! A file comes from anywhere, so nothing in it is believed: every index, count, offset and number is checked before
//! it is used, and what fails names its element. What the renderer does not draw yet (animations, skins, morph targets,
//! UV sets beyond the second, unknown extensions) leaves one warning each.
//!
//! Why this way: the `gltf` crate parses the JSON, but its own GLB reader, accessor iterators and some of its getters
//! assert on broken files, so bytes are read by `source`, `buffers` and `accessors`, and `document` checks what those
//! getters rely on.

mod accessors;
mod buffers;
mod cameras;
mod document;
mod facts;
mod images;
mod label;
mod lights;
mod materials;
mod nodes;
mod primitives;
mod source;
mod tangents;
mod topology;
mod uri;

pub use self::facts::{AnimationFacts, Facts, ImageFacts, inspect};

use std::collections::BTreeSet;
use std::path::Path;

use glam::Mat3;

use self::buffers::Buffers;
use self::materials::Materials;
use self::nodes::PlacedNode;
use self::primitives::Primitives;
use self::source::Source;
use crate::error::{Error, Result};
use crate::scene::{Draw, Scene};

/// Stands in the hash for how a file becomes a scene; a change that alters scenes alters this line.
const IMPORT_SETTINGS: &[u8] = b"quincunx glTF import 2: rest pose, COLOR_0, two UV sets, flat normals, MikkTSpace";

/// A short file can have many nodes that all draw one mesh of many primitives; this many draws take 320 MiB.
const MAX_DRAWS: usize = 1 << 22;

/// Reads a .gltf or .glb file with its buffers and images.
///
/// External files must lie in the file's folder or below it. Draws, lights and cameras stand in the order of their
/// nodes. Fails with a request error (exit code 2) that names the file and the element.
pub fn load(path: &Path) -> Result<Scene> {
    read(path).map_err(|error| error.within(path.display()))
}

fn read(path: &Path) -> Result<Scene> {
    let source = Source::open(path)?;
    let document = document::parse(source.json())?;
    let mut warnings = document::ignored_features(&document);

    let mut hasher = blake3::Hasher::new();
    hasher.update(source.bytes());
    let buffers = Buffers::read(&document, &source, &mut hasher)?;
    let Materials { mut materials, textures, image_indices } = materials::read(&document, &mut warnings)?;
    let images = images::read(&document, &image_indices, &source, &buffers, &mut hasher)?;
    hasher.update(IMPORT_SETTINGS);

    let placed = nodes::place(&document)?;
    let lights = lights::read(&document, &placed, &mut warnings)?;
    let cameras = cameras::read(&document, &placed, &mut warnings)?;
    let drawn: BTreeSet<usize> = placed.iter().filter_map(|placed| placed.mesh(&document)).collect();
    let primitives = primitives::read(&document, &drawn, &buffers, &mut materials, &mut warnings)?;
    let draws = draws(&document, &placed, &primitives, &mut warnings)?;

    let scene = Scene {
        name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
        hash: hasher.finalize().to_hex().to_string(),
        meshes: primitives.meshes,
        draws,
        materials,
        textures,
        images,
        lights,
        cameras,
        warnings,
        texture_limit_px: 0,
    };
    let bounds = scene.bounds();
    if !bounds.is_empty() && !bounds.diagonal().is_finite() {
        return Err(Error::request(format!(
            "the scene reaches from {} to {}, too far for 32-bit floats; scale it down",
            bounds.min, bounds.max
        )));
    }
    Ok(scene)
}

/// One draw for every primitive of every placed mesh.
fn draws(
    document: &gltf::Document,
    placed: &[PlacedNode],
    primitives: &Primitives,
    warnings: &mut Vec<String>,
) -> Result<Vec<Draw>> {
    let mut draws = Vec::new();
    let mut flat = Vec::new();
    for placed in placed {
        let Some(mesh) = placed.mesh(document) else { continue };
        let determinant = Mat3::from_mat4(placed.world_from_node).determinant();
        // Below the normal floats the inverse, and with it every normal, is lost.
        if !determinant.is_normal() {
            flat.push(label::node(document, placed.node_index));
            continue;
        }
        let meshes = primitives.of_mesh(mesh);
        if draws.len() + meshes.len() > MAX_DRAWS {
            let node = label::node(document, placed.node_index);
            return Err(Error::request(format!("{node} brings the scene to more than {MAX_DRAWS} draws, the limit")));
        }
        draws.extend(meshes.map(|mesh| Draw { mesh, world_from_object: placed.world_from_node }));
    }
    if let Some(first) = flat.first() {
        warnings.push(format!(
            "{} drawn by a transform that flattens it to nothing or scales it beyond 32-bit floats: {first}{}; \
             left out",
            label::count(flat.len(), "mesh is", "meshes are"),
            if flat.len() > 1 { " and others" } else { "" },
        ));
    }
    Ok(draws)
}

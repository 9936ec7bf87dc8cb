//! glTF 2.0 files (.gltf and .glb) to a `Model`, and that to a `Scene` at a moment.
//!
//! A file comes from anywhere, so nothing in it is believed: every index, count, offset and number is checked before
//! it is used, and what fails names its element. What the renderer does not draw (UV sets beyond the second, unknown
//! extensions) leaves one warning each.
//!
//! Why this way: the `gltf` crate parses the JSON, but its own GLB reader, accessor iterators and some of its getters
//! assert on broken files, so bytes are read by `source`, `buffers` and `accessors`, and `document` checks what those
//! getters rely on.

mod accessors;
mod animations;
mod attributes;
mod bodies;
mod buffers;
mod cameras;
mod deform;
mod document;
mod facts;
mod images;
pub(crate) mod label;
mod lights;
mod limits;
pub(crate) mod marks;
mod materials;
mod model;
mod morph;
mod motion;
mod nodes;
mod normals;
mod parts;
mod primitives;
mod skins;
mod source;
mod survey;
mod tangents;
mod topology;
mod uri;

pub use self::facts::{AnimationFacts, Facts, inspect};
pub use crate::scene::gltf::images::ImageFacts;

use std::path::Path;

use crate::error::Result;
use crate::scene::Scene;
use crate::scene::animation::AnimationChoice;

pub use animations::no_such_animation;
pub use model::Model;

/// The scene of a .gltf or .glb file at 0 s, all its animations playing.
///
/// Errors: as `Model::open`.
pub fn load(path: &Path) -> Result<Scene> {
    Model::open(path, &AnimationChoice::All)?.into_pose(0.0)
}

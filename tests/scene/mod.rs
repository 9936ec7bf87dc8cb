//! Scenes as they are read.

mod gltf;

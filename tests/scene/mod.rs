//! Scenes as they are read and made.

mod furnished;
mod gltf;
mod smoke;

//! What several test files share.

pub mod gltf_file;

//! A thin floor over ash: device, commands, barriers, buffers, images, pipelines. It knows no technique and no scene.

pub mod access;
mod bands;
pub mod barrier;
pub mod berth;
pub mod buffer;
mod build;
pub mod calibration;
pub mod commands;
pub mod descriptors;
pub mod device;
pub mod failure;
pub mod image;
pub mod interface;
pub mod pipeline;
pub mod probe;
pub mod readback;
pub mod recorded;
pub mod rendering;
pub mod sampler;
pub mod shader;
pub mod statistics;
pub mod structure;
pub mod timing;
pub mod transfer;
pub mod upload;
pub mod validation;

pub use access::{Access, AccessSet};
pub use barrier::{Barrier, Edge, Target};
pub use berth::Berth;
pub use buffer::Buffer;
pub use commands::{Commands, Traffic};
pub use descriptors::Bound;
pub use device::{DeviceRequest, Gpu};
pub use image::{Image, ImageDescription};
pub use rendering::{ColorTarget, Layers};
pub use structure::Structure;

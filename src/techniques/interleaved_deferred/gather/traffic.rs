//! Bytes that copies between orders of the frame move.

use crate::gpu::Traffic;
use crate::gpu::shader::structs::MappingParams;

/// Bytes of a pass from `source_texels` to `target_texels`.
pub fn moved(source_texels: u64, target_texels: u64, threads: [u32; 3]) -> Traffic {
    let invocations = Some(threads.iter().map(|side| u64::from(*side)).product());
    Traffic { read_bytes: Some(source_texels * 8), written_bytes: Some(target_texels * 8), invocations }
}

/// Bytes of a pass that ends in frame order: what is pulled comes with the padding of the rows, what is pushed reads
/// the padding of sub-buffers and leaves it.
pub fn to_frame(mapping: &MappingParams, pulls: bool, threads: [u32; 3]) -> Traffic {
    if pulls {
        moved(mapping.frame_texel_count(), mapping.frame_texel_count(), threads)
    } else {
        moved(mapping.texel_count(), mapping.extent().pixel_count(), threads)
    }
}

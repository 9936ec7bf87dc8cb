//! Interleave-RepeatFrame: layer by layer, each with all draws (Clarberg & Munkberg 2014, section 4.2). Needs nothing of the
//! device, and keeps to one layer's memory at a time. Shader: sample.vert.

use crate::techniques::deep_shading::visibility::draw::Repeats;

/// In the tuple's layer.
pub fn repeats(tuple: u32) -> Repeats {
    Repeats { tuples: tuple..tuple + 1, step: 1, instance_count: 1 }
}

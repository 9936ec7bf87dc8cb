//! Interleave-Instancing: each draw call once, an instance a tuple (Clarberg & Munkberg 2014, section 4.2). Shader: sample.vert.

use crate::techniques::deep_shading::visibility::draw::Repeats;

pub fn repeats(tuple_count: u32) -> Repeats {
    Repeats { tuples: 0..1, step: 1, instance_count: tuple_count }
}

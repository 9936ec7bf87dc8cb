//! Interleave-RepeatDraw: each draw call for all tuples before the next one (Clarberg & Munkberg 2014, section 4.2). State
//! changes once a draw; as many calls as by repeated frames. Shader: sample.vert.

use crate::techniques::deep_shading::visibility::draw::Repeats;

pub fn repeats(tuple_count: u32) -> Repeats {
    Repeats { tuples: 0..tuple_count, step: 1, instance_count: 1 }
}

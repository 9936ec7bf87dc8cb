//! Last bits: quotients, roots, powers and angles come out one unit in the last place off, up or down.
//!
//! Vulkan lets them be farther off (2.5 units a quotient), `precise` or not. The direction depends on the result's bits
//! and on the place in the shader. Zero, one, infinity, NaN and what is too small for a full mantissa stay: devices
//! come to them exactly, as good as always.

use super::instruction::of_ids;
use super::module::Module;
use rspirv::dr::Instruction;
use rspirv::spirv::{GlslStd450Op as Glsl, Op};

const INEXACT: [Glsl; 18] = [
    Glsl::Sin,
    Glsl::Cos,
    Glsl::Tan,
    Glsl::Asin,
    Glsl::Acos,
    Glsl::Atan,
    Glsl::Atan2,
    Glsl::Sinh,
    Glsl::Tanh,
    Glsl::Pow,
    Glsl::Exp,
    Glsl::Log,
    Glsl::Exp2,
    Glsl::Log2,
    Glsl::Sqrt,
    Glsl::InverseSqrt,
    Glsl::Length,
    Glsl::Normalize,
];

/// All bits but the sign.
const MAGNITUDE: u32 = 0x7fff_ffff;
const ONE: u32 = 1.0f32.to_bits();
const LEAST_NORMAL: u32 = f32::MIN_POSITIVE.to_bits();

pub fn last_bit(module: &mut Module, seed: u64) {
    module.for_each(
        |_, _| (),
        |module, (), inst, out| {
            let is_inexact = inst.class.opcode == Op::FDiv
                || module.glsl_function(&inst).is_some_and(|called| INEXACT.iter().any(|glsl| *glsl as u32 == called));
            match (module.free_components(&inst), inst.result_id, inst.result_type) {
                (Some(count), Some(result), Some(kind)) if is_inexact => {
                    let moved = moved(module, out, inst, count, seed);
                    out.push(of_ids(Op::Bitcast, kind, result, &[moved]));
                }
                _ => out.push(inst),
            }
        },
    );
}

/// Emits an instruction, and what moves its result: the moved bits.
fn moved(module: &mut Module, out: &mut Vec<Instruction>, mut inst: Instruction, count: u32, seed: u64) -> u32 {
    let chance = module.chance(seed, &inst);
    let right = module.fresh();
    // What the source says of the operation is no word about its bits.
    module.move_decorations(inst.result_id.replace(right).unwrap_or(right), right);
    out.push(inst);
    let (words, bools) = (module.words_of(count), module.bools(count));
    let bits = module.emit(out, Op::Bitcast, words, &[right]);
    // An odd factor's product has every bit of the result in its first one, which is 0 or 1: a step of -1 or 1.
    let [factor, shift, one] = [chance as u32 | 1, 31, 1].map(|value| module.constant(value, count));
    let spread = module.emit(out, Op::IMul, words, &[bits, factor]);
    let side = module.emit(out, Op::ShiftRightLogical, words, &[spread, shift]);
    let twice = module.emit(out, Op::IAdd, words, &[side, side]);
    let step = module.emit(out, Op::ISub, words, &[twice, one]);
    let stepped = module.emit(out, Op::IAdd, words, &[bits, step]);
    let limits = [MAGNITUDE, LEAST_NORMAL, f32::MAX.to_bits(), ONE];
    let [mask, least, most, exact] = limits.map(|value| module.constant(value, count));
    let magnitude = module.emit(out, Op::BitwiseAnd, words, &[bits, mask]);
    let above = module.emit(out, Op::UGreaterThan, bools, &[magnitude, least]);
    let below = module.emit(out, Op::ULessThan, bools, &[magnitude, most]);
    let inexact = module.emit(out, Op::INotEqual, bools, &[magnitude, exact]);
    let within = module.emit(out, Op::LogicalAnd, bools, &[above, below]);
    let is_moved = module.emit(out, Op::LogicalAnd, bools, &[within, inexact]);
    module.emit(out, Op::Select, words, &[is_moved, stepped, bits])
}

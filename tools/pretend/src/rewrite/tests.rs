//! What an invariant output depends on stays as it is, through variables and calls; the rest is rewritten.

use super::*;
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Operand};
use rspirv::spirv::{
    AddressingModel, Capability, Decoration, ExecutionModel, FunctionControl, MemoryModel, StorageClass,
};

/// A vertex shader with two outputs, each a sum of products and a quotient that a function of its own computes and
/// leaves in a variable.
fn vertex_shader(is_invariant: bool) -> Vec<u32> {
    let mut b = Builder::new();
    b.set_version(1, 6);
    b.capability(Capability::Shader);
    b.memory_model(AddressingModel::Logical, MemoryModel::GLSL450);
    let (void, float) = (b.type_void(), b.type_float(32, None));
    let [input, output, local] = [StorageClass::Input, StorageClass::Output, StorageClass::Function]
        .map(|class| b.type_pointer(None, class, float));
    let from = b.variable(input, None, StorageClass::Input, None);
    let to = [(); 2].map(|()| b.variable(output, None, StorageClass::Output, None));
    if is_invariant {
        b.decorate(to[0], Decoration::Invariant, []);
    }
    let kind = b.type_function(float, [float]);
    let callees = [(); 2].map(|()| {
        let callee = b.begin_function(float, None, FunctionControl::NONE, kind).unwrap();
        let x = b.function_parameter(float).unwrap();
        b.begin_block(None).unwrap();
        let held = b.variable(local, None, StorageClass::Function, None);
        let product = b.f_mul(float, None, x, x).unwrap();
        let sum = b.f_add(float, None, product, x).unwrap();
        let quotient = b.f_div(float, None, sum, x).unwrap();
        b.store(held, quotient, None, []).unwrap();
        let value = b.load(float, None, held, None, []).unwrap();
        b.ret_value(value).unwrap();
        b.end_function().unwrap();
        callee
    });
    let kind = b.type_function(void, []);
    let main = b.begin_function(void, None, FunctionControl::NONE, kind).unwrap();
    b.begin_block(None).unwrap();
    let x = b.load(float, None, from, None, []).unwrap();
    for (to, callee) in to.into_iter().zip(callees) {
        let value = b.function_call(float, None, callee, [x]).unwrap();
        b.store(to, value, None, []).unwrap();
    }
    b.ret().unwrap();
    b.end_function().unwrap();
    b.entry_point(ExecutionModel::Vertex, main, "main", [from, to[0], to[1]]);
    b.module().assemble()
}

/// Which of the two functions are as they were.
fn kept(shader: &[u32], modes: &Modes) -> [bool; 2] {
    let before = rspirv::dr::load_words(shader).unwrap();
    let after = rspirv::dr::load_words(rewritten(shader, modes).unwrap()).unwrap();
    [0, 1].map(|index| before.functions[index].assemble() == after.functions[index].assemble())
}

#[test]
fn what_an_invariant_output_hangs_on_stays() {
    let moved = |seed| Modes { last_bit: Some(seed), ..Modes::default() };
    let fused = |seed| Modes { contract: Some(seed), ..Modes::default() };
    let (bound, free) = (vertex_shader(true), vertex_shader(false));
    for seed in 0..16 {
        assert_eq!(kept(&bound, &moved(seed)), [true, false], "seed {seed}");
        assert_eq!(kept(&free, &moved(seed)), [false, false], "seed {seed}");
        assert!(kept(&bound, &fused(seed))[0], "seed {seed}");
    }
    // Chance takes half of the sums.
    for index in [0, 1] {
        let fused_count = (0..16).filter(|seed| !kept(&free, &fused(*seed))[index]).count();
        assert!((1..16).contains(&fused_count), "function {index}: {fused_count} of 16");
    }
}

#[test]
fn the_same_seed_writes_the_same_words_and_modes_together_write_both() {
    let shader = vertex_shader(false);
    let modes = Modes { contract: Some(3), last_bit: Some(4), ..Modes::default() };
    let written = rewritten(&shader, &modes).unwrap();
    assert_eq!(written, rewritten(&shader, &modes).unwrap());
    assert_eq!(shader, rewritten(&shader, &Modes::default()).unwrap());
    let module = rspirv::dr::load_words(&written).unwrap();
    let is_double = |inst: &rspirv::dr::Instruction| inst.operands == [Operand::Capability(Capability::Float64)];
    assert!(module.capabilities.iter().any(is_double));
}

#[test]
fn no_spirv_is_said_to_be_none() {
    assert!(rewritten(&[1, 2, 3, 4, 5], &Modes::default()).is_err());
}

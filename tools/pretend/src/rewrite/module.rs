//! A SPIR-V module while it is rewritten: what its ids are, and the few types and constants that are added.

use super::instruction::{id, of_ids};
use super::invariant;
use rspirv::binary::{Assemble, Consumer, ParseAction, parse_words};
use rspirv::dr::{self, Builder, Instruction, Operand};
use rspirv::spirv::{Decoration, Op, Word};
use std::collections::{HashMap, HashSet};

pub struct Module {
    builder: Builder,
    /// Hash of its words, so that chance differs from shader to shader.
    hash: u64,
    /// Component count of values that are 32-bit floats or vectors of them.
    components: HashMap<Word, u32>,
    no_contraction: HashSet<Word>,
    invariant: HashSet<Word>,
    /// The set of GLSL's functions.
    glsl: Option<Word>,
}

/// rspirv's loader, which knows no execution mode whose operands are ids, such as a workgroup's size by constants.
#[derive(Default)]
struct Loading {
    loader: dr::Loader,
    modes: Vec<Instruction>,
}

impl Consumer for Loading {
    fn initialize(&mut self) -> ParseAction {
        self.loader.initialize()
    }

    fn finalize(&mut self) -> ParseAction {
        self.loader.finalize()
    }

    fn consume_header(&mut self, header: dr::ModuleHeader) -> ParseAction {
        self.loader.consume_header(header)
    }

    fn consume_instruction(&mut self, inst: Instruction) -> ParseAction {
        if inst.class.opcode == Op::ExecutionModeId {
            self.modes.push(inst);
            return ParseAction::Continue;
        }
        self.loader.consume_instruction(inst)
    }
}

/// Every bit of the result depends on every bit of `value` (the last steps of SplitMix64).
fn mixed(value: u64) -> u64 {
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}

impl Module {
    pub fn parse(words: &[u32]) -> Result<Self, String> {
        let mut loading = Loading::default();
        parse_words(words, &mut loading).map_err(|state| state.to_string())?;
        let mut module = loading.loader.module();
        module.execution_modes.extend(loading.modes);
        if module.header.is_none() {
            return Err("no header".to_owned());
        }
        let no_contraction = invariant::decorated(&module, Decoration::NoContraction).collect();
        let is_float =
            |inst: &&Instruction| inst.class.opcode == Op::TypeFloat && inst.operands == [Operand::LiteralBit32(32)];
        let types = &module.types_global_values;
        let float = types.iter().find(is_float).and_then(|inst| inst.result_id);
        let mut floats: HashMap<Word, u32> = float.iter().map(|float| (*float, 1)).collect();
        for inst in types.iter().filter(|inst| inst.class.opcode == Op::TypeVector && Some(id(inst, 0)) == float) {
            floats.extend(inst.result_id.map(|vector| (vector, inst.operands[1].unwrap_literal_bit32())));
        }
        let is_glsl = |inst: &&Instruction| inst.operands == [Operand::LiteralString("GLSL.std.450".to_owned())];
        let of_value = |inst: &Instruction| Some((inst.result_id?, *floats.get(&inst.result_type?)?));
        let components = module.all_inst_iter().filter_map(of_value).collect();
        let glsl = module.ext_inst_imports.iter().find(is_glsl).and_then(|inst| inst.result_id);
        let invariant = invariant::hung_on(&module);
        let hash = words.iter().fold(0, |hash, word| mixed(hash ^ u64::from(*word)));
        Ok(Self { builder: Builder::new_from_module(module), hash, components, no_contraction, invariant, glsl })
    }

    pub fn words(self) -> Vec<u32> {
        self.builder.module().assemble()
    }

    /// Components of a float or a vector of floats.
    pub fn components(&self, value: Word) -> u32 {
        self.components.get(&value).copied().unwrap_or(1)
    }

    /// Components of an instruction's result, where it is a float of 32 bits or a vector of them and no invariant
    /// output depends on it.
    pub fn free_components(&self, inst: &Instruction) -> Option<u32> {
        let result = inst.result_id.filter(|result| !self.invariant.contains(result));
        self.components.get(&result?).copied()
    }

    /// Whether its source says that it is rounded for itself.
    pub fn is_precise(&self, inst: &Instruction) -> bool {
        inst.result_id.is_some_and(|result| self.no_contraction.contains(&result))
    }

    /// Which of GLSL's functions an instruction calls.
    pub fn glsl_function(&self, inst: &Instruction) -> Option<u32> {
        let is_one = inst.class.opcode == Op::ExtInst && self.glsl == Some(id(inst, 0));
        is_one.then(|| inst.operands[1].unwrap_literal_ext_inst_integer())
    }

    /// A number for an instruction: another one for each seed, shader and instruction.
    pub fn chance(&self, seed: u64, inst: &Instruction) -> u64 {
        mixed(self.hash ^ mixed(seed << 32 | u64::from(inst.result_id.unwrap_or_default())))
    }

    /// Writes every block anew: `begin` gets each function first, `write` its instructions and where to put
    /// what becomes of them.
    pub fn for_each<S>(
        &mut self,
        begin: impl Fn(&Self, &dr::Function) -> S,
        mut write: impl FnMut(&mut Self, &mut S, Instruction, &mut Vec<Instruction>),
    ) {
        let mut functions = std::mem::take(&mut self.builder.module_mut().functions);
        for function in &mut functions {
            let mut state = begin(self, function);
            for block in &mut function.blocks {
                let mut written = Vec::new();
                for inst in std::mem::take(&mut block.instructions) {
                    write(self, &mut state, inst, &mut written);
                }
                block.instructions = written;
            }
        }
        self.builder.module_mut().functions = functions;
    }

    /// Adds an instruction, whose result is returned.
    pub fn emit(&mut self, out: &mut Vec<Instruction>, op: Op, kind: Word, operands: &[Word]) -> Word {
        let result = self.builder.id();
        out.push(of_ids(op, kind, result, operands));
        result
    }

    fn vector(&mut self, component: Word, count: u32) -> Word {
        if count == 1 { component } else { self.builder.type_vector(component, count) }
    }

    pub fn doubles(&mut self, count: u32) -> Word {
        let double = self.builder.type_float(64, None);
        self.vector(double, count)
    }

    pub fn words_of(&mut self, count: u32) -> Word {
        let word = self.builder.type_int(32, 0);
        self.vector(word, count)
    }

    pub fn bools(&mut self, count: u32) -> Word {
        let bool = self.builder.type_bool();
        self.vector(bool, count)
    }

    /// The same word in each component.
    pub fn constant(&mut self, value: u32, count: u32) -> Word {
        let word = self.builder.type_int(32, 0);
        let scalar = self.builder.constant_bit32(word, value);
        if count == 1 {
            return scalar;
        }
        let vector = self.words_of(count);
        self.builder.constant_composite(vector, vec![scalar; count as usize])
    }

    /// Shaders with doubles say so.
    pub fn need_doubles(&mut self) {
        let capability = rspirv::spirv::Capability::Float64;
        let is_there = |inst: &Instruction| inst.operands == [Operand::Capability(capability)];
        if !self.builder.module_ref().capabilities.iter().any(is_there) {
            self.builder.capability(capability);
        }
    }

    /// What was said of one id (that it is precise) is said of another.
    pub fn move_decorations(&mut self, from: Word, to: Word) {
        for inst in &mut self.builder.module_mut().annotations {
            if inst.class.opcode == Op::Decorate && id(inst, 0) == from {
                inst.operands[0] = Operand::IdRef(to);
            }
        }
    }

    pub fn fresh(&mut self) -> Word {
        self.builder.id()
    }
}

//! What a module gets while it is rewritten: types and constants, each once, and instructions.

use super::graft::{bound, is_same, set_bound};
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Op, Word};

/// A module that grows. `finish` writes down how far its ids go.
pub struct Emitter {
    pub module: Module,
    next: Word,
}

impl Emitter {
    pub fn new(module: Module) -> Self {
        let next = bound(&module);
        Self { module, next }
    }

    pub fn finish(mut self) -> Module {
        set_bound(&mut self.module, self.next);
        self.module
    }

    pub fn fresh(&mut self) -> Word {
        self.next += 1;
        self.next - 1
    }

    /// A type or constant: the one that is there, or a new one.
    pub fn once(&mut self, op: Op, ty: Option<Word>, operands: Vec<Operand>) -> Word {
        let wanted = Instruction::new(op, ty, None, operands);
        let known = self.module.types_global_values.iter().find(|value| is_same(value, &wanted));
        if let Some(id) = known.and_then(|value| value.result_id) {
            return id;
        }
        let id = self.fresh();
        self.module.types_global_values.push(Instruction { result_id: Some(id), ..wanted });
        id
    }

    pub fn uint(&mut self) -> Word {
        self.once(Op::TypeInt, None, vec![Operand::LiteralBit32(32), Operand::LiteralBit32(0)])
    }

    pub fn int(&mut self) -> Word {
        self.once(Op::TypeInt, None, vec![Operand::LiteralBit32(32), Operand::LiteralBit32(1)])
    }

    pub fn float(&mut self) -> Word {
        self.once(Op::TypeFloat, None, vec![Operand::LiteralBit32(32)])
    }

    pub fn vector(&mut self, component: Word, count: u32) -> Word {
        self.once(Op::TypeVector, None, vec![Operand::IdRef(component), Operand::LiteralBit32(count)])
    }

    /// A whole number.
    pub fn number(&mut self, value: u32) -> Word {
        let uint = self.uint();
        self.once(Op::Constant, Some(uint), vec![Operand::LiteralBit32(value)])
    }

    pub fn zero(&mut self) -> Word {
        let float = self.float();
        self.once(Op::Constant, Some(float), vec![Operand::LiteralBit32(0)])
    }

    /// An instruction with a result, at the end of `body`.
    pub fn push(&mut self, body: &mut Vec<Instruction>, op: Op, ty: Word, operands: Vec<Operand>) -> Word {
        let id = self.fresh();
        body.push(Instruction::new(op, Some(ty), Some(id), operands));
        id
    }

    /// A component of a vector.
    pub fn component(&mut self, body: &mut Vec<Instruction>, ty: Word, vector: Word, index: u32) -> Word {
        self.push(body, Op::CompositeExtract, ty, vec![Operand::IdRef(vector), Operand::LiteralBit32(index)])
    }
}

/// Ids as operands.
pub fn ids(all: &[Word]) -> Vec<Operand> {
    all.iter().map(|id| Operand::IdRef(*id)).collect()
}

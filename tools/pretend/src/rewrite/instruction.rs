//! Instructions by the ids that they have as operands.

use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Op, Word};

pub fn ids(instruction: &Instruction) -> impl Iterator<Item = Word> {
    instruction.operands.iter().filter_map(Operand::id_ref_any)
}

/// Operand `index`, which the grammar says is an id.
pub fn id(instruction: &Instruction, index: usize) -> Word {
    instruction.operands[index].unwrap_id_ref()
}

pub fn of_ids(op: Op, kind: Word, result: Word, operands: &[Word]) -> Instruction {
    Instruction::new(op, Some(kind), Some(result), operands.iter().map(|id| Operand::IdRef(*id)).collect())
}

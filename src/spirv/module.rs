//! Modules from words.

use rspirv::dr::{Instruction, Module, Operand, load_words};
use rspirv::spirv::{ExecutionMode, Op};

/// `OpExecutionModeId`, which rspirv 0.13 writes and does not read: it takes it for an instruction of a function.
const EXECUTION_MODE_ID: u32 = Op::ExecutionModeId as u32;
const HEADER_WORDS: usize = 5;

/// Errors: a text that says why it is no module.
pub fn load(words: &[u32]) -> Result<Module, String> {
    let (mut kept, mut modes) = (words[..HEADER_WORDS.min(words.len())].to_vec(), Vec::new());
    let mut rest = words.get(HEADER_WORDS..).unwrap_or_default();
    while let Some(first) = rest.first() {
        let (instruction, after) =
            rest.split_at_checked((first >> 16).max(1) as usize).ok_or("it ends within an instruction")?;
        match (first & 0xffff, instruction) {
            (EXECUTION_MODE_ID, [_, entry, mode, ids @ ..]) => {
                let mode = ExecutionMode::from_u32(*mode).ok_or("an execution mode that nobody knows")?;
                let mut operands = vec![Operand::IdRef(*entry), Operand::ExecutionMode(mode)];
                operands.extend(ids.iter().map(|id| Operand::IdRef(*id)));
                modes.push(Instruction::new(Op::ExecutionModeId, None, None, operands));
            }
            _ => kept.extend(instruction),
        }
        rest = after;
    }
    let mut module = load_words(&kept).map_err(|error| error.to_string())?;
    module.execution_modes.extend(modes);
    Ok(module)
}

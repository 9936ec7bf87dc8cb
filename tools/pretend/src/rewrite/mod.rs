//! A shader that computes what its source says to another last bit, as compilers and devices may.
//!
//! What they may not change stays: a result that is `precise` (NoContraction) is rounded where its source rounds it,
//! and what an `invariant` output depends on is not touched at all, since pipelines with the same source for it must
//! come to the same bits.

mod contract;
mod instruction;
mod invariant;
mod last_bit;
mod module;

use crate::modes::Modes;
use module::Module;

/// The same words for the same seeds.
///
/// Errors: no SPIR-V, in the parser's words.
pub fn rewritten(words: &[u32], modes: &Modes) -> Result<Vec<u32>, String> {
    let mut module = Module::parse(words)?;
    if let Some(seed) = modes.contract {
        contract::contract(&mut module, seed);
    }
    if let Some(seed) = modes.last_bit {
        last_bit::last_bit(&mut module, seed);
    }
    Ok(module.words())
}

#[cfg(test)]
mod tests;

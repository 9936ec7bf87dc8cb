//! Contraction: a product and the sum that takes it are rounded once, where neither is `precise`, at random.
//!
//! Computed in doubles, where the product of two floats is exact, since a software driver takes Fma apart again. Dot
//! products, which devices compute as such sums, are rounded once too. Products of matrices stay as they are.

use super::instruction::{id, of_ids};
use super::module::Module;
use rspirv::dr::{Function, Instruction};
use rspirv::grammar::reflect::is_block_terminator;
use rspirv::spirv::{Op, Word};
use std::collections::{HashMap, HashSet};

pub fn contract(module: &mut Module, seed: u64) {
    module.for_each(Known::of, |module, known, inst, out| {
        known.follow(&inst);
        let chance = module.chance(seed, &inst);
        let fused = match fusable(module, known, &inst, chance) {
            Some(fused) if chance & 1 == 1 => fused,
            _ => return out.push(inst),
        };
        module.need_doubles();
        let doubles = module.doubles(1);
        let (Some(result), Some(kind)) = (inst.result_id, inst.result_type) else { return out.push(inst) };
        let wide = match fused {
            Fused::Dot => {
                let [a, b] = [0, 1].map(|index| widened(module, out, id(&inst, index)));
                module.emit(out, Op::Dot, doubles, &[a, b])
            }
            Fused::Sum { product, other, is_first } => {
                let [a, b, c] = [id(&product, 0), id(&product, 1), other].map(|value| widened(module, out, value));
                let kind = module.doubles(module.free_components(&inst).unwrap_or(1));
                let exact = module.emit(out, product.class.opcode, kind, &[a, b]);
                let operands = if is_first { [exact, c] } else { [c, exact] };
                module.emit(out, inst.class.opcode, kind, &operands)
            }
        };
        out.push(of_ids(Op::FConvert, kind, result, &[wide]));
    });
}

/// What becomes one operation.
enum Fused {
    Dot,
    /// A sum or a difference whose first or second operand is the product.
    Sum {
        product: Instruction,
        other: Word,
        is_first: bool,
    },
}

/// The product to fuse; of two products that are added, chance takes one.
fn fusable(module: &Module, known: &Known, inst: &Instruction, chance: u64) -> Option<Fused> {
    let op = inst.class.opcode;
    if !matches!(op, Op::FAdd | Op::FSub | Op::Dot) || module.is_precise(inst) {
        return None;
    }
    module.free_components(inst)?;
    if op == Op::Dot {
        return Some(Fused::Dot);
    }
    let operands = [id(inst, 0), id(inst, 1)];
    let first = (chance >> 1 & 1) as usize;
    [first, 1 - first].into_iter().find_map(|index| {
        let product = known.products.get(known.loaded.get(&operands[index]).unwrap_or(&operands[index]))?;
        Some(Fused::Sum { product: product.clone(), other: operands[1 - index], is_first: index == 0 })
    })
}

/// The same value as a double or a vector of them.
fn widened(module: &mut Module, out: &mut Vec<Instruction>, value: Word) -> Word {
    let kind = module.doubles(module.components(value));
    module.emit(out, Op::FConvert, kind, &[value])
}

/// What is known in a function.
struct Known {
    /// Products that may be fused.
    products: HashMap<Word, Instruction>,
    locals: HashSet<Word>,
    /// What lies in local variables, as far as the block has written it: sources name their products.
    stored: HashMap<Word, Word>,
    loaded: HashMap<Word, Word>,
}

impl Known {
    fn of(module: &Module, function: &Function) -> Self {
        let of_kind =
            |ops: &'static [Op]| function.all_inst_iter().filter(move |inst| ops.contains(&inst.class.opcode));
        let products = of_kind(&[Op::FMul, Op::VectorTimesScalar])
            .filter(|inst| !module.is_precise(inst) && module.free_components(inst).is_some())
            .filter_map(|inst| Some((inst.result_id?, inst.clone())))
            .collect();
        let locals = of_kind(&[Op::Variable]).filter_map(|inst| inst.result_id).collect();
        Self { products, locals, stored: HashMap::new(), loaded: HashMap::new() }
    }

    /// Keeps up with what lies in variables.
    fn follow(&mut self, inst: &Instruction) {
        match inst.class.opcode {
            Op::Store if self.locals.contains(&id(inst, 0)) => {
                self.stored.insert(id(inst, 0), id(inst, 1));
            }
            Op::Load => {
                let value = self.stored.get(&id(inst, 0)).copied();
                self.loaded.extend(inst.result_id.zip(value));
            }
            // Parts of a variable are written through other pointers, and a callee may write it.
            Op::Store | Op::FunctionCall | Op::CopyMemory => self.stored.clear(),
            // The next block may be entered from elsewhere.
            op if is_block_terminator(op) => self.stored.clear(),
            _ => {}
        }
    }
}

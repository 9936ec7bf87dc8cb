//! What an output that is declared `invariant` depends on: nothing that two compilers' runs may do differently may be
//! done to it.

use super::instruction::{id, ids};
use rspirv::dr::{Function, Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, Word};
use std::collections::{HashMap, HashSet};

/// Ids, or struct types by one of their members.
pub fn decorated(module: &Module, decoration: Decoration) -> impl Iterator<Item = Word> {
    let is_it = move |inst: &&Instruction| inst.operands.contains(&Operand::Decoration(decoration));
    module.annotations.iter().filter(is_it).map(|inst| id(inst, 0))
}

/// Variables of a type that is decorated, or that are so themselves.
fn outputs(module: &Module) -> HashSet<Word> {
    let mut found: HashSet<Word> = decorated(module, Decoration::Invariant).collect();
    // Pointers to types stand behind them, and variables behind pointers.
    for inst in &module.types_global_values {
        let of = match inst.class.opcode {
            Op::TypePointer => Some(id(inst, 1)),
            Op::Variable => inst.result_type,
            _ => None,
        };
        if of.is_some_and(|of| found.contains(&of)) {
            found.extend(inst.result_id);
        }
    }
    found
}

/// One function of a module, and what its calls need of the others.
struct Slice<'a> {
    module: &'a Module,
    /// The variable or parameter behind a pointer.
    roots: HashMap<Word, Word>,
    held: HashSet<Word>,
}

/// All ids whose values reach an invariant output, through variables and calls, and by the branches of functions that
/// write it. Where a variable's value goes by whatever path, all that is written to it is in.
pub fn hung_on(module: &Module) -> HashSet<Word> {
    let held = outputs(module);
    if held.is_empty() {
        return held;
    }
    let mut slice = Slice { module, roots: HashMap::new(), held };
    for inst in module.all_inst_iter() {
        if let (Op::AccessChain | Op::InBoundsAccessChain, Some(result)) = (inst.class.opcode, inst.result_id) {
            let root = slice.root(id(inst, 0));
            slice.roots.insert(result, root);
        }
    }
    loop {
        let before = slice.held.len();
        module.functions.iter().for_each(|function| slice.look_through(function));
        if slice.held.len() == before {
            return slice.held;
        }
    }
}

impl Slice<'_> {
    fn root(&self, pointer: Word) -> Word {
        self.roots.get(&pointer).copied().unwrap_or(pointer)
    }

    fn is_held(&self, pointer: Word) -> bool {
        self.held.contains(&self.root(pointer))
    }

    fn look_through(&mut self, function: &Function) {
        let name = function.def.as_ref().and_then(|def| def.result_id).unwrap_or_default();
        let mut writes = self.held.contains(&name);
        for inst in function.all_inst_iter() {
            match inst.class.opcode {
                Op::Store | Op::CopyMemory if self.is_held(id(inst, 0)) => {
                    self.held.extend(ids(inst));
                    writes = true;
                }
                Op::ReturnValue if self.held.contains(&name) => self.held.extend(ids(inst)),
                Op::FunctionCall => self.call(inst),
                _ => {}
            }
            if inst.result_id.is_some_and(|result| self.held.contains(&result)) {
                self.held.extend(ids(inst));
            }
        }
        if writes {
            let branches =
                function.all_inst_iter().filter(|inst| matches!(inst.class.opcode, Op::BranchConditional | Op::Switch));
            self.held.extend(branches.map(|inst| id(inst, 0)));
        }
    }

    /// Arguments and parameters of a call, in both directions: a callee may write through a pointer.
    fn call(&mut self, inst: &Instruction) {
        let callee = self
            .module
            .functions
            .iter()
            .find(|function| function.def.as_ref().and_then(|def| def.result_id) == Some(id(inst, 0)));
        let parameters = callee.iter().flat_map(|callee| &callee.parameters).filter_map(|inst| inst.result_id);
        for (parameter, argument) in parameters.zip(ids(inst).skip(1)) {
            if self.held.contains(&parameter) {
                self.held.insert(argument);
            }
            if self.is_held(argument) {
                self.held.insert(parameter);
            }
        }
    }
}

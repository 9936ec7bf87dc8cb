//! Functions of one module grafted into another.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Op, Word};
use std::collections::{BTreeMap, HashMap};

/// Brings every function of `donor` but its entry point into `module`, with the variables that they bind; ids of the functions by their
/// names in GLSL.
pub fn graft(module: &mut Module, donor: &Module) -> BTreeMap<String, Word> {
    let mut ids = Ids { of: HashMap::new(), next: bound(module) };
    for capability in &donor.capabilities {
        push_new(&mut module.capabilities, capability.clone());
    }
    for import in &donor.ext_inst_imports {
        let known = module.ext_inst_imports.iter().find(|own| own.operands == import.operands);
        match known.and_then(|own| own.result_id) {
            Some(own) => ids.take_for(import, own),
            None => module.ext_inst_imports.push(ids.renamed(import)),
        }
    }
    let mut variables = Vec::new();
    for value in &donor.types_global_values {
        let renamed = ids.renamed(value);
        // A module may say a type of this kind only once.
        let is_once = !matches!(
            value.class.opcode,
            Op::TypeStruct | Op::TypeArray | Op::TypeRuntimeArray | Op::TypePointer | Op::Variable
        );
        let twin = module.types_global_values.iter().find(|own| is_once && is_same(own, &renamed));
        match twin.and_then(|own| own.result_id) {
            Some(own) => ids.take_for(value, own),
            None => {
                if value.class.opcode == Op::Variable {
                    variables.extend(renamed.result_id);
                }
                module.types_global_values.push(renamed);
            }
        }
    }
    // What was said once already has its annotations: of those only blocks and arrays have any, which are always new.
    module.annotations.extend(donor.annotations.iter().map(|annotation| ids.renamed(annotation)));
    let entries: Vec<Word> = donor.entry_points.iter().filter_map(|entry| entry.operands[1].id_ref_any()).collect();
    for function in &donor.functions {
        let id = function.def.as_ref().and_then(|def| def.result_id);
        if id.is_none_or(|id| entries.contains(&id)) {
            continue;
        }
        let mut function = function.clone();
        let parts = function.def.iter_mut().chain(&mut function.parameters).chain(&mut function.end);
        parts.for_each(|part| *part = ids.renamed(part));
        for block in &mut function.blocks {
            block.label.iter_mut().chain(&mut block.instructions).for_each(|part| *part = ids.renamed(part));
        }
        module.functions.push(function);
    }
    // Since SPIR-V 1.4 an entry point names every variable that it uses.
    for entry in &mut module.entry_points {
        entry.operands.extend(variables.iter().map(|id| Operand::IdRef(*id)));
    }
    let next = ids.next;
    let names = donor.debug_names.iter().filter_map(|name| {
        let [Operand::IdRef(id), Operand::LiteralString(text)] = &name.operands[..] else { return None };
        let (function, _) = text.split_once('(')?;
        Some((function.to_owned(), *ids.of.get(id)?))
    });
    let names = names.collect();
    set_bound(module, next);
    names
}

/// Ids above all that are used.
pub fn bound(module: &Module) -> Word {
    module.header.as_ref().map_or(1, |header| header.bound)
}

pub fn set_bound(module: &mut Module, bound: Word) {
    if let Some(header) = &mut module.header {
        header.bound = bound;
    }
}

/// Adds an instruction that is not there.
pub fn push_new(all: &mut Vec<Instruction>, one: Instruction) {
    if !all.contains(&one) {
        all.push(one);
    }
}

/// Whether both say the same under two ids.
pub fn is_same(one: &Instruction, other: &Instruction) -> bool {
    (one.class.opcode, one.result_type, &one.operands) == (other.class.opcode, other.result_type, &other.operands)
}

/// New ids of what is brought in.
struct Ids {
    of: HashMap<Word, Word>,
    next: Word,
}

impl Ids {
    fn of(&mut self, id: Word) -> Word {
        *self.of.entry(id).or_insert_with(|| {
            self.next += 1;
            self.next - 1
        })
    }

    /// What the donor calls `instruction` is there as `own`.
    fn take_for(&mut self, instruction: &Instruction, own: Word) {
        self.of.extend(instruction.result_id.map(|id| (id, own)));
    }

    fn renamed(&mut self, instruction: &Instruction) -> Instruction {
        let mut renamed = instruction.clone();
        let ids = renamed.operands.iter_mut().filter_map(Operand::id_ref_any_mut);
        ids.chain(&mut renamed.result_type).chain(&mut renamed.result_id).for_each(|id| *id = self.of(*id));
        renamed
    }
}

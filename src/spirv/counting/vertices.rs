//! What a vertex is made of: bytes of streams that no shader loads.

use super::{Attribute, FIRST_STREAM, Walk, begin_with};
use crate::spirv::emit::ids;
use rspirv::dr::{Function, Instruction, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass, Word};

impl Walk {
    /// Counts what a vertex is made of, at the beginning of its shader.
    pub(super) fn vertices(&mut self, function: &mut Function, attributes: &[Attribute]) -> Result<(), String> {
        let inputs: Vec<u32> = self.inputs();
        let read: Vec<&Attribute> =
            attributes.iter().filter(|attribute| inputs.contains(&attribute.location)).collect();
        if read.is_empty() {
            return Ok(());
        }
        let (int, uint) = (self.emitter.int(), self.emitter.uint());
        let mut body = Vec::new();
        let variable = self.vertex_index();
        let (held, is_uint) = match self.types.get(&variable).and_then(|ty| self.layout.pointee(*ty)) {
            Some((_, ty)) => (ty, ty == uint),
            None => (int, false),
        };
        let index = self.emitter.push(&mut body, Op::Load, held, ids(&[variable]));
        let index = if is_uint { index } else { self.emitter.push(&mut body, Op::Bitcast, uint, ids(&[index])) };
        for attribute in read {
            let [stride, offset, bytes] = [attribute.stride_bytes, attribute.offset_bytes, attribute.bytes]
                .map(|number| self.emitter.number(number));
            let (slot, reads) = (self.emitter.number(FIRST_STREAM + attribute.stream), self.emitter.number(0));
            let begin = self.emitter.push(&mut body, Op::IMul, uint, ids(&[index, stride]));
            let begin = self.emitter.push(&mut body, Op::IAdd, uint, ids(&[begin, offset]));
            self.call(&mut body, "mark_bytes", &[slot, begin, bytes, reads]);
        }
        begin_with(function, body)
    }

    /// Locations that the module reads.
    fn inputs(&self) -> Vec<u32> {
        let variables = self.emitter.module.types_global_values.iter().filter(|value| {
            let class = Operand::StorageClass(StorageClass::Input);
            value.class.opcode == Op::Variable && value.operands.first() == Some(&class)
        });
        variables.filter_map(|variable| self.layout.location(variable.result_id?)).collect()
    }

    /// The variable that says which vertex it is.
    fn vertex_index(&mut self) -> Word {
        if let Some(known) = self.layout.built_in(BuiltIn::VertexIndex) {
            return known;
        }
        let int = self.emitter.int();
        let class = Operand::StorageClass(StorageClass::Input);
        let ty = self.emitter.once(Op::TypePointer, None, vec![class.clone(), Operand::IdRef(int)]);
        let id = self.emitter.fresh();
        let module = &mut self.emitter.module;
        module.types_global_values.push(Instruction::new(Op::Variable, Some(ty), Some(id), vec![class]));
        let decoration =
            vec![Operand::IdRef(id), Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(BuiltIn::VertexIndex)];
        module.annotations.push(Instruction::new(Op::Decorate, None, None, decoration));
        module.entry_points.iter_mut().for_each(|entry| entry.operands.push(Operand::IdRef(id)));
        id
    }
}

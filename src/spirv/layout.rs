//! Where the members of buffers lie, by the decorations of a module.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, Decoration, Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

/// Types, constants and variables of a module, with what decorates them.
#[derive(Default)]
pub struct Layout {
    values: HashMap<Word, Instruction>,
    offsets: HashMap<(Word, u32), u32>,
    matrix_strides: HashMap<(Word, u32), u32>,
    array_strides: HashMap<Word, u32>,
    bindings: HashMap<Word, u32>,
    sets: HashMap<Word, u32>,
    locations: HashMap<Word, u32>,
    built_ins: HashMap<Word, BuiltIn>,
    /// Matrices whose columns are not in one piece.
    row_major: HashSet<(Word, u32)>,
}

/// A step into a type: what lies there, and how far from the beginning.
pub struct Step {
    pub ty: Word,
    /// Bytes between the columns of a matrix that lies there.
    pub matrix_stride: Option<u32>,
    /// From the beginning.
    pub distance: Distance,
}

/// How far a step goes.
pub enum Distance {
    /// To a member of a struct.
    Bytes(u32),
    /// To an element: so many bytes for each before it.
    Each(u32),
}

impl Layout {
    pub fn of(module: &Module) -> Self {
        let mut layout = Self::default();
        for value in &module.types_global_values {
            layout.values.extend(value.result_id.map(|id| (id, value.clone())));
        }
        for annotation in &module.annotations {
            let operands = &annotation.operands;
            match (annotation.class.opcode, &operands[..]) {
                (Op::Decorate, [Operand::IdRef(id), Operand::Decoration(kind), Operand::LiteralBit32(value)]) => {
                    let map = match kind {
                        Decoration::ArrayStride => &mut layout.array_strides,
                        Decoration::Binding => &mut layout.bindings,
                        Decoration::DescriptorSet => &mut layout.sets,
                        Decoration::Location => &mut layout.locations,
                        _ => continue,
                    };
                    map.insert(*id, *value);
                }
                (
                    Op::Decorate,
                    [Operand::IdRef(id), Operand::Decoration(Decoration::BuiltIn), Operand::BuiltIn(what)],
                ) => {
                    layout.built_ins.insert(*id, *what);
                }
                (
                    Op::MemberDecorate,
                    [
                        Operand::IdRef(id),
                        Operand::LiteralBit32(member),
                        Operand::Decoration(kind),
                        Operand::LiteralBit32(value),
                    ],
                ) => {
                    let map = match kind {
                        Decoration::Offset => &mut layout.offsets,
                        Decoration::MatrixStride => &mut layout.matrix_strides,
                        _ => continue,
                    };
                    map.insert((*id, *member), *value);
                }
                (
                    Op::MemberDecorate,
                    [Operand::IdRef(id), Operand::LiteralBit32(member), Operand::Decoration(Decoration::RowMajor)],
                ) => {
                    layout.row_major.insert((*id, *member));
                }
                _ => {}
            }
        }
        layout
    }

    pub fn value(&self, id: Word) -> Option<&Instruction> {
        self.values.get(&id)
    }

    fn operand(&self, id: Word, index: usize) -> Option<&Operand> {
        self.values.get(&id)?.operands.get(index)
    }

    /// Opcode of a type.
    pub fn kind(&self, ty: Word) -> Option<Op> {
        self.values.get(&ty).map(|value| value.class.opcode)
    }

    /// Storage class and what is pointed at.
    pub fn pointee(&self, ty: Word) -> Option<(StorageClass, Word)> {
        let value = self.values.get(&ty).filter(|value| value.class.opcode == Op::TypePointer)?;
        let [Operand::StorageClass(class), Operand::IdRef(to)] = value.operands[..] else { return None };
        Some((class, to))
    }

    /// A whole number that no specialization changes.
    pub fn constant(&self, id: Word) -> Option<u32> {
        let value = self.values.get(&id).filter(|value| value.class.opcode == Op::Constant)?;
        match value.operands[..] {
            [Operand::LiteralBit32(word)] => Some(word),
            _ => None,
        }
    }

    /// Set and binding of a variable.
    pub fn place(&self, variable: Word) -> Option<(u32, u32)> {
        Some((*self.sets.get(&variable)?, *self.bindings.get(&variable)?))
    }

    pub fn location(&self, variable: Word) -> Option<u32> {
        self.locations.get(&variable).copied()
    }

    /// The variable that holds a built-in value.
    pub fn built_in(&self, what: BuiltIn) -> Option<Word> {
        self.built_ins.iter().find(|(_, held)| **held == what).map(|(id, _)| *id)
    }

    /// The step that `index`, an id, takes into `ty`; None: the module does not say how far.
    pub fn step(&self, ty: Word, matrix_stride: Option<u32>, index: Word) -> Option<Step> {
        let step = |ty, distance| Step { ty, matrix_stride: None, distance };
        let first = || self.operand(ty, 0)?.id_ref_any();
        match self.kind(ty)? {
            Op::TypeStruct => {
                let member = self.constant(index)?;
                let to = self.operand(ty, member as usize)?.id_ref_any()?;
                let offset = *self.offsets.get(&(ty, member))?;
                let matrix_stride = self.matrix_strides.get(&(ty, member)).copied();
                if self.row_major.contains(&(ty, member)) {
                    return None;
                }
                Some(Step { ty: to, matrix_stride, distance: Distance::Bytes(offset) })
            }
            Op::TypeArray | Op::TypeRuntimeArray => {
                let each = Distance::Each(*self.array_strides.get(&ty)?);
                Some(Step { matrix_stride, ..step(first()?, each) })
            }
            Op::TypeMatrix => Some(step(first()?, Distance::Each(matrix_stride?))),
            Op::TypeVector => {
                let component = first()?;
                Some(step(component, Distance::Each(self.bytes(component, None)?)))
            }
            _ => None,
        }
    }

    /// Bytes from the beginning of a value to the end of its last member.
    pub fn bytes(&self, ty: Word, matrix_stride: Option<u32>) -> Option<u32> {
        let literal = |index| match self.operand(ty, index)? {
            Operand::LiteralBit32(word) => Some(*word),
            _ => None,
        };
        let first = || self.operand(ty, 0)?.id_ref_any();
        match self.kind(ty)? {
            Op::TypeInt | Op::TypeFloat => Some(literal(0)? / 8),
            // Addresses, as the module's memory model has them.
            Op::TypePointer => Some(8),
            Op::TypeVector => Some(literal(1)? * self.bytes(first()?, None)?),
            Op::TypeMatrix => Some((literal(1)? - 1) * matrix_stride? + self.bytes(first()?, None)?),
            Op::TypeArray => {
                let count = self.constant(self.operand(ty, 1)?.id_ref_any()?)?;
                Some((count - 1) * self.array_strides.get(&ty)? + self.bytes(first()?, matrix_stride)?)
            }
            Op::TypeStruct => {
                let members = 0..self.values.get(&ty)?.operands.len() as u32;
                let ends = members.map(|member| {
                    let to = self.operand(ty, member as usize)?.id_ref_any()?;
                    let matrix_stride = self.matrix_strides.get(&(ty, member)).copied();
                    Some(self.offsets.get(&(ty, member))? + self.bytes(to, matrix_stride)?)
                });
                ends.collect::<Option<Vec<_>>>()?.into_iter().max()
            }
            _ => None,
        }
    }
}

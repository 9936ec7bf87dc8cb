//! A module that counts: beside each access to a buffer or an image stands a call that says which bytes it reads or writes.
//!
//! What is counted is what the shader's text does in threads that are alive, before a driver leaves out what nobody uses: a structure that
//! is loaded whole is read whole. Threads that only help with derivatives are not counted.

mod images;
mod vertices;

use super::emit::{Emitter, ids};
use super::graft::{graft, push_new};
use super::layout::{Distance, Layout};
use super::module::load;
use rspirv::binary::Assemble;
use rspirv::dr::{Block, Function, Instruction, Module, Operand};
use rspirv::spirv::{BuiltIn, ExecutionMode, ExecutionModel, Op, StorageClass, Word};
use std::collections::{BTreeMap, HashMap};

/// The slot of a binding is this and its number.
pub const FIRST_BINDING: u32 = 1;
/// Slots of vertex streams begin here.
pub const FIRST_STREAM: u32 = 64;
/// Where the functions look for a slot of set 1: what they take it by.
const IN_SET_1: u32 = 256;

/// What the vertex stage is handed of a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute {
    pub location: u32,
    /// Index of the stream.
    pub stream: u32,
    pub stride_bytes: u32,
    pub offset_bytes: u32,
    pub bytes: u32,
}

/// Functions that count, compiled.
pub struct Counters<'a> {
    /// For shaders that bind nothing but set 0.
    pub own: &'a [u32],
    /// For those that read a material too.
    pub both: &'a [u32],
}

/// The module of `words` with calls beside its accesses. `attributes`: what its vertices are made of.
///
/// Errors: a text that says what is no module, or what in it cannot be followed.
pub fn counting(words: &[u32], counters: &Counters<'_>, attributes: &[Attribute]) -> Result<Vec<u32>, String> {
    let mut module = load(words)?;
    let bare = Layout::of(&module);
    let reads_material = module
        .types_global_values
        .iter()
        .any(|value| value.result_id.and_then(|id| bare.place(id)).is_some_and(|(set, _)| set == 1));
    let own_functions = module.functions.len();
    let functions = graft(&mut module, &load(if reads_material { counters.both } else { counters.own })?);
    tests_depth_early(&mut module);
    let mut walk = Walk {
        layout: Layout::of(&module),
        types: result_types(&module),
        functions,
        emitter: Emitter::new(module),
        pointers: HashMap::new(),
        images: HashMap::new(),
        opaque: HashMap::new(),
    };
    walk.follow_globals();
    let mut all = std::mem::take(&mut walk.emitter.module.functions);
    let entry = walk.entry()?;
    all[..own_functions].iter_mut().for_each(|function| walk.hand_on(function));
    for function in &mut all[..own_functions] {
        walk.function(function)?;
        if function.def.as_ref().and_then(|def| def.result_id) == Some(entry.0) {
            match entry.1 {
                ExecutionModel::Vertex => walk.vertices(function, attributes)?,
                ExecutionModel::GLCompute | ExecutionModel::Fragment => {
                    let mut body = Vec::new();
                    walk.call(&mut body, "mark_invocation", &[]);
                    begin_with(function, body)?;
                }
                _ => {}
            }
        }
    }
    let mut module = walk.emitter.finish();
    module.functions = all;
    Ok(module.assemble())
}

/// Depth is tested before a shader that only shades, as drivers do where nobody would see it: a shader that counts is seen. One that lets go of
/// fragments is left as it is, and counts hidden ones too.
fn tests_depth_early(module: &mut Module) {
    let Some(entry) = module
        .entry_points
        .first()
        .filter(|entry| entry.operands[0] == Operand::ExecutionModel(ExecutionModel::Fragment))
    else {
        return;
    };
    let entry = entry.operands[1].clone();
    let ends = |op| matches!(op, Op::Kill | Op::DemoteToHelperInvocation | Op::TerminateInvocation);
    let instructions =
        module.functions.iter().flat_map(|function| &function.blocks).flat_map(|block| &block.instructions);
    let is_late = instructions.into_iter().any(|instruction| ends(instruction.class.opcode))
        || module
            .execution_modes
            .iter()
            .any(|mode| mode.operands[1] == Operand::ExecutionMode(ExecutionMode::DepthReplacing))
        || Layout::of(module).built_in(BuiltIn::SampleMask).is_some();
    if !is_late {
        let mode = Operand::ExecutionMode(ExecutionMode::EarlyFragmentTests);
        push_new(&mut module.execution_modes, Instruction::new(Op::ExecutionMode, None, None, vec![entry, mode]));
    }
}

/// Type of every value of a function.
fn result_types(module: &Module) -> HashMap<Word, Word> {
    let bodies = module.functions.iter().flat_map(|function| &function.blocks).flat_map(|block| &block.instructions);
    let parameters = module.functions.iter().flat_map(|function| &function.parameters);
    let all = bodies.chain(parameters).chain(&module.types_global_values);
    all.filter_map(|value| Some((value.result_id?, value.result_type?))).collect()
}

/// What a pointer leads to.
#[derive(Clone, Copy)]
enum Root {
    /// A binding: the value of `where`.
    Slot(Word),
    /// The address of a buffer.
    Address(Word),
}

/// A place in a buffer.
#[derive(Clone, Copy)]
struct Pointer {
    root: Root,
    ty: Word,
    matrix_stride: Option<u32>,
    /// Bytes from the buffer's beginning: these, and as many as an instruction has found.
    bytes: u32,
    more: Option<Word>,
}

struct Walk {
    emitter: Emitter,
    layout: Layout,
    /// Type of each value that the module had.
    types: HashMap<Word, Word>,
    /// Those that count, by name.
    functions: BTreeMap<String, Word>,
    pointers: HashMap<Word, Pointer>,
    /// Values of `where` of images, by what holds them: a variable, a parameter, a loaded image.
    images: HashMap<Word, Word>,
    /// For each function that takes images, which of its parameters are.
    opaque: HashMap<Word, Vec<usize>>,
}

impl Walk {
    fn entry(&self) -> Result<(Word, ExecutionModel), String> {
        let entry = self.emitter.module.entry_points.first().ok_or("no entry point")?;
        match entry.operands[..] {
            [Operand::ExecutionModel(model), Operand::IdRef(id), ..] => Ok((id, model)),
            _ => Err("an entry point of another kind".to_owned()),
        }
    }

    /// Buffers and images that the module binds.
    fn follow_globals(&mut self) {
        let variables = self.emitter.module.types_global_values.clone();
        for variable in variables.iter().filter(|value| value.class.opcode == Op::Variable) {
            let (Some(id), Some(ty)) = (variable.result_id, variable.result_type) else { continue };
            let (Some((set, binding)), Some((class, to))) = (self.layout.place(id), self.layout.pointee(ty)) else {
                continue;
            };
            let place = self.emitter.number((FIRST_BINDING + binding) | if set == 1 { IN_SET_1 } else { 0 });
            match class {
                StorageClass::StorageBuffer | StorageClass::Uniform => {
                    let pointer =
                        Pointer { root: Root::Slot(place), ty: to, matrix_stride: None, bytes: 0, more: None };
                    self.pointers.insert(id, pointer);
                }
                StorageClass::UniformConstant => {
                    self.images.insert(id, place);
                }
                _ => {}
            }
        }
    }

    /// Functions that take images are told their slots too.
    fn hand_on(&mut self, function: &mut Function) {
        let is_image = |parameter: &Instruction| {
            let pointee = parameter.result_type.and_then(|ty| self.layout.pointee(ty));
            pointee.is_some_and(|(class, _)| class == StorageClass::UniformConstant)
        };
        let places: Vec<usize> =
            (0..function.parameters.len()).filter(|at| is_image(&function.parameters[*at])).collect();
        let Some(def) = function.def.as_mut().filter(|_| !places.is_empty()) else { return };
        let uint = self.emitter.uint();
        for place in &places {
            let slot = self.emitter.fresh();
            self.images.extend(function.parameters[*place].result_id.map(|id| (id, slot)));
            function.parameters.push(Instruction::new(Op::FunctionParameter, Some(uint), Some(slot), Vec::new()));
        }
        let types = function.parameters.iter().filter_map(|parameter| parameter.result_type);
        let operands: Vec<Word> = def.result_type.into_iter().chain(types).collect();
        def.operands[1] = Operand::IdRef(self.emitter.once(Op::TypeFunction, None, ids(&operands)));
        self.opaque.extend(def.result_id.map(|id| (id, places)));
    }

    fn function(&mut self, function: &mut Function) -> Result<(), String> {
        for Block { instructions, .. } in &mut function.blocks {
            let mut body = Vec::with_capacity(instructions.len());
            for instruction in std::mem::take(instructions) {
                self.instruction(instruction, &mut body)?;
            }
            *instructions = body;
        }
        Ok(())
    }

    /// Writes `instruction` to the end of `body`, with what counts it.
    fn instruction(&mut self, mut instruction: Instruction, body: &mut Vec<Instruction>) -> Result<(), String> {
        let operand = |index: usize| instruction.operands.get(index).and_then(Operand::id_ref_any);
        let (op, result, ty) = (instruction.class.opcode, instruction.result_id, instruction.result_type);
        let first = operand(0);
        match op {
            Op::AccessChain | Op::InBoundsAccessChain => {
                let chain = instruction.operands.clone();
                body.push(instruction);
                return self.chain(result, &chain, body);
            }
            Op::Bitcast | Op::ConvertUToPtr => {
                let pointee = ty.and_then(|ty| self.layout.pointee(ty));
                if let (Some((StorageClass::PhysicalStorageBuffer, to)), Some(address)) = (pointee, first) {
                    let root = Root::Address(address);
                    let pointer = Pointer { root, ty: to, matrix_stride: None, bytes: 0, more: None };
                    self.pointers.extend(result.map(|id| (id, pointer)));
                }
            }
            Op::Load => {
                self.access(first, false, body)?;
                if let Some(slot) = first.and_then(|from| self.images.get(&from).copied()) {
                    self.images.extend(result.map(|id| (id, slot)));
                }
            }
            Op::Image => {
                if let Some(slot) = first.and_then(|from| self.images.get(&from).copied()) {
                    self.images.extend(result.map(|id| (id, slot)));
                }
            }
            Op::Store => self.access(first, true, body)?,
            Op::AtomicLoad => self.access(first, false, body)?,
            Op::AtomicStore => self.access(first, true, body)?,
            _ if is_atomic(op) => {
                self.access(first, false, body)?;
                self.access(first, true, body)?;
            }
            Op::FunctionCall => {
                let places = first.and_then(|function| self.opaque.get(&function)).cloned().unwrap_or_default();
                let slot = |place: usize| {
                    let image = instruction.operands.get(1 + place).and_then(Operand::id_ref_any);
                    image.and_then(|image| self.images.get(&image).copied())
                };
                let slots: Option<Vec<Word>> = places.into_iter().map(slot).collect();
                let slots = slots.ok_or("an image that is handed on and not followed to its binding")?;
                instruction.operands.extend(ids(&slots));
            }
            Op::ImageSampleImplicitLod
            | Op::ImageSampleExplicitLod
            | Op::ImageSampleDrefImplicitLod
            | Op::ImageSampleDrefExplicitLod
            | Op::ImageGather
            | Op::ImageDrefGather => self.sample(&instruction, body)?,
            Op::ImageFetch | Op::ImageRead => self.texel(&instruction, false, body)?,
            Op::ImageWrite => self.texel(&instruction, true, body)?,
            Op::ImageTexelPointer
            | Op::CopyMemory
            | Op::CopyMemorySized
            | Op::SampledImage
            | Op::ImageSampleProjImplicitLod
            | Op::ImageSampleProjExplicitLod
            | Op::ImageSampleProjDrefImplicitLod
            | Op::ImageSampleProjDrefExplicitLod => {
                return Err(format!("Op{op:?} is not followed"));
            }
            _ => {}
        }
        body.push(instruction);
        Ok(())
    }

    /// A pointer into what another one leads to.
    fn chain(&mut self, result: Option<Word>, chain: &[Operand], body: &mut Vec<Instruction>) -> Result<(), String> {
        let (Some(result), Some(base)) = (result, chain.first().and_then(Operand::id_ref_any)) else { return Ok(()) };
        if let Some(slot) = self.images.get(&base).copied() {
            self.images.insert(result, slot);
        }
        let Some(mut pointer) = self.pointers.get(&base).copied() else { return Ok(()) };
        let uint = self.emitter.uint();
        for index in chain[1..].iter().filter_map(Operand::id_ref_any) {
            let step = self.layout.step(pointer.ty, pointer.matrix_stride, index);
            let step =
                step.ok_or_else(|| format!("a step into a {:?} without its offset", self.layout.kind(pointer.ty)))?;
            match (step.distance, self.layout.constant(index)) {
                (Distance::Bytes(bytes), _) => pointer.bytes += bytes,
                (Distance::Each(bytes), Some(count)) => pointer.bytes += bytes * count,
                (Distance::Each(bytes), None) => {
                    let bytes = self.emitter.number(bytes);
                    let far = self.emitter.push(body, Op::IMul, uint, ids(&[index, bytes]));
                    pointer.more = Some(match pointer.more {
                        None => far,
                        Some(more) => self.emitter.push(body, Op::IAdd, uint, ids(&[more, far])),
                    });
                }
            }
            (pointer.ty, pointer.matrix_stride) = (step.ty, step.matrix_stride);
        }
        self.pointers.insert(result, pointer);
        Ok(())
    }

    /// A load or a store through a pointer, if it leads into a buffer.
    fn access(&mut self, pointer: Option<Word>, writes: bool, body: &mut Vec<Instruction>) -> Result<(), String> {
        let Some(id) = pointer else { return Ok(()) };
        let Some(pointer) = self.pointers.get(&id).copied() else {
            let pointee = self.types.get(&id).and_then(|ty| self.layout.pointee(*ty));
            let leads_out = pointee.is_some_and(|(class, _)| {
                matches!(
                    class,
                    StorageClass::StorageBuffer | StorageClass::Uniform | StorageClass::PhysicalStorageBuffer
                )
            });
            return if leads_out { Err("a pointer whose buffer is not known".to_owned()) } else { Ok(()) };
        };
        let bytes = self.layout.bytes(pointer.ty, pointer.matrix_stride);
        let bytes = bytes.ok_or_else(|| format!("a {:?} without its size", self.layout.kind(pointer.ty)))?;
        let uint = self.emitter.uint();
        let offset = match (pointer.more, pointer.bytes) {
            (None, bytes) => self.emitter.number(bytes),
            (Some(more), 0) => more,
            (Some(more), bytes) => {
                let bytes = self.emitter.number(bytes);
                self.emitter.push(body, Op::IAdd, uint, ids(&[more, bytes]))
            }
        };
        let (bytes, writes) = (self.emitter.number(bytes), self.emitter.number(u32::from(writes)));
        match pointer.root {
            Root::Slot(slot) => self.call(body, "mark_bytes", &[slot, offset, bytes, writes]),
            Root::Address(address) => self.call(body, "mark_address", &[address, offset, bytes, writes]),
        }
        Ok(())
    }

    fn call(&mut self, body: &mut Vec<Instruction>, function: &str, arguments: &[Word]) {
        let void = self.emitter.once(Op::TypeVoid, None, Vec::new());
        let operands: Vec<Word> = std::iter::once(self.functions[function]).chain(arguments.iter().copied()).collect();
        self.emitter.push(body, Op::FunctionCall, void, ids(&operands));
    }
}

/// Puts `body` at the beginning of a function, behind its variables.
fn begin_with(function: &mut Function, body: Vec<Instruction>) -> Result<(), String> {
    let block = function.blocks.first_mut().ok_or("an entry point without a body")?;
    let is_variable = |instruction: &Instruction| instruction.class.opcode == Op::Variable;
    let at = block.instructions.iter().take_while(|instruction| is_variable(instruction)).count();
    block.instructions.splice(at..at, body);
    Ok(())
}

fn is_atomic(op: Op) -> bool {
    matches!(
        op,
        Op::AtomicExchange
            | Op::AtomicCompareExchange
            | Op::AtomicIIncrement
            | Op::AtomicIDecrement
            | Op::AtomicIAdd
            | Op::AtomicISub
            | Op::AtomicSMin
            | Op::AtomicUMin
            | Op::AtomicSMax
            | Op::AtomicUMax
            | Op::AtomicAnd
            | Op::AtomicOr
            | Op::AtomicXor
            | Op::AtomicFAddEXT
            | Op::AtomicFMinEXT
            | Op::AtomicFMaxEXT
    )
}

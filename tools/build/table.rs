//! The table of shaders: what each entry point binds, takes and runs on, read back from its SPIR-V with spirq.

use crate::compile::{EntryPoint, Variant};
use crate::constants::Constants;
use crate::structs::{Structs, by_module};
use glslang::ShaderStage;
use spirq::ReflectConfig;
use spirq::prelude::*;
use std::collections::BTreeMap;
use std::fmt::Write;

/// One entry point in one variant.
pub struct Row {
    name: String,
    constant: String,
    stage: &'static str,
    file: String,
    bindings: Vec<Binding>,
    params: Option<Params>,
    constants: Vec<(String, u32, u32)>,
    workgroup: [Side; 3],
}

/// A push-constant block: its struct, and where the members lie.
struct Params {
    name: String,
    size_bytes: u32,
    members: Vec<(String, u32)>,
}

struct Binding {
    set: u32,
    binding: u32,
    name: String,
    kind: &'static str,
    count: u32,
}

/// One side of a workgroup: a number, or the specialization constant that holds it.
#[derive(Clone, Copy)]
enum Side {
    Fixed(u32),
    Constant(u32),
}

#[derive(Default)]
pub struct Table {
    pub rows: Vec<Row>,
}

impl Row {
    pub fn reflect(entry: &EntryPoint, variant: &Variant, words: &[u32], file: String) -> Result<Self, String> {
        let mut config = ReflectConfig::new();
        let entry_points = config.spv(words).ref_all_rscs(false).combine_img_samplers(true).reflect();
        let entry_points = entry_points.map_err(|error| format!("spirq: {error}"))?;
        let reflected = entry_points.first().ok_or("spirq sees no entry point")?;
        let mut bindings = Vec::new();
        let mut params = None;
        let mut constants = Vec::new();
        for variable in &reflected.vars {
            match variable {
                Variable::Descriptor { name, desc_bind, desc_ty, ty, nbind } => bindings.push(Binding {
                    set: desc_bind.set(),
                    binding: desc_bind.bind(),
                    name: resource_name(name.as_deref(), ty).ok_or("a binding has no name")?,
                    kind: kind_of(desc_ty)?,
                    count: *nbind,
                }),
                Variable::PushConstant { ty, .. } => params = Some(params_of(ty)?),
                Variable::SpecConstant { name, spec_id, .. } => {
                    // glslang gives the sides of a workgroup constants of their own, without names.
                    let side = || workgroup_side(reflected, *spec_id).map(|axis| format!("WORKGROUP_{axis}"));
                    let name = name.clone().filter(|name| !name.is_empty()).or_else(side);
                    let name = name.ok_or_else(|| format!("specialization constant {spec_id} has no name"))?;
                    constants.push((name, *spec_id, default_of(words, *spec_id)?));
                }
                Variable::Input { .. } | Variable::Output { .. } => {}
            }
        }
        bindings.sort_by_key(|binding| (binding.set, binding.binding));
        constants.sort_by_key(|constant| constant.1);
        let (name, extension) = entry.name.rsplit_once('.').ok_or("no extension")?;
        Ok(Self {
            name: name.to_owned(),
            constant: format!("{}{}", extension.to_uppercase(), variant.suffix()),
            stage: match entry.stage {
                ShaderStage::Vertex => "Vertex",
                ShaderStage::Geometry => "Geometry",
                ShaderStage::Fragment => "Fragment",
                _ => "Compute",
            },
            file,
            bindings,
            params,
            workgroup: workgroup_of(reflected, &constants, words)?,
            constants,
        })
    }
}

/// The variable's name, or its block's where the block is anonymous.
fn resource_name(name: Option<&str>, ty: &Type) -> Option<String> {
    match name {
        Some(name) if !name.is_empty() => Some(name.to_owned()),
        _ => match ty {
            Type::Struct(block) => block.name().map(str::to_owned),
            _ => None,
        },
    }
}

fn kind_of(kind: &DescriptorType) -> Result<&'static str, String> {
    Ok(match kind {
        DescriptorType::StorageBuffer(_) => "StorageBuffer",
        DescriptorType::UniformBuffer() => "UniformBuffer",
        DescriptorType::StorageImage(_) => "StorageImage",
        DescriptorType::SampledImage() => "SampledImage",
        DescriptorType::CombinedImageSampler() => "CombinedImageSampler",
        DescriptorType::Sampler() => "Sampler",
        DescriptorType::AccelStruct() => "AccelerationStructure",
        other => return Err(format!("{other:?} is not in the table's vocabulary")),
    })
}

/// The one struct that a push-constant block holds.
fn params_of(ty: &Type) -> Result<Params, String> {
    let fault = "a push-constant block holds exactly one struct named ...Params";
    let Type::Struct(block) = ty else { return Err(fault.to_owned()) };
    let [member] = &block.members[..] else { return Err(fault.to_owned()) };
    let Type::Struct(params) = &member.ty else { return Err(fault.to_owned()) };
    let name = params.name().ok_or(fault)?.to_owned();
    let mut members = Vec::new();
    for member in &params.members {
        let field = member.name.clone().ok_or("a member has no name")?;
        members.push((field, member.offset.ok_or("a member has no offset")? as u32));
    }
    let size_bytes = params.nbyte().ok_or("the struct has no size")? as u32;
    Ok(Params { name, size_bytes, members })
}

/// The axis of the workgroup whose size constant `spec_id` is.
fn workgroup_side(entry: &spirq::prelude::EntryPoint, spec_id: u32) -> Option<char> {
    let sides = entry.exec_modes.iter().flat_map(|mode| mode.operands.iter().zip(['X', 'Y', 'Z']));
    sides.into_iter().find(|(operand, _)| operand.spec_id == Some(spec_id)).map(|(_, axis)| axis)
}

/// OpExecutionMode LocalSize gives numbers, LocalSizeId (what glslang writes for Vulkan 1.3) gives constants.
fn workgroup_of(
    entry: &spirq::prelude::EntryPoint,
    constants: &[(String, u32, u32)],
    words: &[u32],
) -> Result<[Side; 3], String> {
    use spirq::spirv::ExecutionMode;
    let mut sides = [Side::Fixed(1); 3];
    for mode in &entry.exec_modes {
        if !matches!(mode.exec_mode, ExecutionMode::LocalSize | ExecutionMode::LocalSizeId) {
            continue;
        }
        for (side, operand) in sides.iter_mut().zip(&mode.operands) {
            *side = match operand.spec_id {
                Some(id) if constants.iter().any(|constant| constant.1 == id) => Side::Constant(id),
                Some(id) => Side::Fixed(default_of(words, id)?),
                None => Side::Fixed(match &operand.value {
                    ConstantValue::U32(value) => *value,
                    ConstantValue::S32(value) => *value as u32,
                    other => return Err(format!("a workgroup side of {other:?}")),
                }),
            };
        }
    }
    Ok(sides)
}

/// The default of a specialization constant, as bits: spirq names the constant but not its value.
fn default_of(words: &[u32], spec_id: u32) -> Result<u32, String> {
    const OP_DECORATE: u32 = 71;
    const DECORATION_SPEC_ID: u32 = 1;
    const OP_SPEC_CONSTANT_TRUE: u32 = 48;
    const OP_SPEC_CONSTANT_FALSE: u32 = 49;
    const OP_SPEC_CONSTANT: u32 = 50;
    let instructions = || {
        let mut at = 5;
        std::iter::from_fn(move || {
            let word = *words.get(at)?;
            let length = (word >> 16).max(1) as usize;
            let instruction = words.get(at..at + length)?;
            at += length;
            Some((word & 0xffff, instruction))
        })
    };
    let id = instructions()
        .find(|(op, i)| *op == OP_DECORATE && i.len() > 3 && i[2] == DECORATION_SPEC_ID && i[3] == spec_id)
        .map(|(_, i)| i[1])
        .ok_or_else(|| format!("no constant has id {spec_id}"))?;
    instructions()
        .find_map(|(op, i)| match op {
            OP_SPEC_CONSTANT if i[2] == id => Some(i[3]),
            OP_SPEC_CONSTANT_TRUE if i[2] == id => Some(1),
            OP_SPEC_CONSTANT_FALSE if i[2] == id => Some(0),
            _ => None,
        })
        .ok_or_else(|| format!("constant {spec_id} has no default"))
}

/// Modules that mirror glsl/, from a map of path to its items.
#[derive(Default)]
struct Module {
    items: String,
    children: BTreeMap<String, Module>,
}

impl Module {
    fn at(&mut self, path: &str) -> &mut Self {
        path.split('/').fold(self, |module, part| module.children.entry(part.to_owned()).or_default())
    }

    fn write(&self, text: &mut String) {
        text.push_str(&self.items);
        for (name, child) in &self.children {
            writeln!(text, "pub mod {name} {{").expect("writing to a string");
            text.push_str("#[allow(unused_imports)]\nuse crate::gpu::shader::{Binding, BindingKind, ParamsLayout, Shader, Side, SpecConstant, Stage};\n");
            child.write(text);
            text.push_str("}\n");
        }
    }
}

pub fn write(table: &Table, structs: &Structs, constants: &Constants) -> String {
    let mut root = Module::default();
    let mut all = String::new();
    for row in &table.rows {
        row.write(&mut root.at(&row.name).items).expect("writing to a string");
        write!(all, "&{}::{}, ", row.name.replace('/', "::"), row.constant).expect("writing to a string");
    }
    for rows in table.rows.chunk_by(|a, b| a.name == b.name && a.extension() == b.extension()) {
        if rows.len() > 1 {
            let list: String = rows.iter().map(|row| format!("&{}, ", row.constant)).collect();
            let items = &mut root.at(&rows[0].name).items;
            writeln!(
                items,
                "/// Every variant, for `shader::variant`.\npub static {}_VARIANTS: &[&Shader] = &[{list}];",
                rows[0].extension()
            )
            .expect("writing to a string");
        }
    }
    for (module, items) in constants.by_module() {
        root.at(module).items.push_str(&items);
    }
    let mut names = String::new();
    let mut layouts = String::new();
    for (module, items) in by_module(structs) {
        for item in items {
            root.at(&module).items.push_str(&item.rust);
            let path = format!("{}::{}", module.replace('/', "::"), item.name);
            writeln!(names, "    pub use super::{path};").expect("writing to a string");
            write!(
                layouts,
                "StructLayout {{ name: \"{}\", size_bytes: ::core::mem::size_of::<{path}>() as u32, members: {path}::LAYOUT }}, ",
                item.name
            )
            .expect("writing to a string");
        }
    }
    let mut text = String::from("// Written by build.rs from glsl/. Do not edit.\n");
    root.write(&mut text);
    write!(
        text,
        "/// Every shader in every variant.\npub static ALL: &[&Shader] = &[{all}];\n\
         /// Every struct: its name, size in bytes and members' offsets, as naga read them.\n\
         pub static LAYOUTS: &[StructLayout] = &[{layouts}];\n\
         /// Every struct by its bare name.\npub mod structs {{\n{names}}}\n"
    )
    .expect("writing to a string");
    text
}

impl Row {
    /// `COMP`, of the constant `COMP_BUFFER`.
    fn extension(&self) -> &str {
        self.constant.split('_').next().unwrap_or(&self.constant)
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "pub static {}: Shader = Shader {{", self.constant)?;
        writeln!(text, "name: \"{}\", variant: \"{}\", stage: Stage::{},", self.name, self.constant, self.stage)?;
        writeln!(text, "spirv: include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{}\")),", self.file)?;
        writeln!(text, "bindings: &[")?;
        for b in &self.bindings {
            let Binding { set, binding, name, kind, count } = b;
            writeln!(
                text,
                "Binding {{ set: {set}, binding: {binding}, name: \"{name}\", kind: BindingKind::{kind}, count: {count} }},"
            )?;
        }
        writeln!(text, "],")?;
        match &self.params {
            None => writeln!(text, "params: None,")?,
            Some(Params { name, size_bytes, members }) => {
                let members: String =
                    members.iter().map(|(name, offset)| format!("(\"{name}\", {offset}), ")).collect();
                writeln!(
                    text,
                    "params: Some(ParamsLayout {{ name: \"{name}\", size_bytes: {size_bytes}, members: &[{members}] }}),"
                )?;
            }
        }
        writeln!(text, "constants: &[")?;
        for (name, id, default) in &self.constants {
            writeln!(text, "SpecConstant {{ name: \"{name}\", id: {id}, default: {default} }},")?;
        }
        let side = |side: &Side| match side {
            Side::Fixed(value) => format!("Side::Fixed({value})"),
            Side::Constant(id) => format!("Side::Constant({id})"),
        };
        let [x, y, z] = &self.workgroup;
        writeln!(text, "],\nworkgroup: [{}, {}, {}],\n}};", side(x), side(y), side(z))
    }
}

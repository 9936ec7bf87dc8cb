//! The contract between host and device: structs written once, in GLSL, and read back with naga.
//!
//! Every `struct` whose name ends in Params or Block, wherever it stands, is put into one compute shader that uses it
//! as std430; naga parses and validates that shader and says each member's type, offset and each struct's size.

use crate::Faults;
use crate::compile::{EntryPoint, Sources, Variant};
use naga::front::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::fmt::Write;

/// One struct as Rust text, and where it belongs.
pub struct Struct {
    /// Path from glsl/ of the file that defines it, with its extension.
    pub file: String,
    pub name: String,
    pub rust: String,
}

pub struct Structs(pub Vec<Struct>);

struct Definition {
    file: String,
    name: String,
    text: String,
}

impl Structs {
    pub fn find(sources: &Sources) -> Result<Self, Faults> {
        let mut definitions: Vec<Definition> = Vec::new();
        for (file, text) in sources.files() {
            for (name, body) in definitions_in(text) {
                if let Some(first) = definitions.iter().find(|definition| definition.name == name) {
                    return Err(vec![format!("glsl/{file}:1:1: struct {name} is defined in glsl/{} too", first.file)]);
                }
                definitions.push(Definition { file: file.to_owned(), name, text: body });
            }
        }
        if definitions.is_empty() {
            return Ok(Self(Vec::new()));
        }
        sort_by_use(&mut definitions);
        let words = sources.compile_interface(&interface(&definitions))?;
        let module = parse(&words).map_err(|fault| vec![format!("naga on the structs: {fault}")])?;
        let mut structs = Vec::new();
        for definition in &definitions {
            match generate(&module, &definition.name) {
                Ok(rust) => structs.push(Struct { file: definition.file.clone(), name: definition.name.clone(), rust }),
                Err(fault) => {
                    return Err(vec![format!("glsl/{}:1:1: struct {}: {fault}", definition.file, definition.name)]);
                }
            }
        }
        Ok(Self(structs))
    }
}

/// A second opinion on a shader: naga at SPIR-V 1.3 must read and accept it.
pub fn portable(sources: &Sources, entry: &EntryPoint, variant: &Variant) -> Result<(), String> {
    let words = sources.compile_portable(entry, variant).map_err(|faults| faults.join("; "))?;
    parse(&words).map(|_| ())
}

fn parse(words: &[u32]) -> Result<naga::Module, String> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let options =
        spv::Options { adjust_coordinate_space: false, strict_capabilities: true, block_ctx_dump_prefix: None };
    let module = spv::parse_u8_slice(&bytes, &options).map_err(|error| error.to_string())?;
    Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| error.into_inner().to_string())?;
    Ok(module)
}

/// `struct FooParams { ... };` anywhere in the text.
fn definitions_in(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find("struct ") {
        let from = &rest[start..];
        let name: String = from["struct ".len()..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let end = from.find("};").map_or(from.len(), |end| end + 2);
        if name.ends_with("Params") || name.ends_with("Block") {
            found.push((name, from[..end].to_owned()));
        }
        rest = &from[end.min(from.len())..];
    }
    found
}

/// A struct that another one holds comes first.
fn sort_by_use(definitions: &mut [Definition]) {
    for _ in 0..definitions.len() {
        for first in 0..definitions.len() {
            for second in first + 1..definitions.len() {
                let needed = format!("{} ", definitions[second].name);
                if definitions[first].text.lines().skip(1).any(|line| line.trim_start().starts_with(&needed)) {
                    definitions.swap(first, second);
                }
            }
        }
    }
}

fn interface(definitions: &[Definition]) -> String {
    let mut text = String::from("#version 460\nlayout(local_size_x = 1) in;\n");
    for definition in definitions {
        writeln!(text, "{}", definition.text).expect("writing to a string");
    }
    let mut touches = String::new();
    for (binding, definition) in definitions.iter().enumerate() {
        let name = &definition.name;
        writeln!(
            text,
            "layout(std430, set = 0, binding = {binding}) readonly buffer Interface{binding} {{ {name} values[]; }} interface{binding};"
        )
        .expect("writing to a string");
        writeln!(touches, "    sum += interface{binding}.values.length();").expect("writing to a string");
    }
    let sink = definitions.len();
    writeln!(text, "layout(std430, set = 0, binding = {sink}) buffer Sink {{ int sink; }};")
        .expect("writing to a string");
    writeln!(text, "void main() {{\n    int sum = 0;\n{touches}    sink = sum;\n}}").expect("writing to a string");
    text
}

/// `#[repr(C)]` with every gap named, and the offsets asserted where the struct is compiled.
fn generate(module: &naga::Module, name: &str) -> Result<String, String> {
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some(name))
        .ok_or_else(|| "naga does not list it".to_owned())?;
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        return Err("naga does not see a struct".to_owned());
    };
    let mut fields = String::new();
    let mut asserts = String::new();
    let mut layout = String::new();
    let mut end = 0;
    let mut gaps = 0;
    let mut gap = |fields: &mut String, from: u32, to: u32| {
        if to > from {
            writeln!(fields, "    pub _gap{gaps}: [u8; {}],", to - from).expect("writing to a string");
            gaps += 1;
        }
    };
    for member in members {
        let field = member.name.as_deref().ok_or("a member has no name")?;
        let (rust, size) = rust_type(module, member.ty).map_err(|fault| format!("member {field}: {fault}"))?;
        gap(&mut fields, end, member.offset);
        writeln!(fields, "    pub {field}: {rust},").expect("writing to a string");
        writeln!(asserts, "    assert!(::core::mem::offset_of!({name}, {field}) == {});", member.offset)
            .expect("writing to a string");
        write!(layout, "(\"{field}\", {}), ", member.offset).expect("writing to a string");
        end = member.offset + size;
    }
    gap(&mut fields, end, *span);
    Ok(format!(
        "#[repr(C)]\n#[derive(Clone, Copy, Debug, PartialEq, ::bytemuck::Pod, ::bytemuck::Zeroable)]\n\
         pub struct {name} {{\n{fields}}}\nconst _: () = {{\n{asserts}    \
         assert!(::core::mem::size_of::<{name}>() == {span});\n}};\n\
         impl {name} {{\n    /// Each member and its offset in bytes, as naga read them.\n    \
         pub const LAYOUT: &'static [(&'static str, u32)] = &[{layout}];\n}}\n"
    ))
}

/// The Rust type with the same bytes, and its size.
fn rust_type(module: &naga::Module, handle: naga::Handle<naga::Type>) -> Result<(String, u32), String> {
    use naga::{ArraySize, ScalarKind, TypeInner};
    let scalar = |scalar: naga::Scalar| match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => Ok("f32"),
        (ScalarKind::Uint, 4) => Ok("u32"),
        (ScalarKind::Sint, 4) => Ok("i32"),
        _ => Err(format!("{scalar:?} has no agreed twin: use float, uint or int")),
    };
    let ty = &module.types[handle];
    match &ty.inner {
        TypeInner::Scalar(s) => Ok((scalar(*s)?.to_owned(), 4)),
        TypeInner::Vector { size, scalar: s } => {
            let count = *size as u32;
            Ok((format!("[{}; {count}]", scalar(*s)?), 4 * count))
        }
        TypeInner::Matrix { columns, rows, scalar: s } => {
            let (columns, rows) = (*columns as u32, *rows as u32);
            if rows == 3 {
                return Err("a matrix of three rows has gaps in each column: use four rows".to_owned());
            }
            Ok((format!("[[{}; {rows}]; {columns}]", scalar(*s)?), 4 * columns * rows))
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), stride } => {
            let (inner, size) = rust_type(module, *base)?;
            if size != *stride {
                return Err(format!("array elements of {size} bytes lie {stride} apart"));
            }
            Ok((format!("[{inner}; {count}]"), stride * count.get()))
        }
        TypeInner::Struct { span, .. } => {
            let name = ty.name.clone().ok_or("a nested struct has no name")?;
            if !(name.ends_with("Params") || name.ends_with("Block")) {
                return Err(format!("nested struct {name} must end in Params or Block"));
            }
            Ok((format!("crate::gpu::shader::structs::{name}"), *span))
        }
        other => Err(format!("{other:?} has no twin on the host")),
    }
}

/// For `table`: the structs by the module they belong to.
pub fn by_module(structs: &Structs) -> BTreeMap<String, Vec<&Struct>> {
    let mut modules: BTreeMap<String, Vec<&Struct>> = BTreeMap::new();
    for item in &structs.0 {
        let stem = item.file.rsplit_once('.').map_or(item.file.as_str(), |(stem, _)| stem);
        modules.entry(stem.to_owned()).or_default().push(item);
    }
    modules
}

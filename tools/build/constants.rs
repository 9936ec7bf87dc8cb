//! Numbers that host and device share: `const uint` and `const float` of glsl/, as Rust constants of the same name.

use crate::Faults;
use crate::compile::Sources;
use std::collections::BTreeMap;
use std::fmt::Write;

/// One constant, and what stands above it in its file.
struct Constant {
    file: String,
    rust_type: &'static str,
    value: String,
    /// Lines of the comment above it, without their slashes.
    comment: Vec<String>,
}

/// Constants by module (a path from glsl/ without its extension, which several files may share) and name.
#[derive(Default)]
pub struct Constants(BTreeMap<String, BTreeMap<String, Constant>>);

impl Constants {
    /// Every constant of a whole file that is one literal number and is defined once. One that is made of others, or
    /// that an `#if` chooses, stays the shader's own.
    ///
    /// Errors: two files of one module give a name two values.
    pub fn find(sources: &Sources) -> Result<Self, Faults> {
        let mut found = Self::default();
        for (file, text) in sources.files() {
            let module = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
            let lines: Vec<&str> = text.lines().collect();
            let defined: Vec<(usize, Definition<'_>)> =
                lines.iter().enumerate().filter_map(|(at, line)| Some((at, Definition::parse(line)?))).collect();
            for (at, definition) in &defined {
                let name = definition.name;
                let is_chosen = defined.iter().filter(|(_, other)| other.name == name).count() > 1;
                let Some((rust_type, value)) = definition.literal().filter(|_| !is_chosen) else { continue };
                let above = lines[..*at].iter().rev().map_while(|line| line.strip_prefix("// "));
                let mut comment: Vec<String> = above.map(str::to_owned).collect();
                comment.reverse();
                let constant = Constant { file: file.to_owned(), rust_type, value, comment };
                let constants = found.0.entry(module.to_owned()).or_default();
                match constants.get(name) {
                    Some(known) if known.value != constant.value => {
                        let (line, other) = (at + 1, &known.file);
                        let values = format!("{} here and {} in glsl/{other}", constant.value, known.value);
                        return Err(vec![format!("glsl/{file}:{line}:1: {name} is {values}")]);
                    }
                    _ => constants.insert(name.to_owned(), constant),
                };
            }
        }
        Ok(found)
    }

    /// Rust items of each module.
    pub fn by_module(&self) -> impl Iterator<Item = (&str, String)> {
        self.0.iter().map(|(module, constants)| {
            let mut text = String::new();
            for (name, Constant { file, rust_type, value, comment }) in constants {
                for line in comment {
                    writeln!(text, "/// {line}").expect("writing to a string");
                }
                let empty = if comment.is_empty() { "" } else { "///\n" };
                // Digits of a shader's pi are no mistake.
                let allowed = if *rust_type == "f32" { "#[allow(clippy::approx_constant)]\n" } else { "" };
                write!(text, "{empty}/// Defined in glsl/{file}.\n{allowed}pub const {name}: {rust_type} = {value};\n")
                    .expect("writing to a string");
            }
            (module.as_str(), text)
        })
    }
}

/// A line `const TYPE NAME = VALUE;` that begins at its first column: one that is indented belongs to a function.
struct Definition<'a> {
    glsl_type: &'a str,
    name: &'a str,
    value: &'a str,
}

impl<'a> Definition<'a> {
    fn parse(line: &'a str) -> Option<Self> {
        let (left, right) = line.strip_prefix("const ")?.split_once(" = ")?;
        let (glsl_type, name) = left.split_once(' ')?;
        let (value, _) = right.split_once(';')?;
        Some(Self { glsl_type, name, value })
    }

    /// Its type and value in Rust, where it is one literal number.
    fn literal(&self) -> Option<(&'static str, String)> {
        match self.glsl_type {
            "uint" => {
                let digits = self.value.strip_suffix('u')?;
                let value = match digits.strip_prefix("0x") {
                    Some(hexadecimal) => u32::from_str_radix(hexadecimal, 16).ok()?,
                    None => digits.parse().ok()?,
                };
                Some(("u32", value.to_string()))
            }
            "float" => {
                // Through the shortest text of the same float: GLSL takes digits that Rust's lints do not.
                let value: f32 = self.value.parse().ok()?;
                Some(("f32", format!("{value:?}")))
            }
            _ => None,
        }
    }
}

//! GLSL text to SPIR-V words by the glslang crate: includes, variants, errors that name file, line and column.

use crate::Faults;
use glslang::include::{IncludeHandler, IncludeResult, IncludeType};
use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage, SpirvVersion,
    Target, VulkanVersion,
};
use std::collections::BTreeMap;
use std::path::Path;

/// Every file below glsl/, by its path from there.
pub struct Sources {
    texts: BTreeMap<String, String>,
}

/// A file with a `main`.
#[derive(Clone)]
pub struct EntryPoint {
    /// Path from glsl/, with its extension.
    pub name: String,
    pub stage: ShaderStage,
    /// `// variants:` lines, one axis each: a name and its values.
    axes: Vec<(String, Vec<String>)>,
    /// `// portable: yes`: must also pass naga at SPIR-V 1.3.
    pub portable: bool,
    /// `// spirv: 1.5`: not 1.6, in which `gl_HelperInvocation` is volatile, which Mesa 22.3's lavapipe cannot read.
    is_older: bool,
}

/// One value for each axis; empty where the file has no axis.
#[derive(Clone, Default)]
pub struct Variant(pub Vec<(String, String)>);

impl Variant {
    /// `_BUFFER_HALF`, or nothing.
    pub fn suffix(&self) -> String {
        self.0.iter().map(|(_, value)| format!("_{}", value.to_uppercase().replace('-', "_"))).collect()
    }

    /// `STORAGE_BUFFER`, one a value.
    fn defines(&self) -> Vec<String> {
        self.0.iter().map(|(axis, value)| format!("{axis}_{}", value.to_uppercase().replace('-', "_"))).collect()
    }
}

impl EntryPoint {
    fn parse(name: &str, stage: ShaderStage, text: &str) -> Self {
        let mut axes = Vec::new();
        let (mut portable, mut is_older) = (false, false);
        for line in text.lines().take_while(|line| line.starts_with("//") || line.trim().is_empty()) {
            if let Some(list) = line.strip_prefix("// variants:") {
                for axis in list.split_whitespace() {
                    if let Some((key, values)) = axis.split_once('=') {
                        axes.push((key.to_owned(), values.split('|').map(str::to_owned).collect()));
                    }
                }
            }
            portable |= line.trim() == "// portable: yes";
            is_older |= line.trim() == "// spirv: 1.5";
        }
        Self { name: name.to_owned(), stage, axes, portable, is_older }
    }

    /// Every combination of the axes' values.
    pub fn variants(&self) -> Vec<Variant> {
        let mut variants = vec![Variant::default()];
        for (axis, values) in &self.axes {
            variants = variants
                .iter()
                .flat_map(|variant| {
                    values.iter().map(move |value| {
                        let mut longer = variant.clone();
                        longer.0.push((axis.clone(), value.clone()));
                        longer
                    })
                })
                .collect();
        }
        variants
    }
}

impl Sources {
    pub fn read(root: &Path) -> Result<Self, Faults> {
        let mut texts = BTreeMap::new();
        let mut folders = vec![root.to_path_buf()];
        while let Some(folder) = folders.pop() {
            let entries = std::fs::read_dir(&folder).map_err(|error| vec![format!("{}: {error}", folder.display())])?;
            for entry in entries.flatten() {
                let path = entry.path();
                if path.is_dir() {
                    folders.push(path);
                    continue;
                }
                let text =
                    std::fs::read_to_string(&path).map_err(|error| vec![format!("{}: {error}", path.display())])?;
                println!("cargo::rerun-if-changed={}", path.display());
                let name = path.strip_prefix(root).expect("found below root").to_string_lossy().replace('\\', "/");
                texts.insert(name, text);
            }
        }
        Ok(Self { texts })
    }

    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        self.texts.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }

    pub fn entry_points(&self) -> Vec<EntryPoint> {
        self.files()
            .filter_map(|(name, text)| {
                let stage = match name.rsplit_once('.')?.1 {
                    "vert" => ShaderStage::Vertex,
                    "geom" => ShaderStage::Geometry,
                    "frag" => ShaderStage::Fragment,
                    "comp" => ShaderStage::Compute,
                    _ => return None,
                };
                Some(EntryPoint::parse(name, stage, text))
            })
            .collect()
    }

    /// SPIR-V 1.6 for Vulkan 1.3, or what the file asks for, as the driver gets it.
    pub fn compile(&self, entry: &EntryPoint, variant: &Variant) -> Result<Vec<u32>, Faults> {
        let (vulkan, spirv) = match entry.is_older {
            true => (VulkanVersion::Vulkan1_2, SpirvVersion::SPIRV1_5),
            false => (VulkanVersion::Vulkan1_3, SpirvVersion::SPIRV1_6),
        };
        self.compile_for(entry, variant, vulkan, spirv)
    }

    /// SPIR-V 1.3 for Vulkan 1.1, the newest that naga reads whole.
    pub fn compile_portable(&self, entry: &EntryPoint, variant: &Variant) -> Result<Vec<u32>, Faults> {
        self.compile_for(entry, variant, VulkanVersion::Vulkan1_1, SpirvVersion::SPIRV1_3)
    }

    fn compile_for(
        &self,
        entry: &EntryPoint,
        variant: &Variant,
        vulkan: VulkanVersion,
        spirv: SpirvVersion,
    ) -> Result<Vec<u32>, Faults> {
        let text = &self.texts[&entry.name];
        compile(self, &entry.name, text, entry.stage, &variant.defines(), vulkan, spirv)
    }

    /// A compute shader that is in no file: the struct generator's.
    pub fn compile_interface(&self, text: &str) -> Result<Vec<u32>, Faults> {
        let (vulkan, spirv) = (VulkanVersion::Vulkan1_1, SpirvVersion::SPIRV1_3);
        compile(self, "interface of all structs", text, ShaderStage::Compute, &[], vulkan, spirv)
    }
}

/// Finds `#include "x.glsl"` beside the including file, else from glsl/ on.
struct Includes<'a> {
    texts: &'a BTreeMap<String, String>,
    root: String,
}

impl IncludeHandler for Includes<'_> {
    fn include(&mut self, _: IncludeType, header: &str, includer: &str, _: usize) -> Option<IncludeResult> {
        let includer = if includer.is_empty() { self.root.as_str() } else { includer.trim_start_matches("glsl/") };
        let folder = includer.rsplit_once('/').map_or("", |(folder, _)| folder);
        let beside = if folder.is_empty() { header.to_owned() } else { format!("{folder}/{header}") };
        [beside, header.to_owned()].into_iter().find_map(|name| {
            let text = self.texts.get(&name)?;
            Some(IncludeResult { name: format!("glsl/{name}"), data: text.clone() })
        })
    }
}

fn compile(
    sources: &Sources,
    name: &str,
    text: &str,
    stage: ShaderStage,
    defines: &[String],
    vulkan: VulkanVersion,
    spirv: SpirvVersion,
) -> Result<Vec<u32>, Faults> {
    let compiler = Compiler::acquire().ok_or_else(|| vec!["glslang did not start".to_owned()])?;
    // The #version line must come first and errors must name the file, so the header is put before the text and the
    // file's own #version line is blanked, not removed: line numbers stay.
    let body = text.replacen("#version 460", "", 1);
    let source = ShaderSource::from(format!(
        "#version 460\n#extension GL_GOOGLE_include_directive : require\n\
         #extension GL_GOOGLE_cpp_style_line_directive : enable\n#line 1 \"glsl/{name}\"\n{body}"
    ));
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: vulkan, spirv_version: spirv },
        version_profile: None,
        messages: ShaderMessage::DEFAULT | ShaderMessage::DISPLAY_ERROR_COLUMN | ShaderMessage::ENHANCED,
    };
    let defines: Vec<(&str, Option<&str>)> = defines.iter().map(|define| (define.as_str(), Some("1"))).collect();
    let mut includes = Includes { texts: &sources.texts, root: name.to_owned() };
    let fault = |error: glslang::error::GlslangError| faults_of(name, &error.to_string());
    let input = ShaderInput::new(&source, stage, &options, Some(&defines[..]), Some(&mut includes)).map_err(fault)?;
    let shader = compiler.create_shader(input).map_err(fault)?;
    shader.compile().map_err(fault)
}

/// glslang prints one string; its lines `ERROR: file:line:col: message` become file:line:col: message.
fn faults_of(name: &str, log: &str) -> Faults {
    let lines: Faults = log
        .lines()
        .filter_map(|line| line.trim().strip_prefix("ERROR: "))
        .filter(|line| line.contains(": '") || line.contains("glsl/"))
        .map(str::to_owned)
        .collect();
    if lines.is_empty() { vec![format!("glsl/{name}:1:1: {}", log.trim().replace('\n', "; "))] } else { lines }
}

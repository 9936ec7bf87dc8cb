//! The JSON text to a document whose every index and name has been checked.
//!
//! The `gltf` crate's getters unwrap what its validation has seen; this file runs that validation, guards the one place
//! where it indexes by itself, and lets pass what it is stricter about than drawing needs.

use gltf::json::validation::{Checked, Validate};
use gltf::{Document, Semantic, json};
use serde::Deserialize;

use super::label;
use super::skins::SETS;
use super::survey::survey;
use crate::error::{Error, Result};
use crate::scene::gltf::label::json_error;

/// What is honoured where a file uses it. Quantised vertices need nothing beyond what `accessors` reads anyway.
const EXTENSIONS: [&str; 8] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// How many of the crate's findings a message shows.
const SHOWN_FINDINGS: usize = 4;

/// A document, and what had to be left out of it.
#[derive(Debug)]
pub struct Parsed {
    pub document: Document,
    pub warnings: Vec<String>,
}

/// Parses and checks the JSON of a glTF 2.0 file.
///
/// Errors: it is none, or a part of it points nowhere (exit code 2).
pub fn parse(json: &[u8]) -> Result<Parsed> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    if json.trim_ascii_start().first() != Some(&b'{') {
        return Err(Error::request("is neither glTF JSON nor a .glb: it begins with neither '{' nor 'glTF'"));
    }
    check_version(json)?;
    let surveyed = survey(json)?;
    let root: json::Root = serde_json::from_slice(&surveyed.json).map_err(|error| json_error(&error))?;
    check_required_extensions(&root)?;
    check_indices(&root)?;
    let document = Document::from_json_without_validation(root);
    let mut warnings = ignored_features(&document);
    if surveyed.pointer_channels > 0 {
        warnings.push(label::count(
            surveyed.pointer_channels,
            "animation channel has no node and is left out",
            "animation channels have no node and are left out",
        ));
    }
    Ok(Parsed { document, warnings })
}

/// Version 1 files have objects where version 2 has arrays: asking first gives a better answer than the parser's.
fn check_version(json: &[u8]) -> Result<()> {
    #[derive(Deserialize)]
    #[serde(rename_all = "camelCase")]
    struct Asset {
        version: String,
        min_version: Option<String>,
    }
    #[derive(Deserialize)]
    struct Head {
        asset: Asset,
    }
    let Head { asset } = serde_json::from_slice(json).map_err(|error| json_error(&error))?;
    let needed = asset.min_version.unwrap_or(asset.version);
    if needed != "2.0" && !(needed.starts_with("2.") && needed.len() > 2) {
        return Err(Error::request(format!(
            "is glTF version {:?}; version 2.0 is what is read",
            label::shown(&needed)
        )));
    }
    Ok(())
}

fn check_required_extensions(root: &json::Root) -> Result<()> {
    let missing = || root.extensions_required.iter().map(String::as_str).filter(|name| !EXTENSIONS.contains(name));
    if missing().next().is_none() {
        return Ok(());
    }
    Err(Error::request(format!("extensionsRequired asks for {}, which is not handled", label::list(missing())))
        .note(format!("export the scene without it; handled are {}", EXTENSIONS.join(", "))))
}

fn check_indices(root: &json::Root) -> Result<()> {
    // The validation below indexes `accessors` by POSITION before it has checked that index.
    for (mesh_index, mesh) in root.meshes.iter().enumerate() {
        for (primitive_index, primitive) in mesh.primitives.iter().enumerate() {
            let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            if let Some(index) = position.filter(|index| index.value() >= root.accessors.len()) {
                return Err(Error::request(format!(
                    "{}, primitive {primitive_index}: POSITION is accessor {}, but there are {} accessors",
                    label::element("mesh", mesh_index, mesh.name.as_deref()),
                    index.value(),
                    root.accessors.len()
                )));
            }
        }
    }
    let mut findings = Vec::new();
    root.validate(root, json::Path::new, &mut |path, error| {
        let path = path().to_string();
        // Bounds are taken from the positions themselves, and required extensions are checked above by what is handled.
        let unneeded = path.ends_with("[\"POSITION\"].min") || path.ends_with("[\"POSITION\"].max");
        if !unneeded && error != json::validation::Error::Unsupported {
            findings.push(format!("{path}: {}", error.to_string().to_lowercase()));
        }
    });
    let Some((first, rest)) = findings.split_first() else { return Ok(()) };
    let mut error = Error::request(format!("breaks the rules of glTF 2.0 at {first}"));
    for finding in rest.iter().take(SHOWN_FINDINGS - 1) {
        error = error.note(format!("and at {finding}"));
    }
    if findings.len() > SHOWN_FINDINGS {
        error = error.note(format!("and at {} further places", findings.len() - SHOWN_FINDINGS));
    }
    Err(error)
}

/// One sentence for each thing in the file that the scene leaves out.
fn ignored_features(document: &Document) -> Vec<String> {
    let root = document.as_json();
    let with = |is_ignored: fn(&Semantic) -> bool| {
        let primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        let has = |semantic: &Checked<Semantic>| matches!(semantic, Checked::Valid(semantic) if is_ignored(semantic));
        primitives.filter(|primitive| primitive.attributes.keys().any(has)).count()
    };
    let mut sentences = Vec::new();
    for (count, one, many) in [
        (
            with(|semantic| matches!(semantic, Semantic::Colors(1..))),
            "primitive has vertex colours beyond the first, which are ignored",
            "primitives have vertex colours beyond the first, which are ignored",
        ),
        (
            with(|semantic| matches!(semantic, Semantic::Joints(SETS..) | Semantic::Weights(SETS..))),
            "primitive has joints beyond eight a vertex, which are ignored",
            "primitives have joints beyond eight a vertex, which are ignored",
        ),
    ] {
        if count > 0 {
            sentences.push(label::count(count, one, many));
        }
    }
    let unknown = || root.extensions_used.iter().map(String::as_str).filter(|name| !EXTENSIONS.contains(name));
    match unknown().count() {
        0 => {}
        1 => sentences.push(format!("the extension {} is ignored", label::list(unknown()))),
        _ => sentences.push(format!("the extensions {} are ignored", label::list(unknown()))),
    }
    sentences
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(json: &str) -> String {
        parse(json.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn what_is_not_gltf_2_is_told_apart() {
        assert!(message("solid teapot").contains("neither"));
        assert!(message("{").contains("cut short"));
        assert!(message("{}").contains("asset"));
        assert!(message(r#"{"asset":{"version":"1.0"},"meshes":{"a":{}}}"#).contains("version \"1.0\""));
        assert!(message(r#"{"asset":{"version":"2.0","minVersion":"3.0"}}"#).contains("version \"3.0\""));
        assert!(parse(b"\xef\xbb\xbf {\"asset\":{\"version\":\"2.0\"}}").is_ok());
    }

    #[test]
    fn indices_beyond_their_array_are_named() {
        let mesh = r#"{"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":7}}]}]}"#;
        assert!(message(mesh).contains("mesh 0, primitive 0: POSITION is accessor 7"), "{}", message(mesh));
        let node = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":3}]}"#;
        assert!(message(node).contains("nodes[0].mesh"), "{}", message(node));
    }
}

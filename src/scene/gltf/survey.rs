//! A look at the JSON before it becomes structures: what the `gltf` crate would misread, and what would take more memory
//! than its bytes are worth.
//!
//! Why this way: the crate cuts indices to 32 bits before anything can check them, so that 2^32 would be element 0; three
//! bytes, `{},`, become hundreds; and it refuses whole files for a scene without `nodes` and for a channel without a node,
//! which glTF allows. The survey reads the text as a stream and keeps nothing of it.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use gltf::json;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::value::RawValue;
use serde_json::{Value, json};

use crate::error::{Error, Result};
use crate::units::Bytes;

/// What the elements of a file's arrays may take once parsed.
const MAX_ELEMENT_BYTES: usize = 512 << 20;

/// How long a section may be that is written anew: as values it takes some twenty times as much.
const MAX_REWRITTEN_BYTES: usize = 16 << 20;

/// Members that are an index, or lists and tables of some.
const INDICES: [&str; 25] = [
    "attributes",
    "buffer",
    "bufferView",
    "camera",
    "children",
    "componentType",
    "index",
    "indices",
    "input",
    "inverseBindMatrices",
    "joints",
    "light",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
];

/// Sizes of what the elements of the top arrays become.
const ELEMENTS: [(&str, usize); 13] = [
    ("accessors", size_of::<json::Accessor>()),
    ("animations", size_of::<json::Animation>()),
    ("buffers", size_of::<json::Buffer>()),
    ("bufferViews", size_of::<json::buffer::View>()),
    ("cameras", size_of::<json::Camera>()),
    ("images", size_of::<json::Image>()),
    ("materials", size_of::<json::Material>()),
    ("meshes", size_of::<json::Mesh>()),
    ("nodes", size_of::<json::Node>()),
    ("samplers", size_of::<json::texture::Sampler>()),
    ("scenes", size_of::<json::Scene>()),
    ("skins", size_of::<json::Skin>()),
    ("textures", size_of::<json::Texture>()),
];

/// The text as the crate can read it.
#[derive(Debug)]
pub struct Surveyed<'a> {
    pub json: Cow<'a, [u8]>,
    /// Animation channels without a node, which are left out.
    pub pointer_channels: usize,
}

/// Looks at `json`, an object, and writes anew what the crate refuses and glTF allows.
///
/// Errors: it is no JSON, an index is beyond 32 bits, or its arrays have too many elements (exit code 2).
pub fn survey(json: &[u8]) -> Result<Surveyed<'_>> {
    let mut deserializer = serde_json::Deserializer::from_slice(json);
    let top = deserializer.deserialize_map(Top::default()).map_err(|error| super::label::json_error(&error))?;
    let mut total = 0usize;
    for (name, size) in ELEMENTS {
        let count = top.counts.get(name).copied().unwrap_or_default();
        total = total.saturating_add(count.saturating_mul(size));
        if total > MAX_ELEMENT_BYTES {
            return Err(Error::request(format!(
                "{name}: {count} elements bring the document to {}; {} is the limit",
                Bytes(total as u64),
                Bytes(MAX_ELEMENT_BYTES as u64)
            )));
        }
    }
    let mut surveyed = Surveyed { json: Cow::Borrowed(json), pointer_channels: 0 };
    if let Some((text, dropped)) = rewrite(json) {
        surveyed.json = Cow::Owned(text);
        surveyed.pointer_channels = dropped;
    }
    Ok(surveyed)
}

/// `json` with `nodes` in every scene, and without channels that have no node, whose number is returned; None where it has
/// neither.
fn rewrite(json: &[u8]) -> Option<(Vec<u8>, usize)> {
    let sections: BTreeMap<Cow<'_, str>, &RawValue> = serde_json::from_slice(json).ok()?;
    let mut pieces: Vec<(std::ops::Range<usize>, String)> = Vec::new();
    let mut dropped = 0;
    for (name, change) in [("animations", without_pointers as fn(&mut Value) -> usize), ("scenes", with_nodes)] {
        let Some(text) = sections.get(name).map(|raw| raw.get()).filter(|text| text.len() <= MAX_REWRITTEN_BYTES)
        else {
            continue;
        };
        let mut value: Value = serde_json::from_str(text).ok()?;
        let changed = change(&mut value);
        if changed > 0 {
            // `text` is a part of `json`.
            let start = text.as_ptr() as usize - json.as_ptr() as usize;
            pieces.push((start..start + text.len(), value.to_string()));
            dropped += if name == "animations" { changed } else { 0 };
        }
    }
    if pieces.is_empty() {
        return None;
    }
    pieces.sort_by_key(|(range, _)| range.start);
    let (mut whole, mut end) = (Vec::with_capacity(json.len()), 0);
    for (range, text) in pieces {
        whole.extend_from_slice(&json[end..range.start]);
        whole.extend_from_slice(text.as_bytes());
        end = range.end;
    }
    whole.extend_from_slice(&json[end..]);
    Some((whole, dropped))
}

/// glTF 2.0, section 3.11: a channel without a node is an extension's (KHR_animation_pointer), to be passed over.
fn without_pointers(animations: &mut Value) -> usize {
    let mut dropped = 0;
    for animation in animations.as_array_mut().into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| !channel["target"].is_object() || channel["target"].get("node").is_some());
        dropped += before - channels.len();
    }
    dropped
}

fn with_nodes(scenes: &mut Value) -> usize {
    let mut changed = 0;
    for scene in scenes.as_array_mut().into_iter().flatten() {
        if let Value::Object(members) = scene
            && !members.contains_key("nodes")
        {
            members.insert("nodes".to_owned(), json!([]));
            changed += 1;
        }
    }
    changed
}

/// The whole document: how many elements each of its arrays has.
#[derive(Default)]
struct Top {
    counts: BTreeMap<String, usize>,
}

impl<'de> Visitor<'de> for Top {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a glTF document")
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut members: A) -> Result<Self, A::Error> {
        while let Some(key) = members.next_key::<Cow<'de, str>>()? {
            let count = members.next_value_seed(Part { key: &key })?;
            if ELEMENTS.iter().any(|(name, _)| *name == key) {
                self.counts.insert(key.into_owned(), count);
            }
        }
        Ok(self)
    }
}

/// A value somewhere below the member `key`; its own result is how many elements it has.
#[derive(Clone, Copy)]
struct Part<'k> {
    key: &'k str,
}

impl<'de> DeserializeSeed<'de> for Part<'_> {
    type Value = usize;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        match self.key {
            // Anything may be in there, to any depth; the parser keeps it as text.
            "extras" => deserializer.deserialize_ignored_any(IgnoredAny).map(|_| 0),
            _ => deserializer.deserialize_any(self),
        }
    }
}

impl<'de> Visitor<'de> for Part<'_> {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value")
    }

    fn visit_u64<E: serde::de::Error>(self, value: u64) -> Result<usize, E> {
        if value > u64::from(u32::MAX) && INDICES.contains(&self.key) {
            return Err(E::custom(format!("{} is {value}, beyond all that it could name", self.key)));
        }
        Ok(0)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<usize, A::Error> {
        let mut count = 0;
        while let Some(key) = members.next_key::<Cow<'de, str>>()? {
            // Semantics are names of the file's own.
            let key = if self.key == "attributes" { self.key } else { &*key };
            members.next_value_seed(Part { key })?;
            count += 1;
        }
        Ok(count)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<usize, A::Error> {
        let mut count = 0;
        while elements.next_element_seed(self)?.is_some() {
            count += 1;
        }
        Ok(count)
    }

    fn visit_bool<E>(self, _: bool) -> Result<usize, E> {
        Ok(0)
    }

    fn visit_i64<E>(self, _: i64) -> Result<usize, E> {
        Ok(0)
    }

    fn visit_f64<E>(self, _: f64) -> Result<usize, E> {
        Ok(0)
    }

    fn visit_str<E>(self, _: &str) -> Result<usize, E> {
        Ok(0)
    }

    fn visit_unit<E>(self) -> Result<usize, E> {
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(json: &str) -> String {
        survey(json.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn an_index_is_not_cut_to_32_bits() {
        assert!(text(r#"{"nodes":[{"mesh":4294967296}]}"#).contains("mesh is 4294967296"));
        assert!(text(r#"{"m":[{"p":[{"attributes":{"POSITION":9999999999}}]}]}"#).contains("attributes is 9999999999"));
        assert!(text(r#"{"nodes":[{"children":[0,4294967296]}]}"#).contains("children is"));
        for fine in [r#"{"bufferViews":[{"byteOffset":4294967296}]}"#, r#"{"extras":{"mesh":4294967296}}"#] {
            assert_eq!(survey(fine.as_bytes()).unwrap().json, fine.as_bytes());
        }
    }

    #[test]
    fn empty_elements_are_counted_by_what_they_become() {
        let many = format!(r#"{{"materials":[{{}}{}]}}"#, ",{}".repeat(MAX_ELEMENT_BYTES / 64));
        assert!(text(&many).contains("materials: 8388609 elements"), "{}", text(&many));
    }

    #[test]
    fn what_gltf_allows_is_written_as_the_crate_reads_it() {
        let json = r#"{"scenes":[{"name":"a"}], "x":1, "animations":[{"channels":[
            {"sampler":0,"target":{"path":"pointer"}},{"sampler":1,"target":{"node":0,"path":"scale"}}]}]}"#;
        let surveyed = survey(json.as_bytes()).unwrap();
        assert_eq!(surveyed.pointer_channels, 1);
        let read: Value = serde_json::from_slice(&surveyed.json).unwrap();
        assert_eq!(read["scenes"], json!([{"name": "a", "nodes": []}]));
        assert_eq!(read["animations"][0]["channels"], json!([{"sampler": 1, "target": {"node": 0, "path": "scale"}}]));
        assert_eq!(read["x"], 1);
    }
}

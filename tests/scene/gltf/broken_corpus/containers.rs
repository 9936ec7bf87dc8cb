//! A .glb cut at every edge and beside it, chunks that lie about their length, JSON that is none.

use super::Case;
use crate::support::gltf_file::GltfFile;
use serde_json::json;

pub fn cases() -> Vec<Case> {
    let whole = GltfFile::triangle().glb();
    let word = |at: usize| u32::from_le_bytes(whole[at..at + 4].try_into().unwrap());
    let json_end = 20 + word(12) as usize;
    let edges = [
        ("the magic", 4),
        ("the header", 12),
        ("the JSON chunk's length", 16),
        ("the JSON chunk's header", 20),
        ("the JSON chunk", json_end),
        ("the binary chunk's length", json_end + 4),
        ("the binary chunk's header", json_end + 8),
        ("the binary chunk", whole.len()),
    ];
    let mut cases = Vec::new();
    for (name, edge) in edges {
        for (place, length) in [("before", edge - 1), ("at", edge), ("behind", edge + 1)] {
            if length >= whole.len() {
                continue;
            }
            cases.push(Case::refused(format!("cut {place} the end of {name}"), whole[..length].to_vec(), &[]));
            if length >= 12 {
                let mut agreed = whole[..length].to_vec();
                agreed[8..12].copy_from_slice(&(length as u32).to_le_bytes());
                let name = format!("cut {place} the end of {name}, the header agreeing");
                cases.push(Case::refused(name, agreed, &[]));
            }
        }
    }
    for value in [0, 1, 1 << 31, u32::MAX] {
        for (name, at) in [("length", 8), ("JSON chunk length", 12), ("binary chunk length", json_end)] {
            let mut changed = whole.clone();
            changed[at..at + 4].copy_from_slice(&value.to_le_bytes());
            cases.push(Case::refused(format!("{name} of {value}"), changed, &[]));
        }
    }
    let mut longer = whole.clone();
    longer.extend([0; 7]);
    cases.push(Case::drawn("bytes behind the end", longer));
    cases.extend(texts());
    cases
}

/// Where the main file's JSON itself is at fault.
fn texts() -> Vec<Case> {
    const DEEP: usize = 100_000;
    let nested = |open: &str, close: &str| {
        let text = format!("{}0{}", open.repeat(DEEP), close.repeat(DEEP));
        format!("{{\"asset\": {{\"version\": \"2.0\", \"extras\": {text}}}}}").into_bytes()
    };
    let asset = |rest: &str| format!("{{\"asset\": {{\"version\": \"2.0\"}}{rest}}}").into_bytes();
    let long = "x".repeat(1 << 20);
    vec![
        Case::refused("arrays 100,000 deep", nested("[", "]"), &["no triangle"]),
        Case::refused("objects 100,000 deep", nested("{\"a\":", "}"), &["no triangle"]),
        Case::refused(
            "arrays 100,000 deep where none belong",
            asset(&format!(", \"x\": {}{}", "[".repeat(DEEP), "]".repeat(DEEP))),
            &["recursion"],
        ),
        Case::refused("an unclosed string", asset(", \"x\": \"")[..30].to_vec(), &["cut short"]),
        Case::refused("a byte that is not UTF-8", b"{\"asset\": {\"version\": \"2.0\xff\"}}".to_vec(), &["JSON"]),
        Case::refused("a number of 400 digits", asset(&format!(", \"scene\": {}", "9".repeat(400))), &["JSON"]),
        Case::refused("1e999 as a number", asset(", \"nodes\": [{\"scale\": [1e999, 1, 1]}]"), &["JSON"]),
        Case::refused("an array where an object belongs", asset(", \"nodes\": [[]]"), &["JSON"]),
        Case::refused("an index of -1", asset(", \"scene\": -1"), &["JSON"]),
        Case::refused("no asset", b"{}".to_vec(), &["asset"]),
        Case::refused(
            "a version of a megabyte",
            format!("{{\"asset\": {{\"version\": \"{long}\"}}}}").into(),
            &["version"],
        ),
        Case::changed("a required extension that is unknown", &["extensionsRequired", "EXT_teapot"], |file| {
            file.json["extensionsRequired"] = json!(["EXT_teapot"]);
        }),
        Case::changed("100,000 unknown required extensions", &["extensionsRequired", "EXT_7"], |file| {
            let names: Vec<String> = (0..100_000).map(|index| format!("EXT_{index}")).collect();
            file.json["extensionsRequired"] = json!(names);
        }),
        Case::changed("a required extension with a terminal's escape codes", &["extensionsRequired"], |file| {
            file.json["extensionsRequired"] = json!(["\u{1b}[2J"]);
        }),
        Case::changed("a name of a megabyte", &["mesh 0", "POSITION"], |file| {
            file.json["meshes"][0]["name"] = json!(long);
            file.json["accessors"][0]["count"] = json!(9);
        }),
        Case::refused(
            "a million empty materials",
            asset(&format!(", \"materials\": [{{}}{}]", ",{}".repeat(2 << 20))),
            &["materials"],
        ),
        Case::refused(
            "two million empty nodes",
            asset(&format!(", \"nodes\": [{{}}{}]", ",{}".repeat(4 << 20))),
            &["nodes"],
        ),
    ]
}

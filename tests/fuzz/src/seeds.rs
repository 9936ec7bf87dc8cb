//! The seeds of a target: files of the tests' own builders, and a few lines of text.

// The tests' builder whole, of which seeds are made by a part: loading is the fuzz targets' own work.
#[allow(dead_code)]
#[path = "../../support/gltf_file.rs"]
mod gltf_file;

use gltf_file::{F32, GltfFile, U16, U8, png};
use quincunx::techniques;
use serde_json::json;
use std::path::Path;

/// Where QUINCUNX_SEEDS names a folder, writes the seeds of `target` there and ends the process: a fuzz target has no
/// arguments of its own, and another program would not link to the fuzzer.
pub fn write_if_asked(target: &str) {
    let Some(folder) = std::env::var_os("QUINCUNX_SEEDS") else { return };
    let seeds: Vec<Vec<u8>> = match target {
        "importer" => files().iter().flat_map(|file| [[&[0], &file.glb()[..]].concat(), text(file)]).collect(),
        "rows" => rows(),
        "settings" => values(),
        _ => panic!("no seeds for {target}"),
    };
    for (index, seed) in seeds.iter().enumerate() {
        std::fs::write(Path::new(&folder).join(format!("seed-{index}")), seed).unwrap();
    }
    std::process::exit(0);
}

/// The same as a .gltf, its buffer in a URI.
fn text(file: &GltfFile) -> Vec<u8> {
    let mut json = file.json.clone();
    let escaped: String = file.bytes.iter().map(|byte| format!("%{byte:02x}")).collect();
    json["buffers"] = json!([{"byteLength": file.bytes.len(), "uri": format!("data:,{escaped}")}]);
    [&[4], json.to_string().as_bytes()].concat()
}

fn files() -> Vec<GltfFile> {
    vec![GltfFile::triangle(), indexed(), textured(), sparse(), lit(), moving(), skinned(), morphed()]
}

fn indexed() -> GltfFile {
    let mut file = GltfFile::triangle();
    let indices = file.indices(U16, &[0, 1, 2]);
    file.primitive()["indices"] = json!(indices);
    file.primitive()["mode"] = json!(5);
    file.root(json!({"children": [2], "scale": [2.0, 1.0, -1.0]}));
    file.push("nodes", json!({"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]}));
    file
}

fn textured() -> GltfFile {
    let mut file = GltfFile::triangle();
    let view = file.view(&png(3, 2));
    file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("images", json!({"uri": "a.png"}));
    file.push("samplers", json!({"wrapS": 33071, "minFilter": 9984}));
    file.push("textures", json!({"source": 0, "sampler": 0}));
    file.push("textures", json!({"source": 1}));
    let moved =
        json!({"KHR_texture_transform": {"offset": [0.5, 0.0], "rotation": 1.0, "scale": [2, 3], "texCoord": 1}});
    file.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0, "extensions": moved}, "metallicFactor": 0.5,
                "metallicRoughnessTexture": {"index": 1},
            },
            "normalTexture": {"index": 1, "scale": 0.5}, "occlusionTexture": {"index": 0, "strength": 0.5},
            "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 0.5, 0],
            "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
            "extensions": {
                "KHR_materials_emissive_strength": {"emissiveStrength": 3}, "KHR_materials_ior": {"ior": 1.3},
                "KHR_materials_specular": {"specularFactor": 0.5}, "KHR_materials_transmission": {"transmissionFactor": 0.5},
            },
        }),
    );
    file.push("materials", json!({"extensions": {"KHR_materials_unlit": {}}}));
    for (semantic, kind, values) in [
        ("NORMAL", "VEC3", [0.0, 0.0, 1.0].repeat(3)),
        ("TEXCOORD_0", "VEC2", vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        ("TEXCOORD_1", "VEC2", vec![0.0, 0.0, 0.5, 0.0, 0.0, 0.5]),
        ("COLOR_0", "VEC4", [1.0, 0.5, 0.0, 1.0].repeat(3)),
    ] {
        let accessor = file.floats(kind, &values);
        file.primitive()["attributes"][semantic] = json!(accessor);
    }
    file.primitive()["material"] = json!(0);
    file
}

fn sparse() -> GltfFile {
    let mut file = GltfFile::triangle();
    let (places, values) = (file.view(&[1]), file.view(&[0; 12]));
    file.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": places, "componentType": U8}, "values": {"bufferView": values},
    });
    let zeros = file.push("accessors", json!({"componentType": F32, "count": 3, "type": "VEC3"}));
    file.primitive()["attributes"]["NORMAL"] = json!(zeros);
    file.json["bufferViews"][0]["byteStride"] = json!(12);
    file
}

fn lit() -> GltfFile {
    let mut file = GltfFile::triangle();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "directional"}, {"type": "point", "range": 3, "intensity": 5},
        {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}, "color": [1, 0, 0.5]},
    ]}});
    for light in 0..3 {
        file.root(json!({"extensions": {"KHR_lights_punctual": {"light": light}}, "rotation": [0, 0.6, 0, 0.8]}));
    }
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1, "zfar": 9}}));
    file.push(
        "cameras",
        json!({"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 2, "znear": 0, "zfar": 9}}),
    );
    file.root(json!({"camera": 0}));
    file.root(json!({"camera": 1, "translation": [0, 0, 3]}));
    file
}

fn moving() -> GltfFile {
    let mut file = GltfFile::triangle();
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], ("VEC3", &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0]));
    file.animate(0, "rotation", "STEP", &[0.0, 1.0], ("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]));
    file.animate(0, "scale", "CUBICSPLINE", &[0.5], ("VEC3", &[1.0; 9]));
    file
}

fn skinned() -> GltfFile {
    let mut file = GltfFile::triangle();
    file.bind(U8, [1, 0, 0, 0], [0.75, 0.25, 0.0, 0.0]);
    file.json["nodes"][0]["skin"] = json!(0);
    file.root(json!({"children": [2]}));
    file.push("nodes", json!({"translation": [0, 1, 0]}));
    let unit = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let matrices = file.floats("MAT4", &unit.repeat(2));
    file.push("skins", json!({"joints": [1, 2], "inverseBindMatrices": matrices, "skeleton": 1}));
    file.animate(2, "rotation", "LINEAR", &[0.0, 1.0], ("VEC4", &[0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]));
    file
}

fn morphed() -> GltfFile {
    let mut file = GltfFile::triangle();
    let moves = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
    file.primitive()["targets"] = json!([{"POSITION": moves, "NORMAL": moves}, {"POSITION": moves}]);
    file.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    file.animate(0, "weights", "LINEAR", &[0.0, 1.0], ("SCALAR", &[0.0, 1.0, 1.0, 0.0]));
    file
}

fn rows() -> Vec<Vec<u8>> {
    let row = |variant: &str, mean: f64| {
        json!({
            "schema": 1, "bench": "split", "variant": variant, "technique": "deferred", "commit": "c", "repeat": 3,
            "device": {"name": "d", "type": "cpu", "driver_info": "i"}, "baseline": "a",
            "scene": {"name": "box", "hash": "h"}, "settings": {"pattern": "2x2", "block": variant},
            "ratio": {"mean": mean, "interval_95": [0.5, 1.5]}, "error_against_none": {"rmse": 0.5, "flip": 0.1},
            "stage_ms": {"median": 3.5}, "bytes_read": 100, "bytes_written": 28, "memory": {"peak_bytes": 1048576},
            "identity": {"mean": 1.0, "interval_95": null}, "copied_bytes": 64, "copied_gb_per_s": 1.5,
        })
    };
    let lines = format!("{}\n{}\n", row("8", 1.0), row("16", 0.5));
    let skipped = json!({"bench": "split", "variant": "32", "skipped": "it cannot be"});
    let texts =
        [lines.clone(), format!("{lines}{skipped}\n"), format!("{lines}{{\"bench\": \"fra"), "{}\n\n{}\n".to_owned()];
    (0..5u8).flat_map(|which| texts.each_ref().map(|text| [&[which], text.as_bytes()].concat())).collect()
}

/// Text behind the two bytes that choose what it is for: `arbitrary` takes a last String from the end of the input.
fn values() -> Vec<Vec<u8>> {
    let settings = techniques::ALL.iter().flat_map(|technique| quincunx::techniques::settings_of(*technique));
    let mut texts: Vec<(u8, String)> = settings.map(|setting| (0, setting.default.to_owned())).collect();
    for text in ["64x64", "auto", "0.25", "2%", "1.5GiB", "none", "1,0.5,0", "17", "-1", "nan", "1e308", "1:7"] {
        texts.push((0, text.to_owned()));
    }
    for text in ["split=none,one-pass\nkernel=5,7", "--pattern=2x2,4x4", "kernel=5 split=none"] {
        texts.push((2, text.to_owned()));
    }
    texts.extend(["0..47\n24", "8..11\n0.5", "0..999999\n1000"].map(|text| (3, text.to_owned())));
    texts.iter().enumerate().map(|(at, (what, text))| [&[*what, at as u8], text.as_bytes()].concat()).collect()
}

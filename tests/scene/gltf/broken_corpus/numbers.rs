//! Counts, offsets and strides beyond what is there, and numbers that no scene has.

use super::Case;
use crate::support::gltf_file::{GltfFile, U8, U16, U32};
use serde_json::{Value, json};

/// The triangle with all that accessors may have: indices, normals, coordinates, colours, sparse values.
fn rich() -> GltfFile {
    let mut file = GltfFile::triangle();
    let indices = file.indices(U16, &[0, 1, 2]);
    file.primitive()["indices"] = json!(indices);
    for (semantic, kind, values) in [
        ("NORMAL", "VEC3", [0.0, 0.0, 1.0].repeat(3)),
        ("TEXCOORD_0", "VEC2", vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        ("COLOR_0", "VEC4", vec![1.0; 12]),
    ] {
        let accessor = file.floats(kind, &values);
        file.primitive()["attributes"][semantic] = json!(accessor);
    }
    let (places, values) = (file.view(&[1]), file.view(&[0; 12]));
    file.json["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": {"bufferView": places, "componentType": U8}, "values": {"bufferView": values},
    });
    file.json["buffers"] = json!([{"byteLength": file.bytes.len()}]);
    file
}

pub fn accessors() -> Vec<Case> {
    let hard = [
        ("2^31", json!(1u64 << 31)),
        ("2^32 - 1", json!(u32::MAX)),
        ("2^32", json!(1u64 << 32)),
        ("2^63", json!(1u64 << 63)),
        ("2^64 - 1", json!(u64::MAX)),
        ("2^64 - 4", json!(u64::MAX - 3)),
        ("-1", json!(-1)),
        ("0.5", json!(0.5)),
    ];
    let places = [
        "/accessors/0/count",
        "/accessors/0/byteOffset",
        "/accessors/1/count",
        "/accessors/0/sparse/count",
        "/accessors/0/sparse/indices/byteOffset",
        "/accessors/0/sparse/values/byteOffset",
        "/accessors/0/bufferView",
        "/bufferViews/0/byteOffset",
        "/bufferViews/0/byteLength",
        "/bufferViews/0/byteStride",
        "/bufferViews/0/buffer",
        "/buffers/0/byteLength",
        "/meshes/0/primitives/0/indices",
        "/meshes/0/primitives/0/attributes/POSITION",
        "/nodes/0/mesh",
        "/scenes/0/nodes/0",
    ];
    let mut cases = Vec::new();
    for place in places {
        for (name, number) in &hard {
            let mut file = rich();
            let (above, key) = place.rsplit_once('/').unwrap();
            let above = file.json.pointer_mut(above).unwrap();
            match above {
                Value::Array(elements) => elements[key.parse::<usize>().unwrap()] = number.clone(),
                _ => above[key] = number.clone(),
            }
            cases.push(Case::refused(format!("{place} of {name}"), file.glb(), &[]));
        }
    }
    for (stride, word) in
        [(1, "byteStride"), (4, "stride"), (8, "stride"), (11, "stride"), (13, "13 bytes"), (256, "byteStride")]
    {
        let name = format!("a stride of {stride} bytes for elements of 12");
        cases.push(Case::changed(name, &[word], |file| file.json["bufferViews"][0]["byteStride"] = json!(stride)));
    }
    cases.push(Case::changed("an offset and a length whose sum passes 2^64", &["buffer view 0"], |file| {
        file.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX - 8);
        file.json["bufferViews"][0]["byteLength"] = json!(36);
    }));
    for (name, semantic, kind, component) in [
        ("positions of shorts in two", "POSITION", "VEC2", U16),
        ("positions of 32-bit integers", "POSITION", "VEC3", U32),
        ("normals of four", "NORMAL", "VEC4", U8),
        ("coordinates of one", "TEXCOORD_0", "SCALAR", U8),
        ("colours of two", "COLOR_0", "VEC2", U8),
    ] {
        cases.push(Case::changed(name, &["mesh 0", semantic], |file| {
            let view = file.view(&[0; 64]);
            let accessor = json!({"bufferView": view, "componentType": component, "count": 3, "type": kind});
            let accessor = file.push("accessors", accessor);
            file.primitive()["attributes"][semantic] = json!(accessor);
        }));
    }
    for (name, component, values) in
        [("bytes", U8, [0, 1, 255]), ("shorts", U16, [0, 1, 65535]), ("integers", U32, [0, 1, u32::MAX])]
    {
        cases.push(Case::changed(
            format!("an index beyond the vertices, in {name}"),
            &["indices", "element 2"],
            |file| {
                let indices = file.indices(component, &values);
                file.primitive()["indices"] = json!(indices);
            },
        ));
    }
    cases.push(Case::changed("indices of floats", &["indices"], |file| {
        let indices = file.floats("SCALAR", &[0.0, 1.0, 2.0]);
        file.primitive()["indices"] = json!(indices);
    }));
    cases
}

/// The document of the triangle, its node with what `node` says and an element pushed to each of `arrays`.
fn with(name: String, words: &[&str], node: Value, arrays: &[(&str, Value)]) -> Case {
    Case::changed(name, words, |file| {
        for (array, element) in arrays {
            file.push(array, element.clone());
        }
        file.root(node);
    })
}

pub fn values() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, number) in [("NaN", f32::NAN), ("infinity", f32::INFINITY), ("-infinity", f32::NEG_INFINITY)] {
        for (semantic, kind, width) in
            [("POSITION", "VEC3", 3), ("NORMAL", "VEC3", 3), ("TEXCOORD_0", "VEC2", 2), ("COLOR_0", "VEC4", 4)]
        {
            cases.push(Case::changed(format!("{name} in {semantic}"), &["mesh 0", semantic, "element 1"], |file| {
                let mut values = vec![0.0; 3 * width];
                values[width] = number;
                let accessor = file.floats(kind, &values);
                file.primitive()["attributes"][semantic] = json!(accessor);
            }));
        }
    }
    for (name, number) in [("1e300", 1e300), ("-1e300", -1e300)] {
        for (key, value) in [
            ("translation", json!([number, 0, 0])),
            ("rotation", json!([0, 0, 0, number])),
            ("scale", json!([1, number, 1])),
            ("matrix", json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, number, 0, 0, 1])),
        ] {
            cases.push(with(format!("a {key} of {name}"), &["node 1"], json!({ key: value }), &[]));
        }
        for material in [
            json!({"pbrMetallicRoughness": {"baseColorFactor": [number, 0, 0, 1]}}),
            json!({"pbrMetallicRoughness": {"roughnessFactor": number}}),
            json!({"emissiveFactor": [number, 0, 0]}),
            json!({"alphaMode": "MASK", "alphaCutoff": number}),
            json!({"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": number}}, "emissiveFactor": [1, 1, 1]}),
            json!({"extensions": {"KHR_materials_ior": {"ior": number}}}),
        ] {
            let words = ["material 0"];
            cases.push(with(format!("a material {material}"), &words, json!({}), &[("materials", material)]));
        }
        for light in [
            json!({"type": "point", "intensity": number}),
            json!({"type": "point", "color": [1, number, 1]}),
            json!({"type": "point", "range": number}),
            json!({"type": "spot", "spot": {"outerConeAngle": number}}),
        ] {
            cases.push(Case::changed(format!("a light {light}"), &["light 0"], |file| {
                file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
                file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
            }));
        }
        for (kind, view) in [
            ("perspective", json!({"yfov": number, "znear": 0.1})),
            ("perspective", json!({"yfov": 1, "znear": number})),
            ("perspective", json!({"yfov": 1, "znear": 0.1, "zfar": number})),
            ("orthographic", json!({"xmag": number, "ymag": 1, "znear": 0, "zfar": 1})),
            ("orthographic", json!({"xmag": 1, "ymag": 1, "znear": 0, "zfar": number})),
        ] {
            let camera = json!({"type": kind, kind: view});
            cases.push(with(format!("a camera {camera}"), &["camera 0"], json!({"camera": 0}), &[("cameras", camera)]));
        }
    }
    cases.push(with("a rotation of nothing".into(), &["node 1"], json!({"rotation": [0, 0, 0, 0]}), &[]));
    cases.push(with("a matrix that is not affine".into(), &["node 1", "affine"], json!({"matrix": vec![1; 16]}), &[]));
    cases.push(with("a matrix of 3 numbers".into(), &["JSON"], json!({"matrix": [1, 2, 3]}), &[]));
    cases.extend(extreme());
    cases
}

/// Numbers that are finite and still have no picture, or only just one.
fn extreme() -> Vec<Case> {
    let mut cases = Vec::new();
    for (kind, view) in [
        ("perspective", json!({"yfov": 1e-44, "znear": 0.1})),
        ("perspective", json!({"yfov": 1.0, "znear": 3e38})),
        ("perspective", json!({"yfov": 1.0, "znear": 1e-44, "zfar": 3e38})),
        ("orthographic", json!({"xmag": 1e-44, "ymag": 1e-44, "znear": 0, "zfar": 1})),
        ("orthographic", json!({"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1e-44})),
    ] {
        let camera = json!({"type": kind, kind: view});
        cases.push(with(format!("a camera {camera}"), &[], json!({"camera": 0}), &[("cameras", camera)]).either());
    }
    for intensity in [1e20, 3e38] {
        cases.push(Case::changed(format!("a light of {intensity} candela"), &["light 0"], |file| {
            file.json["extensions"] =
                json!({"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": intensity}]}});
            let translation = [0.2, 0.2, 0.5];
            file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": translation}));
        }));
    }
    let mut shining = GltfFile::triangle();
    let extensions = json!({"KHR_materials_emissive_strength": {"emissiveStrength": 3e38}});
    shining.push("materials", json!({"emissiveFactor": [1, 1, 1], "extensions": extensions}));
    shining.primitive()["material"] = json!(0);
    cases.push(Case::drawn("an emission of 3e38", shining.glb()));
    for scale in [1e-44, 1e-30, 1e-10, 1e10, 1e12] {
        let mut file = GltfFile::triangle();
        file.json["nodes"][0]["scale"] = json!([scale, scale, scale]);
        match scale {
            // No inverse is left: nothing is drawn.
            small if small < 1e-20 => {
                cases.push(Case::refused(format!("a scale of {scale}"), file.glb(), &["no triangle"]));
            }
            _ => cases.push(Case::drawn(format!("a scale of {scale}"), file.glb())),
        }
    }
    for far in [1e30, 3e38] {
        cases.push(Case::changed(format!("a triangle {far} m across"), &["too far"], |file| {
            let far = far as f32;
            let positions = file.floats("VEC3", &[-far, 0.0, 0.0, far, 0.0, 0.0, 0.0, far, 0.0]);
            file.primitive()["attributes"]["POSITION"] = json!(positions);
        }));
    }
    let mut point = GltfFile::triangle();
    let positions = point.floats("VEC3", &[0.0; 9]);
    point.primitive()["attributes"]["POSITION"] = json!(positions);
    cases.push(Case::drawn("a triangle without area", point.glb()));
    let mut flat = GltfFile::triangle();
    let normals = flat.floats("VEC3", &[0.0; 9]);
    flat.primitive()["attributes"]["NORMAL"] = json!(normals);
    cases.push(Case::drawn("normals of length zero", flat.glb()));
    cases
}

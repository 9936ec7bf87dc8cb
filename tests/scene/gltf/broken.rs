//! glTF files that must be refused: each with one request error that names the file and the element, never a panic.

use crate::support::gltf_file::{F32, GltfFile, U8, U16, U32, expect, load_bytes, write};
use proptest::prelude::*;
use quincunx::scene::gltf;
use serde_json::{Value, json};

/// The triangle after a change to its document must be refused with these words.
#[track_caller]
fn refused(change: impl FnOnce(&mut GltfFile), words: &[&str]) {
    let mut file = GltfFile::triangle();
    change(&mut file);
    expect(&file.load().unwrap_err(), "scene.glb", words);
}

#[test]
fn files_that_are_no_gltf() {
    let folder = tempfile::tempdir().unwrap();
    expect(&gltf::load(&folder.path().join("no.glb")).unwrap_err(), "no.glb", &["no such file"]);
    expect(&gltf::load(folder.path()).unwrap_err(), "", &["is a folder"]);
    expect(&load_bytes("a.gltf", b"").unwrap_err(), "a.gltf", &["is empty"]);
    expect(&load_bytes("a.gltf", b"v 0 0 0\nf 1 1 1\n").unwrap_err(), "a.gltf", &["neither"]);
    expect(&load_bytes("a.gltf", b"\x89PNG").unwrap_err(), "a.gltf", &["neither"]);
    expect(&load_bytes("a.gltf", b"{\"asset\": {\"version\": \"2.0\"}").unwrap_err(), "a.gltf", &["cut short"]);
    expect(&load_bytes("a.gltf", b"{\"asset\": {\"version\": \"1.0\"}}").unwrap_err(), "a.gltf", &["version \"1.0\""]);
    let nested = format!("{{\"asset\": {{\"version\": \"2.0\", \"extras\": {}", "[".repeat(100_000));
    expect(&load_bytes("a.gltf", nested.as_bytes()).unwrap_err(), "a.gltf", &["JSON"]);
}

#[test]
fn a_glb_cut_anywhere() {
    let whole = GltfFile::triangle().glb();
    assert!(load_bytes("scene.glb", &whole).is_ok());
    for length in 0..whole.len() {
        expect(&load_bytes("scene.glb", &whole[..length]).unwrap_err(), "scene.glb", &[]);
        // The same with a header that agrees, so that the cut shows further inside.
        if length >= 12 {
            let mut cut = whole[..length].to_vec();
            cut[8..12].copy_from_slice(&(length as u32).to_le_bytes());
            expect(&load_bytes("scene.glb", &cut).unwrap_err(), "scene.glb", &[]);
        }
    }
}

#[test]
fn counts_and_offsets_beyond_the_end() {
    for count in [4u64, 1 << 31, 1 << 32, u64::MAX] {
        refused(|file| file.json["accessors"][0]["count"] = json!(count), &["mesh 0 \"leaf\", primitive 0"]);
    }
    for offset in [4u64, 1 << 32, u64::MAX] {
        refused(|file| file.json["accessors"][0]["byteOffset"] = json!(offset), &["POSITION", "accessor 0"]);
        refused(|file| file.json["bufferViews"][0]["byteOffset"] = json!(offset), &["accessor 0", "buffer view 0"]);
    }
    refused(|file| file.json["bufferViews"][0]["byteLength"] = json!(u64::MAX), &["buffer view 0"]);
    refused(|file| file.json["bufferViews"][0]["byteStride"] = json!(8), &["stride"]);
    refused(|file| file.json["bufferViews"][0]["byteStride"] = json!(u64::MAX), &["bufferViews[0].byteStride"]);
    refused(|file| file.json["buffers"] = json!([{"byteLength": 1000}]), &["buffer 0", "1000"]);
    refused(|file| file.json["accessors"][0]["type"] = json!("VEC2"), &["POSITION", "Vec2"]);
    refused(|file| file.json["accessors"][0]["type"] = json!("VEC9"), &["accessors[0].type"]);
    refused(|file| file.json["accessors"][0]["componentType"] = json!(U32), &["POSITION", "32-bit integers"]);
}

#[test]
fn few_bytes_named_many_times() {
    let mut file = GltfFile::triangle();
    let indices = file.indices(U8, &[0; 1 << 20]);
    let primitive = json!({"attributes": {"POSITION": 0}, "indices": indices});
    file.json["meshes"][0]["primitives"] = json!(vec![primitive; 300]);
    expect(&file.load().unwrap_err(), "scene.glb", &["mesh 0 \"leaf\", primitive 5", "the limit"]);

    let mut file = GltfFile::triangle();
    let primitive = file.primitive().clone();
    file.json["meshes"][0]["primitives"] = json!(vec![primitive; 2050]);
    for _ in 0..2050 {
        file.root(json!({"mesh": 0}));
    }
    expect(&file.load().unwrap_err(), "scene.glb", &["node 1753", "triangles over all nodes"]);
    // As many bytes as would back them.
    file.view(&[0; 1 << 20]);
    expect(&file.load().unwrap_err(), "scene.glb", &["node 2046", "4194304 draws"]);
}

#[test]
fn sparse_values_that_lie() {
    let sparse = |count: u64, place: u8| {
        move |file: &mut GltfFile| {
            let places = file.view(&[place]);
            let values = file.view(&[0; 12]);
            file.json["accessors"][0]["sparse"] = json!({
                "count": count,
                "indices": {"bufferView": places, "componentType": U8},
                "values": {"bufferView": values},
            });
        }
    };
    refused(sparse(1, 3), &["POSITION", "sparse", "index 3"]);
    refused(sparse(u64::MAX, 0), &["POSITION", "sparse"]);
    refused(
        |file| {
            sparse(1, 0)(file);
            file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
            file.json["accessors"][0]["count"] = json!(1u64 << 20);
        },
        &["POSITION", "without a buffer view"],
    );
}

#[test]
fn attributes_that_do_not_fit() {
    refused(
        |file| {
            let indices = file.indices(U16, &[0, 1, 3]);
            file.primitive()["indices"] = json!(indices);
        },
        &["primitive 0", "indices", "element 2 is vertex 3"],
    );
    refused(|file| file.primitive()["indices"] = json!(0), &["indices", "scalars"]);
    refused(|file| file.primitive()["attributes"]["POSITION"] = json!(99), &["mesh 0", "POSITION", "99"]);
    refused(|file| file.primitive()["attributes"] = json!({}), &["POSITION"]);
    refused(|file| file.primitive()["material"] = json!(5), &["meshes[0].primitives[0].material"]);
    for (semantic, kind, values) in [
        ("NORMAL", "VEC3", vec![0.0, 0.0, 1.0, f32::NAN, 0.0, 1.0, 0.0, 0.0, 1.0]),
        ("TEXCOORD_0", "VEC2", vec![0.0, 0.0, f32::INFINITY, 0.0, 1.0, 0.0]),
        ("POSITION", "VEC3", vec![0.0, 0.0, 1.0, 0.0, f32::NAN, 1.0, 0.0, 0.0, 1.0]),
    ] {
        refused(
            |file| {
                let accessor = file.floats(kind, &values);
                file.primitive()["attributes"][semantic] = json!(accessor);
            },
            &["mesh 0", "primitive 0", semantic, "element 1"],
        );
    }
    refused(
        |file| {
            let accessor = file.floats("VEC2", &[0.0; 4]);
            file.primitive()["attributes"]["TEXCOORD_0"] = json!(accessor);
        },
        &["TEXCOORD_0", "2 elements", "POSITION has 3"],
    );
    refused(
        |file| {
            let huge = file.floats("VEC3", &[-3e38, 0.0, 0.0, 3e38, 0.0, 0.0, 0.0, 3e38, 0.0]);
            file.primitive()["attributes"]["POSITION"] = json!(huge);
        },
        &["too far"],
    );
}

#[test]
fn hierarchies_that_are_no_tree() {
    refused(|file| file.json["nodes"][0]["children"] = json!([0]), &["node 0", "cycle"]);
    refused(
        |file| file.json["nodes"] = json!([{"mesh": 0}, {"children": [2]}, {"children": [1]}]),
        &["node 1", "cycle"],
    );
    refused(
        |file| file.json["nodes"] = json!([{"children": [2]}, {"children": [2]}, {"mesh": 0, "name": "leaf"}]),
        &["node 2 \"leaf\"", "nodes 0 and 1"],
    );
    refused(|file| file.json["nodes"] = json!([{"children": [1, 1]}, {}]), &["node 1", "one parent"]);
    refused(|file| file.json["scenes"][0]["nodes"] = json!([0, 0]), &["node 0", "twice"]);
    refused(|file| file.json["scenes"][0]["nodes"] = json!([7]), &["scenes[0].nodes[0]"]);
    refused(|file| file.json["nodes"][0]["children"] = json!([7]), &["nodes[0].children[0]"]);
    refused(|file| file.json["nodes"][0]["rotation"] = json!([0, 0, 0, 0]), &["node 0", "rotation"]);
    refused(|file| file.json["nodes"][0]["scale"] = json!([1e300, 1, 1]), &["node 0", "scale"]);
    refused(|file| file.json["nodes"][0]["matrix"] = json!(vec![1; 16]), &["node 0", "affine"]);
    let far = json!([{"scale": [1e30, 1, 1], "children": [1]}, {"scale": [1e30, 1, 1], "mesh": 0}]);
    refused(|file| file.json["nodes"] = far, &["node 1", "32-bit floats"]);
}

#[test]
fn uris_that_lead_nowhere_or_outside() {
    for (uri, words) in [
        ("gone.bin", &["buffer 0", "gone.bin", "no such file"][..]),
        ("../secret.bin", &["buffer 0", "leaves the scene's folder"]),
        ("%2e%2e/secret.bin", &["leaves the scene's folder"]),
        ("/etc/passwd", &["buffer 0", "absolute"]),
        ("https://example.org/a.bin", &["buffer 0", "scheme"]),
        ("data:;base64,A*==", &["buffer 0", "base64"]),
        ("data:;base64,AAAA", &["buffer 0", "3 are there"]),
    ] {
        refused(|file| file.json["buffers"] = json!([{"byteLength": 36, "uri": uri}]), words);
    }
    refused(|file| file.json["buffers"] = json!([{"byteLength": 36}, {"byteLength": 1}]), &["buffer 1", "no uri"]);
    let mut json = GltfFile::triangle().json;
    json["buffers"] = json!([{"byteLength": 36}]);
    expect(&load_bytes("a.gltf", json.to_string().as_bytes()).unwrap_err(), "a.gltf", &["buffer 0", "no binary chunk"]);
    json["buffers"] = json!([{"byteLength": 36, "uri": "short.bin"}]);
    let (_folder, path) = write(&[("a.gltf", json.to_string().as_bytes()), ("short.bin", &[0; 35])]);
    expect(&gltf::load(&path).unwrap_err(), "a.gltf", &["buffer 0", "36 bytes", "35 are there"]);
}

#[test]
fn extensions_that_are_required_and_unknown() {
    let required = json!(["KHR_lights_punctual", "KHR_draco_mesh_compression"]);
    refused(|file| file.json["extensionsRequired"] = required, &["KHR_draco_mesh_compression", "handled are"]);
}

/// A material that shows image 0, which is `image`.
fn with_image(file: &mut GltfFile, image: Value) {
    file.push("images", image);
    file.push("textures", json!({"source": 0}));
    file.push("materials", json!({"name": "paint", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
}

#[test]
fn images_and_materials_that_cannot_be_shown() {
    let embedded = |bytes: &'static [u8]| {
        move |file: &mut GltfFile| {
            let view = file.view(bytes);
            with_image(file, json!({"bufferView": view, "mimeType": "image/png", "name": "wood"}));
        }
    };
    refused(embedded(b"GIF89a"), &["image 0 \"wood\"", "neither PNG nor JPEG"]);
    refused(embedded(b"\x89PNG\r\n\x1a\n"), &["image 0 \"wood\"", "cannot be decoded"]);
    // A header that claims 100,000 x 100,000 pixels.
    let bomb = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\x01\x86\xa0\0\x01\x86\xa0\x08\x06\0\0\0";
    refused(
        |file| {
            let mut bytes = bomb.to_vec();
            bytes.extend(crc32(&bomb[12..]).to_be_bytes());
            bytes.extend(b"\0\0\0\0IDAT");
            bytes.extend(crc32(b"IDAT").to_be_bytes());
            let view = file.view(&bytes);
            with_image(file, json!({"bufferView": view, "mimeType": "image/png"}));
        },
        &["image 0", "100000x100000", "16384"],
    );
    refused(|file| with_image(file, json!({"uri": "gone.png"})), &["image 0 \"gone.png\"", "no such file"]);
    refused(|file| with_image(file, json!({"name": "void"})), &["image 0 \"void\"", "neither a uri nor"]);
    refused(|file| with_image(file, json!({"bufferView": 9})), &["images[0].bufferView"]);
    let metal = json!({"name": "gold", "pbrMetallicRoughness": {"metallicFactor": 1e300}});
    let gold = |file: &mut GltfFile| {
        file.push("materials", metal);
    };
    refused(gold, &["material 0 \"gold\"", "metallicFactor"]);
}

/// PNG's checksum, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0u32, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)))
}

#[test]
fn lights_and_cameras_with_impossible_numbers() {
    let light = |light: Value| {
        move |file: &mut GltfFile| {
            file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
            file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
        }
    };
    refused(light(json!({"type": "point", "name": "lamp", "intensity": -1})), &["light 0 \"lamp\"", "intensity"]);
    refused(light(json!({"type": "point", "range": 0})), &["light 0", "range"]);
    refused(light(json!({"type": "spot"})), &["lights[0].spot"]);
    let spot = json!({"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}});
    refused(light(spot), &["light 0", "cone angles"]);
    refused(light(json!({"type": "laser"})), &["lights[0].type"]);
    refused(
        |file| {
            file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
        },
        &["nodes[1]"],
    );

    let camera = |camera: Value| {
        move |file: &mut GltfFile| {
            file.push("cameras", camera);
            file.root(json!({"camera": 0}));
        }
    };
    let view = json!({"yfov": 4.0, "znear": 0.1});
    refused(
        camera(json!({"type": "perspective", "perspective": view, "name": "eye"})),
        &["camera 0 \"eye\"", "yfov 4"],
    );
    refused(camera(json!({"type": "orthographic", "perspective": view})), &["camera 0", "projection"]);
    let flat = json!({"xmag": 1, "ymag": 0, "znear": 0, "zfar": 1});
    refused(camera(json!({"type": "orthographic", "orthographic": flat})), &["camera 0", "ymag 0"]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever a few changed bytes make of a file, it loads or is refused; it does not panic.
    #[test]
    fn changed_bytes_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)) {
        let mut file = GltfFile::triangle();
        let indices = file.indices(U16, &[0, 1, 2]);
        file.primitive()["indices"] = json!(indices);
        let normals = file.push("accessors", json!({
            "componentType": F32, "count": 3, "type": "VEC3",
            "sparse": {"count": 1, "indices": {"bufferView": 1, "componentType": U8}, "values": {"bufferView": 0}},
        }));
        file.primitive()["attributes"]["NORMAL"] = json!(normals);
        file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
        file.root(json!({"camera": 0, "rotation": [0.0, 0.0, 0.0, 1.0]}));
        let mut bytes = file.glb();
        for (place, value) in changes {
            let place = place.index(bytes.len());
            // Digits stay digits in half of the cases, so that numbers go wrong and not only the syntax.
            bytes[place] = if bytes[place].is_ascii_digit() && value < 128 { b'0' + value % 10 } else { value };
        }
        if let Err(error) = load_bytes("scene.glb", &bytes) {
            prop_assert_eq!(error.exit_code(), 2);
        }
    }
}

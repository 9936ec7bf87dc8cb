//! `scene inspect` and `scene export` from outside, and what an exported scene is when it is read back.

use crate::support::gltf_file::{GltfFile, U8};
use crate::support::program::Program;
use crate::support::watched::Watched;
use glam::Vec3;
use quincunx::scene::procedural::{self, ProceduralScene};
use quincunx::scene::{self, Scene, glb, gltf};
use quincunx::scene::{AnimationChoice, LightKind, Texture};
use serde_json::{Value, json};

fn inspected(program: &Program, scene: &str) -> Value {
    program.run(&["scene", "inspect", scene, "--json"]).fine().json()
}

/// A file with one of everything that is counted.
fn rich() -> GltfFile {
    let mut file = GltfFile::triangle();
    file.json["asset"]["generator"] = json!("by hand");
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_sheen"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}, {"type": "directional"}]}});
    file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}}));
    file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 1}}}));
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}, "name": "eye"}));
    file.root(json!({"camera": 0}));
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbaImage::new(3, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let shown = file.view(&png.into_inner());
    let broken = file.view(b"no picture");
    file.json["images"] = json!([
        {"bufferView": shown, "mimeType": "image/png", "name": "grain"},
        {"bufferView": broken, "mimeType": "image/png"},
    ]);
    file.json["textures"] = json!([{"source": 0}, {"source": 1}]);
    file.push("materials", json!({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    file.push("materials", json!({"alphaMode": "MASK"}));
    file.push("materials", json!({"emissiveFactor": [1, 0, 0]}));
    file.primitive()["material"] = json!(0);
    let times = file.floats("SCALAR", &[0.0, 2.5]);
    let places = file.floats("VEC3", &[0.0; 6]);
    file.push(
        "animations",
        json!({
            "name": "wave",
            "samplers": [{"input": times, "output": places}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
        }),
    );
    file
}

#[test]
fn inspect_counts_what_a_file_holds() {
    let program = Program::new();
    let path = program.path("rich.glb");
    let bytes = rich().glb();
    std::fs::write(&path, &bytes).unwrap();
    let found = inspected(&program, &path);
    assert_eq!(found["schema"], 1);
    assert_eq!((&found["triangles"], &found["vertices"], &found["draws"]), (&json!(1), &json!(3), &json!(1)));
    assert_eq!((&found["meshes"], &found["normal_groups"]), (&json!(1), &json!(1)));
    assert_eq!(found["closed_meshes"], 0);
    assert_eq!(found["materials"], json!({"opaque": 1, "mask": 1, "blend": 1}));
    assert_eq!(found["emissive_materials"], 1);
    assert_eq!(found["lights"], json!({"directional": 1, "point": 1, "spot": 0}));
    assert_eq!(found["cameras"], json!([{"name": "eye", "kind": "perspective"}]));
    assert_eq!(found["bounds"], json!({"min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.0]}));
    let file = &found["file"];
    assert_eq!(file["bytes"], bytes.len());
    assert_eq!((&file["generator"], &file["version"]), (&json!("by hand"), &json!("2.0")));
    assert_eq!(file["extensions_used"], json!(["KHR_lights_punctual", "KHR_materials_sheen"]));
    assert_eq!(file["extensions_required"], json!([]));
    for (key, count) in [("scenes", 1), ("nodes", 4), ("meshes", 1), ("primitives", 1), ("textures", 2), ("skins", 0)] {
        assert_eq!(file[key], count, "{key}");
    }
    assert_eq!(
        file["images"],
        json!([
            {"name": "grain", "format": "PNG", "width": 3, "height": 2},
            {"name": "image 1", "format": null},
        ])
    );
    assert_eq!(file["animations"], json!([{"name": "wave", "channels": 1, "duration_s": 2.5}]));
    let warnings: Vec<&str> = found["warnings"].as_array().unwrap().iter().map(|one| one.as_str().unwrap()).collect();
    assert!(warnings.iter().any(|warning| warning.contains("KHR_materials_sheen")), "{warnings:?}");

    let text = program.run(&["scene", "inspect", &path]).fine().out;
    for words in [
        "by hand",
        "1 triangles in 1 draws",
        "1 meshes, 0 of them closed, 1 normal groups",
        "grain, 3x2 PNG",
        "wave, 2.5 s, 1 channels",
        "KHR_materials_sheen",
    ] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn external_files_count_and_built_in_scenes_have_no_file() {
    let program = Program::new();
    let mut file = GltfFile::triangle();
    file.json["buffers"] = json!([{"byteLength": file.bytes.len(), "uri": "leaf.bin"}]);
    let text = file.json.to_string();
    std::fs::write(program.path("leaf.gltf"), &text).unwrap();
    std::fs::write(program.path("leaf.bin"), &file.bytes).unwrap();
    assert_eq!(inspected(&program, &program.path("leaf.gltf"))["file"]["bytes"], text.len() + file.bytes.len());

    let found = inspected(&program, "lamps:objects=12,lights=7");
    assert_eq!((&found["file"], &found["draws"]), (&Value::Null, &json!(13)));
    assert_eq!(found["lights"]["point"], 7);
    // Five walls, two blocks with a top and four sides each, a panel; walls do not touch as meshes.
    assert_eq!(inspected(&program, "cornell")["normal_groups"], 16);
    // All but the ground.
    assert_eq!(found["closed_meshes"], found["meshes"].as_u64().unwrap() - 1);
    let same = inspected(&program, "lamps:objects=12,lights=7");
    assert_eq!(found["hash"], same["hash"]);
}

#[test]
fn a_broken_file_is_refused_as_render_refuses_it() {
    let program = Program::new();
    let mut broken = GltfFile::triangle();
    let indices = broken.indices(U8, &[0, 1, 7]);
    broken.primitive()["indices"] = json!(indices);
    let path = program.path("broken.glb");
    std::fs::write(&path, broken.glb()).unwrap();
    program.fails(&["scene", "inspect", &path], 2, &["broken.glb", "vertex 7"]);
    let [inspect, render] = [["scene", "inspect", &path].as_slice(), &["render", &path]].map(|run| program.run(run));
    assert_eq!((inspect.code, inspect.err), (render.code, render.err));
    program.fails(&["scene", "inspect", "teapot.obj"], 2, &["neither a built-in scene"]);
    program.fails(&["scene", "inspect", "lamps:lights=5001"], 2, &["0 to 5000"]);
}

#[test]
fn export_writes_a_whole_glb_or_nothing() {
    let program = Program::new();
    let path = program.path("box.glb");
    let said = program.run(&["scene", "export", "cornell", "-o", &path]).fine().out;
    assert!(said.contains("38 triangles"), "{said}");
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(bytes, encoded("cornell"));
    assert_eq!(inspected(&program, &path)["triangles"], 38);
    let other = program.path("other.glb");
    program.run(&["scene", "export", "lamps:objects=3,lights=2", "-o", &other, "--seed", "9"]).fine();
    assert_ne!(std::fs::read(&other).unwrap(), encoded("lamps:objects=3,lights=2"));

    for (arguments, words) in [
        (["cornell", "-o", "box.gltf"], ["box.gltf", "written as .glb"]),
        (["cornell", "-o", "box"], ["box", "written as .glb"]),
        (["cornell", "-o", "missing/box.glb"], ["missing", "no folder"]),
        (["teapot", "-o", "teapot.glb"], ["teapot", "built-in scenes: cornell"]),
        (["lamps:lights=5001", "-o", "dark.glb"], ["lights=5001", "0 to 5000"]),
    ] {
        let [scene, flag, file] = arguments;
        program.fails(&["scene", "export", scene, flag, file], 2, &words);
    }
}

/// The bytes of a built-in scene of seed 1.
fn encoded(spec: &str) -> Vec<u8> {
    let ProceduralScene { scene, motions } = procedural::open(spec, 1).unwrap().unwrap();
    glb::encode(&scene, &motions).unwrap()
}

/// The scene, written and read.
fn read_back(spec: &str) -> (Scene, Scene) {
    let made = scene::load(spec, 1).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    std::fs::write(&path, encoded(spec)).unwrap();
    let read = gltf::load(&path).unwrap();
    (made, read)
}

/// What a reader makes unit length again may have another last bit.
const UNIT: f32 = 3e-7;

fn uses_texture(scene: &Scene, material: usize) -> bool {
    scene::TextureSlot::ALL.into_iter().any(|slot| scene.materials[material].texture(slot).is_some())
}

#[test]
fn what_is_read_back_is_what_was_written() {
    for spec in
        ["cornell", "lamps:objects=40,lights=30", "hall:triangles=20000", "fence:alpha=mask", "chess:triangles=12000"]
    {
        let (made, read) = read_back(spec);
        let textured: Vec<bool> = (0..read.materials.len()).map(|material| uses_texture(&read, material)).collect();
        assert_eq!(read.warnings, [] as [&str; 0], "{spec}");
        assert_eq!(read.meshes.len(), made.meshes.len());
        for (made, read) in made.meshes.iter().zip(&read.meshes) {
            assert_eq!((&made.name, made.material), (&read.name, read.material));
            assert_eq!(made.indices.len(), read.indices.len(), "{spec}: {}", made.name);
            // Corner by corner: a reader drops vertices that no triangle uses.
            for (made_vertex, read_vertex) in made.indices.iter().zip(&read.indices) {
                let (from, to) = (*made_vertex as usize, *read_vertex as usize);
                assert_eq!(made.positions[from], read.positions[to], "{spec}: {}", made.name);
                assert!(made.normals[from].abs_diff_eq(read.normals[to], UNIT), "{spec}: {}", made.name);
                let tangents = (made.tangents.get(from).copied().unwrap_or_default(), read.tangents[to]);
                assert!(tangents.0.abs_diff_eq(tangents.1, UNIT), "{spec}: {}: {tangents:?}", made.name);
                let atlas = if textured[read.material] {
                    assert_eq!(made.uvs[from], read.uvs[to], "{spec}: {}", made.name);
                    &read.atlas
                } else {
                    &read.uvs
                };
                assert_eq!(made.atlas[from], atlas[to], "{spec}: {}", made.name);
            }
        }
        assert_eq!(made.draws.len(), read.draws.len());
        for (made, read) in made.draws.iter().zip(&read.draws) {
            assert_eq!((made.mesh, made.world_from_object), (read.mesh, read.world_from_object));
        }
        for (made_material, read_material) in made.materials.iter().zip(&read.materials) {
            // Textures may be numbered in another order.
            let textures = |scene: &Scene, material: &quincunx::scene::Material| {
                scene::TextureSlot::ALL.map(|slot| {
                    material.texture(slot).map(|index| {
                        let Texture { image, sampler, color_space } = scene.textures[index];
                        (scene.images[image].name.clone(), scene.images[image].rgba8.clone(), sampler, color_space)
                    })
                })
            };
            assert!(textures(&made, made_material) == textures(&read, read_material), "{}", made_material.name);
            let factors = |one: &quincunx::scene::Material| {
                let one = one.clone();
                (one.name, one.base_color, one.metallic, one.roughness, one.emissive, one.alpha, one.double_sided)
            };
            assert_eq!(factors(made_material), factors(read_material), "{spec}");
        }
        assert_eq!(made.lights.len(), read.lights.len());
        for (made, read) in made.lights.iter().zip(&read.lights) {
            assert_eq!((&made.name, made.intensity, made.position), (&read.name, read.intensity, read.position));
            assert_eq!((made.kind, made.range), (read.kind, read.range));
            assert!(made.kind == LightKind::Point || made.direction.abs_diff_eq(read.direction, UNIT));
        }
        for (made, read) in made.cameras.iter().zip(&read.cameras) {
            assert_eq!((&made.name, made.projection), (&read.name, read.projection));
            assert!(made.world_from_view.abs_diff_eq(read.world_from_view, UNIT), "{spec}");
        }
    }
}

/// Draws and cameras, along splines and turning: a file of them moves as the scene does.
#[test]
fn what_moves_in_a_scene_moves_in_its_file() {
    for spec in ["chess:triangles=12000", "arena:triangles=60000"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.glb");
        std::fs::write(&path, encoded(spec)).unwrap();
        let made = scene::open(spec, 1, &AnimationChoice::All).unwrap();
        let read = gltf::Model::open(&path, &AnimationChoice::All).unwrap();
        let rest = made.pose(0.0).unwrap();
        for time_s in [0.0, 0.3, 1.75, 16.9, 44.4, 60.0, 70.0] {
            let [made, read] = [made.pose(time_s).unwrap(), read.pose(time_s).unwrap()];
            let places = |scene: &Scene| scene.draws.iter().map(|draw| draw.world_from_object).collect::<Vec<_>>();
            assert_eq!(places(&made), places(&read), "{spec}, {time_s} s");
            assert_eq!(places(&made) == places(&rest), time_s % 60.0 == 0.0 || time_s > 60.0, "{spec}, {time_s} s");
            assert_eq!(made.cameras.len(), read.cameras.len(), "{spec}");
            for (made, read) in made.cameras.iter().zip(&read.cameras) {
                assert!(made.world_from_view.abs_diff_eq(read.world_from_view, 4e-7), "{spec}: {}", made.name);
            }
        }
    }
}

#[test]
fn an_exported_animation_turns_as_the_scene_does() {
    let spec = "fence:lights=9";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fence.glb");
    std::fs::write(&path, encoded(spec)).unwrap();
    let made = scene::open(spec, 1, &AnimationChoice::All).unwrap();
    let read = gltf::Model::open(&path, &AnimationChoice::All).unwrap();
    let places = |scene: Scene| scene.draws.iter().map(|draw| draw.world_from_object).collect::<Vec<_>>();
    let rest = places(made.pose(0.0).unwrap());
    for (time_s, moved) in [(0.0, 0), (0.7, 1), (3.0, 1), (59.9, 1), (100.0, 1)] {
        let [made, read] = [places(made.pose(time_s).unwrap()), places(read.pose(time_s).unwrap())];
        assert_eq!(made, read, "{time_s} s");
        assert_eq!(made.iter().zip(&rest).filter(|(now, rest)| now != rest).count(), moved, "{time_s} s");
    }
    let still = scene::open(spec, 1, &AnimationChoice::None).unwrap();
    assert_eq!(places(still.pose(0.7).unwrap()), rest);
    assert_eq!(scene::open(spec, 1, &AnimationChoice::One("door".to_owned())).unwrap_err().exit_code(), 2);
}

#[test]
fn an_exported_lamp_moves_as_the_scenes_does() {
    let spec = "cornell:motion=on";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cornell.glb");
    std::fs::write(&path, encoded(spec)).unwrap();
    let made = scene::open(spec, 1, &AnimationChoice::All).unwrap();
    let read = gltf::Model::open(&path, &AnimationChoice::All).unwrap();
    let mut places = Vec::new();
    for time_s in [0.0, 0.7, 3.0] {
        let [made, read] = [made.pose(time_s).unwrap(), read.pose(time_s).unwrap()];
        let [lamp, panel] = [read.lights[0].position, read.draws[7].world_from_object.w_axis.truncate()];
        assert_eq!(made.lights[0].position, lamp, "{time_s} s");
        assert_eq!(made.draws[7].world_from_object.w_axis.truncate(), panel, "{time_s} s");
        places.push(lamp);
    }
    assert!(places[0].distance(places[1]) > 0.5 && places[1].distance(places[2]) > 0.5, "{places:?}");
}

/// The box's camera and normals lie along the axes, where making unit length changes nothing: the same bits. The others'
/// last bits move a normal by one of its 65535 steps here and there, or an edge into another pixel.
#[test]
fn an_exported_scene_gives_the_same_picture() {
    for (spec, most_pixels) in
        [("cornell", 0), ("lamps:objects=40,lights=30", 10), ("hall:triangles=20000", 10), ("fence", 10)]
    {
        let (made, read) = read_back(spec);
        let changes = [("size", "160x90"), ("vpls", "64")];
        let [made, read] = [made, read].map(|scene| {
            Watched::with_scene(scene)
                .picture("interleaved_deferred", &changes)
                .pixels
                .into_iter()
                .map(Vec3::from_array)
        });
        let far = made.zip(read).filter(|(made, read)| {
            // One step of a normal turns it by 3e-5; a lamp nearby and GGX's peak make at most a few hundred times that
            // of it.
            let bound = if most_pixels == 0 { 0.0 } else { 0.01 * made.max_element().max(0.1) };
            (*made - *read).abs().max_element() > bound
        });
        let far_count = far.count();
        println!("{spec}: {far_count} pixels differ");
        assert!(far_count <= most_pixels, "{spec}: {far_count} pixels differ");
    }
}

//! Large input: a generated scene of many triangles, draws, lights and textures, drawn within the heap of the reference
//! driver and within a bound of memory: twice the scene on the host (itself, and what is made of it on the way), three
//! times where the device's memory is the host's too (there textures stand once more, with their coarser levels).
//!
//! QUINCUNX_LARGE=full draws a million triangles, 5,000 draws, 2,000 lights and 200 textures of 1024 px; without it all
//! of that is smaller.

use crate::support::gltf_file::{GltfFile, U32};
use crate::support::program::Program;
use image::{ExtendedColorType, ImageEncoder};
use quincunx::memory::pool::SHARED_BLOCK_BYTES;
use quincunx::scene::gltf;
use serde_json::json;

/// What a scene is built of.
struct Size {
    triangles: usize,
    draws: usize,
    lights: usize,
    textures: usize,
    side_px: u32,
}

const SMALL: Size = Size { triangles: 100_000, draws: 500, lights: 100, textures: 40, side_px: 512 };
const FULL: Size = Size { triangles: 1_000_000, draws: 5_000, lights: 2_000, textures: 200, side_px: 1024 };

/// How much may be taken beside the scene: by the program and the driver's compiler, which take half of it with nothing to
/// draw, and by what a driver bins triangles in.
const ASIDE_BYTES: u64 = 200 << 20;

fn size() -> Size {
    if std::env::var("QUINCUNX_LARGE").as_deref() == Ok("full") { FULL } else { SMALL }
}

/// A picture that packs to a tenth or so: rough, but not noise.
fn picture(side_px: u32, which: u32) -> Vec<u8> {
    let texel = |at: u32| {
        let (x, y) = (at % side_px, at / side_px);
        [x.wrapping_mul(which + 3) >> 3, y >> 2, (x ^ y) >> 4].map(|channel| channel as u8)
    };
    let pixels: Vec<u8> = (0..side_px * side_px).flat_map(texel).collect();
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    encoder.write_image(&pixels, side_px, side_px, ExtendedColorType::Rgb8).unwrap();
    bytes
}

/// `Size::draws` sheets in a square, each with `triangles / draws` triangles under one of the textures, and lights over them.
fn build(size: &Size) -> GltfFile {
    let mut file = GltfFile::empty();
    for texture in 0..size.textures {
        let view = file.view(&picture(size.side_px, texture as u32));
        file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        file.push("textures", json!({"source": texture}));
        file.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}));
    }
    let sides = ((size.triangles / size.draws / 2) as f32).sqrt() as u32;
    let across = (size.draws as f32).sqrt().ceil() as usize;
    for draw in 0..size.draws {
        let (mut positions, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for y in 0..=sides {
            for x in 0..=sides {
                let (u, v) = (x as f32 / sides as f32, y as f32 / sides as f32);
                positions.extend([u, v, 0.2 * (9.0 * u + draw as f32).sin() * (7.0 * v).cos()]);
                uvs.extend([u, v]);
                if x < sides && y < sides {
                    let corner = y * (sides + 1) + x;
                    indices.extend([corner, corner + 1, corner + sides + 1]);
                    indices.extend([corner + 1, corner + sides + 2, corner + sides + 1]);
                }
            }
        }
        let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(positions.len() / 3));
        let (positions, uvs) = (file.floats("VEC3", &positions), file.floats("VEC2", &uvs));
        let indices = file.indices(U32, &indices);
        let attributes = json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs});
        let primitive = json!({"attributes": attributes, "indices": indices, "material": draw % size.textures});
        let mesh = file.push("meshes", json!({"primitives": [primitive]}));
        file.root(json!({"mesh": mesh, "translation": [draw % across, draw / across, 0]}));
    }
    let light = json!({"type": "point", "intensity": 0.5, "range": 2});
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
    for light in 0..size.lights {
        let place = light as f32 * 0.618_034 * across as f32;
        let translation = [place % across as f32, light as f32 / size.lights as f32 * across as f32, 1.0];
        file.root(json!({"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": translation}));
    }
    file
}

#[test]
fn a_large_scene_takes_twice_its_bytes_and_no_more() {
    let size = size();
    let program = Program::new();
    let path = program.path("large.glb");
    std::fs::write(&path, build(&size).glb()).unwrap();
    let scene_bytes = gltf::load(path.as_ref()).unwrap().size_bytes();
    for technique in [&["deferred", "--cull", "tiled"][..], &["interleaved_deferred", "--direct", "none"]] {
        let arguments =
            [&["render", &path, "--size", "320x180", "--json", "-o", "large.png", "--technique"], technique];
        let measured = program.measure(&arguments.concat());
        assert_eq!(measured.ran.code, 0, "{}", measured.ran.err);
        let report = measured.ran.json();
        assert_eq!(report["scene"]["draws"], size.draws);
        let memory = |key: &str| report["memory"][key].as_u64().unwrap();
        let (block_bytes, bound_bytes) = (memory("memory_block_bytes"), memory("allocated_bytes"));
        // On a software driver device memory is the host's too, as far as it is touched: all that is bound is.
        let host_bytes = measured.peak_bytes.saturating_sub(bound_bytes);
        let mib = |bytes: u64| bytes >> 20;
        let text = format!(
            "{}: {} triangles: scene {} MiB, peak {} MiB, of it device memory {} MiB (in memory blocks of {} MiB); {:?} of \
             a processor; texture limit {}",
            technique[0],
            report["scene"]["triangles"],
            mib(scene_bytes),
            mib(measured.peak_bytes),
            mib(bound_bytes),
            mib(block_bytes),
            measured.cpu,
            report["settings"]["texture-limit"],
        );
        println!("{text}");
        assert!(host_bytes <= 2 * scene_bytes + ASIDE_BYTES, "the host alone: {} MiB: {text}", mib(host_bytes));
        assert!(measured.peak_bytes <= 3 * scene_bytes + ASIDE_BYTES, "the whole process: {text}");
        assert!(block_bytes <= bound_bytes / 4 * 5 + SHARED_BLOCK_BYTES, "memory blocks stand empty: {text}");
    }
}

//! What materials and vertices say, from the file to the pixel: each rule against its closed form, or against the twin
//! that the host looks materials up with.

use crate::support::choices::words;
use crate::support::gltf_file::{GltfFile, U8, U16};
use crate::support::square::{matt, picture, square};
use crate::support::watched::{Changes, Watched, both};
use glam::{Affine2, Mat4, Vec2, Vec3, Vec4};
use quincunx::scene::{AlphaMode, ColorSpace, Image, Light, LightKind, Material, Placement, Scene, TextureSlot};
use quincunx::shading::material::{self, MeshPoint};
use serde_json::{Value, json};
use std::sync::Arc;

/// Pixels of a side: a square that fills the picture, so that the pixel's middle says its coordinates.
const SIDE: usize = 32;

/// The G-buffer keeps colours in half floats: half a step, relative.
const HALF: f32 = 1.0 / 2048.0;

/// What the pixels show under ambient light 1 alone: a matt surface its base colour.
const AMBIENT: Changes<'static> = &[("size", "32x32"), ("rig", "none"), ("ambient", "1"), ("brdf", "lambert")];

fn pixels(scene: &Scene, changes: Changes<'_>) -> Vec<Vec3> {
    pixels_of(&Watched::with_scene(scene.clone()), "deferred", &both(AMBIENT, changes))
}

fn pixels_of(watched: &Watched, technique: &str, changes: Changes<'_>) -> Vec<Vec3> {
    watched.picture(technique, changes).pixels.iter().map(|pixel| Vec3::from_array(*pixel)).collect()
}

/// The point of the square under each pixel's middle.
fn points(scene: &Scene) -> impl Iterator<Item = MeshPoint> {
    (0..SIDE * SIDE).map(|pixel| {
        let [x, y] = [pixel % SIDE, pixel / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32);
        // The lower triangle holds corners 0, 1 and 2, the upper one 0, 2 and 3.
        let up = 1.0 - y;
        match up <= x {
            true => MeshPoint::on(&scene.meshes[0], [0, 1, 2], [1.0 - x, x - up, up]),
            false => MeshPoint::on(&scene.meshes[0], [0, 2, 3], [1.0 - up, x, up - x]),
        }
    })
}

fn require_near(found: Vec3, expected: Vec3, bound: f32, what: &str) {
    assert!((found - expected).abs().max_element() <= bound, "{what}: {found} for {expected}");
}

#[test]
fn vertex_colours_of_every_type_are_read() {
    let rgb: [[f32; 3]; 3] = [[1.0, 0.0, 0.2], [0.4, 1.0, 0.6], [0.0, 0.8, 1.0]];
    for alpha in [false, true] {
        let flat: Vec<f32> = rgb.iter().flat_map(|color| color.iter().copied().chain(alpha.then_some(0.4))).collect();
        let kind = if alpha { "VEC4" } else { "VEC3" };
        for component_type in [U8, U16, 5126] {
            let mut file = GltfFile::triangle();
            let stride = if alpha { 4 } else { 3 } * if component_type == U16 { 2 } else { 1 };
            let accessor = if component_type == 5126 {
                file.floats(kind, &flat)
            } else {
                // glTF 2.0, section 3.6.2.4: each vertex begins at a multiple of 4 bytes.
                let mut bytes = Vec::new();
                for color in flat.chunks(if alpha { 4 } else { 3 }) {
                    for value in color {
                        match component_type {
                            U8 => bytes.push((value * 255.0).round() as u8),
                            _ => bytes.extend(((value * 65535.0).round() as u16).to_le_bytes()),
                        }
                    }
                    bytes.resize(bytes.len().next_multiple_of(4), 0xee);
                }
                let view = file.view(&bytes);
                file.json["bufferViews"][view]["byteStride"] = json!(usize::next_multiple_of(stride, 4));
                file.push(
                    "accessors",
                    json!({"bufferView": view, "componentType": component_type, "normalized": true, "count": 3,
                        "type": kind}),
                )
            };
            file.primitive()["attributes"]["COLOR_0"] = json!(accessor);
            let scene = file.load().unwrap();
            assert_eq!(scene.warnings, [] as [&str; 0]);
            for (found, rgb) in scene.meshes[0].colors.iter().zip(rgb) {
                let expected = Vec3::from_array(rgb).extend(if alpha { 0.4 } else { 1.0 });
                assert!((*found - expected).abs().max_element() < 1e-5, "{component_type} {kind}: {found}");
            }
            assert_eq!(scene.meshes[0].colors.len(), 3);
        }
    }
}

#[test]
fn colours_beyond_their_range_are_clamped_and_white_ones_dropped() {
    let mut file = GltfFile::triangle();
    let colors = file.floats("VEC3", &[2.0, 0.5, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]);
    file.primitive()["attributes"]["COLOR_0"] = json!(colors);
    let scene = file.load().unwrap();
    assert_eq!(scene.meshes[0].colors[0], Vec4::new(1.0, 0.5, 0.0, 1.0));
    assert_eq!(scene.warnings, ["1 vertex colour is clamped to 0 to 1"]);
    let white = file.floats("VEC3", &[1.0; 9]);
    file.primitive()["attributes"]["COLOR_0"] = json!(white);
    assert!(file.load().unwrap().meshes[0].colors.is_empty());
    let two = file.floats("VEC3", &[1.0; 6]);
    file.primitive()["attributes"]["COLOR_0"] = json!(two);
    let message = file.load().unwrap_err().to_string();
    assert!(message.contains("COLOR_0") && message.contains("2 elements, but POSITION has 3"), "{message}");
}

#[test]
fn a_vertex_colour_multiplies_the_base_colour() {
    let mut scene = square(matt(Vec4::new(0.5, 1.0, 0.25, 1.0)));
    scene.meshes[0].colors = vec![Vec4::ONE, Vec4::new(0.0, 1.0, 0.5, 1.0), Vec4::ONE, Vec4::new(1.0, 0.0, 0.0, 1.0)];
    for (found, point) in pixels(&scene, &[]).into_iter().zip(points(&scene)) {
        let expected = point.color.truncate() * Vec3::new(0.5, 1.0, 0.25);
        require_near(found, expected, HALF, "the product");
    }
}

#[test]
fn a_vertex_alpha_cuts_holes_and_blends() {
    let fading = vec![Vec4::ONE, Vec4::new(1.0, 1.0, 1.0, 0.0), Vec4::new(1.0, 1.0, 1.0, 0.0), Vec4::ONE];
    let mut scene = square(Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, ..matt(Vec4::ONE) });
    scene.meshes[0].colors = fading;
    let background = ("background", "0.25");
    for (index, found) in pixels(&scene, &[background]).into_iter().enumerate() {
        let expected = if index % SIDE < SIDE / 2 { 1.0 } else { 0.25 };
        require_near(found, Vec3::splat(expected), HALF, "MASK");
    }
    scene.materials[0].alpha = AlphaMode::Blend;
    for (found, point) in pixels(&scene, &[background]).into_iter().zip(points(&scene)) {
        let expected = point.color.w + 0.25 * (1.0 - point.color.w);
        require_near(found, Vec3::splat(expected), 1e-5, "BLEND");
    }
}

/// Each texture through another placement; the twin says what each pixel shows.
#[test]
fn textures_are_read_where_they_are_placed() {
    let mut scene = square(matt(Vec4::ONE));
    scene.meshes[0].uvs_1 = scene.meshes[0].uvs.iter().map(|uv| 0.5 * *uv + 0.125).collect();
    let steps: Vec<[u8; 4]> = (0..16u8).map(|texel| [texel * 16, 255 - texel * 16, texel * 3, 255]).collect();
    let base_color = picture(&mut scene, 4, &steps, ColorSpace::Srgb);
    let linear = picture(&mut scene, 4, &steps, ColorSpace::Linear);
    let glow = picture(&mut scene, 2, &[[255, 0, 0, 255], [0, 0, 255, 255]], ColorSpace::Srgb);
    let placement = |uv_set, scale: [f32; 2], turn, shift: [f32; 2]| Placement {
        uv_set,
        picture_from_uv: Affine2::from_scale_angle_translation(scale.into(), turn, shift.into()),
    };
    let material = &mut scene.materials[0];
    material.base_color_texture = Some(base_color);
    material.metallic = 1.0;
    material.metallic_roughness_texture = Some(linear);
    material.emissive = Vec3::splat(0.5);
    material.emissive_texture = Some(glow);
    material.placements[TextureSlot::BaseColor as usize] = placement(1, [1.5, -0.75], 0.6, [0.3, 0.1]);
    material.placements[TextureSlot::MetallicRoughness as usize] = placement(0, [0.5, 0.5], -0.3, [0.0, 0.4]);
    material.placements[TextureSlot::Emissive as usize] = placement(1, [1.0, 1.0], 1.2, [0.0, 0.0]);
    let (zoomed, material) = (nearest(&scene), &scene.materials[0]);
    let mut on_edges = 0;
    for (found, point) in pixels(&scene, &[]).into_iter().zip(points(&scene)) {
        // Lambert under ambient light 1: the part that is no metal, and the emission.
        let moved = |by: Vec2| {
            let point = MeshPoint { uvs: point.uvs.map(|uv| uv + by), ..point };
            material::albedo_at(&zoomed, material, &point) + material::emissive_at(&zoomed, material, &point)
        };
        // At a texel's edge the twin changes within a little step, and the device may take either side.
        let expected = moved(Vec2::ZERO);
        let changes = |step: Vec2| (moved(2e-3 * step) - expected).abs().max_element() > 1e-4;
        if [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y].into_iter().any(changes) {
            on_edges += 1;
            continue;
        }
        // The 8 bits of metalness, the sRGB decoder's, and half floats.
        require_near(found, expected, 1.0 / 255.0, "base colour, metalness and emission");
    }
    assert!(on_edges < SIDE * SIDE / 4, "{on_edges} pixels lie on the edge of a texel");
}

/// The scene with each texel of its images 64 texels wide: filtered far from its edges it is the nearest one.
fn nearest(scene: &Scene) -> Scene {
    const ZOOM: u32 = 64;
    let zoom = |image: &Arc<Image>| {
        let (width, height) = (image.width * ZOOM, image.height * ZOOM);
        let texel = |at: u32| {
            let (x, y) = (at % width / ZOOM, at / width / ZOOM);
            let start = 4 * (y * image.width + x) as usize;
            image.rgba8[start..start + 4].to_vec()
        };
        let rgba8 = (0..width * height).flat_map(texel).collect();
        Image { name: String::new(), width, height, rgba8 }.into()
    };
    Scene { images: scene.images.iter().map(zoom).collect(), textures: scene.textures.clone(), ..Scene::default() }
}

#[test]
fn occlusion_darkens_ambient_light_and_no_other() {
    let mut scene = square(matt(Vec4::ONE));
    let texture = picture(&mut scene, 2, &[[0, 255, 255, 255], [102, 0, 0, 255]], ColorSpace::Linear);
    scene.materials[0].occlusion_texture = Some(texture);
    scene.lights = vec![Light {
        name: String::new(),
        kind: LightKind::Directional,
        intensity: Vec3::splat(std::f32::consts::PI),
        position: Vec3::ZERO,
        direction: Vec3::NEG_Z,
        range: None,
        radius: 0.0,
    }];
    for strength in [0.0, 0.6, 1.0] {
        scene.materials[0].occlusion_strength = strength;
        for alpha in [AlphaMode::Opaque, AlphaMode::Blend] {
            scene.materials[0].alpha = alpha;
            let watched = Watched::with_scene(scene.clone());
            // Path tracing reads the map where no ray finds the occluders that it describes.
            let traced = [("spp", "4"), ("transport", "direct"), ("ambient-visibility", "off")];
            for (technique, changes) in [("deferred", &[("direct-shadow", "none")][..]), ("path_traced", &traced)] {
                for (index, found) in pixels_of(&watched, technique, &both(AMBIENT, changes)).into_iter().enumerate() {
                    let texel = if index % SIDE < SIDE / 2 { 0.0 } else { 0.4 };
                    // The sun alone gives pi / pi. Strength and what is left of the light are 255ths.
                    let expected = 1.0 + (1.0 + strength * (texel - 1.0));
                    require_near(found, Vec3::splat(expected), 1.0 / 255.0, &format!("sun and ambient by {technique}"));
                }
            }
            for found in pixels_of(&watched, "path_traced", &both(AMBIENT, &traced[..2])) {
                require_near(found, Vec3::splat(2.0), 1e-3, "ambient light that rays find");
            }
        }
    }
}

#[test]
fn an_unlit_surface_shows_its_colour_and_takes_no_light() {
    let color = Vec4::new(0.9, 0.5, 0.1, 0.5);
    let unlit = Material { unlit: true, dielectric_f0: 0.0, ..matt(color) };
    let mut scene = square(unlit);
    scene.lights = vec![Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: Vec3::splat(9.0),
        position: Vec3::new(0.3, 0.2, 0.1),
        direction: Vec3::NEG_Z,
        range: None,
        radius: 0.0,
    }];
    for brdf in words("deferred", "brdf") {
        for (alpha, bound) in [(AlphaMode::Opaque, HALF), (AlphaMode::Blend, 1e-6)] {
            scene.materials[0].alpha = alpha;
            let expected = color.truncate() * if alpha == AlphaMode::Blend { 0.5 } else { 1.0 };
            for found in pixels(&scene, &[("brdf", brdf)]) {
                require_near(found, expected, bound, brdf);
            }
        }
    }
    // It sends nothing on: no virtual point light lies on it, and it is no emitter.
    scene.materials[0].alpha = AlphaMode::Opaque;
    let watched = Watched::with_scene(scene);
    let renderer = watched.render("interleaved_deferred", &[("size", "32x32"), ("emissive", "on"), ("vpls", "16")]);
    assert_eq!(renderer.counters["vpls_found"], 0.0);
    for found in renderer.picture().unwrap().pixels {
        require_near(Vec3::from_array(found), color.truncate(), HALF, "interleaved");
    }
}

#[test]
fn an_index_of_refraction_sets_the_reflection_at_normal_incidence() {
    for ior in [1.0f32, 1.33, 1.5, 2.42] {
        let mut file = GltfFile::triangle();
        file.push("materials", json!({"extensions": {"KHR_materials_ior": {"ior": ior}}}));
        file.primitive()["material"] = json!(0);
        let f0 = file.load().unwrap().materials[0].dielectric_f0;
        let ratio = (ior - 1.0) / (ior + 1.0);
        assert!((f0 - ratio * ratio).abs() < 1e-7, "{ior}: {f0}");
        for alpha in [AlphaMode::Opaque, AlphaMode::Blend] {
            let base = 0.25;
            let material = Material { dielectric_f0: f0, alpha, ..matt(Vec3::splat(base).extend(1.0)) };
            // Under light from everywhere: (1 - F0) of the colour, and F0. Eight bits hold the root of F0.
            let bound = 2.0 * ratio * (0.5 / 254.0) + HALF;
            for found in pixels(&square(material), &[("brdf", "ggx")]) {
                require_near(found, Vec3::splat((1.0 - f0) * base + f0), bound, "ambient");
            }
        }
    }
}

fn material_of(value: Value) -> (Material, Vec<String>) {
    let mut file = GltfFile::triangle();
    file.push("materials", value);
    file.primitive()["material"] = json!(0);
    let scene = file.load().unwrap();
    (scene.materials[0].clone(), scene.warnings)
}

#[test]
fn extensions_become_what_can_be_drawn_and_say_so() {
    let (glass, warnings) = material_of(json!({
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5]},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.75}},
    }));
    assert_eq!(glass.alpha, AlphaMode::Blend);
    // The alpha of an opaque material means nothing.
    assert!((glass.base_color.w - (1.0 - 0.75 * 0.96)).abs() < 1e-6, "{}", glass.base_color);
    assert!(warnings[0].starts_with("1 transmissive material is drawn as a BLEND surface"), "{warnings:?}");

    let (dull, warnings) = material_of(json!({"extensions": {
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [0.5, 1.0, 0.0]},
    }}));
    assert!((dull.dielectric_f0 - 0.04 * 0.5 * 0.5).abs() < 1e-7, "{}", dull.dielectric_f0);
    assert!(warnings[0].contains("KHR_materials_specular"), "{warnings:?}");

    let (flat, warnings) = material_of(json!({
        "emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_unlit": {}},
    }));
    assert!(flat.unlit && !flat.is_emissive() && warnings.is_empty());
    assert_eq!((flat.metallic, flat.emissive), (0.0, Vec3::ZERO));
}

#[test]
fn broken_extensions_are_refused_with_their_material() {
    for (material, said) in [
        (json!({"extensions": {"KHR_materials_ior": {"ior": 0.5}}}), "index of refraction is 0.5"),
        (
            json!({"pbrMetallicRoughness": {"baseColorTexture":
                {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1e39, 1]}}}}}),
            "all must be finite",
        ),
        (
            json!({"normalTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": "left"}}}}),
            "KHR_texture_transform cannot be read",
        ),
        (
            json!({"occlusionTexture": {"index": 0, "strength": 1e39}}),
            "occlusionTexture.strength is inf; it must be finite",
        ),
    ] {
        let mut file = GltfFile::triangle();
        file.json["images"] = json!([{"uri": "data:image/png;base64,"}]);
        file.json["textures"] = json!([{"source": 0}]);
        file.push("materials", material);
        let error = file.load().unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.message().contains(said), "{error}");
        assert!(error.message().contains("material 0"), "{error}");
    }
}

/// KHR_texture_transform's own words: shift, then turn counter-clockwise, then scale; its set wins.
#[test]
fn a_transform_in_a_file_is_read_for_every_texture() {
    let transform = json!({"KHR_texture_transform":
        {"offset": [0.25, 0.5], "rotation": std::f32::consts::FRAC_PI_2, "scale": [2, 3], "texCoord": 1}});
    let texture = json!({"index": 0, "extensions": transform});
    let mut file = GltfFile::triangle();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbaImage::new(1, 1).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let view = file.view(&bytes.into_inner());
    file.json["images"] = json!([{"bufferView": view, "mimeType": "image/png"}]);
    file.json["textures"] = json!([{"source": 0}]);
    file.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
    file.push(
        "materials",
        json!({
            "pbrMetallicRoughness": {"baseColorTexture": texture, "metallicRoughnessTexture": texture},
            "normalTexture": texture, "emissiveTexture": texture, "occlusionTexture": texture,
        }),
    );
    let uvs = file.floats("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    file.primitive()["attributes"]["TEXCOORD_1"] = json!(uvs);
    file.primitive()["material"] = json!(0);
    let scene = file.load().unwrap();
    assert_eq!(scene.warnings, [] as [&str; 0]);
    assert_eq!(scene.meshes[0].uvs_1, [Vec2::ZERO, Vec2::X, Vec2::Y]);
    for slot in TextureSlot::ALL {
        let placement = scene.materials[0].placement(slot);
        assert_eq!(placement.uv_set, 1);
        // By hand: (0.1, 0.2) scaled is (0.2, 0.6); a quarter turn makes (v, -u) of it.
        let found = placement.at([Vec2::ZERO, Vec2::new(0.1, 0.2)]);
        assert!(found.abs_diff_eq(Vec2::new(0.25 + 0.6, 0.5 - 0.2), 1e-6), "{slot:?}: {found}");
    }
}

/// Shines from the eye: a side that is seen is lit, by pi / pi of its colour.
fn headlight() -> Light {
    Light {
        name: String::new(),
        kind: LightKind::Directional,
        intensity: Vec3::splat(std::f32::consts::PI),
        position: Vec3::ZERO,
        direction: Vec3::NEG_Z,
        range: None,
        radius: 0.0,
    }
}

/// A front is what runs counter-clockwise in object space, whatever the node does to it.
#[test]
fn sides_are_told_through_mirrors_and_turns() {
    let changes =
        both(AMBIENT, &[("ambient", "0"), ("background", "0.25"), ("direct-shadow", "none"), ("size", "8x8")]);
    let turned = Mat4::from_rotation_y(std::f32::consts::PI);
    let mut watched = Watched::with_scene(square(matt(Vec4::ONE)));
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -2.0, 1.0), Vec3::new(-1.0, -1.0, 1.0)] {
        for (turn, is_front) in [(Mat4::IDENTITY, true), (turned, false)] {
            for double_sided in [false, true] {
                for alpha in [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Blend] {
                    let mut scene = square(Material { double_sided, alpha, ..matt(Vec3::splat(0.5).extend(1.0)) });
                    scene.draws[0].world_from_object = turn * Mat4::from_scale(scale);
                    scene.lights.push(headlight());
                    let what = format!("{scale} {is_front} {double_sided} {alpha:?}");
                    // Scenes of one hash are taken for the same.
                    scene.hash.clone_from(&what);
                    watched = watched.showing(scene);
                    let expected = if is_front || double_sided { 0.5 } else { 0.25 };
                    for found in pixels_of(&watched, "deferred", &changes) {
                        require_near(found, Vec3::splat(expected), 1e-3, &what);
                    }
                }
            }
        }
    }
}

/// The same of a skin, where the joints replace the node: a mirrored joint keeps the front, a mirrored node does
/// nothing.
#[test]
fn sides_are_told_through_mirrored_joints() {
    let raster = both(AMBIENT, &[("ambient", "0"), ("direct-shadow", "none"), ("size", "8x8")]);
    let rays: Changes<'_> = &[("size", "8x8"), ("rig", "none"), ("brdf", "lambert"), ("spp", "2")];
    let mut watched = Watched::with_scene(square(matt(Vec4::ONE)));
    // Scales of the joint with which the triangle covers the picture; the last two turn its front away.
    for (scale, is_front) in [
        ([8.0, 8.0, 1.0], true),
        ([-8.0, 8.0, 1.0], true),
        ([8.0, -8.0, 1.0], true),
        ([-8.0, -8.0, 1.0], true),
        ([8.0, 8.0, -1.0], false),
        ([-8.0, 8.0, -1.0], false),
    ] {
        for (has_normals, node_scale) in [(true, 1.0), (false, 1.0), (true, -1.0)] {
            let mut file = GltfFile::skinned_triangle();
            file.json["nodes"][0]["scale"] = json!([node_scale, 1, 1]);
            let [x, y, _] = scale.map(|side: f32| -2.0 * side.signum());
            file.json["nodes"][2] = json!({"scale": scale, "translation": [x, y, 0]});
            if has_normals {
                let normals = file.floats("VEC3", &[0.0, 0.0, 1.0].repeat(3));
                file.primitive()["attributes"]["NORMAL"] = json!(normals);
            }
            let mut scene = file.load().unwrap();
            let Scene { cameras, .. } = square(matt(Vec4::ONE));
            (scene.cameras, scene.lights) = (cameras, vec![headlight()]);
            scene.materials[0] = matt(Vec3::splat(0.5).extend(1.0));
            watched = watched.showing(scene);
            let expected = Vec3::splat(if is_front { 0.5 } else { 0.0 });
            for (technique, changes) in [("deferred", &raster[..]), ("path_traced", rays)] {
                for found in pixels_of(&watched, technique, changes) {
                    require_near(found, expected, 1e-3, &format!("{technique}: {scale:?} {has_normals} {node_scale}"));
                }
            }
        }
    }
}

//! A built-in scene as a binary glTF 2.0 file, so that other programs can draw it and this one can read it back.
//!
//! The file holds the scene's own numbers: matrices instead of translation, rotation and scale, and light in powers of two
//! times a colour, so that what is read back is what was written. What a reader makes unit length again (normals, tangents,
//! the axes of cameras) may come back with another last bit.
//!
//! What no built-in scene has (vertex colours, second UV sets, placed textures, occlusion, unlit surfaces, other indices
//! of refraction) is not written.

mod binary;
mod materials;

use self::binary::Binary;
use crate::error::{Error, Result};
use crate::scene::animation::{Curve, Interpolation};
use crate::scene::glb::materials::scaled;
use crate::scene::procedural::{Motion, Thing};
use crate::scene::{Camera, Light, LightKind, Mesh, Projection, Scene};
use crate::units::Bytes;
use glam::Mat4;
use serde_json::{Map, Value, json};

const LIGHTS: &str = "KHR_lights_punctual";

/// `scene`, which a generator made, and what moves in it, each as an animation, as the bytes of a .glb.
///
/// Errors: more than the 4 GiB that the format can hold, or an image that cannot be encoded (exit code 2).
pub fn encode(scene: &Scene, motions: &[Motion]) -> Result<Vec<u8>> {
    let mut binary = Binary::default();
    let meshes: Vec<Value> = scene.meshes.iter().map(|mesh| mesh_json(scene, mesh, &mut binary)).collect();
    let looks = materials::encode(scene, &mut binary)?;

    let mut nodes: Vec<Value> = scene
        .draws
        .iter()
        .enumerate()
        .map(|(index, draw)| {
            let mut node = node(motions, Thing::Draw(index), draw.world_from_object);
            node.insert("mesh".to_owned(), json!(draw.mesh));
            node.insert("name".to_owned(), json!(scene.meshes[draw.mesh].name));
            Value::Object(node)
        })
        .collect();
    nodes.extend(scene.lights.iter().enumerate().map(|(index, light)| {
        let mut node = node(motions, Thing::Light(index), world_from_light(light));
        node.insert("name".to_owned(), json!(light.name));
        node.insert("extensions".to_owned(), json!({ LIGHTS: { "light": index } }));
        Value::Object(node)
    }));
    nodes.extend(scene.cameras.iter().enumerate().map(|(index, camera)| {
        let mut node = node(motions, Thing::Camera(index), camera.world_from_view);
        node.insert("name".to_owned(), json!(camera.name));
        node.insert("camera".to_owned(), json!(index));
        Value::Object(node)
    }));

    let mut root = Map::new();
    root.insert(
        "asset".to_owned(),
        json!({ "version": "2.0", "generator": concat!("quincunx ", env!("CARGO_PKG_VERSION")) }),
    );
    let lights: Vec<Value> = scene.lights.iter().map(light_json).collect();
    let mut extensions: Vec<&str> = looks.extensions;
    if !lights.is_empty() {
        extensions.push(LIGHTS);
        root.insert("extensions".to_owned(), json!({ LIGHTS: { "lights": lights } }));
    }
    let all_nodes: Vec<usize> = (0..nodes.len()).collect();
    let cameras = scene.cameras.iter().map(camera_json).collect();
    let animations = motions.iter().map(|motion| animation_json(scene, motion, &mut binary)).collect();
    let Binary { bytes, views, accessors } = binary;
    // glTF has no empty arrays.
    for (key, array) in [
        ("extensionsUsed", extensions.into_iter().map(Value::from).collect()),
        ("scenes", vec![json!({ "name": scene.name, "nodes": all_nodes })]),
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", looks.materials),
        ("textures", looks.textures),
        ("samplers", looks.samplers),
        ("images", looks.images),
        ("cameras", cameras),
        ("animations", animations),
        ("accessors", accessors),
        ("bufferViews", views),
        ("buffers", vec![json!({ "byteLength": bytes.len() })]),
    ] {
        if !array.is_empty() {
            root.insert(key.to_owned(), Value::Array(array));
        }
    }
    root.insert("scene".to_owned(), json!(0));
    contain(&Value::Object(root).to_string(), bytes)
}

/// Puts both parts into one file (glTF 2.0, section 4.4).
fn contain(json: &str, mut binary: Vec<u8>) -> Result<Vec<u8>> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let Ok(total) = u32::try_from(length) else {
        return Err(Error::request(format!("the file would have {}; a .glb holds 4 GiB", Bytes(length as u64)))
            .note("ask for fewer triangles"));
    };
    let mut file = Vec::with_capacity(length);
    file.extend_from_slice(b"glTF\x02\0\0\0");
    file.extend_from_slice(&total.to_le_bytes());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        // No part is longer than the whole.
        file.extend_from_slice(&(chunk.len() as u32).to_le_bytes());
        file.extend_from_slice(kind);
        file.extend(chunk);
    }
    Ok(file)
}

fn mesh_json(scene: &Scene, mesh: &Mesh, binary: &mut Binary) -> Value {
    let material = &scene.materials[mesh.material];
    assert!(mesh.colors.is_empty() && mesh.uvs_1.is_empty(), "no generator makes them");
    let mut attributes = Map::new();
    let mut put = |name: &str, accessor: usize| attributes.insert(name.to_owned(), json!(accessor));
    put("POSITION", binary.positions(&mesh.positions));
    put("NORMAL", binary.vectors(bytemuck::cast_slice(&mesh.normals), "VEC3"));
    if material.normal_texture.is_some() {
        put("TANGENT", binary.vectors(bytemuck::cast_slice(&mesh.tangents), "VEC4"));
    }
    // Sets have their numbers in a row: an atlas, which no texture reads, is the last.
    let texture_uvs = materials::has_texture(material).then_some(&mesh.uvs);
    let atlas = Some(&mesh.atlas).filter(|atlas| !atlas.is_empty());
    for (set, uvs) in texture_uvs.into_iter().chain(atlas).enumerate() {
        put(&format!("TEXCOORD_{set}"), binary.vectors(bytemuck::cast_slice(uvs), "VEC2"));
    }
    let indices = binary.indices(&mesh.indices);
    json!({
        "name": mesh.name,
        "primitives": [{ "attributes": attributes, "indices": indices, "material": mesh.material }],
    })
}

/// A node at a place; nothing where it is the world's own.
fn placed(world_from_node: Mat4) -> Map<String, Value> {
    let mut node = Map::new();
    if world_from_node != Mat4::IDENTITY {
        node.insert("matrix".to_owned(), json!(world_from_node.to_cols_array()));
    }
    node
}

/// The node of a thing that stands at `place` or is moved by one of `motions`.
fn node(motions: &[Motion], thing: Thing, place: Mat4) -> Map<String, Value> {
    let Some(motion) = motions.iter().find(|motion| motion.thing == thing) else { return placed(place) };
    // What an animation moves may have no matrix (glTF 2.0, section 3.5.3).
    let (translation, rotation) = (motion.translation_at(0.0).to_array(), motion.rotation_at(0.0).to_array());
    let parts = json!({ "translation": translation, "rotation": rotation });
    if let Value::Object(node) = parts { node } else { unreachable!("it is an object") }
}

fn animation_json(scene: &Scene, motion: &Motion, binary: &mut Binary) -> Value {
    // Draws come first, then lights, then cameras.
    let node = match motion.thing {
        Thing::Draw(index) => index,
        Thing::Light(index) => scene.draws.len() + index,
        Thing::Camera(index) => scene.draws.len() + scene.lights.len() + index,
    };
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for (path, kind, curve) in [("translation", "VEC3", &motion.translations), ("rotation", "VEC4", &motion.rotations)]
    {
        let Some(curve) = curve else { continue };
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
        samplers.push(sampler_json(curve, kind, binary));
    }
    json!({ "name": motion.name, "samplers": samplers, "channels": channels })
}

fn sampler_json(curve: &Curve, kind: &str, binary: &mut Binary) -> Value {
    let (input, output) = (binary.times(curve.times_s()), binary.vectors(curve.values(), kind));
    let interpolation = match curve.interpolation() {
        Interpolation::Step => "STEP",
        Interpolation::Linear => "LINEAR",
        Interpolation::CubicSpline => "CUBICSPLINE",
    };
    json!({ "input": input, "output": output, "interpolation": interpolation })
}

/// A light shines along its node's -z.
fn world_from_light(light: &Light) -> Mat4 {
    if !light.kind.has_direction() {
        return Mat4::from_translation(light.position);
    }
    let back = -light.direction;
    let (x, y) = back.any_orthonormal_pair();
    Mat4::from_cols(x.extend(0.0), y.extend(0.0), back.extend(0.0), light.position.extend(1.0))
}

fn light_json(light: &Light) -> Value {
    let (color, intensity) = scaled(light.intensity);
    let mut json = json!({ "name": light.name, "color": color.to_array(), "intensity": intensity });
    match light.kind {
        LightKind::Directional | LightKind::Point => {}
        LightKind::Spot { inner_angle, outer_angle } => {
            json["spot"] = json!({ "innerConeAngle": inner_angle, "outerConeAngle": outer_angle });
        }
    }
    json["type"] = json!(light.kind.name());
    if let Some(range) = light.range {
        json["range"] = json!(range);
    }
    json
}

fn camera_json(camera: &Camera) -> Value {
    let (kind, view) = match camera.projection {
        Projection::Perspective { y_fov, aspect, z_near, z_far } => {
            let mut view = json!({ "yfov": y_fov, "znear": z_near });
            for (key, value) in [("aspectRatio", aspect), ("zfar", z_far)] {
                if let Some(value) = value {
                    view[key] = json!(value);
                }
            }
            ("perspective", view)
        }
        Projection::Orthographic { x_mag, y_mag, z_near, z_far } => {
            ("orthographic", json!({ "xmag": x_mag, "ymag": y_mag, "znear": z_near, "zfar": z_far }))
        }
    };
    json!({ "name": camera.name, "type": kind, kind: view })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn light_is_a_colour_times_a_power_of_two_exactly() {
        for value in [
            Vec3::ZERO,
            Vec3::new(0.3, 1.0, 0.1),
            Vec3::new(17.3, 0.1, 1e-7),
            Vec3::new(1024.0, 1023.9, 0.0),
            Vec3::new(1e30, 3.3e37, 1.0),
        ] {
            let (color, power) = scaled(value);
            assert!(color.max_element() <= 1.0 && color * power == value, "{value}: {color} times {power}");
        }
    }
}

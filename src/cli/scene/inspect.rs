//! `quincunx scene inspect`: what a scene holds, and what of it is not drawn as it stands there. No device is needed.

use super::seed::{seed, seed_argument};
use crate::cli::output;
use crate::error::Result;
use crate::scene::gltf::Facts;
use crate::scene::shell::Shell;
use crate::scene::{self, AlphaMode, Camera, Image, LightKind, Material, Medium, Projection, Scene, normal_groups};
use crate::units::{Bytes, Extent};
use clap::{Arg, ArgAction, ArgMatches, Command};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new("inspect")
        .about("Print what a scene holds, and what of it is left out or approximated")
        .arg(
            Arg::new("scene")
                .value_name("SCENE")
                .required(true)
                .help("A .gltf or .glb file, or a built-in scene with its parameters"),
        )
        .arg(seed_argument())
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
        .arg(output::quiet_flag())
}

/// Prints the inventory.
///
/// Errors: no such scene, or a broken file (exit code 2), as `render` refuses it.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let spec = matches.get_one::<String>("scene").expect("clap requires it");
    let (scene, facts) = scene::inspect(spec, seed(matches))?;
    if matches.get_flag("json") {
        return output::print(&format!("{:#}\n", document(&scene, facts.as_ref())));
    }
    let mut text = String::new();
    describe(&mut text, &scene, facts.as_ref()).expect("writing to a string");
    output::print_text(matches, &text)
}

fn document(scene: &Scene, facts: Option<&Facts>) -> Value {
    let bounds = scene.bounds();
    let corners = (!bounds.is_empty()).then(|| json!({ "min": bounds.min.to_array(), "max": bounds.max.to_array() }));
    let cameras: Vec<Value> =
        scene.cameras.iter().map(|camera| json!({ "name": camera.name, "kind": kind(camera) })).collect();
    let [opaque, mask, blend] = alpha_counts(scene);
    json!({
        "schema": 1,
        "name": scene.name,
        "hash": scene.hash,
        "file": facts.map(file_document),
        "draws": scene.draws.len(),
        "triangles": scene.triangle_count(),
        "vertices": vertex_count(scene),
        "meshes": scene.meshes.len(),
        "closed_meshes": closed_mesh_count(scene),
        "normal_groups": normal_group_count(scene),
        "materials": { "opaque": opaque, "mask": mask, "blend": blend },
        "textures": scene.textures.len(),
        "images": scene.images.iter().map(|image| image_document(image)).collect::<Vec<_>>(),
        "lights": Map::from_iter(light_counts(scene).map(|(name, count)| (name.to_owned(), json!(count)))),
        "emissive_materials": scene.materials.iter().filter(|material| material.is_emissive()).count(),
        "medium": scene.medium.map(|medium| {
            let Medium { scattering, absorption, asymmetry } = medium;
            json!({ "scattering": scattering, "absorption": absorption, "asymmetry": asymmetry })
        }),
        "cameras": cameras,
        "bounds": corners,
        "warnings": scene.warnings,
    })
}

fn file_document(facts: &Facts) -> Value {
    let images: Vec<Value> = facts
        .images
        .iter()
        .map(|image| match image.header {
            Some((format, Extent { width, height })) => {
                json!({ "name": image.name, "format": format, "width": width, "height": height })
            }
            None => json!({ "name": image.name, "format": null }),
        })
        .collect();
    let animations: Vec<Value> = facts
        .animations
        .iter()
        .map(|one| json!({ "name": one.name, "channels": one.channel_count, "duration_s": one.duration_s }))
        .collect();
    json!({
        "bytes": facts.size_bytes,
        "generator": facts.generator,
        "version": facts.version,
        "extensions_used": facts.extensions_used,
        "extensions_required": facts.extensions_required,
        "scenes": facts.scene_count,
        "nodes": facts.node_count,
        "meshes": facts.mesh_count,
        "primitives": facts.primitive_count,
        "textures": facts.texture_count,
        "skins": facts.skin_count,
        "images": images,
        "animations": animations,
    })
}

fn image_document(image: &Image) -> Value {
    json!({ "name": image.name, "width": image.width, "height": image.height })
}

fn describe(text: &mut String, scene: &Scene, facts: Option<&Facts>) -> std::fmt::Result {
    writeln!(text, "{}", scene.name)?;
    match facts {
        Some(facts) => describe_file(text, facts)?,
        None => writeln!(text, "   built in")?,
    }
    let (triangles, draws) = (scene.triangle_count(), scene.draws.len());
    writeln!(text, "   drawn: {triangles} triangles in {draws} draws, {} vertices", vertex_count(scene))?;
    let (meshes, closed, groups) = (scene.meshes.len(), closed_mesh_count(scene), normal_group_count(scene));
    writeln!(text, "   shapes: {meshes} meshes, {closed} of them closed, {groups} normal groups")?;
    let bounds = scene.bounds();
    if !bounds.is_empty() {
        writeln!(text, "   from {} to {}, in metres", bounds.min, bounds.max)?;
    }
    let [opaque, mask, blend] = alpha_counts(scene);
    let shining = scene.materials.iter().filter(|material| material.is_emissive()).count();
    writeln!(text, "   materials: {opaque} opaque, {mask} MASK, {blend} BLEND; {shining} of them emissive")?;
    let pixels: u64 = scene.images.iter().map(|image| Extent::new(image.width, image.height).pixel_count()).sum();
    let (textures, images) = (scene.textures.len(), scene.images.len());
    writeln!(text, "   textures: {textures} of {images} images, {} at their finest", Bytes(4 * pixels))?;
    let lights = Vec::from_iter(light_counts(scene).map(|(name, count)| format!("{count} {name}")));
    writeln!(text, "   lights: {}", lights.join(", "))?;
    if let Some(Medium { scattering, absorption, asymmetry }) = scene.medium {
        writeln!(
            text,
            "   medium: a metre scatters {scattering} and absorbs {absorption} of light, mean cosine {asymmetry}"
        )?;
    }
    for (index, camera) in scene.cameras.iter().enumerate() {
        writeln!(text, "   camera {index}: {}, {}", camera.name, kind(camera))?;
    }
    for warning in &scene.warnings {
        writeln!(text, "   note: {warning}")?;
    }
    Ok(())
}

fn describe_file(text: &mut String, facts: &Facts) -> std::fmt::Result {
    let generator = facts.generator.as_deref().unwrap_or("an unnamed program");
    writeln!(text, "   glTF {} by {generator}, {}", facts.version, Bytes(facts.size_bytes))?;
    for (what, names) in [("uses", &facts.extensions_used), ("requires", &facts.extensions_required)] {
        if !names.is_empty() {
            writeln!(text, "   {what} {}", names.join(", "))?;
        }
    }
    writeln!(
        text,
        "   holds: {} scenes, {} nodes, {} meshes of {} primitives, {} textures, {} images, {} skins",
        facts.scene_count,
        facts.node_count,
        facts.mesh_count,
        facts.primitive_count,
        facts.texture_count,
        facts.images.len(),
        facts.skin_count
    )?;
    for (index, image) in facts.images.iter().enumerate() {
        match image.header {
            Some((format, extent)) => writeln!(text, "   image {index}: {}, {extent} {format}", image.name)?,
            None => writeln!(text, "   image {index}: {}, cannot be read", image.name)?,
        }
    }
    for (index, one) in facts.animations.iter().enumerate() {
        let duration = one.duration_s.map_or("times that cannot be read".to_owned(), |seconds| format!("{seconds} s"));
        writeln!(text, "   animation {index}: {}, {duration}, {} channels", one.name, one.channel_count)?;
    }
    Ok(())
}

fn vertex_count(scene: &Scene) -> usize {
    scene.meshes.iter().map(|mesh| mesh.positions.len()).sum()
}

/// Meshes with an inside, which can cast a stencil shadow.
fn closed_mesh_count(scene: &Scene) -> usize {
    scene.meshes.par_iter().filter(|mesh| Shell::of(mesh).is_closed()).count()
}

/// Number of normal groups of all meshes together.
fn normal_group_count(scene: &Scene) -> usize {
    scene.meshes.par_iter().map(normal_groups::count).sum()
}

/// OPAQUE, MASK, BLEND.
fn alpha_counts(scene: &Scene) -> [usize; 3] {
    let count = |is: fn(&Material) -> bool| scene.materials.iter().filter(|material| is(material)).count();
    [
        count(|material| material.alpha == AlphaMode::Opaque),
        count(|material| matches!(material.alpha, AlphaMode::Mask { .. })),
        count(|material| material.alpha == AlphaMode::Blend),
    ]
}

/// Names of all kinds of light, and how many there are of each.
fn light_counts(scene: &Scene) -> impl Iterator<Item = (&'static str, usize)> {
    let count = |name| scene.lights.iter().filter(|light| light.kind.name() == name).count();
    LightKind::NAMES.into_iter().map(move |name| (name, count(name)))
}

fn kind(camera: &Camera) -> &'static str {
    match camera.projection {
        Projection::Perspective { .. } => "perspective",
        Projection::Orthographic { .. } => "orthographic",
    }
}

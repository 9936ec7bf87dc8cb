//! What the user says of BLEND surfaces by their names: layers of the stipple by `--stipple-layers`, or in the file (Kircher 2009,
//! section 4: patterns are assigned statically, with user input), and which are decals by `--decals`.
//!
//! The flag is heard before the file, a node before a material.

use super::assignment;
use crate::error::{Error, Result};
use crate::sampling::pattern::Pattern;
use crate::scene::gltf::label;
use crate::scene::gltf::marks::STIPPLE_LAYER;
use crate::scene::{AlphaMode, Material, Scene};
use std::collections::{BTreeMap, BTreeSet};

/// Value of `--stipple-layers` and `--decals` that names no draw.
pub const NONE: &str = "none";

/// A BLEND draw by what it may be called.
struct Blended<'a> {
    draw: u32,
    /// Its node's, or where there are none its mesh's, which is the name of its node once it is exported.
    node_name: &'a str,
    node_layer: Option<u32>,
    material: &'a Material,
}

impl Blended<'_> {
    fn names(&self) -> [&str; 2] {
        [self.node_name, &self.material.name]
    }
}

/// The draws that are decals. `text`: of `--decals`.
///
/// Errors: a name that no BLEND surface has (exit code 2).
pub fn decals(scene: &Scene, text: &str) -> Result<BTreeSet<u32>> {
    let asked: BTreeSet<&str> = text.split(',').filter(|_| text != NONE).collect();
    let blended: Vec<Blended<'_>> = blended(scene).collect();
    require_known(&blended, "--decals", asked.iter().copied())?;
    let is_asked = |one: &&Blended<'_>| one.names().iter().any(|name| asked.contains(name));
    Ok(blended.iter().filter(is_asked).map(|one| one.draw).collect())
}

fn require_known<'a>(blended: &[Blended<'_>], flag: &str, mut asked: impl Iterator<Item = &'a str>) -> Result<()> {
    let names: BTreeSet<&str> = blended.iter().flat_map(Blended::names).filter(|name| !name.is_empty()).collect();
    let Some(name) = asked.find(|name| !names.contains(name)) else { return Ok(()) };
    let name = label::shown(name);
    let refused = Error::request(format!("{flag} {name}: no BLEND surface has a node or a material of that name"));
    Err(refused.note(match names.len() {
        0 => "the scene has none with a name".to_owned(),
        _ => format!("there are {}", label::list(names.iter().copied())),
    }))
}

/// The layers of draws that have one, by draw. `text`: of `--stipple-layers`.
///
/// Errors: a name that no BLEND surface has, a name twice, a layer that the stipple does not have (exit code 2).
pub fn layers(scene: &Scene, text: &str, stipple: &Pattern) -> Result<BTreeMap<u32, u32>> {
    let blended: Vec<Blended<'_>> = blended(scene).collect();
    let asked = asked(text, stipple)?;
    require_known(&blended, "--stipple-layers", asked.keys().copied())?;
    let mut layers = BTreeMap::new();
    for one in &blended {
        let of_flag = one.names().into_iter().find_map(|name| asked.get(name));
        let of_file = one.node_layer.or(one.material.stipple_layer);
        if let (None, Some(layer)) = (of_flag, of_file) {
            require_layer(layer, stipple).map_err(|error| {
                let (kind, name) =
                    if one.node_layer.is_some() { ("node", one.node_name) } else { ("material", &*one.material.name) };
                error.within(format!("{STIPPLE_LAYER} of {kind} {:?}", label::shown(name)))
            })?;
        }
        layers.extend(of_flag.copied().or(of_file).map(|layer| (one.draw, layer)));
    }
    Ok(layers)
}

fn blended(scene: &Scene) -> impl Iterator<Item = Blended<'_>> {
    scene.draws.iter().enumerate().filter_map(|(index, draw)| {
        let mesh = &scene.meshes[draw.mesh];
        let material = &scene.materials[mesh.material];
        let node = scene.draw_nodes.get(index).map(|node| &scene.nodes[*node as usize]);
        (material.alpha == AlphaMode::Blend).then(|| Blended {
            draw: index as u32,
            node_name: node.map_or(&mesh.name, |node| &node.name),
            node_layer: node.and_then(|node| node.stipple_layer),
            material,
        })
    })
}

/// What `--stipple-layers` says of names: `NAME=LAYER,NAME=LAYER`.
fn asked<'a>(text: &'a str, stipple: &Pattern) -> Result<BTreeMap<&'a str, u32>> {
    let mut asked = BTreeMap::new();
    for part in text.split(',').filter(|_| text != NONE) {
        let refused = |why: &str| Error::request(format!("--stipple-layers {}: {why}", label::shown(part)));
        // Names may hold an equals sign.
        let Some((name, layer)) = part.rsplit_once('=') else {
            return Err(refused("it is not NAME=LAYER"));
        };
        let layer = layer.parse().map_err(|_| refused("its layer is not a whole number"))?;
        require_layer(layer, stipple)
            .map_err(|error| error.within(format!("--stipple-layers {}", label::shown(part))))?;
        if asked.insert(name, layer).is_some() {
            return Err(refused("its name has a layer already"));
        }
    }
    Ok(asked)
}

fn require_layer(layer: u32, stipple: &Pattern) -> Result<()> {
    let (most, [side, _]) = (assignment::layer_count(stipple), stipple.period_px());
    if (1..=most).contains(&layer) {
        return Ok(());
    }
    let refused =
        Error::request(format!("layer {layer}: a stipple of {side}x{side} has layers 1 to {most} for BLEND surfaces"));
    Err(if side == 2 { refused.note("--stipple 4x4 has layers 1 to 15") } else { refused })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Mesh, Node};
    use glam::{Mat4, Vec3};

    /// Draw 0 is solid; 1 and 2 are of the materials `amber` and `blue`, by the nodes `left` and `right`.
    fn scene() -> Scene {
        let blend = |name: &str| Material { alpha: AlphaMode::Blend, ..Material::diffuse(name, Vec3::ONE) };
        let node = |name: &str| Node { name: name.to_owned(), stipple_layer: None };
        Scene {
            materials: vec![Material::diffuse("wall", Vec3::ONE), blend("amber"), blend("blue")],
            meshes: (0..3).map(|material| Mesh { material, ..Mesh::default() }).collect(),
            draws: (0..3).map(|mesh| Draw { mesh, world_from_object: Mat4::IDENTITY }).collect(),
            nodes: ["house", "left", "right"].map(node).to_vec(),
            draw_nodes: vec![0, 1, 2],
            ..Scene::default()
        }
    }

    #[test]
    fn the_flag_goes_before_the_file_and_a_node_before_a_material() {
        let (mut scene, two) = (scene(), Pattern::grid([2, 2]));
        assert_eq!(layers(&scene, NONE, &two).unwrap(), BTreeMap::new());
        scene.materials[1].stipple_layer = Some(3);
        scene.materials[2].stipple_layer = Some(2);
        assert_eq!(layers(&scene, NONE, &two).unwrap(), BTreeMap::from([(1, 3), (2, 2)]));
        scene.nodes[2].stipple_layer = Some(1);
        assert_eq!(layers(&scene, NONE, &two).unwrap(), BTreeMap::from([(1, 3), (2, 1)]));
        assert_eq!(layers(&scene, "amber=1,right=3", &two).unwrap(), BTreeMap::from([(1, 1), (2, 3)]));
        assert_eq!(layers(&scene, "blue=3,right=2", &two).unwrap(), BTreeMap::from([(1, 3), (2, 2)]));
    }

    #[test]
    fn decals_are_named_by_node_or_material() {
        let scene = scene();
        assert_eq!(decals(&scene, NONE).unwrap(), BTreeSet::new());
        assert_eq!(decals(&scene, "amber").unwrap(), BTreeSet::from([1]));
        assert_eq!(decals(&scene, "amber,right").unwrap(), BTreeSet::from([1, 2]));
        let error = decals(&scene, "wall").unwrap_err().to_string();
        assert!(error.contains("--decals wall") && error.contains("there are amber, blue"), "{error}");
    }

    #[test]
    fn what_cannot_be_is_refused_with_what_can() {
        let (mut scene, [two, four]) = (scene(), [2, 4].map(|side| Pattern::grid([side; 2])));
        for (text, side, said) in [
            ("green=1", 2, "there are amber, blue, left, right"),
            ("wall=1", 2, "no BLEND surface"),
            ("amber", 2, "not NAME=LAYER"),
            ("amber=two", 2, "not a whole number"),
            ("amber=0", 2, "layers 1 to 3"),
            ("amber=4", 2, "--stipple 4x4"),
            ("amber=16", 4, "layers 1 to 15"),
            ("amber=1,amber=2", 2, "has a layer already"),
        ] {
            let error = layers(&scene, text, &Pattern::grid([side; 2])).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(said), "{text}: {error}");
        }
        scene.materials[1].stipple_layer = Some(7);
        let error = layers(&scene, NONE, &two).unwrap_err();
        assert!(error.to_string().contains("of material \"amber\""), "{error}");
        assert_eq!(layers(&scene, NONE, &four).unwrap(), BTreeMap::from([(1, 7)]));
        assert_eq!(layers(&scene, "amber=2", &two).unwrap(), BTreeMap::from([(1, 2)]), "the file's is not asked");
    }
}

//! Scenes while a shutter is open, and surfaces that light does not change.

use quincunx::scene::{self, AlphaMode, AnimationChoice, Material, Scene};

/// A scene of `scene::open` with all that moves in it, from when the shutter opens to when it closes, seconds.
pub fn moving(spec: &str, shutter_s: [f64; 2]) -> Scene {
    scene::open(spec, 1, &AnimationChoice::All).unwrap().exposed(shutter_s).unwrap()
}

/// The same in one colour a draw, whichever light there is; glass stays glass. `has_holes`: so do holes, and their textures.
pub fn unlit(mut scene: Scene, has_holes: bool) -> Scene {
    for material in &mut scene.materials {
        let is_read = has_holes && material.alpha != AlphaMode::Opaque;
        *material = Material {
            unlit: true,
            base_color_texture: material.base_color_texture.filter(|_| is_read),
            normal_texture: None,
            metallic_roughness_texture: None,
            emissive_texture: None,
            occlusion_texture: None,
            ..material.clone()
        };
    }
    scene
}

//! The shadow volumes of a picture (Kircher & Lawrance 2009, sections 4 and 7): which lights cast by them, and what they
//! cast, as lists that a device draws.
//!
//! Opaque and MASK surfaces cast; a MASK surface as if it had no holes, as it does for shadow rays. BLEND surfaces let light
//! through. A surface that is not closed has no volume: it casts nothing and is counted.

use std::cmp::Reverse;
use std::ops::Range;

use glam::Vec4;

use super::shadow_volume::ShadowVolume;
use crate::error::{Error, Result};
use crate::progress::Stage;
use crate::scene::shell::Shell;
use crate::scene::{AlphaMode, Light, Mesh, Scene};
use crate::shading::light;

/// Triangles of all surfaces that cast, once a light: a closed surface has at most three corners for two of them, which keeps
/// the indices of a light below 2^24, what every device can draw with.
const MOST_TRIANGLES: u64 = 1 << 22;

/// The `count` strongest lights, as ascending indices: directional ones before others, then those of more flux, then those
/// that come first. All of them where there are fewer.
pub fn strongest(lights: &[Light], count: usize) -> Vec<usize> {
    // A disc of one metre stands for the scene: between directional lights it changes nothing.
    let flux = |light: &Light| light::flux(light, 1.0).element_sum();
    let mut order: Vec<usize> = (0..lights.len()).collect();
    order.sort_by(|a, b| {
        let [a, b] = [a, b].map(|index| &lights[*index]);
        let is_directional = |light: &Light| light.kind.is_directional();
        (Reverse(is_directional(a)).cmp(&Reverse(is_directional(b)))).then(flux(b).total_cmp(&flux(a)))
    });
    order.truncate(count);
    order.sort_unstable();
    order
}

/// What one light casts.
#[derive(Clone, Debug)]
pub struct CastingLight {
    /// Index of the light.
    pub light: u32,
    /// Where its positions begin in `ShadowCasters::positions`.
    pub first_position: u32,
    /// Its part of `ShadowCasters::triangles`.
    pub triangles: Range<u32>,
}

/// The volumes of some lights.
#[derive(Debug, Default)]
pub struct ShadowCasters {
    /// `ShadowVolume::positions` of all lights, one light after the other.
    pub positions: Vec<Vec4>,
    /// `ShadowVolume::triangles` of all lights, as indices into the positions of the same light.
    pub triangles: Vec<[u32; 3]>,
    /// Ascending by light.
    pub lights: Vec<CastingLight>,
    /// Surfaces with a volume, summed over the lights.
    pub volume_count: usize,
    /// Draws that cast nothing, because their mesh is not closed.
    pub open_count: usize,
}

impl ShadowCasters {
    /// Those of `casting`, indices into `lights`, in n log n of the triangles.
    ///
    /// Errors: they are of too many triangles (exit code 2).
    pub fn of(scene: &Scene, lights: &[Light], casting: &[usize]) -> Result<Self> {
        let mut casters = Self::default();
        if casting.is_empty() {
            return Ok(casters);
        }
        let _stage = Stage::begin("making shadow volumes");
        let casts = |mesh: &Mesh| scene.materials[mesh.material].alpha != AlphaMode::Blend;
        let mut is_drawn = vec![false; scene.meshes.len()];
        scene.draws.iter().for_each(|draw| is_drawn[draw.mesh] = true);
        let shells: Vec<Option<Shell>> = (scene.meshes.iter().zip(is_drawn))
            .map(|(mesh, is_drawn)| (is_drawn && casts(mesh)).then(|| Shell::of(mesh)))
            .collect();
        let casting_draws = || scene.draws.iter().filter_map(|draw| Some((draw, shells[draw.mesh].as_ref()?)));
        let closed_draws = || casting_draws().filter(|(_, shell)| shell.is_closed());
        casters.open_count = casting_draws().count() - closed_draws().count();
        let triangle_count: u64 = closed_draws().map(|(_, shell)| shell.triangles.len() as u64).sum();
        let all = triangle_count.saturating_mul(casting.len() as u64);
        if all > MOST_TRIANGLES {
            return Err(Error::request(format!(
                "--shadow-volumes {}: volumes are made of at most {MOST_TRIANGLES} triangles, and {}'s closed surfaces have \
                 {triangle_count} for each light",
                casting.len(),
                scene.name
            ))
            .note(match MOST_TRIANGLES / triangle_count {
                0 => "--direct-shadow ray casts shadows without volumes".to_owned(),
                fitting => format!("--shadow-volumes {fitting} fits; --direct-shadow ray casts shadows without volumes"),
            }));
        }
        for index in casting {
            let source = lights[*index].source();
            let [first_position, first_triangle] = [casters.positions.len(), casters.triangles.len()];
            for (draw, shell) in closed_draws() {
                let Some(volume) = ShadowVolume::of(shell, &draw.world_from_object, source) else { continue };
                let first = (casters.positions.len() - first_position) as u32;
                casters.positions.extend(volume.positions);
                casters.triangles.extend(volume.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
                casters.volume_count += 1;
            }
            casters.lights.push(CastingLight {
                light: *index as u32,
                first_position: first_position as u32,
                triangles: first_triangle as u32..casters.triangles.len() as u32,
            });
        }
        Ok(casters)
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat4, Vec3};

    use super::*;
    use crate::scene::{Draw, LightKind, Material, procedural};

    fn light(kind: LightKind, intensity: f32) -> Light {
        let (position, direction) = (Vec3::new(3.0, 9.0, 2.0), Vec3::NEG_Y);
        Light {
            name: String::new(),
            kind,
            intensity: Vec3::splat(intensity),
            position,
            direction,
            range: None,
            radius: 0.0,
        }
    }

    #[test]
    fn the_strongest_lights_are_suns_and_then_those_of_most_flux() {
        let narrow = LightKind::Spot { inner_angle: 0.1, outer_angle: 0.2 };
        let lights = [
            light(LightKind::Point, 5.0),
            light(narrow, 60.0),
            light(LightKind::Directional, 0.1),
            light(LightKind::Point, 9.0),
            light(LightKind::Directional, 2.0),
            light(LightKind::Point, 9.0),
        ];
        let expected: [&[usize]; 8] =
            [&[], &[4], &[2, 4], &[2, 3, 4], &[2, 3, 4, 5], &[0, 2, 3, 4, 5], &[0, 1, 2, 3, 4, 5], &[0, 1, 2, 3, 4, 5]];
        for (count, expected) in expected.iter().enumerate() {
            assert_eq!(strongest(&lights, count), *expected, "{count}");
        }
    }

    /// Two blocks, one of them twice, as material 1 says, and the ground, which is open.
    fn blocks(alpha: AlphaMode) -> Scene {
        let made = procedural::build("lamps", 1).unwrap().unwrap();
        let mesh = |shape: &str, material: usize| {
            let mesh = made.meshes.iter().find(|mesh| mesh.name.starts_with(shape)).expect("the scene has one");
            Mesh { material, ..mesh.clone() }
        };
        let draw = |mesh: usize, x: f32| Draw { mesh, world_from_object: Mat4::from_translation(Vec3::X * x) };
        Scene {
            meshes: vec![mesh("ground", 0), mesh("block", 0), mesh("block", 1)],
            draws: vec![draw(0, 0.0), draw(1, 0.0), draw(2, 2.0), draw(2, 4.0)],
            materials: vec![Material::default(), Material { alpha, ..Material::default() }],
            ..Scene::default()
        }
    }

    #[test]
    fn closed_surfaces_that_stop_light_cast_once_a_light() {
        let lights = [light(LightKind::Point, 1.0), light(LightKind::Directional, 1.0)];
        for (alpha, casting_draws) in
            [(AlphaMode::Opaque, 3), (AlphaMode::Mask { cutoff: 0.5 }, 3), (AlphaMode::Blend, 1)]
        {
            let scene = blocks(alpha);
            let casters = ShadowCasters::of(&scene, &lights, &[0, 1]).unwrap();
            assert_eq!((casters.volume_count, casters.open_count), (2 * casting_draws, 1), "{alpha:?}");
            assert_eq!(casters.lights.len(), 2);
            // Two for each place of a block, and one at infinity more for parallel light.
            assert_eq!(casters.positions.len(), casting_draws * (16 + 9), "{alpha:?}");
            let (mut first, mut next) = (0, 0);
            for (index, light) in casters.lights.iter().enumerate() {
                let position_count = (casting_draws * [16, 9][index]) as u32;
                assert_eq!((light.light, light.first_position, light.triangles.start), (index as u32, first, next));
                let triangles = &casters.triangles[light.triangles.start as usize..light.triangles.end as usize];
                assert_eq!(triangles.iter().flatten().max(), Some(&(position_count - 1)), "{alpha:?}");
                (first, next) = (first + position_count, light.triangles.end);
            }
            assert_eq!(next as usize, casters.triangles.len());
        }
        let none = ShadowCasters::of(&blocks(AlphaMode::Opaque), &lights, &[]).unwrap();
        assert!(none.positions.is_empty() && none.lights.is_empty());
    }

    #[test]
    fn a_surface_that_a_triangle_is_missing_of_is_counted_and_casts_nothing() {
        let mut scene = blocks(AlphaMode::Opaque);
        scene.meshes[2].indices.truncate(3 * 11);
        let casters = ShadowCasters::of(&scene, &[light(LightKind::Point, 1.0)], &[0]).unwrap();
        assert_eq!((casters.volume_count, casters.open_count), (1, 3));
    }

    #[test]
    fn too_many_triangles_are_refused_with_the_lights_that_would_do() {
        let mut scene = blocks(AlphaMode::Opaque);
        let draw = scene.draws[2];
        scene.draws.extend(std::iter::repeat_n(draw, 200_000));
        let lights = vec![light(LightKind::Point, 1.0); 2];
        let error = ShadowCasters::of(&scene, &lights, &[0, 1]).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let text = error.to_string();
        assert!(text.contains("--shadow-volumes 2") && text.contains("--shadow-volumes 1 fits"), "{text}");
    }
}

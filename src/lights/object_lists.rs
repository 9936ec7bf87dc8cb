//! Lists of lights for objects, made on the host: for each draw, or piece of a BLEND draw, those whose range reaches the box
//! around it.
//!
//! Beyond its range a light adds exactly 0, so a list that leaves it out changes no bit of the picture. Directional
//! lights, and those that never end, are in every list. A spot counts as the sphere of its range: its cone is not looked
//! at. Draws with equal lists share one.
//!
//! Shaders hold the points of an object inside its box, with lists or without: interpolated positions lie beside their
//! triangle by rounding, and where a pixel has several samples by more than that even if they are asked for at a covered
//! sample: on lavapipe of Mesa 22 a pixel of an edge was lit by a lamp that reaches no point of its object.

use super::pieces::{Piece, pieces};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{LightBlock, ObjectLightsBlock};
use crate::scene::{AlphaMode, Bounds, Scene};
use crate::settings::ListChoice;
use crate::units::Bytes;
use bytemuck::Zeroable;
use glam::{Vec3, Vec4};
use std::collections::HashMap;
use std::ops::Range;

/// A draw's stretch of `ObjectLists::entries`, and the box that its points are held inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectLights {
    pub first: u32,
    pub count: u32,
    /// World space.
    pub bounds: Bounds,
}

impl ObjectLights {
    /// As shaders read it.
    pub fn block(&self) -> ObjectLightsBlock {
        ObjectLightsBlock {
            box_min_ws: self.bounds.min.extend(0.0).to_array(),
            box_max_ws: self.bounds.max.extend(0.0).to_array(),
            first: self.first,
            count: self.count,
            ..ObjectLightsBlock::zeroed()
        }
    }
}

/// A run of a BLEND draw's triangles, and its lights.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceLights {
    /// Their places in the mesh's list.
    pub triangles: Range<u32>,
    pub lights: ObjectLights,
}

/// The lists of draws and pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjectLists {
    /// Indices of lights, rising in each list.
    pub entries: Vec<u32>,
    /// Lists of the draws, by index into `Scene::draws`; empty in lists made by `blended`.
    pub objects: Vec<ObjectLights>,
    /// The pieces of each draw, in the order of its triangles, by index into `Scene::draws`; of BLEND draws only.
    pub pieces: Vec<Vec<PieceLights>>,
}

/// Part of a distance, and of the coordinates it is the difference of, that a handful of operations in 32 bits rounds.
const ROUNDING: f32 = 1e-5;

/// Sides of pieces, as a part of the scene's diagonal.
const PIECE_SIDE: f32 = 1.0 / 32.0;

impl ObjectLists {
    /// The lists of `scene`'s draws, and of their pieces where they blend. `most_bytes`: what a device binds at once.
    ///
    /// Errors: different lists together are longer than that (exit code 4).
    pub fn new(scene: &Scene, lights: &[LightBlock], choice: ListChoice, most_bytes: u64) -> Result<Self> {
        let mut maker = Maker::new(scene, lights, choice, most_bytes);
        let boxes = (0..scene.draws.len()).map(|draw| scene.swept_bounds(draw));
        let objects = boxes.map(|bounds| maker.object(bounds)).collect::<Result<_>>()?;
        Ok(Self { objects, ..maker.blended()? })
    }

    /// The lists of BLEND draws' pieces alone.
    ///
    /// Errors: as `new`.
    pub fn blended(scene: &Scene, lights: &[LightBlock], choice: ListChoice, most_bytes: u64) -> Result<Self> {
        Maker::new(scene, lights, choice, most_bytes).blended()
    }

    /// Lights of a draw's list, on average and at most; 0 where nothing is drawn.
    pub fn lights_per_object(&self) -> [f64; 2] {
        mean_and_most(self.objects.iter())
    }

    /// Lights of a BLEND piece's list, on average and at most; 0 where nothing blends.
    pub fn lights_per_piece(&self) -> [f64; 2] {
        mean_and_most(self.pieces.iter().flatten().map(|piece| &piece.lights))
    }
}

fn mean_and_most<'a>(lists: impl Iterator<Item = &'a ObjectLights> + Clone) -> [f64; 2] {
    let counts = || lists.clone().map(|list| f64::from(list.count));
    [counts().sum::<f64>() / counts().count().max(1) as f64, counts().fold(0.0, f64::max)]
}

/// Lists in the making: equal ones are one.
struct Maker<'a> {
    scene: &'a Scene,
    lights: &'a [LightBlock],
    choice: ListChoice,
    most_bytes: u64,
    entries: Vec<u32>,
    /// Where a list begins.
    known: HashMap<Vec<u32>, u32>,
}

impl<'a> Maker<'a> {
    fn new(scene: &'a Scene, lights: &'a [LightBlock], choice: ListChoice, most_bytes: u64) -> Self {
        Self { scene, lights, choice, most_bytes, entries: Vec::new(), known: HashMap::new() }
    }

    fn object(&mut self, bounds: Bounds) -> Result<ObjectLights> {
        let is_in = |index: &u32| self.choice == ListChoice::None || reaches(&self.lights[*index as usize], &bounds);
        let list: Vec<u32> = (0..self.lights.len() as u32).filter(is_in).collect();
        let count = list.len() as u32;
        if let Some(first) = self.known.get(&list) {
            return Ok(ObjectLights { first: *first, count, bounds });
        }
        let first = self.entries.len() as u32;
        let bytes = (self.entries.len() + list.len()) as u64 * size_of::<u32>() as u64;
        if bytes > self.most_bytes {
            return Err(Error::memory(format!(
                "the lists of {} draws under {} lights are longer than {}, which this device binds at once",
                self.scene.draws.len(),
                self.lights.len(),
                Bytes(self.most_bytes)
            ))
            .note("--light-lists none has one list for all; fewer --lights would fit"));
        }
        self.entries.extend(&list);
        self.known.insert(list, first);
        Ok(ObjectLights { first, count, bounds })
    }

    fn blended(mut self) -> Result<ObjectLists> {
        let scene = self.scene;
        let side_m = PIECE_SIDE * scene.lasting_bounds().diagonal();
        let mut all = Vec::with_capacity(scene.draws.len());
        for (index, draw) in scene.draws.iter().enumerate() {
            let mesh = &scene.meshes[draw.mesh];
            let blends = scene.materials[mesh.material].alpha == AlphaMode::Blend;
            let found = if blends { pieces(draw, mesh, side_m) } else { Vec::new() };
            // On its way a piece may come anywhere in its draw's box.
            let swept = scene.closing.is_some().then(|| scene.swept_bounds(index));
            let lit = |piece: Piece| {
                let lights = self.object(swept.unwrap_or(piece.bounds))?;
                Ok(PieceLights { triangles: piece.triangles, lights })
            };
            all.push(found.into_iter().map(lit).collect::<Result<_>>()?);
        }
        Ok(ObjectLists { entries: self.entries, objects: Vec::new(), pieces: all })
    }
}

/// False: no point of a surface inside `bounds` gets light.
fn reaches(light: &LightBlock, bounds: &Bounds) -> bool {
    let [.., range] = light.intensity;
    if range == 0.0 {
        return true;
    }
    let center = Vec4::from_array(light.position_ws).truncate();
    let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let slack = Vec3::splat(ROUNDING * (farthest + bounds.diagonal()));
    let away = (bounds.min - slack - center).max(center - bounds.max - slack).max(Vec3::ZERO);
    away.length_squared() <= range * range * (1.0 + ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Light, LightKind, Material, Mesh};
    use crate::shading::light;
    use glam::Mat4;
    use proptest::prelude::*;

    /// Triangles of which each is one draw, and as many lights; the last light has no end.
    fn scene(count: u32, seed: u32) -> (Scene, Vec<LightBlock>) {
        let number = |index: u32, axis: u32| 10.0 * sobol_burley::sample(index, axis, seed) - 5.0;
        let point = |index: u32| Vec3::new(number(index, 0), number(index, 1), number(index, 2));
        let mesh = Mesh { indices: vec![0, 1, 2], positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], ..Mesh::default() };
        let draws = (0..count).map(|index| Draw { mesh: 0, world_from_object: Mat4::from_translation(point(index)) });
        let light = |index: u32| Light {
            name: String::new(),
            kind: if index + 1 == count { LightKind::Directional } else { LightKind::Point },
            intensity: Vec3::ONE,
            position: point(count + index),
            direction: -Vec3::Y,
            range: Some(0.5 + number(index, 3).abs()),
            radius: 0.0,
        };
        let lights = (0..count).map(|index| light::block(&light(index), 0.0)).collect();
        let materials = vec![Material::default()];
        (Scene { meshes: vec![mesh], draws: draws.collect(), materials, ..Scene::default() }, lights)
    }

    /// The same triangles as one draw, which blends.
    fn blended(count: u32, seed: u32) -> (Scene, Vec<LightBlock>) {
        let (mut scene, lights) = scene(count, seed);
        let corners = |draw: &Draw| {
            scene.meshes[0].positions.iter().map(|at| draw.world_from_object.transform_point3(*at)).collect::<Vec<_>>()
        };
        let positions = scene.draws.iter().flat_map(corners).collect();
        scene.meshes = vec![Mesh { indices: (0..3 * count).collect(), positions, ..Mesh::default() }];
        scene.draws = vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }];
        scene.materials[0].alpha = AlphaMode::Blend;
        (scene, lights)
    }

    proptest! {
        /// What gives any of the object's points light is in its list, and the lists together are shorter than all.
        #[test]
        fn a_light_that_is_left_out_gives_nothing(seed in 0u32..1000) {
            let (scene, lights) = scene(20, seed);
            let lists = ObjectLists::new(&scene, &lights, ListChoice::Object, 1 << 20).unwrap();
            for (draw, object) in scene.draws.iter().zip(&lists.objects) {
                let corner = draw.world_from_object.transform_point3(Vec3::ZERO);
                require_all_that_give(&lists, object, corner, &lights)?;
            }
            let [mean, most] = lists.lights_per_object();
            prop_assert!(mean <= most && mean < 20.0, "{mean} {most}");
        }

        /// The same of pieces, whose lists are far shorter than that of their draw.
        #[test]
        fn a_piece_has_the_lights_that_reach_it(seed in 0u32..1000) {
            let (scene, lights) = blended(20, seed);
            let lists = ObjectLists::new(&scene, &lights, ListChoice::Object, 1 << 20).unwrap();
            let alone = ObjectLists::blended(&scene, &lights, ListChoice::Object, 1 << 20).unwrap();
            prop_assert!(alone.objects.is_empty() && alone.lights_per_piece() == lists.lights_per_piece());
            for piece in &lists.pieces[0] {
                for triangle in piece.triangles.clone() {
                    let [corner, ..] = scene.meshes[0].triangle(triangle as usize);
                    require_all_that_give(&lists, &piece.lights, corner, &lights)?;
                }
            }
            let ([mean, most], [of_draw, _]) = (lists.lights_per_piece(), lists.lights_per_object());
            prop_assert!(mean <= most && mean < of_draw, "{mean} {most} {of_draw}");
        }
    }

    /// Every light that gives a point of the triangle at `corner` light is in `object`'s list.
    fn require_all_that_give(
        lists: &ObjectLists,
        object: &ObjectLights,
        corner: Vec3,
        lights: &[LightBlock],
    ) -> Result<(), TestCaseError> {
        let list = &lists.entries[object.first as usize..][..object.count as usize];
        prop_assert!(list.is_sorted_by(|a, b| a < b));
        for (index, light) in (0u32..).zip(lights) {
            let gives = (0..64u32).any(|step| {
                let (u, v) = (step as f32 % 8.0 / 7.0, (step / 8) as f32 / 7.0);
                let at = corner + Vec3::new(u, v * (1.0 - u), 0.0);
                light::incident_from(light, at.clamp(object.bounds.min, object.bounds.max)).2 != Vec3::ZERO
            });
            prop_assert!(!gives || list.contains(&index), "light {index}");
        }
        prop_assert!(list.contains(&19), "directional light is everywhere");
        Ok(())
    }

    #[test]
    fn equal_lists_are_one() {
        let (mut scene, lights) = scene(6, 1);
        scene.draws = vec![scene.draws[0]; 4];
        let lists = ObjectLists::new(&scene, &lights, ListChoice::Object, 1 << 20).unwrap();
        assert_eq!(lists.entries.len(), lists.objects[0].count as usize);
        let all = ObjectLists::new(&scene, &lights, ListChoice::None, 1 << 20).unwrap();
        assert_eq!((all.entries.len(), all.lights_per_object()), (6, [6.0, 6.0]));
        let error = ObjectLists::new(&scene, &lights, ListChoice::None, 23).unwrap_err();
        assert!(error.exit_code() == 4 && error.to_string().contains("4 draws under 6 lights"), "{error}");
    }
}

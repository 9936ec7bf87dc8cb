//! Lists of lights for objects, made on the host: for each draw those whose range reaches the box around it.
//!
//! Beyond its range a light adds exactly 0, so a list that leaves it out changes no bit of the picture. Directional
//! lights, and those that never end, are in every list. A spot counts as the sphere of its range: its cone is not looked
//! at. Draws with equal lists share one.
//!
//! Shaders hold the points of an object inside its box, with lists or without: interpolated positions lie beside their
//! triangle by rounding, and where a pixel has several samples by more than that even if they are asked for at a covered
//! sample: on lavapipe of Mesa 22 a pixel of an edge was lit by a lamp that reaches no point of its object.

use crate::error::{Error, Result};
use crate::gpu::shader::structs::{LightBlock, ObjectLightsBlock};
use crate::scene::{Bounds, Scene};
use crate::units::Bytes;
use bytemuck::Zeroable;
use glam::{Vec3, Vec4};
use std::collections::HashMap;

/// Which lists there are (`--light-lists`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ListChoice {
    /// A list for each draw.
    Object,
    /// One list of every light for all draws: the oracle.
    None,
}

impl ListChoice {
    /// The value of `--light-lists`.
    pub fn from_setting(text: &str) -> Self {
        match text {
            "object" => Self::Object,
            "none" => Self::None,
            other => panic!("--light-lists {other} was checked"),
        }
    }
}

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

/// The lists of all draws.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectLists {
    /// Indices of lights, rising in each list.
    pub entries: Vec<u32>,
    /// By index into `Scene::draws`.
    pub objects: Vec<ObjectLights>,
}

/// Part of a distance, and of the coordinates it is the difference of, that a handful of operations in 32 bits rounds.
const ROUNDING: f32 = 1e-5;

impl ObjectLists {
    /// The lists of `scene`'s draws. `most_bytes`: what a device binds at once.
    ///
    /// Errors: different lists together are longer than that (exit code 4).
    pub fn new(scene: &Scene, lights: &[LightBlock], choice: ListChoice, most_bytes: u64) -> Result<Self> {
        let every = 0..lights.len() as u32;
        let mut lists = Self { entries: Vec::new(), objects: Vec::with_capacity(scene.draws.len()) };
        let mut known: HashMap<Vec<u32>, u32> = HashMap::new();
        for draw in &scene.draws {
            let mut bounds = Bounds::EMPTY;
            draw.extend(&scene.meshes[draw.mesh], &mut bounds);
            let is_in = |index: &u32| choice == ListChoice::None || reaches(&lights[*index as usize], &bounds);
            let list: Vec<u32> = every.clone().filter(is_in).collect();
            let count = list.len() as u32;
            let first = match known.get(&list) {
                Some(first) => *first,
                None => {
                    let first = lists.entries.len() as u32;
                    let bytes = (lists.entries.len() + list.len()) as u64 * size_of::<u32>() as u64;
                    if bytes > most_bytes {
                        return Err(Error::memory(format!(
                            "the lists of {} draws under {} lights are longer than {}, which this device binds at once",
                            scene.draws.len(),
                            lights.len(),
                            Bytes(most_bytes)
                        ))
                        .note("--light-lists none has one list for all; fewer --lights would fit"));
                    }
                    lists.entries.extend(&list);
                    known.insert(list, first);
                    first
                }
            };
            lists.objects.push(ObjectLights { first, count, bounds });
        }
        Ok(lists)
    }

    /// Lights of a draw's list, on average and at most; 0 where nothing is drawn.
    pub fn lights_per_object(&self) -> [f64; 2] {
        let counts = || self.objects.iter().map(|object| f64::from(object.count));
        [counts().sum::<f64>() / self.objects.len().max(1) as f64, counts().fold(0.0, f64::max)]
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
    use crate::scene::{Draw, Light, LightKind, Mesh};
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
        };
        let lights = (0..count).map(|index| light::block(&light(index), 0.0)).collect();
        (Scene { meshes: vec![mesh], draws: draws.collect(), ..Scene::default() }, lights)
    }

    proptest! {
        /// What gives any of the object's points light is in its list, and the lists together are shorter than all.
        #[test]
        fn a_light_that_is_left_out_gives_nothing(seed in 0u32..1000) {
            let (scene, lights) = scene(20, seed);
            let lists = ObjectLists::new(&scene, &lights, ListChoice::Object, 1 << 20).unwrap();
            for (draw, object) in scene.draws.iter().zip(&lists.objects) {
                let list = &lists.entries[object.first as usize..][..object.count as usize];
                prop_assert!(list.is_sorted_by(|a, b| a < b));
                for (index, light) in (0u32..).zip(&lights) {
                    let gives = (0..64u32).any(|step| {
                        let (u, v) = (step as f32 % 8.0 / 7.0, (step / 8) as f32 / 7.0);
                        let at = draw.world_from_object.transform_point3(Vec3::new(u, v * (1.0 - u), 0.0));
                        light::incident_from(light, at.clamp(object.bounds.min, object.bounds.max)).2 != Vec3::ZERO
                    });
                    prop_assert!(!gives || list.contains(&index), "light {index}");
                }
                prop_assert!(list.contains(&19), "directional light is everywhere");
            }
            let [mean, most] = lists.lights_per_object();
            prop_assert!(mean <= most && mean < 20.0, "{mean} {most}");
        }
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

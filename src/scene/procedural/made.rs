//! A built-in scene once made: what stands still, and what of it turns with time.

use glam::{Mat4, Quat, Vec3};

use crate::error::Result;
use crate::scene::animation::{AnimationChoice, Curve, Interpolation};
use crate::scene::{Bounds, Scene, gltf};

/// For how long a built-in scene moves; then it stands still, as an animated file does after its last key.
const DURATION_S: u32 = 60;

/// In how many moments of a turn it is looked at for where the scene reaches.
const REACH_PARTS: u32 = 8;

/// A draw that turns about an axis upward through its own origin; an animation of the scene.
#[derive(Clone, Debug)]
pub struct Spin {
    pub name: &'static str,
    /// Index into `Scene::draws`.
    pub draw: usize,
    /// Where the draw's origin stands, metres.
    pub translation: Vec3,
    /// Of quaternions x, y, z, w; between keys the shorter arc.
    pub curve: Curve,
    turn_s: u32,
}

impl Spin {
    /// Turns once in `turn_s` seconds, from +z toward +x.
    pub fn new(name: &'static str, draw: usize, translation: Vec3, turn_s: u32) -> Self {
        // Quarters: the shorter arc between two keys is then the way round.
        const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
        let quarters = [[0.0, 0.0, 0.0, 1.0], [0.0, HALF, 0.0, HALF], [0.0, 1.0, 0.0, 0.0], [0.0, HALF, 0.0, -HALF]];
        let key_count = 4 * DURATION_S / turn_s + 1;
        let times_s = (0..key_count).map(|key| (key * turn_s) as f32 * 0.25).collect();
        let values = (0..key_count as usize).flat_map(|key| quarters[key % 4]).collect();
        let curve = Curve::new(Interpolation::Linear, times_s, values, 4).expect("as many keys as values, ascending");
        Self { name, draw, translation, curve, turn_s }
    }

    fn world_from_object(&self, time_s: f64) -> Mat4 {
        // As glTF composes a node, so that a scene that is written and read stands where it stood.
        let rotation: Quat = self.curve.rotation_at(time_s);
        Mat4::from_scale_rotation_translation(Vec3::ONE, rotation, self.translation)
    }
}

/// A scene at rest, and what turns in it.
#[derive(Clone, Debug)]
pub struct Made {
    pub scene: Scene,
    pub spins: Vec<Spin>,
}

impl Made {
    /// The same with only those turning that `choice` names.
    ///
    /// Errors: there is none of that name (exit code 2).
    pub fn playing(mut self, choice: &AnimationChoice) -> Result<Self> {
        match choice {
            AnimationChoice::All => {}
            AnimationChoice::None => self.spins.clear(),
            AnimationChoice::One(name) => {
                let by_name = self.spins.iter().position(|spin| spin.name == name);
                let index = by_name.or_else(|| name.parse().ok()).filter(|index| *index < self.spins.len());
                let Some(index) = index else {
                    return Err(gltf::no_such_animation(name, self.spins.iter().map(|spin| Some(spin.name))));
                };
                self.spins = vec![self.spins.swap_remove(index)];
            }
        }
        self.scene.reach = self.reach();
        Ok(self)
    }

    /// The scene at `time_s`, seconds, at least 0. Its hash covers the time where something turns.
    pub fn into_pose(self, time_s: f64) -> Scene {
        let Self { mut scene, spins } = self;
        for spin in &spins {
            scene.draws[spin.draw].world_from_object = spin.world_from_object(time_s);
        }
        if !spins.is_empty() {
            let names: Vec<&str> = spins.iter().map(|spin| spin.name).collect();
            let identity = format!("{} time={time_s} playing={}", scene.hash, names.join(","));
            scene.hash = blake3::hash(identity.as_bytes()).to_hex().to_string();
        }
        scene
    }

    /// Where the scene reaches while it turns; None where nothing does.
    fn reach(&self) -> Option<Bounds> {
        let longest_s = self.spins.iter().map(|spin| spin.turn_s).max()?;
        let mut reach = self.scene.bounds();
        for part in 0..REACH_PARTS {
            let time_s = f64::from(longest_s) * f64::from(part) / f64::from(REACH_PARTS);
            for spin in &self.spins {
                let mut draw = self.scene.draws[spin.draw];
                draw.world_from_object = spin.world_from_object(time_s);
                draw.extend(&self.scene.meshes[draw.mesh], &mut reach);
            }
        }
        Some(reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Mesh};

    fn made() -> Made {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let meshes = vec![Mesh { positions, indices: vec![0, 1, 2], ..Mesh::default() }];
        let draws = vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }; 2];
        let scene = Scene { hash: "a hash".to_owned(), meshes, draws, ..Scene::default() };
        Made { scene, spins: vec![Spin::new("wheel", 1, Vec3::new(5.0, 0.0, 0.0), 2)] }
    }

    fn tip(time_s: f64) -> Vec3 {
        made().into_pose(time_s).draws[1].world_from_object.transform_point3(Vec3::X)
    }

    #[test]
    fn a_spin_turns_evenly_from_z_toward_x_and_stops() {
        // x goes to -z: that is from +z toward +x.
        let (right, front) = (Vec3::new(6.0, 0.0, 0.0), Vec3::new(5.0, 0.0, -1.0));
        for (time_s, place) in [
            (0.0, right),
            (0.25, Vec3::new(5.0 + 0.5f32.sqrt(), 0.0, -(0.5f32.sqrt()))),
            (0.5, front),
            (2.0, right),
            (58.5, front),
            (60.0, right),
            (61.0, right),
        ] {
            assert!(tip(time_s).abs_diff_eq(place, 1e-5), "{time_s} s: {}", tip(time_s));
        }
        assert_eq!(made().into_pose(0.3).draws[0].world_from_object, Mat4::IDENTITY);
    }

    #[test]
    fn what_plays_is_chosen_by_name_or_index_and_stands_in_the_hash() {
        let playing = |choice: &str| made().playing(&AnimationChoice::parse(choice));
        for choice in ["all", "wheel", "0"] {
            let playing = playing(choice).unwrap();
            // It sweeps a circle of 1 m around x = 5 m, and there is a triangle that stands.
            let reach = playing.scene.reach.unwrap();
            assert!(reach.min.abs_diff_eq(Vec3::new(0.0, 0.0, -1.0), 1e-6), "{reach:?}");
            assert!(reach.max.abs_diff_eq(Vec3::new(6.0, 1.0, 1.0), 1e-6), "{reach:?}");
            assert_ne!(playing.clone().into_pose(0.5).hash, playing.into_pose(0.75).hash);
        }
        let still = playing("none").unwrap();
        assert!(still.scene.reach.is_none());
        assert_eq!(still.clone().into_pose(0.5).hash, still.into_pose(0.75).hash);
        let error = playing("door").unwrap_err();
        assert!(error.to_string().contains("an index below 1, or a name work: wheel"), "{error}");
        assert!(playing("1").is_err());
    }
}

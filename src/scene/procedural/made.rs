//! A built-in scene once made: what stands still, and what of it moves with time.

use glam::{Mat4, Quat, Vec3};

use super::curves;
use crate::error::Result;
use crate::scene::animation::{AnimationChoice, Curve};
use crate::scene::{Bounds, Facing, Scene, gltf};

/// Number of moments of its period at which a thing is sampled for the scene's bounds.
const REACH_PARTS: u32 = 8;

/// Which thing of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thing {
    /// Index into `Scene::draws`.
    Draw(usize),
    /// Index into `Scene::lights`, of a point light: it only goes somewhere else.
    Light(usize),
    /// Index into `Scene::cameras`.
    Camera(usize),
}

/// A thing that moves; an animation of the scene.
#[derive(Clone, Debug)]
pub struct Motion {
    pub name: String,
    pub thing: Thing,
    /// Where the thing's origin stands, metres, where `translations` is None.
    translation: Vec3,
    /// Translation, three numbers in metres.
    pub translations: Option<Curve>,
    /// Rotation, a quaternion x, y, z, w. None: the orientation of its own space stays.
    pub rotations: Option<Curve>,
    /// After how many seconds it has been wherever it goes.
    period_s: u32,
}

impl Motion {
    /// Once about `axis`, of unit length, through its own origin at `at` in `turn_s` seconds, counter-clockwise as seen
    /// from the axis' tip: about y from +z toward +x.
    pub fn turning(name: &str, thing: Thing, at: Vec3, axis: Vec3, turn_s: u32) -> Self {
        let rotations = Some(curves::turns(axis, turn_s));
        Self { name: name.to_owned(), thing, translation: at, translations: None, rotations, period_s: turn_s }
    }

    /// Along `translations`, which repeats after `period_s`, turned by `rotations`, if any.
    pub fn along(name: &str, thing: Thing, translations: Curve, rotations: Option<Curve>, period_s: u32) -> Self {
        let translation = translations.vector_at(0.0);
        Self { name: name.to_owned(), thing, translation, translations: Some(translations), rotations, period_s }
    }

    /// Where the thing's origin stands at `time_s`, metres.
    pub fn translation_at(&self, time_s: f64) -> Vec3 {
        self.translations.as_ref().map_or(self.translation, |curve| curve.vector_at(time_s))
    }

    /// How the thing is turned at `time_s`.
    pub fn rotation_at(&self, time_s: f64) -> Quat {
        self.rotations.as_ref().map_or(Quat::IDENTITY, |curve| curve.rotation_at(time_s))
    }

    /// World from the thing's own space at `time_s`, seconds.
    pub fn place_at(&self, time_s: f64) -> Mat4 {
        // As glTF composes a node, so that a scene that is written and read stands where it stood.
        Mat4::from_scale_rotation_translation(Vec3::ONE, self.rotation_at(time_s), self.translation_at(time_s))
    }
}

/// A scene at rest, and what moves in it.
#[derive(Clone, Debug)]
pub struct ProceduralScene {
    pub scene: Scene,
    pub motions: Vec<Motion>,
}

impl ProceduralScene {
    /// The same with only those moving that `choice` names.
    ///
    /// Errors: there is none of that name (exit code 2).
    pub fn playing(mut self, choice: &AnimationChoice) -> Result<Self> {
        match choice {
            AnimationChoice::All => {}
            AnimationChoice::None => self.motions.clear(),
            AnimationChoice::One(name) => {
                let by_name = self.motions.iter().position(|motion| motion.name == *name);
                let index = by_name.or_else(|| name.parse().ok()).filter(|index| *index < self.motions.len());
                let Some(index) = index else {
                    let names = self.motions.iter().map(|motion| Some(motion.name.as_str()));
                    return Err(gltf::no_such_animation(name, names));
                };
                self.motions = vec![self.motions.swap_remove(index)];
            }
        }
        self.scene.reach = self.reach();
        self.scene.facing = self.scene.reach.map(|_| Facing::of(&self.scene));
        Ok(self)
    }

    /// The scene at `time_s`, seconds, at least 0. Its hash covers the time where something moves.
    pub fn into_pose(self, time_s: f64) -> Scene {
        let Self { mut scene, motions } = self;
        for motion in &motions {
            let place = motion.place_at(time_s);
            match motion.thing {
                Thing::Draw(index) => scene.draws[index].world_from_object = place,
                Thing::Light(index) => scene.lights[index].position = motion.translation_at(time_s),
                Thing::Camera(index) => scene.cameras[index].world_from_view = place,
            }
        }
        if !motions.is_empty() {
            let names: Vec<&str> = motions.iter().map(|motion| motion.name.as_str()).collect();
            let identity = format!("{} time={time_s} playing={}", scene.hash, names.join(","));
            scene.hash = blake3::hash(identity.as_bytes()).to_hex().to_string();
        }
        scene
    }

    /// Where the scene reaches while its draws move; None where nothing moves.
    fn reach(&self) -> Option<Bounds> {
        if self.motions.is_empty() {
            return None;
        }
        let mut reach = self.scene.bounds();
        for motion in &self.motions {
            let Thing::Draw(index) = motion.thing else { continue };
            let mut draw = self.scene.draws[index];
            for part in 0..REACH_PARTS {
                let time_s = f64::from(motion.period_s) * f64::from(part) / f64::from(REACH_PARTS);
                draw.world_from_object = motion.place_at(time_s);
                draw.extend(&self.scene.meshes[draw.mesh], &mut reach);
            }
        }
        Some(reach)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Draw, Material, Mesh, Projection};
    use glam::DVec3;

    fn made() -> ProceduralScene {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let meshes = vec![Mesh { positions, indices: vec![0, 1, 2], ..Mesh::default() }];
        let draws = vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }; 2];
        let materials = vec![Material::default()];
        let scene = Scene { hash: "a hash".to_owned(), meshes, draws, materials, ..Scene::default() };
        let wheel = Motion::turning("wheel", Thing::Draw(1), Vec3::new(5.0, 0.0, 0.0), Vec3::Y, 2);
        ProceduralScene { scene, motions: vec![wheel] }
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
    fn a_camera_flies_and_what_it_flies_past_stands() {
        let mut made = made();
        let projection = Projection::Orthographic { x_mag: 1.0, y_mag: 1.0, z_near: 0.0, z_far: 1.0 };
        let camera = Camera { name: "bird".to_owned(), world_from_view: Mat4::IDENTITY, projection };
        made.scene.cameras = vec![camera];
        let path = curves::to_and_fro([DVec3::ZERO, DVec3::X * 100.0], 20);
        let turn = curves::turns(Vec3::X, 20);
        made.motions.push(Motion::along("flight", Thing::Camera(0), path, Some(turn), 20));
        let made = made.playing(&AnimationChoice::parse("flight")).unwrap();
        // The triangles alone: where a camera goes nothing is drawn.
        assert_eq!(made.scene.reach, Some(made.scene.bounds()));
        let pose = made.clone().into_pose(5.0);
        let view = pose.cameras[0].world_from_view;
        assert!(view.transform_point3(Vec3::Y).abs_diff_eq(Vec3::new(50.0, 0.0, 1.0), 1e-4), "{view}");
        assert_eq!(pose.draws[1].world_from_object, Mat4::IDENTITY);
        assert_ne!(pose.hash, made.into_pose(6.0).hash);
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

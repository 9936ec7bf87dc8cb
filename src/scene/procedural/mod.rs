//! Scenes that the program makes itself, seeded: the same on every machine.

mod arena;
mod assembly;
mod built_ins;
mod charts;
mod chess;
mod cornell;
mod curves;
mod desk;
mod fence;
mod hall;
mod lamps;
mod made;
mod office;
pub mod panel;
mod patch;
mod patterns;
mod pictures;
mod pieces;
mod power;
mod room;
mod shapes;
mod shirley;
mod solids;
mod specimen;

#[cfg(test)]
mod checks;
mod values;
mod wares;
mod zone_plate;

use crate::error::{Error, Result};
use crate::scene::{AnimationChoice, Scene, normal_groups};
use assembly::Assembly;
use rayon::prelude::*;
use values::Values;

pub use built_ins::{ALL, BuiltIn};
pub use made::{Motion, ProceduralScene, Thing};
pub use values::{Choice, Parameter, SEED};

/// Goes into every hash; raised whenever a generator makes something else from the same parameters.
const GENERATOR_VERSION: u32 = 1;

impl BuiltIn {
    fn values(&self, arguments: Option<&str>) -> Result<Values> {
        let mut values: Vec<_> =
            self.parameters.iter().map(|parameter| (parameter.key, parameter.choice.default())).collect();
        for argument in arguments.into_iter().flat_map(|arguments| arguments.split(',')) {
            let Some((key, text)) = argument.split_once('=') else {
                return Err(self.refusal(&format!("'{argument}' is not key=value")));
            };
            let known = self.parameters.iter().chain([&SEED]).find(|parameter| parameter.key == key);
            let Some(parameter) = known else {
                return Err(self.refusal(&format!("there is no parameter '{key}'")));
            };
            let choice = parameter.choice;
            let Some(value) = choice.parse(text) else {
                let kind = if let Choice::Number { .. } | Choice::Seed = choice { "a whole number, " } else { "" };
                return Err(self.refusal(&format!("{key}={text}: must be {kind}{}", choice.described())));
            };
            values.retain(|(known, _)| known != &parameter.key);
            values.push((parameter.key, value));
        }
        Ok(Values(values))
    }

    fn refusal(&self, trouble: &str) -> Error {
        let error = Error::request(format!("scene {}: {trouble}", self.name));
        let error = self.parameters.iter().fold(error, |error, parameter| {
            let Parameter { key, description, choice } = parameter;
            error.note(format!("{key}={}: {description}", choice.described()))
        });
        error.note(format!("seed={}: {}", SEED.choice.described(), SEED.description))
    }

    /// What stands after the colon of a scene's name: every parameter, but for switches that are off.
    fn settings(&self, values: &Values) -> String {
        let one =
            |parameter: &Parameter| format!("{}={}", parameter.key, parameter.choice.text(values.get(parameter.key)));
        let named = self.parameters.iter().filter(|parameter| parameter.choice.is_named(values.get(parameter.key)));
        named.map(one).collect::<Vec<_>>().join(",")
    }
}

/// Makes the scene that `spec` names: `name` or `name:key=value,key=value`.
///
/// None where no built-in scene has that name: it may be a file. The error lists the parameters with what they may be
/// where one is unknown or not that. The same spec and seed give the same bytes everywhere; a seed in the spec stands for `seed`.
pub fn open(spec: &str, seed: u64) -> Option<Result<ProceduralScene>> {
    let (name, arguments) = match spec.split_once(':') {
        Some((name, arguments)) => (name, Some(arguments)),
        None => (spec, None),
    };
    let built_in = ALL.iter().find(|built_in| built_in.name == name)?;
    let made = built_in.values(arguments).and_then(|values| {
        let seed = values.seed().unwrap_or(seed);
        let Assembly { mut scene, motions } = (built_in.make)(&values, seed);
        scene.meshes.par_iter_mut().for_each(normal_groups::assign);
        let settings = built_in.settings(&values);
        scene.name = if settings.is_empty() { name.to_owned() } else { format!("{name}:{settings}") };
        let identity = format!("{} seed={seed} version={GENERATOR_VERSION}", scene.name);
        scene.hash = blake3::hash(identity.as_bytes()).to_hex().to_string();
        if values.seed().is_some() {
            let separator = if settings.is_empty() { ':' } else { ',' };
            scene.name.extend([separator.to_string(), format!("{}={seed}", SEED.key)]);
        }
        ProceduralScene { scene, motions }.playing(&AnimationChoice::All)
    });
    Some(made)
}

/// The scene of `open` at 0 s.
pub fn build(spec: &str, seed: u64) -> Option<Result<Scene>> {
    Some(open(spec, seed)?.map(|made| made.into_pose(0.0)))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::scene::shell::Shell;
    use crate::scene::{AlphaMode, Material};

    fn made(spec: &str, seed: u64) -> Scene {
        build(spec, seed).expect("the name is known").expect("the parameters are good")
    }

    #[test]
    fn every_default_scene_is_sound_and_made_the_same_twice() {
        for built_in in ALL {
            let scene = made(built_in.name, 1);
            checks::assert_scene_is_sound(&scene);
            // The hall takes seconds: a smaller one is made by the same code.
            let spec = if built_in.name == "hall" { "hall:triangles=20000" } else { built_in.name };
            let [first, second] = [made(spec, 1), made(spec, 1)].map(|scene| (checks::fingerprint(&scene), scene.hash));
            assert_eq!(first, second, "{spec}");
        }
    }

    /// A seed of its own is that of `--seed`, whatever that is then.
    #[test]
    fn a_scene_has_the_seed_that_it_is_asked_for() {
        let [seven, own] = [made("lamps:lights=3", 7), made("lamps:lights=3,seed=7", 1)];
        assert_eq!((checks::fingerprint(&own), &own.hash), (checks::fingerprint(&seven), &seven.hash));
        assert_eq!(own.name, format!("{},seed=7", seven.name));
        assert_eq!(made(&own.name, 2).hash, own.hash);
        assert_eq!(made("specimen:seed=3", 1).name, "specimen:seed=3");
        for (text, said) in
            [("-1", "seed=-1: must be a whole number, 0 to 4294967295"), ("4294967296", "default --seed")]
        {
            let error = open(&format!("cornell:seed={text}"), 1).unwrap().unwrap_err();
            assert!(error.exit_code() == 2 && error.to_string().contains(said), "{error}");
        }
    }

    #[test]
    fn cornell_has_its_walls_its_blocks_and_its_panel() {
        let scene = made("cornell", 1);
        // Four walls, the ceiling around the panel, and the blocks.
        assert_eq!(scene.triangle_count(), 2 * (4 + 4 + 1 + 2 * 5));
        assert_eq!((scene.lights.len(), scene.cameras.len()), (1, 1));
        let bounds = scene.bounds();
        assert!((bounds.max - bounds.min).abs_diff_eq(glam::vec3(5.56, 5.488, 5.592), 1e-5), "{bounds:?}");
    }

    #[test]
    fn the_lamp_of_cornell_circles_under_its_panel() {
        let [plain, off] = ["cornell", "cornell:motion=off"].map(|spec| made(spec, 1));
        assert_eq!((off.name.as_str(), &off.hash), ("cornell", &plain.hash));
        assert_eq!(plain.hash, "d8f0204d37e017200c1454bb2b6d3750306e9c844cbf2332a90b85c52cf524b4");
        let circling = open("cornell:motion=on", 1).expect("a name").expect("a parameter");
        assert_eq!(circling.scene.name, "cornell:motion=on");
        let panel = circling.scene.draws.len() - 1;
        let home = plain.lights[0].position;
        for step in 0..40 {
            let pose = circling.clone().into_pose(f64::from(step) * 0.1);
            checks::assert_scene_is_sound(&pose);
            let lamp = pose.lights[0].position;
            // What stands for the panel stays 5 cm below its middle.
            let bounds = pose.draws[panel].bounds(&pose.meshes[pose.draws[panel].mesh]);
            assert!((bounds.center() - lamp).abs_diff_eq(glam::vec3(0.0, 0.05, 0.0), 1e-4), "{step}: {lamp}");
            assert!(((lamp - home).length() - 1.2).abs() < 0.03, "{step}: {lamp}");
            // It stays inside: what moves is in the box of what stands.
            let (all, still) = (pose.bounds(), plain.bounds());
            assert!(all.min.cmpge(still.min - 1e-4).all() && all.max.cmple(still.max + 1e-4).all(), "{all:?}");
            assert_eq!(pose.draws[..panel].len(), plain.draws.len() - 1);
        }
        let [start, quarter, later] = [0.0, 1.0, 4.0].map(|time_s| circling.clone().into_pose(time_s));
        assert!(start.lights[0].position.distance(quarter.lights[0].position) > 1.5);
        assert_eq!(start.lights[0].position, later.lights[0].position);
        assert!(start.hash != quarter.hash && start.hash != plain.hash);
    }

    #[test]
    fn the_hall_has_the_triangles_that_it_was_asked_for() {
        for wanted in [hall::LEAST_TRIANGLES, 5000, 80_000, 256_000, 4_000_000] {
            let count = hall::planned_triangle_count(wanted);
            assert!(count.abs_diff(wanted) * 20 <= wanted, "{wanted} asked for, {count} planned");
        }
        for wanted in [5000, 80_000] {
            let scene = made(&format!("hall:triangles={wanted}"), 1);
            checks::assert_scene_is_sound(&scene);
            assert_eq!(scene.triangle_count(), hall::planned_triangle_count(wanted));
        }
    }

    #[test]
    fn a_hall_in_fewer_draws_is_the_same_hall() {
        let [whole, joined] = ["", ",draws=100"].map(|more| made(&format!("hall:triangles=20000{more}"), 1));
        checks::assert_scene_is_sound(&joined);
        assert_eq!((joined.draws.len(), joined.triangle_count()), (100, whole.triangle_count()));
        // What is moved in 64 bits instead of 32 may be a rounding elsewhere.
        let (joined, whole) = (joined.bounds(), whole.bounds());
        assert!(joined.min.abs_diff_eq(whole.min, 1e-5) && joined.max.abs_diff_eq(whole.max, 1e-5), "{joined:?}");
        let dark = made("hall:triangles=20000,lights=3", 1);
        assert_eq!((dark.lights.len(), dark.lights[2].name.as_str()), (3, "nave_lamp_2"));
        checks::assert_scene_is_sound(&dark);
    }

    #[test]
    fn the_hall_has_materials_and_lamps_of_many_kinds() {
        let scene = made("hall:triangles=20000", 1);
        let used: BTreeSet<usize> = scene.meshes.iter().map(|mesh| mesh.material).collect();
        assert!(used.len() >= 24 && used.len() == scene.materials.len(), "{} materials", used.len());
        assert!((8..=24).contains(&scene.lights.len()), "{} lights", scene.lights.len());
        let has = |wanted: fn(&Material) -> bool| scene.materials.iter().any(wanted);
        assert!(has(|material| matches!(material.alpha, AlphaMode::Mask { .. })));
        assert!(has(|material| material.alpha == AlphaMode::Blend));
        assert!(has(|material| material.metallic_roughness_texture.is_some()));
        assert!(has(Material::is_emissive));
    }

    #[test]
    fn lamps_has_its_numbers_and_follows_its_seed() {
        let scene = made("lamps:lights=7,objects=12", 3);
        assert_eq!(scene.name, "lamps:objects=12,lights=7");
        assert_eq!(scene.lights.len(), 7);
        // Beside the objects there is the ground.
        assert_eq!(scene.draws.len(), 13);
        let other = made("lamps:lights=7,objects=12", 4);
        assert_ne!(checks::fingerprint(&scene), checks::fingerprint(&other));
        assert_ne!(scene.hash, other.hash);
        checks::assert_scene_is_sound(&made("lamps:objects=5000,lights=5000", 1));
        checks::assert_scene_is_sound(&made("lamps:objects=1,lights=1", 1));
    }

    /// Clarberg & Munkberg 2014, table 1: thousands of triangles, draws, lights.
    #[test]
    fn the_scenes_of_table_1_have_its_numbers() {
        for (name, spec, triangles, draws, lights) in [
            ("ARENA", "arena", 528_000, 855, 64),
            ("SPONZA", "hall:lights=16,draws=392", 256_000, 392, 16),
            ("POWER", "power", 111_000, 286, 1),
            ("CHESS", "chess", 46_000, 19, 16),
        ] {
            let scene = made(spec, 1);
            let count = scene.triangle_count();
            assert!(count.abs_diff(triangles) * 100 <= triangles, "{name}: {count} triangles");
            assert_eq!((scene.draws.len(), scene.lights.len()), (draws, lights), "{name}");
        }
    }

    #[test]
    fn who_stands_in_the_hall_of_power_sees_its_roof() {
        let scene = made("power:triangles=30000", 1);
        for name in ["roof_sheet", "light_strip"] {
            let mesh = scene.meshes.iter().find(|mesh| mesh.name == name).expect("it has a roof");
            assert!(mesh.normals.iter().all(|normal| normal.y < -0.5), "{name}");
        }
    }

    #[test]
    fn what_moves_in_the_arena_stays_in_it() {
        let ProceduralScene { scene, motions } =
            open("arena:triangles=60000", 1).expect("a name").expect("good parameters");
        checks::assert_scene_is_sound(&scene);
        let named = |start: &str| motions.iter().filter(|motion| motion.name.starts_with(start)).count();
        assert_eq!([named("crown"), named("lantern"), motions.len()], [16, 12, 3 + 16 + 12 + 4 + 1]);
        // Nothing leaves the vault, through which rods of lanterns and raised gates could stick.
        let (still, reach) = (scene.bounds(), scene.reach.expect("things move"));
        assert!(reach.min.abs_diff_eq(still.min, 1e-4) && reach.max.abs_diff_eq(still.max, 1e-4), "{reach:?}");
        let flight = motions.last().expect("the camera is added last");
        assert_eq!(flight.thing, Thing::Camera(3));
        for step in 0..600 {
            let at = flight.translation_at(f64::from(step) * 0.1);
            // Between stage and walls, over the parapet and under the vault.
            let radius_m = at.x.hypot(at.z);
            assert!((4.6..11.0).contains(&radius_m) && (1.3..7.6).contains(&at.y), "{at}");
        }
    }

    #[test]
    fn the_men_that_move_stand_on_squares_and_the_camera_circles() {
        let ProceduralScene { scene, motions } =
            open("chess:triangles=12000", 1).expect("a name").expect("good parameters");
        let names: Vec<&str> = motions.iter().map(|motion| motion.name.as_str()).collect();
        assert_eq!(names, ["queen", "bishop", "knight", "pawn", "circling"]);
        checks::assert_scene_is_sound(&scene);
        for motion in &motions[..4] {
            let Thing::Draw(draw) = motion.thing else { panic!("{} is a man", motion.name) };
            let [from, halfway] = [0.0, 1.0].map(|time_s| motion.translation_at(time_s));
            // A square's middle is an odd number of 3 cm from the board's.
            assert!([from.x, from.z].iter().all(|at| ((at / 0.06).abs() - 0.5).fract().abs() < 1e-3), "{from}");
            assert!(from.y == 0.0 && halfway.distance(from) > 0.02, "{}: {from} to {halfway}", motion.name);
            assert_eq!(scene.draws[draw].world_from_object, motion.place_at(0.0));
        }
        assert!(least_cosine(&motions[4], glam::Vec3::ZERO) > 0.95);
    }

    /// The least cosine, over its way, of the angle between where a camera looks and where `toward` is from it.
    fn least_cosine(motion: &Motion, toward: glam::Vec3) -> f32 {
        let cosine = |step: u32| {
            let time_s = f64::from(step) * 0.37;
            let way = (toward - motion.translation_at(time_s)).normalize();
            (motion.rotation_at(time_s) * glam::Vec3::NEG_Z).dot(way)
        };
        (0..160).map(cosine).fold(1.0, f32::min)
    }

    #[test]
    fn the_fence_has_its_lamps_its_wire_its_glass_and_a_rotor_that_casts_shadows() {
        let ProceduralScene { scene, motions } =
            open("fence", 1).expect("the name is known").expect("it needs no parameters");
        assert_eq!((scene.lights.len(), scene.name.as_str()), (122, "fence:lights=122,alpha=blend"));
        let count = |scene: &Scene, is: fn(&AlphaMode) -> bool| {
            scene.materials.iter().filter(|material| is(&material.alpha)).count()
        };
        let is_mask = |alpha: &AlphaMode| matches!(alpha, AlphaMode::Mask { .. });
        assert_eq!((count(&scene, |alpha| *alpha == AlphaMode::Blend), count(&scene, is_mask)), (9, 0));
        let masked = made("fence:alpha=mask,lights=1", 1);
        assert_eq!((count(&masked, |alpha| *alpha == AlphaMode::Blend), count(&masked, is_mask)), (7, 2));
        assert_eq!(masked.lights.len(), 1);
        checks::assert_scene_is_sound(&masked);
        let [Motion { thing: Thing::Draw(rotor), .. }] = motions.as_slice() else {
            panic!("one thing turns: {motions:?}")
        };
        assert!(Shell::of(&scene.meshes[scene.draws[*rotor].mesh]).is_closed());
        // Above the rotor, so that its shadow falls on what is below.
        assert!(scene.lights[0].position.y > motions[0].translation_at(0.0).y + 1.0);
    }

    #[test]
    fn bad_parameters_are_refused_with_what_would_work() {
        assert!(build("sponza.glb", 1).is_none());
        for (spec, said) in [
            ("lamps:lights=5001", "lights=5001: must be a whole number, 0 to 5000, default 81"),
            ("lamps:lights=", "lights=: must be"),
            ("lamps:lamp=3", "no parameter 'lamp'"),
            ("hall:80000", "'80000' is not key=value"),
            ("hall:triangles=1", "triangles=1: must be"),
            ("cornell:width=3", "no parameter 'width'"),
            ("cornell:motion=yes", "motion=yes: must be off or on, default off"),
            ("fence:alpha=solid", "alpha=solid: must be blend or mask, default blend"),
        ] {
            let error = build(spec, 1).expect("the name is known").expect_err(spec);
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().contains(said), "{spec}: {error}");
        }
        let error = build("lamps:lights=x", 1).expect("the name is known").expect_err("x is not a number");
        assert!(error.to_string().contains("objects=1 to 5000, default 101"), "{error}");
    }
}

//! Stochastic rasterisation that tests all samples of a pixel in a loop and keeps the nearest by 64-bit atomics sees (to the bit,
//! on software drivers) what a layer a tuple with depth tests sees, its oracle: alpha, motion, two eyes and surfaces in one place included.

use super::FRAGMENT;
use crate::support::difference::{require_same, require_same_numbers};
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has};
use glam::{Vec4, vec4};
use quincunx::caps::{Caps, known};
use quincunx::job::Job;
use quincunx::scene::{self, AlphaMode, Draw, Scene};
use quincunx::{study, techniques};

const DEEP: &str = "deep_shading";
const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");
const LOOP: (&str, &str) = ("sample-tests", "loop");
const LAYERS: (&str, &str) = ("sample-tests", "layers");

/// Both methods give the same triangles, pairs, colours and picture.
#[track_caller]
fn require_one_picture(watched: &Watched, changes: Changes<'_>) {
    let gpu = &watched.session.gpu;
    if !has(&gpu.caps, Feature::WideAtomics) {
        return;
    }
    let changes = both(changes, &[STOCHASTIC]);
    let stage = "visibility.spids";
    let [looped, layered] = [LOOP, LAYERS].map(|way| {
        let renderer = watched.render_stages(DEEP, &both(&changes, &[way]), &[stage]);
        assert_eq!(renderer.resolved["sample-tests"], way.1);
        let counters = renderer.measured_counters().unwrap();
        let mut pairs = ["listed_digest", "samples_seen", "shader_invocations"].map(|key| counters.get(key).copied());
        if counters.get("shading_samples_forgotten").is_some_and(|forgotten| *forgotten > 0.0) {
            // Where eight samples have the places of a ninth, who was the first decides what is shaded again.
            pairs[2] = None;
        }
        (watched.integers(&renderer, stage), pairs, renderer.picture().unwrap())
    });
    assert!(looped.0.iter().filter(|id| **id != u32::MAX).count() > looped.0.len() / 4, "{changes:?}");
    require_same_numbers(gpu, &looped.0, &layered.0, &("triangles that samples see", &changes));
    require_same(gpu, &looped.2, &layered.2, &changes);
    if gpu.caps.identity.is_software() {
        assert_eq!(looped.1, layered.1, "{changes:?}");
    }
}

/// Sizes that the table of tuples does not divide.
#[test]
fn a_loop_sees_what_layers_see_sharp_and_under_a_lens() {
    let watched = Watched::open("hall:triangles=8000");
    let size = ("size", "97x55");
    require_one_picture(&watched, &[size]);
    require_one_picture(&watched, &[size, ("aperture", "0.3"), ("focus", "6"), ("polygon-from", "vertex")]);
    require_one_picture(
        &watched,
        &[size, ("spp", "3"), ("tuples", "45"), FRAGMENT, ("zmax", "on"), ("accumulate", "2")],
    );
    let filtered = [size, ("aperture", "0.1"), ("reconstruct", "on"), ("lists", "none")];
    require_one_picture(&watched, &filtered);
}

#[test]
fn a_loop_sees_what_layers_see_while_things_move_with_holes_and_glass() {
    for spec in ["fence:lights=6", "fence:lights=6,alpha=mask"] {
        let watched = Watched::with_scene(moving(spec, [0.0, 0.1]));
        let changes = [("size", "65x37"), ("camera", "rotor"), ("aperture", "0.1"), ("focus", "4")];
        require_one_picture(&watched, &changes);
        require_one_picture(&watched, &both(&changes, &[("shading", "indirect-gbuffer")]));
    }
}

#[test]
fn a_loop_sees_what_layers_see_by_both_eyes() {
    let watched = Watched::with_scene(moving("fence:lights=6", [0.0, 0.1]));
    let changes = [("size", "65x37"), ("stereo", "0.065")];
    require_one_picture(&watched, &changes);
    require_one_picture(&watched, &both(&changes, &[("aperture", "0.1"), ("stereo-eyes", "right")]));
}

/// The box twice in one place, the second time with a material of its own, solid or not: by a depth test the first that is drawn is
/// seen, and draws come by material. Which of two different shaders' surfaces, rounding decides where each rounds for itself.
fn doubled(alpha: AlphaMode, base_color: Vec4) -> Scene {
    let mut scene = scene::load("cornell", 1).unwrap();
    scene.hash = format!("{} twice, {alpha:?}", scene.hash);
    let material = scene.materials.len();
    scene.materials.push(scene::Material { base_color, alpha, ..scene.materials[0].clone() });
    let first_copy = scene.meshes.len();
    let copies: Vec<_> = scene.meshes.iter().map(|mesh| scene::Mesh { material, ..mesh.clone() }).collect();
    scene.meshes.extend(copies);
    let copies: Vec<_> = scene.draws.iter().map(|draw| Draw { mesh: first_copy + draw.mesh, ..*draw }).collect();
    // Their ids come first.
    scene.draws.splice(0..0, copies);
    scene
}

#[test]
fn of_surfaces_in_one_place_the_first_that_is_drawn_is_seen() {
    let changes = [("size", "65x37"), ("aperture", "0.1")];
    for (alpha, base_color) in [
        (AlphaMode::Opaque, vec4(0.1, 0.2, 0.8, 1.0)),
        (AlphaMode::Mask { cutoff: 0.5 }, vec4(0.1, 0.2, 0.8, 1.0)),
        (AlphaMode::Blend, vec4(0.1, 0.2, 0.8, 0.5)),
    ] {
        let watched = Watched::with_scene(doubled(alpha, base_color));
        if alpha == AlphaMode::Opaque || watched.session.gpu.caps.identity.is_software() {
            require_one_picture(&watched, &changes);
        }
    }
}

/// What a device lacks is refused where it is asked for, and gone around where it is not; a buffer has 8 bytes a sample.
#[test]
fn a_device_without_64_bit_atomics_has_layers() {
    let plan = |change: fn(&mut Caps), changes: Changes<'_>| {
        let mut caps = known::caps("lavapipe-22.3.6").unwrap();
        change(&mut caps);
        let mut job = Job::new("cornell", techniques::find(DEEP).unwrap());
        for (key, value) in both(changes, &[STOCHASTIC]) {
            job.set(key, value).unwrap();
        }
        study::planned(&job, "lavapipe-22.3.6", &caps).map(|planned| planned.table.json().to_string())
    };
    let has_loop = |planned: &str| planned.contains("deep_shading.visibility.nearest");
    let with = |_: &mut Caps| {};
    let without = |caps: &mut Caps| caps.features.shader_int64_atomics = false;
    let narrow = |caps: &mut Caps| caps.limits.max_storage_buffer_range_bytes = (8 * 1280 * 720 - 1) * 8;
    for (change, is_looped) in [(with as fn(&mut Caps), true), (without, false), (narrow, false)] {
        assert_eq!(has_loop(&plan(change, &[]).unwrap()), is_looped);
    }
    assert!(!has_loop(&plan(with, &[LAYERS]).unwrap()));
    let error = plan(without, &[LOOP]).unwrap_err();
    assert_eq!(error.exit_code(), 3, "{error}");
    assert!(error.to_string().contains("shaderBufferInt64Atomics"), "{error}");
    let error = plan(narrow, &[LOOP]).unwrap_err();
    assert_eq!(error.exit_code(), 4, "{error}");
    assert!(
        error.to_string().contains("58982400 bytes") && error.to_string().contains("--sample-tests layers"),
        "{error}"
    );
    let error = plan(with, &[LOOP, ("shading", "ssaa")]).unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
}

//! Budgets: never passed, not even for a moment; refused in words that help; and what they promise is true.

use crate::support;
use crate::support::counted::{begin, counted_device, counter, live_bytes};
use crate::support::watched::{Changes, Watched, require_silence, values};
use quincunx::choice::Choice;
use quincunx::error::{Error, Result};
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::commands::Submits;
use quincunx::memory::Strategy;
use quincunx::memory::ledger::Snapshot;
use quincunx::picture::Picture;
use quincunx::scene::{self, Scene};
use quincunx::session::Session;
use quincunx::techniques;

const MIB: u64 = 1 << 20;
/// Textures of 512 and 1024 pixels, 64 MiB of them.
const TEXTURED: &str = "hall:triangles=8000";

fn within(strategy: Strategy, budget_bytes: u64) -> DeviceRequest {
    DeviceRequest { budget_bytes: Some(budget_bytes), ..counted_device(strategy) }
}

/// The whole path: scene, frame, picture; and the ledger before the picture is read back.
fn render(
    request: &DeviceRequest,
    scene: &Scene,
    technique: &str,
    changes: Changes<'_>,
) -> Result<(Picture, Snapshot)> {
    let session = Session::open(request, scene.clone())?;
    let renderer = session.renderer(techniques::find(technique)?, &values(technique, changes), &[], Submits::One)?;
    renderer.frame()?;
    let picture = renderer.picture()?;
    require_silence(&session.gpu, technique);
    Ok((picture, session.gpu.memory.snapshot()))
}

#[test]
fn under_any_budget_there_is_a_right_picture_or_an_error_and_nothing_stays() {
    let scene = scene::load("cornell", 1).unwrap();
    let (technique, changes) = ("interleaved_deferred", [("size", "161x91"), ("vpls", "64")]);
    // A budget is of one heap, and the counter sums all up.
    let heap_count = support::driver().heaps.len() as u64;
    for &strategy in Strategy::ALL {
        let _one = begin();
        let (picture, free) = render(&counted_device(strategy), &scene, technique, &changes).unwrap();
        let needed = counter().most_bytes;
        let mut rendered = 0;
        let steps =
            [1, 1000, 4096, 50_000, 300_000, MIB, 2 * MIB, 3 * MIB, free.peak_bytes, 4 * MIB, 8 * MIB, 24 * MIB];
        for budget in steps.into_iter().chain([needed - 1, needed, u64::MAX]) {
            counter().most_bytes = 0;
            match render(&within(strategy, budget), &scene, technique, &changes) {
                Ok((found, _)) => {
                    assert_eq!(found.hash().unwrap(), picture.hash().unwrap(), "{strategy:?} within {budget}");
                    rendered += 1;
                }
                Err(error) => {
                    assert_eq!(error.exit_code(), 4, "{error}");
                    assert!(error.message().contains("the budget of "), "{error}");
                    assert!(budget < needed, "{strategy:?}: {budget} is what it took: {error}");
                }
            }
            let most = counter().most_bytes;
            assert!(most / heap_count <= budget, "{strategy:?}: {most} bytes were held within {budget} a heap");
            assert_eq!(live_bytes(), 0, "{strategy:?} within {budget}");
        }
        assert!(rendered >= 4, "{strategy:?}: only {rendered} budgets were enough");
    }
}

/// Half-empty shared memory blocks do not spend a budget: half as much again as the bytes of the resources is enough.
#[test]
fn shared_memory_blocks_do_not_spend_a_small_budget() {
    let scene = scene::load("cornell", 1).unwrap();
    let (technique, changes) = ("interleaved_deferred", [("size", "161x91"), ("vpls", "64")]);
    let _one = begin();
    let (_, dedicated) = render(&counted_device(Strategy::Dedicated), &scene, technique, &changes).unwrap();
    for &strategy in Strategy::ALL {
        let budget = dedicated.peak_bytes * 3 / 2;
        render(&within(strategy, budget), &scene, technique, &changes)
            .unwrap_or_else(|error| panic!("{strategy:?}: {error}"));
    }
}

/// The number and the unit behind `would free`, and the limit before it.
fn promise(error: &Error) -> Option<(u32, String)> {
    let text = error.to_string();
    let (_, rest) = text.split_once("--texture-limit ")?;
    let (limit, rest) = rest.split_once(" would free ")?;
    Some((limit.parse().ok()?, rest.lines().next()?.to_owned()))
}

#[test]
fn an_error_says_what_was_wanted_what_is_held_and_what_would_help() {
    let _one = begin();
    let scene = scene::load(TEXTURED, 1).unwrap();
    let render = |budget: u64, changes: Changes<'_>| {
        render(&within(Strategy::Dedicated, budget), &scene, "deferred", changes)
            .map(drop)
            .expect_err("the budget is small")
    };
    let frame = render(70 * MIB, &[("size", "640x360"), ("alias", "off")]);
    let text = frame.to_string();
    // GPUs round them up more: an H200 to 63.8 MiB.
    let (bound, all) = if support::driver().identity.is_software() { ("63.7", "63.7 MiB") } else { ("63.8", "63.") };
    let held = format!("are held in memory blocks, most of it by scene.textures ({bound} MiB), gbuffer (");
    assert!(frame.message().starts_with("allocating deferred."), "{text}");
    assert!(frame.message().contains("MiB, device-local, type "), "{text}");
    assert!(frame.message().ends_with(": the budget of 70.0 MiB is spent"), "{text}");
    for words in [
        &held,
        "\n       --texture-limit 256 would free 44",
        "a smaller --size would need less; `memory --technique deferred` prints the plan",
    ] {
        assert!(text.contains(words), "no {words} in\n{text}");
    }
    let upload = render(30 * MIB, &[]);
    assert!(upload.message().starts_with("allocating scene.textures."), "{upload}");
    assert!(promise(&upload).is_some(), "{upload}");
    assert!(!upload.to_string().contains("--size"), "a smaller picture does not help: {upload}");
    let hopeless = render(1000, &[]).to_string();
    for words in [
        "allocating scene.positions (",
        "the budget of 1000 B is too small for it",
        "nothing else is held",
        &format!("no --texture-limit would suffice: all of the scene's textures take {all}"),
    ] {
        assert!(hopeless.contains(words), "no {words} in\n{hopeless}");
    }
    // A scene without textures has none to limit.
    let cornell = scene::load("cornell", 1).unwrap();
    let opened = Session::open(&within(Strategy::Linear, 1000), cornell).map(drop);
    let plain = opened.expect_err("the budget is small").to_string();
    assert!(!plain.contains("--texture-limit"), "{plain}");
}

/// Textures of 2048 pixels that shade take 537 MB of a plan for a small picture.
#[test]
fn a_setting_that_halves_what_a_frame_takes_is_named() {
    let _one = begin();
    let scene = scene::load("cornell", 1).unwrap();
    let changes = [("shading", "texture-space"), ("size", "64x36")];
    let refused = render(&within(Strategy::Linear, 64 * MIB), &scene, "deep_shading", &changes);
    let text = refused.map(drop).expect_err("the budget is small").to_string();
    assert!(
        text.contains("\n       --shading-texture-size 1024 or a smaller --size would need less; `memory"),
        "{text}"
    );
}

/// With the limit that an error names, what was refused fits, and the textures shrink by as much as it says; with twice
/// the limit it would not have fit.
#[test]
fn a_texture_limit_frees_what_the_error_promises() {
    let _one = begin();
    let mut scene = scene::load(TEXTURED, 1).unwrap();
    let textures = |request: &DeviceRequest, scene: &Scene| {
        let session = Session::open(request, scene.clone()).unwrap();
        session.gpu.memory.snapshot().groups()["scene.textures"]
    };
    let unlimited = textures(&counted_device(Strategy::Linear), &scene);
    for &strategy in Strategy::ALL {
        for budget in [4, 12, 30, 60] {
            scene.texturing.limit_px = 0;
            let request = within(strategy, budget * MIB);
            let error = Session::open(&request, scene.clone()).map(drop).expect_err("the textures are larger");
            let (limit_px, frees) = promise(&error).unwrap_or_else(|| panic!("{strategy:?}, {budget} MiB: {error}"));
            scene.texturing.limit_px = limit_px;
            let limited = textures(&request, &scene);
            assert_eq!(quincunx::units::Bytes(unlimited - limited).to_string(), frees, "{strategy:?}, {budget} MiB");
            scene.texturing.limit_px = 2 * limit_px;
            let still = Session::open(&request, scene.clone()).map(drop);
            assert!(still.is_err(), "{strategy:?}, {budget} MiB: a limit of {} is enough", 2 * limit_px);
        }
    }
}

#[test]
fn a_texture_limit_is_planned_and_changes_only_what_is_larger() {
    let hash_within = |limit_px: u32| {
        let mut scene = scene::load(TEXTURED, 1).unwrap();
        scene.texturing.limit_px = limit_px;
        let watched = Watched::with_scene(scene);
        let snapshot = watched.session.gpu.memory.snapshot();
        assert_eq!(watched.session.stats.plan().bytes(), snapshot.asked_bytes(), "limit {limit_px}");
        let sides = watched.session.stats.textures.iter().map(|(extent, _)| extent.width.max(extent.height));
        (watched.hash("deferred", &[("size", "97x53")]), sides.max().unwrap())
    };
    let (unlimited, side) = hash_within(0);
    assert_eq!(hash_within(16384), (unlimited.clone(), side));
    assert_eq!(hash_within(side), (unlimited.clone(), side));
    let (coarse, limited) = hash_within(7);
    assert!(limited <= 7 && coarse != unlimited);
    hash_within(1);
}

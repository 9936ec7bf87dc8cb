//! A scene's own medium: `--medium auto`, what it is judged against, and what is said of it.

use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both, values};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;
use quincunx::reference::recipe::Recipe;
use quincunx::scene::{self, Medium};
use quincunx::techniques;
use serde_json::{Value, json};

const OWN: Medium = Medium { scattering: 0.2, absorption: 0.05, asymmetry: 0.4 };
const TEXT: &str = "0.2,0.05,0.4";
const SMALL: Changes<'static> = &[("size", "24x16"), ("emissive", "on")];

/// The box, in smoke or without.
fn cornell(medium: Option<Medium>) -> Watched {
    let mut scene = scene::load("cornell", 1).unwrap();
    scene.medium = medium;
    Watched::with_scene(scene)
}

#[test]
fn auto_is_the_scene_s_own_medium_and_other_values_stand_for_it() {
    let [smoky, clear] = [Some(OWN), None].map(cornell);
    for (technique, more) in [("path_traced", &[("spp", "4")][..]), ("adaptive_interleaved", &[][..])] {
        let picture = |watched: &Watched, medium: &str| -> Picture {
            watched.picture(technique, &both(&both(SMALL, more), &[("medium", medium)]))
        };
        let own = picture(&smoky, "auto");
        assert_eq!(own, picture(&clear, TEXT), "{technique}");
        assert_eq!(picture(&smoky, "none"), picture(&clear, "auto"), "{technique}");
        assert_eq!(picture(&smoky, "0.1,0,0"), picture(&clear, "0.1,0,0"), "{technique}");
        assert_ne!(own, picture(&smoky, "none"), "{technique}");
        let told = smoky.render(technique, &both(SMALL, more));
        assert_eq!(told.resolved["medium"], TEXT, "{technique}");
        assert_eq!(clear.render(technique, &both(SMALL, more)).resolved["medium"], "none", "{technique}");
    }
}

/// Whoever draws the medium is judged in it, with the light that it scatters once into what is seen; whoever does not
/// is judged without.
#[test]
fn references_have_the_medium_that_the_judged_picture_has() {
    let [smoky, clear] = [Some(OWN), None].map(cornell);
    let judging = |watched: &Watched, technique: &str, changes: Changes<'_>| {
        let paths = techniques::find("path_traced").unwrap();
        let judged = techniques::find(technique).unwrap();
        Recipe::judging(paths, judged, &values(technique, changes), &watched.session, 4).unwrap()
    };
    for (technique, changes, medium, airlight) in [
        ("adaptive_interleaved", &[][..], TEXT, "seen"),
        ("adaptive_interleaved", &[("components", "id,ss")], TEXT, "none"),
        ("adaptive_interleaved", &[("medium", "none")], "none", "path"),
        ("adaptive_interleaved", &[("medium", "0.1,0,0")], "0.1,0,0", "seen"),
        ("path_traced", &[], TEXT, "path"),
        ("forward", &[], "none", "path"),
    ] {
        let settings = judging(&smoky, technique, changes).settings();
        assert_eq!([&settings["medium"], &settings["airlight"]], [medium, airlight], "{technique} {changes:?}");
    }
    // A scene without one shares its references with `--medium none`.
    let key = |changes| judging(&clear, "adaptive_interleaved", changes).key().to_owned();
    assert_eq!(key(&[]), key(&[("medium", "none")]));
    assert_ne!(key(&[]), key(&[("medium", TEXT)]));
}

#[test]
fn light_of_the_air_is_refused_where_there_is_none() {
    let clear = cornell(None);
    for (changes, said) in [
        (&[("airlight", "seen")][..], "--airlight seen: there is no medium"),
        (&[("transport", "single-scatter")], "--transport single-scatter: there is no medium"),
    ] {
        let error = clear.try_renderer("path_traced", &both(SMALL, changes), &[], Submits::One);
        let error = error.err().unwrap();
        assert!(error.to_string().contains(said) && error.to_string().contains("--medium 0.1,0,0"), "{error}");
        assert_eq!(error.exit_code(), 2);
    }
}

/// Closed shelves and the far corner are seen through it: of light that crosses the room most is left.
#[test]
fn the_office_has_smoke_where_it_is_asked_for() {
    assert_eq!(scene::load("office:desks=1", 1).unwrap().medium, None);
    let scene = scene::load("office:desks=1,smoke=on", 1).unwrap();
    let medium = scene.medium.unwrap();
    let across = (-medium.extinction() * f64::from(scene.bounds().diagonal())).exp();
    assert!(medium.scattering > 0.0 && (0.3..0.8).contains(&across), "{medium:?}: {across}");
}

#[test]
fn inspect_names_a_medium_and_export_says_that_it_is_left_out() {
    let program = Program::new();
    let inspected = |scene: &str| -> Value { program.run(&["scene", "inspect", scene, "--json"]).fine().json() };
    assert_eq!(inspected("office")["medium"], Value::Null);
    let own = json!({ "scattering": 0.08, "absorption": 0.005, "asymmetry": 0.3 });
    assert_eq!(inspected("office:smoke=on")["medium"], own);
    let said = program.run(&["scene", "inspect", "office:smoke=on"]).fine().out;
    assert!(said.contains("medium: a metre scatters 0.08 and absorbs 0.005"), "{said}");
    let path = program.path("office.glb");
    let said = program.run(&["scene", "export", "office:smoke=on", "-o", &path]).fine().out;
    assert!(said.contains("--medium 0.08,0.005,0.3"), "{said}");
    assert_eq!(inspected(&path)["medium"], Value::Null);
    let said = program.run(&["scene", "export", "office", "-o", &path]).fine().out;
    assert!(!said.contains("note"), "{said}");
}

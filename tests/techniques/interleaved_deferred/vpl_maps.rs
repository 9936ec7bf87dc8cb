//! Shadow maps of virtual point lights (`--vpl-shadow map`; Segovia 2006, section 4.3).

use super::NAME;
use crate::support::boxes::{camera, closed_box, point_light, rectangle};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::picture::AovChannels;
use quincunx::scene::{Material, Scene};

const MAP: (&str, &str) = ("vpl-shadow", "map");
const HIDDEN: &str = "vpl_shadow.hidden";
const COMMON: [(&str, &str); 5] =
    [("size", "64x36"), ("vpls", "64"), ("direct", "none"), ("position", "float"), ("filter", "none")];

/// How many of its lights each pixel does not see.
fn hidden(watched: &Watched, changes: Changes<'_>) -> Vec<u32> {
    let renderer = watched.render_stages(NAME, changes, &[HIDDEN]);
    let AovChannels::YU32(counts) = renderer.aov(HIDDEN).unwrap().channels else { panic!("counts") };
    counts
}

/// Parts of what two ways say together that they say otherwise of a pixel's lights, at least.
fn apart(a: &[u32], b: &[u32], lights_a_pixel: u32) -> f64 {
    let differing: u32 = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).sum();
    f64::from(differing) / (a.len() as f64 * f64::from(lights_a_pixel))
}

/// A screen in front of a wall, lit by what one lamp lights of the floor and of the walls around them.
pub fn screened() -> Watched {
    let grey = Material { double_sided: true, ..Material::diffuse("grey", Vec3::splat(0.6)) };
    let mut scene = closed_box(&grey);
    rectangle(&mut scene, vec3(0.1, 0.2, -0.3), 0.4 * Vec3::X, 0.3 * Vec3::Y, grey.clone());
    rectangle(&mut scene, vec3(-0.4, -0.3, 0.1), 0.3 * Vec3::X, 0.3 * Vec3::Z, grey);
    scene.lights = vec![point_light(vec3(0.5, 0.6, 0.6), 4.0)];
    scene.cameras = vec![camera(vec3(-0.2, 0.1, 0.9), vec3(0.0, 0.0, -1.0), 1.2)];
    let name = "screened".to_owned();
    Watched::with_scene(Scene { name: name.clone(), hash: name, ..scene })
}

/// Maps say what rays say, and more nearly so the finer they are.
#[test]
fn maps_hide_what_rays_hide() {
    let watched = screened();
    for split in ["none", "one-pass", "stencil", "subsample"] {
        let way = both(&COMMON, &[("split", split)]);
        let lights_a_pixel = if split == "none" || split == "subsample" { 64 } else { 4 };
        let rays = hidden(&watched, &both(&way, &[("vpl-shadow", "ray")]));
        let by_rays = f64::from(rays.iter().sum::<u32>()) / (rays.len() as f64 * f64::from(lights_a_pixel));
        let [coarse, fine] = ["32", "512"].map(|size| {
            let maps = hidden(&watched, &both(&way, &[MAP, ("vpl-shadow-size", size)]));
            apart(&maps, &rays, lights_a_pixel)
        });
        println!(
            "{split}: rays hide {by_rays:.3} of all lights, maps of 32 and 512 say {coarse:.4} and {fine:.4} otherwise"
        );
        assert!(by_rays > 0.05, "{split}: there is something to hide");
        assert!(fine < 0.004 && coarse < 0.05 && fine < coarse, "{split}: {coarse}, {fine}");
    }
}

/// What is left out of maps, and which are not drawn, changes no bit of any shape; where maps lie changes next to none.
#[test]
fn culled_maps_hold_all_that_is_asked() {
    let watched = screened();
    let hall = Watched::open("hall:triangles=8000");
    for (watched, sees_all) in [(&watched, true), (&hall, false)] {
        for shape in ["hemicube", "cube", "layers"] {
            let way = both(&COMMON, &[MAP, ("vpl-shadow-shape", shape), ("vpl-shadow-maps", "7")]);
            let culled = watched.render(NAME, &way);
            let all = both(&way, &[("shadow-casters", "all")]);
            require_same(&watched.session.gpu, &culled.picture().unwrap(), &watched.picture(NAME, &all), &shape);
            let counter = |name: &str| culled.counters[name];
            let faces = if shape == "hemicube" { 5.0 } else { 6.0 };
            println!("{shape}: {} of {} faces are drawn", counter("vpl_map_faces"), 64.0 * faces);
            assert!(
                sees_all || counter("vpl_map_faces") < 64.0 * faces,
                "{shape}: some faces see nothing that is seen"
            );
            assert_eq!(counter("vpl_map_turns"), 10.0);
        }
        let way = |changes: Changes<'_>| hidden(watched, &both(&both(&COMMON, &[MAP]), changes));
        let held = way(&[]);
        assert!(held.iter().sum::<u32>() > 0);
        let indexed = ("vpl-shadow-index", "cube-map");
        for changes in [
            &[("vpl-shadow-maps", "1")][..],
            &[("vpl-shadow-shape", "cube")],
            &[("vpl-shadow-shape", "layers")],
            &[indexed],
            &[indexed, ("vpl-shadow-shape", "cube"), ("vpl-shadow-maps", "7")],
        ] {
            let other = apart(&way(changes), &held, 4);
            println!("{changes:?}: {other:.5} otherwise");
            assert!(other < 0.002, "{changes:?}: {other}");
        }
    }
}

/// Where a map's texels are large, few triangles hide what all of them hide.
#[test]
fn coarser_triangles_hide_what_all_hide() {
    let hall = Watched::open("hall:triangles=60000");
    let size = ("vpl-shadow-size", "64");
    for shape in ["hemicube", "layers"] {
        let way = both(&COMMON, &[MAP, size, ("vpl-shadow-shape", shape), ("vpl-shadow-maps", "7")]);
        let of = |detail: &str| {
            let changes = both(&way, &[("vpl-shadow-detail", detail)]);
            let renderer = hall.render_stages(NAME, &changes, &[HIDDEN]);
            let AovChannels::YU32(counts) = renderer.aov(HIDDEN).unwrap().channels else { panic!("counts") };
            let counter = |name: &str| renderer.counters[name];
            (counts, counter("vpl_map_triangles_drawn"), counter("vpl_map_coarse_triangles_drawn"))
        };
        let (all, triangles, coarse) = of("0");
        assert!(coarse == 0.0 && all.iter().sum::<u32>() > 0);
        let mut before = (triangles, 0.0);
        for (detail, most_apart) in [("0.1", 0.002), ("0.5", 0.01), ("2", 0.04)] {
            let (counts, triangles_drawn, coarse) = of(detail);
            let found = (triangles_drawn, apart(&counts, &all, 4));
            println!("{shape}, {detail}: {:.3} of all triangles, {:.5} otherwise", found.0 / triangles, found.1);
            assert!(found.0 < before.0 && coarse > 0.0 && coarse <= found.0, "{detail}: {found:?}, {coarse}");
            assert!(found.1 < most_apart, "{detail}: {found:?}");
            before = found;
        }
    }
}

/// A wall hides all that is behind it, whichever map's turn it is.
#[test]
fn a_room_behind_a_wall_is_dark() {
    let watched = super::vpl_shadow::rooms(0.1);
    for (split, maps) in [("one-pass", "64"), ("none", "5"), ("subsample", "1"), ("depth", "64")] {
        let way = both(&COMMON, &[("split", split), ("vpl-shadow-maps", maps), MAP]);
        let [dark, lit] = ["map", "none"].map(|shadow| {
            let pixels = watched.picture(NAME, &both(&way, &[("vpl-shadow", shadow)])).pixels;
            pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>()
        });
        println!("{split}, {maps} at once: {:.5} of the light comes through", dark / lit);
        // Along its rim a wall is a texel narrower than it is.
        assert!(lit > 1.0 && dark < 0.02 * lit, "{split}, {maps}: {dark} of {lit}");
    }
}

/// The atlas is as large as the budget lets it be, and lights take turns; too many turns are refused with what would help.
#[test]
fn the_budget_says_how_many_maps_are_held() {
    let watched = screened();
    let common = both(&COMMON, &[MAP, ("vpl-shadow-size", "256")]);
    let count = |budget: &str| -> (f64, u64) {
        let renderer = watched.render(NAME, &both(&common, &[("memory-budget", budget)]));
        let atlas = renderer.plan.resources.iter().find(|planned| planned.name.ends_with("vpl_shadow.maps")).unwrap();
        (renderer.counters["vpl_map_turns"], atlas.bytes())
    };
    // A map of 3 * 256 * 256 texels takes 768 KiB; all 64 take 48 MiB.
    let (turns, bytes) = count("none");
    assert_eq!((turns, bytes), (1.0, 48 << 20));
    let (turns, bytes) = count("16MiB");
    println!("16 MiB: {turns} turns, {bytes} B");
    assert!(turns > 3.0 && bytes < 16 << 20, "{turns} turns, {bytes} B");
    let one = both(&common, &[("vpls", "128"), ("vpl-shadow-maps", "1")]);
    let refused = watched.try_renderer(NAME, &one, &[], Submits::One).err().expect("128 turns");
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.to_string().contains("128 turns") && refused.to_string().contains("--vpl-shadow ray"), "{refused}");
}

//! Adaptive interleaved sampling: each component against a plain estimator on the host, the modes and the ways to
//! refine against each other, and the whole against paths (Dubla 2009).

mod airlight;
mod beyond;
mod convergence;
mod host;
mod occlusion;
mod smoothing;
mod spheres;

use crate::support::boxes::{camera, panel, rectangle};
use crate::support::difference::{require_same, rmse};
use crate::support::seen::{self, Seen, point_at};
use crate::support::watched::{Watched, both};
use bytemuck::Zeroable;
use glam::{Vec3, vec3};
use quincunx::bvh::Bvh;
use quincunx::frame::View;
use quincunx::gpu::shader::structs::{AdaptiveParams, AreaSampleBlock, VplBlock};
use quincunx::lights::area::area_lights;
use quincunx::lights::vpl;
use quincunx::sampling::pairs::in_order;
use quincunx::sampling::sampler::Sampler;
use quincunx::scene::{Material, Scene};
use quincunx::units::Extent;

const NAME: &str = "adaptive_interleaved";
const EXTENT: Extent = Extent { width: 97, height: 53 };
/// Emissive surfaces shine beside the lamp, positions are exact, and every pixel has an estimate of its own.
const CORNELL: [(&str, &str); 4] = [("size", "97x53"), ("emissive", "on"), ("position", "float"), ("id-scale", "1")];

/// The host's twin of the shaders' sampler.
fn sampler([tile_x, tile_y]: [u32; 2], most: u32) -> AdaptiveParams {
    AdaptiveParams { tile_x, tile_y, base: 1, most, ..AdaptiveParams::zeroed() }
}

/// What a pixel shows, by a ray on the host.
struct Shown {
    pixel: [u32; 2],
    position: Vec3,
    normal: Vec3,
}

/// Pixels of which rays and rasteriser surely see one surface.
fn shown(watched: &Watched, bvh: &Bvh) -> Vec<Shown> {
    let scene = &watched.session.scene;
    let view = View::new(scene, "0", EXTENT).unwrap();
    let eye = view.eye();
    let sources = seen::sources(watched, &view);
    let surfaces = (0u32..).zip(sources).filter(|(_, seen)| matches!(seen, Seen::Surface(_)));
    surfaces
        .map(|(index, _)| {
            let pixel = [index % EXTENT.width, index / EXTENT.width];
            let direction =
                (point_at(&view, pixel.map(|side| f64::from(side) + 0.5)) - eye.as_dvec3()).normalize().as_vec3();
            let accept = |hit: &quincunx::bvh::Hit| !bvh.is_culled_back(hit, direction);
            let hit = bvh.closest_hit(eye, direction, f32::INFINITY, accept).unwrap();
            let triangle = &bvh.triangles[hit.triangle];
            let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
            let normal = three(triangle.edge1).cross(three(triangle.edge2)).normalize();
            let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
            Shown { pixel, position: eye + direction * hit.distance, normal }
        })
        .collect()
}

/// Whether nothing hides `to` from the surface: the plain way, a hundredth of a per cent of the diagonal off it.
fn sees(bvh: &Bvh, offset: f32, shown: &Shown, to: Vec3) -> bool {
    let origin = shown.position + shown.normal * offset;
    let away = to - origin;
    !bvh.occluded(origin, away.normalize(), away.length() - 2.0 * offset)
}

fn xyz([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

fn vpl_irradiance(shown: &Shown, vpl: &VplBlock, clamp_m: f32) -> Vec3 {
    let to = xyz(vpl.position_ws) - shown.position;
    let squared = to.length_squared();
    let cosines = shown.normal.dot(to.normalize()).max(0.0) * (-xyz(vpl.normal_ws).dot(to.normalize())).max(0.0);
    xyz(vpl.intensity) * (cosines / squared.max(clamp_m * clamp_m))
}

fn area_irradiance(shown: &Shown, point: &AreaSampleBlock) -> Vec3 {
    let to = xyz(point.position_ws) - shown.position;
    let leaving = -xyz(point.normal_ws).dot(to.normalize());
    let leaving = if point.normal_ws[3] != 0.0 { leaving.abs() } else { leaving.max(0.0) };
    xyz(point.intensity) * (shown.normal.dot(to.normalize()).max(0.0) * leaving / to.length_squared())
}

/// The part of the pixels whose irradiance is the host's within 1 % of it and a thousandth of the brightest.
fn agreeing_part(irradiance: &[[f32; 3]], shown: &[Shown], host: impl Fn(&Shown) -> Vec3) -> f64 {
    // Half of the channels are above it: what lies beside a lamp is too bright to measure anything by.
    let mut channels = irradiance.as_flattened().to_vec();
    channels.sort_by(f32::total_cmp);
    let middle = channels[channels.len() / 2];
    let agrees = |shown: &&Shown| {
        let [x, y] = shown.pixel;
        let found = Vec3::from_array(irradiance[(y * EXTENT.width + x) as usize]);
        let expected = host(shown);
        (found - expected).abs().max_element() <= 0.01 * expected.max_element() + 1e-3 * middle
    };
    shown.iter().filter(agrees).count() as f64 / shown.len() as f64
}

/// With every subset each pixel has every virtual light: a loop over all of them, each with its ray.
#[test]
fn indirect_light_of_all_subsets_is_every_virtual_light_with_its_shadow() {
    let watched = Watched::open("cornell");
    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let diagonal = scene.lasting_bounds().diagonal();
    let shown = shown(&watched, &bvh);
    assert!(shown.len() > 1000);
    let lights = &scene.lights;
    let walk = vpl::Walk { count: 64, bounces: 1, emissive: true, starts: false, medium: None, seed: 1 };
    let vpls = vpl::walk(scene, &bvh, lights, &walk).vpls;
    for (tile, most) in [("1x1", "1"), ("2x2", "4"), ("3x3", "9"), ("4x2", "8")] {
        let own = [("components", "id"), ("mode", "max"), ("vpls", "64"), ("tile", tile), ("id-max", most)];
        let changes = both(&CORNELL, &own);
        let renderer = watched.render_stages(NAME, &changes, &["irradiance.id"]);
        let irradiance = watched.rgb(&renderer, "irradiance.id");
        let part = agreeing_part(&irradiance, &shown, |shown| {
            let lit = |vpl: &&VplBlock| sees(&bvh, 1e-4 * diagonal, shown, xyz(vpl.position_ws));
            vpls.iter().filter(lit).map(|vpl| vpl_irradiance(shown, vpl, 0.02 * diagonal)).sum()
        });
        assert!(part > 0.985, "{tile}: {part}");
    }
    // The initial pass alone has the pixel's own stretch of them, which stands for all.
    let own = [("components", "id"), ("mode", "igi"), ("vpls", "64"), ("tile", "3x2"), ("id-max", "6")];
    let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["irradiance.id"]);
    let sampler = AdaptiveParams { source_count: 64, ..sampler([3, 2], 6) };
    let part = agreeing_part(&watched.rgb(&renderer, "irradiance.id"), &shown, |shown| {
        let [first, end] = sampler.id_stretch(sampler.slot_of(shown.pixel), 0).map(|index| index as usize);
        let lit = |vpl: &&VplBlock| sees(&bvh, 1e-4 * diagonal, shown, xyz(vpl.position_ws));
        6.0 * vpls[first..end].iter().filter(lit).map(|vpl| vpl_irradiance(shown, vpl, 0.02 * diagonal)).sum::<Vec3>()
    });
    assert!(part > 0.985, "3x2, igi: {part}");
}

/// The mean over the points of the sampler that belong to the pixel's place in the tile.
#[test]
fn soft_shadows_are_the_mean_over_the_pixel_s_own_points() {
    [("sobol", Sampler::Sobol), ("jittered", Sampler::Jittered)].into_iter().for_each(require_own_points);
}

fn require_own_points((name, spread): (&str, Sampler)) {
    let watched = Watched::open("cornell");
    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let offset = 1e-4 * scene.lasting_bounds().diagonal();
    let shown = shown(&watched, &bvh);
    let [x, y, most] = [3u32, 2, 5];
    let own =
        [("components", "ss"), ("mode", "max"), ("tile", "3x2"), ("ss-max", "5"), ("rig", "none"), ("lights", "0")];
    let own = both(&own, &[("sampler", name)]);
    let points_of = |spread| area_lights(scene, 16)[0].points(scene, &in_order(spread, [x, y], most, 1 ^ 0x9e37_79b9));
    let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["irradiance.ss"]);
    let irradiance = watched.rgb(&renderer, "irradiance.ss");
    let lamps = &scene.lights;
    let sampler = sampler([x, y], most);
    let part_of = |points: &[AreaSampleBlock]| {
        agreeing_part(&irradiance, &shown, |shown| {
            let of_iteration = |iteration: u32| {
                let point = &points[sampler.ss_point(0, sampler.slot_of(shown.pixel), iteration) as usize];
                if sees(&bvh, offset, shown, xyz(point.position_ws)) {
                    area_irradiance(shown, point)
                } else {
                    Vec3::ZERO
                }
            };
            let areas: Vec3 = (0..most).map(of_iteration).sum::<Vec3>() / most as f32;
            let punctual = lamps.iter().map(|lamp| {
                let to = lamp.position - shown.position;
                let cosine = shown.normal.dot(to.normalize()).max(0.0);
                let is_lit = cosine > 0.0 && sees(&bvh, offset, shown, lamp.position);
                if is_lit { lamp.intensity * (cosine / to.length_squared()) } else { Vec3::ZERO }
            });
            areas + punctual.sum::<Vec3>()
        })
    };
    let [own, others] = [spread, Sampler::R2].map(|spread| part_of(&points_of(spread)));
    println!("{name}: {own} of the pixels, with another sampler's points {others}");
    assert!(own > 0.985 && others < 0.97, "{name}: {own} {others}");
}

/// Two panels of unlike light and size over a floor with a shelf between: each has its own points, whatever the mode takes of
/// them.
#[test]
fn each_area_light_has_points_of_its_own_in_every_mode() {
    let mut scene = Scene { name: "panels".to_owned(), hash: "panels".to_owned(), ..Scene::default() };
    let grey = Material::diffuse("floor", Vec3::splat(0.5));
    rectangle(&mut scene, Vec3::ZERO, 4.0 * Vec3::X, -4.0 * Vec3::Z, grey.clone());
    rectangle(&mut scene, vec3(0.3, 1.0, 0.0), 0.8 * Vec3::X, -0.6 * Vec3::Z, grey);
    rectangle(&mut scene, vec3(-2.0, 3.0, 0.0), 0.5 * Vec3::X, 0.5 * Vec3::Z, panel(Vec3::splat(9.0)));
    rectangle(&mut scene, vec3(2.0, 2.5, 0.5), 0.3 * Vec3::X, 0.2 * Vec3::Z, panel(vec3(20.0, 5.0, 1.0)));
    scene.cameras.push(camera(vec3(0.0, 4.0, 6.0), Vec3::ZERO, 0.8));
    let watched = Watched::with_scene(scene);
    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let offset = 1e-4 * scene.lasting_bounds().diagonal();
    let shown = shown(&watched, &bvh);
    let seed = |light: u32| 1 ^ (light + 1).wrapping_mul(0x9e37_79b9);
    let lights = area_lights(scene, 16);
    assert_eq!(lights.len(), 2);
    let points: Vec<_> = (0u32..)
        .zip(&lights)
        .flat_map(|(index, light)| light.points(scene, &in_order(Sampler::Sobol, [3, 2], 4, seed(index))))
        .collect();
    let sampler = sampler([3, 2], 4);
    for (mode, iteration_count) in [("max", 4), ("igi", 1)] {
        let own = [("components", "ss"), ("mode", mode), ("tile", "3x2"), ("ss-max", "4"), ("rig", "none")];
        let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["irradiance.ss"]);
        let irradiance = watched.rgb(&renderer, "irradiance.ss");
        let part = agreeing_part(&irradiance, &shown, |shown| {
            let slot = sampler.slot_of(shown.pixel);
            let met = |(light, iteration): (u32, u32)| {
                let point = &points[sampler.ss_point(light, slot, iteration) as usize];
                if sees(&bvh, offset, shown, xyz(point.position_ws)) {
                    area_irradiance(shown, point)
                } else {
                    Vec3::ZERO
                }
            };
            let iterations = (0..iteration_count).flat_map(|iteration| [(0, iteration), (1, iteration)]).map(met);
            iterations.sum::<Vec3>() / iteration_count as f32
        });
        assert!(part > 0.985, "{mode}: {part}");
    }
}

/// A pixel of a tile that was refined to the most has the light of `max`, one of a tile that was not has that of `igi`,
/// each bit for bit; and both kinds are there.
#[test]
fn each_tile_is_between_no_refinement_and_all_of_it() {
    let watched = Watched::open("cornell");
    for component in ["id", "ss"] {
        let stages = [format!("irradiance.{component}"), format!("guidance.{component}.iterations")];
        let stages: Vec<&str> = stages.iter().map(String::as_str).collect();
        let irradiance = |mode: &str, stages: &[&str]| {
            let changes = both(&CORNELL, &[("components", component), ("mode", mode), ("base", "2")]);
            let renderer = watched.render_stages(NAME, &changes, stages);
            let iterations = stages.get(1).map_or(Vec::new(), |iterations| watched.integers(&renderer, iterations));
            (watched.rgb(&renderer, stages[0]), iterations)
        };
        let (adaptive, iterations) = irradiance("adaptive", &stages);
        let (max, all) = irradiance("max", &stages);
        let (igi, _) = irradiance("igi", &stages[..1]);
        assert!(all.iter().all(|count| *count == 9 || *count == 2), "a tile without a surface is not refined");
        let (mut least, mut most, mut between) = (0, 0, 0);
        for pixel in 0..adaptive.len() {
            match iterations[pixel] {
                2 => {
                    assert_eq!(adaptive[pixel], igi[pixel], "{component}: pixel {pixel}");
                    least += 1;
                }
                9 => {
                    assert_eq!(adaptive[pixel], max[pixel], "{component}: pixel {pixel}");
                    most += 1;
                }
                count => {
                    assert!((3..9).contains(&count));
                    between += 1;
                }
            }
        }
        // No tile has all of its virtual lights hidden.
        let least_most = if component == "ss" { 20 } else { 0 };
        assert!(least > 500 && most >= least_most && between > 50, "{component}: {least}, {between}, {most}");
    }
}

/// Under one light both guidances are the paper's; under several a tile is refined by `each` where some light is hidden
/// from some of its pixels and not from others.
#[test]
fn each_light_guides_by_itself() {
    let watched = Watched::open("cornell");
    let own = [("components", "ss"), ("tile", "3x3")];
    let hash = |guidance, emissive| {
        watched.hash(NAME, &both(&both(&CORNELL, &own), &[("ss-guidance", guidance), ("emissive", emissive)]))
    };
    assert_eq!(hash("each", "off"), hash("mean", "off"), "one light");
    // Wholly dark tiles are refined by neither.
    let iterations = |guidance| {
        let own = both(&own, &[("ss-guidance", guidance), ("emissive", "off")]);
        let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["guidance.ss.iterations"]);
        watched.integers(&renderer, "guidance.ss.iterations")
    };
    assert_eq!(iterations("each"), iterations("mean"), "one light");
    assert_ne!(hash("each", "on"), hash("mean", "on"), "two lights");

    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let offset = 1e-4 * scene.lasting_bounds().diagonal();
    let shown = shown(&watched, &bvh);
    let points = area_lights(scene, 16)[0].points(scene, &in_order(Sampler::Sobol, [3, 3], 9, 1 ^ 0x9e37_79b9));
    let sampler = sampler([3, 3], 9);
    let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &["guidance.ss.iterations"]);
    let iterations = watched.integers(&renderer, "guidance.ss.iterations");
    let (mut parted_count, mut tile_count, mut off) = (0, 0, 0);
    for tile_y in 0..EXTENT.height / 3 {
        for tile_x in 0..EXTENT.width / 3 {
            let is_own = |shown: &&Shown| shown.pixel[0] / 3 == tile_x && shown.pixel[1] / 3 == tile_y;
            let own: Vec<&Shown> = shown.iter().filter(is_own).collect();
            // What rays are not sure of is left to the tests of pictures.
            if own.len() < 9 {
                continue;
            }
            let met = |shown: &&Shown| {
                let point = &points[sampler.ss_point(0, sampler.slot_of(shown.pixel), 0) as usize];
                let lamp = scene.lights[0].position;
                let faces = shown.normal.dot(lamp - shown.position) > 0.0;
                let panel = area_irradiance(shown, point) != Vec3::ZERO;
                [panel && sees(&bvh, offset, shown, xyz(point.position_ws)), faces && sees(&bvh, offset, shown, lamp)]
            };
            let met: Vec<[bool; 2]> = own.iter().map(met).collect();
            // How many pixels each light is hidden from; only those that part the tile count.
            let hidden = [0, 1].map(|light| met.iter().filter(|met| !met[light]).count());
            let parted: Vec<usize> = hidden.into_iter().filter(|count| (1..9).contains(count)).collect();
            let refine = parted.iter().sum::<usize>() as f32 / (9 * parted.len().max(1)) as f32;
            let expected = sampler.base + sampler.further_iterations(refine, true);
            let found = iterations[(tile_y * 3 * EXTENT.width + tile_x * 3) as usize];
            off += u32::from(found != expected);
            parted_count += u32::from(!parted.is_empty());
            tile_count += 1;
        }
    }
    assert!(tile_count > 200 && parted_count > 8 && parted_count < tile_count / 3, "{parted_count} of {tile_count}");
    assert!(off * 50 <= tile_count, "{off} of {tile_count} are others");
}

/// Guidance that asks every tile for all of its iterations gives the picture of `max`: an error that no tile has is wanted,
/// where light varies and reaches everything.
#[test]
fn guidance_for_everything_is_the_most_everywhere() {
    let watched = Watched::with_scene(airlight::shelf());
    for component in ["ss", "id", "pm"] {
        let own =
            both(&CORNELL, &[("components", component), ("tile", "3x2"), ("id-max", "6"), ("medium", "0.2,0.05,0.4")]);
        let own: Vec<_> = own.into_iter().filter(|(key, _)| *key != "id-max" || component == "id").collect();
        let picture = |changes: &[(&str, &str)]| watched.picture(NAME, &both(&own, changes));
        let most = picture(&[("mode", "max")]);
        require_same(&watched.session.gpu, &picture(&[("until-error", "0.000001")]), &most, &component);
        assert_ne!(picture(&[]).hash().unwrap(), most.hash().unwrap(), "{component}: its own guidance asks for less");
    }
}

/// A tile of one pixel shares with nobody: its estimate is its own samples' (`soft_shadows_are_the_mean_…` and the tests
/// like it), and what is filtered is what was estimated.
#[test]
fn tiles_of_one_pixel_are_not_filtered() {
    let watched = Watched::open("cornell");
    let own = both(&CORNELL, &[("tile", "1x1"), ("id-max", "1"), ("ss-max", "3"), ("medium", "0.2,0.05,0.4")]);
    let stages = ["id", "ss", "pm"]
        .map(|component| [format!("irradiance.{component}"), format!("filter.irradiance.{component}")]);
    let named: Vec<&str> = stages.as_flattened().iter().map(String::as_str).collect();
    let renderer = watched.render_stages(NAME, &own, &named);
    for [before, after] in &stages {
        assert_eq!(watched.rgb(&renderer, before), watched.rgb(&renderer, after), "{before} and {after}");
    }
}

/// Listed and dispatched from the device, or each tile in a loop of its own.
#[test]
fn both_ways_to_refine_give_the_same_picture() {
    let watched = Watched::open("cornell");
    for (own, mode) in [
        (&[("tile", "3x3")][..], "adaptive"),
        (&[("tile", "8x8"), ("base", "3")][..], "adaptive"),
        (&[("tile", "1x1"), ("id-max", "1")][..], "adaptive"),
        (&[("tile", "5x3"), ("position", "unorm16"), ("workgroup", "8x8")][..], "adaptive"),
        (&[("tile", "2x4"), ("id-max", "8"), ("position", "depth")][..], "max"),
        (&[("id-scale", "2")][..], "adaptive"),
        (&[("id-scale", "3"), ("tile", "2x2"), ("id-max", "4")][..], "adaptive"),
    ] {
        let picture = |refine| {
            let changes = both(&both(&CORNELL, own), &[("mode", mode), ("refine", refine)]);
            watched.picture(NAME, &changes)
        };
        require_same(&watched.session.gpu, &picture("fused"), &picture("indirect"), &own);
    }
}

/// Fewer rays than with all of them, and than interleaved sampling at every pixel has (section 4.1), and no farther
/// from the integral than all of them by more than a tenth.
#[test]
fn adaptive_rays_are_fewer_and_its_picture_as_near_to_paths() {
    let watched = Watched::open("cornell");
    let shared = [("size", "96x72"), ("emissive", "on"), ("background", "0")];
    let reference = [("transport", "one-bounce"), ("brdf", "lambert"), ("ambient-visibility", "off"), ("spp", "256")];
    let reference = watched.picture("path_traced", &both(&shared, &reference));
    let run = |mode| {
        let renderer = watched.render(NAME, &both(&shared, &[("mode", mode)]));
        let rays = renderer.measured_counters().unwrap()["rays"];
        (rays, rmse(&renderer.picture().unwrap(), &reference))
    };
    let [(adaptive_rays, adaptive), (max_rays, max), (igi_rays, _)] = ["adaptive", "max", "igi"].map(run);
    assert!(adaptive_rays < 0.4 * max_rays && adaptive_rays < igi_rays, "{adaptive_rays} {max_rays} {igi_rays}");
    assert!(adaptive < 1.1 * max, "{adaptive} and {max}");
}

/// Rays and tiles are counted as the stages show them.
#[test]
fn counters_are_sums_over_the_stages() {
    let watched = Watched::open("cornell");
    let stages = ["rays.id", "rays.ss", "guidance.id.iterations", "guidance.ss.iterations"];
    // By slots a workgroup has 64 tiles, which are many of the few that this frame refines.
    let own = [("tile", "3x3"), ("ray-order", "tile")];
    let renderer = watched.render_stages(NAME, &both(&CORNELL, &own), &stages);
    let counters = renderer.measured_counters().unwrap();
    let pixels = EXTENT.pixel_count() as f64;
    let mut all = 0.0;
    for component in ["id", "ss"] {
        let mean = |stage: &str| {
            let stage = watched.integers(&renderer, stage);
            stage.iter().map(|count| f64::from(*count)).sum::<f64>() / pixels
        };
        let rays = mean(&format!("rays.{component}"));
        assert!((counters[&*format!("rays_{component}")] - rays).abs() < 1e-9);
        let iterations = mean(&format!("guidance.{component}.iterations"));
        assert!((counters[&*format!("iterations_{component}")] - iterations).abs() < 1e-9);
        let idle = counters[&*format!("lanes_idle_{component}")];
        assert!((0.0..0.2).contains(&idle), "{idle}");
        all += rays;
    }
    assert!((counters["rays"] - all).abs() < 1e-9);
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let watched = Watched::open("cornell");
    for (changes, words, help) in [
        (
            &[("size", "4x4"), ("tile", "5x1"), ("components", "ss")][..],
            "--tile 5x1 is larger than the picture's 4x4",
            "smaller --tile",
        ),
        (
            &[("size", "6x6"), ("tile", "5x1")][..],
            "larger than the 3x3 of 6x6 pixels that id is estimated at",
            "smaller --tile",
        ),
        (&[("id-max", "10")][..], "--id-max 10 with --tile 3x3: a pixel has 9 subsets", "--id-max 9"),
        (&[("vpls", "8")][..], "--vpls 8 for the 9 subsets of --tile 3x3", "--vpls 9 or more"),
        (&[("base", "4"), ("ss-max", "3")][..], "--base 4 with --ss-max 3", "--base 3 or fewer"),
        (&[("components", "id"), ("ss-max", "3")][..], "--ss-max 3 with --components id", ""),
        (&[("components", "ss,ss")][..], "one or more of id, ss, pm, ao", ""),
        (&[("components", "id,pm")][..], "--components pm: --medium none scatters no light", "--medium 0.1,0,0"),
        (&[("components", "pm"), ("medium", "0,1,0")][..], "--medium 0,1,0 scatters no light", "--medium 0.1,0,0"),
        (&[("components", "ao"), ("ambient", "0")][..], "there is no ambient light", "--ambient 0.3"),
        (&[("ao-max", "3")][..], "--ao-max 3 with --components auto", ""),
        (&[("trace", "host"), ("refine", "fused")][..], "--refine fused with --trace host", "--trace device"),
    ] {
        let mut job = quincunx::job::Job::new("cornell", quincunx::techniques::find(NAME).unwrap());
        let set = changes.iter().try_for_each(|(key, value)| job.set(key, value));
        let caps = &watched.session.gpu.caps;
        let error =
            set.and_then(|()| job.run_on(&crate::support::watched::watched_device()).map(|_| caps)).err().unwrap();
        assert_eq!(error.exit_code(), 2, "{error}");
        let text = format!("{error}");
        assert!(error.message().contains(words), "{changes:?}: {}", error.message());
        assert!(text.contains(help) || format!("{error:?}").contains(help), "{changes:?}: {text}");
    }
}

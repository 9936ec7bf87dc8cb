//! Glossy surfaces under virtual point lights (`--vpl-brdf ggx`; Segovia 2006, section 4.3), and the colour in sub-buffers that they
//! need.

use super::{NAME, require_same_in_every_split};
use crate::support::boxes::{camera, closed_box, point_light, rectangle};
use crate::support::difference::require_same;
use crate::support::seen::point_at;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::bvh::Bvh;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::shader::structs::VplBlock;
use quincunx::lights::vpl;
use quincunx::metrics::compare;
use quincunx::scene::{AlphaMode, Material, Scene};
use quincunx::settings::Brdf;
use quincunx::shading::brdf::{Surface, evaluate};
use quincunx::shading::light::vpl_irradiance;

const GGX: (&str, &str) = ("vpl-brdf", "ggx");
const PANE: Option<(AlphaMode, f32)> = Some((AlphaMode::Blend, 0.5));
/// Where it stands.
const PANE_Z: f32 = -0.2;
const COMMON: [(&str, &str); 4] = [("size", "64x36"), ("direct", "none"), ("vpls", "64"), ("position", "float")];

/// A box of grey walls under one lamp, and in it a metal, a plastic and, where `pane` has one, a pane of that part of cover, all
/// smooth enough to mirror. `plastic_f0`: at normal incidence.
fn glossy(plastic_f0: f32, pane: Option<(AlphaMode, f32)>) -> Watched {
    let grey = Material { double_sided: true, ..Material::diffuse("grey", vec3(0.6, 0.5, 0.4)) };
    let mut scene = closed_box(&grey);
    let smooth = |color: Vec3| Material { double_sided: true, ..Material::diffuse("smooth", color) };
    let metal = Material { metallic: 1.0, roughness: 0.4, ..smooth(vec3(0.9, 0.7, 0.3)) };
    let plastic = Material { roughness: 0.3, dielectric_f0: plastic_f0, ..smooth(vec3(0.2, 0.4, 0.7)) };
    rectangle(&mut scene, vec3(-0.5, 0.1, -0.7), 0.35 * Vec3::X, 0.4 * Vec3::Y, metal);
    rectangle(&mut scene, vec3(0.4, -0.5, -0.3), 0.3 * Vec3::X, -0.3 * Vec3::Z, plastic.clone());
    if let Some((alpha, cover)) = pane {
        let base_color = plastic.base_color.truncate().extend(cover);
        let pane = Material { alpha, base_color, ..plastic };
        rectangle(&mut scene, vec3(0.5, 0.3, PANE_Z), 0.2 * Vec3::X, 0.3 * Vec3::Y, pane);
    }
    scene.lights = vec![point_light(vec3(0.2, 0.7, 0.4), 4.0)];
    scene.cameras = vec![camera(vec3(0.1, 0.1, 0.9), vec3(0.0, 0.0, -1.0), 1.2)];
    let name = format!("glossy {plastic_f0} {pane:?}");
    Watched::with_scene(Scene { name: name.clone(), hash: name, ..scene })
}

/// The same bits in every split, storage and form of copy, where few materials say what few say too; with hidden lights, punctual
/// ones in the subsets, draws, and more runs than one.
#[test]
fn every_split_shades_the_same_mirror_part() {
    let watched = glossy(0.09, PANE);
    let way = both(&COMMON, &[GGX, ("filter", "none")]);
    let branch = require_same_in_every_split(&watched, &way);
    let lambert = watched.picture(NAME, &both(&way, &[("split", "branch"), ("vpl-brdf", "lambert")]));
    let apart = compare(&branch, &lambert, 0.1).unwrap().metrics.rmse;
    assert!(apart > 0.05, "mirrors are seen: {apart}");
    let drawn: [Changes<'_>; 4] = [
        &[("split", "fragment"), ("shade-by", "quad")],
        &[("split", "one-pass"), ("shade-by", "viewport"), ("storage", "image")],
        &[("split", "stencil")],
        &[("split", "tile")],
    ];
    let own: [Changes<'_>; 3] = [
        &[("vpl-shadow", "ray"), ("direct", "interleaved")],
        &[("accumulate", "3"), ("vpl-shadow", "map")],
        &[("position", "unorm16"), ("direct", "full"), ("cull", "tiled")],
    ];
    for own in own {
        let own = both(&way, own);
        let branch = watched.picture(NAME, &both(&own, &[("split", "branch")]));
        for split in drawn {
            require_same(&watched.session.gpu, &branch, &watched.picture(NAME, &both(&own, split)), &(&own, split));
        }
    }
}

/// What a metal, a plastic, walls and a pane that covers all send towards the eye is the sum that the host has of the same lights.
#[test]
fn the_mirror_part_is_that_of_the_formula() {
    let watched = glossy(0.04, Some((AlphaMode::Blend, 1.0)));
    let session = &watched.session;
    let bvh = Bvh::build(&session.scene).unwrap();
    let stages = ["gbuffer.normal", "gbuffer.color.id"];
    let way = both(&COMMON, &[GGX, ("split", "none"), ("blend-lights", "all")]);
    let renderer = watched.render_stages(NAME, &way, &stages);
    let (normals, ids) = (watched.rgb(&renderer, stages[0]), watched.integers(&renderer, stages[1]));
    let picture = renderer.picture().unwrap();
    let walk = vpl::Walk { count: 64, bounces: 1, emissive: false, starts: true, medium: None, seed: 1 };
    let vpls = vpl::walk(&session.scene, &bvh, &renderer.lights.lights, &walk).vpls;
    let least_squared = (0.02 * session.scene.bounds().diagonal()).powi(2);
    let (eye, width) = (renderer.view.eye(), renderer.view.extent.width);
    let pane = session.scene.materials.len() - 1;
    let mut seen = [0; 4];
    for (index, (normal, id)) in normals.iter().zip(&ids).enumerate() {
        let middle = [index as u32 % width, index as u32 / width].map(|at| f64::from(at) + 0.5);
        let direction = (point_at(&renderer.view, middle) - eye.as_dvec3()).normalize().as_vec3();
        let solid_m = bvh.closest_hit(eye, direction, 100.0, |_| true).expect("the box is closed").distance;
        let pane_m = (PANE_Z - eye.z) / direction.z;
        let on_pane = (eye + direction * pane_m - vec3(0.5, 0.3, PANE_Z)).abs();
        let is_pane = pane_m > 0.0 && on_pane.x < 0.2 && on_pane.y < 0.3;
        // At its edge a ray and a pixel may say otherwise.
        if is_pane != (pane_m > 0.0 && on_pane.x < 0.19 && on_pane.y < 0.29) {
            continue;
        }
        let material = &session.scene.materials[if is_pane { pane } else { *id as usize }];
        let position = eye + direction * if is_pane { pane_m } else { solid_m };
        let base_color = material.base_color.truncate();
        // The G-buffer holds roughness in eight bits.
        let held = if is_pane { material.roughness } else { (material.roughness * 255.0).round() / 255.0 };
        let (metallic, roughness) = (material.metallic, held);
        let surface = Surface { base_color, metallic, roughness, dielectric_f0: material.dielectric_f0 };
        let normal = if is_pane { Vec3::Z } else { Vec3::from_array(*normal) };
        let sum = |position: Vec3| -> Vec3 {
            let sent = |vpl: &VplBlock| {
                let [x, y, z, _] = vpl.position_ws;
                let to_vpl = (vec3(x, y, z) - position).normalize();
                let received = vpl_irradiance(vpl, position, normal, least_squared);
                let is_lit = received != Vec3::ZERO;
                if is_lit { received * evaluate(Brdf::Ggx, &surface, normal, to_vpl, -direction) } else { received }
            };
            vpls.iter().map(sent).sum()
        };
        let expected = sum(position);
        let found = Vec3::from_array(picture.pixels[index]);
        // Halves round by 2^-11, normals of smooth surfaces by what turns a highlight a little.
        let moved: Vec3 =
            [Vec3::X, Vec3::Y, Vec3::Z].iter().map(|step| (sum(position + 1e-4 * step) - expected).abs()).sum();
        let bound = expected * 4e-3 + 3.0 * moved + 1e-5;
        let is_near = (found - expected).abs().cmple(bound).all();
        assert!(is_near, "pixel {middle:?}, {}: {found} for {expected}", material.name);
        let kind = match (metallic > 0.0, roughness < 0.9) {
            _ if is_pane => 3,
            (true, _) => 0,
            (_, true) => 1,
            _ => 2,
        };
        seen[kind] += 1;
    }
    println!("{seen:?} pixels of metal, plastic, walls and pane");
    assert!(seen.iter().all(|count| *count > 40), "{seen:?}");
}

/// Punctual lights that each pixel finds in its subset are those of direct shading, but for halves.
#[test]
fn punctual_lights_in_subsets_have_a_mirror_part() {
    let watched = glossy(0.09, None);
    let way = both(&COMMON, &[("filter", "none"), ("direct-pattern", "1x1")]);
    for brdf in ["ggx", "lambert"] {
        let way = both(&way, &[("brdf", brdf), ("vpl-brdf", brdf)]);
        let [whole, joined] =
            ["full", "interleaved"].map(|direct| watched.picture(NAME, &both(&way, &[("direct", direct)])));
        let apart = compare(&joined, &whole, 0.1).unwrap().metrics.relmse.sqrt();
        println!("{brdf}: {apart:.6} apart");
        assert!(apart < 1e-3, "{brdf}: {apart}");
    }
}

/// Ever more virtual lights come to what walks of their own for each path come to.
#[test]
fn virtual_lights_come_to_walks() {
    let watched = glossy(0.04, None);
    for brdf in ["ggx", "lambert"] {
        let common = [("size", "32x18"), ("brdf", brdf), ("vpl-brdf", brdf)];
        let paths = [("spp", "4096"), ("transport", "one-bounce"), ("vpl-visibility", "off"), ("pixel", "middle")];
        let walked = watched.picture("path_traced", &both(&common, &paths));
        let off = |vpls| {
            let own = [("vpls", vpls), ("split", "none"), ("direct-shadow", "ray"), ("position", "float")];
            compare(&watched.picture(NAME, &both(&common, &own)), &walked, 0.1).unwrap().metrics.relmse.sqrt()
        };
        let [few, many] = ["64", "8192"].map(off);
        println!("{brdf}: {few:.4} off with 64 lights, {many:.4} with 8192");
        assert!(many < 0.03 && many < 0.3 * few, "{brdf}: {few}, {many}");
    }
}

/// A dielectric with the index of refraction of air mirrors nothing: what few materials say reaches every shading.
#[test]
fn what_refracts_as_air_does_is_diffuse() {
    let watched = glossy(0.0, PANE);
    for split in ["none", "one-pass", "fragment", "depth"] {
        let way = both(&COMMON, &[("split", split), ("filter", "none")]);
        let ids = watched.integers(&watched.render_stages(NAME, &way, &["gbuffer.color.id"]), "gbuffer.color.id");
        let [ggx, lambert] = ["ggx", "lambert"].map(|brdf| watched.picture(NAME, &both(&way, &[("vpl-brdf", brdf)])));
        let mut plastic_count = 0;
        for (id, (ggx, lambert)) in ids.iter().zip(ggx.pixels.iter().zip(&lambert.pixels)) {
            if watched.session.scene.materials[*id as usize].dielectric_f0 != 0.0 {
                continue;
            }
            let [ggx, lambert] = [ggx, lambert].map(|pixel| Vec3::from_array(*pixel));
            let apart = (ggx - lambert).abs().max_element();
            assert!(apart <= 2e-3 * lambert.max_element(), "{split}: {ggx} and {lambert}");
            plastic_count += 1;
        }
        assert!(plastic_count > 30, "{split}: {plastic_count}");
    }
}

/// The colour of sub-buffers is that of the frame; where shading does not read it, no bit of the picture changes.
#[test]
fn colour_moves_with_position_and_normal() {
    let watched = glossy(0.04, PANE);
    let way = both(&COMMON, &[("pattern", "5x3"), ("size", "61x37")]);
    let plain = watched.picture(NAME, &both(&way, &[("split", "branch")]));
    for split in super::copies() {
        let own = both(&way, &both(&split, &[("sub-buffer-color", "on")]));
        let renderer = watched.render_stages(NAME, &own, &["gbuffer.color", "split.color"]);
        require_same(&watched.session.gpu, &renderer.picture().unwrap(), &plain, &split);
        let [whole, moved] = ["gbuffer.color", "split.color"].map(|stage| watched.rgb(&renderer, stage));
        let extent = renderer.view.extent;
        assert_eq!(super::split::back_in_frame_order(&moved, extent, [5, 3]), whole, "{split:?}");
        assert!(whole.iter().any(|color| color[0] != whole[0][0]), "there are several colours");
    }
}

#[test]
fn glossy_sub_buffers_without_colour_are_refused() {
    let watched = Watched::open("cornell");
    let changes = [("size", "16x16"), GGX, ("sub-buffer-color", "off")];
    let refused = watched.try_renderer(NAME, &changes, &[], Submits::One).err().expect("it is refused");
    assert_eq!(refused.exit_code(), 2);
    let text = refused.to_string();
    assert!(text.contains("--sub-buffer-color off with --vpl-brdf ggx") && text.contains("auto or on"), "{text}");
    // What copies nothing reads the frame's.
    watched.render(NAME, &both(&changes, &[("split", "branch")]));
}

//! Inferred lighting's filter (Kircher 2009, section 3): whose light a pixel takes, and how near that is to many samples.

use crate::support::boxes::{edge, rectangle};
use crate::support::choices::words_but;
use crate::support::watched::{Watched, both};
use glam::{Vec3, vec3};
use quincunx::picture::AovChannels;
use quincunx::scene::Material;
use std::collections::BTreeSet;

const NAME: &str = "inferred_lighting";

/// Samples of the wall are thrown out where the square is shaded, however bright they are; plain filtering lets them in.
#[test]
fn the_filter_keeps_another_surface_s_light_out() {
    let dark = Watched::with_scene(edge(0.0));
    let bright = Watched::with_scene(edge(500.0));
    let common = [("size", "160x120"), ("light-size", "50x38"), ("brdf", "lambert"), ("light-cutoff", "0")];
    // The square's own pixels, by a light buffer of the frame's size.
    let marked = both(&common, &[("light-size", "160x120")]);
    let renderer = dark.render_stages(NAME, &marked, &["geometry.dsf.id"]);
    let ids = dark.integers(&renderer, "geometry.dsf.id");
    let is_square = |index: &usize| ids[*index] >> 8 == 1;
    assert!((0..ids.len()).filter(is_square).count() > 1000);
    for (filter, leaks) in
        [("dsf", false), ("discontinuity", false), ("bilateral", false), ("bilinear", true), ("nearest", true)]
    {
        let changes = both(&common, &[("light-filter", filter)]);
        let [a, b] = [&dark, &bright].map(|watched| watched.picture(NAME, &changes).pixels);
        let changed = (0..ids.len()).filter(is_square).filter(|index| a[*index] != b[*index]).count();
        assert_eq!(changed > 0, leaks, "--light-filter {filter}: {changed} pixels of the square changed");
        let wall = (0..ids.len()).filter(|index| !is_square(index)).filter(|index| a[*index] != b[*index]).count();
        assert!(wall > 1000, "the light reaches the wall");
    }
}

/// The same where the wall and the square are one draw in one normal group: depth alone says which samples are whose.
#[test]
fn depth_tells_parts_of_one_surface_apart() {
    let one_draw = |wall_light: f32| {
        let mut scene = edge(wall_light);
        let square = scene.meshes.pop().unwrap();
        let wall = &mut scene.meshes[0];
        wall.indices.extend(square.indices.iter().map(|index| index + 4));
        wall.positions.extend(square.positions);
        wall.normals.extend(square.normals);
        wall.tangents.extend(square.tangents);
        wall.uvs.extend(square.uvs);
        scene.draws.pop();
        Watched::with_scene(scene)
    };
    let (dark, bright) = (one_draw(0.0), one_draw(500.0));
    let common = [("size", "160x120"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let stages = ["geometry.dsf.id", "geometry.dsf.depth"];
    let full = dark.render_stages(NAME, &both(&common, &[("light-size", "160x120")]), &stages);
    assert_eq!(dark.integers(&full, stages[0]).into_iter().collect::<BTreeSet<u32>>().len(), 1, "one id");
    let AovChannels::Y(depths_m) = full.aov(stages[1]).unwrap().channels else { panic!("one channel") };
    let square: Vec<usize> = (0..depths_m.len()).filter(|index| depths_m[*index] < 4.5).collect();
    assert!(square.len() > 1000);
    // The wall is 6 m away, the square 3.
    for (threshold, leaks) in [("0", false), ("0.05", false), ("0.9", false), ("1", true)] {
        let changes = both(&common, &[("light-size", "50x38"), ("depth-threshold", threshold)]);
        let [a, b] = [&dark, &bright].map(|watched| watched.picture(NAME, &changes).pixels);
        let changed = square.iter().filter(|index| a[**index] != b[**index]).count();
        assert_eq!(changed > 0, leaks, "--depth-threshold {threshold}: {changed} pixels of the square changed");
    }
}

/// The paper's figure 4, pixel by pixel: the light of a pixel is the bilinear mean of those of its four texels that show its
/// surface, by their ids. Where none does, `--light-rings 1` takes those of the twelve around them that do, by a tent of twice the
/// width; all four where there is none either, which is counted. The sliver is too narrow to reach many texels.
#[test]
fn a_pixel_takes_the_texels_of_its_own_surface() {
    const RATIO: usize = 4;
    let (extent, texels) = ([160, 120], [40, 30]);
    let mut scene = edge(300.0);
    let gray = Material::diffuse("gray", Vec3::splat(0.5));
    rectangle(&mut scene, vec3(0.9, 0.3, -2.9), vec3(0.02, 0.0, 0.0), vec3(0.1, 0.7, 0.0), gray);
    let watched = Watched::with_scene(scene);
    let common = [("size", "160x120"), ("light-size", "40x30"), ("brdf", "lambert"), ("light-cutoff", "0")];
    let stages = ["geometry.dsf.id", "light.l_buffer.irradiance"];
    let full = watched.render_stages(NAME, &both(&common, &[("light-size", "160x120")]), &stages[..1]);
    let ids = watched.integers(&full, stages[0]);
    for (rings, texels_away) in [("0", 0..2), ("1", -1..3)] {
        let low = watched.render_stages(NAME, &both(&common, &[("light-rings", rings)]), &stages);
        let low_ids = watched.integers(&low, stages[0]);
        let light = watched.rgb(&low, stages[1]);
        let picture = low.picture().unwrap();
        // Any pixel of a texel shows the texel.
        let shown = |[x, y]: [usize; 2]| (y * RATIO + RATIO / 2) * extent[0] + x * RATIO + RATIO / 2;
        // Pixels by how many of their four texels are their own; of those without, how many found some farther away.
        let (mut found, mut found_farther) = ([0; 5], 0);
        for (pixel, id) in ids.iter().enumerate() {
            let at = [pixel % extent[0], pixel / extent[0]].map(|at| (at as f32 + 0.5) / RATIO as f32 - 0.5);
            let [mut own, mut all, mut farther] = [(Vec3::ZERO, 0.0, 0); 3];
            for step in texels_away.clone().flat_map(|y| texels_away.clone().map(move |x| [x, y])) {
                let texel =
                    [0, 1].map(|side| (at[side].floor() as i32 + step[side]).clamp(0, texels[side] - 1) as usize);
                let is_near = step.iter().all(|step| (0..2).contains(step));
                let reach = if is_near { 1.0 } else { 2.0 };
                let weigh = |side: usize| 1.0 - (step[side] as f32 - at[side] + at[side].floor()).abs() / reach;
                let (weight, irradiance) = (weigh(0) * weigh(1), Vec3::from_array(light[shown(texel)]));
                let add = |sum: &mut (Vec3, f32, usize)| {
                    *sum = (sum.0 + irradiance * weight, sum.1 + weight, sum.2 + 1);
                };
                let is_own = low_ids[shown(texel)] == *id;
                match (is_near, is_own) {
                    (true, true) => [&mut all, &mut own].into_iter().for_each(add),
                    (true, false) => add(&mut all),
                    (false, true) => add(&mut farther),
                    (false, false) => {}
                }
            }
            found[own.2] += 1;
            found_farther += usize::from(own.2 == 0 && farther.2 > 0);
            let (sum, weights, _) = [own, farther].into_iter().find(|sum| sum.2 > 0).unwrap_or(all);
            let expected = sum / weights * (0.5 / std::f32::consts::PI);
            let off = (Vec3::from_array(picture.pixels[pixel]) - expected).abs().max_element();
            let bound = 3e-4 * expected.max_element() + 1e-6;
            assert!(off <= bound, "{rings} rings, pixel {pixel}: {off} off {expected}, {} texels", own.2);
        }
        println!(
            "{rings} rings: pixels by how many of their four texels are theirs {found:?}, {found_farther} farther away"
        );
        assert!(found.iter().all(|count| *count > 20), "{found:?}");
        assert!(rings == "0" || (found_farther > 20 && found_farther < found[0]), "{found_farther} of {found:?}");
        let rejected = low.measured_counters().unwrap()["rejected_fragments"];
        assert_eq!(rejected, (found[0] - found_farther) as f64, "{found:?}");
    }
}

/// Where the light buffer's nearest texel shows another surface than the pixel does, the filter is nearer to what many samples a
/// pixel come to than plain filtering is.
#[test]
fn on_edges_the_filter_is_nearer_to_the_supersampled_picture() {
    let (size, common) = ("200x112", [("brdf", "lambert"), ("size", "200x112")]);
    for spec in ["lamps:objects=101,lights=81", "fence:lights=20", "hall:triangles=8000"] {
        let watched = Watched::open(spec);
        let reference = watched.picture("forward", &both(&common, &[("supersample", "8")]));
        let ids = |light_size: &str| {
            let changes = both(&common, &[("light-size", light_size)]);
            let renderer = watched.render_stages(NAME, &changes, &["geometry.dsf.id"]);
            watched.integers(&renderer, "geometry.dsf.id")
        };
        let (low, high) = (ids("auto"), ids(size));
        let chosen: Vec<usize> = (0..low.len()).filter(|index| low[*index] != high[*index]).collect();
        assert!(chosen.len() > 500, "{spec}: {} pixels", chosen.len());
        let rmse = |filter: &str| {
            let picture = watched.picture(NAME, &both(&common, &[("msaa", "4"), ("light-filter", filter)]));
            let square = |index: &usize| {
                let channels = picture.pixels[*index].into_iter().zip(reference.pixels[*index]);
                channels.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / 3.0
            };
            (chosen.iter().map(square).sum::<f64>() / chosen.len() as f64).sqrt()
        };
        let [dsf, bilinear, nearest] = ["dsf", "bilinear", "nearest"].map(rmse);
        println!("{spec}: {} pixels, dsf {dsf:.4}, bilinear {bilinear:.4}, nearest {nearest:.4}", chosen.len());
        assert!(dsf < bilinear && bilinear < nearest, "{spec}: {dsf}, {bilinear}, {nearest}");
    }
}

/// A sampler may round a fetch's place: to one of 16 from texel to texel at the coarsest that Vulkan allows, of 256 on most GPUs,
/// not at all on lavapipe. A half float has 1024 steps from one power of two to the next.
#[test]
fn a_single_fetch_blends_as_four_do_but_for_the_sampler_s_steps() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "160x90"), ("brdf", "lambert")];
    let picture = |fetch: &str, filter: &str| {
        watched.picture(NAME, &both(&common, &[("light-fetch", fetch), ("light-filter", filter)])).pixels
    };
    // One texel is nothing to blend, and hardly a texel belongs wholly to a bilateral filter's surface.
    for filter in words_but(NAME, "light-filter", &["nearest", "bilateral"]) {
        let (four, single) = (picture("texels", filter), picture("sampler", filter));
        let step = |value: f32| 2f32.powi(value.max(1e-6).log2().floor() as i32 - 10);
        let steps = four.as_flattened().iter().zip(single.as_flattened()).map(|(a, b)| (a - b).abs() / step(a.max(*b)));
        let (mut most, mut sum) = (0f32, 0f64);
        for steps in steps {
            most = most.max(steps);
            sum += f64::from(steps);
        }
        let mean = sum / (3 * four.len()) as f64;
        println!("{filter}: {most} half-float steps at most, {mean} in the mean");
        assert!(most > 0.0, "{filter}: it is another way");
        // Two steps for each time that two texels differ by the value between them, as at edges: 34 on an H200, and 0.4 in the mean.
        let allowed = if watched.session.gpu.caps.identity.is_software() { 8.0 } else { 64.0 };
        assert!(most < allowed && mean < 1.0, "{filter}: {most} half-float steps, {mean} in the mean");
    }
}

//! What follows the estimates: the box filter and the guided upsampling, each against a few lines (Dubla 2009, sections 3 and
//! 4.1).

use super::{CORNELL, EXTENT, NAME, Shown, shown};
use crate::support::watched::{Watched, both};
use glam::Vec3;
use quincunx::bvh::Bvh;

/// Each pixel of the box counts that a walk reaches which goes right or left only, and down or up only, over no flag.
#[test]
fn the_filter_is_the_mean_of_what_no_discontinuity_parts() {
    let watched = Watched::open("cornell");
    for (tile, [width, height]) in [("3x3", [3i32, 3]), ("4x2", [4, 2]), ("8x7", [8, 7])] {
        let changes = both(&CORNELL, &[("components", "ss"), ("tile", tile)]);
        let stages = ["irradiance.ss", "filter.irradiance.ss", "discontinuity.flags"];
        let renderer = watched.render_stages(NAME, &changes, &stages);
        let [source, filtered] = ["irradiance.ss", "filter.irradiance.ss"].map(|stage| watched.rgb(&renderer, stage));
        let flags = watched.integers(&renderer, "discontinuity.flags");
        let index = |x: i32, y: i32| (y * EXTENT.width as i32 + x) as usize;
        let is_in = |x: i32, y: i32| (0..EXTENT.width as i32).contains(&x) && (0..EXTENT.height as i32).contains(&y);
        // Every such walk, one step at a time.
        fn reaches(from: [i32; 2], to: [i32; 2], open: &dyn Fn([i32; 2], [i32; 2]) -> bool) -> bool {
            if from == to {
                return true;
            }
            let steps = [[(to[0] - from[0]).signum(), 0], [0, (to[1] - from[1]).signum()]];
            steps.into_iter().filter(|step| *step != [0, 0]).any(|step| {
                let next = [from[0] + step[0], from[1] + step[1]];
                open(from, next) && reaches(next, to, open)
            })
        }
        let open = |from: [i32; 2], to: [i32; 2]| {
            let lesser = [from[0].min(to[0]), from[1].min(to[1])];
            flags[index(lesser[0], lesser[1])] & if from[0] == to[0] { 2 } else { 1 } == 0
        };
        let mut parted = 0;
        for y in (0..EXTENT.height as i32).step_by(3) {
            for x in (0..EXTENT.width as i32).step_by(2) {
                let (mut sum, mut count) = (Vec3::ZERO, 0);
                for (dx, dy) in
                    (0..height).flat_map(|dy| (0..width).map(move |dx| (dx - (width - 1) / 2, dy - (height - 1) / 2)))
                {
                    if is_in(x + dx, y + dy) && reaches([x, y], [x + dx, y + dy], &open) {
                        sum += Vec3::from_array(source[index(x + dx, y + dy)]);
                        count += 1;
                    }
                }
                parted += u32::from(count < width * height);
                let (found, expected) = (Vec3::from_array(filtered[index(x, y)]), sum / count as f32);
                let off = (found - expected).abs().max_element();
                assert!(off <= 2e-3 * expected.max_element().max(1e-3), "{tile} at {x},{y}: {found} and {expected}");
            }
        }
        assert!(parted > 100, "{tile}: {parted}");
    }
}

/// Four texels around a pixel, weighed by tents over the screen, normals and distances from the pixel's plane (section
/// 4.1); the nearest in the scene where none is like it.
#[test]
fn upsampling_is_guided_by_normals_and_planes() {
    let watched = Watched::open("cornell");
    let scene = &watched.session.scene;
    let bvh = Bvh::build(scene).unwrap();
    let shown = shown(&watched, &bvh);
    let at = |pixel: [u32; 2]| shown.iter().find(|shown| shown.pixel == pixel);
    let diagonal = scene.lasting_bounds().diagonal();
    for (scale, plane) in [(2u32, "0.5%"), (3, "0.02%")] {
        let threshold = if scale == 2 { 0.005 } else { 0.0002 } * diagonal;
        let scale_text = scale.to_string();
        // A box of one texel leaves them as they are.
        let own =
            [("components", "id"), ("tile", "1x1"), ("id-max", "1"), ("vpls", "64"), ("position-threshold", plane)];
        let changes = both(&both(&CORNELL, &own), &[("id-scale", &scale_text)]);
        let renderer = watched.render_stages(NAME, &changes, &["irradiance.id", "filter.irradiance.id"]);
        let [source, upsampled] = ["irradiance.id", "filter.irradiance.id"].map(|stage| watched.rgb(&renderer, stage));
        let brightest = source.as_flattened().iter().fold(0f32, |most, channel| most.max(*channel));
        let tent = |distance: f32, threshold: f32| (1.0 - distance / threshold).max(0.0);
        let (mut checked, mut alone, mut off) = (0, 0, 0);
        for pixel in shown.iter().step_by(2) {
            let lower = pixel.pixel.map(|side| side / scale);
            let part = pixel.pixel.map(|side| (side % scale) as f32 / scale as f32);
            let texels = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|beside: [u32; 2]| {
                let place = [0, 1].map(|axis| (lower[axis] + beside[axis]) * scale);
                let near = [0, 1].map(|axis| if beside[axis] == 1 { part[axis] } else { 1.0 - part[axis] });
                at(place).map(|other| (other, near[0] * near[1]))
            });
            // Rays do not know for sure what one of them shows.
            let Some(texels) = texels.into_iter().collect::<Option<Vec<_>>>() else { continue };
            let value =
                |other: &Shown| Vec3::from_array(source[(other.pixel[1] * EXTENT.width + other.pixel[0]) as usize]);
            let (mut sum, mut weights) = (Vec3::ZERO, 0.0);
            for (other, near) in &texels {
                let plane = pixel.normal.dot(other.position - pixel.position).abs();
                let weight = near * tent(1.0 - pixel.normal.dot(other.normal), 0.3) * tent(plane, threshold);
                sum += value(other) * weight;
                weights += weight;
            }
            let distance = |other: &Shown| other.position.distance_squared(pixel.position);
            let nearest = texels.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).unwrap();
            alone += u32::from(weights <= 1e-4);
            let expected = if weights > 1e-4 { sum / weights } else { value(nearest.0) };
            let [x, y] = pixel.pixel;
            let found = Vec3::from_array(upsampled[(y * EXTENT.width + x) as usize]);
            off += u32::from((found - expected).abs().max_element() > 5e-3 * brightest);
            checked += 1;
        }
        assert!(checked > 300 && off * 100 <= checked, "{scale}: {off} of {checked}, {alone} alone");
    }
}

/// However many pixels of a column a thread filters, and whatever the box.
#[test]
fn filters_of_one_pixel_a_thread_and_of_many_are_the_same() {
    let watched = Watched::open("cornell");
    for tile in ["1x1", "3x3", "2x5", "8x8"] {
        let hash =
            |texels| watched.hash(NAME, &both(&CORNELL, &[("components", "ss"), ("tile", tile), ("texels", texels)]));
        let plain = hash("1");
        for texels in ["2", "8"] {
            assert_eq!(hash(texels), plain, "{tile}, {texels}");
        }
    }
}

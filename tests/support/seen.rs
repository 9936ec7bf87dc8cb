//! Which triangle a pixel shows, by rays on the host.

use crate::support::placing_steps;
use crate::support::watched::Watched;
use glam::{DVec3, dvec3};
use quincunx::bvh::{Bvh, Hit, Source};
use quincunx::frame::View;
use quincunx::scene::AlphaMode;

/// A pixel's middle on each side of which the rasteriser may have placed an edge, in pixels, where vertices lie on a grid of 256
/// a pixel; rays and edges are rounded.
const EDGE_PX: f64 = 0.02;

/// A part of a distance: where two surfaces are less apart, either may be seen.
const SAME_DEPTH: f32 = 1e-4;

/// The point in the world, at depth 0.5, that a place of the picture shows; `at` in pixels from the upper left corner.
pub fn point_at(view: &View, at: [f64; 2]) -> DVec3 {
    let world_from_clip = view.clip_from_world().as_dmat4().inverse();
    let ndc = |at: f64, side: u32| at / f64::from(side) * 2.0 - 1.0;
    world_from_clip.project_point3(dvec3(ndc(at[0], view.extent.width), ndc(at[1], view.extent.height), 0.5))
}

/// What a pixel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    Nothing,
    Surface(Source),
    /// An edge between two draws is so near to the pixel's middle, or one of them so near behind the other, that either may
    /// be seen.
    Unclear,
}

/// What each pixel shows, row-major; of a scene whose surfaces are all opaque.
pub fn sources(watched: &Watched, view: &View) -> Vec<Seen> {
    let scene = &watched.session.scene;
    assert!(scene.drawn_materials().all(|material| material.alpha == AlphaMode::Opaque), "rays know no holes");
    let bvh = Bvh::build(scene).unwrap();
    let eye = view.eye();
    let edge_px = EDGE_PX * placing_steps(&watched.session.gpu.caps);
    let hit_at = |at: [f64; 2], unlike: Option<Source>| {
        let direction = (point_at(view, at) - eye.as_dvec3()).normalize().as_vec3();
        let is_another = |hit: &Hit| unlike.is_none_or(|source| bvh.sources[hit.triangle].draw != source.draw);
        bvh.closest_hit(eye, direction, f32::INFINITY, |hit| !bvh.is_culled_back(hit, direction) && is_another(hit))
    };
    let draw_at = |at: [f64; 2]| hit_at(at, None).map(|hit| bvh.sources[hit.triangle].draw);
    let pixels = (0..view.extent.height).flat_map(|y| (0..view.extent.width).map(move |x| [x, y]));
    pixels
        .map(|[x, y]| {
            let middle = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let hit = hit_at(middle, None);
            let source = hit.map(|hit| bvh.sources[hit.triangle]);
            let draw = source.map(|source| source.draw);
            let around = [[-edge_px, 0.0], [edge_px, 0.0], [0.0, -edge_px], [0.0, edge_px]];
            if around.iter().any(|step| draw_at([middle[0] + step[0], middle[1] + step[1]]) != draw) {
                return Seen::Unclear;
            }
            let (Some(hit), Some(source)) = (hit, source) else { return Seen::Nothing };
            let next = hit_at(middle, Some(source)).map_or(f32::INFINITY, |next| next.distance);
            if next < hit.distance * (1.0 + SAME_DEPTH) { Seen::Unclear } else { Seen::Surface(source) }
        })
        .collect()
}

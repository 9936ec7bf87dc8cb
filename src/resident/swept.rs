//! Views that see from more than one place and moment: through a lens, while the shutter is open.
//!
//! A cluster is left out where every place of the lens has it outside of one plane that clips, from the beginning of the exposure
//! to its end. Along a plane a point's distance is a line over the lens and over time, and what the lens adds is convex in the
//! point: where the corners of a cluster's box are outside at both ends, so is all that lies between them. Facing is not looked
//! at: another place of the lens sees another side. Where something moves, the box at the end is made of the cluster's corners, once
//! a renderer.

use super::clipped::outside_one_plane;
use super::disc::LensDisc;
use super::draw_view::DrawView;
use super::raster::Raster;
use super::{Cluster, DrawCall};
use crate::frame::View;
use crate::scene::{Bounds, Scene};

/// From where, and until when, a view sees.
#[derive(Clone, Copy, Default)]
pub struct Sweep<'a> {
    /// None: from the camera's place alone.
    pub lens: Option<LensDisc>,
    /// The scene and its view when the shutter closes; None: nothing moves.
    pub closing: Option<(&'a Scene, &'a View)>,
}

/// A draw as it is seen when the shutter opens, and when it closes where that is another view of it.
pub struct SweptView<'a> {
    pub open: DrawView<'a>,
    close: Option<DrawView<'a>>,
    /// One place, one moment.
    is_still: bool,
}

impl<'a> SweptView<'a> {
    pub fn new(scene: &'a Scene, call: &DrawCall, view: &View, raster: Raster, sweep: Sweep<'a>) -> Self {
        let of = |scene, view| DrawView::new(scene, call, view, raster, sweep.lens);
        Self {
            open: of(scene, view),
            close: sweep.closing.map(|(scene, view)| of(scene, view)),
            is_still: sweep.lens.is_none() && sweep.closing.is_none(),
        }
    }

    /// True: no sample can see a triangle of the cluster. `indices`: the cluster's.
    pub fn sees_nothing_of(&self, cluster: &Cluster, indices: &[u32]) -> bool {
        if self.is_still {
            return self.open.sees_nothing_of(cluster, indices);
        }
        let mut corners = cluster.bounds.corners().map(|corner| self.open.clipped(corner)).to_vec();
        if let Some(close) = &self.close {
            let mut bounds = Bounds::EMPTY;
            indices.iter().for_each(|index| bounds.include(close.positions[*index as usize]));
            corners.extend(bounds.corners().map(|corner| close.clipped(corner)));
        }
        outside_one_plane(&corners)
    }
}

#[cfg(test)]
mod tests {
    use super::super::DrawList;
    use super::super::clipped::Clipped;
    use super::super::{ClusteredCalls, Coverage, Geometry, Raster};
    use super::*;
    use crate::frame::{LensPlace, Placement};
    use crate::lens::on_unit_disc;
    use crate::scene::{AlphaMode, procedural};
    use crate::settings::GeometryChoice;
    use crate::units::Extent;
    use glam::{DMat4, DVec2, DVec4, Mat4, Quat, Vec3};
    use proptest::prelude::*;

    fn list(scene: &Scene, view: &View, sweep: Sweep<'_>) -> (Geometry, DrawList) {
        let geometry = Geometry::of(scene);
        let calls = geometry.calls(scene);
        let clustered = ClusteredCalls { calls: &calls, clusters: &geometry.clusters, indices: &geometry.indices };
        let raster = Raster { extent: view.extent, coverage: Coverage::Anywhere };
        let list = DrawList::of(scene, &clustered, view, raster, GeometryChoice::Culled, sweep);
        (geometry, list)
    }

    /// Clip space through a place of the lens, by the matrices that members of interleaved sampling are drawn with.
    fn clip(view: &View, scene: &Scene, place: LensPlace) -> DMat4 {
        let block = view.block(&scene.bounds(), Vec3::ZERO, Vec3::ZERO, 0, 0);
        let block = view.seen_from(block, place, Placement::WHOLE);
        DMat4::from_cols_array_2d(&block.clip_from_world.map(|column| column.map(f64::from)))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8))]

        /// Corners and middles of triangles that are left out lie outside of the picture, wherever on the lens and whenever.
        #[test]
        fn what_is_left_out_is_nowhere_in_the_picture(
            radius in 0.0f32..0.6, focus in 0.5f32..8.0, aside in -0.2f32..0.2, turn in -0.4f32..0.4, moved in -2.0f32..2.0,
            has_lens: bool, has_motion: bool,
        ) {
            // One place at one moment leaves out what faces away, too.
            prop_assume!(has_lens || has_motion);
            let scene = procedural::build("hall:triangles=8000", 1).unwrap().unwrap();
            let view = View::new(&scene, "0", Extent::new(64, 36)).unwrap();
            let mut closing = scene.clone();
            let way = Mat4::from_rotation_translation(Quat::from_rotation_y(turn), Vec3::new(moved, 0.0, 0.3 * moved));
            closing.draws.iter_mut().step_by(2).for_each(|draw| draw.world_from_object = way * draw.world_from_object);
            let mut closing_view = view.clone();
            closing_view.camera.world_from_view *= Mat4::from_rotation_y(0.5 * turn);
            let lens = LensDisc { aside_m: aside, radius_m: radius, focus_m: focus };
            let sweep = Sweep {
                lens: has_lens.then_some(lens),
                closing: has_motion.then_some((&closing, &closing_view)),
            };
            let (geometry, list) = list(&scene, &view, sweep);
            let kept = |draw: u32, index: u32| {
                let holds = |part: &&super::super::DrawCall| {
                    part.draw == draw && (part.first_index..part.first_index + part.index_count).contains(&index)
                };
                list.calls().find(holds).is_some()
            };
            let numbers = |index: u32| [0, 1, 2].map(|axis| sobol_burley::sample(index, axis, 7));
            let sights: Vec<(DMat4, DMat4, f64)> = (0..8).map(|index| {
                let [u, v, time] = numbers(index);
                let place = match has_lens {
                    true => LensPlace {
                        at_m: radius * on_unit_disc([u, v]) + aside * glam::Vec2::X,
                        focus_m: focus,
                    },
                    false => LensPlace::MIDDLE,
                };
                let time = if has_motion { f64::from(time) } else { 0.0 };
                (clip(&view, &scene, place), clip(&closing_view, &closing, place), time)
            }).collect();
            for call in geometry.calls(&scene).iter().filter(|call| call.alpha != AlphaMode::Blend) {
                for cluster in &geometry.clusters[call.clusters()] {
                    if kept(call.draw, cluster.first_index) {
                        continue;
                    }
                    let [open, close] = [&scene, &closing].map(|scene| &scene.draws[call.draw as usize]);
                    for corners in geometry.indices[cluster.indices()].chunks_exact(3) {
                        let at = |scene: &Scene, mesh: usize| {
                            let corners = [0, 1, 2].map(|at| scene.meshes[mesh].positions[corners[at] as usize].as_dvec3());
                            [corners[0], corners[1], corners[2], (corners[0] + corners[1] + corners[2]) / 3.0]
                        };
                        let (from, to) = (at(&scene, open.mesh), at(&closing, close.mesh));
                        for (before, after, time) in &sights {
                            for (from, to) in from.iter().zip(&to) {
                                let from = *before * open.world_from_object.as_dmat4() * from.extend(1.0);
                                let to = *after * close.world_from_object.as_dmat4() * to.extend(1.0);
                                let seen = Clipped { at: from.lerp(to, *time), error: DVec4::ZERO, reach: DVec2::ZERO };
                                prop_assert!(seen.inside().iter().any(|inside| *inside < 0.0), "{:?}", seen.at);
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_small_lens_leaves_out_what_is_beside_the_picture() {
        let scene = procedural::build("hall:triangles=8000", 1).unwrap().unwrap();
        let view = View::new(&scene, "0", Extent::new(64, 36)).unwrap();
        let lens = |radius_m| Some(LensDisc { aside_m: 0.0, radius_m, focus_m: 4.0 });
        let culled = |lens| list(&scene, &view, Sweep { lens, closing: None }).1.clusters_culled;
        let [small, large] = [0.05, 3.0].map(|radius| culled(lens(radius)));
        assert!(small > large && 2 * small > culled(None), "{small}, {large}, {}", culled(None));
    }
}

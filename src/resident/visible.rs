//! Which clusters of the solid draws a view needs, and in which order: outside the view, and with their backs to it, they
//! are left out; the rest is drawn front to back.
//!
//! Why this way: leaving out is exact. A cluster is left out only where no triangle of it can make a fragment, whatever
//! the device's 32-bit arithmetic and its snapping of corners do; a cone of normals would be quicker to test and cannot
//! promise that, because snapping can flip thin triangles. Single triangles are tested only in clusters that the
//! planes left, up to the first that may be seen: the 78,000 triangles of `hall:triangles=80000` take 0.8 ms, once a
//! renderer.
//!
//! Sorting is not exact by itself: of two surfaces at the same depth the first one drawn wins, and others win in another
//! order (ten pixels of the picture of `hall:triangles=80000` at 1024x768). So `--geometry all` draws everything in the
//! same order, in which what was left out has no say: the same bits on every device.

use super::raster::{Coverage, Raster};
use super::swept::{Sweep, SweptView};
use super::{Cluster, ClusteredCalls, DrawCall, SceneGpu, Sides};
use crate::frame::View;
use crate::scene::{AlphaMode, Scene};
use crate::settings::GeometryChoice;

/// The solid part of a scene as a view needs it: ranges of draws, nearest first, clusters that follow each other as one.
#[derive(Default)]
pub struct DrawList {
    pub opaque: Vec<DrawCall>,
    pub mask: Vec<DrawCall>,
    pub clusters_drawn: u64,
    pub clusters_culled: u64,
}

impl DrawList {
    /// `sweep`: from where and until when `view` sees, which is as the shutter opens.
    pub fn new(
        scene: &Scene,
        resident: &SceneGpu,
        view: &View,
        raster: Raster,
        choice: GeometryChoice,
        sweep: Sweep<'_>,
    ) -> Self {
        Self::of(scene, &resident.clustered(&resident.calls), view, raster, choice, sweep)
    }

    /// What casts shadows into a map that is drawn from `view`: both sides of every triangle, as shadow rays meet both. `scene`:
    /// as its draws stand in the map.
    pub fn of_casters(scene: &Scene, resident: &SceneGpu, view: &View, choice: GeometryChoice) -> Self {
        let both_sides = |call: &DrawCall| DrawCall { sides: Sides::Both, ..*call };
        let calls: Vec<DrawCall> = resident.calls.iter().map(both_sides).collect();
        let raster = Raster { extent: view.extent, coverage: Coverage::Middle };
        Self::of(scene, &resident.clustered(&calls), view, raster, choice, Sweep::default())
    }

    pub(super) fn of(
        scene: &Scene,
        clustered: &ClusteredCalls<'_>,
        view: &View,
        raster: Raster,
        choice: GeometryChoice,
        sweep: Sweep<'_>,
    ) -> Self {
        let ClusteredCalls { calls, clusters, indices } = *clustered;
        let mut kept: Vec<(f64, DrawCall)> = Vec::new();
        let mut clusters_culled = 0;
        for call in calls.iter().filter(|call| call.alpha != AlphaMode::Blend) {
            let swept = SweptView::new(scene, call, view, raster, sweep);
            for cluster in &clusters[call.clusters()] {
                if choice == GeometryChoice::Culled && swept.sees_nothing_of(cluster, &indices[cluster.indices()]) {
                    clusters_culled += 1;
                } else {
                    let Cluster { first_index, index_count, bounds } = *cluster;
                    kept.push((swept.open.distance(&bounds), DrawCall { first_index, index_count, ..*call }));
                }
            }
        }
        // Stable: what is equally far stays in the order of the calls.
        kept.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let clusters_drawn = kept.len() as u64;
        let mut list = Self { opaque: Vec::new(), mask: Vec::new(), clusters_drawn, clusters_culled };
        kept.into_iter().for_each(|(_, part)| list.push(part));
        list
    }

    /// Adds a part of a draw; what follows the last one is one with it.
    pub(super) fn push(&mut self, part: DrawCall) {
        let calls = if part.alpha == AlphaMode::Opaque { &mut self.opaque } else { &mut self.mask };
        match calls.last_mut() {
            Some(last) if last.draw == part.draw && last.first_index + last.index_count == part.first_index => {
                last.index_count += part.index_count;
            }
            _ => calls.push(part),
        }
    }

    /// In the order of drawing.
    pub fn calls(&self) -> impl Iterator<Item = &DrawCall> {
        self.opaque.iter().chain(&self.mask)
    }

    /// Numbers for the report's `counters`.
    pub fn counters(&self) -> [(&'static str, f64); 3] {
        [
            ("triangles_drawn", self.triangles_drawn() as f64),
            ("clusters_drawn", self.clusters_drawn as f64),
            ("clusters_culled", self.clusters_culled as f64),
        ]
    }

    pub fn triangles_drawn(&self) -> u64 {
        self.calls().map(|call| u64::from(call.index_count / 3)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::clipped::Clipped;
    use super::super::geometry::Geometry;
    use super::*;
    use crate::scene::{Camera, Draw, Material, Mesh, Projection};
    use crate::units::Extent;
    use glam::{DVec2, DVec4, Mat4, Quat, Vec3};
    use proptest::prelude::*;

    /// A square from -1 to 1 that bulges by `height` towards +z, where its front is: four clusters.
    fn patch(height: f32, double_sided: bool) -> Scene {
        const SIDE: u32 = 16;
        let mut mesh = Mesh::default();
        for vertex in 0..(SIDE + 1) * (SIDE + 1) {
            let [x, y] = [vertex % (SIDE + 1), vertex / (SIDE + 1)].map(|at| 2.0 * at as f32 / SIDE as f32 - 1.0);
            mesh.positions.push(Vec3::new(x, y, height * (1.0 - x * x) * (1.0 - y * y)));
            mesh.normals.push(Vec3::Z);
        }
        for cell in 0..SIDE * SIDE {
            let first = cell / SIDE * (SIDE + 1) + cell % SIDE;
            let [a, b, c, d] = [first, first + 1, first + SIDE + 2, first + SIDE + 1];
            mesh.indices.extend([a, b, c, a, c, d]);
        }
        Scene {
            meshes: vec![mesh],
            materials: vec![Material { double_sided, ..Material::default() }],
            ..Scene::default()
        }
    }

    fn list(scene: &Scene, view: &View, choice: GeometryChoice, coverage: Coverage) -> DrawList {
        let geometry = Geometry::of(scene);
        let calls = geometry.calls(scene);
        let clustered = ClusteredCalls { calls: &calls, clusters: &geometry.clusters, indices: &geometry.indices };
        DrawList::of(scene, &clustered, view, Raster { extent: view.extent, coverage }, choice, Sweep::default())
    }

    fn view(eye: Vec3, at: Vec3, projection: Projection) -> View {
        let back = (eye - at).normalize();
        let right = Vec3::new(0.1, 1.0, 0.2).cross(back).normalize();
        let axes = [right, back.cross(right), back].map(|axis| axis.extend(0.0));
        let world_from_view = Mat4::from_cols(axes[0], axes[1], axes[2], eye.extend(1.0));
        let camera = Camera { name: String::new(), world_from_view, projection };
        View { extent: Extent::new(64, 48), camera, made_up: false }
    }

    fn projection(kind: u32) -> Projection {
        let z_far = [None, Some(6.0)][kind as usize % 2];
        match kind {
            0 | 1 => Projection::Perspective { y_fov: 0.8, aspect: None, z_near: 0.5, z_far },
            _ => Projection::Orthographic { x_mag: 1.0, y_mag: 0.75, z_near: 0.5, z_far: 6.0 },
        }
    }

    /// By brute force: the triangle, clipped, shows its front (or either side) over one of `places` in a pixel. Sides are told
    /// by where the eye is in object space, not by the picture.
    fn makes_a_fragment(view: &View, draw: &Draw, triangle: [Vec3; 3], double_sided: bool, places: &[DVec2]) -> bool {
        let object_from_world = draw.world_from_object.as_dmat4().inverse();
        let [a, b, c] = triangle.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a);
        let towards_eye = match view.camera.projection {
            Projection::Perspective { .. } => object_from_world.transform_point3(view.eye().as_dvec3()) - a,
            Projection::Orthographic { .. } => {
                object_from_world.transform_vector3(view.camera.world_from_view.z_axis.truncate().as_dvec3())
            }
        };
        if !double_sided && normal.dot(towards_eye) <= 0.0 {
            return false;
        }
        let clip = view.clip_from_world().as_dmat4() * draw.world_from_object.as_dmat4();
        let mut polygon: Vec<DVec4> = [a, b, c].map(|corner| clip * corner.extend(1.0)).to_vec();
        let inside = |at: DVec4, plane: usize| Clipped { at, error: DVec4::ZERO, reach: DVec2::ZERO }.inside()[plane];
        for plane in 0..6 {
            let corners = std::mem::take(&mut polygon);
            for (index, here) in corners.iter().enumerate() {
                let next = corners[(index + 1) % corners.len()];
                let (now, then) = (inside(*here, plane), inside(next, plane));
                if now >= 0.0 {
                    polygon.push(*here);
                }
                if (now >= 0.0) != (then >= 0.0) {
                    polygon.push(here.lerp(next, now / (now - then)));
                }
            }
        }
        let extent = DVec2::new(f64::from(view.extent.width), f64::from(view.extent.height));
        let corners: Vec<DVec2> =
            polygon.iter().map(|at| (DVec2::new(at.x, at.y) / at.w * 0.5 + 0.5) * extent).collect();
        let holds = |middle: DVec2| {
            let sides = (0..corners.len()).map(|index| {
                let (here, next) = (corners[index], corners[(index + 1) % corners.len()]);
                (next - here).perp_dot(middle - here)
            });
            let sides: Vec<f64> = sides.collect();
            sides.len() > 2 && (sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0))
        };
        (0..view.extent.width * view.extent.height).any(|pixel| {
            let [x, y] = [pixel % view.extent.width, pixel / view.extent.width].map(f64::from);
            places.iter().any(|place| holds(DVec2::new(x, y) + *place))
        })
    }

    /// Returns how many clusters were left out.
    fn require_nothing_lost(scene: &Scene, view: &View, coverage: Coverage) -> u64 {
        let places: Vec<DVec2> = match coverage {
            Coverage::Middle => vec![DVec2::splat(0.5)],
            // Vulkan's standard places of four samples.
            Coverage::Anywhere => {
                [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]].map(DVec2::from).into()
            }
        };
        let geometry = Geometry::of(scene);
        let list = list(scene, view, GeometryChoice::Culled, coverage);
        for call in geometry.calls(scene) {
            for cluster in &geometry.clusters[call.clusters()] {
                let drawn = list.calls().any(|part| {
                    let range = part.first_index..part.first_index + part.index_count;
                    part.draw == call.draw && range.contains(&cluster.first_index)
                });
                for corners in geometry.indices[cluster.indices()].chunks_exact(3).filter(|_| !drawn) {
                    let draw = &scene.draws[call.draw as usize];
                    let triangle = [0, 1, 2].map(|at| scene.meshes[draw.mesh].positions[corners[at] as usize]);
                    let made = makes_a_fragment(view, draw, triangle, call.sides == Sides::Both, &places);
                    assert!(!made, "{triangle:?} in {view:?}");
                }
            }
        }
        list.clusters_culled
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn what_is_left_out_makes_no_fragment(
            kind in 0u32..3,
            double_sided: bool,
            eye in [-4.0f32..4.0, -4.0..4.0, -4.0..4.0],
            at in [-2.0f32..2.0, -2.0..2.0, -2.0..2.0],
            scale in [-2.0f32..2.0, 0.1..2.0, 0.02..2.0],
            turn in [0.0f32..6.0, 0.0..6.0],
        ) {
            let mut scene = patch(0.3, double_sided);
            prop_assume!(scale[0].abs() > 0.01);
            let rotation = Quat::from_rotation_x(turn[0]) * Quat::from_rotation_y(turn[1]);
            for x in [-1.0, 0.0, 1.5] {
                let translation = Vec3::new(x, 0.2 * x, -x);
                let world_from_object = Mat4::from_scale_rotation_translation(scale.into(), rotation, translation);
                scene.draws.push(Draw { mesh: 0, world_from_object });
            }
            for coverage in [Coverage::Middle, Coverage::Anywhere] {
                require_nothing_lost(&scene, &view(eye.into(), at.into(), projection(kind)), coverage);
            }
        }
    }

    #[test]
    fn a_side_is_left_out_where_it_is_a_back_alone() {
        for kind in 0..3 {
            for (mirror, height, double_sided) in
                [(1.0, 0.1, false), (-1.0, 0.1, false), (1.0, 0.1, true), (-1.0, 0.0, true)]
            {
                let mut scene = patch(height, double_sided);
                let world_from_object = Mat4::from_scale(Vec3::new(0.4 * mirror, 0.4, 0.4));
                scene.draws.push(Draw { mesh: 0, world_from_object });
                let from = |z: f32| view(Vec3::new(0.1, 0.2, z), Vec3::ZERO, projection(kind));
                for coverage in [Coverage::Middle, Coverage::Anywhere] {
                    let left_out = |z: f32| require_nothing_lost(&scene, &from(z), coverage);
                    assert_eq!(left_out(3.0), 0, "its front");
                    assert_eq!(left_out(-3.0), if double_sided { 0 } else { 4 }, "its back");
                }
                // Behind the eye, beside the view, nearer than the near plane.
                for (eye, at) in [
                    (Vec3::new(0.0, 0.0, 3.0), Vec3::new(0.0, 0.0, 6.0)),
                    (Vec3::new(0.0, 0.0, 3.0), Vec3::new(5.0, 0.0, 0.0)),
                    (Vec3::new(0.0, 0.0, 0.3), Vec3::ZERO),
                ] {
                    let view = view(eye, at, projection(kind));
                    assert_eq!(require_nothing_lost(&scene, &view, Coverage::Middle), 4, "{eye} to {at}");
                }
            }
        }
    }

    /// Far planes: one cuts, an infinite one never does.
    #[test]
    fn what_lies_behind_the_far_plane_is_left_out() {
        let mut scene = patch(0.0, false);
        scene.draws.push(Draw { mesh: 0, world_from_object: Mat4::IDENTITY });
        let eye = Vec3::new(0.0, 0.0, 7.0);
        for (kind, culled) in [(0, 0), (1, 4), (2, 4)] {
            let view = view(eye, Vec3::ZERO, projection(kind));
            assert_eq!(require_nothing_lost(&scene, &view, Coverage::Middle), culled);
        }
    }

    #[test]
    fn nearer_clusters_come_first_and_both_choices_have_one_order() {
        for kind in 0..3 {
            let mut scene = patch(0.1, false);
            for z in [-1.0, 1.0, -9.0, 0.0] {
                let world_from_object = Mat4::from_translation(Vec3::new(0.0, 0.0, z));
                scene.draws.push(Draw { mesh: 0, world_from_object });
            }
            let view = view(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO, projection(kind));
            let [all, culled] = [GeometryChoice::All, GeometryChoice::Culled]
                .map(|choice| list(&scene, &view, choice, Coverage::Middle));
            assert_eq!(all.triangles_drawn(), 4 * 512);
            assert_eq!((all.clusters_drawn, all.clusters_culled), (16, 0));
            let draws = |list: &DrawList| {
                let mut draws: Vec<u32> = list.opaque.iter().map(|part| part.draw).collect();
                draws.dedup();
                draws
            };
            assert_eq!(draws(&all), [1, 3, 0, 2]);
            let far = if kind == 0 { &[1, 3, 0, 2][..] } else { &[1, 3, 0] };
            assert_eq!(draws(&culled), far, "the farthest is behind a far plane");
        }
    }
}

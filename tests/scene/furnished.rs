//! The furnished rooms `office`, `desk` and `shirley`: what lights them, that nothing leaks, and that no two faces
//! lie in one plane, where which of them is seen would be chance.

use glam::{DVec2, DVec3, Vec3};
use quincunx::bvh::Bvh;
use quincunx::frame::View;
use quincunx::lights::LightSet;
use quincunx::lights::area::area_lights;
use quincunx::scene::shell::Shell;
use quincunx::scene::{self, Scene};
use quincunx::settings::Values;
use quincunx::techniques;
use quincunx::units::Extent;
use std::collections::{BTreeMap, BTreeSet};

/// Each with others of its parameters, and how many area lights it has.
const ROOMS: [(&str, usize); 7] = [
    ("office", 2),
    ("office:desks=9,slats=12", 2),
    ("office:desks=1,slats=90", 2),
    ("desk", 1),
    ("desk:things=60", 1),
    ("shirley", 1),
    ("shirley:boxes=250", 1),
];

fn made(spec: &str) -> Scene {
    scene::load(spec, 1).unwrap()
}

#[test]
fn panels_alone_light_furnished_rooms_and_enough() {
    for (spec, count) in ROOMS {
        let scene = made(spec);
        assert_eq!(area_lights(&scene, 16).len(), count, "{spec}");
        let view = View::new(&scene, "0", Extent::new(16, 9)).unwrap();
        let technique = techniques::find("adaptive_interleaved").unwrap();
        let values = Values::defaults(&techniques::settings_of(technique));
        let lights = LightSet::new(&scene, &view, &values).unwrap();
        assert!(lights.is_emissive_alone && !lights.has_rig && !lights.has_punctual, "{spec}");
    }
}

/// All but what shines is closed, and reflects less than 0.85 of what falls on it, as no metal does.
#[test]
fn furniture_is_closed_and_matt() {
    for (spec, count) in ROOMS {
        let scene = made(spec);
        let open: BTreeSet<&str> =
            scene.meshes.iter().filter(|mesh| !Shell::of(mesh).is_closed()).map(|mesh| mesh.name.as_str()).collect();
        let shining: BTreeSet<&str> = scene
            .meshes
            .iter()
            .filter(|mesh| scene.materials[mesh.material].is_emissive())
            .map(|mesh| mesh.name.as_str())
            .collect();
        assert_eq!(open, shining, "{spec}");
        assert_eq!(shining.len(), count, "{spec}");
        for material in &scene.materials {
            let brightest = material.base_color_texture.map_or(255, |texture| {
                let image = &scene.images[scene.textures[texture].image];
                image.rgba8.chunks(4).flat_map(|texel| &texel[..3]).copied().max().unwrap()
            });
            let encoded = f64::from(brightest) / 255.0;
            // sRGB as its standard has it, above its straight part.
            let linear = ((encoded + 0.055) / 1.055).powf(2.4) as f32;
            let albedo = material.base_color.truncate().max_element() * linear;
            assert!(albedo < 0.85 && material.metallic == 0.0, "{spec}: {}: {albedo}", material.name);
        }
    }
}

/// From where each camera is, every ray ends at the front of something: the walls let none out, and nothing is inside
/// out.
#[test]
fn no_ray_leaves_a_furnished_room() {
    for (spec, _) in ROOMS {
        let scene = made(spec);
        let bvh = Bvh::build(&scene).unwrap();
        let walls = scene.bounds();
        for camera in &scene.cameras {
            let eye = camera.world_from_view.w_axis.truncate();
            assert!(eye.cmpgt(walls.min).all() && eye.cmplt(walls.max).all(), "{spec}: {}", camera.name);
            for index in 0..20_000 {
                let [u, v] = [0, 1].map(|dimension| sobol_burley::sample(index, dimension, 5));
                let (height, turn) = (2.0 * u - 1.0, std::f32::consts::TAU * v);
                let across = (1.0 - height * height).sqrt();
                let direction = Vec3::new(across * turn.cos(), height, across * turn.sin());
                let hit = bvh.closest_hit(eye, direction, f32::INFINITY, |_| true);
                let Some(hit) = hit else { panic!("{spec}: from {} along {direction} nothing is met", camera.name) };
                let mesh = &scene.meshes[scene.draws[bvh.sources[hit.triangle].draw as usize].mesh];
                assert!(!bvh.is_culled_back(&hit, direction), "{spec}: {} from {}", mesh.name, camera.name);
            }
        }
    }
}

#[test]
fn a_seed_furnishes_a_room_anew() {
    for spec in ["office", "desk", "shirley"] {
        let places = |seed: u64| {
            let scene = scene::load(spec, seed).unwrap();
            let meshes = scene.meshes.iter().map(|mesh| mesh.positions.clone()).collect::<Vec<_>>();
            (meshes, scene.draws.iter().map(|draw| draw.world_from_object).collect::<Vec<_>>())
        };
        assert_eq!(places(3), places(3), "{spec}");
        assert_ne!(places(3), places(4), "{spec}");
    }
}

/// A triangle, and the plane that it is in.
struct Flat {
    name: String,
    corners: [DVec3; 3],
    normal: DVec3,
    offset_m: f64,
}

impl Flat {
    /// How far two triangles of one plane reach into each other: the least over the directions across their edges.
    fn depth_m(&self, other: &Self) -> f64 {
        let right = self.normal.any_orthonormal_vector();
        let up = self.normal.cross(right);
        let [one, two] = [self, other].map(|flat| flat.corners.map(|at| DVec2::new(at.dot(right), at.dot(up))));
        let mut least = f64::INFINITY;
        for triangle in [one, two] {
            for side in 0..3 {
                let across = (triangle[(side + 1) % 3] - triangle[side]).perp().normalize();
                let range = |corners: [DVec2; 3]| {
                    let along = corners.map(|corner| corner.dot(across));
                    [along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(-f64::INFINITY, f64::max)]
                };
                let ([low, high], [from, to]) = (range(one), range(two));
                least = least.min(high.min(to) - low.max(from));
            }
        }
        least
    }
}

/// Faces that touch end at each other or reach into each other: where two lay in one plane, rounding would choose
/// between them, and between shadow and light.
#[test]
fn no_two_faces_of_a_furnished_room_lie_in_one_plane() {
    // Beyond what single precision makes of one plane in a room of ten metres.
    const SAME_M: f64 = 1e-5;
    let mut found = BTreeMap::new();
    for (spec, _) in ROOMS {
        let scene = made(spec);
        let mut planes: BTreeMap<[i64; 4], Vec<Flat>> = BTreeMap::new();
        for draw in &scene.draws {
            let mesh = &scene.meshes[draw.mesh];
            for triangle in 0..mesh.triangle_count() {
                let corners =
                    mesh.triangle(triangle).map(|corner| draw.world_from_object.transform_point3(corner).as_dvec3());
                let [a, b, c] = corners;
                let mut normal = (b - a).cross(c - a).normalize();
                // Both sides of a plane are one.
                let first = normal.to_array().into_iter().find(|part| part.abs() > 1e-3).unwrap();
                normal *= first.signum();
                let offset_m = normal.dot(a);
                let key = [normal.x * 50.0, normal.y * 50.0, normal.z * 50.0, offset_m * 500.0 + 0.25];
                let flat = Flat { name: mesh.name.clone(), corners, normal, offset_m };
                planes.entry(key.map(|part| part.round() as i64)).or_default().push(flat);
            }
        }
        for flats in planes.values() {
            for (index, one) in flats.iter().enumerate() {
                for other in &flats[..index] {
                    let is_one_plane =
                        other.corners.iter().all(|corner| (one.normal.dot(*corner) - one.offset_m).abs() < SAME_M);
                    if is_one_plane && one.depth_m(other) > 1e-4 {
                        found.entry((spec, other.name.clone(), one.name.clone())).or_insert(one.corners);
                    }
                }
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

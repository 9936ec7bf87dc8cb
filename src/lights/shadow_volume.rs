//! Stencil shadow volumes (Heidmann 1991; Kircher & Lawrance 2009, sections 4 and 7): the space that a closed surface
//! keeps a light from, as triangles that a depth-fail count can draw.
//!
//! The triangles that face the light are the front cap. The sides run from the silhouette, where such a triangle meets one
//! that faces away, to infinity; the back cap is the front cap seen there, turned around, so that the volume is closed
//! and the count stays right with the eye inside of it. With the light inside of the surface none faces it, and all
//! outside is in shadow: then the triangles that face away, turned around, are the front cap.
//!
//! What faces the light is decided once a triangle. However it is rounded, cap and silhouette agree, and the volume has
//! no gap.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Mat4, Vec3, Vec4};

use crate::scene::shell::Shell;
use crate::scene::{Bounds, LightSource};

/// A closed surface in homogeneous coordinates; triangles run counter-clockwise from outside.
#[derive(Debug)]
pub struct ShadowVolume {
    /// World space. w = 1: a point, in the order of `Shell::positions`; w = 0: the end of a ray away from the light, one
    /// for each of these, or for parallel light a single one for all.
    pub positions: Vec<Vec4>,
    /// Indices into `positions`: front cap, sides, back cap.
    pub triangles: Vec<[u32; 3]>,
    pub front_cap_count: usize,
    pub side_count: usize,
    /// 0 for parallel light: its sides end in one point.
    pub back_cap_count: usize,
}

impl ShadowVolume {
    /// The volume of a surface where it is drawn, mirrored or not. None where it is not closed.
    pub fn of(shell: &Shell, world_from_object: &Mat4, source: LightSource) -> Option<Self> {
        if !shell.is_closed() {
            return None;
        }
        let near: Vec<Vec3> =
            shell.positions.iter().map(|position| world_from_object.transform_point3(*position)).collect();
        let is_mirrored = world_from_object.determinant() < 0.0;
        // Counter-clockwise from outside in the world.
        let outward = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let is_inside = match source {
            LightSource::At(light) => is_inside(light, &near, shell.triangles.iter().map(|corners| outward(*corners))),
            LightSource::Along(_) => false,
        };
        let is_cap: Vec<bool> = shell
            .triangles
            .iter()
            .map(|corners| faces(outward(*corners).map(|place| near[place as usize].as_dvec3()), source) != is_inside)
            .collect();
        // Turned so that the light sees them counter-clockwise.
        let is_turned = is_mirrored != is_inside;
        let toward = |[a, b, c]: [u32; 3]| if is_turned { [a, c, b] } else { [a, b, c] };

        let place_count = near.len() as u32;
        let far = |place: u32| match source {
            LightSource::At(_) => place_count + place,
            LightSource::Along(_) => place_count,
        };
        let mut triangles: Vec<[u32; 3]> = (shell.triangles.iter().zip(&is_cap))
            .filter(|(_, is_cap)| **is_cap)
            .map(|(corners, _)| toward(*corners))
            .collect();
        let front_cap_count = triangles.len();
        for edge in &shell.edges {
            let [here, there] = edge.triangles.map(|triangle| is_cap[triangle as usize]);
            if here == there {
                continue;
            }
            // As the cap's triangle walks it.
            let [from, to] = edge.places;
            let [from, to] = if here == is_turned { [to, from] } else { [from, to] };
            triangles.push([to, from, far(from)]);
            if let LightSource::At(_) = source {
                triangles.push([to, far(from), far(to)]);
            }
        }
        let side_count = triangles.len() - front_cap_count;
        if let LightSource::At(_) = source {
            for triangle in 0..front_cap_count {
                let [a, b, c] = triangles[triangle];
                triangles.push([far(a), far(c), far(b)]);
            }
        }
        let back_cap_count = triangles.len() - front_cap_count - side_count;
        let mut positions: Vec<Vec4> = near.iter().map(|position| position.extend(1.0)).collect();
        match source {
            LightSource::At(light) => positions.extend(near.iter().map(|position| (*position - light).extend(0.0))),
            LightSource::Along(direction) => positions.push(direction.extend(0.0)),
        }
        Some(Self { positions, triangles, front_cap_count, side_count, back_cap_count })
    }
}

/// Whether the light sees a triangle's corners run counter-clockwise.
fn faces([a, b, c]: [DVec3; 3], source: LightSource) -> bool {
    let toward_light = match source {
        LightSource::At(light) => light.as_dvec3() - a,
        LightSource::Along(direction) => -direction.as_dvec3(),
    };
    (b - a).cross(c - a).dot(toward_light) > 0.0
}

/// Whether a closed surface winds around `point`.
fn is_inside(point: Vec3, positions: &[Vec3], triangles: impl Iterator<Item = [u32; 3]>) -> bool {
    let mut bounds = Bounds::EMPTY;
    positions.iter().for_each(|position| bounds.include(*position));
    if point.cmplt(bounds.min).any() || point.cmpgt(bounds.max).any() {
        return false;
    }
    let seen = |place: u32| (positions[place as usize] - point).as_dvec3();
    let turned: f64 = triangles.map(|corners| solid_angle(corners.map(seen))).sum();
    // Once around is the whole sphere, 4 pi.
    turned.abs() > TAU
}

/// The solid angle of a triangle as the origin sees it, -2 pi to 2 pi, positive where its corners run clockwise: from
/// inside of a surface. Only the directions of the corners count. Van Oosterom & Strackee 1983, equation 8.
fn solid_angle(corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners.map(DVec3::normalize_or_zero);
    let angle = 2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
    angle.clamp(-2.0 * PI, 2.0 * PI)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::bvh::Bvh;
    use crate::sampling::pcg::Pcg32;
    use crate::scene::{Draw, Material, Mesh, Scene, procedural};

    /// A closed mesh of the scene lamps, once, where `world_from_object` puts it.
    fn alone(shape: &str, world_from_object: Mat4) -> Scene {
        let made = procedural::build("lamps", 1).unwrap().unwrap();
        let mesh = made.meshes.into_iter().find(|mesh| mesh.name.starts_with(shape)).expect("the scene has one");
        let meshes = vec![Mesh { material: 0, ..mesh }];
        let draws = vec![Draw { mesh: 0, world_from_object }];
        Scene { meshes, draws, materials: vec![Material::default()], ..Scene::default() }
    }

    /// How often the volume's surface winds around a point: its corners at infinity are directions from anywhere.
    fn winding(volume: &ShadowVolume, point: Vec3) -> i64 {
        let seen = |index: u32| {
            let position = volume.positions[index as usize];
            position.truncate().as_dvec3() - point.as_dvec3() * f64::from(position.w)
        };
        let turned: f64 = volume.triangles.iter().map(|corners| solid_angle(corners.map(seen))).sum();
        let times = turned / (4.0 * PI);
        assert!((times - times.round()).abs() < 1e-3, "{point}: {times} times");
        times.round() as i64
    }

    /// Each edge is walked as often one way as the other; but where all sides meet at infinity, exactly once.
    fn require_closed(volume: &ShadowVolume) {
        let mut walked: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for [a, b, c] in &volume.triangles {
            for edge in [[*a, *b], [*b, *c], [*c, *a]] {
                *walked.entry(edge).or_default() += 1;
            }
        }
        let last = volume.positions.len() as u32 - 1;
        for ([from, to], times) in &walked {
            assert_eq!(walked.get(&[*to, *from]), Some(times), "the edge {from} to {to}");
            assert!(
                *times == 1 || volume.back_cap_count == 0 && [from, to].contains(&&last),
                "{from} to {to}: {times}"
            );
        }
        let parts = volume.front_cap_count + volume.side_count + volume.back_cap_count;
        assert_eq!(parts, volume.triangles.len());
    }

    fn volume(scene: &Scene, source: LightSource) -> ShadowVolume {
        let shell = Shell::of(&scene.meshes[0]);
        ShadowVolume::of(&shell, &scene.draws[0].world_from_object, source).expect("it is closed")
    }

    /// Points around the object: in the volume where the way to the light is barred, and nowhere else.
    fn require_shadow(name: &str, scene: &Scene, source: LightSource) {
        let volume = volume(scene, source);
        require_closed(&volume);
        let bvh = Bvh::build(scene).unwrap();
        let bounds = scene.bounds();
        let mut random = Pcg32::new(7, 3);
        let (mut dark, mut lit) = (0, 0);
        for _ in 0..400 {
            let mut number = || random.between(-1.5, 1.5);
            let point = bounds.center() + (bounds.max - bounds.min) * Vec3::new(number(), number(), number());
            let (way, limit) = match source {
                LightSource::At(light) => (light - point, 1.0),
                LightSource::Along(direction) => (-direction, f32::INFINITY),
            };
            let is_dark = bvh.occluded(point, way, limit);
            assert_eq!(winding(&volume, point) > 0, is_dark, "{name}, {source:?}: {point}");
            *(if is_dark { &mut dark } else { &mut lit }) += 1;
        }
        assert!(dark > 0 && lit > 0, "{name}, {source:?}: {dark} dark, {lit} lit");
    }

    #[test]
    fn what_a_volume_holds_is_what_no_ray_from_the_light_reaches() {
        let turned = Mat4::from_scale_rotation_translation(
            Vec3::new(1.3, 0.7, 1.0),
            glam::Quat::from_euler(glam::EulerRot::YXZ, 0.5, 0.9, -0.3),
            Vec3::new(0.4, -0.2, 1.7),
        );
        let mirrored = turned * Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        for shape in ["block", "ball", "ring"] {
            for (place, world_from_object) in [("turned", turned), ("mirrored", mirrored)] {
                let (name, scene) = (format!("{shape}, {place}"), alone(shape, world_from_object));
                let bounds = scene.bounds();
                let size = bounds.max - bounds.min;
                require_shadow(&name, &scene, LightSource::At(bounds.center() + size * Vec3::new(0.9, 1.1, 0.3)));
                // Between a block's corner and its box, or a ring's: still outside.
                require_shadow(&name, &scene, LightSource::At(bounds.min + size * 0.01));
                require_shadow(&name, &scene, LightSource::Along(Vec3::new(0.3, -1.0, 0.45)));
                // A point of the surface, moved a little inward.
                let mesh = &scene.meshes[0];
                let at = mesh.positions[mesh.indices[0] as usize] - 0.05 * mesh.normals[mesh.indices[0] as usize];
                let at = if shape == "ring" {
                    at
                } else {
                    mesh.positions.iter().sum::<Vec3>() / mesh.positions.len() as f32
                };
                require_shadow(&name, &scene, LightSource::At(world_from_object.transform_point3(at)));
            }
        }
    }

    #[test]
    fn a_block_in_front_of_a_lamp_has_the_triangles_that_one_counts() {
        let scene = alone("block", Mat4::IDENTITY);
        let counts = |source: LightSource| {
            let volume = volume(&scene, source);
            [volume.front_cap_count, volume.side_count, volume.back_cap_count, volume.positions.len()]
        };
        // One face of two triangles, four edges of two; three faces, six edges; parallel light has a triangle an edge.
        assert_eq!(counts(LightSource::At(Vec3::new(0.0, 9.0, 0.0))), [2, 8, 2, 16]);
        assert_eq!(counts(LightSource::At(Vec3::new(5.0, 9.0, 6.0))), [6, 12, 6, 16]);
        assert_eq!(counts(LightSource::Along(Vec3::NEG_Y)), [2, 4, 0, 9]);
        // All around the lamp: no silhouette.
        assert_eq!(counts(LightSource::At(Vec3::new(0.0, 0.3, 0.0))), [12, 0, 12, 16]);
    }

    #[test]
    fn open_surfaces_have_no_volume() {
        let sheet = alone("ground", Mat4::IDENTITY);
        assert!(ShadowVolume::of(&Shell::of(&sheet.meshes[0]), &Mat4::IDENTITY, LightSource::At(Vec3::Y)).is_none());
    }
}

//! Punctual and virtual point lights on the host: the twin of glsl/shading/light.glsl and light_start.glsl.

use crate::gpu::shader::shading::light::{
    LEAST_DISTANCE_SQUARED, LIGHT_DIRECTIONAL, LIGHT_PATCH, LIGHT_POINT, LIGHT_SPOT,
};
use crate::gpu::shader::structs::{LightBlock, VplBlock};
use crate::scene::{Light, LightKind};
use bytemuck::Zeroable;
use glam::{Vec3, Vec4};

/// A bit for each kind of light that is among `lights`: glsl/shading/light.glsl's LIGHT_KINDS.
pub fn kinds(lights: &[Light]) -> u32 {
    lights.iter().fold(0, |bits, light| bits | 1 << number(light.kind))
}

/// A kind of light as shaders know it.
fn number(kind: LightKind) -> u32 {
    match kind {
        LightKind::Directional => LIGHT_DIRECTIONAL,
        LightKind::Point => LIGHT_POINT,
        LightKind::Spot { .. } => LIGHT_SPOT,
    }
}

/// A light as shaders read it. `cutoff_lux`: a light without range ends where it gives this irradiance; 0: never.
pub fn block(light: &Light, cutoff_lux: f32) -> LightBlock {
    let range = match light.range {
        _ if light.kind.is_directional() => 0.0,
        Some(range) => range,
        None if cutoff_lux > 0.0 => (light.intensity.max_element() / cutoff_lux).sqrt(),
        None => 0.0,
    };
    let mut block = LightBlock {
        position_ws: light.position.extend(if range > 0.0 { 1.0 / (range * range) } else { 0.0 }).to_array(),
        intensity: light.intensity.extend(range).to_array(),
        direction_ws: light.direction.extend(light.radius).to_array(),
        kind: number(light.kind),
        ..LightBlock::zeroed()
    };
    match light.kind {
        LightKind::Directional | LightKind::Point => {}
        LightKind::Spot { inner_angle, outer_angle } => {
            // KHR_lights_punctual's own suggestion for the cone's edge.
            block.spot_scale = 1.0 / (inner_angle.cos() - outer_angle.cos()).max(1e-3);
            block.spot_offset = -outer_angle.cos() * block.spot_scale;
        }
    }
    block
}

/// Direction to the light, its distance, and the irradiance that it gives a surface that faces it.
pub fn incident_from(light: &LightBlock, position_ws: Vec3) -> (Vec3, f32, Vec3) {
    if light.kind == LIGHT_DIRECTIONAL {
        let three = |v: [f32; 4]| Vec4::from_array(v).truncate();
        return (-three(light.direction_ws), 1e30, three(light.intensity));
    }
    let to_light = Vec4::from_array(light.position_ws).truncate() - position_ws;
    let distance = to_light.length_squared().sqrt();
    let towards = to_light / distance.max(1e-12);
    (towards, distance, irradiance_along(light, to_light.length_squared(), towards))
}

/// Irradiance of what faces a point or spot light, at the square of a distance, where its light comes along -`towards`.
fn irradiance_along(light: &LightBlock, distance_squared: f32, towards: Vec3) -> Vec3 {
    let intensity = Vec4::from_array(light.intensity).truncate();
    let direction = Vec4::from_array(light.direction_ws).truncate();
    let fraction_squared = distance_squared * light.position_ws[3];
    let window = (1.0 - fraction_squared * fraction_squared).clamp(0.0, 1.0);
    let mut attenuation = window / distance_squared.max(LEAST_DISTANCE_SQUARED);
    if light.kind == LIGHT_SPOT {
        let cone = (direction.dot(-towards) * light.spot_scale + light.spot_offset).clamp(0.0, 1.0);
        attenuation *= cone * cone;
    }
    if light.kind == LIGHT_PATCH {
        let cosine = -direction.dot(towards);
        attenuation *= if light.direction_ws[3] != 0.0 { cosine.abs() } else { cosine.max(0.0) };
    }
    intensity * attenuation
}

/// The same from a point of the light's sphere, drawn evenly over the part that is seen: the mean over `numbers`, 0 to 1,
/// is what all of the sphere gives. As `incident_from` where the light is a point or directional; dark inside the sphere.
pub fn incident_from_sphere(light: &LightBlock, position_ws: Vec3, [u, v]: [f32; 2]) -> (Vec3, f32, Vec3) {
    let radius = light.direction_ws[3];
    let (to_center, center_distance, irradiance) = incident_from(light, position_ws);
    if light.kind == LIGHT_DIRECTIONAL || radius <= 0.0 {
        return (to_center, center_distance, irradiance);
    }
    if center_distance <= radius {
        return (to_center, center_distance, Vec3::ZERO);
    }
    let sine_squared = (radius / center_distance).powi(2);
    let least_cosine = (1.0 - sine_squared).max(0.0).sqrt();
    // 1 - cosine, without the difference of two numbers next to each other.
    let fallen = u * sine_squared / (1.0 + least_cosine);
    let (cosine, sine) = (1.0 - fallen, (fallen * (2.0 - fallen)).max(0.0).sqrt());
    let (x, y) = to_center.any_orthonormal_pair();
    let angle = std::f32::consts::TAU * v;
    let towards = x * (sine * angle.cos()) + y * (sine * angle.sin()) + to_center * cosine;
    let beside_squared = center_distance * center_distance * sine * sine;
    let distance = center_distance * cosine - (radius * radius - beside_squared).max(0.0).sqrt();
    // Radiance is intensity over the sphere's disc, and the sphere covers 2 pi (1 - least_cosine).
    let seen = 2.0 / (1.0 + least_cosine);
    (towards, distance, irradiance_along(light, center_distance * center_distance, towards) * seen)
}

/// Irradiance that a virtual point light gives a surface; `least_squared`: the square of the least distance
/// (--vpl-clamp), in square metres.
pub fn vpl_irradiance(vpl: &VplBlock, position_ws: Vec3, normal_ws: Vec3, least_squared: f32) -> Vec3 {
    let three = |v: [f32; 4]| Vec4::from_array(v).truncate();
    let to_vpl = three(vpl.position_ws) - position_ws;
    let distance_squared = to_vpl.length_squared();
    let facing = normal_ws.dot(to_vpl).max(0.0) * (-three(vpl.normal_ws).dot(to_vpl)).max(0.0);
    three(vpl.intensity) * (facing / (distance_squared.max(1e-12) * distance_squared.max(least_squared)))
}

/// Flux in lumens (per channel); a directional light's is what falls through a disc of `radius` metres.
pub fn flux(light: &Light, radius: f32) -> Vec3 {
    use std::f32::consts::PI;
    match light.kind {
        LightKind::Directional => light.intensity * (PI * radius * radius),
        LightKind::Point => light.intensity * (4.0 * PI),
        LightKind::Spot { outer_angle, .. } => light.intensity * (2.0 * PI * (1.0 - outer_angle.cos())),
    }
}

/// Where a walk of light starts, world space.
#[derive(Clone, Copy, Debug)]
pub struct LightStart {
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// Lumens (per channel) that the whole walk carries.
    pub flux: Vec3,
}

impl LightStart {
    /// A start on a punctual light. `numbers`: 0 to 1. A directional light starts on a disc before the sphere of `radius`
    /// metres around `center`, so that whatever stands in its way stops it.
    pub fn of(light: &Light, [u, v]: [f32; 2], center: Vec3, radius: f32) -> Self {
        use std::f32::consts::{PI, TAU};
        match light.kind {
            LightKind::Directional => {
                let (x, y) = light.direction.any_orthonormal_pair();
                let (r, angle) = (radius * u.sqrt(), TAU * v);
                let on_disc = x * (r * angle.cos()) + y * (r * angle.sin());
                let origin = center + on_disc - light.direction * (1.01 * radius);
                Self { origin, direction: light.direction, flux: flux(light, radius) }
            }
            LightKind::Point => {
                let z = 1.0 - 2.0 * u;
                let r = (1.0 - z * z).max(0.0).sqrt();
                let direction = Vec3::new(r * (TAU * v).cos(), r * (TAU * v).sin(), z);
                Self { origin: light.position, direction, flux: light.intensity * (4.0 * PI) }
            }
            LightKind::Spot { inner_angle, outer_angle } => {
                // Uniform in the outer cone; the cone's edge dims the flux.
                let z = 1.0 - u * (1.0 - outer_angle.cos());
                let r = (1.0 - z * z).max(0.0).sqrt();
                let (x, y) = light.direction.any_orthonormal_pair();
                let direction = x * (r * (TAU * v).cos()) + y * (r * (TAU * v).sin()) + light.direction * z;
                let edge = (inner_angle.cos() - outer_angle.cos()).max(1e-3);
                let cone = ((z - outer_angle.cos()) / edge).clamp(0.0, 1.0);
                let flux = light.intensity * (TAU * (1.0 - outer_angle.cos()) * cone * cone);
                Self { origin: light.position, direction, flux }
            }
        }
    }

    /// The same start on the sphere of `light`, evenly over the disc that is seen from where it goes: a point's is its
    /// middle. `numbers`: 0 to 1.
    pub fn on_sphere(self, light: &Light, [u, v]: [f32; 2]) -> Self {
        if light.kind.is_directional() {
            return self;
        }
        let (x, y) = self.direction.any_orthonormal_pair();
        let (r, angle) = (u.sqrt(), std::f32::consts::TAU * v);
        let out = x * (r * angle.cos()) + y * (r * angle.sin()) + self.direction * (1.0 - u).max(0.0).sqrt();
        Self { origin: self.origin + light.radius * out, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(kind: LightKind) -> Light {
        Light {
            name: String::new(),
            kind,
            intensity: Vec3::splat(8.0),
            position: Vec3::new(0.0, 2.0, 0.0),
            direction: -Vec3::Y,
            range: None,
            radius: 0.0,
        }
    }

    /// What a patch gives is what a virtual light does, which is a patch too; its back is dark but where both sides shine.
    #[test]
    fn a_patch_shines_by_its_cosine_on_the_sides_that_it_has() {
        let patch = LightBlock { kind: LIGHT_PATCH, ..block(&light(LightKind::Point), 0.0) };
        let vpl =
            VplBlock { position_ws: patch.position_ws, normal_ws: patch.direction_ws, intensity: patch.intensity };
        for at in [Vec3::ZERO, Vec3::new(1.0, 0.5, -0.5)] {
            let (towards, _, irradiance) = incident_from(&patch, at);
            let expected = vpl_irradiance(&vpl, at, towards, 0.0);
            assert!(expected.x > 0.0 && irradiance.distance(expected) < 1e-6 * expected.length(), "{irradiance}");
        }
        let (_, _, behind) = incident_from(&patch, Vec3::new(0.0, 4.0, 0.0));
        let both = LightBlock { direction_ws: [0.0, -1.0, 0.0, 1.0], ..patch };
        assert_eq!((behind, incident_from(&both, Vec3::new(0.0, 4.0, 0.0)).2), (Vec3::ZERO, Vec3::splat(2.0)));
    }

    #[test]
    fn a_point_light_falls_off_by_the_square_and_ends_exactly_at_its_range() {
        let block = block(&light(LightKind::Point), 0.0);
        let (direction, distance, irradiance) = incident_from(&block, Vec3::ZERO);
        assert_eq!((direction, distance, irradiance), (Vec3::Y, 2.0, Vec3::splat(2.0)));
        let ending = super::block(&Light { range: Some(3.0), ..light(LightKind::Point) }, 0.0);
        let window = 1.0 - (2.0f32 / 3.0).powi(4);
        let (_, _, irradiance) = incident_from(&ending, Vec3::ZERO);
        assert!((irradiance.x - 2.0 * window).abs() < 1e-5);
        assert_eq!(incident_from(&ending, Vec3::new(0.0, -1.0, 0.0)).2, Vec3::ZERO);
        assert_eq!(incident_from(&ending, Vec3::new(0.0, -9.0, 0.0)).2, Vec3::ZERO);
    }

    #[test]
    fn a_light_without_range_gets_the_cutoffs() {
        let block = block(&light(LightKind::Point), 0.002);
        assert!((block.intensity[3] - (8.0f32 / 0.002).sqrt()).abs() < 1e-3);
    }

    #[test]
    fn a_spot_is_full_inside_its_inner_cone_and_dark_outside_its_outer_cone() {
        let spot = block(&light(LightKind::Spot { inner_angle: 0.3, outer_angle: 0.6 }), 0.0);
        assert_eq!(incident_from(&spot, Vec3::ZERO).2, Vec3::splat(2.0));
        let at =
            |angle: f32| incident_from(&spot, Vec3::new(2.0 * angle.tan(), 0.0, 0.0)).2.x * (2.0 / angle.cos()).powi(2);
        assert!((at(0.29) - 8.0).abs() < 1e-3);
        assert!(at(0.61).abs() < 1e-6);
        let half = ((0.45f32.cos() - 0.6f32.cos()) / (0.3f32.cos() - 0.6f32.cos())).powi(2);
        assert!((at(0.45) - 8.0 * half).abs() < 1e-3);
    }

    /// Irradiance of a surface that faces a sphere's middle is that of a point of the same intensity, however near it is.
    #[test]
    fn a_sphere_gives_a_surface_that_faces_it_what_its_point_does() {
        let block = block(&Light { radius: 0.9, ..light(LightKind::Point) }, 0.0);
        for distance in [0.95f32, 2.0, 30.0] {
            let position = Vec3::new(0.0, 2.0 - distance, 0.0);
            let steps = 64;
            let mut mean = 0.0;
            for step in 0..steps * steps {
                let numbers = [step % steps, step / steps].map(|step| (step as f32 + 0.5) / steps as f32);
                let (towards, length, irradiance) = incident_from_sphere(&block, position, numbers);
                let met = position + towards * length - Vec3::new(0.0, 2.0, 0.0);
                assert!((met.length() - 0.9).abs() < 1e-4 * distance.max(1.0), "{distance}: {met}");
                mean += irradiance.x * towards.y / (steps * steps) as f32;
            }
            let expected = 8.0 / (distance * distance);
            assert!((mean / expected - 1.0).abs() < 2e-3, "{distance}: {mean} and {expected}");
        }
        assert_eq!(incident_from_sphere(&block, Vec3::new(0.0, 2.5, 0.0), [0.5; 2]).2, Vec3::ZERO, "inside");
        let point = super::block(&light(LightKind::Point), 0.0);
        assert_eq!(incident_from_sphere(&point, Vec3::X, [0.3; 2]), incident_from(&point, Vec3::X));
    }

    /// Starts lie on the side of a sphere that they leave, and over all of its disc.
    #[test]
    fn a_start_on_a_sphere_leaves_it() {
        let light = Light { radius: 0.5, ..light(LightKind::Point) };
        let mut mean_squared = 0.0;
        for step in 0..256 {
            let number = |scale: u32| ((step * scale) % 256) as f32 / 256.0;
            let start = LightStart::of(&light, [number(1), number(3)], Vec3::ZERO, 1.0);
            let LightStart { origin, direction, .. } = start.on_sphere(&light, [number(5), number(7)]);
            let out = origin - light.position;
            assert!((out.length() - 0.5).abs() < 1e-5 && out.dot(direction) >= 0.0, "{out} {direction}");
            mean_squared += (out - direction * out.dot(direction)).length_squared() / 256.0;
        }
        // Evenly over a disc: half of its squared radius.
        assert!((mean_squared / 0.125 - 1.0).abs() < 0.02, "{mean_squared}");
    }

    /// What starts carry is what light gives: a metre from a light with a place its flux over the solid angle, in lux; from
    /// a directional one its flux over the disc.
    #[test]
    fn a_start_carries_what_the_light_gives_where_it_goes() {
        use std::f32::consts::PI;
        let (inner_angle, outer_angle) = (0.3, 0.6);
        let (center, radius) = (Vec3::new(1.0, -2.0, 0.5), 3.0);
        let kinds = [
            (LightKind::Directional, PI * radius * radius),
            (LightKind::Point, 4.0 * PI),
            (LightKind::Spot { inner_angle, outer_angle }, 2.0 * PI * (1.0 - outer_angle.cos())),
        ];
        for (kind, spread) in kinds {
            let light = Light { direction: Vec3::new(2.0, -3.0, 6.0) / 7.0, ..light(kind) };
            let block = block(&light, 0.0);
            for step in 0..64 {
                let numbers = [step % 8, step / 8].map(|step| (step as f32 + 0.5) / 8.0);
                let LightStart { origin, direction, flux } = LightStart::of(&light, numbers, center, radius);
                assert!((direction.length() - 1.0).abs() < 1e-5, "{kind:?}: {direction}");
                let (towards, _, irradiance) = incident_from(&block, origin + direction);
                assert!((towards + direction).length() < 1e-5, "{kind:?}: {towards} and {direction}");
                assert!((flux / spread - irradiance).abs().max_element() < 1e-3, "{kind:?}: {flux} and {irradiance}");
                if kind.is_directional() {
                    let beside = origin - center - direction * (origin - center).dot(direction);
                    assert!((origin - center).dot(direction) < -radius && beside.length() <= radius, "{origin}");
                }
            }
        }
    }

    #[test]
    fn a_virtual_point_light_shines_like_a_small_lambert_patch() {
        let vpl = VplBlock { position_ws: [0.0, 2.0, 0.0, 0.0], normal_ws: [0.0, -1.0, 0.0, 0.0], intensity: [4.0; 4] };
        assert!((vpl_irradiance(&vpl, Vec3::ZERO, Vec3::Y, 0.01).x - 1.0).abs() < 1e-6);
        // At 45 degrees: both cosines are 1/sqrt 2, the distance squared is 8.
        assert!((vpl_irradiance(&vpl, Vec3::new(2.0, 0.0, 0.0), Vec3::Y, 0.01).x - 4.0 * 0.5 / 8.0).abs() < 1e-6);
        assert_eq!(vpl_irradiance(&vpl, Vec3::new(0.0, 3.0, 0.0), -Vec3::Y, 0.01), Vec3::ZERO);
        // Nearer than the clamp it grows no more.
        assert!((vpl_irradiance(&vpl, Vec3::new(0.0, 1.9, 0.0), Vec3::Y, 1.0).x - 4.0).abs() < 1e-5);
    }
}

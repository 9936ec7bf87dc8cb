//! Pictures that a formula knows: what is held against something that is not this program's shaders.

use crate::picture::Picture;
use crate::scene::{Camera, Draw, Light, LightKind, Material, Mesh, Projection, Scene};
use crate::units::Extent;
use glam::{Mat4, Vec2, Vec3, Vec4, vec3};
use std::f32::consts::PI;

/// A scene with one surface at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosedForm {
    /// No surface in sight: the background, `BACKGROUND`, and nothing else.
    Empty,
    /// A matt square that fills the picture, under parallel light at a slant.
    Sun,
    /// The same under a point light: the inverse square of its distance, its slant, and the window of its range.
    Lamp,
}

/// The setting that `ClosedForm::Empty` is drawn with.
pub const BACKGROUND: (&str, &str) = ("background", "0.25,0.5,0.75");
const BACKGROUND_RADIANCE: [f32; 3] = [0.25, 0.5, 0.75];
const ALBEDO: Vec3 = vec3(0.8, 0.5, 0.3);
/// Where parallel light goes.
const SUN: Vec3 = vec3(-0.3, -0.4, -1.0);
const SUN_LUX: Vec3 = vec3(2.0, 3.0, 4.0);
/// Metres from the middle of the square, of which 2 m are seen from top to bottom.
const LAMP: Vec3 = vec3(0.3, -0.2, 1.0);
const LAMP_CANDELA: Vec3 = vec3(3.0, 2.0, 4.0);
const LAMP_RANGE_M: f32 = 3.0;

impl ClosedForm {
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Sun => "sun",
            Self::Lamp => "lamp",
        }
    }

    /// What is drawn.
    pub fn scene(self) -> Scene {
        // Behind the camera, where nothing is to be in sight.
        let z_m = if self == Self::Empty { 5.0 } else { 0.0 };
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let mesh = Mesh {
            positions: corners.map(|(x, y)| vec3(2.0 * x, 2.0 * y, z_m)).to_vec(),
            normals: vec![Vec3::Z; 4],
            tangents: vec![Vec4::ZERO; 4],
            uvs: corners.map(|(x, y)| Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y)).to_vec(),
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Mesh::default()
        };
        let name = self.name().to_owned();
        let projection = Projection::Orthographic { x_mag: 1.0, y_mag: 1.0, z_near: 0.1, z_far: 9.0 };
        let world_from_view = Mat4::from_translation(2.0 * Vec3::Z);
        Scene {
            hash: name.clone(),
            name,
            meshes: vec![mesh],
            draws: vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }],
            materials: vec![Material::diffuse("matt", ALBEDO)],
            lights: vec![self.light()],
            cameras: vec![Camera { name: String::new(), world_from_view, projection }],
            ..Scene::default()
        }
    }

    fn light(self) -> Light {
        let light = Light {
            name: String::new(),
            kind: LightKind::Directional,
            intensity: SUN_LUX,
            position: Vec3::ZERO,
            direction: SUN.normalize(),
            range: None,
            radius: 0.0,
        };
        match self {
            Self::Empty | Self::Sun => light,
            Self::Lamp => Light {
                kind: LightKind::Point,
                intensity: LAMP_CANDELA,
                position: LAMP,
                range: Some(LAMP_RANGE_M),
                radius: 0.0,
                ..light
            },
        }
    }

    /// The picture: Lambert's law at the middle of each pixel.
    pub fn picture(self, extent: Extent) -> Picture {
        let pixels = (0..extent.height).flat_map(|y| (0..extent.width).map(move |x| [x, y]));
        let radiance = |at: [u32; 2]| match self {
            Self::Empty => BACKGROUND_RADIANCE,
            Self::Sun => (ALBEDO / PI * SUN_LUX * -SUN.normalize().z).to_array(),
            Self::Lamp => (ALBEDO / PI * lamp_irradiance(point_at(at, extent))).to_array(),
        };
        Picture { extent, pixels: pixels.map(radiance).collect() }
    }
}

/// What the camera sees in the middle of a pixel, metres: the picture is 2 m high, and as wide as its shape says.
fn point_at([x, y]: [u32; 2], extent: Extent) -> Vec3 {
    let Extent { width, height } = extent;
    let from_middle = |at: u32, all: u32| (2.0 * at as f32 + 1.0 - all as f32) / height as f32;
    vec3(from_middle(x, width), -from_middle(y, height), 0.0)
}

/// KHR_lights_punctual: the inverse square, and a window that ends it at the range; on a surface that faces +z.
fn lamp_irradiance(point_m: Vec3) -> Vec3 {
    let to_light = LAMP - point_m;
    let distance = to_light.length();
    let window = (1.0 - (distance / LAMP_RANGE_M).powi(4)).clamp(0.0, 1.0);
    LAMP_CANDELA * (to_light.z / distance) * window / (distance * distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers worked out by hand: straight below the lamp, 1 m away, and under the sun everywhere.
    #[test]
    fn formulas_say_what_is_known_by_hand() {
        let window = 1.0 - (1.0f32 / 3.0).powi(4);
        let below = lamp_irradiance(vec3(0.3, -0.2, 0.0));
        assert!((below - LAMP_CANDELA * window).abs().max_element() < 1e-6, "{below}");
        // A point 3-4-5 away from it is beyond a range of 3 m.
        assert_eq!(lamp_irradiance(vec3(3.3, 3.8, 0.0)), Vec3::ZERO);
        let extent = Extent::new(4, 2);
        assert_eq!(point_at([0, 0], extent), vec3(-1.5, 0.5, 0.0));
        assert_eq!(point_at([3, 1], extent), vec3(1.5, -0.5, 0.0));
        // The slant's cosine is 1 / sqrt(1.25).
        let expected = 0.8 / PI * 2.0 / 1.25f32.sqrt();
        assert!(ClosedForm::Sun.picture(extent).pixels.iter().all(|pixel| (pixel[0] - expected).abs() < 1e-6));
        assert_eq!(ClosedForm::Empty.picture(extent).pixels, [BACKGROUND_RADIANCE; 8]);
    }
}

//! Punctual lights in glTF's units (KHR_lights_punctual).

use glam::Vec3;

/// Where a punctual light shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Parallel light along `Light::direction`; intensity in lux.
    Directional,
    /// All round; intensity in candela.
    Point,
    /// A cone around `Light::direction`; intensity in candela. Half angles in radians, 0 <= inner < outer <= pi/2.
    Spot { inner_angle: f32, outer_angle: f32 },
}

/// One punctual light in world space.
#[derive(Clone, Debug)]
pub struct Light {
    pub name: String,
    pub kind: LightKind,
    /// Linear RGB colour times intensity: lux (directional) or candela (point, spot), each at least 0.
    pub intensity: Vec3,
    /// Metres; unused by directional lights.
    pub position: Vec3,
    /// Unit vector in which the light travels; unused by point lights.
    pub direction: Vec3,
    /// Distance in metres at which the light ends (glTF's window); None: no end of its own.
    pub range: Option<f32>,
}

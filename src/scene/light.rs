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

impl LightKind {
    /// The names of all kinds, as KHR_lights_punctual has them.
    pub const NAMES: [&'static str; 3] = ["directional", "point", "spot"];

    /// One of `NAMES`.
    pub const fn name(self) -> &'static str {
        let [directional, point, spot] = Self::NAMES;
        match self {
            Self::Directional => directional,
            Self::Point => point,
            Self::Spot { .. } => spot,
        }
    }

    /// Whether it shines along one direction, from nowhere.
    pub const fn is_directional(self) -> bool {
        match self {
            Self::Directional => true,
            Self::Point | Self::Spot { .. } => false,
        }
    }

    /// Whether turning it changes what it lights.
    pub const fn has_direction(self) -> bool {
        match self {
            Self::Directional | Self::Spot { .. } => true,
            Self::Point => false,
        }
    }

    /// Half angle of the cone around `Light::direction` beyond which a light with a place is dark, radians. None: it shines
    /// all round.
    pub const fn half_angle(self) -> Option<f32> {
        match self {
            Self::Spot { outer_angle, .. } => Some(outer_angle),
            Self::Directional | Self::Point => None,
        }
    }
}

/// Where light comes from, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// A point, metres.
    At(Vec3),
    /// Parallel light that travels so; not zero.
    Along(Vec3),
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
    /// Metres: of the sphere around `position` whose surface shines, alike all over; 0: the light is a point. Unused by
    /// directional lights.
    pub radius: f32,
}

impl Light {
    /// Where its light comes from; that of a spot from its tip.
    pub const fn source(&self) -> LightSource {
        if self.kind.is_directional() { LightSource::Along(self.direction) } else { LightSource::At(self.position) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_says_where_it_shines_from() {
        let (position, direction) = (Vec3::X, Vec3::NEG_Y);
        let source = |kind: LightKind| {
            Light { name: String::new(), kind, intensity: Vec3::ONE, position, direction, range: None, radius: 0.0 }
                .source()
        };
        assert_eq!(source(LightKind::Point), LightSource::At(position));
        assert_eq!(source(LightKind::Spot { inner_angle: 0.1, outer_angle: 0.2 }), LightSource::At(position));
        assert_eq!(source(LightKind::Directional), LightSource::Along(direction));
    }
}

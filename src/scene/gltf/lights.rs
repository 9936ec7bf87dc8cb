//! KHR_lights_punctual: point, spot and directional lights at their nodes.

use std::f32::consts::FRAC_PI_2;

use glam::Vec3;
use gltf::Document;
use gltf::khr_lights_punctual::Kind;

use super::label;
use super::nodes::PlacedNode;
use crate::error::{Error, Result};
use crate::scene::{Light, LightKind};

/// Greatest candela or lux: what it gives at the least distance, and over many lights, is still within 32-bit floats.
pub const MAX_INTENSITY: f32 = 1e18;

/// By how much an outer cone angle may exceed pi/2: what a file with few digits rounds up.
const ANGLE_TOLERANCE: f32 = 1e-4;

/// The lights at `placed` nodes, in their order. One whose node has no direction is left out with a warning.
pub fn read(document: &Document, placed: &[PlacedNode], warnings: &mut Vec<String>) -> Result<Vec<Light>> {
    let mut lights = Vec::new();
    for placed in placed {
        let Some(node) = document.nodes().nth(placed.node_index) else { continue };
        let Some(light) = node.light() else { continue };
        let label = label::element("light", light.index(), light.name());
        let read = read_light(&light, node.name(), placed).map_err(|error| error.within(&label))?;
        match read {
            Some(light) => lights.push(light),
            None => {
                warnings.push(format!("{label} at {} has no direction; left out", label::node(document, node.index())))
            }
        }
    }
    Ok(lights)
}

fn read_light(
    light: &gltf::khr_lights_punctual::Light<'_>,
    node_name: Option<&str>,
    placed: &PlacedNode,
) -> Result<Option<Light>> {
    let intensity = Vec3::from_array(light.color()) * light.intensity();
    if !(intensity.is_finite() && intensity.min_element() >= 0.0 && intensity.max_element() <= MAX_INTENSITY) {
        return Err(Error::request(format!(
            "colour times intensity is {intensity}; each must be 0 to {MAX_INTENSITY:e}"
        )));
    }
    if let Some(range) = light.range().filter(|range| !(range.is_finite() && *range > 0.0)) {
        return Err(Error::request(format!("its range is {range} m; give a positive one, or none for no end")));
    }
    let kind = match light.kind() {
        Kind::Directional => LightKind::Directional,
        Kind::Point => LightKind::Point,
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let ordered = 0.0 <= inner_cone_angle && inner_cone_angle < outer_cone_angle;
            if !ordered || outer_cone_angle > FRAC_PI_2 + ANGLE_TOLERANCE {
                return Err(Error::request(format!(
                    "its cone angles are {inner_cone_angle} and {outer_cone_angle} rad; \
                     needed is 0 <= inner < outer <= pi/2"
                )));
            }
            let outer_angle = outer_cone_angle.min(FRAC_PI_2);
            LightKind::Spot { inner_angle: inner_cone_angle.min(outer_angle.next_down()), outer_angle }
        }
    };
    // The extension: a light shines along its node's -z.
    let back = placed.world_from_node.z_axis.truncate();
    let direction = if kind.has_direction() { (-back).try_normalize() } else { Some(Vec3::NEG_Z) };
    let Some(direction) = direction else { return Ok(None) };
    Ok(Some(Light {
        name: light.name().or(node_name).map_or_else(|| format!("light {}", light.index()), str::to_owned),
        kind,
        intensity,
        position: placed.world_from_node.w_axis.truncate(),
        direction,
        range: light.range().filter(|_| !kind.is_directional()),
        radius: 0.0,
    }))
}

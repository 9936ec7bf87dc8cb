//! What a punctual light can reach, on the screen: the rectangle of its sphere. Kircher 2009, section 2.2.

use crate::frame::View;
use crate::gpu::shader::structs::LightBlock;
use crate::scene::Projection;
use crate::units::Extent;
use glam::{Vec3, Vec4};

/// Texels of a rectangle: its corner and its extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle {
    pub corner_px: [u32; 2],
    pub extent: Extent,
}

/// Texels by which a rectangle is larger than arithmetic says: what rounding may do to an edge.
const MARGIN_PX: f64 = 1.0;

/// The rectangle of `raster` that bounds what `light` reaches, as `view` sees it; None where that is nothing. A light without
/// end reaches everything.
pub fn rectangle(light: &LightBlock, view: &View, raster: Extent) -> Option<Rectangle> {
    let whole = Rectangle { corner_px: [0, 0], extent: raster };
    let range = f64::from(light.intensity[3]);
    if range == 0.0 {
        return Some(whole);
    }
    let center_ws: Vec3 = Vec4::from_array(light.position_ws).truncate();
    let center = view.camera.world_from_view.inverse().as_dmat4().transform_point3(center_ws.as_dvec3());
    let aspect = f64::from(view.extent.width) / f64::from(view.extent.height);
    let [x, y] = match view.camera.projection {
        Projection::Perspective { y_fov, z_near, .. } => {
            // Behind the eye altogether.
            if -center.z + range < f64::from(z_near) {
                return None;
            }
            let scale = 1.0 / (0.5 * f64::from(y_fov)).tan();
            [tangents(center.x, -center.z, range, scale / aspect), tangents(center.y, -center.z, range, scale)]
        }
        Projection::Orthographic { y_mag, .. } => {
            let (y_mag, x_mag) = (f64::from(y_mag), f64::from(y_mag) * aspect);
            let span = |middle: f64, mag: f64| Some([(middle - range) / mag, (middle + range) / mag]);
            [span(center.x, x_mag), span(center.y, y_mag)]
        }
    };
    // y points down on the screen.
    let y = y.map(|[low, high]| [-high, -low]);
    let [left, right] = texels(x, raster.width)?;
    let [top, bottom] = texels(y, raster.height)?;
    Some(Rectangle { corner_px: [left, top], extent: Extent::new(right - left, bottom - top) })
}

/// Where the two planes through the eye that touch a sphere cross the screen, -1 to 1 inside; None: it may be seen
/// everywhere along this axis. `across`, `ahead`: the sphere's middle.
fn tangents(across: f64, ahead: f64, radius: f64, scale: f64) -> Option<[f64; 2]> {
    let distance = across.hypot(ahead);
    if distance <= radius {
        return None;
    }
    let (middle, half) = (across.atan2(ahead), (radius / distance).asin());
    let edge = |angle: f64| {
        // Beside or behind the eye: beyond the screen's edge on that side.
        let limit = std::f64::consts::FRAC_PI_2;
        if angle <= -limit {
            f64::NEG_INFINITY
        } else if angle >= limit {
            f64::INFINITY
        } else {
            angle.tan() * scale
        }
    };
    Some([edge(middle - half), edge(middle + half)])
}

/// First and end of the texels of a span, of `length` in all; None where there are none.
fn texels(span: Option<[f64; 2]>, length: u32) -> Option<[u32; 2]> {
    let Some([low, high]) = span else { return Some([0, length]) };
    let place = |at: f64| (at * 0.5 + 0.5) * f64::from(length);
    let first = (place(low) - MARGIN_PX).floor().clamp(0.0, f64::from(length)) as u32;
    let end = (place(high) + MARGIN_PX).ceil().clamp(0.0, f64::from(length)) as u32;
    (first < end).then_some([first, end])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Light, LightKind};
    use crate::shading::light::block;
    use glam::Mat4;
    use proptest::prelude::*;

    fn light(position: Vec3, range: f32) -> LightBlock {
        let light = Light {
            name: String::new(),
            kind: LightKind::Point,
            intensity: Vec3::ONE,
            position,
            direction: -Vec3::Y,
            range: Some(range),
            radius: 0.0,
        };
        block(&light, 0.0)
    }

    fn view(projection: Projection) -> View {
        let world_from_view = Mat4::from_rotation_y(0.4) * Mat4::from_translation(Vec3::new(0.5, -0.2, 1.0));
        View {
            extent: Extent::new(200, 100),
            camera: Camera { name: String::new(), world_from_view, projection },
            made_up: false,
        }
    }

    proptest! {
        /// Every point of the sphere that is on the screen is in the rectangle.
        #[test]
        fn no_point_within_range_is_left_out(
            x in -6f32..6.0, y in -6f32..6.0, z in -8f32..6.0, range in 0.05f32..5.0,
            directions in proptest::collection::vec((-1f32..1.0, -1f32..1.0, -1f32..1.0, 0f32..1.0), 1..40),
            orthographic: bool,
        ) {
            let view = view(if orthographic {
                Projection::Orthographic { x_mag: 4.0, y_mag: 2.0, z_near: 0.1, z_far: 50.0 }
            } else {
                Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 0.1, z_far: None }
            });
            let raster = Extent::new(125, 62);
            let found = rectangle(&light(Vec3::new(x, y, z), range), &view, raster);
            let clip = view.clip_from_world();
            for (dx, dy, dz, part) in directions {
                let away = Vec3::new(dx, dy, dz).normalize_or(Vec3::X) * range * part;
                let at = clip * (Vec3::new(x, y, z) + away).extend(1.0);
                if at.w <= 0.0 || at.x.abs() > at.w || at.y.abs() > at.w || at.z < 0.0 || at.z > at.w {
                    continue;
                }
                let place = |at: f32, length: u32| (at * 0.5 + 0.5) * length as f32;
                let (px, py) = (place(at.x / at.w, raster.width), place(at.y / at.w, raster.height));
                let rectangle = found.expect("something of it is seen");
                let [left, top] = rectangle.corner_px;
                prop_assert!(px >= left as f32 && px <= (left + rectangle.extent.width) as f32);
                prop_assert!(py >= top as f32 && py <= (top + rectangle.extent.height) as f32);
            }
        }
    }

    #[test]
    fn what_is_behind_reaches_nothing_and_what_has_no_end_everything() {
        let view = view(Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 0.1, z_far: None });
        let raster = Extent::new(125, 62);
        let behind = view.camera.world_from_view.transform_point3(Vec3::new(0.0, 0.0, 5.0));
        assert_eq!(rectangle(&light(behind, 1.0), &view, raster), None);
        let endless = rectangle(&light(behind, 0.0), &view, raster).unwrap();
        assert_eq!(endless, Rectangle { corner_px: [0, 0], extent: raster });
        let small =
            rectangle(&light(view.camera.world_from_view.transform_point3(Vec3::NEG_Z * 5.0), 0.2), &view, raster);
        assert!(small.unwrap().extent.pixel_count() < 200, "{small:?}");
    }
}

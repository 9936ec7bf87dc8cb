//! glTF cameras at their nodes, made rigid.

use std::f32::consts::PI;

use glam::Mat4;
use gltf::{Document, json};

use super::label;
use super::nodes::PlacedNode;
use crate::error::{Error, Result};
use crate::scene::{Camera, Projection};

/// The cameras at `placed` nodes, in their order. One whose node has no orientation is left out with a warning.
pub fn read(document: &Document, placed: &[PlacedNode], warnings: &mut Vec<String>) -> Result<Vec<Camera>> {
    let root = document.as_json();
    let mut cameras = Vec::new();
    for placed in placed {
        let node = &root.nodes[placed.node_index];
        let Some(index) = node.camera.map(|camera| camera.value()) else { continue };
        let camera = &root.cameras[index];
        let label = label::element("camera", index, camera.name.as_deref());
        let projection = read_projection(camera).map_err(|error| error.within(&label))?;
        match rigid(placed.world_from_node) {
            Some(world_from_view) => {
                let name = camera.name.clone().or_else(|| node.name.clone());
                let name = name.unwrap_or_else(|| format!("camera {index}"));
                cameras.push(Camera { name, world_from_view, projection });
            }
            None => warnings
                .push(format!("{label} at {} has no orientation; left out", label::node(document, placed.node_index))),
        }
    }
    Ok(cameras)
}

fn read_projection(camera: &json::Camera) -> Result<Projection> {
    let positive = |value: f32| value.is_finite() && value > 0.0;
    // The crate checks that one of the two is there, not that it is the one that `type` names.
    match (camera.type_, &camera.perspective, &camera.orthographic) {
        (json::validation::Checked::Valid(json::camera::Type::Perspective), Some(view), _) => {
            let (aspect, z_far) = (view.aspect_ratio, view.zfar);
            let fits = positive(view.yfov)
                && view.yfov < PI
                && aspect.is_none_or(positive)
                && positive(view.znear)
                && z_far.is_none_or(|z_far| z_far.is_finite() && z_far > view.znear);
            if !fits {
                return Err(Error::request(format!(
                    "yfov {}, aspectRatio {aspect:?}, znear {}, zfar {z_far:?}: needed is 0 < yfov < pi, a positive \
                     aspectRatio or none, and 0 < znear < zfar",
                    view.yfov, view.znear
                )));
            }
            Ok(Projection::Perspective { y_fov: view.yfov, aspect, z_near: view.znear, z_far })
        }
        (json::validation::Checked::Valid(json::camera::Type::Orthographic), _, Some(view)) => {
            let fits = positive(view.xmag)
                && positive(view.ymag)
                && view.znear >= 0.0
                && view.zfar.is_finite()
                && view.zfar > view.znear;
            if !fits {
                return Err(Error::request(format!(
                    "xmag {}, ymag {}, znear {}, zfar {}: needed are positive magnitudes and 0 <= znear < zfar",
                    view.xmag, view.ymag, view.znear, view.zfar
                )));
            }
            Ok(Projection::Orthographic { x_mag: view.xmag, y_mag: view.ymag, z_near: view.znear, z_far: view.zfar })
        }
        _ => Err(Error::request("has no description of the projection that its type names")),
    }
}

/// Rotation and translation of a transform: it keeps looking along -z with its y upwards; scale, shear and mirroring
/// go. None where y and z do not span a plane.
fn rigid(world_from_view: Mat4) -> Option<Mat4> {
    let back = world_from_view.z_axis.truncate().try_normalize()?;
    let right = world_from_view.y_axis.truncate().try_normalize()?.cross(back).try_normalize()?;
    let up = back.cross(right);
    Some(Mat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), world_from_view.w_axis))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};

    use super::*;

    #[test]
    fn scale_and_mirroring_leave_a_rigid_view() {
        let rotation = Quat::from_euler(glam::EulerRot::YXZ, 0.4, -0.7, 0.2);
        let rigid_view = Mat4::from_rotation_translation(rotation, Vec3::new(1.0, 2.0, 3.0));
        for scale in [Vec3::ONE, Vec3::new(-2.0, 3.0, 0.5), Vec3::splat(100.0)] {
            let found = rigid(rigid_view * Mat4::from_scale(scale)).unwrap();
            assert!(found.abs_diff_eq(rigid_view, 1e-5), "{scale}: {found}");
        }
        assert!(rigid(Mat4::from_scale(Vec3::new(1.0, 1.0, 0.0))).is_none());
    }
}

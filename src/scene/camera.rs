//! Cameras: where they stand and how they project.

use glam::Mat4;

/// glTF's two projections. Distances in metres, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// `aspect` None: the picture's. `z_far` None: infinite.
    Perspective { y_fov: f32, aspect: Option<f32>, z_near: f32, z_far: Option<f32> },
    /// Half the width and half the height of what is seen.
    Orthographic { x_mag: f32, y_mag: f32, z_near: f32, z_far: f32 },
}

/// A view: looks along -z of its own space, y up.
#[derive(Clone, Debug)]
pub struct Camera {
    pub name: String,
    /// Rigid: rotation and translation only.
    pub world_from_view: Mat4,
    pub projection: Projection,
}

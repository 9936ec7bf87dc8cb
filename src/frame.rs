//! The view of a frame: camera and extent, and the block of numbers that every shader may read (glsl/frame.glsl).

use crate::error::{Error, Result};
use crate::framing;
use crate::gpu::shader::frame::FAR;
use crate::gpu::shader::structs::FrameBlock;
use crate::scene::{Bounds, Camera, Projection, Scene};
use crate::units::Extent;
use bytemuck::Zeroable;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// A camera and the picture it fills.
#[derive(Clone, Debug)]
pub struct View {
    pub extent: Extent,
    pub camera: Camera,
    /// None of the scene's: this one frames what there is (`framing`).
    pub made_up: bool,
}

impl View {
    /// The camera that `selector` (an index or a name) names; where the scene has none, and where it is `framing` and none
    /// is called so, one that frames the scene (`framing`).
    ///
    /// Errors: no such camera (exit code 2).
    pub fn new(scene: &Scene, selector: &str, extent: Extent) -> Result<Self> {
        let by_name = scene.cameras.iter().position(|camera| camera.name == selector);
        let is_default = scene.cameras.is_empty() && selector == "0";
        if is_default || by_name.is_none() && selector == framing::NAME {
            let camera = framing::camera(&scene.lasting_bounds(), &scene.lasting_facing(), extent);
            return Ok(Self { extent, camera, made_up: true });
        }
        if scene.cameras.is_empty() {
            return Err(Error::request(format!("--camera {selector}: {} has no camera", scene.name))
                .note("without --camera one is made that frames the scene"));
        }
        let index = by_name.or_else(|| selector.parse().ok()).filter(|index| *index < scene.cameras.len());
        match index {
            Some(index) => Ok(Self { extent, camera: scene.cameras[index].clone(), made_up: false }),
            None => {
                let names: Vec<&str> = scene.cameras.iter().map(|camera| camera.name.as_str()).take(12).collect();
                Err(Error::request(format!("--camera {selector}: {} has no such camera", scene.name)).note(format!(
                    "`framing` makes one that frames the scene; it has {}: {}",
                    scene.cameras.len(),
                    names.join(", ")
                )))
            }
        }
    }

    /// Where the eye is, world space.
    pub fn eye(&self) -> Vec3 {
        self.camera.world_from_view.w_axis.truncate()
    }

    /// The camera's right, up and back: unit vectors, world space.
    fn axes(&self) -> [Vec3; 3] {
        let [right, up, back, _] =
            self.camera.world_from_view.to_cols_array_2d().map(|[x, y, z, _]| Vec3::new(x, y, z));
        [right, up, back]
    }

    /// Least and greatest distance from the eye's plane, along the direction in which the camera looks, of what can be
    /// seen of `bounds`, in metres; both differ.
    pub fn depth_range(&self, bounds: &Bounds) -> [f32; 2] {
        let [_, _, back] = self.axes();
        let (near, far) = match self.camera.projection {
            Projection::Perspective { z_near, z_far, .. } => (z_near, z_far.unwrap_or(f32::INFINITY)),
            Projection::Orthographic { z_near, z_far, .. } => (z_near, z_far),
        };
        let (center, half) = (bounds.center(), (bounds.max - bounds.min) * 0.5);
        let (middle, reach) =
            if bounds.is_empty() { (0.0, 0.0) } else { (back.dot(self.eye() - center), back.abs().dot(half)) };
        let least = (middle - reach).max(near);
        // A flat scene still needs a range with an inside.
        let greatest = (middle + reach).min(far).max(least + 1e-3 * least.abs().max(1e-6));
        [least, greatest]
    }

    /// Clip space from world space: y down as in Vulkan, depth reversed.
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_view() * self.camera.world_from_view.inverse()
    }

    /// Clip-space units for a metre to the right and up in view space, before the division.
    pub fn clip_scale(&self) -> Vec2 {
        let clip_from_view = self.clip_from_view();
        Vec2::new(clip_from_view.x_axis.x, clip_from_view.y_axis.y)
    }

    fn clip_from_view(&self) -> Mat4 {
        let picture_aspect = self.extent.width as f32 / self.extent.height as f32;
        match self.camera.projection {
            // A camera with an aspect of its own keeps its vertical angle; the picture's shape decides the width.
            Projection::Perspective { y_fov, aspect: _, z_near, z_far } => {
                let y = 1.0 / (0.5 * y_fov).tan();
                let x = y / picture_aspect;
                // depth = near (far - z) / (z (far - near)): 1 at near, 0 at far; far may be infinite.
                let (a, b) = match z_far {
                    None => (0.0, z_near),
                    Some(z_far) => (z_near / (z_far - z_near), z_near * z_far / (z_far - z_near)),
                };
                Mat4::from_cols(
                    Vec4::new(x, 0.0, 0.0, 0.0),
                    Vec4::new(0.0, -y, 0.0, 0.0),
                    Vec4::new(0.0, 0.0, a, -1.0),
                    Vec4::new(0.0, 0.0, b, 0.0),
                )
            }
            Projection::Orthographic { x_mag, y_mag, z_near, z_far } => {
                // The picture's shape decides the width here too.
                let x_mag = if x_mag / y_mag == picture_aspect { x_mag } else { y_mag * picture_aspect };
                let depth = z_far - z_near;
                Mat4::from_cols(
                    Vec4::new(1.0 / x_mag, 0.0, 0.0, 0.0),
                    Vec4::new(0.0, -1.0 / y_mag, 0.0, 0.0),
                    Vec4::new(0.0, 0.0, 1.0 / depth, 0.0),
                    Vec4::new(0.0, 0.0, z_far / depth, 1.0),
                )
            }
        }
    }

    /// What a pixel sees as a cone, from the eye on: its width there, metres, and by how much it grows a metre along the view.
    pub fn pixel_cone(&self) -> [f32; 2] {
        let rows = self.extent.height as f32;
        match self.camera.projection {
            Projection::Perspective { y_fov, .. } => [0.0, 2.0 * (0.5 * y_fov).tan() / rows],
            Projection::Orthographic { y_mag, .. } => [2.0 * y_mag / rows, 0.0],
        }
    }

    /// The block that shaders read.
    pub fn block(
        &self,
        bounds: &Bounds,
        background: Vec3,
        ambient: Vec3,
        light_count: u32,
        vpl_count: u32,
    ) -> FrameBlock {
        let (box_min, box_size) = if bounds.is_empty() {
            (Vec3::ZERO, Vec3::ONE)
        } else {
            // A flat scene still needs a box with an inside.
            (bounds.min, (bounds.max - bounds.min).max(Vec3::splat(1e-6 * bounds.diagonal().max(1e-6))))
        };
        self.camera_of(FrameBlock {
            box_min_ws: box_min.extend(0.0).to_array(),
            box_size_ws: box_size.extend(0.0).to_array(),
            background: background.extend(0.0).to_array(),
            ambient: ambient.extend(0.0).to_array(),
            width_px: self.extent.width,
            height_px: self.extent.height,
            light_count,
            vpl_count,
            ..FrameBlock::zeroed()
        })
    }

    /// `block` with this view's camera.
    pub fn camera_of(&self, block: FrameBlock) -> FrameBlock {
        let clip_from_world = self.clip_from_world();
        // Double precision: the inverse is what `--position depth` reads positions back with.
        let world_from_clip = clip_from_world.as_dmat4().inverse().as_mat4();
        let perspective = matches!(self.camera.projection, Projection::Perspective { .. });
        let [right, up, back] = self.axes();
        FrameBlock {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            world_from_clip: world_from_clip.to_cols_array_2d(),
            eye_ws: self.eye().extend(if perspective { 1.0 } else { 0.0 }).to_array(),
            forward_ws: (-back).extend(0.0).to_array(),
            right_ws: right.extend(0.0).to_array(),
            up_ws: up.extend(0.0).to_array(),
            ..block
        }
    }

    /// `block`, which is of this view, with the picture moved by `offset_px` to the right and down.
    pub fn moved(&self, block: FrameBlock, offset_px: Vec2) -> FrameBlock {
        // Clip space is two units wide.
        let shift = 2.0 * offset_px / Vec2::new(self.extent.width as f32, self.extent.height as f32);
        self.seen_from(block, LensPlace::MIDDLE, Placement { scale: Vec2::ONE, shift })
    }

    /// `block`, which is of this view, as a place of its lens sees it, the picture placed otherwise in what it is drawn into.
    pub fn seen_from(&self, block: FrameBlock, lens: LensPlace, placement: Placement) -> FrameBlock {
        if lens == LensPlace::MIDDLE && placement == Placement::WHOLE {
            return block;
        }
        let placing =
            Mat4::from_translation(placement.shift.extend(0.0)) * Mat4::from_scale(placement.scale.extend(1.0));
        let view_from_world = lens.shear() * self.camera.world_from_view.inverse();
        let clip_from_world = placing * (self.clip_from_view() * view_from_world);
        let world_from_clip = clip_from_world.as_dmat4().inverse().as_mat4();
        let [right, up, back] = self.axes();
        let aside = right * lens.at_m.x + up * lens.at_m.y;
        let [eye_x, eye_y, eye_z, is_perspective] = block.eye_ws;
        // Parallel rays lean towards the same place in the plane in focus.
        let leaning = (-back - aside / lens.focus_m).normalize();
        FrameBlock {
            clip_from_world: clip_from_world.to_cols_array_2d(),
            world_from_clip: world_from_clip.to_cols_array_2d(),
            eye_ws: (Vec3::new(eye_x, eye_y, eye_z) + aside).extend(is_perspective).to_array(),
            forward_ws: if is_perspective > 0.0 { block.forward_ws } else { leaning.extend(0.0).to_array() },
            ..block
        }
    }
}

/// How a picture lies in what it is drawn into: what is at `at` of it, -1 to 1 along both axes, is at `scale * at + shift`
/// there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    pub scale: Vec2,
    pub shift: Vec2,
}

impl Placement {
    /// The picture fills what it is drawn into.
    pub const WHOLE: Self = Self { scale: Vec2::ONE, shift: Vec2::ZERO };
}

/// A place on a thin lens, and the plane that it sees as all others do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensPlace {
    /// Metres to the camera's right and up.
    pub at_m: Vec2,
    /// From the lens to the plane in focus, metres.
    pub focus_m: f32,
}

impl LensPlace {
    /// Where the camera is.
    pub const MIDDLE: Self = Self { at_m: Vec2::ZERO, focus_m: 1.0 };

    /// View space as it is seen from this place: what lies in the plane in focus stays.
    fn shear(self) -> Mat4 {
        let mut shear = Mat4::from_translation(-self.at_m.extend(0.0));
        shear.z_axis = (-self.at_m / self.focus_m).extend(1.0).extend(0.0);
        shear
    }
}

/// What is seen through a place of the picture, from the near plane to the far one: the twin of `view_ray` in
/// glsl/frame.glsl.
#[derive(Clone, Copy, Debug)]
pub struct ViewRay {
    /// On the near plane, world space.
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
    /// Metres that it reaches.
    pub limit: f32,
    /// Metres before its origin at which it would begin if no near plane cut it.
    pub behind: f32,
}

impl ViewRay {
    /// Through the place `at_px` of the picture, in pixels from its upper left corner.
    pub fn through(frame: &FrameBlock, at_px: Vec2) -> Self {
        let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        let world_from_clip = Mat4::from_cols_array_2d(&frame.world_from_clip);
        let ndc = at_px / Vec2::new(frame.width_px as f32, frame.height_px as f32) * 2.0 - 1.0;
        let [near, far] = [1.0, 0.0].map(|depth| world_from_clip * ndc.extend(depth).extend(1.0));
        let (eye, is_perspective) = (three(frame.eye_ws), frame.eye_ws[3] > 0.0);
        let start = near.truncate() / near.w;
        // A far plane at infinity has w = 0: this is a direction all the same.
        let seen = || (far.truncate() - eye * far.w).normalize();
        let (direction, behind) =
            if is_perspective { (seen(), start.distance(eye)) } else { (three(frame.forward_ws), 0.0) };
        // Along the ray, and not to the near plane's own point, which floats place too roughly next to the eye.
        let origin = if is_perspective { eye + direction * behind } else { start };
        let limit = if far.w > 0.0 { (far.truncate() / far.w).distance(origin).min(FAR) } else { FAR };
        Self { origin, direction, limit, behind }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(projection: Projection) -> View {
        let world_from_view = Mat4::from_translation(Vec3::new(0.0, 0.0, 5.0));
        let camera = Camera { name: String::new(), world_from_view, projection };
        View { extent: Extent::new(200, 100), camera, made_up: false }
    }

    #[test]
    fn depth_is_one_at_the_near_plane_and_zero_at_the_far_plane_and_up_is_up() {
        let perspective = Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 1.0, z_far: Some(10.0) };
        let orthographic = Projection::Orthographic { x_mag: 4.0, y_mag: 2.0, z_near: 1.0, z_far: 10.0 };
        for projection in [perspective, orthographic] {
            let clip = view(projection).clip_from_world();
            assert!((clip.project_point3(Vec3::new(0.0, 0.0, 4.0)).z - 1.0).abs() < 1e-6, "{projection:?}");
            assert!(clip.project_point3(Vec3::new(0.0, 0.0, -5.0)).z.abs() < 1e-6, "{projection:?}");
            // Vulkan's y points down: what is up in the world has a negative y.
            assert!(clip.project_point3(Vec3::new(0.0, 0.5, 0.0)).y < 0.0);
            assert!(clip.project_point3(Vec3::new(0.5, 0.0, 0.0)).x > 0.0);
        }
    }

    #[test]
    fn a_ray_through_a_pixel_goes_from_the_near_plane_to_the_far_one() {
        let perspective = |z_far| Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 1.0, z_far };
        let orthographic = Projection::Orthographic { x_mag: 4.0, y_mag: 2.0, z_near: 1.0, z_far: 10.0 };
        for (projection, has_end) in [(perspective(Some(10.0)), true), (perspective(None), false), (orthographic, true)]
        {
            let view = view(projection);
            let block = view.block(&Bounds::EMPTY, Vec3::ZERO, Vec3::ZERO, 0, 0);
            for at_px in [Vec2::new(0.5, 0.5), Vec2::new(160.25, 20.0)] {
                let ray = ViewRay::through(&block, at_px);
                assert!((ray.direction.length() - 1.0).abs() < 1e-6);
                assert!((ray.origin.z - 4.0).abs() < 1e-5, "{projection:?}: {ray:?}");
                let begun = ray.origin - ray.direction * ray.behind;
                let is_perspective = matches!(projection, Projection::Perspective { .. });
                assert!(!is_perspective || (begun - view.eye()).length() < 1e-5, "{ray:?}");
                let end = ray.origin + ray.direction * if has_end { ray.limit } else { 50.0 };
                assert!(if has_end { (end.z + 5.0).abs() < 1e-4 } else { ray.limit == FAR }, "{projection:?}: {ray:?}");
                for point in [ray.origin, end] {
                    let clip = view.clip_from_world().project_point3(point);
                    let found = (clip.truncate() + 1.0) * 0.5 * Vec2::new(200.0, 100.0);
                    assert!((found - at_px).length() < 1e-2, "{projection:?}: {found} for {at_px}");
                }
            }
        }
    }

    #[test]
    fn a_moved_picture_has_every_point_so_many_pixels_further() {
        let perspective = Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 1.0, z_far: None };
        let orthographic = Projection::Orthographic { x_mag: 4.0, y_mag: 2.0, z_near: 1.0, z_far: 10.0 };
        for projection in [perspective, orthographic] {
            let view = view(projection);
            let plain = view.block(&Bounds::EMPTY, Vec3::ZERO, Vec3::ZERO, 0, 0);
            assert_eq!(view.moved(plain, Vec2::ZERO), plain);
            let moved = view.moved(plain, Vec2::new(0.25, -0.5));
            for point in [Vec3::new(0.3, 0.2, -1.0), Vec3::new(-0.7, 0.1, 3.0)] {
                let at = |block: &FrameBlock| Mat4::from_cols_array_2d(&block.clip_from_world).project_point3(point);
                let apart = (at(&moved) - at(&plain)) * Vec3::new(100.0, 50.0, 1.0);
                assert!((apart - Vec3::new(0.25, -0.5, 0.0)).length() < 1e-4, "{apart}");
            }
        }
    }

    /// Through every place of the lens what lies in the plane in focus is in one place, and what lies twice as far is as far
    /// aside as similar triangles say.
    #[test]
    fn a_place_on_the_lens_sees_the_plane_in_focus_where_it_is() {
        let perspective = Projection::Perspective { y_fov: 1.0, aspect: None, z_near: 0.1, z_far: None };
        let orthographic = Projection::Orthographic { x_mag: 4.0, y_mag: 2.0, z_near: 1.0, z_far: 20.0 };
        for projection in [perspective, orthographic] {
            let view = view(projection);
            let plain = view.block(&Bounds::EMPTY, Vec3::ZERO, Vec3::ZERO, 0, 0);
            let lens = LensPlace { at_m: Vec2::new(0.2, -0.1), focus_m: 5.0 };
            let seen = view.seen_from(plain, lens, Placement::WHOLE);
            let at = |block: &FrameBlock, z: f32| {
                Mat4::from_cols_array_2d(&block.clip_from_world).project_point3(Vec3::new(0.3, 0.2, z))
            };
            // The eye is at 5: the plane in focus is that of 0.
            assert!((at(&seen, 0.0) - at(&plain, 0.0)).length() < 1e-6, "{projection:?}");
            let behind = (at(&seen, -5.0) - at(&plain, -5.0)) * Vec3::new(100.0, 50.0, 1.0);
            // A point 5 m behind it moves by the place on the lens, seen from 10 m.
            let clip = view.clip_from_world();
            let moved = clip.project_point3(Vec3::new(0.3 + 0.2, 0.2 - 0.1, -5.0))
                - clip.project_point3(Vec3::new(0.3, 0.2, -5.0));
            assert!((behind - moved * Vec3::new(100.0, 50.0, 1.0)).length() < 1e-3, "{projection:?}: {behind}");
            // Rays through the middle of the picture go through the lens place and the same point in focus.
            let ray = ViewRay::through(&seen, Vec2::new(100.0, 50.0));
            let in_focus = ray.origin + ray.direction * (ray.origin.z / -ray.direction.z);
            assert!(in_focus.length() < 1e-4, "{projection:?}: {in_focus}");
        }
    }

    #[test]
    fn a_camera_that_is_not_there_is_refused_with_those_that_are() {
        let mut scene = Scene { name: "room".to_owned(), ..Scene::default() };
        assert!(View::new(&scene, "0", Extent::new(8, 8)).unwrap().made_up);
        assert_eq!(View::new(&scene, "1", Extent::new(8, 8)).unwrap_err().exit_code(), 2);
        let projection = Projection::Orthographic { x_mag: 1.0, y_mag: 1.0, z_near: 0.0, z_far: 1.0 };
        let own = |name: &str| Camera { name: name.to_owned(), world_from_view: Mat4::IDENTITY, projection };
        scene.cameras.push(own("window"));
        assert!(!View::new(&scene, "window", Extent::new(8, 8)).unwrap().made_up);
        let error = View::new(&scene, "door", Extent::new(8, 8)).unwrap_err();
        assert!(error.to_string().contains("it has 1: window"), "{error}");
        // A camera that frames the scene exists on request, unless the file has one of this name.
        assert!(View::new(&scene, "framing", Extent::new(8, 8)).unwrap().made_up);
        scene.cameras.push(own("framing"));
        assert!(!View::new(&scene, "framing", Extent::new(8, 8)).unwrap().made_up);
    }
}

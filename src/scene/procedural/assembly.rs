//! Puts a scene together: pictures, materials, meshes and draws by index.

use glam::{DVec3, Mat4, Vec3, Vec4};

use super::curves;
use super::made::{Motion, Thing};
use super::patch::{self, Patch};
use super::pictures::{Sheet, Texel};
use crate::scene::animation::Curve;
use crate::scene::procedural::curves::facing;
use crate::scene::{Camera, ColorSpace, Draw, Image, Light, LightKind, Material, Projection, Sampler, Scene, Texture};

/// Which pictures of a pattern a material uses.
#[derive(Clone, Copy, Debug)]
pub struct Maps {
    pub size_px: u32,
    /// Height of the relief in widths of the picture; None: no normal map.
    pub relief: Option<f32>,
    /// Whether roughness and metalness vary over the surface.
    pub metallic_roughness: bool,
}

/// A scene that is being made.
#[derive(Default)]
pub struct Assembly {
    pub scene: Scene,
    /// What moves in it.
    pub motions: Vec<Motion>,
}

impl Assembly {
    /// Adds a material and returns its index.
    pub fn material(&mut self, material: Material) -> usize {
        self.scene.materials.push(material);
        self.scene.materials.len() - 1
    }

    /// Adds a material whose colour (and relief, and roughness, as `maps` asks) comes from a pattern.
    ///
    /// `material` gives the rest. Where metalness and roughness come from the pattern both factors become 1.
    pub fn textured(&mut self, material: Material, maps: Maps, pattern: impl Fn([f32; 2]) -> Texel + Sync) -> usize {
        let sheet = Sheet::paint(maps.size_px, |u, v| pattern([u, v]));
        let name = material.name.clone();
        let mut material = material;
        let base_color = sheet.base_color(&format!("{name}.base_color"));
        material.base_color_texture = Some(self.texture(base_color, ColorSpace::Srgb));
        if let Some(relief) = maps.relief {
            let normals = sheet.normals(&format!("{name}.normal"), relief);
            material.normal_texture = Some(self.texture(normals, ColorSpace::Linear));
        }
        if maps.metallic_roughness {
            let image = sheet.metallic_roughness(&format!("{name}.metallic_roughness"));
            material.metallic_roughness_texture = Some(self.texture(image, ColorSpace::Linear));
            material.metallic = 1.0;
            material.roughness = 1.0;
        }
        self.material(material)
    }

    /// Adds a material that lights itself, as a window does: a pattern is what it shines, by the factor of `material`; it
    /// reflects next to nothing.
    pub fn shining(&mut self, material: Material, size_px: u32, pattern: impl Fn([f32; 2]) -> Texel + Sync) -> usize {
        let index = self.textured(material, Maps { size_px, relief: None, metallic_roughness: false }, pattern);
        let material = &mut self.scene.materials[index];
        material.emissive_texture = material.base_color_texture.take();
        material.base_color = Vec4::new(0.02, 0.02, 0.02, 1.0);
        index
    }

    /// Adds an image seen trilinearly and repeated, and returns the texture's index.
    pub fn texture(&mut self, image: Image, color_space: ColorSpace) -> usize {
        self.scene.images.push(image.into());
        let image = self.scene.images.len() - 1;
        self.scene.textures.push(Texture { image, sampler: Sampler::default(), color_space });
        self.scene.textures.len() - 1
    }

    /// Adds a mesh, with tangents where its material has a normal map, and returns its index.
    pub fn mesh(&mut self, name: &str, material: usize, patches: &[Patch]) -> usize {
        let with_tangents = self.scene.materials[material].normal_texture.is_some();
        self.scene.meshes.push(patch::mesh(name, material, patches, with_tangents));
        self.scene.meshes.len() - 1
    }

    /// Puts a mesh somewhere.
    pub fn draw(&mut self, mesh: usize, world_from_object: Mat4) {
        self.scene.draws.push(Draw { mesh, world_from_object });
    }

    /// Adds a mesh that stands once, where its patches are.
    pub fn fixed(&mut self, name: &str, material: usize, patches: &[Patch]) {
        let mesh = self.mesh(name, material, patches);
        self.draw(mesh, Mat4::IDENTITY);
    }

    /// Puts a mesh somewhere where it turns about an axis of unit length, once in `turn_s` seconds.
    pub fn turning(&mut self, name: &str, mesh: usize, at: DVec3, axis: Vec3, turn_s: u32) {
        let thing = Thing::Draw(self.scene.draws.len());
        self.draw(mesh, shifted(at));
        self.motions.push(Motion::turning(name, thing, at.as_vec3(), axis, turn_s));
    }

    /// Puts a mesh where `translations`, which repeats after `period_s` seconds, and `rotations` have it.
    pub fn moving(&mut self, name: &str, mesh: usize, translations: Curve, rotations: Option<Curve>, period_s: u32) {
        let thing = Thing::Draw(self.scene.draws.len());
        let motion = Motion::along(name, thing, translations, rotations, period_s);
        self.draw(mesh, motion.place_at(0.0));
        self.motions.push(motion);
    }

    /// Adds a point light that goes along `translations`, which repeat after `period_s` seconds: candela per channel, metres.
    pub fn moving_point_light(&mut self, name: &str, translations: Curve, intensity: Vec3, period_s: u32) {
        let thing = Thing::Light(self.scene.lights.len());
        let motion = Motion::along(name, thing, translations, None, period_s);
        self.point_light(name.to_owned(), motion.translation_at(0.0), intensity, None);
        self.motions.push(motion);
    }

    /// Adds a point light: candela per channel, metres.
    pub fn point_light(&mut self, name: String, position: Vec3, intensity: Vec3, range: Option<f32>) {
        let direction = Vec3::NEG_Y;
        self.scene.lights.push(Light {
            name,
            kind: LightKind::Point,
            intensity,
            position,
            direction,
            range,
            radius: 0.0,
        });
    }

    /// Adds a spot light at `position` that shines toward `target`: candela per channel, metres; half angles of its cone
    /// in radians, from where it fades and where it ends.
    pub fn spot_light(&mut self, name: String, [position, target]: [DVec3; 2], intensity: Vec3, angles: [f32; 2]) {
        let [inner_angle, outer_angle] = angles;
        let direction = (target - position).normalize().as_vec3().normalize();
        let (kind, position) = (LightKind::Spot { inner_angle, outer_angle }, position.as_vec3());
        self.scene.lights.push(Light { name, kind, intensity, position, direction, range: None, radius: 0.0 });
    }

    /// Adds a perspective camera at `eye` that looks at `target`, y up. Metres, radians.
    pub fn camera(&mut self, name: &str, eye: DVec3, target: DVec3, y_fov: f32) {
        let [right, up, backward] = facing(eye, target);
        let column = |vector: DVec3, w: f32| vector.as_vec3().extend(w);
        let world_from_view =
            Mat4::from_cols(column(right, 0.0), column(up, 0.0), column(backward, 0.0), column(eye, 1.0));
        let projection = Projection::Perspective { y_fov, aspect: None, z_near: 0.05, z_far: None };
        self.scene.cameras.push(Camera { name: name.to_owned(), world_from_view, projection });
    }

    /// Adds a camera that flies through `eyes` and back to the first while it looks from one of `targets` to the next, in
    /// `curves::DURATION_S`. Its animation has its name.
    pub fn flying_camera(&mut self, name: &str, eyes: &[DVec3], targets: &[DVec3], y_fov: f32) {
        let thing = Thing::Camera(self.scene.cameras.len());
        self.camera(name, eyes[0], targets[0], y_fov);
        let [path, gaze] = [eyes, targets].map(|stops| curves::circuit(stops, curves::DURATION_S));
        let looks = curves::looking(&path, &gaze);
        self.motions.push(Motion::along(name, thing, path, Some(looks), curves::DURATION_S));
    }
}

/// A place: `cosine` and `sine` of a turn around y (from +z toward +x), a scale, then a shift in metres.
pub fn place([sine, cosine]: [f64; 2], scale: f64, shift: DVec3) -> Mat4 {
    let column = |x: f64, y: f64, z: f64| Vec4::new(x as f32, y as f32, z as f32, 0.0);
    Mat4::from_cols(
        column(cosine * scale, 0.0, -sine * scale),
        column(0.0, scale, 0.0),
        column(sine * scale, 0.0, cosine * scale),
        shift.as_vec3().extend(1.0),
    )
}

/// A place that is only a shift.
pub fn shifted(shift: DVec3) -> Mat4 {
    place([0.0, 1.0], 1.0, shift)
}

//! A square that fills the picture: what a material is at each of its points, a pixel shows.

use glam::{Mat4, Vec2, Vec3, Vec4};
use quincunx::scene::{Camera, ColorSpace, Draw, Image, Material, Mesh, Projection, Sampler, Scene, Texture, Wrap};

/// Vulkan's standard places of 4 samples, parts of a pixel.
pub const FOUR_PLACES: [Vec2; 4] =
    [Vec2::new(0.375, 0.125), Vec2::new(0.875, 0.375), Vec2::new(0.125, 0.625), Vec2::new(0.625, 0.875)];

/// Faces the camera and fills the picture; coordinates run from the picture's upper left corner.
pub fn square(material: Material) -> Scene {
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let mesh = Mesh {
        positions: corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        uvs: corners.map(|(x, y)| Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y)).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    let projection = Projection::Orthographic { x_mag: 1.0, y_mag: 1.0, z_near: 0.1, z_far: 9.0 };
    let world_from_view = Mat4::from_translation(Vec3::Z * 2.0);
    Scene {
        name: "square".to_owned(),
        meshes: vec![mesh],
        draws: vec![Draw { mesh: 0, world_from_object: Mat4::IDENTITY }],
        materials: vec![material],
        cameras: vec![Camera { name: String::new(), world_from_view, projection }],
        ..Scene::default()
    }
}

pub fn matt(base_color: Vec4) -> Material {
    Material { base_color, metallic: 0.0, ..Material::default() }
}

/// Adds an image of linear numbers, seen nearest and repeated; returns the texture's index.
pub fn picture(scene: &mut Scene, width: u32, rgba8: &[[u8; 4]], color_space: ColorSpace) -> usize {
    let height = rgba8.len() as u32 / width;
    scene.images.push(Image { name: String::new(), width, height, rgba8: rgba8.concat() }.into());
    let sampler =
        Sampler { wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat, mag_linear: false, min_linear: false, mip_linear: None };
    scene.textures.push(Texture { image: scene.images.len() - 1, sampler, color_space });
    scene.textures.len() - 1
}

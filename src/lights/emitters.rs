//! Sources of light by their power: the triangles that shine, and the punctual lights, as lists that a number between 0 and
//! 1 chooses from (glsl/techniques/path_traced/path.glsl, `source_of`).

use crate::bvh::Bvh;
use crate::gpu::shader::structs::SourceBlock;
use crate::scene::{Light, Material, Scene};
use crate::shading::light;
use bytemuck::Zeroable;
use glam::Vec3;

/// The triangles that shine.
pub struct Emitters {
    /// Emitting triangles, by index into the tree's triangles; their chances add up to 1.
    pub sources: Vec<SourceBlock>,
    /// Sum of radiance times area, over all channels; 0 where nothing shines.
    total: f64,
}

impl Emitters {
    /// All emissive triangles of the tree, by radiance times area. Textures are left out of the choice: one that is off
    /// costs noise, not truth.
    pub fn of(scene: &Scene, bvh: &Bvh) -> Self {
        let mut indices = Vec::new();
        let mut powers = Vec::new();
        for (index, source) in bvh.sources.iter().enumerate() {
            let material = &scene.materials[scene.meshes[scene.draws[source.draw as usize].mesh].material];
            if !material.is_emissive() {
                continue;
            }
            let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
            let triangle = &bvh.triangles[index];
            let area = 0.5 * three(triangle.edge1).cross(three(triangle.edge2)).length();
            let power = luminous(material.emissive) * f64::from(area);
            if power > 0.0 {
                indices.push(index as u32);
                powers.push(power);
            }
        }
        Self { sources: sources(&indices, &powers), total: powers.iter().sum() }
    }

    /// How likely a point of such a surface is chosen, per square metre; 0 where it does not shine.
    pub fn density_of(&self, material: &Material) -> f32 {
        if material.is_emissive() && self.total > 0.0 { (luminous(material.emissive) / self.total) as f32 } else { 0.0 }
    }

    /// Flux of one side of all of them, summed over channels.
    pub fn power(&self) -> f64 {
        self.total * std::f64::consts::PI
    }
}

/// Punctual lights by flux, as a list by index, and their flux summed over channels. `radius`: of the scene, in metres.
pub fn punctual(lights: &[Light], radius: f32) -> (Vec<SourceBlock>, f64) {
    let powers: Vec<f64> = lights.iter().map(|one| luminous(light::flux(one, radius))).collect();
    let indices: Vec<u32> = (0..lights.len() as u32).collect();
    (sources(&indices, &powers), powers.iter().sum())
}

/// Sum of the channels.
pub fn luminous(color: Vec3) -> f64 {
    f64::from(color.x + color.y + color.z)
}

/// Sources for those of `powers` that are not 0, each with its part of the sum.
fn sources(indices: &[u32], powers: &[f64]) -> Vec<SourceBlock> {
    let total: f64 = powers.iter().sum();
    let mut sum = 0.0;
    let mut sources: Vec<SourceBlock> = Vec::new();
    for (index, power) in indices.iter().zip(powers).filter(|(_, power)| **power > 0.0) {
        sum += power / total;
        let (chance, cumulative) = ((power / total) as f32, sum as f32);
        sources.push(SourceBlock { index: *index, chance, cumulative, ..SourceBlock::zeroed() });
    }
    // The last must be beyond every number that is drawn.
    if let Some(last) = sources.last_mut() {
        last.cumulative = 1.0;
    }
    sources
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, LightKind, Mesh};
    use glam::{Mat4, vec3};

    #[test]
    fn triangles_are_chosen_by_radiance_times_area() {
        let mesh = |material: usize| Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            indices: vec![0, 1, 2],
            material,
            ..Mesh::default()
        };
        let shining = |radiance: f32| Material { emissive: Vec3::splat(radiance), ..Material::diffuse("", Vec3::ZERO) };
        let scene = Scene {
            meshes: vec![mesh(0), mesh(1), mesh(2)],
            draws: [(0, 1.0), (1, 2.0), (2, 1.0)]
                .map(|(mesh, scale)| Draw { mesh, world_from_object: Mat4::from_scale(Vec3::splat(scale)) })
                .to_vec(),
            materials: vec![shining(3.0), shining(1.0), shining(0.0)],
            ..Scene::default()
        };
        let bvh = Bvh::whole(&scene).unwrap();
        let emitters = Emitters::of(&scene, &bvh);
        assert_eq!(emitters.sources.len(), 2);
        for source in &emitters.sources {
            // 3 over half a square metre, 1 over two.
            let (chance, area, material) = match bvh.sources[source.index as usize].draw {
                0 => (3.0 / 7.0, 0.5, 0),
                draw => (4.0 / 7.0, 2.0, draw as usize),
            };
            assert!((source.chance - chance).abs() < 1e-6, "{source:?}");
            assert!((emitters.density_of(&scene.materials[material]) - chance / area).abs() < 1e-6);
        }
        assert_eq!(emitters.sources[1].cumulative, 1.0);
        assert_eq!(emitters.density_of(&scene.materials[2]), 0.0);
        assert!((emitters.power() - 3.0 * 3.5 * std::f64::consts::PI).abs() < 1e-5);
    }

    #[test]
    fn dark_lights_are_not_chosen() {
        let light = |intensity: Vec3| Light {
            name: String::new(),
            kind: LightKind::Point,
            intensity,
            position: Vec3::ZERO,
            direction: -Vec3::Y,
            range: None,
            radius: 0.0,
        };
        let (sources, power) = punctual(&[light(Vec3::ZERO), light(vec3(1.0, 2.0, 3.0)), light(Vec3::splat(2.0))], 1.0);
        assert_eq!(sources.iter().map(|source| source.index).collect::<Vec<_>>(), [1, 2]);
        assert!((sources[0].chance - 0.5).abs() < 1e-6);
        assert!((power - 48.0 * std::f64::consts::PI).abs() < 1e-4);
        assert!(punctual(&[], 1.0).0.is_empty());
    }
}

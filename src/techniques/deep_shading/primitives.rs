//! Global ids of triangles over all draws, and what of the scene is drawn (Clarberg & Munkberg 2014, section 4.2).

use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::shader::structs::DrawnParams;
use crate::gpu::shader::techniques::deep_shading::entries::waiting::ENTRY_STRAY;
use crate::gpu::shader::techniques::deep_shading::scene_buffers::{DRAWN_BLENDED, DRAWN_DOUBLE_SIDED, DRAWN_MIRRORED};
use crate::passes::blend;
use crate::resident::{Coverage, DrawCall, DrawList, Raster, SceneGpu, Sides, Sweep};
use crate::scene::{AlphaMode, Scene};
use crate::settings::GeometryChoice;
use bytemuck::Zeroable;

/// Ids of a scene's triangles.
pub struct Primitives {
    /// By draw: what an index's place, a third of it, is short of the id (modulo 2^32).
    offsets: Vec<u32>,
    pub count: u64,
    /// The same by draw for numbers in the order of draws.
    orders: Vec<u32>,
    ordered: Vec<DrawCall>,
}

impl Primitives {
    /// Errors: more triangles than ids (exit code 2).
    pub fn new(scene: &Scene) -> Result<Self> {
        let mut firsts = Vec::new();
        let mut first = 0u64;
        for mesh in &scene.meshes {
            firsts.push(first);
            first += mesh.triangle_count() as u64;
        }
        let mut count = 0u64;
        let offsets = scene.draws.iter().map(|draw| {
            let offset = count.wrapping_sub(firsts[draw.mesh]) as u32;
            count += scene.meshes[draw.mesh].triangle_count() as u64;
            offset
        });
        let offsets = offsets.collect();
        // A bit of an entry's words says that it is a stray.
        if count > u64::from(ENTRY_STRAY) {
            return Err(Error::request(format!("{}: {count} triangles, and ids are 31 bits", scene.name)));
        }
        Ok(Self { orders: vec![0; scene.draws.len()], ordered: Vec::new(), offsets, count })
    }

    /// The id of a draw's triangle, by the place of its first index among all that are resident.
    pub fn id(&self, draw: u32, first_index: u32) -> u32 {
        (first_index / 3).wrapping_add(self.offsets[draw as usize])
    }

    /// Numbers triangles in the order in which `list` draws them, from 0 on; a draw of which it draws parts has numbers for all.
    pub fn set_order(&mut self, scene: &SceneGpu, list: &DrawList) {
        let mut whole = vec![None; self.orders.len()];
        scene.calls.iter().for_each(|call| whole[call.draw as usize] = Some(*call));
        // Each once, where its first part comes.
        self.ordered = list.calls().filter_map(|part| whole[part.draw as usize].take()).collect();
        let mut count = 0u32;
        for call in &self.ordered {
            self.orders[call.draw as usize] = count.wrapping_sub(call.first_index / 3);
            // No more than there are ids.
            count += call.index_count / 3;
        }
    }

    /// Whole draws, in that order.
    pub fn ordered(&self) -> &[DrawCall] {
        &self.ordered
    }

    /// That number of a draw's triangle, by the place of its first index among all that are resident.
    pub fn order(&self, draw: u32, first_index: u32) -> u32 {
        (first_index / 3).wrapping_add(self.orders[draw as usize])
    }

    /// Parameters of a draw for shaders, without the tuple.
    pub fn params(&self, scene: &SceneGpu, call: &DrawCall) -> DrawnParams {
        let mut flags = if call.mirrored { DRAWN_MIRRORED } else { 0 };
        if call.alpha == AlphaMode::Blend {
            flags |= DRAWN_BLENDED;
        }
        if call.sides == Sides::Both {
            flags |= DRAWN_DOUBLE_SIDED;
        }
        DrawnParams {
            material: scene.material_blocks[call.material as usize],
            draw: call.draw,
            vertex_offset: call.vertex_offset as u32,
            primitive_offset: self.offsets[call.draw as usize],
            order_offset: self.orders[call.draw as usize],
            flags,
            first_triangle: call.first_index / 3,
            ..DrawnParams::zeroed()
        }
    }
}

/// The same for one tuple.
pub fn of_tuple(params: DrawnParams, tuple: u32) -> DrawnParams {
    DrawnParams { tuple, ..params }
}

/// What is drawn: solid surfaces, and with an alpha test those that have one, BLEND ones last.
///
/// `sweep`: what the middle of the lens does not see may be seen from its rim, or at another time.
pub fn drawn(scene: &Scene, resident: &SceneGpu, view: &View, choice: GeometryChoice, sweep: Sweep<'_>) -> DrawList {
    let raster = Raster { extent: view.extent, coverage: Coverage::Anywhere };
    let mut list = DrawList::new(scene, resident, view, raster, choice, sweep);
    list.mask.extend(blend::back_to_front(resident, view));
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Draw, Mesh};
    use glam::Mat4;

    #[test]
    fn ids_count_on_over_draws_of_shared_meshes() {
        let mesh = |triangles: usize| Mesh { indices: vec![0; 3 * triangles], ..Mesh::default() };
        let draw = |mesh| Draw { mesh, world_from_object: Mat4::IDENTITY };
        let scene =
            Scene { meshes: vec![mesh(5), mesh(2)], draws: vec![draw(1), draw(0), draw(1)], ..Scene::default() };
        let primitives = Primitives::new(&scene).unwrap();
        assert_eq!(primitives.count, 9);
        // The second mesh's first triangle is the fifth of all indices.
        let id = |draw: u32, place: u32| primitives.id(draw, 3 * place);
        assert_eq!([id(0, 5), id(0, 6), id(1, 0), id(1, 4), id(2, 5), id(2, 6)], [0, 1, 2, 6, 7, 8]);
    }
}

//! Tangents for normal maps: MikkTSpace, which glTF 2.0 asks for where a file has none (section 3.7.2.1).

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace};
use glam::{Vec3, Vec4};

use crate::scene::{Mesh, Placement};

/// Tangents for every vertex, along the normal map where `placement` puts it; a vertex whose triangles disagree is split.
pub fn generate(mesh: &mut Mesh, placement: &Placement) {
    let mut corners = Corners { tangents: vec![Vec4::ZERO; mesh.indices.len()], mesh, placement };
    match bevy_mikktspace::generate_tangents(&mut corners) {
        Ok(()) => {}
        // The error type has no values: every mesh has tangents, if arbitrary ones where it has no area.
        Err(error) => unreachable!("{error}"),
    }
    let tangents = corners.tangents;
    split_vertices(mesh, &tangents);
    normalize(mesh);
}

/// Makes tangents unit length and perpendicular to their normals, and their sign +1 or -1.
pub fn normalize(mesh: &mut Mesh) {
    for (tangent, normal) in mesh.tangents.iter_mut().zip(&mesh.normals) {
        let direction = tangent.truncate();
        let unit = direction.try_normalize().and_then(|unit| (unit - *normal * normal.dot(unit)).try_normalize());
        let unit = unit.unwrap_or_else(|| normal.any_orthonormal_vector());
        *tangent = unit.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 });
    }
}

/// A mesh as MikkTSpace sees it: corners, not shared vertices.
struct Corners<'a> {
    mesh: &'a Mesh,
    placement: &'a Placement,
    /// One a corner.
    tangents: Vec<Vec4>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.indices[3 * face + corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangle_count()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let vertex = self.vertex(face, corner);
        let uvs_1 = self.mesh.uvs_1.get(vertex).copied().unwrap_or_default();
        let uv = self.placement.at([self.mesh.uvs[vertex], uvs_1]);
        // A finite coordinate times a finite scale may not be.
        if uv.is_finite() { uv.to_array() } else { [0.0; 2] }
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let Some(space) = space else { return };
        // MikkTSpace's bitangent follows increasing v, which in glTF runs down the picture; a normal map's green
        // points up it.
        let sign = if space.is_orientation_preserving() { -1.0 } else { 1.0 };
        self.tangents[3 * face + corner] = Vec3::from_array(space.tangent()).extend(sign);
    }
}

/// Gives each vertex the tangent of its first corner, and each further tangent at it a vertex of its own.
fn split_vertices(mesh: &mut Mesh, corner_tangents: &[Vec4]) {
    let mut first: Vec<Option<Vec4>> = vec![None; mesh.positions.len()];
    let mut further: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    mesh.tangents = vec![Vec4::ZERO; mesh.positions.len()];
    let mut indices = std::mem::take(&mut mesh.indices);
    for (index, tangent) in indices.iter_mut().zip(corner_tangents) {
        let vertex = *index as usize;
        match first[vertex] {
            None => {
                first[vertex] = Some(*tangent);
                mesh.tangents[vertex] = *tangent;
            }
            Some(known) if known == *tangent => {}
            Some(_) => {
                let key = (*index, tangent.to_array().map(f32::to_bits));
                *index = *further.entry(key).or_insert_with(|| {
                    let repeated = mesh.repeat_vertex(vertex);
                    mesh.tangents[repeated as usize] = *tangent;
                    repeated
                });
            }
        }
    }
    mesh.indices = indices;
}

#[cfg(test)]
mod tests {
    use glam::Vec2;
    use proptest::prelude::*;

    use super::*;

    /// Two triangles that share the edge between vertices 1 and 2; `uvs` as the picture lies on them.
    fn pair(uvs: [Vec2; 4]) -> Mesh {
        Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)],
            normals: vec![Vec3::Z; 4],
            uvs: uvs.to_vec(),
            indices: vec![0, 1, 2, 2, 1, 3],
            ..Mesh::default()
        }
    }

    #[test]
    fn an_upright_picture_has_u_along_x_and_its_bitangent_up() {
        let mut mesh = pair([Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::ZERO, Vec2::new(1.0, 0.0)]);
        generate(&mut mesh, &Placement::default());
        assert_eq!(mesh.tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
    }

    #[test]
    fn a_mirrored_half_gets_vertices_of_its_own() {
        // The second triangle runs back over the picture of the first.
        let mut mesh = pair([Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::ZERO, Vec2::new(0.0, 1.0)]);
        generate(&mut mesh, &Placement::default());
        assert_eq!(mesh.positions.len(), 6);
        assert_eq!(mesh.tangents.len(), 6);
        let signs: Vec<f32> = mesh.indices.iter().map(|index| mesh.tangents[*index as usize].w).collect();
        assert_eq!(signs, [1.0, 1.0, 1.0, -1.0, -1.0, -1.0]);
    }

    /// Coordinates whose differences and products vanish or overflow.
    fn extreme() -> impl Strategy<Value = f32> {
        prop::sample::select(vec![0.0, 1.0, -1.0, 0.5, 1e-30, -1e-45, 1e20, -3e38, f32::MAX])
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn any_finite_mesh_gets_whole_tangents(
            vertices in prop::collection::vec(prop::array::uniform5(extreme()), 6),
            indices in prop::collection::vec(0u32..6, 24),
        ) {
            let mut mesh = Mesh {
                positions: vertices.iter().map(|[x, y, z, ..]| Vec3::new(*x, *y, *z)).collect(),
                normals: [Vec3::X, Vec3::Y, Vec3::Z].repeat(2),
                uvs: vertices.iter().map(|[.., u, v]| Vec2::new(*u, *v)).collect(),
                indices,
                ..Mesh::default()
            };
            generate(&mut mesh, &Placement::default());
            prop_assert_eq!(mesh.tangents.len(), mesh.positions.len());
            for tangent in &mesh.tangents {
                prop_assert!((tangent.truncate().length() - 1.0).abs() < 1e-4 && tangent.w.abs() == 1.0, "{}", tangent);
            }
        }
    }

    #[test]
    fn without_uvs_or_area_tangents_are_still_unit_and_perpendicular() {
        let mut flat = pair([Vec2::ZERO; 4]);
        flat.positions[3] = Vec3::X;
        for scale in [1.0, 1e-20, 1e20, 3e38] {
            let mut mesh = flat.clone();
            mesh.positions.iter_mut().for_each(|position| *position *= scale);
            mesh.uvs[1] = Vec2::splat(scale);
            generate(&mut mesh, &Placement::default());
            for (tangent, normal) in mesh.tangents.iter().zip(&mesh.normals) {
                assert!((tangent.truncate().length() - 1.0).abs() < 1e-5, "{tangent}");
                assert!(tangent.truncate().dot(*normal).abs() < 1e-5, "{tangent}");
            }
        }
    }
}

//! glTF primitives to meshes: attributes read, indices made a triangle list, missing normals and tangents made.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3, Vec4};
use gltf::{Document, Semantic};
use rayon::prelude::*;

use super::attributes::{Attributes, Vertices, vectors};
use super::buffers::Buffers;
use super::deform::Deform;
use super::limits::Allowance;
use super::{accessors, label, parts, tangents, topology};
use crate::error::{Error, Result};
use crate::scene::gltf::normals::{corners, flat_normals, normalize_normals};
use crate::scene::{AlphaMode, Material, Mesh, TextureSlot, normal_groups};

/// How many indices the drawn meshes may have together beside one for each byte of the file: 1.4 million triangles,
/// 210 MiB where no two share a vertex.
const FREE_INDICES: usize = 1 << 22;

/// How many elements of attributes that are read whole, whatever triangles use of them (`is_packed`).
const FREE_ELEMENTS: usize = 1 << 24;

/// A primitive as a mesh, or a connected part of one that blends.
#[derive(Debug)]
pub struct Piece {
    pub mesh: Mesh,
    /// What bends it; None where no node shows it bent.
    pub deform: Option<Deform>,
}

/// Result of reading one primitive.
#[derive(Debug)]
enum Outcome {
    Piece {
        piece: Box<Piece>,
        left_over_indices: usize,
        repaired_normals: usize,
        clamped_colors: usize,
    },
    /// Points or lines.
    NotTriangles,
    /// A triangle mode without a whole triangle.
    Empty,
}

/// How nodes show a glTF mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshUse {
    /// Some node bends it: its morph targets are read.
    pub is_bent: bool,
    /// Some node gives it a skin: its joints and weights are read.
    pub is_skinned: bool,
}

/// Reads the glTF meshes `drawn`, in parallel; a primitive without a material appends glTF's default to `materials`.
/// Returns the pieces of each.
pub fn read(
    document: &Document,
    drawn: &BTreeMap<usize, MeshUse>,
    buffers: &Buffers<'_>,
    materials: &mut Vec<Material>,
    warnings: &mut Vec<String>,
) -> Result<BTreeMap<usize, Vec<Piece>>> {
    let jobs: Vec<gltf::Mesh<'_>> = document.meshes().filter(|mesh| drawn.contains_key(&mesh.index())).collect();
    let jobs: Vec<_> = jobs.iter().flat_map(|mesh| mesh.primitives().map(move |primitive| (mesh, primitive))).collect();
    check_total(&jobs, buffers)?;
    let default_material = materials.len();
    let outcomes: Vec<Result<Outcome>> = jobs
        .par_iter()
        .map(|(mesh, primitive)| {
            let material_index = primitive.material().index().unwrap_or(default_material);
            let plain = Material::default();
            let material = materials.get(material_index).unwrap_or(&plain);
            let shown = drawn[&mesh.index()];
            let mut outcome = read_primitive(document, buffers, mesh.index(), primitive, material, shown)
                .map_err(|error| error.within(primitive_label(mesh, primitive)))?;
            if let Outcome::Piece { piece, .. } = &mut outcome {
                piece.mesh.name = mesh_name(mesh, primitive.index());
                piece.mesh.material = material_index;
            }
            Ok(outcome)
        })
        .collect();

    let mut pieces: BTreeMap<usize, Vec<Piece>> = BTreeMap::new();
    let (mut not_triangles, mut left_over, mut repaired, mut clamped, mut weightless) = (0, 0, 0, 0, 0);
    // Taken in file order, so that of several broken primitives always the same one is reported.
    for ((mesh, _), outcome) in jobs.iter().zip(outcomes) {
        let of_mesh = pieces.entry(mesh.index()).or_default();
        match outcome? {
            Outcome::Piece { piece, left_over_indices, repaired_normals, clamped_colors } => {
                left_over += usize::from(left_over_indices > 0);
                repaired += repaired_normals;
                clamped += clamped_colors;
                let influences = piece.deform.as_ref().and_then(Deform::influences);
                weightless += influences.map_or(0, |influences| influences.weightless);
                let blends = materials.get(piece.mesh.material).is_some_and(|one| one.alpha == AlphaMode::Blend);
                // What bends has weights for the vertices in their order.
                if blends && piece.deform.is_none() {
                    of_mesh.extend(parts::split(piece.mesh).into_iter().map(|mesh| Piece { mesh, deform: None }));
                } else {
                    of_mesh.push(*piece);
                }
            }
            Outcome::NotTriangles => not_triangles += 1,
            Outcome::Empty => {}
        }
    }
    if pieces.values().flatten().any(|piece| piece.mesh.material == default_material) {
        materials.push(Material::default());
    }
    for (count, one, many) in [
        (not_triangles, "primitive of points or lines is left out", "primitives of points or lines are left out"),
        (
            left_over,
            "primitive ends with an incomplete triangle, left out",
            "primitives end with an incomplete triangle, left out",
        ),
        (
            repaired,
            "normal of length zero is replaced by its triangle's",
            "normals of length zero are replaced by their triangles'",
        ),
        (clamped, "vertex colour is clamped to 0 to 1", "vertex colours are clamped to 0 to 1"),
        (
            weightless,
            "vertex without joint weights follows its skin's first joint",
            "vertices without joint weights follow their skin's first joint",
        ),
    ] {
        if count > 0 {
            warnings.push(label::count(count, one, many));
        }
    }
    Ok(pieces)
}

fn primitive_label(mesh: &gltf::Mesh<'_>, primitive: &gltf::Primitive<'_>) -> String {
    format!("{}, primitive {}", label::element("mesh", mesh.index(), mesh.name()), primitive.index())
}

/// Refuses what would take more memory than any scene here is worth, before anything is read.
fn check_total(jobs: &[(&gltf::Mesh<'_>, gltf::Primitive<'_>)], buffers: &Buffers<'_>) -> Result<()> {
    let mut indices = Allowance::new("indices", FREE_INDICES, 1, buffers.file_bytes());
    let mut elements = Allowance::new("elements of sparse attributes", FREE_ELEMENTS, 1, buffers.file_bytes());
    for (mesh, primitive) in jobs {
        let packed = primitive.attributes().filter(|(_, accessor)| accessors::is_packed(accessor));
        let count = packed.fold(0usize, |sum, (_, accessor)| sum.saturating_add(accessor.count()));
        let spent = indices.spend(corners(primitive)).and_then(|()| elements.spend(count));
        spent.map_err(|error| error.within(primitive_label(mesh, primitive)))?;
    }
    Ok(())
}

/// The mesh's name, with the primitive's index where it has several.
fn mesh_name(mesh: &gltf::Mesh<'_>, primitive_index: usize) -> String {
    let name = mesh.name().map_or_else(|| format!("mesh {}", mesh.index()), str::to_owned);
    if mesh.primitives().len() > 1 { format!("{name}.{primitive_index}") } else { name }
}

fn read_primitive(
    document: &Document,
    buffers: &Buffers<'_>,
    mesh_index: usize,
    primitive: &gltf::Primitive<'_>,
    material: &Material,
    shown: MeshUse,
) -> Result<Outcome> {
    let normal_mapped = material.normal_texture.is_some();
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        return Err(Error::request("has no POSITION"));
    };
    let vertex_count = u32::try_from(positions.count())
        .map_err(|_| Error::request(format!("{} vertices are more than 32-bit indices can name", positions.count())))?;
    accessors::require_there(buffers, &positions).map_err(|error| error.within("POSITION"))?;
    let indices = match primitive.indices() {
        Some(accessor) => {
            accessors::indices(buffers, &accessor, positions.count()).map_err(|error| error.within("indices"))?
        }
        None => (0..vertex_count).collect(),
    };
    let Some(mut triangles) = topology::triangle_list(primitive.mode(), indices) else {
        return Ok(Outcome::NotTriangles);
    };
    if triangles.indices.is_empty() {
        return Ok(Outcome::Empty);
    }
    let corners = if shown.is_bent { triangles.indices.clone() } else { Vec::new() };
    let vertices = Vertices::used_by(&mut triangles.indices, positions.count());
    let read = Attributes { buffers, primitive, vertices };

    let positions = accessors::floats_at::<3>(buffers, &positions, read.vertices.picked.as_deref());
    let positions = positions.map_err(|error| error.within("POSITION"))?;
    let normals = read.attribute::<3>(&Semantic::Normals)?;
    let uvs = read.attribute::<2>(&Semantic::TexCoords(0))?;
    let (uvs_1, atlas) = match (material.reads_uvs_1(), read.attribute::<2>(&Semantic::TexCoords(1))) {
        (true, second) => {
            let uvs = second?.map_or_else(|| vec![Vec2::ZERO; positions.len()], |uvs| vectors(uvs, Vec2::from_array));
            (uvs, Vec::new())
        }
        // What no texture reads may be an atlas; where it is broken nothing is missing.
        (false, second) => (Vec::new(), vectors(second.ok().flatten().unwrap_or_default(), Vec2::from_array)),
    };
    let (colors, clamped_colors) = read.colors()?;
    // glTF 2.0, section 3.7.2.1: without normals the file's tangents mean nothing.
    let tangents = match normal_mapped && normals.is_some() {
        true => read.attribute::<4>(&Semantic::Tangents)?,
        false => None,
    };
    let mut mesh = Mesh {
        uvs: uvs.map_or_else(|| vec![Vec2::ZERO; positions.len()], |uvs| vectors(uvs, Vec2::from_array)),
        uvs_1,
        atlas,
        colors,
        positions: vectors(positions, Vec3::from_array),
        normals: vectors(normals.unwrap_or_default(), Vec3::from_array),
        tangents: vectors(tangents.unwrap_or_default(), Vec4::from_array),
        indices: triangles.indices,
        ..Mesh::default()
    };
    topology::drop_unused_vertices(&mut mesh);
    let repaired_normals = if mesh.normals.is_empty() {
        flat_normals(&mut mesh);
        0
    } else {
        normalize_normals(&mut mesh)
    };
    match (normal_mapped, mesh.tangents.is_empty()) {
        (true, true) => tangents::generate(&mut mesh, material.placement(TextureSlot::Normal)),
        (true, false) => tangents::normalize(&mut mesh),
        (false, _) => mesh.tangents = vec![Vec4::ZERO; mesh.positions.len()],
    }
    normal_groups::assign(&mut mesh);
    let deform = shown
        .is_bent
        .then(|| Deform::read(document, buffers, primitive, mesh_index, shown.is_skinned, &mesh, &corners));
    let deform = deform.transpose()?;
    let piece = Box::new(Piece { mesh, deform });
    Ok(Outcome::Piece { piece, left_over_indices: triangles.left_over, repaired_normals, clamped_colors })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::gltf::normals::triangle_normal;

    #[test]
    fn normals_are_made_unit_and_repaired_where_they_have_no_length() {
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
            normals: vec![Vec3::Z * 3.0, Vec3::ZERO, Vec3::Z],
            indices: vec![0, 1, 2],
            ..Mesh::default()
        };
        assert_eq!(normalize_normals(&mut mesh), 1);
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
    }

    #[test]
    fn a_triangle_of_any_size_has_a_normal() {
        for size in [1e-30, 1.0, 1e30] {
            assert_eq!(triangle_normal([Vec3::ZERO, Vec3::X * size, Vec3::Y * size]), Vec3::Z, "{size}");
        }
        assert_eq!(triangle_normal([Vec3::ONE; 3]), Vec3::Y);
    }
}

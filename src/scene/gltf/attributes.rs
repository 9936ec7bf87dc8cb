//! The attributes of a primitive's vertices: all of them, or where few are used only those.
//!
//! Files share one long vertex list among many primitives; reading all of it for each would take the square of its length.

use glam::{Vec3, Vec4};
use gltf::accessor::Dimensions;
use gltf::{Accessor, Semantic};

use super::accessors;
use super::buffers::Buffers;
use crate::error::Result;

/// Which vertices of a primitive are read.
#[derive(Debug, PartialEq)]
pub struct Vertices {
    /// How many the file has.
    pub count: usize,
    /// The used ones, ascending; None: all.
    pub picked: Option<Vec<u32>>,
}

impl Vertices {
    /// Those that `indices`, each below `count`, name; where they are fewer than `count`, `indices` become places among
    /// them.
    pub fn used_by(indices: &mut [u32], count: usize) -> Self {
        if indices.len() >= count {
            return Self { count, picked: None };
        }
        let mut used = indices.to_vec();
        used.sort_unstable();
        used.dedup();
        for index in indices {
            *index = used.partition_point(|vertex| vertex < index) as u32;
        }
        Self { count, picked: Some(used) }
    }
}

/// What attributes are read from, and at which vertices.
pub struct Attributes<'a> {
    pub buffers: &'a Buffers<'a>,
    pub primitive: &'a gltf::Primitive<'a>,
    pub vertices: Vertices,
}

impl Attributes<'_> {
    /// An optional attribute, which must have one element a vertex.
    ///
    /// Errors: another number of elements, or elements that cannot be read (exit code 2).
    pub fn attribute<const N: usize>(&self, semantic: &Semantic) -> Result<Option<Vec<[f32; N]>>> {
        let read = |accessor: Accessor<'_>| {
            accessors::require_count(&accessor, self.vertices.count)?;
            accessors::floats_at::<N>(self.buffers, &accessor, self.vertices.picked.as_deref())
        };
        self.primitive.get(semantic).map(read).transpose().map_err(|error| error.within(semantic.to_string()))
    }

    /// COLOR_0, RGB or RGBA, and how many of its colours were outside 0 to 1; empty where it is missing or white.
    ///
    /// Errors: as `attribute`.
    pub fn colors(&self) -> Result<(Vec<Vec4>, usize)> {
        let semantic = Semantic::Colors(0);
        let has_alpha = self.primitive.get(&semantic).is_some_and(|accessor| accessor.dimensions() == Dimensions::Vec4);
        let read = if has_alpha {
            self.attribute::<4>(&semantic)?.map(|colors| vectors(colors, Vec4::from_array))
        } else {
            let opaque = |rgb| Vec3::from_array(rgb).extend(1.0);
            self.attribute::<3>(&semantic)?.map(|colors| vectors(colors, opaque))
        };
        let mut colors = read.unwrap_or_default();
        let mut clamped_count = 0;
        for color in &mut colors {
            let clamped = color.clamp(Vec4::ZERO, Vec4::ONE);
            clamped_count += usize::from(clamped != *color);
            *color = clamped;
        }
        if colors.iter().all(|color| *color == Vec4::ONE) {
            colors.clear();
        }
        Ok((colors, clamped_count))
    }
}

/// Arrays as vectors.
pub fn vectors<const N: usize, V>(arrays: Vec<[f32; N]>, vector: fn([f32; N]) -> V) -> Vec<V> {
    arrays.into_iter().map(vector).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_vertices_of_many_are_picked_in_their_order() {
        let mut indices = [9, 2, 9, 2, 7, 9];
        let vertices = Vertices::used_by(&mut indices, 10);
        assert_eq!((vertices.picked, indices), (Some(vec![2, 7, 9]), [2, 0, 2, 0, 1, 2]));
        let mut indices = [2, 1, 0];
        assert_eq!(Vertices::used_by(&mut indices, 3), Vertices { count: 3, picked: None });
        assert_eq!(indices, [2, 1, 0]);
    }
}

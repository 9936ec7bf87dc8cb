//! Which vertices of a mesh stand in one place: neighbours are found by position, because what a file or a normal parts
//! (texture seams, creases, meshes without indices) is one surface all the same.

use glam::Vec3;
use rayon::prelude::*;

/// The places of a mesh's vertices, numbered from 0; the same positions always get the same numbers.
#[derive(Debug)]
pub struct Places {
    /// The place of each vertex.
    pub of_vertex: Vec<u32>,
    /// Vertices, place by place; ascending in each.
    vertices: Vec<u32>,
    /// Where each place begins in `vertices`, and where the last one ends.
    starts: Vec<u32>,
}

impl Places {
    /// Positions are one place where they are equal; -0 equals +0. In n log n.
    pub fn of(positions: &[Vec3]) -> Self {
        let keyed = positions.par_iter().zip(0u32..positions.len() as u32).map(|(position, vertex)| {
            // Adding +0 turns -0 into +0.
            ((*position + Vec3::ZERO).to_array().map(f32::to_bits), vertex)
        });
        let mut keyed: Vec<([u32; 3], u32)> = keyed.collect();
        keyed.par_sort_unstable();
        let mut places = Self { of_vertex: vec![0; positions.len()], vertices: Vec::new(), starts: Vec::new() };
        places.vertices.reserve_exact(positions.len());
        for (index, (key, vertex)) in keyed.iter().enumerate() {
            if index == 0 || keyed[index - 1].0 != *key {
                places.starts.push(index as u32);
            }
            places.of_vertex[*vertex as usize] = places.starts.len() as u32 - 1;
            places.vertices.push(*vertex);
        }
        places.starts.push(positions.len() as u32);
        places
    }

    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The vertices of each place.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|ends| &self.vertices[ends[0] as usize..ends[1] as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_are_one_place_and_both_zeros_are_one_number() {
        let positions = [Vec3::X, Vec3::new(-0.0, 1.0, 0.0), Vec3::X, Vec3::new(0.0, 1.0, -0.0), Vec3::Z];
        let places = Places::of(&positions);
        assert_eq!(places.count(), 3);
        let mut found: Vec<Vec<u32>> = places.iter().map(<[u32]>::to_vec).collect();
        for (place, vertices) in found.iter().enumerate() {
            assert!(vertices.iter().all(|vertex| places.of_vertex[*vertex as usize] as usize == place));
        }
        found.sort();
        assert_eq!(found, [vec![0, 2], vec![1, 3], vec![4]]);
        assert_eq!(Places::of(&[]).count(), 0);
    }
}

//! What a scene is put together from where it has a number of triangles to meet.
//!
//! Every piece divides its curves and faces by one edge length. A wanted number is met by searching that length; what then
//! is missing goes into a flat grid, which can take any number.

use glam::{DAffine3, Mat4};

use super::patch::{Patch, placed, triangle_count};

/// One mesh and where it stands.
pub struct Piece {
    pub name: &'static str,
    pub material: usize,
    pub patches: Vec<Patch>,
    pub places: Vec<Mat4>,
}

impl Piece {
    fn triangle_count(&self) -> u64 {
        triangle_count(&self.patches) * self.places.len() as u64
    }
}

/// How many triangles all draws of `pieces` have together.
pub fn count(pieces: &[Piece]) -> u64 {
    pieces.iter().map(Piece::triangle_count).sum()
}

/// The pieces that `made` gives for the shortest edge, metres between the two of `range_m`, at which they have at most
/// `most` triangles; for the longest edge where they have more even then.
pub fn divided(most: u64, range_m: [f64; 2], made: impl Fn(f64) -> Vec<Piece>) -> Vec<Piece> {
    let [mut too_fine_m, mut coarse_m] = range_m;
    for _ in 0..24 {
        let middle_m = (too_fine_m * coarse_m).sqrt();
        if count(&made(middle_m)) > most {
            too_fine_m = middle_m;
        } else {
            coarse_m = middle_m;
        }
    }
    made(coarse_m)
}

/// Columns and rows of a grid over `width_m` and `length_m` with about `triangles`, its cells about square.
pub fn grid([width_m, length_m]: [f64; 2], triangles: u64) -> [u32; 2] {
    let quads = (triangles / 2).max(1);
    let columns = ((quads as f64 * width_m / length_m).sqrt().round() as u64).max(1);
    [columns as u32, (quads / columns).max(1) as u32]
}

/// The same pieces in at most `most` draws, or in as many as there are pieces: copies of one piece are made one mesh where
/// they stand, as many as it takes, those of the fewest triangles first.
pub fn joined(mut pieces: Vec<Piece>, most: u64) -> Vec<Piece> {
    let draws: u64 = pieces.iter().map(|piece| piece.places.len() as u64).sum();
    let mut excess = draws.saturating_sub(most) as usize;
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|index| triangle_count(&pieces[*index].patches));
    for index in order {
        let Piece { name, material, ref patches, ref mut places } = pieces[index];
        let count = (excess + 1).min(places.len());
        if count < 2 {
            continue;
        }
        excess -= count - 1;
        let together =
            places.drain(..count).flat_map(|place| placed(patches.clone(), DAffine3::from_mat4(place.as_dmat4())));
        let patches = together.collect();
        pieces.push(Piece { name, material, patches, places: vec![Mat4::IDENTITY] });
    }
    pieces.retain(|piece| !piece.places.is_empty());
    pieces
}

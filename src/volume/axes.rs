//! From the axes of a file to those of the world.

use super::voxels::{Voxels, room};
use crate::error::Result;

/// Where an axis of a file leads in the world: along its x, y or z (0 to 2), or the other way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    pub axis: usize,
    pub is_back: bool,
}

/// Left, posterior, superior: the patient's left is x as one sees him, his back is away, his head is up.
pub const LPS: [Way; 3] =
    [Way { axis: 0, is_back: false }, Way { axis: 2, is_back: true }, Way { axis: 1, is_back: false }];

/// What `of_file` has along each axis of a file, along each of the world's.
pub fn in_world<T: Copy>(of_file: [T; 3], ways: [Way; 3]) -> [T; 3] {
    let mut of_world = of_file;
    ways.iter().zip(of_file).for_each(|(way, along)| of_world[way.axis] = along);
    of_world
}

/// Voxels of a file, its first axis fastest, in the world's order. `size`: along the file's axes.
///
/// Errors: no memory for them (exit code 4).
pub fn turned(voxels: Voxels, size: [u32; 3], ways: [Way; 3]) -> Result<Voxels> {
    Ok(match voxels {
        Voxels::U8(values) => Voxels::U8(values_turned(&values, size, ways)?),
        Voxels::U16(values) => Voxels::U16(values_turned(&values, size, ways)?),
        Voxels::F32(values) => Voxels::F32(values_turned(&values, size, ways)?),
    })
}

fn values_turned<T: Copy>(values: &[T], size: [u32; 3], ways: [Way; 3]) -> Result<Vec<T>> {
    let size = size.map(|side| side as usize);
    let strides = [1, size[0], size[0] * size[1]];
    let [width, height, depth] = in_world(size, ways);
    // By the world's axis: the file's stride along it, its length, and whether it is run through backwards.
    let runs = in_world([0, 1, 2].map(|axis| (strides[axis], size[axis], ways[axis].is_back)), ways);
    let at = |axis: usize, index: usize| {
        let (stride, length, is_back) = runs[axis];
        stride * if is_back { length - 1 - index } else { index }
    };
    let mut turned = room(values.len())?;
    for z in 0..depth {
        for y in 0..height {
            let row = at(2, z) + at(1, y);
            turned.extend((0..width).map(|x| values[row + at(0, x)]));
        }
    }
    Ok(turned)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One voxel that is marked comes to where its axes lead, whatever these are.
    #[test]
    fn a_marked_voxel_is_where_its_axes_lead() {
        let size = [4u32, 3, 5];
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        for order in orders {
            for flips in 0..8 {
                let ways = [0, 1, 2].map(|axis| Way { axis: order[axis], is_back: flips >> axis & 1 == 1 });
                let marked = [3usize, 1, 2];
                let mut values = vec![0u8; 60];
                values[(marked[2] * 3 + marked[1]) * 4 + marked[0]] = 1;
                let Voxels::U8(turned) = turned(Voxels::U8(values), size, ways).unwrap() else { unreachable!() };
                let world = in_world(size, ways).map(|side| side as usize);
                let found = turned.iter().position(|value| *value == 1).unwrap();
                let found = [found % world[0], found / world[0] % world[1], found / world[0] / world[1]];
                for (axis, way) in ways.iter().enumerate() {
                    let last = size[axis] as usize - 1;
                    let expected = if way.is_back { last - marked[axis] } else { marked[axis] };
                    assert_eq!(found[way.axis], expected, "{ways:?}");
                }
            }
        }
    }
}

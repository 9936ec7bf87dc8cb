//! The values of a volume in their box.

use super::voxels::Voxels;
use crate::error::{Error, Result};

/// The longest side: no device has three-dimensional images beyond it.
const MOST_SIDE: u64 = 16384;

/// Values on a grid, in a box whose corners are the middles of its corner voxels.
#[derive(Clone, Debug)]
pub struct Volume {
    /// As it was asked for: a built-in name with its parameters, or a path.
    pub name: String,
    /// BLAKE3, in hexadecimal, of values, size and spacing.
    pub hash: String,
    /// Voxels along the world's x, y and z, each at least 2.
    pub size: [u32; 3],
    /// From one voxel to the next along x, y and z, each above 0; only their ratios count.
    pub spacing: [f32; 3],
    /// x changes fastest, then y.
    pub voxels: Voxels,
    /// The least and the greatest value; the same one where all are.
    pub range: [f32; 2],
}

impl Volume {
    /// A volume of values in the world's order.
    ///
    /// Errors: a side is below 2 or beyond `MOST_SIDE`, a spacing is not above 0, a value is no number (exit code 2).
    pub(super) fn new(size: [u32; 3], spacing: [f32; 3], voxels: Voxels) -> Result<Self> {
        require_sides(size.map(u64::from))?;
        if !spacing.iter().all(|along| along.is_finite() && *along > 0.0) {
            return Err(Error::request(format!("{spacing:?} from one voxel to the next: each must be above 0")));
        }
        let range = voxels.range()?;
        let mut hasher = blake3::Hasher::new();
        hasher.update(voxels.bytes());
        hasher.update(bytemuck::cast_slice(&size));
        hasher.update(bytemuck::cast_slice(&spacing));
        let hash = hasher.finalize().to_hex().to_string();
        Ok(Self { name: String::new(), hash, size, spacing, voxels, range })
    }
}

/// Errors: a side is below 2 or beyond `MOST_SIDE` (exit code 2).
pub(super) fn require_sides(size: [u64; 3]) -> Result<()> {
    match size.iter().all(|side| (2..=MOST_SIDE).contains(side)) {
        true => Ok(()),
        false => {
            let [width, height, depth] = size;
            Err(Error::request(format!("{width}x{height}x{depth} voxels: each side must be 2 to {MOST_SIDE}")))
        }
    }
}

//! The values of a volume, as wide as its file has them.

use crate::error::{Error, Result};
use crate::units::Bytes;

/// Values, one a voxel.
#[derive(Clone, Debug, PartialEq)]
pub enum Voxels {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

impl Voxels {
    /// As they lie in memory.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::U8(values) => values,
            Self::U16(values) => bytemuck::cast_slice(values),
            Self::F32(values) => bytemuck::cast_slice(values),
        }
    }

    /// The least and the greatest.
    ///
    /// Errors: one is not a finite number, which is named by its place among all (exit code 2).
    pub(super) fn range(&self) -> Result<[f32; 2]> {
        fn ends<T: Copy + Ord + Into<f32>>(values: &[T]) -> [f32; 2] {
            let ends = [values.iter().min(), values.iter().max()];
            ends.map(|end| end.map_or(0.0, |value| (*value).into()))
        }
        match self {
            Self::U8(values) => Ok(ends(values)),
            Self::U16(values) => Ok(ends(values)),
            Self::F32(values) => {
                if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                    return Err(Error::request(format!("voxel {index} is {}: values must be finite", values[index])));
                }
                Ok(values.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[least, most], value| {
                    [least.min(*value), most.max(*value)]
                }))
            }
        }
    }
}

/// Room for `count` values.
///
/// Errors: there is none (exit code 4).
pub(super) fn room<T>(count: usize) -> Result<Vec<T>> {
    let mut values = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>()) as u64;
    values.try_reserve_exact(count).map_err(|_| Error::memory(format!("{} of voxels do not fit", Bytes(bytes))))?;
    Ok(values)
}

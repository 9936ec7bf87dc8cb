//! How large a picture may be that is read.

use crate::error::{Error, Result};
use crate::units::{Bytes, Extent};
use std::fmt::Display;
use std::path::Path;

/// The largest side of a picture that is read, in pixels: the largest image a Vulkan driver of today makes.
pub const SIDE_LIMIT_PX: u32 = 32768;

/// The most bytes that a picture may take when decoded: a header of a few bytes must not claim the machine's memory.
pub const DECODED_LIMIT: Bytes = Bytes(2 << 30);

/// What a file's header claims, held against the limits before anything is allocated by it.
pub fn require_within_limits(path: &Path, width: u64, height: u64) -> Result<Extent> {
    let decoded = Bytes(width.saturating_mul(height).saturating_mul(size_of::<[f32; 3]>() as u64));
    let side_limit = u64::from(SIDE_LIMIT_PX);
    if width == 0 || height == 0 || width > side_limit || height > side_limit || decoded > DECODED_LIMIT {
        return Err(unreadable(
            path,
            &format!(
                "{width}x{height}: a side has 1 to {SIDE_LIMIT_PX} pixels, a decoded picture at most {DECODED_LIMIT}"
            ),
        ));
    }
    Ok(Extent::new(width as u32, height as u32))
}

pub fn unreadable(path: &Path, cause: &dyn Display) -> Error {
    Error::request(format!("cannot read {}: {cause}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_held_against_the_limits() {
        let path = Path::new("a.png");
        assert!(require_within_limits(path, 32768, 1).is_ok());
        for (width, height) in [(0, 4), (32769, 1), (32768, 32768), (u64::MAX, u64::MAX)] {
            assert!(require_within_limits(path, width, height).is_err(), "{width}x{height}");
        }
    }
}

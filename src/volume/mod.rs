//! Volumes: scalar values on a grid, from a file or a formula, and the functions that turn values into light. No Vulkan.
//!
//! A volume stands in the world with its x, y and z axes, y up. Files of scanned heads and bodies have their axes to the
//! patient's left, to the back and up, in this order (DICOM's and ITK's LPS): they become x, -z and y, so that a face looks to
//! +z, where cameras stand.

mod axes;
mod nrrd;
mod raw;
mod signals;
mod transfer;
mod voxels;

pub use transfer::Transfer;
pub use voxels::Voxels;

use crate::error::{Error, Result};
use std::path::Path;

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

/// What is asked for.
pub struct VolumeRequest<'a> {
    /// `marschner-lobb`, `head`, either with parameters after a colon, or the path of a file.
    pub spec: &'a str,
    /// Voxels along the axes of a file without a header, the axis that changes fastest first.
    pub raw_size: Option<[u32; 3]>,
    /// What is random of a built-in volume.
    pub seed: u64,
}

/// The volume that is asked for.
///
/// Errors: there is no such built-in volume or file, a file is broken or of a kind that is not read (exit code 2); memory
/// (4).
pub fn open(request: &VolumeRequest<'_>) -> Result<Volume> {
    let VolumeRequest { spec, raw_size, seed } = *request;
    if let Some(made) = signals::open(spec, seed) {
        return made;
    }
    let path = Path::new(spec);
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_lowercase();
    let read = match (extension.as_str(), raw_size) {
        ("nrrd" | "nhdr", None) => nrrd::open(path),
        ("nrrd" | "nhdr", Some(_)) => Err(Error::request("its header says how many voxels it has")
            .note("--volume-size is for files without a header")),
        (_, Some(size)) => raw::open(path, size),
        (_, None) => Err(Error::request("neither a built-in volume nor a file that says how many voxels it has").note(
            "marschner-lobb and head are built in; .nrrd and .nhdr files have a header; --volume-size WxHxD reads others as raw",
        )),
    };
    read.map_err(|error| error.within(format!("volume {spec}")))
        .map(|volume| Volume { name: spec.to_owned(), ..volume })
}

impl Volume {
    /// A volume of values in the world's order.
    ///
    /// Errors: a side is below 2 or beyond `MOST_SIDE`, a spacing is not above 0, a value is no number (exit code 2).
    fn new(size: [u32; 3], spacing: [f32; 3], voxels: Voxels) -> Result<Self> {
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
fn require_sides(size: [u64; 3]) -> Result<()> {
    match size.iter().all(|side| (2..=MOST_SIDE).contains(side)) {
        true => Ok(()),
        false => {
            let [width, height, depth] = size;
            Err(Error::request(format!("{width}x{height}x{depth} voxels: each side must be 2 to {MOST_SIDE}")))
        }
    }
}

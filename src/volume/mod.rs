//! Volumes: scalar values on a grid, from a file or a formula, and the functions that turn values into light. No Vulkan.
//!
//! A volume stands in the world with its x, y and z axes, y up. Files of scanned heads and bodies have their axes to the
//! patient's left, to the back and up, in this order (DICOM's and ITK's LPS): they become x, -z and y, so that a face looks to
//! +z, where cameras stand.

mod axes;
mod field;
mod nrrd;
mod raw;
mod signals;
mod transfer;
mod voxels;

pub use field::Volume;
pub use transfer::Transfer;
pub use voxels::Voxels;

use crate::error::{Error, Result};
use std::path::Path;

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

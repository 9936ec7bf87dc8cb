//! How near pictures must be, and the settings that several groups of cases share.

use crate::selftest::case::Settings;
use crate::selftest::judge::{Bounds, Must};

/// Two shaders that say the same, on a device whose compiler may round each in its way.
pub const ROUNDING: Bounds = Bounds {
    apart: 0.005,
    rmse: 0.02,
    flip: 0.005,
    mean: 0.004,
    why: "equal where each step is rounded alike; compilers of GPUs fuse and reorder, which moves a few pixels along \
          edges",
};

/// The same where rays choose what comes next: one that grazes an edge takes all of a path with it.
pub const PATHS: Bounds = Bounds {
    apart: 0.03,
    rmse: 0.1,
    flip: 0.02,
    mean: 0.03,
    why: "equal where each step is rounded alike; a ray that grazes an edge takes its whole path with it, and paths \
          are few",
};

/// The same shaders on the same numbers: only when and where they run is another.
pub const SAME: Must = Must::Same { why: "the same shaders on the same numbers, once more or in other bytes" };

/// Made once more, which finds races, and with bytes that are shared otherwise.
pub const AGAIN: &[Settings] = &[&[], &[("alias", "off")], &[("alias", "optimal")]];

/// A submit for each piece of work, and for as many as there are.
pub const CUT: &[Settings] = &[&[("submit-ms", "0.001")], &[("submit-ms", "1000000")]];

pub const WHOLE: Settings = &[("submit-ms", "0")];

pub const EVERYTHING: Settings = &[("geometry", "all")];

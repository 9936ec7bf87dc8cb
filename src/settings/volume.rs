//! The rows of a volume: which one, where it stands, and how its values become light.

use super::{Changes, Kind, Part, Setting, Unread, Values};
use crate::error::{Error, Result};

/// The word for no volume.
const NONE: &str = "none";

const SIZE: &str = "volume-size";
/// The word for the size that a file has in its header.
const BY_HEADER: &str = "header";

/// Which volume there is.
pub const VOLUME: Setting = Setting {
    key: "volume",
    kind: Kind::Text("FILE|marschner-lobb|head|none"),
    default: NONE,
    paper: "Keller 2001, 3.3",
    help: "Values on a grid that emit and absorb light in the scene: an NRRD file (.nrrd, .nhdr), raw voxels with \
           --volume-size, or a built-in one, marschner-lobb or head, with parameters after a colon (head:size=128)",
    ..Setting::changing(Changes::Picture)
};

/// What the rows after it have in common.
const OF_VOLUME: Setting = Setting {
    unread: |values| Unread::with(values, VOLUME.key, &[NONE], "there is no volume"),
    ..Setting::changing(Changes::Picture)
};

/// How it stands in the scene and shines; nothing reads these rows without a volume.
pub const VOLUME_PLACE: &[Setting] = &[
    Setting {
        key: SIZE,
        kind: Kind::Text("WxHxD|header"),
        default: BY_HEADER,
        unit: "voxels",
        help: "Voxels of a raw file along its axes, the first of which is the nearest in the file; its bytes a voxel say \
               whether they are u8, little-endian u16 or f32; header: the file says it itself, as NRRD does",
        ..OF_VOLUME
    },
    Setting {
        key: "transfer",
        kind: Kind::Text("ramp|heat|tissue|shells|FILE"),
        default: "ramp",
        paper: "Keller 2001, 3.3",
        help: "Colour and extinction by value: a built-in function, or a text file with a line \
               VALUE RED GREEN BLUE EXTINCTION for each point, values from 0 to 1, extinction as optical depth over the \
               volume's longest side",
        ..OF_VOLUME
    },
    Setting {
        key: "volume-window",
        kind: Kind::Parts(&[Part { word: "LEAST", min: -1e9, max: 1e9 }, Part { word: "MOST", min: -1e9, max: 1e9 }]),
        auto: true,
        default: "auto",
        help: "Values of the volume that are 0 and 1 to --transfer; auto: its least and its greatest",
        ..OF_VOLUME
    },
    Setting {
        key: "volume-density",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        default: "1",
        help: "Factor of the extinction of --transfer",
        ..OF_VOLUME
    },
    Setting {
        key: "volume-length",
        kind: Kind::Number { min: 1e-6, max: 1e6 },
        auto: true,
        default: "auto",
        unit: "m",
        help: "Longest side of the volume's box, from the middle of its first voxel to that of its last; auto: as long as \
               the box, unturned, fits into the scene's",
        ..OF_VOLUME
    },
    Setting {
        key: "volume-at",
        kind: Kind::Parts(&[
            Part { word: "X", min: -1e9, max: 1e9 },
            Part { word: "Y", min: -1e9, max: 1e9 },
            Part { word: "Z", min: -1e9, max: 1e9 },
        ]),
        auto: true,
        default: "auto",
        unit: "m",
        help: "Middle of the volume's box in the world; auto: the middle of the scene",
        ..OF_VOLUME
    },
    Setting {
        key: "volume-turn",
        kind: Kind::Number { min: -360.0, max: 360.0 },
        default: "0",
        unit: "degrees",
        help: "Turn of the volume about the upright through its middle, counterclockwise as seen from above",
        ..OF_VOLUME
    },
];

/// The name of the volume that these settings ask for, by a technique that draws volumes.
pub fn volume_name(values: &Values) -> Option<&str> {
    values.get(VOLUME.key).filter(|text| *text != NONE)
}

/// Voxels of a raw file along its axes; None: the file says it itself.
///
/// Errors: it is no `WxHxD`, each at least 2 (exit code 2).
pub fn raw_volume_size(values: &Values) -> Result<Option<[u32; 3]>> {
    let text = values.text(SIZE);
    if text == BY_HEADER {
        return Ok(None);
    }
    let sides: Option<Vec<u32>> = text.split('x').map(|side| side.parse().ok().filter(|side| *side >= 2)).collect();
    let sides = sides.and_then(|sides| sides.try_into().ok());
    sides.map(Some).ok_or_else(|| {
        Error::request(format!("--{SIZE} {text}: it must be WxHxD, each at least 2, or {BY_HEADER}"))
            .note("--volume-size 256x256x109 is 256 voxels along the first two axes and 109 along the third")
    })
}

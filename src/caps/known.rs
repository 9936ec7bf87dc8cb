//! Known drivers as data: `assets/caps/`, one file each. A plan reads them where there is no device.

use super::Caps;
use crate::error::{Error, Result};

/// Name and file of each.
macro_rules! known {
    ($($name:literal),+) => { &[$(($name, include_str!(concat!("../../assets/caps/", $name, ".json")))),+] };
}

/// What the files say, and from where: assets/caps/README.md.
const KNOWN: &[(&str, &str)] = known!(
    "lavapipe-22.3.6",
    "lavapipe-25.0.7",
    "swiftshader",
    "amd-polaris10",
    "amd-navi21",
    "intel-arc-a770",
    "intel-iris-xe",
    "nvidia-h200",
    "nvidia-rtx-2070",
    "tiler-roadmap-2022",
    "least-1.3"
);

/// The caps that a plan without a device has where `--caps` names none.
pub const DEFAULT: &str = "lavapipe-22.3.6";

/// What Vulkan 1.3 promises of every device, and no more.
pub const LEAST: &str = "least-1.3";

/// Every name that `caps` knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|(name, _)| *name)
}

/// The caps of a known driver, with the rules by which it rounds sizes up where they were measured.
///
/// Errors: no driver has this name (exit code 2).
pub fn caps(name: &str) -> Result<Caps> {
    let found = KNOWN.iter().find(|(known, _)| *known == name);
    let (_, text) = found.ok_or_else(|| {
        Error::request(format!("--caps {name}: no driver of this name is known"))
            .note(format!("there are {}", names().collect::<Vec<_>>().join(", ")))
            .note("the path of a file that `quincunx devices --json` has printed works too")
    })?;
    Ok(serde_json::from_str(text).expect("a test reads every file of assets/caps"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_known_driver_can_be_read_and_software_says_how_it_rounds() {
        for name in names() {
            let caps = caps(name).unwrap();
            assert_eq!(caps.layout.is_some(), caps.identity.is_software(), "{name}");
        }
        assert_eq!(caps("voodoo").unwrap_err().exit_code(), 2);
        assert!([DEFAULT, LEAST].iter().all(|special| names().any(|name| name == *special)));
    }

    /// Each name has one file, each file is read and names its source.
    #[test]
    fn every_file_is_known_and_says_where_it_is_from() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/caps");
        let sources = std::fs::read_to_string(folder.join("README.md")).unwrap();
        for entry in std::fs::read_dir(&folder).unwrap() {
            let file = entry.unwrap().file_name().into_string().unwrap();
            let Some(name) = file.strip_suffix(".json") else { continue };
            assert!(names().any(|known| known == name), "{file} is not known");
        }
        for name in names() {
            assert!(sources.contains(&format!("`{name}`")), "README.md does not say where {name} is from");
        }
    }

    /// What data from before a limit was looked up gets is what Vulkan promises.
    #[test]
    fn older_files_have_the_least() {
        let least = caps(LEAST).unwrap();
        let mut older = serde_json::to_value(caps(DEFAULT).unwrap()).unwrap();
        let keys = [
            "max_viewport_px",
            "max_framebuffer_px",
            "max_image_layers",
            "max_volume_side_px",
            "max_uniform_buffer_range_bytes",
            "max_shared_memory_bytes",
            "max_storage_buffers_per_stage",
            "max_storage_images_per_stage",
            "sub_pixel_bits",
            "max_framebuffer_layers",
        ];
        for key in keys {
            older["limits"].as_object_mut().unwrap().remove(key).unwrap();
        }
        let older: Caps = serde_json::from_value(older).unwrap();
        let [older, least] = [older, least].map(|caps| serde_json::to_value(caps.limits).unwrap());
        for key in keys {
            assert_eq!(older[key], least[key], "{key}");
        }
    }
}

//! Known drivers as data: `assets/caps/`, one file each. A plan reads them where there is no device.

use super::Caps;
use crate::error::{Error, Result};

/// Name and file of each.
const KNOWN: &[(&str, &str)] = &[
    ("lavapipe-22.3.6", include_str!("../../assets/caps/lavapipe-22.3.6.json")),
    ("lavapipe-25.0.7", include_str!("../../assets/caps/lavapipe-25.0.7.json")),
    ("swiftshader", include_str!("../../assets/caps/swiftshader.json")),
];

/// The caps that a plan without a device has where `--caps` names none.
pub const DEFAULT: &str = "lavapipe-22.3.6";

/// Every name that `caps` knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    KNOWN.iter().map(|(name, _)| *name)
}

/// The caps of a known driver, with the rules by which it rounds sizes up.
///
/// Errors: no driver has this name (exit code 2).
pub fn caps(name: &str) -> Result<Caps> {
    let found = KNOWN.iter().find(|(known, _)| *known == name);
    let (_, text) = found.ok_or_else(|| {
        Error::request(format!("--caps {name}: no driver of this name is known"))
            .note(format!("there are {}", names().collect::<Vec<_>>().join(", ")))
    })?;
    Ok(serde_json::from_str(text).expect("a test reads every file of assets/caps"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_known_driver_can_be_read_and_says_how_it_rounds() {
        for name in names() {
            let caps = caps(name).unwrap();
            assert!(caps.layout.is_some() && !caps.memory_types.is_empty(), "{name}");
        }
        assert_eq!(caps("voodoo").unwrap_err().exit_code(), 2);
        assert!(names().any(|name| name == DEFAULT));
    }
}

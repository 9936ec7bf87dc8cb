//! Where the user has what was long in the making kept.

use std::ffi::OsString;
use std::path::PathBuf;

/// The user's folder: QUINCUNX_CACHE, or quincunx in XDG_CACHE_HOME, or ~/.cache/quincunx; it need not exist. None where none of the
/// variables is set.
pub fn of_user() -> Option<PathBuf> {
    named(|name| std::env::var_os(name))
}

/// The first of the places that is named; an empty or, of XDG's, a relative name is none (XDG Base Directory
/// Specification).
fn named(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let named = |name: &str| variable(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    named("QUINCUNX_CACHE")
        .or_else(|| Some(named("XDG_CACHE_HOME").filter(|path| path.is_absolute())?.join("quincunx")))
        .or_else(|| Some(named("HOME")?.join(".cache/quincunx")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_users_folder_is_the_first_that_is_named() {
        let of = |set: &[(&str, &str)]| {
            let found = named(|name| set.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into()));
            found.map(|path| path.to_str().unwrap().to_owned())
        };
        let (own, xdg, home) = (("QUINCUNX_CACHE", "own"), ("XDG_CACHE_HOME", "/xdg"), ("HOME", "/home/me"));
        assert_eq!(of(&[own, xdg, home]).unwrap(), "own");
        assert_eq!(of(&[xdg, home]).unwrap(), "/xdg/quincunx");
        assert_eq!(of(&[home]).unwrap(), "/home/me/.cache/quincunx");
        assert_eq!(of(&[("XDG_CACHE_HOME", "relative"), home]).unwrap(), "/home/me/.cache/quincunx");
        assert_eq!(of(&[("QUINCUNX_CACHE", ""), xdg]).unwrap(), "/xdg/quincunx");
        assert_eq!(of(&[]), None);
    }
}

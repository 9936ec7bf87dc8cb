//! What is the user's own: where what was long in the making is kept, and the file of the user's defaults.

use std::ffi::OsString;
use std::path::PathBuf;

type Variable<'a> = &'a dyn Fn(&str) -> Option<OsString>;

/// The user's cache: QUINCUNX_CACHE, or quincunx in XDG_CACHE_HOME, or ~/.cache/quincunx; it need not exist. None where none of the
/// variables is set.
pub fn cache() -> Option<PathBuf> {
    cache_of(&|name| std::env::var_os(name))
}

/// The file of the user's defaults: QUINCUNX_DEFAULTS, or quincunx/defaults.toml in XDG_CONFIG_HOME or ~/.config. None where it is not
/// there, or QUINCUNX_DEFAULTS is set and empty; a file that QUINCUNX_DEFAULTS names need not exist.
pub fn defaults() -> Option<PathBuf> {
    defaults_of(&|name| std::env::var_os(name))
}

fn cache_of(variable: Variable<'_>) -> Option<PathBuf> {
    named("QUINCUNX_CACHE", variable).or_else(|| Some(base("XDG_CACHE_HOME", ".cache", variable)?.join("quincunx")))
}

fn defaults_of(variable: Variable<'_>) -> Option<PathBuf> {
    match variable("QUINCUNX_DEFAULTS") {
        Some(_) => named("QUINCUNX_DEFAULTS", variable),
        None => {
            let path = base("XDG_CONFIG_HOME", ".config", variable)?.join("quincunx/defaults.toml");
            path.exists().then_some(path)
        }
    }
}

fn named(name: &str, variable: Variable<'_>) -> Option<PathBuf> {
    variable(name).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// A folder of XDG's, or `below` in the user's; an empty or a relative name of XDG's is none (XDG Base Directory Specification).
fn base(name: &str, below: &str, variable: Variable<'_>) -> Option<PathBuf> {
    let absolute = named(name, variable).filter(|path| path.is_absolute());
    absolute.or_else(|| Some(named("HOME", variable)?.join(below)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(of: fn(Variable<'_>) -> Option<PathBuf>, set: &[(&str, &str)]) -> Option<String> {
        let found = of(&|name| set.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into()));
        found.map(|path| path.to_str().unwrap().to_owned())
    }

    #[test]
    fn the_cache_is_the_first_folder_that_is_named() {
        let of = |set: &[(&str, &str)]| found(cache_of, set);
        let (own, xdg, home) = (("QUINCUNX_CACHE", "own"), ("XDG_CACHE_HOME", "/xdg"), ("HOME", "/home/me"));
        assert_eq!(of(&[own, xdg, home]).unwrap(), "own");
        assert_eq!(of(&[xdg, home]).unwrap(), "/xdg/quincunx");
        assert_eq!(of(&[home]).unwrap(), "/home/me/.cache/quincunx");
        assert_eq!(of(&[("XDG_CACHE_HOME", "relative"), home]).unwrap(), "/home/me/.cache/quincunx");
        assert_eq!(of(&[("QUINCUNX_CACHE", ""), xdg]).unwrap(), "/xdg/quincunx");
        assert_eq!(of(&[]), None);
    }

    #[test]
    fn defaults_are_those_that_are_there_unless_others_or_none_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let home = folder.path().to_str().unwrap();
        let of = |set: &[(&str, &str)]| found(defaults_of, set);
        assert_eq!(of(&[("HOME", home)]), None);
        let file = folder.path().join(".config/quincunx/defaults.toml");
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        std::fs::write(&file, "").unwrap();
        assert_eq!(of(&[("HOME", home)]).unwrap(), file.to_str().unwrap());
        assert_eq!(of(&[("HOME", home), ("QUINCUNX_DEFAULTS", "")]), None);
        assert_eq!(of(&[("HOME", home), ("QUINCUNX_DEFAULTS", "mine.toml")]).unwrap(), "mine.toml");
        assert_eq!(of(&[("HOME", home), ("XDG_CONFIG_HOME", "/nowhere")]), None);
    }
}

//! Files that are written whole or not at all.
//!
//! The bytes go into a temporary file in the same folder (a rename across file systems would be a copy) and take the
//! asked name when they are all on disk. A failure leaves the earlier file.

use serde::de::DeserializeOwned;
use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Calls `write` with a fresh file, then gives that file the name `path`; an older file of that name is replaced.
///
/// Fails as a bad request that names `path` and the cause: the folder is missing or closed, `path` is no regular file, the
/// disk is full, or `write` failed. `path` is then as it was.
pub fn write_whole<E: Display>(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>) -> Result<()> {
    let failed = |cause: &dyn Display| Error::request(format!("cannot write {}: {cause}", path.display()));
    match path.metadata() {
        Ok(found) if found.is_dir() => return Err(failed(&"it is a folder; name a file in it")),
        // A rename would put a file in the place of a device such as /dev/null.
        Ok(found) if !found.is_file() => return Err(failed(&"it is not a regular file")),
        _ => {}
    }
    // A link keeps pointing where it points: its target is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        Some(_) => Path::new("."),
        None => return Err(failed(&"it names no file")),
    };
    if !folder.is_dir() {
        return Err(failed(&format!("there is no folder {}", folder.display())));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".quincunx-");
    // A temporary file is its owner's alone; a result has the rights of any new file (the umask still counts).
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let fresh = builder.tempfile_in(folder).map_err(|error| failed(&error))?;
    let (file, fresh_path) = fresh.into_parts();
    let mut buffered = BufWriter::new(file);
    write(&mut buffered).map_err(|error| failed(&error))?;
    buffered.flush().map_err(|error| failed(&error))?;
    // Some file systems report a full disk only here.
    buffered.get_ref().sync_all().map_err(|error| failed(&error))?;
    fresh_path.persist(&target).map_err(|error| failed(&error.error))
}

/// Makes a folder, and those above it, where it is not there.
///
/// Errors: it cannot be made (exit code 2).
pub fn make_folder(path: &Path) -> Result<()> {
    std::fs::create_dir_all(path)
        .map_err(|error| Error::request(format!("cannot make the folder {}: {error}", path.display())))
}

/// A document of ours has some kilobytes.
const MAX_DOCUMENT_BYTES: u64 = 64 << 20;

/// The text of a document that this program writes.
///
/// Errors: it cannot be read, or is longer than any of ours (exit code 2).
pub fn read_document(path: &Path) -> Result<String> {
    let failed = |why: &dyn Display| Error::request(format!("cannot read {}: {why}", path.display()));
    let bytes = path.metadata().map_err(|error| failed(&error))?.len();
    if bytes > MAX_DOCUMENT_BYTES {
        return Err(failed(&format!("it has {bytes} bytes; up to {MAX_DOCUMENT_BYTES} are read")));
    }
    std::fs::read_to_string(path).map_err(|error| failed(&error))
}

/// A document of TOML that a user writes.
///
/// Errors: as `read_document`; it is not what a `T` is read from (exit code 2), with the line.
pub fn read_toml<T: DeserializeOwned>(path: &Path) -> Result<T> {
    let text = read_document(path)?;
    toml::from_str(&text).map_err(|error| {
        let before = error.span().map(|span| text[..span.start].matches('\n').count());
        let line = before.map(|lines| format!("line {}: ", lines + 1)).unwrap_or_default();
        Error::request(format!("{}: {line}{}", path.display(), error.message()))
    })
}

/// Errors: the folder of an output does not exist (exit code 2); found before a picture is made, not after.
pub fn require_folder(path: &Path) -> Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if folder.is_dir() {
        return Ok(());
    }
    Err(Error::request(format!("{}: the folder {} does not exist", path.display(), folder.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_whole_and_replaces_an_older_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.json");
        for text in ["first, and longer", "second"] {
            write_whole(&path, |file| file.write_all(text.as_bytes())).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names_in(folder.path()), ["report.json"]);
    }

    #[test]
    fn a_failure_leaves_the_older_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.json");
        std::fs::write(&path, "older").unwrap();
        let error = write_whole(&path, |file| {
            file.write_all(b"half of it").unwrap();
            Err(std::io::Error::other("no space left"))
        })
        .unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.message().contains("report.json: no space left"), "{error}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "older");
        assert_eq!(names_in(folder.path()), ["report.json"]);
    }

    #[test]
    fn a_path_that_holds_no_file_is_refused_before_anything_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("missing/report.json");
        for (path, cause) in [
            (missing.as_path(), "there is no folder"),
            (folder.path(), "it is a folder"),
            (Path::new("/dev/null"), "it is not a regular file"),
            (Path::new(""), "it names no file"),
        ] {
            let error = write_whole(path, |_| -> Result<()> { unreachable!("nothing may be written") }).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().contains(cause), "{error}");
        }
        assert!(names_in(folder.path()).is_empty());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_file_gets_the_rights_of_a_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let real = folder.path().join("real.json");
        let link = folder.path().join("link.json");
        let plain = folder.path().join("plain.json");
        std::fs::write(&plain, "").unwrap();
        write_whole(&real, |file| file.write_all(b"1")).unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&real), mode(&plain));
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write_whole(&link, |file| file.write_all(b"2")).unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read_to_string(&real).unwrap(), "2");
    }
}

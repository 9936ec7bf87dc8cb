//! The bytes of a scene file: the file itself, the two chunks of a .glb, and the files it points at.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::io::Read;
use std::ops::{Deref, Range};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use super::uri::{self, Target};
use crate::error::{Error, Result};
use crate::units::Bytes;

const GLB_MAGIC: &[u8; 4] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The main file in memory, and where its parts are.
#[derive(Debug)]
pub struct Source {
    folder: PathBuf,
    bytes: Vec<u8>,
    chunks: Chunks,
    /// Files that it points at, read so far: a short file may name a long one many times.
    files: Mutex<HashMap<PathBuf, Arc<Vec<u8>>>>,
}

/// Bytes of a scene.
#[derive(Clone, Debug)]
pub enum Data<'a> {
    /// A part of what is in memory.
    Part(&'a [u8]),
    /// The first `length` bytes of a file, or of a data URI.
    Fetched { bytes: Arc<Vec<u8>>, length: usize },
}

impl Deref for Data<'_> {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        match self {
            Self::Part(bytes) => bytes,
            Self::Fetched { bytes, length } => &bytes[..*length],
        }
    }
}

/// Where JSON and binary data lie in the main file.
#[derive(Debug, PartialEq)]
struct Chunks {
    json: Range<usize>,
    binary: Option<Range<usize>>,
}

impl Source {
    /// Reads the main file; a .glb is known by its first four bytes, not by its name.
    pub fn open(path: &Path) -> Result<Self> {
        let bytes = read_file(path)?;
        let chunks = if bytes.starts_with(GLB_MAGIC) {
            split_glb(&bytes)?
        } else {
            Chunks { json: 0..bytes.len(), binary: None }
        };
        let folder = path.parent().map(Path::to_owned).unwrap_or_default();
        Ok(Self { folder, bytes, chunks, files: Mutex::default() })
    }

    /// The whole main file.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The JSON text.
    pub fn json(&self) -> &[u8] {
        &self.bytes[self.chunks.json.clone()]
    }

    /// The binary chunk of a .glb.
    pub fn binary(&self) -> Option<&[u8]> {
        self.chunks.binary.clone().map(|range| &self.bytes[range])
    }

    /// Bytes of the main file and of the files that it points at, as far as they were read, each once.
    pub fn size_bytes(&self) -> usize {
        let files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        self.bytes.len() + files.values().map(|bytes| bytes.len()).sum::<usize>()
    }

    /// The bytes behind a URI. Those of an external file go into `hasher` when it is read, which is done once; embedded
    /// ones are in the main file already.
    ///
    /// Errors: the URI is broken or leads outside, or the file cannot be read (exit code 2).
    pub fn fetch(&self, uri: &str, hasher: &mut blake3::Hasher) -> Result<Data<'static>> {
        let bytes = match uri::resolve(uri)? {
            Target::Data(bytes) => Arc::new(bytes),
            Target::File(relative) => {
                let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
                match files.entry(self.folder.join(&relative)) {
                    Entry::Occupied(known) => known.get().clone(),
                    Entry::Vacant(free) => {
                        let path = free.key();
                        let read = self.require_inside(path).and_then(|()| read_file(path));
                        let bytes = read.map_err(|error| error.within(path.display()))?;
                        hasher.update(&bytes);
                        free.insert(Arc::new(bytes)).clone()
                    }
                }
            }
        };
        let length = bytes.len();
        Ok(Data::Fetched { bytes, length })
    }

    /// Errors: links lead from `path` out of the scene's folder (exit code 2).
    fn require_inside(&self, path: &Path) -> Result<()> {
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let (Ok(folder), Ok(target)) = (folder.canonicalize(), path.canonicalize()) else {
            // Reading it says why.
            return Ok(());
        };
        match target.starts_with(folder) {
            true => Ok(()),
            false => Err(Error::request("is a link that leads outside the scene's folder; copy the file there")),
        }
    }
}

/// What a .glb's header can say; a longer file is no part of a scene.
const MAX_FILE_BYTES: u64 = 1 << 32;

/// A regular, non-empty file, whole.
fn read_file(path: &Path) -> Result<Vec<u8>> {
    let metadata = std::fs::metadata(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => Error::request("there is no such file"),
        _ => Error::request(format!("cannot be read: {error}")),
    })?;
    if metadata.is_dir() {
        return Err(Error::request("is a folder; name the .gltf or .glb file in it"));
    }
    // A pipe or a device would block or never end.
    if !metadata.is_file() {
        return Err(Error::request("is not a regular file"));
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(Error::request(format!(
            "has {}; files of up to {} are read",
            Bytes(metadata.len()),
            Bytes(MAX_FILE_BYTES)
        )));
    }
    let mut bytes = Vec::new();
    let read = std::fs::File::open(path).and_then(|mut file| file.read_to_end(&mut bytes));
    read.map_err(|error| Error::request(format!("cannot be read: {error}")))?;
    if bytes.is_empty() {
        return Err(Error::request("is empty"));
    }
    Ok(bytes)
}

/// Finds the chunks of a binary glTF (glTF 2.0, section 4.4).
fn split_glb(bytes: &[u8]) -> Result<Chunks> {
    let word = |at: usize| -> Option<u32> { Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?)) };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(Error::request(format!(
            "is cut short: a .glb header has {HEADER_BYTES} bytes, the file {}",
            bytes.len()
        )));
    };
    if version != 2 {
        return Err(Error::request(format!("is binary glTF version {version}; version 2 is what is read")));
    }
    let length = length as usize;
    if length > bytes.len() {
        return Err(Error::request(format!(
            "is cut short: its header says {length} bytes, the file has {}",
            bytes.len()
        )));
    }

    let mut chunks = Chunks { json: 0..0, binary: None };
    let mut at = HEADER_BYTES;
    let mut chunk_index = 0;
    while at < length {
        let start = at + CHUNK_HEADER_BYTES;
        let (Some(chunk_length), Some(kind)) = (word(at), bytes.get(at + 4..start)) else {
            return Err(Error::request(format!("chunk {chunk_index} has no room for its header at byte {at}")));
        };
        let end = start + chunk_length as usize;
        if end > length {
            return Err(Error::request(format!(
                "chunk {chunk_index} says {chunk_length} bytes, but {} are left in the file",
                length.saturating_sub(start)
            )));
        }
        match (chunk_index, kind) {
            (0, b"JSON") => chunks.json = start..end,
            (1, b"BIN\0") => chunks.binary = Some(start..end),
            (0, _) => {
                return Err(Error::request(format!("chunk 0 must be JSON, but its type is {}", kind.escape_ascii())));
            }
            // Further chunks belong to extensions.
            _ => {}
        }
        at = end;
        chunk_index += 1;
    }
    if chunks.json.is_empty() {
        return Err(Error::request("has no JSON chunk"));
    }
    Ok(chunks)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn glb(length: u32, chunks: &[(&[u8; 4], u32, &[u8])]) -> Vec<u8> {
        let mut bytes = GLB_MAGIC.to_vec();
        bytes.extend(2u32.to_le_bytes());
        bytes.extend(length.to_le_bytes());
        for (kind, chunk_length, data) in chunks {
            bytes.extend(chunk_length.to_le_bytes());
            bytes.extend(*kind);
            bytes.extend(*data);
        }
        bytes
    }

    #[test]
    fn chunks_are_found_and_unknown_ones_passed_over() {
        let bytes = glb(44, &[(b"JSON", 4, b"{}  "), (b"BIN\0", 4, &[1, 2, 3, 4]), (b"ABCD", 0, &[])]);
        assert_eq!(split_glb(&bytes).unwrap(), Chunks { json: 20..24, binary: Some(32..36) });
    }

    #[test]
    fn lengths_that_lie_are_refused() {
        let error = |bytes: &[u8]| split_glb(bytes).unwrap_err().message().to_owned();
        assert!(error(&glb(0, &[])).contains("no JSON chunk"));
        assert!(error(&glb(5, &[])).contains("no JSON chunk"));
        assert!(error(&glb(u32::MAX, &[(b"JSON", 2, b"{}")])).contains("cut short"));
        assert!(error(&glb(22, &[(b"JSON", u32::MAX, b"{}")])).contains("chunk 0"));
        assert!(error(&glb(16, &[(b"BIN\0", 2, b"{}")])).contains("chunk 0"));
        assert!(error(&glb(22, &[(b"BIN\0", 2, b"{}")])).contains("must be JSON"));
        assert!(error(b"glTF").contains("cut short"));
    }
}

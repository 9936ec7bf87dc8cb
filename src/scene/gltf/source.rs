//! The bytes of a scene file: the file itself, the two chunks of a .glb, and the files it points at.

use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::uri::{self, Target};
use crate::error::{Error, Result};

const GLB_MAGIC: &[u8; 4] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// The main file in memory, and where its parts are.
#[derive(Debug)]
pub struct Source {
    folder: PathBuf,
    bytes: Vec<u8>,
    chunks: Chunks,
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
        Ok(Self { folder, bytes, chunks })
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

    /// The bytes behind a URI. Those of an external file go into `hasher`; embedded ones are in the main file already.
    pub fn fetch(&self, uri: &str, hasher: &mut blake3::Hasher) -> Result<Vec<u8>> {
        match uri::resolve(uri)? {
            Target::Data(bytes) => Ok(bytes),
            Target::File(relative) => {
                let path = self.folder.join(&relative);
                let bytes = read_file(&path).map_err(|error| error.within(path.display()))?;
                hasher.update(&bytes);
                Ok(bytes)
            }
        }
    }
}

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

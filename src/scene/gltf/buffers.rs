//! The buffers of a file in memory, and checked slices of them.

use std::borrow::Cow;

use gltf::Document;
use gltf::buffer::{Source as BufferSource, View};

use super::label;
use super::source::Source;
use crate::error::{Error, Result};

/// Every buffer of the file, each exactly as long as the file says.
#[derive(Debug)]
pub struct Buffers<'a> {
    buffers: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; external ones go into `hasher` in file order.
    pub fn read(document: &Document, source: &'a Source, hasher: &mut blake3::Hasher) -> Result<Self> {
        let mut read = |buffer: gltf::Buffer<'_>| -> Result<Cow<'a, [u8]>> {
            let mut bytes = match buffer.source() {
                BufferSource::Uri(uri) => Cow::Owned(source.fetch(uri, hasher)?),
                BufferSource::Bin if buffer.index() == 0 => {
                    Cow::Borrowed(source.binary().ok_or_else(|| {
                        Error::request("has no uri, and the file has no binary chunk that could be it")
                    })?)
                }
                BufferSource::Bin => return Err(Error::request("has no uri; only buffer 0 of a .glb may go without")),
            };
            let length = buffer.length();
            if bytes.len() < length {
                return Err(Error::request(format!("should have {length} bytes, but {} are there", bytes.len())));
            }
            match &mut bytes {
                Cow::Borrowed(slice) => *slice = &slice[..length],
                Cow::Owned(vector) => vector.truncate(length),
            }
            Ok(bytes)
        };
        let buffers = document.buffers().map(|buffer| {
            let label = label::element("buffer", buffer.index(), buffer.name());
            read(buffer).map_err(|error| error.within(label))
        });
        Ok(Self { buffers: buffers.collect::<Result<_>>()? })
    }

    #[cfg(test)]
    pub fn of(bytes: &'a [u8]) -> Self {
        Self { buffers: vec![Cow::Borrowed(bytes)] }
    }

    /// How many bytes all buffers together have.
    pub fn total_bytes(&self) -> usize {
        self.buffers.iter().map(|buffer| buffer.len()).sum()
    }

    /// The bytes of a buffer view; fails where it reaches beyond its buffer.
    pub fn view(&self, view: &View<'_>) -> Result<&[u8]> {
        let buffer_index = view.buffer().index();
        let buffer = &self.buffers[buffer_index];
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| buffer.get(view.offset()..end)).ok_or_else(|| {
            Error::request(format!(
                "{}: {} bytes from byte {} reach beyond buffer {buffer_index}, which has {}",
                label::element("buffer view", view.index(), view.name()),
                view.length(),
                view.offset(),
                buffer.len()
            ))
        })
    }
}

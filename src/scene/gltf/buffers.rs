//! The buffers of a file in memory, and checked slices of them.

use gltf::Document;
use gltf::buffer::View;

use super::label;
use super::source::{Data, Source};
use crate::error::{Error, Result};

/// Every buffer of the file, each exactly as long as the file says.
#[derive(Debug)]
pub struct Buffers<'a> {
    buffers: Vec<Data<'a>>,
    file_bytes: usize,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers; external ones go into `hasher` in file order.
    pub fn read(document: &Document, source: &'a Source, hasher: &mut blake3::Hasher) -> Result<Self> {
        let mut read = |buffer: gltf::Buffer<'_>| -> Result<Data<'a>> {
            let mut data =
                match &document.as_json().buffers[buffer.index()].uri {
                    Some(uri) => source.fetch(uri, hasher)?,
                    None if buffer.index() == 0 => Data::Part(source.binary().ok_or_else(|| {
                        Error::request("has no uri, and the file has no binary chunk that could be it")
                    })?),
                    None => return Err(Error::request("has no uri; only buffer 0 of a .glb may go without")),
                };
            let wanted = buffer.length();
            if data.len() < wanted {
                return Err(Error::request(format!("should have {wanted} bytes, but {} are there", data.len())));
            }
            match &mut data {
                Data::Part(bytes) => *bytes = &bytes[..wanted],
                Data::Fetched { length, .. } => *length = wanted,
            }
            Ok(data)
        };
        let buffers = document.buffers().map(|buffer| {
            let label = label::element("buffer", buffer.index(), buffer.name());
            read(buffer).map_err(|error| error.within(label))
        });
        let buffers = buffers.collect::<Result<_>>()?;
        Ok(Self { buffers, file_bytes: source.size_bytes() })
    }

    #[cfg(test)]
    pub fn of(bytes: &'a [u8]) -> Self {
        Self { buffers: vec![Data::Part(bytes)], file_bytes: bytes.len() }
    }

    /// How many bytes the file and its buffers' files have, each counted once: what backs all that buffers are named for.
    pub fn file_bytes(&self) -> usize {
        self.file_bytes
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

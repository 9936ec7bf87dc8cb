//! Voxels without a header: bytes, 16-bit words or 32-bit floats, little-endian, told apart by how long the file is.

use super::axes::{self, LPS};
use super::field::{Volume, require_sides};
use super::voxels::{Voxels, room};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// How a file has values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    U8,
    U16,
    /// Becomes floats, which hold every one of them.
    I16,
    F32,
}

impl Kind {
    /// Bytes of a value.
    pub fn bytes(self) -> u64 {
        match self {
            Self::U8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::F32 => 4,
        }
    }
}

/// A raw file of `size` voxels.
///
/// Errors: it cannot be read, or its length is that of no such voxels (exit code 2); memory (4).
pub fn open(path: &Path, size: [u32; 3]) -> Result<Volume> {
    require_sides(size.map(u64::from))?;
    let count: u64 = size.map(u64::from).iter().product();
    let cannot = |error: std::io::Error| Error::request(format!("cannot read it: {error}"));
    let mut file = File::open(path).map_err(cannot)?;
    let length = file.metadata().map_err(cannot)?.len();
    let kinds = [Kind::U8, Kind::U16, Kind::F32];
    let Some(kind) = kinds.into_iter().find(|kind| count * kind.bytes() == length) else {
        let lengths = kinds.map(|kind| (count * kind.bytes()).to_string()).join(", ");
        let [width, height, depth] = size;
        return Err(Error::request(format!("{length} bytes are no {width}x{height}x{depth} voxels"))
            .note(format!("u8, u16 and f32 voxels of that size are files of {lengths} bytes")));
    };
    let voxels = read(&mut file, kind, false, count)?;
    let voxels = axes::turned(voxels, size, LPS)?;
    Volume::new(axes::in_world(size, LPS), [1.0; 3], voxels)
}

/// `count` values of a stream. Memory is taken as they come, not as the count promises.
///
/// Errors: it ends before, or cannot be read (exit code 2); memory (4).
pub fn read(stream: &mut impl Read, kind: Kind, is_big_endian: bool, count: u64) -> Result<Voxels> {
    Ok(match kind {
        Kind::U8 => Voxels::U8(values(stream, count, |[byte]: [u8; 1]| byte)?),
        Kind::U16 => Voxels::U16(values(stream, count, |word| word_of(word, is_big_endian))?),
        Kind::I16 => Voxels::F32(values(stream, count, |word| f32::from(word_of(word, is_big_endian) as i16))?),
        Kind::F32 => Voxels::F32(values(stream, count, |word| match is_big_endian {
            true => f32::from_be_bytes(word),
            false => f32::from_le_bytes(word),
        })?),
    })
}

fn word_of(word: [u8; 2], is_big_endian: bool) -> u16 {
    if is_big_endian { u16::from_be_bytes(word) } else { u16::from_le_bytes(word) }
}

/// Values that are read at once.
const PIECE: u64 = 1 << 20;

fn values<const BYTES: usize, T>(
    stream: &mut impl Read,
    count: u64,
    value: impl Fn([u8; BYTES]) -> T,
) -> Result<Vec<T>> {
    let mut values: Vec<T> = Vec::new();
    let mut piece = Vec::new();
    while (values.len() as u64) < count {
        let wanted = (count - values.len() as u64).min(PIECE) * BYTES as u64;
        piece.clear();
        let found = stream.take(wanted).read_to_end(&mut piece);
        let found = found.map_err(|error| Error::request(format!("its voxels cannot be read: {error}")))?;
        if (found as u64) < wanted {
            let have = (values.len() + found / BYTES) as u64;
            return Err(Error::request(format!("it ends after {have} of {count} voxels")));
        }
        if values.capacity() < values.len() + found / BYTES {
            // Doubled, so that a file of any length is copied a few times, and no more than `count` has.
            let next = (2 * values.len() as u64).max(PIECE).min(count) as usize;
            let mut grown = room(next.max(values.len() + found / BYTES))?;
            grown.append(&mut values);
            values = grown;
        }
        let (words, _) = piece.as_chunks::<BYTES>();
        values.extend(words.iter().map(|word| value(*word)));
    }
    Ok(values)
}

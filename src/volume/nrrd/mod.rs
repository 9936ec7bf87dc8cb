//! NRRD, nearly raw raster data (Kindlmann, Definition of NRRD file format, teem's documentation): three-dimensional scalars,
//! raw or compressed by gzip, behind their header or in a file of their own.

#[cfg(test)]
mod checks;
mod header;

use super::axes::{self, LPS, Way};
use super::field::{Volume, require_sides};
use super::raw;
use super::voxels::Voxels;
use crate::error::{Error, Result};
use flate2::read::MultiGzDecoder;
use header::{Encoding, Header};
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

/// The file of a header, which holds the voxels or names the file that does.
///
/// Errors: it is broken, or of a kind that is not read, in words (exit code 2); memory (4).
pub fn open(path: &Path) -> Result<Volume> {
    let mut file = opened(path)?;
    let header = Header::read(&mut file)?;
    require_sides(header.size)?;
    let size = header.size.map(|side| side as u32);
    let voxels = match &header.data_file {
        None => voxels(&mut file, &header),
        Some(name) => {
            let data = beside(path, name)?;
            opened(&data).and_then(|mut data| voxels(&mut data, &header)).map_err(|error| error.within(data.display()))
        }
    }?;
    let (ways, spacing) = placed(&header);
    let voxels = axes::turned(voxels, size, ways)?;
    Volume::new(axes::in_world(size, ways), axes::in_world(spacing, ways), voxels)
}

fn opened(path: &Path) -> Result<BufReader<File>> {
    File::open(path).map(BufReader::new).map_err(|error| Error::request(format!("cannot read it: {error}")))
}

/// The file `name`, which lies in the header's folder or below it.
fn beside(header: &Path, name: &str) -> Result<PathBuf> {
    let name = Path::new(name);
    let is_below = name.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    match is_below {
        true => Ok(header.parent().unwrap_or(Path::new("")).join(name)),
        false => {
            let shown: String = name.display().to_string().chars().take(80).collect();
            Err(Error::request(format!("data file {shown}: it must lie beside its header, or below")))
        }
    }
}

/// The voxels that stand from here on in a file.
fn voxels(file: &mut BufReader<File>, header: &Header) -> Result<Voxels> {
    let count: u64 = header.size.iter().product();
    let bytes = count * header.kind.bytes();
    skip_lines(file, header.line_skip)?;
    let broken = |error: std::io::Error| Error::request(format!("its voxels cannot be read: {error}"));
    let length = file.get_ref().metadata().map_err(broken)?.len();
    let read = |stream: &mut dyn Read| raw::read(&mut &mut *stream, header.kind, header.is_big_endian, count);
    match header.encoding {
        Encoding::Raw => {
            let at = match header.byte_skip {
                // From the end: as much as there must be.
                None => length.checked_sub(bytes).unwrap_or(length),
                Some(skip) => file.stream_position().map_err(broken)?.saturating_add(skip),
            };
            if length.saturating_sub(at) < bytes {
                let have = length.saturating_sub(at) / header.kind.bytes();
                return Err(Error::request(format!("it ends after {have} of {count} voxels")));
            }
            file.seek(SeekFrom::Start(at)).map_err(broken)?;
            read(file)
        }
        Encoding::Gzip => {
            let mut stream = MultiGzDecoder::new(file);
            // Bytes to skip are counted in what is unpacked, as the format has it.
            let skip = header.byte_skip.unwrap_or_default();
            let skipped = std::io::copy(&mut (&mut stream).take(skip), &mut std::io::sink()).map_err(broken)?;
            if skipped < skip {
                return Err(Error::request(format!("byte skip: {skip}: it has {skipped} bytes")));
            }
            read(&mut stream)
        }
    }
}

fn skip_lines(file: &mut impl BufRead, count: u64) -> Result<()> {
    for line in 0..count {
        let found = file.skip_until(b'\n').map_err(|error| Error::request(format!("line skip: {error}")))?;
        if found == 0 {
            return Err(Error::request(format!("line skip: {count}: it has {line} lines")));
        }
    }
    Ok(())
}

/// How the file's axes lie in the world, and the distances of voxels along them.
fn placed(header: &Header) -> ([Way; 3], [f32; 3]) {
    let plain = (LPS, header.spacings.map(|along| along as f32));
    let Some(directions) = header.directions else { return plain };
    let lengths = directions.map(|direction| direction.iter().map(|along| along * along).sum::<f64>().sqrt());
    let spacing = lengths.map(|length| length as f32);
    // Where left, back and up lead in the world, and which of a space's axes is the other way.
    let of_space = header.space.ways();
    let ways = [0, 1, 2].map(|axis| {
        let along = |of: usize| directions[axis][of] / lengths[axis];
        let chief = (0..3).find(|of| along(*of).abs() > 0.999)?;
        let way = of_space[chief];
        Some(Way { axis: way.axis, is_back: way.is_back != (along(chief) < 0.0) })
    });
    match ways {
        [Some(a), Some(b), Some(c)] if a.axis + b.axis + c.axis == 3 && a.axis != b.axis => ([a, b, c], spacing),
        // Oblique ones keep the order that most files have.
        _ => (LPS, spacing),
    }
}

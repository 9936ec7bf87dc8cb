//! The header of an NRRD file: lines of fields up to an empty one.

use crate::error::{Error, Result};
use crate::volume::axes::{LPS, Way};
use crate::volume::raw::Kind;
use std::io::{BufRead, Read};

/// The longest header that is read, bytes.
const MOST_BYTES: u64 = 1 << 16;

/// How voxels are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    Raw,
    Gzip,
}

/// What the axes of the space around the patient are called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Left, posterior, superior; of spaces without names too.
    Lps,
    /// Right, anterior, superior.
    Ras,
    /// Left, anterior, superior.
    Las,
}

impl Space {
    /// Where its axes lead in the world.
    pub fn ways(self) -> [Way; 3] {
        let [left, back, up] = LPS;
        let other = |way: Way| Way { is_back: !way.is_back, ..way };
        match self {
            Self::Lps => [left, back, up],
            Self::Ras => [other(left), other(back), up],
            Self::Las => [left, other(back), up],
        }
    }
}

/// What a header says.
#[derive(Clone, Debug, PartialEq)]
pub struct Header {
    pub kind: Kind,
    /// Voxels along its axes, the one that changes fastest first; not checked yet.
    pub size: [u64; 3],
    pub encoding: Encoding,
    pub is_big_endian: bool,
    /// From one voxel to the next along each axis; 1 where it says nothing.
    pub spacings: [f64; 3],
    /// The same as vectors of the space.
    pub directions: Option<[[f64; 3]; 3]>,
    pub space: Space,
    /// Where the voxels are; None: behind the header.
    pub data_file: Option<String>,
    pub line_skip: u64,
    /// None: they are the last bytes of the file.
    pub byte_skip: Option<u64>,
}

/// Errors: what is wrong with a field.
type Read1<T> = Result<T, String>;

/// The fields as texts.
#[derive(Default)]
struct Fields(Vec<(String, String)>);

impl Fields {
    fn get(&self, names: &[&str]) -> Option<&str> {
        let found = self.0.iter().find(|(name, _)| names.contains(&name.as_str()));
        found.map(|(_, text)| text.as_str())
    }

    fn wanted(&self, name: &str) -> Read1<&str> {
        self.get(&[name]).ok_or_else(|| format!("it has no field {name}"))
    }
}

impl Header {
    /// The header that a file begins with; what comes next is behind it.
    ///
    /// Errors: it is none, too long, lacks a field or has one that cannot be read here (exit code 2).
    pub fn read(file: &mut impl BufRead) -> Result<Self> {
        let cannot = |error: std::io::Error| Error::request(format!("cannot read it: {error}"));
        let mut limited = file.take(MOST_BYTES);
        let mut bytes = Vec::new();
        limited.read_until(b'\n', &mut bytes).map_err(cannot)?;
        let is_magic =
            bytes.starts_with(b"NRRD000") && bytes.get(7).is_some_and(|version| (b'1'..=b'5').contains(version));
        if !is_magic {
            return Err(Error::request("it is no NRRD file: it does not begin with NRRD0001 to NRRD0005"));
        }
        let mut fields = Fields::default();
        loop {
            bytes.clear();
            limited.read_until(b'\n', &mut bytes).map_err(cannot)?;
            if bytes.is_empty() && limited.limit() == 0 {
                return Err(Error::request(format!("its header does not end within {MOST_BYTES} bytes")));
            }
            let line = String::from_utf8_lossy(&bytes);
            let line = line.trim_end_matches(['\n', '\r']);
            // An empty line ends the header, and so does the end of a file that names another.
            if line.is_empty() {
                break;
            }
            if line.starts_with('#') || line.contains(":=") {
                continue;
            }
            let Some((name, text)) = line.split_once(':') else {
                let shown: String = line.chars().take(60).collect();
                return Err(Error::request(format!("its header has a line without a field: {shown}")));
            };
            fields.0.push((name.trim().to_lowercase(), text.trim().to_owned()));
        }
        Self::of(&fields).map_err(Error::request)
    }

    fn of(fields: &Fields) -> Read1<Self> {
        let dimension = fields.wanted("dimension")?;
        if dimension != "3" {
            return Err(format!("dimension: {}: three are read", short(dimension)));
        }
        let kind = kind(fields.wanted("type")?)?;
        let size = three(fields.wanted("sizes")?, |text| text.parse::<u64>().ok()).ok_or_else(|| {
            format!("sizes: {}: it must be three whole numbers", short(fields.get(&["sizes"]).unwrap_or("")))
        })?;
        let encoding = match fields.wanted("encoding")?.to_lowercase().as_str() {
            "raw" => Encoding::Raw,
            "gzip" | "gz" => Encoding::Gzip,
            other => return Err(format!("encoding: {}: raw and gzip are read", short(other))),
        };
        let is_big_endian = match (fields.get(&["endian"]).map(str::to_lowercase).as_deref(), kind) {
            (Some("big"), _) => true,
            (Some("little"), _) | (None, Kind::U8) => false,
            (Some(other), _) => return Err(format!("endian: {}: it must be little or big", short(other))),
            (None, _) => return Err("it has no field endian, and its values are wider than a byte".to_owned()),
        };
        let whole = |names: &[&str]| match fields.get(names) {
            None => Ok(0i64),
            Some(text) => text.parse().map_err(|_| format!("{}: {}: it must be a whole number", names[0], short(text))),
        };
        let byte_skip = match whole(&["byte skip", "byteskip"])? {
            -1 if encoding == Encoding::Raw => None,
            skip => Some(
                u64::try_from(skip)
                    .map_err(|_| format!("byte skip: {skip}: it must be at least 0, or -1 of raw voxels"))?,
            ),
        };
        let line_skip = whole(&["line skip", "lineskip"])?;
        Ok(Self {
            kind,
            size,
            encoding,
            is_big_endian,
            spacings: spacings(fields)?,
            directions: directions(fields)?,
            space: space(fields),
            data_file: data_file(fields)?,
            line_skip: u64::try_from(line_skip)
                .map_err(|_| format!("line skip: {line_skip}: it must be at least 0"))?,
            byte_skip,
        })
    }
}

fn kind(text: &str) -> Read1<Kind> {
    Ok(match text.to_lowercase().as_str() {
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Kind::U8,
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => Kind::U16,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => Kind::I16,
        "float" => Kind::F32,
        other => return Err(format!("type: {}: uint8, uint16, int16 and float are read", short(other))),
    })
}

/// Three words with spaces between.
fn three<T>(text: &str, read: impl Fn(&str) -> Option<T>) -> Option<[T; 3]> {
    text.split_whitespace().map(read).collect::<Option<Vec<T>>>()?.try_into().ok()
}

fn spacings(fields: &Fields) -> Read1<[f64; 3]> {
    let Some(text) = fields.get(&["spacings"]) else { return Ok([1.0; 3]) };
    // What has no distance says nan.
    let along = |text: &str| text.parse::<f64>().ok().map(|along| if along.is_nan() { 1.0 } else { along.abs() });
    three(text, along)
        .filter(|spacings| spacings.iter().all(|along| along.is_finite() && *along > 0.0))
        .ok_or_else(|| format!("spacings: {}: it must be three numbers that are not 0", short(text)))
}

/// `(x,y,z)` for each axis.
fn directions(fields: &Fields) -> Read1<Option<[[f64; 3]; 3]>> {
    let Some(text) = fields.get(&["space directions"]) else { return Ok(None) };
    let vector = |text: &str| -> Option<[f64; 3]> {
        let numbers = text.trim().strip_prefix('(')?.split(',').map(|number| number.trim().parse().ok());
        let vector: [f64; 3] = numbers.collect::<Option<Vec<f64>>>()?.try_into().ok()?;
        let length: f64 = vector.iter().map(|along| along * along).sum();
        (length.is_finite() && length > 0.0).then_some(vector)
    };
    let vectors: Option<Vec<[f64; 3]>> = text.trim().trim_end_matches(')').split(')').map(vector).collect();
    vectors
        .and_then(|vectors| vectors.try_into().ok())
        .map(Some)
        .ok_or_else(|| format!("space directions: {}: it must be three vectors (x,y,z) that are not 0", short(text)))
}

fn space(fields: &Fields) -> Space {
    match fields.get(&["space"]).map(str::to_lowercase).as_deref() {
        Some("right-anterior-superior" | "ras") => Space::Ras,
        Some("left-anterior-superior" | "las") => Space::Las,
        _ => Space::Lps,
    }
}

fn data_file(fields: &Fields) -> Read1<Option<String>> {
    let Some(name) = fields.get(&["data file", "datafile"]) else { return Ok(None) };
    if name.starts_with("LIST") || name.contains('%') {
        return Err(format!("data file: {}: voxels in several files are not read", short(name)));
    }
    Ok(Some(name.to_owned()))
}

/// The start of a text, for messages.
fn short(text: &str) -> String {
    text.chars().take(60).collect()
}

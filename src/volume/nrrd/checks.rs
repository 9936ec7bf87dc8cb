//! Files of every kind that is read, and of many that are not.

use super::super::{Volume, VolumeRequest, Voxels, open};
use crate::error::Error;
use flate2::Compression;
use flate2::write::GzEncoder;
use proptest::prelude::*;
use std::fs;
use std::io::Write;
use std::path::Path;

fn read(path: &Path) -> Result<Volume, Error> {
    open(&VolumeRequest { spec: path.to_str().unwrap(), raw_size: None, seed: 1 })
}

/// A file of `header` fields and `data` behind an empty line.
fn file(folder: &Path, header: &str, data: &[u8]) -> Result<Volume, Error> {
    let path = folder.join("a.nrrd");
    fs::write(&path, [format!("NRRD0004\n# a comment\n{header}key:=value\n\n").as_bytes(), data].concat()).unwrap();
    read(&path)
}

fn packed(data: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(data).unwrap();
    encoder.finish().unwrap()
}

/// Values of 24 voxels whose bytes all differ, and the fields that go with them.
const SIZES: &str = "dimension: 3\nsizes: 2 3 4\n";

fn expected() -> Vec<f32> {
    (0..24).map(|value| 259.0 * value as f32).collect()
}

/// The world's value at the file's (i, j, k): x is i, y is k, z is j backwards.
fn at(volume: &Volume, [i, j, k]: [usize; 3]) -> f32 {
    assert_eq!(volume.size, [2, 4, 3]);
    let index = ((2 - j) * 4 + k) * 2 + i;
    match &volume.voxels {
        Voxels::U8(values) => values[index].into(),
        Voxels::U16(values) => values[index].into(),
        Voxels::F32(values) => values[index],
    }
}

/// Each type in each byte order, raw and packed, behind its header and in a file beside it, with bytes and lines to skip.
#[test]
fn every_kind_of_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let words: Vec<u16> = expected().iter().map(|value| *value as u16).collect();
    let kinds: [(&str, &str, Vec<u8>); 8] = [
        ("uchar", "", (0..24).collect()),
        ("unsigned short", "endian: little\n", words.iter().flat_map(|word| word.to_le_bytes()).collect()),
        ("uint16", "endian: big\n", words.iter().flat_map(|word| word.to_be_bytes()).collect()),
        ("short", "endian: little\n", words.iter().flat_map(|word| word.to_le_bytes()).collect()),
        ("int16", "endian: big\n", words.iter().flat_map(|word| word.to_be_bytes()).collect()),
        ("float", "endian: little\n", expected().iter().flat_map(|value| value.to_le_bytes()).collect()),
        ("float", "endian: big\n", expected().iter().flat_map(|value| value.to_be_bytes()).collect()),
        ("uint8", "spacings: 0.5 1 nan\n", (0..24).collect()),
    ];
    for (kind, more, data) in kinds {
        let fields = format!("type: {kind}\n{SIZES}{more}");
        let skipped = [b"one line\nsix".as_slice(), &data].concat();
        fs::write(folder.join("data.bin"), &skipped).unwrap();
        fs::write(folder.join("data.gz"), packed(&data)).unwrap();
        let volumes = [
            file(folder, &format!("{fields}encoding: raw\n"), &data),
            file(folder, &format!("{fields}encoding: gzip\n").replace('\n', "\r\n"), &packed(&data)),
            file(folder, &format!("{fields}encoding: raw\nbyte skip: -1\n"), &skipped),
            file(folder, &format!("{fields}encoding: raw\nline skip: 1\nbyte skip: 3\n"), &skipped),
            file(folder, &format!("{fields}encoding: gz\nbyteskip: 12\n"), &packed(&skipped)),
            file(folder, &format!("{fields}encoding: raw\ndata file: data.bin\nbyte skip: 12\n"), &[]),
            file(folder, &format!("{fields}encoding: gz\ndatafile: ./data.gz\n"), &[]),
        ];
        for volume in volumes {
            let volume = volume.unwrap_or_else(|error| panic!("{kind}: {error}"));
            let scale = if more.contains("endian") { 259.0 } else { 1.0 };
            for (index, place) in [(0, [0, 0, 0]), (1, [1, 0, 0]), (2, [0, 1, 0]), (23, [1, 2, 3])] {
                assert_eq!(at(&volume, place), scale * index as f32, "{kind} at {place:?}");
            }
            let x_m = if kind == "uint8" { 0.5 } else { 1.0 };
            assert_eq!(volume.spacing, [x_m, 1.0, 1.0], "{kind}");
        }
    }
}

/// The same voxel of the same patient stands in one place, whichever way the file's axes lead.
#[test]
fn spaces_lead_to_one_world() {
    let folder = tempfile::tempdir().unwrap();
    // The voxel at (1, 0, 0) is marked.
    let marked: Vec<u8> = (0..24).map(|index| u8::from(index == 1)).collect();
    for (space, directions, size, expected) in [
        ("left-posterior-superior", "(1,0,0) (0,2,0) (0,0,3)", [2, 4, 3], [1, 0, 2]),
        ("LPS", "(-1,0,0) (0,2,0) (0,0,3)", [2, 4, 3], [0, 0, 2]),
        ("right-anterior-superior", "(1,0,0) (0,2,0) (0,0,3)", [2, 4, 3], [0, 0, 0]),
        ("RAS", "(0,0,-1) (0,2,0) (3,0,0)", [4, 2, 3], [3, 0, 0]),
        ("left-anterior-superior", "(1,0,0) (0,2,0) (0,0,3)", [2, 4, 3], [1, 0, 0]),
        ("scanner-xyz", "(1,0,0) (0,2,0) (0,0,3)", [2, 4, 3], [1, 0, 2]),
        // Oblique: in the order of most files.
        ("LPS", "(0.8,0.6,0) (-1.2,1.6,0) (0,0,3)", [2, 4, 3], [1, 0, 2]),
    ] {
        let header = format!("type: uint8\n{SIZES}encoding: raw\nspace: {space}\nspace directions: {directions}\n");
        let volume = file(folder.path(), &header, &marked).unwrap();
        assert_eq!(volume.size, size, "{space}");
        let Voxels::U8(values) = &volume.voxels else { panic!("bytes") };
        let found = values.iter().position(|value| *value == 1).unwrap() as u32;
        assert_eq!([found % size[0], found / size[0] % size[1], found / size[0] / size[1]], expected, "{space}");
        let mut spacing = volume.spacing.map(|along| along.round() as u32);
        assert_eq!(spacing[1], if space == "RAS" { 1 } else { 3 }, "{space}");
        spacing.sort();
        assert_eq!(spacing, [1, 2, 3], "{space}");
    }
}

/// What is broken or not read ends with one error that names the file and the trouble.
#[test]
fn hostile_headers_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let good = format!("type: uint8\n{SIZES}encoding: raw\n");
    let data = [7u8; 24];
    let cases: Vec<(String, Vec<u8>, &str)> = vec![
        (good.clone(), data[..23].to_vec(), "23 of 24 voxels"),
        (good.replace("raw", "gzip"), packed(&data[..20]), "20 of 24 voxels"),
        (good.replace("raw", "gzip"), data.to_vec(), "cannot be read"),
        (good.replace("raw", "bzip2"), data.to_vec(), "raw and gzip are read"),
        (good.replace("encoding: raw\n", ""), data.to_vec(), "no field encoding"),
        (good.replace("uint8", "double"), data.to_vec(), "uint8, uint16, int16 and float"),
        (good.replace("uint8", "uint16"), data.to_vec(), "no field endian"),
        (good.replace("2 3 4", "2 3"), data.to_vec(), "three whole numbers"),
        (good.replace("2 3 4", "-2 3 4"), data.to_vec(), "three whole numbers"),
        (good.replace("2 3 4", "1 3 4"), data.to_vec(), "each side must be 2 to"),
        (good.replace("2 3 4", "4294967296 4294967296 4294967296"), data.to_vec(), "each side must be 2 to"),
        (good.replace("2 3 4", "16384 16384 16384"), data.to_vec(), "24 of 4398046511104 voxels"),
        (
            good.replace("2 3 4", "16384 16384 16384").replace("raw", "gzip"),
            packed(&data),
            "24 of 4398046511104 voxels",
        ),
        (good.replace("dimension: 3", "dimension: 4"), data.to_vec(), "three are read"),
        (format!("{good}data file: ../a.raw\n"), data.to_vec(), "beside its header"),
        (format!("{good}data file: /etc/passwd\n"), data.to_vec(), "beside its header"),
        (format!("{good}data file: LIST\n"), data.to_vec(), "several files"),
        (format!("{good}data file: none.raw\n"), data.to_vec(), "none.raw"),
        (format!("{good}byte skip: -2\n"), data.to_vec(), "at least 0"),
        (format!("{good}byte skip: 9223372036854775807\n"), data.to_vec(), "0 of 24 voxels"),
        (format!("{good}line skip: 99\n"), data.to_vec(), "line skip: 99"),
        (format!("{good}spacings: 1 0 1\n"), data.to_vec(), "not 0"),
        (format!("{good}space directions: (1,0,0) (0,0,0) (0,0,1)\n"), data.to_vec(), "not 0"),
        (format!("{good}no field\n"), data.to_vec(), "line without a field"),
        (format!("type: float\nendian: little\n{SIZES}encoding: raw\n"), [0xff; 96].to_vec(), "voxel 0 is NaN"),
    ];
    for (header, data, words) in cases {
        let error = file(folder, &header, &data).unwrap_err();
        let text = error.to_string();
        assert!(error.exit_code() == 2 && text.contains(words) && text.contains("a.nrrd"), "{header}: {text}");
    }
    let path = folder.join("b.nrrd");
    for (bytes, words) in [
        (b"not one".to_vec(), "no NRRD file"),
        (b"NRRD0009\n\n".to_vec(), "no NRRD file"),
        ([b"NRRD0004\n".to_vec(), b"#".repeat(1 << 20)].concat(), "does not end within"),
    ] {
        fs::write(&path, bytes).unwrap();
        let error = read(&path).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(words), "{error}");
    }
    let error = read(&folder.join("c.nhdr")).unwrap_err();
    assert!(error.to_string().contains("cannot read it"), "{error}");
}

/// Files without a header are told apart by their length.
#[test]
fn raw_files_are_read_by_their_length() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.raw");
    let open = |size| open(&VolumeRequest { spec: path.to_str().unwrap(), raw_size: size, seed: 1 });
    for (bytes, last) in [(24usize, 23.0f32), (48, 5.0), (96, 5.0)] {
        let data: Vec<u8> = match bytes {
            24 => (0..24).collect(),
            48 => [5u8, 0].repeat(24),
            _ => 5f32.to_le_bytes().repeat(24),
        };
        fs::write(&path, data).unwrap();
        let volume = open(Some([2, 3, 4])).unwrap();
        assert_eq!(at(&volume, [1, 2, 3]), last, "{bytes} bytes");
    }
    let error = open(Some([2, 3, 5])).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("30, 60, 120 bytes"), "{error}");
    assert!(open(None).unwrap_err().to_string().contains("--volume-size"));
}

proptest! {
    /// Whatever is changed in a good file, it is read or refused: no panic, and no memory beyond what is there.
    #[test]
    fn changed_bytes_are_read_or_refused(
        changes in prop::collection::vec((0usize..200, any::<u8>()), 1..6), is_packed in any::<bool>(), cut in 0usize..60,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let data = if is_packed { packed(&[3; 24]) } else { vec![3; 24] };
        let encoding = if is_packed { "gzip" } else { "raw" };
        let header = format!("NRRD0004\ntype: uint8\n{SIZES}space: RAS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\nencoding: {encoding}\n\n");
        let mut bytes = [header.as_bytes(), &data].concat();
        let length = bytes.len();
        changes.iter().for_each(|(at, byte)| bytes[at % length] = *byte);
        bytes.truncate(length - cut);
        let path = folder.path().join("a.nrrd");
        fs::write(&path, bytes).unwrap();
        if let Err(error) = read(&path) {
            prop_assert_eq!(error.exit_code(), 2);
        }
    }
}

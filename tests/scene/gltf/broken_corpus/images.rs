//! Pictures that claim what they do not hold, or hold more than their bytes let expect.

use super::Case;
use crate::support::gltf_file::{GltfFile, png};
use serde_json::json;

/// The triangle under a texture of these bytes.
fn shown(image: &[u8]) -> GltfFile {
    let mut file = GltfFile::triangle();
    let view = file.view(image);
    file.push("images", json!({"bufferView": view, "mimeType": "image/png", "name": "wood"}));
    file.push("textures", json!({"source": 0}));
    file.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    file.primitive()["material"] = json!(0);
    file
}

fn refused(name: &str, image: &[u8], words: &[&str]) -> Case {
    Case::refused(name, shown(image).glb(), &[&["image 0 \"wood\""], words].concat())
}

const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

fn chunk(kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut checked = kind.to_vec();
    checked.extend(data);
    let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    let crc = !checked.iter().fold(!0u32, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)));
    [&(data.len() as u32).to_be_bytes()[..], &checked, &crc.to_be_bytes()].concat()
}

/// A PNG header of 8-bit RGBA (depth 8, type 6) or another kind.
fn header(width: u32, height: u32, depth: u8, kind: u8) -> Vec<u8> {
    let mut data = [width.to_be_bytes(), height.to_be_bytes()].concat();
    data.extend([depth, kind, 0, 0, 0]);
    [SIGNATURE, &chunk(b"IHDR", &data)].concat()
}

/// `count` zeros as zlib packs them: a thousandth of their bytes. The checksum of zeros is known (RFC 1950).
fn zeros(count: usize) -> Vec<u8> {
    use std::io::Write;
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    for _ in 0..count >> 16 {
        packed.write_all(&[0; 1 << 16]).unwrap();
    }
    packed.write_all(&vec![0; count & 0xffff]).unwrap();
    packed.finish().unwrap()
}

fn jpeg(width: u16, height: u16) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(8, 8, image::Rgb([1, 2, 3])).write_to(&mut bytes, image::ImageFormat::Jpeg).unwrap();
    let mut bytes = bytes.into_inner();
    // SOF0: marker, length, precision, then height and width.
    let at = bytes.windows(2).position(|pair| pair == [0xff, 0xc0]).unwrap();
    bytes[at + 5..at + 7].copy_from_slice(&height.to_be_bytes());
    bytes[at + 7..at + 9].copy_from_slice(&width.to_be_bytes());
    bytes
}

pub fn cases() -> Vec<Case> {
    let end = chunk(b"IEND", &[]);
    let empty = chunk(b"IDAT", &[]);
    let claims = |width: u32, height: u32| [header(width, height, 8, 6), empty.clone(), end.clone()].concat();
    let good = png(8, 8);
    let mut cases = vec![
        refused("a PNG header of 2^31 - 1 pixels a side", &claims(i32::MAX as u32, i32::MAX as u32), &[]),
        refused("a PNG header of 100,000 pixels a side", &claims(100_000, 100_000), &["16384"]),
        refused("a PNG header of 16,384 pixels a side", &claims(16_384, 16_384), &[]),
        refused("a PNG header of 0 pixels", &claims(0, 8), &[]),
        refused("a PNG without pixels", &claims(8, 8), &["cannot be decoded"]),
        refused("a JPEG header of 65,535 pixels a side", &jpeg(65_535, 65_535), &["16384"]),
        refused("a JPEG header of 16,384 pixels a side", &jpeg(16_384, 16_384), &["limit"]),
        refused("a JPEG header of 0 pixels", &jpeg(0, 8), &[]),
        refused("a GIF", b"GIF89a", &["neither PNG nor JPEG"]),
        refused("an image of nothing", &[], &[]),
    ];
    for length in [1, 8, 16, 33, good.len() / 2, good.len() - 1] {
        // The last byte is of a checksum that nobody needs.
        let cut = &good[..length];
        cases.push(match length + 12 < good.len() {
            true => refused(&format!("a PNG cut after {length} bytes"), cut, &[]),
            false => Case::drawn(format!("a PNG cut after {length} bytes"), shown(cut).glb()),
        });
    }
    let mut wrong = good.clone();
    let middle = wrong.len() / 2;
    wrong[middle] ^= 0xff;
    cases.push(refused("a PNG with a wrong byte", &wrong, &["cannot be decoded"]));

    // What zeros pack to: a thousandth.
    let bomb = |side: u32, depth: u8| {
        let row = 4 * side as usize * usize::from(depth / 8) + 1;
        [header(side, side, depth, 6), chunk(b"IDAT", &zeros(row * side as usize)), end.clone()].concat()
    };
    cases.push(refused("a PNG of a gigabyte in a megabyte", &bomb(16_384, 8), &["limit"]));
    cases.push(refused("a PNG of 512 MiB, 16 bits a channel", &bomb(8_192, 16), &["limit"]));
    cases.push(Case::drawn("a PNG of 64 MiB in 64 KiB", shown(&bomb(4_096, 8)).glb()));
    // A colour profile that unpacks to a gigabyte stands before the pixels.
    let profile = chunk(b"iCCP", &[b"p\0\0".to_vec(), zeros(1 << 30)].concat());
    let mut bomb = header(8, 8, 8, 6);
    bomb.extend(profile);
    bomb.extend(&good[33..]);
    cases.push(refused("a colour profile of a gigabyte", &bomb, &[]).either());
    let flat = png(2048, 2048);
    let mut many = shown(&flat);
    for index in 1..400 {
        many.push("images", json!({"bufferView": 1, "mimeType": "image/png"}));
        many.push("textures", json!({"source": index}));
        many.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": index}}}));
    }
    cases.push(Case::refused("one picture as 400 images", many.glb(), &["image 8", "limit"]));
    let mut outside = GltfFile::triangle();
    outside.push("images", json!({"uri": "../secret.png"}));
    outside.push("textures", json!({"source": 0}));
    outside.push("materials", json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}));
    cases.push(Case::refused("an image outside the folder", outside.glb(), &["image 0", "scene's folder"]));
    cases
}

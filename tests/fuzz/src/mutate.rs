//! Mutations of a scene file that keep its JSON whole, so that what is changed is what the importer reads and not only
//! what the JSON parser does: values replaced by hard ones, members dropped and moved, elements repeated.

use serde_json::{Map, Value, json};

/// A file with its first byte, which is the target's and not the file's.
struct Parts {
    first: u8,
    document: Value,
    binary: Vec<u8>,
}

/// PCG (O'Neill 2014): the fuzzer gives one number, a mutation needs several.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % end.max(1)
    }

    fn of<'a, T>(&mut self, values: &'a [T]) -> &'a T {
        &values[self.below(values.len())]
    }
}

const NUMBERS: [f64; 24] = [
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    12.0,
    36.0,
    255.0,
    256.0,
    5120.0,
    5121.0,
    5123.0,
    5125.0,
    5126.0,
    -1.0,
    0.5,
    2147483648.0,
    4294967295.0,
    4294967296.0,
    9223372036854775807.0,
    18446744073709551615.0,
    3e38,
    1e300,
];

const WORDS: [&str; 34] = [
    "SCALAR",
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT2",
    "MAT3",
    "MAT4",
    "OPAQUE",
    "MASK",
    "BLEND",
    "LINEAR",
    "STEP",
    "CUBICSPLINE",
    "translation",
    "rotation",
    "scale",
    "weights",
    "pointer",
    "perspective",
    "orthographic",
    "directional",
    "point",
    "spot",
    "a.bin",
    "a.png",
    "%2e%2e/a.bin",
    "/etc/passwd",
    "data:;base64,AAAAAAAAAAA=",
    "data:,%00%00",
    "image/png",
    "2.0",
    "KHR_lights_punctual",
    "KHR_materials_unlit",
    "KHR_draco_mesh_compression",
];

const KEYS: [&str; 60] = [
    "POSITION",
    "NORMAL",
    "TANGENT",
    "TEXCOORD_0",
    "TEXCOORD_1",
    "COLOR_0",
    "JOINTS_0",
    "WEIGHTS_0",
    "JOINTS_1",
    "WEIGHTS_1",
    "indices",
    "mode",
    "material",
    "targets",
    "attributes",
    "mesh",
    "skin",
    "camera",
    "children",
    "matrix",
    "translation",
    "rotation",
    "scale",
    "weights",
    "bufferView",
    "byteOffset",
    "byteLength",
    "byteStride",
    "count",
    "componentType",
    "type",
    "normalized",
    "sparse",
    "min",
    "max",
    "uri",
    "buffer",
    "joints",
    "inverseBindMatrices",
    "skeleton",
    "sampler",
    "samplers",
    "channels",
    "input",
    "output",
    "interpolation",
    "target",
    "node",
    "path",
    "extensions",
    "extensionsUsed",
    "extensionsRequired",
    "scene",
    "source",
    "index",
    "texCoord",
    "alphaMode",
    "alphaCutoff",
    "doubleSided",
    "name",
];

/// The custom mutator of the importer's target: `data[..size]` becomes another input of at most `max_size` bytes, whose
/// length it returns. `plain` is the fuzzer's own mutation.
pub fn file(
    data: &mut [u8],
    size: usize,
    max_size: usize,
    seed: u32,
    plain: fn(&mut [u8], usize, usize) -> usize,
) -> usize {
    let mut random = Random(u64::from(seed));
    let parts = if random.below(8) == 0 { None } else { split(&data[..size]) };
    let Some(mut parts) = parts else { return plain(data, size, max_size) };
    for _ in 0..=random.below(4) {
        match random.below(6) {
            0 if !parts.binary.is_empty() => bytes(&mut parts.binary, &mut random),
            1 => parts.first = random.below(256) as u8,
            _ => value(&mut parts.document, &mut random),
        }
    }
    let whole = join(&parts);
    if whole.len() > max_size.min(data.len()) {
        return plain(data, size, max_size);
    }
    data[..whole.len()].copy_from_slice(&whole);
    whole.len()
}

fn split(input: &[u8]) -> Option<Parts> {
    let (first, bytes) = input.split_first()?;
    if bytes.first() == Some(&b'{') {
        return Some(Parts { first: *first, document: serde_json::from_slice(bytes).ok()?, binary: Vec::new() });
    }
    let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
    let document = serde_json::from_slice(bytes.get(20..20usize.checked_add(length)?)?).ok()?;
    let binary = bytes.get(28 + length..).unwrap_or_default().to_vec();
    Some(Parts { first: *first, document, binary })
}

fn join(parts: &Parts) -> Vec<u8> {
    let mut text = parts.document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut whole = vec![parts.first];
    whole.extend(b"glTF\x02\0\0\0");
    whole.extend((28 + text.len() as u32 + parts.binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &parts.binary)] {
        whole.extend((chunk.len() as u32).to_le_bytes());
        whole.extend(kind);
        whole.extend(chunk);
    }
    whole
}

/// Changes a word or a byte of the binary chunk.
fn bytes(binary: &mut [u8], random: &mut Random) {
    const HARD: [f32; 10] = [0.0, -0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, f32::MAX, f32::MIN_POSITIVE, 1e-45, 1e20];
    let at = random.below(binary.len());
    match binary.get_mut(at / 4 * 4..at / 4 * 4 + 4) {
        Some(word) if random.below(2) == 0 => word.copy_from_slice(&random.of(&HARD).to_le_bytes()),
        _ => binary[at] = random.below(256) as u8,
    }
}

/// Changes something below `root`: walks down at random and stops at random.
fn value(root: &mut Value, random: &mut Random) {
    let other = part(root, random).clone();
    walk(root, other, random);
}

fn walk(at: &mut Value, other: Value, random: &mut Random) {
    let stop = random.below(5) == 0;
    match at {
        Value::Object(members) if !members.is_empty() => {
            if stop {
                return member(members, other, random);
            }
            let which = random.below(members.len());
            walk(members.values_mut().nth(which).unwrap(), other, random);
        }
        Value::Array(elements) if !elements.is_empty() => {
            if stop {
                return element(elements, other, random);
            }
            let which = random.below(elements.len());
            walk(&mut elements[which], other, random);
        }
        leaf => replace(leaf, other, random),
    }
}

/// Some value below `root`, to be put elsewhere.
fn part<'a>(root: &'a Value, random: &mut Random) -> &'a Value {
    let mut at = root;
    while random.below(6) > 0 {
        at = match at {
            Value::Object(members) if !members.is_empty() => members.values().nth(random.below(members.len())).unwrap(),
            Value::Array(elements) if !elements.is_empty() => random.of(elements),
            _ => break,
        };
    }
    at
}

fn member(members: &mut Map<String, Value>, other: Value, random: &mut Random) {
    let which = random.below(members.len());
    let key = members.keys().nth(which).unwrap().clone();
    match random.below(4) {
        0 => {
            members.remove(&key);
        }
        1 => {
            members.insert((*random.of(&KEYS)).to_owned(), other);
        }
        2 => {
            members.insert((*random.of(&KEYS)).to_owned(), json!(random.below(8)));
        }
        _ => {
            let moved = members.remove(&key).unwrap();
            members.insert((*random.of(&KEYS)).to_owned(), moved);
        }
    }
}

fn element(elements: &mut Vec<Value>, other: Value, random: &mut Random) {
    let which = random.below(elements.len());
    match random.below(4) {
        0 => {
            elements.remove(which);
        }
        1 => elements.push(other),
        2 => elements.push(elements[which].clone()),
        _ => elements.swap(0, which),
    }
}

fn replace(leaf: &mut Value, other: Value, random: &mut Random) {
    *leaf = match (&*leaf, random.below(4)) {
        (_, 0) => other,
        (Value::Number(number), 1) if number.is_u64() => {
            let number = number.as_u64().unwrap();
            json!(if random.below(2) == 0 { number.wrapping_add(1) } else { number.saturating_sub(1) })
        }
        (Value::Number(_), _) => match *random.of(&NUMBERS) {
            // Integers as integers: indices and counts are read as such.
            whole if whole >= 0.0 && whole.fract() == 0.0 && whole < 1e30 => json!(whole as u64),
            number => json!(number),
        },
        (Value::Bool(flag), _) => json!(!flag),
        (Value::String(_), _) => json!(random.of(&WORDS)),
        _ => json!(random.below(4)),
    };
}

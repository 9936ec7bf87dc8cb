//! URIs of buffers and images: embedded data, or a file that must not lie outside the scene's folder.
//!
//! A scene file may come from a stranger; it must not be able to make the renderer read (and, through a report or a
//! picture, show) any other file of the machine.

use std::path::{Component, Path, PathBuf};

use crate::error::{Error, Result};

/// What a URI points at.
#[derive(Debug, PartialEq)]
pub enum Target {
    /// The bytes of a data URI.
    Data(Vec<u8>),
    /// A path relative to the scene's folder, inside it.
    File(PathBuf),
}

/// Decodes a URI.
///
/// Refuses schemes other than `data:`, absolute paths, and paths that climb out of the folder.
pub fn resolve(uri: &str) -> Result<Target> {
    if let Some(data) = strip_scheme(uri, "data:") {
        return decode_data(data).map(Target::Data);
    }
    // A colon before the first slash ends a scheme (RFC 3986, section 3.1).
    if uri.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err(refused(uri, "has a scheme"));
    }
    let decoded = String::from_utf8(decode_percent(uri)).map_err(|_| refused(uri, "is not UTF-8"))?;
    relative_path(&decoded).map(Target::File)
}

fn strip_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let head = uri.get(..scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then(|| &uri[scheme.len()..])
}

fn refused(uri: &str, why: &str) -> Error {
    // A URI may be megabytes long.
    let shown: String = uri.chars().take(80).collect();
    Error::request(format!("the URI {shown:?} {why}"))
        .note("what is read: data URIs, and files in the scene's folder or below it, by a relative path with '/'")
}

/// Splits at '/', resolves '.' and '..', and keeps the path inside the folder.
fn relative_path(decoded: &str) -> Result<PathBuf> {
    let mut segments: Vec<&str> = Vec::new();
    if decoded.starts_with('/') {
        return Err(refused(decoded, "is an absolute path"));
    }
    for segment in decoded.split('/') {
        match segment {
            "" | "." => {}
            ".." => {
                segments.pop().ok_or_else(|| refused(decoded, "leaves the scene's folder"))?;
            }
            _ => {
                // On Windows `C:` and `a\..\b` are more than one plain name; elsewhere '\' is refused alike, so that a
                // file is good or bad on all systems.
                let mut components = Path::new(segment).components();
                let plain = matches!(components.next(), Some(Component::Normal(_))) && components.next().is_none();
                if !plain || segment.contains(['\\', '\0']) {
                    return Err(refused(decoded, "has a part that is not a plain file name"));
                }
                segments.push(segment);
            }
        }
    }
    if segments.is_empty() {
        return Err(refused(decoded, "names no file"));
    }
    Ok(segments.iter().collect())
}

/// `%41` to `A`. A '%' without two hexadecimal digits stays as it is: exporters forget to encode it.
fn decode_percent(text: &str) -> Vec<u8> {
    let mut decoded = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if let (b'%', [high, low, tail @ ..]) = (first, tail)
            && let (Some(high), Some(low)) = (hex_digit(*high), hex_digit(*low))
        {
            decoded.push(16 * high + low);
            rest = tail;
        } else {
            decoded.push(*first);
        }
    }
    decoded
}

fn hex_digit(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).map(|value| value as u8)
}

/// What follows `data:`: `[type][;base64],payload`.
fn decode_data(data: &str) -> Result<Vec<u8>> {
    let Some((head, payload)) = data.split_once(',') else {
        return Err(Error::request("a data URI has no comma between its type and its data"));
    };
    if head.to_ascii_lowercase().ends_with(";base64") { decode_base64(payload) } else { Ok(decode_percent(payload)) }
}

/// RFC 4648's standard alphabet; padding may be missing.
fn decode_base64(payload: &str) -> Result<Vec<u8>> {
    let digits = payload.trim_end_matches('=').as_bytes();
    let mut decoded = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    for (group_index, group) in digits.chunks(4).enumerate() {
        let mut bits = 0u32;
        for (place, digit) in group.iter().enumerate() {
            let value = base64_digit(*digit).ok_or_else(|| {
                let at = 4 * group_index + place;
                Error::request(format!("a data URI has byte 0x{digit:02x} at place {at}, which is not base64"))
            })?;
            bits |= u32::from(value) << (18 - 6 * place);
        }
        if group.len() == 1 {
            return Err(Error::request("a data URI ends inside a base64 group: its data is cut short"));
        }
        decoded.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Ok(decoded)
}

fn base64_digit(digit: u8) -> Option<u8> {
    match digit {
        b'A'..=b'Z' => Some(digit - b'A'),
        b'a'..=b'z' => Some(digit - b'a' + 26),
        b'0'..=b'9' => Some(digit - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_escapes_decode_and_stray_percents_stay() {
        assert_eq!(decode_percent("a%20b%C3%A4"), "a bä".as_bytes());
        assert_eq!(decode_percent("100%.bin"), b"100%.bin");
        assert_eq!(decode_percent("%4"), b"%4");
        assert_eq!(decode_percent("%+f"), b"%+f");
    }

    #[test]
    fn base64_decodes_all_lengths_and_names_a_bad_byte() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm8", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob")]
        {
            assert_eq!(decode_base64(text).unwrap(), bytes.as_bytes());
        }
        assert_eq!(resolve("DATA:image/png;base64,/+8=").unwrap(), Target::Data(vec![0xff, 0xef]));
        assert_eq!(resolve("data:,a%20b").unwrap(), Target::Data(b"a b".to_vec()));
        assert!(decode_base64("Zm9*").unwrap_err().message().contains("0x2a at place 3"));
        assert!(decode_base64("Zm9vY").unwrap_err().message().contains("cut short"));
    }

    #[test]
    fn a_path_stays_in_the_folder() {
        assert_eq!(resolve("a/./b%20c/../d.bin").unwrap(), Target::File(PathBuf::from("a/d.bin")));
        assert_eq!(resolve("./x.bin").unwrap(), Target::File(PathBuf::from("x.bin")));
        for bad in [
            "../x.bin",
            "a/../../x.bin",
            "/etc/passwd",
            "%2e%2e/x.bin",
            "a/..%2f..%2fx.bin",
            "%2Fetc/passwd",
            "file:///x",
            "https://example.org/x.bin",
            "C:/x.bin",
            "..\\x.bin",
            "a%5c..%5c..%5cx",
            "x%00.bin",
            "",
            ".",
            "a/..",
            "%ff.bin",
        ] {
            let error = resolve(bad).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{bad}");
            assert!(error.to_string().contains("scene's folder"), "{bad}: {error}");
        }
    }
}

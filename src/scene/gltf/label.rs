//! How messages name the elements of a file: by index, and by name where there is one.

use crate::error::Error;
use crate::scene::gltf::label;
/// How much of a name is shown: a file may have one of megabytes.
const SHOWN_CHARS: usize = 80;

/// `kind 3 "name"`, or `kind 3` where the file gives no name.
pub fn element(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} {:?}", shown(name)),
        _ => format!("{kind} {index}"),
    }
}

/// The beginning of a text of the file's.
pub fn shown(text: &str) -> String {
    let mut shown: String = text.chars().take(SHOWN_CHARS).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    shown
}

/// The first of `names`, which are the file's, and how many more there are.
pub fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const SHOWN_NAMES: usize = 8;
    let mut names = names.map(|name| shown(name).escape_debug().to_string());
    let first: Vec<String> = names.by_ref().take(SHOWN_NAMES).collect();
    match names.count() {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}

/// `element` of a node.
pub fn node(document: &gltf::Document, index: usize) -> String {
    element("node", index, document.nodes().nth(index).and_then(|node| node.name()))
}

/// `1 mesh is`, `2 meshes are`.
pub fn count(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// A message of the parser's, which may quote the file: its beginning, and the place at its end.
pub fn json_error(error: &serde_json::Error) -> Error {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let what = text.strip_suffix(&place).unwrap_or(&text);
    let refused = Error::request(format!("is not glTF 2.0 JSON: {}{place}", label::shown(what).escape_debug()));
    if error.is_eof() { refused.note("the file seems cut short") } else { refused }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_shows_its_name_where_it_has_one() {
        assert_eq!(element("mesh", 3, Some("door")), "mesh 3 \"door\"");
        assert_eq!(element("mesh", 3, None), "mesh 3");
        assert_eq!(shown(&"x".repeat(1000)).len(), SHOWN_CHARS + 3);
        assert_eq!(list(["a"; 10].into_iter()), "a, a, a, a, a, a, a, a and 2 more");
        assert_eq!(list(["\u{1b}[2J"].into_iter()), "\\u{1b}[2J");
        assert_eq!(count(1, "mesh is", "meshes are"), "1 mesh is");
        assert_eq!(count(2, "mesh is", "meshes are"), "2 meshes are");
    }
}

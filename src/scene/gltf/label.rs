//! How messages name the elements of a file: by index, and by name where there is one.

/// `kind 3 "name"`, or `kind 3` where the file gives no name.
pub fn element(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} {name:?}"),
        _ => format!("{kind} {index}"),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_shows_its_name_where_it_has_one() {
        assert_eq!(element("mesh", 3, Some("door")), "mesh 3 \"door\"");
        assert_eq!(element("mesh", 3, None), "mesh 3");
        assert_eq!(count(1, "mesh is", "meshes are"), "1 mesh is");
        assert_eq!(count(2, "mesh is", "meshes are"), "2 meshes are");
    }
}

//! The house's walls: rooms import downward alone, and no files name each other in a circle.

mod imports;

use imports::{Import, circles, imports};
use std::collections::BTreeSet;
use std::path::Path;

/// The rooms of src/ from the ground up: each may name what lies on lower floors. docs/architecture.md draws them.
const FLOORS: &[&[&str]] = &[
    &["choice", "error", "progress", "spirv", "svg", "units", "user_folder"],
    &["caps", "interrupt", "page", "whole_file"],
    &["sampling"],
    &["memory", "picture", "volume"],
    &["gpu", "metrics", "scene", "settings"],
    &["bvh", "framing", "plan", "shading"],
    &["frame"],
    &["lens", "lights", "resident"],
    &["passes"],
    &["techniques"],
    &["report"],
    &["locality", "preset", "session"],
    &["reference"],
    &["continuation"],
    &["job"],
    &["sequence"],
    &["bench", "selftest", "study"],
    &["papers", "tune"],
    &["cli"],
    // The crate's front pages.
    &["lib", "main"],
];

fn all() -> Vec<Import> {
    imports(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), "quincunx")
}

/// The folder or file below src/.
fn room(file: &Path) -> String {
    file.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs").to_owned()
}

fn floor(file: &Path) -> usize {
    let name = room(file);
    let found = FLOORS.iter().position(|rooms| rooms.contains(&name.as_str()));
    found.unwrap_or_else(|| panic!("src/{}: FLOORS does not say where {name} lies", file.display()))
}

fn line(Import { file, line, target, name }: &Import) -> String {
    format!("src/{}:{line} names {name} of src/{}", file.display(), target.display())
}

#[test]
fn rooms_import_downward() {
    let is_upward =
        |import: &&Import| room(&import.file) != room(&import.target) && floor(&import.file) <= floor(&import.target);
    let upward: Vec<String> = all().iter().filter(is_upward).map(line).collect();
    assert!(upward.is_empty(), "{} imports do not look down:\n{}", upward.len(), upward.join("\n"));
}

#[test]
fn no_files_name_each_other_in_a_circle() {
    let all = all();
    let arrows: BTreeSet<_> = all.iter().map(|import| (import.file.clone(), import.target.clone())).collect();
    let ties = |circle: &Vec<_>| -> Vec<String> {
        all.iter().filter(|tie| circle.contains(&tie.file) && circle.contains(&tie.target)).map(line).collect()
    };
    let found: Vec<String> = circles(&arrows).iter().map(|circle| ties(circle).join("\n")).collect();
    assert!(found.is_empty(), "{} circles:\n{}", found.len(), found.join("\n\n"));
}

/// What the tests above would see: uses, groups, renamings, paths in code and in macros, names that are handed on; and not what
/// tests name.
#[test]
fn every_way_to_name_something_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("lib.rs", "pub mod a; pub mod b; pub mod c;");
    write("a.rs", "pub struct A; pub fn made() -> u32 { 1 } pub const LEAST: u32 = 1;");
    write("b/mod.rs", "mod inner; pub use inner::{Inner, B as Renamed};");
    write("b/inner.rs", "use crate::a::{self, A}; pub struct Inner(A); pub struct B; fn f() { a::made(); }");
    write(
        "c.rs",
        "use crate::b::Renamed;\nfn f(_: crate::b::Inner) { println!(\"{}\", quincunx::a::LEAST); let _: Renamed; }\n\
         #[cfg(test)]\nmod tests { use crate::a::made; }",
    );
    let seen: Vec<String> = imports(folder.path(), "quincunx").iter().map(line).collect();
    let expected = [
        "src/b/inner.rs:1 names A of src/a.rs",
        "src/b/inner.rs:1 names made of src/a.rs",
        "src/c.rs:2 names LEAST of src/a.rs",
        "src/c.rs:1 names B of src/b/inner.rs",
        "src/c.rs:2 names Inner of src/b/inner.rs",
    ];
    assert_eq!(seen, expected);
    let arrows = BTreeSet::from([("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")]);
    assert_eq!(circles(&arrows), [["a", "b", "c"]]);
}

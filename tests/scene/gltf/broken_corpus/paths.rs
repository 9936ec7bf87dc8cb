//! URIs, links and files that would make the renderer read what does not belong to the scene, or never end.

use super::Case;
use crate::support::gltf_file::GltfFile;
use serde_json::json;
use std::path::Path;

/// A triangle whose positions are in the file that `uri` names.
fn outside(name: &str, uri: &str, words: &[&str]) -> Case {
    let mut file = GltfFile::triangle();
    let bytes = std::mem::take(&mut file.bytes);
    file.json["buffers"] = json!([{"byteLength": bytes.len(), "uri": uri}]);
    // What it must not reach, beside the scene's folder, would make a good picture.
    Case::refused(name, file.glb(), words).with_file("../secret.bin", bytes)
}

fn link(folder: &Path) {
    std::os::unix::fs::symlink("../secret.bin", folder.join("link.bin")).unwrap();
}

fn linked_folder(folder: &Path) {
    std::os::unix::fs::symlink("..", folder.join("up")).unwrap();
}

fn link_inside(folder: &Path) {
    std::fs::rename(folder.join("../secret.bin"), folder.join("real.bin")).unwrap();
    std::os::unix::fs::symlink("real.bin", folder.join("link.bin")).unwrap();
}

fn circle(folder: &Path) {
    std::os::unix::fs::symlink("link.bin", folder.join("link.bin")).unwrap();
}

fn pipe(folder: &Path) {
    let path = std::ffi::CString::new(folder.join("pipe.bin").to_str().unwrap()).unwrap();
    // SAFETY: a path that ends with a zero.
    assert_eq!(unsafe { libc::mkfifo(path.as_ptr(), 0o600) }, 0);
}

fn device(folder: &Path) {
    std::os::unix::fs::symlink("/dev/zero", folder.join("link.bin")).unwrap();
}

/// A terabyte that takes no room on the disk.
fn hole(folder: &Path) {
    std::fs::File::create(folder.join("hole.bin")).unwrap().set_len(1 << 40).unwrap();
}

pub fn cases() -> Vec<Case> {
    let leaves = &["buffer 0", "scene's folder"][..];
    let mut cases: Vec<Case> = [
        ("a URI with ..", "../secret.bin"),
        ("a URI with .. behind a folder", "a/../../secret.bin"),
        ("a URI with %2e%2e", "%2e%2e/secret.bin"),
        ("a URI with %2E%2E%2F", "%2E%2E%2Fsecret.bin"),
        ("a URI with a backslash", "..\\secret.bin"),
        ("an absolute path", "/etc/passwd"),
        ("an absolute path, encoded", "%2Fetc%2Fpasswd"),
        ("a file: URI", "file:///etc/passwd"),
        ("an https: URI", "https://example.org/a.bin"),
        ("a URI with a zero", "secret.bin%00"),
        ("a URI of nothing", ""),
        ("a URI of a dot", "."),
    ]
    .map(|(name, uri)| outside(name, uri, leaves))
    .into();
    cases.push(outside("a link to a file outside", "link.bin", &["buffer 0", "link.bin", "outside"]).prepared(link));
    cases.push(outside("a folder that is a link", "up/secret.bin", &["buffer 0", "outside"]).prepared(linked_folder));
    cases.push(outside("a link to itself", "link.bin", &["buffer 0", "cannot be read"]).prepared(circle));
    cases.push(outside("a link to a device", "link.bin", &["buffer 0", "outside"]).prepared(device));
    cases.push(outside("a pipe", "pipe.bin", &["buffer 0", "not a regular file"]).prepared(pipe));
    cases.push(outside("a file of a terabyte", "hole.bin", &["buffer 0", "1.00 TiB"]).prepared(hole));
    cases.push(outside("a missing file", "gone.bin", &["buffer 0", "gone.bin", "no such file"]));
    cases.push(outside("a folder", "..", &["buffer 0"]));
    for (name, uri, words) in [
        ("a byte that is not base64", "data:;base64,AA*A", &["buffer 0", "0x2a"][..]),
        ("base64 that ends in a group", "data:;base64,AAAAA", &["buffer 0", "cut short"]),
        ("base64 with = in the middle", "data:;base64,AA==AAAA", &["buffer 0", "0x3d"]),
        ("base64 that is too short", "data:;base64,AAAA", &["buffer 0", "3 are there"]),
        ("a data URI without a comma", "data:;base64", &["buffer 0", "comma"]),
    ] {
        cases.push(outside(name, uri, words));
    }
    let inside = outside("a link inside the folder", "link.bin", &[]).prepared(link_inside);
    cases.push(Case { end: super::End::Picture, ..inside });
    cases
}

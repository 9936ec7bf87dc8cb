//! Shaders that count, as modules: each is valid, whatever it binds.

use crate::support::skip;
use quincunx::gpu::shader;
use quincunx::gpu::shader::gpu::marks::{COMP_BOTH, COMP_OWN};
use quincunx::spirv::counting::{Attribute, Counters, counting};
use std::io::ErrorKind;
use std::process::Command;

fn attribute(location: u32) -> Attribute {
    Attribute { location, stream: location.min(2), stride_bytes: 48, offset_bytes: 4, bytes: 12 }
}

/// Calls in `main` of glsl/gpu/marks.comp.
const CALLS_OF_MAIN: usize = 6;

/// How often a module says OpFunctionCall.
fn calls(words: &[u32]) -> usize {
    let (mut at, mut count) = (5, 0);
    while at < words.len() {
        count += usize::from(words[at] & 0xffff == 57);
        at += (words[at] >> 16) as usize;
    }
    count
}

#[test]
fn every_shader_that_counts_is_valid_for_vulkan_1_3() {
    let folder = tempfile::tempdir().unwrap();
    let (own, both) = (COMP_OWN.words(), COMP_BOTH.words());
    let attributes: Vec<Attribute> = (0..6).map(attribute).collect();
    let inner = calls(&own) - CALLS_OF_MAIN;
    assert_eq!(inner, calls(&both) - CALLS_OF_MAIN);
    let mut can_be_checked = true;
    for shader in shader::ALL.iter().filter(|shader| shader.name != COMP_OWN.name) {
        let counts = counting(&shader.words(), &Counters { own: &own, both: &both }, &attributes);
        let counts = counts.unwrap_or_else(|fault| panic!("{}: {fault}", shader.label()));
        // What is brought in has calls of its own, and `main` stays behind.
        let added = calls(&counts) - calls(&shader.words()) - inner;
        assert!(added > 0 || shader.bindings.is_empty(), "{}: nothing is counted", shader.label());
        if !can_be_checked {
            continue;
        }
        let file = folder.path().join(shader.label());
        let bytes: Vec<u8> = counts.iter().flat_map(|word| word.to_le_bytes()).collect();
        std::fs::write(&file, bytes).unwrap();
        let output = match Command::new("spirv-val").args(["--target-env", "vulkan1.3"]).arg(&file).output() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                skip("spirv-val is not installed (Debian and Ubuntu: apt-get install spirv-tools)");
                can_be_checked = false;
                continue;
            }
            output => output.unwrap(),
        };
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", shader.label());
    }
}

#[test]
fn what_is_no_module_is_said_to_be_none() {
    let words = COMP_OWN.words();
    let counters = Counters { own: &words, both: &words };
    for broken in [&words[..0], &words[..3], &words[..words.len() - 1]] {
        assert!(counting(broken, &counters, &[]).is_err(), "{} words", broken.len());
    }
}

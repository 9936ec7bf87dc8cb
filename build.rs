//! glsl/ to SPIR-V, a table of what each shader binds, and the host's twins of the structs it reads.
//!
//! Reads   every file below glsl/: .vert .geom .frag .comp are entry points, .glsl is only included.
//! Writes  $OUT_DIR/shaders.rs: modules that mirror glsl/, each entry point a `Shader`, each struct named ...Params or
//!         ...Block a `#[repr(C)]` struct with its offsets asserted, each `const uint` or `const float` that is a number
//!         a Rust constant of the same name; and one .spv file beside it per variant.
//! Stops   with file:line:col at a GLSL error, at an entry point without its Rust file, at a struct name used twice,
//!         at a constant with two values in one module.
//!
//! One definition, one direction: numbers of sets, bindings, constants and offsets are typed in GLSL only.

#[path = "tools/build/compile.rs"]
mod compile;
#[path = "tools/build/constants.rs"]
mod constants;
#[path = "tools/build/structs.rs"]
mod structs;
#[path = "tools/build/table.rs"]
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What went wrong, each line as cargo shows it: path:line:column: message.
type Faults = Vec<String>;

fn main() -> ExitCode {
    println!("cargo::rerun-if-changed=glsl");
    println!("cargo::rerun-if-changed=tools/build");
    println!("cargo::rerun-if-changed=build.rs");
    // The report says which commit it came from; outside a checkout it says "unknown".
    // A path that does not exist would make every build run this again.
    for path in [".git/HEAD", ".git/logs/HEAD"] {
        if Path::new(path).exists() {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    println!("cargo::rustc-env=QUINCUNX_COMMIT={}", commit());
    let out = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    match generate(Path::new("glsl"), &out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(faults) => {
            for fault in faults {
                println!("cargo::error={fault}");
            }
            ExitCode::FAILURE
        }
    }
}

fn commit() -> String {
    let output = std::process::Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout).trim().to_owned(),
        _ => "unknown".to_owned(),
    }
}

fn generate(root: &Path, out: &Path) -> Result<(), Faults> {
    let sources = compile::Sources::read(root)?;
    let structs = structs::Structs::find(&sources)?;
    let constants = constants::Constants::find(&sources)?;
    let mut table = table::Table::default();
    let mut faults = Faults::new();
    for entry in sources.entry_points() {
        if let Err(fault) = mirrored(&entry.name) {
            faults.push(fault);
            continue;
        }
        for variant in entry.variants() {
            match sources.compile(&entry, &variant) {
                Ok(words) => {
                    let file = format!("{}{}.spv", entry.name.replace('/', "."), variant.suffix().to_lowercase());
                    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                    std::fs::write(out.join(&file), bytes).map_err(|error| vec![format!("writing {file}: {error}")])?;
                    match table::Row::reflect(&entry, &variant, &words, file) {
                        Ok(row) => table.rows.push(row),
                        Err(fault) => faults.push(format!("glsl/{}:1:1: {fault}", entry.name)),
                    }
                }
                Err(mut more) => faults.append(&mut more),
            }
            if entry.portable
                && let Err(fault) = structs::portable(&sources, &entry, &variant)
            {
                faults.push(format!("glsl/{}:1:1: marked portable, but naga says: {fault}", entry.name));
            }
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let text = table::write(&table, &structs, &constants);
    std::fs::write(out.join("shaders.rs"), text).map_err(|error| vec![format!("writing shaders.rs: {error}")])
}

/// Drop the first folder and the extension, and a shader and its pass have the same path.
fn mirrored(name: &str) -> Result<(), String> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let file = PathBuf::from(format!("src/{stem}.rs"));
    let folder = PathBuf::from(format!("src/{stem}/mod.rs"));
    if file.exists() || folder.exists() {
        Ok(())
    } else {
        Err(format!(
            "glsl/{name}:1:1: a shader without its pass: neither {} nor {} exists",
            file.display(),
            folder.display()
        ))
    }
}

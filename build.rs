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

use compile::{EntryPoint, Variant};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

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
    let mut faults = Faults::new();
    let mut variants = Vec::new();
    for entry in sources.entry_points() {
        match mirrored(&entry.name) {
            Ok(()) => variants.extend(entry.variants().into_iter().map(|variant| (entry.clone(), variant))),
            Err(fault) => faults.push(fault),
        }
    }
    let mut table = table::Table::default();
    for made in side_by_side(&variants, |(entry, variant)| row(&sources, entry, variant, out)) {
        match made {
            Ok(row) => table.rows.push(row),
            Err(mut more) => faults.append(&mut more),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let text = table::write(&table, &structs, &constants);
    std::fs::write(out.join("shaders.rs"), text).map_err(|error| vec![format!("writing shaders.rs: {error}")])
}

/// Writes a variant's SPIR-V; what it binds.
fn row(sources: &compile::Sources, entry: &EntryPoint, variant: &Variant, out: &Path) -> Result<table::Row, Faults> {
    let words = sources.compile(entry, variant)?;
    let file = format!("{}{}.spv", entry.name.replace('/', "."), variant.suffix().to_lowercase());
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    std::fs::write(out.join(&file), bytes).map_err(|error| vec![format!("writing {file}: {error}")])?;
    let at_entry = |fault: String| vec![format!("glsl/{}:1:1: {fault}", entry.name)];
    let row = table::Row::reflect(entry, variant, &words, file).map_err(at_entry)?;
    if entry.portable {
        structs::portable(sources, entry, variant)
            .map_err(|fault| at_entry(format!("marked portable, but naga says: {fault}")))?;
    }
    Ok(row)
}

/// What `work` makes of each, in their order: on as many threads as the machine has, because glslang takes one.
fn side_by_side<T: Sync, R: Send>(all: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let turns = || {
        let turn = || {
            let index = next.fetch_add(1, Ordering::Relaxed);
            all.get(index).map(|item| (index, work(item)))
        };
        std::iter::from_fn(turn).collect::<Vec<_>>()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut made: Vec<(usize, R)> = std::thread::scope(|scope| {
        let started: Vec<_> = (0..threads).map(|_| scope.spawn(turns)).collect();
        started.into_iter().flat_map(|thread| thread.join().expect("no thread of a build panics")).collect()
    });
    made.sort_by_key(|(index, _)| *index);
    made.into_iter().map(|(_, result)| result).collect()
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

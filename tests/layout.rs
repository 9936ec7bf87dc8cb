//! The house rules that a program can check: the mirror, the walls between rooms, the size of files, valid shaders.

use crate::support;
use quincunx::gpu::shader;
use quincunx::techniques::settings_of;
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

const ENTRY_POINTS: [&str; 4] = ["vert", "geom", "frag", "comp"];
const MOST_LINES: usize = 500;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Every file below `folder`, with its path from there, sorted.
fn files(folder: &str) -> Vec<PathBuf> {
    fn walk(folder: &Path, found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { walk(&path, found) } else { found.push(path) }
        }
    }
    let folder = root().join(folder);
    let mut found = Vec::new();
    walk(&folder, &mut found);
    found.sort();
    found.into_iter().map(|path| path.strip_prefix(&folder).unwrap().to_owned()).collect()
}

fn entry_points() -> Vec<PathBuf> {
    let is_entry =
        |path: &PathBuf| path.extension().is_some_and(|extension| ENTRY_POINTS.iter().any(|e| *e == extension));
    files("glsl").into_iter().filter(is_entry).collect()
}

/// The module that a file of src/ is: `techniques::deferred::shade`.
fn module_of(file: &Path) -> String {
    let words: Vec<&str> = file.iter().map(|word| word.to_str().unwrap()).collect();
    let path = words.join("::");
    let path = path.strip_suffix(".rs").unwrap_or(&path);
    path.strip_suffix("::mod").unwrap_or(path).to_owned()
}

/// Lines of a Rust file that are neither comment nor test.
fn code(file: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(root().join("src").join(file)).unwrap();
    let before_tests = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    before_tests.lines().filter(|line| !line.trim_start().starts_with("//")).map(str::to_owned).collect()
}

/// Lines of code below src/`room` that name one of `words`.
fn mentions(room: &str, words: &[&str]) -> Vec<String> {
    files("src")
        .iter()
        .filter(|file| file.starts_with(room) && file.extension().is_some_and(|extension| extension == "rs"))
        .flat_map(|file| {
            let lines = code(file).into_iter().filter(|line| words.iter().any(|word| line.contains(word)));
            lines.map(|line| format!("src/{}: {}", file.display(), line.trim())).collect::<Vec<_>>()
        })
        .collect()
}

#[test]
fn every_shader_is_valid_for_vulkan_1_3() {
    let folder = tempfile::tempdir().unwrap();
    for shader in shader::ALL {
        let file = folder.path().join(shader.label());
        std::fs::write(&file, shader.spirv).unwrap();
        let output = match Command::new("spirv-val").args(["--target-env", "vulkan1.3"]).arg(&file).output() {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return support::skip("spirv-val is not installed (Debian and Ubuntu: apt-get install spirv-tools)");
            }
            output => output.unwrap(),
        };
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", shader.label());
    }
}

#[test]
fn every_entry_point_has_its_pass_and_its_rows_in_the_table() {
    let tabled: BTreeSet<&str> = shader::ALL.iter().map(|shader| shader.name).collect();
    let entries = entry_points();
    for entry in &entries {
        let name = entry.with_extension("");
        let file = root().join("src").join(&name).with_extension("rs");
        let module = root().join("src").join(&name).join("mod.rs");
        assert!(file.is_file() || module.is_file(), "glsl/{} has no src/{}.rs", entry.display(), name.display());
        assert!(tabled.contains(name.to_str().unwrap()), "glsl/{} is not in the table", entry.display());
    }
    let written: BTreeSet<String> =
        entries.iter().map(|entry| entry.with_extension("").to_str().unwrap().to_owned()).collect();
    for name in tabled {
        assert!(written.contains(name), "{name} is in the table and not in glsl/");
    }
}

#[test]
fn no_file_is_longer_than_can_be_read_at_once() {
    let mut long = Vec::new();
    for folder in ["src", "glsl", "tools/build"] {
        for file in files(folder) {
            let Ok(text) = std::fs::read_to_string(root().join(folder).join(&file)) else { continue };
            let lines = text.lines().count();
            if lines > MOST_LINES {
                long.push(format!("{folder}/{}: {lines} lines", file.display()));
            }
        }
    }
    assert_eq!(long, [] as [&str; 0]);
}

/// A file that no other names is not compiled, and its tests do not run.
#[test]
fn every_file_of_tests_is_one_of_the_program() {
    let is_rust = |file: &&PathBuf| file.extension().is_some_and(|extension| extension == "rs");
    // tests/fuzz is a package of its own.
    let rust: Vec<PathBuf> =
        files("tests").iter().filter(is_rust).filter(|file| !file.starts_with("fuzz")).cloned().collect();
    let mut named = BTreeSet::from([PathBuf::from("main.rs")]);
    for file in rust.iter().filter(|file| file.ends_with("main.rs") || file.ends_with("mod.rs")) {
        let text = std::fs::read_to_string(root().join("tests").join(file)).unwrap();
        for line in text.lines() {
            let line = line.strip_prefix("pub ").unwrap_or(line);
            if let Some(name) = line.strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';')) {
                let module = file.with_file_name(name).join("mod.rs");
                let is_folder = root().join("tests").join(&module).is_file();
                named.insert(if is_folder { module } else { file.with_file_name(format!("{name}.rs")) });
            }
        }
    }
    let rust = BTreeSet::from_iter(rust);
    let odd: Vec<&PathBuf> = named.symmetric_difference(&rust).collect();
    assert!(odd.is_empty(), "named by no mod line, or not there: {odd:?}");
}

/// What of tests/ no room of src/ has: it holds for the whole program, or is what tests need.
const BESIDE_ROOMS: [&str; 12] = [
    "compilers",
    "contract",
    "docs",
    "drivers",
    "fuzz",
    "golden",
    "large",
    "layout",
    "main",
    "pretend",
    "rooms",
    "support",
];

#[test]
fn tests_lie_as_the_rooms_lie() {
    let is_there = |path: &Path| path.is_dir() || path.with_extension("rs").is_file();
    for file in files("tests").iter().filter(|file| !file.starts_with("snapshots")) {
        let room = file.iter().next().unwrap().to_str().unwrap().trim_end_matches(".rs");
        let is_of_all = BESIDE_ROOMS.contains(&room);
        let has_room = is_of_all || is_there(&root().join("src").join(room));
        assert!(has_room, "tests/{} is of no room of src/", file.display());
        // Its folders are the room's folders; files of input lie where their tests do.
        let folder = file.parent().filter(|folder| !is_of_all && !folder.ends_with("broken_corpus"));
        let is_of_room = folder.is_none_or(|folder| is_there(&root().join("src").join(folder)));
        assert!(is_of_room, "tests/{}: src/ has no such folder", file.display());
    }
}

/// Whoever reads a choice asks for its enum (`choices!`): no second list of its words stands in the code. A benchmark
/// compares variants by their texts, whatever the setting.
#[test]
fn choices_are_read_as_enums() {
    let settings = quincunx::techniques::ALL.iter().flat_map(|technique| settings_of(*technique));
    let choices: BTreeSet<&str> =
        settings.filter(|setting| setting.choices().is_some()).map(|setting| setting.key).collect();
    let reads = |line: &str| {
        let keys = line.split(".text(\"").skip(1).filter_map(|after| after.split('"').next());
        keys.into_iter().any(|key| choices.contains(key))
    };
    let mut found = Vec::new();
    for file in files("src").iter().filter(|file| file.extension().is_some_and(|extension| extension == "rs")) {
        if file.starts_with("bench") {
            continue;
        }
        let mut lines = code(file);
        lines.retain(|line| reads(line) || line.contains("was checked") && !file.starts_with("settings"));
        found.extend(lines.iter().map(|line| format!("src/{}: {}", file.display(), line.trim())));
    }
    assert_eq!(found, [] as [&str; 0]);
}

#[test]
fn every_file_says_why_it_exists() {
    for file in files("src").iter().filter(|file| file.extension().is_some_and(|extension| extension == "rs")) {
        let text = std::fs::read_to_string(root().join("src").join(file)).unwrap();
        assert!(text.starts_with("//! "), "src/{} has no header", file.display());
    }
    for file in files("glsl").iter().filter(|file| file.extension().is_some_and(|extension| extension != "md")) {
        let text = std::fs::read_to_string(root().join("glsl").join(file)).unwrap();
        assert!(text.starts_with("// "), "glsl/{} has no header", file.display());
    }
}

/// A quad's helper lanes have what is interpolated, and need not have what is read from a buffer: `dFdx` and `dFdy` take inputs
/// of the stage, and a texture that chooses its level itself is read at one.
#[test]
fn levels_of_textures_are_chosen_by_inputs_alone() {
    let mut found = Vec::new();
    for file in files("glsl").iter().filter(|file| file.extension().is_some_and(|extension| extension != "md")) {
        let text = std::fs::read_to_string(root().join("glsl").join(file)).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            let code = line.split("//").next().unwrap();
            let arguments = |name: &str| -> Vec<&str> {
                let calls = code
                    .match_indices(name)
                    .filter(|(at, _)| !code[..*at].ends_with(|before: char| before.is_alphanumeric() || before == '_'));
                calls.map(|(at, name)| &code[at + name.len()..]).collect()
            };
            let derived = ["dFdx(", "dFdy(", "fwidth(", "STEP_RIGHT(", "STEP_DOWN("].into_iter().flat_map(arguments);
            let sampled = arguments("texture(").into_iter().map(|call| call.split_once(", ").map_or("", |(_, at)| at));
            if !derived.chain(sampled).all(|argument| argument.starts_with("in_")) {
                found.push(format!("glsl/{}:{number}: {}", file.display(), line.trim()));
            }
        }
    }
    assert_eq!(found, [] as [&str; 0]);
}

/// A number that host and device share is typed in GLSL, and `build.rs` hands it to the host.
#[test]
fn numbers_of_shaders_are_typed_once() {
    /// The name in `const NAME...`, where what follows its `=` begins with a digit.
    fn typed(line: &str) -> Option<&str> {
        let (before, value) = line.trim_start().split_once(" = ")?;
        let (_, declared) = before.rsplit_once("const ")?;
        let name = declared.split(':').next()?.rsplit(' ').next()?;
        value.starts_with(|first: char| first.is_ascii_digit()).then_some(name)
    }
    let text_of = |folder: &str, file: &Path| std::fs::read_to_string(root().join(folder).join(file)).unwrap();
    let mut shared = BTreeSet::new();
    for file in files("glsl") {
        let text = text_of("glsl", &file);
        shared.extend(text.lines().filter(|line| line.starts_with("const ")).filter_map(typed).map(str::to_owned));
    }
    assert!(shared.len() > 100 && shared.contains("TILE_PX"), "{} numbers were found", shared.len());
    let mut twice = Vec::new();
    // A scene's file has its number too, below the room of shaders: a test of shading compares the two.
    for file in files("src").into_iter().filter(|file| !file.starts_with("scene")) {
        let text = text_of("src", &file);
        let copies = (1..).zip(text.lines()).filter(|(_, line)| typed(line).is_some_and(|name| shared.contains(name)));
        twice.extend(copies.map(|(number, line)| format!("src/{}:{number}: {}", file.display(), line.trim())));
    }
    assert_eq!(twice, [] as [&str; 0]);
}

#[test]
fn the_floor_knows_no_technique_and_no_scene() {
    for room in ["gpu", "memory"] {
        let words = ["techniques", "crate::scene", "crate::passes", "crate::lights", "crate::cli", "crate::job"];
        let found: Vec<String> = mentions(room, &words)
            .into_iter()
            // The table of shaders mirrors glsl/, names of techniques included; nothing of them is in it.
            .filter(|line| !line.contains("gpu::shader::techniques"))
            .collect();
        assert_eq!(found, [] as [&str; 0], "{room}");
    }
    assert_eq!(mentions("scene", &["vk::", "ash::", "crate::gpu", "crate::techniques"]), [] as [&str; 0]);
}

#[test]
fn techniques_do_not_import_each_other() {
    let modules: BTreeSet<String> = files("src").iter().map(|file| module_of(file)).collect();
    let techniques: Vec<&str> = quincunx::techniques::ALL.iter().map(|technique| technique.name()).collect();
    let mut found = Vec::new();
    for technique in &techniques {
        assert!(modules.contains(&format!("techniques::{technique}")), "{technique} has no folder");
        let others = techniques.iter().filter(|other| other != &technique);
        for other in others {
            let words =
                [format!("techniques::{other}::"), format!("super::super::{other}"), format!("techniques::{other};")];
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            let lines = mentions(&format!("techniques/{technique}"), &words);
            found.extend(lines.into_iter().filter(|line| !line.contains(&format!("shader::techniques::{technique}"))));
        }
    }
    assert_eq!(found, [] as [&str; 0]);
}

#[test]
fn passes_and_lights_know_no_technique() {
    for room in ["passes", "lights", "shading", "sampling"] {
        assert_eq!(mentions(room, &["crate::techniques", "crate::cli", "crate::job"]), [] as [&str; 0], "{room}");
    }
}

/// Allocators of others allocate too, where they are built to be measured.
#[test]
fn memory_is_allocated_in_one_room() {
    let outside: Vec<String> = mentions("", &[".allocate_memory(", ".free_memory("])
        .into_iter()
        .filter(|line| !line.starts_with("src/memory/") && !line.starts_with("src/bench/allocate/rivals.rs"))
        .collect();
    assert_eq!(outside, [] as [&str; 0]);
}

/// Pipelines that draw the same triangles in the same places, one after the other, must cover the same pixels: without `invariant` a
/// driver may compile one vertex shader in two ways.
#[test]
fn vertices_that_several_pipelines_place_are_invariant() {
    const INVARIANT: u32 = 18;
    let is_invariant = |spirv: &[u8]| {
        let words: Vec<u32> = spirv.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
        let mut at = 5;
        let mut is_there = false;
        while at < words.len() {
            // OpDecorate and OpMemberDecorate, whose third and fourth words are the decoration.
            is_there |= words[at] & 0xffff == 71 && words[at + 2] == INVARIANT;
            is_there |= words[at] & 0xffff == 72 && words[at + 3] == INVARIANT;
            at += (words[at] >> 16) as usize;
        }
        is_there
    };
    let places = |stage| matches!(stage, shader::Stage::Vertex | shader::Stage::Geometry);
    let without: BTreeSet<&str> = shader::ALL
        .iter()
        .filter(|shader| places(shader.stage) && !is_invariant(shader.spirv))
        .map(|shader| shader.name)
        .collect();
    let needless = [
        // Corners are constants.
        "passes/fullscreen",
        // One pipeline of a frame draws with it.
        "bench/device/triangles",
        "techniques/deep_shading/baseline/msaa",
        "techniques/deep_shading/shade/corner",
        "techniques/deep_shading/shade/geometry",
        "techniques/deep_shading/shade/vertex",
        "techniques/inferred_lighting/light/shadow_volumes",
        "techniques/inferred_lighting/light/volumes",
        "techniques/interleaved_deferred/shade/drawn",
        "techniques/interleaved_sampling/slices",
        // It copies places.
        "techniques/deep_shading/visibility/layer",
        // Its vertex shader places nothing.
        "techniques/deep_shading/visibility/polygon",
    ];
    assert_eq!(without, BTreeSet::from(needless));
}

/// Pages that are not in the project, and the letters of codes that only those pages explain. A comment that names one
/// sends its reader nowhere. (In two parts, so that this file may be checked too.)
const PRIVATE_PAGES: [&str; 4] =
    [concat!("design", ".md"), concat!("style", ".md"), concat!("house", ".md"), concat!("check", "list")];
const PRIVATE_CODES: [&str; 5] = ["SG", "KH", "KL", "DB", "CM"];

/// Why a line is refused; None for a good one. `is_code`: it is Rust or GLSL, and comments begin with slashes.
fn complaint(line: &str, is_code: bool) -> Option<String> {
    let comment = ["///", "//!", "//"].iter().find_map(|mark| line.trim_start().strip_prefix(mark));
    if is_code && comment.is_some_and(|text| text.trim_start().starts_with("Of ")) {
        return Some("a comment begins with the thing that it is about, not with \"Of\"".to_owned());
    }
    if let Some(page) = PRIVATE_PAGES.iter().find(|page| line.to_lowercase().contains(*page)) {
        return Some(format!("{page} is not in the project: name the paper's section"));
    }
    let words = line.split(|letter: char| !letter.is_ascii_alphanumeric());
    let is_private = |word: &&str| {
        PRIVATE_CODES.iter().any(|code| {
            let number = word.strip_prefix(code).unwrap_or_default();
            !number.is_empty() && number.bytes().all(|digit| digit.is_ascii_digit())
        })
    };
    words
        .into_iter()
        .find(is_private)
        .map(|code| format!("{code} is in no page of the project: name the paper's section"))
}

#[test]
fn comments_say_what_they_are_about_and_name_pages_that_a_reader_has() {
    let git =
        Command::new("git").args(["ls-files", "src", "glsl", "tests", "tools", "docs"]).current_dir(root()).output();
    let listed = git.map(|output| String::from_utf8(output.stdout).unwrap()).unwrap_or_default();
    if listed.is_empty() {
        return support::skip("git does not say which files are the project's");
    }
    let mut refused = Vec::new();
    for file in listed.lines() {
        let Ok(text) = std::fs::read_to_string(root().join(file)) else { continue };
        let is_code = ["rs", "glsl"].iter().chain(&ENTRY_POINTS).any(|ending| file.ends_with(&format!(".{ending}")));
        let complaints = (1..).zip(text.lines()).filter_map(|(number, line)| Some((number, complaint(line, is_code)?)));
        refused.extend(complaints.map(|(number, why)| format!("{file}:{number}: {why}")));
    }
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}

/// Rows of glsl/README.md's tables, `| number | names (where they are) |`, as the table of shaders has them: what stands at
/// each binding of the first set, and at each number of a specialization constant.
fn numbered_rows(numbers: impl Fn(&shader::Shader) -> Vec<(u32, &'static str)>) -> Vec<String> {
    let mut rows: BTreeMap<u32, BTreeMap<&str, BTreeSet<&str>>> = BTreeMap::new();
    for shader in shader::ALL {
        let room = shader.name.strip_prefix("techniques/").unwrap_or(shader.name);
        let room = room.split('/').next().unwrap_or(room);
        for (number, name) in numbers(shader) {
            rows.entry(number).or_default().entry(name).or_default().insert(room);
        }
    }
    let names = |names: BTreeMap<&str, BTreeSet<&str>>| {
        let named = |(name, rooms): (&str, BTreeSet<&str>)| {
            format!("`{name}` ({})", rooms.into_iter().collect::<Vec<_>>().join(", "))
        };
        names.into_iter().map(named).collect::<Vec<_>>().join("; ")
    };
    rows.into_iter().map(|(number, all)| format!("| {number} | {} |", names(all))).collect()
}

/// A number has no meaning of its own: the page says which names it goes by, and where.
#[test]
fn the_page_of_shaders_has_every_binding_and_every_constant() {
    let page = std::fs::read_to_string(root().join("glsl/README.md")).unwrap();
    let (bindings, constants) = page.split_once("## Specialization constants").expect("the second half of the page");
    let rows = |text: &str| -> Vec<String> {
        let is_row =
            |line: &&str| line.starts_with("| ") && line[2..].starts_with(|first: char| first.is_ascii_digit());
        text.lines().filter(is_row).map(str::to_owned).collect()
    };
    let bound = numbered_rows(|shader| {
        let own = shader.bindings.iter().filter(|binding| binding.set == 0);
        own.map(|binding| (binding.binding, binding.name)).collect()
    });
    let specialized = numbered_rows(|shader| shader.constants.iter().map(|each| (each.id, each.name)).collect());
    let is_shared =
        |row: &&String| row[2..].split(' ').next().is_some_and(|number| number.parse::<u32>().unwrap() >= 60);
    for row in specialized.iter().filter(is_shared) {
        assert!(!row.contains("; "), "a constant from 60 on has one name: {row}");
    }
    for (what, found, expected) in
        [("Bindings", rows(bindings), bound), ("Specialization constants", rows(constants), specialized)]
    {
        assert_eq!(found, expected, "glsl/README.md, {what}: its rows should be\n{}", expected.join("\n"));
    }
}

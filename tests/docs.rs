//! The pages beside the code: what they link to and name is there, and what the program makes or writes is in them.

use crate::support::program::Program;
use crate::techniques::own_pass::edges;
use quincunx::techniques;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// README is a first page: what does not fit moves to docs/.
const README_MOST_BYTES: usize = 12_288;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Files below `folder` with one of `extensions`, as paths from the root, sorted.
fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    fn walk(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, extensions, found);
            } else if path.extension().is_some_and(|own| extensions.iter().any(|extension| own == *extension)) {
                found.push(path.strip_prefix(root()).unwrap().to_owned());
            }
        }
    }
    let mut found = Vec::new();
    walk(&root().join(folder), extensions, &mut found);
    found.sort();
    found
}

fn pages() -> Vec<PathBuf> {
    let mut pages: Vec<PathBuf> =
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "glsl/README.md"].map(PathBuf::from).to_vec();
    pages.extend(files("docs", &["md"]));
    pages
}

/// A page's paragraphs outside of its blocks of code, indented or fenced, with the number of their first lines.
fn prose(text: &str) -> Vec<(usize, String)> {
    let mut paragraphs: Vec<(usize, String)> = Vec::new();
    let (mut is_fenced, mut goes_on) = (false, false);
    for (number, line) in (1..).zip(text.lines()) {
        let is_fence = line.trim_start().starts_with("```");
        is_fenced ^= is_fence;
        if is_fence || is_fenced || line.starts_with("    ") || line.is_empty() {
            goes_on = false;
            continue;
        }
        let is_heading = line.starts_with('#');
        match paragraphs.last_mut().filter(|_| goes_on && !is_heading) {
            Some((_, paragraph)) => *paragraph = format!("{paragraph}\n{line}"),
            None => paragraphs.push((number, line.to_owned())),
        }
        goes_on = !is_heading;
    }
    paragraphs
}

/// What stands between backticks, and the paragraph without it.
fn code_spans(paragraph: &str) -> (Vec<&str>, String) {
    let parts: Vec<&str> = paragraph.split('`').collect();
    let spans = parts.iter().skip(1).step_by(2).copied().collect();
    (spans, parts.iter().step_by(2).copied().collect::<Vec<_>>().join(" "))
}

/// Where a paragraph's links and pictures lead.
fn links(paragraph: &str) -> Vec<String> {
    let (_, text) = code_spans(paragraph);
    let behind = |mark: &str, end: char| -> Vec<String> {
        text.split(mark).skip(1).filter_map(|rest| Some(rest.split_once(end)?.0.to_owned())).collect()
    };
    [behind("](", ')'), behind("src=\"", '"')].concat()
}

/// The anchor that a forge gives a heading.
fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase();
    let kept = kept.chars().filter(|letter| letter.is_alphanumeric() || " -_".contains(*letter));
    kept.map(|letter| if letter == ' ' { '-' } else { letter }).collect()
}

fn anchors(text: &str) -> BTreeSet<String> {
    let headings = prose(text).into_iter().filter(|(_, line)| line.starts_with('#'));
    headings.map(|(_, line)| anchor(line.trim_start_matches('#').trim())).collect()
}

#[test]
fn readme_is_a_page_that_is_read_at_once() {
    let bytes = read(Path::new("README.md")).len();
    assert!(bytes <= README_MOST_BYTES, "README.md has {bytes} bytes of {README_MOST_BYTES}: docs/ has room");
}

#[test]
fn every_link_of_a_page_leads_somewhere() {
    let mut dead = Vec::new();
    for page in pages() {
        let text = read(&page);
        for (number, paragraph) in prose(&text) {
            for link in links(&paragraph).into_iter().filter(|link| !link.contains("://")) {
                let (path, heading) = link.split_once('#').map_or((link.as_str(), None), |(path, at)| (path, Some(at)));
                let target = if path.is_empty() { page.clone() } else { page.with_file_name("").join(path) };
                let is_there = root().join(&target).exists();
                if !is_there || heading.is_some_and(|heading| !anchors(&read(&target)).contains(heading)) {
                    dead.push(format!("{}:{number}: {link}", page.display()));
                }
            }
        }
    }
    assert_eq!(dead, [] as [&str; 0]);
}

/// Paths of the repository that a text names: words that begin with one of its folders. A name in capitals stands for any.
fn named_paths(text: &str) -> Vec<&str> {
    const FOLDERS: [&str; 6] = ["src/", "glsl/", "tests/", "tools/", "docs/", "assets/"];
    let is_of_path = |letter: char| letter.is_alphanumeric() || "/._-".contains(letter);
    let breaks = |letter: char| letter.is_whitespace() || "`'\"()[],;:|".contains(letter);
    let words = text.split(breaks).map(|word| word.trim_end_matches(['.', '/']));
    let is_any = |word: &str| word.split(['/', '.']).any(|part| part.len() > 1 && part == part.to_uppercase());
    words
        .filter(|word| FOLDERS.iter().any(|folder| word.starts_with(folder)))
        .filter(|word| word.chars().all(is_of_path) && !word.contains("..") && !is_any(word))
        .collect()
}

#[test]
fn every_path_that_a_page_or_a_comment_names_is_there() {
    let mut missing = Vec::new();
    let mut look = |file: &Path, number: usize, text: &str| {
        for path in named_paths(text).into_iter().filter(|path| !root().join(path).exists()) {
            missing.push(format!("{}:{number}: {path}", file.display()));
        }
    };
    for page in pages() {
        let text = read(&page);
        for (number, paragraph) in prose(&text) {
            code_spans(&paragraph).0.into_iter().for_each(|span| look(&page, number, span));
        }
        let code = (1..).zip(text.lines()).filter(|(_, line)| line.starts_with("    "));
        code.for_each(|(number, line)| look(&page, number, line));
    }
    let shaders = ["glsl", "vert", "geom", "frag", "comp"];
    let sources = [files("src", &["rs"]), files("tests", &["rs"]), files("glsl", &shaders)].concat();
    for file in sources {
        for (number, line) in (1..).zip(read(&file).lines()) {
            if let Some(comment) = line.trim_start().strip_prefix("//") {
                look(&file, number, comment);
            }
        }
    }
    assert_eq!(missing, [] as [&str; 0]);
}

#[test]
fn every_technique_has_its_page() {
    let there: BTreeSet<PathBuf> = files("docs/techniques", &["md"]).into_iter().collect();
    let page = |name: &str| Path::new("docs/techniques").join(format!("{name}.md"));
    assert_eq!(there, techniques::ALL.iter().map(|technique| page(technique.name())).collect());
    let readme = read(Path::new("README.md"));
    for page in there {
        assert!(readme.contains(&format!("]({})", page.display())), "README.md does not link {}", page.display());
    }
}

#[test]
fn the_page_of_the_architecture_has_every_room() {
    let page = read(Path::new("docs/architecture.md"));
    for entry in std::fs::read_dir(root().join("src")).unwrap().map(|entry| entry.unwrap().path()) {
        let room = entry.file_name().unwrap().to_str().unwrap();
        assert!(!entry.is_dir() || page.contains(&format!("`src/{room}/`")), "docs/architecture.md has no src/{room}/");
    }
}

#[test]
fn the_page_of_settings_is_what_the_program_prints() {
    let printed = Program::new().run(&["settings", "--markdown"]).fine().out;
    let kept = read(Path::new("docs/settings.md"));
    assert!(kept == printed, "docs/settings.md is of another program; quincunx settings --markdown > docs/settings.md");
}

#[test]
fn settings_of_a_technique_are_those_of_its_help() {
    let program = Program::new();
    for technique in techniques::ALL {
        let printed = program.run(&["settings", technique.name()]).fine().out;
        let flags: BTreeSet<&str> =
            printed.lines().filter_map(|line| line.strip_prefix("      --")?.split(' ').next()).collect();
        let expected = quincunx::techniques::settings_of(*technique);
        assert_eq!(flags, expected.iter().map(|setting| setting.key).collect(), "{}", technique.name());
    }
    program.fails(&["settings", "backward"], 2, &["backward", "forward"]);
}

/// The verbs, as help lists them.
fn verbs(program: &Program) -> Vec<String> {
    let help = program.run(&["--help"]).fine().out;
    let listed = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    // What does not fit on a verb's line goes on farther to the right.
    let lines = listed.lines().filter_map(|line| line.strip_prefix("  ").filter(|line| !line.starts_with(' ')));
    lines.filter_map(|line| line.split(' ').next()).filter(|verb| *verb != "help").map(str::to_owned).collect()
}

#[test]
fn completions_the_manual_and_readme_name_every_verb() {
    let program = Program::new();
    let verbs = verbs(&program);
    assert!(verbs.len() >= 9 && verbs.iter().any(|verb| verb == "man"), "{verbs:?}");
    let readme = read(Path::new("README.md"));
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = program.run(&["completions", shell]).fine().out;
        for word in verbs.iter().map(String::as_str).chain(["pattern", "export"]) {
            assert!(script.contains(word), "{shell} does not complete {word}");
        }
    }
    let page = program.run(&["man"]).fine().out;
    for verb in &verbs {
        assert!(page.contains(&format!("quincunx\\-{verb}(1)")), "the manual does not name {verb}: {page}");
        assert!(readme.contains(&format!("\n| `{verb}")), "README's table of verbs has no {verb}");
        let own = program.run(&["man", verb]).fine().out;
        assert!(own.contains(&format!(".TH quincunx-{verb} 1")), "{own}");
    }
    program.fails(&["man", "scene", "burn"], 2, &["scene has no verb burn", "list, inspect, export"]);
    program.fails(&["completions", "cmd"], 2, &["cmd", "bash"]);
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_gone_is_no_failure() {
    use std::process::Stdio;
    for arguments in [&["settings"][..], &["settings", "--markdown"], &["completions", "bash"], &["man", "render"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = crate::support::program::quincunx();
        let output = command.args(arguments).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(
            (output.status.code(), String::from_utf8(output.stderr).unwrap().as_str()),
            (Some(0), ""),
            "{arguments:?}"
        );
    }
}

/// Objects whose keys are not the program's own: settings, passes, groups.
const OPEN: [&str; 5] = ["settings", "asked", "groups", "touched_groups", "pass_ms"];
/// Keys of a spread of times and of a ratio, which stand in many places: `*.median` on the page.
const REPEATED: [&str; 7] = ["median", "min", "max", "samples[]", "mean", "interval_95[]", "pairs"];

/// Paths of all that `value` holds: `a.b` of an object, `a[]` of a list's entries, `a.*` of an open object.
fn keys(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    let path = path.trim_start_matches('.');
    let last = path.rsplit('.').next().unwrap();
    match value {
        Value::Object(entries) => {
            for (key, value) in entries {
                let step = if OPEN.contains(&last) { "*" } else { key };
                keys(value, &format!("{path}.{step}"), found);
            }
        }
        Value::Array(entries) if !entries.is_empty() => {
            entries.iter().for_each(|entry| keys(entry, &format!("{path}[]"), found));
        }
        // Where a list is empty its entries are what the page names.
        Value::Array(_) => _ = found.insert(format!("{path}[]")),
        _ => {
            let is_repeated = |(_, key): (&str, &str)| REPEATED.contains(&key) && path != "image.mean[]";
            match path.rsplit_once('.').filter(|parts| is_repeated(*parts)) {
                Some((of, key)) => {
                    found.insert(of.to_owned());
                    found.insert(format!("*.{key}"));
                }
                None => _ = found.insert(path.to_owned()),
            }
        }
    }
}

/// A key of the page's tables, and on which condition it is written: nothing where every document of its kind has it.
#[derive(Clone)]
struct Told {
    key: String,
    condition: String,
}

/// The rows of a page's tables whose first cell is code, in the section `heading` and those below it.
fn told(page: &str, heading: &str) -> Vec<Told> {
    let section = page.split(&format!("\n## {heading}\n")).nth(1).unwrap_or_else(|| panic!("no heading {heading}"));
    let lines = section.split("\n## ").next().unwrap().lines();
    let row = |line: &str| {
        let cells: Vec<&str> = line.strip_prefix("| `")?.strip_suffix(" |")?.split(" | ").collect();
        let key = cells[0].strip_suffix('`')?.to_owned();
        Some(Told { key, condition: cells.get(2).map_or("", |cell| cell.trim()).to_owned() })
    };
    lines.filter_map(row).collect()
}

/// Holds what documents have against what the page tells of them, and of all kinds of documents.
fn require_told(kind: &str, written: &BTreeSet<String>, own: &[Told], shared: &[Told]) {
    let is_told = |key: &String| own.iter().chain(shared).any(|told| told.key == *key);
    let untold: Vec<&String> = written.iter().filter(|key| !is_told(key)).collect();
    assert!(untold.is_empty(), "docs/report.md, {kind}: it does not name {untold:#?}");
    let sources: String = files("src", &["rs"]).iter().map(|file| read(file)).collect();
    let is_written = |told: &&Told| {
        let name = told.key.rsplit('.').next().unwrap().trim_end_matches("[]");
        // A key is a text, or a field of a struct that is written as a document.
        let is_in_sources =
            || [format!("\"{name}\""), format!("pub {name}: ")].iter().any(|word| sources.contains(word));
        written.contains(&told.key) || !told.condition.is_empty() && is_in_sources()
    };
    let stale: Vec<&str> = own.iter().filter(|told| !is_written(told)).map(|told| told.key.as_str()).collect();
    assert!(
        stale.is_empty(),
        "docs/report.md, {kind}: nothing writes {stale:#?}, or not on every run: its third cell says when"
    );
}

/// Keys of what the program prints as JSON, on one line or one a line.
fn written(program: &Program, commands: &[&str]) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for command in commands {
        let ran = program.run(&command.split(' ').collect::<Vec<_>>());
        assert_eq!(ran.code, 0, "{command}: {}", ran.err);
        let documents = serde_json::Deserializer::from_str(&ran.out).into_iter::<Value>();
        documents.for_each(|document| keys(&document.unwrap(), "", &mut found));
    }
    found
}

const SMALL: &str = "--size 32x18 --json";

fn small(commands: &[&str]) -> Vec<String> {
    commands.iter().map(|command| format!("{command} {SMALL}")).collect()
}

#[test]
fn the_page_of_the_report_names_every_key() {
    let program = Program::new();
    let page = read(Path::new("docs/report.md"));
    let reports = small(&[
        "render cornell --vpls 16 --profile --statistics --aov gbuffer.normal,shade.irradiance -o a.exr",
        "render cornell --vpls 16 --reference a.exr --max rmse=1 -o b.png",
        "render cornell --technique deep_shading --spp 4 --direct-shadow none --visibility stochastic",
        "render cornell --technique deep_shading --spp 4 --direct-shadow none --shading indirect-gbuffer",
        "render cornell --technique deep_shading --spp 4 --direct-shadow none --shading texture-space",
        "render lamps:objects=5,lights=6 --technique inferred_lighting --volumes scissor --shadow-volumes 2",
        "render cornell --technique forward --direct-shadow map --msaa 4",
        "render cornell --technique deferred --cull tiled",
        "render cornell --technique adaptive_interleaved --emissive on --medium 0.1,0,0 --ambient 0.1 --components id,ss,pm,ao",
        "render cornell --technique path_traced --spp 4",
        "render cornell --vpls 16 --frames 0..1",
    ]);
    let reports: Vec<&str> = reports.iter().map(String::as_str).collect();
    // A sequence is one document with a report a frame.
    let of_frames = |key: String| key.strip_prefix("frames[].").map_or(key.clone(), str::to_owned);
    let report: BTreeSet<String> = written(&program, &reports).into_iter().map(of_frames).collect();
    let told_of_report = told(&page, "A picture's report");
    require_told("a picture's report", &report, &told_of_report, &[]);

    let rows = small(&[
        "bench frame cornell --vpls 16 --sweep split=none,one-pass,tile --sweep block=16,32 --repeat 3 --reference a.exr",
        "bench split cornell --vpls 16 --repeat 3 --fair",
        "bench shade cornell --vpls 16 --sweep pattern=4x4,8x8 --repeat 3",
        "bench filter cornell --vpls 16 --repeat 3",
        "bench frame cornell:motion=on --vpls 16 --repeat 3 --frames 0..2",
    ]);
    let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
    let told_of_row = told(&page, "A benchmark's row");
    require_told("a benchmark's row", &written(&program, &rows), &told_of_row, &told_of_report);

    let rays = written(&program, &["bench rays cornell --rays 1000 --repeat 3 --json"]);
    require_told(
        "a row of bench rays",
        &rays,
        &told(&page, "A row of bench rays"),
        &[told_of_report, told_of_row].concat(),
    );
}

/// Runs an example in `folder`. Returns what it says.
fn run_example(name: &str, folder: &Path, arguments: &[&str]) -> String {
    let mut cargo = std::process::Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--example", name, "--manifest-path"]).arg(root().join("Cargo.toml"));
    let output = cargo.arg("--").args(arguments).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Lines of code between `from` and `to`, without indentation, comment signs and blank lines.
fn lines_between<'a>(text: &'a str, from: &str, to: &str) -> Vec<&'a str> {
    let (_, rest) = text.split_once(from).unwrap_or_else(|| panic!("no {from:?}"));
    let (lines, _) = rest.split_once(to).unwrap_or_else(|| panic!("no {to:?} after {from:?}"));
    let bare = |line: &'a str| line.trim().trim_start_matches("//!").trim();
    lines.lines().map(bare).filter(|line| !line.is_empty() && !line.starts_with("# ")).collect()
}

#[test]
fn the_picture_in_ten_lines_is_the_same_everywhere_and_makes_a_picture() {
    let example = read(Path::new("examples/picture.rs"));
    let lines = lines_between(&example, "fn main() -> Result<(), quincunx::Error> {", "Ok(())");
    for (page, from) in [("README.md", "```rust\n"), ("src/lib.rs", "```no_run\n")] {
        let text = read(Path::new(page));
        let shown = lines_between(&text, from, "```");
        assert_eq!(shown, [&["use quincunx::job::Job;"], &lines[..]].concat(), "{page}");
    }
    let folder = tempfile::tempdir().unwrap();
    run_example("picture", folder.path(), &[]);
    let picture = quincunx::picture::image_file::read(&folder.path().join("cornell.exr")).unwrap();
    assert_eq!(picture.extent.to_string(), "640x360");
    assert!(picture.mean().iter().all(|channel| *channel > 0.01), "{:?}", picture.mean());
}

#[test]
fn the_pass_of_one_s_own_makes_its_picture_beside_the_plain_one() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str| quincunx::picture::image_file::read(&folder.path().join(name)).unwrap();
    let said = run_example("own_pass", folder.path(), &["a.exr", "b.exr"]);
    assert!(said.lines().last().unwrap().ends_with(", interleaved_deferred.composite, own.edges"), "{said}");
    let (plain, own) = (read("a.exr"), read("b.exr"));
    assert_eq!((plain.extent.to_string(), own.extent), ("320x180".to_owned(), plain.extent));
    let expected = edges(&plain);
    let apart = own.pixels.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
    assert!(apart.fold(0.0, f32::max) <= 1e-6 && own.mean()[0] < 0.99 * plain.mean()[0]);
    // Without names: two PNG files.
    run_example("own_pass", folder.path(), &[]);
    assert_ne!(read("plain.png").pixels, read("own_pass.png").pixels);
}

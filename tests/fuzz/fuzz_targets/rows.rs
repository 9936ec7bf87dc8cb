//! Any bytes as the `rows.jsonl` that `--resume` reads, and whatever rows are in it as what a summary is made of.

#![no_main]

use libfuzzer_sys::{Corpus, fuzz_target};
use quincunx::bench::row::BenchRow;
use quincunx::bench::rows_file::{Existing, NAME, RowsFile};
use quincunx::bench::summary::Summary;
use quincunx::bench::sweep;
use quincunx::bench::what::What;
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> = LazyLock::new(quincunx_fuzz::memory_folder);
static WHATS: LazyLock<Vec<What>> = LazyLock::new(What::all);

fuzz_target!(init: quincunx_fuzz::seeds::write_if_asked("rows"), |bytes: &[u8]| -> Corpus {
    let Some((which, bytes)) = bytes.split_first() else { return Corpus::Reject };
    let path = FOLDER.path().join(NAME);
    std::fs::write(&path, bytes).unwrap();
    let mut file = match RowsFile::open(FOLDER.path(), Existing::Resume) {
        Ok(file) => file,
        Err(error) => {
            assert_eq!(error.exit_code(), 2, "{error}");
            return Corpus::Keep;
        }
    };
    let lines = bytes.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"));
    let rows: Vec<BenchRow> = lines.filter_map(|line| serde_json::from_slice(line).ok()).collect();
    assert!(rows.iter().all(|row| file.kept(row).is_some()), "a row that is there is not found again");
    let whole: usize = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
    let more = BenchRow { bench: "frame".to_owned(), variant: "more".to_owned(), ..BenchRow::default() };
    file.append(&more).unwrap();
    let after = std::fs::read(&path).unwrap();
    assert_eq!(after, [&bytes[..whole], format!("{}\n", more.line()).as_bytes()].concat());
    if !rows.is_empty() {
        let axes = sweep::axes(&["pattern=2x2,4x4".to_owned(), "block=8,16".to_owned()]).unwrap();
        let summary = Summary::new(WHATS[usize::from(*which) % WHATS.len()], &axes, rows, &["quincunx".to_owned()]);
        assert!(!summary.text().is_empty() && !summary.markdown().is_empty() && summary.json().is_object());
    }
    Corpus::Keep
});

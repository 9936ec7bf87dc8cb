//! `rows.jsonl`: rows appended as they are found, one line and one write each, so that what is there is always valid.

use super::row::BenchRow;
use crate::error::{Error, Result};
use crate::units::Bytes;
use crate::whole_file::make_folder;
use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Its name in the folder of `-o`.
pub const NAME: &str = "rows.jsonl";

/// A row has some kilobytes: a longer file is none of rows.
const MAX_BYTES: u64 = 256 << 20;

/// What happens to rows that are there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    Refuse,
    /// They are kept, and not measured again.
    Resume,
    Overwrite,
}

/// The file, open from its first new row on: a run that fails before leaves it as it was.
pub struct RowsFile {
    path: PathBuf,
    file: Option<File>,
    /// Whole lines that stay; what follows them was torn off by the end of a process.
    kept_bytes: u64,
    kept: HashMap<String, BenchRow>,
}

impl RowsFile {
    /// Reads what is there, and makes the folder where it is not.
    ///
    /// Errors: the folder cannot be made, rows are there and `existing` refuses them, a line is no row, or the file cannot be read (exit code 2).
    pub fn open(folder: &Path, existing: Existing) -> Result<Self> {
        make_folder(folder)?;
        let path = folder.join(NAME);
        let mut rows = Self { path, file: None, kept_bytes: 0, kept: HashMap::new() };
        if !rows.path.exists() {
            return Ok(rows);
        }
        match existing {
            Existing::Overwrite => {}
            Existing::Refuse => {
                return Err(rows
                    .error("it holds rows of an earlier run")
                    .note("--resume measures only what is missing in it; --force replaces it"));
            }
            Existing::Resume => rows.kept = rows.read()?.into_iter().map(|row| (row.key(), row)).collect(),
        }
        Ok(rows)
    }

    /// The rows that are there, in their order; a torn last one is left out.
    ///
    /// Errors: a line is no row, or the file cannot be read (exit code 2).
    pub fn rows(folder: &Path) -> Result<Vec<BenchRow>> {
        let mut rows = Self { path: folder.join(NAME), file: None, kept_bytes: 0, kept: HashMap::new() };
        rows.read()
    }

    /// Notes how much of it is whole.
    fn read(&mut self) -> Result<Vec<BenchRow>> {
        let metadata = std::fs::metadata(&self.path).map_err(|error| self.error(&error.to_string()))?;
        // A pipe or a device would block or never end.
        if !metadata.is_file() {
            return Err(self.error("it is not a regular file"));
        }
        if metadata.len() > MAX_BYTES {
            let (has, most) = (Bytes(metadata.len()), Bytes(MAX_BYTES));
            return Err(self
                .error(&format!("it has {has}; up to {most} of rows are read"))
                .note("--force replaces it"));
        }
        let bytes = std::fs::read(&self.path).map_err(|error| self.error(&error.to_string()))?;
        let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        self.kept_bytes = whole as u64;
        let lines = bytes[..whole].split(|byte| *byte == b'\n').enumerate().filter(|(_, line)| !line.is_empty());
        let row = |(index, line): (usize, &[u8])| {
            serde_json::from_slice(line).map_err(|error| {
                let why = format!("line {} is not a row: {error}", index + 1);
                self.error(&why).note("remove the line, or use --force")
            })
        };
        lines.map(row).collect()
    }

    fn error(&self, why: &str) -> Error {
        Error::request(format!("{}: {why}", self.path.display()))
    }

    /// The row of the same measurement as `head`, which has the keys that say what a row is of.
    pub fn kept(&self, head: &BenchRow) -> Option<&BenchRow> {
        self.kept.get(&head.key())
    }

    /// Appends a row.
    ///
    /// Errors: it cannot be written (exit code 2).
    pub fn append(&mut self, row: &BenchRow) -> Result<()> {
        self.write(format!("{}\n", row.line()).as_bytes()).map_err(|error| self.error(&error.to_string()))
    }

    fn write(&mut self, line: &[u8]) -> std::io::Result<()> {
        if self.file.is_none() {
            let file = OpenOptions::new().append(true).create(true).open(&self.path)?;
            file.set_len(self.kept_bytes)?;
            self.file = Some(file);
        }
        self.file.as_mut().expect("opened above").write_all(line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Metrics;
    use serde_json::json;

    fn row(variant: &str) -> BenchRow {
        let text =
            format!(r#"{{ "bench": "frame", "variant": "{variant}", "scene": {{ "hash": "h" }}, "repeat": 3 }}"#);
        serde_json::from_str(&text).unwrap()
    }

    #[test]
    fn a_torn_line_is_dropped_and_whole_ones_stay_as_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        let mut rows = RowsFile::open(folder.path(), Existing::Refuse).unwrap();
        assert!(!path.exists());
        rows.append(&row("a")).unwrap();
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, [&whole[..], &whole[..whole.len() / 2]].concat()).unwrap();

        let mut rows = RowsFile::open(folder.path(), Existing::Resume).unwrap();
        assert_eq!(rows.kept(&row("a")), Some(&row("a")));
        assert_eq!(rows.kept(&row("b")), None);
        assert_eq!(rows.kept(&BenchRow { bench: "split".to_owned(), ..row("a") }), None);
        rows.append(&row("b")).unwrap();
        let text = std::fs::read(&path).unwrap();
        assert_eq!(text, [&whole[..], format!("{}\n", row("b").line()).as_bytes()].concat());
    }

    /// A measure of errors is younger than the rows of a sweep that `--resume` goes on with.
    #[test]
    fn a_row_of_before_a_measure_is_still_a_row() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        let mut whole = serde_json::to_value(row("a")).unwrap();
        whole["error_against_none"] = serde_json::to_value(Metrics { psnr: 40.0, ..Metrics::EQUAL }).unwrap();
        whole["errors"] = whole["error_against_none"].clone();
        for (key, value) in
            [("reference", json!("auto")), ("threshold", json!(0.1)), ("cut", json!([])), ("gates", json!([]))]
        {
            whole["errors"][key] = value;
        }
        for measure in Metrics::NAMES {
            let mut of_before = whole.clone();
            for errors in ["errors", "error_against_none"] {
                of_before[errors].as_object_mut().unwrap().remove(*measure).unwrap();
            }
            std::fs::write(&path, format!("{of_before}\n")).unwrap();
            let rows = RowsFile::open(folder.path(), Existing::Resume).unwrap();
            let kept = rows.kept(&row("a")).unwrap();
            assert_eq!(serde_json::to_value(kept).unwrap(), of_before);
            assert!(kept.errors.is_some() && kept.other.is_empty(), "{kept:?}");
        }
    }

    #[test]
    fn what_can_be_no_rows_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        // No byte of it takes room on the disk.
        File::create(&path).unwrap().set_len(1 << 40).unwrap();
        let refused = || RowsFile::open(folder.path(), Existing::Resume).err().unwrap();
        let error = refused();
        assert!(error.exit_code() == 2 && error.message().contains("1.00 TiB"), "{error}");
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir(&path).unwrap();
        assert!(refused().message().contains("not a regular file"));
    }

    #[test]
    fn rows_are_replaced_only_on_request() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        std::fs::write(&path, "{}\nnothing\n").unwrap();
        let refused = |existing| RowsFile::open(folder.path(), existing).err().unwrap();
        let error = refused(Existing::Refuse);
        assert!(error.exit_code() == 2 && error.to_string().contains("--resume"), "{error}");
        for (line, why) in
            [("nothing", "expected ident"), ("[]", ""), (r#"{"ratio":7}"#, "Ratio"), ("{\"schema\":-1}", "u32")]
        {
            std::fs::write(&path, format!("{{}}\n{line}\n")).unwrap();
            let error = refused(Existing::Resume);
            assert!(error.exit_code() == 2 && error.message().contains("line 2 is not a row"), "{error}");
            assert!(error.message().contains(why), "{error}");
        }
        std::fs::write(&path, "{}\nnothing\n").unwrap();
        let mut rows = RowsFile::open(folder.path(), Existing::Overwrite).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "{}\nnothing\n");
        rows.append(&row("a")).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), format!("{}\n", row("a").line()));
    }
}

//! `quincunx bench merge`: rows of several folders, such as those of shards, as one.

use super::output::{folder_flag, print, quiet_flag};
use super::progress;
use crate::bench::page::picture_file;
use crate::bench::row::BenchRow;
use crate::bench::rows_file::{Existing, RowsFile};
use crate::bench::summary::Summary;
use crate::bench::sweep::Axis;
use crate::bench::what::What;
use crate::error::{Error, Result};
use crate::progress::say;
use crate::whole_file::make_folder;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

pub const NAME: &str = "merge";

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new(NAME)
        .about("Rows of several folders as one: what is there twice counts once")
        .arg(
            Arg::new("folders")
                .value_name("DIR")
                .num_args(1..)
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("Folders with rows.jsonl, of one kind of benchmark"),
        )
        .arg(
            folder_flag("Folder to write rows.jsonl, rows.csv, summary.json, summary.md and index.html to")
                .required(true),
        )
        .arg(Arg::new("force").long("force").action(ArgAction::SetTrue).help("Replace rows.jsonl"))
        .arg(quiet_flag())
}

/// Merges and prints.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let mut seen = HashSet::new();
    let (mut rows, mut doubled): (Vec<BenchRow>, usize) = (Vec::new(), 0);
    let mut pictures = Vec::new();
    for folder in matches.get_many::<PathBuf>("folders").expect("clap requires them") {
        for row in RowsFile::rows(folder)? {
            if seen.insert(row.key()) {
                pictures.extend(picture_file(folder, &row).filter(|file| file.is_file()));
                rows.push(row);
            } else {
                doubled += 1;
            }
        }
    }
    let Some(first) = rows.first() else { return Err(Error::request("bench merge: there are no rows")) };
    let what = What::all().into_iter().find(|what| what.name() == first.bench);
    let what =
        what.ok_or_else(|| Error::request(format!("bench merge: rows of `bench {}` are not merged", first.bench)))?;
    if let Some(other) = rows.iter().find(|row| row.bench != first.bench) {
        return Err(Error::request(format!(
            "bench merge: rows of `bench {}` and of `bench {}` are no one table",
            first.bench, other.bench
        )));
    }
    let folder = matches.get_one::<PathBuf>("output").expect("clap requires it");
    let existing = if matches.get_flag("force") { Existing::Overwrite } else { Existing::Refuse };
    let mut file = RowsFile::open(folder, existing)?;
    rows.iter().try_for_each(|row| file.append(row))?;
    if !pictures.is_empty() {
        copy_into(&folder.join("pictures"), &pictures)?;
    }
    let summary = Summary::new(what, &axes(&rows), rows, argv);
    summary.write(folder)?;
    if !matches.get_flag("quiet") {
        print(&summary.text())?;
    }
    if doubled > 0 {
        say(format!("{doubled} rows were there twice"));
    }
    Ok(())
}

/// Copies files, whose names say what they hold, into a folder.
///
/// Errors: one cannot be copied (exit code 2).
fn copy_into(folder: &Path, files: &[PathBuf]) -> Result<()> {
    make_folder(folder)?;
    for file in files {
        let copy = folder.join(file.file_name().expect("it is a file"));
        if !copy.exists() {
            std::fs::copy(file, &copy)
                .map_err(|error| Error::request(format!("cannot copy {}: {error}", file.display())))?;
        }
    }
    Ok(())
}

/// Settings in which rows differ, with their values in the order in which they come.
fn axes(rows: &[BenchRow]) -> Vec<Axis> {
    let mut axes: Vec<Axis> = Vec::new();
    for (key, value) in rows.iter().flat_map(|row| row.asked()) {
        let value = value.to_string();
        match axes.iter_mut().find(|axis| axis.key == *key) {
            Some(axis) if !axis.values.contains(&value) => axis.values.push(value),
            Some(_) => {}
            None => axes.push(Axis { key: key.clone(), values: vec![value] }),
        }
    }
    axes.retain(|axis| axis.values.len() > 1);
    axes
}

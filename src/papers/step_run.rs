//! Running a step: this program, in a process of its own, whose files say afterwards what it found.
//!
//! Each step has devices, memory and a crash of its own, and its command is one that a user can type. A file beside its
//! results says which command of which commit they are of: a later run takes what is there, and a bench goes on where it
//! was stopped.

use super::found::Left;
use super::recipe::{Step, Verb};
use super::request::Request;
use crate::bench::rows_file::RowsFile;
use crate::error::{Error, Result};
use crate::interrupt;
use crate::progress::say;
use crate::whole_file::{read_document as read, write_whole};
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// Environment that chooses the driver.
const DRIVERS: &[&str] = &["VK_DRIVER_FILES", "VK_ICD_FILENAMES"];

/// How often it is asked whether a process has ended.
const TICK: Duration = Duration::from_millis(20);

/// What a process that has been told to stop may take for it. Rows and files are written whole: it loses what it would have lost.
const PATIENCE: Duration = Duration::from_secs(5);

/// What a step's process leaves when it fails.
struct Failure {
    code: Option<i32>,
    message: String,
}

/// Runs a step unless its results are there.
///
/// With when its results were written; None where there are none.
///
/// Errors: a file cannot be written or is no result (exit code 2); Ctrl-C (130). A step that fails is no error: it leaves
/// its reason.
pub fn run(step: &Step, request: &Request, commit: &str) -> Result<(Left, Option<SystemTime>)> {
    let left = left(step, request, commit)?;
    let written = || Files::of(step, &request.folder).result.metadata().ok()?.modified().ok();
    let at = if let Left::Nothing { .. } = left { None } else { written() };
    Ok((left, at))
}

fn left(step: &Step, request: &Request, commit: &str) -> Result<Left> {
    let folder = &request.folder;
    let command = step.command(request);
    let files = Files::of(step, folder);
    let driver = DRIVERS.iter().filter_map(|name| Some(format!("{name}={}", std::env::var(name).ok()?)));
    // What is made of other steps' files is of their commands too.
    let earlier = step.earlier_files().filter_map(|file| {
        let (stem, _) = file.rsplit_once('.')?;
        read(&folder.join(format!("{stem}.command"))).ok()
    });
    let own = driver.chain([commit.to_owned()]).chain(command.iter().cloned());
    let key = own.chain(earlier).collect::<Vec<_>>().join("\n");
    let is_begun = !request.is_fresh && read(&files.key).is_ok_and(|there| there == key);
    if is_begun && files.is_done() {
        return files.read();
    }
    if !is_begun {
        files.remove()?;
        write_whole(&files.key, |out| out.write_all(key.as_bytes()))?;
    }
    let mut arguments = command;
    if let Verb::Bench { .. } = step.verb {
        arguments.push(if is_begun { "--resume" } else { "--force" }.to_owned());
    }
    if request.is_quiet {
        arguments.push("--quiet".to_owned());
    }
    match ended(&request.program, &arguments)? {
        Ok(printed) => {
            if let Verb::Compare { .. } | Verb::Memory | Verb::Pattern { .. } = step.verb {
                write_whole(&files.result, |out| out.write_all(&printed))?;
            }
            files.read()
        }
        Err(Failure { code: Some(130), .. }) => {
            Err(Error::interrupted("interrupted; finished steps and rows are valid").note("the same command goes on"))
        }
        Err(Failure { code, message }) => Ok(Left::Nothing { reason: message, exit_code: code }),
    }
}

/// Runs the program: what it printed, or how it failed.
///
/// Errors: it cannot be started (exit code 2); Ctrl-C (130).
fn ended(program: &Path, arguments: &[String]) -> Result<Result<Vec<u8>, Failure>> {
    let cannot = |error: std::io::Error| Error::request(format!("cannot run {}: {error}", program.display()));
    let mut command = Command::new(program);
    // What a paper publishes is not of what the user likes best.
    command.env("QUINCUNX_DEFAULTS", "");
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(cannot)?;
    let (mut stdout, stderr) = (child.stdout.take().expect("piped"), child.stderr.take().expect("piped"));
    let (status, printed, said) = std::thread::scope(|scope| {
        let printed = scope.spawn(move || {
            let mut bytes = Vec::new();
            stdout.read_to_end(&mut bytes).map(|_| bytes)
        });
        let said = scope.spawn(move || passed_on(stderr));
        let status = waited_for(&mut child);
        (status, printed.join().expect("reading does not panic"), said.join().expect("reading does not panic"))
    });
    let status = status.map_err(cannot)?;
    interrupt::check().map_err(|error| error.note("the same command goes on"))?;
    if status.success() {
        return Ok(Ok(printed.map_err(cannot)?));
    }
    let message = match status.code() {
        Some(code) if said.is_empty() => format!("it ended with exit code {code}"),
        Some(_) => said,
        None => format!("it was ended: {status}"),
    };
    Ok(Err(Failure { code: status.code(), message }))
}

/// Ctrl-C reaches it as it reaches this process, or is not meant for it: then it is ended.
fn waited_for(child: &mut Child) -> std::io::Result<std::process::ExitStatus> {
    let mut asked: Option<Instant> = None;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        if interrupt::check().is_err() && asked.get_or_insert_with(Instant::now).elapsed() > PATIENCE {
            child.kill()?;
        }
        std::thread::sleep(TICK);
    }
}

/// Hands its lines on to the user, and keeps those of its error.
fn passed_on(stderr: impl Read) -> String {
    let mut error: Vec<String> = Vec::new();
    for line in BufReader::new(stderr).lines().map_while(|line| line.ok()) {
        match line.strip_prefix("error: ") {
            Some(message) => error.push(message.to_owned()),
            None if !error.is_empty() => error.push(line.trim().to_owned()),
            None => say(line),
        }
    }
    error.join("; ")
}

/// Where a step's results are.
struct Files {
    /// Which command they are of.
    key: PathBuf,
    /// What is there when the step is done.
    result: PathBuf,
    /// The folder of a bench.
    folder: Option<PathBuf>,
}

impl Files {
    fn of(step: &Step, folder: &Path) -> Self {
        let key = folder.join(format!("{}.command", step.name));
        match step.verb {
            Verb::Bench { .. } => {
                let own = folder.join(&step.name);
                Self { key, result: own.join("summary.json"), folder: Some(own) }
            }
            _ => Self { key, result: folder.join(format!("{}.json", step.name)), folder: None },
        }
    }

    fn is_done(&self) -> bool {
        self.result.is_file()
    }

    fn remove(&self) -> Result<()> {
        for file in [&self.result, &self.key] {
            match std::fs::remove_file(file) {
                Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                    return Err(Error::request(format!("cannot remove {}: {error}", file.display())));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn read(&self) -> Result<Left> {
        match &self.folder {
            Some(folder) => Ok(Left::Rows(RowsFile::rows(folder)?)),
            None => {
                let document: Value = serde_json::from_str(&read(&self.result)?)
                    .map_err(|error| Error::request(format!("{}: {error}", self.result.display())))?;
                Ok(Left::Document(document))
            }
        }
    }
}

//! Every failure that a user can meet: what happened, on which thing, with which values, and the way out.
//!
//! One type for the whole library, because the reader of an error is a person at a terminal: the kind chooses the exit
//! code, the message is the first line, notes are the indented lines below it. A programmer's mistake asserts instead.

use std::fmt;

/// What kind of trouble it is; it chooses the exit code of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// A comparison, a gate or `--validate` failed, or a picture holds NaN or infinity. Exit code 1.
    Gate,
    /// A bad request or file, or an output that cannot be written. Exit code 2.
    Request,
    /// No Vulkan driver, or no device that fits. Exit code 3.
    NoDevice,
    /// The device failed. Exit code 4.
    Device,
    /// Memory, or what a budget leaves of it, is too small. Exit code 4.
    Memory,
    /// Ctrl-C; what is written is valid. Exit code 130.
    Interrupted,
}

/// A failure with its values and the way out.
#[derive(Clone, Debug)]
pub struct Error {
    kind: ErrorKind,
    message: String,
    notes: Vec<String>,
}

/// The library's result.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into(), notes: Vec::new() }
    }

    /// A comparison or a gate failed.
    pub fn gate(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Gate, message)
    }

    /// A bad request, a bad file, or an output that cannot be written.
    pub fn request(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Request, message)
    }

    /// No driver or no fitting device.
    pub fn no_device(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::NoDevice, message)
    }

    /// The device failed.
    pub fn device(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Device, message)
    }

    /// Memory, or what a budget leaves of it, is too small.
    pub fn memory(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Memory, message)
    }

    /// Stopped by the user.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self::new(ErrorKind::Interrupted, message)
    }

    /// Puts the thing that was being worked on before the message: `context: message`.
    pub fn within(mut self, context: impl fmt::Display) -> Self {
        self.message = format!("{context}: {}", self.message);
        self
    }

    /// Adds a line below the message: the values, or what would work.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// What kind of trouble it is.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The first line, without its notes.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The process's exit code.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            ErrorKind::Gate => 1,
            ErrorKind::Request => 2,
            ErrorKind::NoDevice => 3,
            ErrorKind::Device | ErrorKind::Memory => 4,
            ErrorKind::Interrupted => 130,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        for note in &self.notes {
            write!(f, "\n       {note}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_reads_top_down_and_knows_its_exit_code() {
        let error = Error::request("--pattern 0x6: both numbers must be 1 to 64")
            .within("interleaved_deferred")
            .note("for example --pattern 4x4");
        assert_eq!(error.exit_code(), 2);
        assert_eq!(
            error.to_string(),
            "interleaved_deferred: --pattern 0x6: both numbers must be 1 to 64\n       for example --pattern 4x4"
        );
    }
}

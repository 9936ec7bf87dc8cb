//! Ctrl-C: asked about between frames, so that what is written stays valid. A second Ctrl-C ends the process at once.

use crate::error::{Error, Result};
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Installs the handler; called once, by the binary. Where it cannot be installed, Ctrl-C kills as usual.
pub fn install() {
    let handler = || {
        if ASKED.swap(true, Ordering::SeqCst) {
            std::process::exit(130);
        }
    };
    if let Err(error) = ctrlc::set_handler(handler) {
        eprintln!("warning: Ctrl-C will not end cleanly: {error}");
    }
}

/// Errors: the user has asked to stop (exit code 130).
pub fn check() -> Result<()> {
    if ASKED.load(Ordering::SeqCst) {
        return Err(Error::interrupted("interrupted; what is written is valid"));
    }
    Ok(())
}

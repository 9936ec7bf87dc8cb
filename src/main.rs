//! The binary: arguments in, exit code out.

use std::process::ExitCode;

fn main() -> ExitCode {
    quincunx::interrupt::install();
    let argv: Vec<String> = std::env::args().collect();
    match quincunx::cli::run(&argv) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

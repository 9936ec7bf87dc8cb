//! The binary: arguments in, exit code out.

use std::process::ExitCode;

fn main() -> ExitCode {
    quincunx::interrupt::install();
    let mut argv = Vec::new();
    for argument in std::env::args_os() {
        match argument.into_string() {
            Ok(argument) => argv.push(argument),
            Err(argument) => {
                eprintln!("error: the argument {argument:?} is not UTF-8");
                return ExitCode::from(2);
            }
        }
    }
    match quincunx::cli::run(&argv) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.exit_code())
        }
    }
}

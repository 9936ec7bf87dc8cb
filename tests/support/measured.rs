//! The program from outside, with what it took: time on a processor and memory at the peak, as the system counts them.

use super::program::{Program, Ran, quincunx};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::ExitStatus;
use std::time::Duration;

/// A run that never ends is ended by the system after as much time on a processor.
const MOST_CPU_S: u64 = 60;

/// What a run left, and took.
pub struct Measured {
    pub ran: Ran,
    /// Processor time of all its threads.
    pub cpu: Duration,
    /// Greatest resident size.
    pub peak_bytes: u64,
}

impl Program {
    /// Runs the program and measures it. Panics where a signal ended it: a crash, or `MOST_CPU_S`.
    #[expect(clippy::zombie_processes, reason = "wait4 waits, and measures")]
    pub fn measure(&self, arguments: &[&str]) -> Measured {
        let (out, err) = (self.path("standard-output"), self.path("standard-error"));
        let mut command = quincunx();
        command.current_dir(self.folder.path()).args(arguments);
        command.stdout(std::fs::File::create(&out).unwrap()).stderr(std::fs::File::create(&err).unwrap());
        // SAFETY: setrlimit is one of the calls that are allowed between fork and exec.
        unsafe {
            command.pre_exec(|| {
                let limit = libc::rlimit { rlim_cur: MOST_CPU_S, rlim_max: MOST_CPU_S };
                match libc::setrlimit(libc::RLIMIT_CPU, &limit) {
                    0 => Ok(()),
                    _ => Err(std::io::Error::last_os_error()),
                }
            });
        }
        let child = command.spawn().unwrap();
        let mut status = 0;
        // SAFETY: all zeros is a valid rusage.
        let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
        // SAFETY: a child of this process, for which nobody else waits; both places are valid.
        let waited = unsafe { libc::wait4(child.id() as i32, &mut status, 0, &mut usage) };
        assert_eq!(waited, child.id() as i32);
        let text = |file: &str| {
            let text = String::from_utf8(std::fs::read(file).unwrap()).unwrap();
            std::fs::remove_file(file).unwrap();
            text
        };
        let (out, err) = (text(&out), text(&err));
        let status = ExitStatus::from_raw(status);
        let code = status.code().unwrap_or_else(|| panic!("{arguments:?} ended by {status}: {err}"));
        let time =
            |time: libc::timeval| Duration::from_secs(time.tv_sec as u64) + Duration::from_micros(time.tv_usec as u64);
        Measured {
            ran: Ran::new(code, out, &err),
            cpu: time(usage.ru_utime) + time(usage.ru_stime),
            // Linux counts in KiB.
            peak_bytes: usage.ru_maxrss as u64 * 1024,
        }
    }
}

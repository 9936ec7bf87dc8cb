//! What else ran on the machine while rows were measured: processors' time that went to other processes, and to other
//! guests of the same host. Linux reports both (proc(5)); on other systems neither is known.

use serde::{Deserialize, Serialize};

/// From this part of all processors' time on a machine is busy. A software driver works on all processors, so what others
/// take of them a frame waits for: 5 % is about how wide the intervals of nine rounds are on a machine of two.
pub const BUSY_SHARE: f64 = 0.05;

/// Least ticks of all processors from which a share is computed: one of a hundred is a percent. Two processors have
/// them in half a second.
const LEAST_TICKS: u64 = 100;

/// Time of all processors since the machine started, in the kernel's ticks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ticks {
    /// All ticks, including idle ones.
    all: u64,
    /// Ticks spent on processes and interrupts of this machine.
    busy: u64,
    /// Taken by other guests of the host.
    steal: u64,
    /// Spent on this process.
    own: u64,
}

/// A row's `machine`: parts of all processors' time, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Part that other processes took.
    pub other_cpu_share: f64,
    /// Part that other guests of the host took.
    pub steal_share: f64,
    /// Whether both together are over `BUSY_SHARE`.
    pub busy: bool,
}

impl Ticks {
    /// None where the system does not report it.
    pub fn now() -> Option<Self> {
        let read = |path: &str| std::fs::read_to_string(path).ok();
        Self::of(&read("/proc/stat")?, &read("/proc/self/stat")?)
    }

    /// Ticks from the texts of /proc/stat and /proc/self/stat.
    fn of(machine: &str, process: &str) -> Option<Self> {
        let line = machine.lines().find_map(|line| line.strip_prefix("cpu "))?;
        let numbers: Vec<u64> = line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<_>>()?;
        // What follows are guests, which user and nice have already.
        let [user, nice, system, idle, iowait, irq, softirq, steal] = *numbers.first_chunk()?;
        let sum = |parts: &[u64]| parts.iter().try_fold(0u64, |sum, part| sum.checked_add(*part));
        let busy = sum(&[user, nice, system, irq, softirq])?;
        // The second field is a name in brackets, which may hold anything; utime and stime are the 14th and 15th.
        let (_, fields) = process.rsplit_once(')')?;
        let mut times = fields.split_whitespace().skip(11).map(|word| word.parse::<u64>().ok());
        let own = times.next()??.checked_add(times.next()??)?;
        Some(Self { all: sum(&[busy, idle, iowait, steal])?, busy, steal, own })
    }
}

impl Load {
    /// None where too little time is between both.
    pub fn between(before: Ticks, after: Ticks) -> Option<Self> {
        let passed = |of: fn(Ticks) -> u64| of(after).saturating_sub(of(before));
        let all = passed(|ticks| ticks.all);
        // The process's ticks are counted apart from the machine's, and may be one ahead.
        let other = passed(|ticks| ticks.busy).saturating_sub(passed(|ticks| ticks.own));
        let share = |ticks: u64| ticks as f64 / all as f64;
        (all >= LEAST_TICKS).then(|| Self::of(share(other), share(passed(|one| one.steal))))
    }

    fn of(other_cpu_share: f64, steal_share: f64) -> Self {
        Self { other_cpu_share, steal_share, busy: other_cpu_share + steal_share > BUSY_SHARE }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ticks of user, nice, system, idle, iowait, irq, softirq and steal, with guests behind them; and of a process's two.
    fn ticks(machine: [u64; 8], process: [u64; 2]) -> Ticks {
        let words = machine.map(|number| number.to_string()).join(" ");
        let machine = format!("cpu  {words} 7 7\ncpu0 1 2 3 4 5 6 7 8 9 10\nctxt 5\n");
        let [user, system] = process;
        let process = format!("42 (a (strange) name) R 1 2 3 4 5 6 7 8 9 10 {user} {system} 0 0 20 0 9\n");
        Ticks::of(&machine, &process).unwrap()
    }

    #[test]
    fn shares_are_of_all_processors_time() {
        let before = ticks([1000, 10, 100, 5000, 50, 5, 5, 20], [300, 40]);
        // 1000 ticks later: 600 busy, 560 of them of this process, 340 idle, 20 waiting, 40 stolen.
        let after = ticks([1500, 30, 170, 5340, 70, 10, 10, 60], [800, 100]);
        let load = Load::between(before, after).unwrap();
        assert!((load.other_cpu_share - 0.04).abs() < 1e-12 && (load.steal_share - 0.04).abs() < 1e-12, "{load:?}");
        assert!(load.busy, "together they are over a twentieth");
        assert!(!Load::of(load.other_cpu_share, 0.0).busy);
    }

    #[test]
    fn what_is_not_known_is_not_said() {
        let before = ticks([0; 8], [0, 0]);
        assert_eq!(Load::between(before, ticks([50, 0, 0, 40, 0, 0, 0, 0], [0, 0])), None, "90 ticks");
        // A process that is a tick ahead of its machine took nothing from others.
        let ahead = Load::between(before, ticks([100, 0, 0, 100, 0, 0, 0, 0], [101, 0])).unwrap();
        assert_eq!(ahead.other_cpu_share, 0.0);
        let process = "1 (x) R 1 2 3 4 5 6 7 8 9 10 1 1 0";
        for (machine, process) in [
            ("", process),
            ("cpu  1 2 3 4 5 6 7\n", process),
            ("cpu  1 2 3 4 5 6 7 x\n", process),
            ("cpu  1 2 3 4 5 6 7 8\n", ""),
            ("cpu  1 2 3 4 5 6 7 8\n", "1 (x) R 1 2"),
            ("cpu  18446744073709551615 2 3 4 5 6 7 8\n", process),
        ] {
            assert_eq!(Ticks::of(machine, process), None, "{machine:?} {process:?}");
        }
    }
}

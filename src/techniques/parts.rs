//! Frames in parts: runs that are recorded one by one, because each draws other things, and a picture of all of them at the end.
//!
//! The first run makes what all of them share, and each adds its samples to sums that are kept on the device, those of even and those of
//! odd runs apart. A picture is made of the sums, when it is wanted: of all runs, or of one half of them. How far the halves are from
//! each other says how far the whole is from what it tends to (`metrics::noise::error_of_halves`).

/// What ends runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InParts {
    /// The estimated relative error at which they end before `Frame::run_count`.
    pub until_error: Option<f64>,
}

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The samples of a run. That of index 0 begins a picture: it makes what all runs share, and sums begin with it.
    Samples { run: u32 },
    /// The picture of runs 0 to `run_count`.
    Picture { of: Runs, run_count: u32 },
}

/// Which of the runs a picture is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Runs {
    All,
    Even,
    Odd,
}

impl Runs {
    /// What the sums of even and of odd runs count in their mean, where there were `run_count` runs: at least one of these.
    pub fn weights(self, run_count: u32) -> [f32; 2] {
        let [even, odd] = halves(run_count);
        match self {
            Self::All => [1.0 / run_count as f32; 2],
            Self::Even => [1.0 / even as f32, 0.0],
            Self::Odd => [0.0, 1.0 / odd as f32],
        }
    }
}

/// How many of `run_count` runs are even, and how many odd.
pub fn halves(run_count: u32) -> [u32; 2] {
    [run_count.div_ceil(2), run_count / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_weigh_each_run_once() {
        for run_count in 1..9u32 {
            let [even, odd] = halves(run_count).map(|count| count as f32);
            let total = |[e, o]: [f32; 2]| e * even + o * odd;
            assert!((total(Runs::All.weights(run_count)) - 1.0).abs() < 1e-6);
            assert!((total(Runs::Even.weights(run_count)) - 1.0).abs() < 1e-6);
            if run_count > 1 {
                assert!((total(Runs::Odd.weights(run_count)) - 1.0).abs() < 1e-6);
            }
        }
        assert_eq!(halves(5), [3, 2]);
    }
}

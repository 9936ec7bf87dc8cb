//! The settings of progressive rendering: how many runs with lights of their own a picture has (Segovia 2006, section 6.3).

use crate::settings::{Changes, Kind, Setting, Unread, Values};
use crate::techniques::until_error::{MOST_SAMPLES, sample_count};

/// Its rows of the table.
pub const RUNS: &[Setting] = &[
    Setting {
        key: "accumulate",
        kind: Kind::Integer { min: 1, max: MOST_SAMPLES as u64 },
        auto: true,
        default: "auto",
        paper: "Segovia 2006, 6.3",
        help: "Runs whose irradiance is summed up, each with --vpls virtual lights of its own and their shadows, while the G-buffer \
               and its sub-buffers stay as they are; one filter and one composite make the picture of their mean; with \
               --until-error, the most; auto: 1, with --until-error 65536",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "until-error",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0",
        paper: "Segovia 2006, table 5",
        help: "Estimated relative standard error of the picture (root of the mean square), by how far those of even and of odd runs are \
               apart, at which runs end before --accumulate; 0: never, all of them are made",
        unread: |values| Unread::with(values, "accumulate", &["1"], "there is one run"),
        ..Setting::changing(Changes::Samples)
    },
];

/// Runs of a picture, at most where an error ends them.
pub fn run_count(values: &Values) -> u32 {
    sample_count(values, "accumulate", 1)
}

/// Why nothing reads a setting that the filter of one run alone has.
pub fn is_filtered_once(values: &Values) -> Option<Unread> {
    let key = if values.text("accumulate") == "auto" { "until-error" } else { "accumulate" };
    let reader = if key == "accumulate" { "--accumulate 1" } else { "--until-error 0" };
    let why = "runs are gathered before they are filtered";
    (run_count(values) > 1).then(|| Unread::at(values, key, reader, why))
}

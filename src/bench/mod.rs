//! Benchmarks: a grid of settings, measured in turn, each row with its error, its bytes and the command that repeats it.
//!
//! A sweep is measured in groups. A group holds the baseline and a few variants at once and measures them in rounds,
//! A B A B, so that drift of the machine falls on all of them; ratios are of the same round, and to the baseline of the
//! same group. Rows are written when their group is done.

pub mod allocate;
pub mod best;
pub mod candidate;
pub mod copy;
mod csv_file;
pub mod device;
pub mod fail_if;
pub mod faster;
pub mod frames;
pub mod group;
pub mod head;
pub mod machine;
pub mod numbers;
pub mod page;
pub mod pareto;
pub mod rates;
pub mod rates_plot;
pub mod rays;
pub mod reference;
pub mod rounds;
pub mod row;
pub mod rows_file;
pub mod run;
pub mod shard;
pub mod stats;
pub mod summary;
pub mod sweep;
pub mod table;
pub mod units;
pub mod variant;
pub mod what;

//! `bench allocate`: what a program asked of memory, replayed through each strategy and through allocators of others: the
//! same takes and gives in the same order, their time, and what memory blocks they come to.
//!
//! Bytes are found in a replay of their own, in which nothing is timed; times are of whole replays, in turn, A B A B. At a
//! replay's end all that is live is given back, so that the next one begins with nothing.

pub mod contender;
pub mod generated;
mod line_up;
mod ours;
pub mod play;
#[cfg(feature = "rivals")]
mod rivals;
pub mod rows;
mod timed;
pub mod verdict;

//! What a command leaves behind: numbers, tables.

pub mod memory;
pub mod notes;
pub mod run;

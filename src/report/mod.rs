//! What a command leaves behind: numbers, tables.

pub mod command_line;
pub mod errors;
pub mod memory;
pub mod notes;
pub mod nullable;
pub mod roofline;
pub mod run;
pub mod spread;
mod text;
pub mod trace;
pub mod work_row;

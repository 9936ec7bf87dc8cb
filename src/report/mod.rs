//! What a command leaves behind: pictures, numbers, tables.

pub mod picture;

//! What a command leaves behind: pictures, numbers, tables.

pub mod image_file;
pub mod memory;
pub mod notes;
pub mod picture;
pub mod run;
pub mod tonemap;
pub mod visible;
pub mod whole_file;

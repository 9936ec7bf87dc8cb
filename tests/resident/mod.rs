//! The scene in device memory.

mod geometry;

//! Shaders that count: what a module reads and writes in buffers and images is told to functions that are grafted into it.
//!
//! Modules are rewritten as data, without a device. `graft` brings the functions in, `layout` knows where members lie, `counting` puts
//! a call beside each access.

pub mod counting;
mod emit;
mod graft;
mod layout;
mod module;

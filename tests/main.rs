//! All tests of the program, as one program: each of their files by itself would be linked with everything.
//!
//! Tests of a room of src/ lie at its place here; what holds for the whole program lies beside the rooms.

mod compilers;
mod contract;
mod docs;
mod drivers;
mod golden;
mod large;
mod layout;
mod pretend;
mod rooms;
mod support;

// The rooms.
mod bench;
mod caps;
mod cli;
mod framing;
mod gpu;
mod lens;
mod locality;
mod memory;
mod papers;
mod passes;
mod plan;
mod progress;
mod reference;
mod report;
mod resident;
mod sampling;
mod scene;
mod selftest;
mod sequence;
mod settings;
mod shading;
mod spirv;
mod study;
mod techniques;
mod tune;

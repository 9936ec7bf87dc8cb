//! Sequences, on the host and in shaders.

mod sobol;

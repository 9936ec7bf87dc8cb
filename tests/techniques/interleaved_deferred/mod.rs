//! Interleaved deferred shading (Segovia et al. 2006) pass by pass; tests/techniques/collapse.rs holds its methods to one picture.

mod discontinuity;
mod split;
mod subsample;

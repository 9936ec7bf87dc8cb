//! Locality without a device: the addresses that a pass touches, in the order in which a GPU of given warps would touch them, through
//! given caches. Words: it explains where time may go; it does not predict it.
//!
//! The address streams are those of our own shaders, by the host twin of their mapping. A machine is data with its source, and what
//! nobody published of it is named as assumed.

pub mod access;
pub mod cache;
pub mod case;
pub mod copies;
pub mod count;
pub mod drawn;
pub mod filter;
pub mod frame;
pub mod insert;
pub mod layout;
pub mod machine;
pub mod shade;
pub mod spids;
pub mod stage;

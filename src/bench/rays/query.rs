//! What is asked along a ray.

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Whether anything is in the way.
    Any,
    /// Which triangle comes first.
    Nearest,
}

impl Query {
    /// Name in rows.
    pub fn name(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Nearest => "nearest",
        }
    }
}

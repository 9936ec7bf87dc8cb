//! What shares bytes: a range of bytes, and the passes in which it is used.

/// One transient resource: bytes, alignment (a power of two), first and last pass, inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    pub bytes: u64,
    pub alignment: u64,
    pub first: usize,
    pub last: usize,
}

impl Span {
    /// Some pass sees both.
    pub fn meets(&self, other: &Self) -> bool {
        self.first <= other.last && other.first <= self.last
    }
}

pub fn one_after_the_other(spans: &[Span]) -> Vec<u64> {
    let mut end = 0u64;
    spans
        .iter()
        .map(|span| {
            let offset = end.next_multiple_of(span.alignment);
            end = offset + span.bytes;
            offset
        })
        .collect()
}

pub fn total_bytes(spans: &[Span], offsets: &[u64]) -> u64 {
    spans.iter().zip(offsets).map(|(span, offset)| offset + span.bytes).max().unwrap_or(0)
}

//! Workgroups of compute shaders whose invocations are pixels (`--workgroup`).

use crate::caps::Caps;
use crate::settings::{Values, WORKGROUP};

/// What `auto` is on software drivers, whose invocations run one after the other.
const ROW: [u32; 2] = [64, 1];

/// And on GPUs, where pixels that lie together in both directions share what they fetch and go the same ways: of the frame with
/// 64x1 an H200 takes 0.23 (`path_traced`), 0.35 (`adaptive_interleaved`), 0.62 to 0.68 (`interleaved_deferred`), 0.78 (`deferred`).
const SQUARE_SIDE: u32 = 16;

/// Width and height, `auto` resolved.
pub fn workgroup(values: &Values, caps: &Caps) -> [u32; 2] {
    let best = match caps.identity.is_software() {
        true => ROW,
        false => [SQUARE_SIDE, SQUARE_SIDE.min(caps.limits.max_workgroup_invocations / SQUARE_SIDE)],
    };
    values.unless_auto(WORKGROUP.key, Values::pair).unwrap_or(best)
}

/// As `--workgroup` says it.
pub fn text([x, y]: [u32; 2]) -> String {
    format!("{x}x{y}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn a_gpu_has_squares_as_large_as_it_allows() {
        let of = |name: &str, most: Option<u32>| {
            let mut caps = known::caps(name).unwrap();
            caps.limits.max_workgroup_invocations = most.unwrap_or(caps.limits.max_workgroup_invocations);
            workgroup(&Values::defaults(&[WORKGROUP]), &caps)
        };
        assert_eq!(of("lavapipe-22.3.6", None), [64, 1]);
        assert_eq!(of("nvidia-h200", None), [16, 16]);
        assert_eq!(of("nvidia-h200", Some(128)), [16, 8]);
    }
}

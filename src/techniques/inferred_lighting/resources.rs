//! The technique's name, which begins those of its passes and of what it holds.

pub const NAME: &str = "inferred_lighting";

/// Full name of the frame's block at the light buffer's extent.
pub fn light_frame() -> String {
    format!("{NAME}.light.frame")
}

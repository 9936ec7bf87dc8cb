//! Explanations of failed driver calls for the reader of the error, and what would help.

use crate::error::Error;
use ash::vk;

/// The error of `doing`, which the driver answered with `result` (exit code 4).
pub fn failed(doing: &str, result: vk::Result) -> Error {
    let (what, help) = match result {
        vk::Result::ERROR_DEVICE_LOST => (
            "the device is lost",
            "its driver failed or was reset, often by a pass that ran too long: run it again with a smaller --size or fewer \
             lights, or on another --device; --validate finds mistakes of this program",
        ),
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
            ("the host's memory is spent", "end other programs, or run it again with a smaller --size")
        }
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => (
            "the device's memory is spent",
            "end other programs that use it, or run it again with a smaller --size or --texture-limit",
        ),
        _ => ("the driver refused", "--validate finds mistakes of this program; another --device has another driver"),
    };
    Error::device(format!("{doing}: {what} ({result:?})")).note(help)
}

//! Values of settings as they are typed.

use crate::units::Bytes;
use glam::Vec3;

pub fn parse_pair(text: &str) -> Option<[u32; 2]> {
    let (first, second) = text.split_once('x')?;
    Some([first.parse().ok()?, second.parse().ok()?])
}

/// `NxM`, or `N` for both.
pub fn parse_sides(text: &str) -> Option<[u32; 2]> {
    match text.parse() {
        Ok(side) => Some([side; 2]),
        Err(_) => parse_pair(text),
    }
}

pub fn parse_length(text: &str, diagonal: f64) -> Option<f64> {
    let value = match text.strip_suffix('%') {
        Some(percent) => percent.parse::<f64>().ok()? / 100.0 * diagonal,
        None => text.parse().ok()?,
    };
    value.is_finite().then_some(value)
}

/// Some(None) is `none`; a budget of no bytes is none that anything fits into.
pub fn parse_bytes(text: &str) -> Option<Option<u64>> {
    match text {
        "none" => Some(None),
        text => Bytes::parse(text).filter(|bytes| bytes.0 > 0).map(|bytes| Some(bytes.0)),
    }
}

pub fn parse_numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|number| number.parse().ok()).collect()
}

/// Some(None) is `none`; else any count of numbers.
pub fn parse_numbers_or_none(text: &str) -> Option<Option<Vec<f64>>> {
    match text {
        "none" => Some(None),
        text => parse_numbers(text).map(Some),
    }
}

/// Three numbers, or one for all three, each finite and at least 0.
pub fn parse_color(text: &str) -> Option<Vec3> {
    let numbers: Vec<f32> = text.split(',').map(|part| part.parse().ok()).collect::<Option<_>>()?;
    let color = match numbers[..] {
        [all] => Vec3::splat(all),
        [r, g, b] => Vec3::new(r, g, b),
        _ => return None,
    };
    (color.is_finite() && color.cmpge(Vec3::ZERO).all()).then_some(color)
}

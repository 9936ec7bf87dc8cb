//! Numbers as a reader sees them.

use super::recipe::Number;

/// Four digits, as many as papers print; below a thousandth with a power of ten.
pub fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let whole = value.abs().log10().floor() as i32;
    if whole < -3 { format!("{value:.3e}") } else { format!("{value:.*}", (3 - whole).max(0) as usize) }
}

/// With its bounds.
pub fn number(number: &Number) -> String {
    match number.bounds {
        Some([low, high]) => format!("{} ({} to {})", digits(number.value), digits(low), digits(high)),
        None => digits(number.value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [
            (1.0, "1.000"),
            (36.2, "36.20"),
            (117.06, "117.1"),
            (5280.0, "5280"),
            (0.0123, "0.01230"),
            (0.00123, "0.001230"),
            (-0.000_018_3, "-1.830e-5"),
            (0.0, "0"),
        ] {
            assert_eq!(digits(value), text);
        }
        assert_eq!(number(&Number { value: 2.0, bounds: Some([1.5, 2.5]) }), "2.000 (1.500 to 2.500)");
    }
}

//! Numbers as a reader sees them.

use super::recipe::Number;

/// Four digits, as many as papers print.
pub fn digits(value: f64) -> String {
    let whole = value.abs().max(1e-9).log10().floor() as i32;
    format!("{value:.*}", (3 - whole).clamp(0, 6) as usize)
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
            (0.0, "0.000000"),
        ] {
            assert_eq!(digits(value), text);
        }
        assert_eq!(number(&Number { value: 2.0, bounds: Some([1.5, 2.5]) }), "2.000 (1.500 to 2.500)");
    }
}

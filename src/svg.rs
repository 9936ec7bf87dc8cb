//! What the SVG files of plots have in common.

use std::fmt::{Result, Write};

/// Begins a white page of so many units across and down, in which text is 12 units high; `</svg>` ends it.
pub fn begin(text: &mut String, [width, height]: [f64; 2]) -> Result {
    writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>"
    )
}

/// A text as XML has it between tags.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

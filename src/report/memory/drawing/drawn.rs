//! A picture, and names in it.

use crate::svg;
use maud::{Markup, PreEscaped, html};

/// A picture of so many units across and down.
pub struct Drawing {
    pub title: &'static str,
    pub size: [f64; 2],
    pub parts: Markup,
}

impl Drawing {
    /// As a part of a page, whose stylesheet has `svg text`.
    pub fn inline(&self) -> Markup {
        let [width, height] = self.size;
        html! {
            svg role="img" aria-label=(self.title) viewBox={ "0 0 " (width) " " (height) } { (self.parts) }
        }
    }

    /// As a file.
    pub fn file(&self) -> String {
        let mut text = String::new();
        svg::begin(&mut text, self.size).expect("writing to a string");
        text.push_str(&html! { (PreEscaped("<g>")) (self.parts) (PreEscaped("</g>")) }.into_string());
        text.push_str("\n</svg>\n");
        text
    }
}

/// As much of a name as has room, at seven units a letter.
pub fn cut(name: &str, room: f64) -> Option<String> {
    let most = (room / 7.0) as usize;
    match name.chars().count() {
        count if count <= most => Some(name.to_owned()),
        _ if most >= 4 => Some(name.chars().take(most - 1).chain(['…']).collect()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_as_long_as_their_room() {
        assert_eq!(cut("split.normal", 200.0).as_deref(), Some("split.normal"));
        assert_eq!(cut("split.normal", 42.0).as_deref(), Some("split…"));
        assert_eq!(cut("split.normal", 20.0), None);
    }
}

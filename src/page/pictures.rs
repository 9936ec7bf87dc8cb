//! Pictures within a page: one over another with a slider, and each by itself.

use crate::error::{Error, Result};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, html};
use std::path::{Path, PathBuf};

/// A file with more is none of our pictures.
const MOST_BYTES: u64 = 64 << 20;

/// PNG files by their titles. Nothing where there are none.
///
/// Errors: one cannot be read (exit code 2).
pub fn markup<'a>(files: impl Iterator<Item = (&'a str, PathBuf)>) -> Result<Markup> {
    let pictures: Vec<(&str, String)> = files.map(|(title, path)| Ok((title, data(&path)?))).collect::<Result<_>>()?;
    if pictures.is_empty() {
        return Ok(html! {});
    }
    Ok(html! {
        @if pictures.len() > 1 { (slider(&pictures)) }
        div.pictures {
            @for (title, data) in &pictures {
                figure { img src=(data) alt=(title) loading="lazy"; figcaption { (title) } }
            }
        }
    })
}

/// Two of the pictures, chosen by name, and a line between them that moves.
fn slider(pictures: &[(&str, String)]) -> Markup {
    let choice = |name: &str, chosen: usize| {
        html! {
            select aria-label={ "picture on the " (name) } data-side=(name) {
                @for (index, (title, _)) in pictures.iter().enumerate() {
                    option value=(index) selected[index == chosen] { (title) }
                }
            }
        }
    };
    html! {
        div.slider {
            div.stage {
                img.right src=(pictures[1].1) alt=(pictures[1].0);
                img.left src=(pictures[0].1) alt=(pictures[0].0);
            }
            input type="range" min="0" max="100" value="50" aria-label="line between both pictures";
            div.choices { (choice("left", 0)) (choice("right", 1)) }
        }
    }
}

/// A PNG as an address that holds it.
fn data(path: &Path) -> Result<String> {
    let failed = |why: &dyn std::fmt::Display| Error::request(format!("cannot read {}: {why}", path.display()));
    let bytes = path.metadata().map_err(|error| failed(&error))?.len();
    if bytes > MOST_BYTES {
        return Err(failed(&format!("it has {bytes} bytes; up to {MOST_BYTES} go into a page")));
    }
    let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(bytes)))
}

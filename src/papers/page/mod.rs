//! Reproductions as one HTML file that needs nothing else: tables that sort, plots, pictures with a slider.

mod dots;
mod item;

use super::outcome::Outcome;
use crate::error::Result;
use crate::page;
use crate::whole_file::write_whole;
use maud::{Markup, html};
use std::io::Write;
use std::path::{Path, PathBuf};

/// An item's outcome, and the folder of its pictures.
pub type Made = (Outcome, PathBuf);

/// Writes all of `made` as one page.
///
/// Errors: a picture cannot be read, or the page cannot be written (exit code 2).
pub fn write(path: &Path, made: &[Made]) -> Result<()> {
    let items = made.iter().map(|(outcome, folder)| item::markup(outcome, folder)).collect::<Result<Vec<_>>>()?;
    let text = text(made, &items);
    write_whole(path, |out| out.write_all(text.as_bytes()))
}

fn text(made: &[Made], items: &[Markup]) -> String {
    let title = match made {
        [(only, _)] => format!("{}/{}: {}", only.paper, only.item, only.title),
        _ => "Published tables and figures, made again".to_owned(),
    };
    let body = html! {
        p.note {
            "Made by " code { "quincunx reproduce" } ". Published numbers are hollow in plots, ours are filled, with their bounds: "
            "the least and the greatest of times, 95 % intervals of ratios."
        }
        @if made.len() > 1 { (contents(made)) }
        @for item in items { (item) }
    };
    page::document(&title, &body)
}

/// Links to the items, with their verdicts.
fn contents(made: &[Made]) -> Markup {
    html! {
        nav {
            ul {
                @for (outcome, _) in made {
                    li {
                        a href={ "#" (item::anchor(outcome)) } { (outcome.paper) "/" (outcome.item) }
                        " " (outcome.title) " "
                        span.verdict { (outcome.verdict) }
                    }
                }
            }
        }
    }
}

//! What five papers publish, as data: each table, figure and number with its place, what may be compared with it, and the
//! commands that make it here.

pub mod clarberg_2014;
mod close_up;
pub mod columns;
pub mod digits;
pub mod dubla_2009;
pub mod figures;
pub mod found;
pub mod item;
pub mod keller_2001;
pub mod kircher_2009;
pub mod listing;
pub mod outcome;
pub mod page;
pub mod recipe;
pub mod reproduce;
pub mod request;
pub mod segovia_2006;
pub mod step_run;
pub mod text;

#[cfg(test)]
mod checks;

use crate::error::{Error, Result};
use item::{Item, Paper};

/// In the order in which they were published.
pub const ALL: &[&Paper] =
    &[&keller_2001::PAPER, &segovia_2006::PAPER, &kircher_2009::PAPER, &dubla_2009::PAPER, &clarberg_2014::PAPER];

/// Every item of every paper.
pub fn all() -> Vec<(&'static Paper, &'static Item)> {
    ALL.iter().flat_map(|paper| paper.items.iter().map(|item| (*paper, item))).collect()
}

/// The item of `PAPER/ITEM`, or all of `PAPER`.
///
/// Errors: there is no such paper or item (exit code 2, and which there are).
pub fn find(name: &str) -> Result<Vec<(&'static Paper, &'static Item)>> {
    let (paper_name, item_name) = name.split_once('/').map_or((name, None), |(paper, item)| (paper, Some(item)));
    let paper = ALL.iter().find(|paper| paper.name == paper_name).ok_or_else(|| {
        let names: Vec<&str> = ALL.iter().map(|paper| paper.name).collect();
        Error::request(format!("{name}: there is no paper {paper_name}; there are {}", names.join(", ")))
    })?;
    let Some(item_name) = item_name else {
        return Ok(paper.items.iter().map(|item| (*paper, item)).collect());
    };
    let item = paper.item(item_name).ok_or_else(|| {
        let names: Vec<&str> = paper.items.iter().map(|item| item.name).collect();
        Error::request(format!("{name}: {paper_name} has no item {item_name}; it has {}", names.join(", ")))
    })?;
    Ok(vec![(*paper, item)])
}

//! What a paper prints, as data: its tables, the curves of its figures and the numbers in its text.

use super::recipe::{Effort, Recipe};

/// A paper with all that it publishes.
pub struct Paper {
    /// Author and year, as the command line has it.
    pub name: &'static str,
    pub authors: &'static str,
    pub title: &'static str,
    /// Where and when it was published.
    pub venue: &'static str,
    pub items: &'static [Item],
}

/// A table, a figure or a section with numbers.
pub struct Item {
    /// As the command line has it behind the paper's: `table-1`.
    pub name: &'static str,
    /// What it shows, in our words.
    pub title: &'static str,
    /// Its section, and its page where the paper's text has pages.
    pub place: &'static str,
    /// Its numbers; none of a picture that has no numbers.
    pub published: &'static [Published],
    pub verdict: Verdict,
    /// How it is made here; None where the verdict says that it is not.
    pub recipe: Option<fn(Effort) -> Recipe>,
}

/// What may be compared. Each has the reason, a sentence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The numbers themselves: bytes, counts, arithmetic.
    Comparable(&'static str),
    /// How numbers relate to each other, or what a picture shows; the numbers are those of another machine or scene.
    ShapeOnly(&'static str),
    /// Nothing: it cannot be made here.
    NotHere(&'static str),
}

impl Verdict {
    /// As the command line and the documents write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Comparable(_) => "comparable",
            Self::ShapeOnly(_) => "shape only",
            Self::NotHere(_) => "not here",
        }
    }

    pub fn reason(self) -> &'static str {
        let (Self::Comparable(reason) | Self::ShapeOnly(reason) | Self::NotHere(reason)) = self;
        reason
    }
}

/// Where the paper has no number.
pub const ABSENT: f64 = f64::NAN;

/// Numbers of one unit.
pub struct Published {
    pub title: &'static str,
    /// What each number is in: ms, frames/s, MiB, times.
    pub unit: &'static str,
    pub columns: &'static [&'static str],
    /// Name and numbers, one a column, `ABSENT` among them.
    pub rows: &'static [(&'static str, &'static [f64])],
    pub scale: Scale,
}

/// What of a number is laid beside ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The number.
    Itself,
    /// Its part of the number that this row has in its column.
    PartsOfRow(&'static str),
    /// Its part of the number that this column has in its row.
    PartsOfColumn(&'static str),
    /// Nothing: it is of the paper's machine alone.
    ItsMachine,
}

impl Published {
    /// The number of a row and a column; None where there is none.
    pub fn number(&self, row: &str, column: &str) -> Option<f64> {
        let column = self.columns.iter().position(|name| *name == column)?;
        let (_, numbers) = self.rows.iter().find(|(name, _)| *name == row)?;
        numbers.get(column).copied().filter(|number| !number.is_nan())
    }

    /// The number that the one of `row` and `column` is laid against, by its own row and column; None where numbers stand
    /// for themselves.
    pub fn whole_of<'a>(&self, row: &'a str, column: &'a str) -> Option<(&'a str, &'a str)> {
        match self.scale {
            Scale::Itself | Scale::ItsMachine => None,
            Scale::PartsOfRow(whole) => Some((whole, column)),
            Scale::PartsOfColumn(whole) => Some((row, whole)),
        }
    }

    /// Numbers of a column from the top, as far as it has them.
    ///
    /// Panics: there is no such column, which is a mistake of this program.
    pub fn column(&self, column: &str) -> impl Iterator<Item = (&'static str, f64)> {
        let index = self.columns.iter().position(|name| *name == column).expect("a column of the table");
        self.rows.iter().map(move |(name, numbers)| (*name, numbers[index])).filter(|(_, number)| !number.is_nan())
    }
}

impl Paper {
    /// `name` among its items.
    pub fn item(&self, name: &str) -> Option<&'static Item> {
        self.items.iter().find(|item| item.name == name)
    }
}

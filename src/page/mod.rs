//! What HTML pages have in common: one file that needs nothing else, readable on a phone and in the dark, whose tables sort.

pub mod pictures;
pub mod scale;

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A page of this title.
pub fn document(title: &str, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(include_str!("page.css"))) }
            }
            body {
                main {
                    h1 { (title) }
                    (body)
                }
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
    }
    .into_string()
}

/// A table whose head sorts it: titles, with whether they are of numbers, and of each row the cells with their numbers.
pub fn table(columns: &[(&str, bool)], rows: &[Vec<(Markup, Option<f64>)>]) -> Markup {
    html! {
        div.scroll {
            table {
                thead { tr { @for (title, _) in columns { th scope="col" { button type="button" { (title) } } } } }
                tbody {
                    @for row in rows {
                        tr {
                            @for ((_, is_number), (text, value)) in columns.iter().zip(row) {
                                td class=[is_number.then_some("number")] data-value=[value] { (text) }
                            }
                        }
                    }
                }
            }
        }
    }
}

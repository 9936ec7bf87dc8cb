//! Choices of settings: enums whose values are words, from one declaration that rows, parsers and texts are made from.
//!
//! A room of its own on the ground floor, because rooms on every floor have such enums.

/// A value that one word of a closed list stands for.
pub trait Choice: Copy + Into<&'static str> + 'static {
    /// All values, in the order in which help shows their words.
    const ALL: &'static [Self];

    /// The value of a word; None: the list does not have it.
    fn from_word(word: &str) -> Option<Self>;
}

/// Declares an enum with a word for each value: `WORDS`, in the order in which help shows them, `name` and `Choice`. A number
/// after the value is the value's in shaders.
macro_rules! choices {
    (
        $(#[$of_enum:meta])*
        pub enum $name:ident {
            $($(#[$of_value:meta])* $word:literal => $value:ident $(= $number:literal)?,)+
        }
    ) => {
        $(#[$of_enum])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {
            $($(#[$of_value])* $value $(= $number)?,)+
        }

        impl $name {
            /// The words of all values.
            pub const WORDS: &'static [&'static str] = &[$($word),+];

            /// Its word.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $word,)+
                }
            }
        }

        impl $crate::choice::Choice for $name {
            const ALL: &'static [Self] = &[$(Self::$value),+];

            fn from_word(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$value),)+
                    _ => None,
                }
            }
        }

        impl From<$name> for &'static str {
            fn from(value: $name) -> Self {
                value.name()
            }
        }
    };
}

pub(crate) use choices;

#[cfg(test)]
mod tests {
    use super::Choice;

    choices! {
        /// Where to.
        #[derive(Default)]
        pub enum Way {
            /// Along the shore.
            #[default]
            "long-way" => Long = 7,
            "short" => Short = 3,
        }
    }

    #[test]
    fn a_declaration_is_the_enum_its_words_its_parser_and_its_texts() {
        assert_eq!(Way::WORDS, ["long-way", "short"]);
        for word in Way::WORDS {
            assert_eq!(Way::from_word(word).map(Way::name), Some(*word));
        }
        assert_eq!(Way::ALL, [Way::Long, Way::Short]);
        assert_eq!(Way::from_word("long-way"), Some(Way::default()));
        for other in ["", "Short", "short ", "shor", "auto"] {
            assert_eq!(Way::from_word(other), None);
        }
        assert_eq!((Way::Long as u32, Way::Short as u32), (7, 3));
        assert_eq!(<&str>::from(Way::Short), "short");
    }
}

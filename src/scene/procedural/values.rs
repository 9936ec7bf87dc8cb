//! What a built-in scene can be asked for, and its parameters as they were given.

/// One thing that a scene can be asked for.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    pub key: &'static str,
    pub description: &'static str,
    pub choice: Choice,
}

/// What a parameter may be.
#[derive(Clone, Copy, Debug)]
pub enum Choice {
    /// A whole number between the least and the greatest.
    Number { default: u64, range: [u64; 2] },
    /// One of these; the first by default.
    Word(&'static [&'static str]),
}

impl Choice {
    /// The values that it may have, and its default.
    pub fn described(&self) -> String {
        match self {
            Self::Number { default, range: [least, greatest] } => format!("{least} to {greatest}, default {default}"),
            Self::Word(words) => format!("{}, default {}", words.join(" or "), words[0]),
        }
    }

    /// The number, or the place of the word.
    pub(super) fn default(&self) -> u64 {
        if let Self::Number { default, .. } = self { *default } else { 0 }
    }

    pub(super) fn parse(&self, text: &str) -> Option<u64> {
        match self {
            Self::Number { range: [least, greatest], .. } => {
                text.parse().ok().filter(|value| (least..=greatest).contains(&value))
            }
            Self::Word(words) => words.iter().position(|word| *word == text).map(|place| place as u64),
        }
    }

    pub(super) fn text(&self, value: u64) -> String {
        match self {
            Self::Number { .. } => value.to_string(),
            Self::Word(words) => words[value as usize].to_owned(),
        }
    }
}

/// One value for each parameter of a scene, in its order.
pub struct Values(pub(super) Vec<(&'static str, u64)>);

impl Values {
    pub(super) fn get(&self, key: &str) -> u64 {
        let found = self.0.iter().find(|(name, _)| *name == key);
        found.expect("a scene reads only the parameters that it lists").1
    }
}

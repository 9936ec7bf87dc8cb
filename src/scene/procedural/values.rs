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
    /// `off` or `on`. While it is off, a scene is called as if it had no such parameter: one that had none before stays
    /// the same scene.
    Switch,
    /// The seed of what is scattered in it, where it is not that of the picture's samples (`--seed`).
    Seed,
}

/// What every scene can be asked for.
pub const SEED: Parameter = Parameter {
    key: "seed",
    description: "seed of what the scene scatters, when --seed is to change a picture's samples alone",
    choice: Choice::Seed,
};

const OFF_ON: [&str; 2] = ["off", "on"];

impl Choice {
    /// The values that it may have, and its default.
    pub fn described(&self) -> String {
        match self {
            Self::Number { default, range: [least, greatest] } => format!("{least} to {greatest}, default {default}"),
            Self::Word(words) => format!("{}, default {}", words.join(" or "), words[0]),
            Self::Switch => Self::Word(&OFF_ON).described(),
            Self::Seed => format!("0 to {}, default --seed", u32::MAX),
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
            Self::Switch => Self::Word(&OFF_ON).parse(text),
            Self::Seed => text.parse::<u32>().ok().map(u64::from),
        }
    }

    pub(super) fn text(&self, value: u64) -> String {
        match self {
            Self::Number { .. } | Self::Seed => value.to_string(),
            Self::Word(words) => words[value as usize].to_owned(),
            Self::Switch => Self::Word(&OFF_ON).text(value),
        }
    }

    /// Whether it stands in a scene's name at `value`.
    pub(super) fn is_named(&self, value: u64) -> bool {
        !matches!((self, value), (Self::Switch, 0))
    }
}

/// One value for each parameter of a scene, and its seed where it was asked for one.
pub struct Values(pub(super) Vec<(&'static str, u64)>);

impl Values {
    /// The seed that it was asked for.
    pub(super) fn seed(&self) -> Option<u64> {
        self.0.iter().find(|(name, _)| *name == SEED.key).map(|(_, seed)| *seed)
    }

    pub(super) fn get(&self, key: &str) -> u64 {
        let found = self.0.iter().find(|(name, _)| *name == key);
        found.expect("a scene reads only the parameters that it lists").1
    }
}

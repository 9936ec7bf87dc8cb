//! Settings that not every choice of others reads: `Setting::unread` of a row says why.
//!
//! A render refuses a changed value that nothing reads, a benchmark measures what it leaves equal only once: both ask here.

use super::{Setting, Unread, Values};
use crate::error::{Error, Result};

impl Unread {
    /// None where `key` has one of the values `readers`, of its enum or as words; `why`: what the others lack, after the
    /// colon.
    pub fn unless<T>(values: &Values, key: &str, readers: &[T], why: &'static str) -> Option<Self>
    where
        T: Copy + Into<&'static str>,
    {
        let (text, readers) = (values.text(key), words(readers));
        let words = match &readers[..] {
            [] => String::new(),
            [one] => (*one).to_owned(),
            [few @ .., last] => format!("{} or {last}", few.join(", ")),
        };
        (!readers.contains(&text)).then(|| Self {
            with: format!("--{key} {text}"),
            why,
            readers: format!("--{key} {words}"),
        })
    }

    /// Some where `key` has one of the values `others`, of its enum or as words.
    pub fn with<T>(values: &Values, key: &str, others: &[T], why: &'static str) -> Option<Self>
    where
        T: Copy + Into<&'static str>,
    {
        let text = values.text(key);
        let readers = format!("any other --{key}");
        words(others).contains(&text).then(|| Self { with: format!("--{key} {text}"), why, readers })
    }

    /// Some where the list `key`, which is no `auto`, lacks `word`.
    pub fn unlisted(values: &Values, key: &str, word: &str, why: &'static str) -> Option<Self> {
        let text = values.text(key);
        let readers = format!("--{key} {word}");
        (!text.split(',').any(|listed| listed == word)).then(|| Self { with: format!("--{key} {text}"), why, readers })
    }

    /// Some where `key`, a number of at least 0, is 0.
    pub fn without(values: &Values, key: &str, why: &'static str) -> Option<Self> {
        let readers = format!("--{key} above 0");
        (values.number(key) <= 0.0).then(|| Self { with: format!("--{key} {}", values.text(key)), why, readers })
    }

    /// What is not read at the value that `key` has; `readers`: an option with a value at which it is.
    pub fn at(values: &Values, key: &str, readers: &str, why: &'static str) -> Self {
        Self { with: format!("--{key} {}", values.text(key)), why, readers: readers.to_owned() }
    }

    /// The refusal of `--KEY VALUE`, in one sentence.
    pub fn sentence(&self, key: &str, value: &str) -> String {
        let Self { with, why, readers } = self;
        format!("--{key} {value} with {with}: {why}; {readers} would read it")
    }
}

fn words<T: Copy + Into<&'static str>>(values: &[T]) -> Vec<&'static str> {
    values.iter().map(|value| (*value).into()).collect()
}

/// Errors: the value of a setting is not its default, and nothing reads it (exit code 2).
pub fn require_read(settings: &[Setting], values: &Values) -> Result<()> {
    for setting in settings {
        let (key, text) = (setting.key, values.text(setting.key));
        if text != setting.default
            && let Some(unread) = (setting.unread)(values)
        {
            return Err(Error::request(unread.sentence(key, text))
                .note(format!("--{key} {} is the default, which is always accepted", setting.default)));
        }
    }
    Ok(())
}

/// `values` with every setting that nothing reads at its default: two requests with the same effect are equal.
pub fn without_unread(settings: &[Setting], values: &Values) -> Values {
    let mut read = values.clone();
    for setting in settings {
        if (setting.unread)(values).is_some() {
            read.set(setting, setting.default).expect("a default is possible");
        }
    }
    read
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::{Changes, Kind};

    const ROAD: Setting = Setting {
        key: "road",
        kind: Kind::Choice(&["short", "long", "none"]),
        default: "short",
        ..Setting::changing(Changes::Picture)
    };
    const WIDTH: Setting = Setting {
        key: "width",
        kind: Kind::Integer { min: 0, max: 9 },
        default: "3",
        unread: |values| Unread::unless(values, "road", &["long"], "it is a point"),
        ..ROAD
    };
    const SIGNS: Setting = Setting {
        key: "signs",
        kind: Kind::Choice(&["off", "on"]),
        default: "off",
        unread: |values| {
            let without_road = Unread::with(values, "road", &["none"], "there is no road");
            without_road.or_else(|| Unread::without(values, "width", "it has no room"))
        },
        ..ROAD
    };
    const ALL: [Setting; 3] = [ROAD, WIDTH, SIGNS];
    fn values(changes: &[(&Setting, &str)]) -> Values {
        let mut values = Values::defaults(&ALL);
        changes.iter().for_each(|(setting, text)| values.set(setting, text).unwrap());
        values
    }

    #[test]
    fn a_changed_value_that_nothing_reads_is_refused_with_what_would_read_it() {
        let refused = |changes: &[(&Setting, &str)]| require_read(&ALL, &values(changes)).err();
        for fine in
            [&[][..], &[(&ROAD, "none")], &[(&ROAD, "long"), (&WIDTH, "5")], &[(&SIGNS, "on")], &[(&WIDTH, "3")]]
        {
            assert!(refused(fine).is_none(), "{fine:?}");
        }
        for (changes, sentence) in [
            (&[(&WIDTH, "5")][..], "--width 5 with --road short: it is a point; --road long would read it"),
            (
                &[(&ROAD, "none"), (&SIGNS, "on")],
                "--signs on with --road none: there is no road; any other --road would read it",
            ),
            (
                &[(&ROAD, "long"), (&WIDTH, "0"), (&SIGNS, "on")],
                "--signs on with --width 0: it has no room; --width above 0 would read it",
            ),
        ] {
            let error = refused(changes).unwrap();
            assert_eq!((error.exit_code(), error.message()), (2, sentence));
        }
    }

    #[test]
    fn requests_that_come_to_the_same_are_equal() {
        let read = |changes: &[(&Setting, &str)]| without_unread(&ALL, &values(changes));
        assert_eq!(read(&[(&WIDTH, "5")]), values(&[]));
        assert_eq!(read(&[(&ROAD, "long"), (&WIDTH, "5")]), values(&[(&ROAD, "long"), (&WIDTH, "5")]));
    }
}

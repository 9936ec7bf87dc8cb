//! A command as it is typed: words that a shell would part or change stand in quotes.

use std::borrow::Cow;

/// The words in one line, for a POSIX shell.
pub fn command_line(words: &[impl AsRef<str>]) -> String {
    words.iter().map(|word| quoted(word.as_ref())).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &str) -> Cow<'_, str> {
    let is_plain = |letter: char| letter.is_alphanumeric() || "-_./:=,@%+".contains(letter);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.into()
    } else if word.contains(['"', '$', '`', '\\', '!']) {
        // In these quotes every letter stands for itself, but the quote.
        format!("'{}'", word.replace('\'', r"'\''")).into()
    } else {
        format!("\"{word}\"").into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_shell_would_part_or_change_stands_in_quotes() {
        for (words, line) in [
            (&["bench", "cornell:motion=on", "3%", "-o", "out/ä.b"][..], "bench cornell:motion=on 3% -o out/ä.b"),
            (&["--point", "a: kernel=7 seed=2"], "--point \"a: kernel=7 seed=2\""),
            (&["--fail-if", "flip>0.1", ""], "--fail-if \"flip>0.1\" \"\""),
            (&["it's", "$HOME", "it's $HOME"], "\"it's\" '$HOME' 'it'\\''s $HOME'"),
        ] {
            assert_eq!(command_line(words), line);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_shell_reads_the_words_again() {
        let words = ["a b", "", "*", "$HOME", "it's", "\"'$`\\!", "a;b", "~", "#", "a\nb", "(", "{a,b}", "a=b c", "%1"];
        let script = format!("printf '%s\\0' {}", command_line(&words));
        let output = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), words.map(|word| format!("{word}\0")).concat());
    }
}

//! Any text as a value of any setting, a sweep, a baseline, a range of frames: refused with exit code 2, or read back
//! by every reader of its kind.

#![no_main]

use libfuzzer_sys::fuzz_target;
use quincunx::{Error, techniques};
use quincunx::bench::sweep;
use quincunx::sequence::Frames;
use quincunx::settings::{Kind, Setting, Values};
use quincunx::techniques::settings_of;
use std::sync::LazyLock;

static SETTINGS: LazyLock<Vec<Setting>> = LazyLock::new(|| {
    let mut all: Vec<Setting> = Vec::new();
    for setting in techniques::ALL.iter().flat_map(|technique| settings_of(*technique)) {
        if all.iter().all(|known| known.key != setting.key) {
            all.push(setting);
        }
    }
    all
});

/// How many combinations of a sweep are made: the number of axes is the user's.
const MOST_POINTS: usize = 1 << 12;

fn require_request(error: &Error) {
    assert_eq!(error.exit_code(), 2, "{error}");
}

fn read_back(values: &Values, setting: &Setting) {
    let key = setting.key;
    match setting.kind {
        _ if setting.auto && values.text(key) == "auto" => {}
        Kind::Integer { min, max } => assert!((min..=max).contains(&values.integer(key))),
        Kind::Number { min, max } => assert!((min..=max).contains(&values.number(key))),
        Kind::Choice(choices) => assert!(choices.contains(&values.text(key))),
        Kind::Pair { min, max } => assert!(values.pair(key).iter().all(|side| (min..=max).contains(side))),
        Kind::Sides { min, max } => assert!(values.sides(key).iter().all(|side| (min..=max).contains(side))),
        Kind::Length => assert!(values.length(key, 1.0) >= 0.0),
        Kind::Bytes => assert!(values.bytes(key).is_none_or(|bytes| bytes > 0)),
        Kind::PowerOfBytes { min, max } => {
            let bytes = values.power_of_bytes(key);
            assert!(bytes.is_power_of_two() && (min..=max).contains(&bytes));
        }
        Kind::Color => assert!(values.color(key).is_finite()),
        Kind::Words(words) => assert!(values.text(key).split(',').all(|word| words.contains(&word))),
        Kind::Parts(parts) if parts.len() == 2 => drop(values.numbers::<2>(key)),
        Kind::Parts(_) => drop(values.numbers::<3>(key)),
        Kind::PartsOrNone(parts) if parts.len() == 2 => drop(values.numbers_or_none::<2>(key)),
        Kind::PartsOrNone(_) => drop(values.numbers_or_none::<3>(key)),
        _ => {}
    }
}

fuzz_target!(init: quincunx_fuzz::seeds::write_if_asked("settings"), |input: (u8, u8, String)| {
    let (what, which, text) = input;
    match what % 4 {
        0 | 1 => {
            let setting = &SETTINGS[usize::from(which) % SETTINGS.len()];
            let mut values = Values::defaults(&SETTINGS);
            match values.set(setting, &text) {
                Ok(()) => read_back(&values, setting),
                Err(error) => require_request(&error),
            }
        }
        2 => {
            if let Err(error) = sweep::point(&text) {
                require_request(&error);
            }
            let texts: Vec<String> = text.split('\n').map(str::to_owned).collect();
            match sweep::axes(&texts) {
                Err(error) => require_request(&error),
                Ok(axes) => {
                    let count = axes.iter().try_fold(1usize, |count, axis| count.checked_mul(axis.values.len()));
                    if count.is_some_and(|count| count <= MOST_POINTS) {
                        let grid = sweep::with_points(sweep::grid(&axes), &[]).unwrap();
                        assert_eq!(Some(grid.len()), count);
                        let named = sweep::label(&grid[usize::from(which) % grid.len()].point);
                        let found = sweep::parts(&grid, Some(&named)).unwrap()[0].baseline.unwrap();
                        assert_eq!(sweep::label(&grid[found].point), named);
                        if let Err(error) = sweep::parts(&grid, Some(&texts[0])) {
                            require_request(&error);
                        }
                    }
                }
            }
        }
        _ => {
            let (frames, fps) = text.split_once('\n').unwrap_or((&text, "24"));
            match Frames::parse(frames, fps) {
                Ok(frames) => assert!(frames.count() >= 1),
                Err(error) => require_request(&error),
            }
        }
    }
});

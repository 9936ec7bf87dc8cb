//! A sweep of 200 rows that is killed (SIGKILL) three times, at moments that nobody chose, ends with the rows of one that was not;
//! each time one measurement is lost at most.

use crate::support::benched::read;
use crate::support::program::{Program, quincunx};
use quincunx::bench::row::BenchRow;
use quincunx::sampling::pcg::Pcg32;
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::process::Stdio;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

const ROWS: &str = "out/rows.jsonl";
const COUNT: usize = 200;
const KILLS: usize = 3;
/// No machine takes as long to measure a few small rows.
const PATIENCE: Duration = Duration::from_secs(300);

/// A sweep over seeds of the samples alone, whose rows share their shaders and have a picture each, in groups of one.
fn words(seeds: &str) -> Vec<&str> {
    let small =
        ["bench", "frame", "cornell:seed=1", "--size", "16x16", "--vpls", "16", "--repeat", "1", "--group", "1"];
    [&small[..], &["--sweep", seeds, "--json", "--quiet", "-o"]].concat()
}

/// What is on disk: whole lines, and behind them what was torn.
fn on_disk(program: &Program) -> String {
    std::fs::read_to_string(program.path(ROWS)).unwrap_or_default()
}

fn whole(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

fn rows(text: &str) -> Vec<BenchRow> {
    whole(text)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|error| panic!("{error}: {line}")))
        .collect()
}

/// All of a row that is the same in each run.
fn lasting(rows: &[BenchRow]) -> Vec<impl PartialEq + std::fmt::Debug + use<>> {
    let one = |row: &BenchRow| {
        assert!(row.frame_ms.is_some() && row.ratio.is_some(), "{}", row.line());
        let of = (row.key(), row.settings.clone(), row.planned_bytes);
        (of, row.image_hash.clone(), row.error_against_none, row.counters.clone())
    };
    rows.iter().map(one).collect()
}

/// Starts the sweep and kills it once `enough` rows are on disk, `late` of the time of a row after that. Returns how many rows it has
/// shown.
fn run_and_kill(program: &Program, words: &[&str], enough: usize, late: f64) -> usize {
    let count = || whole(&on_disk(program)).lines().count();
    let before = count();
    let shown = program.path("shown.jsonl");
    let mut child = quincunx()
        .current_dir(program.folder.path())
        .args(words)
        .stdout(File::create(&shown).unwrap())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let mut first = None;
    let pace = loop {
        let found = count();
        if found > before {
            let (since, from) = *first.get_or_insert_with(|| (Instant::now(), found));
            if found >= enough {
                break since.elapsed() / (found - from).max(1) as u32;
            }
        }
        assert!(begun.elapsed() < PATIENCE && child.try_wait().unwrap().is_none(), "{found} of {enough} rows");
        std::thread::sleep(Duration::from_millis(1));
    };
    std::thread::sleep(pace.mul_f64(late));
    child.kill().unwrap();
    assert_eq!(child.wait().unwrap().signal(), Some(libc::SIGKILL), "it has ended before");
    whole(&std::fs::read_to_string(shown).unwrap()).lines().count()
}

#[test]
fn a_sweep_that_is_killed_three_times_ends_with_the_rows_of_one_that_was_not() {
    let seeds: Vec<String> = (1..=COUNT).map(|seed| seed.to_string()).collect();
    let seeds = format!("seed={}", seeds.join(","));
    let words = words(&seeds);
    let program = Program::new();
    let begun = Instant::now();
    program.run(&[&words[..], &["whole"]].concat()).fine();
    println!("{COUNT} rows took {:.1} s", begun.elapsed().as_secs_f64());
    let expected = lasting(&rows(&read(&program, "whole/rows.jsonl")));
    assert_eq!(expected.len(), COUNT);

    // Nobody chose it; failures say it.
    let start = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as u64;
    let mut chance = Pcg32::new(start, 0);
    let mut before = String::new();
    for turn in 0..KILLS {
        let had = whole(&before).lines().count();
        // In each quarter but the last, so that no run ends by itself.
        let quarter = COUNT as f64 / (KILLS + 1) as f64;
        let enough = (((turn as f64 + f64::from(chance.unit())) * quarter) as usize).max(had + 1);
        let resumed = [&words[..], &["out", "--resume"]].concat();
        let shown = run_and_kill(&program, &resumed, enough, 2.0 * f64::from(chance.unit()));
        let after = on_disk(&program);
        let found = rows(&after);
        println!("killed with {} rows on disk, {had} of before, {shown} shown since", found.len());
        // Rows of before stay to the letter; a row that was shown was written before, and the next one at most was not shown.
        assert!(after.starts_with(whole(&before)), "chance from {start}");
        let new = found.len() - had;
        assert!((shown..=shown + 1).contains(&new), "{new} rows came, {shown} were shown, chance from {start}");
        // Rows come one after the other, in the order of the sweep: all that was measured before the last row is there.
        assert_eq!(lasting(&found)[..], expected[..found.len()], "chance from {start}");
        before = after;
        // A kill may fall into the writing of a row: once it surely does.
        if turn == 1 {
            let line = whole(&before).lines().last().unwrap();
            let mut file = OpenOptions::new().append(true).open(program.path(ROWS)).unwrap();
            file.write_all(&line.as_bytes()[..line.len() / 2]).unwrap();
        }
    }
    let ran = program.run(&[&words[..], &["out", "--resume"]].concat()).fine();
    let text = on_disk(&program);
    assert!(text.starts_with(whole(&before)) && text.ends_with('\n'), "chance from {start}");
    let all = rows(&text);
    assert_eq!(rows(&ran.out).len(), COUNT - whole(&before).lines().count(), "only what is missing is measured");
    assert_eq!(lasting(&all), expected, "chance from {start}");
    // Each row was written when it was measured, and no other was measured with it: a kill can lose no more than one.
    let groups: BTreeSet<&String> = all.iter().map(|row| row.group.as_ref().unwrap()).collect();
    assert_eq!(groups.len(), COUNT);
}

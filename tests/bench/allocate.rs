//! `bench allocate`: recorded and generated allocations replayed, held against plain models of what they ask for.

use crate::support::benched::{lines, read};
use crate::support::program::Program;
use crate::support::watched::{Watched, watched_device};
use quincunx::bench::allocate::generated::{Generated, generated};
use quincunx::caps::known;
use quincunx::choice::Choice;
use quincunx::gpu::DeviceRequest;
use quincunx::memory::Strategy;
use quincunx::memory::pool::{Place, Pool, Rules};
use quincunx::memory::trace::{Event, Recorder, Trace};
use quincunx::scene;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

const HEAD: &str = "{\"schema\":1,\"trace\":\"allocations\"}\n";

/// This program's rows of traces that are replayed, in one round.
fn replayed(program: &Program, more: &[&str]) -> Vec<Value> {
    let base = ["bench", "allocate", "--repeat", "1", "--json", "--quiet"];
    let mut rows = lines(&program.run(&[&base[..], more].concat()).fine().out);
    rows.retain(is_ours);
    rows
}

/// A build may have rivals, and comparisons with them.
fn is_ours(row: &Value) -> bool {
    row["allocator"] == "quincunx"
}

/// What lives at most at once, and how many takes there are: of lines that are read as anybody would.
fn peak_and_takes(text: &str) -> (u64, u64) {
    let (mut live, mut sum, mut peak, mut takes) = (HashMap::new(), 0, 0, 0);
    for line in text.lines().skip(1) {
        let line: Value = serde_json::from_str(line).unwrap();
        match line["take"].as_u64() {
            Some(id) => {
                let bytes = line["bytes"].as_u64().unwrap();
                assert!(live.insert(id, bytes).is_none(), "{line}");
                sum += bytes;
                takes += 1;
            }
            None => sum -= live.remove(&line["give"].as_u64().unwrap()).unwrap(),
        }
        peak = peak.max(sum);
    }
    (peak, takes)
}

fn sum_at_peak(row: &Value) -> u64 {
    let parts = ["live_bytes", "padding_bytes", "gap_bytes", "lost_bytes", "free_bytes"];
    parts.iter().map(|key| row["at_peak"][key].as_u64().unwrap_or_else(|| panic!("no {key}: {row}"))).sum()
}

#[test]
fn a_recorded_render_is_replayed_to_its_own_bytes() {
    let program = Program::new();
    let render = [
        "render",
        "cornell",
        "--size",
        "64x36",
        "--vpls",
        "16",
        "--quiet",
        "-o",
        "a.png",
        "--report",
        "report.json",
        "--record-allocations",
        "a.jsonl",
    ];
    program.run(&render).fine();
    let text = read(&program, "a.jsonl");
    assert!(
        text.lines().next().unwrap().starts_with("{\"schema\":1,\"trace\":\"allocations\",\"device\":\""),
        "{text}"
    );
    let (peak, takes) = peak_and_takes(&text);
    let report: Value = serde_json::from_str(&read(&program, "report.json")).unwrap();
    let resources = report["memory"]["resources"].as_array().unwrap();
    assert!(takes > 10 && resources.iter().any(|row| text.contains(row["name"].as_str().unwrap())), "{text}");
    let rows = replayed(&program, &["a.jsonl", "--sweep", "memory-block=auto,1MiB"]);
    let variants: Vec<&str> = rows.iter().map(|row| row["variant"].as_str().unwrap()).collect();
    assert_eq!(
        variants[..3],
        ["allocation=linear memory-block=auto", "allocation=linear memory-block=1MiB", "allocation=dedicated"]
    );
    for row in &rows {
        let number = |key: &str| row[key].as_u64().unwrap_or_else(|| panic!("no {key}: {row}"));
        assert_eq!((number("peak_live_bytes"), number("operations")), (peak, 2 * takes), "{row}");
        assert!(number("peak_bytes") >= peak && number("memory_blocks") > 0, "{row}");
        assert_eq!(sum_at_peak(row), number("peak_bytes"), "{row}");
        assert!(row["ns_per_operation"]["median"].as_f64().unwrap() > 0.0, "{row}");
        assert_eq!(row["end_fragmentation"], 0.0, "all of it came back: {row}");
    }
    let of = |variant: &str| rows.iter().find(|row| row["variant"] == variant).unwrap();
    assert_eq!(of("allocation=dedicated")["peak_bytes"], peak);
    // As it was made: the report is of the moment at which the picture is there, which the peak is not below.
    let made = report["memory"]["memory_block_bytes"].as_u64().unwrap();
    assert!(of(variants[0])["peak_bytes"].as_u64().unwrap() >= made);
}

/// The recorder hears what the ledger and the pool hear: the same memory blocks come of it, range by range.
#[test]
fn what_is_recorded_makes_the_same_memory_blocks() {
    for &strategy in Strategy::ALL {
        for block_bytes in [None, Some(2 << 20)] {
            let recorder = Arc::new(Recorder::default());
            let request = DeviceRequest { strategy, block_bytes, recorder: Some(recorder.clone()), ..watched_device() };
            let watched = Watched::with_request(&request, scene::load("cornell", 1).unwrap());
            let gone = watched.render("deferred", &[("size", "161x91")]);
            let _renderer = watched.render("interleaved_deferred", &[("size", "97x53"), ("vpls", "16")]);
            drop(gone);
            let snapshot = watched.session.gpu.memory.snapshot();
            let trace = Trace::new("recorded", recorder.events(), 1).unwrap();
            let mut pool = Pool::new(Rules::new(&watched.session.gpu.caps, strategy, None, block_bytes));
            let mut live: HashMap<u64, (Place, u64)> = HashMap::new();
            for event in trace.events() {
                match event {
                    Event::Take { id, ask, .. } => {
                        live.insert(*id, (pool.place(ask).unwrap(), ask.bytes));
                    }
                    Event::Give { id } => {
                        let (place, bytes) = live.remove(id).unwrap();
                        pool.give_back(place.block, place.offset, bytes);
                    }
                }
            }
            assert_eq!(pool.states(), snapshot.blocks, "{strategy:?} {block_bytes:?}");
            assert_eq!(trace.peak_live_bytes(), snapshot.peak_bytes, "{strategy:?}");
            assert_eq!(
                live.len(),
                snapshot.arenas.len() + snapshot.resources.iter().filter(|one| one.arena.is_none()).count()
            );
            let shared = snapshot.blocks.iter().filter(|block| block.used_bytes < block.bytes);
            assert!(shared.clone().all(|block| block.bytes <= block_bytes.unwrap_or(16 << 20)), "{strategy:?}");
        }
    }
}

/// Sizes by which each strategy's bytes are known in closed form.
#[test]
fn each_strategy_comes_to_what_arithmetic_says() {
    let program = Program::new();
    let line = |id: u64, bytes: u64, alignment: u64| {
        format!(
            "{{\"take\":{id},\"bytes\":{bytes},\"alignment\":{alignment},\"memory_type\":0,\"tiling\":\"linear\"}}\n"
        )
    };
    // 300 at 0, 1000 at 512 (a gap of 212), then the first comes back and 200 is asked for.
    let text = [HEAD, &line(1, 300, 256), &line(2, 1000, 512), "{\"give\":1}\n", &line(3, 200, 256)].concat();
    std::fs::write(program.path("t.jsonl"), text).unwrap();
    let rows = replayed(
        &program,
        &["t.jsonl", "--sweep", "memory-block=64KiB", "--sweep", "allocation=linear,tlsf,buddy,dedicated"],
    );
    assert_eq!(rows.len(), 4);
    let at_peak = |index: usize| {
        let keys = ["live_bytes", "padding_bytes", "gap_bytes", "lost_bytes", "free_bytes"];
        keys.map(|key| rows[index]["at_peak"][key].as_u64().unwrap())
    };
    // One block of 64 KiB is there from the first take on: its peak is that moment.
    let block = 65_536;
    assert_eq!(at_peak(0), [300, 0, 0, 0, block - 300]);
    assert_eq!(at_peak(1), [300, 0, 0, 0, block - 300]);
    assert_eq!(at_peak(2), [300, 212, 0, 0, block - 512]);
    assert_eq!(at_peak(3), [1300, 0, 0, 0, 0]);
    let end = |index: usize| rows[index]["end_fragmentation"].as_f64().unwrap();
    let free = (block - 1200) as f64;
    // Linear: 200 at 1536; tlsf: 200 in the hole of 512; buddy: 256 for 200 at 0, 1024 at 1024, and halves behind.
    assert!((end(0) - (1.0 - (block - 1736) as f64 / free)).abs() < 1e-12, "{}", rows[0]);
    assert!((end(1) - (1.0 - (block - 1512) as f64 / free)).abs() < 1e-12, "{}", rows[1]);
    assert!((end(2) - (1.0 - 32_768.0 / free)).abs() < 1e-12, "{}", rows[2]);
    assert_eq!((end(3), &rows[3]["memory_blocks"]), (0.0, &2.into()));
    assert_eq!(rows[0]["ratio"]["mean"], 1.0, "the first row is what ratios are to");
}

#[test]
fn each_strategy_is_bad_at_the_trace_that_is_made_for_it() {
    let program = Program::new();
    // As few memory blocks as Vulkan allows: 4096.
    let peaks = |trace: &str| -> HashMap<String, Value> {
        let rows = replayed(&program, &[trace, "--caps", "least-1.3"]);
        let caps = known::caps("least-1.3").unwrap();
        let peak = generated(trace, &caps).unwrap().peak_live_bytes();
        assert!(rows.iter().all(|row| row["refused"].is_string() || row["peak_live_bytes"] == peak), "{trace}");
        let named = |row: Value| (row["variant"].as_str().unwrap().replace("allocation=", ""), row);
        rows.into_iter().map(named).collect()
    };
    let peak = |rows: &HashMap<String, Value>, name: &str| rows[name]["peak_bytes"].as_u64().unwrap();
    let pinned = peaks("pinned");
    assert!(peak(&pinned, "linear") > 3 * peak(&pinned, "tlsf"), "{pinned:?}");
    let above = peaks("above-powers");
    assert!(peak(&above, "buddy") > peak(&above, "linear") / 2 * 3, "{above:?}");
    let misses = peaks("near-misses");
    let at_peak = |name: &str| misses[name]["at_peak"]["live_bytes"].as_u64().unwrap();
    let most = misses["tlsf"]["peak_live_bytes"].as_u64().unwrap();
    // Memory blocks are made while less lives than did before: holes that would do are not found.
    assert!(at_peak("tlsf") < most && at_peak("dedicated") == most, "{misses:?}");
    let tiny = peaks("tiny");
    let refused = tiny["dedicated"]["refused"].as_str().unwrap();
    assert!(
        refused.contains("event 4") && refused.contains("memory blocks already (maxMemoryAllocationCount)"),
        "{refused}"
    );
    assert!(tiny["dedicated"]["peak_bytes"].is_null() && peak(&tiny, "linear") > 0);
}

#[test]
fn what_is_no_trace_and_no_setting_is_refused() {
    let program = Program::new();
    let write = |name: &str, text: &str| std::fs::write(program.path(name), [HEAD, text].concat()).unwrap();
    let take = "{\"take\":1,\"bytes\":16,\"alignment\":4,\"memory_type\":2,\"tiling\":\"linear\",\"name\":\"a\"}\n";
    write("give.jsonl", &format!("{take}{{\"give\":2}}\n"));
    write("large.jsonl", &take.replace("16", "18446744073709551615"));
    write("type.jsonl", take);
    std::fs::write(program.path("picture.jsonl"), [0xff; 40]).unwrap();
    for (more, words) in [
        (&["give.jsonl"][..], &["give.jsonl:3: give 2: it is not taken"][..]),
        (&["large.jsonl"], &["large.jsonl:2: bytes 18446744073709551615: a resource has 1 to 1099511627776"]),
        (&["type.jsonl"], &["type.jsonl: event 0 (a) takes memory type 2", "--caps"]),
        (&["picture.jsonl"], &["picture.jsonl"]),
        (&["none.jsonl"], &["none.jsonl"]),
        (&["frame"], &["frame: there is no such trace", "near-misses", ".jsonl"]),
        (&["frames:count=x"], &["count=x: it must be count=1 to"]),
        (&["tiny", "--sweep", "vpls=4"], &["--sweep vpls", "allocation and memory-block"]),
        (&["tiny", "--sweep", "allocation=first-fit"], &["--allocation first-fit", "linear|dedicated|tlsf|buddy"]),
        (&["tiny", "--sweep", "memory-block=3MiB"], &["--memory-block 3MiB", "a power of two of 64.0 KiB to 1.00 GiB"]),
        (&["tiny", "--caps", "nothing"], &["nothing"]),
    ] {
        program.fails(&[&["bench", "allocate"], more].concat(), 2, words);
    }
    program.fails(&["render", "cornell", "--record-allocations", "nowhere/a.jsonl"], 2, &["nowhere"]);
}

#[test]
fn a_table_and_a_document_are_written_and_a_device_takes_the_same() {
    let program = Program::new();
    let small = ["frames:count=3", "random:count=200", "--repeat", "3", "--sweep", "allocation=linear,tlsf"];
    let ran = program.run(&[&["bench", "allocate", "-o", "out"][..], &small].concat()).fine();
    let text = read(&program, "out/allocate.txt");
    assert_eq!(ran.out, text);
    for words in [
        "frames:count=3: 181 takes, 99 gives, ",
        "random:count=200: ",
        "time ratio (95 %)",
        "allocation=tlsf",
        "3 rounds",
    ] {
        assert!(text.contains(words), "{text} does not say {words}");
    }
    let document: Value = serde_json::from_str(&read(&program, "out/allocate.json")).unwrap();
    let numbers = document["rows"].as_array().unwrap();
    assert_eq!(document["command"].as_array().unwrap()[2], "allocate");
    let on = ["bench", "allocate", "--on-device", "--validate", "--json", "--quiet"];
    let device = lines(&program.run(&[&on[..], &small].concat()).fine().out);
    let ours = |rows: &[Value]| -> Vec<[Value; 3]> {
        rows.iter()
            .filter(|row| is_ours(row))
            .map(|row| ["trace", "variant", "operations"].map(|key| row[key].clone()))
            .collect()
    };
    assert_eq!(ours(&device), ours(numbers));
    assert!(device.iter().filter(|row| is_ours(row)).all(|row| row["place"].is_string() && row["place"] != "numbers"));
    assert_eq!(numbers[1]["ratio"]["pairs"], 3);
}

#[test]
fn every_generated_trace_is_replayed_by_default() {
    let rows = replayed(&Program::new(), &["--sweep", "allocation=tlsf"]);
    let traces: Vec<&str> = rows.iter().map(|row| row["trace"].as_str().unwrap()).collect();
    assert_eq!(traces, Generated::WORDS);
}

/// Allocators of others are built where they are asked for, and nowhere else.
#[test]
fn no_build_has_rivals_unless_they_are_asked_for() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    assert!(manifest["features"].get("default").is_none());
    let rivals = manifest["features"]["rivals"].as_array().unwrap();
    for name in rivals.iter().map(|one| one.as_str().unwrap().strip_prefix("dep:").unwrap()) {
        assert_eq!(manifest["dependencies"][name]["optional"].as_bool(), Some(true), "{name}");
        assert!(manifest.get("dev-dependencies").is_none_or(|dev| dev.get(name).is_none()), "{name}");
    }
    assert_eq!(rivals.len(), 2);
}

//! `memory` from outside: what it draws and says of a plan and of what was made, held against its own list of resources.

use crate::papers::page::shown;
use crate::support::benched::read;
use crate::support::program::Program;
use crate::support::{browser, skip};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

const NAME: &str = "interleaved_deferred";
const SMALL: [&str; 6] = ["cornell", "--size", "64x36", "--vpls", "64", "--pattern"];

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("no number: {value}"))
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

/// A folder of what `memory` writes.
fn written(program: &Program, more: &[&str]) -> Value {
    program.run(&[&["memory"], &SMALL[..], &["2x2", "-o", "out"], more].concat()).fine();
    serde_json::from_str(&read(program, &format!("out/memory-{NAME}.json"))).unwrap()
}

/// The rectangles of an SVG that are of a resource: name, x, y, width, height.
fn rectangles(svg: &str) -> Vec<(String, [f64; 4])> {
    svg.split("<rect data-name=\"")
        .skip(1)
        .map(|part| {
            let name = part.split('"').next().unwrap().to_owned();
            let of = |key: &str| {
                let text = part.split(&format!(" {key}=\"")).nth(1).unwrap().split('"').next().unwrap();
                text.parse::<f64>().unwrap_or_else(|_| panic!("{key}={text:?}"))
            };
            (name, [of("x"), of("y"), of("width"), of("height")])
        })
        .collect()
}

/// Whether two stretches have more in common than a rounded edge.
fn meet(a: [f64; 2], b: [f64; 2]) -> bool {
    a[0] + 1e-6 < b[0] + b[1] && b[0] + 1e-6 < a[0] + a[1]
}

#[test]
fn bytes_of_passes_follow_from_the_lives_of_resources() {
    let program = Program::new();
    for alias in ["off", "greedy", "optimal"] {
        let memory = &written(&program, &["--plan", "--alias", alias])["memory"];
        let (passes, resources) = (list(&memory["passes"]), list(&memory["resources"]));
        let place = |pass: &Value| passes.iter().position(|known| known["pass"] == *pass).unwrap_or(passes.len());
        let mut fullest = (0, 0);
        for (index, pass) in passes.iter().enumerate() {
            let lives = |row: &&Value| {
                row["first_pass"].is_null() || place(&row["first_pass"]) <= index && index <= place(&row["last_pass"])
            };
            let sum = |rows: &mut dyn Iterator<Item = &Value>| rows.map(|row| number(&row["bound_bytes"])).sum::<u64>();
            let live = sum(&mut resources.iter().filter(lives));
            let held = sum(&mut resources.iter().filter(|row| row["arena"].is_null() || lives(row)));
            let said = ["live_bytes", "held_bytes"].map(|key| number(&pass[key]));
            assert_eq!(said, [live, held], "--alias {alias}: {}", pass["pass"]);
            fullest = fullest.max((live, held));
        }
        let most = passes.iter().map(|pass| number(&pass["held_bytes"])).max().unwrap();
        assert_eq!(most, number(&memory["peak_bytes"]), "--alias {alias}");
        let waste = |key: &str| number(&memory["waste"][key]);
        let bound = |of: fn(&Value) -> u64| resources.iter().map(of).sum::<u64>();
        assert_eq!(
            waste("padding_bytes"),
            bound(|row| number(&row["bound_bytes"]).saturating_sub(number(&row["bytes"])))
        );
        assert_eq!(waste("alignment_bytes"), bound(|row| number(&row["alignment_waste_bytes"])));
        assert_eq!(waste("idle_bytes"), fullest.1 - fullest.0, "--alias {alias}");
        assert!(memory["waste"]["free_bytes"].is_null(), "nothing was made");
        assert_eq!(waste("idle_bytes") > 0, alias == "off", "sharing leaves nothing idle");
        let text = program.run(&[&["memory"], &SMALL[..], &["2x2", "--plan", "--alias", alias]].concat()).fine().out;
        assert!(text.contains("of no use: ") && text.contains("# live, - held"), "{text}");
    }
}

#[test]
fn what_shares_bytes_is_drawn_at_one_height_in_other_passes() {
    let program = Program::new();
    let memory = &written(&program, &["--plan"])["memory"];
    let drawn = rectangles(&read(&program, &format!("out/memory-{NAME}.lifetimes.svg")));
    let resources = list(&memory["resources"]);
    let frame: BTreeMap<&str, &Value> = resources
        .iter()
        .map(|row| (row["name"].as_str().unwrap(), row))
        .filter(|(name, _)| !name.starts_with("scene."))
        .collect();
    let names: BTreeSet<&str> = drawn.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!((drawn.len(), names), (frame.len(), frame.keys().copied().collect()), "each once");
    let bytes_a_unit =
        drawn.iter().map(|(name, [.., height])| number(&frame[name.as_str()]["bound_bytes"]) as f64 / height);
    let scales: Vec<f64> = bytes_a_unit.collect();
    assert!(scales.iter().all(|scale| (scale / scales[0] - 1.0).abs() < 1e-6), "as high as their bytes: {scales:?}");
    let mut sharing = 0;
    for (index, (a, [ax, ay, aw, ah])) in drawn.iter().enumerate() {
        for (b, [bx, by, bw, bh]) in &drawn[index + 1..] {
            let shares = |one: &str, other: &str| {
                let with = &frame[one]["arena"]["shares_with"];
                with.as_array().is_some_and(|names| names.iter().any(|name| name == other))
            };
            let same_height = meet([*ay, *ah], [*by, *bh]);
            assert_eq!(same_height, shares(a, b), "{a} and {b}");
            assert!(!(same_height && meet([*ax, *aw], [*bx, *bw])), "{a} and {b} hold the same bytes in one pass");
            sharing += u32::from(same_height);
        }
    }
    assert!(sharing > 2, "some share");
    let blocks = program.path(&format!("out/memory-{NAME}.blocks.svg"));
    assert!(!std::path::Path::new(&blocks).exists(), "nothing was made");
}

#[test]
fn memory_blocks_are_drawn_and_written_in_the_words_of_vma() {
    let program = Program::new();
    for allocation in ["tlsf", "dedicated", "buddy"] {
        let memory = &written(&program, &["--allocation", allocation])["memory"];
        let blocks = list(&memory["memory_blocks"]);
        let drawn = rectangles(&read(&program, &format!("out/memory-{NAME}.blocks.svg")));
        let resources = list(&memory["resources"]);
        assert_eq!(drawn.len(), resources.iter().filter(|row| row["memory_block"].is_u64()).count());
        for (index, (a, [ax, ay, aw, ah])) in drawn.iter().enumerate() {
            let row = resources.iter().find(|row| row["name"] == a.as_str()).unwrap();
            let largest = blocks.iter().map(|block| number(&block["bytes"])).max().unwrap() as f64;
            let at = 10.0 + number(&row["offset"]) as f64 * 880.0 / largest;
            assert!((ax - at).abs() < 1e-6 && (aw - number(&row["bound_bytes"]) as f64 * 880.0 / largest).abs() < 1e-6);
            for (b, [bx, by, bw, bh]) in &drawn[index + 1..] {
                assert!(!(meet([*ax, *aw], [*bx, *bw]) && meet([*ay, *ah], [*by, *bh])), "{a} hides {b}");
            }
        }
        let dump: Value = serde_json::from_str(&read(&program, &format!("out/memory-{NAME}.vma.json"))).unwrap();
        let mut seen = 0;
        for (pool, pools) in dump["DefaultPools"].as_object().unwrap() {
            for (index, block) in pools["Blocks"].as_object().unwrap() {
                let known =
                    blocks.iter().find(|known| number(&known["index"]) == index.parse::<u64>().unwrap()).unwrap();
                assert_eq!(*pool, format!("Type {}", known["memory_type"]));
                assert_eq!([&block["TotalBytes"], &block["UnusedBytes"]], [&known["bytes"], &known["free_bytes"]]);
                // Ranges follow each other without gaps: what draws them looks at sizes alone.
                let mut end = 0;
                for range in list(&block["Suballocations"]) {
                    assert_eq!(number(&range["Offset"]), end, "{range}");
                    end += number(&range["Size"]);
                }
                assert_eq!(end, number(&block["TotalBytes"]));
                seen += 1;
            }
        }
        assert_eq!(seen, blocks.len());
        let total = |key: &str| number(&dump["Total"][key]);
        assert_eq!((total("BlockCount"), total("BlockBytes")), (seen as u64, number(&memory["memory_block_bytes"])));
        let free: u64 = blocks.iter().map(|block| number(&block["free_bytes"])).sum();
        assert_eq!(total("AllocationBytes") + free, total("BlockBytes"));
        assert_eq!(number(&memory["waste"]["free_bytes"]), free);
        assert_eq!(dump["General"]["API"], "Vulkan");
    }
}

#[test]
fn two_studies_are_compared_resource_by_resource() {
    let program = Program::new();
    let of = |folder: &str, more: &[&str]| -> Value {
        program.run(&[&["memory"], &SMALL[..5], &["--plan", "-o", folder], more].concat()).fine();
        serde_json::from_str(&read(&program, &format!("{folder}/memory-{NAME}.json"))).unwrap()
    };
    let (a, b) = (of("a", &["--pattern", "2x2"]), of("b", &["--split", "none"]));
    let files = ["a", "b"].map(|folder| format!("{folder}/memory-{NAME}.json"));
    let found = program.run(&["memory", &files[0], &files[1], "--json"]).fine().json();
    let bound = |document: &Value, name: &str| {
        let rows = list(&document["memory"]["resources"]).iter();
        let own = |row: &&Value| {
            let own = row["name"].as_str().unwrap();
            own == name || own.strip_prefix(&format!("{NAME}.")) == Some(name)
        };
        rows.filter(own).map(|row| number(&row["bound_bytes"])).next()
    };
    let mut difference = 0;
    for line in list(&found["resources"]) {
        let name = line["name"].as_str().unwrap();
        let [before, after] = [bound(&a, name), bound(&b, name)];
        assert_eq!(line["bytes"], serde_json::json!([before, after]), "{name}");
        assert_ne!(before, after, "{name}");
        difference += line["difference"].as_i64().unwrap();
    }
    let allocated = |document: &Value| number(&document["memory"]["allocated_bytes"]) as i64;
    assert!(difference < 0, "no split, no sub-buffers");
    assert_eq!(difference, allocated(&b) - allocated(&a), "nothing is left out");
    let is_sub_buffer = |line: &&Value| line["name"].as_str().unwrap().starts_with("split.");
    assert!(list(&found["resources"]).iter().filter(is_sub_buffer).all(|line| line["bytes"][1].is_null()));
    let text = program.run(&["memory", &files[0], &files[1]]).fine().out;
    assert!(text.contains("are the same in both") && text.contains("split."), "{text}");
    // A report of a picture has memory too; what has none is refused.
    program.run(&[&["render"], &SMALL[..], &["2x2", "-o", "a.png", "--report", "a.json"]].concat()).fine();
    program.run(&["memory", "a.json", &files[0]]).fine();
    program.fails(&["memory", &files[0], &files[1], "--size", "32x18"], 2, &["nothing reads --size"]);
    program.fails(&["memory", &files[0], &files[1], "--plan"], 2, &["nothing reads --plan"]);
    std::fs::write(program.path("none.json"), "{}").unwrap();
    program.fails(&["memory", &files[0], "none.json"], 2, &["none.json", "no memory", "render --report"]);
    program.fails(&["memory", &files[0], "nowhere.json"], 2, &["nowhere.json"]);
    let both =
        program.run(&["memory", "cornell", "--plan", "--technique", "deferred", "--technique", "forward", "--json"]);
    std::fs::write(program.path("both.json"), both.fine().out).unwrap();
    program.fails(&["memory", &files[0], "both.json"], 2, &["both.json", "2 techniques", "-o writes a file for each"]);
}

/// Heaps have what their resources have; what the driver says of them stands beside it.
#[test]
fn heaps_add_up_and_the_driver_speaks_for_itself() {
    let program = Program::new();
    let (made, planned) = (written(&program, &[]), written(&program, &["--plan"]));
    for document in [&made, &planned] {
        let sum = |key: &str| list(&document["heaps"]).iter().map(|heap| number(&heap[key])).sum::<u64>();
        assert_eq!(sum("bound_bytes"), number(&document["memory"]["allocated_bytes"]));
        if document["memory"]["memory_blocks"].is_array() {
            assert_eq!(sum("memory_block_bytes"), number(&document["memory"]["memory_block_bytes"]));
        }
    }
    assert!(
        list(&planned["heaps"]).iter().all(|heap| heap["driver"].is_null() && heap["memory_block_bytes"].is_null())
    );
    let says = crate::support::driver().features.memory_budget;
    for heap in list(&made["heaps"]) {
        assert_eq!(heap["driver"].is_object(), says, "{heap}");
        if says {
            let [budget, usage] = ["budget_bytes", "usage_bytes"].map(|key| number(&heap["driver"][key]));
            assert!(budget > 0 && usage >= number(&heap["memory_block_bytes"]), "{heap}");
        }
    }
}

/// What is found works on the device, and a mebibyte less is refused there.
#[test]
fn the_smallest_budget_is_enough_and_none_is_smaller() {
    let Some(known) = crate::support::known_driver() else { return skip("how this driver rounds is not known") };
    let program = Program::new();
    // Shadow maps of virtual lights take what is left: under a small budget few are held at once.
    let maps = ["--vpl-shadow", "map", "--vpl-shadow-size", "64"];
    for (more, gives_up) in [(&[][..], None), (&maps[..], Some("vpl-shadow-maps"))] {
        let job = [&["cornell", "--size", "320x180", "--vpls", "64"], more].concat();
        let plan = [&["memory"], &job[..], &["--plan", "--caps", known, "--smallest-budget"]].concat();
        let document = program.run(&[&plan[..], &["--json"]].concat()).fine().json();
        let smallest = &document["techniques"][0]["smallest_budget"];
        let mebibytes = number(&smallest["budget_bytes"]) >> 20;
        println!("{more:?}: {smallest}");
        let given_up: Vec<&str> =
            list(&smallest["given_up"]).iter().map(|one| one["setting"].as_str().unwrap()).collect();
        assert_eq!(given_up, Vec::from_iter(gives_up), "{smallest}");
        let text = program.run(&plan).fine().out;
        assert!(
            text.contains(&format!("--memory-budget {mebibytes}MiB is enough, and one mebibyte less is not")),
            "{text}"
        );
        let render = |budget: u64| {
            let budget = format!("{budget}MiB");
            program.run(&[&["render"], &job[..], &["-o", "a.png", "--memory-budget", &budget]].concat())
        };
        render(mebibytes).fine();
        assert_eq!(render(mebibytes - 1).code, 4, "{mebibytes} MiB");
    }
    program.fails(&["memory", "cornell", "--smallest-budget"], 2, &["--plan"]);
}

#[test]
fn the_page_of_memory_is_laid_out_and_sorts_without_errors() {
    let Some(browser) = browser() else { return skip("there is no chromium") };
    let program = Program::new();
    let made = written(&program, &[]);
    for width in [390, 1280] {
        let found = shown(&program, "out/index.html", &browser, width);
        assert_eq!(found["errors"], serde_json::json!([]), "{found:#}");
        assert_eq!((&found["width"], &found["overflow"]), (&Value::from(width), &Value::from(0)), "{found:#}");
        assert_eq!(list(&found["plots"]).len(), 2, "lifetimes and memory blocks");
        let mut live: Vec<u64> =
            list(&made["memory"]["passes"]).iter().map(|pass| number(&pass["live_bytes"])).collect();
        let shown = |key: &str| -> Vec<u64> {
            list(&found[key]).iter().map(|value| value.as_str().unwrap().parse().unwrap()).collect()
        };
        assert_eq!(shown("before"), live);
        live.sort_unstable();
        assert_eq!(shown("ascending"), live);
    }
}

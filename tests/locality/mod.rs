//! Locality: the address streams move real buffers as the shaders do, and `bench locality` counts and says.

mod touched;

use crate::support::program::Program;
use crate::support::watched::Watched;
use crate::techniques::interleaved_deferred::split::back_in_frame_order;
use quincunx::locality::access::{Kernel, groups_of};
use quincunx::locality::case::Case;
use quincunx::locality::copies::{Copy, Pass};
use quincunx::locality::machine::Machine;
use quincunx::techniques::interleaved_deferred::split_method::{Form, Split, StorageKind};
use quincunx::units::Extent;
use serde_json::Value;
use std::collections::HashMap;

/// Where a normal of the G-buffer ends, by the accesses of the passes of a split: address of its sub-buffer's texel by that of the pixel.
fn moved(case: &Case, passes: &[Pass], machine: &Machine) -> HashMap<u64, u64> {
    let mapping = case.mapping();
    let memory = case.memory(&mapping, machine);
    let all = (0..mapping.height_px).flat_map(|y| (0..mapping.width_px).map(move |x| [x, y]));
    // From where what lies at an address came.
    let mut from: HashMap<u64, u64> =
        all.map(|pixel| memory.gbuffer[1].texel(pixel)).map(|address| (address, address)).collect();
    for pass in passes {
        let kernel =
            Copy { pass: *pass, form: case.form, mapping: &mapping, memory: &memory, group_size: case.workgroup };
        let mut next = HashMap::new();
        for group in groups_of(&kernel) {
            for y in 0..case.workgroup[1] {
                for x in 0..case.workgroup[0] {
                    let mut accesses = Vec::new();
                    kernel.accesses(group, [x, y], &mut accesses);
                    // Position and normal take turns among the reads, those that are left out too, and among the writes.
                    let reads: Vec<Option<u64>> = accesses
                        .iter()
                        .filter(|access| access.is_none_or(|access| !access.is_write))
                        .map(|access| access.map(|access| access.address))
                        .collect();
                    let writes = accesses.iter().flatten().filter(|access| access.is_write);
                    let written: Vec<u64> = writes
                        .skip(1)
                        .step_by(2)
                        .flat_map(|access| (0..u64::from(access.bytes) / 8).map(|word| access.address + 8 * word))
                        .collect();
                    for (read, written) in reads.iter().skip(1).step_by(2).zip(written) {
                        if let Some(origin) = read.and_then(|read| from.get(&read)) {
                            next.insert(written, *origin);
                        }
                    }
                }
            }
        }
        from.extend(next);
    }
    from
}

/// Those of `tile` are not among them: what an invocation reads, another one writes.
#[test]
fn address_streams_move_what_the_shaders_move() {
    let watched = Watched::open("cornell");
    let machine = Machine::known("rdna2-navi22").unwrap();
    let extent = Extent::new(97, 53);
    for (split, form, passes) in [
        (Split::OnePass, Form::Pull, &[Pass::SplitOnePass][..]),
        (Split::OnePass, Form::Push, &[Pass::SplitOnePass]),
        (Split::TwoPass, Form::Pull, &[Pass::SplitBlocks, Pass::SplitTranslate]),
        (Split::TwoPass, Form::Push, &[Pass::SplitBlocks, Pass::SplitTranslate]),
    ] {
        for storage in [StorageKind::Buffer, StorageKind::Image] {
            let (pattern, block) = ([4, 2], [12, 4]);
            let case = Case { extent, split, pattern, block, form, storage, workgroup: [16, 4] }.checked().unwrap();
            let changes = [
                ("size", "97x53"),
                ("pattern", "4x2"),
                ("block", "12x4"),
                ("workgroup", "16x4"),
                ("vpls", "64"),
                ("split", split.name()),
                ("copy", form.name()),
                ("storage", storage.name()),
            ];
            let changes: Vec<_> =
                changes.into_iter().filter(|(key, _)| *key != "block" || split != Split::OnePass).collect();
            let renderer = watched.render_stages("interleaved_deferred", &changes, &["gbuffer.normal", "split.normal"]);
            let pixels = watched.rgb(&renderer, "gbuffer.normal");
            let device = back_in_frame_order(&watched.rgb(&renderer, "split.normal"), extent, pattern);
            let mapping = case.mapping();
            let memory = case.memory(&mapping, &machine);
            let from = moved(&case, passes, &machine);
            let pixel_at: HashMap<u64, usize> = (0..pixels.len())
                .map(|index| {
                    (memory.gbuffer[1].texel([index as u32 % extent.width, index as u32 / extent.width]), index)
                })
                .collect();
            for (index, shown) in device.iter().enumerate() {
                let pixel = [index as u32 % extent.width, index as u32 / extent.width];
                let texel = memory.sub_buffers.of_sub_buffer(1, &mapping, mapping.texel_of_pixel(pixel));
                let origin = from.get(&texel).unwrap_or_else(|| panic!("{}: nothing came to {pixel:?}", case.label()));
                assert_eq!(pixels[pixel_at[origin]], *shown, "{} {pixel:?}", case.label());
            }
        }
    }
}

fn counted(program: &Program, more: &[&str]) -> Value {
    let ran = program.run(&[&["bench", "locality", "--json", "--quiet"][..], more].concat()).fine();
    serde_json::from_str(&ran.out).unwrap()
}

#[test]
fn copies_are_counted_on_every_machine_beside_what_was_measured() {
    let program = Program::new();
    let measured = [
        "bench",
        "split",
        "cornell",
        "--size",
        "64x48",
        "--vpls",
        "16",
        "--storage",
        "image",
        "--workgroup",
        "16x16",
        "--sweep",
        "split=one-pass,two-pass",
        "--sweep",
        "pattern=2x2,4x4",
        "--repeat",
        "1",
        "-o",
        "rows",
        "--quiet",
    ];
    program.run(&measured).fine();
    let axes = [
        "--sweep",
        "size=64x48",
        "--sweep",
        "split=one-pass,two-pass,tile",
        "--sweep",
        "pattern=2x2,4x4",
        "--sweep",
        "block=8,16",
    ];
    let found = counted(&program, &[&axes[..], &["--measured", "rows", "-o", "out"]].concat());
    let machines = found["machines"].as_array().unwrap().len();
    let rows = found["rows"].as_array().unwrap();
    // One pass has no blocks: (1 + 2 + 2) x 2 patterns, a split and a gather each.
    assert_eq!(rows.len(), machines * 20, "{machines}");
    for row in rows {
        let total = &row["total"];
        let bytes = |key: &str| total[key].as_u64().unwrap();
        // Everything that is asked for comes from memory once at least, and everything that is written goes there.
        let parts = if row["stage"] == "split" { 16 } else { 8 };
        let passes = row["passes"].as_array().unwrap().len() as u64;
        assert!(bytes("memory_read_bytes") >= passes * 64 * 48 * parts, "{row}");
        assert!(bytes("memory_written_bytes") >= passes * 64 * 48 * parts, "{row}");
        assert!(bytes("first_misses") <= bytes("first_reads") && bytes("lines") <= bytes("sectors"), "{row}");
    }
    let times: Vec<f64> = rows.iter().filter_map(|row| row["measured_ms"].as_f64()).collect();
    // Blocks were 16 there, and gathers were not measured.
    assert_eq!(times.len(), machines * 4, "{times:?}");
    let text = std::fs::read_to_string(program.path("out/locality.txt")).unwrap();
    for machine in ["volta-v100", "assumed-2004", "measured ms", "; assumed: first, second"] {
        assert!(text.contains(machine), "{text}");
    }
    // A machine of one's own, from a file that has the keys of ours.
    std::fs::write(program.path("own.json"), found["machines"][0].to_string().replace("volta-v100", "mine")).unwrap();
    let own = counted(&program, &["--machine", "own.json", "--machine", "volta-v100", "--sweep", "size=64x48"]);
    assert_eq!((&own["rows"][0]["machine"], &own["rows"][0]["total"]), (&"mine".into(), &own["rows"][2]["total"]));
}

#[test]
fn other_stages_are_counted_each_once_for_what_they_read() {
    let program = Program::new();
    let measured = "bench shade cornell --size 64x48 --workgroup 16x16 --split remap --pattern 2x2 --texels 1 --repeat 1 -o rows --quiet";
    let measured = [&measured.split(' ').collect::<Vec<_>>()[..], &["--sweep", "vpls=16,64"]].concat();
    program.run(&measured).fine();
    let axes = [
        "--stage",
        "insert,filter,shade",
        "--machine",
        "volta-v100",
        "--sweep",
        "size=64x48",
        "--sweep",
        "pattern=2x2,4x4",
        "--sweep",
        "split=remap,branch,none",
        "--sweep",
        "vpls=16,64",
    ];
    let found = counted(&program, &[&axes[..], &["--measured", "rows", "-o", "out"]].concat());
    let rows = found["rows"].as_array().unwrap();
    let of = |stage: &str| rows.iter().filter(|row| row["stage"] == stage).collect::<Vec<_>>();
    // Without a split the pattern says nothing; the Gaussian and the lists know none of these keys.
    assert_eq!([of("shade").len(), of("filter").len(), of("insert").len(), rows.len()], [2 * 5, 1, 1, 12]);
    assert_eq!(rows[0]["case"], "split=remap pattern=2x2 texels=1 vpls=16");
    assert_eq!(rows[1]["case"], "filter=gauss kernel=5 texels=1");
    assert_eq!(rows[2]["case"], "spp=8 tuples=8 triangle=8 blur=0");
    assert_eq!(rows.iter().filter(|row| !row["measured_ms"].is_null()).count(), 2, "{rows:#?}");
    // Lights of a subset are read by each of its pixels: 48 bytes of a fourth of them.
    let asked = |row: &Value| row["total"]["asked_bytes"].as_u64().unwrap();
    let lights = |case: &str| asked(rows.iter().find(|row| row["case"] == case).unwrap());
    let [few, many] = [16, 64].map(|vpls| lights(&format!("split=branch pattern=2x2 texels=1 vpls={vpls}")));
    assert_eq!(many - few, 64 * 48 * (16 - 4) * 48);
    let passes = of("filter")[0]["passes"].as_array().unwrap().iter().map(|pass| pass["pass"].as_str().unwrap());
    assert_eq!(passes.collect::<Vec<_>>(), ["discontinuity", "filter.rows", "filter.columns"]);
    let text = std::fs::read_to_string(program.path("out/locality.txt")).unwrap();
    assert!(text.contains("insert: spp=8 tuples=8 triangle=8 blur=0"), "{text}");
}

#[test]
fn drawn_machines_say_where_two_passes_gain() {
    let program = Program::new();
    let small = ["--drawn", "30", "--sweep", "size=64x32", "--sweep", "block=8,16"];
    let found = counted(&program, &small);
    let all = found["drawn"].as_array().unwrap();
    assert_eq!(all.len(), 30);
    let share =
        |index: usize| all.iter().filter(|one| one["gains"][index].as_f64().unwrap() > 1.0).count() as f64 / 30.0;
    let summary = &found["summary"];
    assert_eq!(summary["two_passes_win"], serde_json::json!([share(0), share(1)]));
    let grows = all.iter().filter(|one| one["gains"][1].as_f64() > one["gains"][0].as_f64()).count() as f64 / 30.0;
    assert_eq!(summary["gain_grows"], grows);
    assert_eq!(counted(&program, &small)["drawn"], found["drawn"]);
    assert_ne!(counted(&program, &[&small[..], &["--seed", "2"]].concat())["drawn"], found["drawn"]);
}

#[test]
fn what_cannot_be_counted_is_refused() {
    let program = Program::new();
    std::fs::write(program.path("bad.json"), "{\"name\": \"bad\"}").unwrap();
    for (more, words) in [
        (&["--sweep", "kernel=5"][..], &["--sweep kernel", "no such key", "workgroup"][..]),
        (&["--sweep", "split=branch"], &["split=branch", "one-pass, two-pass and tile"]),
        (&["--sweep", "split=nowhere"], &["--sweep split=nowhere"]),
        (&["--sweep", "pattern=0"], &["sides are 1 to"]),
        (&["--sweep", "pattern=axb"], &["--sweep pattern=axb", "NxM"]),
        (&["--machine", "voodoo"], &["no machine voodoo", "volta-v100"]),
        (&["--machine", "bad.json"], &["bad.json", "it is no machine"]),
        (&["--machine", "nowhere.json"], &["nowhere.json"]),
        (&["--drawn", "5", "--sweep", "copy=pull,push"], &["--drawn with --sweep copy="]),
        (&["--drawn", "5", "--sweep", "pattern=8x8"], &["--drawn with --sweep pattern=", "2x2 and at 4x4"]),
        (&["--seed", "2"], &["--drawn"]),
        (&["--stage", "composite"], &["composite", "insert"]),
        (&["--stage", "split", "--drawn", "5"], &["--stage", "--drawn"]),
        (&["--sweep", "vpls=64"], &["--sweep vpls: --stage split,gather", "--stage shade knows it"]),
        (&["--stage", "shade", "--sweep", "split=stencil"], &["split=stencil", "remap, one-pass"]),
        (&["--stage", "shade", "--sweep", "vpls=few"], &["--sweep vpls=few", "a whole number"]),
        (&["--stage", "filter", "--sweep", "filter=none"], &["--sweep filter=none", "no such filter"]),
        (&["--stage", "insert", "--sweep", "blur=99"], &["blur=99", "0 to 64 px"]),
        (&["--stage", "insert", "--sweep", "tuples=12"], &["spp=8 tuples=12"]),
    ] {
        let ran = program.run(&[&["bench", "locality"][..], more].concat());
        assert_eq!(ran.code, 2, "{more:?}: {}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{more:?}: {}", ran.err);
    }
}

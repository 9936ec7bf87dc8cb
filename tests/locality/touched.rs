//! Address streams against what the shaders themselves count of the bytes that they ask for.

use crate::support::program::Program;
use crate::support::touched::{bytes, ends, list, rendered, rendered_with, row};
use crate::support::watched::Watched;
use quincunx::locality::access::{Access, accesses_of};
use quincunx::locality::filter::{FilterCase, FilterKind};
use quincunx::locality::frame::Resource;
use quincunx::locality::insert::Insert;
use quincunx::locality::layout::Layout;
use quincunx::locality::shade::ShadeCase;
use quincunx::locality::spids::Spids;
use quincunx::techniques::interleaved_deferred::split_method::{Split, StorageKind};
use quincunx::units::Extent;
use serde_json::Value;

/// A hall whose every pixel sees a surface.
const SCENE: &str = "hall:triangles=5000";

/// Neither side is whole patterns, blocks or workgroups.
const SIZE: &str = "61x45";
const EXTENT: Extent = Extent { width: 61, height: 45 };

/// Report of a frame of interleaved_deferred.
fn touched(program: &Program, settings: &[&str]) -> Value {
    rendered(program, &[&[SCENE, "--size", SIZE, "--touched", "line"][..], settings].concat())
}

/// Fails where a pass asks for other bytes of a resource than a stream does.
fn require_asked(report: &Value, pass: &str, name: &str, resource: &Resource, accesses: &[Access], what: &str) {
    let [.., read, written] = bytes(row(report, pass, name));
    assert_eq!([read, written], resource.asked_bytes(accesses), "{what}: {name}");
}

#[test]
fn shading_asks_for_what_its_stream_does() {
    let program = Program::new();
    let (buffer, image) = (StorageKind::Buffer, StorageKind::Image);
    for (split, storage, texels, vpls, more) in [
        (Split::OnePass, buffer, 4, 18, &["--pattern", "4x2", "--storage", "buffer"][..]),
        (Split::TwoPass, image, 1, 18, &["--pattern", "4x2", "--block", "12x4", "--storage", "image"]),
        (Split::Remap, buffer, 2, 17, &["--pattern", "4x2"]),
        (Split::Branch, buffer, 1, 18, &["--pattern", "4x2"]),
        (Split::None, buffer, 8, 5, &[]),
    ] {
        let (pattern, block, workgroup) = ([4, 2], [12, 4], [4, 2]);
        let case = ShadeCase { extent: EXTENT, split, pattern, block, storage, workgroup, texels, vpls };
        let case = case.checked().unwrap();
        assert_eq!(case.texels, texels);
        let counts = [texels.to_string(), vpls.to_string()];
        let settings = ["--split", split.name(), "--workgroup", "4x2", "--texels", &counts[0], "--vpls", &counts[1]];
        let report = touched(&program, &[&settings[..], more].concat());
        let shade = case.kernel(Layout::Linear);
        let (all, memory) = (accesses_of(&shade), &shade.memory);
        let is_moved = matches!(split, Split::OnePass | Split::TwoPass);
        let (surfaces, irradiance) = match is_moved {
            true => (memory.sub_buffers.parts, memory.irradiance.parts[0]),
            false => (memory.gbuffer, memory.frame_irradiance),
        };
        let from = if is_moved { "split" } else { "gbuffer" };
        for (name, resource) in [
            (format!("{from}.position"), &surfaces[0]),
            (format!("{from}.normal"), &surfaces[1]),
            (".subsets".to_owned(), &memory.subsets),
            (".vpls".to_owned(), &memory.vpls),
            ("shade.irradiance".to_owned(), &irradiance),
        ] {
            require_asked(&report, "deferred.shade", &name, resource, &all, split.name());
        }
    }
}

#[test]
fn filters_ask_for_what_their_streams_do() {
    let program = Program::new();
    for (filter, taps, texels) in [(FilterKind::Gauss, 7, 4), (FilterKind::GaussFast, 5, 1)] {
        let (pattern, workgroup) = ([4, 2], [16, 4]);
        let case = FilterCase { extent: EXTENT, filter, taps, pattern, texels, workgroup }.checked().unwrap();
        let counts = [taps.to_string(), texels.to_string()];
        // Nothing is a discontinuity.
        let even = ["--normal-threshold", "2", "--position-threshold", "1000"];
        let settings =
            ["--filter", filter.name(), "--workgroup", "16x4", "--kernel", &counts[0], "--texels", &counts[1]];
        let report = touched(&program, &[&settings[..], &even].concat());
        let kernels = case.kernels(Layout::Linear);
        let of = |kernels: &[_]| kernels.iter().flat_map(|kernel| accesses_of(kernel)).collect::<Vec<Access>>();
        let (flagged, filtered, memory) = (of(&kernels[..1]), of(&kernels[1..]), &kernels[0].memory);
        let [position, normal] = &memory.gbuffer;
        for (name, resource) in [("gbuffer.position", position), ("gbuffer.normal", normal), (".flags", &memory.flags)]
        {
            require_asked(&report, "discontinuity", name, resource, &flagged, filter.name());
        }
        let packed = (filter == FilterKind::GaussFast).then_some(("filter.packed", &memory.packed));
        for (name, resource) in [
            (".flags", &memory.flags),
            ("gather.irradiance", &memory.source),
            ("filter.rows", &memory.rows),
            ("filter.irradiance", &memory.filtered),
        ]
        .into_iter()
        .chain(packed)
        {
            require_asked(&report, "deferred.filter", name, resource, &filtered, filter.name());
        }
    }
}

/// The box of adaptive_interleaved, over one of its components.
#[test]
fn a_box_asks_for_what_its_stream_does() {
    let settings = ["--technique", "adaptive_interleaved", "--workgroup", "16x4", "--texels", "4", "--tile", "4x3"];
    let arguments = [&["cornell", "--size", SIZE, "--touched", "line"][..], &settings].concat();
    let report = rendered(&Program::new(), &arguments);
    let (filter, pattern, workgroup) = (FilterKind::Box, [4, 3], [16, 4]);
    let case = FilterCase { extent: EXTENT, filter, taps: 5, pattern, texels: 4, workgroup }.checked().unwrap();
    let [flags, filtered] = &case.kernels(Layout::Linear)[..] else { panic!("it is two passes") };
    let memory = &flags.memory;
    let (flagging, filtering) = (accesses_of(flags), accesses_of(filtered));
    let of_flags = "adaptive_interleaved.discontinuity";
    for (pass, name, resource, accesses) in [
        (of_flags, "gbuffer.position", &memory.gbuffer[0], &flagging),
        (of_flags, "gbuffer.normal", &memory.gbuffer[1], &flagging),
        (of_flags, "discontinuity.flags", &memory.flags, &flagging),
        ("filter.ss", "discontinuity.flags", &memory.flags, &filtering),
        ("filter.ss", "irradiance.ss", &memory.source, &filtering),
        ("filter.ss", "filter.irradiance", &memory.filtered, &filtering),
    ] {
        require_asked(&report, pass, name, resource, accesses, pass);
    }
}

/// A sample a pixel, whose neighbours in a layer are four pixels apart and have lists of their own; lists of 4 x 4 pixels. On one
/// thread samples come in the order of the stream.
#[test]
fn insertion_asks_for_what_its_stream_does() {
    let extent = Extent::new(64, 48);
    let settings = [
        ("size", "64x48"),
        ("spp", "1"),
        ("tuples", "16"),
        ("shading-scale", "0.25"),
        ("guard-band", "0"),
        ("instrument", "off"),
        ("visibility", "repeat-frame"),
    ];
    let spids = seen(&Watched::open("cornell"), extent, &settings);
    let insert = Insert::new(spids, Layout::Linear, 32);
    let (all, memory) = (accesses_of(&insert), &insert.memory);
    let flags: Vec<String> =
        settings.iter().flat_map(|(key, value)| [format!("--{key}"), (*value).to_owned()]).collect();
    let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
    let arguments = [&["cornell", "--technique", "deep_shading", "--touched", "line"][..], &flags].concat();
    let report = rendered_with(&Program::new(), &arguments, &[("LP_NUM_THREADS", "0")]);
    let passes = list(&report["memory"]["touched"]["passes"]);
    let rows = list(&ends(passes, "pass", "deep_shading.lists")["resources"]);
    assert!(
        rows.iter().all(|row| !row["resource"].as_str().unwrap().ends_with("counters")),
        "there are strays: {rows:#?}"
    );
    let asked = |name: &str| {
        let [.., read, written] = bytes(ends(rows, "resource", name));
        [read, written]
    };
    let of = |resource: &Resource| resource.asked_bytes(&all);
    // What threads do whatever others do.
    assert_eq!(asked("visibility.spids"), of(&memory.spids));
    assert_eq!(asked("lists.addresses"), of(&memory.addresses));
    // Lists are emptied before.
    let ([begins_read, begins_written], emptied) = (asked("lists.begins"), extent.pixel_count() / 16 * 4);
    let (begins, nodes) = (of(&memory.begins), of(&memory.nodes));
    let tries = |nodes: [u64; 2]| nodes[1] / 8;
    assert_eq!((begins_written - emptied) / 4, tries(asked("lists.nodes")), "a node is written before each exchange");
    assert_eq!(
        begins_read - begins_written + emptied,
        begins[0] - begins[1],
        "a list's beginning is read once a sample"
    );
    // How often an exchange is lost, and how lists are ordered, is the device's.
    let device = asked("lists.nodes");
    assert!(tries(device) >= tries(nodes), "{device:?} {nodes:?}");
    let near = |at: usize| device[at].abs_diff(nodes[at]) <= nodes[at] / 8;
    assert!(near(0) && near(1), "{device:?} {nodes:?}");
}

/// What the samples of a frame see, a sample a pixel spread over layers.
fn seen(watched: &Watched, extent: Extent, settings: &[(&str, &str)]) -> Spids {
    let renderer = watched.render_stages("deep_shading", settings, &["visibility.spids", "visibility.spids.shifts"]);
    let triangles = watched.integers(&renderer, "visibility.spids");
    let shifts = watched.rgb(&renderer, "visibility.spids.shifts");
    let [layer, space] = [Extent::new(extent.width / 4, extent.height / 4); 2];
    let mut words = Vec::new();
    for tuple in 0..16 {
        for at in (0..layer.height).flat_map(|y| (0..layer.width).map(move |x| [x, y])) {
            let [x, y] = [at[0] * 4 + tuple % 4, at[1] * 4 + tuple / 4];
            let pixel = (y * extent.width + x) as usize;
            // The pixel of shading space under the middle of a pixel of the frame is a fourth of it.
            let shading = [0, 1].map(|axis: usize| ([x, y][axis] / 4).wrapping_add_signed(shifts[pixel][axis] as i32));
            words.push(match triangles[pixel] {
                u32::MAX => [u32::MAX; 2],
                triangle => [triangle, shading[1] << 16 | shading[0]],
            });
        }
    }
    Spids { layer, space, words }
}

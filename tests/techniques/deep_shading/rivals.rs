//! Rivals of deep shading on its own samples: a compact geometry buffer with a cache before it (Liktor & Dachsbacher 2012) comes
//! to the oracle's picture, shades what the lists shade while nothing is forgotten, and has the memory that it says.

use crate::support::difference::require_same;
use crate::support::moving::moving;
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::scene::Scene;
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "65x37");
const INDIRECT: (&str, &str) = ("shading", "indirect-gbuffer");
const ORACLE: (&str, &str) = ("lists", "none");

/// The fence's rotor turns by a quarter of a turn.
fn rotor() -> Scene {
    let spec = "fence:lights=6,alpha=mask";
    moving(spec, [0.0, 0.1])
}

fn counters(watched: &Watched, changes: Changes<'_>) -> BTreeMap<&'static str, f64> {
    watched.render(DEEP, changes).measured_counters().unwrap()
}

#[track_caller]
fn require_oracle_s(watched: &Watched, common: Changes<'_>) {
    let [oracle, indirect] = [ORACLE, INDIRECT].map(|method| watched.picture(DEEP, &both(common, &[method])));
    require_same(&watched.session.gpu, &indirect, &oracle, &common);
}

/// Textures and glass under a lens; what moves, with holes; every kind of visibility that finds its samples in another way;
/// shadows that rays find, and maps.
#[test]
fn pointers_lead_to_the_bits_of_every_sample_shaded_by_itself() {
    let hall = Watched::open("hall:triangles=8000");
    require_oracle_s(&hall, &[SIZE, ("spp", "2"), ("aperture", "0.3"), ("focus", "6")]);
    let fence = Watched::with_scene(rotor());
    require_oracle_s(&fence, &[SIZE, ("camera", "rotor"), ("spp", "2"), ("accumulate", "2")]);
    let cornell = Watched::open("cornell");
    let lens = [SIZE, ("spp", "2"), ("aperture", "0.1")];
    for more in [
        &[("visibility", "stochastic"), ("direct-shadow", "ray")][..],
        &[("visibility", "ray"), ("shading-scale", "0.5")],
        &[("direct-shadow", "map"), ("shadow-map-size", "128")],
    ] {
        require_oracle_s(&cornell, &both(&lens, more));
    }
}

/// Samples that shading space has no place for have entries of their own.
#[test]
fn what_comes_from_outside_shading_space_is_shaded_too() {
    let watched = Watched::open("lamps:objects=20,lights=4");
    let common = [SIZE, ("spp", "4"), ("aperture", "3"), ("guard-band", "0")];
    require_oracle_s(&watched, &common);
    let [indirect, deep] = [&[INDIRECT][..], &[]].map(|more| counters(&watched, &both(&common, more)));
    for key in ["samples_outside_shading_space", "samples_seen", "samples_without_colour"] {
        assert_eq!(indirect[key], deep[key], "{key}");
    }
    assert!(deep["samples_outside_shading_space"] > 0.0);
}

/// With room for all that is seen the cache forgets nothing, and there is an entry of each triangle and shading pixel that the
/// lists have. A cache of one entry forgets nearly all, and one of a thousand some: more is shaded, to the same picture.
#[test]
fn what_the_cache_keeps_is_shaded_once_and_what_it_forgets_again() {
    let watched = Watched::open("lamps:objects=20,lights=4");
    let common = [SIZE, ("spp", "8"), ("aperture", "0.1")];
    let deep = watched.render(DEEP, &common);
    let (picture, deep) = (deep.picture().unwrap(), deep.measured_counters().unwrap());
    let of = |cache: &str| {
        let frame = watched.render(DEEP, &both(&common, &[INDIRECT, ("shading-cache", cache)]));
        require_same(&watched.session.gpu, &frame.picture().unwrap(), &picture, &(cache, "entries"));
        let counted = frame.measured_counters().unwrap();
        assert_eq!(counted["samples_without_colour"], 0.0, "{cache} entries");
        assert!(!counted.contains_key("lists"), "{counted:?}");
        (counted["shader_invocations"], counted["shading_samples_forgotten"])
    };
    let outside = deep["samples_outside_shading_space"];
    let [all, some, none] = ["262144", "1024", "1"].map(of);
    println!("lists {}, {outside} outside; caches {all:?}, {some:?}, {none:?}", deep["shader_invocations"]);
    assert_eq!(all, (deep["shader_invocations"], 0.0));
    assert!(some.0 > all.0 && some.1 > 0.0, "{some:?}");
    assert!(none.0 > some.0 && none.0 <= deep["samples_seen"], "{none:?}");
}

/// With two sets of samples, and room for what they see. A cache of 256 MiB is reached to its end: what looked there for nothing
/// would be shaded again.
#[test]
fn buffers_longer_than_the_device_binds_are_reached_by_their_addresses() {
    let watched = Watched::open("lamps:objects=20,lights=4");
    let common = [("size", "33x19"), ("spp", "4"), ("accumulate", "2"), ("aperture", "0.1")];
    let deep = watched.render(DEEP, &common);
    let (picture, shaded) = (deep.picture().unwrap(), deep.measured_counters().unwrap()["shader_invocations"]);
    let [short, long] = ["262144", "67108864"].map(|entries| [INDIRECT, ("shading-cache", entries)]);
    let is_long = watched.session.gpu.caps.limits.max_storage_buffer_range_bytes < 4 << 26;
    let reached = if is_long { "addresses" } else { "descriptors" };
    for (changes, access) in [
        (short.to_vec(), "descriptors"),
        (both(&short, &[("list-access", "addresses")]), "addresses"),
        (long.to_vec(), reached),
    ] {
        let frame = watched.render(DEEP, &both(&common, &changes));
        assert_eq!(frame.resolved["list-access"], access, "{changes:?}");
        require_same(&watched.session.gpu, &frame.picture().unwrap(), &picture, &changes);
        assert_eq!(frame.measured_counters().unwrap()["shader_invocations"], shaded, "{changes:?}");
    }
    let forgetful = [INDIRECT, ("list-access", "addresses"), ("shading-cache", "9")];
    let frame = watched.render(DEEP, &both(&common, &forgetful));
    require_same(&watched.session.gpu, &frame.picture().unwrap(), &picture, &forgetful);
    assert!(frame.measured_counters().unwrap()["shading_samples_forgotten"] > 0.0);
    if is_long {
        let bound = both(&long, &[("list-access", "descriptors")]);
        let error = watched.try_renderer(DEEP, &both(&common, &bound), &[], Submits::One).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 4);
        for said in ["--list-access descriptors: the longest buffer has 268435456 bytes", "--list-access addresses"] {
            assert!(error.to_string().contains(said), "{said}: {error}");
        }
    }
}

/// Frame buffer as of the lists; a pointer a sample; a cache of as many words; four buffers of 16 bytes an entry and 8 of its
/// colour, an entry a sample at worst, and 4 of its place in the order. The second frame's are longer than the device binds. A frame touches the entries that it makes.
#[test]
fn memory_is_an_entry_a_sample_at_worst() {
    let plan = |size: &str, more: &[&str]| -> BTreeMap<String, u64> {
        let mut arguments = vec!["memory", "--technique", DEEP, "--plan", "--size", size, "--spp", "8", "--json"];
        arguments.extend(["--shading", "indirect-gbuffer"]);
        arguments.extend(more);
        let json = Program::new().run(&arguments).fine().json();
        serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap()
    };
    for (size, samples) in [("1280x720", 1280 * 720 * 8), ("1920x1080", 1920 * 1080 * 8)] {
        let groups = plan(size, &[]);
        for (group, bytes) in [
            ("frame_buffer", 12 * samples),
            ("indirect_frame_buffer", 4 * samples),
            ("shading_cache", 4 * samples),
            ("compact_geometry_buffer", (4 * 16 + 8) * samples),
            // The scene has so many materials, 24 bytes each.
            ("entry_order", 4 * samples + 24 * 6),
        ] {
            assert_eq!(groups[group], bytes, "{size}: {group}");
        }
        for group in ["deep_shading_buffer", "auxiliary"] {
            assert!(!groups.contains_key(group), "{groups:?}");
        }
    }
    assert_eq!(plan("1280x720", &["--shading-cache", "65536"])["shading_cache"], 4 * 65536);
    let watched = Watched::open("cornell");
    let frame = watched.render(DEEP, &[SIZE, ("spp", "2"), INDIRECT]);
    let entries = frame.measured_counters().unwrap()["shader_invocations"];
    let table = frame.touched(watched.session.memory_table(&frame, None).unwrap()).unwrap();
    assert_eq!(table.sums().touched_bytes.unwrap() as f64, (72.0 + 4.0) * entries);
}

#[test]
fn settings_that_it_does_not_read_are_refused() {
    let watched = Watched::open("cornell");
    for (changes, said) in [
        (&[INDIRECT, ORACLE][..], "--lists none with --shading indirect-gbuffer: it has no lists"),
        (&[INDIRECT, ("conservative", "vertex")], "--conservative vertex with --shading indirect-gbuffer"),
        (&[("shading-cache", "9")], "--shading-cache 9 with --shading deep: it has no cache"),
        (&[("shading", "ssaa"), ("shading-cache", "9")], "--shading-cache 9 with --shading ssaa"),
        (&[("shading", "ssaa"), ("list-access", "addresses")], "--list-access addresses with --shading ssaa"),
        (&[INDIRECT, ("size", "4096x4096"), ("spp", "64")], "1073741824 samples in a set of 16 bytes a buffer"),
        (
            &[INDIRECT, ("size", "8192x8192"), ("guard-band", "0"), ("spp", "64")],
            "4294967296 samples in a set, and indices reach 2147483647",
        ),
        (&[("size", "8192x8192"), ("guard-band", "0"), ("spp", "64")], " is within reach at this size; --accumulate"),
    ] {
        let error = watched.try_renderer(DEEP, changes, &[], Submits::One).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains(said), "{changes:?}: {error}");
    }
}

//! Entries that a compute shader shades: lights that are left out, and samples that shading space has no place for.

use super::{DEEP, SIZE};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use quincunx::metrics;

/// Lights with a range reach parts of the scene: a thread's entries leave out the others, and it shades the same.
#[test]
fn lights_that_reach_no_entry_are_left_out() {
    let watched = Watched::open("lamps:objects=60,lights=81");
    let common = [SIZE, ("spp", "2"), ("aperture", "0.05")];
    let counted = |changes: Changes<'_>| {
        let renderer = watched.render(DEEP, &both(&common, changes));
        let counters = renderer.measured_counters().unwrap();
        let [left, out, shaded] =
            ["light_evaluations", "light_evaluations_culled", "shader_invocations"].map(|name| counters[name]);
        assert_eq!(left + out, 81.0 * shaded, "{changes:?}");
        (renderer.picture().unwrap(), out / (left + out))
    };
    let (plain, none) = counted(&[("cull-lights", "off")]);
    assert_eq!(none, 0.0);
    let mut parts = Vec::new();
    for texels in ["1", "4", "16"] {
        for lists in ["linked", "none"] {
            let (found, part) = counted(&[("texels", texels), ("lists", lists)]);
            require_same(&watched.session.gpu, &found, &plain, &(texels, lists));
            parts.push(part);
        }
    }
    println!("parts that are left out: {parts:?}");
    // Fewer lights reach one entry than some of several; which lie together is chance.
    assert!(parts[0] > parts[2] && parts[0] > parts[4] && parts.iter().all(|part| *part > 0.2), "{parts:?}");
}

/// Samples that shading space has no place for are shaded where they are seen, as supersampling shades each: with many of them
/// the picture is as near to it as with none. Both differ from it by highlights and by levels of textures too.
#[test]
fn what_shading_space_has_no_place_for_is_shaded_where_it_is_seen() {
    let watched = Watched::open("chess:triangles=12000");
    let common = [SIZE, ("spp", "8"), ("aperture", "0.6"), ("focus", "2"), ("brdf", "lambert")];
    let every_sample = watched.picture(DEEP, &both(&common, &[("shading", "ssaa"), ("visibility", "repeat-frame")]));
    let of = |guard| {
        let renderer = watched.render(DEEP, &both(&common, &[("guard-band", guard)]));
        let compared = metrics::compare(&renderer.picture().unwrap(), &every_sample, metrics::DEFAULT_THRESHOLD);
        (compared.unwrap().metrics.rmse, renderer.measured_counters().unwrap()["samples_outside_shading_space"])
    };
    let ((far, few), (near, many)) = (of("400"), of("0"));
    println!("RMSE {far} with {few} samples outside, {near} with {many}");
    assert!(many > few + 20_000.0 && near < 1.02 * far, "{far} with {few} samples outside, {near} with {many}");
}

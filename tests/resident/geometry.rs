//! `--geometry culled` leaves out what makes no fragment: the same pixels as `all`, and fewer triangles.

use crate::support;
use crate::support::watched::{Changes, Watched, both};
use quincunx::session::Renderer;

/// Renders with both choices; returns the counters of `culled`: triangles and clusters drawn, clusters left out.
fn require_same_picture(watched: &Watched, technique: &str, changes: Changes<'_>) -> [f64; 3] {
    let [culled, all] = ["culled", "all"].map(|choice| {
        let changes = both(changes, &[("geometry", choice)]);
        watched.render_stages(technique, &changes, &["gbuffer.normal", "gbuffer.color"])
    });
    let hash = |renderer: &Renderer| renderer.picture().unwrap().hash().unwrap();
    assert_eq!(hash(&culled), hash(&all), "{technique} with {changes:?}");
    for stage in ["gbuffer.normal", "gbuffer.color"] {
        assert_eq!(watched.rgb(&culled, stage), watched.rgb(&all, stage), "{stage} of {technique} with {changes:?}");
    }
    let counters = |renderer: &Renderer| {
        ["triangles_drawn", "clusters_drawn", "clusters_culled"].map(|name| renderer.counters[name])
    };
    let (culled, all) = (counters(&culled), counters(&all));
    assert_eq!((all[1], all[2]), (culled[1] + culled[2], 0.0), "every cluster is drawn or left out");
    assert!(culled[0] <= all[0]);
    culled
}

#[test]
fn built_in_scenes_lose_no_pixel() {
    for (spec, least_culled) in [("cornell", 0.0), ("lamps", 1.0), ("hall:triangles=80000", 100.0)] {
        let watched = Watched::open(spec);
        for size in ["320x180", "161x91"] {
            let culled = require_same_picture(&watched, "interleaved_deferred", &[("size", size), ("vpls", "16")])[2];
            assert!(culled >= least_culled, "{spec}: {culled} clusters are left out");
        }
        require_same_picture(&watched, "deferred", &[("size", "97x53"), ("position", "depth")]);
    }
}

#[test]
fn maps_lose_no_pixel_from_any_camera() {
    let Some(folder) = support::shared_scenes() else { return };
    for (map, cameras) in [("kaos", &["0", "1", "2", "3"][..]), ("oa_thor", &["0"]), ("pul1duel-oa", &["0"])] {
        let watched = Watched::open(folder.join(format!("maps/{map}.glb")).to_str().unwrap());
        for camera in cameras {
            let changes = [("size", "161x91"), ("camera", camera), ("direct-shadow", "none")];
            let culled = require_same_picture(&watched, "deferred", &changes)[2];
            assert!(culled > 0.0, "{map}, camera {camera}: a map is never seen whole");
        }
    }
}

/// What the pass says it reads is what it draws: of a scene without holes, which are in textures.
#[test]
fn traffic_follows_what_is_drawn() {
    let watched = Watched::open("cornell");
    for choice in ["culled", "all"] {
        let renderer = watched.render("forward", &[("size", "97x53"), ("geometry", choice), ("depth-prepass", "on")]);
        let depth = renderer.passes().iter().find(|pass| pass.name == "forward.depth").unwrap();
        let read_bytes = depth.traffic.read_bytes.expect("vertices alone are read") as f64;
        // An index and a position of 12 bytes for each corner.
        assert_eq!(read_bytes, renderer.counters["triangles_drawn"] * 3.0 * 16.0, "{choice}");
    }
}

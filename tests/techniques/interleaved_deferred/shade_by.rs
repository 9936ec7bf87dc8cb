//! Sub-buffers shaded by draws (`--shade-by viewport|quad`; Segovia 2006, section 4.3).

use super::NAME;
use crate::support::difference::require_same;
use crate::support::watched::{Watched, both};
use quincunx::gpu::commands::Submits;

/// Every texel of every sub-buffer is drawn by its own draw: what a dispatch shades, to the bit, with hidden lights and joined ones,
/// in odd sizes and patterns.
#[test]
fn draws_shade_what_a_dispatch_shades() {
    let watched = Watched::open("cornell");
    for (size, pattern, split) in [("97x53", "4x4", "one-pass"), ("61x37", "5x3", "tile"), ("64x36", "8x2", "fragment")]
    {
        let common = [("size", size), ("pattern", pattern), ("split", split), ("storage", "image"), ("vpls", "64")];
        let lit = [("vpl-shadow", "ray"), ("direct", "interleaved"), ("filter", "none"), ("position", "float")];
        let way = both(&common, &lit);
        let dispatched = watched.picture(NAME, &way);
        let branch: Vec<_> = way.iter().copied().filter(|(key, _)| !["split", "storage"].contains(key)).collect();
        let plain = watched.picture(NAME, &both(&branch, &[("split", "branch")]));
        require_same(&watched.session.gpu, &dispatched, &plain, &split);
        for by in ["viewport", "quad"] {
            let drawn = watched.picture(NAME, &both(&way, &[("shade-by", by)]));
            require_same(&watched.session.gpu, &drawn, &dispatched, &format!("{by}, {split}"));
        }
    }
}

#[test]
fn draws_into_what_is_no_image_are_refused() {
    let watched = Watched::open("cornell");
    for with in [("storage", "buffer"), ("split", "layered")] {
        let changes = [("size", "16x16"), ("shade-by", "viewport"), with];
        let refused = watched.try_renderer(NAME, &changes, &[], Submits::One).err().expect("it is refused");
        assert_eq!(refused.exit_code(), 2);
        let text = refused.to_string();
        assert!(text.contains(&format!("--{} {}", with.0, with.1)) && text.contains("--storage image"), "{text}");
    }
    let renderer = watched.render(NAME, &[("size", "16x16"), ("shade-by", "viewport")]);
    assert!(renderer.picture().unwrap().mean()[0] > 0.0, "auto storage is an image");
}

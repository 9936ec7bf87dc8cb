//! A pass of the user's own after each technique's, that of examples/own_pass.rs: planned, and after the picture.

#[path = "../../examples/own_pass.rs"]
#[allow(dead_code, reason = "its `main` is the example's")]
mod example;

use crate::support::choices::techniques;
use crate::support::watched::{Changes, Watched, require_silence, values};
use example::{COLOR, Edges, NAME};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;
use quincunx::plan::Shape;
use quincunx::session::Renderer;
use quincunx::techniques::find;
use quincunx::techniques::own_pass::WithPass;
use std::sync::Arc;

/// What the shader says, in Rust: sums and differences alone, which every device rounds alike.
pub fn edges(picture: &Picture) -> Vec<[f32; 3]> {
    let (width, height) = (picture.extent.width as i32, picture.extent.height as i32);
    let at = |x: i32, y: i32| picture.pixels[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let pixels = (0..width * height).map(|index| (index % width, index / width));
    pixels
        .map(|(x, y)| {
            let (right, left, below, above) = (at(x + 1, y), at(x - 1, y), at(x, y + 1), at(x, y - 1));
            std::array::from_fn(|c| {
                let (step, rise) = ((right[c] - left[c]).abs(), (below[c] - above[c]).abs());
                (at(x, y)[c] - step - rise).max(0.0)
            })
        })
        .collect()
}

/// A method that a trait gains, and that is not handed on, would be a technique's own no more.
#[test]
fn every_method_is_handed_on() {
    let read = |file: &str| std::fs::read_to_string(format!("{}/src/techniques/{file}", env!("CARGO_MANIFEST_DIR")));
    let traits = syn::parse_file(&read("mod.rs").unwrap()).unwrap();
    let own = read("own_pass.rs").unwrap();
    let mut count = 0;
    for item in traits.items {
        let syn::Item::Trait(item) = item else { continue };
        for member in item.items {
            let syn::TraitItem::Fn(method) = member else { continue };
            let name = method.sig.ident;
            assert!(own.contains(&format!("fn {name}(")), "{}::{name} is not handed on", item.ident);
            count += 1;
        }
    }
    assert!(count > 25, "{count} methods");
}

fn with_edges(watched: &Watched, technique: &str, changes: Changes<'_>) -> Renderer {
    let wrapped = WithPass { technique: find(technique).unwrap(), pass: Arc::new(Edges::new().unwrap()) };
    let renderer = watched.session.renderer(&wrapped, &values(technique, changes), &[], Submits::One).unwrap();
    renderer.frame().unwrap();
    require_silence(&watched.session.gpu, technique);
    renderer
}

/// Techniques of one run and of several, with BLEND surfaces drawn last, and a picture for each eye.
#[test]
fn it_reads_the_picture_of_every_technique() {
    let watched = Watched::open("fence:lights=6");
    let small = [("size", "33x17")];
    let (eyes, samples) = ([small[0], ("stereo", "0.1")], [small[0], ("spp", "3")]);
    let plain = techniques().map(|technique| (technique, &small[..]));
    for (technique, changes) in plain.chain([("deep_shading", &eyes[..]), ("path_traced", &samples)]) {
        let expected = edges(&watched.picture(technique, changes));
        let renderer = with_edges(&watched, technique, changes);
        assert_eq!(renderer.passes().last().unwrap().name, NAME, "{technique}");
        let planned = renderer.plan.resources.iter().find(|planned| planned.name == COLOR).unwrap();
        assert!(matches!(planned.shape, Shape::Image(_)) && planned.bytes() == 33 * 17 * 16, "{technique}");
        let picture = renderer.picture().unwrap();
        require_silence(&watched.session.gpu, "reading the picture back");
        let apart = |(found, expected): (&[f32; 3], &[f32; 3])| {
            (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f32::max)
        };
        let most = picture.pixels.iter().zip(&expected).map(apart).fold(0.0, f32::max);
        assert!(most <= 1e-6, "{technique} with {changes:?}: {most} apart");
        assert!(expected.iter().any(|pixel| pixel[0] > 0.01), "{technique}: it is dark");
    }
}

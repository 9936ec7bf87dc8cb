//! Pipelines: each constant that is given is one of a stage, and equal ones are made once.

use crate::support::watched::{require_silence, watched_device};
use quincunx::gpu::Gpu;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::shader::passes::accumulate;
use quincunx::gpu::shader::passes::filter::gauss_pack;
use std::sync::Arc;

/// A constant that is misspelt would leave the shader at its default, and nothing else would show it.
#[test]
#[should_panic(expected = "passes.accumulate.comp: no constant is called WORKGROUP_W")]
fn a_constant_that_no_stage_has_makes_no_pipeline() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let known: Vec<(&str, u32)> = accumulate::COMP.constants.iter().map(|it| (it.name, it.default)).collect();
    assert!(ComputePipeline::new(&gpu, &accumulate::COMP, &known).is_ok());
    let misspelt = [&known[..], &[("WORKGROUP_W", 8)]].concat();
    let _ = ComputePipeline::new(&gpu, &accumulate::COMP, &misspelt);
}

/// Those that nobody uses go when there are many, those in use stay, and whichever is asked for then is right again.
#[test]
fn equal_pipelines_are_one_and_idle_ones_end() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let of = |gpu: &Arc<Gpu>, shape: [u32; 2]| {
        let constants = [("WORKGROUP_X", shape[0]), ("WORKGROUP_Y", shape[1])];
        ComputePipeline::new(gpu, &gauss_pack::COMP, &constants).unwrap()
    };
    let used = of(&gpu, [64, 1]);
    let again = of(&gpu, [64, 1]);
    assert_eq!(used.handle(), again.handle());
    assert!(of(&gpu, [32, 2]).handle() != used.handle());
    // More shapes than are kept, twice.
    let shapes: Vec<[u32; 2]> =
        (1..=64).flat_map(|width| (1..=64 / width).map(move |height| [width, height])).collect();
    assert!(shapes.len() > 260, "{}", shapes.len());
    for shape in shapes.iter().chain(&shapes) {
        assert_eq!(of(&gpu, *shape).workgroup, [shape[0], shape[1], 1]);
    }
    assert_eq!(of(&gpu, [64, 1]).handle(), used.handle());
    require_silence(&gpu, "pipelines that end");
}

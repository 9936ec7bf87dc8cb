//! Constants of pipelines: each one that is given is one of a stage.

use crate::support::watched::watched_device;
use quincunx::gpu::Gpu;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::shader::passes::accumulate;

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

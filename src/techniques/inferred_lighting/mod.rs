//! Inferred lighting: Kircher and Lawrance 2009, "Inferred Lighting: Fast dynamic lighting and shadows for opaque and
//! translucent objects". Light small, shade large.
//!
//! Passes: geometry (at the light buffer's size), decals (with `--decals`), cull (with `--volumes tiled`), light, pack (with draws and float sums), depth
//! and material (at the frame's size), resolve (with `--msaa`).
//!
//! Differs from the paper: the light pass sums in 32 bits and rounds once (`--l-buffer half` is the paper's way); its
//! default method is one dispatch with light lists for tiles (`--volumes quad`, `scissor`, `stencil`, `both` and `auto`
//! are draws, and only lights that are drawn have `--shadow-volumes`); depth is reversed and a float; specular power
//! travels in a third target by default (`--extras`), because materials of glTF have a roughness each, and F0 beside it;
//! the L-buffer has three channels of the highlight by default, with the Fresnel factor of each light over that F0
//! (`--highlight`; `intensity` with `--fresnel normal` is the paper's one number, without a factor of angles); a surface
//! that none of its four texels belongs to looks one texel farther (`--light-rings 0` does not, as in the paper).
//!
//! Equals `deferred` within the rounding of normals, depth, roughness and L-buffer with `--light-size` at the frame's
//! size, without BLEND surfaces (tests/techniques/inferred_lighting/mod.rs has the bound).

mod aov;
mod assignment;
mod bench_stages;
mod blend_names;
mod choices;
mod cull;
mod decals;
pub mod encoding;
mod footprint;
mod frame;
mod geometry;
mod light;
mod material;
mod motion;
mod resources;
mod settings;
mod stipple;
mod survivors;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::{HostPart, Inputs, NamedPattern, Prepared, Technique, Tuned, straight_light};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::gpu::Access;
use crate::gpu::shader::structs::{FrameBlock, LightBlock};
use crate::lights::LightSet;
use crate::lights::shadow_casters::ShadowCasters;
use crate::passes::{blend, cull as light_masks, direct, samples, workgroup};
use crate::plan::Plan;
use crate::settings::{INSTRUMENT, MULTISAMPLE, Setting, Values, WORKGROUP};
use crate::techniques::inferred_lighting::encoding::PackingFormat;
use crate::techniques::inferred_lighting::light::store::Sums;
use crate::techniques::inferred_lighting::resources::{NAME, light_frame};
use choices::{Choices, LightFetch};
use encoding::Loss;
use frame::InferredFrame;
use light::{Volumes, shadow_volumes};
use std::collections::BTreeMap;
use std::time::Instant;

pub struct InferredLighting;

impl Technique for InferredLighting {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "inferred lighting (Kircher 2009): punctual lights at a fraction of the pixels, found again by the surface they belong to"
    }

    fn scene(&self) -> &'static str {
        "lamps"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, MULTISAMPLE]
    }

    fn aovs(&self) -> &'static [&'static str] {
        aov::AOVS
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("direct-shadow", "none")]
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        let of = "the geometry pass".to_owned();
        let mut needs = vec![Need { of, ability: Ability::FloatDepth, instead: "" }];
        needs.extend(blend::needs(has_blend));
        if values.unless_auto(INSTRUMENT.key, Values::is_on) == Some(true) {
            let of = "--instrument on".to_owned();
            let instead = "--instrument auto counts where a device can";
            needs.push(Need { of, ability: Ability::FragmentAtomics, instead });
        }
        needs.extend(samples::needs(values));
        if values.is("packing", PackingFormat::Fixed) {
            let of = "--packing fixed".to_owned();
            needs.push(Need { of, ability: Ability::FixedPairs, instead: "--packing words works without it" });
        }
        if values.text("decals") != blend_names::NONE {
            let of = "--decals".to_owned();
            let instead = "without it decals have layers of their own";
            needs.push(Need { of, ability: Ability::BlendFixedPairs, instead });
        }
        if values.is("l-buffer", Sums::Fixed) && values.is("light-fetch", LightFetch::Sampler) {
            let of = "--l-buffer fixed with --light-fetch sampler".to_owned();
            needs.push(Need { of, ability: Ability::FixedQuads, instead: "--light-fetch texels works without it" });
        }
        let volumes: Volumes = values.choice("volumes");
        if volumes != Volumes::Tiled {
            let of = format!("--volumes {}", volumes.name());
            needs.push(Need {
                of: of.clone(),
                ability: Ability::BlendFloats,
                instead: "--volumes tiled works without it",
            });
            let casts = values.integer("shadow-volumes") > 0;
            if casts || volumes.counts() {
                let (of, instead) = match casts {
                    true => {
                        ("--shadow-volumes".to_owned(), "--shadow-volumes 0 with --volumes scissor works without it")
                    }
                    false => (of, "--volumes scissor works without it"),
                };
                needs.push(Need { of: of.clone(), ability: Ability::DepthWithStencil, instead });
                needs.push(Need { of, ability: Ability::DepthClamp, instead });
            }
        } else {
            let of = "--volumes tiled".to_owned();
            needs.push(Need { of, ability: Ability::StoreWordPairs, instead: "" });
        }
        needs
    }

    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)> {
        vec![("--light-size", format!("{} px a side", caps.limits.max_image_side_px))]
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        let by_volumes = values.integer("shadow-volumes") as usize;
        straight_light(values, lights, by_volumes)
    }

    fn tuned(&self) -> Tuned {
        &[
            ("volumes", &["tiled", "quad", "scissor", "stencil", "both"]),
            ("cull-by", &["auto", "invocation", "workgroup"]),
            ("depth-prepass", &["on", "off"]),
            ("geometry", &["culled", "all"]),
            ("texels", &["auto", "1", "4", "16"]),
            ("workgroup", &["auto", "8x8", "16x16", "64x1", "256x1"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        let open = figures.counter("shadow_casters_not_closed").filter(|open| *open > 0.0);
        let open = open
            .map(|open| format!("  note: draws without shadow volumes, because their meshes are not closed: {open}"));
        open.into_iter().chain(notes::direct_light(figures, None)).collect()
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        assignment::PATTERNS
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let choices = Choices::new(inputs)?;
        let lights = direct::light_blocks(inputs.lights, inputs.values);
        let started = Instant::now();
        let casters = ShadowCasters::of(inputs.scene, &inputs.lights.lights, &choices.casting_lights)?;
        let casters_ns = started.elapsed().as_nanos() as u64;
        Ok(Box::new(PreparedInferred { choices, lights, casters, casters_ns }))
    }
}

struct PreparedInferred {
    choices: Choices,
    lights: Vec<LightBlock>,
    /// What the lights of `--shadow-volumes` cast.
    casters: ShadowCasters,
    casters_ns: u64,
}

impl Prepared for PreparedInferred {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let choices = &self.choices;
        let light_count = inputs.lights.lights.len();
        let mut plan = Plan::default();
        geometry::plan(&mut plan, choices);
        if choices.has_motion {
            motion::plan(&mut plan, inputs.stats);
        }
        let tree = choices.shading.direct.tree(inputs.bvh, inputs.scene)?;
        direct::plan_with_masks(&mut plan, NAME, light_count, &choices.shading, tree, choices.light_extent);
        plan.buffer("lights", light_frame(), size_of::<FrameBlock>() as u64);
        light::plan(&mut plan, choices.light_extent, choices.l_buffer);
        if !choices.casting_lights.is_empty() {
            shadow_volumes::plan(&mut plan, &self.casters);
        }
        material::plan(&mut plan, inputs.view.extent, choices.samples, choices.is_counted);
        if inputs.stats.has_blend && !choices.tests_alpha {
            // The texels that are left of BLEND draws are counted.
            plan.read_back(&geometry::filtered(false)[0].0);
        }
        plan.pass(format!("{NAME}.geometry"), geometry::written(choices));
        if !choices.decals.is_empty() {
            plan.pass(decals::pass(), geometry::marked());
        }
        let masks = choices.shading.culls(light_count);
        if masks {
            let written = light_masks::masks(NAME, Access::ComputeWrite);
            let placed = geometry::placed(Access::ComputeSample);
            plan.pass(format!("{NAME}.cull"), placed.into_iter().chain([written]));
        }
        if choices.volumes == Volumes::Tiled {
            let mut touches = geometry::lit(choices.has_extras, Access::ComputeSample, Access::ComputeSample);
            touches.extend(masks.then(|| light_masks::masks(NAME, Access::ComputeRead)));
            touches.push((light::l_buffer(), Access::ComputeWrite));
            plan.pass(format!("{NAME}.light"), touches);
        } else {
            let depth_access = if choices.has_stencil() { Access::StencilWrite } else { Access::FragmentSample };
            let mut touches = geometry::lit(choices.has_extras, Access::FragmentSample, depth_access);
            let sums = light::sums(choices.l_buffer);
            let targets = if sums.is_empty() { vec![light::l_buffer()] } else { sums.clone() };
            touches.extend(targets.into_iter().map(|target| (target, Access::ColorWrite)));
            plan.pass(format!("{NAME}.light"), touches);
            if !sums.is_empty() {
                let read = sums.into_iter().map(|sums| (sums, Access::ComputeSample));
                plan.pass(format!("{NAME}.pack"), read.chain([(light::l_buffer(), Access::ComputeWrite)]));
            }
        }
        material::plan_passes(&mut plan, choices);
        Ok(plan)
    }

    fn stages_left_out(&self, inputs: &Inputs<'_>) -> Vec<(&'static str, String)> {
        aov::left_out(inputs.values)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let shading = &self.choices.shading;
        let texels = shading.texels.of_column(shading.direct.load(self.lights.len()));
        BTreeMap::from([
            ("cull-by", shading.cull_by.name().to_owned()),
            ("highlight", self.choices.highlight().to_owned()),
            (INSTRUMENT.key, if self.choices.is_counted { "on" } else { "off" }.to_owned()),
            ("light-size", self.choices.light_extent.to_string()),
            ("stipple", self.choices.stipple_name().to_owned()),
            ("texels", texels.to_string()),
            (WORKGROUP.key, workgroup::text(shading.workgroup)),
        ])
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        let has_casters = !self.choices.casting_lights.is_empty();
        Ok(HostPart {
            passes: has_casters.then(|| (shadow_volumes::pass(), self.casters_ns)).into_iter().collect(),
            counters: self.counters(),
            light_counts: [self.lights.len() as u32, 0],
            build: Box::new(move |gpu, inputs, scene, resources| {
                let Self { choices, lights, casters, .. } = *self;
                Ok(Box::new(InferredFrame::new(gpu, inputs, scene, resources, &choices, &lights, &casters)?))
            }),
        })
    }
}

impl PreparedInferred {
    fn counters(&self) -> BTreeMap<&'static str, f64> {
        let loss = Loss::of(self.choices.packing);
        let mut counters = BTreeMap::from([
            ("lights", self.lights.len() as f64),
            ("normal_error_most_deg", loss.normal_most_deg),
            ("normal_error_mean_deg", loss.normal_mean_deg),
            ("depth_error_most", loss.depth_most),
            ("light_error_most", self.choices.l_buffer.store.loss(self.choices.light_range)),
        ]);
        if !self.choices.casting_lights.is_empty() {
            counters.insert("shadow_volume_lights", self.casters.lights.len() as f64);
            counters.insert("shadow_volumes", self.casters.volume_count as f64);
            counters.insert("shadow_volume_triangles", self.casters.triangles.len() as f64);
            counters.insert("shadow_casters_not_closed", self.casters.open_count as f64);
        }
        counters
    }
}

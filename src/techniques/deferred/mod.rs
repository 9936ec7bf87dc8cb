//! Plain deferred shading of punctual lights: the baseline of Segovia 2006 and the frame of every picture with direct
//! light only. No indirect light.
//!
//! Passes: gbuffer, cull (with `--cull tiled`), shade, blend (where the scene has BLEND surfaces).

mod bench_stages;
pub mod shade;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::{Frame, HostPart, Inputs, Prepared, Technique, Tuned, straight_light};
use crate::caps::{Caps, Need};
use crate::error::Result;
use crate::gpu::shader::structs::LightBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::LightSet;
use crate::lights::object_lists::ObjectLists;
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, SolidPicture};
use crate::passes::cull;
use crate::passes::cull::{Cull, CullLights};
use crate::passes::direct::{self, DirectGpu, ShadingSettings};
use crate::passes::gbuffer::{self, GBuffer, GBufferPass};
use crate::passes::workgroup;
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::{Coverage, SceneGpu};
use crate::settings::{LIGHT_LISTS, SHADING, Setting, Values, WORKGROUP};
use shade::Shade;
use std::collections::BTreeMap;
use std::sync::Arc;

const NAME: &str = "deferred";
/// The finished picture.
const COLOR: &str = "deferred.shade.color";

pub struct Deferred;

impl Technique for Deferred {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "plain deferred shading of the scene's punctual lights"
    }

    fn scene(&self) -> &'static str {
        "lamps"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[SHADING, LIGHT_LISTS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        gbuffer::AOVS
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("cull", "none"), ("direct-shadow", "none")]
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        [gbuffer::need()].into_iter().chain(blend::needs(has_blend)).chain(direct::needs(values)).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        straight_light(values, lights, 0)
    }

    fn tuned(&self) -> Tuned {
        &[
            ("cull", &["none", "tiled"]),
            ("cull-by", &["auto", "invocation", "workgroup"]),
            ("geometry", &["culled", "all"]),
            ("light-lists", &["object", "none"]),
            ("texels", &["auto", "1", "4", "16"]),
            ("workgroup", &["auto", "8x8", "16x16", "64x1", "256x1"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        Vec::from_iter(notes::direct_light(figures, Some("deferred.shade")))
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let settings = ShadingSettings::new(inputs.values, inputs.lights, inputs.scene, inputs.caps);
        let lights = direct::light_blocks(inputs.lights, inputs.values);
        let blended = blend::lists(inputs.scene, &lights, inputs.values, inputs.caps)?;
        Ok(Box::new(PreparedDeferred { settings, lights, blended }))
    }
}

struct PreparedDeferred {
    settings: ShadingSettings,
    lights: Vec<LightBlock>,
    /// The lists of what blends.
    blended: ObjectLists,
}

impl Prepared for PreparedDeferred {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let settings = &self.settings;
        let (extent, position, has_emissive) = (inputs.view.extent, settings.position, inputs.stats.has_emissive);
        let light_count = inputs.lights.lights.len();
        let mut plan = Plan::default();
        gbuffer::plan(&mut plan, NAME, extent, position, has_emissive);
        let tree = settings.direct.tree(inputs.bvh, inputs.scene)?;
        direct::plan_with_masks(&mut plan, NAME, light_count, settings, tree, extent);
        // No virtual lights: what blended surfaces bind in their place.
        plan.buffer("lights", "deferred.vpls", 0);
        plan.picture(COLOR, extent);
        plan.pass(format!("{NAME}.gbuffer"), gbuffer::written(NAME, position, has_emissive));
        let masks = settings.culls(light_count).then_some(NAME);
        if masks.is_some() {
            let written = cull::masks(NAME, Access::ComputeWrite);
            plan.pass(format!("{NAME}.cull"), gbuffer::surface(NAME, position).into_iter().chain([written]));
        }
        let mut shaded = gbuffer::shading(NAME, position, has_emissive);
        shaded.extend(masks.map(|technique| cull::masks(technique, Access::ComputeRead)));
        shaded.push((COLOR.to_owned(), Access::ComputeWrite));
        plan.pass(format!("{NAME}.shade"), shaded);
        if inputs.stats.has_blend {
            blend::plan_lists(&mut plan, NAME, &self.blended);
            plan.pass(format!("{NAME}.blend"), blend::touches(&gbuffer::depth(NAME), COLOR));
        }
        Ok(plan)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let texels = self.settings.texels.of_column(self.settings.direct.load(self.lights.len()));
        BTreeMap::from([
            ("cull-by", self.settings.cull_by.name().to_owned()),
            ("texels", texels.to_string()),
            (WORKGROUP.key, workgroup::text(self.settings.workgroup)),
        ])
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        Ok(HostPart {
            passes: Vec::new(),
            counters: [("lights", self.lights.len() as f64)]
                .into_iter()
                .chain(blend::counters(&self.blended))
                .collect(),
            light_counts: [self.lights.len() as u32, 0],
            build: Box::new(move |gpu, inputs, scene, resources| self.build(gpu, inputs, scene, resources)),
        })
    }
}

impl PreparedDeferred {
    /// The frame on the device.
    fn build(
        self,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let (settings, has_emissive) = (&self.settings, inputs.stats.has_emissive);
        let tree = settings.direct.tree(inputs.bvh, inputs.scene)?;
        let direct = DirectGpu::new(gpu, resources, NAME, &self.lights, settings.culls(self.lights.len()), tree)?;
        Ok(Box::new(DeferredFrame {
            gbuffer_pass: GBufferPass::new(
                gpu,
                scene,
                inputs.draw_list(scene, Coverage::Middle),
                settings.position,
                has_emissive,
            )?,
            cull: direct.masks.as_ref().map(|_| Cull::new(gpu, settings.position, settings.cull_by)).transpose()?,
            shade: Shade::new(gpu, settings, has_emissive, direct.masks.is_some(), self.lights.len())?,
            blend: Blend::new(
                gpu,
                scene,
                inputs.view,
                blend::all_lights(0.0),
                &settings.direct.light_constants(),
                &BlendTarget::plain(&self.blended),
            )?,
            blend_lists: (inputs.stats.has_blend)
                .then(|| blend::upload_lists(gpu, resources, NAME, &self.blended))
                .transpose()?,
            gbuffer: GBuffer::new(gpu, resources, NAME, settings.position, has_emissive)?,
            direct,
            vpls: resources.buffer("deferred.vpls"),
            color: resources.image(COLOR),
        }))
    }
}

struct DeferredFrame {
    gbuffer_pass: GBufferPass,
    cull: Option<Cull>,
    shade: Shade,
    blend: Option<Blend>,
    blend_lists: Option<Buffer>,
    gbuffer: GBuffer,
    direct: DirectGpu,
    vpls: Buffer,
    color: Image,
}

impl Frame for DeferredFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let gbuffer = &self.gbuffer;
        self.gbuffer_pass.record(cmd, NAME, frame, scene, gbuffer)?;
        let mut written = Access::ColorWrite;
        if let (Some(cull), Some(masks)) = (&self.cull, &self.direct.masks) {
            let lights = CullLights { blocks: &self.direct.lights, count: self.direct.light_count };
            cull.record(cmd, NAME, gbuffer.from(written), frame, lights, masks)?;
            written = Access::ComputeSample;
        }
        self.shade.record(cmd, frame, self.direct.from(Access::ComputeWrite), gbuffer.from(written), &self.color)?;
        if let (Some(blend), Some(lists)) = (&self.blend, &self.blend_lists) {
            let lights = BlendLights {
                lights: &self.direct.lights,
                vpls: &self.vpls,
                subsets: &self.vpls,
                bvh_nodes: &self.direct.bvh_nodes,
                bvh_triangles: &self.direct.bvh_triangles,
                lists,
                shadow_maps: None,
            };
            let solid = SolidPicture {
                depth: gbuffer.depth_edge(Access::ComputeSample),
                color: self.color.from(Access::ComputeWrite),
            };
            blend.record(cmd, NAME, frame, scene, &lights, solid)?;
        }
        Ok(())
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.gbuffer_pass.counters().into()
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.color, if self.blend.is_some() { Access::ColorWrite } else { Access::ComputeWrite })
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        self.direct.counters(gpu, self.color.description.extent)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        self.gbuffer.aov(gpu, name).unwrap_or_else(|| unreachable!("{NAME} has no stage {name}"))
    }
}

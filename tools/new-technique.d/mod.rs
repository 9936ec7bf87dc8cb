//! new_technique: the paper (authors, title, where and when it was published), in one sentence.
//!
//! Passes: gbuffer, shade, blend (where the scene has BLEND surfaces).
//!
//! Differs from the paper: so far it is plain deferred shading with a factor.
//!
//! It equals `deferred` at `--light-scale 1`.

mod settings;
mod shade;

use super::bench_stage::{BenchStage, GBUFFER};
use super::{Frame, HostPart, Inputs, Prepared, Technique, light_visibility};
use crate::caps::{Caps, Need};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::LightBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::LightSet;
use crate::lights::object_lists::ObjectLists;
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, SolidPicture};
use crate::passes::direct::{self, DirectGpu, DirectSettings};
use crate::passes::gbuffer::{self, GBuffer, GBufferPass};
use crate::passes::workgroup;
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::{Coverage, SceneGpu};
use crate::settings::{LIGHT_LISTS, PositionStorage, Setting, Values, WORKGROUP};
use shade::Shade;
use std::collections::BTreeMap;
use std::sync::Arc;

const NAME: &str = "new_technique";
const POSITION: PositionStorage = PositionStorage::Unorm16;
/// The finished picture.
const COLOR: &str = "new_technique.shade.color";

pub struct NewTechnique;

impl Technique for NewTechnique {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "one line for the list of techniques"
    }

    fn scene(&self) -> &'static str {
        "lamps"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, LIGHT_LISTS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        gbuffer::AOVS
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("direct-shadow", "none")]
    }

    fn needs(&self, _: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        [gbuffer::need()].into_iter().chain(blend::needs(has_blend)).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Punctual lights, straight.
    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        if values.number("light-scale") != 1.0 {
            return Err(Error::request("--light-scale has no reference but at 1"));
        }
        Ok(vec![
            ("transport", "direct".to_owned()),
            ("light-visibility", light_visibility(values, lights, 0)?),
            ("emissive", "off".to_owned()),
            ("ambient-visibility", "off".to_owned()),
        ])
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        &[GBUFFER]
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let direct = DirectSettings::new(inputs.values, inputs.lights, inputs.scene);
        let workgroup = workgroup::workgroup(inputs.values, inputs.caps);
        let lights = direct::light_blocks(inputs.lights, inputs.values);
        let blended = blend::lists(inputs.scene, &lights, inputs.values, inputs.caps)?;
        Ok(Box::new(PreparedNewTechnique { direct, workgroup, lights, blended }))
    }
}

struct PreparedNewTechnique {
    direct: DirectSettings,
    workgroup: [u32; 2],
    lights: Vec<LightBlock>,
    /// The lists of what blends.
    blended: ObjectLists,
}

impl Prepared for PreparedNewTechnique {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let (extent, has_emissive) = (inputs.view.extent, inputs.stats.has_emissive);
        let mut plan = Plan::default();
        gbuffer::plan(&mut plan, NAME, extent, POSITION, has_emissive);
        direct::plan(&mut plan, NAME, self.lights.len(), self.direct.tree(inputs.bvh, inputs.scene)?);
        // No virtual lights: what blended surfaces bind in their place.
        plan.buffer("lights", "new_technique.vpls", 0);
        plan.picture(COLOR, extent);
        plan.pass(format!("{NAME}.gbuffer"), gbuffer::written(NAME, POSITION, has_emissive));
        let mut shaded = gbuffer::shading(NAME, POSITION, has_emissive);
        shaded.push((COLOR.to_owned(), Access::ComputeWrite));
        plan.pass(format!("{NAME}.shade"), shaded);
        if inputs.stats.has_blend {
            blend::plan_lists(&mut plan, NAME, &self.blended);
            plan.pass(format!("{NAME}.blend"), blend::touches(&gbuffer::depth(NAME), COLOR));
        }
        Ok(plan)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        BTreeMap::from([(WORKGROUP.key, workgroup::text(self.workgroup))])
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

impl PreparedNewTechnique {
    /// The frame on the device.
    fn build(
        self,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let (has_emissive, tree) = (inputs.stats.has_emissive, self.direct.tree(inputs.bvh, inputs.scene)?);
        let list = inputs.draw_list(scene, Coverage::Middle);
        Ok(Box::new(NewTechniqueFrame {
            gbuffer_pass: GBufferPass::new(gpu, scene, list, POSITION, has_emissive)?,
            shade: Shade::new(gpu, inputs.values, self.workgroup, &self.direct, POSITION, has_emissive)?,
            blend: Blend::new(
                gpu,
                scene,
                inputs.view,
                blend::all_lights(0.0),
                &self.direct.light_constants(),
                &BlendTarget::plain(&self.blended),
            )?,
            blend_lists: (inputs.stats.has_blend)
                .then(|| blend::upload_lists(gpu, resources, NAME, &self.blended))
                .transpose()?,
            gbuffer: GBuffer::new(gpu, resources, NAME, POSITION, has_emissive)?,
            direct: DirectGpu::new(gpu, resources, NAME, &self.lights, false, tree)?,
            vpls: resources.buffer("new_technique.vpls"),
            color: resources.image(COLOR),
        }))
    }
}

struct NewTechniqueFrame {
    gbuffer_pass: GBufferPass,
    shade: Shade,
    blend: Option<Blend>,
    blend_lists: Option<Buffer>,
    gbuffer: GBuffer,
    direct: DirectGpu,
    vpls: Buffer,
    color: Image,
}

impl Frame for NewTechniqueFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let gbuffer = &self.gbuffer;
        self.gbuffer_pass.record(cmd, NAME, frame, scene, gbuffer)?;
        self.shade.record(cmd, frame, &self.direct, gbuffer.from(Access::ColorWrite), &self.color)?;
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

//! What a member sees where members differ in more than their place: the scene at a moment (section 3.2), its lights at single
//! places of them (sections 3 and 3.4).
//!
//! Why on the host: a member is drawn by the original algorithm from buffers that it cannot tell from those of a scene that
//! stands still. Triangles of the tree move within boxes that hold both ends of their way, so that no box changes.

use super::choices::Choices;
use super::resources::{NAME, POSED_ATTRIBUTES, POSED_DRAWS, POSED_POSITIONS};
use super::soft::MemberLights;
use crate::error::Result;
use crate::gpu::shader::structs::DrawBlock;
use crate::gpu::{Access, Gpu, upload};
use crate::lights::LightSet;
use crate::memory::kinds::Use;
use crate::passes::forward::{Forward, ForwardMoment};
use crate::plan::{Plan, Resources, Shape};
use crate::resident::{Pose, SceneGpu, VertexAttributes, draw_blocks, geometry};
use crate::sampling::pattern::Dimension;
use crate::scene::Scene;
use crate::settings::Values;
use crate::techniques::{Inputs, Run};
use ash::vk::BufferUsageFlags;
use std::cell::RefCell;
use std::sync::Arc;
use std::time::Instant;

/// Plans where the scene is posed, with `--effect motion`.
pub fn plan(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) {
    let Some(exposure) = &choices.exposure else { return };
    let bytes = |count: u64, size: usize| count * size as u64;
    if exposure.changes_meshes() {
        let flags = BufferUsageFlags::VERTEX_BUFFER | BufferUsageFlags::TRANSFER_DST;
        let mut vertices = |name: &str, size: usize| {
            let bytes = bytes(inputs.stats.vertex_count, size);
            plan.push("scene.geometry", name, Shape::Buffer { bytes, flags, usage: Use::Device });
        };
        vertices(POSED_POSITIONS, size_of::<[f32; 3]>());
        vertices(POSED_ATTRIBUTES, size_of::<VertexAttributes>());
    }
    plan.buffer("scene.geometry", POSED_DRAWS, bytes(inputs.stats.draw_count, size_of::<DrawBlock>()));
}

/// What is made anew for each member.
pub struct Moment {
    gpu: Arc<Gpu>,
    values: Values,
    lights: LightSet,
    /// The scene as the last member saw it, and where the device has it; None where nothing moves.
    posed: Option<(RefCell<Scene>, SceneGpu)>,
}

impl Moment {
    /// Takes out what was planned. None: members differ in their places alone.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
    ) -> Option<Self> {
        let posed = choices.exposure.as_ref().map(|exposure| {
            let draws = Arc::new(resources.buffer(POSED_DRAWS));
            let pose = match exposure.changes_meshes() {
                false => Pose { draws, ..scene.pose.clone() },
                true => Pose {
                    positions: Arc::new(resources.buffer(POSED_POSITIONS)),
                    attributes: Arc::new(resources.buffer(POSED_ATTRIBUTES)),
                    draws,
                },
            };
            (RefCell::new(exposure.opening()), scene.posed(pose))
        });
        choices.changes().then(|| Self {
            gpu: gpu.clone(),
            values: inputs.values.clone(),
            lights: inputs.lights.clone(),
            posed,
        })
    }

    /// The scene as members see it; None where it stands still.
    pub fn scene(&self) -> Option<&SceneGpu> {
        self.posed.as_ref().map(|(_, scene)| scene)
    }

    /// Has `forward` drawn next as the member of `run` sees it: the pass, and how long it took, nanoseconds.
    ///
    /// Errors: memory for the uploads (exit code 4).
    pub fn begin(&self, run: &Run<'_>, choices: &Choices, forward: &Forward) -> Result<(String, u64)> {
        let began = Instant::now();
        let part = choices.part(run.index);
        let exposure = choices.exposure.as_ref();
        if let Some((exposure, (scene, posed))) = exposure.zip(self.posed.as_ref()) {
            let mut scene = scene.borrow_mut();
            exposure.pose(&mut scene, part);
            self.send(&scene, &posed.pose, exposure.changes_meshes())?;
        }
        let posed = self.posed.as_ref().map(|(scene, _)| scene.borrow());
        let scene = posed.as_deref().unwrap_or(run.scene);
        let lights = exposure.map_or_else(|| self.lights.clone(), |exposure| exposure.lights_at(part));
        let number = |dimension| choices.members.basis().number(run.index, dimension).unwrap_or_default();
        let lights = match &choices.soft {
            Some(soft) => soft.at(lights, scene, [Dimension::LightU, Dimension::LightV, Dimension::LightW].map(number)),
            None => MemberLights::from(lights),
        };
        let tree = choices.drawing.direct.tree(run.bvh, run.scene)?;
        let triangles = exposure.and_then(|_| tree.triangles_at(part));
        let mut maps = choices.drawing.maps.clone();
        maps.iter_mut().for_each(|maps| maps.see(&lights.set, scene));
        let moment = ForwardMoment {
            lights: &lights.blocks(&self.values),
            triangles: triangles.as_deref(),
            maps: maps.as_ref(),
        };
        forward.renew(&self.gpu, &moment)?;
        Ok((format!("{NAME}.moment"), began.elapsed().as_nanos() as u64))
    }

    fn send(&self, scene: &Scene, pose: &Pose, has_vertices: bool) -> Result<()> {
        if has_vertices {
            let (positions, attributes) = (geometry::positions(scene), geometry::attributes(scene));
            upload::buffer(&self.gpu, &pose.positions, bytemuck::cast_slice(&positions), Access::VertexRead)?;
            upload::buffer(&self.gpu, &pose.attributes, bytemuck::cast_slice(&attributes), Access::VertexRead)?;
        }
        upload::buffer(&self.gpu, &pose.draws, bytemuck::cast_slice(&draw_blocks(scene)), Access::GraphicsRead)
    }
}

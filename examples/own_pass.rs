//! A compute pass of one's own inside a frame: edges, drawn over the picture of a technique.
//!
//!     cargo run --release --example own_pass [PLAIN OWN]
//!
//! Writes the plain picture and that of the pass: plain.png and own_pass.png, if no other files (.png or .exr) are named.

use glslang::{Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage};
use glslang::{SpirvVersion, Target, VulkanVersion};
use quincunx::gpu::commands::Submits;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::shader::{Binding, BindingKind, Shader, Side, Stage};
use quincunx::gpu::{Access, Bound, Commands, DeviceRequest, Edge, Gpu, Image, Traffic};
use quincunx::picture::image_file::{WriteOptions, write};
use quincunx::plan::{Plan, Resources};
use quincunx::scene;
use quincunx::session::Session;
use quincunx::techniques::own_pass::{OwnFrame, OwnPass, WithPass};
use quincunx::techniques::{self, defaults, set};
use quincunx::units::Extent;
use quincunx::{Error, error::Result};
use std::path::Path;
use std::sync::Arc;

/// Each pixel less how far it is from its neighbours: dark lines where something ends.
const EDGES: &str = "#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D picture;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D edges;

vec3 at(ivec2 pixel) {
    return imageLoad(picture, clamp(pixel, ivec2(0), imageSize(picture) - 1)).rgb;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(picture)))) {
        return;
    }
    vec3 step = abs(at(pixel + ivec2(1, 0)) - at(pixel - ivec2(1, 0)));
    vec3 rise = abs(at(pixel + ivec2(0, 1)) - at(pixel - ivec2(0, 1)));
    imageStore(edges, pixel, vec4(max(at(pixel) - step - rise, 0.0), 1.0));
}
";

/// The pass's name in timings and debuggers.
pub const NAME: &str = "own.edges";
/// The image that it writes.
pub const COLOR: &str = "own.edges.color";

/// The shader in the form that quincunx has its own ones in: SPIR-V, and what it binds by name.
pub struct Edges(Shader);

impl Edges {
    pub fn new() -> Result<Self> {
        let spirv = compiled(EDGES).map_err(|error| Error::request(format!("{NAME}: {error}")))?;
        let bytes: Vec<u8> = spirv.into_iter().flat_map(u32::to_le_bytes).collect();
        let image = |binding, name| Binding { set: 0, binding, name, kind: BindingKind::StorageImage, count: 1 };
        Ok(Self(Shader {
            name: "own/edges",
            variant: "COMP",
            stage: Stage::Compute,
            // The table is as long-lived as the program, and so is this.
            spirv: bytes.leak(),
            bindings: vec![image(0, "picture"), image(1, "edges")].leak(),
            params: None,
            constants: &[],
            workgroup: [Side::Fixed(8), Side::Fixed(8), Side::Fixed(1)],
        }))
    }
}

/// GLSL to SPIR-V by the compiler that quincunx's own shaders are built with; any other will do.
fn compiled(glsl: &str) -> std::result::Result<Vec<u32>, Box<dyn std::error::Error>> {
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let compiler = Compiler::acquire().ok_or("glslang did not start")?;
    let source = ShaderSource::from(glsl);
    let input = ShaderInput::new(&source, ShaderStage::Compute, &options, None, None)?;
    Ok(compiler.create_shader(input)?.compile()?)
}

impl OwnPass for Edges {
    /// An image for the result, and one pass, which reads the picture and writes that.
    fn plan(&self, plan: &mut Plan, picture: &str, extent: Extent) {
        plan.picture(COLOR, extent);
        let touches = [(picture.to_owned(), Access::ComputeRead), (COLOR.to_owned(), Access::ComputeWrite)];
        plan.pass(NAME, touches);
    }

    fn build(&self, gpu: &Arc<Gpu>, resources: &mut Resources) -> Result<Box<dyn OwnFrame>> {
        let pipeline = ComputePipeline::new(gpu, &self.0, &[])?;
        Ok(Box::new(EdgesFrame { pipeline, color: resources.image(COLOR) }))
    }
}

struct EdgesFrame {
    pipeline: ComputePipeline,
    color: Image,
}

impl OwnFrame for EdgesFrame {
    fn record(&self, cmd: &mut Commands, picture: Edge<'_, Image>) -> Result<()> {
        let Extent { width, height } = self.color.description.extent;
        let pixels = u64::from(width) * u64::from(height);
        let traffic =
            Traffic { read_bytes: Some(16 * pixels), written_bytes: Some(16 * pixels), invocations: Some(pixels) };
        cmd.pass(NAME, traffic, |cmd| {
            // The technique says who touched its picture last; nobody has touched the pass's own in this frame.
            cmd.barriers([picture.to(Access::ComputeRead), self.color.discard(Access::ComputeWrite)]);
            let bound = [("picture", Bound::Storage(picture.resource)), ("edges", Bound::Storage(&self.color))];
            cmd.dispatch(&self.pipeline, &[], &bound, self.pipeline.groups([width, height, 1]))
        })
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.color, Access::ComputeWrite)
    }
}

fn main() -> Result<()> {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let [plain, own] = match &named[..] {
        [plain, own] => [plain, own].map(String::as_str),
        _ => ["plain.png", "own_pass.png"],
    };
    let technique = techniques::find("interleaved_deferred")?;
    let with_edges = WithPass { technique, pass: Arc::new(Edges::new()?) };
    let mut values = defaults(technique);
    set(technique, &mut values, "size", "320x180")?;
    let session = Session::open(&DeviceRequest::default(), scene::load("cornell", 1)?)?;
    for (technique, file) in [(technique, plain), (&with_edges, own)] {
        let renderer = session.renderer(technique, &values, &[], Submits::One)?;
        renderer.frame()?;
        write(Path::new(file), &renderer.picture()?, &WriteOptions::default())?;
        let passes: Vec<&str> = renderer.passes().iter().map(|pass| pass.name.as_str()).collect();
        println!("{file}: {}", passes.join(", "));
    }
    Ok(())
}

//! What the layer's contract and last-bit make of a shader whose numbers are known.

use crate::support;
use crate::support::pretending::Layer;
use crate::support::program::start;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::shader::{Binding, BindingKind, Shader, Side, Stage};
use quincunx::gpu::{Access, Bound, Buffer, Commands, DeviceRequest, Gpu, readback};
use quincunx::memory::kinds::Use;
use std::process::Command;

/// How many times each of the expressions stands in the shader: chance takes some.
const TIMES: usize = 16;

/// 1 + 2^-12, whose square is 1 + 2^-11 + 2^-24, and rounds to 1 + 2^-11; c is that with a minus.
const A: f32 = 1.0 + 1.0 / 4096.0;
const C: f32 = -(1.0 + 1.0 / 2048.0);
/// a * a + c where the product is not rounded.
const FUSED: f32 = 1.0 / 16_777_216.0;

/// An expression that the shader has again and again, and what may become of it.
struct Expression {
    /// `%r#` is its result; `%a`, `%c`, `%three` and `%zero` are numbers, none of them a constant.
    text: &'static str,
    /// What is `precise` of it.
    precise: &'static str,
    /// As it is written.
    value: f32,
    may_fuse: bool,
    may_move: bool,
}

const SUM: Expression = Expression {
    text: "%p# = OpFMul %float %a %a\n%r# = OpFAdd %float %p# %c",
    precise: "",
    value: 0.0,
    may_fuse: true,
    may_move: false,
};

const EXPRESSIONS: [Expression; 6] = [
    SUM,
    Expression {
        text: "%p# = OpFMul %float %a %a\nOpStore %local %p#\n%q# = OpLoad %float %local\n%r# = OpFAdd %float %c %q#",
        ..SUM
    },
    Expression { precise: "%p#", may_fuse: false, ..SUM },
    Expression { precise: "%r#", may_fuse: false, ..SUM },
    Expression { text: "%r# = OpFDiv %float %a %three", value: A / 3.0, may_fuse: false, may_move: true, ..SUM },
    Expression { text: "%r# = OpFDiv %float %zero %three", may_fuse: false, ..SUM },
];

/// The shader in SPIR-V's assembly language.
fn assembly() -> String {
    let (mut body, mut precise, mut constants) = (String::new(), String::new(), String::new());
    for index in 0..EXPRESSIONS.len() * TIMES {
        let expression = &EXPRESSIONS[index / TIMES];
        let numbered = |text: &str| text.replace('#', &index.to_string());
        if !expression.precise.is_empty() {
            precise += &numbered(&format!("OpDecorate {} NoContraction\n", expression.precise));
        }
        constants += &numbered("%u# = OpConstant %uint #\n");
        body += &numbered(expression.text);
        body += &numbered("\n%to# = OpAccessChain %pointer %out %u0 %u#\nOpStore %to# %r#\n");
    }
    format!(
        "OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main \"main\" %id %out
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %id BuiltIn GlobalInvocationId
OpDecorate %numbers ArrayStride 4
OpDecorate %block Block
OpMemberDecorate %block 0 Offset 0
OpDecorate %out DescriptorSet 0
OpDecorate %out Binding 0
{precise}%void = OpTypeVoid
%uint = OpTypeInt 32 0
%float = OpTypeFloat 32
%uvec3 = OpTypeVector %uint 3
%id_pointer = OpTypePointer Input %uvec3
%id = OpVariable %id_pointer Input
%numbers = OpTypeRuntimeArray %float
%block = OpTypeStruct %numbers
%out_pointer = OpTypePointer StorageBuffer %block
%out = OpVariable %out_pointer StorageBuffer
%pointer = OpTypePointer StorageBuffer %float
%local_pointer = OpTypePointer Function %float
%a_least = OpConstant %float {A}
%c_least = OpConstant %float {C}
%three_least = OpConstant %float 3
{constants}%function = OpTypeFunction %void
%main = OpFunction %void None %function
%begin = OpLabel
%local = OpVariable %local_pointer Function
%place = OpLoad %uvec3 %id
%first = OpCompositeExtract %uint %place 0
%zero = OpConvertUToF %float %first
%a = OpFAdd %float %a_least %zero
%c = OpFAdd %float %c_least %zero
%three = OpFAdd %float %three_least %zero
{body}OpReturn
OpFunctionEnd
"
    )
}

/// The shader's numbers, as this process's device computes them.
fn numbers() -> Option<Vec<f32>> {
    let folder = tempfile::tempdir().unwrap();
    let [text, binary] = ["a.spvasm", "a.spv"].map(|name| folder.path().join(name));
    std::fs::write(&text, assembly()).unwrap();
    let Ok(output) = Command::new("spirv-as").args(["--target-env", "vulkan1.3", "-o"]).args([&binary, &text]).output()
    else {
        support::skip("spirv-as is not installed (Debian and Ubuntu: apt-get install spirv-tools)");
        return None;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let shader = Shader {
        name: "test",
        variant: "COMP",
        stage: Stage::Compute,
        spirv: std::fs::read(&binary).unwrap().leak(),
        bindings: &[Binding { set: 0, binding: 0, name: "Numbers", kind: BindingKind::StorageBuffer, count: 1 }],
        params: None,
        constants: &[],
        workgroup: [Side::Fixed(1); 3],
    };
    let gpu = Gpu::open(&DeviceRequest::default()).unwrap();
    let pipeline = ComputePipeline::new(&gpu, &shader, &[]).unwrap();
    let bytes = 4 * (EXPRESSIONS.len() * TIMES) as u64;
    let flags = ash::vk::BufferUsageFlags::STORAGE_BUFFER | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let buffer = Buffer::new(&gpu, "test.numbers", "test", bytes, flags, Use::Device).unwrap();
    let mut cmd = Commands::begin(&gpu, "test", Submits::One).unwrap();
    cmd.barriers([buffer.discard(Access::ComputeWrite)]);
    cmd.dispatch(&pipeline, &[], &[("Numbers", Bound::Buffer(&buffer))], [1, 1, 1]).unwrap();
    cmd.finish().unwrap().run().unwrap();
    Some(bytemuck::pod_collect_to_vec(&readback::buffer(&gpu, &buffer, bytes, Access::ComputeWrite).unwrap()))
}

/// Names the file of the numbers to a process that this test starts of itself, since layers come with a process.
const CHILD: &str = "QUINCUNX_TEST_PRETEND_CHILD";

#[test]
fn fused_sums_and_last_bits_come_out_where_sources_leave_them_free() {
    if let Some(file) = std::env::var_os(CHILD) {
        let numbers = numbers().unwrap();
        std::fs::write(file, bytemuck::cast_slice(&numbers)).unwrap();
        return;
    }
    let (Some(layer), Some(plain)) = (Layer::built(), numbers()) else { return };
    let of = |numbers: &[f32], kind: usize| numbers[kind * TIMES..(kind + 1) * TIMES].to_vec();
    for (kind, expression) in EXPRESSIONS.iter().enumerate() {
        assert_eq!(of(&plain, kind), [expression.value; TIMES], "{}", expression.text);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("numbers");
    for seed in 1..=3 {
        let under = |modes: &str| -> Vec<f32> {
            // Its module below the crate, which the runner leaves out.
            let (_, module) = module_path!().split_once("::").unwrap();
            let this = format!("{module}::fused_sums_and_last_bits_come_out_where_sources_leave_them_free");
            // Not `current_exe`, which under a runner may be the C library's loader.
            let mut command = start(std::env::args_os().next().unwrap());
            command.args(["--exact", &this]).env(CHILD, &file).envs(layer.variables(modes));
            let output = command.output().unwrap();
            assert!(output.status.success(), "{modes}: {}", String::from_utf8_lossy(&output.stdout));
            bytemuck::pod_collect_to_vec(&std::fs::read(&file).unwrap())
        };
        let (contracted, moved) = (under(&format!("contract={seed}")), under(&format!("last-bit={seed}")));
        for (kind, Expression { text, precise, value, may_fuse, may_move }) in EXPRESSIONS.iter().enumerate() {
            let sums = of(&contracted, kind);
            let fused_count = sums.iter().filter(|sum| **sum == FUSED).count();
            let kept_count = sums.iter().filter(|sum| *sum == value).count();
            assert_eq!(fused_count + kept_count, TIMES, "{text} with precise {precise}: {sums:?}");
            assert_eq!((1..TIMES).contains(&fused_count), *may_fuse, "{text} with precise {precise}: {sums:?}");
            let steps = |number: &f32| i64::from(number.to_bits()) - i64::from(value.to_bits());
            let steps: Vec<i64> = of(&moved, kind).iter().map(steps).collect();
            assert!(steps.iter().all(|steps| steps.abs() == i64::from(*may_move)), "{text}: {steps:?}");
            assert_eq!(steps.contains(&1) && steps.contains(&-1), *may_move, "{text}: {steps:?}");
        }
    }
}

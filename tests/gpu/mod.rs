//! What a GPU would do and no software driver does, pretended: another clock, a rasteriser that leaves pixels out, rays that are
//! none.

mod loops;
mod lost;
mod marks;
mod multisample;
mod pipeline;
mod statistics;
mod validation;

use crate::support::difference::require_same;
use crate::support::program::Program;
use crate::support::shading_space::without_shading_space;
use crate::support::square::{matt, square};
use crate::support::watched::{Watched, values, watched_device};
use ash::vk;
use glam::{Vec3, Vec4};
use quincunx::caps::Caps;
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::timing::Clock;
use quincunx::scene::Material;
use quincunx::session::{Renderer, Session};
use quincunx::{scene, techniques};
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The driver's own functions behind those of the tests; what was found once stays, for tests that share a process.
#[derive(Clone, Copy)]
struct Own {
    submit: Option<vk::PFN_vkQueueSubmit2>,
    results: Option<vk::PFN_vkGetQueryPoolResults>,
}

static OWN: Mutex<Own> = Mutex::new(Own { submit: None, results: None });

fn own() -> Own {
    *OWN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A rasteriser that draws less than what a method needs is detected: by the picture, whatever counts and whatever
/// sums.
#[test]
fn samples_that_find_no_colour_fail_the_picture() {
    let request = DeviceRequest { hook: Some(without_shading_space), ..watched_device() };
    let watched = Watched::with_request(&request, scene::load("cornell", 1).unwrap());
    let common = [("size", "33x17"), ("spp", "2"), ("visibility", "repeat-frame"), ("shade-by", "fragment")];
    for more in
        [&[][..], &[("instrument", "off")], &[("accumulate", "2")], &[("aperture", "0.2"), ("reconstruct", "on")]]
    {
        let changes = [&common[..], more].concat();
        let renderer = watched.render("deep_shading", &changes);
        let error = renderer.picture().err().unwrap();
        assert_eq!(error.exit_code(), 1, "{more:?}: {error}");
        let text = error.to_string();
        for words in ["NaN", "a sample that finds no colour", "--conservative", "--conservative vertex"] {
            assert!(text.contains(words), "{more:?}: {text}");
        }
    }
    // Where draws are shaded in textures, these are drawn into nothing too.
    let textures = [&common[..2], &[("shading", "texture-space")]].concat();
    let error = watched.render("deep_shading", &textures).picture().err().unwrap();
    assert!(error.exit_code() == 1 && error.to_string().contains("texels were never shaded"), "{error}");
    let black = watched.render("deep_shading", &[&common[..], &[("conservative", "none")]].concat());
    assert_eq!(black.picture().unwrap().mean(), [0.0; 3]);
    assert!(black.measured_counters().unwrap()["samples_without_colour"] > 0.0);
}

const TICK_NS: u64 = 10;
const PASS_TICKS: u64 = 500;
const SUBMIT: Duration = Duration::from_millis(1);

/// A submit that takes its time, as a GPU's way there and back does.
unsafe extern "system" fn slow_submit(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo2<'_>,
    fence: vk::Fence,
) -> vk::Result {
    std::thread::sleep(SUBMIT);
    let submit = own().submit.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { submit(queue, count, submits, fence) }
}

/// The n-th query of a pool was written PASS_TICKS times n ticks after a start near the end of 36 bits; noise stands above them.
unsafe extern "system" fn set_results(
    device: vk::Device,
    pool: vk::QueryPool,
    first: u32,
    count: u32,
    bytes: usize,
    data: *mut c_void,
    stride: vk::DeviceSize,
    flags: vk::QueryResultFlags,
) -> vk::Result {
    let results = own().results.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    let result = unsafe { results(device, pool, first, count, bytes, data, stride, flags) };
    for query in 0..u64::from(count) {
        let ticks = ((1u64 << 36) - 700 + query * PASS_TICKS) & ((1 << 36) - 1);
        // SAFETY: the caller's array holds `count` numbers of eight bytes, which the driver has just written.
        unsafe { *data.cast::<u64>().add(query as usize) = ticks | query << 40 };
    }
    result
}

fn with_a_clock(name: &CStr, function: *const c_void) -> *const c_void {
    let mut own = OWN.lock().unwrap_or_else(PoisonError::into_inner);
    match name.to_bytes() {
        b"vkQueueSubmit2" => {
            // SAFETY: the pointer is the function of that name.
            own.submit = Some(unsafe { transmute::<*const c_void, vk::PFN_vkQueueSubmit2>(function) });
            slow_submit as vk::PFN_vkQueueSubmit2 as *const c_void
        }
        b"vkGetQueryPoolResults" => {
            // SAFETY: as above.
            own.results = Some(unsafe { transmute::<*const c_void, vk::PFN_vkGetQueryPoolResults>(function) });
            set_results as vk::PFN_vkGetQueryPoolResults as *const c_void
        }
        _ => function,
    }
}

fn as_a_processor(caps: &mut Caps) {
    caps.identity.device_type = "cpu".to_owned();
}

fn as_a_gpu(caps: &mut Caps) {
    caps.identity.device_type = "discrete-gpu".to_owned();
    caps.limits.timestamp_period_ns = TICK_NS as f32;
    caps.limits.timestamp_bits = 36;
}

/// On a GPU a pass's time is the one between its timestamps, and a frame's too: not that of the submits around them.
#[test]
fn times_of_a_gpu_are_those_of_its_own_clock() {
    let changes = values("deferred", &[("size", "33x17")]);
    for (pretense, clock) in [(as_a_processor as fn(&mut Caps), Clock::Wall), (as_a_gpu, Clock::Timestamps)] {
        let request = DeviceRequest { hook: Some(with_a_clock), pretense: Some(pretense), ..watched_device() };
        let session = Session::open(&request, scene::load("cornell", 1).unwrap()).unwrap();
        let technique = techniques::find("deferred").unwrap();
        for submits in [Submits::One, Submits::PerPass] {
            let renderer = session.renderer(technique, &changes, &[], submits).unwrap();
            assert_eq!(renderer.clock(), clock);
            let frame = renderer.frame().unwrap();
            let count = frame.passes.len() as u64;
            let submit_count = if submits == Submits::One { 1 } else { count };
            assert!(count > 1 && frame.wall_ns > submit_count * SUBMIT.as_nanos() as u64, "{clock:?} {submits:?}");
            let pass_ns = PASS_TICKS * TICK_NS;
            let expected = match (clock, submits) {
                (Clock::Wall, _) => frame.wall_ns,
                // From the first query to the last, or what lies between each pair of them.
                (Clock::Timestamps, Submits::One) => (2 * count - 1) * pass_ns,
                (Clock::Timestamps, Submits::PerPass) => count * pass_ns,
            };
            assert_eq!(frame.figure_ns(clock), expected, "{clock:?} {submits:?}");
            let of_pass = frame.passes[1].figure_ns(clock);
            match (clock, submits) {
                (Clock::Wall, Submits::One) => assert_eq!(of_pass, None),
                (Clock::Wall, Submits::PerPass) => assert!(of_pass > Some(SUBMIT.as_nanos() as u64)),
                (Clock::Timestamps, _) => assert_eq!(of_pass, Some(pass_ns)),
            }
        }
    }
}

/// Submits of frames, and the most command buffers in one.
static SUBMITTED: Mutex<[u32; 2]> = Mutex::new([0; 2]);

unsafe extern "system" fn counted_submit(
    queue: vk::Queue,
    count: u32,
    submits: *const vk::SubmitInfo2<'_>,
    fence: vk::Fence,
) -> vk::Result {
    // SAFETY: the caller's own structs.
    let buffers = unsafe { std::slice::from_raw_parts(submits, count as usize) };
    {
        let mut submitted = SUBMITTED.lock().unwrap_or_else(PoisonError::into_inner);
        submitted[0] += 1;
        submitted[1] = buffers.iter().map(|submit| submit.command_buffer_info_count).fold(submitted[1], u32::max);
    }
    let submit = own().submit.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { submit(queue, count, submits, fence) }
}

fn with_counted_submits(name: &CStr, function: *const c_void) -> *const c_void {
    if name.to_bytes() != b"vkQueueSubmit2" {
        return function;
    }
    // SAFETY: the pointer is the function of that name.
    let submit = unsafe { transmute::<*const c_void, vk::PFN_vkQueueSubmit2>(function) };
    OWN.lock().unwrap_or_else(PoisonError::into_inner).submit = Some(submit);
    counted_submit as vk::PFN_vkQueueSubmit2 as *const c_void
}

/// Submits and the most command buffers of one, since the last time.
fn submitted() -> [u32; 2] {
    std::mem::take(&mut *SUBMITTED.lock().unwrap_or_else(PoisonError::into_inner))
}

/// What a watchdog would end goes in bands: a submit each where the limit is shorter than any, all in one again where they are known to be
/// short enough; the same picture, counters and stages.
#[test]
fn frames_in_bands_are_the_same_frames() {
    let request = DeviceRequest { hook: Some(with_counted_submits), ..watched_device() };
    let watched = Watched::with_request(&request, scene::load("hall:triangles=8000", 1).unwrap());
    // Odd: the last band is a part of one.
    let size = [("size", "97x53")];
    let rays = [("direct-shadow", "ray")];
    let cases: [(&str, &[(&str, &str)]); 9] = [
        ("deferred", &rays),
        ("deferred", &[("cull", "tiled")]),
        ("interleaved_deferred", &[("split", "one-pass")]),
        ("interleaved_deferred", &[("split", "tile"), ("fuse", "on")]),
        ("interleaved_deferred", &[("split", "indirect"), ("direct-shadow", "ray")]),
        ("inferred_lighting", &[]),
        ("forward", &[]),
        ("deep_shading", &[("spp", "4"), ("aperture", "0.1"), ("reconstruct", "on")]),
        ("path_traced", &[("spp", "5"), ("medium", "0.05,0.01,0.3")]),
    ];
    for (technique, changes) in cases {
        let common = [&size[..], changes].concat();
        let whole = watched.render(technique, &common);
        let [of_whole, _] = submitted();
        let expected = whole.picture().unwrap().hash().unwrap();
        // Nodes of insertions that another was quicker than are counted too, and entries lie beside each other as threads are quick:
        // no two runs have as many.
        let by_chance = match technique {
            "deep_shading" => &["nodes_written", "light_evaluations", "light_evaluations_culled"][..],
            _ => &[],
        };
        let counted = |renderer: &Renderer| {
            let mut counters = renderer.measured_counters().unwrap();
            by_chance.iter().for_each(|name| _ = counters.remove(name));
            counters
        };
        let counters = counted(&whole);
        for submits in [Submits::One, Submits::PerPass] {
            let cut = watched
                .try_renderer(technique, &[&common[..], &[("submit-ms", "0.0001")]].concat(), &[], submits)
                .unwrap();
            for _ in 0..2 {
                submitted();
                cut.frame().unwrap();
                let [count, most] = submitted();
                assert_eq!(most, 1, "{technique} {changes:?} {submits:?}");
                let runs = cut.runs().1;
                // What is drawn is not cut, and forward only draws.
                let least = runs * cut.passes().len() as u32 + u32::from(technique != "forward");
                assert!(count >= least, "{technique} {changes:?}: {count} submits in {runs} runs");
                assert_eq!(cut.picture().unwrap().hash().unwrap(), expected, "{technique} {changes:?} {submits:?}");
                assert_eq!(counted(&cut), counters, "{technique} {changes:?} {submits:?}");
            }
        }
        let roomy =
            watched.try_renderer(technique, &[&common[..], &[("submit-ms", "1000000")]].concat(), &[], Submits::One);
        let roomy = roomy.unwrap();
        roomy.frame().unwrap();
        submitted();
        roomy.frame().unwrap();
        let [count, most] = submitted();
        // With several runs all but the first go together.
        let expected_count = roomy.runs().1.min(2);
        assert!(count == expected_count && most > 1, "{technique} {changes:?}: {count} submits of up to {most}");
        assert_eq!(roomy.picture().unwrap().hash().unwrap(), expected, "{technique} {changes:?}");
        assert!(of_whole > 0);
    }
}

/// Samples that go together end where their error is looked at, and are those that go one by one.
#[test]
fn samples_in_one_submit_are_the_same_samples() {
    let request = DeviceRequest { hook: Some(with_counted_submits), ..watched_device() };
    let watched = Watched::with_request(&request, scene::load("cornell", 1).unwrap());
    let common = [("size", "17x9"), ("spp", "400"), ("until-error", "0.06")];
    let path_traced = |limit| {
        let changes = [&common[..], &[("submit-ms", limit)]].concat();
        let renderer = watched.try_renderer("path_traced", &changes, &[], Submits::One).unwrap();
        submitted();
        renderer.frame().unwrap();
        let [count, _] = submitted();
        (renderer, count)
    };
    let ((alone, of_alone), (together, of_together)) = (path_traced("0"), path_traced("1000000"));
    let [count, all] = <[u32; 2]>::from(alone.runs());
    println!("{count} of {all} samples, in {of_alone} submits and in {of_together}");
    assert!((16..all).contains(&count), "{count}");
    assert_eq!(together.runs(), alone.runs());
    assert_eq!(together.picture().unwrap().hash().unwrap(), alone.picture().unwrap().hash().unwrap());
    // One by one; or those before 16, 24, 32, 48 and so on together, and the first one alone. Both read sums back at these.
    assert!(of_alone >= count && of_together < of_alone / 3, "{of_together} and {of_alone}");
}

/// What a stage binds is counted before a driver sees it: refused with the shader, both numbers and the limit's name, whatever the
/// technique; on a device with as many as GPUs have nothing is.
#[test]
fn stages_that_bind_more_than_the_device_has_are_refused() {
    let least = |caps: &mut Caps| caps.limits.max_storage_buffers_per_stage = 4;
    let mut refused = 0;
    for (pretense, most) in [(least as fn(&mut Caps), 4), (|caps| caps.limits.max_storage_buffers_per_stage = 31, 31)] {
        let request = DeviceRequest { pretense: Some(pretense), ..watched_device() };
        let watched = Watched::with_request(&request, scene::load("cornell", 1).unwrap());
        for technique in techniques::ALL {
            let Err(error) = watched.try_renderer(technique.name(), &[("size", "33x17")], &[], Submits::One) else {
                continue;
            };
            refused += 1;
            assert_eq!(error.exit_code(), 3, "{error}");
            let text = error.to_string();
            assert!(text.contains(&format!("bind {most} (maxPerStageDescriptorStorageBuffers)")), "{text}");
            assert_eq!(most, 4, "{text}");
        }
    }
    assert!(refused >= 4, "{refused}");
}

/// A surface that faces nowhere faces the eye; NaN would be lit as a compiler likes, and a ray from there look into every
/// node of the tree.
#[test]
fn surfaces_without_a_direction_face_the_eye() {
    // Its own normals do, of every pixel.
    let plain = square(matt(Vec4::ONE));
    let mut scene = plain.clone();
    scene.meshes[0].normals = vec![Vec3::ZERO; 4];
    scene.hash = "without normals".to_owned();
    let [watched, plain] = [scene, plain].map(Watched::with_scene);
    let common = [("size", "16x16"), ("rig", "always"), ("ambient", "0"), ("direct-shadow", "ray")];
    for (technique, more) in [
        ("forward", &[][..]),
        ("inferred_lighting", &[]),
        ("deferred", &[]),
        ("interleaved_deferred", &[("vpls", "16")]),
    ] {
        let [picture, facing] =
            [&watched, &plain].map(|watched| watched.picture(technique, &[&common[..], more].concat()));
        assert!(facing.mean()[0] > 0.01, "{technique}: {:?}", facing.mean());
        require_same(&watched.session.gpu, &picture, &facing, &technique);
    }
}

/// A ray that begins on a box's upper plane and goes down enters the box: the distance to it is a zero of either sign.
#[test]
fn rays_from_a_box_s_plane_go_into_it() {
    let mut scene = square(Material { emissive: Vec3::ONE, ..matt(Vec4::ONE) });
    // As high as the camera, where the box ends.
    for position in &mut scene.meshes[0].positions {
        position.z = position.y + 1.0;
    }
    scene.meshes[0].indices = [0, 1, 2, 0, 2, 3].repeat(40);
    let watched = Watched::with_scene(scene);
    let common = [("size", "16x16"), ("spp", "1"), ("rig", "none"), ("ambient", "1"), ("camera", "0")];
    for width in ["2", "4"] {
        let picture = watched.picture("path_traced", &[&common[..], &[("node-width", width)]].concat());
        // The uppermost part lies before the camera's near plane.
        let unseen = picture.pixels[2 * 16..].iter().filter(|pixel| pixel[0] == 0.0).count();
        assert_eq!(unseen, 0, "--node-width {width}");
    }
}

/// What is timed and what looks for mistakes goes without; the report says so.
#[test]
fn shaders_are_kept_within_buffers_where_nothing_is_measured() {
    let program = Program::new();
    let robust = |more: &[&str]| {
        let arguments = [&["render", "cornell", "--technique", "deferred", "--size", "16x16", "--json"], more].concat();
        program.run(&arguments).fine().json()["device"]["robust_buffer_access"].as_bool().unwrap()
    };
    assert!(robust(&[]));
    assert!(!robust(&["--profile"]) && !robust(&["--validate"]));
}

/// As many pixels as no viewport has: refused before anything is drawn, with what fits.
#[test]
fn a_shading_space_beyond_the_device_s_viewport_is_refused() {
    let program = Program::new();
    let devices = program.run(&["devices", "--json"]).fine().json();
    let most_px = devices["devices"][0]["caps"]["limits"]["max_viewport_px"][0].as_u64().unwrap();
    // A quarter of what the device draws, and a few pixels more.
    let width = most_px / 4 + 904;
    let (size, of_space) = (format!("{width}x8"), format!("{} x 160", 4 * width + 128));
    let tall = ["render", "power", "--technique", "deep_shading", "--size", &size, "--spp", "1"];
    let refused = [&tall[..], &["--shading-scale", "4", "--validate"]].concat();
    program.fails(&refused, 2, &["deep_shading: ", &of_space, "can be drawn", "--shading-scale", "fits"]);
}

//! The ledger against a counter of its own around vkAllocateMemory and vkFreeMemory, to the byte.

mod support;

use ash::vk;
use ash::vk::Handle;
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::commands::Submits;
use quincunx::memory::Strategy;
use quincunx::memory::ledger::Snapshot;
use quincunx::scene;
use quincunx::session::Session;
use std::collections::BTreeMap;
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::{Mutex, MutexGuard, PoisonError};
use support::watched::{Changes, Watched, both, watched_device};

/// What went past the hook. A hook is a plain function, so there is one counter in the process, and one test at a time.
struct Counter {
    allocate: Option<vk::PFN_vkAllocateMemory>,
    free: Option<vk::PFN_vkFreeMemory>,
    /// Bytes of each live allocation, by its handle.
    live: BTreeMap<u64, u64>,
    bytes_ever: u64,
    /// Allocations still to come before one is refused; None: none is.
    until_refusal: Option<u32>,
}

impl Counter {
    const NEW: Self = Self { allocate: None, free: None, live: BTreeMap::new(), bytes_ever: 0, until_refusal: None };

    /// Whether this allocation is the one to refuse.
    fn refuses(&mut self) -> bool {
        let refused = self.until_refusal == Some(0);
        self.until_refusal = self.until_refusal.and_then(|count| count.checked_sub(1));
        refused
    }
}

static COUNTER: Mutex<Counter> = Mutex::new(Counter::NEW);
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn counter() -> MutexGuard<'static, Counter> {
    COUNTER.lock().unwrap_or_else(PoisonError::into_inner)
}

fn live_bytes() -> u64 {
    counter().live.values().sum()
}

unsafe extern "system" fn counted_allocate(
    device: vk::Device,
    info: *const vk::MemoryAllocateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    memory: *mut vk::DeviceMemory,
) -> vk::Result {
    if counter().refuses() {
        return vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
    }
    let allocate = counter().allocate.expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    let result = unsafe { allocate(device, info, callbacks, memory) };
    if result == vk::Result::SUCCESS {
        // SAFETY: both pointers are valid in a call that succeeded.
        let (bytes, handle) = unsafe { ((*info).allocation_size, (*memory).as_raw()) };
        let mut counter = counter();
        counter.bytes_ever += bytes;
        assert!(counter.live.insert(handle, bytes).is_none(), "a live handle was given out again");
    }
    result
}

unsafe extern "system" fn counted_free(
    device: vk::Device,
    memory: vk::DeviceMemory,
    callbacks: *const vk::AllocationCallbacks<'_>,
) {
    let free = counter().free.expect("the hook stored it");
    if memory != vk::DeviceMemory::null() {
        assert!(counter().live.remove(&memory.as_raw()).is_some(), "freed what was not allocated");
    }
    // SAFETY: the driver's own function with the caller's arguments.
    unsafe { free(device, memory, callbacks) };
}

fn hook(name: &CStr, own: *const c_void) -> *const c_void {
    if own.is_null() {
        return own;
    }
    let mut counter = counter();
    match name.to_bytes() {
        b"vkAllocateMemory" => {
            // SAFETY: the pointer is the function of that name.
            counter.allocate = Some(unsafe { transmute::<*const c_void, vk::PFN_vkAllocateMemory>(own) });
            counted_allocate as vk::PFN_vkAllocateMemory as *const c_void
        }
        b"vkFreeMemory" => {
            // SAFETY: as above.
            counter.free = Some(unsafe { transmute::<*const c_void, vk::PFN_vkFreeMemory>(own) });
            counted_free as vk::PFN_vkFreeMemory as *const c_void
        }
        _ => own,
    }
}

/// Runs `test` on a counted device and requires that everything is given back at its end.
fn counted(strategy: Strategy, spec: &str, test: impl FnOnce(&Watched)) {
    let _one = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    *counter() = Counter::NEW;
    let request = DeviceRequest { strategy, hook: Some(hook), ..watched_device() };
    let watched = Watched::with_request(&request, scene::load(spec, 1).unwrap());
    test(&watched);
    drop(watched);
    assert_eq!(live_bytes(), 0, "bytes that nobody gave back");
    assert!(counter().bytes_ever > 0, "the hook saw nothing");
}

fn require_ledger_as_counted(snapshot: &Snapshot, what: &str) {
    assert_eq!(snapshot.memory_block_bytes, live_bytes(), "{what}: in memory blocks");
    assert_eq!(snapshot.requested_bytes_ever, counter().bytes_ever, "{what}: ever asked for");
    assert!(snapshot.asked_bytes() <= snapshot.bound_bytes(), "{what}: bound is asked for, and padding");
    assert!(snapshot.bound_bytes() <= snapshot.memory_block_bytes, "{what}: resources lie in memory blocks");
    assert!(snapshot.bound_bytes() <= snapshot.peak_bytes, "{what}: now is not above the peak");
}

#[test]
fn the_ledger_counts_what_the_driver_was_asked_for() {
    for strategy in [Strategy::Linear, Strategy::Dedicated] {
        counted(strategy, "cornell", |watched| {
            let memory = &watched.session.gpu.memory;
            require_ledger_as_counted(&memory.snapshot(), "the scene");
            let changes = [("size", "161x91"), ("vpls", "64")];
            let first = watched.render_stages("interleaved_deferred", &changes, &["split.normal"]);
            require_ledger_as_counted(&memory.snapshot(), "a renderer");
            let second = watched.render("deferred", &[("size", "640x360"), ("direct-shadow", "ray")]);
            require_ledger_as_counted(&memory.snapshot(), "a second renderer");
            second.picture().unwrap();
            first.aov("split.normal").unwrap();
            require_ledger_as_counted(&memory.snapshot(), "after reading back");
            let held = memory.snapshot().bound_bytes();
            drop(first);
            require_ledger_as_counted(&memory.snapshot(), "the second renderer alone");
            assert!(memory.snapshot().bound_bytes() < held);
            drop(second);
            require_ledger_as_counted(&memory.snapshot(), "the scene again");
        });
    }
}

#[test]
fn a_memory_block_for_each_resource_holds_what_the_driver_requires() {
    counted(Strategy::Dedicated, "cornell", |watched| {
        let _renderer = watched.render("interleaved_deferred", &[("size", "161x91"), ("vpls", "64")]);
        let snapshot = watched.session.gpu.memory.snapshot();
        assert_eq!(snapshot.memory_block_bytes, snapshot.bound_bytes());
        assert_eq!(counter().live.len(), snapshot.resources.len());
        assert!(snapshot.resources.iter().all(|entry| entry.offset == 0));
    });
}

#[test]
fn resources_in_shared_memory_blocks_do_not_overlap() {
    counted(Strategy::Linear, "hall:triangles=8000", |watched| {
        let _first = watched.render("interleaved_deferred", &[("size", "321x181"), ("vpls", "64")]);
        let _second = watched.render("deferred", &[("size", "161x91"), ("cull", "tiled")]);
        let mut entries = watched.session.gpu.memory.snapshot().resources;
        entries.sort_by_key(|entry| (entry.memory_block, entry.offset));
        for pair in entries.windows(2) {
            let apart = pair[0].memory_block != pair[1].memory_block;
            let behind = pair[0].offset + pair[0].bound_bytes <= pair[1].offset;
            assert!(apart || behind, "{} and {} share bytes", pair[0].name, pair[1].name);
        }
    });
}

/// The plan is arithmetic, the ledger is what was made: the same bytes, name by name.
#[test]
fn what_is_planned_is_what_is_made() {
    let settings: &[(&str, &str, Changes<'_>)] = &[
        ("cornell", "deferred", &[("size", "160x90")]),
        ("cornell", "deferred", &[("size", "161x91"), ("position", "depth"), ("cull", "tiled")]),
        ("cornell", "deferred", &[("size", "161x91"), ("position", "float"), ("direct-shadow", "ray")]),
        ("lamps:objects=8,lights=40", "deferred", &[("size", "97x53"), ("position", "half"), ("cull", "tiled")]),
        ("cornell", "interleaved_deferred", &[("size", "160x90"), ("vpls", "64")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("pattern", "5x7"), ("position", "float")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "none"), ("position", "depth")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "branch"), ("filter", "gauss-fast")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "subsample"), ("cull", "tiled")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "indirect"), ("pattern", "5x7")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "remap"), ("position", "half")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("filter", "none"), ("direct", "none")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "stencil"), ("position", "depth")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "depth"), ("filter", "gauss-fast")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("storage", "image"), ("position", "float")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "two-pass"), ("block", "24x10")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "two-pass"), ("storage", "image")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "tile"), ("pattern", "5x7")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "layered"), ("position", "depth")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "fragment"), ("position", "half")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("split", "fragment"), ("fragment-passes", "1")]),
        (
            "hall:triangles=8000",
            "interleaved_deferred",
            &[("size", "97x53"), ("direct", "interleaved"), ("vpls", "64")],
        ),
        ("hall:triangles=8000", "deferred", &[("size", "97x53"), ("direct-shadow", "ray")]),
    ];
    for (spec, technique, changes) in settings {
        counted(Strategy::Linear, spec, |watched| {
            let renderer = watched.render(technique, changes);
            let scene_plan = watched.session.stats.plan();
            let snapshot = watched.session.gpu.memory.snapshot();
            let planned: BTreeMap<&str, (&str, u64)> = scene_plan
                .resources
                .iter()
                .chain(&renderer.plan.resources)
                .map(|planned| (planned.name.as_str(), (planned.group, planned.bytes())))
                .collect();
            let made: BTreeMap<&str, (&str, u64)> = snapshot
                .resources
                .iter()
                .map(|entry| (entry.name.as_str(), (entry.group.as_str(), entry.bytes)))
                .collect();
            assert_eq!(planned, made, "{technique} of {spec} with {changes:?}");
            assert_eq!(scene_plan.bytes() + renderer.plan.bytes(), snapshot.asked_bytes());
        });
    }
}

#[test]
fn a_refused_request_leaves_nothing_behind() {
    counted(Strategy::Linear, "cornell", |watched| {
        let before = watched.session.gpu.memory.snapshot();
        let refused = watched.try_renderer("interleaved_deferred", &[("vpls", "8")], &[], Submits::One);
        assert_eq!(refused.err().unwrap().exit_code(), 2);
        let after = watched.session.gpu.memory.snapshot();
        assert_eq!(after.bound_bytes(), before.bound_bytes());
        require_ledger_as_counted(&after, "after a refusal");
    });
}

/// The driver refuses each allocation once: an error that names the resource, and nothing stays behind.
#[test]
fn memory_that_is_refused_leaves_nothing_behind() {
    counted(Strategy::Dedicated, "cornell", |watched| {
        let memory = &watched.session.gpu.memory;
        let before = memory.snapshot();
        let common = [("size", "33x17"), ("vpls", "16"), ("filter", "gauss-fast"), ("direct-shadow", "ray")];
        for split in ["one-pass", "two-pass", "fragment", "stencil"] {
            let changes = both(&common, &[("split", split)]);
            for refused_at in 0.. {
                counter().until_refusal = Some(refused_at);
                let made = watched.try_renderer("interleaved_deferred", &changes, &[], Submits::One);
                let refused = counter().until_refusal.is_none();
                counter().until_refusal = None;
                let Err(error) = made else {
                    assert!(!refused, "{split}: allocation {refused_at} was refused, and nobody noticed");
                    assert!(refused_at > 20, "{split}: only {refused_at} allocations");
                    break;
                };
                assert_eq!(error.exit_code(), 4, "{error}");
                assert!(error.message().contains("allocating "), "{error}");
                let after = memory.snapshot();
                assert_eq!(after.bound_bytes(), before.bound_bytes(), "{split}, refused at {refused_at}: {error}");
                require_ledger_as_counted(&after, "after a refusal");
            }
        }
    });
}

#[test]
fn a_scene_that_does_not_fit_is_refused() {
    let _one = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let scene = scene::load("hall:triangles=8000", 1).unwrap();
    for refused_at in [0, 1, 2, 5, 9] {
        *counter() = Counter { until_refusal: Some(refused_at), ..Counter::NEW };
        let request = DeviceRequest { strategy: Strategy::Dedicated, hook: Some(hook), ..watched_device() };
        let error = Session::open(&request, scene.clone()).err().expect("the driver refused");
        assert_eq!(error.exit_code(), 4, "{error}");
        assert_eq!(live_bytes(), 0, "refused at {refused_at}: {error}");
    }
}

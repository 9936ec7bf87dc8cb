//! The ledger against a counter of its own around vkAllocateMemory and vkFreeMemory, to the byte.

mod budget;
mod study;
mod tiling;
mod touched;

use crate::support::choices::{words, words_but};
use crate::support::counted::{begin, counted, counted_device, counter, live_bytes};
use crate::support::watched::{Changes, Watched, both};
use ash::vk;
use quincunx::choice::Choice;
use quincunx::error::Result;
use quincunx::gpu::commands::Submits;
use quincunx::memory::kinds::Use;
use quincunx::memory::ledger::Snapshot;
use quincunx::memory::{Allocation, Memory, Request, Strategy, Tiling};
use quincunx::scene;
use quincunx::session::Session;
use std::collections::BTreeMap;
use std::sync::Arc;

fn require_ledger_as_counted(snapshot: &Snapshot, what: &str) {
    assert_eq!(snapshot.memory_block_bytes, live_bytes(), "{what}: in memory blocks");
    assert_eq!(snapshot.requested_bytes_ever, counter().bytes_ever, "{what}: ever asked for");
    assert!(snapshot.asked_bytes() <= snapshot.bound_bytes(), "{what}: bound is asked for, and padding");
    assert!(snapshot.held_bytes() <= snapshot.memory_block_bytes, "{what}: resources lie in memory blocks");
    assert!(snapshot.held_bytes() <= snapshot.peak_bytes, "{what}: now is not above the peak");
    let in_blocks: u64 = snapshot.blocks.iter().map(|block| block.bytes).sum();
    assert_eq!(in_blocks, snapshot.memory_block_bytes, "{what}: block by block");
    for block in &snapshot.blocks {
        assert_eq!(block.used_bytes + block.free_bytes, block.bytes, "{what}: {block:?}");
        assert!(block.used_bytes > 0 && block.largest_free_bytes <= block.free_bytes, "{what}: {block:?}");
        assert!((0.0..=1.0).contains(&block.fragmentation), "{what}: {block:?}");
    }
}

#[test]
fn the_ledger_counts_what_the_driver_was_asked_for() {
    for &strategy in Strategy::ALL {
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
        let changes = [("size", "161x91"), ("vpls", "64"), ("alias", "off")];
        let _renderer = watched.render("interleaved_deferred", &changes);
        let snapshot = watched.session.gpu.memory.snapshot();
        assert_eq!(snapshot.memory_block_bytes, snapshot.bound_bytes());
        assert_eq!(counter().live.len(), snapshot.resources.len());
        assert!(snapshot.resources.iter().all(|entry| entry.offset == 0));
    });
}

#[test]
fn resources_in_shared_memory_blocks_do_not_overlap() {
    for strategy in Strategy::ALL.iter().copied().filter(|strategy| strategy.shares_blocks()) {
        counted(strategy, "hall:triangles=8000", |watched| {
            let alone = ("alias", "off");
            let first = watched.render("interleaved_deferred", &[("size", "321x181"), ("vpls", "64"), alone]);
            let _second = watched.render("deferred", &[("size", "161x91"), ("cull", "tiled"), alone]);
            drop(first);
            let _third = watched.render("interleaved_deferred", &[("size", "161x91"), ("vpls", "64"), alone]);
            let mut entries = watched.session.gpu.memory.snapshot().resources;
            entries.sort_by_key(|entry| (entry.memory_block, entry.offset));
            for pair in entries.windows(2) {
                let apart = pair[0].memory_block != pair[1].memory_block;
                let behind = pair[0].offset + pair[0].bound_bytes <= pair[1].offset;
                assert!(apart || behind, "{} and {} share bytes", pair[0].name, pair[1].name);
            }
        });
    }
}

/// Two resources of one renderer lie in the same bytes only where no pass sees both, and what sharing saves is a third.
#[test]
fn resources_that_share_bytes_never_live_in_the_same_pass() {
    let settings: [(&str, Changes<'_>); 4] = [
        ("deferred", &[("cull", "tiled")]),
        ("interleaved_deferred", &[]),
        ("interleaved_deferred", &[("filter", "gauss-fast"), ("pattern", "5x7"), ("direct-shadow", "ray")]),
        ("interleaved_deferred", &[("split", "subsample"), ("position", "depth")]),
    ];
    for (technique, changes) in settings {
        for alias in words_but(technique, "alias", &["off"]) {
            counted(Strategy::Linear, "cornell", |watched| {
                let size = [("size", "321x181"), ("vpls", "64"), ("alias", alias)];
                let keys = if technique == "deferred" { &[size[0], size[2]][..] } else { &size };
                let renderer = watched.render(technique, &both(changes, keys));
                let plan = &renderer.plan;
                let lifetime = |name: &str| {
                    let index = plan.resources.iter().position(|planned| planned.name == name).unwrap();
                    plan.lifetime(index).unwrap()
                };
                let snapshot = watched.session.gpu.memory.snapshot();
                let parts: Vec<_> = snapshot.resources.iter().filter(|entry| entry.arena.is_some()).collect();
                let mut sharing_count = 0;
                for (index, one) in parts.iter().enumerate() {
                    for other in &parts[..index] {
                        let bytes = one.memory_block == other.memory_block
                            && one.offset < other.offset + other.bound_bytes
                            && other.offset < one.offset + one.bound_bytes;
                        let (a, b) = (lifetime(&one.name), lifetime(&other.name));
                        assert!(!bytes || a.last < b.first || b.last < a.first, "{} and {}", one.name, other.name);
                        sharing_count += usize::from(bytes);
                    }
                }
                // Where images and buffers have memory types of their own, little may be left to share.
                let must_share = watched.session.gpu.caps.identity.is_software() || changes.is_empty();
                assert!(sharing_count > 0 || !must_share, "{technique} {changes:?}: nothing is shared");
                assert_eq!(snapshot.aliased_bytes(), renderer.sharing.aliased_bytes());
                let transient: u64 = parts.iter().map(|part| part.bound_bytes).sum();
                let saved = snapshot.aliased_bytes() as f64 / transient as f64;
                // Other devices round other resources up: an H200 saves 26 % of the bytes that are bound.
                let of_defaults = if watched.session.gpu.caps.identity.is_software() { 1.0 / 3.0 } else { 0.25 };
                let least = if changes.is_empty() { of_defaults } else { 0.0 };
                assert!(
                    saved > least || !must_share,
                    "{technique} {changes:?}: {saved} of the transient bytes are saved"
                );
            });
        }
    }
}

/// The peak is of bytes that are held: without sharing of all of them in every pass, with it of no more than the arenas have.
#[test]
fn the_peak_is_what_stays_bound() {
    for alias in words("interleaved_deferred", "alias") {
        counted(Strategy::Linear, "cornell", |watched| {
            let changes = [("size", "321x181"), ("vpls", "64"), ("alias", alias)];
            let renderer = watched.render("interleaved_deferred", &changes);
            let snapshot = watched.session.gpu.memory.snapshot();
            let memory = watched.session.memory_table(&renderer, Some(&snapshot)).unwrap().json();
            let bytes = |key: &str| memory[key].as_u64().unwrap();
            assert_eq!(bytes("allocated_bytes"), snapshot.bound_bytes(), "{alias}");
            assert_eq!(bytes("aliased_bytes"), snapshot.aliased_bytes(), "{alias}");
            let held = bytes("allocated_bytes") - bytes("aliased_bytes");
            assert!(bytes("peak_bytes") <= held, "{alias}: {memory:#}");
            assert_eq!(bytes("peak_bytes") == bytes("allocated_bytes"), alias == "off", "{alias}");
        });
    }
}

/// Renderers that overlap in time leave holes: TLSF takes them again, so that the same frames need fewer bytes.
#[test]
fn what_returns_to_a_tlsf_block_is_taken_again() {
    let [linear, tlsf] = [Strategy::Linear, Strategy::Tlsf].map(|strategy| {
        let mut most = 0;
        counted(strategy, "cornell", |watched| {
            let changes = [("size", "320x180"), ("alias", "off")];
            let mut held = watched.render("deferred", &changes);
            for _ in 0..8 {
                let next = watched.render("deferred", &changes);
                most = most.max(live_bytes());
                held = next;
            }
            drop(held);
        });
        most
    });
    assert!(tlsf < linear, "{tlsf} bytes, linear ranges {linear}");
}

/// The plan is arithmetic, the ledger is what was made: the same bytes, name by name.
#[test]
fn what_is_planned_is_what_is_made() {
    let settings: &[(&str, &str, Changes<'_>)] = &[
        ("cornell", "deferred", &[("size", "160x90")]),
        ("cornell", "deferred", &[("size", "161x91"), ("position", "depth"), ("cull", "tiled")]),
        ("cornell", "deferred", &[("size", "161x91"), ("position", "float"), ("direct-shadow", "ray")]),
        ("lamps:objects=8,lights=40", "deferred", &[("size", "97x53"), ("position", "half"), ("cull", "tiled")]),
        ("cornell", "path_traced", &[("size", "97x53"), ("spp", "2"), ("emissive", "on")]),
        ("lamps:objects=8,lights=40", "path_traced", &[("size", "161x91"), ("spp", "1"), ("texture-limit", "64")]),
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
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("fuse", "on"), ("storage", "image")]),
        ("cornell", "interleaved_deferred", &[("size", "161x91"), ("fuse", "on"), ("split", "remap")]),
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

/// The driver refuses each allocation once: an error that names the resource, and nothing stays behind. An arena with
/// its parts stands beside the renderer.
#[test]
fn memory_that_is_refused_leaves_nothing_behind() {
    let changes = [("size", "33x17"), ("vpls", "16"), ("filter", "gauss-fast"), ("direct-shadow", "ray")];
    for (strategy, alias) in Strategy::ALL.iter().flat_map(|&strategy| ["off", "greedy"].map(|alias| (strategy, alias)))
    {
        let changes = both(&changes, &[("alias", alias)]);
        counted(strategy, "cornell", |watched| {
            let memory = &watched.session.gpu.memory;
            let before = memory.snapshot();
            for refused_at in 0.. {
                counter().until_refusal = Some(refused_at);
                let made = arena_of_two(memory).and_then(|arena| {
                    Ok((arena, watched.try_renderer("interleaved_deferred", &changes, &[], Submits::One)?))
                });
                let refused = counter().until_refusal.is_none();
                counter().until_refusal = None;
                let Err(error) = made else {
                    assert!(!refused, "allocation {refused_at} was refused, and nobody noticed");
                    let least = match (strategy, alias) {
                        (Strategy::Dedicated, "off") => 21,
                        (Strategy::Dedicated, _) => 9,
                        _ => 2,
                    };
                    assert!(refused_at >= least, "{strategy:?}: only {refused_at} allocations");
                    break;
                };
                assert!(refused, "{strategy:?}: nothing was refused, and it failed: {error}");
                assert_eq!(error.exit_code(), 4, "{error}");
                assert!(error.message().contains("allocating "), "{error}");
                let after = memory.snapshot();
                assert_eq!(after.held_bytes(), before.held_bytes(), "refused at {refused_at}: {error}");
                require_ledger_as_counted(&after, "after a refusal");
            }
        });
    }
}

/// The same of methods with images, look-up textures and resources between two passes.
#[test]
fn memory_that_is_refused_on_any_method_leaves_nothing_behind() {
    counted(Strategy::Dedicated, "cornell", |watched| {
        let before = watched.session.gpu.memory.snapshot();
        for split in ["two-pass", "layered", "fragment", "stencil"] {
            let changes = [("size", "33x17"), ("vpls", "16"), ("split", split), ("alias", "off")];
            for refused_at in 0.. {
                counter().until_refusal = Some(refused_at);
                let made = watched.try_renderer("interleaved_deferred", &changes, &[], Submits::One);
                let refused = counter().until_refusal.is_none();
                counter().until_refusal = None;
                let Err(error) = made else {
                    assert!(!refused, "{split}: allocation {refused_at} was refused, and nobody noticed");
                    assert!(refused_at > 15, "{split}: only {refused_at} allocations");
                    break;
                };
                assert_eq!((error.exit_code(), refused), (4, true), "{split}: {error}");
                let after = watched.session.gpu.memory.snapshot();
                assert_eq!(after.held_bytes(), before.held_bytes(), "{split}, refused at {refused_at}: {error}");
                require_ledger_as_counted(&after, "after a refusal");
            }
        }
    });
}

#[test]
fn a_scene_that_does_not_fit_is_refused() {
    let scene = scene::load("hall:triangles=8000", 1).unwrap();
    for &strategy in Strategy::ALL {
        for refused_at in [0, 1, 2, 5, 9] {
            let _one = begin();
            counter().until_refusal = Some(refused_at);
            let opened = Session::open(&counted_device(strategy), scene.clone()).map(drop);
            let refused = counter().until_refusal.is_none();
            match opened {
                Ok(()) => assert!(!refused, "allocation {refused_at} was refused, and nobody noticed"),
                Err(error) => assert_eq!((error.exit_code(), refused), (4, true), "{error}"),
            }
            assert_eq!(live_bytes(), 0, "refused at {refused_at}");
        }
    }
}

/// 64 KiB in which two parts of 48 KiB lie, 16 KiB of them shared twice.
fn arena_of_two(memory: &Arc<Memory>) -> Result<[Allocation; 2]> {
    let arena = memory.arena("test.arena", "test", 64 << 10, 4096, !0, Use::Device)?;
    let part = |name, offset| {
        let requirements = vk::MemoryRequirements { size: 48 << 10, alignment: 4096, memory_type_bits: !0 };
        let (usage, tiling) = (Use::Device, Tiling::Optimal);
        arena.part(&Request { name, group: "test", bytes: 48_000, requirements, usage, tiling }, offset)
    };
    Ok([part("test.first", 0)?, part("test.second", 16 << 10)?])
}

#[test]
fn an_arena_counts_once_and_returns_with_its_last_part() {
    for &strategy in Strategy::ALL {
        counted(strategy, "cornell", |watched| {
            let memory = &watched.session.gpu.memory;
            let before = memory.snapshot();
            let live_before = live_bytes();
            let [first, second] = arena_of_two(memory).unwrap();
            let with = memory.snapshot();
            require_ledger_as_counted(&with, "with an arena");
            assert_eq!(live_bytes() - live_before, 64 << 10, "a memory block of its own");
            assert_eq!(with.held_bytes() - before.held_bytes(), 64 << 10);
            assert_eq!(with.bound_bytes() - before.bound_bytes(), 96 << 10);
            assert_eq!((before.aliased_bytes(), with.aliased_bytes()), (0, 32 << 10));
            let parts = &with.resources[before.resources.len()..];
            assert_eq!(parts[0].memory_block, parts[1].memory_block);
            assert!(
                with.resources[..before.resources.len()].iter().all(|one| one.memory_block != parts[0].memory_block)
            );
            assert_eq!((parts[0].offset, parts[1].offset, first.offset, second.offset), (0, 16 << 10, 0, 16 << 10));
            assert_eq!((first.handle, parts[0].bytes, parts[0].bound_bytes), (second.handle, 48_000, 48 << 10));
            drop(first);
            assert_eq!(live_bytes() - live_before, 64 << 10, "the second part keeps it");
            assert_eq!(memory.snapshot().aliased_bytes(), 0);
            drop(second);
            assert_eq!(live_bytes(), live_before);
            require_ledger_as_counted(&memory.snapshot(), "without the arena");
        });
    }
}

/// The host sees a part where it lies, and two parts in the same bytes are the same bytes.
#[test]
fn parts_of_a_mapped_arena_share_what_the_host_wrote() {
    counted(Strategy::Linear, "cornell", |watched| {
        let memory = &watched.session.gpu.memory;
        let arena = memory.arena("test.arena", "test", 8192, 256, !0, Use::Upload).unwrap();
        let requirements = vk::MemoryRequirements { size: 4096, alignment: 256, memory_type_bits: !0 };
        let (usage, tiling) = (Use::Upload, Tiling::Linear);
        let request = Request { name: "test.part", group: "test", bytes: 4096, requirements, usage, tiling };
        let [first, second] = [0, 1024].map(|offset| arena.part(&request, offset).unwrap());
        drop(arena);
        let [first, second] = [&first, &second].map(|part| part.mapped.expect("it is for upload"));
        // SAFETY: both parts are alive, mapped and 4096 bytes long; nobody else writes them.
        unsafe {
            first.add(1024 + 7).write(42);
            assert_eq!(second.add(7).read(), 42);
        }
    });
}

#[test]
fn a_part_in_a_memory_type_that_the_driver_forbids_is_refused() {
    counted(Strategy::Linear, "cornell", |watched| {
        let arena = watched.session.gpu.memory.arena("test.arena", "test", 8192, 256, !0, Use::Device).unwrap();
        let requirements = vk::MemoryRequirements { size: 4096, alignment: 256, memory_type_bits: 0 };
        let (usage, tiling) = (Use::Device, Tiling::Linear);
        let request = Request { name: "test.part", group: "test", bytes: 4096, requirements, usage, tiling };
        let error = arena.part(&request, 0).err().expect("no type is allowed");
        assert!(error.exit_code() == 4 && error.message().contains("test.part"), "{error}");
    });
}

/// Where resources lie changes no picture.
#[test]
fn every_strategy_gives_the_same_picture() {
    for (technique, changes) in
        [("interleaved_deferred", &[("size", "97x53"), ("vpls", "64")][..]), ("deferred", &[("size", "97x53")])]
    {
        let hash =
            |strategy: &Strategy| Watched::with_strategy(*strategy, "hall:triangles=8000").hash(technique, changes);
        let hashes: Vec<_> = Strategy::ALL.iter().map(hash).collect();
        assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{technique}: {hashes:?}");
    }
}

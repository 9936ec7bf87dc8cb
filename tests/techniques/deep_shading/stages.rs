//! Figures 2 and 3 as pictures: where samples are shaded, conservative depth (B) and addresses of colours (C).

use super::{DEEP, FRAGMENT};
use crate::support::boxes::{camera, panel, rectangle};
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::scene::{Projection, Scene};
use std::collections::BTreeMap;

const SIZE: (&str, &str) = ("size", "64x36");
const ZMAX: &str = "lists.zmax";
const ADDRESSES: &str = "lists.addresses";
const SHIFTS: &str = "visibility.spids.shifts";
const SPIDS: &str = "visibility.spids";

/// A wall 4 m away in the lower half of the picture, `aside` metres to the right, and 2 m away a panel before the left half of all
/// of it.
fn steps(aside: f32) -> Scene {
    let name = format!("steps {aside}");
    let mut scene = Scene { name: name.clone(), hash: name, ..Scene::default() };
    let grey = || panel(Vec3::splat(0.25));
    rectangle(&mut scene, vec3(aside, -20.0, -4.0), 40.0 * Vec3::X, 20.0 * Vec3::Y, grey());
    rectangle(&mut scene, vec3(-10.0, 0.0, -2.0), 10.0 * Vec3::X, 40.0 * Vec3::Y, grey());
    scene.cameras.push(camera(Vec3::ZERO, -Vec3::Z, 0.9));
    scene
}

/// Depth is reversed, near over distance: of what is seen at a pixel of shading space the farthest, 0 where that is nothing.
#[test]
fn zmax_is_the_farthest_that_is_seen() {
    let watched = Watched::with_scene(steps(0.0));
    let Projection::Perspective { z_near, .. } = watched.session.scene.cameras[0].projection else { unreachable!() };
    let zmax = |lens: Changes<'_>| {
        let common = [SIZE, FRAGMENT, ("zmax", "on"), ("spp", "4"), ("tuples", "4")];
        watched.floats(&watched.render_stages(DEEP, &both(&common, lens), &[ZMAX]), ZMAX)
    };
    let (near, far) = (z_near / 2.0, z_near / 4.0);
    let is = |found: f32, depth: f32| (found - depth).abs() <= 1e-5 * depth;
    for (at, found) in zmax(&[]).into_iter().enumerate() {
        let expected = match (at % 64 < 32, at / 64 < 18) {
            (true, _) => near,
            (false, true) => 0.0,
            (false, false) => far,
        };
        assert!(is(found, expected), "{} {}: {found}, not {expected}", at % 64, at / 64);
    }
    // The lens sees the wall behind the panel's rim; where the panel alone is in reach it is as before.
    let blurred = zmax(&[("spp", "32"), ("tuples", "32"), ("aperture", "1.2"), ("focus", "2")]);
    let of_row = |y: usize| &blurred[64 * y..64 * (y + 1)];
    assert!(of_row(30)[..24].iter().all(|found| is(*found, near)), "{:?}", of_row(30));
    assert!(of_row(30)[30..].iter().all(|found| is(*found, far)), "{:?}", of_row(30));
}

/// Where nothing is blurred samples lie in their own pixels; a wall that passes is shaded where it is halfway.
#[test]
fn shading_points_are_shifted_by_half_of_the_way() {
    let shifts = |scene| {
        let watched = Watched::with_scene(scene);
        let changes = [SIZE, ("spp", "1"), ("tuples", "16")];
        let renderer = watched.render_stages(DEEP, &changes, &[SHIFTS, SPIDS]);
        let seen = watched.integers(&renderer, SPIDS).into_iter().map(|id| id != u32::MAX);
        seen.zip(watched.rgb(&renderer, SHIFTS)).collect::<Vec<_>>()
    };
    assert!(shifts(steps(0.0)).iter().all(|(_, shift)| *shift == [0.0; 3]));
    // A wall moves by 0.8 m at a distance of 4, half of it on each side of the middle; pixels count from their middles.
    let most = 18.0 / (0.5 * 0.9f32).tan() / 4.0 * 0.4;
    let moved = shifts(steps(0.0).closing_as(steps(0.8)).unwrap());
    let of_wall = |at: usize| at % 64 >= 48 && at / 64 >= 18;
    let seen: Vec<f32> = (0..moved.len()).filter(|at| of_wall(*at) && moved[*at].0).map(|at| moved[at].1[0]).collect();
    let (least, greatest) = seen.iter().fold((0f32, 0f32), |(low, high), x| (low.min(*x), high.max(*x)));
    println!("{} samples of the wall are shifted from {least} to {greatest} pixels, of {most}", seen.len());
    assert!(seen.len() > 250 && greatest > 0.7 * most && least < -0.7 * most);
    assert!(greatest <= most.ceil() && least >= -most.ceil());
    assert!(moved.iter().all(|(_, [_, y, z])| [*y, *z] == [0.0; 2]));
}

/// An address is shared by samples of one triangle alone, and by none where each has a pixel of shading space.
#[test]
fn an_address_is_of_one_triangle() {
    let watched = Watched::open("chess:triangles=12000");
    for (lens, is_shared) in [(&[("aperture", "0.2")][..], true), (&[("spp", "1")], false)] {
        let renderer = watched.render_stages(DEEP, &both(&[SIZE, ("spp", "8")], lens), &[SPIDS, ADDRESSES]);
        let [seen, addresses] = [SPIDS, ADDRESSES].map(|stage| watched.integers(&renderer, stage));
        let mut seen_by = BTreeMap::<u32, Vec<u32>>::new();
        for (seen, address) in seen.iter().zip(&addresses) {
            assert_eq!(*seen == u32::MAX, *address == u32::MAX, "what sees nothing has no colour");
            seen_by.entry(*address).or_default().push(*seen);
        }
        seen_by.remove(&u32::MAX);
        for (address, seen) in &seen_by {
            assert!(seen.iter().all(|id| *id == seen[0]), "{address}: {seen:?}");
        }
        let (samples, colours) = (seen_by.values().map(Vec::len).sum::<usize>(), seen_by.len());
        println!("{samples} samples that see a triangle have {colours} addresses");
        assert!(samples > 1000 && (colours < samples) == is_shared, "{samples}, {colours}");
    }
}

/// What has no such buffer says which settings have.
#[test]
fn stages_that_are_not_made_are_refused() {
    let watched = Watched::open("cornell");
    for (stage, changes, said) in [
        (ZMAX, &[SIZE][..], "--shade-by fragment and --zmax on makes it"),
        (ADDRESSES, &[SIZE, ("address-buffer", "off")], "--address-buffer on, and lists, makes it"),
        (ADDRESSES, &[SIZE, ("shading", "ssaa")], "--shading deep makes it"),
    ] {
        let error = watched.try_renderer(DEEP, changes, &[stage], Submits::One).map(|_| ()).unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains(said), "{stage}: {error}");
    }
}

//! Built-in volumes: a test signal and a phantom of a head.

use super::field::Volume;
use super::voxels::{Voxels, room};
use crate::error::{Error, Result};
use crate::sampling::pcg::Pcg32;
use glam::{DVec3, dvec3};
use rayon::prelude::*;
use std::f64::consts::PI;

/// One of them.
struct Signal {
    name: &'static str,
    /// Voxels along each side, where nothing else is asked for.
    default_size: u32,
    make: fn(u32, u64) -> Result<Voxels>,
}

const ALL: [Signal; 2] = [
    Signal { name: "marschner-lobb", default_size: 41, make: marschner_lobb },
    Signal { name: "head", default_size: 96, make: head },
];

/// Voxels along each side.
const SIZES: [u32; 2] = [8, 1024];

/// The built-in volume of a name, with parameters after a colon; None: there is none of the name.
///
/// Errors: an impossible parameter (exit code 2); memory (4).
pub fn open(spec: &str, seed: u64) -> Option<Result<Volume>> {
    let (name, arguments) = spec.split_once(':').map_or((spec, None), |(name, arguments)| (name, Some(arguments)));
    let signal = ALL.iter().find(|signal| signal.name == name)?;
    Some(size(signal, arguments).and_then(|size| {
        let made = Volume::new([size; 3], [1.0; 3], (signal.make)(size, seed)?)?;
        Ok(Volume { name: spec.to_owned(), ..made })
    }))
}

fn size(signal: &Signal, arguments: Option<&str>) -> Result<u32> {
    let Some(arguments) = arguments else { return Ok(signal.default_size) };
    let [least, most] = SIZES;
    let size = arguments.strip_prefix("size=").and_then(|text| text.parse().ok());
    size.filter(|size| (least..=most).contains(size)).ok_or_else(|| {
        let (name, default) = (signal.name, signal.default_size);
        Error::request(format!("volume {name}:{arguments}: its one parameter is size=N"))
            .note(format!("size={least} to {most}, default {default}: voxels along each side"))
    })
}

/// `value` at each voxel's middle, -1 to 1 along each axis from the first to the last.
fn sampled<T: Copy + Default + Send>(size: u32, value: impl Fn(DVec3) -> T + Sync) -> Result<Vec<T>> {
    let side = size as usize;
    let mut values = room(side.pow(3))?;
    values.resize(side.pow(3), T::default());
    let along = |index: usize| 2.0 * index as f64 / (size - 1) as f64 - 1.0;
    values.par_chunks_mut(side * side).enumerate().for_each(|(z, slice)| {
        for (index, into) in slice.iter_mut().enumerate() {
            *into = value(dvec3(along(index % side), along(index / side), along(z)));
        }
    });
    Ok(values)
}

/// The signal of Marschner and Lobb 1994 (An evaluation of reconstruction filters for volume rendering, section 4): ripples,
/// nearly all of whose energy lies below 0.94 of what 41 samples along a side can hold. Their z is the world's z, toward the
/// camera.
fn marschner_lobb(size: u32, _: u64) -> Result<Voxels> {
    sampled(size, |at| marschner_lobb_at(at) as f32).map(Voxels::F32)
}

fn marschner_lobb_at(at: DVec3) -> f64 {
    let (frequency, amplitude) = (6.0, 0.25);
    let radius = at.truncate().length();
    let ripple = (2.0 * PI * frequency * (0.5 * PI * radius).cos()).cos();
    (1.0 - (0.5 * PI * at.z).sin() + amplitude * (1.0 + ripple)) / (2.0 * (1.0 + amplitude))
}

/// What a head is made of, 0 to 255.
const SOFT: f64 = 105.0;
const SKIN: f64 = 70.0;
const FLUID: f64 = 92.0;
const BRAIN: f64 = 130.0;
const BONE: f64 = 205.0;
const TOOTH: f64 = 255.0;

/// A phantom of a head that looks to +z: air 0, skin 70, fluid 92, soft tissue 105, brain 130 with folds, bone 205, teeth 255;
/// nose, mouth, sinuses and ear canals are air. Borders are a voxel and a half wide, as in a scan.
fn head(size: u32, seed: u64) -> Result<Voxels> {
    let mut random = Pcg32::new(seed, 21);
    let folds: Vec<u8> = (0..LATTICE.pow(3)).map(|_| random.below(256) as u8).collect();
    sampled(size, |at| head_at(at, 3.0 / f64::from(size), &folds).round() as u8).map(Voxels::U8)
}

/// Side of the lattice of random numbers that folds are made from.
const LATTICE: usize = 24;

/// Smooth noise of 0 to 1, which repeats after `LATTICE`.
fn noise(at: DVec3, lattice: &[u8]) -> f64 {
    let low = at.floor();
    let part = at - low;
    let part = part * part * (3.0 - 2.0 * part);
    let wrapped = |axis: usize, one: usize| (low[axis] as i64 + one as i64).rem_euclid(LATTICE as i64) as usize;
    (0..8)
        .map(|corner| {
            let one = [corner & 1, corner >> 1 & 1, corner >> 2 & 1];
            let weight: f64 = (0..3).map(|axis| if one[axis] == 1 { part[axis] } else { 1.0 - part[axis] }).product();
            let index = (wrapped(2, one[2]) * LATTICE + wrapped(1, one[1])) * LATTICE + wrapped(0, one[0]);
            weight * f64::from(lattice[index]) / 255.0
        })
        .sum()
}

/// About how far outside of an ellipsoid a place lies; negative within.
fn ellipsoid(at: DVec3, middle: [f64; 3], radii: [f64; 3]) -> f64 {
    let (at, radii) = (at - DVec3::from(middle), DVec3::from(radii));
    let [first, second] = [(at / radii).length(), (at / (radii * radii)).length()];
    if second == 0.0 { -radii.min_element() } else { first * (first - 1.0) / second }
}

/// Both sides of the head alike.
fn both(at: DVec3) -> DVec3 {
    dvec3(at.x.abs(), at.y, at.z)
}

/// Distance to an upright cylinder of elliptic section.
fn column(at: DVec3, [x, z]: [f64; 2], radius: f64, [bottom, top]: [f64; 2]) -> f64 {
    let across = ((at.x - x).powi(2) + (at.z - z).powi(2)).sqrt() - radius;
    across.max(at.y - top).max(bottom - at.y)
}

fn head_at(at: DVec3, border: f64, folds: &[u8]) -> f64 {
    let side = both(at);
    let skull = |grown: f64| ellipsoid(at, [0.0, 0.18, -0.05], [0.55 + grown, 0.64 + grown, 0.66 + grown]);
    let jaw = |grown: f64| ellipsoid(at, [0.0, -0.42, 0.20], [0.38 + grown, 0.34 + grown, 0.42 + grown]);
    let neck = column(at, [0.0, -0.18], 0.30, [-1.2, -0.3]);
    let nose = ellipsoid(at, [0.0, -0.10, 0.66], [0.10, 0.20, 0.16]);
    let ear = ellipsoid(side, [0.62, 0.02, -0.06], [0.06, 0.18, 0.12]);
    let skin = skull(0.05).min(jaw(0.05)).min(neck).min(nose).min(ear);
    // How much of a voxel is within; what comes later lies over what came before.
    let within = |distance: f64| (0.5 - distance / border).clamp(0.0, 1.0);
    let mut value = 0.0;
    let mut lay = |distance: f64, of: f64| value += (of - value) * within(distance);
    lay(skin, SKIN);
    lay(skin + 0.045, SOFT);
    // Bone: a shell, a jaw that is open above and behind, the spine.
    let vault = skull(-0.03);
    lay(vault, BONE);
    let bow = jaw(-0.06).max(-jaw(-0.15)).max(at.y + 0.36).max(-(at.z - 0.02));
    lay(bow, BONE);
    lay(column(at, [0.0, -0.22], 0.09, [-1.2, -0.34]), BONE);
    lay(ellipsoid(side, [0.26, -0.06, 0.46], [0.12, 0.06, 0.10]).max(skin + 0.05), BONE);
    lay(skull(-0.09), FLUID);
    let fold = noise(at * 7.0 + 11.0, folds) + 0.5 * noise(at * 15.0 + 3.0, folds);
    let gap = 0.012 - at.x.abs();
    lay(skull(-0.115).max(gap), BRAIN + 26.0 * (fold - 0.75));
    lay(ellipsoid(side, [0.09, 0.20, -0.02], [0.05, 0.12, 0.20]), FLUID);
    // Sockets, eyes in them, and what holds air.
    lay(ellipsoid(side, [0.20, 0.06, 0.54], [0.125, 0.115, 0.14]), SOFT);
    lay(ellipsoid(side, [0.20, 0.06, 0.55], [0.095, 0.095, 0.095]), FLUID);
    lay(ellipsoid(side, [0.10, 0.34, 0.535], [0.07, 0.06, 0.035]), 0.0);
    lay(ellipsoid(side, [0.055, -0.14, 0.48], [0.035, 0.14, 0.22]), 0.0);
    lay(ellipsoid(at, [0.0, -0.36, 0.36], [0.20, 0.05, 0.20]), 0.0);
    lay(ellipsoid(side, [0.52, 0.0, -0.04], [0.14, 0.025, 0.025]), 0.0);
    // Two rows of teeth around the mouth.
    let row = ellipsoid(at, [0.0, -0.36, 0.34], [0.24, 0.09, 0.25]).max(-ellipsoid(
        at,
        [0.0, -0.36, 0.34],
        [0.19, 0.2, 0.20],
    ));
    lay(row.max(0.016 - (at.y + 0.36).abs()).max(-(at.z - 0.30)), TOOTH);
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published formula, by numbers that are known without it.
    #[test]
    fn the_test_signal_is_the_published_one() {
        // In the middle the ripple is cos(12 pi) = 1; at radius 1 it is cos(0) = 1; z = 1 takes the sine away.
        for (at, expected) in [
            (DVec3::ZERO, 1.5 / 2.5),
            (dvec3(1.0, 0.0, 0.0), 1.5 / 2.5),
            (dvec3(0.0, 0.0, 1.0), 0.5 / 2.5),
            (dvec3(0.0, -1.0, -1.0), 1.0),
            // cos(pi / 3) = 1/2: the ripple is cos(6 pi) = 1 at radius 2/3 too.
            (dvec3(0.0, 2.0 / 3.0, 0.0), 1.5 / 2.5),
        ] {
            assert!((marschner_lobb_at(at) - expected).abs() < 1e-12, "{at}");
        }
        let made = open("marschner-lobb", 1).unwrap().unwrap();
        assert_eq!(made.size, [41; 3]);
        let Voxels::F32(values) = &made.voxels else { panic!("floats") };
        assert!((values[(20 * 41 + 20) * 41 + 20] - 0.6).abs() < 1e-6);
        assert!(made.range[0] >= 0.0 && made.range[1] <= 1.0, "{:?}", made.range);
    }

    #[test]
    fn a_head_has_all_its_tissues_where_they_belong() {
        let made = open("head", 1).unwrap().unwrap();
        let Voxels::U8(values) = &made.voxels else { panic!("bytes") };
        let at = |x: f64, y: f64, z: f64| {
            let index = |along: f64| ((along + 1.0) / 2.0 * 95.0).round() as usize;
            f64::from(values[(index(z) * 96 + index(y)) * 96 + index(x)])
        };
        let near = |value: f64, of: f64| (value - of).abs() < 14.0;
        assert_eq!(at(0.9, 0.9, 0.9), 0.0, "air around");
        assert!(near(at(0.0, 0.86, -0.05), SKIN) || near(at(0.0, 0.84, -0.05), SKIN), "skin on top");
        assert!(near(at(0.0, 0.77, -0.05), BONE), "the vault: {}", at(0.0, 0.77, -0.05));
        assert!(at(0.3, 0.3, 0.0) > 110.0 && at(0.3, 0.3, 0.0) < 160.0, "brain");
        assert!(near(at(0.2, 0.06, 0.55), FLUID) && near(at(-0.2, 0.06, 0.55), FLUID), "eyes before it, to +z");
        assert_eq!(at(0.1, 0.34, 0.54), 0.0, "sinus");
        assert_eq!(at(0.0, -0.36, 0.36), 0.0, "mouth");
        assert!(near(at(0.0, -0.8, -0.22), BONE), "spine");
        assert!(made.range[0] == 0.0 && made.range[1] > 240.0, "teeth: {:?}", made.range);
        // A seed makes the same, another one other folds.
        let same = open("head", 1).unwrap().unwrap();
        let other = open("head", 2).unwrap().unwrap();
        assert!(same.hash == made.hash && other.hash != made.hash);
    }

    #[test]
    fn parameters_are_checked() {
        assert!(open("cube", 1).is_none());
        assert_eq!(open("head:size=16", 1).unwrap().unwrap().size, [16; 3]);
        for spec in ["head:", "head:size=", "head:size=7", "head:size=4000", "head:sides=9", "marschner-lobb:size=-1"] {
            let error = open(spec, 1).unwrap().unwrap_err();
            assert!(error.exit_code() == 2 && error.to_string().contains("8 to 1024"), "{error}");
        }
    }
}

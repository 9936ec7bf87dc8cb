//! Curves that the moving things of built-in scenes follow, as keyframes of glTF: what is exported is what moves here.
//!
//! All of them end after `DURATION_S` at the latest; then their things stand still, as those of an animated file do.

use glam::{DVec3, Quat, Vec3};

use crate::scene::animation::{Curve, Interpolation};

/// For how long a built-in scene moves, seconds: 3600 frames at 60 a second (Clarberg & Munkberg 2014, section 6.1).
pub const DURATION_S: u32 = 60;

/// Keys a second of a camera's rotation: between two of them it turns evenly.
const LOOKS_PER_S: u32 = 4;

fn curve(interpolation: Interpolation, times_s: Vec<f32>, values: Vec<f32>, width: usize) -> Curve {
    Curve::new(interpolation, times_s, values, width).expect("as many keys as values, ascending")
}

/// Rotations: once about `axis`, of unit length, in `turn_s` seconds, counter-clockwise as seen from its tip.
pub fn turns(axis: Vec3, turn_s: u32) -> Curve {
    // Quarters: the shorter arc between two keys is then the way round.
    const HALF: f32 = std::f32::consts::FRAC_1_SQRT_2;
    let quarters = [(0.0, 1.0), (HALF, HALF), (1.0, 0.0), (HALF, -HALF)];
    let key_count = 4 * DURATION_S / turn_s + 1;
    let times_s = (0..key_count).map(|key| (key * turn_s) as f32 * 0.25).collect();
    let quaternion = |key: usize| {
        let (sine, cosine) = quarters[key % 4];
        (axis * sine + Vec3::ZERO).extend(cosine).to_array()
    };
    curve(Interpolation::Linear, times_s, (0..key_count as usize).flat_map(quaternion).collect(), 4)
}

/// Translations: from one place to the other and back in `period_s` seconds, at rest at both.
pub fn to_and_fro(places: [DVec3; 2], period_s: u32) -> Curve {
    let key_count = 2 * DURATION_S / period_s + 1;
    let times_s = (0..key_count).map(|key| (key * period_s) as f32 * 0.5).collect();
    let still = [0.0; 3];
    let key = |key: usize| [still, places[key % 2].as_vec3().to_array(), still].concat();
    curve(Interpolation::CubicSpline, times_s, (0..key_count as usize).flat_map(key).collect(), 3)
}

/// Translations through all `stops` and back to the first, evenly in time, every `period_s` seconds: a closed spline of
/// Catmull and Rom. At least three stops.
pub fn circuit(stops: &[DVec3], period_s: u32) -> Curve {
    let interval_s = f64::from(period_s) / stops.len() as f64;
    let last_key = stops.len() * (DURATION_S / period_s) as usize;
    let stop = |index: usize| stops[index % stops.len()];
    let times_s = (0..=last_key).map(|key| (key as f64 * interval_s) as f32).collect();
    let key = |key: usize| {
        let slope = (stop(key + 1) - stop(key + stops.len() - 1)) / (2.0 * interval_s);
        [slope, stop(key), slope].map(|value| value.as_vec3().to_array()).concat()
    };
    curve(Interpolation::CubicSpline, times_s, (0..=last_key).flat_map(key).collect(), 3)
}

/// Rotations of a camera on `path` that looks at what moves along `targets`, y up. The two never meet.
pub fn looking(path: &Curve, targets: &Curve) -> Curve {
    let key_count = DURATION_S * LOOKS_PER_S + 1;
    let times_s: Vec<f32> = (0..key_count).map(|key| key as f32 / LOOKS_PER_S as f32).collect();
    let rotation = |time_s: &f32| {
        let [eye, target] = [path, targets].map(|curve| curve.vector_at(f64::from(*time_s)).as_dvec3());
        let [right, up, backward] = facing(eye, target).map(|axis| axis.as_vec3());
        Quat::from_rotation_axes(right, up, backward).normalize().to_array()
    };
    let values = times_s.iter().flat_map(rotation).collect();
    curve(Interpolation::Linear, times_s, values, 4)
}

/// To the right, up and backward of one at `eye` who looks at `target` and keeps y up: unit vectors.
pub fn facing(eye: DVec3, target: DVec3) -> [DVec3; 3] {
    let backward = (eye - target).normalize();
    let right = DVec3::Y.cross(backward).normalize();
    [right, backward.cross(right), backward]
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    #[test]
    fn what_goes_to_and_fro_rests_at_both_ends() {
        let curve = to_and_fro([DVec3::ZERO, DVec3::Y * 3.0], 10);
        let height = |time_s: f64| curve.vector_at(time_s).y;
        assert_eq!([0.0, 2.5, 5.0, 10.0, 60.0, 99.0].map(height), [0.0, 1.5, 3.0, 0.0, 0.0, 0.0]);
        assert!(height(0.1) < 0.01 && height(4.9) > 2.99, "{} {}", height(0.1), height(4.9));
    }

    #[test]
    fn a_circuit_passes_its_stops_and_closes_smoothly() {
        let stops = [dvec3(1.0, 0.0, 0.0), dvec3(0.0, 1.0, 0.0), dvec3(-1.0, 0.0, 0.0), dvec3(0.0, -1.0, 0.0)];
        let path = circuit(&stops, 60);
        for (index, stop) in stops.iter().enumerate() {
            assert_eq!(path.vector_at(15.0 * index as f64), stop.as_vec3());
        }
        assert_eq!(path.vector_at(60.0), path.vector_at(0.0));
        let four_times = circuit(&stops, 15);
        assert_eq!(four_times.vector_at(33.75), stops[1].as_vec3());
        let before = (path.vector_at(60.0) - path.vector_at(59.99)) / 0.01;
        let after = (path.vector_at(0.01) - path.vector_at(0.0)) / 0.01;
        // Half of the way between both neighbours, 15 s apart each: 2 m in 30 s.
        assert!(before.abs_diff_eq(after, 1e-3) && (after.y - 1.0 / 15.0).abs() < 1e-3, "{before} {after}");
    }

    #[test]
    fn a_camera_on_its_way_looks_at_its_target() {
        let path = circuit(&[dvec3(4.0, 1.0, 0.0), dvec3(0.0, 2.0, 5.0), dvec3(-4.0, 1.0, -1.0)], 60);
        let targets = circuit(&[dvec3(0.0, 1.0, 0.0), dvec3(0.5, 1.5, 0.0), dvec3(0.0, 1.0, 0.5)], 60);
        let looks = looking(&path, &targets);
        for step in 0..60 {
            let time_s = f64::from(step) * 1.01;
            let toward = (targets.vector_at(time_s) - path.vector_at(time_s)).normalize();
            let rotation = looks.rotation_at(time_s);
            // Between two keys a quarter of a second apart it may be a little ahead or behind: under a degree.
            assert!((rotation * Vec3::NEG_Z).dot(toward) > 0.9998, "{time_s} s");
            assert!((rotation * Vec3::X).y.abs() < 0.01, "{time_s} s: it leans");
        }
    }
}

//! Directions around a normal: the twin of `around` in glsl/shading/scatter.glsl.

use glam::Vec3;

/// `local`, given around z, around a unit vector instead (Duff et al. 2017).
pub fn around(normal: Vec3, local: Vec3) -> Vec3 {
    let turn = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (turn + normal.z);
    let b = normal.x * normal.y * a;
    let x = Vec3::new(1.0 + turn * normal.x * normal.x * a, turn * b, -turn * normal.x);
    let y = Vec3::new(b, turn + normal.y * normal.y * a, -normal.y);
    x * local.x + y * local.y + normal * local.z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_stand_on_the_normal_and_on_each_other_and_are_right_handed() {
        for normal in
            [Vec3::Z, -Vec3::Z, Vec3::X, -Vec3::Y, Vec3::new(2.0, -3.0, 6.0) / 7.0, Vec3::new(-6.0, 2.0, -3.0) / 7.0]
        {
            let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| around(normal, axis));
            assert!((z - normal).length() < 1e-6 && (x.cross(y) - normal).length() < 1e-6, "{normal}: {x} {y} {z}");
            assert!((x.length() - 1.0).abs() < 1e-6 && x.dot(y).abs() < 1e-6, "{normal}: {x} {y}");
        }
    }
}

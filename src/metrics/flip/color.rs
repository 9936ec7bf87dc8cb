//! The colour spaces of FLIP: linear Rec.709, the opponent space YCxCz in which the eye filters, L*a*b* in which it judges.

/// CIE XYZ of the sRGB primaries (IEC 61966-2-1, from their chromaticities in full precision).
const XYZ_FROM_RGB: [[f32; 3]; 3] = [
    [0.412_386_56, 0.357_591_5, 0.180_450_5],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.019_330_62, 0.119_197_17, 0.950_372_6],
];
/// Inverse of `XYZ_FROM_RGB`.
const RGB_FROM_XYZ: [[f32; 3]; 3] = [
    [3.241_003_2, -1.537_399, -0.498_615_87],
    [-0.969_224_3, 1.875_93, 0.041_554_226],
    [0.055_639_423, -0.204_011_2, 1.057_148_9],
];
/// The XYZ of white, D65: what each row of the matrix sums up to.
const WHITE: [f32; 3] = [0.950_428_55, 1.0, 1.088_900_4];

fn times(matrix: &[[f32; 3]; 3], vector: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * vector[0] + row[1] * vector[1] + row[2] * vector[2])
}

/// Opponent channels of linear light: Y (-16 to 100), red against green, yellow against blue.
pub fn ycxcz(linear: [f32; 3]) -> [f32; 3] {
    let xyz = times(&XYZ_FROM_RGB, linear);
    let [x, y, z] = [xyz[0] / WHITE[0], xyz[1] / WHITE[1], xyz[2] / WHITE[2]];
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The way back from `ycxcz`.
pub fn linear_rgb([luma, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (luma + 16.0) / 116.0;
    times(&RGB_FROM_XYZ, [(y + cx / 500.0) * WHITE[0], y * WHITE[1], (y - cz / 200.0) * WHITE[2]])
}

/// L* (0 to 100), and a* and b* weighted by a hundredth of L*: dark colours look less colourful (Hunt).
pub fn hunt_lab(linear: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let root = |t: f32| if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 };
    let xyz = times(&XYZ_FROM_RGB, linear);
    let [x, y, z] = [root(xyz[0] / WHITE[0]), root(xyz[1] / WHITE[1]), root(xyz[2] / WHITE[2])];
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}

/// Distance of large differences: along L*, plus the Euclidean of a* and b* (Abasi et al. 2020).
pub fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_black_and_the_way_back() {
        let near = |found: [f32; 3], expected: [f32; 3]| {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{found:?} {expected:?}");
        };
        near(ycxcz([1.0; 3]), [100.0, 0.0, 0.0]);
        near(ycxcz([0.0; 3]), [-16.0, 0.0, 0.0]);
        near(hunt_lab([1.0; 3]), [100.0, 0.0, 0.0]);
        near(hunt_lab([0.0; 3]), [0.0; 3]);
        // L* a* b* of the red primary are 53.24, 80.09, 67.20; white is D65 to more digits here.
        near(hunt_lab([1.0, 0.0, 0.0]), [53.237, 42.639, 35.776]);
        for color in [[0.2, 0.5, 0.9], [1.0, 0.0, 0.3], [0.0, 0.01, 0.0]] {
            let back = linear_rgb(ycxcz(color));
            assert!(back.iter().zip(color).all(|(a, b)| (a - b).abs() < 1e-5), "{back:?} {color:?}");
        }
    }
}

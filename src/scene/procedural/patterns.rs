//! What the surfaces of the procedural scenes look like: stone, brick, wood, cloth, glass, metal.
//!
//! Each function gives one texel at (u, v) in 0 to 1, v down, and repeats.

use super::pictures::{Texel, blend, fractal, hashed, mix, noise, step};

/// Distance to the nearest edge of the unit cell.
fn to_edge(x: f32, y: f32) -> f32 {
    x.min(1.0 - x).min(y).min(1.0 - y)
}

/// 0 to 1 and back to 0 over one unit.
fn triangle_wave(x: f32) -> f32 {
    1.0 - (2.0 * (x - x.floor()) - 1.0).abs()
}

/// Cloudy stone with veins, between two colours.
pub fn marble([u, v]: [f32; 2], body: [f32; 3], vein: [f32; 3], seed: u32) -> Texel {
    let cloud = fractal([u, v], [3, 3], 5, seed);
    let bend = fractal([u, v], [2, 2], 5, seed ^ 0x51);
    // Layers that run diagonally, folded by noise; whole numbers of them, so that the picture repeats.
    let layer = |across: f32, down: f32, fold: f32, sharp: f32| {
        step(sharp, 1.0, triangle_wave(across * u + down * v + fold * bend + 0.6 * cloud))
    };
    let veins = 0.8 * layer(1.0, 2.0, 2.5, 0.88) + 0.35 * layer(-2.0, 3.0, 4.0, 0.9);
    let strength = veins * (0.25 + 0.75 * cloud) + 0.35 * step(0.4, 0.8, cloud);
    Texel {
        color: blend(body, vein, strength.min(1.0)),
        roughness: 0.22 + 0.15 * cloud,
        height: 0.5,
        ..Texel::default()
    }
}

/// A floor of marble: large squares in two colours, each with its own grain, and small dark squares on the corners.
pub fn marble_floor([u, v]: [f32; 2], seed: u32) -> Texel {
    const TILES: f32 = 4.0;
    let (x, y) = (u * TILES, v * TILES);
    let (i, j) = (x.floor() as u32, y.floor() as u32);
    let (s, t) = (x.fract(), y.fract());
    let corner = s.min(1.0 - s) + t.min(1.0 - t);
    let grain = [u + hashed(i, j, seed), v + hashed(j, i, seed ^ 7)];
    let inlay = step(0.235, 0.245, corner);
    let stone = if (i + j) % 2 == 0 {
        marble(grain, [0.87, 0.83, 0.76], [0.62, 0.56, 0.49], seed)
    } else {
        marble(grain, [0.56, 0.40, 0.31], [0.80, 0.66, 0.52], seed ^ 3)
    };
    let tone = 0.93 + 0.14 * hashed(i, j, seed ^ 0x33);
    let joint = step(0.008, 0.022, to_edge(s, t).min((corner - 0.24).abs()));
    let color = blend([0.13, 0.16, 0.17], stone.color.map(|channel| channel * tone), inlay);
    Texel {
        color: blend([0.30, 0.27, 0.23], color, joint),
        height: joint,
        roughness: mix(0.8, stone.roughness * 0.8, joint),
        ..Texel::default()
    }
}

/// Fired clay squares laid on the diagonal.
pub fn terracotta([u, v]: [f32; 2], seed: u32) -> Texel {
    let (x, y) = ((u + v) * 4.0, (u - v + 1.0) * 4.0);
    // The diagonal grid repeats after eight cells in each of its directions.
    let (i, j) = (x.floor() as u32 % 8, y.floor() as u32 % 8);
    let edge = to_edge(x.fract(), y.fract());
    let body = step(0.015, 0.06, edge);
    let tone = hashed((i + j) % 8, (i + 8 - j) % 8, seed);
    let dirt = fractal([u, v], [8, 8], 4, seed);
    let clay = blend([0.60, 0.36, 0.26], [0.74, 0.47, 0.33], 0.6 * tone + 0.4 * dirt);
    Texel {
        color: blend([0.50, 0.45, 0.39], clay, body),
        height: body * (0.9 + 0.1 * dirt),
        roughness: mix(0.95, 0.45 + 0.25 * dirt, body),
        ..Texel::default()
    }
}

/// Courses of stone or brick in running bond: `columns` x `rows` in the picture, `rows` even.
pub struct Masonry {
    pub columns: u32,
    pub rows: u32,
    pub dark: [f32; 3],
    pub light: [f32; 3],
    pub mortar: [f32; 3],
    /// Width of the joints as a part of a course's height.
    pub joint: f32,
}

/// A wall of `masonry`.
pub fn masonry([u, v]: [f32; 2], masonry: &Masonry, seed: u32) -> Texel {
    let y = v * masonry.rows as f32;
    let row = y.floor() as u32;
    let x = u * masonry.columns as f32 + 0.5 * (row % 2) as f32;
    let column = x.floor() as u32 % masonry.columns;
    // Both distances in heights of a course.
    let aspect = masonry.rows as f32 / masonry.columns as f32;
    let (s, t) = (x.fract(), y.fract());
    let ragged = 0.5 * masonry.joint * fractal([u, v], [16, 16], 2, seed ^ 5);
    let edge = (s.min(1.0 - s) * aspect).min(t.min(1.0 - t));
    let body = step(masonry.joint * 0.4 + ragged, masonry.joint + ragged, edge);
    let grain = fractal([u, v], [16, 16], 4, seed);
    let tone = 0.65 * hashed(column, row, seed ^ 11) + 0.35 * grain;
    Texel {
        color: blend(masonry.mortar, blend(masonry.dark, masonry.light, tone), body),
        height: body * (0.8 + 0.2 * grain),
        roughness: 0.8 + 0.2 * grain,
        ..Texel::default()
    }
}

/// Trowelled plaster with faint stains.
pub fn plaster([u, v]: [f32; 2], color: [f32; 3], seed: u32) -> Texel {
    let stain = fractal([u, v], [3, 3], 4, seed);
    let grain = fractal([u, v], [24, 24], 3, seed ^ 9);
    let tone = 0.86 + 0.12 * stain + 0.06 * grain;
    Texel { color: color.map(|channel| channel * tone), height: grain, roughness: 0.9, ..Texel::default() }
}

/// Four boards, their grain along v.
pub fn boards([u, v]: [f32; 2], dark: [f32; 3], light: [f32; 3], seed: u32) -> Texel {
    let x = u * 4.0;
    let board = x.floor() as u32;
    let shift = hashed(board, 3, seed);
    let wave = fractal([u, v + shift], [8, 2], 3, seed ^ board);
    let ring = triangle_wave(3.0 * x + 3.0 * wave);
    let fibre = noise([u, v + shift], [96, 6], seed ^ 21);
    let body = step(0.01, 0.05, x.fract().min(1.0 - x.fract()));
    let tone = 0.45 * ring + 0.3 * fibre + 0.25 * shift;
    Texel {
        color: blend(dark, light, tone).map(|channel| channel * (0.35 + 0.65 * body)),
        height: body * (0.85 + 0.15 * fibre),
        roughness: 0.45 + 0.3 * fibre,
        ..Texel::default()
    }
}

/// A woven runner: a border on both long sides (u = 0 and 1), lozenges along its middle.
pub fn carpet([u, v]: [f32; 2], seed: u32) -> Texel {
    let side = u.min(1.0 - u);
    let lozenge = (u - 0.5).abs() * 2.6 + (v - 0.5).abs();
    let red = [0.50, 0.09, 0.08];
    let gold = [0.78, 0.57, 0.24];
    let blue = [0.11, 0.15, 0.31];
    let ring = |from: f32, to: f32, value: f32| step(from - 0.006, from, value) * (1.0 - step(to, to + 0.006, value));
    let mut color = red;
    color = blend(color, blue, 1.0 - step(0.118, 0.124, side));
    color = blend(color, gold, ring(0.025, 0.04, side).max(ring(0.11, 0.125, side)));
    let teeth = 0.055 + 0.03 * triangle_wave(8.0 * v);
    color = blend(color, gold, ring(0.045, teeth, side) * 0.8);
    color = blend(color, gold, ring(0.46, 0.5, lozenge).max(ring(0.0, 0.1, lozenge)));
    color = blend(color, blue, ring(0.12, 0.44, lozenge));
    color = blend(color, gold, ring(0.24, 0.27, lozenge));
    let weave = 0.5 * triangle_wave(64.0 * u) + 0.5 * triangle_wave(64.0 * v);
    let wear = fractal([u, v], [4, 4], 4, seed);
    Texel {
        color: color.map(|channel| channel * (0.72 + 0.16 * weave + 0.2 * wear)),
        height: weave,
        roughness: 1.0,
        ..Texel::default()
    }
}

/// Small coloured stones in a wave between two gilded bands; u along the frieze.
pub fn mosaic([u, v]: [f32; 2], seed: u32) -> Texel {
    const STONES: f32 = 64.0;
    let (x, y) = (u * STONES, v * STONES);
    let (i, j) = (x.floor() as u32, y.floor() as u32);
    let (p, q) = ((i as f32 + 0.5) / STONES, (j as f32 + 0.5) / STONES);
    let gold = [0.83, 0.64, 0.26];
    let field = [0.10, 0.24, 0.36];
    let from_middle = (q - 0.5).abs();
    let scroll = (q - 0.5 - 0.2 * (step(0.0, 1.0, triangle_wave(2.0 * p)) * 2.0 - 1.0)).abs();
    let flower = ((triangle_wave(4.0 * p) - 0.5).abs() * 0.5 + (from_middle - 0.13).abs()) < 0.05;
    let base = if from_middle > 0.43 || scroll < 0.035 {
        gold
    } else if from_middle > 0.39 {
        [0.60, 0.16, 0.12]
    } else if flower {
        [0.86, 0.80, 0.68]
    } else {
        field
    };
    let body = step(0.02, 0.14, to_edge(x.fract(), y.fract()));
    let tone = 0.75 + 0.4 * hashed(i, j, seed);
    let gilded = if base == gold { 1.0 } else { 0.0 };
    Texel {
        color: blend([0.45, 0.41, 0.36], base.map(|channel| channel * tone), body),
        height: body,
        roughness: mix(0.9, mix(0.35, 0.3, gilded), body),
        metallic: gilded * body,
        ..Texel::default()
    }
}

/// One stone of an arch, for a texture that repeats stone by stone along u; every second of the picture's two is red.
pub fn arch_stones([u, v]: [f32; 2], seed: u32) -> Texel {
    let x = u * 2.0;
    let stone = x.floor() as u32;
    let grain = fractal([u, v], [6, 6], 4, seed);
    let base = if stone == 0 { [0.82, 0.76, 0.65] } else { [0.62, 0.34, 0.26] };
    let body = step(0.012, 0.05, x.fract().min(1.0 - x.fract()).min(0.5 * v.min(1.0 - v) + 0.012));
    Texel {
        color: blend([0.42, 0.37, 0.31], base.map(|channel| channel * (0.82 + 0.24 * grain)), body),
        height: body * (0.85 + 0.15 * grain),
        roughness: 0.85,
        ..Texel::default()
    }
}

/// Leaded glass: small panes in `colors`, larger toward the middle of the window.
pub fn leaded_glass([u, v]: [f32; 2], columns: u32, colors: &[[f32; 3]], seed: u32) -> Texel {
    let (x, y) = (u * columns as f32, v * columns as f32 * 2.0);
    let (a, b) = (x + 0.5 * y, x - 0.5 * y + columns as f32);
    let (i, j) = (a.floor() as u32, b.floor() as u32);
    let pick = (hashed(i, j, seed) * colors.len() as f32) as usize;
    let edge = to_edge(a.fract(), b.fract());
    let light = 0.75 + 0.25 * fractal([u, v], [8, 8], 3, seed);
    let glass = step(0.03, 0.06, edge);
    let color = colors[pick.min(colors.len() - 1)].map(|channel| channel * light * glass);
    Texel { color, height: glass, roughness: 0.3, ..Texel::default() }
}

/// An iron lattice: quatrefoils between bars, alpha 0 in the holes.
pub fn grille([u, v]: [f32; 2]) -> Texel {
    let (x, y) = (2.0 * (u - 0.5).abs(), 2.0 * (v - 0.5).abs());
    let bar = (1.0 - x).min(1.0 - y);
    let circle = |cx: f32, cy: f32, radius: f32| (((x - cx) * (x - cx) + (y - cy) * (y - cy)).sqrt() - radius).abs();
    let curl = circle(0.45, 0.0, 0.4).min(circle(0.0, 0.45, 0.4)).min(circle(0.0, 0.0, 0.16));
    let solid = bar < 0.09 || curl < 0.055;
    let shade = 0.16 + 0.1 * step(0.0, 0.09, bar.min(curl));
    Texel {
        color: [shade, shade * 0.97, shade * 0.92],
        alpha: if solid { 1.0 } else { 0.0 },
        roughness: 0.55,
        metallic: 1.0,
        ..Texel::default()
    }
}

/// Thin cloth: woven bands, more solid in the embroidery along its hem (v = 1) and in its pattern.
pub fn veil([u, v]: [f32; 2], seed: u32) -> Texel {
    let flower = ((triangle_wave(4.0 * u) - 0.5).abs() + (triangle_wave(8.0 * v) - 0.5).abs()) < 0.22;
    let hem = step(0.86, 0.87, v);
    let band = hem * step(0.0, 0.3, triangle_wave(12.0 * u + 2.0 * v));
    let thread = 0.9 + 0.1 * noise([u, v], [128, 128], seed);
    let cloth = blend([0.30, 0.52, 0.55], [0.86, 0.70, 0.36], if flower { 0.85 } else { band });
    Texel {
        color: cloth.map(|channel| channel * thread),
        alpha: if flower || hem > 0.5 { 0.85 } else { 0.5 },
        ..Texel::default()
    }
}

/// Hammered metal of one colour, with tarnish in the dents.
pub fn hammered([u, v]: [f32; 2], color: [f32; 3], seed: u32) -> Texel {
    let dent = noise([u, v], [14, 14], seed);
    let tarnish = step(0.45, 0.8, fractal([u, v], [4, 4], 5, seed ^ 1));
    Texel {
        color: color.map(|channel| channel * (1.0 - 0.35 * tarnish)),
        height: dent,
        roughness: 0.25 + 0.35 * tarnish,
        metallic: 1.0 - 0.4 * tarnish,
        ..Texel::default()
    }
}

/// Two-coloured squares with joints, for a ground: `tiles` x `tiles` in the picture, `tiles` even.
pub fn checker([u, v]: [f32; 2], tiles: u32, colors: [[f32; 3]; 2], seed: u32) -> Texel {
    let (x, y) = (u * tiles as f32, v * tiles as f32);
    let (i, j) = (x.floor() as u32, y.floor() as u32);
    let body = step(0.01, 0.03, to_edge(x.fract(), y.fract()));
    let grain = fractal([u, v], [8, 8], 4, seed);
    let tone = 0.82 + 0.2 * grain + 0.1 * hashed(i, j, seed);
    Texel {
        color: colors[((i + j) % 2) as usize].map(|channel| channel * tone * (0.7 + 0.3 * body)),
        height: body,
        roughness: 0.5 + 0.4 * grain,
        ..Texel::default()
    }
}

/// Part of a texel, 0 to 1, that a line covers: `distance` from its middle, `half` as wide, both in units of which the
/// picture has `texels`.
fn covered(distance: f32, half: f32, texels: f32) -> f32 {
    ((half - distance) * texels + 0.5).clamp(0.0, 1.0)
}

/// Chain-link of galvanised wire: four lozenges in each direction, alpha 0 between; `size_px` of the picture, for smooth
/// edges.
pub fn chain_link([u, v]: [f32; 2], size_px: u32) -> Texel {
    const HALF_WIRE: f32 = 0.055;
    let (x, y) = (4.0 * u, 4.0 * v);
    // Distances across both diagonals to the nearest wire.
    let across = |along: f32| ((along - along.floor()) - 0.5).abs() * std::f32::consts::FRAC_1_SQRT_2;
    let (rising, falling) = (across(x + y), across(x - y));
    let distance = rising.min(falling);
    // A wire is round: brightest along its middle; where two cross, one lies in the other's shade.
    let round = 1.0 - (distance / HALF_WIRE).min(1.0) * 0.55;
    let crossed = if rising.max(falling) < 1.8 * HALF_WIRE { 0.8 } else { 1.0 };
    let shade = 0.78 * round * crossed;
    Texel {
        color: [shade, shade * 1.01, shade * 1.03],
        alpha: covered(distance, HALF_WIRE, size_px as f32 * 0.25),
        roughness: 0.45,
        ..Texel::default()
    }
}

/// Three strands of barbed wire along u, alpha 0 between; twice as wide as high.
pub fn barbed_wire([u, v]: [f32; 2], size_px: u32) -> Texel {
    // In heights of the picture.
    let x = 2.0 * u;
    let mut distance = f32::INFINITY;
    for (strand, middle) in [0.2_f32, 0.5, 0.8].into_iter().enumerate() {
        // Two wires wound about each other, six times in the picture, and a knot of four points every quarter.
        let wave = 0.012 * (triangle_wave(6.0 * u + 0.3 * strand as f32) * 2.0 - 1.0);
        distance = distance.min((v - middle - wave).abs()).min((v - middle + wave).abs());
        let along = (4.0 * u + 0.37 * strand as f32).fract() * 0.5 - 0.25;
        let (p, q) = (along + (v - middle), along - (v - middle));
        if along.abs() < 0.065 && (v - middle).abs() < 0.085 {
            distance = distance.min(0.6 * p.abs()).min(0.6 * q.abs());
        }
    }
    let shade = 0.66 + 0.12 * triangle_wave(12.0 * x);
    Texel {
        color: [shade, shade * 0.97, shade * 0.93],
        alpha: covered(distance, 0.013, size_px as f32),
        roughness: 0.5,
        ..Texel::default()
    }
}

/// A banner of one colour with a gilded border and a lozenge in its middle, woven.
pub fn banner([u, v]: [f32; 2], field: [f32; 3], seed: u32) -> Texel {
    let border = u.min(1.0 - u).min(v).min(1.0 - v);
    let lozenge = 1.6 * (u - 0.5).abs() + (v - 0.45).abs();
    let is_gold = (0.05..0.09).contains(&border) || (0.2..0.25).contains(&lozenge) || lozenge < 0.09;
    let weave = 0.5 * triangle_wave(48.0 * u) + 0.5 * triangle_wave(96.0 * v);
    let color = if is_gold { [0.80, 0.60, 0.24] } else { field };
    let wear = fractal([u, v], [5, 5], 4, seed);
    Texel {
        color: color.map(|channel| channel * (0.75 + 0.15 * weave + 0.2 * wear)),
        height: weave,
        ..Texel::default()
    }
}

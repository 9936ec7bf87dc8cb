//! Shading space: its size with the guard band, and where a place of the scene lies in it (Clarberg & Munkberg 2014,
//! sections 3 and 6).

use super::settings::LEAST_SCALE;
use super::tuples::TupleTable;
use crate::caps::Limits;
use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::shader::structs::DeepBlock;
use crate::lens::Lens;
use crate::settings::Values;
use crate::techniques::deep_shading::eyes::{Sight, metre};
use crate::techniques::deep_shading::modes::warp::Warp;
use crate::units::Extent;
use glam::{Vec2, Vec4, Vec4Swizzles};

/// Places of 16 bits a side, one of which says that there is none.
const MOST_SIDE_PX: u64 = 65_534;

/// Size and warp of shading space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingSpace {
    pub guard_px: u32,
    /// Pixels of it along a pixel of the frame.
    scale: f64,
    /// Pixels of it that the frame takes if it is even.
    scaled_px: [f32; 2],
    /// 0: it is even.
    warp_falloff: f64,
    pub extent: Extent,
}

impl ShadingSpace {
    /// Around the frame there are `guard_px`. Reads `--shading-scale`, `--shading-warp` and `--warp-falloff`.
    ///
    /// Errors: a side is longer than shading points can be packed, or than a device of these limits draws (exit code 2).
    pub fn new(values: &Values, guard_px: u32, limits: &Limits, frame: Extent) -> Result<Self> {
        let scale = values.number("shading-scale");
        let scaled = [frame.width, frame.height].map(|side| f64::from(side) * scale);
        let warp_falloff = if values.is("shading-warp", Warp::Foveated) { values.number("warp-falloff") } else { 0.0 };
        let even = scaled.map(|side| side.ceil() + 2.0 * f64::from(guard_px));
        // Its middle stays as fine.
        let [width, height] = even.map(|side| (side / (1.0 + warp_falloff)).ceil() as u64);
        let most = limits.most_drawn_px().map(|side| u64::from(side).min(MOST_SIDE_PX));
        if width > most[0] || height > most[1] {
            // Scale at which both sides fit, for a user to type: cut to three decimals.
            let room = |axis: usize| most[axis] as f64 * (1.0 + warp_falloff) - 2.0 * f64::from(guard_px) - 1.0;
            let fitting = (room(0) / f64::from(frame.width)).min(room(1) / f64::from(frame.height));
            let fitting = (fitting * 1000.0).floor() / 1000.0;
            let advice = match fitting >= LEAST_SCALE {
                true => format!("--shading-scale {fitting} fits"),
                false => "a smaller --size or --guard-band would fit".to_owned(),
            };
            return Err(Error::request(format!(
                "--guard-band {guard_px}, --shading-scale {scale}: shading space has {width} x {height} pixels, and at most {} x {} \
                 can be drawn",
                most[0], most[1]
            ))
            .note(advice));
        }
        let scaled_px = scaled.map(|side| side as f32);
        Ok(Self { guard_px, scale, scaled_px, warp_falloff, extent: Extent::new(width as u32, height as u32) })
    }

    /// The pixel of shading space, row by row, that is under the middle of a pixel of the frame.
    pub fn index_under(&self, frame_px: [u32; 2]) -> usize {
        let even = frame_px.map(|at| ((f64::from(at) + 0.5) * self.scale) as f32 + self.guard_px as f32);
        let at = self.warped(Vec2::from_array(even)).as_uvec2();
        let last = [self.extent.width - 1, self.extent.height - 1];
        at.y.min(last[1]) as usize * self.extent.width as usize + at.x.min(last[0]) as usize
    }

    /// The place of one of even shading space, pixels. warp.glsl's.
    fn warped(&self, at: Vec2) -> Vec2 {
        if self.warp_falloff == 0.0 {
            return at;
        }
        let half = 0.5 * Vec2::from_array(self.scaled_px) + self.guard_px as f32;
        let (from_middle, falloff) = ((at - half) / half, self.warp_falloff as f32);
        let to = from_middle * ((1.0 + falloff) / (1.0 + falloff * from_middle.abs().max_element()));
        0.5 * self.side_px() * (1.0 + to)
    }

    fn side_px(&self) -> Vec2 {
        Vec2::new(self.extent.width as f32, self.extent.height as f32)
    }

    /// The pixel of a place in the middle of the exposure's clip space; None: behind the eye, before the near plane or outside,
    /// shading space has no place for it. space.glsl's shading_pixel.
    pub fn pixel(&self, clip: Vec4) -> Option<[u32; 2]> {
        let scaled = Vec2::from_array(self.scaled_px);
        let at = 0.5 * clip.xy() * scaled + clip.w * (0.5 * scaled + self.guard_px as f32);
        let at = self.warped(at / clip.w);
        let has_place =
            clip.w > 0.0 && clip.z <= clip.w && at.cmpge(Vec2::ZERO).all() && at.cmplt(self.side_px()).all();
        has_place.then_some([at.x as u32, at.y as u32])
    }

    /// The shaders' block: shading space, the cameras at both ends of the exposure, and the samples.
    ///
    /// It is seen from the middle of the lens, or from the midpoint between two eyes.
    pub fn block(&self, open: &View, close: Option<&View>, lens: Option<Lens>, table: &TupleTable) -> DeepBlock {
        let close = close.unwrap_or(open);
        let layer = table.layer(open.extent);
        let radius = lens.map_or(0.0, |lens| lens.reach());
        let reach = radius * metre(open);
        let [open, close] = Sight::of_exposure(open, close, lens);
        DeepBlock {
            open_clip_from_world: open.clip_from_world.to_cols_array_2d(),
            close_clip_from_world: close.clip_from_world.to_cols_array_2d(),
            open_depth: open.depth.to_array(),
            close_depth: close.depth.to_array(),
            lens: reach.to_array(),
            inverse_focus: lens.map_or(0.0, |lens| 1.0 / lens.focus),
            guard_px: self.guard_px as f32,
            scaled_px: self.scaled_px,
            shading_width_px: self.extent.width,
            shading_height_px: self.extent.height,
            layer_width_px: layer.width,
            layer_height_px: layer.height,
            table_width_px: table.cells[0],
            table_height_px: table.cells[1],
            sample_count: table.samples,
            tuple_count: table.tuple_count(),
            opaque_zero: 0,
            warp_falloff: self.warp_falloff as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use crate::settings::Values;

    fn space(guard: &str, scale: &str, extent: Extent) -> Result<ShadingSpace> {
        ShadingSpace::new(&scaled(scale), guard.parse().unwrap(), &known::caps(known::DEFAULT).unwrap().limits, extent)
    }

    fn scaled(scale: &str) -> Values {
        let rows = super::super::settings::SETTINGS;
        let mut values = Values::defaults(rows);
        values.set(rows.iter().find(|row| row.key == "shading-scale").unwrap(), scale).unwrap();
        values
    }

    #[test]
    fn a_guard_band_lies_on_all_sides_of_the_scaled_frame() {
        let side = |space: ShadingSpace| (space.extent.width, space.extent.height);
        assert_eq!(side(space("64", "1", Extent::new(1280, 720)).unwrap()), (1408, 848));
        assert_eq!(side(space("0", "0.5", Extent::new(101, 31)).unwrap()), (51, 16));
        let error = space("4096", "4", Extent::new(16384, 16)).unwrap_err();
        assert!(error.to_string().contains("73728 x 8256"), "{error}");
    }

    /// The scale that an error advises fits, and what is a little larger does not: on devices that draw more or less than lavapipe.
    #[test]
    fn a_shading_space_that_cannot_be_drawn_is_refused_with_the_scale_that_fits() {
        let known = known::caps(known::DEFAULT).unwrap().limits;
        let limits = |viewport: u32, framebuffer: u32| Limits {
            max_image_side_px: 65_536,
            max_viewport_px: [viewport; 2],
            max_framebuffer_px: [framebuffer; 2],
            ..known.clone()
        };
        let least = known::caps(known::LEAST).unwrap().limits;
        let nvidia = known::caps("nvidia-rtx-2070").unwrap().limits;
        for (limits, most) in [
            (least, 4096),
            (nvidia, 32_768),
            (limits(16_384, 16_384), 16_384),
            (limits(4096, 32_768), 4096),
            (limits(32_768, 8192), 8192),
            (limits(100_000, 100_000), MOST_SIDE_PX as u32),
        ] {
            for (guard, frame) in
                [("0", Extent::new(5000, 8)), ("64", Extent::new(17, 6001)), ("200", Extent::new(16_384, 16_384))]
            {
                let of_scale = |scale: &str| ShadingSpace::new(&scaled(scale), guard.parse().unwrap(), &limits, frame);
                let Err(error) = of_scale("4") else {
                    let side = frame.width.max(frame.height) * 4 + 2 * guard.parse::<u32>().unwrap();
                    assert!(side <= most, "{frame} with {most}");
                    continue;
                };
                assert_eq!(error.exit_code(), 2);
                let text = error.to_string();
                assert!(text.contains(&format!("at most {most} x {most}")), "{text}");
                let scale: f64 =
                    text.split("--shading-scale ").last().unwrap().split(' ').next().unwrap().parse().unwrap();
                let fitting = of_scale(&scale.to_string()).unwrap().extent;
                assert!(fitting.width.max(fitting.height) <= most, "{fitting} of {most}");
                assert!(of_scale(&(scale + 0.002).min(4.0).to_string()).is_err(), "{text}");
            }
        }
    }

    /// Middles stay middles, the rim stays the rim, and a step there is shorter as the falloff says.
    #[test]
    fn a_foveated_space_is_finest_in_its_middle() {
        let even = space("0", "1", Extent::new(400, 200)).unwrap();
        let warped = ShadingSpace { warp_falloff: 1.0, extent: Extent::new(200, 100), ..even };
        let place = |x: f32, y: f32| warped.warped(Vec2::new(x, y));
        assert_eq!([place(200.0, 100.0), place(400.0, 100.0)], [Vec2::new(100.0, 50.0), Vec2::new(200.0, 50.0)]);
        let step = |x: f32| (place(x + 0.5, 100.0) - place(x - 0.5, 100.0)).x;
        assert!(
            (step(200.0) - 1.0).abs() < 0.01 && (step(399.5) - 0.25).abs() < 0.01,
            "{} {}",
            step(200.0),
            step(399.5)
        );
        // Across the way to the rim it shrinks as the square root of that.
        let across = (place(399.5, 100.5) - place(399.5, 99.5)).y;
        assert!((across - 0.5).abs() < 0.01, "{across}");
    }
}

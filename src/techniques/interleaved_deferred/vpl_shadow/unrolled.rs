//! Where the faces of a virtual light's shadow map lie in one image, and from where each is drawn (Segovia 2006, section 4.3: the
//! unrolled hemicube; King and Newhall 2004). Twin: maps.comp.
//!
//! A light shines into the half space before its surface: the face along its normal and the near halves of the four around it hold all
//! that it lights, in half the texels of a cube.

use crate::choice::choices;
use crate::frame::View;
use crate::gpu::ImageDescription;
use crate::gpu::shader::structs::{VplBlock, VplMapBlock};
use crate::passes::shadow_maps::{FORMAT, projection};
use crate::scene::Bounds;
use crate::units::Extent;
use ash::vk;
use glam::{Mat4, Vec3, Vec4};

choices! {
    /// What a virtual light's shadow map is (`--vpl-shadow-shape`).
    pub enum MapShape {
        /// Unrolled in one image: a face and four halves.
        "hemicube" => Hemicube,
        /// Unrolled in one image: six faces.
        "cube" => Cube,
        /// Six faces, each a layer of an array.
        "layers" => Layers,
    }
}

choices! {
    /// How a direction comes to its texel of an unrolled map (`--vpl-shadow-index`).
    pub enum MapIndex {
        "arithmetic" => Arithmetic,
        /// By a look-up in a cube of texels' places.
        "cube-map" => CubeMap,
    }
}

/// Maps that are held at once, in one image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapAtlas {
    pub shape: MapShape,
    /// Texels across a face, an even number.
    pub size_px: u32,
    /// Maps that it holds.
    pub map_count: u32,
    /// Maps beside each other.
    pub columns: u32,
}

/// A face of a light's map, or the half of one.
pub struct Face {
    /// The whole face.
    pub view: View,
    /// Clip space of what is drawn of it, depth reversed.
    pub clip_from_world: Mat4,
}

/// A face's place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub layer: u32,
    pub at_px: [u32; 2],
    pub extent: Extent,
}

/// Brings the half towards the normal, where y is 0 to 1, into the whole of clip space.
const HALF: Mat4 = Mat4::from_cols(Vec4::X, Vec4::new(0.0, 2.0, 0.0, 0.0), Vec4::Z, Vec4::new(0.0, -1.0, 0.0, 1.0));

impl MapAtlas {
    /// `map_count` maps, which a device's sides can hold, in rows that leave the fewest places empty, as square as such rows can be.
    pub fn new(shape: MapShape, size_px: u32, map_count: u32, max_side_px: u32) -> Self {
        let one = Self { shape, size_px, map_count, columns: 1 };
        let [width, height] = one.tile_px();
        let sides = |columns: u32| [columns * width, map_count.div_ceil(columns) * height];
        let fitting = (1..=map_count.min(max_side_px / width)).filter(|columns| sides(*columns)[1] <= max_side_px);
        let best = fitting.min_by_key(|columns| {
            let [across, down] = sides(*columns).map(u64::from);
            (across * down, across.max(down))
        });
        Self { columns: best.unwrap_or(1), ..one }
    }

    /// The most maps that an image of a device holds.
    pub fn most(shape: MapShape, size_px: u32, max_side_px: u32, max_layers: u32) -> u32 {
        let [width, height] = Self { shape, size_px, map_count: 1, columns: 1 }.tile_px();
        match shape {
            MapShape::Layers => max_layers / 6,
            MapShape::Hemicube | MapShape::Cube => (max_side_px / width).saturating_mul(max_side_px / height),
        }
        .max(1)
    }

    pub fn face_count(&self) -> u32 {
        if self.shape == MapShape::Hemicube { 5 } else { 6 }
    }

    /// What a map takes of the image, or of its layer.
    pub fn tile_px(&self) -> [u32; 2] {
        let size = self.size_px;
        match self.shape {
            MapShape::Hemicube => [2 * size, 3 * (size / 2)],
            MapShape::Cube => [3 * size, 2 * size],
            MapShape::Layers => [size, size],
        }
    }

    pub fn description(&self) -> ImageDescription {
        use vk::ImageUsageFlags as Usage;
        let [width, height] = self.tile_px();
        let (extent, layer_count) = match self.shape {
            MapShape::Layers => (Extent::new(width, height), Some(6 * self.map_count)),
            MapShape::Hemicube | MapShape::Cube => {
                (Extent::new(self.columns * width, self.map_count.div_ceil(self.columns) * height), None)
            }
        };
        let plain = ImageDescription::plain(extent, FORMAT, 1, Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED);
        ImageDescription { layer_count, ..plain }
    }

    /// The cube in which directions are looked up: six faces, as large as those of a map.
    pub fn index_description(&self) -> ImageDescription {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let extent = Extent::new(self.size_px, self.size_px);
        let plain = ImageDescription::plain(extent, vk::Format::R16G16_UINT, 1, usage);
        ImageDescription { layer_count: Some(6), is_cube: true, ..plain }
    }

    /// Where a face of the map in `slot` lies.
    pub fn window(&self, slot: u32, face: u32) -> Window {
        let (size, half) = (self.size_px, self.size_px / 2);
        let whole = Extent::new(size, size);
        if self.shape == MapShape::Layers {
            return Window { layer: 6 * slot + face, at_px: [0, 0], extent: whole };
        }
        let [width, height] = self.tile_px();
        let tile = [slot % self.columns * width, slot / self.columns * height];
        let (first, extent) = match (self.shape, face) {
            (MapShape::Cube, _) => ([face % 3 * size, face / 3 * size], whole),
            (_, 0) => ([0, 0], whole),
            (_, 1) => ([size, 0], Extent::new(size, half)),
            (_, 2) => ([size, half], Extent::new(size, half)),
            (_, 3) => ([0, size], Extent::new(size, half)),
            _ => ([size, size], Extent::new(size, half)),
        };
        Window { layer: 0, at_px: [tile[0] + first[0], tile[1] + first[1]], extent }
    }

    /// The texel of the map in the first slot of an unrolled image in which a direction of a light's frame (right, up, normal)
    /// lies. Twin: maps.comp.
    pub fn texel_of(&self, away: Vec3) -> [u32; 2] {
        let (face, axis, across) = face_of(away);
        let half = (self.size_px / 2) as i32;
        let [x, y] = across.map(|across| (across / axis.abs() * half as f32).floor() as i32);
        let is_half = self.shape == MapShape::Hemicube && face > 0;
        let Window { at_px: [left, top], extent, .. } = self.window(0, face);
        let (x, y) = (x + half, if is_half { y } else { y + half });
        let inside = |at: i32, side: u32| at.clamp(0, side as i32 - 1) as u32;
        [left + inside(x, extent.width), top + inside(y, extent.height)]
    }

    /// The faces of a light's map: along its normal, then around it, and for a cube behind it. `bounds`: of all that casts shadows.
    pub fn faces(&self, vpl: &VplBlock, bounds: &Bounds) -> Vec<Face> {
        let MapFrame { position, right, up, normal, depths } = MapFrame::of(vpl, bounds);
        // Right, down and forward of each: its place in it grows along the first two.
        let axes = [
            [right, up, normal],
            [up, normal, right],
            [up, normal, -right],
            [right, normal, up],
            [right, normal, -up],
            [right, up, -normal],
        ];
        let extent = Extent::new(self.size_px, self.size_px);
        let face = |(index, [right, down, forward]): (usize, [Vec3; 3])| {
            let camera = projection::perspective(position, [right, -down, -forward], 1.0, depths);
            let view = View { extent, camera, made_up: false };
            let is_half = self.shape == MapShape::Hemicube && index > 0;
            let whole = view.clip_from_world();
            Face { view, clip_from_world: if is_half { HALF * whole } else { whole } }
        };
        axes.into_iter().take(self.face_count() as usize).enumerate().map(face).collect()
    }
}

/// Where a direction of a light's frame lies: the face, how far along its axis, and across it.
fn face_of(away: Vec3) -> (u32, f32, [f32; 2]) {
    let size = away.abs();
    if size.z >= size.x.max(size.y) {
        (if away.z < 0.0 { 5 } else { 0 }, away.z, [away.x, away.y])
    } else if size.x >= size.y {
        (if away.x < 0.0 { 2 } else { 1 }, away.x, [away.y, away.z])
    } else {
        (if away.y < 0.0 { 4 } else { 3 }, away.y, [away.x, away.z])
    }
}

/// The frame in which a light looks along its normal, and where its faces begin and end.
struct MapFrame {
    position: Vec3,
    right: Vec3,
    up: Vec3,
    normal: Vec3,
    depths: [f32; 2],
}

impl MapFrame {
    fn of(vpl: &VplBlock, bounds: &Bounds) -> Self {
        let [position, normal] = [vpl.position_ws, vpl.normal_ws].map(|at| Vec4::from_array(at).truncate());
        // A triangle without an area has none.
        let normal = normal.try_normalize().unwrap_or(Vec3::Y);
        let (right, up) = projection::across(normal);
        Self { position, right, up, normal, depths: projection::depths(position, 0.0, 1.0, bounds) }
    }
}

/// What maps.comp reads of a light's map.
pub fn block(vpl: &VplBlock, bounds: &Bounds) -> VplMapBlock {
    let MapFrame { right, up, depths: [near, far], .. } = MapFrame::of(vpl, bounds);
    // As View::clip_from_world has it.
    VplMapBlock {
        right_ws: right.extend(-near / (far - near)).to_array(),
        up_ws: up.extend(near * far / (far - near)).to_array(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ROOM: Bounds = Bounds { min: Vec3::new(-4.0, -1.0, -3.0), max: Vec3::new(5.0, 3.0, 2.0) };

    fn light(position: Vec3, normal: Vec3) -> VplBlock {
        VplBlock {
            position_ws: position.extend(0.0).to_array(),
            normal_ws: normal.extend(0.0).to_array(),
            intensity: [1.0; 4],
        }
    }

    /// Texel and depth that maps.comp asks at, of the map in the first slot.
    fn asked(atlas: &MapAtlas, vpl: &VplBlock, at_ws: Vec3) -> (u32, [f32; 2], f32) {
        let [position, normal] = [vpl.position_ws, vpl.normal_ws].map(|at| Vec4::from_array(at).truncate());
        let block = block(vpl, &ROOM);
        let [right, up] = [block.right_ws, block.up_ws].map(Vec4::from_array);
        let away = at_ws - position;
        let away = Vec3::new(away.dot(right.truncate()), away.dot(up.truncate()), away.dot(normal));
        let (face, axis, across) = face_of(away);
        let half = 0.5 * atlas.size_px as f32;
        let is_half = atlas.shape == MapShape::Hemicube && face > 0;
        let [x, y] = across.map(|at| at / axis.abs() * half);
        (face, [x + half, if is_half { y } else { y + half }], right.w + up.w / axis.abs())
    }

    proptest! {
        /// Where a shader asks is where the rasteriser has put the point, in every shape; the faces of a hemicube hold all that its
        /// light lights.
        #[test]
        fn shaders_ask_where_maps_are_drawn(
            at in [0f32..1.0, 0f32..1.0, 0f32..1.0],
            from in [0f32..1.0, 0f32..1.0, 0f32..1.0],
            towards in [-1f32..1.0, -1f32..1.0, -1f32..1.0],
            shape in 0usize..3,
        ) {
            let place = |parts: [f32; 3]| ROOM.min + (ROOM.max - ROOM.min) * Vec3::from_array(parts);
            let (at_ws, position) = (place(at), place(from));
            let normal = Vec3::from_array(towards).try_normalize().unwrap_or(Vec3::X);
            let vpl = light(position, normal);
            let away = at_ws - position;
            prop_assume!(away.length() > 0.2 && away.normalize().dot(normal) > 1e-3);
            let shape = [MapShape::Hemicube, MapShape::Cube, MapShape::Layers][shape];
            let atlas = MapAtlas::new(shape, 16, 1, 16384);
            let (face, texel, depth) = asked(&atlas, &vpl, at_ws);
            let faces = atlas.faces(&vpl, &ROOM);
            prop_assert_eq!(faces.len(), atlas.face_count() as usize);
            let drawn = faces[face as usize].clip_from_world.project_point3(at_ws);
            let Window { extent, .. } = atlas.window(0, face);
            let x = (drawn.x * 0.5 + 0.5) * extent.width as f32;
            let y = (drawn.y * 0.5 + 0.5) * extent.height as f32;
            prop_assert!((x - texel[0]).abs() < 1e-3 && (y - texel[1]).abs() < 1e-3, "{x}, {y}: {texel:?} of {face}");
            prop_assert!((drawn.z - depth).abs() < 2e-5 && (0.0..=1.0).contains(&depth), "{drawn} {depth}");
            let inside = (0.0..=extent.width as f32).contains(&x) && (-1e-3..=extent.height as f32).contains(&y);
            prop_assert!(inside, "{x}, {y} of {face}");
        }
    }

    /// No texel is two faces', whatever the shape, and all lie in the image.
    #[test]
    fn faces_share_no_texel() {
        for shape in [MapShape::Hemicube, MapShape::Cube, MapShape::Layers] {
            for (count, side) in [(1, 16384), (7, 16384), (7, 64), (12, 16384)] {
                let atlas = MapAtlas::new(shape, 8, count, side);
                let description = atlas.description();
                let extent = description.extent;
                assert!(extent.width.max(extent.height) <= side, "{shape:?}: {extent}");
                let mut owners = std::collections::BTreeMap::new();
                for (slot, face) in (0..count).flat_map(|slot| (0..atlas.face_count()).map(move |face| (slot, face))) {
                    let Window { layer, at_px: [left, top], extent: face_extent } = atlas.window(slot, face);
                    assert!(layer < description.layers(), "{shape:?}");
                    for y in top..top + face_extent.height {
                        for x in left..left + face_extent.width {
                            assert!(x < extent.width && y < extent.height, "{shape:?}: {x}, {y} of {extent}");
                            let before = owners.insert((layer, x, y), (slot, face));
                            assert_eq!(before, None, "{shape:?}: {x}, {y} of {slot}, {face}");
                        }
                    }
                }
                let texels = if shape == MapShape::Hemicube { 3 * 64 } else { 6 * 64 };
                assert_eq!(owners.len() as u32, count * texels, "{shape:?}");
            }
        }
    }
}

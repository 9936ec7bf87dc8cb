//! Rendering: opened into whole images, of one sample a pixel or several.

use super::marks::shape::Part;
use super::places::SamplePlaces;
use super::{Access, Commands, Image};
use crate::units::Extent;
use ash::vk;

/// A colour attachment.
#[derive(Clone, Copy)]
pub struct ColorTarget<'a> {
    pub image: &'a Image,
    /// What every sample holds before the draws; None: what is there.
    pub clear: Option<vk::ClearColorValue>,
}

/// Which layers of its attachments a rendering draws into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layers {
    /// The first; of plain images the only one.
    First,
    One(u32),
    /// So many, and shaders say which.
    All(u32),
}

impl Layers {
    fn view(self, image: &Image) -> vk::ImageView {
        match self {
            Self::One(layer) => image.layer_views[layer as usize],
            Self::First | Self::All(_) => image.view,
        }
    }

    fn count(self) -> u32 {
        if let Self::All(count) = self { count } else { 1 }
    }
}

impl<'a> ColorTarget<'a> {
    pub fn new(image: &'a Image, clear: Option<vk::ClearColorValue>) -> Self {
        Self { image, clear }
    }

    fn info(&self, layers: Layers) -> vk::RenderingAttachmentInfo<'static> {
        vk::RenderingAttachmentInfo::default()
            .image_view(layers.view(self.image))
            .image_layout(Access::ColorWrite.layout())
            .load_op(load(self.clear.is_some()))
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue { color: self.clear.unwrap_or_default() })
    }
}

fn load(clears: bool) -> vk::AttachmentLoadOp {
    if clears { vk::AttachmentLoadOp::CLEAR } else { vk::AttachmentLoadOp::LOAD }
}

impl Commands {
    /// Opens rendering into whole images of `extent`. A depth image that has a stencil too is attached as both, and both
    /// are cleared; a clear value of None loads what is there.
    pub fn begin_rendering(
        &mut self,
        extent: Extent,
        colors: &[ColorTarget<'_>],
        depth: Option<(&Image, Option<f32>, Access)>,
    ) {
        self.begin_layers(extent, Layers::First, colors, depth);
    }

    /// Begins rendering into layers of arrays.
    pub fn begin_layers(
        &mut self,
        extent: Extent,
        layers: Layers,
        colors: &[ColorTarget<'_>],
        depth: Option<(&Image, Option<f32>, Access)>,
    ) {
        for color in colors {
            self.check_attached(color.image, Access::ColorWrite);
        }
        if let Some((image, _, access)) = depth {
            self.check_attached(image, access);
        }
        let color_infos: Vec<_> = colors.iter().map(|color| color.info(layers)).collect();
        let depth_stencil_info = |aspect| {
            depth.filter(|(image, ..)| image.aspect().contains(aspect)).map(|(image, clear, access)| {
                let value = vk::ClearDepthStencilValue { depth: clear.unwrap_or_default(), stencil: 0 };
                let stores = access.writes_aspect(aspect);
                vk::RenderingAttachmentInfo::default()
                    .image_view(layers.view(image))
                    .image_layout(access.layout())
                    .load_op(load(clear.is_some()))
                    // A store is a write, which what is sampled meanwhile may not have.
                    .store_op(if stores { vk::AttachmentStoreOp::STORE } else { vk::AttachmentStoreOp::NONE })
                    .clear_value(vk::ClearValue { depth_stencil: value })
            })
        };
        let depth_info = depth_stencil_info(vk::ImageAspectFlags::DEPTH);
        let stencil_info = depth_stencil_info(vk::ImageAspectFlags::STENCIL);
        let area = vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent: vk::Extent2D { width: extent.width, height: extent.height },
        };
        let mut info =
            vk::RenderingInfo::default().render_area(area).layer_count(layers.count()).color_attachments(&color_infos);
        if let Some(depth_info) = &depth_info {
            info = info.depth_attachment(depth_info);
        }
        if let Some(stencil_info) = &stencil_info {
            info = info.stencil_attachment(stencil_info);
        }
        // SAFETY: the buffer is being recorded; the images are alive and in the layouts that the caller's barriers left.
        unsafe { self.gpu.device.cmd_begin_rendering(self.buffer(), &info) };
        for color in colors {
            self.note_attached(color.image, layers, color.clear.is_some(), true);
        }
        if let Some((image, clear, access)) = depth {
            self.note_attached(image, layers, clear.is_some(), access.writes());
        }
        self.set_window([0, 0], extent);
        if let Some(places) = &self.places {
            places.set(&self.gpu, self.buffer());
        }
    }

    /// Places the samples of what is drawn from here on by pipelines, and into images, whose samples are placed: as many of them as
    /// there are places, px from the upper left corners of their pixels. The device can do so (`Caps::placed_sample_counts`).
    pub fn place_samples(&mut self, places_px: impl IntoIterator<Item = [f32; 2]>) {
        self.places = Some(SamplePlaces::new(places_px));
    }

    pub fn end_rendering(&mut self) {
        // SAFETY: opened by `begin_rendering`.
        unsafe { self.gpu.device.cmd_end_rendering(self.buffer()) };
    }

    /// An attachment is loaded, or cleared, and stored: all of its layers that are drawn into.
    fn note_attached(&self, image: &Image, layers: Layers, clears: bool, stores: bool) {
        let drawn = match layers {
            Layers::First => 0..1,
            Layers::One(layer) => layer..layer + 1,
            Layers::All(count) => 0..count,
        };
        if !clears {
            self.note(&image.marked, false, Part::Layers(drawn.clone()));
        }
        if clears || stores {
            self.note(&image.marked, true, Part::Layers(drawn));
        }
    }

    /// A programmer's mistake: rendering begins, and no barrier has brought an attachment there.
    fn check_attached(&self, image: &Image, access: Access) {
        if cfg!(debug_assertions) {
            let truth = self.truth.get(&image.target()).copied().unwrap_or_default();
            assert!(
                truth.contains(access.into()),
                "{} is attached as {access:?}, but the last barriers left {truth:?}",
                image.name
            );
        }
    }
}

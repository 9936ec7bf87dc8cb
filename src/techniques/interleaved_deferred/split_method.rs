//! The methods of `--split`: how the pixels of one light subset are brought together. Segovia 2006, sections 3.1 to
//! 3.3.

use super::sub_buffers::{Stage, Storage};
use crate::caps::{Ability, Caps, Need};
use crate::choice::choices;
use crate::error::{Error, Result};
use crate::gpu::shader::structs::MappingParams;
use crate::settings::Values;
use crate::techniques::interleaved_deferred::resources::NAME;

choices! {
    /// The words of the methods (`--split`).
    pub enum Split {
        "none" => None,
        "subsample" => Subsample,
        "stencil" => Stencil,
        "depth" => Depth,
        "branch" => Branch,
        "indirect" => Indirect,
        "remap" => Remap,
        "one-pass" => OnePass,
        "two-pass" => TwoPass,
        "tile" => Tile,
        "layered" => Layered,
        "fragment" => Fragment,
    }
}

impl Split {
    /// Those that copy into sub-buffers.
    pub const COPYING: &[Self] = &[Self::OnePass, Self::TwoPass, Self::Tile, Self::Layered, Self::Fragment];
}

choices! {
    /// What shades sub-buffers (`--shade-by`).
    pub enum ShadeBy {
        /// A compute shader.
        "dispatch" => Dispatch,
        /// A draw each, in a viewport that is the sub-buffer.
        "viewport" => Viewport,
        /// A draw each, of a quad on the sub-buffer.
        "quad" => Quad,
    }
}

choices! {
    /// Where sub-buffers lie (`--storage`).
    pub enum StorageKind {
        "buffer" => Buffer,
        "image" => Image,
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SplitMethod {
    /// Every light on every pixel: plain deferred shading, another sum.
    None,
    /// All lights at one pixel of each pattern, interpolated: another sum.
    Subsample,
    /// n x m draws over the frame, each passing its subset's pixels by a test.
    Masked(MaskKind),
    /// One pass over the un-split G-buffer, each pixel looping over its own subset.
    Branch,
    /// A dispatch a subset over the un-split G-buffer, at the pattern's stride.
    Indirect,
    /// The same in one dispatch, workgroups numbered by subset.
    Remap,
    /// A copy into sub-buffers, and the irradiance back.
    Copy(Copies),
}

/// What a masked split tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskKind {
    Stencil,
    Depth,
}

/// How a split copies, there and back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copies {
    pub by: Copier,
    pub storage: Storage,
    pub form: Form,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copier {
    /// A compute shader that moves each texel at once (3.2).
    OnePass,
    /// One that splits blocks, one that moves sub-blocks (3.3).
    TwoPass,
    /// A block at a time through workgroup memory.
    Tile,
    /// A fragment program and a look-up texture (3.2).
    OneFragmentPass,
    /// Two of them, as the paper ran it (4.2).
    TwoFragmentPasses,
}

choices! {
    /// Texels that a thread of a copy handles (`--copy`).
    pub enum Form {
        /// A texel written, or two.
        "pull" => Pull,
        /// A texel read, or two.
        "push" => Push,
    }
}

/// What works without images.
const SUPPORT_BUFFERS: &str = "--split one-pass, two-pass and tile support --storage buffer";

impl SplitMethod {
    /// The split that `--split`, `--storage`, `--copy` and `--fragment-passes` ask for on a device.
    ///
    /// Errors: they contradict each other (exit code 2).
    pub fn new(values: &Values, caps: &Caps) -> Result<Self> {
        let split = values.choice("split");
        let by = match split {
            Split::None => return Ok(Self::None),
            Split::Subsample => return Ok(Self::Subsample),
            Split::Stencil => return Ok(Self::Masked(MaskKind::Stencil)),
            Split::Depth => return Ok(Self::Masked(MaskKind::Depth)),
            Split::Branch => return Ok(Self::Branch),
            Split::Indirect => return Ok(Self::Indirect),
            Split::Remap => return Ok(Self::Remap),
            Split::OnePass | Split::Layered => Copier::OnePass,
            Split::TwoPass => Copier::TwoPass,
            Split::Tile => Copier::Tile,
            Split::Fragment if values.integer("fragment-passes") == 1 => Copier::OneFragmentPass,
            Split::Fragment => Copier::TwoFragmentPasses,
        };
        let form = values.choice("copy");
        if form == Form::Push && matches!(split, Split::Tile | Split::Fragment) {
            return Err(knows_one_form(split));
        }
        let is_drawn = !values.is("shade-by", ShadeBy::Dispatch);
        if is_drawn && split == Split::Layered {
            return Err(draws_into_one_image(values.choice("shade-by"), "--split layered"));
        }
        let asked = values.unless_auto("storage", Values::choice);
        if is_drawn && asked == Some(StorageKind::Buffer) {
            return Err(draws_into_one_image(values.choice("shade-by"), "--storage buffer"));
        }
        let storage = storage(split, if is_drawn { Some(StorageKind::Image) } else { asked }, caps)?;
        Ok(Self::Copy(Copies { by, storage, form }))
    }

    /// What it needs of a device.
    pub fn needs(self, values: &Values) -> Vec<Need> {
        let split: Split = values.choice("split");
        let mut needs = Vec::new();
        let mut need = |of: String, ability, instead| needs.push(Need { of, ability, instead });
        match self {
            Self::Masked(MaskKind::Stencil) => {
                need("--split stencil".to_owned(), Ability::DepthWithStencil, "--split depth tests a depth buffer");
            }
            Self::Copy(copies) if copies.storage != Storage::Buffer => {
                let (of, instead) = match (split, values.choice("shade-by")) {
                    (_, by @ (ShadeBy::Viewport | ShadeBy::Quad)) => {
                        (format!("--shade-by {}", by.name()), "--shade-by dispatch shades buffers too")
                    }
                    (Split::Layered | Split::Fragment, _) => (format!("--split {}", split.name()), SUPPORT_BUFFERS),
                    _ => ("--storage image".to_owned(), SUPPORT_BUFFERS),
                };
                need(of, Ability::StoreWordPairs, instead);
            }
            _ => {}
        }
        needs
    }

    /// How it copies; None where nothing is copied.
    pub fn copies(self) -> Option<Copies> {
        match self {
            Self::Copy(copies) => Some(copies),
            _ => None,
        }
    }

    /// Whether all lights are summed at each pixel that is shaded.
    pub fn sums_all(self) -> bool {
        matches!(self, Self::None | Self::Subsample)
    }
}

/// The storage that `--storage` asks for.
///
/// Errors: the split does not support it (exit code 2).
fn storage(split: Split, asked: Option<StorageKind>, caps: &Caps) -> Result<Storage> {
    let needs_images = matches!(split, Split::Layered | Split::Fragment);
    let stores_words = caps.features.storage_image_extended_formats;
    match asked {
        Some(StorageKind::Buffer) if needs_images => Err(needs_image(split)),
        Some(StorageKind::Buffer) => Ok(Storage::Buffer),
        None if !needs_images && (caps.identity.is_software() || !stores_words) => Ok(Storage::Buffer),
        _ if split == Split::Layered => Ok(Storage::Layers),
        _ => Ok(Storage::Image),
    }
}

fn needs_image(split: Split) -> Error {
    let why = match split {
        Split::Layered => "its sub-buffers are the layers of an image",
        _ => "fragment programs draw into images",
    };
    Error::request(format!("{NAME}: --split {} with --storage buffer: {why}", split.name()))
        .note("--storage image or auto; --split one-pass, two-pass and tile support buffers")
}

fn draws_into_one_image(by: ShadeBy, with: &str) -> Error {
    Error::request(format!(
        "{NAME}: --shade-by {} with {with}: draws need the sub-buffers tiled in one image",
        by.name()
    ))
    .note("--storage image with --split one-pass, two-pass, tile or fragment; --shade-by dispatch shades all")
}

fn knows_one_form(split: Split) -> Error {
    let why = match split {
        Split::Tile => "a workgroup reads and writes its block in order, both ways",
        _ => "a fragment program writes the texel at its own place",
    };
    Error::request(format!("{NAME}: --split {} with --copy push: {why}", split.name()))
        .note("--copy pull; --split one-pass, two-pass and layered support both forms")
}

impl Copies {
    /// What runs on each texel.
    pub fn stage(self) -> Stage {
        match self.by {
            Copier::OnePass | Copier::TwoPass | Copier::Tile => Stage::Compute,
            Copier::OneFragmentPass | Copier::TwoFragmentPasses => Stage::Fragment,
        }
    }

    /// Whether it goes through the block layout.
    pub fn is_two_pass(self) -> bool {
        matches!(self.by, Copier::TwoPass | Copier::TwoFragmentPasses)
    }

    /// Whether it reads `--block`.
    pub fn has_blocks(self) -> bool {
        self.is_two_pass() || self.by == Copier::Tile
    }

    /// Texels that a thread moves: the RUN of sub_buffers.glsl.
    fn run(self) -> u32 {
        if self.storage == Storage::Buffer { 2 } else { 1 }
    }

    /// Threads for the texels of all sub-buffers.
    pub fn sub_buffer_threads(self, mapping: &MappingParams) -> [u32; 3] {
        [mapping.sub_width_px / self.run(), mapping.sub_height_px, mapping.subset_count()]
    }

    /// Threads for the pixels of the padded frame, or the texels of the block layout.
    pub fn padded_threads(self, mapping: &MappingParams) -> [u32; 3] {
        let padded = mapping.padded();
        [padded.width / self.run(), padded.height, 1]
    }

    /// Threads for the pixels of the frame, two each: frame order is always a buffer.
    pub fn frame_threads(mapping: &MappingParams) -> [u32; 3] {
        [mapping.row_pitch() / 2, mapping.height_px, 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use crate::techniques::interleaved_deferred::settings::SETTINGS;

    fn storage_on(driver: &str, stores_words: bool, split: &str, storage: &str) -> Result<Storage> {
        let mut caps = known::caps(driver).unwrap();
        caps.features.storage_image_extended_formats = stores_words;
        let mut values = Values::defaults(SETTINGS);
        for (key, text) in [("split", split), ("storage", storage)] {
            values.set(SETTINGS.iter().find(|setting| setting.key == key).unwrap(), text).unwrap();
        }
        Ok(SplitMethod::new(&values, &caps)?.copies().expect("it copies").storage)
    }

    #[test]
    fn auto_is_what_the_device_and_the_split_do_best() {
        for (driver, stores_words, split, storage) in [
            ("lavapipe-22.3.6", true, "one-pass", Storage::Buffer),
            ("intel-arc-a770", true, "one-pass", Storage::Image),
            ("intel-arc-a770", false, "two-pass", Storage::Buffer),
            ("lavapipe-22.3.6", true, "layered", Storage::Layers),
            ("lavapipe-22.3.6", true, "fragment", Storage::Image),
        ] {
            assert_eq!(storage_on(driver, stores_words, split, "auto").unwrap(), storage, "{split} on {driver}");
        }
        assert_eq!(storage_on("lavapipe-22.3.6", true, "tile", "image").unwrap(), Storage::Image);
        assert_eq!(storage_on("intel-arc-a770", true, "tile", "buffer").unwrap(), Storage::Buffer);
    }
}

//! Granules of a resource: the pieces in which what is touched is counted. Numbers only.

use std::ops::Range;

/// What a resource is, as far as its granules go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Buffer { bytes: u64, granule_bytes: u64 },
    Image(Texels),
}

/// An image in blocks of texels, each of as many bytes as a granule, or fewer where the texels do not come out even.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texels {
    pub size: [u32; 2],
    /// Layers times samples, or slices.
    pub layers: u32,
    pub levels: u32,
    pub samples: u32,
    pub texel_bytes: u32,
    /// log2 of the texels of a block, across and down.
    pub block: [u32; 2],
}

/// A part of a resource.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Part {
    /// A stretch of a buffer.
    Bytes(Range<u64>),
    /// Layers of an image's finest level.
    Layers(Range<u32>),
    All,
}

impl Texels {
    /// An image of one level, one layer and one sample, whose texels are of `texel_bytes`.
    pub fn new(size: [u32; 2], texel_bytes: u32, granule_bytes: u64) -> Self {
        let bits = (granule_bytes / u64::from(texel_bytes)).max(1).ilog2();
        Self { size, layers: 1, levels: 1, samples: 1, texel_bytes, block: [bits.div_ceil(2), bits / 2] }
    }

    fn level_size(&self, level: u32) -> [u32; 2] {
        self.size.map(|side| (side >> level).max(1))
    }

    fn level_blocks(&self, level: u32) -> [u64; 2] {
        let size = self.level_size(level);
        [0, 1].map(|axis| u64::from(size[axis].div_ceil(1 << self.block[axis])))
    }

    /// Granules of a level, all layers.
    fn level_granules(&self, level: u32) -> u64 {
        self.level_blocks(level).iter().product::<u64>() * u64::from(self.layers)
    }

    /// Level and bytes of a granule: those at an edge have fewer.
    fn granule(&self, mut index: u64) -> (u32, u64) {
        let mut level = 0;
        while index >= self.level_granules(level) {
            index -= self.level_granules(level);
            level += 1;
        }
        let [across, down] = self.level_blocks(level);
        let place = [index % across, index / across % down];
        let size = self.level_size(level);
        let texels: u64 = [0, 1]
            .map(|axis| {
                let begin = place[axis] << self.block[axis];
                u64::from(size[axis]).min(begin + (1 << self.block[axis])) - begin
            })
            .iter()
            .product();
        (level, texels * u64::from(self.texel_bytes))
    }

    /// Bytes of a level, all layers.
    fn level_bytes(&self, level: u32) -> u64 {
        let [width, height] = self.level_size(level).map(u64::from);
        width * height * u64::from(self.layers * self.texel_bytes)
    }
}

impl Shape {
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Buffer { bytes, .. } => *bytes,
            Self::Image(texels) => (0..texels.levels).map(|level| texels.level_bytes(level)).sum(),
        }
    }

    pub fn granule_count(&self) -> u64 {
        match self {
            Self::Buffer { bytes, granule_bytes } => bytes.div_ceil(*granule_bytes),
            Self::Image(texels) => (0..texels.levels).map(|level| texels.level_granules(level)).sum(),
        }
    }

    /// Bytes of each level, or of the one that a buffer is.
    pub fn level_bytes(&self) -> Vec<u64> {
        match self {
            Self::Buffer { bytes, .. } => vec![*bytes],
            Self::Image(texels) => (0..texels.levels).map(|level| texels.level_bytes(level)).collect(),
        }
    }

    /// Bytes of the granules that `marks`, 32 a word, have, by level.
    pub fn marked_bytes(&self, marks: &[u32]) -> Vec<u64> {
        let mut bytes = vec![0; self.level_bytes().len()];
        for (word, marks) in marks.iter().enumerate().filter(|(_, marks)| **marks != 0) {
            for bit in (0..32).filter(|bit| marks >> bit & 1 == 1) {
                let granule = 32 * word as u64 + bit;
                let (level, more) = match self {
                    Self::Buffer { bytes, granule_bytes } => {
                        (0, (*bytes).min((granule + 1) * granule_bytes) - granule * granule_bytes)
                    }
                    Self::Image(texels) => texels.granule(granule),
                };
                bytes[level as usize] += more;
            }
        }
        bytes
    }

    /// Granules of a part, and its bytes.
    pub fn part(&self, part: &Part) -> (Range<u64>, u64) {
        match (self, part) {
            (Self::Buffer { granule_bytes, .. }, Part::Bytes(range)) if !range.is_empty() => {
                (range.start / granule_bytes..range.end.div_ceil(*granule_bytes), range.end - range.start)
            }
            (Self::Image(texels), Part::Layers(layers)) => {
                let [each, each_bytes] = [texels.level_granules(0), texels.level_bytes(0)]
                    .map(|all| all / u64::from(texels.layers) * u64::from(texels.samples));
                let [first, end] = [layers.start, layers.end].map(u64::from);
                (first * each..end * each, (end - first) * each_bytes)
            }
            (_, Part::All) => (0..self.granule_count(), self.bytes()),
            (_, _) => (0..0, 0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn granules_of_an_image_are_blocks_and_sum_up_to_it() {
        // Blocks of 4x4 texels: 3x2 of the first level, 2x1 of the second, one of the third.
        let shape = Shape::Image(Texels { levels: 3, ..Texels::new([10, 5], 4, 64) });
        assert_eq!((shape.granule_count(), shape.bytes()), (9, 4 * (50 + 10 + 2)));
        assert_eq!(shape.marked_bytes(&[0x1ff]), [200, 40, 8]);
        // The block at the right end of the first row, and the one below its left neighbour.
        assert_eq!(shape.marked_bytes(&[1 << 2 | 1 << 4]), [4 * (2 * 4 + 4), 0, 0]);
        // The second level's last.
        assert_eq!(shape.marked_bytes(&[1 << 7]), [0, 4 * 2, 0]);
    }

    #[test]
    fn a_buffer_s_last_granule_ends_with_it() {
        let shape = Shape::Buffer { bytes: 150, granule_bytes: 64 };
        assert_eq!(shape.granule_count(), 3);
        assert_eq!(shape.marked_bytes(&[0b110]), [64 + 22]);
        assert_eq!(shape.part(&Part::Bytes(60..70)), (0..2, 10));
        assert_eq!(shape.part(&Part::Bytes(64..64)), (0..0, 0));
        assert_eq!(shape.part(&Part::All), (0..3, 150));
    }

    #[test]
    fn a_layer_has_its_samples() {
        let shape = Shape::Image(Texels { layers: 3 * 4, samples: 4, ..Texels::new([8, 4], 4, 64) });
        assert_eq!(shape.bytes(), 8 * 4 * 4 * 4 * 3);
        assert_eq!(shape.part(&Part::Layers(1..2)), (8..16, 8 * 4 * 4 * 4));
    }
}

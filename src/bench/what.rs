//! What a benchmark times: a whole frame, or the passes of one stage of it.

use crate::gpu::commands::{RecordedPass, Submits};
use crate::settings::Values;

/// The word after `bench`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    Split,
    Shade,
    Gather,
    Filter,
    Frame,
}

impl What {
    pub const ALL: [Self; 5] = [Self::Split, Self::Shade, Self::Gather, Self::Filter, Self::Frame];

    /// As the command line and the rows write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Split => "split",
            Self::Shade => "shade",
            Self::Gather => "gather",
            Self::Filter => "filter",
            Self::Frame => "frame",
        }
    }

    /// One line for the help.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Split => {
                "Copy of the G-buffer into sub-buffers, beside the same kernel at pattern 1x1 and vkCmdCopyBuffer"
            }
            Self::Shade => "Pass that shades with the lights of the subsets, in nanoseconds an evaluation",
            Self::Gather => {
                "Copy of the irradiance back to the frame, beside the same kernel at 1x1 and vkCmdCopyBuffer"
            }
            Self::Filter => "Discontinuity buffer and the filter that reads it, in nanoseconds a pixel and a tap",
            Self::Frame => "Whole frames, one submit each",
        }
    }

    /// The row's key of its times.
    pub fn time_key(self) -> &'static str {
        if self == Self::Frame { "frame_ms" } else { "stage_ms" }
    }

    /// A stage is timed by the wall clock of a submit a pass.
    pub fn submits(self) -> Submits {
        if self == Self::Frame { Submits::One } else { Submits::PerPass }
    }

    /// Whether it moves texels and computes nothing, so that a plain copy is its measure.
    pub fn copies(self) -> bool {
        matches!(self, Self::Split | Self::Gather)
    }

    /// Indices of the passes that belong to it: `TECHNIQUE.STAGE` and `TECHNIQUE.STAGE.*`, of a frame all.
    pub fn passes(self, technique: &str, passes: &[RecordedPass]) -> Vec<usize> {
        let stages: &[&str] = match self {
            Self::Frame => return (0..passes.len()).collect(),
            // The filter has no other reader of its flags.
            Self::Filter => &["discontinuity", "filter"],
            _ => &[self.name()],
        };
        let belongs = |name: &str| {
            let stage = name.strip_prefix(technique).and_then(|rest| rest.strip_prefix('.'));
            stage.is_some_and(|stage| {
                stages
                    .iter()
                    .any(|known| stage.strip_prefix(known).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
            })
        };
        passes.iter().enumerate().filter(|(_, pass)| belongs(&pass.name)).map(|(index, _)| index).collect()
    }

    /// Whether its work is done in passes that do other work too.
    pub fn is_fused(self, values: &Values) -> bool {
        let mut settings = values.iter();
        matches!(self, Self::Gather | Self::Filter) && settings.any(|(key, text)| key == "fuse" && text == "on")
    }

    /// Why a frame with these settings has none of its passes, or none that do nothing else.
    pub fn absence(self, technique: &str, values: &Values) -> String {
        let text = |key: &str| values.iter().find(|(known, _)| *known == key).map(|(_, text)| text);
        match (self, text("split"), text("pattern"), text("filter")) {
            _ if self.is_fused(values) => {
                format!("--fuse on: {technique} has no passes of the {} alone", self.name())
            }
            (Self::Split, Some(split), ..) => format!("--split {split} makes no copy"),
            (Self::Gather, Some(split), ..) => format!("--split {split} makes no copy, and gathers nothing"),
            (Self::Filter, .., Some("none")) => "--filter none filters nothing".to_owned(),
            (Self::Filter, Some(split), Some(pattern), _) => {
                format!("--split {split} --pattern {pattern} is not interleaved: nothing is filtered")
            }
            _ => format!("{technique} has no pass {technique}.{}", self.name()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Traffic;

    #[test]
    fn a_stage_is_its_pass_and_the_passes_below_it() {
        let names = [
            "t.gbuffer",
            "t.split.blocks",
            "t.split.translate",
            "t.splitting",
            "t.shade",
            "t.discontinuity",
            "t.filter",
        ];
        let passes = names.map(|name| RecordedPass { name: name.to_owned(), traffic: Traffic::default() });
        assert_eq!(What::Split.passes("t", &passes), [1, 2]);
        assert_eq!(What::Shade.passes("t", &passes), [4]);
        assert_eq!(What::Filter.passes("t", &passes), [5, 6]);
        assert_eq!(What::Gather.passes("t", &passes), [0usize; 0]);
        assert_eq!(What::Frame.passes("t", &passes).len(), 7);
        assert_eq!(What::Split.passes("other", &passes), [0usize; 0]);
    }
}

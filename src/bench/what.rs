//! What a benchmark times: a whole frame, or one stage of it.

use crate::error::{Error, Result};
use crate::gpu::commands::Submits;
use crate::techniques::bench_stage::BenchStage;
use crate::techniques::{self, Technique};

/// The word after `bench`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    Frame,
    /// The stage of this name, of each technique that has it.
    Stage(&'static str),
}

impl What {
    /// Every stage once, in the order of the techniques, and the frame.
    pub fn all() -> Vec<Self> {
        let mut all: Vec<Self> = Vec::new();
        for stage in techniques::ALL.iter().flat_map(|technique| technique.bench_stages()) {
            if !all.contains(&Self::Stage(stage.name)) {
                all.push(Self::Stage(stage.name));
            }
        }
        all.push(Self::Frame);
        all
    }

    /// As the command line and the rows write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Stage(name) => name,
        }
    }

    /// One line for the help.
    pub fn summary(self) -> String {
        let stages = self.stages();
        match &stages[..] {
            [] => "Whole frames, one submit each".to_owned(),
            [(first, stage), others @ ..] => {
                let others: Vec<&str> = others.iter().map(|(technique, _)| *technique).collect();
                let also = if others.is_empty() { String::new() } else { format!("; also of {}", others.join(", ")) };
                format!("{} ({first}{also})", stage.summary)
            }
        }
    }

    /// Techniques with a stage of this name, each with its own; none for frames.
    pub fn stages(self) -> Vec<(&'static str, &'static BenchStage)> {
        let named = |technique: &&'static dyn Technique| {
            let stage = technique.bench_stages().iter().find(|stage| self == Self::Stage(stage.name))?;
            Some((technique.name(), stage))
        };
        techniques::ALL.iter().filter_map(named).collect()
    }

    /// The stage of `technique`; None for frames.
    ///
    /// Errors: it has no such stage (exit code 2, and which it has).
    pub fn stage_of(self, technique: &dyn Technique) -> Result<Option<&'static BenchStage>> {
        let Self::Stage(name) = self else { return Ok(None) };
        let stages = technique.bench_stages();
        stages.iter().find(|stage| stage.name == name).map(Some).ok_or_else(|| {
            let names: Vec<&str> = stages.iter().map(|stage| stage.name).collect();
            let (its_own, technique) = (names.join(", "), technique.name());
            Error::request(format!("{technique} has no stage {name}; `bench` times its stages {its_own}, and frame"))
        })
    }

    /// A stage is timed by the wall clock of a submit a pass.
    pub fn submits(self) -> Submits {
        if self == Self::Frame { Submits::One } else { Submits::PerPass }
    }

    /// Whether it moves texels and computes nothing, so that a plain copy is its measure.
    pub fn copies(self) -> bool {
        self.stages().iter().any(|(_, stage)| stage.copying().is_some())
    }

    /// The setting whose best value a sweep of it tells; None where there is none.
    pub fn tuned(self) -> Option<&'static str> {
        self.stages().iter().find_map(|(_, stage)| Some(stage.copying()?.tuned))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stage_is_named_once_and_says_whose_it_is() {
        let all = What::all();
        let mut names: Vec<&str> = all.iter().map(|what| what.name()).collect();
        assert!(!names.contains(&"rays"), "a verb of its own");
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
        let shade = What::Stage("shade").summary();
        assert!(shade.contains("(interleaved_deferred; also of deep_shading, deferred, forward)"), "{shade}");
        assert!(What::Stage("split").copies() && !What::Stage("shade").copies() && !What::Frame.copies());
        assert_eq!(What::Stage("gather").tuned(), Some("block"));
        for technique in techniques::ALL {
            let own: Vec<&str> = technique.bench_stages().iter().map(|stage| stage.name).collect();
            assert!(!own.is_empty() && own.iter().all(|name| all.contains(&What::Stage(name))), "{own:?}");
        }
    }

    #[test]
    fn a_technique_without_a_stage_says_which_it_has() {
        let deferred = techniques::find("deferred").unwrap();
        let error = What::Stage("gather").stage_of(deferred).err().unwrap();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(
            error.message(),
            "deferred has no stage gather; `bench` times its stages gbuffer, cull, shade, and frame"
        );
        assert!(What::Frame.stage_of(deferred).unwrap().is_none());
    }
}

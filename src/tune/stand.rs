//! The stand on which candidates are measured: groups beside the baseline, A B A B, without the rows of `bench`.

use super::halving::{FIRST_ROUNDS, Trial};
use crate::bench::candidate::Candidate;
use crate::bench::group::{BASELINE, Group, MOST_VARIANTS, Measurement};
use crate::bench::rounds::Length;
use crate::bench::variant::Variant;
use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::progress::Stage;
use std::collections::VecDeque;
use std::rc::Rc;
use std::time::Instant;

/// What is done with the picture of a candidate.
pub type Look<'a> = &'a mut dyn FnMut(usize, &Picture) -> Result<()>;

pub struct Stand<'a> {
    /// The request's.
    pub measurement: Measurement<'a>,
    pub candidates: &'a [Candidate],
    pub baseline: Rc<Variant>,
    /// No group of the first rung begins after it.
    pub first_until: Instant,
    /// No group of the others does.
    pub again_until: Instant,
    /// Frames that were measured, those of the baseline and those that warm up among them.
    pub frames: usize,
    /// Candidates that the device or its memory refused.
    pub refused: Vec<(usize, Error)>,
}

impl Stand<'_> {
    /// As `Trial::ratios`, until no time is left; `look` sees the picture of each.
    ///
    /// Errors: as `Trial::ratios`, and those of `look`.
    pub fn measure(
        &mut self,
        candidates: &[usize],
        rounds: usize,
        until: Instant,
        mut look: Option<Look<'_>>,
    ) -> Result<Vec<(usize, Vec<f64>)>> {
        let mut waiting: VecDeque<usize> = candidates.iter().copied().collect();
        let mut found = Vec::new();
        let stage = Stage::counted("measuring", "candidates");
        while !waiting.is_empty() && Instant::now() < until {
            let mut group = Group::new(&self.baseline, MOST_VARIANTS);
            self.refused.extend(group.fill(&self.measurement, self.candidates, &mut waiting)?);
            if group.members.is_empty() {
                continue;
            }
            if let Some(look) = &mut look {
                let pictures = group.pictures()?;
                for (member, picture) in group.members.iter().zip(&pictures) {
                    look(member.candidate, picture)?;
                }
                self.frames += pictures.len();
            }
            let samples = group.measure(Length { least: rounds, until_interval: None }, &mut |_, _| {})?;
            self.frames += samples.len() * (rounds + 1);
            let baseline = samples[BASELINE].totals_ms();
            for member in &group.members {
                let times = samples[member.probe].totals_ms();
                found.push((member.candidate, times.iter().zip(&baseline).map(|(time, base)| time / base).collect()));
            }
            stage.reach((candidates.len() - waiting.len()) as u64, candidates.len() as u64);
        }
        Ok(found)
    }
}

impl Trial for Stand<'_> {
    fn ratios(&mut self, candidates: &[usize], rounds: usize) -> Result<Vec<(usize, Vec<f64>)>> {
        let until = if rounds == FIRST_ROUNDS { self.first_until } else { self.again_until };
        self.measure(candidates, rounds, until, None)
    }
}

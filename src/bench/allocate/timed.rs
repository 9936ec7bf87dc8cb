//! A script played again and again through one player, as a probe of rounds.

use super::play::{Player, Script};
use crate::bench::rounds::Probe;
use crate::error::{Error, Result};
use std::cell::RefCell;
use std::time::Instant;

/// Operations of a measurement, at least: a replay of a short trace takes microseconds, which no clock tells.
const LEAST_OPERATIONS: usize = 20_000;

/// Plays the whole script as often as makes enough operations.
pub struct Timed<'a> {
    script: &'a Script,
    player: RefCell<Box<dyn Player>>,
    times: usize,
}

impl<'a> Timed<'a> {
    pub fn new(script: &'a Script, player: Box<dyn Player>) -> Self {
        let times = LEAST_OPERATIONS.div_ceil(script.operation_count());
        Self { script, player: RefCell::new(player), times }
    }

    /// Takes and gives of a measurement.
    pub fn operation_count(&self) -> usize {
        self.times * self.script.operation_count()
    }
}

impl Probe for Timed<'_> {
    fn measure(&self) -> Result<Vec<f64>> {
        let mut player = self.player.borrow_mut();
        let start = Instant::now();
        for _ in 0..self.times {
            self.script.play(&mut **player).map_err(|(at, why)| Error::memory(format!("event {at}: {why}")))?;
        }
        Ok(vec![start.elapsed().as_secs_f64() * 1e3])
    }
}

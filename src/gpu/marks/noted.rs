//! What is touched without a shader: noted while it is recorded, and taken when the pass has run.

use super::shape::Part;
use super::{Marked, Marks, Slots};
use std::cell::RefCell;
use std::sync::Arc;

/// A touch that the recording knows.
pub enum Noted {
    Part {
        marked: Arc<Marked>,
        writes: bool,
        part: Part,
    },
    /// A resource by name whose touches nobody counts.
    Unknown(String),
}

/// Notes of a frame that is being recorded, and what its draws are bound to.
#[derive(Default)]
pub struct Notes(RefCell<Open>);

#[derive(Default)]
struct Open {
    /// By pass.
    noted: Vec<(usize, Noted)>,
    slots: Option<Arc<Slots>>,
    streams: Vec<Arc<Marked>>,
    indices: Option<Arc<Marked>>,
}

impl Open {
    /// Slots and streams meet in either order.
    fn join(&self) {
        if let Some(slots) = &self.slots {
            self.streams.iter().zip(0..).for_each(|(stream, index)| slots.set_stream(index, stream));
        }
    }
}

impl Notes {
    pub fn add(&self, pass: usize, noted: Noted) {
        self.0.borrow_mut().noted.push((pass, noted));
    }

    /// Nothing is bound yet.
    pub fn begin_pass(&self) {
        let mut open = self.0.borrow_mut();
        (open.slots, open.indices) = (None, None);
        open.streams.clear();
    }

    /// Draws that follow go by these slots.
    pub fn bind_slots(&self, slots: Arc<Slots>) {
        let mut open = self.0.borrow_mut();
        open.slots = Some(slots);
        open.join();
    }

    pub fn bind_streams(&self, streams: Vec<Arc<Marked>>) {
        let mut open = self.0.borrow_mut();
        open.streams = streams;
        open.join();
    }

    pub fn bind_indices(&self, indices: Arc<Marked>) {
        self.0.borrow_mut().indices = Some(indices);
    }

    pub fn indices(&self) -> Option<Arc<Marked>> {
        self.0.borrow().indices.clone()
    }

    /// Adds those of a pass that has just ended to its marks.
    pub fn add_to(&self, marks: &Marks, pass: usize, name: &str) {
        for (_, noted) in self.0.borrow().noted.iter().filter(|(noted, _)| *noted == pass) {
            match noted {
                Noted::Part { marked, writes, part } => marks.add(name, marked, *writes, part),
                Noted::Unknown(resource) => marks.add_unknown(name, resource),
            }
        }
    }
}

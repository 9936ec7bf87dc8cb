//! Scenes that the program makes itself, seeded.

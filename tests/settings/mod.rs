//! The table of settings.

mod changes;
mod unread;

//! The table of settings.

mod unread;

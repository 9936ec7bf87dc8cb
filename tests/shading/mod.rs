//! Materials and light against closed forms.

mod derivatives;
mod light_units;
mod materials;
mod texture_levels;

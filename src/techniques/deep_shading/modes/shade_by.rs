//! What shades the triangles of lists (`--shade-by`).

use crate::choice::choices;
use crate::settings::Values;
use crate::techniques::deep_shading::modes::lists::Lists;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;

choices! {
    /// What shades the triangles of lists (`--shade-by`).
    pub enum ShadeBy {
        /// A compute shader, entry by entry.
        "compute" => Compute,
        /// The paper's: fragments of a conservative pass over shading space, which look themselves up.
        "fragment" => Fragment,
    }
}

impl ShadeBy {
    /// What shades what lists have; None: there are none.
    pub fn of(values: &Values) -> Option<Self> {
        let has_lists = values.is("shading", ShadingKind::Deep) && !values.is("lists", Lists::None);
        has_lists.then(|| values.choice("shade-by"))
    }
}

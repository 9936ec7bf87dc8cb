//! A built-in scene's parameters as they were given.

/// One value for each parameter of a scene, in its order.
pub struct Values(pub(super) Vec<(&'static str, u64)>);

impl Values {
    pub(super) fn get(&self, key: &str) -> u64 {
        let found = self.0.iter().find(|(name, _)| *name == key);
        found.expect("a scene reads only the parameters that it lists").1
    }
}

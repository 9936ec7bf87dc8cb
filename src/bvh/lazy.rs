//! A scene's trees, made when the first ray asks for them: pictures without rays do not wait for them. Where another
//! moment of the same triangles had a tree, that one is refitted (`bvh::refit`), until its cost has grown too much.

use super::Bvh;
use crate::error::Result;
use crate::scene::{AlphaMode, Scene};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::Instant;

/// The trees of a scene.
pub struct LazyBvh {
    solid: Tree,
    /// With BLEND surfaces, where there are any.
    whole: Tree,
    empty: Bvh,
    /// As `after` has it.
    growth: f64,
    /// Nanoseconds of making trees since `begin_use`.
    made_ns: AtomicU64,
}

/// What was used of a scene's trees: of the one whose cost has grown most, where there are two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeUse {
    /// Nanoseconds that building or refitting took; 0: they were there.
    pub made_ns: u64,
    /// Moments since it was built.
    pub refits: u32,
    /// Its cost (`Bvh::cost`) in parts of that when it was built.
    pub cost: f64,
}

#[derive(Default)]
struct Tree {
    now: OnceLock<AgedBvh>,
    /// One of another moment.
    earlier: Mutex<Option<AgedBvh>>,
    is_used: AtomicBool,
}

/// A tree, and what has become of it since it was built.
struct AgedBvh {
    bvh: Bvh,
    built_cost: f64,
    refits: u32,
}

impl AgedBvh {
    /// Cost in parts of that when it was built.
    fn relative_cost(&self) -> f64 {
        let cost = self.bvh.cost();
        if cost == self.built_cost { 1.0 } else { cost / self.built_cost }
    }

    /// The same over `scene`; None where it costs more than that it may.
    fn refitted(mut self, scene: &Scene, growth: f64) -> Option<Self> {
        self.bvh.refit(scene);
        self.refits += 1;
        (self.relative_cost() <= 1.0 + growth).then_some(self)
    }
}

impl Tree {
    fn get(&self, lazy: &LazyBvh, scene: &Scene, build: impl FnOnce(&Scene) -> Result<Bvh>) -> Result<&Bvh> {
        self.is_used.store(true, Ordering::Relaxed);
        if let Some(aged) = self.now.get() {
            return Ok(&aged.bvh);
        }
        let started = Instant::now();
        let earlier = self.earlier.lock().expect("nobody panics while holding it").take();
        let aged = match earlier.and_then(|earlier| earlier.refitted(scene, lazy.growth)) {
            Some(refitted) => refitted,
            None => {
                let bvh = build(scene)?;
                AgedBvh { built_cost: bvh.cost(), bvh, refits: 0 }
            }
        };
        lazy.made_ns.fetch_add(started.elapsed().as_nanos() as u64, Ordering::Relaxed);
        Ok(&self.now.get_or_init(|| aged).bvh)
    }

    /// For another moment; a moment at which nobody asked for it is passed over.
    fn into_earlier(self) -> Self {
        let earlier = self.earlier.into_inner().expect("nobody panics while holding it");
        Self { earlier: Mutex::new(self.now.into_inner().or(earlier)), ..Self::default() }
    }

    fn used(&self) -> Option<&AgedBvh> {
        self.now.get().filter(|_| self.is_used.load(Ordering::Relaxed))
    }
}

impl Default for LazyBvh {
    fn default() -> Self {
        let [solid, whole] = [Tree::default(), Tree::default()];
        Self { solid, whole, empty: Bvh::empty(), growth: 0.0, made_ns: AtomicU64::new(0) }
    }
}

impl LazyBvh {
    /// Those of the scene `then`, where `earlier` are those of `before`: refitted instead of built, if both scenes have
    /// the same triangles, as long as their cost is at most by the share `growth` greater than when they were built. 0:
    /// never.
    pub fn after(earlier: Self, [before, then]: [&Scene; 2], growth: f64) -> Self {
        let blend =
            |scene: &Scene| scene.drawn_materials().map(|one| one.alpha == AlphaMode::Blend).collect::<Vec<_>>();
        if growth <= 0.0 || !before.has_same_triangles(then) || blend(before) != blend(then) {
            return Self::default();
        }
        let [solid, whole] = [earlier.solid, earlier.whole].map(Tree::into_earlier);
        Self { solid, whole, growth, ..Self::default() }
    }

    /// The tree over `scene`, which must be the same at every call.
    ///
    /// Errors: as `Bvh::build`.
    pub fn over(&self, scene: &Scene) -> Result<&Bvh> {
        self.solid.get(self, scene, Bvh::build)
    }

    /// The tree over all of `scene`, BLEND surfaces included, which must be the same at every call.
    ///
    /// Errors: as `Bvh::build`.
    pub fn whole(&self, scene: &Scene) -> Result<&Bvh> {
        if scene.drawn_materials().all(|material| material.alpha != AlphaMode::Blend) {
            return self.over(scene);
        }
        self.whole.get(self, scene, Bvh::whole)
    }

    /// The tree that no ray meets.
    pub fn empty(&self) -> &Bvh {
        &self.empty
    }

    /// Whatever is asked for from here on counts in `used`.
    pub fn begin_use(&self) {
        self.made_ns.store(0, Ordering::Relaxed);
        [&self.solid, &self.whole].into_iter().for_each(|tree| tree.is_used.store(false, Ordering::Relaxed));
    }

    /// What was asked for since `begin_use`; None: no tree.
    pub fn used(&self) -> Option<TreeUse> {
        let used = [&self.solid, &self.whole].into_iter().filter_map(Tree::used);
        let made_ns = self.made_ns.load(Ordering::Relaxed);
        let of = |aged: &AgedBvh| TreeUse { made_ns, refits: aged.refits, cost: aged.relative_cost() };
        used.map(of).max_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::tests::field;
    use glam::Vec3;

    /// The field with every triangle moved out of its place, neighbours in several directions.
    fn pulled(far: f32) -> Scene {
        let mut scene = field(2, 200);
        for (index, corners) in scene.meshes[0].positions.chunks_mut(3).enumerate() {
            let way = Vec3::new((index % 3) as f32 - 1.0, (index % 5) as f32 - 2.0, (index % 7) as f32 - 3.0);
            corners.iter_mut().for_each(|corner| *corner += far * way);
        }
        scene
    }

    #[test]
    fn a_tree_is_refitted_until_its_cost_has_grown_by_the_share() {
        let lazy = LazyBvh::default();
        lazy.begin_use();
        assert_eq!(lazy.used(), None);
        lazy.over(&pulled(0.0)).unwrap();
        let first = lazy.used().unwrap();
        assert!((first.refits, first.cost) == (0, 1.0) && first.made_ns > 0);
        lazy.begin_use();
        assert_eq!(lazy.used(), None);
        lazy.whole(&pulled(0.0)).unwrap();
        assert_eq!(lazy.used().unwrap().made_ns, 0, "it was there");

        let mut lazy = lazy;
        let (mut builds, mut before) = (0, pulled(0.0));
        for step in 1..=12 {
            let scene = pulled(0.03 * step as f32);
            lazy = LazyBvh::after(lazy, [&before, &scene], 0.3);
            // A moment at which nobody asks is none.
            lazy = LazyBvh::after(lazy, [&scene, &scene], 0.3);
            let nodes = lazy.over(&scene).unwrap().nodes.len();
            let used = lazy.used().unwrap();
            assert!(nodes > 1 && used.cost <= 1.3, "{used:?}");
            builds += u32::from(used.refits == 0);
            assert_eq!(used.refits == 0, used.cost == 1.0, "{used:?}");
            before = scene;
        }
        assert!((2..8).contains(&builds), "{builds} of 12 were built");
    }

    #[test]
    fn only_the_same_triangles_are_refitted_and_without_growth_none() {
        let refits = |then: &Scene, growth: f64| {
            let (lazy, before) = (LazyBvh::default(), pulled(0.0));
            lazy.over(&before).unwrap();
            let lazy = LazyBvh::after(lazy, [&before, then], growth);
            lazy.over(then).unwrap();
            lazy.used().unwrap().refits
        };
        assert_eq!([refits(&pulled(0.001), 0.3), refits(&pulled(0.001), 0.0)], [1, 0]);
        let mut turned = pulled(0.001);
        turned.meshes[0].indices.swap(0, 3);
        let mut twice = pulled(0.001);
        twice.draws.push(twice.draws[0]);
        assert_eq!([refits(&turned, 0.3), refits(&twice, 0.3)], [0, 0]);
        // The same in glass: there is nothing to refit.
        let mut glass = pulled(0.001);
        glass.materials[0].alpha = AlphaMode::Blend;
        assert_eq!(refits(&glass, 0.3), 0);
    }
}

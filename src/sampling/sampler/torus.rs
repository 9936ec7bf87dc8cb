//! Places on a rectangle that repeats, and who is near to whom.

/// Places in buckets.
pub struct Torus {
    sides: [f64; 2],
    places: Vec<[f64; 2]>,
    columns: usize,
    rows: usize,
    /// Indices of the places of each bucket, row by row.
    buckets: Vec<Vec<u32>>,
}

impl Torus {
    /// `places` on a rectangle of these sides, in buckets that hold about one each.
    pub fn new(sides: [f64; 2], places: Vec<[f64; 2]>) -> Self {
        let spacing = (sides[0] * sides[1] / places.len().max(1) as f64).sqrt();
        let mut torus = Self::empty(sides, spacing);
        places.into_iter().for_each(|place| torus.push(place));
        torus
    }

    /// No places yet, on a rectangle of these sides, in buckets that are `bucket_side` wide and high or more.
    pub fn empty(sides: [f64; 2], bucket_side: f64) -> Self {
        let [columns, rows] = sides.map(|side| ((side / bucket_side) as usize).max(1));
        Self { sides, places: Vec::new(), columns, rows, buckets: vec![Vec::new(); columns * rows] }
    }

    /// Adds a place.
    pub fn push(&mut self, place: [f64; 2]) {
        let [column, row] = self.bucket(place);
        self.buckets[row * self.columns + column].push(self.places.len() as u32);
        self.places.push(place);
    }

    pub fn sides(&self) -> [f64; 2] {
        self.sides
    }

    pub fn into_places(self) -> Vec<[f64; 2]> {
        self.places
    }

    pub fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    fn bucket(&self, place: [f64; 2]) -> [usize; 2] {
        let of = |axis: usize, count: usize| ((place[axis] / self.sides[axis] * count as f64) as usize).min(count - 1);
        [of(0, self.columns), of(1, self.rows)]
    }

    /// The shortest way from `from` to a copy of `to`.
    pub fn way(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let way = to[axis] - from[axis];
            way - self.sides[axis] * (way / self.sides[axis]).round()
        })
    }

    /// Square of its length.
    pub fn squared(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let [x, y] = self.way(from, to);
        x * x + y * y
    }

    /// Calls `met` with each place whose bucket is at most `reach` buckets away, once.
    fn around(&self, place: [f64; 2], reach: usize, mut met: impl FnMut(u32)) {
        let [column, row] = self.bucket(place);
        let axis = |middle: usize, count: usize| {
            // All of them where the reach goes around.
            let covered = (2 * reach + 1).min(count);
            let first = if covered == count { 0 } else { middle + count - reach };
            (first..first + covered).map(move |bucket| bucket % count)
        };
        for row in axis(row, self.rows) {
            for column in axis(column, self.columns) {
                self.buckets[row * self.columns + column].iter().for_each(|index| met(*index));
            }
        }
    }

    /// The shorter side of a bucket.
    fn bucket_side(&self) -> f64 {
        (self.sides[0] / self.columns as f64).min(self.sides[1] / self.rows as f64)
    }

    /// Whether a place lies nearer to `place` than `radius`.
    pub fn has_within(&self, place: [f64; 2], radius: f64) -> bool {
        let mut has = false;
        self.around(place, (radius / self.bucket_side()).ceil() as usize, |other| {
            has |= self.squared(place, self.places[other as usize]) < radius * radius;
        });
        has
    }

    /// The nearest place to `place`; there is one.
    pub fn nearest(&self, place: [f64; 2]) -> u32 {
        let side = self.bucket_side();
        let most = self.columns.max(self.rows);
        let mut best = (f64::INFINITY, u32::MAX);
        for reach in 1.. {
            self.around(place, reach, |index| {
                let squared = self.squared(place, self.places[index as usize]);
                // The first of two that are as near.
                if squared < best.0 || squared == best.0 && index < best.1 {
                    best = (squared, index);
                }
            });
            // What lies beyond is at least so many whole buckets away.
            let beyond = side * reach as f64;
            if best.0 <= beyond * beyond || 2 * reach + 1 >= most {
                break;
            }
        }
        best.1
    }

    /// Places no farther than `radius` from the place of an index, but itself, each with the square of its distance.
    pub fn neighbours(&self, index: u32, radius: f64) -> Vec<(u32, f64)> {
        let place = self.places[index as usize];
        let mut found = Vec::new();
        self.around(place, (radius / self.bucket_side()).ceil() as usize, |other| {
            let squared = self.squared(place, self.places[other as usize]);
            if other != index && squared <= radius * radius {
                found.push((other, squared));
            }
        });
        found.sort_unstable_by_key(|(other, _)| *other);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// What buckets find is what a look at all places finds.
        #[test]
        fn the_nearest_is_the_nearest_of_all(
            sides in (0.5f64..9.0, 0.5f64..9.0), places in prop::collection::vec((0f64..1.0, 0f64..1.0), 1..90),
            at in (0f64..1.0, 0f64..1.0), radius in 0.01f64..3.0,
        ) {
            let sides = [sides.0, sides.1];
            let scaled = |(x, y): &(f64, f64)| [x * sides[0], y * sides[1]];
            let torus = Torus::new(sides, places.iter().map(scaled).collect());
            let at = scaled(&at);
            let nearest = torus.nearest(at);
            let squared = |index: u32| torus.squared(at, torus.places()[index as usize]);
            prop_assert!((0..places.len() as u32).all(|index| squared(nearest) <= squared(index)));
            let between = |index: u32| torus.squared(torus.places()[0], torus.places()[index as usize]);
            let expected: Vec<u32> = (1..places.len() as u32).filter(|i| between(*i) <= radius * radius).collect();
            let found: Vec<u32> = torus.neighbours(0, radius).into_iter().map(|(index, _)| index).collect();
            prop_assert_eq!(found, expected);
            prop_assert_eq!(torus.has_within(at, radius), squared(nearest) < radius * radius);
        }
    }
}

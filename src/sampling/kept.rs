//! Points that take long to make, kept in a folder and read from there the next time.
//!
//! Nothing that is found is believed: a file counts when it is as long as it must be and holds its key and the hash of its own
//! numbers. The key has points of a small basis in it, so that what another version of a sampler made is not taken for this one's. A
//! file that cannot be read or written costs time alone: the points are made again.

use super::sampler::{Places, Points, Sampler};
use super::side::Side;
use crate::error::Result;
use crate::whole_file::write_whole;
use std::io::Write;
use std::path::{Path, PathBuf};

/// From so many numbers of all points on making them takes longer than reading them: some tenths of a second.
const LONG_FROM: usize = 1 << 14;
/// Width of the basis of the points in the key, px, and points a pixel.
const SMALL: u32 = 2;

/// What points are asked for, as `Sampler::points` is.
#[derive(Clone, Copy)]
pub struct Asked {
    pub sampler: Sampler,
    pub sides: [Side; 2],
    pub count: u32,
    pub dimensions: usize,
    pub seed: u32,
    pub places: Places,
}

impl Asked {
    /// Makes them.
    ///
    /// Errors: as `Sampler::points`.
    fn make(&self) -> Result<Points> {
        self.sampler.points(self.sides, self.count, self.dimensions, self.seed, self.places)
    }

    fn number_count(&self) -> usize {
        self.count as usize * self.dimensions
    }

    /// Whether they take long: those that are moved until they are well spread, where there are many.
    fn takes_long(&self) -> bool {
        matches!(self.sampler, Sampler::Relaxed | Sampler::BlueErrors) && self.number_count() >= LONG_FROM
    }

    /// The name of what they are, and of how they are made.
    fn key(&self) -> Result<String> {
        let small = Asked { sides: [Side::new(SMALL, 1); 2], count: SMALL * SMALL * SMALL, ..*self };
        let [width, height] = self.sides;
        let Asked { count, dimensions, seed, places, .. } = self;
        let name = self.sampler.name();
        let mut hasher = blake3::Hasher::new();
        hasher.update(format!("{name} {width:?} {height:?} {count} {dimensions} {seed} {places:?}").as_bytes());
        hasher.update(&bytes(&small.make()?));
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// The points: from `folder` where they take long and are there, else made, and kept there if they take long.
///
/// Errors: as `Sampler::points`.
pub fn points(asked: &Asked, folder: Option<&Path>) -> Result<Points> {
    let Some(folder) = folder.filter(|_| asked.takes_long()) else { return asked.make() };
    let key = asked.key()?;
    let path = folder.join(format!("{key}.points"));
    if let Some(points) = read(&path, &key, asked) {
        return Ok(points);
    }
    let points = asked.make()?;
    keep(path, &key, &points);
    Ok(points)
}

fn bytes(points: &Points) -> Vec<u8> {
    points.iter().flatten().flat_map(|number| number.to_le_bytes()).collect()
}

/// What stands before the numbers.
fn head(key: &str, numbers: &[u8]) -> String {
    format!("quincunx points\n{key}\n{}\n", blake3::hash(numbers).to_hex())
}

/// None: there is no such file, or it is not what it should be.
fn read(path: &Path, key: &str, asked: &Asked) -> Option<Points> {
    let (head_bytes, number_bytes) = (head(key, &[]).len(), asked.number_count() * size_of::<f64>());
    if path.metadata().ok()?.len() != (head_bytes + number_bytes) as u64 {
        return None;
    }
    let file = std::fs::read(path).ok()?;
    let (found, numbers) = file.split_at_checked(head_bytes)?;
    if found != head(key, numbers).as_bytes() {
        return None;
    }
    let numbers: Vec<f64> =
        numbers.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight bytes"))).collect();
    let points: Points = numbers.chunks_exact(asked.dimensions).map(<[f64]>::to_vec).collect();
    (points.len() == asked.count as usize).then_some(points)
}

fn keep(path: PathBuf, key: &str, points: &Points) {
    let numbers = bytes(points);
    let is_there = path.parent().is_some_and(|folder| std::fs::create_dir_all(folder).is_ok());
    if is_there {
        // A full disk or a folder that is closed leaves no file, and the next one makes the points again.
        let _ = write_whole(&path, |file| {
            file.write_all(head(key, &numbers).as_bytes())?;
            file.write_all(&numbers)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Asked = Asked {
        sampler: Sampler::BlueErrors,
        sides: [Side { pixels: 64, bases: 1 }, Side { pixels: 64, bases: 1 }],
        count: 1 << 13,
        dimensions: 2,
        seed: 5,
        places: Places::Spread,
    };

    fn files(folder: &Path) -> Vec<PathBuf> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect()
    }

    /// What is kept is read, which a file with other numbers and their hash shows; what is broken is made again.
    #[test]
    fn long_points_are_kept_and_nothing_broken_is_believed() {
        let folder = tempfile::tempdir().unwrap();
        let kept = |asked: &Asked| points(asked, Some(folder.path())).unwrap();
        let made = kept(&LONG);
        let [path] = files(folder.path()).try_into().unwrap();
        let whole = std::fs::read(&path).unwrap();
        let key = LONG.key().unwrap();

        let mut other = made.clone();
        other[0][0] = 0.5;
        keep(path.clone(), &key, &other);
        assert_eq!(kept(&LONG), other);

        let mut changed = whole.clone();
        *changed.last_mut().unwrap() ^= 1;
        for broken in [&whole[..whole.len() - 1], &[], &[&whole[..], &[0]].concat(), &changed] {
            std::fs::write(&path, broken).unwrap();
            assert_eq!(read(&path, &key, &LONG), None, "{} bytes", broken.len());
        }
        assert_eq!(kept(&LONG), made);
        assert_eq!(std::fs::read(&path).unwrap(), whole);
        assert_ne!(Asked { seed: 6, ..LONG }.key().unwrap(), key);
    }

    #[test]
    fn short_points_and_those_of_a_closed_folder_are_made() {
        let folder = tempfile::tempdir().unwrap();
        for short in [Asked { count: 1 << 12, ..LONG }, Asked { sampler: Sampler::R2, ..LONG }] {
            assert_eq!(points(&short, Some(folder.path())).unwrap(), short.make().unwrap());
        }
        assert!(files(folder.path()).is_empty());
        let file = folder.path().join("file");
        std::fs::write(&file, "").unwrap();
        let [closed, none] = [Some(file.join("folder")), None].map(|folder| points(&LONG, folder.as_deref()).unwrap());
        assert_eq!(closed, none);
    }
}

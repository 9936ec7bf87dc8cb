//! The space of a search: every combination of its axes that can be told from the others, once, in classes of one picture.

use crate::bench::candidate::{Candidate, changed, without_unread};
use crate::bench::sweep::{self, Axis, Point, label};
use crate::error::{Error, Result};
use crate::job::Job;
use crate::sampling::pcg::Pcg32;
use crate::settings::{Changes, Values};
use crate::techniques::settings_of;
use std::collections::{BTreeMap, HashMap};

/// Combinations beyond this are refused: each is looked at, if not measured.
const MOST_COMBINATIONS: usize = 100_000;

/// Candidates whose settings make one picture, as `Setting::changes` has it.
pub struct Class {
    /// The settings that make it, of the axes.
    pub label: String,
    /// In the order in which they are tried.
    pub members: Vec<usize>,
}

/// All candidates.
pub struct Space {
    /// Those that can be.
    pub candidates: Vec<Candidate>,
    /// What each of them sets, of the axes that it reads.
    pub points: Vec<Point>,
    pub classes: Vec<Class>,
    /// Combinations of the axes, equal ones and those that cannot be among them.
    pub combinations: usize,
    /// Place of the request's own settings, where the axes have them.
    pub asked: Option<usize>,
    /// Place of a candidate by its settings.
    places: HashMap<String, usize>,
}

impl Space {
    /// `job`: what is not searched. The order in which candidates are tried is drawn from `--seed`.
    ///
    /// Errors: there are too many combinations, or none that can be (exit code 2).
    pub fn new(job: &Job, axes: &[Axis], scene_hash: &str) -> Result<Self> {
        let combinations = axes.iter().try_fold(1_usize, |all, axis| all.checked_mul(axis.values.len()));
        let combinations = combinations.filter(|all| *all <= MOST_COMBINATIONS).ok_or_else(|| {
            Error::request(format!("the axes have more than {MOST_COMBINATIONS} combinations"))
                .note("--sweep names fewer")
        })?;
        let mut space = Self {
            candidates: Vec::new(),
            points: Vec::new(),
            classes: Vec::new(),
            combinations,
            asked: None,
            places: HashMap::new(),
        };
        let mut why = None;
        for full in sweep::grid(axes) {
            match at(job, &full) {
                Ok(values) => {
                    let key = key(&values);
                    if space.places.contains_key(&key) {
                        continue;
                    }
                    let point: Point = full.into_iter().filter(|(key, _)| is_read(job, &values, key)).collect();
                    let candidate = Candidate::new(job, &[], &point, false, scene_hash);
                    if let Err(error) = &candidate.values {
                        why.get_or_insert(error.clone());
                        continue;
                    }
                    space.places.insert(key, space.candidates.len());
                    space.candidates.push(candidate);
                    space.points.push(point);
                }
                Err(error) => {
                    why.get_or_insert(error);
                }
            }
        }
        if space.candidates.is_empty() {
            let error = why.unwrap_or_else(|| Error::request("nothing is searched"));
            return Err(
                Error::request(format!("none of the {combinations} combinations is possible")).note(error.message())
            );
        }
        space.asked = at(job, &Point::new()).ok().and_then(|values| space.places.get(&key(&values)).copied());
        space.classes = classes(job, &space.points, &space.candidates);
        let mut random = Pcg32::new(job.values.integer("seed"), 0);
        space.classes.iter_mut().for_each(|class| random.shuffle(&mut class.members));
        Ok(space)
    }

    /// Candidates that differ from this one in one of the axes, and in what is read, or not, because of that.
    pub fn neighbours(&self, job: &Job, axes: &[Axis], place: usize) -> Vec<usize> {
        let own = &self.points[place];
        // What it does not read may be read by a neighbour: at what the request has, where that is searched.
        let text = |axis: &Axis| {
            let own = own.iter().find(|(key, _)| *key == axis.key).map(|(_, text)| text.as_str());
            let asked = || job.values.get(&axis.key).filter(|text| axis.values.iter().any(|value| value == text));
            own.or_else(asked).unwrap_or(&axis.values[0]).to_owned()
        };
        let full: Point = axes.iter().map(|axis| (axis.key.clone(), text(axis))).collect();
        let mut found = Vec::new();
        for (index, axis) in axes.iter().enumerate() {
            for value in &axis.values {
                let mut point = full.clone();
                point[index].1.clone_from(value);
                let neighbour = at(job, &point).ok().and_then(|values| self.places.get(&key(&values)).copied());
                if let Some(neighbour) = neighbour.filter(|one| *one != place && !found.contains(one)) {
                    found.push(neighbour);
                }
            }
        }
        found
    }

    /// Candidates of these classes, in the order in which they are tried: of each class one in turn.
    pub fn in_turn(&self, classes: &[usize]) -> Vec<usize> {
        let longest = classes.iter().map(|class| self.classes[*class].members.len()).max().unwrap_or(0);
        let in_turn = (0..longest)
            .flat_map(|turn| classes.iter().filter_map(move |class| self.classes[*class].members.get(turn).copied()));
        in_turn.collect()
    }
}

/// The settings of a point, what nothing reads at its default.
fn at(job: &Job, point: &Point) -> Result<Values> {
    let changes = point.iter().map(|(key, text)| (key.as_str(), text.as_str()));
    Ok(without_unread(job.technique, &changed(job, &job.values, changes)?))
}

fn key(values: &Values) -> String {
    values.iter().map(|(key, text)| format!("{key}={text}\n")).collect()
}

fn is_read(job: &Job, values: &Values, key: &str) -> bool {
    settings_of(job.technique).iter().any(|setting| setting.key == key && (setting.unread)(values).is_none())
}

fn classes(job: &Job, points: &[Point], candidates: &[Candidate]) -> Vec<Class> {
    let settings = settings_of(job.technique);
    let changes_picture =
        |key: &str| settings.iter().any(|setting| setting.key == key && setting.changes != Changes::Nothing);
    let mut classes: BTreeMap<String, Class> = BTreeMap::new();
    for (place, (candidate, point)) in candidates.iter().zip(points).enumerate() {
        let values = candidate.values.as_ref().expect("those that cannot be are left out");
        let picture = values.iter().filter(|(key, _)| changes_picture(key));
        let picture: String = picture.map(|(key, text)| format!("{key}={text}\n")).collect();
        let own: Point = point.iter().filter(|(key, _)| changes_picture(key)).cloned().collect();
        let class = classes.entry(picture).or_insert_with(|| Class { label: label(&own), members: Vec::new() });
        class.members.push(place);
    }
    classes.into_values().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques;

    fn space(sweeps: &[&str]) -> (Job, Vec<Axis>, Space) {
        let job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
        let axes = sweep::axes(&sweeps.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>()).unwrap();
        let space = Space::new(&job, &axes, "").unwrap();
        (job, axes, space)
    }

    fn labels(space: &Space, places: &[usize]) -> Vec<String> {
        places.iter().map(|place| label(&space.points[*place])).collect()
    }

    #[test]
    fn combinations_that_come_to_the_same_are_one_candidate() {
        let (_, _, space) = space(&["split=none,one-pass,two-pass", "block=8,16,32", "pattern=2x2,4x4"]);
        assert_eq!(space.asked.map(|place| label(&space.points[place])).unwrap(), "split=one-pass pattern=4x4");
        // Without a split no pattern and no block is read; with one pass no block.
        assert_eq!((space.combinations, space.candidates.len()), (18, 1 + 2 + 6));
        let all: Vec<usize> = (0..space.candidates.len()).collect();
        let labels = labels(&space, &all);
        assert!(labels.contains(&"split=none".to_owned()), "{labels:?}");
        assert!(labels.contains(&"split=one-pass pattern=2x2".to_owned()), "{labels:?}");
        assert!(labels.contains(&"split=two-pass block=32 pattern=4x4".to_owned()), "{labels:?}");
        let pictures: Vec<(&str, usize)> =
            space.classes.iter().map(|class| (class.label.as_str(), class.members.len())).collect();
        assert_eq!(pictures.len(), 5, "{pictures:?}");
        assert!(pictures.contains(&("split=two-pass pattern=2x2", 3)), "{pictures:?}");
    }

    #[test]
    fn neighbours_differ_in_one_setting_and_in_what_it_leaves_unread() {
        let (job, axes, space) = space(&["split=none,one-pass,two-pass", "block=8,16,32", "pattern=2x2,4x4"]);
        let place = |text: &str| space.points.iter().position(|point| label(point) == text).unwrap();
        let of = |text: &str| {
            let mut found = labels(&space, &space.neighbours(&job, &axes, place(text)));
            found.sort();
            found
        };
        assert_eq!(
            of("split=two-pass block=32 pattern=4x4"),
            [
                "split=none",
                "split=one-pass pattern=4x4",
                "split=two-pass block=16 pattern=4x4",
                "split=two-pass block=32 pattern=2x2",
                "split=two-pass block=8 pattern=4x4"
            ]
        );
        assert_eq!(of("split=none"), ["split=one-pass pattern=4x4", "split=two-pass block=16 pattern=4x4"]);
    }

    #[test]
    fn classes_take_turns() {
        let (_, _, space) = space(&["split=two-pass", "block=8,16,32", "pattern=2x2,4x4"]);
        let all = space.in_turn(&[0, 1]);
        let of = |place: &usize| space.classes.iter().position(|class| class.members.contains(place)).unwrap();
        assert_eq!(all[..4].iter().map(of).collect::<Vec<_>>(), [0, 1, 0, 1]);
        assert_eq!((all.len(), space.in_turn(&[1]).len()), (6, 3));
    }

    #[test]
    fn what_cannot_be_searched_is_refused() {
        let job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
        let numbers = (5..400).map(|number| number.to_string()).collect::<Vec<_>>().join(",");
        for (sweeps, why) in [
            (vec![format!("kernel={numbers}"), format!("sigma={numbers}")], "more than 100000"),
            (vec!["kernel=98,99".to_owned()], "none of the 2 combinations is possible"),
        ] {
            let error = Space::new(&job, &sweep::axes(&sweeps).unwrap(), "").err().unwrap();
            assert!(error.exit_code() == 2 && error.message().contains(why), "{error}");
        }
    }
}

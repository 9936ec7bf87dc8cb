//! glTF animations to channels: which property of which node follows which curve.

use std::collections::BTreeSet;

use gltf::json::animation::{Interpolation as JsonInterpolation, Property};
use gltf::json::validation::Checked;
use gltf::{Accessor, Document, json};

use super::buffers::Buffers;
use super::limits::Allowance;
use super::nodes::Hierarchy;
use super::{accessors, label, morph};
use crate::error::{Error, Result};
use crate::scene::animation::{AnimationChoice, Curve, Interpolation, unit_quaternion};
use crate::scene::gltf::motion::{Channel, Motion};

/// How many numbers the curves of a file may have together, beside one for each byte of it: 16 MiB of them.
const FREE_CURVE_NUMBERS: usize = 1 << 22;

/// The channels of the animations that `choice` names, no two of them for the same property of the same node.
///
/// Errors: no such animation; a broken one, by animation and channel (exit code 2).
pub fn read(
    document: &Document,
    hierarchy: &Hierarchy,
    buffers: &Buffers<'_>,
    choice: &AnimationChoice,
    warnings: &mut Vec<String>,
) -> Result<Vec<Channel>> {
    let animations = &document.as_json().animations;
    let chosen = match choice {
        AnimationChoice::All => 0..animations.len(),
        AnimationChoice::None => 0..0,
        AnimationChoice::One(name) => one(animations, name)?,
    };
    let (mut channels, mut taken, mut overruled) = (Vec::new(), BTreeSet::new(), Vec::new());
    let what = "numbers of animations";
    let mut numbers = Allowance::new(what, FREE_CURVE_NUMBERS, 1, buffers.file_bytes());
    for animation_index in chosen {
        let animation = &animations[animation_index];
        for (channel_index, channel) in animation.channels.iter().enumerate() {
            let name = || {
                let animation = label::element("animation", animation_index, animation.name.as_deref());
                format!("{animation}, channel {channel_index}")
            };
            let read =
                read_channel(document, hierarchy, buffers, animation, channel, &mut numbers).map_err(|error| {
                    error.within(name()).note("`--animation none` draws the file without its animations")
                })?;
            if taken.insert((read.node_index, read.motion)) {
                channels.push(read);
            } else {
                overruled.push(name());
            }
        }
    }
    if let Some(first) = overruled.first() {
        warnings.push(format!(
            "{} a property that an earlier one drives: {first}{}; the earlier one plays",
            label::count(overruled.len(), "animation channel drives", "animation channels drive"),
            if overruled.len() > 1 { " and others" } else { "" }
        ));
    }
    Ok(channels)
}

/// The place of the animation of this name, else of this index.
pub(super) fn one(animations: &[json::Animation], name: &str) -> Result<std::ops::Range<usize>> {
    let by_name = animations.iter().position(|animation| animation.name.as_deref() == Some(name));
    match by_name.or_else(|| name.parse().ok()).filter(|index| *index < animations.len()) {
        Some(index) => Ok(index..index + 1),
        None => Err(no_such_animation(name, animations.iter().map(|animation| animation.name.as_deref()))),
    }
}

/// `--animation NAME` where the scene has only those of `names`.
pub fn no_such_animation<'a>(name: &str, names: impl ExactSizeIterator<Item = Option<&'a str>>) -> Error {
    /// How many names a message shows.
    const SHOWN: usize = 12;
    let count = names.len();
    let names: Vec<&str> = names.take(SHOWN).map(|name| name.unwrap_or("(no name)")).collect();
    let refused = Error::request(format!("--animation {name}: there is no such animation"));
    match count {
        0 => refused.note("the scene has none; `all` and `none` work"),
        _ => refused.note(format!("`all`, `none`, an index below {count}, or a name work: {}", names.join(", "))),
    }
}

fn read_channel(
    document: &Document,
    hierarchy: &Hierarchy,
    buffers: &Buffers<'_>,
    animation: &json::Animation,
    channel: &json::animation::Channel,
    numbers: &mut Allowance,
) -> Result<Channel> {
    let node_index = channel.target.node.value();
    // The crate's validation does not look at this index.
    if node_index >= document.nodes().len() {
        return Err(Error::request(format!(
            "its target is node {node_index}, but there are {} nodes",
            document.nodes().len()
        )));
    }
    let sampler = &animation.samplers[channel.sampler.value()];
    let motion = match channel.target.path {
        Checked::Valid(Property::Translation) => Motion::Translation,
        Checked::Valid(Property::Rotation) => Motion::Rotation,
        Checked::Valid(Property::Scale) => Motion::Scale,
        Checked::Valid(Property::MorphTargetWeights) => Motion::Weights,
        Checked::Invalid => return Err(Error::request("its path is none of translation, rotation, scale, weights")),
    };
    let interpolation = match sampler.interpolation {
        Checked::Valid(JsonInterpolation::Step) => Interpolation::Step,
        Checked::Valid(JsonInterpolation::Linear) => Interpolation::Linear,
        Checked::Valid(JsonInterpolation::CubicSpline) => Interpolation::CubicSpline,
        Checked::Invalid => return Err(Error::request("its interpolation is none of STEP, LINEAR, CUBICSPLINE")),
    };
    let node = || label::node(document, node_index);
    if motion != Motion::Weights && hierarchy.has_matrix(node_index) {
        return Err(Error::request(format!("{} has a matrix; only translation, rotation and scale can move", node())));
    }
    let width = match motion {
        Motion::Translation | Motion::Scale => 3,
        Motion::Rotation => 4,
        Motion::Weights => match morph::target_count(document, node_index)? {
            0 => return Err(Error::request(format!("{} has no morph targets whose weights could move", node()))),
            count => count,
        },
    };
    let accessor = |index: usize, what: &str| {
        let found = document.accessors().nth(index);
        found.ok_or_else(|| Error::request(format!("its {what} is accessor {index}, which does not exist")))
    };
    let (input, output) = (accessor(sampler.input.value(), "input")?, accessor(sampler.output.value(), "output")?);
    let sum = |accessor: &Accessor<'_>| accessor.count().saturating_mul(accessor.dimensions().multiplicity());
    numbers.spend(sum(&input).saturating_add(sum(&output)))?;

    let times_s = accessors::floats::<1>(buffers, &input).map_err(|error| error.within("input"))?.into_flattened();
    let values = match motion {
        Motion::Translation | Motion::Scale => {
            accessors::floats::<3>(buffers, &output).map(|values| values.into_flattened())
        }
        Motion::Rotation => accessors::floats::<4>(buffers, &output).map(|values| values.into_flattened()),
        Motion::Weights => accessors::floats::<1>(buffers, &output).map(|values| values.into_flattened()),
    };
    let values = values.map_err(|error| error.within("output"))?;
    let curve = Curve::new(interpolation, times_s, values, width)?;
    if motion == Motion::Rotation
        && let Some(key) = curve.key_values().position(|key| unit_quaternion(glam::Vec4::from_slice(key)).is_none())
    {
        return Err(Error::request(format!("the rotation of key {key} is zero, which is not a rotation")));
    }
    Ok(Channel { node_index, motion, curve })
}

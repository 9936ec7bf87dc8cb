//! What a technique can and cannot do on a device, from its caps alone: the same needs that refuse a render, tried for
//! every value of every setting.

use super::Technique;
use crate::caps::{Caps, Need};
use crate::error::{Error, Result};
use crate::passes::workgroup::workgroup;
use crate::settings::{Kind, Values, WORKGROUP};
use crate::techniques::settings_of;

/// What a technique lacks on a device, and the limits of its settings.
#[derive(Clone, Debug)]
pub struct Fitness {
    /// Missing abilities that every frame needs. Empty: the technique runs.
    pub stopped_by: Vec<Need>,
    /// Missing abilities that only some settings or scenes need.
    pub left_out: Vec<Need>,
    /// A setting, and the most of it in words.
    pub bounds: Vec<(&'static str, String)>,
}

/// Errors: the device cannot do what the settings ask for (exit code 3), or has no workgroups of their shape (2). `has_blend`:
/// the scene has BLEND surfaces.
pub fn require(technique: &dyn Technique, values: &Values, caps: &Caps, has_blend: bool) -> Result<()> {
    if reads_workgroup(technique) {
        require_workgroup(workgroup(values, caps), caps).map_err(|error| error.within(technique.name()))?;
    }
    match unmet(technique, values, caps, has_blend).first() {
        Some(need) => Err(need.refusal(caps).within(technique.name())),
        None => Ok(()),
    }
}

fn reads_workgroup(technique: &dyn Technique) -> bool {
    technique.settings().iter().copied().flatten().any(|setting| setting.key == WORKGROUP.key)
}

/// Errors: the device's workgroups are smaller (exit code 2).
fn require_workgroup([x, y]: [u32; 2], caps: &Caps) -> Result<()> {
    let (most, [x_most, y_most, _]) = (caps.limits.max_workgroup_invocations, caps.limits.max_workgroup_size);
    if x <= x_most && y <= y_most && x * y <= most {
        return Ok(());
    }
    let (device, driver, count) = (&caps.identity.name, caps.identity.driver_text(), x * y);
    let fitting_x = x.min(x_most).min(most);
    let fitting_y = y.min(y_most).min(most / fitting_x);
    Err(Error::request(format!(
        "--workgroup {x}x{y}: {count} invocations; {device} on {driver} has workgroups of at most {most} \
         (maxComputeWorkGroupInvocations), {x_most} by {y_most} at most (maxComputeWorkGroupSize)"
    ))
    .note(format!("--workgroup {fitting_x}x{fitting_y} fits")))
}

/// What the settings need and a device of these caps lacks. `has_blend`: as `require` has it.
pub fn unmet(technique: &dyn Technique, values: &Values, caps: &Caps, has_blend: bool) -> Vec<Need> {
    technique.needs(values, caps, has_blend).into_iter().filter(|need| !need.is_met(caps)).collect()
}

/// What `technique` can do on a device of these caps.
pub fn fitness(technique: &dyn Technique, caps: &Caps) -> Fitness {
    let settings = settings_of(technique);
    let defaults = Values::defaults(&settings);
    let stopped_by = unmet(technique, &defaults, caps, false);
    let mut left_out: Vec<Need> = Vec::new();
    let mut leave_out = |needs: Vec<Need>| {
        for need in needs {
            if !stopped_by.contains(&need) && !left_out.contains(&need) {
                left_out.push(need);
            }
        }
    };
    for setting in &settings {
        let Kind::Choice(choices) = setting.kind else { continue };
        for choice in choices {
            let mut values = defaults.clone();
            values.set(setting, choice).expect("a choice of the table");
            leave_out(unmet(technique, &values, caps, false));
        }
    }
    leave_out(unmet(technique, &defaults, caps, true));
    let limits = &caps.limits;
    let mut bounds =
        vec![("--size", format!("{} px a side", limits.most_drawn_px().into_iter().min().unwrap_or_default()))];
    if reads_workgroup(technique) {
        let [x, y, _] = limits.max_workgroup_size;
        bounds.push(("--workgroup", format!("{} invocations, {x} by {y} at most", limits.max_workgroup_invocations)));
    }
    bounds.extend(technique.bounds(caps));
    Fitness { stopped_by, left_out, bounds }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use crate::techniques::{ALL, find};

    /// A GPU that has everything, changed.
    fn device(change: impl FnOnce(&mut Caps)) -> Caps {
        let mut caps = known::caps("amd-navi21").unwrap();
        // It was not looked up there.
        caps.sample_locations = known::caps("nvidia-h200").unwrap().sample_locations;
        caps.features.fragment_shader_barycentric = true;
        change(&mut caps);
        caps
    }

    fn of(needs: &[Need]) -> Vec<&str> {
        needs.iter().map(|need| need.of.as_str()).collect()
    }

    #[test]
    fn a_device_that_has_everything_lacks_nothing() {
        for technique in ALL {
            let fitness = fitness(*technique, &device(|_| {}));
            assert!(fitness.stopped_by.is_empty() && fitness.left_out.is_empty(), "{fitness:?}");
            assert!(fitness.bounds.contains(&("--size", "16384 px a side".to_owned())));
        }
    }

    #[test]
    fn what_is_left_out_is_refused_and_nothing_else_is() {
        let interleaved = find("interleaved_deferred").unwrap();
        let settings = settings_of(interleaved);
        for (caps, expected) in [
            (device(|caps| caps.formats.float_depth_with_stencil = false), &["--split stencil"][..]),
            (
                device(|caps| caps.features.storage_image_extended_formats = false),
                &[
                    "--split layered",
                    "--split fragment",
                    "--storage image",
                    "--shade-by viewport",
                    "--shade-by quad",
                    "--filter gauss-fast",
                ],
            ),
            (device(|caps| caps.formats.float_color_blend = false), &["a scene with BLEND surfaces"]),
        ] {
            let fitness = fitness(interleaved, &caps);
            assert!(fitness.stopped_by.is_empty(), "{fitness:?}");
            assert_eq!(of(&fitness.left_out), expected);
            for setting in &settings {
                let Kind::Choice(choices) = setting.kind else { continue };
                for choice in choices {
                    let mut values = Values::defaults(&settings);
                    values.set(setting, choice).unwrap();
                    let refused = require(interleaved, &values, &caps, false);
                    let flag = format!("--{} {choice}", setting.key);
                    assert_eq!(refused.is_err(), expected.contains(&flag.as_str()), "{flag}: {refused:?}");
                    if let Err(error) = refused {
                        assert_eq!(error.exit_code(), 3);
                        let text = error.to_string();
                        let need = fitness.left_out.iter().find(|need| need.of == flag).unwrap();
                        assert!(text.contains(need.ability.name()) && text.contains(need.instead), "{text}");
                    }
                }
            }
        }
    }

    /// What limits say is refused, by name and with a shape that fits, and all below is not: by every technique that has the setting.
    #[test]
    fn workgroups_that_the_device_does_not_have_are_refused_by_their_flag() {
        let limited = |most: u32, size: [u32; 3]| {
            device(|caps| {
                caps.limits.max_workgroup_invocations = most;
                caps.limits.max_workgroup_size = size;
            })
        };
        let mut readers = 0;
        for technique in ALL {
            let settings = settings_of(*technique);
            let has_bound = |caps: &Caps| fitness(*technique, caps).bounds.iter().any(|(of, _)| *of == "--workgroup");
            let Some(workgroup) = settings.iter().find(|setting| setting.key == "workgroup") else {
                assert!(!has_bound(&device(|_| {})), "{} has no --workgroup", technique.name());
                continue;
            };
            readers += 1;
            for (caps, shape, fits) in [
                (limited(1024, [1024, 1024, 64]), "256x4", None),
                (limited(1024, [1024, 1024, 64]), "256x256", Some("--workgroup 256x4 fits")),
                (limited(1024, [1024, 1024, 64]), "33x32", Some("--workgroup 33x31 fits")),
                (limited(1024, [128, 128, 64]), "256x1", Some("--workgroup 128x1 fits")),
                (limited(128, [128, 128, 64]), "1x129", Some("--workgroup 1x128 fits")),
                (limited(128, [128, 64, 64]), "1x128", Some("--workgroup 1x64 fits")),
                (limited(128, [128, 128, 64]), "128x1", None),
            ] {
                assert!(has_bound(&caps));
                let mut values = Values::defaults(&settings);
                values.set(workgroup, shape).unwrap();
                let refused = require(*technique, &values, &caps, false);
                assert_eq!(refused.is_err(), fits.is_some(), "{} --workgroup {shape}: {refused:?}", technique.name());
                let (Err(error), Some(fits)) = (refused, fits) else { continue };
                let most = caps.limits.max_workgroup_invocations.to_string();
                let text = error.to_string();
                for words in [&format!("{}: --workgroup {shape}: ", technique.name()), fits, &most] {
                    assert!(text.contains(words), "{text} does not say {words}");
                }
                assert_eq!(error.exit_code(), 2);
                values.set(workgroup, fits.split(' ').nth(1).unwrap()).unwrap();
                require(*technique, &values, &caps, false).unwrap();
            }
        }
        assert!(readers > 1);
    }

    #[test]
    fn ray_queries_are_refused_where_there_are_none_and_the_tree_is_not() {
        let technique = find("path_traced").unwrap();
        let caps = device(|caps| caps.features.ray_query = false);
        let fitness = fitness(technique, &caps);
        assert!(fitness.stopped_by.is_empty() && of(&fitness.left_out) == ["--rays query"], "{fitness:?}");
        let mut values = Values::defaults(&settings_of(technique));
        require(technique, &values, &caps, true).unwrap();
        let rays = settings_of(technique).into_iter().find(|setting| setting.key == "rays").unwrap();
        values.set(&rays, "query").unwrap();
        let error = require(technique, &values, &caps, false).unwrap_err();
        assert_eq!(error.exit_code(), 3);
        let text = error.to_string();
        for words in [caps.identity.driver_text(), "VK_KHR_ray_query", "--rays tree"] {
            assert!(text.contains(words), "{text}");
        }
    }

    #[test]
    fn a_filter_that_depth_has_not_is_refused_and_the_plain_one_is_not() {
        let technique = find("forward").unwrap();
        let caps = device(|caps| caps.formats.float_depth_linear = false);
        assert_eq!(of(&fitness(technique, &caps).left_out), ["--shadow-filter bilinear"]);
        let filtered = |filter: &str| {
            let settings = settings_of(technique);
            let mut values = Values::defaults(&settings);
            values.set(settings.iter().find(|setting| setting.key == "shadow-filter").unwrap(), filter).unwrap();
            require(technique, &values, &caps, false)
        };
        for plain in ["auto", "nearest", "gather"] {
            filtered(plain).unwrap();
        }
        let error = filtered("bilinear").unwrap_err();
        let text = error.to_string();
        assert_eq!(error.exit_code(), 3);
        assert!(text.contains("D32_SFLOAT sampled with linear") && text.contains("--shadow-filter gather"), "{text}");
    }

    /// A triangle that the device drops because it has no area is one whose samples have no colour.
    #[test]
    fn conservative_rasterisation_without_degenerate_triangles_is_left_out() {
        let deep = find("deep_shading").unwrap();
        let drops = |caps: &mut Caps| caps.conservative.as_mut().unwrap().draws_degenerate_triangles = false;
        for caps in [device(drops), device(|caps| caps.conservative = None)] {
            assert_eq!(of(&fitness(deep, &caps).left_out), ["--conservative hardware"]);
        }
    }

    #[test]
    fn samples_are_left_out_where_one_format_has_not_as_many() {
        let forward = find("forward").unwrap();
        for (caps, expected) in [
            (known::caps(known::DEFAULT).unwrap(), &["--shadow-filter bilinear", "--msaa 8"][..]),
            (device(|caps| caps.formats.half_color_sample_counts = vec![1, 2, 4]), &["--msaa 8"]),
            (device(|caps| caps.formats.float_depth_sample_counts = vec![1, 8]), &["--msaa 4"]),
            (device(|caps| caps.formats.float_color_sample_counts = vec![1]), &["--msaa 4", "--msaa 8"]),
        ] {
            assert_eq!(of(&fitness(forward, &caps).left_out), expected);
        }
    }

    #[test]
    fn what_every_frame_needs_stops_the_technique() {
        let caps = device(|caps| caps.formats.float_depth = false);
        for technique in ALL {
            let expected: &[&str] = match technique.name() {
                "path_traced" => &[],
                "forward" | "interleaved_sampling" => &["the depth buffer"],
                "inferred_lighting" => &["the geometry pass"],
                "deep_shading" => &["the visibility pass"],
                _ => &["the G-buffer"],
            };
            assert_eq!(of(&fitness(*technique, &caps).stopped_by), expected);
        }
    }
}

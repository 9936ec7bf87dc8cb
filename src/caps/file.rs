//! Caps from a file that `quincunx devices --json` has written, perhaps on another machine. A file may hold anything:
//! every number that a plan uses is checked first.

use super::{Caps, LayoutRules, StructureRules, known};
use crate::error::{Error, Result};
use serde_json::Value;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Some 10 KiB a device.
const MOST_BYTES: u64 = 4 << 20;
/// VK_MAX_MEMORY_HEAPS and VK_MAX_MEMORY_TYPES.
const MOST_HEAPS: usize = 16;
const MOST_TYPES: usize = 32;
/// Beyond every heap that there is, and sums of a few stay numbers.
const MOST_HEAP_BYTES: u64 = 1 << 60;
/// The same of what a driver rounds to.
const MOST_MULTIPLE: u64 = 1 << 30;

/// Limits of which less is better, powers of two as Vulkan has them.
const STEPS: [&str; 3] =
    ["buffer_image_granularity_bytes", "non_coherent_atom_bytes", "min_storage_buffer_offset_bytes"];

/// The caps that `--caps` asks for: by a known name, or by the path of a file, of whose devices `selector` names one as
/// `--device` does. With the name to print.
///
/// Errors: there is neither, or the file does not hold such a device (exit code 2).
pub fn asked(text: &str, selector: Option<&str>) -> Result<(String, Caps)> {
    let path = Path::new(text);
    let is_path = path.components().count() > 1 || path.extension().is_some_and(|extension| extension == "json");
    if known::names().any(|name| name == text) || !(is_path || path.exists()) {
        return Ok((text.to_owned(), known::caps(text)?));
    }
    let caps = read(path, selector)?;
    Ok((format!("{} ({})", caps.identity.name, caps.identity.driver_text()), caps))
}

/// The device in the file at `path` that `selector` names as `--device` does; None: the one that a render would take.
///
/// Errors: no such file or device, or one that Vulkan does not allow (exit code 2).
pub fn read(path: &Path, selector: Option<&str>) -> Result<Caps> {
    let refused = |why: String| {
        let error = Error::request(format!("--caps {}: {why}", path.display()));
        error.note("the file must hold what `quincunx devices --json` prints, or the caps of one device from it")
    };
    let document = document(path).map_err(refused)?;
    let caps = chosen(&document, selector).map_err(refused)?;
    let caps: Caps = serde_json::from_value(caps.clone()).map_err(|error| refused(error.to_string()))?;
    require_possible(&caps).map_err(|why| refused(format!("{}: {why}", caps.identity.name)))?;
    Ok(caps)
}

fn document(path: &Path) -> Result<Value, String> {
    let mut text = Vec::new();
    let file = File::open(path).map_err(|error| error.to_string())?;
    file.take(MOST_BYTES + 1).read_to_end(&mut text).map_err(|error| error.to_string())?;
    if text.len() as u64 > MOST_BYTES {
        return Err(format!("it has more than {} MiB", MOST_BYTES >> 20));
    }
    serde_json::from_slice(&text).map_err(|error| format!("it is not JSON: {error}"))
}

/// The caps of one device: of the whole list, of one of its devices, or by themselves.
fn chosen<'a>(document: &'a Value, selector: Option<&str>) -> Result<&'a Value, String> {
    let Some(devices) = document.get("devices") else { return Ok(document.get("caps").unwrap_or(document)) };
    let devices = devices.as_array().ok_or("its `devices` is not a list")?;
    let all: Vec<(usize, Caps, &Value)> = devices
        .iter()
        .enumerate()
        .map(|(index, device)| {
            let caps = serde_json::from_value(device["caps"].clone());
            Ok((index, caps.map_err(|error| format!("device {index}: {error}"))?, &device["caps"]))
        })
        .collect::<Result<_, String>>()?;
    let is_usable = |index: usize| devices[index]["missing"].as_array().is_none_or(Vec::is_empty);
    let fitting = all.iter().filter(|(index, caps, _)| caps.identity.is_named(selector, *index) && is_usable(*index));
    let first = fitting.min_by_key(|(_, caps, _)| caps.identity.preference());
    first.map(|(_, _, caps)| *caps).ok_or_else(|| {
        let asked = selector.map_or(String::new(), |selector| format!(" that --device {selector} names"));
        let names: Vec<String> =
            all.iter().map(|(index, caps, _)| format!("{index}: {}", caps.identity.name)).collect();
        format!("it has no device{asked} that can be used; it has {} ({})", names.len(), names.join(", "))
    })
}

/// Errors: why no device has these caps.
fn require_possible(caps: &Caps) -> Result<(), String> {
    let least = known::caps(known::LEAST).expect("it is known");
    let [limits, promised] = [&caps.limits, &least.limits].map(|limits| serde_json::to_value(limits).expect("numbers"));
    for (key, promised) in promised.as_object().expect("limits have names") {
        require_promised(key, &limits[key], promised)?;
    }
    require_heaps(caps)?;
    caps.layout.as_ref().map_or(Ok(()), |rules| require_rules(rules, caps.memory_types.len()))
}

/// Errors: `said` of the limit `key` is less than Vulkan promises, or no number that it may be.
fn require_promised(key: &str, said: &Value, promised: &Value) -> Result<(), String> {
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let fails = |why: String| Err(format!("limits.{key} is {said}, {why}"));
    match promised.as_array() {
        Some(_) if key == "framebuffer_sample_counts" => match said.as_array() {
            Some(counts) if counts.contains(&Value::from(1)) && counts.contains(&Value::from(4)) => Ok(()),
            _ => fails("and Vulkan promises 1 and 4".to_owned()),
        },
        Some(sides) => {
            let said = said.as_array().into_iter().flatten();
            said.zip(sides).try_for_each(|(said, promised)| require_promised(key, said, promised))
        }
        None if STEPS.contains(&key) => match said.as_u64() {
            Some(step) if step.is_power_of_two() && number(said) <= number(promised) => Ok(()),
            _ => fails(format!("and Vulkan promises a power of two of at most {promised}")),
        },
        // NaN, and what is too large for its type, is null.
        None if number(said) >= number(promised) => Ok(()),
        None => fails(format!("and Vulkan promises {promised} at least")),
    }
}

fn require_heaps(caps: &Caps) -> Result<(), String> {
    let (heaps, types) = (caps.heaps.len(), caps.memory_types.len());
    if !(1..=MOST_HEAPS).contains(&heaps) || !(1..=MOST_TYPES).contains(&types) {
        return Err(format!(
            "it has {heaps} heaps and {types} memory types; Vulkan allows 1 to {MOST_HEAPS} and 1 to {MOST_TYPES}"
        ));
    }
    if let Some(index) = caps.heaps.iter().position(|heap| !(1..=MOST_HEAP_BYTES).contains(&heap.bytes)) {
        return Err(format!("heap {index} has {} bytes", caps.heaps[index].bytes));
    }
    match caps.memory_types.iter().position(|kind| kind.heap as usize >= heaps) {
        Some(index) => {
            Err(format!("memory type {index} is of heap {}, and there are {heaps}", caps.memory_types[index].heap))
        }
        None => Ok(()),
    }
}

fn require_rules(rules: &LayoutRules, type_count: usize) -> Result<(), String> {
    let multiples = [
        rules.buffer_size_multiple_bytes,
        rules.image_width_multiple_px,
        rules.image_row_multiple_bytes,
        rules.image_height_multiple_px,
        rules.image_size_multiple_bytes,
    ];
    let alignments = [rules.buffer_alignment_bytes, rules.vertex_buffer_alignment_bytes, rules.image_alignment_bytes];
    let structures = rules.structures.iter().flat_map(|rules| {
        let StructureRules { header_bytes, inner_bytes, triangle_bytes, instance_bytes } = rules;
        [*header_bytes, *inner_bytes, *triangle_bytes, *instance_bytes]
    });
    let is_possible = multiples.iter().chain(&alignments).all(|multiple| (1..=MOST_MULTIPLE).contains(multiple))
        && alignments.iter().all(|alignment| alignment.is_power_of_two())
        && structures.into_iter().all(|bytes| bytes <= MOST_MULTIPLE)
        && (5..=16).contains(&rules.depth_stencil_texel_bytes)
        && rules.memory_type_bits != 0
        && rules.memory_type_bits.checked_shr(type_count as u32).unwrap_or(0) == 0;
    match is_possible {
        true => Ok(()),
        false => Err("no driver rounds as its `layout` says".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Job;
    use crate::study;
    use crate::techniques::ALL;
    use proptest::prelude::*;

    fn read_text(text: &str, selector: Option<&str>) -> Result<Caps> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gpu.json");
        std::fs::write(&path, text).unwrap();
        read(&path, selector)
    }

    #[test]
    fn every_known_driver_is_possible() {
        for name in known::names() {
            require_possible(&known::caps(name).unwrap()).unwrap_or_else(|why| panic!("{name}: {why}"));
        }
    }

    /// The list as `devices --json` prints it: the one that a render would take, or the one that `--device` names.
    #[test]
    fn one_device_of_a_list_is_chosen_as_a_render_would() {
        let entry = |name: &str, missing: &[&str]| {
            let caps = known::caps(name).unwrap();
            serde_json::json!({ "caps": caps, "missing": missing, "techniques": [] })
        };
        let list = |entries: &[Value]| serde_json::json!({ "schema": 1, "devices": entries }).to_string();
        let (lavapipe, radv) = (entry("lavapipe-25.0.7", &[]), entry("amd-navi21", &[]));
        let both = list(&[lavapipe.clone(), radv.clone()]);
        let unusable = list(&[lavapipe.clone(), entry("amd-navi21", &["feature maintenance4"])]);
        for (text, selector, expected) in [
            (&both, None, "discrete-gpu"),
            (&both, Some("0"), "cpu"),
            (&both, Some("RADV"), "discrete-gpu"),
            (&unusable, None, "cpu"),
            (&radv.to_string(), None, "discrete-gpu"),
            (&radv["caps"].to_string(), None, "discrete-gpu"),
        ] {
            assert_eq!(read_text(text, selector).unwrap().identity.device_type, expected, "{selector:?}");
        }
        for (text, selector, words) in [
            (&both, Some("2"), "--device 2"),
            (&unusable, Some("1"), "--device 1"),
            (&list(&[]), None, "it has 0"),
            (&r#"{"devices": 3}"#.to_owned(), None, "not a list"),
            (&list(&[lavapipe, serde_json::json!({})]), None, "device 1"),
        ] {
            let error = read_text(text, selector).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(words), "{error} does not say {words}");
        }
    }

    #[test]
    fn what_no_device_has_is_refused_by_its_name() {
        let caps = |key: &str, value: Value| {
            let mut caps = serde_json::to_value(known::caps(known::DEFAULT).unwrap()).unwrap();
            *caps.pointer_mut(key).unwrap_or_else(|| panic!("{key}")) = value;
            caps.to_string()
        };
        for (text, words) in [
            ("voodoo".to_owned(), "not JSON"),
            ("{}".to_owned(), "missing field"),
            ("[".repeat(1000), "not JSON"),
            (" ".repeat(MOST_BYTES as usize + 1), "more than 4 MiB"),
            (
                caps("/limits/max_image_side_px", 4095.into()),
                "limits.max_image_side_px is 4095, and Vulkan promises 4096",
            ),
            (caps("/limits/max_workgroup_size/2", 0.into()), "limits.max_workgroup_size is 0"),
            (caps("/limits/max_framebuffer_px", Value::from(vec![0, 4096])), "limits.max_framebuffer_px is 0"),
            (caps("/limits/buffer_image_granularity_bytes", 0.into()), "a power of two of at most 131072"),
            (caps("/limits/min_storage_buffer_offset_bytes", 512.into()), "a power of two of at most 256"),
            (caps("/limits/framebuffer_sample_counts", Value::from(vec![1])), "Vulkan promises 1 and 4"),
            (caps("/limits/timestamp_period_ns", 1e300.into()), "limits.timestamp_period_ns"),
            (caps("/memory_types/0/heap", 1.into()), "memory type 0 is of heap 1, and there are 1"),
            (caps("/memory_types", Value::Array(Vec::new())), "0 memory types"),
            (caps("/heaps/0/bytes", 0.into()), "heap 0 has 0 bytes"),
            (caps("/layout/image_height_multiple_px", 0.into()), "`layout`"),
            (caps("/layout/image_alignment_bytes", 48.into()), "`layout`"),
            (caps("/layout/memory_type_bits", 2.into()), "`layout`"),
        ] {
            let error = read_text(&text, None).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{error}");
            assert!(error.to_string().starts_with("--caps "), "{error}");
            assert!(error.to_string().contains(words), "{error} does not say {words}");
        }
        assert_eq!(read(Path::new("/"), None).unwrap_err().exit_code(), 2);
        assert_eq!(read(Path::new("nowhere.json"), None).unwrap_err().exit_code(), 2);
    }

    #[test]
    fn a_name_is_a_known_driver_and_a_path_is_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gpu.json");
        std::fs::write(&path, serde_json::to_string(&known::caps("amd-navi21").unwrap()).unwrap()).unwrap();
        let (name, read) = asked(path.to_str().unwrap(), None).unwrap();
        assert!(name.contains("NAVI21") && read.identity.device_type == "discrete-gpu", "{name}");
        assert_eq!(asked("swiftshader", Some("7")).unwrap().0, "swiftshader");
        for (text, words) in
            [("voodoo", "no driver of this name"), ("voodoo.json", "No such file"), ("./voodoo", "No such")]
        {
            let error = asked(text, None).unwrap_err();
            assert!(error.exit_code() == 2 && error.to_string().contains(words), "{error}");
        }
    }

    /// Where numbers stand in a document.
    fn number_paths(value: &Value, path: &str, found: &mut Vec<String>) {
        match value {
            Value::Number(_) => found.push(path.to_owned()),
            Value::Array(items) => {
                items
                    .iter()
                    .enumerate()
                    .for_each(|(index, item)| number_paths(item, &format!("{path}/{index}"), found));
            }
            Value::Object(members) => {
                members.iter().for_each(|(key, member)| number_paths(member, &format!("{path}/{key}"), found));
            }
            _ => {}
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Whatever numbers it holds, a file is refused or planned with, or the plan is refused: nothing panics.
        #[test]
        fn a_file_with_other_numbers_is_refused_or_planned_with(
            name in 0usize..100,
            changes in prop::collection::vec((0usize..1000, 0usize..9), 1..4),
            technique in 0usize..100,
        ) {
            let names: Vec<&str> = known::names().collect();
            let mut caps = serde_json::to_value(known::caps(names[name % names.len()]).unwrap()).unwrap();
            let mut paths = Vec::new();
            number_paths(&caps, "", &mut paths);
            let values = [
                Value::from(0), 1.into(), 4096.into(), u32::MAX.into(), (1u64 << 60).into(), i64::MAX.into(),
                u64::MAX.into(), (-1).into(), 0.5.into(),
            ];
            for (path, value) in changes {
                *caps.pointer_mut(&paths[path % paths.len()]).unwrap() = values[value].clone();
            }
            if let Ok(caps) = read_text(&caps.to_string(), None) {
                let mut job = Job::new("cornell", ALL[technique % ALL.len()]);
                job.set("size", "16x8").unwrap();
                if let Ok(study) = study::planned(&job, "changed", &caps) {
                    prop_assert!(!study.table.text().is_empty());
                }
            }
        }
    }
}

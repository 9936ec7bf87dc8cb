//! Compilers of GPUs that are not there: AMD's driver without hardware, below a layer that drops commands (tools/pretend, mode `null`) and a
//! validation layer. tools/compilers runs these tests; others skip what needs that driver.

mod choices;
mod kept;

use crate::support::name_skip;
use crate::support::program::{Program, Ran};
use std::path::Path;

/// GCN 4, RDNA 2 and RDNA 4: compute units and shaders of three kinds.
const FAMILIES: [&str; 3] = ["polaris10", "navi21", "gfx1201"];

/// The driver, and the program on it.
struct Null {
    program: Program,
    variables: Vec<(String, String)>,
}

impl Null {
    /// None, and said so, where tools/compilers has not set what it takes. CI has no such driver: no failure there.
    fn open() -> Option<Self> {
        let variable = |name: &str| {
            let value = std::env::var(name).ok();
            if value.is_none() {
                name_skip(&format!("{name} is not set: tools/compilers sets it"));
            }
            value
        };
        let driver = variable("QUINCUNX_NULL_DRIVER")?;
        let layer = variable("QUINCUNX_PRETEND_LAYER")?;
        variable("QUINCUNX_RUNNER")?;
        let environment = std::fs::read_to_string(Path::new(&driver).join("environment")).unwrap();
        let pairs = environment.lines().map(|line| line.split_once('=').unwrap());
        let mut variables: Vec<(String, String)> =
            pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        // The one that watches first, which is nearer to the program: it must see what the other drops.
        for (name, value) in [
            ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_QUINCUNX_pretend"),
            ("VK_ADD_LAYER_PATH", &layer),
            ("QUINCUNX_PRETEND", "null"),
        ] {
            variables.push((name.to_owned(), value.to_owned()));
        }
        Some(Self { program: Program::new(), variables })
    }

    /// A tiny picture of cornell under validation, with `more` in the environment; its report on standard output.
    fn render(&self, family: &str, words: &[&str], more: &[(&str, &str)]) -> Ran {
        let mut arguments = vec!["render", "cornell", "--size", "24x16"];
        arguments.extend(words);
        arguments.extend(["--validate", "--quiet", "--json", "-o", "a.exr"]);
        let mut variables: Vec<(&str, &str)> =
            self.variables.iter().map(|(name, value)| (&name[..], &value[..])).collect();
        variables.push(("RADV_FORCE_FAMILY", family));
        variables.extend(more);
        self.program.run_with(&arguments, &variables)
    }
}

/// Whether a request was refused with words: it is wrong, the device lacks something, or has not as much memory in one block.
fn is_refused(ran: &Ran) -> bool {
    let is_named = ["--", " needs ", "(max"].iter().any(|word| ran.err.contains(word));
    let is_of_memory = ran.code == 4 && ran.err.contains("error: allocating ");
    (matches!(ran.code, 2 | 3) || is_of_memory) && is_named && ran.err.lines().any(|line| line.starts_with("error: "))
}

/// Were it the other way round, the watching one would see nothing and have nothing to say.
#[test]
fn the_layer_that_watches_is_above_the_one_that_pretends() {
    let Some(null) = Null::open() else { return };
    let ran = null.render(FAMILIES[0], &["--technique", "deferred"], &[("VK_LOADER_DEBUG", "layer")]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let device = ran.err.split_once("vkCreateDevice layer callstack").unwrap_or_else(|| panic!("{}", ran.err)).1;
    let place = |layer| device.find(layer).unwrap_or_else(|| panic!("no {layer}: {device}"));
    assert!(place("VK_LAYER_KHRONOS_validation") < place("VK_LAYER_QUINCUNX_pretend"), "{device}");
}

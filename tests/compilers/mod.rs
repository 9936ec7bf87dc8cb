//! Compilers of GPUs that are not there: drivers without hardware, below a layer that drops commands (tools/pretend,
//! mode `null`) and a validation layer. tools/compilers runs these tests; others skip what needs those drivers.

mod choices;
mod kept;

use crate::support::name_skip;
use crate::support::program::{Program, Ran};
use std::path::Path;

/// GPUs that a driver can be told to compile for.
struct Family {
    name: &'static str,
    /// As tools/drivers calls it.
    driver: &'static str,
    /// The variable that names it to the driver.
    variable: (&'static str, &'static str),
}

const fn amd(name: &'static str) -> Family {
    Family { name, driver: "radv-null", variable: ("RADV_FORCE_FAMILY", name) }
}

/// AMD's GCN 4, RDNA 2 and RDNA 4, and NVIDIA's Turing, the newest that the driver's shim knows.
const FAMILIES: [Family; 4] = [
    amd("polaris10"),
    amd("navi21"),
    amd("gfx1201"),
    Family { name: "tu104", driver: "nvk-null", variable: ("NOUVEAU_CHIPSET", "0x164") },
];

/// The program on such a driver.
struct Null {
    program: Program,
    variables: Vec<(String, String)>,
}

impl Null {
    /// None, and said so, where tools/compilers has not set what it takes. CI has no such driver: no failure there.
    fn open(family: &Family) -> Option<Self> {
        let variable = |name: &str| {
            let value = std::env::var(name).ok();
            if value.is_none() {
                name_skip(&format!("{name} is not set: tools/compilers sets it"));
            }
            value
        };
        let drivers = variable("QUINCUNX_NULL_DRIVERS")?;
        let layer = variable("QUINCUNX_PRETEND_LAYER")?;
        variable("QUINCUNX_RUNNER")?;
        let file = Path::new(&drivers).join(family.driver).join("environment");
        let environment = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let pairs = environment.lines().map(|line| line.split_once('=').unwrap());
        let mut variables: Vec<(String, String)> =
            pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        // The one that watches first, which is nearer to the program: it must see what the other drops.
        for (name, value) in [
            ("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation:VK_LAYER_QUINCUNX_pretend"),
            ("VK_ADD_LAYER_PATH", &layer),
            ("QUINCUNX_PRETEND", "null"),
            family.variable,
        ] {
            variables.push((name.to_owned(), value.to_owned()));
        }
        Some(Self { program: Program::new(), variables })
    }

    /// A tiny picture of cornell under validation, with `more` in the environment; its report on standard output.
    fn render(&self, words: &[&str], more: &[(&str, &str)]) -> Ran {
        let mut arguments = vec!["render", "cornell", "--size", "24x16"];
        arguments.extend(words);
        arguments.extend(["--validate", "--quiet", "--json", "-o", "a.exr"]);
        let mut variables: Vec<(&str, &str)> =
            self.variables.iter().map(|(name, value)| (&name[..], &value[..])).collect();
        variables.extend(more);
        self.program.run_with(&arguments, &variables)
    }
}

/// Whether a request was refused with words: it is wrong, the device lacks something, or makes no such memory block.
fn is_refused(ran: &Ran) -> bool {
    let is_named = ["--", " needs ", "(max"].iter().any(|word| ran.err.contains(word));
    let is_of_memory = ran.code == 4 && ran.err.contains("error: allocating ");
    (matches!(ran.code, 2 | 3) || is_of_memory) && is_named && ran.err.lines().any(|line| line.starts_with("error: "))
}

/// Were it the other way round, the watching one would see nothing and have nothing to say.
#[test]
fn the_layer_that_watches_is_above_the_one_that_pretends() {
    let Some(null) = Null::open(&FAMILIES[0]) else { return };
    let ran = null.render(&["--technique", "deferred"], &[("VK_LOADER_DEBUG", "layer")]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let device = ran.err.split_once("vkCreateDevice layer callstack").unwrap_or_else(|| panic!("{}", ran.err)).1;
    let place = |layer| device.find(layer).unwrap_or_else(|| panic!("no {layer}: {device}"));
    assert!(place("VK_LAYER_KHRONOS_validation") < place("VK_LAYER_QUINCUNX_pretend"), "{device}");
}

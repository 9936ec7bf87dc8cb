//! What is pretended, by QUINCUNX_PRETEND.

use std::sync::LazyLock;

#[derive(Default)]
pub struct Modes {
    /// Memory comes with all bits set, which are NaN.
    pub poison: bool,
    /// What a barrier may drop is overwritten.
    pub discard: bool,
    /// Behind every buffer lie bytes that nobody may write, and that are NaN to who reads them.
    pub padding: bool,
    /// Memory types as of a discrete GPU: some that the host does not see, one that is not coherent.
    pub discrete: bool,
    /// The device says that it is a discrete GPU.
    pub gpu: bool,
    /// The least limits and features that Vulkan 1.3 lets a device have.
    pub least_limits: bool,
    /// The driver has no hardware: it compiles, and what it lacks beside that is made up.
    pub null: bool,
    /// The device has placed samples, four a pixel, which lie where Vulkan's standard has them.
    pub placed_samples: bool,
    /// Products and sums of shaders become one operation where a compiler may do so; by this seed.
    pub contract: Option<u64>,
    /// Results of shaders that need not be exact are one unit in the last place off; by this seed.
    pub last_bit: Option<u64>,
}

pub static MODES: LazyLock<Modes> = LazyLock::new(|| {
    let mut modes = Modes::default();
    let text = std::env::var("QUINCUNX_PRETEND").unwrap_or_default();
    for word in text.split(',').filter(|word| !word.is_empty()) {
        if let Some((name, seed)) = word.split_once('=') {
            let Ok(seed) = seed.parse() else {
                crate::fail(&format!("QUINCUNX_PRETEND={text}: {word}: a seed is a whole number from 0"));
            };
            match name {
                "contract" => modes.contract = Some(seed),
                "last-bit" => modes.last_bit = Some(seed),
                _ => crate::fail(&format!("QUINCUNX_PRETEND={text}: {word}: contract and last-bit alone take a seed")),
            }
            continue;
        }
        match word {
            "poison" => modes.poison = true,
            "discard" => modes.discard = true,
            "padding" => modes.padding = true,
            "discrete" => modes.discrete = true,
            "gpu" => modes.gpu = true,
            "least-limits" => modes.least_limits = true,
            "null" => modes.null = true,
            "placed-samples" => modes.placed_samples = true,
            _ => crate::fail(&format!(
                "QUINCUNX_PRETEND={text}: {word}: there are poison, discard, padding, discrete, gpu, least-limits, placed-samples, \
                 contract=SEED and last-bit=SEED"
            )),
        }
    }
    // The others look into memory, which devices without hardware do not fill.
    if modes.null && text != "null" {
        crate::fail(&format!("QUINCUNX_PRETEND={text}: null stands alone"));
    }
    modes
});

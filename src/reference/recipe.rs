//! A recipe: the technique and the settings that make a reference, and the key under which its picture is kept.

use crate::error::Result;
use crate::frame::View;
use crate::lights::LightSet;
use crate::session::Session;
use crate::settings::{Changes, MEDIUM, Setting, Values};
use crate::shading::medium::Medium;
use crate::techniques::{self, Technique, settings_of};
use crate::units::Extent;
use crate::volume::Transfer;
use indexmap::IndexMap;
use serde_json::{Map, Value, json};

/// Goes into every key; raised whenever the kept files, or what goes into a key, change.
const FORMAT: u32 = 1;

/// Whether a reference has the value that its judged picture has, where both techniques read the setting: others stay at
/// their defaults, so that one reference serves all of them.
///
/// `--submit-ms` changes no picture and goes along: a device that aborts long submits aborts a reference's too.
pub(crate) fn goes_along(setting: &Setting) -> bool {
    setting.changes == Changes::Picture || setting.key == "submit-ms"
}

/// The seed of references: not the default one, so that a path-traced picture is not judged by its own samples.
const SEED: &str = "2654435769";

/// The setting that says how many samples a pixel has, of techniques that have it.
pub const SAMPLES: &str = "spp";

/// What makes a reference.
pub struct Recipe {
    pub technique: &'static dyn Technique,
    pub values: Values,
    key: String,
    identity: Value,
}

impl Recipe {
    /// `technique` with `values`, of what `session` shows.
    ///
    /// Errors: no such camera, lights or transfer function (exit code 2).
    pub fn new(technique: &'static dyn Technique, values: Values, session: &Session) -> Result<Self> {
        let scene = &session.scene;
        let view = View::new(scene, values.text("camera"), values.extent("size"))?;
        let lights = LightSet::new(scene, &view, &values)?;
        let camera = &view.camera;
        let settings: Map<String, Value> = values.iter().map(|(key, text)| (key.to_owned(), json!(text))).collect();
        // Floats are printed with as many digits as tell them apart.
        let mut identity = json!({
            "format": FORMAT,
            "technique": technique.name(),
            "estimator": technique.estimator_version(),
            "scene": scene.hash,
            "texturing": format!("{:?}", scene.texturing),
            "camera": [camera.world_from_view.to_cols_array().to_vec(), format!("{:?}", camera.projection)],
            "size": view.extent.to_string(),
            "lights": format!("{:?}", lights.lights),
            "ambient": lights.ambient.to_array(),
            "settings": settings,
        });
        if scene.volume.is_some()
            && let Some(transfer) = values.get("transfer")
        {
            // What a file says may change while its name stays.
            identity["transfer"] = json!(format!("{:?}", Transfer::open(transfer)?));
        }
        let key = blake3::hash(identity.to_string().as_bytes()).to_hex().to_string();
        Ok(Self { technique, values, key, identity })
    }

    /// What `judged` with `values` is held against: `technique` with the settings that both read, those of the transport
    /// that `judged` claims to compute, and `spp` samples a pixel where `technique` counts them.
    ///
    /// Errors: `technique` has no such transport (exit code 2).
    pub fn judging(
        technique: &'static dyn Technique,
        judged: &dyn Technique,
        values: &Values,
        session: &Session,
        spp: u64,
    ) -> Result<Self> {
        let view = View::new(&session.scene, values.text("camera"), values.extent("size"))?;
        let lights = LightSet::new(&session.scene, &view, values)?;
        // What `--medium` comes to here, so that a claim can depend on it; who does not read it draws none.
        let mut values = values.clone();
        let mut medium = "none".to_owned();
        if values.get(MEDIUM.key).is_some() {
            medium = Medium::text(Medium::chosen(&values, &session.scene));
            techniques::set(judged, &mut values, MEDIUM.key, &medium)?;
        }
        let values = &values;
        let mut own = techniques::defaults(technique);
        let mut set = |key: &str, text: &str| techniques::set(technique, &mut own, key, text);
        let reads = |key: &str| settings_of(technique).iter().any(|setting| setting.key == key);
        let along = |key: &str| settings_of(technique).iter().any(|setting| setting.key == key && goes_along(setting));
        for (key, text) in values.iter().filter(|(key, _)| along(key)) {
            set(key, text)?;
        }
        let scattered = values.text("lights");
        if !scattered.contains(':') {
            // Which `--lights` there are depends on the judged seed, not on the reference's.
            set("lights", &format!("{scattered}:{}", values.integer("seed")))?;
        }
        set("seed", SEED)?;
        if reads(MEDIUM.key) {
            set(MEDIUM.key, &medium)?;
        }
        for (key, text) in judged.reference_settings(values, &lights)? {
            if reads(key) {
                set(key, &text)?;
            }
        }
        if reads(SAMPLES) {
            set(SAMPLES, &spp.to_string())?;
        }
        Self::new(technique, own, session)
    }

    /// The same with another count of samples.
    ///
    /// Errors: the technique counts none (exit code 2).
    pub fn with_samples(&self, spp: u64) -> Result<Values> {
        let mut values = self.values.clone();
        techniques::set(self.technique, &mut values, SAMPLES, &spp.to_string())?;
        Ok(values)
    }

    /// Samples a pixel; None where the technique counts none, or the settings say `auto`.
    pub fn samples(&self) -> Option<u64> {
        let has = settings_of(self.technique).iter().any(|setting| setting.key == SAMPLES);
        has.then(|| self.values.unless_auto(SAMPLES, Values::integer)).flatten()
    }

    /// BLAKE3, in hexadecimal, of all that its picture depends on: scene, camera, size, lights, settings, estimator.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// What the key is of.
    pub fn identity(&self) -> &Value {
        &self.identity
    }

    /// Every setting as text.
    pub fn settings(&self) -> IndexMap<String, String> {
        self.values.iter().map(|(key, text)| (key.to_owned(), text.to_owned())).collect()
    }

    pub fn extent(&self) -> Extent {
        self.values.extent("size")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Keys of kept references hold every setting: a row that is classed otherwise would make all of them anew.
    #[test]
    fn a_reference_shares_what_changes_no_picture_and_how_many_samples_there_are() {
        let settings = settings_of(techniques::find("path_traced").unwrap());
        let own: Vec<&str> = settings.iter().filter(|row| !goes_along(row)).map(|row| row.key).collect();
        let of_file = ["exposure", "tonemap", "exr"];
        let of_memory =
            ["allocation", "memory-block", "image-tiling", "alias", "tree-growth", "memory-budget", "touched"];
        let of_samples = ["spp", "until-error"];
        let of_cost = ["workgroup", "node-width", "node-layout", "stack", "stack-entries"];
        assert_eq!(own, [&of_file[..], &of_memory, &of_samples, &of_cost].concat());
    }
}

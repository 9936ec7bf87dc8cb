//! A session under the validation layer, in which every message is a failure.

use quincunx::error::Result;
use quincunx::gpu::commands::{Recording, Submits};
use quincunx::gpu::{DeviceRequest, Gpu};
use quincunx::memory::Strategy;
use quincunx::picture::{AovChannels, Picture};
use quincunx::scene::{self, Scene};
use quincunx::session::{Renderer, Session};
use quincunx::settings::Values;
use quincunx::techniques;
use quincunx::techniques::settings_of;
use std::sync::Arc;

/// Settings that differ from their defaults.
pub type Changes<'a> = &'a [(&'a str, &'a str)];

/// A device with the validation layer and nothing else out of the ordinary.
pub fn watched_device() -> DeviceRequest {
    DeviceRequest { validate: true, ..DeviceRequest::default() }
}

/// Fails with the messages that the validation layer has for `gpu`.
pub fn require_silence(gpu: &Gpu, what: &str) {
    let messages = gpu.take_validation_messages();
    let text: Vec<String> = messages.iter().map(|message| format!("{}\n  {}", message.id, message.text)).collect();
    assert!(text.is_empty(), "{what}: {} validation messages\n{}", text.len(), text.join("\n"));
}

/// A scene on a watched device.
pub struct Watched {
    pub session: Session,
    // Dropped last: what the scene's end brings up is heard too.
    silence: Silence,
}

/// A device that must have been silent to its end.
struct Silence(Arc<Gpu>);

impl Watched {
    /// The scene that `spec` names, as on the command line.
    pub fn open(spec: &str) -> Self {
        Self::with_scene(scene::load(spec, 1).unwrap())
    }

    pub fn with_scene(scene: Scene) -> Self {
        Self::with_request(&watched_device(), scene)
    }

    pub fn with_strategy(strategy: Strategy, spec: &str) -> Self {
        Self::with_request(&DeviceRequest { strategy, ..watched_device() }, scene::load(spec, 1).unwrap())
    }

    pub fn with_request(request: &DeviceRequest, scene: Scene) -> Self {
        assert!(request.validate, "a test watches its device");
        let session = Session::open(request, scene).unwrap();
        require_silence(&session.gpu, "opening the session");
        let silence = Silence(session.gpu.clone());
        Self { session, silence }
    }

    /// Another scene on the same device; one of the same hash and texture limit is taken for the same.
    pub fn showing(self, scene: Scene) -> Self {
        let Self { session, silence } = self;
        let session = session.showing(scene).unwrap();
        require_silence(&session.gpu, "showing another scene");
        Self { session, silence }
    }

    /// One technique with its settings, after one frame in one submit.
    pub fn render(&self, technique: &str, changes: Changes<'_>) -> Renderer {
        self.render_as(technique, changes, &[], Submits::One)
    }

    /// The same, whose `stages` can be read back.
    pub fn render_stages(&self, technique: &str, changes: Changes<'_>, stages: &[&str]) -> Renderer {
        self.render_as(technique, changes, stages, Submits::One)
    }

    pub fn render_as(
        &self,
        technique: &str,
        changes: Changes<'_>,
        stages: &[&str],
        recording: impl Into<Recording>,
    ) -> Renderer {
        let what = format!("{technique} with {changes:?}");
        let made = self.try_renderer(technique, changes, stages, recording);
        let renderer = made.unwrap_or_else(|error| panic!("{what}: {error}"));
        renderer.frame().unwrap_or_else(|error| panic!("{what}: {error}"));
        require_silence(&self.session.gpu, &what);
        renderer
    }

    pub fn try_renderer(
        &self,
        technique: &str,
        changes: Changes<'_>,
        stages: &[&str],
        recording: impl Into<Recording>,
    ) -> Result<Renderer> {
        let stages: Vec<String> = stages.iter().map(|stage| (*stage).to_owned()).collect();
        self.session.renderer(techniques::find(technique)?, &values(technique, changes), &stages, recording)
    }

    /// The picture of one frame.
    pub fn picture(&self, technique: &str, changes: Changes<'_>) -> Picture {
        let picture = self.render(technique, changes).picture().unwrap();
        require_silence(&self.session.gpu, "reading the picture back");
        picture
    }

    /// The picture's hash.
    pub fn hash(&self, technique: &str, changes: Changes<'_>) -> String {
        self.picture(technique, changes).hash().unwrap()
    }

    /// A stage of three channels.
    pub fn rgb(&self, renderer: &Renderer, name: &str) -> Vec<[f32; 3]> {
        let aov = renderer.aov(name).unwrap();
        require_silence(&self.session.gpu, name);
        match aov.channels {
            AovChannels::Rgb(texels) => texels,
            other => panic!("{name} is no RGB stage: {other:?}"),
        }
    }

    /// A stage of one channel.
    pub fn floats(&self, renderer: &Renderer, name: &str) -> Vec<f32> {
        let aov = renderer.aov(name).unwrap();
        require_silence(&self.session.gpu, name);
        match aov.channels {
            AovChannels::Y(texels) => texels,
            other => panic!("{name} is no stage of one channel: {other:?}"),
        }
    }

    /// A stage of whole numbers.
    pub fn integers(&self, renderer: &Renderer, name: &str) -> Vec<u32> {
        let aov = renderer.aov(name).unwrap();
        require_silence(&self.session.gpu, name);
        match aov.channels {
            AovChannels::YU32(texels) => texels,
            other => panic!("{name} is no stage of whole numbers: {other:?}"),
        }
    }
}

impl Drop for Silence {
    fn drop(&mut self) {
        // A panic on its way out says more than what it left behind.
        if !std::thread::panicking() {
            require_silence(&self.0, "the whole test");
        }
    }
}

/// The technique's settings with some changed.
pub fn values(technique: &str, changes: Changes<'_>) -> Values {
    let settings = settings_of(techniques::find(technique).unwrap());
    let mut values = Values::defaults(&settings);
    for (key, text) in changes {
        let setting = settings.iter().find(|setting| setting.key == *key);
        values.set(setting.unwrap_or_else(|| panic!("{technique} does not read --{key}")), text).unwrap();
    }
    values
}

/// `first` and then `second`, which wins.
pub fn both<'a>(first: &[(&'a str, &'a str)], second: &[(&'a str, &'a str)]) -> Vec<(&'a str, &'a str)> {
    first.iter().chain(second).copied().collect()
}

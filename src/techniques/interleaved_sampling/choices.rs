//! What the settings come to.

use super::members::{Drawing, Members};
use crate::caps::Caps;
use crate::choice::{Choice, choices};
use crate::error::{Error, Result};
use crate::frame::{LensPlace, Placement};
use crate::lens::{Eyes, Lens, on_unit_disc};
use crate::lights::LightSet;
use crate::passes::forward::ForwardChoices;
use crate::passes::samples::Samples;
use crate::sampling::basis::Basis;
use crate::sampling::pattern::{Dimension, Pattern};
use crate::sampling::sampler::Places;
use crate::sampling::side::Side;
use crate::settings::{MapDrawing, Values};
use crate::techniques::exposure::Exposure;
use crate::techniques::interleaved_sampling::resources::NAME;
use crate::techniques::interleaved_sampling::slices::SliceChoices;
use crate::techniques::interleaved_sampling::soft::SoftLights;
use crate::techniques::{Inputs, NamedPattern};
use crate::units::Extent;

choices! {
    /// Where in their pixels samples may lie (`--places`).
    pub enum PixelPlaces {
        /// Anywhere.
        "free" => Free,
        /// At sixteenths of a pixel.
        "sixteenths" => Sixteenths,
    }
}

choices! {
    /// What samples are spread over (`--effect`).
    pub enum Effect {
        /// Places in their pixels.
        "aa" => Aa,
        /// The time that the shutter is open.
        "motion" => Motion,
        /// The lens.
        "defocus" => Defocus,
        /// Each light.
        "soft-shadow" => SoftShadow,
        /// Places between the planes of a volume.
        "volume" => Volume,
    }
}

impl Effect {
    /// Those of `--effect`.
    pub fn chosen(values: &Values) -> Vec<Self> {
        values.text("effect").split(',').filter_map(Self::from_word).collect()
    }

    /// Whether it is one of them.
    pub fn is_chosen(self, values: &Values) -> bool {
        Self::chosen(values).contains(&self)
    }

    /// What a sample has beside its place in its pixel.
    fn dimensions(self) -> &'static [Dimension] {
        match self {
            Self::Aa => &[],
            Self::Motion => &[Dimension::Time],
            Self::Defocus => &[Dimension::LensU, Dimension::LensV],
            Self::SoftShadow => &[Dimension::LightU, Dimension::LightV, Dimension::LightW],
            Self::Volume => &[Dimension::Slice],
        }
    }
}

/// Members of one picture: each is a run of what draws the scene, at least some tenths of a millisecond.
const MOST_MEMBERS: f64 = 65536.0;

/// The pattern that the settings choose.
pub const PATTERNS: &[NamedPattern] = &[NamedPattern {
    name: "basis",
    summary: "Samples over a basis of pixels, each of which becomes a regular grid",
    keys: &["basis", "samples", "sampler", "effect", "places", "seed"],
    make: |values| pattern(values),
}];

fn pattern(values: &Values) -> Result<Pattern> {
    if values.text("basis") == "frame" {
        let Extent { width, height } = values.extent("size");
        return Err(Error::request("basis=frame: a pattern by itself has no frame")
            .note(format!("its sides do, as in basis={width}x{height}")));
    }
    Ok(basis(values, values.extent("size"))?.pattern())
}

/// The sides that `--basis` names.
///
/// Errors: it names none, or one below 1 px (exit code 2).
fn sides(values: &Values, frame: Extent) -> Result<[Side; 2]> {
    let text = values.text("basis");
    if text == "frame" {
        return Ok([Side::new(frame.width, 1), Side::new(frame.height, 1)]);
    }
    let refused = |why: &str| {
        Error::request(format!("--basis {text}: {why}"))
            .within(NAME)
            .note("--basis 2x2, 2.5x1.75 and frame work; 1x1 is the accumulation buffer")
    };
    let (x, y) = text.split_once('x').ok_or_else(|| refused("it must be NxM, or frame"))?;
    let [x, y] = [x, y].map(Side::from_text);
    let (Some(x), Some(y)) = (x, y) else {
        return Err(refused("both sides must be numbers with at most two decimal places"));
    };
    if [x, y].iter().any(|side| side.length_px() < 1.0 || side.length_px() > 16384.0) {
        return Err(refused("both sides must be from 1 to 16384 pixels"));
    }
    Ok([x, y])
}

/// The basis of the settings.
///
/// Errors: as of its settings; more members than can be drawn (exit code 2).
fn basis(values: &Values, frame: Extent) -> Result<Basis> {
    let sides = sides(values, frame)?;
    let samples = values.number("samples");
    let count = samples * sides[0].length_px() * sides[1].length_px();
    if count > MOST_MEMBERS {
        let (text, samples) = (values.text("basis"), values.text("samples"));
        let why = format!(
            "--basis {text} with --samples {samples}: {count:.0} members, each drawn by itself, and {MOST_MEMBERS} at most"
        );
        let side = (MOST_MEMBERS / values.number("samples")).sqrt().floor();
        return Err(Error::request(why)
            .within(NAME)
            .note(format!("a basis of at most {side}x{side} pixels has fewer")));
    }
    let effects = Effect::chosen(values);
    if !effects.contains(&Effect::Aa) && sides.iter().any(|side| side.whole_px().is_none()) {
        let text = values.text("basis");
        let why = format!("--basis {text} without aa among --effect: its samples lie in no middles of pixels");
        return Err(Error::request(why).within(NAME).note("sides of whole pixels have such samples"));
    }
    let chosen = Effect::ALL.iter().filter(|effect| effects.contains(effect));
    let further: Vec<Dimension> = chosen.flat_map(|effect| effect.dimensions().iter().copied()).collect();
    let seed = values.integer("seed") as u32;
    let places = if effects.contains(&Effect::Aa) { Places::Spread } else { Places::Middles };
    let made = Basis::new(sides, &further, samples, values.choice("sampler"), places, seed);
    let made = made.map_err(|error| error.within(NAME))?;
    if pixel_places(values)? == PixelPlaces::Free || places == Places::Middles {
        return Ok(made);
    }
    if sides.iter().any(|side| side.whole_px().is_none()) {
        let text = values.text("basis");
        return Err(Error::request(format!("--places sixteenths with --basis {text}: bases begin at parts of pixels"))
            .within(NAME)
            .note("sides of whole pixels have each sample at one place of its pixel"));
    }
    Ok(made.in_sixteenths())
}

/// Where in their pixels samples lie.
///
/// Errors: elsewhere than the device has them (exit code 2).
fn pixel_places(values: &Values) -> Result<PixelPlaces> {
    let are_placed = values.is("members", Drawing::SampleLocations);
    let auto = if are_placed { PixelPlaces::Sixteenths } else { PixelPlaces::Free };
    let places = values.unless_auto("places", Values::choice).unwrap_or(auto);
    if are_placed && places == PixelPlaces::Free {
        let why = "--members sample-locations with --places free: devices have samples at sixteenths of a pixel";
        return Err(Error::request(why).within(NAME).note("--places sixteenths, or auto, has them there"));
    }
    Ok(places)
}

/// The members of the settings.
///
/// Errors: as of `basis`; a way to draw them that the basis, or the effect, has not (exit code 2).
fn members(values: &Values, frame: Extent, caps: &Caps) -> Result<Members> {
    let drawing: Drawing = values.choice("members");
    if drawing == Drawing::SampleLocations && Effect::chosen(values).iter().any(|effect| *effect != Effect::Aa) {
        let text = values.text("effect");
        let why = format!(
            "--members sample-locations with --effect {text}: what is drawn at once is seen from one place at one moment"
        );
        return Err(Error::request(why).within(NAME).note("--effect aa works, and --members tuples draws any"));
    }
    let is_whole = sides(values, frame)?.iter().all(|side| side.whole_px().is_some());
    if drawing.is_over_frame() && !is_whole {
        let (text, name) = (values.text("basis"), drawing.name());
        let why =
            format!("--members {name} with --basis {text}: a member's samples lie elsewhere in pixel after pixel");
        return Err(Error::request(why)
            .within(NAME)
            .note("sides of whole pixels have each in one place, and --members layers and stipple draw any"));
    }
    let basis = basis(values, frame)?;
    let at_once = match drawing {
        Drawing::SampleLocations => {
            let counts = caps.placed_sample_counts();
            let enough = counts.iter().find(|count| **count >= basis.member_count());
            *enough.or(counts.last()).expect("a device without it is refused before")
        }
        Drawing::Layers | Drawing::Stipple | Drawing::Tuples => 1,
    };
    Ok(Members::new(basis, frame, drawing, at_once))
}

/// The choices that the settings make.
pub struct Choices {
    pub drawing: ForwardChoices,
    pub members: Members,
    pub lens: Option<Lens>,
    /// With `--effect motion`, where something moves.
    pub exposure: Option<Exposure>,
    pub soft: Option<SoftLights>,
    /// With `--effect volume`.
    pub slices: Option<SliceChoices>,
}

impl Choices {
    /// Errors: settings that contradict each other (exit code 2); as `ForwardChoices::new`.
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let lens = match Effect::Defocus.is_chosen(values) {
            false => None,
            true if values.number("aperture") <= 0.0 => {
                return Err(Error::request("--effect defocus with --aperture 0: through a pinhole all is sharp")
                    .within(NAME)
                    .note("a diameter in metres, as --aperture 0.05, makes a lens"));
            }
            true => Some(Lens {
                radius: 0.5 * values.number("aperture") as f32,
                focus: crate::lens::focus_m(values, inputs.view, inputs.scene, inputs.bvh.over(inputs.scene)?),
                eyes: Eyes::One { aside: 0.0 },
            }),
        };
        let exposure = match Effect::Motion.is_chosen(values) {
            false => None,
            true if values.text("shutter") == "none" => {
                return Err(Error::request("--effect motion with --shutter none: a single moment has no motion")
                    .within(NAME)
                    .note("--shutter 0,0.02 is open for a fiftieth of a second"));
            }
            true => Exposure::new(inputs)?,
        };
        let soft = if Effect::SoftShadow.is_chosen(values) { Some(SoftLights::new(inputs)?) } else { None };
        let members = members(values, inputs.view.extent, inputs.caps)?;
        let samples = match members.drawing() {
            Drawing::SampleLocations => Samples::placed(members.at_once()),
            Drawing::Layers | Drawing::Stipple | Drawing::Tuples => Samples::ONE,
        };
        let mut choices = Self {
            members,
            lens,
            drawing: ForwardChoices::new(
                NAME,
                values,
                (inputs.scene, inputs.stats, soft.as_ref().map_or(inputs.lights, SoftLights::typical)),
                (inputs.caps, inputs.requirements),
                samples,
            )?,
            exposure,
            soft,
            slices: Effect::Volume.is_chosen(values).then(|| SliceChoices::new(inputs)).transpose()?,
        };
        if choices.changes() {
            if choices.drawing.maps.is_some() && values.is("shadow-maps", MapDrawing::Once) {
                return Err(Error::request("--shadow-maps once: each member has another moment, or lights elsewhere")
                    .within(NAME)
                    .note("--shadow-maps frame draws the maps anew for each"));
            }
            choices.drawing.hold_at_any_moment();
        }
        if choices.soft.is_some() {
            choices.drawing.direct.add_patches();
        }
        Ok(choices)
    }

    /// Whether members see the scene or its lights otherwise, and not only from elsewhere.
    pub fn changes(&self) -> bool {
        self.exposure.is_some() || self.soft.is_some()
    }

    /// Where in their pixels samples may lie.
    pub fn places(&self) -> PixelPlaces {
        if self.members.basis().is_in_sixteenths() { PixelPlaces::Sixteenths } else { PixelPlaces::Free }
    }

    /// Lights of a member.
    pub fn light_set<'a>(&'a self, inputs: &Inputs<'a>) -> &'a LightSet {
        self.soft.as_ref().map_or(inputs.lights, SoftLights::typical)
    }

    /// The part of the exposure at which a member sees the scene.
    pub fn part(&self, member: u32) -> f32 {
        self.members.basis().number(member, Dimension::Time).unwrap_or_default()
    }

    /// How a member lies in its picture, and where on the lens it sees from.
    pub fn sight(&self, member: u32) -> (LensPlace, Placement) {
        let place = self.lens.map_or(LensPlace::MIDDLE, |lens| {
            let number = |dimension| self.members.basis().number(member, dimension).unwrap_or_default();
            let numbers = [Dimension::LensU, Dimension::LensV].map(number);
            LensPlace { at_m: lens.radius * on_unit_disc(numbers), focus_m: lens.focus }
        });
        (place, self.members.placement(member))
    }
}

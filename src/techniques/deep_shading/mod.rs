//! Deep shading buffers: Clarberg and Munkberg 2014, "Deep Shading Buffers on Commodity GPUs". Under motion and defocus
//! blur each triangle is shaded once a pixel, however many samples see it.
//!
//! Words, which files here use as they are explained here
//! - tuple: a place in a pixel, on the lens and in time at which samples are taken; N of them are spread over a table
//!   of N/n pixels, which repeats over the frame (section 4.2)
//! - sample: a pixel of the frame at one of its tuples
//! - shading space, the paper's canonical one: the frame in the middle of the exposure, seen from the middle of the
//!   lens, in whose pixels surfaces are shaded (section 3)
//! - guard band: pixels of shading space around the frame's, for what blur brings in (`--guard-band`; guard_band.rs)
//! - SPID, shading point identifier: what a sample keeps of what it sees, the triangle's id and the pixel of
//!   shading space where that is shaded
//! - list: the triangles to be shaded at one pixel of shading space, in nodes that are linked or, once compacted,
//!   sorted in a row
//! - stray: a sample that no list has, because shading space has no place for it or its list is full
//! - entry: what is shaded once, a triangle at a pixel of shading space, or where a stray sees it
//! - hull: the polygon around every pixel which a triangle touches (`--conservative`)
//! - atlas, chart: a mesh's own texture coordinates, and a connected part of them (`--shading texture-space`)
//!
//! Passes: shadow_maps (with `--direct-shadow map`), scales (with `--shading-rate blur`), visibility (each sample's SPID),
//! lists (insertion by compare-exchange), lists.compact, lists.address, entries (sorts what lists have, and strays, by
//! material), shade, resolve (box filter), with `--reconstruct on` reconstruct.samples (motion and depth), reconstruct.bins,
//! reconstruct.layers, reconstruct.means and reconstruct.filter, count (`--instrument on`), accumulate (`--accumulate`
//! above 1). With `--shade-by fragment` shade is one conservative pass over shading space, and strays follow it; with
//! `--lists none` entries.samples takes the place of the lists.
//!
//! Baselines (`--shading`; baseline/mod.rs), whose passes are shadow_maps, one that draws and shades at once, resolve
//! and accumulate, or those of `indirect-gbuffer`
//! - `ssaa`: every sample that is drawn is shaded where its tuple sees it, drawn frame by frame or stochastically
//! - `msaa`: stochastic multisampling (McGuire et al. 2010), a triangle shaded once for those of a pixel's samples that
//!   see it, `--pass-samples` of them at a time
//! - `indirect-gbuffer`: decoupled deferred shading (Liktor and Dachsbacher 2012): the same samples find what is shaded
//!   in a cache and point to it in a compact geometry buffer (indirect/mod.rs); passes visibility, indirect.memoise,
//!   entries, indirect.gbuffer, indirect.shade
//! - `texture-space`: adaptive texture-space shading (Andersson et al. 2014): draw by draw a texture is shaded and then
//!   drawn with (baseline/texture_space/mod.rs)
//!
//! Differs from the paper
//! - a node of a list is its sample's own, so that no counter gives nodes out and their pool is as long as it can need
//!   to be; an insertion that another was quicker than looks at what is new, and no triangle comes into a list twice
//!   (`--duplicates tolerated` is the paper's way)
//! - colours of a compacted list follow each other from a place that the list's first node keeps; a pass of its own
//!   then looks up each sample's address
//! - s_z is the depth where the sample hit; zmax is a buffer, as compute shaders have no atomics on depth images, and is copied
//!   into one. Samples lie anywhere in a pixel: hulls lie nearer than their triangle's plane by what that rises in half a one;
//!   what is thinner than a pixel, warped or not drawn by hulls is as near as its nearest corner (depth.glsl)
//! - a shading point outside its triangle is brought to the triangle's nearest place; texture levels come from rates on
//!   the triangle's plane: colours depend on triangle and pixel alone
//! - samples outside shading space, behind its eye or before its near plane are shaded where they are seen, and
//!   counted; so are samples that see more in a pixel than the 1024 triangles that a list holds, so that work grows
//!   with samples alone
//! - a compute shader shades what lists have, as entries (`--shade-by fragment` is the paper's way: nothing has to be drawn
//!   where a colour is a function of triangle and pixel); where fragments do, shading space is drawn with triangles that
//!   lists have, which insertion marks (`--shaded-triangles all` is the paper's way)
//! - where blur makes the shading rate lower (`--shading-rate blur`), which the paper leaves for others to evaluate, each
//!   triangle is scaled by itself (scales.rs)
//! - BLEND surfaces, which the paper does not have: as many samples see one as its alpha says
//! - `--visibility stochastic` tests all of a pixel's samples in a loop, the nearest kept by 64-bit atomics (the paper has
//!   images of 8 samples a pixel and their depth test), or draws a layer a tuple where the device has none
//!   (`--sample-tests`); a pixel's own samples are those of a tuple of the interleaved kinds with other binary digits, or
//!   with `--pixel-samples shared` these very samples
//! - `--visibility ray` walks a tree of the project's own; with `--lists direct` the host makes the lists, too, and no
//!   SPID is kept
//! - the reconstruction is a filter of our choice; motion vectors come from SPIDs after visibility (reconstruct/mod.rs)
//! - two eyes (`--stereo`) share one buffer, which the paper has as future work (section 7; stereo.rs)
//! - light as by `forward`, `--direct-shadow map` as the paper's; surfaces face as the middle of the lens sees them
//!
//! Equals itself: `--lists none`, which shades every sample, and every setting of the lists give the same picture, to
//! the bit on software drivers, and so does every order of `--visibility`; `--conservative none` alone leaves samples
//! without a colour. Without blur it is `forward --supersample` with samples in other places.

mod baseline;
mod bench_stages;
mod buffer_addresses;
mod choices;
mod contradictions;
mod count;
mod counters;
mod entries;
mod eyes;
mod frame;
mod guard_band;
mod indirect;
mod lists;
mod mid_exposure;
mod modes;
mod pass_inputs;
mod passes;
mod plan;
mod primitives;
mod ranges;
mod reconstruct;
mod resolve;
pub(crate) mod resources;
mod rivals;
mod sample_colors;
mod sample_count;
mod scales;
mod scene;
mod separate;
mod settings;
mod shade;
mod space;
mod stages;
mod stereo;
mod touched;
pub(crate) mod tuples;
mod visibility;

use super::bench_stage::BenchStage;
use super::{Figures, HostPart, Inputs, NamedPattern, Prepared, Rival, Technique, Tuned, notes, straight_light};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::lights::LightSet;
use crate::passes::shadow_maps::{self, MapLayout};
use crate::plan::Plan;
use crate::settings::{INSTRUMENT, SHADOW_MAPS, Setting, TEXELS, Values};
use crate::techniques::deep_shading::choices::list_access_name;
use crate::techniques::deep_shading::modes::barycentrics::Barycentrics;
use crate::techniques::deep_shading::modes::conservative::Conservative;
use crate::techniques::deep_shading::modes::sample_tests::SampleTests;
use crate::techniques::deep_shading::modes::sample_tests::sample_tests_name;
use crate::techniques::deep_shading::modes::shade_by::ShadeBy;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;
use crate::techniques::deep_shading::resources::{NAME, full};
use baseline::texture_space::atlases::Atlases;
use choices::Choices;
use frame::{DeepFrame, HostTables};
use modes::layer_from::LayerFrom;
use modes::polygon_from::PolygonFrom;
use modes::shading::Shading;
use modes::vertices::Vertices;
use modes::visibility::Visibility;
use primitives::Primitives;
use std::collections::BTreeMap;
use visibility::ray::TracedSamples;

pub struct DeepShading;

impl Technique for DeepShading {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "deep shading buffers (Clarberg 2014): motion and defocus blur, each triangle shaded once a pixel"
    }

    fn scene(&self) -> &'static str {
        "chess"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, settings::SHARED, SHADOW_MAPS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        stages::ALL
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("list-access", "auto"), ("direct-shadow", "none"), ("shading-texture-size", "1024")]
    }

    fn needs(&self, values: &Values, caps: &Caps, _: bool) -> Vec<Need> {
        let need = |of: &str, ability, instead| Need { of: of.to_owned(), ability, instead };
        let mut needs = vec![need("the visibility pass", Ability::FloatDepth, "")];
        let visibility = Visibility::of(values, caps);
        let shading: ShadingKind = values.choice("shading");
        let has_layers = ShadingKind::OF_SPACE.contains(&shading);
        if has_layers && visibility.is_layered() {
            let ability = match LayerFrom::of(values, caps) {
                LayerFrom::Vertex if visibility.has_layer_from() => Ability::LayerFromVertex,
                _ => Ability::GeometryShader,
            };
            let of = format!("--visibility {}", visibility.name());
            needs.push(need(&of, ability, "--visibility repeat-frame works without it"));
        }
        if has_layers && visibility.draws_corners() && Vertices::of(values, caps) == Vertices::Indexed {
            needs.push(need("--vertices indexed", Ability::GeometryShader, "--vertices fetched works without it"));
        }
        let has_polygons = visibility.has_polygons() && shading != ShadingKind::Msaa;
        if has_polygons && PolygonFrom::of(values, caps) == PolygonFrom::Geometry {
            let instead = "--polygon-from vertex works without it";
            needs.push(need("--polygon-from geometry", Ability::GeometryShader, instead));
        }
        let is_looped = values.is("sample-tests", SampleTests::Loop);
        if has_layers && visibility == Visibility::Stochastic && is_looped {
            let instead = "--sample-tests layers works without it";
            needs.push(need("--sample-tests loop", Ability::WideAtomics, instead));
        }
        if ShadeBy::of(values) == Some(ShadeBy::Fragment) {
            needs.push(need("--shade-by fragment", Ability::FragmentAtomics, "--shade-by compute works without it"));
        } else if !has_layers {
            let of = format!("--shading {}", shading.name());
            needs.push(need(&of, Ability::FragmentAtomics, "--shading deep works without it"));
        } else if visibility.has_polygons() {
            let instead = "--visibility repeat-frame works without it";
            needs.push(need("--visibility stochastic", Ability::FragmentAtomics, instead));
        }
        match Conservative::of(values, caps) {
            // Read with fragments alone, and a device has it or not whatever else is asked.
            _ if shading != ShadingKind::Deep => {}
            Conservative::Geometry => {
                let instead = "--conservative vertex works without it";
                needs.push(need("--conservative geometry", Ability::GeometryShader, instead));
            }
            Conservative::Hardware => {
                let instead = "--conservative vertex works without it";
                needs.push(need("--conservative hardware", Ability::ConservativeRaster, instead));
            }
            Conservative::Vertex | Conservative::Plain => {}
        }
        if shading == ShadingKind::Deep && values.is("barycentrics", Barycentrics::Device) {
            let instead = "--barycentrics interpolated works without it";
            needs.push(need("--barycentrics device", Ability::FragmentBarycentrics, instead));
        }
        needs.extend(baseline::needs(values));
        needs.extend(shadow_maps::needs(values));
        needs
    }

    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)> {
        vec![("--tuples", format!("{}", caps.limits.max_image_layers.min(2048)))]
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        straight_light(values, lights, 0)
    }

    fn rivals(&self) -> Vec<Rival> {
        rivals::rivals()
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        Vec::from_iter(notes::direct_light(figures, None))
    }

    fn tuned(&self) -> Tuned {
        &[
            ("lists", &["linked", "direct", "none"]),
            ("shade-by", &["compute", "fragment"]),
            ("cull-lights", &["on", "off"]),
            ("duplicates", &["avoided", "tolerated"]),
            ("compaction", &["on", "off"]),
            ("zmax", &["off", "on"]),
            ("shaded-triangles", &["listed", "all"]),
            ("texels", &["auto", "1", "4", "16"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        tuples::PATTERNS
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        Ok(Box::new(PreparedDeep { choices: Choices::new(inputs)? }))
    }
}

struct PreparedDeep {
    choices: Choices,
}

impl Prepared for PreparedDeep {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs)
    }

    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        stages::left_out(&self.choices)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let Choices { shading, table, pixel_samples, visibility, raster, blur, .. } = &self.choices;
        let mut resolved = BTreeMap::from([
            ("spp", table.samples.to_string()),
            ("tuples", table.tuples_of_eye().to_string()),
            ("guard-band", self.choices.space.guard_px.to_string()),
            ("visibility", visibility.name().to_owned()),
            ("pixel-samples", pixel_samples.name().to_owned()),
        ]);
        if self.choices.is_by_fragment() {
            resolved.insert("conservative", raster.conservative.name().to_owned());
        }
        if *shading == Shading::Deep {
            resolved.insert(TEXELS.key, self.choices.texels.to_string());
        }
        if let Shading::Msaa { pass_samples } = shading {
            resolved.insert("pass-samples", pass_samples.to_string());
        }
        if *shading == Shading::IndirectGbuffer {
            resolved.insert("shading-cache", self.choices.cache_entries.to_string());
        }
        resolved.insert(INSTRUMENT.key, self.choices.count_axis().to_owned());
        resolved.extend(self.choices.maps.as_ref().map(MapLayout::resolved));
        if visibility.has_layer_from() {
            resolved.insert("layer-from", raster.layer_from.name().to_owned());
        }
        if visibility.draws_corners() && matches!(shading, Shading::Deep | Shading::IndirectGbuffer) {
            resolved.insert("vertices", raster.vertices.name().to_owned());
        }
        if visibility.has_polygons() && !matches!(shading, Shading::Msaa { .. }) {
            resolved.insert("polygon-from", raster.polygon_from.name().to_owned());
        }
        if *visibility == Visibility::Stochastic && matches!(shading, Shading::Deep | Shading::IndirectGbuffer) {
            resolved.insert("sample-tests", sample_tests_name(raster.is_looped).to_owned());
        }
        if matches!(shading, Shading::Deep | Shading::IndirectGbuffer) {
            resolved.insert("list-access", list_access_name(self.choices.is_by_address).to_owned());
        }
        if let Some(lens) = blur.lens {
            resolved.insert("focus", format!("{}", lens.focus));
        }
        resolved.insert("reconstruct", if blur.is_reconstructed { "on" } else { "off" }.to_owned());
        resolved
    }

    fn host_part(self: Box<Self>, inputs: &Inputs<'_>) -> Result<HostPart> {
        let choices = self.choices;
        let primitives = Primitives::new(inputs.scene)?;
        let is_traced = choices.visibility == Visibility::Ray;
        let traced = if is_traced { Some(TracedSamples::new(inputs, &choices, &primitives)?) } else { None };
        let atlases = match choices.shading {
            Shading::TextureSpace(size) => Some(Atlases::of(inputs.scene, size.side_px)?),
            _ => None,
        };
        let light_count = inputs.lights.lights.len() as u32;
        Ok(HostPart {
            passes: traced.iter().map(|traced| (full("visibility.rays"), traced.time_ns)).collect(),
            counters: BTreeMap::from([("lights", f64::from(light_count)), ("primitives", primitives.count as f64)]),
            light_counts: [light_count, 0],
            build: Box::new(move |gpu, inputs, scene, resources| {
                let host = HostTables { primitives, traced, atlases };
                Ok(Box::new(DeepFrame::new(gpu, inputs, scene, resources, choices, host)?))
            }),
        })
    }
}

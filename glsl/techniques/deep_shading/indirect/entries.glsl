// The compact geometry buffer: of each shading sample all that its material says, in floats, so that what is shaded from it has
// the bits of what is shaded where it is drawn. Four buffers of 16 bytes an entry: one of 64 would outgrow the range of one
// binding at a quarter of the samples. Planned by src/techniques/deep_shading/indirect/mod.rs.
//
// After reach.glsl; the including shader declares `reach` and defines ENTRY_ACCESS, readonly or writeonly, and whichever of
// READS_QUADS and WRITES_QUADS goes with it as ENTRY_FUNCTION.
#ifndef DEEP_SHADING_ENTRIES_GLSL
#define DEEP_SHADING_ENTRIES_GLSL

// xyz: world space; w: F0 of a dielectric.
layout(std430, set = 0, binding = 35) ENTRY_ACCESS buffer EntryPlaces { vec4 entry_places[]; };
// xyz: unit, world space; w: roughness.
layout(std430, set = 0, binding = 36) ENTRY_ACCESS buffer EntryNormals { vec4 entry_normals[]; };
// rgb: base colour; w: metallic.
layout(std430, set = 0, binding = 37) ENTRY_ACCESS buffer EntryBaseColors { vec4 entry_base_colors[]; };
// rgb: towards the eye before any light reaches it; w: 1 where none does, else 0.
layout(std430, set = 0, binding = 38) ENTRY_ACCESS buffer EntryRadiances { vec4 entry_radiances[]; };

ENTRY_FUNCTION(entry_place, entry_places)
ENTRY_FUNCTION(entry_normal, entry_normals)
ENTRY_FUNCTION(entry_base_color, entry_base_colors)
ENTRY_FUNCTION(entry_radiance, entry_radiances)

#endif

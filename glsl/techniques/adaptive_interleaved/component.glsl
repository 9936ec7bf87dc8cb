// The component of the axis COMPONENT: a file of components/, with two parts of Listing 1 (Dubla 2009, section 3.1).
//
// Its guidance: `Found`, what the texels of a tile found together, with `add_found`, `refine_of` and `refines`. With
// estimate.glsl before it, its samples too: `is_estimated`, `contribute` and `found_word`.
#ifndef ADAPTIVE_INTERLEAVED_COMPONENT_GLSL
#define ADAPTIVE_INTERLEAVED_COMPONENT_GLSL

#if defined(COMPONENT_ID)
#include "techniques/adaptive_interleaved/components/id.glsl"
#elif defined(COMPONENT_SS)
#include "techniques/adaptive_interleaved/components/ss.glsl"
#elif defined(COMPONENT_PM)
#include "techniques/adaptive_interleaved/components/pm.glsl"
#elif defined(COMPONENT_AO)
#include "techniques/adaptive_interleaved/components/ao.glsl"
#endif

#endif

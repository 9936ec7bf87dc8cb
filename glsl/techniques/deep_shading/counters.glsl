// What a frame counts (the report's counters); src/techniques/deep_shading/counters.rs reads it.
#ifndef DEEP_SHADING_COUNTERS_GLSL
#define DEEP_SHADING_COUNTERS_GLSL

// Colours that compaction or the host has given out, or entries of a compact geometry buffer: they need this one.
const uint COUNTED_COLORS = 0u;
// Samples without a list: those before it have their colours from the end on.
const uint COUNTED_STRAYS = 1u;
// Surfaces that were shaded, after the look-up.
const uint COUNTED_SHADED = 2u;
// Samples whose colour was never stored.
const uint COUNTED_MISSING = 3u;
// Triangles of all lists, each once.
const uint COUNTED_LISTED = 4u;
// Those that stand in a list again.
const uint COUNTED_DUPLICATES = 5u;
// The longest list.
const uint COUNTED_LONGEST = 6u;
// Lists that do not fit into a row.
const uint COUNTED_OVERFLOWS = 7u;
// Pixels of shading space with a list.
const uint COUNTED_PIXELS = 8u;
// Samples that see a surface.
const uint COUNTED_SAMPLES = 9u;
// Samples that were tested against a triangle, stochastic visibility's, modulo 2^32.
const uint COUNTED_TESTS = 10u;
// How often that number went around.
const uint COUNTED_TESTS_CARRIED = 11u;
// Those of the tests in which the sample lay in the triangle.
const uint COUNTED_TESTS_HIT = 12u;
// Samples that a list had no room for: a part of the strays.
const uint COUNTED_CROWDED = 13u;
// Nodes that were written: of lists, of insertions that another was quicker than, and of strays.
const uint COUNTED_NODES = 14u;
// Entries of rows that compaction wrote, those that end them included.
const uint COUNTED_ROW_IDS = 15u;
// The sum of a number of each pair of shading pixel and triangle, modulo 2^32: of the same pairs in any order the same.
const uint COUNTED_DIGEST = 16u;
// Shading samples that a full cache forgot (--shading indirect-gbuffer).
const uint COUNTED_FORGOTTEN = 17u;
// Samples all of whose texels a triangle of another chart owns (--shading texture-space): those too, as of COUNTED_MISSING there,
// that something nearer covers later.
const uint COUNTED_OTHER_CHARTS = 18u;
// Pixels of shading space that triangles were drawn at, before any look-up.
const uint COUNTED_DRAWN = 19u;
// Entries that have a material's place in the order (entries/spans.comp).
const uint COUNTED_ORDERED = 20u;
// Evaluations of a light at an entry, modulo 2^32, and how often that number went around.
const uint COUNTED_EVALUATIONS = 21u;
const uint COUNTED_EVALUATIONS_CARRIED = 22u;
const uint COUNTER_COUNT = 23u;

#endif

// The visibility buffer of pointers: of each sample where in the compact geometry buffer the shading sample lies that it sees.
// A sample that finds it in the cache learns which sample made the entry; only that one knows the entry itself.
#ifndef DEEP_SHADING_POINTERS_GLSL
#define DEEP_SHADING_POINTERS_GLSL

// The rest is an entry's index; else it is one more than the index of the sample that has the entry, 0 where there is none.
const uint POINTER_OWNS = 0x80000000u;

#endif

// What stands where a number would be a lie: it fails the picture.
#ifndef NAN_GLSL
#define NAN_GLSL

float no_number() {
    return uintBitsToFloat(0x7fc00000u);
}

#endif

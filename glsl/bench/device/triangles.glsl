// The numbers of a draw of `bench device`: a grid of squares, of two triangles each. Read by: triangles.vert, triangles.frag.

struct TrianglesParams {
    // Where the grid's first corner is in clip space.
    vec2 origin_ndc;
    // From a corner to the next one, across and down.
    float step_ndc;
    // What the target holds where the draw covers it.
    uint number;
};

// A vertex's index is its column, and its row times two to the power of this.
const uint TRIANGLES_COLUMN_BITS = 10u;

layout(push_constant) uniform Push { TrianglesParams params; };

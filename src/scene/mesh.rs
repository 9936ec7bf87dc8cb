//! Triangle lists and where they stand.

use glam::{DVec3, Mat3, Mat4, Vec2, Vec3, Vec4};

/// One triangle list with one material, in object space.
///
/// The vertex arrays all have the same length; `indices` holds three entries a triangle, each below that length.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    pub name: String,
    /// Metres.
    pub positions: Vec<Vec3>,
    /// Unit length.
    pub normals: Vec<Vec3>,
    /// xyz unit length along increasing u, w = +1 or -1: the bitangent is w * cross(normal, tangent).
    /// All zero where the material has no normal map.
    pub tangents: Vec<Vec4>,
    /// Texture coordinates, glTF's convention: (0, 0) is the picture's upper left corner.
    pub uvs: Vec<Vec2>,
    /// The second set; empty where the material has no texture that reads it.
    pub uvs_1: Vec<Vec2>,
    /// Coordinates at which each triangle has a place of a texture to itself (`scene::atlas` looks whether it has); no material
    /// reads them. Empty where they have not been laid out.
    pub atlas: Vec<Vec2>,
    /// Linear RGB and alpha, 0 to 1, that multiply the material's base colour; empty where all are white.
    pub colors: Vec<Vec4>,
    /// The id of the normal group that each vertex is of (`scene::normal_groups`); empty before they are found.
    pub normal_groups: Vec<u8>,
    pub indices: Vec<u32>,
    /// Index into `Scene::materials`.
    pub material: usize,
}

impl Mesh {
    pub fn triangle_count(&self) -> usize {
        self.indices.len() / 3
    }

    /// What its vertices and indices take in memory.
    pub fn size_bytes(&self) -> usize {
        let vectors = size_of_val(self.positions.as_slice()) + size_of_val(self.normals.as_slice());
        let coordinates =
            size_of_val(self.uvs.as_slice()) + size_of_val(self.uvs_1.as_slice()) + size_of_val(self.atlas.as_slice());
        let others = size_of_val(self.tangents.as_slice()) + size_of_val(self.colors.as_slice());
        vectors + coordinates + others + self.normal_groups.len() + size_of_val(self.indices.as_slice())
    }

    /// Adds a vertex that equals `vertex`, and returns its index.
    pub fn repeat_vertex(&mut self, vertex: usize) -> u32 {
        fn repeat<T: Copy>(attribute: &mut Vec<T>, vertex: usize) {
            let value = attribute.get(vertex).copied();
            attribute.extend(value);
        }
        repeat(&mut self.positions, vertex);
        repeat(&mut self.normals, vertex);
        repeat(&mut self.tangents, vertex);
        repeat(&mut self.uvs, vertex);
        repeat(&mut self.uvs_1, vertex);
        repeat(&mut self.atlas, vertex);
        repeat(&mut self.colors, vertex);
        repeat(&mut self.normal_groups, vertex);
        self.positions.len() as u32 - 1
    }

    /// The vertices of triangle `triangle`.
    pub fn corners(&self, triangle: usize) -> [usize; 3] {
        [0, 1, 2].map(|corner| self.indices[3 * triangle + corner] as usize)
    }

    /// The three corners of triangle `triangle`, in object space.
    pub fn triangle(&self, triangle: usize) -> [Vec3; 3] {
        self.corners(triangle).map(|vertex| self.positions[vertex])
    }
}

/// One mesh at one place.
#[derive(Clone, Copy, Debug)]
pub struct Draw {
    /// Index into `Scene::meshes`.
    pub mesh: usize,
    /// Affine. A negative determinant mirrors: the renderer then turns the winding around.
    pub world_from_object: Mat4,
}

/// What a file says of the draws of one of its nodes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Node {
    /// Empty where it has none.
    pub name: String,
    /// As `Material::stipple_layer`, before which it is heard.
    pub stipple_layer: Option<u32>,
}

impl Draw {
    /// Turns normals as the draw turns its surface: the inverse transpose up to a positive factor, which normalising takes
    /// out again.
    pub fn normals_from_object(&self) -> Mat3 {
        let linear = Mat3::from_mat4(self.world_from_object);
        let sign = if linear.determinant() < 0.0 { -1.0 } else { 1.0 };
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        Mat3::from_cols(sign * y.cross(z), sign * z.cross(x), sign * x.cross(y))
    }

    /// The front's normal of triangle `triangle` of `mesh`, which is the one drawn, in world space; as long as twice the area.
    pub fn front(&self, mesh: &Mesh, triangle: usize) -> DVec3 {
        let [a, b, c] =
            mesh.triangle(triangle).map(|corner| self.world_from_object.transform_point3(corner).as_dvec3());
        let normal = (b - a).cross(c - a);
        if self.world_from_object.determinant() < 0.0 { -normal } else { normal }
    }

    /// The box around the vertices of `mesh`, which is the one drawn, in world space.
    pub fn bounds(&self, mesh: &Mesh) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        self.extend(mesh, &mut bounds);
        bounds
    }

    /// Includes the vertices of `mesh`, which is the one drawn, in `bounds`, in world space.
    pub fn extend(&self, mesh: &Mesh, bounds: &mut Bounds) {
        for position in &mesh.positions {
            bounds.include(self.world_from_object.transform_point3(*position));
        }
    }
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: Vec3,
    pub max: Vec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    pub fn include(&mut self, point: Vec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// x changes fastest, then y.
    pub fn corners(&self) -> [Vec3; 8] {
        let pick = |corner: usize, axis: usize| if corner >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
        std::array::from_fn(|corner| Vec3::new(pick(corner, 0), pick(corner, 1), pick(corner, 2)))
    }

    pub fn center(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Length of the diagonal in metres; 0 where empty.
    pub fn diagonal(&self) -> f32 {
        if self.is_empty() { 0.0 } else { (self.max - self.min).length() }
    }
}

/// Areas of triangles by the direction that their fronts look in, world space, square metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facing {
    /// Sum of area times unit normal of the single-sided faces: 0 for closed shapes. What is double-sided looks both ways.
    pub net: DVec3,
    /// Sum of area times the sizes of the normal's three numbers, of all faces.
    pub along: DVec3,
    /// Area of all faces.
    pub area: f64,
}

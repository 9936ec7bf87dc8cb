//! Light and surfaces: the host's twins of glsl/shading/, for tests and for passes that run on the host.
//!
//! Units. A punctual light's intensity is in candela (point, spot) or lux (directional), an emissive material's colour is
//! radiance in cd/m^2, all as glTF has them and all per RGB channel. A point light of I candela gives a surface at
//! distance d, whose normal leans by theta, the irradiance I cos(theta) / d^2; a directional light of E lux gives
//! E cos(theta). A Lambert surface of albedo a under irradiance E sends the radiance a E / pi. In a picture at exposure
//! 0, radiance 1 is the value 1.0: a white surface under an irradiance of pi lux. A point light's flux is 4 pi I, a
//! Lambert panel's of radiance L and area A is pi L A.

pub mod brdf;
pub mod light;
pub mod material;
pub mod medium;
pub mod scatter;

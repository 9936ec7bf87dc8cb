//! Lambert, Blinn-Phong and GGX on the host: the twin of glsl/shading/brdf.glsl.

use crate::scene::material::DEFAULT_DIELECTRIC_F0;
use crate::settings::Brdf;
use glam::Vec3;
use std::f32::consts::PI;

/// A surface as light sees it; colours linear, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    pub base_color: Vec3,
    pub metallic: f32,
    pub roughness: f32,
    /// `Material::dielectric_f0`.
    pub dielectric_f0: f32,
}

impl Surface {
    /// Base colour of the part that scatters diffusely.
    pub fn albedo(&self) -> Vec3 {
        self.base_color * (1.0 - self.metallic)
    }

    fn f0(&self) -> Vec3 {
        Vec3::splat(self.dielectric_f0).lerp(self.base_color, self.metallic)
    }

    /// Fresnel's value at grazing angles.
    fn f90(&self) -> f32 {
        if self.dielectric_f0 == 0.0 { self.metallic } else { 1.0 }
    }
}

/// The 8 bits that encode F0 of a dielectric, 0 to 1, in materials and in the G-buffer: 0 for the default, else steps
/// of its root.
pub fn code_of_f0(f0: f32) -> u32 {
    if f0 == DEFAULT_DIELECTRIC_F0 { 0 } else { 1 + (f0.sqrt() * 254.0).round() as u32 }
}

/// Part of a radiance that comes from everywhere that a surface sends on, 0 to 1: its diffuse part, and beside Lambert
/// its mirror part at normal incidence.
pub fn ambient_reflectance(kind: Brdf, surface: &Surface) -> Vec3 {
    let f0 = match kind {
        Brdf::Lambert => Vec3::ZERO,
        Brdf::BlinnPhong | Brdf::Ggx => surface.f0(),
    };
    (Vec3::ONE - f0) * surface.albedo() + f0
}

/// The BRDF in 1/sr, without the cosine; all vectors unit length.
pub fn evaluate(kind: Brdf, surface: &Surface, normal: Vec3, to_light: Vec3, to_eye: Vec3) -> Vec3 {
    let diffuse = surface.albedo() / PI;
    if kind == Brdf::Lambert {
        return diffuse;
    }
    let half_vector = (to_light + to_eye).normalize();
    let n_dot_h = normal.dot(half_vector).clamp(0.0, 1.0);
    let v_dot_h = to_eye.dot(half_vector).clamp(0.0, 1.0);
    let n_dot_l = normal.dot(to_light).clamp(0.0, 1.0);
    let n_dot_v = normal.dot(to_eye).max(1e-4);
    let alpha = (surface.roughness * surface.roughness).max(1e-3);
    let alpha_squared = alpha * alpha;
    let f0 = surface.f0();
    let fresnel = f0 + (Vec3::splat(surface.f90()) - f0) * (1.0 - v_dot_h).powi(5);
    let specular = if kind == Brdf::BlinnPhong {
        let exponent = (2.0 / alpha_squared - 2.0).max(1.0);
        (exponent + 2.0) / (8.0 * PI) * n_dot_h.max(1e-6).powf(exponent)
    } else {
        let denominator = n_dot_h * n_dot_h * (alpha_squared - 1.0) + 1.0;
        let distribution = alpha_squared / (PI * denominator * denominator);
        let masking = n_dot_l * (n_dot_v * n_dot_v * (1.0 - alpha_squared) + alpha_squared).sqrt();
        let shadowing = n_dot_v * (n_dot_l * n_dot_l * (1.0 - alpha_squared) + alpha_squared).sqrt();
        distribution * 0.5 / (masking + shadowing).max(1e-6)
    };
    (Vec3::ONE - fresnel) * diffuse + fresnel * specular
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader::shading::{brdf, extras};

    #[test]
    fn numbers_are_the_shader_s() {
        assert_eq!(DEFAULT_DIELECTRIC_F0, extras::DEFAULT_DIELECTRIC_F0);
        let kinds = [Brdf::Lambert, Brdf::BlinnPhong, Brdf::Ggx].map(|kind| kind as u32);
        assert_eq!(kinds, [brdf::BRDF_LAMBERT, brdf::BRDF_BLINN_PHONG, brdf::BRDF_GGX]);
    }

    /// Part of the light from one direction that leaves in all directions, by a midpoint rule over the hemisphere.
    fn reflected(kind: Brdf, surface: &Surface, incidence: f32) -> f32 {
        let to_light = Vec3::new(incidence.sin(), incidence.cos(), 0.0);
        let (steps, mut sum) = (200, 0.0);
        for i in 0..steps {
            // Equal steps of cos^2: each direction stands for the same projected solid angle.
            let cosine = ((i as f32 + 0.5) / steps as f32).sqrt();
            let sine = (1.0 - cosine * cosine).sqrt();
            for j in 0..2 * steps {
                let azimuth = PI * (j as f32 + 0.5) / steps as f32;
                let to_eye = Vec3::new(sine * azimuth.cos(), cosine, sine * azimuth.sin());
                sum += evaluate(kind, surface, Vec3::Y, to_light, to_eye).x;
            }
        }
        sum * PI / (2 * steps * steps) as f32
    }

    #[test]
    fn a_white_lambert_surface_loses_no_light_and_ggx_makes_little() {
        for roughness in [0.3, 0.6, 1.0] {
            for metallic in [0.0, 1.0] {
                let surface =
                    Surface { base_color: Vec3::ONE, metallic, roughness, dielectric_f0: DEFAULT_DIELECTRIC_F0 };
                for incidence in [0.0, 0.7, 1.2] {
                    let ggx = reflected(Brdf::Ggx, &surface, incidence);
                    // glTF weighs the diffuse part by 1 - F of the half vector of each direction, the specular part by F
                    // of the mirror's: at grazing angles a white dielectric gives up to a tenth too much.
                    let most = if metallic == 1.0 { 1.01 } else { 1.11 };
                    assert!(ggx > 0.3 && ggx < most, "roughness {roughness}, metallic {metallic}: {ggx}");
                }
            }
        }
        let white =
            Surface { base_color: Vec3::ONE, metallic: 0.0, roughness: 1.0, dielectric_f0: DEFAULT_DIELECTRIC_F0 };
        assert!((reflected(Brdf::Lambert, &white, 0.9) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_white_surface_sends_all_ambient_light_on_and_a_metal_its_color() {
        let color = Vec3::new(0.9, 0.5, 0.2);
        for metallic in [0.0, 0.5, 1.0] {
            let white =
                Surface { base_color: Vec3::ONE, metallic, roughness: 0.5, dielectric_f0: DEFAULT_DIELECTRIC_F0 };
            assert!((ambient_reflectance(Brdf::Ggx, &white) - 1.0).max_element() < 1e-6);
        }
        let metal = Surface { base_color: color, metallic: 1.0, roughness: 0.5, dielectric_f0: DEFAULT_DIELECTRIC_F0 };
        assert_eq!(ambient_reflectance(Brdf::Ggx, &metal), color);
        assert_eq!(ambient_reflectance(Brdf::Lambert, &metal), Vec3::ZERO);
    }

    #[test]
    fn ggx_is_reciprocal() {
        let surface = Surface {
            base_color: Vec3::new(0.9, 0.5, 0.2),
            metallic: 0.4,
            roughness: 0.5,
            dielectric_f0: DEFAULT_DIELECTRIC_F0,
        };
        let a = Vec3::new(0.3, 0.8, 0.1).normalize();
        let b = Vec3::new(-0.5, 0.4, 0.6).normalize();
        let there = evaluate(Brdf::Ggx, &surface, Vec3::Y, a, b);
        let back = evaluate(Brdf::Ggx, &surface, Vec3::Y, b, a);
        assert!((there - back).abs().max_element() < 1e-5);
    }
}

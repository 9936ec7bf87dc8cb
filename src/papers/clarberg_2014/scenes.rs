//! Scenes of ours in place of the paper's, and how they are blurred. The paper gives no apertures and no shutter: those are ours.

use crate::papers::recipe::Effort;

/// In place of the paper's Sponza, as many lights and draws.
pub const SPONZA: &str = "hall:lights=16,draws=392";

/// Name of the paper, scene, and blur. Small pictures have scenes with about as many triangles a pixel, or the fewest that
/// those can have.
pub fn blurred(effort: Effort) -> [(&'static str, &'static str, &'static str); 3] {
    [
        (
            "ARENA",
            effort.pick("arena", "arena:triangles=60000"),
            "--aperture 0.1 --camera flight --time 10 --shutter 0,0.0166667",
        ),
        ("SPONZA", effort.pick(SPONZA, "hall:lights=16,draws=392,triangles=16000"), "--aperture 0.1"),
        ("POWER", effort.pick("power", "power:triangles=30000"), "--aperture 0.15"),
    ]
}

/// The paper's pictures: 8 samples a pixel, of 32 tuples where samples are interleaved.
pub fn pictures(effort: Effort) -> String {
    format!("{} --technique deep_shading --spp 8 --tuples 32", effort.size(1280, 720))
}

/// `pictures`, for what says samples and tuples by itself.
pub fn frames(effort: Effort) -> String {
    format!("{} --technique deep_shading", effort.size(1280, 720))
}

/// Executions are the same whatever light falls: for pictures that nobody looks at.
pub const UNLIT: &str = "--brdf lambert --direct-shadow none --light-cutoff 1000";

/// Scenes with blur that errors are taken of.
pub fn judged() -> [(&'static str, &'static str, &'static str); 3] {
    [
        ("hall", SPONZA, "--aperture 0.1"),
        ("arena", "arena", "--aperture 0.1 --camera flight --time 10 --shutter 0,0.04"),
        ("chess", "chess", "--shutter 0,0.04"),
    ]
}

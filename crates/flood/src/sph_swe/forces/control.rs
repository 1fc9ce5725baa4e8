//! The terrain-difference velocity control force.

use crate::sph_swe::density::h_of_density;
use crate::sph_swe::ground::GROUND_BLOCK;
use crate::sph_swe::particle::Particle;
use corpuscle_scene::{SmoothingForm, SphSwe};
use corpuscle_sph::{LANES, Lanes, Level, Simd, SimdBase, SimdFloat, dispatch};
use corpuscle_terrain::Terrain;

/// Particles whose control forces are computed together: each evaluates four positions of the ground.
pub(super) const CONTROLLED: usize = GROUND_BLOCK / 4;

/// Corners of a square of side 1 round the origin.
const CORNERS: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];

/// The terrain-difference velocity control force on some particles: f = (h_D^2/4) (f_A + f_B + f_C + f_D) with
/// f = (rho2D/rho3D) NP at the corners of a square of side h_D = alpha h0 sqrt(rho0/rho).
///
/// Our reading, for the paper's units do not close: the size of NP is |NP| in three dimensions, it acts against the horizontal
/// motion, and it is an acceleration times `control_strength`. It stops the motion at most.
pub(super) fn control(
    parameters: &SphSwe,
    h0: f64,
    particles: &[Particle],
    terrain: &Terrain,
    step: f64,
) -> [[f64; 2]; CONTROLLED] {
    let [mut dx, mut dy, mut side] = [[0.0; CONTROLLED]; 3];
    let [mut x, mut y] = [[0.0; GROUND_BLOCK]; 2];
    for (k, particle) in particles.iter().enumerate() {
        (dx[k], dy[k]) = (step * particle.u, step * particle.v);
        let h = match parameters.smoothing {
            SmoothingForm::Density => particle.next_h,
            SmoothingForm::Rate => h_of_density(parameters, h0, parameters.density_kg_per_m3 * particle.depth),
        };
        side[k] = parameters.control_square * h;
        for (corner, [across, up]) in CORNERS.into_iter().enumerate() {
            x[corner * CONTROLLED + k] = particle.x + across * side[k] - 0.5 * dx[k];
            y[corner * CONTROLLED + k] = particle.y + up * side[k] - 0.5 * dy[k];
        }
    }
    let [_, slope_x, slope_y] = terrain.heights_and_slopes(&x, &y);
    let ways = dispatch!(Level::new(), simd => ways(simd, &dx, &dy, &slope_x, &slope_y));
    let mut controls = [[0.0; 2]; CONTROLLED];
    for (k, (control, particle)) in controls.iter_mut().zip(particles).enumerate() {
        let speed = particle.speed();
        if speed > 0.0 {
            let force = parameters.control_strength * 0.25 * side[k] * side[k] * particle.depth * ways[k];
            let slowing = (force / speed).min(1.0 / step);
            *control = [-slowing * particle.u, -slowing * particle.v];
        }
    }
    controls
}

/// |NP| summed over the corners of each particle, m: the way between the ground points under a corner now (N) and at the step
/// before (P). The ground rises by its slope halfway times the way, which is exact to third order.
#[inline(always)]
fn ways<S: Simd>(
    simd: S,
    dx: &[f64; CONTROLLED],
    dy: &[f64; CONTROLLED],
    slope_x: &[f64; GROUND_BLOCK],
    slope_y: &[f64; GROUND_BLOCK],
) -> [f64; CONTROLLED] {
    let mut ways = [0.0; CONTROLLED];
    for (group, ways) in ways.chunks_exact_mut(LANES).enumerate() {
        let load =
            |values: &[f64], row: usize| Lanes::from_slice(simd, &values[row * CONTROLLED + group * LANES..][..LANES]);
        let (dx, dy) = (load(dx, 0), load(dy, 0));
        let mut sum = Lanes::splat(simd, 0.0);
        for corner in 0..CORNERS.len() {
            let rise = load(slope_x, corner) * dx + load(slope_y, corner) * dy;
            sum += (dx * dx + dy * dy + rise * rise).sqrt();
        }
        sum.store_slice(ways);
    }
    ways
}

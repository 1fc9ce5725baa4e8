//! The published model, formula by formula: depths, smoothing lengths and accelerations of the particles.
//!
//! The weights of the smoothing kernel for density, pressure and viscosity, in two dimensions at
//! the particle's own smoothing length; a fixed time step; the terrain-difference velocity control force.
//!
//! Not printed in the paper and taken from where its table points (Mueller, Charypar & Gross 2003): the pressure
//! p = k (rho - rho0) with their symmetric pair force, and their viscosity.

use super::arrangement::{Arrangement, GHOST};
use super::density::{Depths, NumberDensities};
use super::edges::EdgeRule;
use super::obstacles::Obstacles;
use super::particle::Particle;
use super::surroundings::{GROUND_BLOCK, Surroundings};
use bytemuck::{Pod, Zeroable};
use corpuscle_scene::{SmoothingForm, SphSwe as Parameters};
use corpuscle_sph::kernel::{Kernel, SmoothingKernel};
use corpuscle_sph::{
    BLOCK, EachReach, LANES, Lanes, LanesExt, Level, Near, Simd, SimdBase, SimdFloat, dispatch, gather,
};
use corpuscle_terrain::Terrain;
use rayon::prelude::*;

/// What the force pass reads of a particle or ghost particle: one cache line, a row of numbers to gather.
#[derive(Debug, Clone, Copy, Default, Pod, Zeroable)]
#[repr(C, align(64))]
pub(super) struct Column {
    pub x: f64,
    pub y: f64,
    pub u: f64,
    pub v: f64,
    /// Area that it stands for, mass over density, m2.
    pub area: f64,
    pub density: f64,
    pressure: f64,
    pub h: f64,
}

/// The scheme with its working memory.
pub(crate) struct SphSwe {
    pub(super) parameters: Parameters,
    /// Initial smoothing length, m.
    pub(super) h0: f64,
    gravity: f64,
    pub(super) arrangement: Arrangement,
    pub(super) columns: Vec<Column>,
    /// Volumes at the places of the arrangement, m3; none where all particles have the same.
    volumes: Vec<f64>,
    /// Depths at the places of the arrangement, m; 1/m2, still to be taken times the volume, where all particles have the same.
    densities: Vec<f64>,
    accelerations: Vec<[f64; 2]>,
    of_groups: Vec<[f64; 2]>,
    spare: Vec<Particle>,
    /// Places of the particles near obstacles.
    near_walls: Vec<u32>,
    of_walls: Vec<([f64; 2], Option<usize>)>,
    on_obstacles: Vec<[f64; 2]>,
}

impl SphSwe {
    pub fn new(parameters: Parameters, h0: f64, gravity: f64) -> Self {
        Self {
            parameters,
            h0,
            gravity,
            arrangement: Arrangement::default(),
            columns: Vec::new(),
            volumes: Vec::new(),
            densities: Vec::new(),
            accelerations: Vec::new(),
            of_groups: Vec::new(),
            spare: Vec::new(),
            near_walls: Vec::new(),
            of_walls: Vec::new(),
            on_obstacles: Vec::new(),
        }
    }

    /// Adds the push of obstacles to that of the water.
    fn add_walls(&mut self, particles: &[Particle], obstacles: &Obstacles) {
        self.on_obstacles.clear();
        self.on_obstacles.resize(obstacles.names.len(), [0.0; 2]);
        if !obstacles.any() {
            return;
        }
        let Self { parameters, arrangement, near_walls, of_walls, accelerations, on_obstacles, .. } = self;
        let near = particles
            .iter()
            .zip(&arrangement.real)
            .filter(|(particle, _)| obstacles.may_reach([particle.x, particle.y]));
        near_walls.clear();
        near_walls.extend(near.map(|(_, &place)| place));
        let particle = |place: u32| &particles[arrangement.particle[place as usize] as usize];
        let push = |&place: &u32| push_of_walls(parameters, obstacles, particle(place));
        near_walls.par_iter().map(push).collect_into_vec(of_walls);
        for (&place, &(push, obstacle)) in near_walls.iter().zip(&*of_walls) {
            let Some(obstacle) = obstacle else { continue };
            let particle = particle(place);
            for axis in 0..2 {
                accelerations[place as usize][axis] += push[axis];
                if particle.outside.is_none() {
                    on_obstacles[obstacle][axis] -= particle.volume * push[axis];
                }
            }
        }
    }

    /// Gives every place the volume of its particle, where they are not all the same.
    fn fill_volumes(&mut self, particles: &[Particle]) {
        self.volumes.clear();
        let is_first = |particle: &Particle| particle.volume == particles[0].volume;
        if particles.par_iter().all(is_first) {
            return;
        }
        let Arrangement { particle, ghosts, .. } = &self.arrangement;
        let volume = |&k: &u32| if k == GHOST { 0.0 } else { particles[k as usize].volume };
        particle.par_iter().map(volume).collect_into_vec(&mut self.volumes);
        for &(place, shown) in ghosts {
            self.volumes[place as usize] = self.volumes[shown as usize];
        }
    }

    /// rho_i = sum_j m_j W(r_ij, h_i), the particle itself included; and, where it follows from the density, the smoothing
    /// length for the next step.
    fn find_densities(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) {
        self.fill_volumes(particles);
        let Arrangement { cells, lists, x, y, reach_squared, .. } = &mut self.arrangement;
        self.densities.resize(x.len(), 0.0);
        // Kernels at h_i: what a particle does not reach itself adds nothing.
        let (kernel, out, volumes) = (self.parameters.kernel, &mut self.densities, &self.volumes);
        let (places, reach): ([&[f64]; 2], _) = ([x, y], EachReach { squared: reach_squared, near: Near::Reached });
        if volumes.is_empty() {
            lists.search(cells, places, &reach, out, &NumberDensities { kernel, reach_squared });
        } else {
            lists.search(cells, places, &reach, out, &Depths { kernel, reach_squared, volumes });
        }
        let (this, rho0) = (&*self, self.parameters.density_kg_per_m3);
        let groups = particles.par_chunks_mut(GROUND_BLOCK).zip(this.arrangement.real.par_chunks(GROUND_BLOCK));
        groups.for_each(|(particles, places)| {
            surroundings.find_ground(particles);
            for (particle, &place) in particles.iter_mut().zip(places) {
                let sum = this.densities[place as usize];
                let water = if this.volumes.is_empty() { particle.volume * sum } else { sum };
                // Whose density was never found has no smoothing length by forms (8) and (9) yet.
                let is_new = step == 0.0 || particle.depth == 0.0;
                let density = rho0 * (water + covered(&this.parameters, &surroundings.obstacles, particle));
                particle.depth = density / rho0;
                particle.next_h = match this.parameters.smoothing {
                    SmoothingForm::Density => h_of_density(&this.parameters, this.h0, density),
                    SmoothingForm::Rate if is_new => 0.0,
                    SmoothingForm::Rate => particle.h,
                };
            }
        });
    }

    fn fill_columns(&mut self, particles: &[Particle], surroundings: &Surroundings) {
        let Parameters { density_kg_per_m3: rho0, gas_constant, clip_negative_pressure, .. } = self.parameters;
        self.columns.resize(self.arrangement.len(), Column::default());
        self.columns.par_iter_mut().zip(&self.arrangement.particle).for_each(|(column, &particle)| {
            if particle == GHOST {
                return;
            }
            let particle = &particles[particle as usize];
            let density = rho0 * particle.depth;
            let pressure = gas_constant * (density - rho0);
            *column = Column {
                x: particle.x,
                y: particle.y,
                u: particle.u,
                v: particle.v,
                area: particle.area(),
                density,
                pressure: if clip_negative_pressure { pressure.max(0.0) } else { pressure },
                h: particle.h,
            };
        });
        for &(place, source) in &self.arrangement.ghosts {
            let place = place as usize;
            let mut column = self.columns[source as usize];
            (column.x, column.y) = (self.arrangement.x[place], self.arrangement.y[place]);
            let ghost = self.arrangement.entries[place].ghost;
            if surroundings.edges.along_x(ghost) == Some(&EdgeRule::Wall) {
                column.u = -column.u;
            }
            if surroundings.edges.along_y(ghost) == Some(&EdgeRule::Wall) {
                column.v = -column.v;
            }
            self.columns[place] = column;
        }
    }

    /// Adds slope of the ground and control force to the pair forces; returns the sum of both over all the water.
    fn add_external_forces(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> [f64; 2] {
        let controlled = self.parameters.control_force && step > 0.0;
        let Self { parameters, h0, gravity, accelerations, of_groups, .. } = self;
        let groups = particles.par_chunks_mut(CONTROLLED).zip(self.arrangement.real.par_chunks(CONTROLLED));
        let of_group = |(particles, places): (&mut [Particle], &[u32])| {
            let controls = if controlled {
                control(parameters, *h0, particles, &surroundings.terrain, step)
            } else {
                [[0.0; 2]; CONTROLLED]
            };
            let mut sum = [0.0; 2];
            for ((particle, &place), control) in particles.iter_mut().zip(places).zip(controls) {
                let pairs = accelerations[place as usize];
                let slope = particle.ground_slope;
                let acceleration = [0, 1].map(|k| match particle.outside {
                    None => pairs[k] - *gravity * slope[k] + control[k],
                    Some(_) => 0.0,
                });
                [particle.ax, particle.ay] = acceleration;
                sum = [0, 1].map(|k| sum[k] + particle.volume * acceleration[k]);
            }
            sum
        };
        groups.map(of_group).collect_into_vec(of_groups);
        of_groups.iter().fold([0.0; 2], |all, group| [0, 1].map(|k| all[k] + group[k]))
    }
}

/// h = h0 (rho0 / rho)^(1/2), at most `largest_smoothing` times h0, m.
pub(crate) fn h_of_density(parameters: &Parameters, h0: f64, density: f64) -> f64 {
    (h0 * (parameters.density_kg_per_m3 / density).sqrt()).min(parameters.largest_smoothing * h0)
}

/// What boundary particles add to the density of a particle, over rho0: sum_k V_k W_ik (Akinci et al. 2012, equation 6).
fn covered(parameters: &Parameters, obstacles: &Obstacles, particle: &Particle) -> f64 {
    let kernel = Kernel::<2>::new(parameters.kernel, particle.h);
    let mut sum = 0.0;
    obstacles.each([particle.x, particle.y], particle.h, |site, r, _| sum += site.volume * kernel.value(r * r));
    sum
}

/// The push of boundary particles, m/s2, and the number of the nearest one's obstacle:
/// a = -sum_k rho0 V_k (p_i / rho_i^2) grad W_ik (Akinci et al. 2012, equation 9).
fn push_of_walls(parameters: &Parameters, obstacles: &Obstacles, particle: &Particle) -> ([f64; 2], Option<usize>) {
    let Parameters { density_kg_per_m3: rho0, gas_constant, clip_negative_pressure, .. } = *parameters;
    let density = rho0 * particle.depth;
    let pressure = gas_constant * (density - rho0);
    let pressure = if clip_negative_pressure { pressure.max(0.0) } else { pressure };
    let strength = rho0 * pressure / (density * density);
    let kernel = Kernel::<2>::new(parameters.kernel, particle.h);
    let (mut push, mut nearest, mut obstacle) = ([0.0; 2], f64::INFINITY, None);
    obstacles.each([particle.x, particle.y], particle.h, |site, r, way| {
        let slope = site.volume * kernel.slope(r) / r.max(1e-9 * particle.h);
        (0..2).for_each(|axis| push[axis] -= strength * slope * way[axis]);
        if r < nearest {
            (nearest, obstacle) = (r, Some(site.obstacle));
        }
    });
    (push, obstacle)
}

/// Particles whose control forces are computed together: each evaluates four positions of the ground.
const CONTROLLED: usize = GROUND_BLOCK / 4;

/// Corners of a square of side 1 round the origin.
const CORNERS: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];

/// The terrain-difference velocity control force on some particles: f = (h_D^2/4) (f_A + f_B + f_C + f_D) with
/// f = (rho2D/rho3D) NP at the corners of a square of side h_D = alpha h0 sqrt(rho0/rho).
///
/// Our reading, for the paper's units do not close: the size of NP is |NP| in three dimensions, it acts against the horizontal
/// motion, and it is an acceleration times `control_strength`. It stops the motion at most.
fn control(
    parameters: &Parameters,
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

/// Pressure and viscosity on the particles of one block: accelerations, m/s2.
#[inline(always)]
fn pair_forces<S: Simd>(
    simd: S,
    parameters: &Parameters,
    arrangement: &Arrangement,
    columns: &[Column],
    first: usize,
    out: &mut [[f64; 2]],
) {
    let rows: &[[f64; LANES]] = bytemuck::must_cast_slice(columns);
    for (k, out) in out.iter_mut().enumerate() {
        let i = first + k;
        let own = columns[i];
        // The kernel at h_i: its factors once, its shapes in each pair.
        let kernel = Kernel::<2>::new(parameters.kernel, own.h);
        let (of_slope, of_laplacian) = (0.5 * kernel.slope_factor(), parameters.viscosity * kernel.laplacian_factor());
        let [mut fx, mut fy] = [Lanes::splat(simd, 0.0); 2];
        for (index, r) in arrangement.lists.of(i).lanes(simd) {
            let [x, y, u, v, area, _, pressure, _] = gather(simd, rows, index.map(|index| index as usize));
            let (ex, ey) = (x - own.x, y - own.y);
            // f = -sum m_j (p_i + p_j)/(2 rho_j) grad W + mu sum m_j (v_j - v_i)/rho_j lap W
            let push = kernel.times_slope_shape(area * (pressure + own.pressure), r) * of_slope / r;
            let drag = area * kernel.laplacian_shape(r) * of_laplacian;
            fx += drag * (u - own.u) - push * ex;
            fy += drag * (v - own.v) - push * ey;
        }
        *out = [fx.sum() / own.density, fy.sum() / own.density];
    }
}

impl SphSwe {
    /// Sorts the particles into cells of that size, m.
    pub fn arrange(&mut self, particles: &mut Vec<Particle>, surroundings: &Surroundings, cell: f64) {
        self.arrangement.arrange(particles, |p| (p.x, p.y, p.h), &surroundings.edges, cell);
        self.arrangement.sort(particles, &mut self.spare);
    }

    /// Finds depth, next smoothing length and acceleration of the particles as arranged, `step` s after the last time. Gives the force of ground, edges and
    /// obstacles on all the water, over its density, m4/s2.
    pub fn evaluate(&mut self, particles: &mut [Particle], surroundings: &Surroundings, step: f64) -> [f64; 2] {
        self.find_densities(particles, surroundings, step);
        self.fill_columns(particles, surroundings);
        if self.parameters.smoothing == SmoothingForm::Rate {
            self.find_smoothing(particles, &surroundings.obstacles, step);
        }
        self.accelerations.resize(self.arrangement.len(), [0.0; 2]);
        self.accelerations.par_chunks_mut(BLOCK).enumerate().for_each(|(block, out)| {
            let (parameters, first) = (&self.parameters, block * BLOCK);
            dispatch!(Level::new(), simd => pair_forces(simd, parameters, &self.arrangement, &self.columns, first, out));
        });
        self.add_walls(particles, &surroundings.obstacles);
        self.add_external_forces(particles, surroundings, step)
    }

    /// The particles in their cells, as last arranged.
    pub fn arrangement(&self) -> &Arrangement {
        &self.arrangement
    }

    /// Force of the water on each obstacle at the last evaluation, over the density of water, m4/s2.
    pub fn on_obstacles(&self) -> &[[f64; 2]] {
        &self.on_obstacles
    }

    /// Switches the control force on or off.
    pub fn control(&mut self, on: bool) {
        self.parameters.control_force = on;
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let each = size_of::<Column>() + size_of::<f64>() + size_of::<[f64; 2]>();
        self.arrangement.bytes()
            + self.volumes.capacity() * size_of::<f64>()
            + self.arrangement.len() * each
            + self.spare.capacity() * size_of::<Particle>()
    }
}

//! Upload of solids: their particles, the air near them, and heat conduction.

use crate::contact::Contact;
use crate::dew::Dew;
use crate::gpu::origin::Origin;
use crate::gpu::shared::{self, Parameters};
use crate::humid_air::ZERO_CELSIUS;
use crate::settings::WallTreatment;
use crate::solids::Site;
use corpuscle_gpu::{Gpu, GpuError, storage, wgpu};
use corpuscle_scene::Table;

/// Parameters of the solids that are uploaded once.
#[derive(Debug)]
pub(crate) struct GpuSolids {
    /// First site of each cell of the air.
    pub start: wgpu::Buffer,
    /// Sites that air comes near: particles, ghost particles and ghost samples.
    pub sites: wgpu::Buffer,
    /// The particles themselves, in order, then the cells of the walls behind solids.
    pub own: wgpu::Buffer,
    /// Pairs between which heat flows.
    pub pairs: wgpu::Buffer,
    /// Particles and cells.
    pub count: usize,
    /// The solids, then the walls, by their ranges of particles or cells and of rows.
    pub bodies: Vec<shared::Body>,
}

impl GpuSolids {
    /// Times, s, and temperatures from the ambient air's, K, at which solids are held where they change come after `rows`.
    pub fn new(
        gpu: &Gpu,
        dew: &Dew,
        origin: Origin,
        parameters: &Parameters,
        rows: &mut Vec<[f64; 2]>,
    ) -> Result<Self, GpuError> {
        let particles = &dew.solids.particles;
        let mut pairs = Vec::new();
        let mut own = Vec::new();
        for node in 0..dew.solids.nodes() {
            let first = pairs.len() as u32;
            let of_it = dew.conduction.pairs(node);
            pairs.extend(of_it.map(|(other, conductance)| [other as u32, (conductance as f32).to_bits()]));
            let end = pairs.len() as u32;
            let of_cell =
                || shared::Site { capacity: dew.solids.heat_capacity(node) as f32, ..shared::Site::default() };
            let site = particles.get(node).map_or_else(of_cell, |particle| {
                gpu_site(dew, origin, &Site::itself(node as u32, particle.position), particle.volume)
            });
            own.push(shared::Site { first, end, ..site });
        }
        let mut sites = of_contact(dew, origin, &dew.contact);
        sites.extend(dew.ghosts.sites.iter().zip(&dew.ghosts.volumes).map(|(site, volume)| shared::Site {
            place: origin.relative(site.position),
            volume: (volume / dew.scale.volume) as f32,
            flags: shared::GHOST,
            ..shared::Site::default()
        }));
        let cell = |site: &shared::Site| cell_at(parameters, site.place);
        sites.sort_by_key(cell);
        let cells = parameters.cells.iter().product::<u32>();
        let first = |wanted: u32| sites.partition_point(|site| cell(site) < wanted) as u32;
        let start: Vec<u32> = (0..=cells).map(first).collect();
        let groups: Vec<usize> = (0..own.len()).map(|node| dew.solids.group(node)).collect();
        let before = |group: usize| groups.partition_point(|of| *of < group) as u32;
        let bodies = (0..dew.solids.groups())
            .map(|group| {
                let first_row = rows.len() as u32;
                rows.extend(changes(dew, group, origin.temperature));
                let (first, end, end_row) = (before(group), before(group + 1), rows.len() as u32);
                shared::Body { first, end, first_row, end_row, ..shared::Body::default() }
            })
            .collect();
        Ok(Self {
            start: filled(gpu, "first sites of cells", &start)?,
            sites: filled(gpu, "sites of solids", &sites)?,
            own: filled(gpu, "particles of solids", &own)?,
            pairs: filled(gpu, "conductances", &pairs)?,
            count: own.len(),
            bodies,
        })
    }
}

/// Times, s, and temperatures from `zero`, K, at which a body is held, where they change.
fn changes(dew: &Dew, body: usize, zero: f64) -> Vec<[f64; 2]> {
    let rows = dew.held_to.get(body).and_then(Option::as_ref).map_or(&[][..], Table::rows);
    let kelvin = |&[time, celsius]: &[f64; 2]| [time, celsius + ZERO_CELSIUS - zero];
    if rows.len() > 1 { rows.iter().map(kelvin).collect() } else { Vec::new() }
}

fn of_contact(dew: &Dew, origin: Origin, contact: &Contact) -> Vec<shared::Site> {
    let sites = contact.sites.iter().zip(&contact.volumes).zip(&contact.walls);
    let of_one = |((site, &volume), walls): ((&Site, &f64), &WallTreatment)| {
        let uploaded = gpu_site(dew, origin, site, volume);
        let keeps_out = match walls {
            WallTreatment::DensityCorrection => shared::JOINS_DENSITY,
            WallTreatment::VirtualForce => shared::REPELS,
            WallTreatment::Ghosts | WallTreatment::None => 0,
        };
        shared::Site { flags: uploaded.flags | keeps_out, ..uploaded }
    };
    sites.map(of_one).collect()
}

/// But for the way it keeps air out.
fn gpu_site(dew: &Dew, origin: Origin, site: &Site, volume: f64) -> shared::Site {
    let number = site.particle as usize;
    let particle = &dew.solids.particles[number];
    let (of_air, of_solid) = (dew.air.conductor(), dew.solids.material(number).conductor());
    let mean = dew.settings.mean;
    let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    shared::Site {
        place: origin.relative(site.position),
        volume: (volume / dew.scale.volume) as f32,
        to_air: mean.conductivity(of_air, of_solid) as f32,
        to_solid: mean.conductivity(of_solid, of_air) as f32,
        part: (of_solid.conductivity / (of_solid.conductivity + of_air.conductivity)) as f32,
        flags: flag(particle.normal.is_some(), shared::BOUNDARY)
            | flag(particle.near_surface, shared::NEAR_SURFACE)
            | flag(dew.solids.is_held(number), shared::HELD)
            | flag(site.beyond, shared::GHOST_PARTICLE_BEYOND),
        particle: site.particle,
        capacity: dew.solids.heat_capacity(number) as f32,
        ..shared::Site::default()
    }
}

/// The cell of a place, as `dew_neighbours.wgsl` has it.
fn cell_at(parameters: &Parameters, place: [f32; 3]) -> u32 {
    let Parameters { corner, per_cell, cells, .. } = parameters;
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let index = ((place[axis] - corner[axis]) * per_cell).max(0.0) as u32;
        index.min(cells[axis] - 1)
    });
    (z * cells[1] + y) * cells[0] + x
}

pub(crate) fn filled<T: bytemuck::NoUninit>(
    gpu: &Gpu,
    label: &'static str,
    values: &[T],
) -> Result<wgpu::Buffer, GpuError> {
    let buffer = storage::<T>(gpu, label, values.len())?;
    gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(values));
    Ok(buffer)
}

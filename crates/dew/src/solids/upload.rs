//! Upload of solids: their particles, the air near them, and heat conduction.

use crate::air::{Properties, Scale};
use crate::humid_air::ZERO_CELSIUS;
use crate::origin::Origin;
use crate::settings::{Mean, WallTreatment};
use crate::shared::{self, Parameters};
use crate::solids::contact::Contact;
use crate::solids::{Conduction, Site, Solids};
use corpuscle_gpu::{Gpu, GpuError, storage, wgpu};
use corpuscle_scene::Table;

/// What is uploaded of solids, and what it depends on.
pub(crate) struct SolidInputs<'a> {
    /// The solids.
    pub solids: &'a Solids,
    /// Conductances of the pairs of their particles.
    pub conduction: &'a Conduction,
    /// Contact of the air with their particles.
    pub contact: &'a Contact,
    /// And with ghost samples in them.
    pub ghosts: &'a Contact,
    /// Temperature over time, °C, of those whose temperature a scene prescribes.
    pub held_to: &'a [Option<Table>],
    /// The air.
    pub air: &'a Properties,
    /// Size of particles.
    pub scale: &'a Scale,
    /// How heat passes between air and solids.
    pub mean: Mean,
}

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
        inputs: &SolidInputs,
        origin: Origin,
        parameters: &Parameters,
        rows: &mut Vec<[f64; 2]>,
    ) -> Result<Self, GpuError> {
        let particles = &inputs.solids.particles;
        let mut pairs = Vec::new();
        let mut own = Vec::new();
        for node in 0..inputs.solids.nodes() {
            let first = pairs.len() as u32;
            let of_it = inputs.conduction.pairs(node);
            pairs.extend(of_it.map(|(other, conductance)| [other as u32, (conductance as f32).to_bits()]));
            let end = pairs.len() as u32;
            let of_cell =
                || shared::Site { capacity: inputs.solids.heat_capacity(node) as f32, ..shared::Site::default() };
            let site = particles.get(node).map_or_else(of_cell, |particle| {
                gpu_site(inputs, origin, &Site::itself(node as u32, particle.position), particle.volume)
            });
            own.push(shared::Site { first, end, ..site });
        }
        let mut sites = of_contact(inputs, origin, inputs.contact);
        sites.extend(inputs.ghosts.sites.iter().zip(&inputs.ghosts.volumes).map(|(site, volume)| shared::Site {
            position: origin.relative(site.position),
            volume: (volume / inputs.scale.volume) as f32,
            flags: shared::GHOST,
            ..shared::Site::default()
        }));
        let cell = |site: &shared::Site| cell_at(parameters, site.position);
        sites.sort_by_key(cell);
        let cells = parameters.cells.iter().product::<u32>();
        let first = |wanted: u32| sites.partition_point(|site| cell(site) < wanted) as u32;
        let start: Vec<u32> = (0..=cells).map(first).collect();
        let groups: Vec<usize> = (0..own.len()).map(|node| inputs.solids.group(node)).collect();
        let before = |group: usize| groups.partition_point(|of| *of < group) as u32;
        let bodies = (0..inputs.solids.groups())
            .map(|group| {
                let first_row = rows.len() as u32;
                rows.extend(changes(inputs, group, origin.temperature));
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
fn changes(inputs: &SolidInputs, body: usize, zero: f64) -> Vec<[f64; 2]> {
    let rows = inputs.held_to.get(body).and_then(Option::as_ref).map_or(&[][..], Table::rows);
    let kelvin = |&[time, celsius]: &[f64; 2]| [time, celsius + ZERO_CELSIUS - zero];
    if rows.len() > 1 { rows.iter().map(kelvin).collect() } else { Vec::new() }
}

fn of_contact(inputs: &SolidInputs, origin: Origin, contact: &Contact) -> Vec<shared::Site> {
    let sites = contact.sites.iter().zip(&contact.volumes).zip(&contact.walls);
    let of_one = |((site, &volume), walls): ((&Site, &f64), &WallTreatment)| {
        let uploaded = gpu_site(inputs, origin, site, volume);
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
fn gpu_site(inputs: &SolidInputs, origin: Origin, site: &Site, volume: f64) -> shared::Site {
    let number = site.particle as usize;
    let particle = &inputs.solids.particles[number];
    let (of_air, of_solid) = (inputs.air.conductor(), inputs.solids.material(number).conductor());
    let mean = inputs.mean;
    let flag = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    shared::Site {
        position: origin.relative(site.position),
        volume: (volume / inputs.scale.volume) as f32,
        to_air: mean.conductivity(of_air, of_solid) as f32,
        to_solid: mean.conductivity(of_solid, of_air) as f32,
        part: (of_solid.conductivity / (of_solid.conductivity + of_air.conductivity)) as f32,
        flags: flag(particle.normal.is_some(), shared::BOUNDARY)
            | flag(particle.near_surface, shared::NEAR_SURFACE)
            | flag(inputs.solids.is_held(number), shared::HELD)
            | flag(site.beyond, shared::GHOST_PARTICLE_BEYOND),
        particle: site.particle,
        capacity: inputs.solids.heat_capacity(number) as f32,
        ..shared::Site::default()
    }
}

/// The cell of a position, as `dew_neighbours.wgsl` has it.
fn cell_at(parameters: &Parameters, position: [f32; 3]) -> u32 {
    let Parameters { corner, per_cell, cells, .. } = parameters;
    let [x, y, z] = [0, 1, 2].map(|axis| {
        let index = ((position[axis] - corner[axis]) * per_cell).max(0.0) as u32;
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

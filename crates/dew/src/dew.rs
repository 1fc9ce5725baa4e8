//! The model: air that moves, carries heat and vapour, and leaves water on solids.

use crate::air::{Arrangement, Column, Particle, Properties, Rates, Role, Scale, Sums, sum_pairs};
use crate::contact::{Contact, Pair};
use crate::exchange::{Exchange, ToAir, Work, excess};
use crate::humid_air::{self, HumidAir};
use crate::layer::Layer;
use crate::room::Room;
use crate::settings::{Condensation, Humidity, Settings, WallTreatment};
use crate::solids::{Body, Conduction, Solids, Surface};
use crate::walls::{self, Push};
use crate::wetting::Wetting;
use corpuscle_model::{Account, ExactSum, ModelError};
use corpuscle_scene::Table;
use corpuscle_scene::dew::Output;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Humid air round cold solids.
pub struct Dew {
    pub(crate) settings: Settings,
    pub(crate) air: Properties,
    pub(crate) room: Room,
    pub(crate) scale: Scale,
    pub(crate) solids: Solids,
    conduction: Conduction,
    /// Sums of the solids' conductances, W/K.
    conductances: Vec<f64>,
    /// Heat of condensation, J/kg.
    pub(crate) latent_heat: f64,
    /// Density at which the pressure is that at rest, kg/m3: the air's, but for how evenly its particles can stand.
    rest_density: f64,
    pub(crate) state: State,
    arrangement: Arrangement,
    pub(crate) contact: Contact,
    pub(crate) ghosts: Contact,
    sums: Vec<Sums>,
    columns: Vec<Column>,
    rates: Vec<Rates>,
    work: Work,
    /// The time shown, s; up to one step after the state's.
    pub(crate) shown: f64,
    pub(crate) warnings: Vec<String>,
    /// Names of the bodies; none where they do not come from a scene.
    pub(crate) names: Vec<String>,
    /// The air before the bodies that say how they keep it out.
    pub(crate) layers: Vec<Option<Layer>>,
    /// Temperature over time, °C, of the bodies that are held at one told by a scene.
    pub(crate) held_to: Vec<Option<Table>>,
    /// What frames show.
    pub(crate) shows: Output,
    /// The surfaces of the bodies; none where one does not tell its own.
    pub(crate) surfaces: Vec<Surface>,
    /// The drops on the solids, where water there forms any.
    pub(crate) wetting: Option<Wetting>,
}

/// Everything that changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct State {
    pub time: f64,
    pub steps: u64,
    pub particle_steps: u64,
    /// Largest sound time step from here, s.
    pub time_step: f64,
    pub next_id: u64,
    pub air: Vec<Particle>,
    /// Temperature of each particle of the solids, K.
    pub temperatures: Vec<f64>,
    /// Water on each particle of the solids, kg.
    pub water_on: Vec<f64>,
    /// Vapour that has become fog less fog that has become vapour, kg.
    pub fogged: ExactSum,
    /// Heat that has come from each solid held at a temperature, J; negative where it took it.
    pub held_heat: Vec<ExactSum>,
    /// Heat that each solid takes from the air through its surface, W, in the last step.
    pub heat_flow: Vec<f64>,
    /// When it was last looked for air that no longer matters, s.
    pub utility_seen: f64,
    /// How far the air before each inlet has come since its last layer, m.
    pub inlet_phase: [[f64; 2]; 3],
    pub water: Account,
    pub energy: Account,
}

/// The largest of what limits the time step.
#[derive(Debug, Clone, Copy, Default)]
struct Extremes {
    speed_squared: f64,
    acceleration_squared: f64,
    weights: f64,
}

impl Extremes {
    fn of(particle: &Particle, rates: &Rates) -> Self {
        Self {
            speed_squared: particle.speed_squared(),
            acceleration_squared: particle.acceleration.iter().map(|along| along * along).sum(),
            weights: rates.weights,
        }
    }

    /// The larger of both; what is not a number stays none.
    fn or(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| if a > b || a.is_nan() { a } else { b };
        Self {
            speed_squared: larger(self.speed_squared, other.speed_squared),
            acceleration_squared: larger(self.acceleration_squared, other.acceleration_squared),
            weights: larger(self.weights, other.weights),
        }
    }
}

/// Zero of the energy's temperature, K.
const COLD: f64 = humid_air::ZERO_CELSIUS;

/// Acceleration limits the time step: this times the root of spacing over acceleration.
const ACCELERATION_LIMIT: f64 = 0.25;

/// Part of the longest step for which no diffusion overshoots its neighbours.
const DIFFUSION_LIMIT: f64 = 0.9;

/// A particle is not moved farther than this in a step to be evened out among its neighbours, in spacings.
const FARTHEST_SPREAD: f64 = 0.05;

/// Most steps by which the air is evened out at the start, how far each goes over the square of the spacing and the
/// gradient of crowding, and the gradient, over the spacing, that is even enough.
const SETTLING: u32 = 200;
const SETTLING_STEP: f64 = 0.2;
const EVEN: f64 = 1e-3;

/// What a [`Dew`] is made from.
pub struct Setup {
    /// How the model works.
    pub settings: Settings,
    /// The air.
    pub air: Properties,
    /// The box.
    pub room: Room,
    /// The solids.
    pub bodies: Vec<Body>,
    /// Seed of everything random.
    pub seed: u64,
}

impl Dew {
    /// Air in a room with solids, at rest on a lattice wherever there is no solid; `start` tells temperature, K, and vapour,
    /// part of the mass, at a place.
    ///
    /// # Errors
    /// Where ghost samples or air of low utility are asked for and a body does not tell its surface.
    pub fn new(setup: &Setup, start: impl Fn([f64; 3]) -> [f64; 2]) -> Result<Self, ModelError> {
        let Setup { settings, air, room, bodies, seed } = setup;
        if settings.low_utility.is_some() && bodies.iter().any(|body| body.surface.is_none()) {
            return Err(ModelError::Setup(
                "how far air is from solids must be known to tell which of it matters".into(),
            ));
        }
        let scale = Scale::new(settings.spacing);
        let solids = Solids::new(bodies, room, &scale, settings.threshold);
        let conduction = Conduction::new(&solids, room, &scale, settings.mean, settings.faster);
        let conductances = (0..solids.particles.len()).map(|i| conduction.sum(i)).collect();
        let sites = solids.sites(room, scale.h(), |particle| particle.near_surface);
        let volume = |site: &crate::solids::Site| solids.particles[site.particle as usize].volume;
        let walls: Vec<_> = bodies.iter().map(|body| body.walls.unwrap_or(settings.walls)).collect();
        let wall_of = |site: &crate::solids::Site| walls[solids.particles[site.particle as usize].body as usize];
        let contact = Contact::new(&sites, volume, wall_of, scale.h());
        let ghosts = crate::solids::ghost_contact(bodies, &walls, &solids, room, &scale, *seed)?;
        let temperatures =
            bodies.iter().flat_map(|body| std::iter::repeat_n(body.temperature, body.positions.len())).collect();
        let state = State {
            time: 0.0,
            steps: 0,
            particle_steps: 0,
            time_step: 0.0,
            next_id: 0,
            air: Vec::new(),
            temperatures,
            water_on: vec![0.0; solids.particles.len()],
            fogged: ExactSum::default(),
            held_heat: vec![ExactSum::default(); bodies.len()],
            heat_flow: vec![0.0; bodies.len()],
            utility_seen: 0.0,
            inlet_phase: [[0.0; 2]; 3],
            water: Account::default(),
            energy: Account::default(),
        };
        let mut dew = Self {
            latent_heat: humid_air::latent_heat(settings.ambient_temperature),
            settings: *settings,
            air: *air,
            room: *room,
            scale,
            solids,
            conduction,
            conductances,
            rest_density: air.density,
            state,
            arrangement: Arrangement::default(),
            contact,
            ghosts,
            sums: Vec::new(),
            columns: Vec::new(),
            rates: Vec::new(),
            work: Work::default(),
            shown: 0.0,
            warnings: Vec::new(),
            names: Vec::new(),
            layers: Vec::new(),
            held_to: Vec::new(),
            shows: Output::default(),
            surfaces: bodies.iter().map(|body| body.surface.clone()).collect::<Option<_>>().unwrap_or_default(),
            wetting: None,
        };
        dew.fill(bodies, start);
        dew.settle();
        dew.state.time_step = dew.next_step(&[], dew.extremes());
        dew.state.water.initial = dew.water();
        dew.state.energy.initial = dew.energy();
        Ok(dew)
    }

    /// Spreads the air evenly between the solids before anything happens.
    fn settle(&mut self) {
        let (room, spacing) = (self.room, self.scale.spacing);
        let completes =
            |walls: &WallTreatment| matches!(walls, WallTreatment::DensityCorrection | WallTreatment::Ghosts);
        let completed = self.contact.walls.is_empty() || self.contact.walls.iter().any(completes);
        let walls = self.contact.walls.clone();
        if completed {
            // Solids that leave the air's density incomplete would draw the air in that spreads between the others.
            let completing = |walls: &&mut WallTreatment| !completes(walls);
            self.contact
                .walls
                .iter_mut()
                .filter(completing)
                .for_each(|walls| *walls = WallTreatment::DensityCorrection);
        }
        for _ in 0..if completed { SETTLING } else { 0 } {
            self.evaluate(0.0);
            let uneven = |rates: &Rates| rates.spread.iter().fold(0.0_f64, |most, along| most.max(along.abs()));
            if self.rates.par_iter().map(uneven).reduce(|| 0.0, f64::max) * spacing < EVEN {
                break;
            }
            let particles = self.state.air.par_iter_mut().zip(&self.rates).with_min_len(1024);
            particles.filter(|(particle, _)| particle.role == Role::Inside).for_each(|(particle, rates)| {
                let farthest = FARTHEST_SPREAD * spacing;
                for axis in 0..3 {
                    let step = SETTLING_STEP * spacing * spacing * rates.spread[axis];
                    particle.position[axis] += step.clamp(-farthest, farthest);
                }
                room.keep(&mut particle.position, &mut particle.velocity);
            });
        }
        self.evaluate(0.0);
        // The pressure at rest is that of the air as it stands: neither too much nor too little of it is in the room.
        if completed {
            let sum: f64 = self.inside().map(|particle| particle.density).sum();
            self.rest_density = sum / (self.inside().count() as f64).max(1.0);
        }
        self.contact.walls = walls;
        self.evaluate(0.0);
        self.take_out_repelled();
    }

    /// Takes out air that a virtual force would throw off at the start: where it acts there is a vacuum.
    fn take_out_repelled(&mut self) {
        let Self { contact, state, scale, .. } = self;
        let is_repelled = |pair: &Pair| {
            contact.walls[pair.other as usize] == WallTreatment::VirtualForce && pair.r < walls::CALM * scale.spacing
        };
        let mut stays = vec![true; state.air.len()];
        for near in contact.near.iter().filter(|near| contact.of_air(near).iter().any(is_repelled)) {
            stays[near.particle as usize] = false;
        }
        let mut stays = stays.into_iter();
        state.air.retain(|_| stays.next() == Some(true));
        self.evaluate(0.0);
    }

    /// Mass of an air particle, kg.
    pub fn particle_mass(&self) -> f64 {
        self.air.density * self.scale.volume
    }

    /// One step.
    pub(crate) fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.drift(step);
        self.cross_faces(step);
        self.tend_utility();
        self.evaluate(0.5 * step);
        self.exchange(step);
        let extremes = self.kick(step);
        self.saturate(step);
        self.state.time += step;
        self.state.steps += 1;
        self.state.particle_steps += self.state.air.len() as u64;
        self.hold();
        self.tend_drops();
        let next = self.next_step(&self.work.stiff, extremes);
        self.state.time_step = next;
        self.refuse_what_is_faster_than_sound(extremes.speed_squared.sqrt())?;
        if next.is_finite() && next > 1e-9 * self.scale.spacing / self.air.sound_speed {
            return Ok(());
        }
        Err(ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: format!(
                "the time step fell from {step:.3e} s to {next:.3e} s. Try a higher speed of sound, or look in the last \
                 frame for the place where the air is fast or hot"
            ),
        })
    }

    /// Brings solids whose temperature is told over time to that of now.
    fn hold(&mut self) {
        let changing = |table: &&Table| table.rows().len() > 1;
        if !self.held_to.iter().flatten().any(|table| changing(&table)) {
            return;
        }
        let now: Vec<_> =
            self.held_to.iter().map(|table| table.as_ref().map(|table| COLD + table.at(self.state.time))).collect();
        for (particle, temperature) in self.solids.particles.iter().zip(&mut self.state.temperatures) {
            if let Some(held) = now[particle.body as usize] {
                *temperature = held;
            }
        }
    }

    /// From here on what condenses sets no heat free.
    pub(crate) fn without_latent_heat(&mut self) {
        self.latent_heat = 0.0;
        self.state.energy.initial = self.energy();
    }

    /// Air faster than the artificial sound is no flow any more. Where no drops are laid, air may be driven as hard as is asked for.
    fn refuse_what_is_faster_than_sound(&self, fastest: f64) -> Result<(), ModelError> {
        if fastest <= self.air.sound_speed || self.wetting.is_none() {
            return Ok(());
        }
        Err(ModelError::Breakdown {
            time: self.state.time,
            step: self.state.steps,
            what: format!(
                "air goes at {fastest:.3} m/s, faster than sound in this model ({:.3} m/s). Let air in more slowly, give it more room \
                 round the solids, or a smaller dew.spacing_m",
                self.air.sound_speed
            ),
        })
    }

    /// Half a kick with the old acceleration, then on by a whole step.
    fn drift(&mut self, step: f64) {
        let room = self.room;
        let farthest = FARTHEST_SPREAD * self.scale.spacing;
        self.state.air.par_iter_mut().with_min_len(1024).for_each(|particle| {
            if particle.role == Role::Inside {
                (0..3).for_each(|axis| particle.velocity[axis] += 0.5 * step * particle.acceleration[axis]);
            }
            // The transport velocity (Adami, Hu & Adams 2013, equations 6 and 8).
            let along = |axis: usize| {
                let spread = (step * step * particle.spreading[axis]).clamp(-farthest, farthest);
                step * particle.velocity[axis] + spread
            };
            let moved = [along(0), along(1), along(2)];
            (0..3).for_each(|axis| particle.position[axis] += moved[axis]);
            room.keep(&mut particle.position, &mut particle.velocity);
        });
    }

    /// Arranges the air and finds what acts on it; velocities are taken `ahead` s on.
    fn evaluate(&mut self, ahead: f64) {
        let Self {
            settings,
            air,
            room,
            scale,
            arrangement,
            contact,
            ghosts,
            sums,
            columns,
            rates,
            state,
            rest_density,
            ..
        } = self;
        arrangement.arrange(&mut state.air, room, scale.h());
        arrangement.search(scale, sums);
        contact.update(arrangement, scale);
        ghosts.update(arrangement, scale);
        walls::add_density(contact, arrangement, scale, settings.kappa, sums);
        walls::add_density(ghosts, arrangement, scale, 1.0, sums);
        walls::add_moment(contact, arrangement, scale, sums);
        fill_columns(arrangement, sums, columns, &mut state.air, air, *rest_density, ahead, room, scale.h());
        rates.resize(state.air.len(), Rates::default());
        let at_work = Properties {
            conductivity: settings.faster * air.conductivity,
            vapour_diffusivity: settings.faster * air.vapour_diffusivity,
            ..*air
        };
        let relative = settings.humidity == Humidity::Relative;
        let saturated = humid_air::saturation_pressure(settings.ambient_temperature);
        let parcel =
            |particle: &Particle| HumidAir::with_mass_fraction(particle.temperature, air.pressure, particle.vapour);
        if relative {
            for (column, entry) in columns.iter_mut().zip(&arrangement.entries) {
                column.vapour = parcel(&state.air[entry.particle as usize]).vapour_pressure / saturated;
            }
        }
        sum_pairs(arrangement, columns, scale, &at_work, rates);
        if relative {
            for (rates, particle) in rates.iter_mut().zip(&state.air) {
                rates.moistening *= saturated * parcel(particle).mass_fraction_slope();
            }
        }
        let push = Push { contact, ghosts, arrangement, columns, scale, air, kappa: settings.kappa };
        push.add(rates);
    }

    /// What air and solids exchange as they stand.
    fn at_surfaces(&self) -> Exchange<'_> {
        Exchange {
            contact: &self.contact,
            arrangement: &self.arrangement,
            columns: &self.columns,
            solids: &self.solids,
            temperatures: &self.state.temperatures,
            water: &self.state.water_on,
            scale: &self.scale,
            air: &self.air,
            settings: &self.settings,
            latent_heat: self.latent_heat,
        }
    }

    /// Heat and vapour between air and solids, and through solids, in a step.
    fn exchange(&mut self, step: f64) {
        let mut work = std::mem::take(&mut self.work);
        let Work { to_solids, to_air, share_of, heat, stiff, .. } = &mut work;
        let exchange = self.at_surfaces();
        exchange.to_solids(step, to_solids);
        let particles = self.solids.particles.len();
        share_of.clear();
        share_of.resize(particles, 1.0);
        let conducted = |i| self.conduction.heat(i, &self.state.temperatures);
        (0..particles).into_par_iter().with_min_len(1024).map(conducted).collect_into_vec(heat);
        stiff.clear();
        stiff.resize(self.contact.near.len(), 0.0);
        stiff.extend_from_slice(&self.conductances);
        let (of_air, of_solids) = stiff.split_at_mut(self.contact.near.len());
        let real = self.contact.sites.iter().zip(&*to_solids).filter(|(site, _)| !site.image);
        for (site, given) in real.clone() {
            let particle = site.particle as usize;
            share_of[particle] = given.share;
            heat[particle] += given.heat;
            of_solids[particle] += given.conductance;
        }
        exchange.to_air(share_of, to_air);
        self.state.heat_flow.fill(0.0);
        for (site, given) in real {
            self.state.heat_flow[self.solids.particles[site.particle as usize].body as usize] += given.heat;
            // What rounding leaves of the last of the water is nothing.
            let water = &mut self.state.water_on[site.particle as usize];
            *water = (*water + step * given.water).max(0.0);
        }
        for (i, &heat) in heat.iter().enumerate() {
            of_solids[i] /= self.solids.heat_capacity(i);
            if self.solids.is_held(i) {
                self.state.held_heat[self.solids.particles[i].body as usize].add(-step * heat);
                self.state.energy.book(-step * heat);
                of_solids[i] = 0.0;
            } else {
                self.state.temperatures[i] += step * heat / self.solids.heat_capacity(i);
            }
        }
        self.book_open_faces(step, to_air);
        for ((near, given), stiff) in self.contact.near.iter().zip(&*to_air).zip(of_air) {
            let rates = &mut self.rates[near.particle as usize];
            rates.warming += given.warming;
            rates.moistening += given.moistening;
            *stiff = given.stiffness;
        }
        self.work = work;
    }

    /// Books what diffuses across open faces. Between particles in the room all cancels, so what they gain together has come
    /// from beyond; and what solids give to air beyond has left.
    fn book_open_faces(&mut self, step: f64, to_air: &[ToAir]) {
        let State { air, water, energy, .. } = &mut self.state;
        if air.iter().all(|particle| particle.role == Role::Inside) {
            return;
        }
        let mass = self.air.density * self.scale.volume;
        let energy_of = |warming: f64, moistening: f64| {
            mass * step * (self.air.heat_capacity * warming + self.latent_heat * moistening)
        };
        let inside = || air.iter().zip(&self.rates).filter(|(particle, _)| particle.role == Role::Inside);
        let gained: ExactSum = inside().map(|(_, rates)| mass * step * rates.moistening).collect();
        water.book(gained.value());
        let gained: ExactSum = inside().map(|(_, rates)| energy_of(rates.warming, rates.moistening)).collect();
        energy.book(gained.value());
        for (near, given) in self.contact.near.iter().zip(to_air) {
            if air[near.particle as usize].role != Role::Inside {
                water.book(-mass * step * given.moistening);
                energy.book(-energy_of(given.warming, given.moistening));
            }
        }
    }

    /// The second half of the kick; heat and vapour of the whole step.
    fn kick(&mut self, step: f64) -> Extremes {
        let Self { settings, state, rates, air, .. } = self;
        let spreading = air.spreading * air.sound_speed * air.sound_speed;
        let kicked = state.air.par_iter_mut().zip(rates).with_min_len(1024).map(|(particle, rates)| {
            if particle.role != Role::Inside {
                return Extremes::of(particle, rates);
            }
            // Boussinesq: air lighter than the ambient air by its temperature and vapour rises.
            let lightness = virtual_temperature(particle.temperature, particle.vapour)
                / virtual_temperature(settings.ambient_temperature, settings.ambient_vapour)
                - 1.0;
            for axis in 0..3 {
                let external = settings.body_acceleration[axis] - lightness * settings.gravity[axis];
                particle.acceleration[axis] = rates.acceleration[axis] + external;
                particle.velocity[axis] += 0.5 * step * particle.acceleration[axis];
            }
            particle.spreading = rates.spread.map(|along| spreading * along);
            particle.temperature += step * rates.warming;
            particle.vapour += step * rates.moistening;
            Extremes::of(particle, rates)
        });
        kicked.reduce(Extremes::default, Extremes::or)
    }

    fn extremes(&self) -> Extremes {
        let air = self.state.air.par_iter().zip(&self.rates).with_min_len(4096);
        air.map(|(particle, rates)| Extremes::of(particle, rates)).reduce(Extremes::default, Extremes::or)
    }

    /// What is beyond saturation condenses: at a surface onto it where that is asked for, else as fog, which evaporates
    /// again in drier air.
    fn saturate(&mut self, step: f64) {
        if !self.settings.fog && self.settings.condensation != Condensation::Parcel {
            return;
        }
        let mut excesses = std::mem::take(&mut self.work.excesses);
        let Self { air, state, latent_heat, .. } = &*self;
        let find = |particle: &Particle| {
            let near_saturation = particle.role == Role::Inside
                && (particle.fog > 0.0 || particle.vapour > crate::exchange::saturation(particle.temperature, air));
            if near_saturation { excess(particle, air, *latent_heat).max(-particle.fog) } else { 0.0 }
        };
        state.air.par_iter().with_min_len(1024).map(find).collect_into_vec(&mut excesses);
        self.deposit(&mut excesses, step);
        if self.settings.fog {
            self.turn_to_fog(&excesses);
        }
        self.work.excesses = excesses;
    }

    /// What parcels have too much becomes fog, or fog becomes what they lack.
    fn turn_to_fog(&mut self, excesses: &[f64]) {
        let mass = self.particle_mass();
        let warming = self.latent_heat / self.air.heat_capacity;
        for (particle, &excess) in self.state.air.iter_mut().zip(excesses).filter(|(_, excess)| **excess != 0.0) {
            particle.vapour -= excess;
            particle.fog += excess;
            particle.temperature += warming * excess;
            self.state.fogged.add(mass * excess);
        }
    }

    /// What parcels at a surface have too much goes onto it, with its heat. Takes it out of `excesses`.
    fn deposit(&mut self, excesses: &mut [f64], step: f64) {
        let mass = self.particle_mass();
        let exchange = self.at_surfaces();
        let near = self.contact.near.iter().filter(|near| excesses[near.particle as usize] > 0.0);
        let deposits: Vec<_> =
            near.map(|near| (near.particle as usize, exchange.shares(near))).filter(|(_, to)| !to.is_empty()).collect();
        for (particle, shares) in deposits {
            let air = &mut self.state.air[particle];
            let water = mass * std::mem::replace(&mut excesses[particle], 0.0);
            air.vapour -= water / mass;
            for (site, share) in shares {
                let site = site as usize;
                let heat = self.latent_heat * water * share;
                self.state.water_on[site] += water * share;
                // The heat is set free at the surface, from where the better conductor takes the most of it.
                let conductivity = self.solids.material(site).conductivity;
                let to_solid = conductivity / (conductivity + self.air.conductivity);
                air.temperature += (1.0 - to_solid) * heat / (mass * self.air.heat_capacity);
                self.state.heat_flow[self.solids.particles[site].body as usize] += to_solid * heat / step;
                if self.solids.is_held(site) {
                    self.state.held_heat[self.solids.particles[site].body as usize].add(-to_solid * heat);
                    self.state.energy.book(-to_solid * heat);
                } else {
                    self.state.temperatures[site] += to_solid * heat / self.solids.heat_capacity(site);
                }
            }
        }
    }

    /// The largest sound time step: sound must not cross a smoothing length, nor diffusion overshoot.
    fn next_step(&self, stiff: &[f64], extremes: Extremes) -> f64 {
        let Properties { sound_speed, viscosity, vapour_diffusivity, .. } = self.air;
        let diffusivity = viscosity.max(self.settings.faster * vapour_diffusivity.max(self.air.heat_diffusivity()));
        let [speed, acceleration] = [extremes.speed_squared, extremes.acceleration_squared].map(f64::sqrt);
        let stiffest = stiff.iter().copied().fold(diffusivity * extremes.weights, f64::max);
        let by_sound = self.settings.cfl * self.scale.h() / (sound_speed + speed);
        let by_force = ACCELERATION_LIMIT * (self.scale.spacing / acceleration.max(1e-30)).sqrt();
        let by_diffusion = DIFFUSION_LIMIT / stiffest.max(1e-30);
        // What is not a number must not be lost in a minimum.
        if speed.is_finite() && acceleration.is_finite() && stiffest.is_finite() {
            by_sound.min(by_force).min(by_diffusion)
        } else {
            f64::NAN
        }
    }

    /// The air in the room.
    pub(crate) fn inside(&self) -> impl Iterator<Item = &Particle> {
        self.state.air.iter().filter(|particle| particle.role == Role::Inside)
    }

    /// Water in the air as vapour and fog and on the solids, kg.
    pub(crate) fn water(&self) -> f64 {
        let in_air = self.inside().map(|particle| self.particle_mass() * (particle.vapour + particle.fog));
        let on_solids = self.water_on_all();
        in_air.chain([on_solids]).collect::<ExactSum>().value()
    }

    /// Water on the solids, kg.
    pub(crate) fn water_on_all(&self) -> f64 {
        let water = &self.state.water_on;
        let sum = || water.iter().copied().collect::<ExactSum>().value();
        self.wetting.as_ref().map_or_else(sum, |wetting| wetting.water(water))
    }

    /// Energy of a parcel of air, J: its heat above 0 °C, and the heat that its vapour gives off when it condenses.
    pub(crate) fn energy_of(&self, particle: &Particle) -> f64 {
        let heat = self.air.heat_capacity * (particle.temperature - COLD);
        self.particle_mass() * (heat + self.latent_heat * particle.vapour)
    }

    /// Energy of the air and of the solids that are free to warm, J.
    pub(crate) fn energy(&self) -> f64 {
        let free = (0..self.solids.particles.len()).filter(|&i| !self.solids.is_held(i));
        let solids = free.map(|i| self.solids.heat_capacity(i) * (self.state.temperatures[i] - COLD));
        self.inside().map(|particle| self.energy_of(particle)).chain(solids).collect::<ExactSum>().value()
    }

    /// Gives the air in the room velocities, m/s, by place.
    pub fn stir(&mut self, velocity: impl Fn([f64; 3]) -> [f64; 3]) {
        let slowest = self.slowest();
        for particle in &mut self.state.air {
            let velocity = velocity(particle.position);
            match particle.role {
                Role::Inside => particle.velocity = velocity,
                Role::Leaving(axis, side) => {
                    let (axis, side) = (usize::from(axis), usize::from(side));
                    particle.leave(axis, side, velocity[axis], slowest);
                }
                Role::Coming(..) | Role::Idle => {}
            }
        }
        self.evaluate(0.0);
        self.state.time_step = self.next_step(&[], self.extremes());
    }

    /// Lays water on the boundary particles of a body, in kg/m2, as there from the start.
    pub fn wet(&mut self, body: usize, amount: f64) {
        for (particle, water) in self.solids.particles.iter().zip(&mut self.state.water_on) {
            if particle.body as usize == body && particle.normal.is_some() {
                *water += amount * particle.area;
            }
        }
        self.state.water.initial = self.water();
    }

    /// Heat that has come from a body held at a temperature, J; negative where it took it.
    pub fn heat_from(&self, body: usize) -> f64 {
        self.state.held_heat[body].value()
    }

    /// Water on a body, kg.
    pub fn water_on_body(&self, body: usize) -> f64 {
        let on = self.solids.particles.iter().zip(&self.state.water_on);
        on.filter(|(particle, _)| particle.body as usize == body).map(|(_, water)| water).sum()
    }

    /// The air, as it stands at the end of the last step; parcels before inlets and beyond outlets among it.
    pub fn air(&self) -> &[Particle] {
        &self.state.air
    }

    /// The solids.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }

    /// Temperature of each particle of the solids, K.
    pub fn temperatures(&self) -> &[f64] {
        &self.state.temperatures
    }

    /// Water on each particle of the solids, kg.
    pub fn water_on_solids(&self) -> &[f64] {
        &self.state.water_on
    }

    /// Largest sound time step from here, s.
    pub fn time_step(&self) -> f64 {
        self.state.time_step
    }

    /// Bytes held for the particles and the work on them.
    pub fn bytes(&self) -> usize {
        let air = self.state.air.capacity() * size_of::<Particle>();
        let work = self.columns.capacity() * size_of::<Column>()
            + self.rates.capacity() * size_of::<Rates>()
            + self.sums.capacity() * size_of::<Sums>();
        air + work + self.arrangement.bytes() + self.contact.bytes() + self.ghosts.bytes() + self.conduction.bytes()
    }

    pub(crate) fn scale(&self) -> &Scale {
        &self.scale
    }
}

/// T (1 + 0.608 Y), K: temperature at which dry air is as light (Stull 1988, equation 1.5.1).
fn virtual_temperature(temperature: f64, vapour: f64) -> f64 {
    temperature * (1.0 + 0.608 * vapour)
}

/// Fills the columns of particles, with their densities, and of their images.
fn fill_columns(
    arrangement: &Arrangement,
    sums: &[Sums],
    columns: &mut Vec<Column>,
    particles: &mut [Particle],
    air: &Properties,
    rest_density: f64,
    ahead: f64,
    room: &Room,
    reach: f64,
) {
    particles.par_iter_mut().zip(&arrangement.place_of).with_min_len(1024).for_each(|(particle, &place)| {
        particle.density = air.density * sums[place as usize].filling;
        if matches!(particle.role, Role::Leaving(..) | Role::Idle) {
            // Beyond an outlet, and where it no longer matters, the air is as it is at rest.
            particle.density = rest_density;
        } else if room.is_before_outlet(particle.position, reach) {
            // Where air would flow back in there is none beyond: that must not suck.
            particle.density = particle.density.max(rest_density);
        }
    });
    let particles = &*particles;
    let column = |(place, entry): (usize, &crate::air::Entry)| {
        let particle = &particles[entry.particle as usize];
        let place_of_particle = arrangement.place_of[entry.particle as usize] as usize;
        let mut velocity = particle.velocity;
        for axis in 0..3 {
            if particle.role == Role::Inside {
                velocity[axis] += ahead * particle.acceleration[axis];
            }
            if entry.mirrored[axis] {
                velocity[axis] = -velocity[axis];
            }
        }
        Column {
            position: arrangement.at(place),
            velocity,
            pressure: air.sound_speed * air.sound_speed * (particle.density - rest_density)
                / (particle.density * particle.density),
            // A particle with few neighbours diffuses no faster than one with half of them.
            evenness: 1.0 / sums[place_of_particle].moment.max(0.5),
            temperature: particle.temperature,
            vapour: particle.vapour,
            unused: [0.0; 6],
        }
    };
    arrangement.entries.par_iter().enumerate().with_min_len(1024).map(column).collect_into_vec(columns);
}

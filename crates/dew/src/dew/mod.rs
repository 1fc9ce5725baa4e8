//! The model: air that moves, carries heat and vapour, and leaves water on solids.

mod accelerated;
mod drops;
mod gauges;
mod inventory;
mod live_change;
mod motion;
mod not_finite;
#[cfg(feature = "gpu")]
mod on_gpu;
mod processes;
mod scatter;
mod settle;
mod source_change;
mod transfer;

pub use live_change::LiveChange;
pub use scatter::Scatter;
pub use source_change::SourceChange;

use crate::air::{Arrangement, Column, Particle, Properties, Rates, Role, Scale, Sums};
use crate::domain::Domain;
use crate::exchange::Work;
use crate::faces::{OpenSide, slowest};
use crate::fan::Fan;
use crate::humid_air;
use crate::layer::Layer;
use crate::normalisation::Tensor;
use crate::room::{Face, InflowsOverTime, Room};
use crate::settings::Settings;
use crate::solids::contact::Contact;
use crate::solids::sources::HeatSources;
use crate::solids::{Body, Conduction, Solids, Surface, bodies, wall};
use crate::state::{Overrides, State};
use crate::walls;
use crate::wetting::Wetting;
use corpuscle_model::{Account, CompensatedSum, ExactSum, ModelError};
use corpuscle_processes::Processes;
use corpuscle_scene::Table;
use corpuscle_scene::dew::Output;

/// Humid air round cold solids.
pub struct Dew {
    pub(crate) settings: Settings,
    pub(crate) air: Properties,
    pub(crate) room: Room,
    pub(crate) scale: Scale,
    pub(crate) solids: Solids,
    pub(crate) conduction: Conduction,
    /// Heaters, the outside, radiation.
    pub(crate) sources: HeatSources,
    /// Sums of the solids' conductances, W/K.
    conductances: Vec<f64>,
    /// Heat of condensation, J/kg.
    pub(crate) latent_heat: f64,
    /// Density at which the pressure is that at rest, kg/m3: the air's, but for how evenly its particles can stand.
    pub(crate) rest_density: f64,
    pub(crate) state: State,
    /// The processes that share the air.
    pub(crate) processes: Processes,
    /// The part of this process, where there are several. The air of `state` is that of this part.
    pub(crate) domain: Option<Domain>,
    arrangement: Arrangement,
    pub(crate) contact: Contact,
    pub(crate) ghosts: Contact,
    sums: Vec<Sums>,
    tensors: Vec<Tensor>,
    columns: Vec<Column>,
    rates: Vec<Rates>,
    work: Work,
    push: walls::Work,
    /// The time shown, s; up to one step after the state's.
    pub(crate) shown: f64,
    pub(crate) warnings: Vec<String>,
    /// Names of the bodies; none where they do not come from a scene.
    pub(crate) names: Vec<String>,
    /// The air before the bodies that say how they keep it out.
    pub(crate) layers: Vec<Option<Layer>>,
    /// Temperature over time, °C, of the bodies whose temperature a scene prescribes.
    pub(crate) held_to: Vec<Option<Table>>,
    /// What frames show.
    pub(crate) shows: Output,
    /// The surfaces of the bodies; none where one has none.
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) fans: Vec<Fan>,
    /// The air that comes in where it changes with time.
    pub(crate) inflows: InflowsOverTime,
    /// The sides of the room by which air comes and goes.
    pub(crate) open_sides: Vec<OpenSide>,
    /// The drops on the solids, where water there forms any.
    pub(crate) wetting: Option<Wetting>,
    /// Part of the evaporation of a wet surface that the water on each particle of the solids lets go: 1 where it is no drops.
    pub(crate) evaporation: Vec<f64>,
    /// Whether air rises and sinks by its warmth and vapour.
    pub(crate) buoyant: bool,
    /// The values before the first live change; none before it.
    as_set_up: Option<Overrides>,
    /// The GPU, where it takes the steps.
    #[cfg(feature = "gpu")]
    pub(crate) gpu_solver: Option<crate::gpu::GpuSolver>,
}

/// Zero of the energy's temperature, K.
const COLD: f64 = humid_air::ZERO_CELSIUS;

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
    /// The fans.
    pub fans: Vec<Fan>,
    /// Seed of everything random.
    pub seed: u64,
}

impl Dew {
    /// Air in a room with solids, at rest on a lattice wherever there is no solid; `start` gives temperature, K, and vapour,
    /// part of the mass, at a position.
    ///
    /// # Errors
    /// Where ghost samples or air of low utility are required and a body has no surface.
    pub fn new(setup: &Setup, start: impl Fn([f64; 3]) -> [f64; 2]) -> Result<Self, ModelError> {
        Self::new_on(&Processes::alone(), setup, start)
    }

    /// As [`Dew::new`], with the air distributed over processes, which all call this, and all that sets the model up. Then all call [`Dew::lead`], and those that
    /// are not the first [follow](Processes::follow) it.
    ///
    /// # Errors
    /// As [`Dew::new`].
    pub fn new_on(
        processes: &Processes,
        setup: &Setup,
        start: impl Fn([f64; 3]) -> [f64; 2],
    ) -> Result<Self, ModelError> {
        let Setup { settings, air, room, bodies, fans, seed } = setup;
        if settings.low_utility.is_some() && bodies.iter().any(|body| body.surface.is_none()) {
            return Err(ModelError::Setup(
                "how far air is from solids must be known to tell which of it matters".into(),
            ));
        }
        let scale = Scale::new(settings.spacing, settings.kernel);
        let solids = Solids::new(bodies, room, &scale, settings.threshold);
        let conduction = Conduction::new(&solids, room, &scale, settings.mean);
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
            held_heat: vec![CompensatedSum::default(); bodies.len()],
            supplied: vec![Default::default(); bodies.len()],
            heat_flow: vec![0.0; bodies.len()],
            utility_seen: 0.0,
            inlet_phase: [[0.0; 2]; 3],
            water: Account::default(),
            energy: Account::default(),
            overrides: None,
            drift: [0.0; 2],
            density_excess_beyond: [[0.0; 2]; 3],
            running_mean_before: [[0.0; 2]; 3],
        };
        let mut dew = Self {
            latent_heat: humid_air::latent_heat(settings.ambient_temperature),
            settings: *settings,
            air: *air,
            room: *room,
            processes: processes.clone(),
            domain: Domain::new(processes, room, scale.h()),
            scale,
            evaporation: vec![1.0; solids.particles.len()],
            solids,
            conduction,
            sources: HeatSources::default(),
            conductances,
            rest_density: air.density,
            state,
            arrangement: Arrangement::default(),
            contact,
            ghosts,
            sums: Vec::new(),
            tensors: Vec::new(),
            columns: Vec::new(),
            rates: Vec::new(),
            work: Work::default(),
            push: walls::Work::default(),
            shown: 0.0,
            warnings: Vec::new(),
            names: Vec::new(),
            layers: Vec::new(),
            held_to: Vec::new(),
            shows: Output::default(),
            surfaces: bodies.iter().map(|body| body.surface.clone()).collect::<Option<_>>().unwrap_or_default(),
            open_sides: Vec::new(),
            fans: fans.clone(),
            inflows: Default::default(),
            wetting: None,
            buoyant: true,
            as_set_up: None,
            #[cfg(feature = "gpu")]
            gpu_solver: None,
        };
        dew.fill(bodies, start);
        dew.balance();
        dew.settle();
        dew.state.time_step = dew.next_step(&[], dew.extremes());
        dew.state.water.initial = dew.water();
        dew.state.energy.initial = dew.energy();
        Ok(dew)
    }

    /// Puts walls behind the solids that have them.
    pub(crate) fn add_walls(&mut self, bodies: &[bodies::Body]) {
        let step = self.settings.time_factor * self.step_by_sound(0.0);
        let temperatures = &mut self.state.temperatures;
        let links = wall::add(bodies, &mut self.solids, temperatures, &self.room, self.scale.spacing, step);
        if self.solids.walls.is_empty() {
            return;
        }
        self.conduction.connect(self.solids.nodes(), &links);
        self.rebuild_heat_network();
    }

    /// Makes room for all that conducts heat, and counts its energy from here on, after something has been added to it.
    fn rebuild_heat_network(&mut self) {
        let groups = self.solids.groups();
        self.conductances = (0..self.solids.nodes()).map(|i| self.conduction.sum(i)).collect();
        self.state.held_heat.resize(groups, CompensatedSum::default());
        self.state.supplied.resize(groups, Default::default());
        self.state.heat_flow.resize(groups, 0.0);
        self.state.energy.initial = self.energy();
    }

    /// Mass of an air particle, kg.
    pub fn particle_mass(&self) -> f64 {
        self.air.particle_mass(&self.scale)
    }

    /// One step.
    pub(crate) fn step(&mut self) -> Result<(), ModelError> {
        let step = self.state.time_step;
        self.drift(step);
        self.cross_faces(step);
        self.inventory().update_utility();
        self.balance_if_due();
        self.evaluate(0.5 * step);
        let drift = std::mem::take(&mut self.state.drift);
        self.exchange(step);
        let extremes = self.kick(step, drift);
        self.saturate(step);
        self.state.time += step;
        self.state.steps += 1;
        self.state.particle_steps += self.air_count() as u64;
        self.hold();
        let next = self.next_step(&self.work.stiff, extremes);
        self.state.time_step = next;
        self.check_step(extremes.speed_squared.sqrt(), step, next)?;
        self.update_drops(self.air_count());
        self.check_drops()
    }

    /// The shortest step with which the run goes on, s.
    pub(crate) fn shortest_step(&self) -> f64 {
        1e-9 * self.scale.spacing / self.air.sound_speed
    }

    /// Refuses to go on where the air is too fast or the next step, s, too short.
    fn check_step(&self, fastest: f64, step: f64, next: f64) -> Result<(), ModelError> {
        self.refuse_what_is_faster_than_sound(fastest)?;
        if next.is_finite() && next > self.shortest_step() {
            return Ok(());
        }
        Err(self.too_short(step, next))
    }

    /// Sets the temperature of solids for which it is prescribed over time.
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

    /// Refuses air above Mach 1 of the artificial speed of sound, where the weakly compressible assumption fails. Where no drops are laid, any drive is accepted.
    fn refuse_what_is_faster_than_sound(&self, fastest: f64) -> Result<(), ModelError> {
        // A speed that is not a number is refused for that, with the time step.
        if fastest.is_nan() || fastest <= self.air.sound_speed || self.wetting.is_none() {
            return Ok(());
        }
        let has_outlet = self.room.faces.as_flattened().contains(&Face::Outlet);
        let where_it_leaves = if has_outlet {
            ". Where cold air sinks or warm air rises through a side of \"outflow\", make that \"open\": no air comes back by the first"
        } else {
            ""
        };
        let position = self.fastest_position().map_or(String::new(), |position| format!(" {position}"));
        Err(self.broken(format!(
            "air goes at {fastest:.3} m/s{position}, faster than sound in this model ({:.3} m/s). Let air in more slowly, give it more room \
             round the solids, or a smaller dew.spacing_m{where_it_leaves}",
            self.air.sound_speed
        )))
    }

    /// The air in the room.
    pub(crate) fn inside(&self) -> impl Iterator<Item = &Particle> + Clone {
        self.state.inside()
    }

    /// Water in the air as vapour and fog and on the solids, kg.
    pub(crate) fn water(&self) -> f64 {
        let in_air = self.inside().map(|particle| self.particle_mass() * (particle.vapour + particle.fog));
        self.total_with(in_air.collect(), [self.water_on_all(), self.residual()[0]].into_iter())
    }

    /// Water on the solids, kg.
    pub(crate) fn water_on_all(&self) -> f64 {
        let water = &self.state.water_on;
        let sum = || water.iter().copied().collect::<CompensatedSum>().value();
        self.wetting.as_ref().map_or_else(sum, |wetting| wetting.water(water))
    }

    /// Energy of a particle of air, J: its heat above 0 °C, and the heat that its vapour gives off when it condenses.
    pub(crate) fn energy_of(&self, particle: &Particle) -> f64 {
        self.particle_mass() * self.air.energy_of(particle, self.latent_heat)
    }

    /// Energy of the air and of the solids that are free to warm, J.
    pub(crate) fn energy(&self) -> f64 {
        let free = (0..self.solids.nodes()).filter(|&i| !self.solids.is_held(i));
        let solids = free.map(|i| self.solids.heat_capacity(i) * (self.state.temperatures[i] - COLD));
        let of_air = self.inside().map(|particle| self.energy_of(particle)).collect();
        self.total_with(of_air, solids.chain([self.residual()[1]]))
    }

    /// A sum over the air of all processes, and what all processes have alike.
    fn total_with(&self, mut of_air: ExactSum, others: impl Iterator<Item = f64>) -> f64 {
        self.processes.total(&mut [], &mut [&mut of_air]);
        others.for_each(|other| of_air.add(other));
        of_air.value()
    }

    /// Gives the air in the room velocities, m/s, by position. Where several processes share the air all of them call this.
    pub fn stir(&mut self, velocity: impl Fn([f64; 3]) -> [f64; 3]) {
        let slowest = slowest(&self.air);
        for particle in &mut self.state.air {
            let velocity = velocity(particle.position);
            match particle.role {
                Role::Inside => particle.velocity = velocity,
                Role::Leaving(axis, side) => {
                    let (axis, side) = (usize::from(axis), usize::from(side));
                    particle.leave(axis, side, velocity[axis], slowest);
                }
                _ => {}
            }
        }
        let before = self.inventory().before_outlets();
        self.state.running_mean_before = before.map(|sides| sides.map(|before| before.velocity));
        self.move_outside();
        self.evaluate(0.0);
        self.state.time_step = self.next_step(&[], self.extremes());
    }

    /// Lays water on the boundary particles of a body, in kg/m2, as there from the start. Where several processes share the air all of them call this.
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

    /// Heat that a body and the wall behind it have got from a heater, from outside the box and by radiation, J; negative where they lost it.
    pub fn heat_supplied(&self, body: usize) -> [f64; 3] {
        let supplied = |group: usize, kind: usize| self.state.supplied[group][kind].value();
        let wall = self.solids.wall_behind(body);
        [0, 1, 2].map(|kind| supplied(body, kind) + wall.map_or(0.0, |wall| supplied(wall, kind)))
    }

    /// Water on a body, kg.
    pub fn water_on_body(&self, body: usize) -> f64 {
        let on = self.solids.particles.iter().zip(&self.state.water_on);
        on.filter(|(particle, _)| particle.body as usize == body).map(|(_, water)| water).sum()
    }

    /// The air, as it stands at the end of the last step; particles before inlets and beyond outlets among it. Where there are several processes, that of the
    /// part of this one.
    pub fn air(&self) -> &[Particle] {
        &self.state.air
    }

    /// The solids.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }

    /// Temperature of each particle of the solids, K.
    pub fn temperatures(&self) -> &[f64] {
        &self.state.temperatures[..self.solids.particles.len()]
    }

    /// Water on each particle of the solids, kg.
    pub fn water_on_solids(&self) -> &[f64] {
        &self.state.water_on
    }

    /// Largest stable time step (CFL) from here, s.
    pub fn time_step(&self) -> f64 {
        self.state.time_step
    }

    /// Time up to which steps were taken, s: up to a step before the time shown. Accounts such as [`Dew::heat_from`] are of this time.
    pub fn stepped_until(&self) -> f64 {
        self.state.time
    }

    /// Bytes held for the particles and the work on them.
    pub fn bytes(&self) -> usize {
        let air = self.state.air.capacity() * size_of::<Particle>();
        let work = self.columns.capacity() * size_of::<Column>()
            + self.rates.capacity() * size_of::<Rates>()
            + self.sums.capacity() * size_of::<Sums>()
            + self.tensors.capacity() * size_of::<Tensor>();
        let shared = self.domain.as_ref().map_or(0, Domain::bytes);
        let near_solids = self.contact.bytes() + self.ghosts.bytes() + self.conduction.bytes();
        air + work + shared + self.arrangement.bytes() + near_solids
    }

    pub(crate) fn scale(&self) -> &Scale {
        &self.scale
    }
}

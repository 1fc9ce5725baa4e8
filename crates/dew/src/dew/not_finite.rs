//! Ends a run in which a value is no longer finite, before anything of it is written.

use super::Dew;
use crate::air::{Part, Particle, Role};
use crate::drops::Drop;
use crate::state::State;
use crate::wetting::{Wetting, WettingState};
use corpuscle_model::ModelError;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a step may break, as it was before: the time shown, the state, the drops, and the numbers of air particles of all processes.
pub(super) struct Before {
    shown: f64,
    state: State,
    drops: Option<WettingState>,
    air: Option<[usize; 2]>,
}

/// A position in words.
fn at(position: [f64; 3]) -> String {
    let [x, y, z] = position;
    format!("at x = {x:.6}, y = {y:.6}, z = {z:.6} m")
}

/// The first quantity of a particle of air that is not finite, and its value.
fn defect(particle: &Particle) -> Option<(&'static str, f64)> {
    let vectors = [
        ("position", particle.position),
        ("velocity", particle.velocity),
        ("acceleration", particle.acceleration),
        ("displacement", particle.spreading),
    ];
    let scalars = [
        ("temperature", particle.temperature),
        ("vapour", particle.vapour),
        ("fog", particle.fog),
        ("density", particle.density),
    ];
    let components = vectors.into_iter().flat_map(|(name, vector)| vector.map(|along| (name, along)));
    // All at once first: this is done for each particle in each step.
    let sum: f64 = components.clone().chain(scalars).map(|(_, value)| 0.0 * value).sum();
    if sum == 0.0 { None } else { components.chain(scalars).find(|(_, value)| !value.is_finite()) }
}

/// The first quantity of a drop that is not finite, in words.
fn of_drop(drop: &Drop) -> Option<String> {
    let vectors = [("position", drop.position), ("velocity", drop.velocity), ("normal", drop.normal)];
    let components = vectors.into_iter().flat_map(|(name, vector)| vector.map(|along| (name, along)));
    let mut all = components.chain([("mass", drop.mass), ("radius", drop.radius)]);
    let (quantity, value) = all.find(|(_, value)| !value.is_finite())?;
    Some(format!("the {quantity} of drop {} {} is {value}", drop.id, at(drop.position)))
}

impl Dew {
    /// Whether a value of the air of this process, or of the solids, is not finite.
    pub(super) fn has_not_finite(&self) -> bool {
        let State { air, temperatures, water_on, .. } = &self.state;
        let solids = || temperatures.iter().chain(water_on);
        air.par_iter().with_min_len(4096).any(|particle| defect(particle).is_some())
            || !solids().all(|value| value.is_finite())
    }

    /// The first value of a state that is not finite, in words; none where all are.
    fn not_finite_in(&self, state: &State) -> Option<String> {
        let of_air = state.air.iter().find_map(|particle| Some((particle, defect(particle)?)));
        if let Some((particle, (quantity, value))) = of_air {
            let which = if particle.role == Role::Inside { "air" } else { "air beyond a side, or of low utility," };
            return Some(format!(
                "the {quantity} of particle {} of the {which} {} is {value}",
                particle.id,
                at(particle.position)
            ));
        }
        let of_solids = [("temperature", &state.temperatures), ("water", &state.water_on)];
        of_solids.into_iter().find_map(|(quantity, values)| {
            let node = values.iter().position(|value| !value.is_finite())?;
            Some(format!("the {quantity} {} is {}", self.node_in_words(node), values[node]))
        })
    }

    /// A particle of a solid, or a cell of the wall behind one, in words.
    fn node_in_words(&self, node: usize) -> String {
        let name = |body: usize| self.names.get(body).map_or(format!("solid {body}"), |name| format!("solid `{name}`"));
        match self.solids.particles.get(node) {
            Some(particle) => {
                format!("of particle {node} of {} {}", name(particle.body as usize), at(particle.position))
            }
            None => {
                let wall = self.solids.cells[node - self.solids.particles.len()].wall;
                format!("of the wall behind {}", name(self.solids.walls[wall as usize] as usize))
            }
        }
    }

    /// The first value of the drops that is not finite, in words; none where all are.
    fn not_finite_on_surfaces(&self) -> Option<String> {
        let drops = self.wetting.as_ref().map(Wetting::drops)?;
        drops.drops().iter().find_map(of_drop).or_else(|| {
            let site = drops.unseen_masses().iter().position(|mass| !mass.is_finite())?;
            let position = drops.sites()[site].position;
            Some(format!("the water {} is {}", at(position), drops.unseen_masses()[site]))
        })
    }

    /// Refuses drops of which a value is not finite. All processes have the same.
    pub(super) fn check_drops(&self) -> Result<(), ModelError> {
        self.not_finite_on_surfaces().map_or(Ok(()), |what| Err(self.broken(format!("{what}. {REMEDY}"))))
    }

    /// The first value that is not finite, in words, of all processes; none where all are finite.
    fn not_finite(&self) -> Option<String> {
        self.processes.gather_all(self.not_finite_in(&self.state)).into_iter().flatten().next()
    }

    /// Where the fastest air is, in words.
    pub(super) fn fastest_position(&self) -> Option<String> {
        let fastest = self.inside().max_by(|a, b| a.speed_squared().total_cmp(&b.speed_squared()));
        let own = fastest.map(|particle| (particle.speed_squared(), at(particle.position)));
        let all = self.processes.gather_all(own).into_iter().flatten();
        all.max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, position)| position)
    }

    /// Where a rate of diffusion is not a number, in words.
    fn not_finite_rate(&self) -> Option<String> {
        let stiff = self.work.stiff.iter().position(|rate| !rate.is_finite());
        let near = &self.contact.near;
        let own =
            stiff.map(|number| match near.get(number).and_then(|near| self.state.air.get(near.particle as usize)) {
                Some(particle) => format!("between the air {} and a solid", at(particle.position)),
                None => self.node_in_words(number - near.len()),
            });
        self.processes.gather_all(own).into_iter().flatten().next()
    }

    /// Refuses a state in which a value is not finite.
    #[cfg(feature = "gpu")]
    pub(super) fn check_finite(&self) -> Result<(), ModelError> {
        self.not_finite().map_or(Ok(()), |what| Err(self.broken(format!("{what}. {REMEDY}"))))?;
        self.check_drops()
    }

    /// Why a step of `next` s does not go on, after one of `step`.
    pub(super) fn too_short(&self, step: f64, next: f64) -> ModelError {
        if let Some(what) = self.not_finite() {
            return self.broken(format!("{what}. {REMEDY}"));
        }
        if let Some(position) = self.not_finite_rate() {
            return self.broken(format!("the flow of heat {position} is no longer a number. {REMEDY}"));
        }
        let position =
            self.fastest_position().map_or(String::new(), |position| format!("; the fastest air is {position}"));
        self.broken(format!(
            "the time step fell from {step:.3e} s to {next:.3e} s{position}. Try a higher speed of sound, or look in the last \
             frame for the position where the air is fast or hot"
        ))
    }

    pub(super) fn broken(&self, what: String) -> ModelError {
        ModelError::Breakdown { time: self.state.time, step: self.state.steps, what }
    }

    /// Refuses a state of a checkpoint, with the drops, in which a value is not finite.
    pub(crate) fn check_state(&self, state: &State, drops: Option<&WettingState>) -> Result<(), ModelError> {
        let of_drops = || drops?.drops().drops.iter().find_map(of_drop);
        let of_clock = || {
            let clock = [("time", state.time), ("time step", state.time_step)];
            let (quantity, value) = clock.into_iter().find(|(_, value)| !value.is_finite())?;
            Some(format!("the {quantity} is {value}"))
        };
        match of_clock().or_else(|| self.not_finite_in(state)).or_else(of_drops) {
            Some(what) => Err(ModelError::Checkpoint(format!("{what}; start the run again"))),
            None => Ok(()),
        }
    }

    /// Takes steps up to `time`, or until `stop` is set; goes back where one breaks down.
    pub(crate) fn advance_on_cpu(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        if !self.state.time_step.is_finite() {
            return Err(self.too_short(self.state.time_step, self.state.time_step));
        }
        if self.state.time + self.state.time_step > time {
            self.shown = time;
            return Ok(());
        }
        let before = self.before();
        let advanced = self.take_steps(time, stop);
        if advanced.is_err() {
            self.go_back_to(before);
        }
        advanced
    }

    fn take_steps(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.state.time + self.state.time_step <= time {
            if self.processes.any(stop.load(Ordering::Relaxed)) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            self.step()?;
        }
        self.shown = time;
        Ok(())
    }

    /// What the next steps may break.
    pub(super) fn before(&self) -> Before {
        Before {
            shown: self.shown,
            state: self.state.clone(),
            drops: self.wetting.as_ref().map(Wetting::state),
            air: self.domain.as_ref().map(|domain| domain.air),
        }
    }

    /// Takes back steps that broke down, so that what is shown and written has finite values only.
    pub(super) fn go_back_to(&mut self, before: Before) {
        let Before { shown, state, drops, air } = before;
        (self.shown, self.state) = (shown, state);
        if let (Some(wetting), Some(drops)) = (&mut self.wetting, drops) {
            wetting.restore(drops);
        }
        if let (Some(domain), Some(air)) = (&mut self.domain, air) {
            domain.air = air;
        }
        self.set_evaporation();
        self.find_pairs_for_layers();
    }

    /// Finds the pairs of air and wall of which the gauges of layers are made.
    pub(super) fn find_pairs_for_layers(&mut self) {
        if self.domain.is_none() && self.layers.iter().any(Option::is_some) {
            self.arrangement.arrange(&mut self.state.air, &[], &self.room, self.scale.h(), Part::WHOLE);
            self.contact.update(&self.arrangement, &self.scale);
            self.ghosts.update(&self.arrangement, &self.scale);
        }
    }
}

/// What to do where a value is not finite.
const REMEDY: &str = "Look in the last frame at the air there; a smaller dew.spacing_m may help";

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_model::{Frame, Model, Values};
    use corpuscle_scene::Scene;
    use std::path::Path;

    /// A change that makes a value no number.
    type Break = fn(&mut Dew);

    const GLASS: &str = "run.until_s = 0.01\n[dew]\nsize_m = [0.02, 0.02, 0.02]\nspacing_m = 0.005\n\
        air = { temperature_c = 25.0, relative_humidity = 0.9 }\ndrops = { sites_per_m2 = 1e6 }\n\
        solid = [{ name = \"pane\", shape = { box = { size_m = [0.005, 0.02, 0.02] } }, position_m = [0.0025, 0.01, 0.01], temperature_c = 5.0 }]\n";

    /// Amid a run.
    fn glass() -> Dew {
        let mut scene = Scene::parse(GLASS, "glass", &[]).unwrap();
        scene.resolve_defaults();
        let mut dew = crate::open(scene.dew().unwrap(), 1, Path::new("")).unwrap();
        advance(&mut dew, 0.02).unwrap();
        dew
    }

    fn advance(dew: &mut Dew, time: f64) -> Result<(), ModelError> {
        dew.advance_to(time, &AtomicBool::new(false))
    }

    fn is_finite(frame: &Frame) -> bool {
        frame.sets.iter().all(|set| {
            let vectors = set.position.iter().chain(&set.velocity);
            let scalars = set.radius.iter().chain(&set.mass).chain(vectors.flatten());
            let mut columns = set.columns.iter().map(|column| match &column.values {
                Values::Scalar(values) => values.iter().all(|value| value.is_finite()),
                Values::Vector(vectors) => vectors.as_flattened().iter().all(|value| value.is_finite()),
            });
            scalars.into_iter().all(|value| value.is_finite()) && columns.all(|all| all)
        })
    }

    #[test]
    fn a_value_that_is_not_a_number_ends_the_run_with_its_time_and_position() {
        let breaks: [(&str, Break); 7] = [
            ("position", |dew| dew.state.air[3].position[1] = f64::NAN),
            ("velocity", |dew| dew.state.air[3].velocity[0] = f64::NAN),
            ("temperature", |dew| dew.state.air[3].temperature = f64::NAN),
            ("vapour", |dew| dew.state.air[3].vapour = f64::NAN),
            ("fog", |dew| dew.state.air[3].fog = f64::NAN),
            ("temperature of a solid", |dew| dew.state.temperatures[5] = f64::NAN),
            ("water", |dew| dew.state.water_on.iter_mut().for_each(|water| *water = f64::NAN)),
        ];
        for (quantity, break_it) in breaks {
            let mut dew = glass();
            break_it(&mut dew);
            let told = advance(&mut dew, 0.05).expect_err(quantity).to_string();
            for word in ["broke down at t = 0.0", "x = ", "y = ", "particle", "NaN"] {
                assert!(told.contains(word), "{quantity}, {word}: {told}");
            }
        }
    }

    #[test]
    fn a_step_that_breaks_down_is_taken_back() {
        let breaks: [(&str, Break); 5] = [
            ("drive", |dew| dew.settings.body_acceleration = [f64::NAN; 3]),
            ("heat of condensation", |dew| dew.latent_heat = f64::NAN),
            ("conduction", |dew| dew.conductances[5] = f64::NAN),
            ("heat capacity of a solid", |dew| dew.solids.bodies[0].0.heat_capacity = f64::NAN),
            ("heat capacity of air", |dew| dew.air.heat_capacity = f64::NAN),
        ];
        for (what, break_it) in breaks {
            let mut dew = glass();
            let (state, frame) = (dew.save(), dew.frame());
            break_it(&mut dew);
            let told = advance(&mut dew, 0.05).expect_err(what).to_string();
            assert!(told.contains("broke down at t = 0.0") && told.contains("x = "), "{what}: {told}");
            assert_eq!(dew.save(), state, "{what}");
            assert!(dew.frame() == frame && is_finite(&frame), "{what}");
            let of_surfaces = |surface: &corpuscle_model::Surface| format!("{surface:?}");
            let told = dew.surfaces().iter().map(of_surfaces).collect::<String>();
            assert_eq!(told, glass().surfaces().iter().map(of_surfaces).collect::<String>(), "{what}");
        }
    }

    /// Not by the forces, which find it anew in each step.
    #[test]
    fn a_density_that_is_not_a_number_is_noticed() {
        let mut dew = glass();
        assert!(!dew.has_not_finite());
        dew.state.air[3].density = f64::NAN;
        assert!(dew.has_not_finite());
    }

    #[test]
    fn a_checkpoint_with_a_value_that_is_not_a_number_is_refused() {
        let mut dew = glass();
        let sound = dew.save();
        dew.state.air[3].vapour = f64::NAN;
        let broken = dew.save();
        dew.restore(&sound).unwrap();
        let told = dew.restore(&broken).unwrap_err().to_string();
        assert!(told.contains("vapour of particle") && told.contains("x = "), "{told}");
        assert_eq!(dew.save(), sound);
    }
}

//! A flood whose steps the graphics card takes.

use super::step::CELL_OVER_H_BALANCED;
use super::{DENSITY, Flood, State, open};
use crate::card::{Card, Progress};
use crate::friction::{Coefficient, Roughness};
use corpuscle_gpu::{Gpu, GpuError};
use corpuscle_model::ModelError;
use corpuscle_scene::Scheme as SchemeName;
use std::sync::atomic::{AtomicBool, Ordering};

fn failed(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl Flood {
    /// Lets a graphics card take the steps, in single precision.
    ///
    /// # Errors
    /// [`ModelError::Setup`] where the scene has something that the card's program has not yet, or the card too little memory.
    pub fn use_card(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        let missing = self.missing_on_card();
        if !missing.is_empty() {
            let what = missing.join(", ");
            return Err(ModelError::Setup(format!(
                "the graphics card cannot yet compute this flood: it has {what}. Run it with `--backend cpu`"
            )));
        }
        let scheme = open::balanced_parameters(&self.settings, self.volume / (self.spacing * self.spacing), self.h);
        let count = self.state.particles.len();
        let shortest = self.shortest_step();
        let card = Card::new(gpu, count, &self.surroundings, &scheme, &self.roughness, shortest);
        self.card = Some(card.map_err(|error| ModelError::Setup(error.to_string()))?);
        self.send_to_card();
        Ok(())
    }

    /// What this flood has that there is no twin of on the card.
    fn missing_on_card(&self) -> Vec<&'static str> {
        let rasters = matches!(self.roughness, Roughness::Manning(Coefficient::Raster(_) | Coefficient::Classes(..)));
        let all = [
            (self.settings.scheme == SchemeName::Paper, "flood.scheme = \"paper\""),
            (self.refinement.is_some(), "[flood.refinement]"),
            (self.ground.is_some(), "[flood.rain] or [flood.infiltration]"),
            (!self.sources.is_empty(), "[[flood.inflow]]"),
            (!self.structures.is_empty(), "[[flood.outflow]], [[flood.stage]] or [[flood.link]]"),
            (!self.state.falling.is_empty(), "water that falls (block)"),
            (self.surroundings.edges.holds_level(), "an edge with a stage"),
            (self.surroundings.obstacles.any(), "[[flood.obstacle]]"),
            (rasters, "Manning's n by a raster or [flood.land_use]"),
        ];
        all.into_iter().filter_map(|(is_there, what)| is_there.then_some(what)).collect()
    }

    /// Hands the state to the card.
    pub(super) fn send_to_card(&mut self) {
        let State { particles, time_step, external, .. } = &self.state;
        if let Some(card) = &mut self.card {
            card.send(particles, *time_step, *external);
        }
    }

    pub(super) fn advance_on_card(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            let look = self.state.next_look as f64 * self.map_period;
            let steps = self.state.steps;
            self.advance_to_look(time, look, stop)?;
            if self.state.time >= look {
                self.look();
            }
            // To the card, which rounds more coarsely, a step that ends at that time may end after it.
            if self.state.steps == steps {
                break;
            }
        }
        self.shown = time;
        Ok(())
    }

    /// Goes on to `time`, or to the first step that ends at `look` or after. What is here changes only when all of it has come back.
    fn advance_to_look(&mut self, time: f64, look: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        let Some(card) = &mut self.card else { return Ok(()) };
        let began = self.state.time;
        let mut done = Progress::none(self.state.time_step);
        while began + done.elapsed + done.step <= time && began + done.elapsed < look {
            let now = began + done.elapsed;
            let progress = card.advance(time - now, look - now).map_err(|error| failed(&error))?;
            done = done.and(progress);
            if progress.steps == 0 || done.broken || stop.load(Ordering::Relaxed) {
                break;
            }
        }
        if done.steps > 0 {
            card.fetch(&mut self.state.particles).map_err(|error| failed(&error))?;
            self.book(&done);
            self.arrange();
        }
        if done.broken { self.check(done.step) } else { Ok(()) }
    }

    fn book(&mut self, progress: &Progress) {
        let state = &mut self.state;
        state.time += progress.elapsed;
        state.steps += progress.steps;
        state.particle_steps += progress.particle_steps;
        state.time_step = progress.step;
        state.external = progress.from_outside;
        state.sizes.cell = CELL_OVER_H_BALANCED * progress.mean_h;
        state.water.inflow.add(progress.inflow);
        state.water.outflow.add(progress.outflow);
        state.momentum.inflow.add(DENSITY * progress.momentum_gained);
        state.momentum.outflow.add(DENSITY * progress.momentum_lost);
        self.surroundings.time = state.time;
    }
}

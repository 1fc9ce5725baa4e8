//! A flood whose steps the graphics card takes.

use super::step::CELL_OVER_H_BALANCED;
use super::{DENSITY, Flood, State, open};
use crate::card::{Birth, Card, MOST_BIRTHS, Progress, Setting, Water};
use crate::inflow::Source;
use corpuscle_gpu::{Gpu, GpuError};
use corpuscle_model::{ExactSum, ModelError};
use corpuscle_scene::Scheme as SchemeName;
use std::sync::atomic::{AtomicBool, Ordering};

/// Births are looked for so many steps beyond the next look at the maps: the step that passes it may be longer than the last.
const LONGEST_AHEAD: f64 = 10.0;

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
        self.open_card(gpu).map_err(|error| ModelError::Setup(error.to_string()))
    }

    /// Wall-clock time that the card has spent on steps, s: without what the host does when something looks.
    pub fn seconds_on_card(&self) -> Option<f64> {
        self.card.as_ref().map(Card::busy)
    }

    /// Bytes held on the card.
    pub fn bytes_on_card(&self) -> Option<u64> {
        self.card.as_ref().map(Card::bytes)
    }

    /// Makes room on a card for the particles that there are, and for more where water comes in, and hands the state over.
    fn open_card(&mut self, gpu: Gpu) -> Result<(), GpuError> {
        let depth = self.volume / (self.spacing * self.spacing);
        let scheme = open::balanced_parameters(&self.settings, depth, self.h);
        let count = self.state.particles.len();
        let comes_in =
            !self.sources.is_empty() || !self.structures.held.is_empty() || self.surroundings.edges.holds_level();
        let room = if comes_in { 2 * count + MOST_BIRTHS } else { count };
        let setting = Setting {
            surroundings: &self.surroundings,
            scheme: &scheme,
            roughness: &self.roughness,
            sources: &self.sources,
            structures: &self.structures,
            seed: self.seed,
            shortest_step: self.shortest_step(),
            volume: self.volume,
            h: self.h,
            spacing: self.spacing,
        };
        let card = Card::new(gpu, room, &setting)?;
        self.card = Some(card);
        self.send_to_card()
    }

    /// What this flood has that there is no twin of on the card.
    fn missing_on_card(&self) -> Vec<&'static str> {
        let all = [
            (self.settings.scheme == SchemeName::Paper, "flood.scheme = \"paper\""),
            (self.refinement.is_some(), "[flood.refinement]"),
            (self.ground.is_some(), "[flood.rain] or [flood.infiltration]"),
            (!self.state.falling.is_empty(), "water that falls (block)"),
        ];
        all.into_iter().filter_map(|(is_there, what)| is_there.then_some(what)).collect()
    }

    /// Hands the state to the card, and takes more room there if there is too little.
    pub(super) fn send_to_card(&mut self) -> Result<(), GpuError> {
        let State { particles, on_obstacles, impulses, flows, .. } = &self.state;
        let water = Water {
            particles,
            step: self.state.time_step,
            from_outside: self.state.external,
            on_obstacles,
            impulses,
            put_back: self.state.put_back,
            steps: self.state.steps,
            next_id: self.state.next_id,
            flows,
        };
        match &mut self.card {
            Some(card) if card.room() < particles.len() => {
                let gpu = card.gpu();
                self.open_card(gpu)
            }
            Some(card) => {
                card.send(&water);
                Ok(())
            }
            None => Ok(()),
        }
    }

    /// Takes more room on the card where the water that is to come might not find any.
    fn make_room(&mut self) -> Result<(), GpuError> {
        let Some(card) = &self.card else { return Ok(()) };
        if card
            .lacks_room(|horizon| most_births(&self.sources, &self.state.owed, self.volume, self.state.time, horizon))
        {
            let gpu = card.gpu();
            self.open_card(gpu)?;
        }
        Ok(())
    }

    pub(super) fn advance_on_card(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            let look = self.state.next_look as f64 * self.map_period;
            let steps = self.state.steps;
            self.make_room().map_err(|error| failed(&error))?;
            let done = self.advance_to_look(time, look, stop).map_err(|error| failed(&error))?;
            if done.broken {
                return self.check(done.step);
            }
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
    fn advance_to_look(&mut self, time: f64, look: f64, stop: &AtomicBool) -> Result<Progress, GpuError> {
        let began = self.state.time;
        let mut done = Progress::none(self.state.time_step);
        let mut owed = self.state.owed.clone();
        while began + done.elapsed + done.step <= time && began + done.elapsed < look {
            let now = began + done.elapsed;
            let births = self.births(&owed, now, time.min(look + LONGEST_AHEAD * done.step));
            let Some(card) = &mut self.card else { break };
            let progress = card.advance(now, time - now, look - now, &births)?;
            for (source, owed) in self.sources.iter().zip(&mut owed) {
                owed.add(source.discharge.integral(now, now + progress.elapsed));
            }
            births[..progress.born].iter().for_each(|birth| owed[birth.source].add(-self.volume));
            done = done.and(progress);
            let lacks_room = card.lacks_room(|horizon| most_births(&self.sources, &owed, self.volume, now, horizon));
            if progress.steps == 0 || done.broken || lacks_room || stop.load(Ordering::Relaxed) {
                break;
            }
        }
        if let Some(card) = self.card.as_mut().filter(|_| done.steps > 0) {
            let state = &mut self.state;
            card.fetch(&mut state.particles, &self.surroundings.terrain)?;
            card.flows(&mut state.flows)?;
            let pushed = card.on_obstacles()?;
            (state.on_obstacles, state.impulses, state.put_back) = (pushed.forces, pushed.impulses, pushed.put_back);
            (self.state.owed, self.state.next_id) = (owed, done.next_id);
            self.book(&done);
            self.arrange();
        }
        Ok(done)
    }

    /// The particles that the sources bring from `now` to `until`, the earliest first.
    fn births(&self, owed: &[ExactSum], now: f64, until: f64) -> Vec<Birth> {
        let sources = self.sources.iter().zip(owed).enumerate();
        let births = sources.flat_map(|(number, (source, owed))| {
            let times = source.times(owed.value(), self.volume, now, until);
            times.into_iter().map(move |time| Birth { time: time - now, source: number, velocity: source.velocity })
        });
        let mut births: Vec<Birth> = births.collect();
        births.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.source.cmp(&b.source)));
        births.truncate(MOST_BIRTHS);
        births
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

/// As many particles as the sources can bring from `now` on within `horizon` s.
fn most_births(sources: &[Source], owed: &[ExactSum], volume: f64, now: f64, horizon: f64) -> usize {
    let of_one = |(source, owed): (&Source, &ExactSum)| owed.value() + source.discharge.integral(now, now + horizon);
    sources.iter().zip(owed).map(of_one).map(|come| (come / volume).max(0.0) as usize + 1).sum()
}

//! A flood whose steps the graphics card takes.

use super::measured_on_card::Onlookers;
use super::on_device::Watch;
use super::{DENSITY, Flood, State, open};
use crate::card::{Birth, Card, MOST_BIRTHS, MOST_LOOKS, MOST_ROWS, Progress, Setting, Span, Water};
use crate::gauges::Reading;
use crate::inflow::Source;
use crate::particle::Particle;
use corpuscle_gpu::{DeviceParticles, Gpu, GpuError, Stopwatch, Taken};
use corpuscle_model::{Companion, ExactSum, Glance, GpuModel, Model, ModelError, Passed};
use corpuscle_scene::{Flood as Settings, Scheme as SchemeName, SmoothingForm};
use std::sync::atomic::{AtomicBool, Ordering};

/// Births are looked for so many steps beyond the next look at the maps: the step that passes it may be longer than the last.
const LONGEST_AHEAD: f64 = 10.0;

/// Room for so many particles is kept where water is held at levels.
const HELD_BIRTHS: usize = 4096;

pub(super) fn failed(error: &GpuError) -> ModelError {
    ModelError::Device(error.to_string())
}

impl GpuModel for Flood {
    fn use_gpu(&mut self, gpu: Gpu) -> Result<(), ModelError> {
        let Settings { scheme, sph_swe, .. } = &self.settings;
        if *scheme == SchemeName::SphSwe && sph_swe.smoothing == SmoothingForm::Rate {
            let what = "flood.sph_swe.smoothing = \"rate\" computes on the CPU only: leave `--backend gpu` out, or take \"density\"";
            return Err(ModelError::Setup(what.into()));
        }
        // Particles that were only just set up may not yet say how long a step may be: the first is then 0 s long, and is taken here.
        if self.state.steps == 0 && self.state.time_step == 0.0 {
            self.step()?;
        }
        self.open_card(gpu).map_err(|error| ModelError::Setup(error.to_string()))
    }

    fn gpu_seconds(&self) -> Option<f64> {
        self.card.as_ref().map(Card::busy)
    }

    fn time_passes(&mut self) {
        if let Some(card) = &mut self.card {
            card.stopwatch = Stopwatch::new(&card.gpu());
        }
    }

    fn pass_times(&self) -> Vec<(&'static str, Taken)> {
        self.card.iter().filter_map(|card| card.stopwatch.as_ref()).flat_map(Stopwatch::taken).collect()
    }

    fn gpu_bytes(&self) -> Option<u64> {
        self.card.as_ref().map(Card::bytes)
    }
    fn gpu(&self) -> Option<Gpu> {
        self.card.as_ref().map(Card::gpu)
    }

    fn particles_on_gpu(&self) -> Result<Option<DeviceParticles>, ModelError> {
        let seen = self.card.as_ref().map(|card| card.seen(self.particles_shown(self.since())));
        seen.transpose().map_err(|error| failed(&error))
    }

    fn advance_shown(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        companion: &mut dyn Companion,
        (first, _): (f64, bool),
        show: &mut dyn FnMut(Glance) -> f64,
    ) -> Result<(), ModelError> {
        if self.card.is_none() {
            return self.advance_with(time, stop, companion);
        }
        let watch = Some(Watch { wanted: first, shown: self.particles_shown(0.0), show });
        self.advance_measured(time, stop, Onlookers { watch, ..Onlookers::of(companion) })
    }
}

impl Flood {
    /// Makes room on a card for the particles that there are, and for more where water comes in, and hands the state over.
    pub(super) fn open_card(&mut self, gpu: Gpu) -> Result<(), GpuError> {
        let count = self.state.particles.len();
        let falling = self.state.falling.len();
        let holds = !self.structures.held.is_empty() || self.surroundings.edges.holds_level();
        let comes_in = !self.sources.is_empty() || self.ground.is_some() || holds;
        let films = self.films();
        let grows = comes_in || self.refinement.is_some();
        let room = falling + if grows { 2 * (count + films) + MOST_BIRTHS } else { count };
        self.open_card_with(gpu, room)
    }

    /// The same with room for so many particles.
    fn open_card_with(&mut self, gpu: Gpu, room: usize) -> Result<(), GpuError> {
        let depth = self.volume / (self.spacing * self.spacing);
        let scheme = open::balanced_parameters(&self.settings, depth, self.h);
        let sph_swe = self.sph_swe();
        let setting = Setting {
            surroundings: &self.surroundings,
            scheme: &scheme,
            sph_swe: (self.settings.scheme == SchemeName::SphSwe).then_some(&sph_swe),
            falling: self.state.falling.len(),
            fall_step: self.fall_step(),
            roughness: &self.roughness,
            sources: &self.sources,
            structures: &self.structures,
            ground: self.ground.as_ref(),
            refinement: self.refinement.as_ref(),
            seed: self.seed,
            shortest_step: self.shortest_step(),
            volume: self.volume,
            h: self.h,
            spacing: self.spacing,
        };
        let mut card = Card::new(gpu, room, &setting)?;
        if !self.looks_for_overtopping() {
            card.keep_maps(&self.surroundings.terrain, &self.surroundings.obstacles, &self.state.maps)?;
        }
        self.card = Some(card);
        self.send_to_card()
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
            time: self.state.time,
            steps: self.state.steps,
            next_id: self.state.next_id,
            flows,
            wetness: &self.state.wetness,
            maps: &self.state.maps,
            falling: &self.state.falling,
        };
        match &mut self.card {
            Some(card) if card.room() < particles.len() || card.room_in_air() < water.falling.len() => {
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

    /// Films that can become particles between two looks at the room.
    fn films(&self) -> usize {
        self.ground.as_ref().map_or(0, |ground| ground.factor.len())
    }

    /// As many particles as can come from `now` on within `horizon` s, while sources owe `owed`.
    fn most_births(&self, owed: &[ExactSum], now: f64, horizon: f64) -> usize {
        let of_one =
            |(source, owed): (&Source, &ExactSum)| owed.value() + source.discharge.integral(now, now + horizon);
        let of_sources =
            self.sources.iter().zip(owed).map(of_one).map(|come| (come / self.volume).max(0.0) as usize + 1);
        let holds = self.surroundings.edges.holds_level() || !self.structures.held.is_empty();
        of_sources.sum::<usize>() + self.films() + if holds { HELD_BIRTHS } else { 0 }
    }

    /// Takes more room on the card where the water that is to come might not find any.
    fn make_room(&mut self) -> Result<(), GpuError> {
        let Some(card) = &self.card else { return Ok(()) };
        if card.lacks_room(|horizon| self.most_births(&self.state.owed, self.state.time, horizon)) {
            let gpu = card.gpu();
            self.open_card(gpu)?;
        }
        Ok(())
    }

    pub(super) fn advance_on_card(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        onlookers: &mut Onlookers<'_>,
    ) -> Result<(), ModelError> {
        onlookers.told = self.shown;
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) || onlookers.call_back {
                // Who has seen a row of gauges is not to see it again.
                self.shown = onlookers.told.max(self.state.time);
                return Ok(());
            }
            let keeps_maps = self.card.as_ref().is_some_and(Card::keeps_maps);
            let look = if keeps_maps { f64::INFINITY } else { self.state.next_look as f64 * self.map_period };
            let before = (self.state.steps, onlookers.told);
            self.make_room().map_err(|error| failed(&error))?;
            if onlookers.measure() {
                self.measure_on_card()?;
            }
            let done = self.advance_to_look(time, look, stop, onlookers)?;
            if done.broken {
                return Err(self.breakdown(done.step));
            }
            if self.state.time >= look {
                self.look();
            }
            // To the card, which rounds more coarsely, a step that ends at that time may end after it.
            let is_stopped = stop.load(Ordering::Relaxed) || onlookers.call_back;
            if (self.state.steps, onlookers.told) == before && !is_stopped {
                break;
            }
        }
        self.show_to(onlookers, self.state.time, time.next_up()).map_err(|error| failed(&error))?;
        self.shown = time;
        Ok(())
    }

    /// Goes on to `time`, or to the first step that ends at `look` or after. What is here changes only when all of it has come back.
    fn advance_to_look(
        &mut self,
        time: f64,
        look: f64,
        stop: &AtomicBool,
        onlookers: &mut Onlookers<'_>,
    ) -> Result<Progress, ModelError> {
        let began = self.state.time;
        let mut done = Progress::none(self.state.time_step);
        let mut owed = self.state.owed.clone();
        let mut looked = self.state.maps.last();
        while began + done.elapsed + done.step <= time && began + done.elapsed < look {
            let now = began + done.elapsed;
            self.show_to(onlookers, now, now + done.step).map_err(|error| failed(&error))?;
            if stop.load(Ordering::Relaxed) || onlookers.call_back {
                break;
            }
            let longest = self.card.as_ref().map_or(0.0, Card::longest_batch);
            let births = self.births(&owed, now, time.min(look + LONGEST_AHEAD * done.step).min(now + longest));
            let looks = self.looks(now, done.looks);
            let due = onlookers.due(time);
            let until = if due.len() == MOST_ROWS { due[MOST_ROWS - 1] } else { time };
            let (target, most) = onlookers.steps_to_look(now, until);
            let from_now: Vec<f64> = due.iter().map(|due| due - now).collect();
            let Some(card) = &mut self.card else { break };
            let span = Span {
                now,
                until: target - now,
                most,
                look: looks.last().copied().unwrap_or(look - now),
                looks: &looks,
                looked: looked - now,
                births: &births,
                due: &from_now,
            };
            let (mut progress, mut readings) =
                card.advance(span, self.ground.as_ref()).map_err(|error| failed(&error))?;
            let particles = card.particles();
            if !readings.iter().all(Reading::is_sound) {
                progress.broken = true;
                readings.clear();
            }
            for (due, reading) in due.iter().zip(&readings) {
                onlookers.tell(*due, &self.row_of_card(reading, &done));
            }
            for (source, owed) in self.sources.iter().zip(&mut owed) {
                owed.add(source.discharge.integral(now, now + progress.elapsed));
            }
            births[..progress.born].iter().for_each(|birth| owed[birth.source].add(-self.volume));
            if progress.looks > 0 {
                looked = now + progress.looked;
            }
            done = done.and(progress);
            let particle_steps = self.state.particle_steps + done.particle_steps;
            onlookers.pass(Passed { time: began + done.elapsed, particles, particle_steps });
            let lacks_room = |card: &Card| card.lacks_room(|horizon| self.most_births(&owed, now, horizon));
            let is_held = progress.steps == 0 && readings.is_empty();
            if is_held && target < until && !done.broken {
                // To the card, which rounds more coarsely, a step that ends when somebody looks may end after it.
                self.show_to(onlookers, now, target.next_up()).map_err(|error| failed(&error))?;
            } else if is_held || done.broken || self.card.as_ref().is_some_and(lacks_room) {
                break;
            }
        }
        if done.steps > 0 {
            let particles = self.fetched().map_err(|error| failed(&error))?;
            let (time, steps) = (began + done.elapsed, self.state.steps + done.steps);
            if let Some(error) = self.defect_among(&particles, time, steps) {
                return Err(error);
            }
            self.state.particles = particles;
            self.take_over(&done, owed, looked).map_err(|error| failed(&error))?;
        }
        Ok(done)
    }

    /// The particles as the card has them.
    fn fetched(&mut self) -> Result<Vec<Particle>, GpuError> {
        let mut particles = Vec::new();
        if let Some(card) = &mut self.card {
            card.fetch(&mut particles, &self.surroundings.terrain)?;
        }
        Ok(particles)
    }

    /// Takes over what else the card has, after steps that did what `done` says: sources owe `owed`, and it was last
    /// looked at the maps at `looked` s.
    fn take_over(&mut self, done: &Progress, owed: Vec<ExactSum>, looked: f64) -> Result<(), GpuError> {
        if let Some(card) = &self.card {
            let state = &mut self.state;
            card.flows(&mut state.flows)?;
            card.falling(&mut state.falling)?;
            card.wetness(&mut state.wetness)?;
            if done.looks > 0 {
                card.maps(&mut state.maps)?;
                state.maps.set_last(looked);
                state.next_look += done.looks as u64;
            }
            let pushed = card.on_obstacles()?;
            (state.on_obstacles, state.impulses, state.put_back) = (pushed.forces, pushed.impulses, pushed.put_back);
            (self.state.owed, self.state.next_id) = (owed, done.next_id);
            self.book(done);
            self.arrange();
        }
        Ok(())
    }

    /// The next times at which the card is to look at the maps, s from `now`, when so many have passed; none where the host does.
    fn looks(&self, now: f64, passed: usize) -> Vec<f64> {
        let numbers = self.state.next_look + passed as u64..;
        let keeps_maps = self.card.as_ref().is_some_and(Card::keeps_maps);
        let count = if keeps_maps { MOST_LOOKS } else { 0 };
        numbers.take(count).map(|number| number as f64 * self.map_period - now).collect()
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
        let cell = self.cell_over_h() * progress.mean_h;
        let state = &mut self.state;
        state.time += progress.elapsed;
        state.steps += progress.steps;
        state.particle_steps += progress.particle_steps;
        state.time_step = progress.step;
        state.external = progress.from_outside;
        state.sizes.cell = cell;
        state.water.inflow.add(progress.inflow);
        state.water.outflow.add(progress.outflow);
        state.wetness.rained.add(progress.rained);
        state.wetness.infiltrated.add(progress.infiltrated);
        state.momentum.inflow.add(DENSITY * progress.momentum_gained);
        state.momentum.outflow.add(DENSITY * progress.momentum_lost);
        self.surroundings.time = state.time;
    }
}

#[cfg(test)]
mod tests;

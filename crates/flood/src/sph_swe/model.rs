//! What a flood shows of itself.

use super::change::Overrides;
#[cfg(feature = "gpu")]
use super::gpu::Observers;
use super::particle::Particle;
use super::{DENSITY, SphSweFlood, State};
#[cfg(feature = "gpu")]
use corpuscle_model::{AdvanceObserver, CpuOnly, GpuModel, advance_with};
use corpuscle_model::{Column, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Values};
use std::sync::atomic::{AtomicBool, Ordering};

impl Model for SphSweFlood {
    fn name(&self) -> &'static str {
        "flood"
    }

    #[cfg(feature = "gpu")]
    fn backend(&self) -> &'static str {
        if self.on_gpu.is_some() { "gpu" } else { "cpu" }
    }

    #[cfg(feature = "gpu")]
    fn cpu_only(&self) -> Option<CpuOnly> {
        self.on_cpu_only()
    }

    #[cfg(feature = "gpu")]
    fn on_gpu(&self) -> Option<&dyn GpuModel> {
        Some(self)
    }

    #[cfg(feature = "gpu")]
    fn on_gpu_mut(&mut self) -> Option<&mut dyn GpuModel> {
        Some(self)
    }

    fn time(&self) -> f64 {
        self.shown
    }

    fn steps(&self) -> u64 {
        self.state.steps
    }

    fn particle_steps(&self) -> u64 {
        self.state.particle_steps
    }

    fn particles(&self) -> usize {
        self.inside().count() + self.state.falling.len()
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        if self.on_gpu.is_some() {
            return corpuscle_gpu::wait_for(self.advance_on_gpu(time, stop, &mut Observers::default()));
        }
        while self.state.time + self.state.time_step <= time {
            if stop.load(Ordering::Relaxed) {
                self.shown = self.shown.max(self.state.time);
                return Ok(());
            }
            self.step()?;
        }
        self.shown = time;
        Ok(())
    }

    #[cfg(feature = "gpu")]
    fn advance_with(
        &mut self,
        time: f64,
        stop: &AtomicBool,
        observer: &mut dyn AdvanceObserver,
    ) -> Result<(), ModelError> {
        if self.on_gpu.is_some() {
            corpuscle_gpu::wait_for(self.advance_measured(time, stop, Observers::of(observer)))
        } else {
            advance_with(self, time, stop, observer)
        }
    }

    fn frame(&self) -> Frame {
        let since = self.since();
        let mut order: Vec<&Particle> = self.inside().collect();
        order.sort_unstable_by_key(|particle| particle.id);
        let count = order.len() + self.state.falling.len();
        let mut set = ParticleSet { name: "water".into(), ..ParticleSet::default() };
        let [mut depth, mut ground, mut speed] = [(); 3].map(|()| Vec::with_capacity(count));
        let radius = 0.5 * self.spacing_shown();
        let terrain = &self.surroundings.terrain;
        let on_ground = order.into_iter().map(|particle| {
            let (x, y) = (particle.x + since * particle.u, particle.y + since * particle.v);
            // What comes into an obstacle is put back before it is shown.
            let held = self.surroundings.obstacles.hold([x, y]);
            let (x, y) = if held { (particle.x, particle.y) } else { (x, y) };
            let height = terrain.height(x, y);
            (particle, [x, y, height + particle.depth], 0.0, height, particle.depth, radius)
        });
        let in_air = self.state.falling.iter().map(|drop| {
            let particle = &drop.particle;
            let height = terrain.height(particle.x, particle.y);
            (particle, [particle.x, particle.y, drop.z], drop.w, height, 0.0, 0.5 * self.spacing)
        });
        for (particle, position, w, height, deep, radius) in on_ground.chain(in_air) {
            set.id.push(particle.id);
            set.position.push(position);
            set.velocity.push([particle.u, particle.v, w]);
            set.radius.push(radius);
            set.mass.push(DENSITY * particle.volume);
            depth.push(deep);
            ground.push(height);
            speed.push(particle.speed());
        }
        set.columns = vec![
            Column { name: "depth", unit: "m", values: Values::Scalar(depth) },
            Column { name: "ground", unit: "m", values: Values::Scalar(ground) },
            Column { name: "speed", unit: "m/s", values: Values::Scalar(speed) },
        ];
        Frame { time: self.shown, sets: vec![set] }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        self.measured_columns()
    }

    fn gauge_row(&self) -> Vec<f64> {
        self.row(&self.reading())
    }

    fn maps(&self) -> Vec<Map> {
        self.state.maps.maps(&self.sampler(self.since()))
    }

    fn ledger(&self) -> Ledger {
        let water = self.state.water.balance("water_m3", self.stored());
        let momentum = self.state.momentum.balance("momentum", self.momentum());
        Ledger { balances: vec![water, momentum] }
    }

    fn warnings(&self) -> Vec<String> {
        let names = self.surroundings.obstacles.names.iter().zip(&self.state.overtopped);
        let warning = |(name, time): (&String, &Option<f64>)| {
            let time = (*time)?;
            Some(format!(
                "from t = {time:.0} s the water at the obstacle '{name}' stood higher than its height_m: it would have flowed over it, \
                 and was held back"
            ))
        };
        let terrain = self.surroundings.terrain.warnings().iter();
        terrain.chain(&self.state.warnings).cloned().chain(names.filter_map(warning)).collect()
    }

    fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&(self.shown, &self.state)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, state): (f64, State) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        if state.residual_volume.len() != self.sources.len()
            || [&state.impulses, &state.on_obstacles]
                .iter()
                .any(|of| of.len() != self.surroundings.obstacles.names.len())
            || state.overtopped.len() != self.surroundings.obstacles.names.len()
            || !state.maps.fit(&self.state.maps)
            || !self.can_be(&state)
        {
            return Err(refused("it belongs to another scene".into()));
        }
        let is_changed = self.state.overrides != Overrides::default() || state.overrides != Overrides::default();
        self.clear_overrides();
        (self.shown, self.state) = (shown, state);
        self.apply_overrides()?;
        self.arrange();
        if is_changed {
            return self.update_gpu();
        }
        #[cfg(feature = "gpu")]
        self.upload_to_gpu().map_err(|error| ModelError::Device(error.to_string()))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{SphSweFlood, State};
    use corpuscle_model::Model;
    use corpuscle_scene::{Flood, Scheme, Water};
    use corpuscle_terrain::{Bounds, Terrain};
    use std::path::Path;
    use std::sync::Arc;

    fn lake() -> SphSweFlood {
        let bounds = Bounds { x_min: 0.0, x_max: 40.0, y_min: 0.0, y_max: 30.0 };
        let terrain = Terrain::analytic(bounds, 1.0, |_, _| (0.0, [0.0; 2]));
        let water = Water { level_m: Some(2.0.into()), ..Water::default() };
        let settings = Flood {
            scheme: Scheme::SphSwe,
            spacing_m: Some(5.0),
            spacing_depth_m: Some(1.0),
            water: vec![water],
            map_every_s: Some(1.0),
            ..Flood::default()
        };
        SphSweFlood::new(&settings, 1, Path::new(""), Arc::new(terrain)).unwrap()
    }

    /// Particles that lie anywhere, or cells of any size, were sorted for ever.
    #[test]
    fn states_that_cannot_be_of_this_flood_are_refused() {
        let changes: [fn(&mut State); 8] = [
            |state| state.particles[0].x = 1e12,
            |state| state.particles[0].y = f64::NAN,
            |state| state.particles[0].h = 0.0,
            |state| state.particles[0].h = 1e12,
            |state| state.particles[0].outside = Some(4),
            |state| state.cell = 1e-12,
            |state| state.cell = f64::NAN,
            |state| state.overtopped.push(None),
        ];
        assert!(lake().restore(&lake().save()).is_ok());
        for (number, change) in changes.into_iter().enumerate() {
            let mut other = lake();
            change(&mut other.state);
            let error = lake().restore(&other.save()).expect_err(&number.to_string()).to_string();
            assert!(error.contains("belongs to another scene"), "{number}: {error}");
        }
    }
}

//! What a flood shows of itself.

use super::change::Overrides;
use super::{DENSITY, State, VoronoiFlood, maps};
#[cfg(feature = "gpu")]
use corpuscle_model::GpuModel;
use corpuscle_model::{
    Balance, Column, CpuOnly, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Values,
};
use std::sync::atomic::{AtomicBool, Ordering};

/// Water less deep than this part of the depth of wet ground is not shown as a particle.
pub(super) const SHOWN: f64 = 0.1;

/// Momentum that is a smaller part of that of all water, if it were as fast as waves, is what rounding leaves of the thrusts in a lake at rest.
const ROUNDING: f64 = 1e-9;

impl Model for VoronoiFlood {
    fn name(&self) -> &'static str {
        "flood"
    }

    fn cpu_only(&self) -> Option<CpuOnly> {
        #[cfg(feature = "gpu")]
        return self.on_cpu_only();
        #[cfg(not(feature = "gpu"))]
        Some(CpuOnly { what: "this program runs floods on the CPU only", remedy: "leave `--backend gpu` out" })
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
        self.solver.wet_cells() + self.state.falling.len()
    }

    fn backend(&self) -> &'static str {
        #[cfg(feature = "gpu")]
        if self.on_gpu.is_some() {
            return "gpu";
        }
        "cpu"
    }

    fn advance_to(&mut self, time: f64, stop: &AtomicBool) -> Result<(), ModelError> {
        #[cfg(feature = "gpu")]
        if self.on_gpu.is_some() {
            return corpuscle_gpu::wait_for(self.advance_on_gpu(time, stop));
        }
        // On a thread of the pool: from outside, each pass of a small flood would wait for one to wake up.
        rayon::scope(|_| {
            while self.state.time < time {
                if stop.load(Ordering::Relaxed) {
                    self.shown = self.shown.max(self.state.time);
                    return Ok(());
                }
                self.step()?;
            }
            self.shown = time;
            Ok(())
        })
    }

    fn frame(&self) -> Frame {
        let mesh = &self.solver.mesh;
        let least = SHOWN * self.settings.wet_depth_m;
        let wet = (0..mesh.len()).map(|cell| (cell, self.water_shown(cell))).filter(|(_, water)| water.depth > least);
        let mut wet: Vec<_> = wet.collect();
        wet.sort_unstable_by_key(|(cell, _)| mesh.point[*cell]);
        let count = wet.len() + self.state.falling.len();
        let mut set = ParticleSet { name: "water".into(), ..ParticleSet::default() };
        let [mut depth, mut ground, mut speed] = [(); 3].map(|()| Vec::with_capacity(count));
        for (cell, water) in wet {
            let [x, y] = mesh.centroid[cell];
            let [u, v] = water.velocity;
            set.id.push(mesh.point[cell]);
            set.position.push([x, y, water.level]);
            set.velocity.push([u, v, 0.0]);
            set.radius.push(0.5 * mesh.area[cell].sqrt());
            set.mass.push(DENSITY * water.depth * mesh.area[cell]);
            depth.push(water.depth);
            ground.push(mesh.bed[cell]);
            speed.push(water.speed());
        }
        for drop in &self.state.falling {
            let [x, y, _] = drop.position;
            set.id.push(drop.id);
            set.position.push(drop.position);
            set.velocity.push(drop.velocity);
            set.radius.push(0.5 * mesh.layout.spacing());
            set.mass.push(DENSITY * drop.volume);
            depth.push(0.0);
            ground.push(self.terrain.height(x, y));
            speed.push(drop.velocity[0].hypot(drop.velocity[1]));
        }
        set.columns = vec![
            Column { name: "depth", unit: "m", values: Values::Scalar(depth) },
            Column { name: "ground", unit: "m", values: Values::Scalar(ground) },
            Column { name: "speed", unit: "m/s", values: Values::Scalar(speed) },
        ];
        Frame { time: self.shown, sets: vec![set] }
    }

    fn gauge_columns(&self) -> Vec<GaugeColumn> {
        self.columns()
    }

    fn gauge_row(&self) -> Vec<f64> {
        self.row()
    }

    fn maps(&self) -> Vec<Map> {
        let water = |cell: usize| self.water_shown(cell);
        let mesh = &self.solver.mesh;
        let mut maps = maps::maps(mesh, &self.terrain, &self.state.records, &water, self.settings.wet_depth_m);
        maps.extend(self.weather.as_ref().and_then(|weather| weather.map(mesh, &self.terrain, &self.state.soaked)));
        maps
    }

    fn ledger(&self) -> Ledger {
        let water = self.state.water.balance("water_m3", self.stored());
        let momentum = Balance {
            least: ROUNDING * self.momentum_of_waves(),
            ..self.state.momentum.balance("momentum", self.momentum())
        };
        Ledger { balances: vec![water, momentum] }
    }

    fn warnings(&self) -> Vec<String> {
        self.terrain.warnings().iter().chain(&self.state.warnings).cloned().collect()
    }

    fn save(&self) -> Vec<u8> {
        let state = State {
            tiles: self.solver.mesh.made.clone(),
            blocks: self.solver.mesh.layout.blocks().finer(),
            columns: [self.solver.columns.clone(), self.solver.before().to_vec()],
            ..self.state.clone()
        };
        postcard::to_stdvec(&(self.shown, &state)).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, mut state): (f64, State) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        let other = || refused("it belongs to another scene".into());
        let tiles = &self.solver.mesh.layout.tiles;
        if state.tiles.iter().any(|tile| *tile as usize >= tiles[0] * tiles[1]) || !self.structures.fit(&state.flows) {
            return Err(other());
        }
        // The tiles that a model without water has made come first, and in any state of this scene too.
        let made = self.solver.mesh.made.len().min(state.tiles.len());
        if self.solver.mesh.made[..made] != state.tiles[..made] || self.solver.mesh.made.len() > state.tiles.len() {
            return Err(other());
        }
        if !self.restore_blocks(&state.blocks)? {
            return Err(other());
        }
        for tile in state.tiles.split_off(made) {
            self.make_tiles(vec![tile as usize])?;
        }
        let [now, before] = std::mem::take(&mut state.columns);
        let cells = self.solver.mesh.len();
        if now.len() != cells || before.len() != cells || state.records.len() != cells {
            return Err(other());
        }
        let obstacles = self.settings.obstacle.len();
        if state.beyond.len() != self.solver.borders.len()
            || [&state.impulses, &state.forces].iter().any(|of| of.len() != obstacles)
        {
            return Err(other());
        }
        if self.state.overrides != Overrides::default() || state.overrides != Overrides::default() {
            self.clear_overrides();
            self.state.overrides = state.overrides.clone();
            self.apply_overrides()?;
        }
        self.solver.columns = now;
        *self.solver.before_mut() = before;
        (self.shown, self.state) = (shown, state);
        self.solver.refresh_water();
        if self.state.steps > 0 {
            self.solver.plan();
        }
        #[cfg(feature = "gpu")]
        self.mark_stale_on_gpu();
        Ok(())
    }
}

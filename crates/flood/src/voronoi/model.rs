//! What a flood shows of itself.

use super::change::Overrides;
use super::domain::{self, Domain};
use super::{DENSITY, State, VoronoiFlood, maps};
#[cfg(feature = "gpu")]
use corpuscle_model::GpuModel;
use corpuscle_model::{
    Balance, Column, CpuOnly, Frame, GaugeColumn, Ledger, Map, Model, ModelError, ParticleSet, Values,
};
use corpuscle_processes::Command;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};

/// Water less deep than this part of the depth of wet ground is not shown as a particle.
pub(super) const SHOWN: f64 = 0.1;

/// Momentum that is a smaller part of that of all water, if it were as fast as waves, is what rounding leaves of the thrusts in a lake at rest.
const ROUNDING: f64 = 1e-9;

/// A wet cell as a frame shows it.
#[derive(Serialize, Deserialize)]
struct Shown {
    point: u64,
    centroid: [f64; 2],
    area: f64,
    bed: f64,
    /// Depth, level, and velocity.
    water: [f64; 4],
}

impl VoronoiFlood {
    /// Sends a command to the other processes, if there are any.
    pub(super) fn broadcast(&self, command: &Command) {
        if let Some(domain) = &self.solver.domain {
            domain.processes.broadcast(command);
        }
    }

    /// The wet cells of all processes, at the first, in the order of their points.
    fn wet_shown(&self) -> Vec<Shown> {
        let (mesh, domain) = (&self.solver.mesh, self.solver.domain.as_ref());
        let least = SHOWN * self.settings.wet_depth_m;
        let own = (0..mesh.len()).filter(|cell| self.solver.owns(*cell));
        let wet = own.map(|cell| (cell, self.water_shown(cell))).filter(|(_, water)| water.depth > least);
        let shown = wet.map(|(cell, water)| Shown {
            point: mesh.point[cell],
            centroid: mesh.centroid[cell],
            area: mesh.area[cell],
            bed: mesh.bed[cell],
            water: [water.depth, water.level, water.velocity[0], water.velocity[1]],
        });
        let mut shown: Vec<Shown> = shown.collect();
        if let Some(domain) = domain {
            shown = domain.processes.gather(shown).into_iter().flatten().collect();
        }
        shown.sort_unstable_by_key(|cell| cell.point);
        shown
    }
}

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
        self.broadcast(&Command::Advance(time));
        // On a thread of the pool: from outside, each pass of a small flood would wait for one to wake up.
        rayon::scope(|_| {
            while self.state.time < time {
                if domain::any(self.solver.domain.as_ref(), stop.load(Ordering::Relaxed)) {
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
        self.broadcast(&Command::Frame);
        let mesh = &self.solver.mesh;
        let wet = self.wet_shown();
        let count = wet.len() + self.state.falling.len();
        let mut set = ParticleSet { name: "water".into(), ..ParticleSet::default() };
        let [mut depth, mut ground, mut speed] = [(); 3].map(|()| Vec::with_capacity(count));
        for Shown { point, centroid: [x, y], area, bed, water: [own_depth, level, u, v] } in wet {
            set.id.push(point);
            set.position.push([x, y, level]);
            set.velocity.push([u, v, 0.0]);
            set.radius.push(0.5 * area.sqrt());
            set.mass.push(DENSITY * own_depth * area);
            depth.push(own_depth);
            ground.push(bed);
            speed.push((u * u + v * v).sqrt());
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
        let mut maps = Vec::new();
        self.each_map(&|_| true, &mut |map| maps.push(map));
        maps
    }

    fn each_map(&self, is_wanted: &dyn Fn(&str) -> bool, take: &mut dyn FnMut(Map)) {
        self.broadcast(&Command::Maps);
        let water = |cell: usize| self.water_shown(cell);
        let mesh = &self.solver.mesh;
        let domain = self.solver.domain.as_ref();
        let (rest, wet_depth) = (self.rest_of_step(), self.settings.wet_depth_m);
        let wet = maps::wet(mesh, &self.terrain, &self.state.records, &water, rest, wet_depth, domain);
        if let Some(wet) = wet {
            wet.each_map(is_wanted, take);
        }
        let soaked = &self.state.soaked;
        let soaked = self.weather.as_ref().and_then(|weather| weather.map(mesh, &self.terrain, soaked, domain));
        soaked.into_iter().filter(|map| is_wanted(map.name)).for_each(take);
    }

    fn ledger(&self) -> Ledger {
        self.broadcast(&Command::Ledger);
        let ([water, momentum, _], _) = self.booked();
        let water = water.balance("water_m3", self.stored());
        let momentum = momentum.balance("momentum", self.momentum());
        let momentum = Balance { least: ROUNDING * self.momentum_of_waves(), ..momentum };
        Ledger { balances: vec![water, momentum] }
    }

    fn warnings(&self) -> Vec<String> {
        self.terrain.warnings().iter().chain(&self.state.warnings).cloned().collect()
    }

    fn save(&self) -> Vec<u8> {
        self.broadcast(&Command::Save);
        postcard::to_stdvec(&(self.shown, &self.gathered_state())).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ModelError> {
        if self.solver.domain.as_ref().is_some_and(Domain::is_first) {
            self.broadcast(&Command::Restore(state.to_vec()));
        }
        let refused = |what: String| ModelError::Checkpoint(what);
        let (shown, mut state): (f64, State) =
            postcard::from_bytes(state).map_err(|error| refused(format!("its bytes are damaged ({error})")))?;
        let other = || refused("it belongs to another scene".into());
        // Before any cells are made, of which a forged state could need far more than it has.
        let tiles = self.solver.mesh.layout.tiles;
        if !state.is_consistent(tiles[0] * tiles[1], self.settings.obstacle.len()) || !self.structures.fit(&state.flows)
        {
            return Err(other());
        }
        if !shown.is_finite() || !state.is_finite() {
            return Err(refused("it holds a value that is not a number".into()));
        }
        // The tiles that a model without water has made come first, and in any state of this scene too.
        let made = self.tiles().len().min(state.tiles.len());
        if self.tiles()[..made] != state.tiles[..made] || self.tiles().len() > state.tiles.len() {
            return Err(other());
        }
        if self.solver.domain.is_some() {
            self.restore_part(state)?;
            self.shown = shown;
            return Ok(());
        }
        if !self.restore_blocks(&state.blocks)? {
            return Err(other());
        }
        for tile in state.tiles.split_off(made) {
            self.make_tiles(vec![tile as usize])?;
            if self.solver.mesh.len() > state.records.len() {
                return Err(other());
            }
        }
        let [now, before] = std::mem::take(&mut state.columns);
        let cells = self.solver.mesh.len();
        if now.len() != cells || before.len() != cells || state.records.len() != cells {
            return Err(other());
        }
        if state.beyond.len() != self.solver.borders.len() {
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

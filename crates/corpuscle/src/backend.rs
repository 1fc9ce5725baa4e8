//! Automatic choice of the backend.

use crate::Simulation;
use corpuscle_gpu::{Gpu, GpuError, GpuKind};
use corpuscle_scene::Scheme;

/// Fewest particles, with those to come, for which the GPU is chosen. A step is some twenty kernels, one after
/// another, of five to ten microseconds each however few particles there are: 0.2 ms at most. In that time one core
/// takes 200 to 300 steps of a particle (1.3 million a second, see the guide's benchmarks), 16 cores some 4000. A GPU
/// has not been measured yet.
pub const FEWEST_ON_GPU: usize = 10_000;

/// Why floods of scheme voronoi stay on the CPU by default: their speed on a GPU has not been measured yet.
const VORONOI: &str = "scheme voronoi runs on the CPU unless `--backend gpu` is given";

/// The CPU that a GPU is weighed against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cpu {
    /// All its cores take steps.
    AllCores,
    /// One core takes steps, as in a browser. Scheme voronoi is not left to it where there is a GPU.
    OneCore,
}

/// A choice of the backend, with its reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choice {
    /// True for the GPU, false for the CPU.
    pub is_gpu: bool,
    /// The reason, as text; empty where there is no GPU to choose.
    pub why: String,
}

impl Simulation {
    /// Chooses the GPU where there is one, it can compute this scene, and the scene is or becomes
    /// large enough for it, by an estimate of the water to come; else the CPU. Software in place of a
    /// GPU is slower than the CPU's own program, and never chosen.
    pub fn use_best(&mut self) -> Choice {
        self.use_best_of(Cpu::AllCores, Gpu::open)
    }

    /// The same with a device that is open, weighed against a CPU.
    pub fn use_best_on(&mut self, gpu: &Gpu, cpu: Cpu) -> Choice {
        self.use_best_of(cpu, || Ok(gpu.clone()))
    }

    /// Why the CPU takes the steps of this scene whatever GPU there is, as text; none where a GPU may be chosen.
    pub fn why_on_cpu(&self, cpu: Cpu) -> Option<String> {
        if let Some(cpu_only) = self.model().cpu_only() {
            return Some(cpu_only.what.into());
        }
        let is_voronoi = self.scene().flood().is_some_and(|scene| scene.flood.scheme == Scheme::Voronoi);
        if is_voronoi && cpu == Cpu::AllCores {
            return Some(VORONOI.into());
        }
        let particles = self.model().particles() as f64 + self.particles_to_come();
        let is_small = particles < FEWEST_ON_GPU as f64;
        is_small.then(|| format!("the scene is small: {}", self.particles_in_words()))
    }

    fn use_best_of(&mut self, cpu: Cpu, open: impl FnOnce() -> Result<Gpu, GpuError>) -> Choice {
        let name = match self.why_on_cpu(cpu) {
            None => self.try_gpu(open),
            Some(why) => Err(why),
        };
        match name {
            Ok(name) => Choice { is_gpu: true, why: format!("{name}, {}", self.particles_in_words()) },
            Err(why) => Choice { is_gpu: false, why },
        }
    }

    /// The name of the GPU that takes the steps now, or why none does.
    fn try_gpu(&mut self, open: impl FnOnce() -> Result<Gpu, GpuError>) -> Result<String, String> {
        let gpu = match open() {
            Ok(gpu) if gpu.kind != GpuKind::Software => gpu,
            Ok(_) | Err(GpuError::NoDevice) => return Err(String::new()),
            Err(error) => return Err(error.to_string()),
        };
        let device = gpu.name.clone();
        self.use_this_gpu(gpu).map_err(|error| error.to_string())?;
        Ok(device)
    }

    fn particles_in_words(&self) -> String {
        let (now, to_come) = (self.model().particles(), self.particles_to_come().round());
        if to_come > 0.0 { format!("{now} particles and about {to_come} to come") } else { format!("{now} particles") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::require_gpu;
    use corpuscle_scene::{Scene, builtin};
    use std::path::Path;

    /// A flood by scheme sph-swe with particles so far apart in water so deep, m.
    fn open(name: &str, [spacing, depth]: [&str; 2]) -> Simulation {
        let set = [("flood.scheme", "sph-swe"), ("flood.spacing_m", spacing), ("flood.spacing_depth_m", depth)];
        let set = set.map(|(path, value)| (path.to_owned(), value.to_owned()));
        let scene = Scene::parse(builtin(name).unwrap().text, name, &set).unwrap();
        Simulation::open(scene, Path::new("")).unwrap()
    }

    #[test]
    fn a_gpu_takes_a_large_flood_and_software_in_its_place_does_not() {
        let Some(gpu) = require_gpu("the choice of a backend") else { return };
        let with_kind = |kind| {
            let mut gpu = gpu.clone();
            gpu.kind = kind;
            gpu
        };
        let mut flood = open("flood/dam-break", ["1", "10"]);
        let count = flood.model().particles();
        assert!(count >= FEWEST_ON_GPU, "{count} particles");
        let choice = flood.use_best_of(Cpu::AllCores, || Ok(with_kind(GpuKind::Software)));
        assert!(!choice.is_gpu && choice.why.is_empty(), "{choice:?}");
        assert_eq!(flood.model().backend(), "cpu");
        let choice = flood.use_best_of(Cpu::AllCores, || Err(GpuError::NoDevice));
        assert!(!choice.is_gpu && choice.why.is_empty(), "{choice:?}");
        let refused = || GpuError::Refused { name: "a GPU".into(), reason: "busy".into() };
        let choice = flood.use_best_of(Cpu::AllCores, || Err(refused()));
        assert!(!choice.is_gpu && choice.why.contains("busy"), "{choice:?}");
        let choice = flood.use_best_of(Cpu::AllCores, || Ok(with_kind(GpuKind::Hardware)));
        assert!(
            choice.is_gpu && choice.why.contains(&gpu.name) && choice.why.contains(&count.to_string()),
            "{choice:?}"
        );
        assert_eq!(flood.model().backend(), "gpu");
    }

    #[test]
    fn the_cpu_takes_what_a_gpu_does_not_compute() {
        let Some(gpu) = require_gpu("the choice of a backend") else { return };
        let mut hardware = gpu;
        hardware.kind = GpuKind::Hardware;
        let rate = [("flood.sph_swe.smoothing".to_owned(), "rate".to_owned())];
        let scene = Scene::parse(builtin("flood/rough-terrain").unwrap().text, "rough", &rate).unwrap();
        let mut flood = Simulation::open(scene, Path::new("")).unwrap();
        let choice = flood.use_best_of(Cpu::AllCores, || Ok(hardware));
        assert!(!choice.is_gpu && choice.why.contains("smoothing = \"rate\""), "{choice:?}");
        assert_eq!(flood.model().backend(), "cpu");
    }

    #[test]
    fn small_floods_those_by_voronoi_and_gases_do_not_ask_for_a_gpu() {
        let gas = Scene::parse(builtin("gas/maxwell").unwrap().text, "gas/maxwell", &[]).unwrap();
        let gas = Simulation::open(gas, Path::new("")).unwrap();
        let voronoi = Scene::parse(builtin("flood/dam-break").unwrap().text, "flood/dam-break", &[]).unwrap();
        let voronoi = Simulation::open(voronoi, Path::new("")).unwrap();
        assert!(voronoi.model().particles() >= FEWEST_ON_GPU);
        let small = open("flood/dam-break", ["2", "10"]);
        for (mut simulation, word) in [(small, "is small"), (gas, "the gas model"), (voronoi, "scheme voronoi")] {
            let choice = simulation.use_best_of(Cpu::AllCores, || panic!("a GPU is asked for"));
            assert!(!choice.is_gpu && choice.why.contains(word), "{choice:?}");
            assert_eq!(simulation.model().backend(), "cpu");
            assert!(!choice.why.contains("GPU"), "{choice:?}");
        }
    }

    #[test]
    fn one_core_leaves_voronoi_to_a_gpu() {
        let scene = Scene::parse(builtin("flood/dam-break").unwrap().text, "flood/dam-break", &[]).unwrap();
        let flood = Simulation::open(scene, Path::new("")).unwrap();
        assert!(flood.why_on_cpu(Cpu::AllCores).is_some_and(|why| why.contains("scheme voronoi")));
        assert_eq!(flood.why_on_cpu(Cpu::OneCore), None);
        let gas = Scene::parse(builtin("gas/maxwell").unwrap().text, "gas/maxwell", &[]).unwrap();
        let gas = Simulation::open(gas, Path::new("")).unwrap();
        assert!(gas.why_on_cpu(Cpu::OneCore).is_some_and(|why| why.contains("the gas model")));
    }

    /// Nothing is there at the start; 34,166 particles come in over the run.
    #[test]
    fn water_that_is_to_come_counts() {
        let mut valley = open("flood/valley", ["4", "1.5"]);
        let to_come = valley.particles_to_come();
        assert!(valley.model().particles() == 0 && to_come > FEWEST_ON_GPU as f64, "{to_come}");
        let mut is_asked = false;
        let choice = valley.use_best_of(Cpu::AllCores, || {
            is_asked = true;
            Err(GpuError::NoDevice)
        });
        assert!(is_asked && !choice.is_gpu && choice.why.is_empty(), "{choice:?}");
    }
}

//! Where the steps are taken, where nobody says.

use crate::Simulation;
use corpuscle_gpu::{Gpu, GpuError, GpuKind};

/// Fewer particles than this at the start are no work for a card. A step is some twenty kernels, one after another, of five to ten
/// microseconds each however few particles there are: 0.2 ms at most. In that time one core takes 200 to 300 steps of a particle
/// (1.3 million a second, see the guide's benchmarks), 16 cores some 4000. A card has not been measured yet.
pub const FEWEST_ON_CARD: usize = 10_000;

/// Where steps are taken, and why there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Choice {
    /// On the graphics card; else on the processor.
    pub is_gpu: bool,
    /// Why, in words.
    pub why: String,
}

impl Simulation {
    /// Lets a graphics card take the steps where there is one, it can compute this scene, and the scene is large enough for it; the
    /// processor elsewhere. Software in place of a card is slower than the processor's own program, and never chosen.
    pub fn use_best(&mut self) -> Choice {
        self.use_best_of(Gpu::open)
    }

    /// The same with a device that is open.
    pub fn use_best_on(&mut self, gpu: &Gpu) -> Choice {
        self.use_best_of(|| Ok(gpu.clone()))
    }

    fn use_best_of(&mut self, open: impl FnOnce() -> Result<Gpu, GpuError>) -> Choice {
        match self.try_card(open) {
            Ok(name) => Choice { is_gpu: true, why: format!("{name}, {} particles", self.model().particles()) },
            Err(why) => Choice { is_gpu: false, why },
        }
    }

    /// The name of the card that takes the steps now, or why none does.
    fn try_card(&mut self, open: impl FnOnce() -> Result<Gpu, GpuError>) -> Result<String, String> {
        let (name, particles) = (self.model().name(), self.model().particles());
        if name == "gas" {
            return Err("a gas computes nowhere else".into());
        }
        if particles < FEWEST_ON_CARD {
            return Err(format!(
                "{particles} particles at the start are too few for a graphics card, which takes {FEWEST_ON_CARD} or more"
            ));
        }
        let gpu = open().map_err(|_| "there is no graphics card".to_owned())?;
        if gpu.kind == GpuKind::Software {
            return Err(format!("there is no graphics card, only software in its place ({})", gpu.name));
        }
        let device = gpu.name.clone();
        self.use_this_gpu(gpu).map_err(|error| error.to_string())?;
        Ok(device)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use corpuscle_gpu::require_gpu;
    use corpuscle_scene::{Scene, builtin};
    use std::path::Path;

    fn open(name: &str, spacing_m: &str) -> Simulation {
        let finer = [("flood.spacing_m".to_owned(), spacing_m.to_owned())];
        let scene = Scene::parse(builtin(name).unwrap().text, name, &finer).unwrap();
        Simulation::open(scene, Path::new("")).unwrap()
    }

    #[test]
    fn a_card_takes_a_large_flood_and_software_in_its_place_does_not() {
        let Some(gpu) = require_gpu("the choice of a backend") else { return };
        let with_kind = |kind| {
            let mut gpu = gpu.clone();
            gpu.kind = kind;
            gpu
        };
        let mut flood = open("flood/dam-break", "1");
        let count = flood.model().particles();
        assert!(count >= FEWEST_ON_CARD, "{count} particles");
        let choice = flood.use_best_of(|| Ok(with_kind(GpuKind::Software)));
        assert!(!choice.is_gpu && choice.why.contains("only software") && choice.why.contains(&gpu.name), "{choice:?}");
        assert_eq!(flood.model().backend(), "cpu");
        let choice = flood.use_best_of(|| Err(GpuError::NoDevice));
        assert!(!choice.is_gpu && choice.why.contains("no graphics card"), "{choice:?}");
        let choice = flood.use_best_of(|| Ok(with_kind(GpuKind::Card)));
        assert!(
            choice.is_gpu && choice.why.contains(&gpu.name) && choice.why.contains(&count.to_string()),
            "{choice:?}"
        );
        assert_eq!(flood.model().backend(), "gpu");
    }

    #[test]
    fn small_floods_and_gases_do_not_ask_for_a_card() {
        let gas = Scene::parse(builtin("gas/maxwell").unwrap().text, "gas/maxwell", &[]).unwrap();
        let gas = Simulation::open(gas, Path::new("")).unwrap();
        for (mut simulation, word) in [(open("flood/dam-break", "2"), "too few"), (gas, "a gas")] {
            let choice = simulation.use_best_of(|| panic!("a card is asked for"));
            assert!(!choice.is_gpu && choice.why.contains(word), "{choice:?}");
            assert_eq!(simulation.model().backend(), "cpu");
        }
    }
}

//! Random valid scenes, made from the types of a scene: each key of a model is named here, so that a new one does not compile until it is made too.

mod dew;
mod flood;
mod gas;
mod trial;

pub use trial::{Finding, Trial, shorter, try_scene};

use crate::random::Random;
use corpuscle_scene::{Run, Series};
use serde::Serialize;

/// The models of which scenes are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Hard balls.
    Gas,
    /// Humid air.
    Dew,
    /// Scheme voronoi.
    Voronoi,
    /// Scheme sph-swe.
    SphSwe,
    /// A closed basin with water at one level, or in motion, and nothing that adds energy.
    Lake,
}

impl Kind {
    /// All of them, by name.
    pub const ALL: [(&'static str, Self); 5] = [
        ("gas", Self::Gas),
        ("dew", Self::Dew),
        ("voronoi", Self::Voronoi),
        ("sph-swe", Self::SphSwe),
        ("lake", Self::Lake),
    ];
}

/// Makes random choices; those with a number in `off` fall to the plain side.
pub struct Maker<'a> {
    /// The numbers.
    pub random: Random,
    off: &'a [usize],
    next: usize,
}

impl<'a> Maker<'a> {
    /// A maker with a seed; `off` are numbers of optional features that are left out.
    pub fn new(seed: u64, off: &'a [usize]) -> Self {
        Self { random: Random::new(seed), off, next: 0 }
    }

    /// How many optional features were asked about.
    pub fn asked(&self) -> usize {
        self.next
    }

    /// Whether the next optional feature is in the scene.
    fn has(&mut self, probability: f64) -> bool {
        let number = self.next;
        self.next += 1;
        self.random.chance(probability) && !self.off.contains(&number)
    }

    /// What is made, in the scene or not: the same numbers are drawn in both cases.
    fn maybe<T>(&mut self, probability: f64, make: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let is_in = self.has(probability);
        let made = make(self);
        is_in.then_some(made)
    }

    fn list<T>(&mut self, probability: f64, most: usize, mut make: impl FnMut(&mut Self, usize) -> T) -> Vec<T> {
        (0..most).filter_map(|number| self.maybe(probability, |maker| make(maker, number))).collect()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        // Few digits, so that a scene can be read.
        let number = self.random.between(low, high);
        format!("{number:.3e}").parse::<f64>().unwrap_or(number).clamp(low, high)
    }

    fn one_of<T: Clone>(&mut self, of: &[T]) -> T {
        self.random.one_of(of).clone()
    }

    fn series(&mut self, low: f64, high: f64, until: f64) -> Series {
        let (a, b, c) = (self.between(low, high), self.between(low, high), self.between(low, high));
        match self.random.below(3) {
            0 | 1 => Series::Constant(a),
            _ => Series::Table(vec![[0.0, a], [0.3 * until, b], [until, c]]),
        }
    }
}

/// A scene of a kind as text.
pub fn scene(kind: Kind, seed: u64, off: &[usize]) -> (String, usize) {
    let mut maker = Maker::new(seed, off);
    let text = match kind {
        Kind::Gas => gas::scene(&mut maker),
        Kind::Dew => dew::scene(&mut maker),
        Kind::Voronoi => flood::scene(&mut maker, false),
        Kind::SphSwe => flood::scene(&mut maker, true),
        Kind::Lake => flood::lake(&mut maker),
    };
    (text, maker.asked())
}

/// Text of a scene with these tables.
fn text(maker: &mut Maker<'_>, until_s: f64, tables: &[(&str, &dyn erased::Table)]) -> String {
    let run = Run {
        until_s,
        frame_every_s: maker.maybe(0.2, |maker| maker.between(0.001, 1.0) * until_s),
        gauge_every_s: maker.maybe(0.2, |maker| maker.between(0.001, 1.0) * until_s),
        checkpoint_every_wall_s: 60.0,
    };
    let seed = maker.random.bits();
    let mut whole = toml::Table::new();
    let value = |table: &dyn erased::Table| table.value();
    whole.insert("seed".into(), toml::Value::Integer((seed % 1_000_000) as i64));
    whole.insert("run".into(), value(&run));
    for (name, table) in tables {
        whole.insert((*name).into(), value(*table));
    }
    toml::to_string(&whole).expect("a scene can be written")
}

/// Tables of different types.
mod erased {
    pub trait Table {
        fn value(&self) -> toml::Value;
    }

    impl<T: super::Serialize> Table for T {
        fn value(&self) -> toml::Value {
            toml::Value::try_from(self).expect("a table can be written")
        }
    }
}

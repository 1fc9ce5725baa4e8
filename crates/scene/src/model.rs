//! The part of a scene that belongs to one model, and the registered models.

use crate::builtin::{DEW, FLOOD, GAS};
use crate::check::{Check, Checked};
use crate::{Builtin, Dew, FloodScene, Gas, Problem, Run, Scene};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::any::Any;
use std::fmt;
use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};
use toml::de::{DeTable, ValueDeserializer};

/// What a scene says of its model: the table of that name, as it is in memory.
///
/// It is read and written by serde; `#[serde(deny_unknown_fields)]` makes it refuse unknown keys with their line.
pub trait ModelScene: fmt::Debug + Clone + PartialEq + Serialize + DeserializeOwned + Send + Sync + 'static {
    /// Name of the model and of its table, as in `[gas]`.
    const NAME: &'static str;

    /// Names of its tables at the top of a scene file; most models have one.
    const TABLES: &'static [&'static str] = &[Self::NAME];

    /// Reads its tables.
    ///
    /// # Errors
    /// [`ReadError`], for a table that is missing, or a value that is not of its type.
    fn read(tables: &mut Tables<'_>) -> Result<Self, ReadError> {
        tables.read(Self::NAME)
    }

    /// Its tables as they are written, in the order of [`ModelScene::TABLES`].
    fn tables(&self) -> Vec<&dyn erased_serde::Serialize> {
        vec![self]
    }

    /// Checks its values beyond their types.
    ///
    /// # Errors
    /// The key and value of the first error: see [`Check`].
    fn check(&self, _check: &Check) -> Checked {
        Ok(())
    }

    /// Fills in what was left out and depends on nothing but the scene.
    fn resolve_defaults(&mut self, _run: &Run) {}

    /// The files that it names.
    fn paths(&mut self) -> Vec<&mut PathBuf> {
        Vec::new()
    }
}

/// The tables of a scene file, to be read by its model.
pub struct Tables<'a>(pub(crate) DeTable<'a>);

/// Why the tables of a model cannot be read.
#[derive(Debug)]
pub enum ReadError {
    /// A value is not of its type.
    Type(toml::de::Error),
    /// Something in them is not as it must be.
    Problem(Box<Problem>),
}

impl Tables<'_> {
    /// Whether there is a table of a name.
    pub fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    /// Reads the table of a name.
    ///
    /// # Errors
    /// [`ReadError`] where there is none, or a value in it is not of its type.
    pub fn read<T: DeserializeOwned>(&mut self, name: &str) -> Result<T, ReadError> {
        let missing = || ReadError::Problem(Problem::new(name, format!(" is missing: give a table [{name}]")));
        let table = self.0.remove(name).ok_or_else(missing)?;
        T::deserialize(ValueDeserializer::from(table)).map_err(ReadError::Type)
    }
}

/// A model that scene files may name: see [`register`].
#[derive(Clone, Copy)]
pub struct SceneKind {
    /// Name of the model.
    pub name: &'static str,
    /// Names of its tables.
    pub tables: &'static [&'static str],
    /// Scenes of it that come with the program.
    pub scenes: &'static [Builtin],
    read: fn(&mut Tables<'_>) -> Result<ModelTables, ReadError>,
}

impl SceneKind {
    /// The gas.
    pub const GAS: Self = Self::of::<Gas>(GAS);

    /// The flood.
    pub const FLOOD: Self = Self::of::<FloodScene>(FLOOD);

    /// Dew.
    pub const DEW: Self = Self::of::<Dew>(DEW);

    /// A model whose tables are `T`, and the scenes of it that come with the program.
    pub const fn of<T: ModelScene>(scenes: &'static [Builtin]) -> Self {
        Self { name: T::NAME, tables: T::TABLES, scenes, read: |tables| Ok(ModelTables::new(T::read(tables)?)) }
    }

    pub(crate) fn read(&self, tables: &mut Tables<'_>) -> Result<ModelTables, ReadError> {
        (self.read)(tables)
    }
}

/// The models that are registered from the start.
const OWN: [SceneKind; 3] = [SceneKind::GAS, SceneKind::FLOOD, SceneKind::DEW];

static ADDED: RwLock<Vec<SceneKind>> = RwLock::new(Vec::new());

/// Registers one more model for scene files of this process. Nothing changes where one of that name is registered.
pub fn register(kind: SceneKind) {
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    if OWN.iter().chain(&*added).all(|known| known.name != kind.name) {
        added.push(kind);
    }
}

/// The registered models.
pub fn kinds() -> Vec<SceneKind> {
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    OWN.iter().chain(&*added).copied().collect()
}

/// [`ModelScene`] of any model.
trait AnyModelScene: Any + fmt::Debug + Send + Sync {
    fn name(&self) -> &'static str;
    fn table_names(&self) -> &'static [&'static str];
    fn tables(&self) -> Vec<&dyn erased_serde::Serialize>;
    fn check(&self, check: &Check) -> Checked;
    fn resolve_defaults(&mut self, run: &Run);
    fn paths(&mut self) -> Vec<&mut PathBuf>;
    fn copy(&self) -> Box<dyn AnyModelScene>;
    fn equals(&self, other: &dyn AnyModelScene) -> bool;
}

impl<T: ModelScene> AnyModelScene for T {
    fn name(&self) -> &'static str {
        T::NAME
    }

    fn table_names(&self) -> &'static [&'static str] {
        T::TABLES
    }

    fn tables(&self) -> Vec<&dyn erased_serde::Serialize> {
        ModelScene::tables(self)
    }

    fn check(&self, check: &Check) -> Checked {
        ModelScene::check(self, check)
    }

    fn resolve_defaults(&mut self, run: &Run) {
        ModelScene::resolve_defaults(self, run);
    }

    fn paths(&mut self) -> Vec<&mut PathBuf> {
        ModelScene::paths(self)
    }

    fn copy(&self) -> Box<dyn AnyModelScene> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn AnyModelScene) -> bool {
        (other as &dyn Any).downcast_ref::<T>() == Some(self)
    }
}

/// The tables of the model of a scene: those of one model.
#[derive(Debug)]
pub struct ModelTables(Box<dyn AnyModelScene>);

impl ModelTables {
    /// Those of a model.
    pub fn new<T: ModelScene>(tables: T) -> Self {
        Self(Box::new(tables))
    }

    /// Name of the model.
    pub fn name(&self) -> &'static str {
        self.0.name()
    }

    /// The tables, where they are of this model.
    pub fn get<T: ModelScene>(&self) -> Option<&T> {
        (&*self.0 as &dyn Any).downcast_ref()
    }

    /// The tables, where they are of this model, to be changed.
    pub fn get_mut<T: ModelScene>(&mut self) -> Option<&mut T> {
        (&mut *self.0 as &mut dyn Any).downcast_mut()
    }

    /// Names and values of the tables as they are written.
    pub(crate) fn written(&self) -> impl Iterator<Item = (&'static str, &dyn erased_serde::Serialize)> {
        self.0.table_names().iter().copied().zip(self.0.tables())
    }

    pub(crate) fn check(&self, check: &Check) -> Checked {
        self.0.check(check)
    }

    pub(crate) fn resolve_defaults(&mut self, run: &Run) {
        self.0.resolve_defaults(run);
    }

    pub(crate) fn paths(&mut self) -> Vec<&mut PathBuf> {
        self.0.paths()
    }
}

impl Clone for ModelTables {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

impl PartialEq for ModelTables {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(&*other.0)
    }
}

impl Scene {
    /// The flood and its ground, where the scene is one of a flood.
    pub fn flood(&self) -> Option<&FloodScene> {
        self.model.get()
    }

    /// The gas, where the scene is one of a gas.
    pub fn gas(&self) -> Option<&Gas> {
        self.model.get()
    }

    /// The air and its solids, where the scene is one of dew.
    pub fn dew(&self) -> Option<&Dew> {
        self.model.get()
    }
}

//! The models of the workbench: how the scenes of each are opened, recorded, shown and changed.
//!
//! [`ModelKind`] is what the workbench needs of a model beside its physics; [`register`] adds one.

pub(crate) mod dew;
pub(crate) mod flood;
pub(crate) mod gas;

use crate::Error;
use crate::parameters::{Builder, Control};
#[cfg(feature = "pictures")]
use crate::pictures::{DrawContext, Particles, PictureSettings, Scenery, Sketcher, Subject};
#[cfg(feature = "pictures")]
use corpuscle_model::SolidShape;
use corpuscle_model::{Model, ModelError};
use corpuscle_output::{PlainReport, Summary};
use corpuscle_processes::Processes;
use corpuscle_scene::{Scene, SceneKind};
use corpuscle_terrain::Terrain;
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};
use toml::Table;

/// Unit of work of models that step.
const PARTICLE_STEPS: &str = "particle-steps";

/// Unit of work of models without steps.
pub(crate) const COLLISIONS: &str = "collisions";

/// A scene to be opened.
pub struct Opening<'a> {
    /// Paths and defaults are resolved; what a model chooses where the scene leaves it open is written into it.
    pub scene: &'a mut Scene,
    /// Folder that relative paths of terrain and series start from.
    pub folder: &'a Path,
    /// The processes that share the run, where there are several.
    pub processes: &'a Processes,
    /// True where a saved state is restored next, so that particles need no initial positions.
    pub is_restored: bool,
}

/// An opened scene.
pub struct Opened {
    /// The model.
    pub model: Box<dyn Model>,
    /// The terrain, if there is one.
    pub terrain: Option<Arc<Terrain>>,
    /// Values chosen where the scene leaves them open, in sentences.
    pub notes: Vec<String>,
}

impl Opened {
    /// A model without terrain.
    pub fn plain(model: Box<dyn Model>) -> Self {
        Self { model, terrain: None, notes: Vec::new() }
    }
}

/// A run that is recorded.
pub struct Recorded<'a> {
    /// Its folder.
    pub folder: &'a Path,
    /// The scene as run.
    pub scene: &'a Scene,
    /// The terrain, if there is one.
    pub terrain: Option<&'a Terrain>,
    /// The model, which shows the time of the frame, or the end.
    pub model: &'a dyn Model,
}

/// A kind of model: how its scenes are opened, recorded, shown and changed. Defaults suit a model of particles in a box.
pub trait ModelKind: Send + Sync {
    /// Its tables in scene files, and the scenes of it that come with the program.
    fn scene(&self) -> SceneKind;

    /// Opens a scene.
    ///
    /// # Errors
    /// Where the scene, or a file that it names, cannot be used.
    fn open(&self, opening: Opening<'_>) -> Result<Opened, Error>;

    /// Whether several processes can share a run of it.
    fn is_shared(&self) -> bool {
        false
    }

    /// Name of its particles, in the plural.
    fn particles(&self) -> &'static str {
        "particles"
    }

    /// Unit of its work, in the plural.
    fn work(&self) -> &'static str {
        PARTICLE_STEPS
    }

    /// Memory that a particle takes, bytes.
    fn bytes_per_particle(&self, _scene: &Scene) -> f64 {
        1000.0
    }

    /// Whether the scene is in SI units; numbers are shown without units where it is not.
    fn has_si_units(&self, _scene: &Scene) -> bool {
        true
    }

    /// Gauges that are plotted before the others, by the beginning of their headers.
    fn first_gauges(&self) -> &'static [&'static str] {
        &[]
    }

    /// Lists the parameters of a scene; `now` is the scene with the changes that have been applied. By default all numbers of its tables.
    fn parameters(&self, builder: &mut Builder, _scene: &Scene, _now: &Scene) {
        for table in self.scene().tables {
            builder.numbers_of(table);
        }
    }

    /// Draws a frame for the report.
    ///
    /// # Errors
    /// Where that cannot be written.
    fn record_frame(&self, _run: &Recorded<'_>) -> Result<(), Error> {
        Ok(())
    }

    /// Completes the summary of a run that ended.
    ///
    /// # Errors
    /// Where a file that the scene names cannot be used.
    fn complete(&self, _run: &Recorded<'_>, _summary: &mut Summary) -> Result<(), Error> {
        Ok(())
    }

    /// Writes the report of a run whose other files are written.
    ///
    /// # Errors
    /// Where the report cannot be written.
    fn write_report(&self, run: &Recorded<'_>) -> Result<(), Error> {
        let time_unit = if self.has_si_units(run.scene) { "s" } else { "" };
        Ok(PlainReport::new(run.folder, run.scene, run.model, time_unit).write()?)
    }

    /// The terrain of a scene that was opened elsewhere, as pictures need it.
    ///
    /// # Errors
    /// Where it cannot be read.
    #[cfg(feature = "pictures")]
    fn terrain(&self, _scene: &Scene, _folder: &Path) -> Result<Option<Arc<Terrain>>, Error> {
        Ok(None)
    }

    /// The solids of a scene that was opened elsewhere, in the order of its model's surfaces.
    ///
    /// # Errors
    /// Where one cannot be made.
    #[cfg(feature = "pictures")]
    fn shapes(&self, _scene: &Scene, _folder: &Path) -> Result<Vec<SolidShape>, Error> {
        Ok(Vec::new())
    }

    /// What pictures show.
    ///
    /// # Errors
    /// Where something cannot be drawn.
    #[cfg(feature = "pictures")]
    fn pictures(
        &self,
        _context: &DrawContext,
        scenery: &Scenery,
        _settings: &PictureSettings,
    ) -> Result<Box<dyn Subject>, Error> {
        Ok(Box::new(Particles::new(scenery)))
    }

    /// What draws sketches, where there is no device that draws.
    ///
    /// # Errors
    /// Where a file that the scene names cannot be used.
    #[cfg(feature = "pictures")]
    fn sketcher(&self, scenery: &Scenery) -> Result<Box<dyn Sketcher>, Error> {
        Ok(Box::new(Particles::new(scenery)))
    }

    /// True where pictures show particles in the memory of a GPU that takes the steps.
    #[cfg(feature = "pictures")]
    fn shows_particles(&self, _scene: &Scene) -> bool {
        true
    }
}

static GAS: gas::Kind = gas::Kind;
static FLOOD: flood::Kind = flood::Kind;
static DEW: dew::Kind = dew::Kind;

/// The built-in models.
static OWN: [&dyn ModelKind; 3] = [&GAS, &FLOOD, &DEW];

static ADDED: RwLock<Vec<&'static dyn ModelKind>> = RwLock::new(Vec::new());

/// Adds a model to the workbench, in this process: its scenes are read, opened, recorded, shown and changed as those of the others are.
/// Nothing changes where one of that name is there.
pub fn register(kind: &'static dyn ModelKind) {
    let mut added = ADDED.write().unwrap_or_else(PoisonError::into_inner);
    let name = kind.scene().name;
    if OWN.iter().chain(&*added).all(|known| known.scene().name != name) {
        added.push(kind);
        corpuscle_scene::register(kind.scene());
    }
}

/// The model of a scene.
///
/// # Errors
/// [`ModelError::Setup`] where it was not registered.
pub fn of(scene: &Scene) -> Result<&'static dyn ModelKind, ModelError> {
    let name = scene.model.name();
    let added = ADDED.read().unwrap_or_else(PoisonError::into_inner);
    let found = OWN.iter().chain(&*added).find(|kind| kind.scene().name == name).copied();
    found.ok_or_else(|| ModelError::Setup(format!("there is no model `{name}` in this program")))
}

/// The parameters of a scene as written; `now` is the scene with the changes that have been applied.
///
/// # Errors
/// [`ModelError::Setup`] where the scene is of a model that was not registered.
pub fn parameters(scene: &Scene, now: &Scene, document: Table) -> Result<Builder, ModelError> {
    let mut builder = Builder { document, groups: Vec::new(), left_out: Vec::new() };
    of(scene)?.parameters(&mut builder, scene, now);
    let whole = Control::Whole([0.0, 99.0]);
    builder.group("Run").scaled("run.until_s", "End", "s", "When the scene ends").add(
        "seed",
        "Seed",
        "",
        "Start value of all random numbers",
        whole,
    );
    builder.groups.retain(|group| !group.parameters.is_empty());
    Ok(builder)
}

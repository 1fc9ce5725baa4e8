//! Errors of opening, running and drawing a scene.

use corpuscle_model::ModelError;
use corpuscle_output::OutputError;
use corpuscle_scene::SceneError;
use corpuscle_terrain::TerrainError;

/// An error of opening, running or drawing a scene. The text is that of the part where it happened.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The scene, or a time series that it names.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The terrain.
    #[error(transparent)]
    Terrain(#[from] TerrainError),
    /// The download of terrain.
    #[cfg(feature = "fetch")]
    #[error(transparent)]
    Fetch(#[from] corpuscle_fetch::FetchError),
    /// The computation.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The run's folder.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The GPU that was to compute.
    #[cfg(feature = "gpu")]
    #[error(transparent)]
    Gpu(#[from] corpuscle_gpu::GpuError),
    /// The pictures.
    #[cfg(feature = "pictures")]
    #[error(transparent)]
    Render(#[from] corpuscle_render::RenderError),
    /// A picture for the surface of the terrain.
    #[cfg(feature = "pictures")]
    #[error("{} cannot be laid on the terrain: {what}; it must be a PNG file, or a GeoTIFF that lies on the terrain", path.display())]
    GroundPicture {
        /// Its file.
        path: std::path::PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Where the sun is to stand in pictures.
    #[cfg(feature = "pictures")]
    #[error("{0}")]
    Sun(String),
    /// The film.
    #[cfg(feature = "film")]
    #[error(transparent)]
    Film(#[from] corpuscle_video::FilmError),
}

impl Error {
    /// True for an error of the input; false where an accepted run failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Scene(_) | Self::Terrain(_) => true,
            #[cfg(feature = "fetch")]
            Self::Fetch(error) => error.is_refusal(),
            #[cfg(feature = "pictures")]
            Self::Render(error) => {
                matches!(error, corpuscle_render::RenderError::Gpu(corpuscle_gpu::GpuError::TooLarge { .. }))
            }
            #[cfg(feature = "pictures")]
            Self::GroundPicture { .. } | Self::Sun(_) => true,
            #[cfg(feature = "film")]
            Self::Film(error) => {
                !matches!(error, corpuscle_video::FilmError::Write { .. } | corpuscle_video::FilmError::Encoder { .. })
            }
            Self::Model(error) => !matches!(error, ModelError::Breakdown { .. } | ModelError::Device(_)),
            #[cfg(feature = "gpu")]
            Self::Gpu(_) => true,
            Self::Output(error) => !matches!(
                error,
                OutputError::Write { .. }
                    | OutputError::GaugeCount { .. }
                    | OutputError::NotFinite { .. }
                    | OutputError::Map(TerrainError::Write { .. })
            ),
        }
    }
}

//! The arguments of the command line.

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum};
use corpuscle::output::FrameFormat;
use corpuscle::pictures::Sun;
use corpuscle::terrain::MapBox;
use std::path::PathBuf;

/// Particle physics from a scene file: gases of colliding balls, dew on cold solids, floods on terrain.
#[derive(Debug, Parser)]
#[command(name = "corpuscle", version, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Write the result as JSON to standard output
    #[arg(long, global = true)]
    pub json: bool,
    /// Number of threads; results are the same for any [default: one for each core]
    #[arg(long, global = true, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
}

fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=1024) => Ok(count),
        _ => Err("must be a whole number from 1 to 1024".into()),
    }
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene into a new folder
    Run(RunOptions),
    /// Draw pictures of a finished run into its folder
    Render(RenderOptions),
    /// Write a run's maps, gauges or particles in another format
    Export(ExportOptions),
    /// Open the window: watch a scene and change it while it runs
    View(ViewOptions),
    /// List the built-in scenes, show one, or copy one to edit
    Scenes(ScenesOptions),
    /// Check a scene without running it: sizes, memory, time step, warnings
    Check(CheckOptions),
    /// Run cases with known answers
    Validate(ValidateOptions),
    /// Measure rates on this machine
    Bench(BenchOptions),
    /// Run a scene many times with changed values; probabilities, percentiles and means
    Ensemble(EnsembleOptions),
    /// Terrain models: download, describe, cut out
    #[command(subcommand)]
    Terrain(TerrainCommand),
}

#[derive(Debug, Subcommand)]
pub enum TerrainCommand {
    /// Download terrain of the Copernicus GLO-30 model, 30 m cells, from its public server
    Fetch(FetchOptions),
    /// Describe terrain files: size, cells, reference system, heights
    Info(InfoOptions),
    /// Cut a box out of one or several terrain files
    Clip(ClipOptions),
}

#[derive(Debug, Args)]
pub struct FetchOptions {
    /// The box, longitudes and latitudes in degrees
    #[arg(long, value_name = "W,S,E,N", value_parser = map_box, allow_hyphen_values = true)]
    pub bbox: MapBox,
    /// The GeoTIFF to write; an existing file is not overwritten
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Base address of another copy of the data [default: CORPUSCLE_GLO30, or the public bucket]
    #[arg(long, value_name = "URL")]
    pub from: Option<String>,
}

#[derive(Debug, Args)]
pub struct InfoOptions {
    /// GeoTIFF or ESRI ASCII grids
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Reference system of files without one: EPSG:27700 or a PROJ string
    #[arg(long, value_name = "SYSTEM", allow_hyphen_values = true)]
    pub crs: Option<String>,
}

#[derive(Debug, Args)]
pub struct ClipOptions {
    /// GeoTIFF or ESRI ASCII grids; where they overlap the first counts
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The box, in the coordinates of the first file
    #[arg(long, value_name = "W,S,E,N", value_parser = map_box, allow_hyphen_values = true)]
    pub bbox: MapBox,
    /// The GeoTIFF to write; an existing file is not overwritten
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Reference system of files without one: EPSG:27700 or a PROJ string
    #[arg(long, value_name = "SYSTEM", allow_hyphen_values = true)]
    pub crs: Option<String>,
}

fn map_box(text: &str) -> Result<MapBox, String> {
    let sides: Result<Vec<f64>, _> = text.split(',').map(|side| side.trim().parse()).collect();
    let sides: [f64; 4] = sides
        .ok()
        .and_then(|sides| sides.try_into().ok())
        .ok_or("must be four numbers, west,south,east,north, as in -91.56,41.64,-91.52,41.68")?;
    MapBox::new(sides)
}

#[derive(Debug, Args)]
pub struct SceneOptions {
    /// A built-in scene (`corpuscle scenes` lists them) or a TOML file [default: flood/valley]
    #[arg(value_name = "SCENE")]
    pub scene: Option<String>,
    /// Change a value of the scene, as in `--set flood.scheme=sph-swe`; rows of lists are counted from 0
    #[arg(long, value_name = "PATH=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
    /// End of the run, s: short for `--set run.until_s=T`
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub until: Option<String>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.trim().is_empty() => Ok((path.trim().to_owned(), value.trim().to_owned())),
        _ => Err("must be PATH=VALUE, as in run.until_s=60".into()),
    }
}

impl SceneOptions {
    /// The changes of the scene: paths of values, and the values.
    pub fn overrides(&self) -> Vec<(String, String)> {
        let until = self.until.iter().map(|until| ("run.until_s".to_owned(), until.clone()));
        self.set.iter().cloned().chain(until).collect()
    }
}

#[derive(Debug, Args)]
pub struct RunOptions {
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Folder to write, new or empty [default: the next free one in runs/]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
    /// Format of the particle files [default: vtp]
    #[arg(long, value_enum)]
    pub frames: Option<Frames>,
    /// Resume an interrupted run in its folder
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "set", "until", "output", "frames"])]
    pub resume: Option<PathBuf>,
    /// Draw a film during the run: film.mp4 in its folder
    #[arg(long, conflicts_with = "resume")]
    pub film: bool,
    /// Length of the film, s
    #[arg(long, value_name = "S", value_parser = film_length, allow_hyphen_values = true, default_value = "12")]
    pub film_length: f64,
    /// Width and height of the film, pixels
    #[arg(long, value_name = "WxH", value_parser = film_size, default_value = "1920x1080")]
    pub film_size: [u32; 2],
    #[command(flatten)]
    pub picture: PictureOptions,
}

fn film_size(text: &str) -> Result<[u32; 2], String> {
    let size = picture_size(text)?;
    let fits = size[0].max(size[1]) <= 3840 && size[0].min(size[1]) <= 2160;
    if fits { Ok(size) } else { Err("must be at most 3840x2160, or 2160x3840: H.264 has no larger pictures".into()) }
}

fn film_length(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds @ 0.1..=3600.0) => Ok(seconds),
        _ => Err("must be seconds, from 0.1 to 3600".into()),
    }
}

/// The backend that computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// `run`, `view`: a GPU if there is one and the scene is large enough, else the CPU; `validate`, `bench`: the CPU
    Auto,
    /// The CPU, all cores
    Cpu,
    /// A GPU
    Gpu,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub enum Frames {
    /// VTK files and a collection, for ParaView
    Vtp,
    /// Tables, one row for each particle
    Csv,
    /// Extended XYZ, for OVITO, VMD and ASE
    Xyz,
    /// No particle files
    None,
}

impl From<Frames> for FrameFormat {
    fn from(frames: Frames) -> Self {
        match frames {
            Frames::Vtp => Self::Vtp,
            Frames::Csv => Self::Csv,
            Frames::Xyz => Self::Xyz,
            Frames::None => Self::None,
        }
    }
}

#[derive(Debug, Args)]
#[command(group = ArgGroup::new("of_a_film").args(["film", "film_to"]).multiple(true))]
pub struct RenderOptions {
    /// The folder of a run
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Draw the frames nearest to these times, s [default: six from start to end]
    #[arg(long, value_name = "T", value_delimiter = ',', allow_hyphen_values = true)]
    pub at: Vec<f64>,
    /// Draw every frame
    #[arg(long, conflicts_with = "at")]
    pub all: bool,
    /// Make a film of every frame, RUN/film.mp4, instead of pictures
    #[arg(long, conflicts_with_all = ["at", "all"])]
    pub film: bool,
    /// Make a film with this name, .mp4 or .gif, or a folder of PNG files [default: RUN/film.mp4]
    #[arg(long, value_name = "PATH", conflicts_with_all = ["at", "all"])]
    pub film_to: Option<PathBuf>,
    /// Frames per second of the film
    #[arg(long, value_name = "N", default_value = "10", requires = "of_a_film")]
    pub rate: f64,
    /// Width and height of the pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = picture_size, default_value = "1920x1080")]
    pub size: [u32; 2],
    /// Samples each way in a pixel: 1 is fast, more is smoother
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4), default_value = "2")]
    pub samples: u32,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub figure: FigureOptions,
}

impl RenderOptions {
    /// Whether a film is made in place of pictures.
    pub fn is_film(&self) -> bool {
        self.film || self.film_to.is_some()
    }
}

/// The options of `corpuscle render` for pictures in a paper.
#[derive(Debug, Args)]
pub struct FigureOptions {
    /// Title, time, legend and axes: drawn into the picture, as vectors in an SVG file that holds the picture, or none
    #[arg(long, value_enum, default_value = "drawn")]
    pub overlay: OverlayKind,
    /// Leave the background and the floor out, so that they are transparent
    #[arg(long)]
    pub transparent: bool,
    /// Text below the title; given twice, the second is that of the run beside
    #[arg(long, value_name = "TEXT")]
    pub caption: Vec<String>,
    /// Draw an arrow towards north in pictures of a flood that are not plans, which have one
    #[arg(long)]
    pub north: bool,
    /// Draw a chart of a gauge into the corner: a column of gauges.csv as in P1.depth_m, or a gauge, of which it is the first
    #[arg(long, value_name = "GAUGE")]
    pub inset: Option<String>,
    /// Draw another run beside it, at the same times
    #[arg(long, value_name = "RUN")]
    pub beside: Option<PathBuf>,
}

/// Where title, time, legend and axes are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OverlayKind {
    /// Into the picture
    Drawn,
    /// As vectors, over the picture in an SVG file
    Vector,
    /// Nowhere
    None,
}

#[derive(Debug, Args)]
pub struct ExportOptions {
    /// The folder of a run
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    /// Files to write: maps as .nc, gauges as .parquet, particles as .vtkhdf or .xyz; an existing file is not overwritten
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
}

/// The options of `corpuscle view`.
#[derive(Debug, Args)]
pub struct ViewOptions {
    /// A built-in scene (`corpuscle scenes` lists them), a TOML file, or the folder of a run [default: the first page]
    #[arg(value_name = "SCENE|RUN")]
    pub what: Option<String>,
    /// Change a value of the scene, as in `--set flood.scheme=sph-swe`; rows of lists are counted from 0
    #[arg(long, value_name = "PATH=VALUE", value_parser = assignment, requires = "what")]
    pub set: Vec<(String, String)>,
    /// Where to compute: `auto` uses the GPU that draws the window if there is one and the scene is large enough
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
    /// Play for so many seconds, print the pictures per second, and close
    #[arg(long, value_name = "S", hide = true, requires = "what")]
    pub measure: Option<f64>,
}

#[derive(Debug, Args)]
pub struct PictureOptions {
    /// Camera: perspective from a position, or a plan from above, to scale
    #[arg(long, value_enum, default_value = "orbit")]
    pub camera: CameraKind,
    /// Direction of the camera as seen from the centre of the picture: bearing from north, and height above the horizon, degrees
    #[arg(long, value_name = "BEARING,HEIGHT", value_parser = direction, allow_hyphen_values = true)]
    pub from: Option<[f64; 2]>,
    /// Position in the centre of the picture, in the scene's coordinates
    #[arg(long = "look", value_name = "X,Y", value_parser = position, allow_hyphen_values = true)]
    pub centre: Option<[f64; 2]>,
    /// Magnification over the view of the whole scene
    #[arg(long, value_name = "N", value_parser = times, default_value = "1")]
    pub zoom: f64,
    /// Moving camera: a table with columns time_s, bearing_deg, height_deg, zoom and, for another centre, x and y
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["camera", "from", "centre", "zoom"])]
    pub camera_path: Option<PathBuf>,
    /// Surface of the terrain of a flood: natural colours, water depth, or a picture: a GeoTIFF, or a PNG file that covers it from corner to corner or has a world file
    #[arg(long, value_name = "natural|depth|FILE", default_value = "natural")]
    pub ground: String,
    /// Exaggeration of the heights of a flood
    #[arg(long, value_name = "N", value_parser = times, default_value = "1")]
    pub heights: f64,
    /// Colour of the water of a flood: clear as a mountain river, blue as a lake, or brown with soil
    #[arg(long, value_enum, default_value = "blue")]
    pub water: Water,
    /// Sun over a flood: bearing from north and height, degrees, or a time in UTC at which it stands over the terrain as it does, as in 2026-06-21T15:00Z [default: beside the camera]
    #[arg(long, value_name = "BEARING,HEIGHT|TIME", allow_hyphen_values = true)]
    pub sun: Option<Sun>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Water {
    /// Clear as a mountain river
    Clear,
    /// Blue as a lake
    Blue,
    /// Brown with soil
    Brown,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CameraKind {
    /// Perspective, from a position
    Orbit,
    /// From above, north up, to scale
    Plan,
}

fn times(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(times @ 0.01..=1000.0) => Ok(times),
        _ => Err("must be a number from 0.01 to 1000".into()),
    }
}

fn position(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let position = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    position.ok_or_else(|| "must be two numbers with a comma between them, as in 500,320".into())
}

fn direction(text: &str) -> Result<[f64; 2], String> {
    match position(text) {
        Ok([bearing, height @ -5.0..=89.0]) => Ok([bearing, height]),
        _ => Err("must be two numbers of degrees, as in 155,35, the second from -5 to 89".into()),
    }
}

fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match sides {
        Some(size @ [16..=16384, 16..=16384]) => Ok(size),
        _ => Err("must be WIDTHxHEIGHT in pixels, as in 1920x1080, each from 16 to 16384".into()),
    }
}

#[derive(Debug, Args)]
pub struct ScenesOptions {
    /// The built-in scene to show or copy
    #[arg(value_name = "NAME")]
    pub name: Option<String>,
    /// Copy it to this file; an existing file is not overwritten
    #[arg(long, value_name = "FILE", requires = "name")]
    pub copy: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct CheckOptions {
    #[command(flatten)]
    pub scene: SceneOptions,
}

#[derive(Debug, Args)]
pub struct ValidateOptions {
    /// Cases by name (`flood/voronoi/stoker`) or beginning (`flood`) [default: all]
    #[arg(value_name = "CASE")]
    pub cases: Vec<String>,
    /// Leave out cases that take more than about ten seconds
    #[arg(long)]
    pub fast: bool,
    /// Also write a page of tables and charts
    #[arg(long, value_name = "FILE.html")]
    pub report: Option<PathBuf>,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
}

#[derive(Debug, Args)]
pub struct BenchOptions {
    /// Benches by name or beginning [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// Less time for each, with more scatter
    #[arg(long)]
    pub quick: bool,
    /// Time each pass of a step on the GPU too
    #[arg(long)]
    pub passes: bool,
    /// Floods on the GPU: also pictures per second, 1920 x 1080, one per step
    #[arg(long)]
    pub draw: bool,
    /// Draw the water by compute shaders instead of raster units, with --draw
    #[arg(long, requires = "draw")]
    pub splats: bool,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
}

#[derive(Debug, Args)]
pub struct EnsembleOptions {
    /// The plan, a TOML file: a scene, what changes, and how it is sampled
    #[arg(value_name = "PLAN.toml")]
    pub plan: PathBuf,
    /// Folder of the ensemble [default: the plan's name in runs/]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Run this member alone, as a task of a job array does; without, those that are missing run and the results are written
    #[arg(long, value_name = "K")]
    pub member: Vec<usize>,
    /// Members at the same time [default: one on each thread]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub at_once: Option<usize>,
}

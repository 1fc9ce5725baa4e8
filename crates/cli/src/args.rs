//! The command line's words.

use clap::{Args, Parser, Subcommand, ValueEnum};
use corpuscle::output::FrameFormat;
use corpuscle::terrain::MapBox;
use std::path::PathBuf;

/// Particle physics from a scene file: flood valleys, look at the result in QGIS and ParaView.
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
    /// Open the window: look at a scene and touch it while it runs
    View(ViewOptions),
    /// List the built-in scenes, show one, or copy one to edit
    Scenes(ScenesOptions),
    /// Say what would be run: sizes, memory, time step, warnings
    Check(CheckOptions),
    /// Run cases with known answers
    Validate(ValidateOptions),
    /// Measure rates on this machine
    Bench(BenchOptions),
    /// Terrain models: fetch one, tell what one holds, cut one out
    #[command(subcommand)]
    Terrain(TerrainCommand),
}

#[derive(Debug, Subcommand)]
pub enum TerrainCommand {
    /// Fetch terrain of the Copernicus GLO-30 model, 30 m cells, from its public server
    Fetch(FetchOptions),
    /// Tell what terrain files hold: size, cells, reference system, heights
    Info(InfoOptions),
    /// Cut a box out of one or several terrain files
    Clip(ClipOptions),
}

#[derive(Debug, Args)]
pub struct FetchOptions {
    /// The box, longitudes and latitudes in degrees
    #[arg(long, value_name = "W,S,E,N", value_parser = map_box, allow_hyphen_values = true)]
    pub bbox: MapBox,
    /// The GeoTIFF to write; one that exists is left alone
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
    /// Reference system of files that name none: EPSG:27700 or a PROJ string
    #[arg(long, value_name = "SYSTEM", allow_hyphen_values = true)]
    pub crs: Option<String>,
}

#[derive(Debug, Args)]
pub struct ClipOptions {
    /// GeoTIFF or ESRI ASCII grids; where they overlap the one named first counts
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The box, in the coordinates of the first file
    #[arg(long, value_name = "W,S,E,N", value_parser = map_box, allow_hyphen_values = true)]
    pub bbox: MapBox,
    /// The GeoTIFF to write; one that exists is left alone
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Reference system of files that name none: EPSG:27700 or a PROJ string
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
    /// What is to be changed in the scene.
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
    /// How particles are written [default: vtp]
    #[arg(long, value_enum)]
    pub frames: Option<Frames>,
    /// Go on with an interrupted run in its folder
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scene", "set", "until", "output", "frames"])]
    pub resume: Option<PathBuf>,
    /// Draw a film of the run while it runs: film.mp4 in its folder
    #[arg(long, conflicts_with = "resume")]
    pub film: bool,
    /// How long the film lasts, s
    #[arg(long, value_name = "S", value_parser = film_length, allow_hyphen_values = true, default_value = "12")]
    pub film_length: f64,
    /// Width and height of the film, pixels
    #[arg(long, value_name = "WxH", value_parser = film_size, default_value = "1920x1080")]
    pub film_size: [u32; 2],
    #[command(flatten)]
    pub look: LookOptions,
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

/// Where a command computes.
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
    /// Where the film goes: a name in .mp4 or .gif, or a folder for PNG files [default: RUN/film.mp4]
    #[arg(long, value_name = "PATH", requires = "film")]
    pub film_to: Option<PathBuf>,
    /// Frames that the film shows in a second
    #[arg(long, value_name = "N", default_value = "10", requires = "film")]
    pub rate: f64,
    /// Width and height of the pictures, pixels
    #[arg(long, value_name = "WxH", value_parser = picture_size, default_value = "1920x1080")]
    pub size: [u32; 2],
    /// Samples each way in a pixel: 1 is fast, more is smoother
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4), default_value = "2")]
    pub samples: u32,
    #[command(flatten)]
    pub look: LookOptions,
}

/// The arguments of `corpuscle view`.
#[derive(Debug, Args)]
pub struct ViewOptions {
    /// A built-in scene (`corpuscle scenes` lists them), a TOML file, or the folder of a run [default: the first page]
    #[arg(value_name = "SCENE|RUN")]
    pub what: Option<String>,
    /// Change a value of the scene, as in `--set flood.scheme=sph-swe`; rows of lists are counted from 0
    #[arg(long, value_name = "PATH=VALUE", value_parser = assignment, requires = "what")]
    pub set: Vec<(String, String)>,
    /// Where to compute: `auto` takes the GPU that draws the window, where there is one and the scene is large enough
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
    /// Play for so many seconds, tell how many pictures there were in a second, and close
    #[arg(long, value_name = "S", hide = true, requires = "what")]
    pub measure: Option<f64>,
}

#[derive(Debug, Args)]
pub struct LookOptions {
    /// From where pictures are taken: an eye that stands somewhere, or straight from above, to scale
    #[arg(long, value_enum, default_value = "orbit")]
    pub camera: CameraKind,
    /// Where the eye stands as seen from the middle: bearing from north, and height above the horizon, degrees
    #[arg(long, value_name = "BEARING,HEIGHT", value_parser = direction, allow_hyphen_values = true)]
    pub from: Option<[f64; 2]>,
    /// The place in the middle of the picture, in the scene's coordinates
    #[arg(long, value_name = "X,Y", value_parser = place, allow_hyphen_values = true)]
    pub look: Option<[f64; 2]>,
    /// How many times nearer than where all is seen
    #[arg(long, value_name = "N", value_parser = times, default_value = "1")]
    pub zoom: f64,
    /// A camera that moves: a table with columns time_s, bearing_deg, height_deg, zoom and, if it is to look elsewhere, x and y
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["camera", "from", "look", "zoom"])]
    pub camera_path: Option<PathBuf>,
    /// What lies on the ground of a flood: natural colours, the water's depth, or a picture (PNG) that covers it from corner to corner
    #[arg(long, value_name = "natural|depth|FILE.png", default_value = "natural")]
    pub ground: String,
    /// Draw heights of a flood so many times higher than they are
    #[arg(long, value_name = "N", value_parser = times, default_value = "1")]
    pub heights: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CameraKind {
    /// An eye that stands somewhere
    Orbit,
    /// Straight from above, north up, to scale
    Plan,
}

fn times(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(times @ 0.01..=1000.0) => Ok(times),
        _ => Err("must be a number from 0.01 to 1000".into()),
    }
}

fn place(text: &str) -> Result<[f64; 2], String> {
    let number = |part: &str| part.trim().parse().ok().filter(|number: &f64| number.is_finite());
    let place = text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    place.ok_or_else(|| "must be two numbers with a comma between them, as in 500,320".into())
}

fn direction(text: &str) -> Result<[f64; 2], String> {
    match place(text) {
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
    /// Copy it to this file; one that exists is left alone
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
    /// Leave out the cases that take more than some seconds
    #[arg(long)]
    pub fast: bool,
    /// Write a page of tables and charts as well
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
    /// Less time for each: a quick look, with more scatter
    #[arg(long)]
    pub quick: bool,
    /// Time each pass of a step on the GPU too
    #[arg(long)]
    pub passes: bool,
    /// Floods on the GPU: pictures a second as well, 1920 x 1080, one a step
    #[arg(long)]
    pub draw: bool,
    /// Draw the water by compute shaders, not raster units, with --draw
    #[arg(long, requires = "draw")]
    pub splats: bool,
    /// Where to compute
    #[arg(long, value_enum, default_value = "auto")]
    pub backend: Backend,
}

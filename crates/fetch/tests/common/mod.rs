//! A stand-in for the public bucket: a server on this machine with tiles of made-up ground.

use corpuscle_fetch::Source;
use geotiff_writer::{CogBuilder, Compression, GeoTiffBuilder, Predictor, RasterType};
use ndarray::Array2;
use std::collections::HashMap;
use std::io::{BufRead, BufReader, Cursor, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, LazyLock, Mutex, MutexGuard};
use std::thread;
use std::time::Duration;
use tempfile::TempDir;

/// Tiles beyond 85 degrees north have this many columns, of cells ten times as wide as high.
pub const COLUMNS: usize = 360;
pub const ROWS: usize = 3600;

/// The made-up height at the centre of a cell, m.
pub fn ground(longitude: f64, latitude: f64) -> f64 {
    f64::from((400.0 + 300.0 * (7.0 * longitude).sin() * (11.0 * latitude).cos()) as f32)
}

/// Name of the tile with this south-west corner.
pub fn name(latitude: i32, longitude: i32) -> String {
    let (ns, ew) = (if latitude < 0 { 'S' } else { 'N' }, if longitude < 0 { 'W' } else { 'E' });
    format!("Copernicus_DSM_COG_10_{ns}{:02}_00_{ew}{:03}_00_DEM", latitude.abs(), longitude.abs())
}

/// A tile of the made-up ground, made once for all tests.
fn tile(latitude: i32, longitude: i32) -> Vec<u8> {
    static MADE: LazyLock<Mutex<HashMap<[i32; 2], Vec<u8>>>> = LazyLock::new(Mutex::default);
    let mut made = MADE.lock().unwrap();
    made.entry([latitude, longitude]).or_insert_with(|| tile_of(latitude, longitude, COLUMNS, ground)).clone()
}

/// A tile as the bucket has it: cloud-optimised, Deflate, tiepoint at the centre of a cell.
pub fn tile_of(latitude: i32, longitude: i32, columns: usize, ground: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let (dx, dy) = (1.0 / columns as f64, 1.0 / ROWS as f64);
    let samples = Array2::from_shape_fn((ROWS, columns), |(row, column)| {
        ground(f64::from(longitude) + column as f64 * dx, f64::from(latitude + 1) - row as f64 * dy) as f32
    });
    let builder = GeoTiffBuilder::new(columns as u32, ROWS as u32)
        .geographic_epsg(4326)
        .raster_type(RasterType::PixelIsPoint)
        .pixel_scale(dx, dy)
        .origin(f64::from(longitude) - 0.5 * dx, f64::from(latitude + 1) + 0.5 * dy)
        .compression(Compression::Deflate)
        .predictor(Predictor::FloatingPoint)
        .tile_size(256, 256);
    let mut bytes = Cursor::new(Vec::new());
    CogBuilder::new(builder).overview_levels(vec![2, 4]).write_2d_to(&mut bytes, samples.view()).unwrap();
    bytes.into_inner()
}

/// What the server does wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// Half of the body, then nothing more.
    Cut,
    /// A body shorter than its own header and the range say, without breaking off.
    Short,
    /// Other bytes than were asked for.
    OtherRange,
    Status(u16),
    /// No answer.
    Silent,
    /// A byte now and then.
    Trickle,
    /// All of the file whatever is asked for.
    NoRanges,
    /// A page that says that one has to log in.
    Page,
}

#[derive(Default)]
struct State {
    files: HashMap<String, (Vec<u8>, String)>,
    /// What goes wrong, with the next so many requests.
    faults: Option<(Fault, usize)>,
    requests: Vec<String>,
}

/// The server.
pub struct Bucket {
    pub base: String,
    state: Arc<Mutex<State>>,
    pub cache: TempDir,
}

impl Bucket {
    /// A server with the tiles of these south-west corners.
    pub fn with(tiles: &[[i32; 2]]) -> Self {
        let bucket = Self::empty();
        let all = tiles.iter();
        bucket.put_tiles(all.map(|&[latitude, longitude]| ([latitude, longitude], tile(latitude, longitude))));
        bucket
    }

    /// Puts tiles and their list on the server.
    pub fn put_tiles(&self, tiles: impl IntoIterator<Item = ([i32; 2], Vec<u8>)>) {
        let mut list = String::new();
        for ([latitude, longitude], bytes) in tiles {
            let name = name(latitude, longitude);
            self.put(&format!("{name}/{name}.tif"), bytes, "1");
            list += &(name + "\n");
        }
        self.put("tileList.txt", list.into_bytes(), "list");
    }

    /// A server without any file.
    pub fn empty() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let base = format!("http://{}", listener.local_addr().unwrap());
        let state: Arc<Mutex<State>> = Arc::default();
        let shared = state.clone();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let state = shared.clone();
                // A client that has gone away is no fault of the server.
                thread::spawn(move || _ = serve(stream, &state));
            }
        });
        Self { base, state, cache: tempfile::tempdir().unwrap() }
    }

    pub fn put(&self, path: &str, bytes: Vec<u8>, etag: &str) {
        self.state().files.insert(format!("/{path}"), (bytes, etag.into()));
    }

    pub fn file(&self, path: &str) -> Vec<u8> {
        self.state().files[&format!("/{path}")].0.clone()
    }

    /// The next `count` requests go wrong.
    pub fn fail(&self, fault: Fault, count: usize) {
        self.state().faults = Some((fault, count));
    }

    /// Paths asked for since this was last called.
    pub fn requests(&self) -> Vec<String> {
        std::mem::take(&mut self.state().requests)
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }

    /// The server, with little patience between attempts.
    pub fn source(&self) -> Source {
        Source { pause: Duration::from_millis(2), ..Source::new(&self.base, self.cache.path()) }
    }

    /// The server, with little patience for slow answers too.
    pub fn hasty(&self) -> Source {
        Source { timeout: Duration::from_millis(200), ..self.source() }
    }
}

fn serve(mut stream: TcpStream, state: &Mutex<State>) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    let path = request.split_whitespace().nth(1).unwrap_or_default().to_owned();
    let mut range = None;
    for line in lines {
        let line = line?.to_lowercase();
        if line.is_empty() {
            break;
        }
        if let Some(asked) = line.strip_prefix("range: bytes=") {
            range = asked.split_once('-').map(|(first, last)| (first.parse().unwrap(), last.parse::<usize>().unwrap()));
        }
    }
    let (file, fault) = {
        let mut state = state.lock().unwrap();
        state.requests.push(path.clone());
        let fault = match &mut state.faults {
            Some((fault, count)) if *count > 0 => {
                *count -= 1;
                Some(*fault)
            }
            _ => None,
        };
        (state.files.get(&path).cloned(), fault)
    };
    let Some((bytes, etag)) = file else {
        return write!(stream, "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    };
    match fault {
        Some(Fault::Silent) => thread::sleep(Duration::from_secs(3)),
        Some(Fault::Status(status)) => {
            write!(stream, "HTTP/1.1 {status} No\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")?;
        }
        Some(Fault::Page) => {
            let page = "<!DOCTYPE html><p>Log in to the network of this hotel";
            write!(stream, "HTTP/1.1 200 OK\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{page}", page.len())?;
        }
        _ => give(&mut stream, &bytes, &etag, range.filter(|_| fault != Some(Fault::NoRanges)), fault)?,
    }
    Ok(())
}

fn give(
    stream: &mut TcpStream,
    bytes: &[u8],
    etag: &str,
    range: Option<(usize, usize)>,
    fault: Option<Fault>,
) -> std::io::Result<()> {
    let total = bytes.len();
    let (first, end) = range.map_or((0, total), |(first, last)| (first, (last + 1).min(total)));
    let mut body = &bytes[first..end];
    let mut length = body.len();
    let mut told = (first, end - 1);
    match fault {
        Some(Fault::Cut) => body = &body[..length / 2],
        Some(Fault::Short) => {
            length /= 2;
            body = &body[..length];
        }
        Some(Fault::OtherRange) => told = (first + 10, end + 9),
        _ => {}
    }
    match range {
        Some(_) => write!(stream, "HTTP/1.1 206 Partial\r\nContent-Range: bytes {}-{}/{total}\r\n", told.0, told.1)?,
        None => write!(stream, "HTTP/1.1 200 OK\r\n")?,
    }
    write!(stream, "ETag: \"{etag}\"\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n")?;
    if fault == Some(Fault::Trickle) {
        for byte in body {
            stream.write_all(&[*byte])?;
            thread::sleep(Duration::from_millis(100));
        }
        return Ok(());
    }
    stream.write_all(body)
}

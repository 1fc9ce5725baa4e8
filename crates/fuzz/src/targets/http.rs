//! Answers of a server to `corpuscle terrain fetch`.

use super::path_of;
use crate::Target;
use corpuscle_fetch::{FetchObserver, Source, fetch};
use corpuscle_terrain::MapBox;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

pub(super) const TARGETS: &[Target] = &[
    Target {
        name: "http",
        about: "answers of a server of terrain, byte for byte",
        corpus: "http",
        read: answers,
        more: made_answers,
    },
    Target { name: "tile", about: "files of a server of terrain", corpus: "tile", read: tile, more: super::none },
];

/// Between one answer and the next.
const NEXT: &[u8] = b"\n====\n";

/// What the server does.
enum Serves {
    /// It sends these, one to each request and the last to all others.
    Answers(Vec<Vec<u8>>, usize),
    /// It has this file, with range requests.
    File(Vec<u8>),
}

static SERVES: Mutex<Serves> = Mutex::new(Serves::Answers(Vec::new(), 0));

/// Calls of one after another, so that each has its answers.
static TURN: Mutex<()> = Mutex::new(());

/// The address of a server on this machine.
static BASE: LazyLock<String> = LazyLock::new(|| {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a server on this machine");
    let base = format!("http://{}", listener.local_addr().expect("its address"));
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            thread::spawn(move || _ = serve(stream));
        }
    });
    base
});

fn serve(mut stream: TcpStream) -> std::io::Result<()> {
    stream.set_nodelay(true)?;
    let mut reader = BufReader::new(stream.try_clone()?);
    let (mut range, mut line) = (None, String::new());
    while reader.read_line(&mut line)? > 0 && line.trim() != "" {
        if let Some(value) = line.to_ascii_lowercase().strip_prefix("range: bytes=") {
            let (first, last) = value.trim().split_once('-').unwrap_or_default();
            range = first.parse().ok().zip(last.parse().ok());
        }
        line.clear();
    }
    let answer = match &mut *SERVES.lock().unwrap_or_else(PoisonError::into_inner) {
        Serves::Answers(answers, next) => {
            let answer = answers.get((*next).min(answers.len().saturating_sub(1))).cloned().unwrap_or_default();
            *next += 1;
            answer
        }
        Serves::File(file) => part(file, range),
    };
    stream.write_all(&answer)
}

fn part(file: &[u8], range: Option<(usize, usize)>) -> Vec<u8> {
    let Some((first, last)) = range else {
        return b"HTTP/1.1 404 Not Found\r\ncontent-length: 0\r\nconnection: close\r\n\r\n".to_vec();
    };
    let last = last.min(file.len().saturating_sub(1));
    let bytes = file.get(first..=last).unwrap_or_default();
    let head = format!(
        "HTTP/1.1 206 Partial Content\r\ncontent-length: {}\r\ncontent-range: bytes {first}-{last}/{}\r\netag: \"1\"\r\nconnection: close\r\n\r\n",
        bytes.len(),
        file.len()
    );
    [head.as_bytes(), bytes].concat()
}

fn fetched(serves: Serves) -> Result<String, String> {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    *SERVES.lock().unwrap_or_else(PoisonError::into_inner) = serves;
    let cache = path_of("cache");
    _ = std::fs::remove_dir_all(&cache);
    let source = Source {
        attempts: 1,
        pause: Duration::ZERO,
        timeout: Duration::from_millis(300),
        ..Source::new(&*BASE, &cache)
    };
    let part = MapBox::new([10.2, 85.2, 10.21, 85.201])?;
    let fetched = fetch(&source, &part, &FetchObserver::none())
        .map_err(|error| error.to_string().replace(&*BASE, "").replace(&cache.display().to_string(), ""))?;
    Ok(format!("{} tiles", fetched.tiles.len()))
}

fn answers(bytes: &[u8]) -> Result<String, String> {
    let mut answers = Vec::new();
    let mut rest = bytes;
    while let Some(at) = rest.windows(NEXT.len()).position(|window| window == NEXT) {
        answers.push(rest[..at].to_vec());
        rest = &rest[at + NEXT.len()..];
    }
    answers.push(rest.to_vec());
    fetched(Serves::Answers(answers, 0))
}

fn tile(bytes: &[u8]) -> Result<String, String> {
    fetched(Serves::File(bytes.to_vec()))
}

/// What a sound server sends: the beginning of a tile; that there is none, and the list.
fn made_answers() -> Vec<Vec<u8>> {
    let whole = crate::corpus::folder().join("tile").join("level.tif");
    let file = std::fs::read(whole).unwrap_or_default();
    let begin = part(&file, Some((0, 262_143)));
    let none = part(&file, None);
    let list = b"HTTP/1.1 200 OK\r\ncontent-length: 41\r\n\r\nCopernicus_DSM_COG_10_N85_00_E011_00_DEM\n".to_vec();
    let open = b"HTTP/1.1 200 OK\r\ntransfer-encoding: chunked\r\n\r\n5\r\nII*\0\x08\r\n0\r\n\r\n".to_vec();
    let moved = b"HTTP/1.1 302 Found\r\nlocation: /other\r\ncontent-length: 0\r\n\r\n".to_vec();
    let head =
        b"HTTP/1.1 206 Partial Content\r\ncontent-length: 8\r\ncontent-range: bytes 0-7/8\r\n\r\nII*\0\x08\0\0\0"
            .to_vec();
    let lie = b"HTTP/1.1 206 Partial Content\r\ncontent-length: 262144\r\ncontent-range: bytes 0-262143/18446744073709551615\r\n\r\n".to_vec();
    let full = [&lie[..], &[b"II*\0".to_vec(), vec![0xff; 262_140]].concat()].concat();
    vec![begin, [&none[..], &list].join(NEXT), open, moved, head, full]
}

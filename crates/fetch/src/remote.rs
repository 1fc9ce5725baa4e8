//! A file on a server with random access, through the cache.

use crate::FetchError;
use crate::cache::{About, Cache};
use crate::client::{Answer, Client};
use crate::piece::{MOST_PIECES, PIECE, bytes_of, pieces_of, runs};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tiff_reader::source::TiffSource;

/// First bytes of TIFF and BigTIFF files.
const MARKS: [&[u8]; 4] = [b"II\x2a\0", b"MM\0\x2a", b"II\x2b\0", b"MM\0\x2b"];

/// A TIFF file on a server.
pub(crate) struct RemoteFile {
    url: String,
    client: Client,
    cache: Cache,
    length: u64,
    etag: Option<String>,
    state: Mutex<State>,
    /// Callback for the bytes downloaded.
    came: Box<dyn Fn(u64) + Send + Sync>,
}

#[derive(Default)]
struct State {
    pieces: HashMap<u64, Vec<u8>>,
    /// Why reading failed.
    failure: Option<FetchError>,
}

impl RemoteFile {
    /// Opens the file at `url`; none where it does not exist.
    pub fn open(
        url: &str,
        client: Client,
        cache: Cache,
        came: impl Fn(u64) + Send + Sync + 'static,
    ) -> Result<Option<Self>, FetchError> {
        let mut file = Self {
            url: url.into(),
            client,
            cache,
            length: 0,
            etag: None,
            state: Mutex::default(),
            came: Box::new(came),
        };
        match file.cache.about() {
            Some(About::File { length, etag }) => (file.length, file.etag) = (length, etag),
            Some(About::Sea) => return Ok(None),
            None => match file.client.get(url, Some(0..MOST_PIECES * PIECE / 4))? {
                Answer::Missing => return Ok(None),
                Answer::Part { bytes, total, etag } => file.first(bytes, total, etag)?,
                Answer::Whole { bytes, etag } => {
                    let length = bytes.len() as u64;
                    file.first(bytes, length, etag)?;
                }
            },
        }
        Ok(Some(file))
    }

    /// Stores the first bytes of the file and its length.
    fn first(&mut self, bytes: Vec<u8>, length: u64, etag: Option<String>) -> Result<(), FetchError> {
        if !MARKS.iter().any(|mark| bytes.starts_with(mark)) {
            let start = String::from_utf8_lossy(&bytes[..bytes.len().min(24)]).into_owned();
            return Err(FetchError::no_tile(&self.url, format!("it is no TIFF file but begins with {start:?}")));
        }
        (self.length, self.etag) = (length, etag.clone());
        self.cache.clear()?;
        // Written last, so that a cache without it counts as empty.
        self.keep(0, &bytes, &mut HashMap::new())?;
        self.cache.set_about(&About::File { length, etag })
    }

    /// Keeps the pieces that lie wholly in `bytes`, which begin with piece number `first`.
    fn keep(&self, first: u64, bytes: &[u8], pieces: &mut HashMap<u64, Vec<u8>>) -> Result<(), FetchError> {
        (self.came)(bytes.len() as u64);
        for (number, piece) in (first..).zip(bytes.chunks(PIECE as usize)) {
            if piece.len() as u64 == self.length_of(number) {
                self.cache.set_piece(number, piece)?;
                pieces.insert(number, piece.to_vec());
            }
        }
        Ok(())
    }

    fn length_of(&self, piece: u64) -> u64 {
        let bytes = bytes_of(&(piece..piece + 1), self.length);
        bytes.end.saturating_sub(bytes.start)
    }

    /// Loads the pieces that are not in memory, from the cache or from the server.
    fn load(&self, wanted: Range<u64>, pieces: &mut HashMap<u64, Vec<u8>>) -> Result<(), FetchError> {
        let mut missing = Vec::new();
        for number in wanted {
            if pieces.contains_key(&number) {
                continue;
            }
            match self.cache.piece(number, self.length_of(number)) {
                Some(piece) => _ = pieces.insert(number, piece),
                None => missing.push(number),
            }
        }
        for run in runs(missing) {
            if !run.clone().all(|number| pieces.contains_key(&number)) {
                self.request(run, pieces)?;
            }
        }
        Ok(())
    }

    /// Downloads a run of pieces.
    fn request(&self, run: Range<u64>, pieces: &mut HashMap<u64, Vec<u8>>) -> Result<(), FetchError> {
        let changed = || FetchError::Changed { url: self.url.clone() };
        match self.client.get(&self.url, Some(bytes_of(&run, self.length)))? {
            Answer::Part { bytes, total, etag } if total == self.length && etag == self.etag => {
                self.keep(run.start, &bytes, pieces)
            }
            Answer::Whole { bytes, etag } if bytes.len() as u64 == self.length && etag == self.etag => {
                self.keep(0, &bytes, pieces)
            }
            _ => Err(changed()),
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Why reading failed, if it did.
    pub fn failure(&self) -> Option<FetchError> {
        self.state().failure.clone()
    }

    /// Its cache.
    pub fn cache(&self) -> &Cache {
        &self.cache
    }

    fn read(&self, offset: u64, len: usize) -> Result<Vec<u8>, FetchError> {
        let mut state = self.state();
        let pieces = pieces_of(offset, len);
        self.load(pieces.clone(), &mut state.pieces)?;
        let all: Vec<u8> = pieces.clone().flat_map(|number| state.pieces[&number].iter().copied()).collect();
        let start = (offset - pieces.start * PIECE) as usize;
        Ok(all[start..start + len].to_vec())
    }
}

impl TiffSource for RemoteFile {
    fn len(&self) -> u64 {
        self.length
    }

    fn read_exact_at(&self, offset: u64, len: usize) -> tiff_reader::error::Result<Vec<u8>> {
        let data_len = self.length;
        if len == 0 {
            return Ok(Vec::new());
        }
        if offset.checked_add(len as u64).is_none_or(|end| end > data_len) {
            return Err(tiff_reader::error::Error::OffsetOutOfBounds { offset, length: len as u64, data_len });
        }
        self.read(offset, len).map_err(|error| {
            let message = tiff_reader::error::Error::Other(error.to_string());
            self.state().failure = Some(error);
            message
        })
    }
}

//! HTTP requests, repeated after temporary errors.

use crate::observer::FetchObserver;
use crate::{FetchError, Source};
use std::io::Read;
use std::ops::Range;
use std::time::{Duration, Instant};
use ureq::http::Response;
use ureq::{Agent, Body};

/// Largest file that is downloaded whole, from a server without range requests, bytes.
const MOST_BYTES: u64 = 1 << 29;

/// Time limit of a request over the timeout of the server.
const LONGEST: u32 = 10;

/// Interval at which the stop flag is checked.
const STOP_CHECK_INTERVAL: Duration = Duration::from_millis(50);

/// A response of the server.
#[derive(Debug, PartialEq)]
pub(crate) enum Answer {
    /// The requested bytes, of a file of `total` bytes.
    Part { bytes: Vec<u8>, total: u64, etag: Option<String> },
    /// The whole file: the server has no range requests.
    Whole { bytes: Vec<u8>, etag: Option<String> },
    /// There is no such file.
    Missing,
}

/// The error of one attempt.
enum Fault {
    /// Temporary: the request is repeated.
    Passing(String),
    Final(FetchError),
}

/// An HTTP client.
#[derive(Debug)]
pub(crate) struct Client {
    agent: Agent,
    attempts: u32,
    pause: Duration,
    observer: FetchObserver,
}

impl Client {
    pub fn new(source: &Source, observer: &FetchObserver) -> Self {
        let timeout = Some(source.timeout);
        let config = Agent::config_builder()
            .http_status_as_error(false)
            .user_agent(concat!("corpuscle/", env!("CARGO_PKG_VERSION")))
            .timeout_resolve(timeout)
            .timeout_connect(timeout)
            .timeout_recv_response(timeout)
            .timeout_per_read(timeout)
            .timeout_per_call(Some(LONGEST * source.timeout))
            .build();
        Self { agent: config.into(), attempts: source.attempts, pause: source.pause, observer: observer.clone() }
    }

    /// Some bytes of a file, those beyond its end left out; all of it without a range.
    pub fn get(&self, url: &str, range: Option<Range<u64>>) -> Result<Answer, FetchError> {
        let mut pause = self.pause;
        let mut attempt = 1;
        loop {
            match self.attempt(url, range.as_ref()) {
                Ok(answer) => return Ok(answer),
                Err(Fault::Final(error)) => return Err(error),
                Err(Fault::Passing(what)) if attempt == self.attempts => {
                    return Err(FetchError::Network { url: url.into(), attempts: attempt, what });
                }
                Err(Fault::Passing(_)) => self.sleep(pause)?,
            }
            (attempt, pause) = (attempt + 1, 2 * pause);
        }
    }

    /// Waits, or returns early when the download is stopped.
    fn sleep(&self, pause: Duration) -> Result<(), FetchError> {
        let start = Instant::now();
        while start.elapsed() < pause {
            if self.observer.is_stopped() {
                return Err(FetchError::Stopped);
            }
            std::thread::sleep(STOP_CHECK_INTERVAL.min(pause));
        }
        Ok(())
    }

    fn attempt(&self, url: &str, range: Option<&Range<u64>>) -> Result<Answer, Fault> {
        let request = self.agent.get(url);
        let request = match range {
            Some(range) => request.header("Range", format!("bytes={}-{}", range.start, range.end - 1)),
            None => request,
        };
        let mut response = request.call().map_err(|error| failed(url, &error))?;
        let etag = header(&response, "etag");
        match (response.status().as_u16(), range) {
            (206, Some(range)) => {
                let stated = header(&response, "content-range").as_deref().and_then(content_range);
                let Some((given, total)) = stated.filter(|(given, total)| is_answer(given, range, *total)) else {
                    return Err(Fault::Passing(format!("the server did not return the requested bytes {range:?}")));
                };
                let bytes = self.body(&mut response, Some(given.end - given.start))?;
                Ok(Answer::Part { bytes, total, etag })
            }
            (200, _) => {
                let length = header(&response, "content-length").and_then(|length| length.parse().ok());
                Ok(Answer::Whole { bytes: self.body(&mut response, length)?, etag })
            }
            // A bucket that cannot be listed returns 403 for a file that does not exist.
            (403 | 404, _) => Ok(Answer::Missing),
            (408 | 429 | 500 | 502..=504, _) => {
                Err(Fault::Passing(format!("the server returned HTTP status {}", response.status().as_u16())))
            }
            (status, _) => Err(Fault::Final(FetchError::Refused { url: url.into(), status })),
        }
    }

    /// The body, which has `length` bytes where that is known.
    fn body(&self, response: &mut Response<Body>, length: Option<u64>) -> Result<Vec<u8>, Fault> {
        if length.is_some_and(|length| length > MOST_BYTES) {
            return Err(Fault::Passing(
                "the server has no range requests, and the file is too long to be downloaded whole".into(),
            ));
        }
        let mut reader = response.body_mut().as_reader().take(length.unwrap_or(MOST_BYTES) + 1);
        let mut bytes = Vec::new();
        let mut buffer = [0; 16 * 1024];
        loop {
            if self.observer.is_stopped() {
                return Err(Fault::Final(FetchError::Stopped));
            }
            match reader.read(&mut buffer) {
                Ok(0) => break,
                Ok(count) => bytes.extend_from_slice(&buffer[..count]),
                Err(error) => return Err(Fault::Passing(format!("the response ended early: {error}"))),
            }
        }
        match length {
            Some(length) if length != bytes.len() as u64 => {
                Err(Fault::Passing(format!("the server sent {} bytes instead of {length}", bytes.len())))
            }
            _ => Ok(bytes),
        }
    }
}

fn header(response: &Response<Body>, name: &str) -> Option<String> {
    response.headers().get(name).and_then(|value| value.to_str().ok()).map(str::to_owned)
}

/// The bytes and the length of the file in a `Content-Range` (RFC 9110, 14.4): `bytes 0-99/1234`.
fn content_range(text: &str) -> Option<(Range<u64>, u64)> {
    let (range, total) = text.trim().strip_prefix("bytes ")?.split_once('/')?;
    let (first, last) = range.split_once('-')?;
    let (first, last): (u64, u64) = (first.parse().ok()?, last.parse().ok()?);
    let end = last.checked_add(1)?;
    (first <= last).then_some((first..end, total.parse().ok()?))
}

/// True where the bytes returned are those requested, up to the end of the file.
fn is_answer(given: &Range<u64>, asked: &Range<u64>, total: u64) -> bool {
    given.start == asked.start && given.end == asked.end.min(total)
}

/// The error of a request without response.
fn failed(url: &str, error: &ureq::Error) -> Fault {
    match error {
        ureq::Error::BadUri(_) | ureq::Error::Http(_) => Fault::Final(FetchError::no_tile(url, "it is no web address")),
        ureq::Error::HostNotFound => Fault::Passing("the server's name is not known; is there a network?".into()),
        ureq::Error::Timeout(_) => Fault::Passing("the server is too slow".into()),
        error => Fault::Passing(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_ranges_are_read() {
        assert_eq!(content_range("bytes 0-99/1234"), Some((0..100, 1234)));
        for text in
            ["bytes 9-3/1234", "bytes 0-99/*", "items 0-9/10", "bytes */10", "", "bytes 0-18446744073709551615/9"]
        {
            assert_eq!(content_range(text), None, "{text}");
        }
    }

    #[test]
    fn only_what_was_asked_for_is_an_answer() {
        assert!(is_answer(&(10..20), &(10..20), 100));
        assert!(is_answer(&(10..15), &(10..20), 15));
        assert!(!is_answer(&(10..15), &(10..20), 100));
        assert!(!is_answer(&(11..20), &(10..20), 100));
    }
}

//! Files read whole, however long they say to be, but not without an end.

use crate::{in_memory, without_disk};
use std::fs::File;
use std::io::{self, Cursor, ErrorKind, Read};
use std::path::Path;

/// Most bytes of what is no file with a length of its own: a pipe, a device.
const MOST_BYTES: u64 = 1 << 29;

/// All bytes of a file in memory or on the disk. A pipe is read to its end too, up to 512 MiB; what goes on beyond, as `/dev/zero` does for ever, is refused.
///
/// # Errors
/// What the system says, and where there is no disk, that the file is not in memory; [`ErrorKind::FileTooLarge`] where there is
/// no end.
pub fn read_bytes(path: &Path) -> io::Result<Vec<u8>> {
    if let Some(bytes) = in_memory(path) {
        return Ok(bytes.to_vec());
    }
    let file = File::open(path).map_err(without_disk)?;
    let told = file.metadata()?;
    let length = if told.is_file() { told.len() } else { 0 };
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(length).unwrap_or(usize::MAX))?;
    read_at_most(file, length.max(MOST_BYTES), &mut bytes)?;
    Ok(bytes)
}

/// A file in memory or on the disk, to be read, and how many bytes it says that it has.
///
/// # Errors
/// As [`read_bytes`].
pub fn open_file(path: &Path) -> io::Result<(Box<dyn Read>, u64)> {
    if let Some(bytes) = in_memory(path) {
        let length = bytes.len() as u64;
        return Ok((Box::new(Cursor::new(bytes)), length));
    }
    let file = File::open(path).map_err(without_disk)?;
    let length = file.metadata()?.len();
    Ok((Box::new(file), length))
}

/// All text of a file, as [`read_bytes`] reads it.
///
/// # Errors
/// As there; [`ErrorKind::InvalidData`] where it is not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    let no_text = |_| io::Error::new(ErrorKind::InvalidData, "it is no text in UTF-8");
    String::from_utf8(read_bytes(path)?).map_err(no_text)
}

fn read_at_most(source: impl Read, most: u64, bytes: &mut Vec<u8>) -> io::Result<()> {
    source.take(most + 1).read_to_end(bytes)?;
    if bytes.len() as u64 <= most {
        return Ok(());
    }
    let what = format!("it goes on beyond {most} bytes; name a file that has an end");
    Err(io::Error::new(ErrorKind::FileTooLarge, what))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "über\n").unwrap();
        assert_eq!(read_text(&path).unwrap(), "über\n");
        std::fs::write(&path, [0xff]).unwrap();
        assert_eq!(read_bytes(&path).unwrap(), [0xff]);
        assert_eq!(read_text(&path).unwrap_err().kind(), ErrorKind::InvalidData);
        assert_eq!(read_text(&folder.path().join("none")).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[test]
    fn what_has_no_end_is_refused() {
        let (mut bytes, endless) = (Vec::new(), || io::repeat(b'1'));
        read_at_most(endless().take(100), 100, &mut bytes).unwrap();
        assert_eq!(bytes.len(), 100);
        bytes.clear();
        let error = read_at_most(endless(), 100, &mut bytes).unwrap_err();
        assert!(error.kind() == ErrorKind::FileTooLarge && bytes.len() == 101, "{error}");
        #[cfg(unix)]
        assert_eq!(read_bytes(Path::new("/dev/zero")).unwrap_err().kind(), ErrorKind::FileTooLarge);
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_read_to_its_end() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("pipe");
        if !std::process::Command::new("mkfifo").arg(&path).status().is_ok_and(|status| status.success()) {
            return eprintln!("skipped: needs mkfifo");
        }
        let to = path.clone();
        let writer = std::thread::spawn(move || std::fs::write(to, "a few\nlines\n"));
        assert_eq!(read_text(&path).unwrap(), "a few\nlines\n");
        writer.join().unwrap().unwrap();
    }
}

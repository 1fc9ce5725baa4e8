//! HDF5 by the `rust-hdf5` library: attributes of text, filters.

use crate::error::Failed;
use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, H5Group};
use std::path::Path;

/// Level of Deflate, behind the shuffle filter: higher ones take much longer for a few percent.
pub(crate) const DEFLATE: u32 = 3;

/// Makes a file. Some network file systems have no locks, and the temporary file is written by nobody else.
pub(crate) fn create(path: &Path) -> Result<H5File, Failed> {
    Ok(H5File::options().no_locking().create(path)?)
}

/// What can have an attribute.
pub(crate) trait HasAttributes {
    /// Adds a text of fixed length, which every program reads.
    fn text(&self, name: &str, value: &str) -> Result<(), Failed>;
}

/// The type of a text of this length, and its bytes; a text without letters has one that is no letter.
fn fixed(value: &str) -> (DatatypeMessage, Vec<u8>) {
    let mut bytes = value.as_bytes().to_vec();
    bytes.resize(bytes.len().max(1), 0);
    let charset = u8::from(!value.is_ascii());
    (DatatypeMessage::FixedString { size: bytes.len() as u32, padding: 1, charset }, bytes)
}

impl HasAttributes for H5File {
    fn text(&self, name: &str, value: &str) -> Result<(), Failed> {
        let (datatype, bytes) = fixed(value);
        Ok(self.set_attr_typed(name, datatype, bytes)?)
    }
}

impl HasAttributes for H5Group {
    fn text(&self, name: &str, value: &str) -> Result<(), Failed> {
        let (datatype, bytes) = fixed(value);
        Ok(self.set_attr_typed(name, datatype, bytes)?)
    }
}

impl HasAttributes for H5Dataset {
    fn text(&self, name: &str, value: &str) -> Result<(), Failed> {
        let (datatype, bytes) = fixed(value);
        Ok(self.set_attr_typed(name, datatype, bytes)?)
    }
}

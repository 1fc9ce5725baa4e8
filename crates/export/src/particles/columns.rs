//! Columns of particles that grow frame by frame.

use crate::error::Failed;
use crate::hdf5::DEFLATE;
use rust_hdf5::{H5Dataset, H5Group, H5Type};

/// Rows of a chunk.
const CHUNK: usize = 1 << 14;

/// A dataset that grows by rows: of one value, or of several.
pub(super) struct Rows {
    dataset: H5Dataset,
    width: usize,
}

impl Rows {
    /// A dataset without rows. More than one value in a row makes it two-dimensional.
    pub(super) fn create<T: H5Type>(group: &H5Group, name: &str, width: usize) -> Result<Self, Failed> {
        let builder = group.new_dataset::<T>();
        let builder = match width {
            1 => builder.shape([0]).max_shape(&[None]).chunk(&[CHUNK]),
            _ => builder.shape([0, width]).max_shape(&[None, Some(width)]).chunk(&[CHUNK, width]),
        };
        Ok(Self { dataset: builder.shuffle_deflate(DEFLATE).create(name)?, width })
    }

    /// Adds rows.
    pub(super) fn append<T: H5Type>(&self, values: &[T]) -> Result<(), Failed> {
        if values.is_empty() {
            return Ok(());
        }
        Ok(self.dataset.append(values)?)
    }

    /// Adds so many rows that hold no number.
    pub(super) fn append_nothing(&self, rows: usize) -> Result<(), Failed> {
        let block = vec![f64::NAN; CHUNK * self.width];
        for first in (0..rows).step_by(CHUNK) {
            self.append(&block[..(rows - first).min(CHUNK) * self.width])?;
        }
        Ok(())
    }
}

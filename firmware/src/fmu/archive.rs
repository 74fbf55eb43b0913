//! The archive of a functional mock-up unit.

use rungc_emit::OutFile;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Reason why a unit was not packed.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    /// The archive cannot hold the files.
    #[error("the FMU cannot be packed: {0}")]
    Zip(#[from] zip::result::ZipError),
    /// A file cannot be written.
    #[error("the FMU cannot be written: {0}")]
    Io(#[from] std::io::Error),
}

/// Packs files in this order, all with the earliest time there is. The first one is not compressed.
pub(super) fn pack(files: &[OutFile<Vec<u8>>]) -> Result<Vec<u8>, ArchiveError> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (i, file) in files.iter().enumerate() {
        let method = match i {
            0 => CompressionMethod::Stored,
            _ => CompressionMethod::Deflated,
        };
        let options = SimpleFileOptions::default()
            .compression_method(method)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644);
        zip.start_file(&file.path, options)?;
        zip.write_all(&file.contents)?;
    }
    Ok(zip.finish()?.into_inner())
}

use std::fs::File;
use std::io::Read;
use std::path::Path;

use roxmltree::{Error, TextPos};

use super::decode::{Decoded, decode};
use crate::io::ImportError;
use crate::io::load::{check_is_file, starts_like_xml};
use crate::io::progress::{LoadStage, Reporter};

/// The largest file: the parser counts positions in 32 bits.
const BYTE_LIMIT: u64 = u32::MAX as u64;
const BLOCK: usize = 1 << 22;

/// Reads a file as text; also gives its size in bytes.
///
/// # Errors
/// Whatever keeps the file from being text that starts like XML.
pub(super) fn read_text(
    path: &Path,
    reporter: &mut Reporter<'_>,
) -> Result<(Decoded, u64), ImportError> {
    let expected = check_is_file(path)?;
    let too_large = |bytes| ImportError::TooLarge {
        path: path.to_owned(),
        bytes,
        limit: BYTE_LIMIT,
    };
    if expected > BYTE_LIMIT {
        return Err(too_large(expected));
    }
    let failed = |error| ImportError::from_io(path, error);
    let mut file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    loop {
        reporter.at(
            LoadStage::Reading,
            (bytes.len() as f32 / expected.max(1) as f32).min(1.0),
        )?;
        let read = (&mut file)
            .take(BLOCK as u64)
            .read_to_end(&mut bytes)
            .map_err(failed)?;
        if read == 0 {
            break;
        }
        if bytes.len() as u64 > BYTE_LIMIT {
            return Err(too_large(bytes.len() as u64));
        }
    }
    let size = bytes.len() as u64;
    check_start(path, &bytes)?;
    let decoded = decode(bytes);
    // Two bytes of UTF-16 can become three.
    if decoded.text.len() as u64 > BYTE_LIMIT {
        return Err(too_large(decoded.text.len() as u64));
    }
    Ok((decoded, size))
}

fn check_start(path: &Path, bytes: &[u8]) -> Result<(), ImportError> {
    let path = path.to_owned();
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(ImportError::Empty { path });
    }
    if starts_like_xml(bytes) {
        return Ok(());
    }
    let found = match bytes {
        [b'P', b'K', 3, 4, ..] => "a zip archive (as in .zae)",
        [b'g', b'l', b'T', b'F', ..] => "glTF",
        _ => "a file whose first sign is not < as in XML",
    };
    Err(ImportError::UnsupportedFormat {
        path,
        found: found.to_owned(),
    })
}

/// The import error for a parser's error in `text`.
pub(super) fn xml_error(path: &Path, text: &str, error: &Error) -> ImportError {
    let path = path.to_owned();
    let line_of = |end: usize| 1 + text[..end].bytes().filter(|b| *b == b'\n').count() as u32;
    match error {
        Error::DtdDetected => ImportError::DocumentType {
            path,
            line: line_of(text.find("<!DOCTYPE").unwrap_or(0)),
        },
        Error::UnexpectedEndOfStream | Error::UnclosedRootNode => ImportError::CutOff {
            path,
            line: line_of(text.trim_end().len()),
        },
        _ => {
            let TextPos { row, col } = error.pos();
            let problem = error.to_string();
            let problem = problem.replace(&format!(" at {row}:{col}"), "");
            ImportError::Xml {
                path,
                line: row,
                column: col,
                problem,
            }
        }
    }
}

//! The secret of the page's address.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::Path;

/// Name of the file.
const FILE: &str = "page-token";

/// Length of a token in characters: 128 bits as hexadecimal digits.
const LENGTH: usize = 32;

/// The token that a folder of the user keeps, so that the address of a page lives on over a restart; a new one the
/// first time. Only the user can read it. Where it cannot be kept, each run has its own.
///
/// # Errors
/// A system without random numbers.
pub fn token(folder: Option<&Path>) -> io::Result<String> {
    let new = random()?;
    let Some(folder) = folder else {
        return Ok(new);
    };
    let path = folder.join(FILE);
    if keep(&path, &new).is_ok() {
        return Ok(new);
    }
    match fs::read_to_string(&path) {
        Ok(kept) if is_token(&kept) => Ok(kept),
        _ => Ok(new),
    }
}

/// Writes the token if there is none yet.
fn keep(path: &Path, token: &str) -> io::Result<()> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(path)?.write_all(token.as_bytes())
}

fn is_token(text: &str) -> bool {
    text.len() == LENGTH && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Random bits as hexadecimal digits.
fn random() -> io::Result<String> {
    let mut bytes = [0; LENGTH / 2];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_lives_on_if_it_can_be_kept() {
        let folder = tempfile::tempdir().unwrap();
        let first = token(Some(folder.path())).unwrap();
        assert!(is_token(&first));
        assert_eq!(token(Some(folder.path())).unwrap(), first);
        assert_ne!(token(None).unwrap(), first);
        let missing = folder.path().join("missing");
        assert_ne!(token(Some(&missing)).unwrap(), first);
        // A damaged file gives no token that could be guessed.
        fs::write(folder.path().join(FILE), "").unwrap();
        assert_ne!(token(Some(folder.path())).unwrap(), "");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let other = tempfile::tempdir().unwrap();
            token(Some(other.path())).unwrap();
            let mode = fs::metadata(other.path().join(FILE)).unwrap().permissions();
            assert_eq!(mode.mode() & 0o077, 0);
        }
    }
}

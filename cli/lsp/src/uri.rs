//! Files by the addresses that editors have for them.

use gen_lsp_types::Uri;
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, percent_encode};
use std::path::{Path, PathBuf};

/// Bytes that an address holds in another form.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'/')
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~');

/// The file at an address; `None` if it is not that of a file, such as that of a text without a name.
pub(crate) fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.0.strip_prefix("file://")?;
    let path = &rest[rest.find('/')?..];
    let bytes: Vec<u8> = percent_decode_str(path).collect();
    let text = String::from_utf8(bytes).ok()?;
    // `/c:/folder`
    let drive = text.as_bytes().get(2) == Some(&b':');
    let text = match cfg!(windows) && drive {
        true => &text[1..],
        false => &text,
    };
    (!text.contains('\0')).then(|| PathBuf::from(text))
}

/// The address of a file.
pub(crate) fn of(path: &Path) -> Uri {
    let absolute = std::path::absolute(path);
    let path = absolute.as_deref().unwrap_or(path);
    let name = match cfg!(windows) {
        true => format!("/{}", path.display())
            .replace('\\', "/")
            .into_bytes(),
        false => path.as_os_str().as_encoded_bytes().to_vec(),
    };
    Uri(format!("file://{}", percent_encode(&name, ESCAPED)))
}

/// The last part of an address, as a file is called.
pub(crate) fn name(uri: &Uri) -> String {
    let last = uri.0.rsplit(['/', ':']).next().unwrap_or_default();
    percent_decode_str(last).decode_utf8_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::{name, of, path};
    use gen_lsp_types::Uri;
    use std::path::Path;

    #[test]
    #[cfg(unix)]
    fn addresses_of_files_lead_back() {
        for file in ["/tmp/a b/启动.il", "/x%20y/[1]#?.il"] {
            assert_eq!(path(&of(Path::new(file))).as_deref(), Some(Path::new(file)));
        }
        let of_editor = Uri("file:///c%3A/Press/%E5%90%AF.il".into());
        assert_eq!(
            path(&of_editor).as_deref(),
            Some(Path::new("/c:/Press/启.il"))
        );
        assert_eq!(name(&of_editor), "启.il");
    }

    #[test]
    fn other_addresses_are_not_files() {
        for uri in [
            "untitled:Untitled-1",
            "file:",
            "file://host",
            "file:///%FF",
            "file:///a%00",
            "",
        ] {
            assert_eq!(path(&Uri(uri.into())), None, "{uri}");
        }
    }
}

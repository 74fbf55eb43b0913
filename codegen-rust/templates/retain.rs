
/// Reports that latched devices cannot be saved.
fn report_unsaved(file: &RetainFile, saved: io::Result<bool>) {
    if let Err(error) = saved {
        report!("{}: {error}", file.path().display());
    }
}

//! Every conformance file can be loaded.

use rungc_sim::plctest;
use std::path::Path;

#[test]
fn every_file_loads() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance");
    let mut cases = 0;
    for part in ["h1u-h2u", "hm", "l01s"] {
        for entry in std::fs::read_dir(folder.join(part)).unwrap() {
            let file = plctest::load(&entry.unwrap().path()).unwrap_or_else(|e| panic!("{e}"));
            cases += file.cases.len();
        }
    }
    assert!(cases > 2700, "{cases}");
}

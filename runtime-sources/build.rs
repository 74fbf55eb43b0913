//! Has the sources embedded again when a file appears or goes away.

fn main() {
    println!("cargo::rerun-if-changed=../runtime-rt");
}

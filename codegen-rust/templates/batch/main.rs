//! The batch on a host: standard input and output.

use std::io::{self, Read, Write};

fn main() {
    let mut input = io::stdin().lock();
    let mut output = io::stdout().lock();
    batch::serve(
        &mut |bytes| input.read(bytes).unwrap_or(0),
        // The reader is gone, so a failed write cannot be reported.
        &mut |bytes| drop(output.write_all(bytes).and_then(|()| output.flush())),
    );
}

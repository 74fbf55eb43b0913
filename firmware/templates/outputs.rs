fn print(text: &core::ffi::CStr) {
    semihosting(0x04, text.as_ptr() as usize); // SYS_WRITE0
}

/// Prints the time, as seconds with three digits after the point.
fn print_time(mut ms: u32) {
    let mut text = *b"      0.000 s  \0";
    let mut at = 10;
    let mut digits = 0;
    while digits < 4 || ms != 0 {
        if digits == 3 {
            at -= 1; // the point
        }
        text[at] = b'0' + (ms % 10) as u8;
        ms /= 10;
        at = at.saturating_sub(1);
        digits += 1;
    }
    semihosting(0x04, text.as_ptr() as usize);
}

/// Output terminals: number, name and what is printed after the state: a comment.
const OUTPUTS: [(u32, &core::ffi::CStr, &core::ffi::CStr); /* COUNT */] = [
/* TABLE */];

/// Prints the outputs that changed.
fn show_outputs(driver: &Driver<TYPE, Pins>, shown: &mut [bool; OUTPUTS.len()]) {
    for ((number, name, comment), shown) in OUTPUTS.iter().zip(shown) {
        let on = driver.program.output(*number);
        if on != *shown {
            *shown = on;
            print_time(driver.now_ms());
            print(name);
            print(if on { c" on" } else { c" off" });
            print(comment);
            print(c"\n");
        }
    }
}


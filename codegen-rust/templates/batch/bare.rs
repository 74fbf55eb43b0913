//! The batch on bare metal: `main` and a panic's end, for a C library that does system calls by semihosting.

use core::ffi::{c_int, c_void};
use core::panic::PanicInfo;

unsafe extern "C" {
    fn read(file: c_int, bytes: *mut c_void, count: usize) -> c_int;
    fn write(file: c_int, bytes: *const c_void, count: usize) -> c_int;
    safe fn _exit(status: c_int) -> !;
}

const STDIN: c_int = 0;
const STDOUT: c_int = 1;

#[unsafe(no_mangle)]
extern "C" fn main() -> c_int {
    crate::serve(
        // SAFETY: the pointer and the length are those of a slice.
        &mut |bytes| {
            let count = unsafe { read(STDIN, bytes.as_mut_ptr().cast(), bytes.len()) };
            usize::try_from(count).unwrap_or(0)
        },
        // SAFETY: the same.
        &mut |bytes| {
            let count = unsafe { write(STDOUT, bytes.as_ptr().cast(), bytes.len()) };
            if usize::try_from(count) != Ok(bytes.len()) {
                _exit(1);
            }
        },
    );
    0
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    _exit(101)
}

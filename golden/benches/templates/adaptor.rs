//! An emitted program as a subject to measure (subject.h).
#![cfg_attr(target_os = "none", no_std)]
#![allow(unused_unsafe)]

use core::ffi::c_char;
use core::mem::MaybeUninit;
use rungc_rt::{NoHal, Program};

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

#[repr(C)]
pub struct Device {
    at: *const u8,
    bytes: u8,
}

#[repr(C)]
pub struct Subject {
    reset: extern "C" fn(),
    scan: extern "C" fn(u32),
    inputs: *const *mut u8,
    devices: *const Device,
    device_count: u32,
    name: *const c_char,
}

/// Pointers to statics, used by one thread.
#[repr(transparent)]
pub struct Shared<T>(T);
unsafe impl<T> Sync for Shared<T> {}

static mut NOWHERE: u8 = 0;
/// As C has it: without contents until it is reset.
static mut MEMORY: MaybeUninit<@PROGRAM@> = MaybeUninit::uninit();
const PLC: *mut @PROGRAM@ = &raw mut MEMORY as *mut @PROGRAM@;

extern "C" fn reset() {
    unsafe { PLC.write(<@PROGRAM@>::new()) }
}

#[unsafe(no_mangle)]
pub extern "C" fn @PREFIX@_one_scan(now_ms: u32) {
    unsafe { (*PLC).scan(&mut NoHal, now_ms, 0) }
}

static INPUTS: Shared<[*mut u8; @INPUTS@]> = Shared(unsafe { [
@INPUT_LIST@] });

static DEVICES: Shared<[Device; @DEVICES@]> = Shared(unsafe { [
@DEVICE_LIST@] });

#[unsafe(no_mangle)]
pub static @PREFIX@_subject: Shared<Subject> = Shared(Subject {
    reset,
    scan: @PREFIX@_one_scan,
    inputs: &raw const INPUTS.0 as *const *mut u8,
    devices: &raw const DEVICES.0 as *const Device,
    device_count: @DEVICES@,
    name: c"@PREFIX@".as_ptr(),
});

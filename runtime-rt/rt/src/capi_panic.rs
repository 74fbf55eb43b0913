//! Panic handler of the static library without the standard library: only a bug reaches it, as this crate never panics
//! on any input.

use core::panic::PanicInfo;

#[cfg(not(target_os = "none"))]
unsafe extern "C" {
    safe fn abort() -> !;
}

#[cfg(not(target_os = "none"))]
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    abort()
}

/// On bare metal the hardware's watchdog ends it.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {
        core::hint::spin_loop();
    }
}

/// The unwinder's hook, which the precompiled `core` names. Nothing unwinds here.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

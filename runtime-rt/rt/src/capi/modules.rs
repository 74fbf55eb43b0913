//! Special modules for hosts in C whose converters are to look like one.

use crate::modules::{KINDS, Module, Quantity, Signal};
use core::mem::{align_of, size_of};

/// A special module at work. It is not to be copied, and takes no call before rungc_module_fit.
#[derive(Debug)]
#[repr(C)]
pub struct ModuleRoom {
    /// Room for it.
    pub words: [u64; 256],
}

const _: () = assert!(
    size_of::<Module>() <= size_of::<ModuleRoom>()
        && align_of::<Module>() <= align_of::<ModuleRoom>()
);

impl ModuleRoom {
    fn module(&mut self) -> &mut Module {
        // SAFETY: rungc_module_fit has put a module here, which fits, as is checked above.
        unsafe { &mut *(&raw mut *self).cast::<Module>() }
    }
}

/// Puts a module of a kind, by its number in the table of kinds, as it comes from the factory; false if there is no
/// such kind.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_fit(module: &mut ModuleRoom, kind: u16) -> bool {
    let Some(kind) = KINDS.get(usize::from(kind)) else {
        return false;
    };
    let place = (&raw mut *module).cast::<Module>();
    // SAFETY: there is room for a module, which needs nothing done when it ends.
    unsafe { place.write(Module::new(kind)) };
    true
}

/// Connects a signal to a channel; channels are counted from 0, and the signal is in millionths of a volt (quantity 0),
/// of a milliampere (1) or of a degree Celsius (2). False if there is no such input.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_connect(
    module: &mut ModuleRoom,
    channel: u8,
    quantity: u8,
    millionths: i32,
) -> bool {
    let signal = Quantity::of(quantity).map(|quantity| Signal {
        quantity,
        millionths,
    });
    let connected = signal.and_then(|signal| module.module().connect(channel, signal));
    connected.is_some()
}

/// Output signal of a channel, in millionths of that unit; 0 if it outputs no such quantity.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_signal(module: &mut ModuleRoom, channel: u8, quantity: u8) -> i32 {
    let quantity = Quantity::of(quantity);
    let signal = quantity.and_then(|quantity| module.module().signal(channel, quantity));
    signal.unwrap_or(0)
}

/// Microseconds pass: the module converts its inputs.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_pass(module: &mut ModuleRoom, microseconds: u32) {
    module.module().pass(microseconds);
}

/// Reads a word of buffer memory; false if the module does not have that many.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_read(
    module: &mut ModuleRoom,
    address: u16,
    value: &mut i16,
) -> bool {
    let word = module.module().read(address);
    *value = word.unwrap_or(*value);
    word.is_some()
}

/// Writes a word of buffer memory; false if the module does not have that many.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_module_write(module: &mut ModuleRoom, address: u16, value: i16) -> bool {
    module.module().write(address, value).is_some()
}

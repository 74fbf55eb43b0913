//! The list of runtime functions. The catalogue names one in a row's `lower`; the interpreter calls it through
//! [`RtFn::call`], emitted Rust through the function of the same name in [`crate::fnc`], emitted C through the C ABI.

use crate::cx::Cx;
use crate::fault::Done;
use crate::fnc;

/// What a function needs from the program around it.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Needs {
    /// Private memory ([`crate::State`]).
    pub state: bool,
    /// Is called in every scan, with [`crate::Site::drive`] telling whether it is driven.
    pub always: bool,
    /// Asks the hardware ([`crate::Hal`]).
    pub hal: bool,
}

macro_rules! registry {
    ($($(#[$doc:meta])* $variant:ident = $module:ident::$function:ident($($operand:ident),*) $([$($need:ident),*])?;)*) => {
        /// A runtime function.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum RtFn { $($(#[$doc])* $variant,)* }

        impl RtFn {
            /// All of them.
            pub const ALL: &'static [RtFn] = &[$(RtFn::$variant),*];

            /// Name of the function in [`crate::fnc`] and, behind `rungc_`, in the C ABI.
            pub const fn name(self) -> &'static str {
                match self { $(RtFn::$variant => stringify!($function),)* }
            }

            /// The module of [`crate::fnc`] it stands in.
            pub const fn module(self) -> &'static str {
                match self { $(RtFn::$variant => stringify!($module),)* }
            }

            /// Names of its operands.
            pub const fn operands(self) -> &'static [&'static str] {
                match self { $(RtFn::$variant => &[$(stringify!($operand)),*],)* }
            }

            /// What it needs.
            pub const fn needs(self) -> Needs {
                #[allow(unused_mut, reason = "functions that need nothing change nothing")]
                match self { $(RtFn::$variant => {
                    let mut needs = Needs { state: false, always: false, hal: false };
                    $($(needs.$need = true;)*)?
                    needs
                })* }
            }

            /// Runs it.
            pub fn call(self, cx: &mut Cx) -> Done {
                match self { $(RtFn::$variant => fnc::$module::$function(cx),)* }
            }
        }
    };
}

registry! {
    /// SUM (FNC 43): counts the one-bits of S into D.
    Sum = data::sum(s, d);
}

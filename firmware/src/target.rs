//! The machines that libraries and images are built for: one row each.

use rungc_runtime_sources::library::Optimise;

/// A machine that code is built for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Target {
    /// The name by which rustc knows it; `host` for this machine.
    pub triple: &'static str,
    /// Its description, for messages.
    pub title: &'static str,
    /// Its C compiler.
    pub cc: &'static str,
    /// Archiver for its objects.
    pub ar: &'static str,
    /// Debian's packages with these tools and a C library.
    pub packages: &'static str,
    /// Options that select the processor for the C compiler.
    pub flags: &'static str,
    /// System below a program.
    pub system: System,
}

/// System below a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum System {
    /// Nothing: images are for a board.
    Bare,
    /// Linux, or what this machine has: executables.
    Linux,
}

const HOST: Target = Target {
    triple: "host",
    title: "this machine",
    cc: "cc",
    ar: "ar",
    packages: "gcc libc6-dev",
    flags: "",
    system: System::Linux,
};

const BARE_PACKAGES: &str = "gcc-arm-none-eabi libnewlib-arm-none-eabi";

const fn cortex(triple: &'static str, title: &'static str, flags: &'static str) -> Target {
    Target {
        triple,
        title,
        cc: "arm-none-eabi-gcc",
        ar: "arm-none-eabi-ar",
        packages: BARE_PACKAGES,
        flags,
        system: System::Bare,
    }
}

/// The microcontroller of most boards, and of the benchmarks.
pub const CORTEX_M4F: Target = cortex(
    "thumbv7em-none-eabihf",
    "Cortex-M4F and M7F",
    "-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16",
);

/// All of them.
pub static ALL: [Target; 9] = [
    HOST,
    cortex(
        "thumbv6m-none-eabi",
        "Cortex-M0, M0+",
        "-mcpu=cortex-m0 -mthumb -mfloat-abi=soft",
    ),
    cortex(
        "thumbv7m-none-eabi",
        "Cortex-M3",
        "-mcpu=cortex-m3 -mthumb -mfloat-abi=soft",
    ),
    cortex(
        "thumbv7em-none-eabi",
        "Cortex-M4 and M7 without floating point unit",
        "-mcpu=cortex-m4 -mthumb -mfloat-abi=soft",
    ),
    CORTEX_M4F,
    Target {
        triple: "x86_64-unknown-linux-gnu",
        title: "64-bit PC Linux",
        cc: "x86_64-linux-gnu-gcc",
        ar: "x86_64-linux-gnu-ar",
        packages: "gcc-x86-64-linux-gnu libc6-dev",
        flags: "",
        system: System::Linux,
    },
    Target {
        triple: "x86_64-unknown-linux-musl",
        title: "64-bit PC Linux, without shared libraries",
        cc: "musl-gcc",
        ar: "ar",
        packages: "musl-tools",
        flags: "-static",
        system: System::Linux,
    },
    Target {
        triple: "aarch64-unknown-linux-gnu",
        title: "64-bit Arm Linux",
        cc: "aarch64-linux-gnu-gcc",
        ar: "aarch64-linux-gnu-ar",
        packages: "gcc-aarch64-linux-gnu libc6-dev-arm64-cross",
        flags: "",
        system: System::Linux,
    },
    Target {
        triple: "armv7-unknown-linux-gnueabihf",
        title: "32-bit Arm Linux",
        cc: "arm-linux-gnueabihf-gcc",
        ar: "arm-linux-gnueabihf-ar",
        packages: "gcc-arm-linux-gnueabihf libc6-dev-armhf-cross",
        flags: "",
        system: System::Linux,
    },
];

/// The machine that rungc runs on.
pub fn host() -> &'static Target {
    &ALL[0]
}

/// The target of this name.
pub fn find(triple: &str) -> Option<&'static Target> {
    ALL.iter().find(|target| target.triple == triple)
}

impl Target {
    /// The name as it appears in names of variables: `thumbv7em_none_eabihf`.
    pub fn variable(&self) -> String {
        self.triple.replace('-', "_")
    }

    /// The environment's variable that names a C compiler for it.
    pub(crate) fn compiler_variable(&self) -> String {
        match self.rustc_name() {
            Some(_) => format!("CC_{}", self.variable()),
            None => "CC".to_string(),
        }
    }

    /// The argument of `--target` for rustc and cargo; `None` for this machine.
    pub fn rustc_name(&self) -> Option<&'static str> {
        (*self != HOST).then_some(self.triple)
    }

    /// Returns true if there is no system below a program.
    pub fn is_bare(&self) -> bool {
        self.system == System::Bare
    }

    /// Optimisation of its code.
    pub fn optimise(&self) -> Optimise {
        match self.system {
            System::Bare => Optimise::Size,
            System::Linux => Optimise::Speed,
        }
    }

    /// Returns true if code is built for it with a floating point unit, which is off after reset.
    pub(crate) fn has_fpu(&self) -> bool {
        self.is_bare() && self.triple.ends_with("hf")
    }
}

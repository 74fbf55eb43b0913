//! The Makefile beside emitted C, of one program or of several.

use crate::files::Shared;
use crate::parts::Runtime;
use std::fmt::Write;

/// Path of the runtime library; `make` needs it before the first rule that uses it.
const LIBRARY_PATH: &str = "\
# The runtime library: `make TARGET=thumbv7em-none-eabihf CC=arm-none-eabi-gcc` for a microcontroller (rustup target add ...).
# It is built from the sources in rungc-rt, without a network; RUNGC_RT=path/to/@LIBRARY@ names one that is built already.
CARGO ?= cargo
ifdef TARGET
TARGET_FLAG = --target $(TARGET)
endif
# The crates of a standard library that cargo builds itself (-Zbuild-std) may come from the registry.
OFFLINE ?= $(if $(CARGO_UNSTABLE_BUILD_STD)$(findstring build-std,$(CARGOFLAGS)),,--offline)
RUNTIME_OPT ?= $(if $(TARGET),s,3)
# For size, the runtime is optimised with the part of the standard library that it uses.
RUNTIME_PROFILE = $(if $(filter s z,$(RUNTIME_OPT)),CARGO_PROFILE_RELEASE_LTO=fat CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1)
LIBRARY = $(or $(RUNGC_RT),rungc-rt/target/$(if $(TARGET),$(TARGET)/)release/@LIBRARY@)
RUNTIME_FEATURES = @FEATURES@
";

/// System libraries that the standard library of Rust needs.
const STD_LIBRARIES: &str = "\
override LDFLAGS += -s $(if $(findstring windows,$(TARGET)),-lws2_32 -luserenv -lntdll,-lpthread -ldl -lm)
";

/// Build rule.
const LIBRARY_RULE: &str = "\
ifndef RUNGC_RT
$(LIBRARY): $(shell find@FOLDERS@ -name '*.rs') rungc-rt/Cargo.toml
\tcd rungc-rt && CARGO_PROFILE_RELEASE_OPT_LEVEL=$(RUNTIME_OPT) $(RUNTIME_PROFILE) $(CARGO) rustc --release --locked $(OFFLINE) --target-dir target \\
\t\t--crate-type staticlib@PACKAGE@ --features $(RUNTIME_FEATURES) $(TARGET_FLAG) $(CARGOFLAGS)
endif

";

/// Crate that the runtime library is built from.
pub(crate) struct Source {
    /// File of the library, as cargo names it.
    pub(crate) library: &'static str,
    /// Argument that names the package; empty for the one in the folder `rungc-rt`.
    package: &'static str,
    features: &'static str,
    /// Folders of sources in `rungc-rt`.
    pub(crate) folders: &'static [&'static str],
}

/// What runs on a microcontroller.
const TARGET: Source = Source {
    library: "librungc_rt.a",
    package: "",
    features: "staticlib",
    folders: &["src", "libm"],
};

/// The same with a host's services.
const HOST: Source = Source {
    library: "librungc_host.a",
    package: " --package rungc-host",
    features: "capi",
    folders: &["src", "libm", "host"],
};

impl Source {
    /// The crate for a library with or without the standard library.
    pub(crate) const fn new(std: bool) -> &'static Self {
        if std { &HOST } else { &TARGET }
    }

    /// Puts its names into a text for a build system.
    pub(crate) fn in_text(&self, text: &str) -> String {
        text.replace("@LIBRARY@", self.library)
            .replace("@PACKAGE@", self.package)
            .replace("@FEATURES@", self.features)
    }
}

/// Build recipe of a program.
#[derive(Clone, Debug)]
pub struct Recipe {
    /// The program's name.
    pub(crate) name: String,
    /// Folder of its files: a path that ends with `/`, or empty for the folder of the Makefile.
    pub(crate) folder: String,
    /// Its sources, in that folder.
    pub(crate) sources: Vec<String>,
    /// Its own headers, in that folder.
    pub(crate) headers: Vec<String>,
    /// True if there is a `main.c` among the sources: then an executable is built, otherwise a library of the objects.
    pub(crate) main: bool,
    /// Parts shared with other programs.
    pub(crate) shared: Shared,
}

impl Recipe {
    /// Returns true if its main program has a thread, which saves latched devices.
    pub(crate) fn has_thread(&self) -> bool {
        self.main && self.shared.retain
    }

    fn target(&self) -> String {
        let Recipe { name, folder, .. } = self;
        match self.main {
            true => format!("{folder}{name}"),
            false => format!("{folder}lib{name}.a"),
        }
    }

    /// The variable that lists its objects, among those of `count` programs.
    fn objects(&self, count: usize) -> String {
        match count {
            1 => "OBJECTS".to_string(),
            _ => format!("OBJECTS_{}", self.name),
        }
    }

    /// Its objects as a list for a Makefile, with those of the runtime in C if it calls that.
    fn object_files(&self, runtime: &Runtime) -> String {
        let own = self.sources.iter();
        let own = own.map(|source| format!("{}{source}", self.folder));
        let parts = runtime.parts().filter(|_| self.shared.calls_runtime());
        let parts = parts.into_iter().flat_map(|parts| parts.paths(".c"));
        let sources = own.chain(parts.map(String::from));
        let objects = sources.map(|source| source.replace(".c", ".o"));
        objects.collect::<Vec<_>>().join(" ")
    }

    /// Returns true if it links the runtime library.
    pub(crate) fn links_library(&self, runtime: &Runtime) -> bool {
        runtime.is_library() && self.shared.calls_runtime()
    }

    /// The rules for its target and its objects.
    fn rules(&self, text: &mut String, count: usize, runtime: &Runtime) {
        let (target, objects) = (self.target(), self.objects(count));
        let library = library(self.links_library(runtime));
        let _ = match self.main {
            true => writeln!(
                text,
                "{target}: $({objects}){library}\n\t$(CC) $(CFLAGS) -o $@ $({objects}){library} $(LDFLAGS)\n"
            ),
            false => writeln!(
                text,
                "{target}: $({objects})\n\t$(AR) rcs $@ $({objects})\n"
            ),
        };
        let own = self
            .headers
            .iter()
            .map(|path| format!("{}{path}", self.folder));
        let parts = runtime.parts().into_iter();
        let parts = parts.flat_map(|parts| parts.paths(".h"));
        let shared = self.shared.headers().chain(parts).map(String::from);
        let headers: Vec<String> = own.chain(shared).collect();
        let _ = writeln!(text, "$({objects}): {}\n", headers.join(" "));
    }
}

/// The runtime library as one more file, if it is needed.
fn library(runtime: bool) -> &'static str {
    if runtime { " $(LIBRARY)" } else { "" }
}

/// A Makefile that builds all programs, of which none has the name of another; those that call the runtime link this
/// one.
pub(crate) fn makefile(recipes: &[Recipe], linked: &Runtime) -> String {
    let count = recipes.len();
    let runtime = linked.is_library();
    let std = recipes.iter().any(|recipe| recipe.shared.std);
    let source = Source::new(std);
    let targets: Vec<String> = recipes.iter().map(Recipe::target).collect();
    let targets = targets.join(" ");
    let links = recipes.iter().any(|recipe| !recipe.main);
    let what = match (links, runtime) {
        (true, true) if count == 1 => format!(
            "{targets} and $(LIBRARY), both to be linked with your firmware (-Wl,--gc-sections)"
        ),
        (true, true) => format!(
            "{targets} and $(LIBRARY), all to be linked with your firmware (-Wl,--gc-sections)"
        ),
        _ => targets.clone(),
    };
    let mut text = format!(
        "# `make` builds {what}; `make CC=arm-none-eabi-gcc CFLAGS=...` builds for another machine.\n\
         # A microcontroller gets small code: -O2 may be several times as large.\n\
         SMALL := $(findstring none-,$(TARGET)$(CC))$(findstring avr-,$(TARGET)$(CC))\n\
         CFLAGS ?= -std=c99 $(if $(SMALL),-Os,-O2) -Wall -Wextra -Wconversion -pedantic -ffunction-sections -fdata-sections\n\
         LDFLAGS ?= -Wl,--gc-sections\n"
    );
    if recipes.iter().any(Recipe::has_thread) {
        text.push_str("# A thread saves latched devices.\noverride LDFLAGS += -pthread\n");
    }
    if recipes.iter().any(|recipe| !recipe.folder.is_empty()) {
        text.push_str("# Headers that all programs share are here.\noverride CPPFLAGS += -I.\n");
    }
    for recipe in recipes {
        let _ = writeln!(
            text,
            "{} = {}",
            recipe.objects(count),
            recipe.object_files(linked)
        );
    }
    if runtime {
        text.push_str(&source.in_text(LIBRARY_PATH));
        text.push_str(if std { STD_LIBRARIES } else { "" });
    }
    let _ = writeln!(text, "\nall: {targets}{}\n", library(runtime));
    if runtime {
        let folders = source.folders.iter();
        let folders: String = folders.map(|name| format!(" rungc-rt/{name}")).collect();
        let rule = source.in_text(LIBRARY_RULE);
        text.push_str(&rule.replace("@FOLDERS@", &folders));
    }
    for recipe in recipes {
        recipe.rules(&mut text, count, linked);
    }
    text.push_str("clean:\n\trm -rf");
    for recipe in recipes {
        let _ = write!(text, " $({})", recipe.objects(count));
    }
    let built = if runtime { " rungc-rt/target" } else { "" };
    let _ = writeln!(text, " {targets}{built}\n\n.PHONY: all clean");
    text
}

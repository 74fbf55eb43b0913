//! The Makefile beside emitted C, of one program or of several.

use crate::files::Shared;
use std::fmt::Write;

/// Path of the runtime library; `make` needs it before the first rule that uses it.
const LIBRARY_PATH: &str = "\
# The runtime library: `make TARGET=thumbv7em-none-eabihf CC=arm-none-eabi-gcc` for a microcontroller (rustup target add ...).
# It is built from the sources in rungc-rt, without a network; RUNGC_RT=path/to/librungc_rt.a names one that is built already.
CARGO ?= cargo
ifdef TARGET
TARGET_FLAG = --target $(TARGET)
endif
# The crates of a standard library that cargo builds itself (-Zbuild-std) may come from the registry.
OFFLINE ?= $(if $(CARGO_UNSTABLE_BUILD_STD)$(findstring build-std,$(CARGOFLAGS)),,--offline)
RUNTIME_OPT ?= $(if $(TARGET),s,3)
# For size, the runtime is optimised with the part of the standard library that it uses.
RUNTIME_PROFILE = $(if $(filter s z,$(RUNTIME_OPT)),CARGO_PROFILE_RELEASE_LTO=fat CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1)
LIBRARY = $(or $(RUNGC_RT),rungc-rt/target/$(if $(TARGET),$(TARGET)/)release/librungc_rt.a)
";

/// Features of the library, and the system libraries these need.
const PLAIN: &str = "RUNTIME_FEATURES = staticlib\n";
const WITH_STD: &str =
    "RUNTIME_FEATURES = staticlib,std\noverride LDFLAGS += -s -lpthread -ldl -lm\n";

/// Build rule.
const LIBRARY_RULE: &str = "\
ifndef RUNGC_RT
$(LIBRARY): $(shell find rungc-rt/src rungc-rt/libm -name '*.rs') rungc-rt/Cargo.toml
\tcd rungc-rt && CARGO_PROFILE_RELEASE_OPT_LEVEL=$(RUNTIME_OPT) $(RUNTIME_PROFILE) $(CARGO) rustc --release --locked $(OFFLINE) --target-dir target \\
\t\t--crate-type staticlib --features $(RUNTIME_FEATURES) $(TARGET_FLAG) $(CARGOFLAGS)
endif

";

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

    /// Its objects as a list for a Makefile.
    fn object_files(&self) -> String {
        let objects = self.sources.iter().map(|source| {
            let object = source.replace(".c", ".o");
            format!("{}{object}", self.folder)
        });
        objects.collect::<Vec<_>>().join(" ")
    }

    /// The rules for its target and its objects.
    fn rules(&self, text: &mut String, count: usize) {
        let (target, objects) = (self.target(), self.objects(count));
        let library = library(self.shared.runtime);
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
        let headers: Vec<String> = own.chain(self.shared.headers().map(String::from)).collect();
        let _ = writeln!(text, "$({objects}): {}\n", headers.join(" "));
    }
}

/// The runtime library as one more file, if it is needed.
fn library(runtime: bool) -> &'static str {
    if runtime { " $(LIBRARY)" } else { "" }
}

/// A Makefile that builds all programs, of which none has the name of another.
pub fn makefile(recipes: &[Recipe]) -> String {
    let count = recipes.len();
    let runtime = recipes.iter().any(|recipe| recipe.shared.runtime);
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
         CFLAGS ?= -std=c99 -O2 -Wall -Wextra -Wconversion -pedantic -ffunction-sections -fdata-sections\n\
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
            recipe.object_files()
        );
    }
    if runtime {
        text.push_str(LIBRARY_PATH);
        let std = recipes.iter().any(|recipe| recipe.shared.std);
        text.push_str(if std { WITH_STD } else { PLAIN });
    }
    let _ = writeln!(text, "\nall: {targets}{}\n", library(runtime));
    if runtime {
        text.push_str(LIBRARY_RULE);
    }
    for recipe in recipes {
        recipe.rules(&mut text, count);
    }
    text.push_str("clean:\n\trm -rf");
    for recipe in recipes {
        let _ = write!(text, " $({})", recipe.objects(count));
    }
    let built = if runtime { " rungc-rt/target" } else { "" };
    let _ = writeln!(text, " {targets}{built}\n\n.PHONY: all clean");
    text
}

//! Connections and log of a host; the runtime library implements them.

use crate::template;
use rungc_ir::Module;

/// The parts of a main program.
#[derive(Default)]
pub struct Parts {
    /// Functions.
    pub code: String,
    /// Before the first scan.
    pub begin: &'static str,
    /// Before each scan.
    pub take: &'static str,
    /// After each.
    pub give: &'static str,
    /// After the last.
    pub end: &'static str,
    /// With each line that is printed.
    pub note: &'static str,
    /// Before commands are read.
    pub commands: &'static str,
}

impl Parts {
    /// Puts them into a main program.
    pub fn in_main(&self, main: &str) -> String {
        let after = |mark: &str, part: &str| format!("{mark}{part}");
        main.replace("/* CLOCK */\n", &after("/* CLOCK */\n", &self.code))
            .replace(
                "        /* SERVE */\n",
                &after("        /* SERVE */\n", self.take),
            )
            .replace(
                "    /* CONNECTIONS */\n",
                &after("    /* CONNECTIONS */\n", self.end),
            )
            .replace("        /* GIVE */\n", self.give)
            .replace("    /* BEGIN */\n", self.begin)
            .replace("    /* NOTE */\n", self.note)
            .replace("    /* COMMANDS */\n", self.commands)
    }
}

/// The parts of a main program with connections; nothing of one without.
pub fn parts(module: &Module, io: bool) -> Parts {
    if !io {
        return Parts::default();
    }
    let edge = match module.takes_events() {
        true => "    PROGRAM_input_edge(context, number, on);\n",
        false => "    (void)context;\n    (void)number;\n    (void)on;\n",
    };
    Parts {
        code: template!("main_io.c").replace("    /* EDGE */\n", edge),
        begin: "    if (!io_begin(plc)) {\n        return 2;\n    }\n",
        take: "        io_read_inputs(plc);\n",
        give: "        io_write_outputs(plc);\n",
        end: "    rungc_io_end();\n",
        note: "    rungc_io_log(line);\n",
        commands: "    if (rungc_io_uses_stdin()) {\n        return;\n    }\n",
    }
}

/// The call for the value of an option.
pub fn option(module: &Module, function: &str) -> String {
    format!("rungc_io_{function}(\"{}\", argv[++i])", module.name)
}

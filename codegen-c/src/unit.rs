//! One module as C text: declarations, and functions in groups of bounded size.

use crate::fields::{PrintField, PrintStorage};
use crate::writer::{Writer, function_name};
use crate::{events, header, lanes, table};
use rungc_emit::cycle::{self, Budget, Latches, Services, Shown, Shows};
use rungc_emit::plan::Plan;
use rungc_emit::storage::{Field, Keep, Kind, Section, Storage};
use rungc_ir::Module;
use rungc_ir::node::{FunctionKind, STEPS_PER_MS};
use rungc_ir::walk::{calls_runtime, statements};
use rungc_rt::special::{M_KEEP_IN_STOP, M_OUTPUTS_OFF, Relay, WATCHDOG_CODE};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// About how many operations a source file may hold, so that none takes long to compile and `make -j` has something to
/// divide.
const FILE_WEIGHT: u64 = 60_000;

/// Up to how many output terminals a `switch` distinguishes.
const FEW_TERMINALS: usize = 8;

/// A module's C text.
pub struct Unit {
    /// Struct and prototypes of the API, for the header.
    pub api: String,
    /// True if the runtime library is needed.
    pub runtime: bool,
    /// Declarations that all groups need.
    pub internal: String,
    /// Functions of the program; the first group also holds those of the API.
    pub groups: Vec<String>,
}

/// Makes it. `by_number`: the host finds devices by number, so the device table is there even if no instruction needs
/// it. `misra`: conditions are Boolean expressions as MISRA C:2012 understands them (rule 14.4).
pub fn unit(module: &Module, by_number: bool, in_lanes: bool, misra: bool) -> Unit {
    let fields = Storage::new(module);
    let plan = match in_lanes {
        // Each memory of an edge is one of all lanes.
        true => Plan::without_ladders(module),
        false => Plan::new(module),
    };
    let total: u64 = plan.functions.iter().map(|f| f.weight).sum();
    let single = total <= FILE_WEIGHT;
    let storage = if single { "static " } else { "" };
    let runtime = by_number || uses_runtime(module);
    let mut writer = Writer::new(module, &plan, &fields);
    writer.boolean_conditions = misra;

    let mut groups = vec![String::new()];
    let mut weight = 0;
    for (index, function) in plan.functions.iter().enumerate() {
        weight += function.weight + 1;
        if weight > FILE_WEIGHT && !single {
            groups.push(String::new());
            weight = function.weight;
        }
        if let Some(group) = groups.last_mut() {
            writer.function(group, index, storage);
        }
    }

    let asked = Services::of(&plan);
    let helpers = std::mem::take(&mut writer.helpers);
    let mut internal = String::new();
    states(&mut internal, &writer, &plan);
    prototypes(&mut internal, &writer, &plan, single);
    helpers.write(&mut internal, module, &fields);
    let printer = Printer {
        module,
        fields: &fields,
        plan: &plan,
    };
    if asked.faults {
        printer.fault(&mut internal);
    }
    let latches = cycle::latches(module, &fields);
    if module.has_watchdog() {
        printer.watchdog(&mut internal);
    }
    // If the program itself clears devices, the functions precede it, otherwise they are with those of the API.
    let clearing = printer.clear_functions(asked.clears_latched || latches != Latches::Retained);
    if asked.clears_general || asked.clears_latched {
        internal.push_str(&clearing);
    } else {
        groups[0].push_str(&clearing);
    }
    printer.api_functions(&mut groups[0]);
    if module.takes_events() {
        groups[0].push_str(&events::functions(module));
    }
    if runtime {
        table::write(&mut groups[0], module, &fields);
    }
    if in_lanes {
        let functions = lanes::source(module, &plan, &fields);
        match single {
            true => groups[0].push_str(&functions),
            false => groups.push(functions),
        }
    }
    Unit {
        api: header::api(module, &fields, &plan, runtime),
        runtime,
        internal,
        groups,
    }
}

/// Returns true if a module calls the runtime.
pub(crate) fn uses_runtime(module: &Module) -> bool {
    let mut uses = module.has_ports();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| uses |= calls_runtime(stmt));
    }
    uses
}

/// The states of parts.
fn states(out: &mut String, writer: &Writer, plan: &Plan) {
    let roots = (0..writer.module.functions.len()).map(|root| (root, plan.state_names(root)));
    for (root, names) in roots.filter(|(_, names)| !names.is_empty()) {
        out.push_str("/* Parts at which the program continues after a jump. */\nenum {\n");
        for state in 1..=names.len() {
            let comma = if state < names.len() { "," } else { "" };
            let _ = writeln!(
                out,
                "    {} = {state}{comma}",
                writer.state_name(root, state as u32)
            );
        }
        out.push_str("};\n\n");
    }
}

/// Prototypes: in one file, of functions that may be called before they are there; in several files, of all.
fn prototypes(out: &mut String, writer: &Writer, plan: &Plan, single: bool) {
    let mut any = false;
    for function in &plan.functions {
        let kind = writer.module.functions.get(function.root).map(|f| &f.kind);
        let in_cycle = matches!(
            kind,
            Some(FunctionKind::Begin | FunctionKind::Main | FunctionKind::End)
        );
        let subroutine = function.is_whole() && !in_cycle;
        if !single || subroutine {
            let storage = if single { "static " } else { "" };
            let _ = writeln!(out, "{storage}{};", writer.signature(function));
            any = true;
        }
    }
    if any {
        out.push('\n');
    }
}

/// The statement by which the watchdog gives a scan its time, if there is one.
pub(crate) fn watchdog_begins(module: &Module, fields: &Storage) -> Option<String> {
    Some(match cycle::budget(module, fields)? {
        Budget::Register(register) => {
            let mut ms = String::new();
            fields.access(&mut ms, DeviceClass::D, register);
            format!("plc->steps_left = (uint32_t)plc_times({ms}) * UINT32_C({STEPS_PER_MS});")
        }
        Budget::Steps(steps) => format!("plc->steps_left = {steps}u;"),
    })
}

/// Writes what belongs to the module as a whole.
pub struct Printer<'a> {
    pub(crate) module: &'a Module,
    pub(crate) fields: &'a Storage<'a>,
    pub(crate) plan: &'a Plan<'a>,
}

/// Call of the host's error callback after a fault.
const CALL_ON_ERROR: &str = "\
#ifdef PLC_ON_ERROR
    if (plc->on_error != NULL) {
        plc->on_error(plc, code, step);
    }
#endif
";

impl Printer<'_> {
    pub(crate) fn name(&self) -> &str {
        &self.module.name
    }

    /// `plc->M8067`, if it is stored.
    pub(crate) fn stored(&self, class: DeviceClass, number: u32) -> Option<String> {
        let mut name = String::new();
        self.fields.access(&mut name, class, number).then_some(name)
    }

    /// A special relay, if it is stored and means on the model what it means on most.
    fn special_relay(&self, relay: Relay) -> Option<String> {
        cycle::keeps(self.module, self.fields, relay)
            .then(|| self.stored(DeviceClass::M, relay.number()))
            .flatten()
    }

    /// The statements by which special devices show an error.
    fn show(&self, out: &mut String, indent: &str, shows: &[Shows]) {
        for &(class, number, shown) in shows {
            let device = self.stored(class, number).unwrap_or_default();
            let _ = match shown {
                Shown::On => writeln!(out, "{indent}{device} = true;"),
                Shown::Word(value) => writeln!(out, "{indent}{device} = {value};"),
                Shown::Code => writeln!(out, "{indent}{device} = plc_int16(code);"),
                Shown::Step => writeln!(out, "{indent}{device} = plc_int16(step);"),
            };
        }
    }

    /// The statements by which an error enters the log, if the program keeps one.
    fn log_error(&self, indent: &str, code: &str) -> String {
        let name = self.name();
        match cycle::error_rules(self.module, self.fields).logs {
            true => format!(
                "{indent}rungc_map map = {name}_map(plc);\n\
                 {indent}rungc_log_error(&map, rungc_at(0), rungc_K({code}));\n"
            ),
            false => String::new(),
        }
    }

    /// Reports an operation error (see the runtime's `report`), as far as the program looks at it.
    fn fault(&self, out: &mut String) {
        let mut lines = "    plc->error.code = code;\n    plc->error.step = step;\n".to_string();
        let [first, each] = cycle::fault_shows(self.module.model, self.fields);
        match first.first() {
            Some(&(class, number, Shown::On)) => {
                let relay = self.stored(class, number).unwrap_or_default();
                let _ = writeln!(lines, "    if (!{relay}) {{ /* only the first one */");
                self.show(&mut lines, "        ", &first);
                lines.push_str("    }\n");
            }
            _ => self.show(&mut lines, "    ", &first),
        }
        self.show(&mut lines, "    ", &each);
        lines.push_str(&self.log_error("    ", "code"));
        lines.push_str(CALL_ON_ERROR);
        let name = self.name();
        let _ = write!(
            out,
            "/* An operation error: the instruction is skipped, the error shown in the special devices that the program looks at. */\n\
             static inline void {name}_fault({name}_plc *plc, uint16_t code, uint16_t step)\n{{\n{lines}}}\n\n"
        );
    }

    /// A scan begins: the watchdog gives it its time, if it has one.
    fn watchdog_begins(&self) -> String {
        let begins = watchdog_begins(self.module, self.fields);
        begins.map_or_else(String::new, |begins| format!("    {begins}\n"))
    }

    /// Writes the watchdog, which stops a scan that does not end.
    fn watchdog(&self, out: &mut String) {
        let name = self.name();
        let mut trip = String::from(
            "        plc->sys.running = false;\n        plc->error.stop = PLC_STOP_WATCHDOG;\n        plc->error.stop_step = step;\n",
        );
        let shows = cycle::watchdog_shows(self.module.model, self.fields);
        self.show(&mut trip, "        ", &shows);
        trip.push_str(&self.log_error("        ", &WATCHDOG_CODE.to_string()));
        let _ = write!(
            out,
            "/* Counts the steps that a loop or a jump back repeats. After too many in one scan the PLC stops, as its watchdog would have it. */\n\
             static inline bool {name}_out_of_time({name}_plc *plc, uint32_t steps, uint16_t step)\n{{\n    \
             if (steps <= plc->steps_left) {{\n        plc->steps_left -= steps;\n        return false;\n    }}\n    \
             plc->steps_left = 0;\n    if (plc->sys.running) {{\n{trip}    }}\n    return true;\n}}\n\n"
        );
    }

    /// Functions that clear devices: general ones (STOP, M8031), and, where a program asks for it, latched ones
    /// (M8032).
    fn clear_functions(&self, latched_too: bool) -> String {
        let name = self.name();
        let mut out = String::new();
        let mut function = |comment: &str, what: &str, body: &str| {
            let body = if body.is_empty() {
                "    (void)plc;\n"
            } else {
                body
            };
            let _ = write!(
                out,
                "/* {comment} */\nstatic inline void {name}_clear_{what}({name}_plc *plc)\n{{\n{body}}}\n\n"
            );
        };
        let mut body = String::new();
        self.clear(&mut body, Section::General, Some(Keep::General));
        function(
            "Clears all devices but inputs, latched and special ones.",
            "general",
            &body,
        );
        if latched_too {
            body.clear();
            self.clear(&mut body, Section::Latched, Some(Keep::Latched));
            function("Clears the latched devices.", "latched", &body);
        }
        out
    }

    /// Writes the clearing of a section and of what mixed arrays hold of its kind.
    fn clear(&self, out: &mut String, section: Section, of_mixed: Option<Keep>) {
        let order = self.fields.in_sections();
        if let Some(first) = order.iter().position(|f| f.section == section) {
            let behind = order[first..].iter().find(|f| f.section != section);
            let (mut from, mut to) = (String::new(), String::new());
            order[first].name(&mut from);
            match behind {
                Some(field) => field.name(&mut to),
                None => to.push_str("sys"),
            }
            let name = self.name();
            let _ = writeln!(
                out,
                "    plc_clear(plc, offsetof({name}_plc, {from}), offsetof({name}_plc, {to}));"
            );
        }
        for field in order.iter().filter(|f| f.section == Section::Mixed) {
            for run in self
                .fields
                .runs(field)
                .filter(|run| Some(run.keep) == of_mixed)
            {
                let mut array = String::from("plc->");
                field.name(&mut array);
                if field.columns().is_some() {
                    let (first, end) = (run.first, run.first + run.count);
                    field.element(&mut array, "n", "u");
                    let mut clear = match field.kind {
                        Kind::Bit | Kind::NumericBit | Kind::Word => {
                            format!("        {array} = 0;\n")
                        }
                        Kind::Timer | Kind::Counter16 | Kind::Counter32 => {
                            format!("        (void)memset(&{array}, 0, sizeof {array});\n")
                        }
                    };
                    if let Some(is_stored) = field.column_is_stored("n", "u") {
                        clear = format!("        if ({is_stored}) {{\n    {clear}        }}\n");
                    }
                    let _ = writeln!(
                        out,
                        "    for (unsigned n = {first}; n < {end}; n++) {{\n{clear}    }}"
                    );
                    continue;
                }
                let _ = writeln!(
                    out,
                    "    (void)memset(&{array}[{}], 0, {}u * sizeof {array}[0]);",
                    run.first - field.first,
                    run.count
                );
            }
        }
    }

    /// The functions that a host calls.
    fn api_functions(&self, out: &mut String) {
        let forget = self.forget(out);
        out.push_str(&events::count_pulses(self.module));
        out.push_str(&events::advance_ports(self.module));
        self.power_cycle(out, forget);
        self.set_running(out, forget);
        self.scan(out);
        self.constant_scan(out);
        self.output(out);
        self.error(out);
    }

    /// The functions for power-on; `forget`: there is one for what RUN forgets.
    fn power_cycle(&self, out: &mut String, forget: bool) {
        let (name, module) = (self.name(), self.module);
        let mut inputs = String::new();
        self.clear(&mut inputs, Section::Inputs, None);
        let mut special = String::new();
        self.clear(&mut special, Section::Special, Some(Keep::Special));
        self.preset(&mut special, false);
        let mut first = String::new();
        self.preset(&mut first, true);
        if !module.model.keeps_contacts {
            self.each_timer_and_counter(&mut special, ["done = false"; 2]);
        }
        let mut states = String::new();
        if module.states > 0 {
            states.push_str("    (void)memset(plc->state, 0, sizeof plc->state);\n");
        }
        if module.sends_pulses() {
            states.push_str("    (void)memset(plc->axis, 0, sizeof plc->axis);\n");
        }
        for number in &module.ports {
            let _ = writeln!(
                states,
                "    (void)memset(plc->com{number}, 0, sizeof plc->com{number});"
            );
        }
        let cells = events::clear_cells(module);
        // An interrupt may come before the first scan.
        let steps = self.watchdog_begins();
        let forget = match forget {
            true => format!("    {name}_forget(plc);\n"),
            false => String::new(),
        };
        let _ = write!(
            out,
            "void {name}_init({name}_plc *plc)\n{{\n    (void)memset(plc, 0, sizeof *plc);\n{first}    {name}_power_cycle(plc);\n}}\n\n\
             void {name}_power_cycle({name}_plc *plc)\n{{\n{}{inputs}    {name}_clear_general(plc);\n{special}{states}{cells}{steps}    \
             plc_power_on(&plc->sys);\n{forget}}}\n\n",
            self.lost_latches(),
        );
    }

    /// Gives special devices their defaults: latched ones, when the PLC is switched on for the first time, or all
    /// others.
    fn preset(&self, out: &mut String, latched: bool) {
        let module = self.module;
        for &(register, value) in &module.initial_words {
            let number = register.number();
            let device = self.stored(DeviceClass::D, number);
            if let Some(device) =
                device.filter(|_| module.is_latched(DeviceClass::D, number) == latched)
            {
                let _ = writeln!(out, "    {device} = {value};");
            }
        }
        for &relay in &module.initial_bits {
            let number = relay.number();
            let device = self.stored(DeviceClass::M, number);
            if let Some(device) =
                device.filter(|_| module.is_latched(DeviceClass::M, number) == latched)
            {
                let _ = writeln!(out, "    {device} = true;");
            }
        }
    }

    /// The function of the RUN/STOP switch.
    fn set_running(&self, out: &mut String, forget: bool) {
        let name = self.name();
        let hold = match self.special_relay(M_KEEP_IN_STOP) {
            Some(hold) => format!(" if (!{hold})"),
            None => String::new(),
        };
        let forget_command = self.forget_run_command();
        let begin_run = match forget {
            true => format!("    if (running) {{\n        {name}_forget(plc);\n    }} else"),
            false => "    if (!running)".to_string(),
        };
        let _ = write!(
            out,
            "void {name}_set_running({name}_plc *plc, bool running)\n{{\n    if (running == plc->sys.running) {{\n        return;\n    }}\n    \
             plc->sys.running = running;\n    plc->sys.first_scan = running;\n{forget_command}{begin_run}{hold} {{\n        {name}_clear_general(plc);\n    }}\n}}\n\n"
        );
    }

    /// The function of a scan.
    fn scan(&self, out: &mut String) {
        let (name, module) = (self.name(), self.module);
        let call = |index: usize, indent: &str| {
            let mut function = String::new();
            function_name(&mut function, module, index);
            match self.plan.whole(index) {
                Some(_) => format!("{indent}{function}(plc);\n"),
                None => String::new(),
            }
        };
        let pulses = match module.sends_pulses() {
            true => format!("    {name}_count_pulses(plc, plc_now_us(&plc->sys));\n"),
            false => String::new(),
        };
        let ports = match module.has_ports() {
            true => format!("    {name}_advance_ports(plc, plc_now_us(&plc->sys));\n"),
            false => String::new(),
        };
        let obey = self.obey_run_command();
        let steps = self.watchdog_begins();
        let periods = events::begin_periods(module);
        let (begin, main, end) = (call(0, "    "), call(1, "        "), call(2, "        "));
        let _ = write!(
            out,
            "void {name}_scan({name}_plc *plc, uint32_t now_ms, uint32_t scan_us)\n{{\n{obey}{periods}    \
             plc_begin_scan(&plc->sys, now_ms, scan_us);\n{pulses}{ports}{steps}{begin}    if (plc->sys.running) {{\n{main}{end}    }}\n    \
             plc->sys.first_scan = false;\n{ports}}}\n\n"
        );
    }

    /// The function that reports errors to a host.
    fn error(&self, out: &mut String) {
        let name = self.name();
        let body = match self.module.may_fail() {
            true => "    return plc->error;\n",
            false => {
                "    const plc_error none = {0, 0, PLC_STOP_NONE, 0};\n    (void)plc;\n    return none;\n"
            }
        };
        let _ = write!(
            out,
            "plc_error {name}_error(const {name}_plc *plc)\n{{\n{body}}}\n\n\
             bool {name}_running(const {name}_plc *plc)\n{{\n    return plc->sys.running;\n}}\n\n"
        );
    }

    /// The function that forgets edges, memories and the coils of timers and counters when RUN begins; false if there
    /// are none.
    fn forget(&self, out: &mut String) -> bool {
        let name = self.name();
        let mut body = String::new();
        let ladders = &self.plan.ladders;
        if ladders.edges(self.module) > 0 {
            body.push_str("    (void)memset(plc->edge, 0, sizeof plc->edge);\n");
        }
        if ladders.count() > 0 {
            body.push_str("    (void)memset(plc->steps, 0, sizeof plc->steps);\n");
        }
        body.push_str(&events::forget(self.module));
        if self.module.run_states > 0 {
            let _ = writeln!(
                body,
                "    (void)memset(plc->state, 0, {}u * sizeof plc->state[0]);",
                self.module.run_states
            );
        }
        if self.module.may_fail() {
            body.push_str("    (void)memset(&plc->error, 0, sizeof plc->error);\n");
        }
        self.each_timer_and_counter(&mut body, ["coil = 0", "coil = false"]);
        if !body.is_empty() {
            let _ = write!(
                out,
                "/* RUN begins: edges, the coils of timers and counters and what takes several scans begin anew. */\n\
                 static void {name}_forget({name}_plc *plc)\n{{\n{body}}}\n\n"
            );
        }
        !body.is_empty()
    }

    /// Does the first thing with a member of each timer, the second with one of each counter.
    fn each_timer_and_counter(&self, out: &mut String, what: [&str; 2]) {
        for (class, what) in [DeviceClass::T, DeviceClass::C].into_iter().zip(what) {
            for field in self.fields.of_class(class) {
                let mut device = String::from("plc->");
                field.name(&mut device);
                let _ = match field.dimensions() {
                    (Some(columns), rows) => write!(
                        out,
                        "    for (int i = 0; i < {columns}; i++) {{\n        for (int j = 0; j < {rows}; j++) {{\n            \
                         {device}[i][j].{what};\n        }}\n    }}\n"
                    ),
                    (None, rows) if field.array => write!(
                        out,
                        "    for (int i = 0; i < {rows}; i++) {{\n        {device}[i].{what};\n    }}\n"
                    ),
                    (None, _) => writeln!(out, "    {device}.{what};"),
                };
            }
        }
    }

    /// Latched devices that a model keeps only while a special register holds a key.
    fn lost_latches(&self) -> String {
        let name = self.name();
        match cycle::latches(self.module, self.fields) {
            Latches::Retained => String::new(),
            Latches::RetainedIf(register, key) => {
                let device = self.stored(DeviceClass::D, register).unwrap_or_default();
                format!(
                    "    if ({device} != {key}) {{\n        {name}_clear_latched(plc);\n    }}\n"
                )
            }
            Latches::Lost(register, key) => format!(
                "    {name}_clear_latched(plc); /* they are kept only if D{register} is {key} */\n"
            ),
        }
    }

    fn output(&self, out: &mut String) {
        let name = self.name();
        let keep = self.special_relay(M_KEEP_IN_STOP);
        let keeps = keep.is_some();
        let stop = match keep {
            // The watchdog switches off what STOP would keep.
            Some(keep) if self.module.has_watchdog() => {
                format!("!plc->sys.running && (!{keep} || plc->error.stop == PLC_STOP_WATCHDOG)")
            }
            Some(keep) => format!("!plc->sys.running && !{keep}"),
            None => "!plc->sys.running".to_string(),
        };
        let off = match self.special_relay(M_OUTPUTS_OFF) {
            Some(off) if keeps => format!("({stop}) || {off}"),
            Some(off) => format!("{stop} || {off}"),
            None => stop,
        };
        let _ = write!(
            out,
            "bool {name}_output(const {name}_plc *plc, unsigned terminal)\n{{\n    if ({off}) {{\n        return false;\n    }}\n"
        );
        for (i, output) in self.module.pulse_outputs.iter().enumerate() {
            let _ = write!(
                out,
                "    if (terminal == {output}u && plc->axis[{i}].on) {{\n        return true;\n    }}\n"
            );
        }
        let fields = self.fields.of_class(DeviceClass::Y);
        for field in fields.iter().filter(|f| f.array) {
            let mut array = String::from("plc->");
            field.name(&mut array);
            field.element(&mut array, "terminal", "u");
            let end = field.end();
            let mut condition = match field.first {
                0 => format!("terminal < {end}u"),
                first => format!("terminal >= {first}u && terminal < {end}u"),
            };
            if let Some(is_stored) = field.column_is_stored("terminal", "u") {
                let _ = write!(condition, " && {is_stored}");
            }
            let _ = write!(
                out,
                "    if ({condition}) {{\n        return {array};\n    }}\n"
            );
        }
        let single: Vec<&Field> = fields.iter().filter(|f| !f.array).collect();
        if single.is_empty() {
            if fields.is_empty() {
                out.push_str("    (void)terminal;\n");
            }
            out.push_str("    return false;\n}\n\n");
            return;
        }
        let terminals = single.last().map_or(0, |last| last.first + 1);
        if single.len() > FEW_TERMINALS && terminals <= 3 * single.len() as u32 {
            self.output_table(&single, out);
            return;
        }
        out.push_str("    switch (terminal) {\n");
        for field in single {
            let mut device = String::from("plc->");
            field.name(&mut device);
            let _ = writeln!(out, "    case {}:\n        return {device};", field.first);
        }
        out.push_str("    default:\n        return false;\n    }\n}\n\n");
    }

    /// The rest of the function where a table of places is smaller than a branch for each terminal.
    fn output_table(&self, terminals: &[&Field], out: &mut String) {
        let name = self.name();
        let bits = if self.fields.bytes() < 60_000 { 16 } else { 32 };
        let _ = write!(
            out,
            "    /* Index of each terminal; UINT{bits}_MAX: the program does not use it. */\n    static const uint{bits}_t place[] = {{\n"
        );
        let mut next = 0;
        for field in terminals {
            for _ in next..field.first {
                let _ = writeln!(out, "        UINT{bits}_MAX,");
            }
            let mut device = String::new();
            field.name(&mut device);
            let _ = writeln!(out, "        offsetof({name}_plc, {device}),");
            next = field.end();
        }
        let _ = write!(
            out,
            "    }};\n    return terminal < {next}u && place[terminal] != UINT{bits}_MAX\n        && *((const bool *)plc + place[terminal]);\n}}\n\n"
        );
    }
}

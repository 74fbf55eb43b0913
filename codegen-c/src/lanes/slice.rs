//! Statements on whole lanes, and the loops over instances between them.

use super::classify::Classes;
use super::mirror::{coil, copies_in, copies_out, in_lanes, lanes};
use super::waiting::{Waiting, waiting};
use crate::code::Code;
use crate::devices::run_timer;
use crate::expr::Around;
use crate::fields::PrintStorage;
use crate::page::Page;
use crate::writer::{LIMITS, Writer, c_type, zero};
use rungc_emit::plan::{Node, Stations};
use rungc_emit::temps::Home;
use rungc_emit::{parts, stations};
use rungc_ir::node::{
    Action, Counter16Coil, Counter32Coil, Edge, Expr, ExprId, Place, Stmt, SysValue, TempId,
    TimerCoil, Ty,
};
use rungc_ir::walk::assigned;
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// Writes the functions of a program in lanes.
pub(super) struct Slicer<'a, 'm> {
    pub classes: Classes<'a, 'm>,
    /// Writes the code of one instance.
    pub writer: Writer<'a, 'm>,
    /// The timers that wait, by number.
    pub waiting: BTreeMap<u32, Waiting>,
    /// The instances that execute what is being written; `None`: all.
    mask: Option<String>,
    /// True if any code of one instance was written.
    pub singles: bool,
    /// Names given in this function.
    names: u32,
    /// Names of parts of the current statement's expressions.
    named: FxHashMap<ExprId, String>,
}

impl<'a, 'm> Slicer<'a, 'm> {
    pub fn new(classes: Classes<'a, 'm>, mut writer: Writer<'a, 'm>) -> Self {
        Slicer {
            waiting: waiting(&classes, &mut writer),
            classes,
            writer,
            mask: None,
            singles: false,
            names: 0,
            named: FxHashMap::default(),
        }
    }

    /// Name of the function in lanes: `motor_lanes_program`.
    pub fn function_name(&self, index: usize) -> String {
        let plan = self.classes.plan;
        let mut name = String::new();
        self.writer.function_name(&mut name, &plan.functions[index]);
        let own = &self.classes.module.name;
        name.replacen(own, &format!("{own}_lanes"), 1)
    }

    /// Writes a function.
    pub fn function(&mut self, out: &mut String, index: usize) {
        let plan = self.classes.plan;
        let function = &plan.functions[index];
        self.writer.enter(index);
        self.names = 0;
        let own = &self.classes.module.name;
        out.push_str(&format!(
            "static void {}({own}_lanes *all)\n{{\n",
            self.function_name(index)
        ));
        let mut page = Page::new(std::mem::take(out));
        if function.body.is_empty() {
            page.line("(void)all;");
        }
        if self.classes.is_left_early(index) {
            self.whole(&mut page, index);
        } else {
            let temps = plan.temps.iter_enumerated();
            for (id, temp) in temps.filter(|(_, temp)| temp.used > 0) {
                if temp.home() == Home::Variable(index) && self.classes.in_lanes(id) {
                    page.line(&format!("plc_lanes lanes_{temp} = 0;"));
                }
            }
            self.nodes(&mut page, &function.body);
        }
        *out = page.finish();
        out.push_str("}\n\n");
    }

    /// A function that is left before its end runs in each instance.
    fn whole(&mut self, page: &mut Page, index: usize) {
        let plan = self.classes.plan;
        let met = self.classes.met(&plan.functions[index].body);
        let mut name = String::new();
        self.writer.function_name(&mut name, &plan.functions[index]);
        self.open_instances(page, None);
        self.lines(
            page,
            copies_in(self.classes.module, self.classes.fields, &met),
        );
        page.line(&format!("{name}(plc);"));
        self.lines(
            page,
            copies_out(self.classes.module, self.classes.fields, &met),
        );
        page.close();
    }

    fn lines(&self, page: &mut Page, lines: Vec<String>) {
        lines.iter().for_each(|line| page.line(line));
    }

    fn nodes(&mut self, page: &mut Page, nodes: &[Node<'m>]) {
        let sliced = self.classes.of_nodes(nodes);
        let mut i = 0;
        while i < nodes.len() {
            if sliced[i] {
                self.node(page, &nodes[i]);
                i += 1;
                continue;
            }
            let end = (i..nodes.len()).find(|&k| sliced[k]).unwrap_or(nodes.len());
            self.instances(page, &nodes[i..end], &nodes[end..]);
            i = end;
        }
    }

    /// A loop over the instances that execute these nodes, which others of the block follow.
    fn instances(&mut self, page: &mut Page, nodes: &[Node<'m>], later: &[Node<'m>]) {
        let classes = &self.classes;
        let (module, fields) = (classes.module, classes.fields);
        let met = classes.met(nodes);
        let (mut read, mut assigns) = (BTreeSet::new(), BTreeSet::new());
        for node in nodes {
            temps(classes, node, &mut read, &mut assigns);
        }
        let (mut kept, mut others) = (BTreeSet::new(), BTreeSet::new());
        for node in later {
            temps(classes, node, &mut kept, &mut others);
        }
        let plan = classes.plan;
        let used = |temp: &&TempId| plan.temp(**temp).used > 0;
        for &temp in assigns.iter().filter(used) {
            let known = plan.temp(temp);
            if classes.in_lanes(temp) && known.home() == Home::Constant && kept.contains(&temp) {
                page.line(&format!("plc_lanes lanes_{known} = 0;"));
            }
        }
        let mut before = copies_in(module, fields, &met);
        let mut after = copies_out(module, fields, &met);
        read.extend(&assigns);
        for &temp in read.iter().filter(used) {
            let known = plan.temp(temp);
            let (lanes, ty) = (classes.in_lanes(temp), module.temps[temp]);
            match (assigns.contains(&temp), known.home()) {
                (_, Home::Field) => continue,
                (false, _) => before.push(format!(
                    "const bool {known} = plc_in_lane(lanes_{known}, l);"
                )),
                (true, Home::Variable(_)) if lanes => {
                    before.push(format!("bool {known} = plc_in_lane(lanes_{known}, l);"));
                }
                (true, Home::Variable(_)) => {
                    before.push(format!("{} {known}{}", c_type(ty), zero(ty)));
                }
                (true, Home::Constant) => {}
            }
            let outlives = known.home() != Home::Constant || kept.contains(&temp);
            if assigns.contains(&temp) && lanes && outlives {
                after.push(format!("plc_put_lane(&lanes_{known}, l, {known});"));
            }
        }
        let mask = self.mask.clone();
        self.open_instances(page, mask.as_deref());
        self.lines(page, before);
        self.writer.nodes(page, nodes);
        self.lines(page, after);
        page.close();
    }

    /// Begins a loop over the instances of a mask, in which `l` is the instance and `plc` its struct.
    fn open_instances(&mut self, page: &mut Page, mask: Option<&str>) {
        self.singles = true;
        let own = &self.classes.module.name;
        match mask {
            None => {
                page.open("for (unsigned l = 0; l < PLC_LANES; l++) {");
            }
            Some(mask) => {
                page.open(&format!(
                    "for (plc_lanes rest = {mask}; rest != 0u; rest &= rest - 1u) {{"
                ));
                page.line("const unsigned l = plc_first_lane(rest);");
            }
        }
        page.line(&format!("{own}_plc *const plc = &all->lane[l];"));
    }

    /// Gives names to inner parts of expressions whose shared parts would make the text explode.
    fn name_parts(&mut self, page: &mut Page, roots: &[ExprId]) {
        self.named.clear();
        let (module, mask) = (self.classes.module, self.mask.clone());
        for e in parts::named(module, &self.classes.plan.sizes, roots, LIMITS) {
            if module.ty(e) == Ty::Bit && self.classes.slices_expr(e) {
                self.names += 1;
                let name = format!("part{}", self.names);
                let value = self.bits(page, e, mask.as_deref());
                page.line(&format!("const plc_lanes {name} = {value};"));
                self.named.insert(e, name);
            }
        }
    }

    fn node(&mut self, page: &mut Page, node: &Node<'m>) {
        self.name_parts(page, &node.roots());
        match node {
            Node::Stmt(Stmt::Network(network)) => self.writer.network(page, *network),
            Node::Stmt(stmt) => self.stmt(page, stmt),
            Node::If {
                cond,
                then,
                otherwise,
            } => self.branch(page, *cond, then, otherwise),
            Node::Repeat(stations) => self.stations(page, stations),
            // Some instance is active for the most part.
            Node::Steps { body, .. } => self.nodes(page, body),
            Node::Outlined(function) if self.mask.is_none() => {
                let name = self.function_name(*function);
                page.line(&format!("{name}(all);"));
            }
            Node::Outlined(_) | Node::For { .. } | Node::Parts { .. } => {
                self.instances(page, std::slice::from_ref(node), &[]);
            }
        }
    }

    fn stations(&mut self, page: &mut Page, stations: &Stations<'m>) {
        let count = stations.count;
        page.set_off();
        page.comment(&stations::heading(stations));
        let variable = self.writer.loop_variable();
        page.open(&format!(
            "for (unsigned {variable} = 0; {variable} < {count}; {variable}++) {{"
        ));
        self.writer.iteration = variable;
        for node in &stations.body {
            self.node(page, node);
        }
        page.close();
    }

    fn branch(&mut self, page: &mut Page, cond: ExprId, then: &[Node<'m>], otherwise: &[Node<'m>]) {
        let outer = self.mask.take();
        let on = self.bits(page, cond, outer.as_deref());
        self.named.clear();
        self.names += 1;
        let (on_name, off_name) = (format!("on{}", self.names), format!("off{}", self.names));
        page.open("{");
        let within = |what: String| match &outer {
            None => what,
            Some(outer) => format!("{outer} & {what}"),
        };
        page.line(&format!("const plc_lanes {on_name} = {};", within(on)));
        if !otherwise.is_empty() {
            page.line(&format!(
                "const plc_lanes {off_name} = {};",
                within(format!("~{on_name}"))
            ));
        }
        for (mask, body) in [(on_name, then), (off_name, otherwise)] {
            if body.is_empty() {
                continue;
            }
            let (long, head) = (body.len() > 2, format!("if ({mask} != 0u) {{"));
            if long {
                page.open(&head);
            }
            self.mask = Some(mask);
            self.nodes(page, body);
            if long {
                page.close();
            }
        }
        page.close();
        self.mask = outer;
    }

    /// Writes a statement that [`Classes`] lets run on whole lanes.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "others do not run on whole lanes"
    )]
    fn stmt(&mut self, page: &mut Page, stmt: &Stmt) {
        let mask = self.mask.clone();
        let Stmt::Do(action) = stmt else {
            return;
        };
        match action {
            &Action::Let(temp, value) if self.classes.plan.temp(temp).used > 0 => {
                let value = self.bits(page, value, mask.as_deref());
                self.let_temp(page, temp, &value);
            }
            Action::Edge(edge) => self.edge(page, edge),
            &Action::SetFlag(flag, value) => {
                let value = self.bits(page, value, mask.as_deref());
                let flag = format!("all->{}", self.classes.module.flags[flag].name);
                self.put(page, &flag, &value);
            }
            &Action::Write(access, value) => {
                if let Some(target) = self.place(&access.place) {
                    let value = self.bits(page, value, mask.as_deref());
                    self.put(page, &target, &value);
                }
            }
            Action::Timer(coil) => self.timer(page, coil),
            Action::Counter16(coil) => self.counter16(page, coil),
            Action::Counter32(coil) => self.counter32(page, coil),
            Action::Reset { place, holds } => self.reset(page, place, *holds),
            _ => {}
        }
    }

    fn let_temp(&self, page: &mut Page, temp: TempId, value: &str) {
        let known = self.classes.plan.temp(temp);
        match known.home() {
            Home::Constant => page.line(&format!("const plc_lanes lanes_{known} = {value};")),
            Home::Variable(_) | Home::Field => {
                self.put(page, &format!("lanes_{known}"), value);
            }
        }
    }

    /// Writes a bit in the instances that execute the statement.
    fn put(&self, page: &mut Page, target: &str, value: &str) {
        page.line(&match (&self.mask, value) {
            (None, _) => format!("{target} = {value};"),
            (Some(mask), "PLC_ALL_LANES") => format!("{target} |= {mask};"),
            (Some(mask), "(plc_lanes)0") => format!("{target} &= ~{mask};"),
            (Some(mask), _) => format!("plc_put_lanes(&{target}, {mask}, {value});"),
        });
    }

    fn edge(&mut self, page: &mut Page, edge: &Edge) {
        let mask = self.mask.clone();
        let input = self.bits(page, edge.input, mask.as_deref());
        let mut memory = String::new();
        self.writer.edge_memory(&mut memory, edge);
        let memory = in_lanes(&memory);
        if self.classes.plan.temp(edge.out).used == 0 {
            return self.put(page, &memory, &input);
        }
        self.names += 1;
        let now = format!("now{}", self.names);
        page.line(&format!("const plc_lanes {now} = {input};"));
        let value = match edge.kind {
            EdgeKind::Rising => format!("{now} & ~{memory}"),
            EdgeKind::Falling => format!("{memory} & ~{now}"),
        };
        self.let_temp(page, edge.out, &value);
        self.put(page, &memory, &now);
    }

    fn timer(&mut self, page: &mut Page, timer: &TimerCoil) {
        let (number, fields) = (timer.number, self.classes.fields);
        let kind = self.writer.coils.kind(number, timer.kind);
        let plain = !(kind.free_running || kind.latches_preset || kind.overruns || kind.shared);
        let Some(done) = lanes(fields, DeviceClass::T, number) else {
            return;
        };
        let coil = coil(fields, DeviceClass::T, number).unwrap_or_default();
        let forced = self.classes.forced.contains(&(DeviceClass::T, number));
        page.open("{");
        let drive = self.named_bits(page, timer.drive, "drive");
        if let Some(waiting) = self.waiting.get(&number).cloned() {
            self.wait(page, &waiting);
            self.put(page, &coil, &drive);
            return page.close();
        }
        // A timer that has timed out stays so, and one that has not been on stays off.
        let work = match (forced, plain) {
            (true, _) => "PLC_ALL_LANES".to_string(),
            (false, true) => format!("({drive} & ~({done} & {coil})) | ({coil} & ~{drive})"),
            (false, false) => format!("{drive} | {coil}"),
        };
        self.coil_loop(page, &work, |slicer, page| {
            let mut device = String::new();
            fields.access(&mut device, DeviceClass::T, number);
            let mut preset = Code::new();
            slicer.writer.expr(&mut preset, timer.preset, Around::Exact);
            let mut code = Code::new();
            let in_lane = Code::from(&*format!("plc_in_lane({drive}, l)"));
            run_timer(&mut code, kind, &device, &in_lane, &preset);
            page.commented(&code, None);
            page.line(&format!("plc_put_lane(&{done}, l, {device}.done);"));
        });
        self.put(page, &coil, &drive);
        page.close();
    }

    /// A timer that waits as long as it can; `drive` says where its coil is on.
    fn wait(&mut self, page: &mut Page, timer: &Waiting) {
        let Waiting {
            device,
            done,
            coil,
            passed,
            left,
            rest,
            ..
        } = timer;
        page.line(&format!("{passed} += all->sys.dt_ms;"));
        page.open(&format!(
            "if ((drive != {coil}) || ({passed} >= {left})) {{"
        ));
        page.line("plc_sys sys = all->sys;");
        page.line(&format!("sys.dt_ms = {passed};"));
        page.line(&format!("{passed} = 0;"));
        page.line(&format!("{left} = UINT32_MAX;"));
        let work = format!("(drive & ~({done} & {coil})) | ({coil} & ~drive)");
        self.open_instances(page, Some(&work));
        page.line(&timer.run.replace("DRIVE", "plc_in_lane(drive, l)"));
        page.line(&format!("plc_put_lane(&{done}, l, {device}.done);"));
        page.open(&format!("if (plc_in_lane(drive, l) && !{device}.done) {{"));
        page.line(&format!("const uint32_t more = {rest};"));
        page.line(&format!("{left} = (more < {left}) ? more : {left};"));
        page.close();
        page.close();
        page.close();
    }

    fn counter16(&mut self, page: &mut Page, counter: &Counter16Coil) {
        let Counter16Coil {
            number,
            drive,
            preset,
        } = *counter;
        self.counter(page, number, drive, preset, None, "plc_count16");
    }

    fn counter32(&mut self, page: &mut Page, counter: &Counter32Coil) {
        let Counter32Coil {
            number,
            drive,
            down,
            preset,
        } = *counter;
        self.counter(page, number, drive, preset, Some(down), "plc_count32");
    }

    /// A counter does something where its coil changes.
    fn counter(
        &mut self,
        page: &mut Page,
        number: u32,
        drive: ExprId,
        preset: ExprId,
        down: Option<ExprId>,
        function: &str,
    ) {
        let fields = self.classes.fields;
        let Some(done) = lanes(fields, DeviceClass::C, number) else {
            return;
        };
        let coil = coil(fields, DeviceClass::C, number).unwrap_or_default();
        page.open("{");
        let drive = self.named_bits(page, drive, "drive");
        let down = down.map(|down| self.named_bits(page, down, "down"));
        self.coil_loop(page, &format!("{drive} ^ {coil}"), |slicer, page| {
            let mut device = String::new();
            fields.access(&mut device, DeviceClass::C, number);
            let mut code = Code::new();
            code.open(&format!("{function}(&{device}"));
            code.argument(format_args!("plc_in_lane({drive}, l)"));
            if let Some(down) = &down {
                code.argument(format_args!("plc_in_lane({down}, l)"));
            }
            code.comma();
            slicer.writer.expr(&mut code, preset, Around::Exact);
            code.close(");");
            page.commented(&code, None);
            page.line(&format!("plc_put_lane(&{done}, l, {device}.done);"));
        });
        self.put(page, &coil, &drive);
        page.close();
    }

    /// A loop over the instances in which a coil does something.
    fn coil_loop(
        &mut self,
        page: &mut Page,
        work: &str,
        inside: impl FnOnce(&mut Self, &mut Page),
    ) {
        let work = match &self.mask {
            None => work.to_string(),
            Some(mask) => format!("{mask} & ({work})"),
        };
        self.open_instances(page, Some(&work));
        inside(self, page);
        page.close();
    }

    fn reset(&mut self, page: &mut Page, place: &Place, holds: bool) {
        let fields = self.classes.fields;
        let Some(done) = lanes(fields, place.class, place.number) else {
            return;
        };
        let mask = self.mask.clone();
        self.open_instances(page, mask.as_deref());
        let mut code = Code::new();
        self.writer.reset(&mut code, place, holds);
        page.commented(&code, None);
        page.close();
        self.put(page, &done, "(plc_lanes)0");
        if let (true, Some(coil)) = (holds, coil(fields, place.class, place.number)) {
            self.put(page, &coil, "~(plc_lanes)0");
        }
    }

    /// A bit in lanes as a constant with its own name.
    fn named_bits(&mut self, page: &mut Page, value: ExprId, name: &str) -> String {
        let mask = self.mask.clone();
        let value = self.bits(page, value, mask.as_deref());
        page.line(&format!("const plc_lanes {name} = {value};"));
        name.to_string()
    }

    /// The lanes of a place, or of that of the loop's current iteration; `None` if nothing reads it.
    fn place(&self, place: &Place) -> Option<String> {
        if place.index.is_none() {
            return lanes(self.classes.fields, place.class, place.number);
        }
        let mut name = String::new();
        self.writer
            .access_iteration(&mut name, place)
            .then(|| in_lanes(&name))
    }

    /// A bit as an expression on lanes. What each instance has to find out by itself is found out before it.
    fn bits(&mut self, page: &mut Page, id: ExprId, mask: Option<&str>) -> String {
        if let Some(name) = self.named.get(&id) {
            return name.clone();
        }
        let expr = *self.classes.module.expr(id);
        if let Expr::Bit(on) = expr {
            return if on { "PLC_ALL_LANES" } else { "(plc_lanes)0" }.to_string();
        }
        if let Expr::Temp(temp) = expr {
            return format!("lanes_{}", self.classes.plan.temp(temp));
        }
        if let Expr::Not(a) = expr {
            return format!("~{}", self.bits(page, a, mask));
        }
        if let Expr::And(a, b) = expr {
            return self.pair(page, a, "&", b, mask);
        }
        if let Expr::Or(a, b) = expr {
            return self.pair(page, a, "|", b, mask);
        }
        if let Expr::Flag(flag) = expr {
            return format!("all->{}", self.classes.module.flags[flag].name);
        }
        if let Expr::Sys(SysValue::Running) = expr {
            return "PLC_ALL_LANES".to_string();
        }
        match expr.as_bit() {
            Some(place) if self.classes.is_lanes(id) => self
                .place(&place)
                .unwrap_or_else(|| "(plc_lanes)0".to_string()),
            _ => self.found_out(page, id, mask),
        }
    }

    fn pair(
        &mut self,
        page: &mut Page,
        a: ExprId,
        op: &str,
        b: ExprId,
        mask: Option<&str>,
    ) -> String {
        let (a, b) = (self.bits(page, a, mask), self.bits(page, b, mask));
        format!("({a} {op} {b})")
    }

    /// A bit that each instance finds out: a comparison of words.
    fn found_out(&mut self, page: &mut Page, id: ExprId, mask: Option<&str>) -> String {
        let mut code = Code::new();
        self.writer.expr(&mut code, id, Around::Exact);
        if self.classes.is_uniform(id) {
            // All that it looks at is what the scan driver knows.
            return format!("plc_all_lanes({})", code.as_str().replace("plc->", "all->"));
        }
        self.names += 1;
        let name = format!("found{}", self.names);
        page.line(&format!("plc_lanes {name} = 0;"));
        self.open_instances(page, mask);
        page.line(&format!("{name} |= (plc_lanes)({}) << l;", code.as_str()));
        page.close();
        name
    }
}

/// The temporaries that nodes read and assign.
fn temps(
    classes: &Classes,
    node: &Node,
    read: &mut BTreeSet<TempId>,
    assigns: &mut BTreeSet<TempId>,
) {
    for root in node.roots() {
        classes.temps_read(root, read);
    }
    if let Node::Stmt(stmt) = node {
        assigns.extend(assigned(stmt));
    }
    for body in node.bodies() {
        body.iter()
            .for_each(|node| temps(classes, node, read, assigns));
    }
}

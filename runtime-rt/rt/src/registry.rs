//! The list of runtime functions. The catalogue names one in a row's `lower`; the interpreter calls it through
//! [`RtFn::call`], emitted Rust through the function of the same name in [`crate::fnc`], emitted C through the C ABI.

use crate::cx::Cx;
use crate::fault::Done;
use crate::fnc;
use crate::wiring::Looks;

/// Requirements of a function on the surrounding program.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Needs {
    /// Private memory ([`crate::State`]).
    pub state: bool,
    /// Is called in every scan, with [`crate::Site::drive`] telling whether it is driven.
    pub always: bool,
    /// Asks the hardware ([`crate::Hal`]).
    pub hal: bool,
    /// One of its operands names a pulse output ([`crate::Axis`]).
    pub pulses: bool,
    /// It looks at the position of the output and at the speeds and times of ramps ([`crate::Looks`]).
    pub ramps: bool,
    /// It looks at the speeds and times of a return to the origin.
    pub home: bool,
    /// It looks at the unit of PWM.
    pub unit: bool,
    /// It gives a clear signal on an output Y that a register may name.
    pub clears: bool,
    /// It waits for the interrupt input of its output.
    pub interrupt: bool,
    /// It works on an axis of HM, whose registers name its outputs.
    pub axis: bool,
    /// It looks at inputs X, and is also called at their edges ([`crate::Site::signal`]): at those of the inputs that
    /// it names or that belong to its output ([`crate::Wiring::inputs`]).
    pub signals: bool,
    /// It works on the serial port of RS ([`crate::Ports::of_rs`]).
    pub port: bool,
    /// It works on the serial port that its last operand names ([`crate::Ports::named`]).
    pub names_port: bool,
    /// It works on a serial port that a register names: all of the model are there.
    pub any_port: bool,
    /// It works on the CAN card ([`crate::comm::CAN_PORT`]).
    pub can: bool,
    /// In the routine of a timer interrupt, its time is the period ([`crate::Site::period_ms`]).
    pub sampled: bool,
    /// Registers give it devices by number, of any class that a scan may write.
    pub anywhere: bool,
}

impl Needs {
    /// Registers that it reads.
    pub const fn looks(self) -> Looks {
        let Needs {
            ramps,
            home,
            unit,
            clears,
            interrupt,
            ..
        } = self;
        Looks {
            ramps,
            home,
            unit,
            clears,
            interrupt,
        }
    }
}

macro_rules! registry {
    ($($variant:ident = $module:ident::$function:ident($($operand:ident),*) $([$($need:ident),*])?;)*) => {
        /// A runtime function.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum RtFn {
            $(
                #[doc = concat!("[`", stringify!($function), "`](crate::fnc::", stringify!($module), "::", stringify!($function), ").")]
                $variant,
            )*
        }

        impl RtFn {
            /// All of them.
            pub const ALL: &'static [RtFn] = &[$(RtFn::$variant),*];

            /// Name of the function in [`crate::fnc`] and, after `rungc_`, in the C ABI.
            pub const fn name(self) -> &'static str {
                match self { $(RtFn::$variant => stringify!($function),)* }
            }

            /// The module of [`crate::fnc`] that contains it.
            pub const fn module(self) -> &'static str {
                match self { $(RtFn::$variant => stringify!($module),)* }
            }

            /// Names of its operands.
            pub const fn operands(self) -> &'static [&'static str] {
                match self { $(RtFn::$variant => &[$(stringify!($operand)),*],)* }
            }

            /// Requirements of the function.
            pub const fn needs(self) -> Needs {
                #[allow(unused_mut, reason = "functions that need nothing change nothing")]
                match self { $(RtFn::$variant => {
                    let mut needs = Needs {
                        state: false,
                        always: false,
                        hal: false,
                        pulses: false,
                        ramps: false,
                        home: false,
                        unit: false,
                        clears: false,
                        interrupt: false,
                        axis: false,
                        signals: false,
                        port: false,
                        names_port: false,
                        any_port: false,
                        can: false,
                        sampled: false,
                        anywhere: false,
                    };
                    $($(needs.$need = true;)*)?
                    needs
                })* }
            }

            /// Runs it.
            pub fn call(self, cx: &mut Cx) -> Done {
                match self { $(RtFn::$variant => fnc::$module::$function(cx),)* }
            }
        }

        $(
            #[cfg(feature = "capi")]
            crate::capi::export!($module::$function($($operand),*));
        )*
    };
}

registry! {
    Smov = move_::smov(s, m1, m2, d, n);
    Bmov = move_::bmov(s, d, n);
    BmovForward = move_::bmov_forward(s, d, n);
    Fmov = move_::fmov(s, d, n);
    Rcr = rotate::rcr(d, n);
    Rcl = rotate::rcl(d, n);
    Sftr = rotate::sftr(s, d, n1, n2);
    Sftl = rotate::sftl(s, d, n1, n2);
    Wsfr = rotate::wsfr(s, d, n1, n2);
    Wsfl = rotate::wsfl(s, d, n1, n2);
    Sfwr = rotate::sfwr(s, d, n);
    Sfrd = rotate::sfrd(s, d, n);
    SfwrHm = rotate::sfwr_hm(s, d, n);
    SfrdHm = rotate::sfrd_hm(s, d, n);
    Pop = rotate::pop(s, d, n);
    Sfr = rotate::sfr(d, n);
    Sfl = rotate::sfl(d, n);
    Zrst = data::zrst(d1, d2);
    Deco = data::deco(s, d, n);
    Enco = data::enco(s, d, n);
    EncoZero = data::enco_zero(s, d, n);
    Mean = data::mean(s, d, n);
    MeanSum = data::mean_sum(s, d, n);
    Ans = data::ans(s, m, d) [state, always];
    Anr = data::anr();
    Flt = float::flt(s, d);
    Ecmp = float::ecmp(s1, s2, d);
    Ezcp = float::ezcp(s1, s2, s, d);
    Emov = float::emov(s, d);
    Ebcd = float::ebcd(s, d);
    Ebin = float::ebin(s, d);
    Eadd = float::eadd(s1, s2, d);
    Esub = float::esub(s1, s2, d);
    Emul = float::emul(s1, s2, d);
    Ediv = float::ediv(s1, s2, d);
    EaddPlain = float::eadd_plain(s1, s2, d);
    EsubPlain = float::esub_plain(s1, s2, d);
    EmulPlain = float::emul_plain(s1, s2, d);
    EdivClamped = float::ediv_clamped(s1, s2, d);
    Exp = float::exp(s, d);
    Loge = float::loge(s, d);
    Log10 = float::log10(s, d);
    Esqr = float::esqr(s, d);
    EsqrClamped = float::esqr_clamped(s, d);
    Eneg = float::eneg(d);
    Int = float::int(s, d);
    IntClamped = float::int_clamped(s, d);
    Sin = float::sin(s, d);
    Cos = float::cos(s, d);
    Tan = float::tan(s, d);
    Asin = float::asin(s, d);
    Acos = float::acos(s, d);
    Atan = float::atan(s, d);
    Rad = float::rad(s, d);
    Deg = float::deg(s, d);
    Sinh = float::sinh(s, d);
    Cosh = float::cosh(s, d);
    Tanh = float::tanh(s, d);
    Prun = serial::prun(s, d);
    Asci = serial::asci(s, d, n);
    AsciBytes = serial::asci_bytes(s, d, n);
    Hex = serial::hex(s, d, n);
    HexBytes = serial::hex_bytes(s, d, n);
    Ccd = serial::ccd(s, d, n);
    Crc = serial::crc(s, d, n);
    Rs = serial::rs(s, m, d, n) [always, port];
    Rs2 = serial::rs2(s, m, d, n, n1) [always, names_port];
    Modbus = modbus::modbus(s1, s2, n, d) [always, port];
    Modbus2 = modbus::modbus2(s1, s2, n, d, n1) [always, names_port];
    Rd3aModbus = modbus::rd3a_modbus(m1, m2, d) [always, any_port];
    Wr3aModbus = modbus::wr3a_modbus(m1, m2, s) [always, any_port];
    Adprw = modbus::adprw(s, s1, s2, s3, d) [always, any_port];
    AdprwFx3 = modbus::adprw_fx3(s, s1, s2, s3, d) [always, any_port];
    Ivrd = modbus::ivrd(s1, s2, d, n) [always, port];
    Ivwr = modbus::ivwr(s1, s2, s3, n) [always, port];
    Mrdc = modbus::mrdc(s1, s2, s3, d1, d2) [state, always, names_port];
    Mrdi = modbus::mrdi(s1, s2, s3, d1, d2) [state, always, names_port];
    Mrdd = modbus::mrdd(s1, s2, s3, d1, d2) [state, always, names_port];
    Mrdai = modbus::mrdai(s1, s2, s3, d1, d2) [state, always, names_port];
    Mwrc = modbus::mwrc(s1, s2, d1, d2) [state, always, names_port];
    Mwrd = modbus::mwrd(s1, s2, d1, d2) [state, always, names_port];
    Mwrcs = modbus::mwrcs(s1, s2, s3, d1, d2) [state, always, names_port];
    Mwrds = modbus::mwrds(s1, s2, s3, d1, d2) [state, always, names_port];
    Cantx = can::cantx(s1, s2, d, n) [hal, can];
    Canrx = can::canrx(s1, s2, d, n) [can];
    Cannet = canlink::cannet(s1, s2, s3) [hal, can];
    Cannode = canlink::cannode(s1, s2) [can];
    Canput = canlink::canput(s1, d, s2, s3, n) [state, always, hal, can];
    Uinit = serial::uinit(s1, s2, d1, d2) [names_port];
    Usend = serial::usend(s1, s2, d) [names_port];
    Urcv = serial::urcv(s1, s2, d) [names_port];
    Tcmp = clock::tcmp(s1, s2, s3, s, d);
    Tzcp = clock::tzcp(s1, s2, s, d);
    Tadd = clock::tadd(s1, s2, d);
    Tsub = clock::tsub(s1, s2, d);
    Htos = clock::htos(s, d);
    Stoh = clock::stoh(s, d);
    Trd = clock::trd(d) [hal];
    TrdShort = clock::trd_short(d) [hal];
    Twr = clock::twr(s) [hal];
    TwrShort = clock::twr_short(s) [hal];
    ClockRefresh = clock::clock_refresh() [state, always, hal];
    ClockRefreshShort = clock::clock_refresh_short() [state, always, hal];
    Hour = clock::hour(s, d1, d2) [state, always];
    Wsum = block::wsum(s, d, n);
    Wtob = block::wtob(s, d, n);
    Btow = block::btow(s, d, n);
    Uni = block::uni(s, d, n);
    Dis = block::dis(s, d, n);
    Sort2 = handy::sort2(s, m1, m2, d, n) [state, always];
    Rnd = block::rnd(d);
    Duty = block::duty(n1, n2, d) [state, always];
    BkAdd = block::bk_add(s1, s2, d, n);
    BkSub = block::bk_sub(s1, s2, d, n);
    BkcmpEq = block::bkcmp_eq(s1, s2, d, n);
    BkcmpGt = block::bkcmp_gt(s1, s2, d, n);
    BkcmpLt = block::bkcmp_lt(s1, s2, d, n);
    BkcmpNe = block::bkcmp_ne(s1, s2, d, n);
    BkcmpLe = block::bkcmp_le(s1, s2, d, n);
    BkcmpGe = block::bkcmp_ge(s1, s2, d, n);
    Fdel = block::fdel(s, d, n);
    Fins = block::fins(s, d, n);
    Zpush = block::zpush(d);
    Zpop = block::zpop(d);
    Scl = scale::scl(s1, s2, d);
    Scl2 = scale::scl2(s1, s2, d);
    Estr = text::estr(s1, s2, d);
    Eval = text::eval(s, d);
    Str = text::str(s1, s2, d);
    Val = text::val(s, d1, d2);
    StrAdd = text::str_add(s1, s2, d);
    Len = text::len(s, d);
    Right = text::right(s, d, n);
    Left = text::left(s, d, n);
    Midr = text::midr(s1, d, s2);
    Midw = text::midw(s1, d, s2);
    Instr = text::instr(s1, s2, d, n);
    StrMov = text::str_mov(s, d);
    Dabin = text::dabin(s, d);
    Binda = text::binda(s, d);
    Ist = handy::ist(s, d1, d2) [state];
    Ser = handy::ser(s1, s2, d, n);
    Absd = handy::absd(s1, s2, d, n);
    Incd = handy::incd(s1, s2, d, n) [state, always];
    Ttmr = handy::ttmr(d, n) [state, always];
    Stmr = handy::stmr(s, m, d) [state, always];
    Ramp = handy::ramp(s1, s2, d, n) [state, always];
    Rotc = handy::rotc(s, m1, m2, d) [state, always];
    Sort = handy::sort(s, m1, m2, d, n) [state, always];
    LogError = system::log_error(n);
    PowerSupply = supply::power_supply() [state, always, hal];
    AnalogInputs = system::analog_inputs() [always, hal];
    Potentiometers = system::potentiometers() [always, hal];
    ExchangeModule = exchange::exchange_module(unit, d, reads, n, period) [state, always, hal];
    ExchangeBoard = exchange::exchange_board(s, d) [always, hal];
    ExchangeAdapter = exchange::exchange_adapter(unit, m, d, sent, received) [always, hal];
    Oscilloscope = scope::oscilloscope(n, d) [state];
    Ptab = segment::ptab(s, d, n) [state, always];
    Pctab = cut::pctab(s, d) [state, always];
    Pbtab = cut::pbtab(s, d) [state, always];
    FromStated = modules::from_stated(m1, m2, d, n) [hal];
    ToStated = modules::to_stated(m1, m2, s, n) [hal];
    FromHost = modules::from_host(m1, m2, d, n) [hal];
    ToHost = modules::to_host(m1, m2, s, n) [hal];
    FromRemote = modules::from_remote(m1, m2, d, n) [hal];
    ToRemote = modules::to_remote(m1, m2, s, n) [hal];
    Ref = modules::refresh_terminals(d, n) [hal];
    RefHm = modules::refresh_terminals_hm(d, n) [hal];
    Reff = modules::reff(n) [hal];
    Mtr = keys::mtr(s, d1, d2, n) [state, always];
    Plsy = pulses::plsy(s1, s2, d) [state, always, pulses];
    Pwm = pulses::pwm(s1, s2, d) [state, always, pulses, unit];
    Plsr = pulses::plsr(s1, s2, s3, d) [state, always, pulses, ramps];
    Dszr = position::dszr(s1, s2, d1, d2) [state, always, pulses, ramps, home, clears, signals];
    Dvit = position::dvit(s1, s2, d1, d2) [state, always, pulses, ramps, interrupt, signals];
    StopPulses = pulses::stop_pulses(d) [pulses];
    AxisPlsy = axes::axis_plsy(d1, d2, axis) [state, always, pulses, axis, signals];
    AxisPlsr = axes::axis_plsr(d1, d2, d3, axis) [state, always, pulses, axis, signals];
    AxisDrvi = axes::axis_drvi(d1, d2, axis) [state, always, pulses, axis, signals];
    AxisDrva = axes::axis_drva(d1, d2, axis) [state, always, pulses, axis, signals];
    AxisDvit = axes::axis_dvit(d1, d2, axis) [state, always, pulses, axis, signals];
    AxisPlsv = axes::axis_plsv(d1, axis) [state, always, pulses, axis, signals];
    AxisPsout = axes::axis_psout(axis, d2) [state, always, pulses, axis, signals];
    AxisGear = axis_follow::axis_gear(axis, d2, d3, d4, d5) [state, always, pulses, axis];
    AxisPtout = axis_follow::axis_ptout(axis, d2, d3, d4, d5) [state, always, pulses, axis];
    AxisCam = axis_cam::axis_cam(axis, d2, d3, d4, d5) [state, always, pulses, axis, anywhere];
    AxisIpl = axis_follow::axis_ipl(axis, d2) [state, always, pulses, axis];
    AxisJog = axis_jog::axis_jog(axis, d2, d3, d4, d5) [state, always, pulses, axis, signals];
    AxisHome = axis_home::axis_home(axis) [state, always, pulses, axis, signals];
    Abs = servo::abs(s, d1, d2) [state, always];
    Zrn = position::zrn(s1, s2, s3, d) [state, always, pulses, ramps, clears, signals];
    Plsv = position::plsv(s, d1, d2) [state, always, pulses, ramps];
    Drvi = position::drvi(s1, s2, d1, d2) [state, always, pulses, ramps];
    Drva = position::drva(s1, s2, d1, d2) [state, always, pulses, ramps];
    Tky = keys::tky(s, d1, d2) [state, always];
    Hky = keys::hky(s, d1, d2, d3) [state, always];
    Dsw = keys::dsw(s, d1, d2, n) [state, always];
    Segl = display::segl(s, d, n) [state, always];
    Arws = display::arws(s, d1, d2, n) [state, always];
    Asc = display::asc(s, d);
    Pr = display::pr(s, d) [state, always];
    PrSignalsOff = display::pr_signals_off(s, d) [state, always];
    From = modules::from(m1, m2, d, n) [hal];
    To = modules::to(m1, m2, s, n) [hal];
    Rd3a = modules::rd3a(m1, m2, d) [hal];
    Wr3a = modules::wr3a(m1, m2, s) [hal];
    Rd3aBoard = modules::rd3a_board(m1, m2, d) [hal];
    Wr3aBoard = modules::wr3a_board(m1, m2, s) [hal];
    Vrrd = modules::vrrd(s, d) [hal];
    Vrsc = modules::vrsc(s, d) [hal];
    Rbfm = modules::rbfm(m1, m2, d, n1, n2) [state, always, hal];
    Wbfm = modules::wbfm(m1, m2, s, n1, n2) [state, always, hal];
    Pid = pid::pid(s1, s2, s3, d) [state, sampled];
    PidTuning = pid::pid_tuning(s1, s2, s3, d) [state, sampled];
    PidChecked = pid::pid_checked(s1, s2, s3, d) [state, sampled];
    PidHm = pid::pid_hm(s1, s2, s3, d) [state];
    PidThermal = pid_thermal::pid_thermal(s1, s2, s3, d) [state, sampled];
    Loadr = cassette::loadr(s, n, er);
    Saver = cassette::saver(s, n, d, er) [state, always];
    Initr = cassette::initr(s, n, er);
    Rwer = cassette::rwer(s, n, er);
    Initer = cassette::initer(s, n, er);
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_are_unique() {
        let names: HashSet<&str> = RtFn::ALL.iter().map(|f| f.name()).collect();
        assert_eq!(names.len(), RtFn::ALL.len());
    }
}

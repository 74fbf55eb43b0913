//! The list of runtime functions. The catalogue names one in a row's `lower`; the interpreter calls it through
//! [`RtFn::call`], emitted Rust through the function of the same name in [`crate::fnc`], emitted C through the C ABI.

use crate::cx::Cx;
use crate::fault::Done;
use crate::fnc;
use crate::wiring::Looks;

/// What a function needs from the program around it.
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
    /// It looks at inputs X, and is also called at their edges ([`crate::Site::signal`]): at those of the inputs that it names or that
    /// belong to its output ([`crate::Wiring::inputs`]).
    pub signals: bool,
    /// It works on the serial port of RS ([`crate::Ports::of_rs`]).
    pub port: bool,
    /// It works on the serial port that its last operand names ([`crate::Ports::named`]).
    pub names_port: bool,
    /// It works on a serial port that a register names: all of the model are there.
    pub any_port: bool,
    /// Registers give it devices by number, of any class that a scan may write.
    pub anywhere: bool,
}

impl Needs {
    /// What it looks at.
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
    ($($(#[$doc:meta])* $variant:ident = $module:ident::$function:ident($($operand:ident),*) $([$($need:ident),*])?;)*) => {
        /// A runtime function.
        #[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum RtFn { $($(#[$doc])* $variant,)* }

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

            /// What it needs.
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
                        signals: false,
                        port: false,
                        names_port: false,
                        any_port: false,
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
    /// SMOV (FNC 13): moves digits; M8168 selects hexadecimal ones.
    Smov = move_::smov(s, m1, m2, d, n);
    /// BMOV (FNC 15): copies a block; M8024 turns the direction.
    Bmov = move_::bmov(s, d, n);
    /// BMOV of HM: M8024 is ignored.
    BmovForward = move_::bmov_forward(s, d, n);
    /// FMOV (FNC 16): fills a block.
    Fmov = move_::fmov(s, d, n);
    /// XCH (FNC 17): exchanges; M8160 exchanges bytes.
    Xch = move_::xch(d1, d2);
    /// XCH of HM: M8160 is ignored.
    XchWords = move_::xch_words(d1, d2);
    /// SWAP (FNC 147): exchanges the bytes of each word.
    Swap = move_::swap(s);
    /// BCD (FNC 18): binary to packed decimal.
    Bcd = move_::bcd(s, d);
    /// BCD of HM: clamps.
    BcdClamped = move_::bcd_clamped(s, d);
    /// BIN (FNC 19): packed decimal to binary.
    Bin = move_::bin(s, d);
    /// BIN of HM: no check of the digits.
    BinUnchecked = move_::bin_unchecked(s, d);
    /// ROR (FNC 30): rotates right.
    Ror = rotate::ror(d, n);
    /// ROL (FNC 31): rotates left.
    Rol = rotate::rol(d, n);
    /// RCR (FNC 32): rotates right through the carry flag.
    Rcr = rotate::rcr(d, n);
    /// RCL (FNC 33): rotates left through the carry flag.
    Rcl = rotate::rcl(d, n);
    /// SFTR (FNC 34): shifts bits right.
    Sftr = rotate::sftr(s, d, n1, n2);
    /// SFTL (FNC 35): shifts bits left.
    Sftl = rotate::sftl(s, d, n1, n2);
    /// WSFR (FNC 36): shifts words right.
    Wsfr = rotate::wsfr(s, d, n1, n2);
    /// WSFL (FNC 37): shifts words left.
    Wsfl = rotate::wsfl(s, d, n1, n2);
    /// SFWR (FNC 38): appends to a queue.
    Sfwr = rotate::sfwr(s, d, n);
    /// SFRD (FNC 39): takes from a queue.
    Sfrd = rotate::sfrd(s, d, n);
    /// SFWR of HM: enters at the front.
    SfwrHm = rotate::sfwr_hm(s, d, n);
    /// SFRD of HM: moves only what the queue holds.
    SfrdHm = rotate::sfrd_hm(s, d, n);
    /// POP (FNC 212): takes the newest entry of a queue.
    Pop = rotate::pop(s, d, n);
    /// SFR (FNC 213): shifts a word right.
    Sfr = rotate::sfr(d, n);
    /// SFL (FNC 214): shifts a word left.
    Sfl = rotate::sfl(d, n);
    /// ZRST (FNC 40): clears a run of devices.
    Zrst = data::zrst(d1, d2);
    /// DECO (FNC 41): switches the bit of that number on.
    Deco = data::deco(s, d, n);
    /// ENCO (FNC 42): number of the highest bit that is on.
    Enco = data::enco(s, d, n);
    /// SUM (FNC 43): counts the one-bits of S into D.
    Sum = data::sum(s, d);
    /// BON (FNC 44): tests a bit.
    Bon = data::bon(s, d, n);
    /// MEAN (FNC 45): mean of a block.
    Mean = data::mean(s, d, n);
    /// MEAN of H1U/H2U: M8490 adds the sum.
    MeanSum = data::mean_sum(s, d, n);
    /// ANS (FNC 46): sets an annunciator after a time.
    Ans = data::ans(s, m, d) [state, always];
    /// ANR (FNC 47): resets the lowest annunciator.
    Anr = data::anr();
    /// SQR (FNC 48): square root of an integer.
    Sqr = data::sqr(s, d);
    /// SQR of HM: 0 for a negative number.
    SqrClamped = data::sqr_clamped(s, d);
    /// FLT (FNC 49): integer to float.
    Flt = float::flt(s, d);
    /// ECMP (FNC 110): compares floats.
    Ecmp = float::ecmp(s1, s2, d);
    /// EZCP (FNC 111): compares a float with a zone.
    Ezcp = float::ezcp(s1, s2, s, d);
    /// EMOV (FNC 112): copies a float.
    Emov = float::emov(s, d);
    /// EBCD (FNC 118): float to decimal mantissa and exponent.
    Ebcd = float::ebcd(s, d);
    /// EBIN (FNC 119): decimal mantissa and exponent to float.
    Ebin = float::ebin(s, d);
    /// EADD (FNC 120): sum of floats.
    Eadd = float::eadd(s1, s2, d);
    /// ESUB (FNC 121): difference of floats.
    Esub = float::esub(s1, s2, d);
    /// EMUL (FNC 122): product of floats.
    Emul = float::emul(s1, s2, d);
    /// EDIV (FNC 123): quotient of floats.
    Ediv = float::ediv(s1, s2, d);
    /// EADD of HM: no flags.
    EaddPlain = float::eadd_plain(s1, s2, d);
    /// ESUB of HM: no flags.
    EsubPlain = float::esub_plain(s1, s2, d);
    /// EMUL of HM: no flags.
    EmulPlain = float::emul_plain(s1, s2, d);
    /// EDIV of HM: a divisor of 0 is not an error.
    EdivClamped = float::ediv_clamped(s1, s2, d);
    /// EXP (FNC 124): power of e.
    Exp = float::exp(s, d);
    /// LOGE (FNC 125): natural logarithm.
    Loge = float::loge(s, d);
    /// LOG10 (FNC 126): common logarithm.
    Log10 = float::log10(s, d);
    /// ESQR (FNC 127): square root of a float.
    Esqr = float::esqr(s, d);
    /// ESQR of HM: 0 for a value that is not finite, no flag.
    EsqrClamped = float::esqr_clamped(s, d);
    /// ENEG (FNC 128): turns a float's sign.
    Eneg = float::eneg(d);
    /// INT (FNC 129): integer part of a float.
    Int = float::int(s, d);
    /// INT of HM: clamps.
    IntClamped = float::int_clamped(s, d);
    /// SIN (FNC 130).
    Sin = float::sin(s, d);
    /// COS (FNC 131).
    Cos = float::cos(s, d);
    /// TAN (FNC 132).
    Tan = float::tan(s, d);
    /// ASIN (FNC 133).
    Asin = float::asin(s, d);
    /// ACOS (FNC 134).
    Acos = float::acos(s, d);
    /// ATAN (FNC 135).
    Atan = float::atan(s, d);
    /// RAD (FNC 136): degrees to radians.
    Rad = float::rad(s, d);
    /// DEG (FNC 137): radians to degrees.
    Deg = float::deg(s, d);
    /// SINH (FNC 438).
    Sinh = float::sinh(s, d);
    /// COSH (FNC 439).
    Cosh = float::cosh(s, d);
    /// TANH (FNC 440).
    Tanh = float::tanh(s, d);
    /// PRUN (FNC 81): copies bits in octal rows.
    Prun = serial::prun(s, d);
    /// ASCI (FNC 82): hexadecimal digits to characters; M8161 selects one a word.
    Asci = serial::asci(s, d, n);
    /// ASCI of HM: one character a word.
    AsciBytes = serial::asci_bytes(s, d, n);
    /// HEX (FNC 83): characters to hexadecimal digits; M8161 selects one a word.
    Hex = serial::hex(s, d, n);
    /// HEX of HM: one character a word, unchecked.
    HexBytes = serial::hex_bytes(s, d, n);
    /// CCD (FNC 84): sum and parity of bytes.
    Ccd = serial::ccd(s, d, n);
    /// CRC (FNC 188): CRC-16 of bytes.
    Crc = serial::crc(s, d, n);
    /// RS (FNC 80): sends and receives bytes.
    Rs = serial::rs(s, m, d, n) [always, port];
    /// RS2 (FNC 87): the same on a port.
    Rs2 = serial::rs2(s, m, d, n, n1) [always, names_port];
    /// MODBUS (FNC 89, H1U and H2U): Modbus requests.
    Modbus = modbus::modbus(s1, s2, n, d) [always, port];
    /// MODBUS2 (FNC 93, H1U and H2U): the same on a port.
    Modbus2 = modbus::modbus2(s1, s2, n, d, n1) [always, names_port];
    /// RD3A (FNC 176, L01S): reads registers by Modbus.
    Rd3aModbus = modbus::rd3a_modbus(m1, m2, d) [always, any_port];
    /// WR3A (FNC 177, L01S): writes registers by Modbus.
    Wr3aModbus = modbus::wr3a_modbus(m1, m2, s) [always, any_port];
    /// ADPRW (FNC 276, L01S): a Modbus request.
    Adprw = modbus::adprw(s, s1, s2, s3, d) [always, any_port];
    /// IVRD (FNC 272, compatible boards): reads by Modbus.
    Ivrd = modbus::ivrd(s1, s2, d, n) [always, port];
    /// IVWR (FNC 273, compatible boards): writes by Modbus.
    Ivwr = modbus::ivwr(s1, s2, s3, n) [always, port];
    /// MRDC (HM): reads coils.
    Mrdc = modbus::mrdc(s1, s2, s3, d1, d2) [state, always, names_port];
    /// MRDI (HM): reads inputs.
    Mrdi = modbus::mrdi(s1, s2, s3, d1, d2) [state, always, names_port];
    /// MRDD (HM): reads registers.
    Mrdd = modbus::mrdd(s1, s2, s3, d1, d2) [state, always, names_port];
    /// MRDAI (HM): reads input registers.
    Mrdai = modbus::mrdai(s1, s2, s3, d1, d2) [state, always, names_port];
    /// MWRC (HM): writes a coil.
    Mwrc = modbus::mwrc(s1, s2, d1, d2) [state, always, names_port];
    /// MWRD (HM): writes a register.
    Mwrd = modbus::mwrd(s1, s2, d1, d2) [state, always, names_port];
    /// MWRCS (HM): writes coils.
    Mwrcs = modbus::mwrcs(s1, s2, s3, d1, d2) [state, always, names_port];
    /// MWRDS (HM): writes registers.
    Mwrds = modbus::mwrds(s1, s2, s3, d1, d2) [state, always, names_port];
    /// UINIT (HM): sets up a port.
    Uinit = serial::uinit(s1, s2, d1, d2) [names_port];
    /// USEND (HM): sends bytes.
    Usend = serial::usend(s1, s2, d) [names_port];
    /// URCV (HM): receives bytes.
    Urcv = serial::urcv(s1, s2, d) [names_port];
    /// TCMP (FNC 160): compares times of day.
    Tcmp = clock::tcmp(s1, s2, s3, s, d);
    /// TZCP (FNC 161): compares a time of day with a zone.
    Tzcp = clock::tzcp(s1, s2, s, d);
    /// TADD (FNC 162): sum of times of day.
    Tadd = clock::tadd(s1, s2, d);
    /// TSUB (FNC 163): difference of times of day.
    Tsub = clock::tsub(s1, s2, d);
    /// HTOS (FNC 164): hours, minutes, seconds to seconds.
    Htos = clock::htos(s, d);
    /// STOH (FNC 165): seconds to hours, minutes, seconds.
    Stoh = clock::stoh(s, d);
    /// TRD (FNC 166): reads the clock.
    Trd = clock::trd(d) [hal];
    /// TRD with two digits of the year (L01S, FX).
    TrdShort = clock::trd_short(d) [hal];
    /// TWR (FNC 167): sets the clock.
    Twr = clock::twr(s) [hal];
    /// TWR with two or four digits of the year (L01S, FX).
    TwrShort = clock::twr_short(s) [hal];
    /// D8013–D8019 from the clock and M8015–M8017, once before each scan's program.
    ClockRefresh = clock::clock_refresh() [state, always, hal];
    /// The same with two digits of the year (L01S, FX).
    ClockRefreshShort = clock::clock_refresh_short() [state, always, hal];
    /// HOUR (FNC 169): hour meter.
    Hour = clock::hour(s, d1, d2) [state, always];
    /// GRY (FNC 170): to Gray code.
    Gry = gray::gry(s, d);
    /// GBIN (FNC 171): from Gray code.
    Gbin = gray::gbin(s, d);
    /// WSUM (FNC 140): sum of a block.
    Wsum = block::wsum(s, d, n);
    /// WTOB (FNC 141): words to bytes.
    Wtob = block::wtob(s, d, n);
    /// BTOW (FNC 142): bytes to words.
    Btow = block::btow(s, d, n);
    /// UNI (FNC 143): joins nibbles.
    Uni = block::uni(s, d, n);
    /// DIS (FNC 144): parts nibbles.
    Dis = block::dis(s, d, n);
    /// SORT2 (FNC 149): sorts rows.
    Sort2 = handy::sort2(s, m1, m2, d, n) [state, always];
    /// RND (FNC 184): random number.
    Rnd = block::rnd(d);
    /// DUTY (FNC 186): timing by scans.
    Duty = block::duty(n1, n2, d) [state, always];
    /// BK+ (FNC 192): sums of blocks.
    BkAdd = block::bk_add(s1, s2, d, n);
    /// BK- (FNC 193): differences of blocks.
    BkSub = block::bk_sub(s1, s2, d, n);
    /// BKCMP= (FNC 194).
    BkcmpEq = block::bkcmp_eq(s1, s2, d, n);
    /// BKCMP> (FNC 195).
    BkcmpGt = block::bkcmp_gt(s1, s2, d, n);
    /// BKCMP< (FNC 196).
    BkcmpLt = block::bkcmp_lt(s1, s2, d, n);
    /// BKCMP<> (FNC 197).
    BkcmpNe = block::bkcmp_ne(s1, s2, d, n);
    /// BKCMP<= (FNC 198).
    BkcmpLe = block::bkcmp_le(s1, s2, d, n);
    /// BKCMP>= (FNC 199).
    BkcmpGe = block::bkcmp_ge(s1, s2, d, n);
    /// FDEL (FNC 210): deletes from a table.
    Fdel = block::fdel(s, d, n);
    /// FINS (FNC 211): inserts into a table.
    Fins = block::fins(s, d, n);
    /// ZPUSH (FNC 102): saves the index registers.
    Zpush = block::zpush(d);
    /// ZPOP (FNC 103): restores the index registers.
    Zpop = block::zpop(d);
    /// LIMIT (FNC 256): holds a value between bounds.
    Limit = scale::limit(s1, s2, s3, d);
    /// BAND (FNC 257): dead band.
    Band = scale::band(s1, s2, s3, d);
    /// ZONE (FNC 258): adds a bias by sign.
    Zone = scale::zone(s1, s2, s3, d);
    /// SCL (FNC 259): scales by a table of points.
    Scl = scale::scl(s1, s2, d);
    /// SCL2 (FNC 269): scales by a table of coordinates.
    Scl2 = scale::scl2(s1, s2, d);
    /// ESTR (FNC 116): float to text.
    Estr = text::estr(s1, s2, d);
    /// EVAL (FNC 117): text to float.
    Eval = text::eval(s, d);
    /// STR (FNC 200): integer to text.
    Str = text::str(s1, s2, d);
    /// VAL (FNC 201): text to integer.
    Val = text::val(s, d1, d2);
    /// $+ (FNC 202): joins texts.
    StrAdd = text::str_add(s1, s2, d);
    /// LEN (FNC 203): length of a text.
    Len = text::len(s, d);
    /// RIGHT (FNC 204): end of a text.
    Right = text::right(s, d, n);
    /// LEFT (FNC 205): beginning of a text.
    Left = text::left(s, d, n);
    /// MIDR (FNC 206): middle of a text.
    Midr = text::midr(s1, d, s2);
    /// MIDW (FNC 207): replaces the middle of a text.
    Midw = text::midw(s1, d, s2);
    /// INSTR (FNC 208): seeks a text.
    Instr = text::instr(s1, s2, d, n);
    /// $MOV (FNC 209): copies a text.
    StrMov = text::str_mov(s, d);
    /// DABIN (FNC 260): decimal text to integer.
    Dabin = text::dabin(s, d);
    /// BINDA (FNC 261): integer to decimal text.
    Binda = text::binda(s, d);
    /// IST (FNC 60): modes of a step sequence.
    Ist = handy::ist(s, d1, d2) [state];
    /// SER (FNC 61): searches a table.
    Ser = handy::ser(s1, s2, d, n);
    /// ABSD (FNC 62): drum by a counter's value.
    Absd = handy::absd(s1, s2, d, n);
    /// INCD (FNC 63): drum step by step.
    Incd = handy::incd(s1, s2, d, n) [state, always];
    /// TTMR (FNC 64): measures the drive.
    Ttmr = handy::ttmr(d, n) [state, always];
    /// STMR (FNC 65): delayed bits.
    Stmr = handy::stmr(s, m, d) [state, always];
    /// ALT (FNC 66): inverts a bit.
    Alt = handy::alt(d);
    /// RAMP (FNC 67): from one value to another in n scans.
    Ramp = handy::ramp(s1, s2, d, n) [state, always];
    /// ROTC (FNC 68): rotary table.
    Rotc = handy::rotc(s, m1, m2, d) [state, always];
    /// SORT (FNC 69): sorts a table kept by columns.
    Sort = handy::sort(s, m1, m2, d, n) [state, always];
    /// D8490–D8511 of H1U/H2U, once after each scan's program.
    ErrorLog = system::error_log() [state, always];
    /// D8030–D8045 of L01S, once before each scan's program.
    AnalogInputs = system::analog_inputs() [always, hal];
    /// D8030 and D8031 of FX3G, once before each scan's program.
    Potentiometers = system::potentiometers() [always, hal];
    /// D8398 and D8399 of FX3G, FX3U and L01S, once before each scan's program.
    RingCounter = system::ring_counter() [always];
    /// The oscilloscope of HM, each millisecond.
    Oscilloscope = scope::oscilloscope(n, d) [state];
    /// PTAB: points of a segment.
    Ptab = segment::ptab(s, d, n) [state, always];
    /// PCTAB: the cam table of a cut.
    Pctab = cut::pctab(s, d) [state, always];
    /// PBTAB: the way back of a cam table.
    Pbtab = cut::pbtab(s, d) [state, always];
    /// FROM of L01S: module 0 is the host's analog inputs if there is no other.
    FromHost = modules::from_host(m1, m2, d, n) [hal];
    /// TO of L01S: module 0 is the host's analog outputs if there is no other.
    ToHost = modules::to_host(m1, m2, s, n) [hal];
    /// REF (FNC 50): refreshes terminals.
    Ref = modules::refresh_terminals(d, n) [hal];
    /// REF of HM: leaves outputs of axes out.
    RefHm = modules::refresh_terminals_hm(d, n) [hal];
    /// REFF (FNC 51): filter of the inputs.
    Reff = modules::reff(n) [hal];
    /// MTR (FNC 52): matrix of switches.
    Mtr = keys::mtr(s, d1, d2, n) [state, always];
    /// PLSY (FNC 57): pulses.
    Plsy = pulses::plsy(s1, s2, d) [state, always, pulses];
    /// PWM (FNC 58): pulses of a width and a period.
    Pwm = pulses::pwm(s1, s2, d) [state, always, pulses, unit];
    /// PLSR (FNC 59): pulses with ramps.
    Plsr = pulses::plsr(s1, s2, s3, d) [state, always, pulses, ramps];
    /// DSZR (FNC 150): return to the origin.
    Dszr = position::dszr(s1, s2, d1, d2) [state, always, pulses, ramps, home, clears, signals];
    /// DVIT (FNC 151): pulses from an interrupt on.
    Dvit = position::dvit(s1, s2, d1, d2) [state, always, pulses, ramps, interrupt, signals];
    /// An input stops the pulses of an output.
    StopPulses = pulses::stop_pulses(d) [pulses];
    /// DPLSY of HM: pulses on an axis.
    AxisPlsy = axes::axis_plsy(d1, d2, axis) [state, always, pulses, signals];
    /// DPLSR of HM: pulses with ramps of a time.
    AxisPlsr = axes::axis_plsr(d1, d2, d3, axis) [state, always, pulses, signals];
    /// DDRVI of HM: relative move.
    AxisDrvi = axes::axis_drvi(d1, d2, axis) [state, always, pulses, signals];
    /// DDRVA of HM: absolute move.
    AxisDrva = axes::axis_drva(d1, d2, axis) [state, always, pulses, signals];
    /// DDVIT of HM: move from an interrupt on.
    AxisDvit = axes::axis_dvit(d1, d2, axis) [state, always, pulses, signals];
    /// DPLSV of HM: pulses of a variable speed.
    AxisPlsv = axes::axis_plsv(d1, axis) [state, always, pulses, signals];
    /// PSOUT of HM: move at the highest speed.
    AxisPsout = axes::axis_psout(axis, d2) [state, always, pulses, signals];
    /// GEAR of HM: follows a master.
    AxisGear = axis_follow::axis_gear(axis, d2, d3, d4, d5) [state, always, pulses];
    /// PTOUT of HM: follows a table.
    AxisPtout = axis_follow::axis_ptout(axis, d2, d3, d4, d5) [state, always, pulses];
    /// CAM of HM: follows a master along a curve while it is engaged.
    AxisCam = axis_cam::axis_cam(axis, d2, d3, d4, d5) [state, always, pulses, anywhere];
    /// IPL of HM: inserts pulses.
    AxisIpl = axis_follow::axis_ipl(axis, d2) [state, always, pulses];
    /// JOG of HM.
    AxisJog = axis_jog::axis_jog(axis, d2, d3, d4, d5) [state, always, pulses, signals];
    /// HOME of HM: return to the origin.
    AxisHome = axis_home::axis_home(axis) [state, always, pulses, signals];
    /// ABS (FNC 155): absolute position of a servo.
    Abs = servo::abs(s, d1, d2) [state, always];
    /// ZRN (FNC 156): return to the origin, without turning round.
    Zrn = position::zrn(s1, s2, s3, d) [state, always, pulses, ramps, clears, signals];
    /// PLSV (FNC 157): pulses of a variable speed.
    Plsv = position::plsv(s, d1, d2) [state, always, pulses, ramps];
    /// DRVI (FNC 158): relative move.
    Drvi = position::drvi(s1, s2, d1, d2) [state, always, pulses, ramps];
    /// DRVA (FNC 159): absolute move.
    Drva = position::drva(s1, s2, d1, d2) [state, always, pulses, ramps];
    /// TKY (FNC 70): ten keys.
    Tky = keys::tky(s, d1, d2) [state, always];
    /// HKY (FNC 71): matrix of 16 keys.
    Hky = keys::hky(s, d1, d2, d3) [state, always];
    /// DSW (FNC 72): decimal switches.
    Dsw = keys::dsw(s, d1, d2, n) [state, always];
    /// SEGD (FNC 73): segments of a digit.
    Segd = display::segd(s, d);
    /// SEGL (FNC 74): display of four or eight digits.
    Segl = display::segl(s, d, n) [state, always];
    /// ARWS (FNC 75): edits a number with arrow keys.
    Arws = display::arws(s, d1, d2, n) [state, always];
    /// ASC (FNC 76): text constant.
    Asc = display::asc(s, d);
    /// PR (FNC 77): prints characters.
    Pr = display::pr(s, d) [state, always];
    /// FROM (FNC 78): reads buffer memory.
    From = modules::from(m1, m2, d, n) [hal];
    /// TO (FNC 79): writes buffer memory.
    To = modules::to(m1, m2, s, n) [hal];
    /// RD3A (FNC 176): reads an analog module.
    Rd3a = modules::rd3a(m1, m2, d) [hal];
    /// WR3A (FNC 177): writes an analog module.
    Wr3a = modules::wr3a(m1, m2, s) [hal];
    /// RD3A of compatible boards: module 0 is the board.
    Rd3aBoard = modules::rd3a_board(m1, m2, d) [hal];
    /// WR3A of compatible boards: module 0 is the board.
    Wr3aBoard = modules::wr3a_board(m1, m2, s) [hal];
    /// VRRD (FNC 85): position of a potentiometer.
    Vrrd = modules::vrrd(s, d) [hal];
    /// VRSC (FNC 86): position of a potentiometer as a switch.
    Vrsc = modules::vrsc(s, d) [hal];
    /// RBFM (FNC 278): reads buffer memory in portions.
    Rbfm = modules::rbfm(m1, m2, d, n1, n2) [state, always, hal];
    /// WBFM (FNC 279): writes buffer memory in portions.
    Wbfm = modules::wbfm(m1, m2, s, n1, n2) [state, always, hal];
    /// PID (FNC 88) of H1U/H2U: without auto-tuning.
    Pid = pid::pid(s1, s2, s3, d);
    /// PID of FX: with auto-tuning by step response.
    PidTuning = pid::pid_tuning(s1, s2, s3, d);
    /// PID of HM: one computation per execution.
    PidHm = pid::pid_hm(s1, s2, s3, d);
    /// PID of L01S: for temperatures.
    PidThermal = pid_thermal::pid_thermal(s1, s2, s3, d) [state];
    /// LOADR (FNC 290): ER to R.
    Loadr = cassette::loadr(s, n, er);
    /// SAVER (FNC 291): a sector of R to ER in portions.
    Saver = cassette::saver(s, n, d, er) [state, always];
    /// INITR (FNC 292): erases R and ER.
    Initr = cassette::initr(s, n, er);
    /// RWER (FNC 294): R to ER.
    Rwer = cassette::rwer(s, n, er);
    /// INITER (FNC 295): erases ER.
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

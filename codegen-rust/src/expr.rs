//! Expressions of the IR as expressions of Rust, with as few parentheses as a reader would write.

use crate::generate::Generator;
use crate::storage::{PrintField, PrintStorage, bit_of, word_of};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use rungc_emit::bounds;
use rungc_emit::logic;
use rungc_emit::storage::Kind;
use rungc_ir::node::{Access, AccessKind, BinOp, Expr, ExprId, Place, SysValue, TempId, Ty};
use rungc_rt::CmpOp;

/// Shape of a Rust expression, for parentheses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Shape {
    /// Needs none: a path, field, call, positive literal.
    Atom,
    /// After a prefix operator.
    Unary,
    /// `a as T`.
    Cast,
    /// Operands of this operator.
    Binary(&'static str),
}

/// A Rust expression.
#[derive(Clone, Debug)]
pub struct Code {
    /// Its text.
    pub tokens: TokenStream,
    /// Its kind.
    pub shape: Shape,
    /// The operands if it is binary: for `a |= b`.
    pub operands: Option<Box<(Code, Code)>>,
}

impl Code {
    /// Something that needs no parentheses.
    pub fn atom(tokens: TokenStream) -> Self {
        Code {
            tokens,
            shape: Shape::Atom,
            operands: None,
        }
    }

    fn shaped(tokens: TokenStream, shape: Shape) -> Self {
        Code {
            tokens,
            shape,
            operands: None,
        }
    }

    /// Two operands of an operator.
    pub fn binary(op: &'static str, a: Code, b: Code) -> Self {
        let sign: TokenStream = match op {
            "&" => quote!(&),
            "|" => quote!(|),
            "^" => quote!(^),
            "/" => quote!(/),
            "%" => quote!(%),
            "==" => quote!(==),
            "!=" => quote!(!=),
            "<" => quote!(<),
            "<=" => quote!(<=),
            ">" => quote!(>),
            _ => quote!(>=),
        };
        let operands = Some(Box::new((a.clone(), b.clone())));
        let (a, b) = (a.operand_of(op), b.operand_of(op));
        Code {
            tokens: quote!(#a #sign #b),
            shape: Shape::Binary(op),
            operands,
        }
    }

    /// As something that a method is called on.
    pub fn receiver(self) -> TokenStream {
        match self.shape {
            Shape::Atom => self.tokens,
            Shape::Unary | Shape::Cast | Shape::Binary(_) => {
                let tokens = self.tokens;
                quote!((#tokens))
            }
        }
    }

    /// As an operand of `op`. Operators are never mixed without parentheses; chains of a bitwise operator need none.
    fn operand_of(self, op: &'static str) -> TokenStream {
        match self.shape {
            Shape::Atom | Shape::Unary => self.tokens,
            Shape::Binary(own) if own == op && matches!(op, "&" | "|" | "^") => self.tokens,
            Shape::Cast | Shape::Binary(_) => self.receiver(),
        }
    }
}

impl ToTokens for Code {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        self.tokens.to_tokens(tokens);
    }
}

/// A 16-bit literal, with its type if the context does not give it.
fn literal16(value: i16, typed: bool) -> Code {
    match (value, typed) {
        (i16::MIN, _) => Code::atom(quote!(i16::MIN)),
        (0.., true) => Code::atom(Literal::i16_suffixed(value).into_token_stream()),
        (0.., false) => Code::atom(Literal::i16_unsuffixed(value).into_token_stream()),
        (_, typed) => {
            let literal = literal16(-value, typed);
            Code::shaped(quote!(-#literal), Shape::Unary)
        }
    }
}

/// A 32-bit literal, with its type if the context does not give it.
pub(crate) fn literal32(value: i32, typed: bool) -> Code {
    match (value, typed) {
        (i32::MIN, _) => Code::atom(quote!(i32::MIN)),
        (0.., true) => Code::atom(Literal::i32_suffixed(value).into_token_stream()),
        (0.., false) => Code::atom(Literal::i32_unsuffixed(value).into_token_stream()),
        (_, typed) => {
            let literal = literal32(-value, typed);
            Code::shaped(quote!(-#literal), Shape::Unary)
        }
    }
}

fn float_literal(value: f32) -> Code {
    if !value.is_finite() {
        let bits = Literal::u32_unsuffixed(value.to_bits());
        return Code::atom(quote!(f32::from_bits(#bits)));
    }
    let literal = Literal::f32_suffixed(value.abs());
    if value.is_sign_negative() {
        Code::shaped(quote!(-#literal), Shape::Unary)
    } else {
        Code::atom(literal.into_token_stream())
    }
}

impl Generator<'_> {
    /// An expression where its type is known from around it.
    pub fn expr(&mut self, id: ExprId) -> Code {
        self.code(id, false)
    }

    /// An expression that must tell its own type.
    pub fn typed(&mut self, id: ExprId) -> Code {
        self.code(id, true)
    }

    fn code(&mut self, id: ExprId, typed: bool) -> Code {
        if let Some(name) = self.named.get(&id) {
            return Code::atom(name.clone());
        }
        match *self.module.expr(id) {
            Expr::Bit(value) => Code::atom(quote!(#value)),
            Expr::I16(value) => literal16(value, typed),
            Expr::I32(value) => literal32(value, typed),
            Expr::F32(value) => float_literal(value),
            Expr::Temp(temp) => self.temp(temp),
            Expr::Read(access) => self.read(access),
            Expr::Cell(cell) => {
                let cell = self.cell(cell);
                Code::atom(quote!(plc.#cell))
            }
            Expr::Entry(table, index) => {
                let (table, index) = (self.table(table), self.expr(index));
                Code::atom(quote!(plc.#table[#index as usize]))
            }
            Expr::Stride(_, by) => {
                let by = Literal::i32_unsuffixed(by as i32);
                Code::atom(quote!((#by * i as i32)))
            }
            Expr::Flag(flag) => {
                let flag = self.flag(flag);
                Code::atom(quote!(plc.#flag))
            }
            Expr::Sys(value) => sys_value(value),
            Expr::Not(a) => self.not(a),
            Expr::And(a, b) => Code::binary("&", self.expr(a), self.expr(b)),
            Expr::Or(a, b) => Code::binary("|", self.expr(a), self.expr(b)),
            Expr::Cmp(op, a, b) => self.compare(op, a, b),
            Expr::Bin(op, a, b) => self.arithmetic(op, a, b, typed),
            Expr::Un(op, a) => {
                let function = self.word_function(op.name(self.module.ty(a)));
                let a = self.expr(a);
                Code::atom(quote!(#function(#a)))
            }
            Expr::Float(op, a, b) => {
                let function = self.word_function(op.name());
                let (a, b) = (self.expr(a), self.expr(b));
                Code::atom(quote!(#function(#a, #b)))
            }
            Expr::Complement(a) => {
                let a = self.code(a, typed).operand_of("!");
                Code::shaped(quote!(!#a), Shape::Unary)
            }
            Expr::Neg(a) => {
                let a = self.typed(a).receiver();
                Code::atom(quote!(#a.wrapping_neg()))
            }
            Expr::Widen(a) => self.widen(a, typed),
            Expr::Narrow(a) => {
                let a = self.typed(a).operand_of("as");
                Code::shaped(quote!(#a as i16), Shape::Cast)
            }
            Expr::Within { value, .. } => self.expr(value),
            Expr::HighWord(a) => {
                let a = self.typed(a).operand_of(">>");
                Code::shaped(quote!((#a >> 16) as i16), Shape::Cast)
            }
            Expr::BitToInt(a) => {
                let a = self.expr(a);
                Code::atom(quote!(i16::from(#a)))
            }
            Expr::InRange {
                place,
                count,
                length,
            } => self.in_range(place, count, length),
        }
    }

    fn read(&mut self, Access { place, kind }: Access) -> Code {
        match kind {
            AccessKind::Bit => self.read_bit(place),
            AccessKind::WordBit(bit) => self.read_word_bit(place, bit),
            AccessKind::Word => self.read_word(place),
            AccessKind::Pair => self.read_pair(place),
            AccessKind::Float => self.read_float(place),
            AccessKind::Nibbles { digits, wide } => self.read_nibbles(place, digits, wide),
        }
    }

    fn read_word_bit(&mut self, place: Place, bit: u8) -> Code {
        let word = self.read_word(place);
        let function = self.word_function("bit");
        let bit = Literal::u8_unsuffixed(bit);
        Code::atom(quote!(#function(#word, #bit)))
    }

    fn widen(&mut self, a: ExprId, typed: bool) -> Code {
        if let Expr::I16(value) = *self.module.expr(a) {
            return literal32(value.into(), typed);
        }
        let a = self.typed(a);
        Code::atom(quote!(i32::from(#a)))
    }

    /// A comparison, with a constant on the right.
    fn compare(&mut self, op: CmpOp, a: ExprId, b: ExprId) -> Code {
        let (op, a, b) = logic::comparison(self.module, op, a, b);
        Code::binary(op.symbol(), self.typed(a), self.expr(b))
    }

    fn temp(&mut self, temp: TempId) -> Code {
        let place = self.temp_place(temp);
        match self.numeric_temps.contains(&temp) {
            true => Self::is_on(place),
            false => Code::atom(place),
        }
    }

    /// `!a`; comparisons of integers are turned around instead.
    pub fn not(&mut self, a: ExprId) -> Code {
        let is_named = self.named.contains_key(&a);
        if let Some((op, x, y)) = logic::opposite(self.module, a).filter(|_| !is_named) {
            return self.compare(op, x, y);
        }
        let a = self.expr(a).operand_of("!");
        Code::shaped(quote!(!#a), Shape::Unary)
    }

    fn arithmetic(&mut self, op: BinOp, a: ExprId, b: ExprId, typed: bool) -> Code {
        let is_wide = self.module.ty(a) == Ty::I32;
        let min = if is_wide {
            quote!(i32::MIN)
        } else {
            quote!(i16::MIN)
        };
        let divisor = *self.module.expr(b);
        let is_constant = matches!(divisor, Expr::I16(_) | Expr::I32(_));
        let by_constant = is_constant && !matches!(divisor, Expr::I16(0 | -1) | Expr::I32(0 | -1));
        let operands = |this: &mut Self| (this.typed(a).receiver(), this.expr(b));
        let call = |(a, b): (TokenStream, Code), method: &str| {
            let method = format_ident!("{method}");
            Code::atom(quote!(#a.#method(#b)))
        };
        match op {
            BinOp::And => Code::binary("&", self.code(a, typed), self.expr(b)),
            BinOp::Or => Code::binary("|", self.code(a, typed), self.expr(b)),
            BinOp::Xor => Code::binary("^", self.code(a, typed), self.expr(b)),
            BinOp::Add => call(operands(self), "wrapping_add"),
            BinOp::Sub => call(operands(self), "wrapping_sub"),
            BinOp::Mul => call(operands(self), "wrapping_mul"),
            BinOp::SatAdd => call(operands(self), "saturating_add"),
            BinOp::SatSub => call(operands(self), "saturating_sub"),
            BinOp::Min => call(operands(self), "min"),
            BinOp::Max => call(operands(self), "max"),
            BinOp::MulHigh => {
                let (a, b) = (self.typed(a), self.expr(b));
                let mul_high = self.word_function("mul_high");
                Code::atom(quote!(#mul_high(#a, #b)))
            }
            BinOp::RotateLeft if is_constant => call(operands(self), "rotate_left"),
            BinOp::RotateLeft => {
                let a = self.typed(a).receiver();
                let places = self.typed(b).operand_of("as");
                Code::atom(quote!(#a.rotate_left(#places as u32)))
            }
            BinOp::Div if by_constant => Code::binary("/", self.typed(a), self.expr(b)),
            BinOp::Rem if by_constant => Code::binary("%", self.typed(a), self.expr(b)),
            // Only MIN / -1 has no quotient left here: it wraps to MIN, with remainder 0.
            BinOp::Div => {
                let (a, b) = operands(self);
                Code::atom(quote!(#a.checked_div(#b).unwrap_or(#min)))
            }
            BinOp::Rem => {
                let (a, b) = operands(self);
                Code::atom(quote!(#a.checked_rem(#b).unwrap_or(0)))
            }
        }
    }

    /// The device of a loop's current iteration.
    pub(crate) fn cell_of_iteration(&self, place: Place) -> Option<TokenStream> {
        let Expr::Stride(_, by) = *self.module.expr(place.index?) else {
            return None;
        };
        let device = (place.class, place.number);
        self.storage
            .cell_of_iteration(device, by, &format_ident!("i"))
    }

    /// The device of a loop's current iteration, or one that an index leads to in an array known to hold it.
    fn cell_by_index(&mut self, place: Place) -> Option<TokenStream> {
        if let Some(cell) = self.cell_of_iteration(place) {
            return Some(cell);
        }
        let (field, more) = bounds::array(self.module, &self.storage, &place)?;
        let name = field.name();
        let index = place.index?;
        let index = match (more, *self.module.expr(index)) {
            // It is at least 0.
            (0, Expr::Widen(word)) => self.typed(word),
            (0, _) => self.typed(index),
            (1.., _) => Code::binary("+", literal32(more as i32, false), self.typed(index)),
            _ => Code::binary("-", self.typed(index), literal32(-more as i32, false)),
        };
        let index = index.receiver();
        Some(quote!(plc.#name[#index as usize]))
    }

    /// Location of a bit; `None` if it is not stored, or selected by an index that may lead anywhere.
    pub(crate) fn bit_cell(&mut self, place: Place) -> Option<TokenStream> {
        match place.index {
            Some(_) => bit_of(place.class, place.number, self.cell_by_index(place)?),
            None => self.storage.bit(&quote!(plc), place.class, place.number),
        }
    }

    fn read_bit(&mut self, place: Place) -> Code {
        if let Some(number) = self.numeric_cell(place) {
            return Self::is_on(number);
        }
        match self.bit_cell(place) {
            Some(cell) => Code::atom(cell),
            None if place.index.is_some() => {
                let (class, number) = self.indexed(place);
                Code::atom(quote!(plc.bit_at(#class, #number)))
            }
            // A device that is not stored is a special one that nothing reads; it reads as 0.
            None => Code::atom(quote!(false)),
        }
    }

    /// Location of a word; `None` if it is not stored, or selected by an index that may lead anywhere.
    pub(crate) fn word_cell(&mut self, place: Place) -> Option<TokenStream> {
        match place.index {
            Some(_) => word_of(place.class, place.number, self.cell_by_index(place)?),
            None => self.storage.word(&quote!(plc), place.class, place.number),
        }
    }

    /// Value of a word device.
    pub fn read_word(&mut self, place: Place) -> Code {
        match self.word_cell(place) {
            Some(cell) => Code::atom(cell),
            None if place.index.is_some() => {
                let (class, number) = self.indexed(place);
                Code::atom(quote!(plc.word_at(#class, #number)))
            }
            None => Code::atom(quote!(0i16)),
        }
    }

    fn read_pair(&mut self, place: Place) -> Code {
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            return Code::atom(quote!(plc.pair_at(#class, #number)));
        }
        let plc = quote!(plc);
        if let Some(counter) = self.storage.counter32(&plc, place.class, place.number) {
            return Code::atom(counter);
        }
        let (low, high) = self.pair_words(place);
        let function = self.word_function("pair");
        Code::atom(quote!(#function(#low, #high)))
    }

    fn read_float(&mut self, place: Place) -> Code {
        if place.index.is_some() {
            let (class, number) = self.indexed(place);
            return Code::atom(quote!(plc.float_at(#class, #number)));
        }
        let (low, high) = self.pair_words(place);
        let function = self.word_function("float");
        Code::atom(quote!(#function(#low, #high)))
    }

    fn pair_words(&mut self, place: Place) -> (Code, Code) {
        let high = place.high_word(self.module.model);
        (self.read_word(place), self.read_word(high))
    }

    fn read_nibbles(&mut self, place: Place, digits: u8, wide: bool) -> Code {
        let value = if place.index.is_some() {
            let (class, number) = self.indexed(place);
            let digits = Literal::u8_unsuffixed(digits);
            quote!(plc.nibbles_at(#digits, #class, #number))
        } else {
            let bits = self.bit_slice(place, digits);
            let function = self.word_function("pack");
            quote!(#function(#bits))
        };
        if wide {
            Code::atom(value)
        } else {
            Code::shaped(quote!(#value as i16), Shape::Cast)
        }
    }

    /// `4 * digits` bits as a slice: of an array, or a new one.
    fn bit_slice(&mut self, place: Place, digits: u8) -> TokenStream {
        let count = 4 * u32::from(digits);
        if let Some(slice) = self.array_slice(place, count) {
            return quote!(&#slice);
        }
        let bits: Vec<Code> = (0..count)
            .map(|i| {
                self.read_bit(Place {
                    number: place.number + i,
                    ..place
                })
            })
            .collect();
        quote!(&[#(#bits),*])
    }

    /// `plc.m[4..20]`, if all of these bits lie in one array.
    pub(crate) fn array_slice(&self, place: Place, count: u32) -> Option<TokenStream> {
        let array = self.storage.array(place.class, place.number, count);
        let field = array.filter(|field| field.kind == Kind::Bit)?;
        let (name, offset) = (field.name(), place.number - field.first);
        let from = Literal::u32_unsuffixed(offset);
        let to = Literal::u32_unsuffixed(offset + count);
        Some(quote!(plc.#name[#from..#to]))
    }

    /// The field of some devices that are side by side, and their range in it.
    pub fn run(&self, first: Place, count: u32) -> Option<(Ident, TokenStream)> {
        let field = self.storage.array(first.class, first.number, count)?;
        let from = first.number - field.first;
        let [from, to] = [from, from + count].map(Literal::u32_unsuffixed);
        Some((field.name(), quote!(#from..#to)))
    }

    fn in_range(&mut self, place: Place, count: u32, length: Option<ExprId>) -> Code {
        if place.index.is_none() && length.is_none() {
            let model = self.module.model;
            let holds = model.in_range(place.class, i64::from(place.number), count);
            return Code::atom(quote!(#holds));
        }
        let (class, number) = self.indexed(place);
        let devices = self.devices_const();
        let count = match length {
            None => Literal::u32_unsuffixed(count).into_token_stream(),
            Some(length) => {
                let length = self.typed(length).receiver();
                quote!(#length.unsigned_abs())
            }
        };
        Code::atom(quote!(#devices.hold(#class, #number, #count)))
    }

    /// Class and number of a place, for access by number.
    pub fn indexed(&mut self, place: Place) -> (TokenStream, TokenStream) {
        self.import_access();
        let class = self.class(place.class);
        let Some(index) = place.index else {
            return (class, literal32(place.number as i32, false).tokens);
        };
        let number = self.offset(place.number as i32, index);
        (class, number)
    }

    /// `base` + `index`.
    pub fn offset(&mut self, base: i32, index: ExprId) -> TokenStream {
        let fits = |end: i32| base.checked_add(end).is_some();
        let cannot_overflow = matches!(
            *self.module.expr(index),
            Expr::Widen(_) | Expr::Within { .. }
        ) && !matches!(
            *self.module.expr(index),
            Expr::Within { low, high, .. } if !(fits(low) && fits(high))
        );
        let index = self.typed(index);
        if base == 0 {
            return index.tokens;
        }
        let base = literal32(base, false);
        if cannot_overflow {
            quote!(#base + #index)
        } else {
            let index = index.receiver();
            quote!(#index.wrapping_add(#base))
        }
    }
}

fn sys_value(value: SysValue) -> Code {
    match value {
        SysValue::Running => Code::atom(quote!(plc.sys.running)),
        SysValue::FirstScan => Code::atom(quote!(plc.sys.first_scan)),
        SysValue::NowMs => Code::shaped(quote!(plc.sys.now_ms as i32), Shape::Cast),
        SysValue::MinuteMs => Code::shaped(quote!(plc.sys.minute_ms as i32), Shape::Cast),
        SysValue::SinceScanMs => Code::shaped(quote!(plc.sys.dt_ms as i32), Shape::Cast),
        SysValue::Scan100us => Code::shaped(quote!((plc.sys.scan_us / 100) as i32), Shape::Cast),
    }
}

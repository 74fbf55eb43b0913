//! Temporaries, and the names of parts of expressions.

use crate::generate::Generator;
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use rungc_emit::parts::{self, Limits};
use rungc_emit::temps::Home;
use rungc_ir::node::{ExprId, TempId, Ty};

/// Limits of an expression written inline.
const LIMITS: Limits = Limits {
    depth: 24,
    shared: 6,
    plain: 6,
};

/// The type of a value, and its value at power-on.
pub fn type_of(ty: Ty) -> (TokenStream, TokenStream) {
    match ty {
        Ty::Bit => (quote!(bool), quote!(false)),
        Ty::I16 => (quote!(i16), quote!(0i16)),
        Ty::I32 => (quote!(i32), quote!(0i32)),
        Ty::F32 => (quote!(f32), quote!(0f32)),
    }
}

impl Generator<'_> {
    /// Location of a temporary: `step12`, `plc.step12`.
    pub(crate) fn temp_place(&self, temp: TempId) -> TokenStream {
        let temp = self.plan.temp(temp);
        let name = format_ident!("{}", temp.to_string());
        match temp.home() {
            Home::Field => quote!(plc.#name),
            Home::Constant | Home::Variable(_) => name.into_token_stream(),
        }
    }

    /// A temporary is given the value of an expression.
    pub(crate) fn assign_temp(&mut self, temp: TempId, value: ExprId) -> TokenStream {
        if self.plan.temp(temp).used == 0 {
            return TokenStream::new();
        }
        let value = match self.assigns_level(temp, value) {
            true => self.numeric(value),
            false => self.typed(value),
        };
        self.bind(temp, value.tokens)
    }

    /// Gives a temporary its value, and declares it if it is a constant.
    pub fn bind(&self, temp: TempId, value: TokenStream) -> TokenStream {
        let known = self.plan.temp(temp);
        let place = self.temp_place(temp);
        match known.home() {
            _ if known.used == 0 => quote!(#value;),
            Home::Constant => quote!(let #place = #value;),
            Home::Variable(_) | Home::Field => quote!(#place = #value;),
        }
    }

    /// The `let`s in front of a statement that evaluates `roots`: for what nests too deep, and for what would be
    /// written out several times.
    pub fn name_parts(&mut self, roots: &[ExprId]) -> TokenStream {
        let mut lets = TokenStream::new();
        for e in parts::named(self.module, &self.plan.sizes, roots, LIMITS) {
            self.names += 1;
            let (name, value) = (format_ident!("part{}", self.names), self.typed(e));
            lets.extend(quote!(let #name = #value;));
            self.named.insert(e, name.into_token_stream());
        }
        lets
    }
}

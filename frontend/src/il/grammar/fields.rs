//! The grammar of a whole field of a table.

use super::*;

/// An operand that fills a whole field of a table.
pub(in crate::il) fn operand_field<'s>() -> impl Parser<'s, &'s str, Operand, Extra> + Copy {
    custom(|input| {
        let stray = any()
            .map_with(|_, e| {
                report(e, Kind::Line);
                span(e.span())
            })
            .then_ignore(any().repeated());
        input.parse(
            space()
                .ignore_then(operand().or_not())
                .then_ignore(space())
                .then(stray.or_not())
                .filter(|(operand, stray)| operand.is_some() || stray.is_some())
                .map(|(operand, stray)| match (operand, stray) {
                    (Some(operand), None) => operand,
                    (_, stray) => Operand {
                        span: stray.unwrap_or_default(),
                        kind: OperandKind::Unreadable(None),
                    },
                }),
        )
    })
}

/// The characters that ASC takes, filling a whole field of a table.
pub(in crate::il) fn text_field<'s>() -> impl Parser<'s, &'s str, Operand, Extra> + Copy {
    custom(|input| {
        let bare = any()
            .repeated()
            .to_slice()
            .map(|text: &str| OperandKind::Text(text.trim().into()));
        input.parse(choice((
            placed(text_operand()).then_ignore(end()),
            bare.map_with(|kind, e| Operand {
                span: span(e.span()),
                kind,
            }),
        )))
    })
}

/// A mnemonic or label that fills a whole field of a table.
pub(in crate::il) fn mnemonic_field<'s>() -> impl Parser<'s, &'s str, Option<SmolStr>, Extra> + Copy
{
    custom(|input| {
        let pointer = label().map(|(device, _)| device.to_smolstr());
        let readable = choice((
            pointer,
            mnemonic().map(|(mnemonic, _)| SmolStr::from(mnemonic)),
        ))
        .map(Some);
        let unreadable = any().repeated().at_least(1).to_slice().map_with(|_, e| {
            report(e, Kind::Line);
            None
        });
        input.parse(choice((
            readable.then_ignore(space()).then_ignore(end()),
            unreadable,
        )))
    })
}

/// A device by itself.
pub(in crate::il) fn device_field<'s>() -> impl Parser<'s, &'s str, Device, Extra> + Copy {
    custom(|input| input.parse(device().padded().then_ignore(end())))
}

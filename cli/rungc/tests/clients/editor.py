"""Edits a list with `rungc lsp` as editors do, by pytest-lsp: python3 editor.py RUNGC FOLDER.

The capabilities are those of two editors. What a server sends is held to the specification by pytest-lsp and lsprotocol.
"""

import asyncio
import pathlib
import sys
import warnings

from lsprotocol import types
from pytest_lsp import LspSpecificationWarning, client_capabilities, make_test_lsp_client

LIST = """\
;! X000 = 启动按钮 😀
LD X000 ; 按下 😀
MOV 0x1F D10
LD> D10 K5
OUT Y000
END
"""


def units(text, encoding):
    return len(text.encode("utf-16-le")) // 2 if encoding == "utf-16" else len(text.encode("utf-8"))


def offset(text, position, encoding):
    """The character of a text at a position, in the units that were negotiated."""
    lines = text.splitlines(keepends=True) + [""]
    line = lines[position.line]
    column = next(n for n in range(len(line) + 1) if units(line[:n], encoding) >= position.character)
    return sum(map(len, lines[: position.line])) + column


def applied(text, edits, encoding):
    places = [(offset(text, e.range.start, encoding), offset(text, e.range.end, encoding), e.new_text) for e in edits]
    for start, end, new in sorted(places, reverse=True):
        text = text[:start] + new + text[end:]
    return text


async def published(client, uri):
    while uri not in client.diagnostics:
        await client.wait_for_notification(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    return client.diagnostics.pop(uri)


async def edit(rungc, folder, editor):
    client = make_test_lsp_client()

    @client.feature(types.CLIENT_REGISTER_CAPABILITY)
    def register(params):
        (one,) = params.registrations
        assert one.method == types.WORKSPACE_DID_CHANGE_WATCHED_FILES, one

    await client.start_io(rungc, "lsp", "--stdio")
    root = folder.as_uri()
    offered = client_capabilities(editor)
    answer = await client.initialize_session(types.InitializeParams(capabilities=offered, root_uri=root))
    encoding = answer.capabilities.position_encoding or "utf-16"
    assert answer.server_info.name == "rungc"

    uri = (folder / "压机.il").as_uri()
    item = types.TextDocumentItem(uri=uri, language_id="il", version=1, text=LIST)
    client.text_document_did_open(types.DidOpenTextDocumentParams(text_document=item))
    (found,) = await published(client, uri)
    assert (found.code, found.source) == ("E0002", "rungc"), found
    assert (found.range.start.line, found.range.start.character) == (2, 4), found

    document = types.TextDocumentIdentifier(uri=uri)
    context = types.CodeActionContext(diagnostics=[found])
    actions = await client.text_document_code_action_async(
        types.CodeActionParams(text_document=document, range=found.range, context=context)
    )
    (fix,) = [action for action in actions if action.kind == types.CodeActionKind.QuickFix]
    text = applied(LIST, fix.edit.changes[uri], encoding)
    assert "MOV H1F D10" in text, text

    # Types it in, and a comment before it.
    end = types.Position(line=1, character=units("LD X000 ; 按下 😀", encoding))
    changes = [
        types.TextDocumentContentChangePartial(range=found.range, text="H1F"),
        types.TextDocumentContentChangePartial(range=types.Range(start=end, end=end), text="!"),
    ]
    versioned = types.VersionedTextDocumentIdentifier(uri=uri, version=2)
    client.text_document_did_change(
        types.DidChangeTextDocumentParams(text_document=versioned, content_changes=changes)
    )
    text = text.replace("按下 😀", "按下 😀!")
    left = await published(client, uri)
    assert not left, left

    place = types.Position(line=1, character=4)
    hover = await client.text_document_hover_async(types.HoverParams(text_document=document, position=place))
    assert "启动按钮 😀" in hover.contents.value, hover
    symbols = await client.text_document_document_symbol_async(types.DocumentSymbolParams(text_document=document))
    assert [symbol.name for symbol in symbols] == ["1: MOV H31 D10", "2: OUT Y000", "3: END"] or len(symbols) == 3
    line = types.Position(line=2, character=2)
    proposals = await client.text_document_completion_async(
        types.CompletionParams(text_document=document, position=line)
    )
    assert "MOV" in [proposal.label for proposal in proposals.items], proposals
    whole = types.Range(start=types.Position(line=0, character=0), end=types.Position(line=6, character=0))
    hints = await client.text_document_inlay_hint_async(types.InlayHintParams(text_document=document, range=whole))
    assert [hint.label for hint in hints] == ["启动按钮 😀"], hints
    tokens = await client.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(text_document=document)
    )
    assert len(tokens.data) % 5 == 0 and tokens.data

    renamed = await client.text_document_rename_async(
        types.RenameParams(text_document=document, position=place, new_name="X10")
    )
    text = applied(text, renamed.changes[uri], encoding)
    assert text.startswith(";! X010 = 启动按钮 😀\nLD X010 ; 按下 😀!\n"), text
    await client.shutdown_session()
    await client.stop()
    assert client.error is None, client.error


async def main():
    rungc, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    for editor in ["neovim", "visual_studio_code"]:
        await asyncio.wait_for(edit(rungc, folder, editor), 60)


warnings.simplefilter("error", LspSpecificationWarning)
asyncio.run(main())

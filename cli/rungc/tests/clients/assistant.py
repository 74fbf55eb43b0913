"""Works with `rungc mcp` as assistants do, by the official client: python3 assistant.py RUNGC FOLDER.

The client holds answers to the protocol's schemas, and structured answers to the schemas of the tools.
"""

import asyncio
import pathlib
import sys

import mcp

REVERSER = """\
;! X000 = forward button
;! X002 = stop
;! Y000 = forward contactor
LD X000
OR Y000
ANI X002
ANI Y001
OUT Y000
LD X001
OR Y001
ANI X002
OUT Y001
END
"""

INTERLOCKED = REVERSER.replace("ANI X002\nOUT Y001", "ANI X002\nANI Y000\nOUT Y001")

TESTS = """\
model = "fx3u"
topic = "reverser"
program = "new.il"

[[case]]
name = "forward, until stop"
[[case.step]]
set = { X000 = 1 }
expect = { Y000 = 1 }
[[case.step]]
set = { X000 = 0, X002 = 1 }
expect = { Y000 = 0 }
"""


class Assistant:
    def __init__(self, client):
        self.client = client

    async def call(self, name, **arguments):
        result = await self.client.call_tool(name, arguments)
        (content,) = result.content
        assert not result.is_error, (name, content.text)
        return result.structured_content, content.text

    async def fails(self, name, part, **arguments):
        result = await self.client.call_tool(name, arguments)
        assert result.is_error and part in result.content[0].text, (name, result)

    async def read(self, uri):
        result = await self.client.read_resource(uri)
        return result.contents[0].text


async def rejected(call, part):
    try:
        result = await call
    except mcp.MCPError as error:
        assert part in str(error), error
    else:
        raise AssertionError(result)


async def offered(a, allowed):
    tools = {tool.name: tool for tool in (await a.client.list_tools()).tools}
    assert set(tools) >= {"open", "check", "view", "xref", "explain", "run", "why", "test", "verify", "diff", "convert"}
    assert ("write" in tools) == allowed
    for name, tool in tools.items():
        assert tool.annotations.read_only_hint == (name != "write"), tool
        assert tool.input_schema["type"] == "object" and tool.output_schema["type"] == "object", tool
    prompts = (await a.client.list_prompts()).prompts
    assert len(prompts) == 5, prompts
    templates = (await a.client.list_resource_templates()).resource_templates
    assert any("{name}" in template.uri_template for template in templates)


async def learns_the_language(a):
    guide = await a.read("rungc://guide")
    assert "octal" in guide and len(guide.split()) <= 2000
    assert "MOV" in await a.read("rungc://instruction/MOV")
    assert "W0203" in await a.read("rungc://diagnostic/W0203")
    assert "# " in await a.read("rungc://book/test-files")
    listed = await a.client.list_resources()
    count = len(listed.resources)
    while listed.next_cursor:
        listed = await a.client.list_resources(cursor=listed.next_cursor)
        count += len(listed.resources)
    assert count > 300, count
    await rejected(a.client.read_resource("rungc://nothing/here"), "resources/list")


async def opens_and_checks(a):
    data, text = await a.call("open", path="old.il")
    assert data["format"] == "instruction list" and data["networks"] == 3, data
    assert "forward contactor" in text
    data, _ = await a.call("check", path="old.il")
    assert data["errors"] == 0, data


async def repairs_a_draft(a):
    draft = "LD X0\nOUTT Y0\nIF X1 THEN\nMOV D0\nOUT Y9\nEND\n"
    data, text = await a.call("check", list=draft)
    assert data["errors"] >= 4, text
    assert {one["line"] for one in data["diagnostics"]} >= {2, 3, 4, 5}, text
    data, _ = await a.call("check", list="LD X0\nOUT Y0\nMOV K5 D0\nOUT Y10\nEND\n", model="fx3u")
    assert data["errors"] == 0, data


async def looks_at_the_ladder(a):
    data, text = await a.call("view", path="old.il", devices=["Y000"])
    assert data["networks"] == 3 and "Y000" in text, text
    await a.fails("view", "none of the 3 networks", path="old.il", network=7)


async def asks_who_uses_a_device(a):
    data, _ = await a.call("xref", path="old.il", devices=["forward contactor"])
    assert len(data["devices"][0]["uses"]) == 2, data
    data, text = await a.call("xref", path="old.il", unused=True)
    assert data["devices"] == [], text


async def explains(a):
    for topic in ["MOV", "LD>=", "W0203", "6706", "fx3u", "test-files", "two-hand"]:
        _, text = await a.call("explain", topic=topic)
        assert len(text) > 100, (topic, text)
    _, text = await a.call("explain", topic="M8013", model="fx3u")
    assert "M8013" in text
    await a.fails("explain", "did you mean", topic="MOVV")
    await a.fails("explain", "is missing")


async def runs(a):
    inputs = [{"at_ms": 100, "set": {"X000": True}}, {"at_ms": 300, "set": {"X000": False, "X002": True}}]
    data, text = await a.call("run", path="old.il", inputs=inputs, watch=["Y000"], for_ms=500)
    assert [row["values"]["Y000"] for row in data["rows"]] == [False, True, False], text
    await a.fails("run", "Q0", path="old.il", watch=["Q0"])


async def finds_why_it_stands_still(a):
    inputs = [{"set": {"X000": True, "X002": True}}]
    data, text = await a.call("why", path="old.il", device="forward contactor", inputs=inputs, how=True)
    assert data["device"] == "Y000" and "X002" in text, text


async def proves_the_interlock(a):
    data, text = await a.call("verify", path="old.il", never=["Y000 & Y001"])
    assert data["results"][0]["verdict"] == "violated" and "X001 = 1" in text, text
    data, _ = await a.call("verify", list=INTERLOCKED, never=["Y000 & Y001"])
    assert data["results"][0]["verdict"] == "proved" and data["assumptions"], data
    await a.fails("verify", "^", path="old.il", never=["Y000 &"])


async def tests(a):
    data, text = await a.call("test", path="new.plctest.toml")
    assert (data["passed"], data["failed"]) == (1, 0), text
    data, text = await a.call("test", text=TESTS.replace("expect = { Y000 = 0 }", "expect = { Y000 = 1 }"))
    assert data["failed"] == 1 and "expected 1" in data["cases"][0]["failure"], text


async def reviews_a_change(a):
    data, text = await a.call("diff", old="old.il", new="new.il", semantic=True)
    assert data["differs"] and any("Y001" in one for one in data["behaviour"]), text


async def converts(a):
    data, _ = await a.call("convert", path="old.il", to="ladder")
    again, _ = await a.call("check", list=data["text"])
    assert again["errors"] == 0
    _, text = await a.call("convert", path="old.il", to="plcopen")
    assert "<?xml" in text


async def stays_in_its_folder(a):
    for path in ["../secret.il", "/etc/passwd", "link.il", "steals.plctest.toml"]:
        tool = "test" if path.endswith(".toml") else "check"
        await a.fails(tool, "outside", path=path)


async def follows_a_prompt(a):
    result = await a.client.get_prompt("prove-interlock", {"path": "old.il", "interlock": "both contactors"})
    assert "both contactors" in result.messages[0].content.text
    await rejected(a.client.get_prompt("prove-interlock", {}), "missing")


async def is_corrected(a):
    await a.fails("check", "did you mean `path`", pth="old.il")
    await a.fails("check", "from 0", path="old.il", offset=-1)
    await rejected(a.client.call_tool("chek", {}), "did you mean `check`")


async def writes(a):
    data, _ = await a.call("write", path="mine.il", text=INTERLOCKED)
    assert data["diagnostics"] == []
    await a.fails("write", "overwrite", path="mine.il", text=INTERLOCKED)
    await a.call("write", path="mine.il", text=INTERLOCKED, overwrite=True)
    await a.fails("write", "was there before", path="old.il", text="END\n", overwrite=True)
    await a.fails("write", "not in a folder", path="../mine.il", text="END\n")


TASKS = [
    learns_the_language,
    opens_and_checks,
    repairs_a_draft,
    looks_at_the_ladder,
    asks_who_uses_a_device,
    explains,
    runs,
    finds_why_it_stands_still,
    proves_the_interlock,
    tests,
    reviews_a_change,
    converts,
    stays_in_its_folder,
    follows_a_prompt,
    is_corrected,
]


async def main(rungc, folder):
    # With the handshake, and with a version in each request.
    for mode, version in [("legacy", "2025-11-25"), ("auto", "2026-07-28")]:
        for arguments in [[], ["--allow-write", "."]]:
            start = mcp.StdioServerParameters(command=rungc, args=["mcp", *arguments], cwd=folder)
            async with mcp.Client(start, mode=mode) as client:
                assert client.protocol_version == version, client.protocol_version
                a = Assistant(client)
                await offered(a, bool(arguments))
                if not arguments:
                    for task in TASKS:
                        await task(a)
                elif mode == "legacy":
                    await writes(a)
    print(f"{len(TASKS) + 2} tasks")


FOLDER = pathlib.Path(sys.argv[2])
(FOLDER / "old.il").write_text(REVERSER)
(FOLDER / "new.il").write_text(INTERLOCKED)
(FOLDER / "new.plctest.toml").write_text(TESTS)
asyncio.run(main(sys.argv[1], FOLDER))

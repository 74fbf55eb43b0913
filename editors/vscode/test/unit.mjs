// Tests of the parts that need no editor, and of the manifest.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { transform } from "esbuild";

const root = new URL("../", import.meta.url);
const read = (file) => readFileSync(new URL(file, root), "utf8");

/** A source in TypeScript as a module. */
async function source(name) {
  const { code } = await transform(read(`src/${name}.ts`), { loader: "ts", format: "esm" });
  return import(`data:text/javascript,${encodeURIComponent(code)}`);
}

const { cases, properties, named, decided } = await source("found");
const { networks, networkAt, places, plain } = await source("networks");
const { add } = await source("lcov");

test("the version is that of rungc", () => {
  const version = /^version = "(.*)"$/m.exec(read("../../Cargo.toml"))[1];
  assert.equal(JSON.parse(read("package.json")).version, version);
  assert.equal(JSON.parse(read("package-lock.json")).version, version);
});

test("every command has a title, and is registered", () => {
  const { commands } = JSON.parse(read("package.json")).contributes;
  const sources = read("src/extension.ts");
  for (const { command, title } of commands) {
    assert.ok(title);
    assert.match(sources, new RegExp(`command\\("${command.replace("rungc.", "")}"`));
  }
});

test("cases are found where they are named", () => {
  const text = `topic = "x"\n[[case]]\nnote = "n"\nname = "a \\"b\\"" # c\nprogram = """\n[[case]]\nname = "no"\n"""
[[case.step]]\nname = "no"\n[[ case ]]\nname = 'c:\\d'\n[[case]]\n`;
  const found = cases(text).map(({ line, label }) => [line, label]);
  assert.deepEqual(found, [[3, 'a "b"'], [11, "c:\\d"]]);
});

test("rows belong to their case", () => {
  const all = cases('[[case]]\nname = "a"\n[[case]]\nname = "a[1]"\n');
  assert.equal(named(all, "a[1]"), all[1]);
  assert.equal(named(all, "a[two]"), all[0]);
  assert.equal(named(all, "b"), undefined);
});

test("properties are found, and their verdicts", () => {
  const all = properties(`[[property]]\nname = "n"\nnever = "Y000"
[[property]]\nid = "R1"\ntext = "t"\nalways = '"a" = M1'
[[property]]\nid = "R2"\ntext = "tests only"\n[[property]]\nid = "R3"\nuse = "two-hand"\n[verify]\nnever = 1\n`);
  const shown = all.map(({ line, label }) => [line, label]);
  assert.deepEqual(shown, [[0, "n"], [3, "R1: t"], [10, "R3: use two-hand"]]);
  const verdicts = [
    { property: "n: never Y000" },
    { requirement: "R1", property: 'always "a" = M1' },
    { requirement: "R3", property: "two-hand: never Y000" },
    { requirement: "R3", property: "two-hand: never Y001" },
  ];
  const of = all.map((one) => decided(one, all, verdicts).map((verdict) => verdicts.indexOf(verdict)));
  assert.deepEqual(of, [[0], [1], [2, 3]]);
  assert.deepEqual(decided(all[0], all, []), []);
});

test("networks are found by their lines", () => {
  const at = (name, first, last, children) => {
    return { name, range: { start: { line: first }, end: { line: last } }, children };
  };
  const found = networks([at("1: OUT Y000", 2, 4), at("P1", 6, 12, [at("2: SRET", 6, 7), at("3: END", 9, 12)])]);
  assert.deepEqual(found.map(({ number }) => number), [1, 2, 3]);
  assert.deepEqual([0, 3, 5, 8, 99].map((line) => networkAt(found, line).number), [1, 1, 2, 3, 3]);
  assert.equal(networkAt([], 0), undefined);
});

test("devices are found however they are written", () => {
  assert.equal(plain("x007"), "X7");
  assert.equal(plain("D0"), "D0");
  assert.deepEqual(places("MOV K2X0 D10Z1 ; X0", "X000"), [4]);
  assert.deepEqual(places("MOV D1 D1", "D1"), [4, 7]);
  assert.deepEqual(places("LD X10", "X1"), []);
});

test("coverage of several files adds up", () => {
  const coverage = new Map();
  const path = (file) => `/w/${file}`;
  add(coverage, "TN:rungc\nSF:a.il\nBRDA:1,0,0,1\nBRDA:1,0,1,0\nDA:1,1\nDA:2,0\nend_of_record\n", path);
  add(coverage, "SF:a.il\r\nBRDA:1,0,0,0\r\nBRDA:1,0,1,1\r\nDA:1,0\r\nDA:2,0\r\n", path);
  const lines = coverage.get("/w/a.il");
  assert.deepEqual(lines.get(1), { executed: true, branches: [true, true] });
  assert.deepEqual(lines.get(2), { executed: false, branches: [] });
});

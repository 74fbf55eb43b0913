// Talks to `rungc run --mc` with mcprotocol, in binary: node mc.js PORT FRAME, where FRAME is 1E or 3E.
//
// The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U. Version 0.1.1 knows 1E alone; 0.1.2 knows 3E, but takes the
// answer to each write for an error (in 1E for one that ends it), and writes bits with the subcommand of another frame. A batch of 32-bit counters
// is part of 1E alone.
"use strict";
const assert = require("node:assert");

const items = {
  TERMS: "D0,2",
  SUM: "D2",
  RELAY: "M0",
  OUTPUT: "Y0",
  RELAYS: "M100,20",
  FLOAT: "DFLOAT200",
  STATES: "S20,3",
  TIMER: "TN0",
  COUNTER: "CN10",
  INPUTS: "X010,2",
  FAR: "D7999",
};
const [port, frame] = [Number(process.argv[2]), process.argv[3]];
if (frame === "1E") items.WIDE = "CN200";
const Mc = require(frame === "1E" ? "mcprotocol" : "mcprotocol-3e");
const plc = new Mc();

const connect = () =>
  new Promise((resolve, reject) => {
    plc.initiateConnection({ port, host: "127.0.0.1", ascii: false, frame }, (error) => (error === undefined ? resolve() : reject(error)));
  });
const read = () => new Promise((resolve, reject) => plc.readAllItems((bad, values) => (bad ? reject(values) : resolve(values))));
const write = (names, values) =>
  new Promise((resolve, reject) => plc.writeItems(names, values, (bad) => (bad && frame === "1E" ? reject(names) : resolve())));
const soon = async (name, wanted) => {
  let value;
  for (let tries = 0; tries < 30000; tries++) {
    value = (await read())[name];
    if (value === wanted) return;
  }
  assert.strictEqual(value, wanted, name);
};

const bits = async () => {
  await write("RELAY", true);
  await soon("OUTPUT", true);
  const pattern = Array.from({ length: 20 }, (_, n) => n % 3 === 0);
  await write("RELAYS", pattern);
  await write("STATES", [true, false, true]);
  await write("COUNTER", 1234);
  await write("WIDE", 12345678);
  const values = await read();
  assert.deepStrictEqual(values.RELAYS, pattern);
  assert.deepStrictEqual(values.STATES, [true, false, true]);
  assert.strictEqual(values.COUNTER, 1234);
  assert.strictEqual(values.WIDE, 12345678);
};

(async () => {
  await connect();
  plc.setTranslationCB((tag) => items[tag]);
  plc.addItems(Object.keys(items));
  await write("TERMS", [5, 7]);
  await soon("SUM", 12);
  await write("FLOAT", 1.5);
  await write("FAR", -2);
  const values = await read();
  assert.deepStrictEqual(values.TERMS, [5, 7]);
  assert.strictEqual(values.FLOAT, 1.5);
  assert.strictEqual(values.FAR, -2);
  assert.deepStrictEqual(values.INPUTS, [false, false]);
  assert.strictEqual(values.OUTPUT, false);
  if (frame === "1E") await bits();
  console.log("all answers are right");
  process.exit(0);
})().catch((error) => {
  console.error(error);
  process.exit(1);
});

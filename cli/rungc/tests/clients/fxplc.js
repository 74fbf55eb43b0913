// Talks to `rungc run --fx` with node-fxplc: node fxplc.js PORT.
//
// The program is that of fx_port.py. The model is FX3U.
"use strict";
const assert = require("node:assert");
const { FXPLCClient, TransportTCP, NumberType } = require("node-fxplc");

const transport = new TransportTCP({ host: "127.0.0.1", port: Number(process.argv[2]), timeout: 300000, flushDelay: 0 });
const plc = new FXPLCClient(transport, { timeoutMs: 300000 });
// Refusals are reported twice, as an event too.
plc.on("error", () => {});

const soon = async (read, wanted) => {
  let value;
  for (let tries = 0; tries < 30000; tries++) {
    value = await read();
    if (value === wanted) return;
  }
  assert.strictEqual(value, wanted);
};

(async () => {
  await transport.connect();
  await plc.batchWrite(["D0", "D1"], [5, -7]);
  await soon(() => plc.readInt("D2"), -2);
  assert.deepStrictEqual(await plc.batchRead(["D0", "D1", "D2"]), [5, -7, -2]);
  await plc.writeBit("M0", true);
  await soon(() => plc.readBit("Y0"), true);
  assert.strictEqual(await plc.readBit("M0"), true);
  assert.strictEqual(await plc.readBit("X0"), false);
  await plc.writeBit("M1", true);
  await soon(() => plc.readBit("T0"), true);
  assert.strictEqual(await plc.readInt("T0"), 5);
  await plc.writeBit("M2", true);
  await soon(() => plc.readInt("C0"), 1);
  await plc.writeBit("M3", true);
  await soon(() => plc.readBit("S10"), true);
  await plc.writeNumber("D300", 1234567890, NumberType.DoubleWordSigned);
  assert.strictEqual(await plc.readNumber("D300", NumberType.DoubleWordSigned), 1234567890);
  await plc.writeNumber("D302", 1.5, NumberType.Float);
  assert.strictEqual(await plc.readNumber("D302", NumberType.Float), 1.5);
  await assert.rejects(plc.readBytes(0x7fff, 2), { name: "NotSupportedCommandError" });
  assert.strictEqual(await plc.readInt("D0"), 5);
  plc.close();
  console.log("all answers are right");
  process.exit(0);
})().catch((error) => {
  console.error(error);
  process.exit(1);
});
